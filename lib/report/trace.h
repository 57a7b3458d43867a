/* What a run's page shows over time: collected slice by slice while the run goes, thinned as it comes.
 *
 * Grippers and the arm's links as poses in base, axes with their speeds, vacuum, and each gripper against the wafer that it holds
 * or would take are thinned (report/thin.h); valves, sensors and where wafers lie change in steps and are kept as they are. All of it is exact at
 * events and wherever wh_trace_mark is called. Slices count as in the run: what is of slice n is true at its end, slice
 * 0 is before the first.
 *
 * Host code: aborts when memory is out. Memory: what thinning leaves, steps, and 4 bytes a wafer.
 */
#ifndef WH_REPORT_TRACE_H
#define WH_REPORT_TRACE_H

#include "report/thin.h"
#include "script/layout.h"
#include "sim/slice.h"

/* How far what is shown may be off, to begin with: it grows where a signal has more points than it may. */
#define WH_TRACE_MM 0.05 /* of grippers and axes */
#define WH_TRACE_RAD 5e-4
#define WH_TRACE_LINK_MM 0.5
#define WH_TRACE_LINK_RAD 2e-3
#define WH_TRACE_MM_PER_S 5.0
#define WH_TRACE_RAD_PER_S 2e-2
#define WH_TRACE_VACUUM 1e-3
#define WH_TRACE_PROJZ 0.005
#define WH_TRACE_PROJXY 0.1
#define WH_TRACE_PLANAR 1e-6

/* How many points a gripper may have, and any other signal. */
#define WH_TRACE_GRIPPER_POINTS 60000
#define WH_TRACE_POINTS 30000

/* Of these thinning takes so much, and rounding to decimals the rest. */
#define WH_TRACE_SHARE 0.98

/* A gripper is shown against a wafer while |dr_proj_z| is less than this, mm, and |dr_proj_xy| less than twice the
 * layout's near_projxy. */
#define WH_TRACE_REACH 20.0

/* A proximity sample holds |dr_proj_z|, |dr_proj_xy| and n1_proj_n2, the others stretched to the first one's tolerance. */
#define WH_TRACE_PROJXY_SCALE (WH_TRACE_PROJZ / WH_TRACE_PROJXY)
#define WH_TRACE_PLANAR_SCALE (WH_TRACE_PROJZ / WH_TRACE_PLANAR)

/* The links of the arm that move: WH_ARM_LIFT to WH_ARM_HAND. */
#define WH_TRACE_LINKS 4

/* A value that holds from a slice on. */
typedef struct {
    int64_t slice;
    int32_t value;
} wh_step_t;

typedef struct {
    wh_step_t *steps;
    size_t count, capacity;
} wh_steps_t;

/* Where a wafer lies or hangs from a slice on. */
typedef struct {
    int64_t slice;
    int32_t wafer;
    int32_t holder; /* a gripper, or WH_NONE */
    wh_pose_t pose; /* gripper_from_wafer, or base_from_wafer */
} wh_stay_t;

/* An event that has a place in the cell. */
typedef struct {
    wh_event_t event;
    int64_t utime;
    bool has_place;
    wh_vec3_t at;
} wh_mark_t;

/* Wafers that a gripper may be near to, while it is near to where they were looked for. */
typedef struct {
    int32_t *wafers;
    size_t count, capacity;
    wh_vec3_t centre;
    bool is_known;
} wh_vicinity_t;

/* Zero it to begin with. Read only. */
typedef struct {
    const wh_layout_t *layout; /* null before the first slice; borrowed */
    size_t axis_count;
    wh_thin_t grippers[WH_GRIPPERS], links[WH_TRACE_LINKS];
    wh_thin_t axes[WH_AXES], speeds[WH_AXES];
    wh_thin_t vacuum[WH_GRIPPERS], proximity[WH_GRIPPERS];
    wh_steps_t valves[WH_GRIPPERS], sensors[WH_GRIPPERS];
    wh_stay_t *stays; /* in order of time */
    size_t stay_count, stay_capacity;
    int32_t *stay_of; /* each wafer's last one */
    wh_mark_t *marks;
    size_t mark_count, mark_capacity;
    int64_t first, last; /* slices */
    double last_axes[WH_AXES];
    int64_t axes_slice; /* of last_axes */
    wh_vicinity_t vicinity[WH_GRIPPERS];
} wh_trace_t;

/* The layout is known: everything is as before the first slice. With `at_home` that is the first sample; without, the next
 * slice is (of a run of which the beginning is missing). */
void wh_trace_begin(wh_trace_t *trace, const wh_layout_t *layout, bool at_home);

/* One accepted slice, later than the last one. `axes` has axis_count numbers; null where they are not known, then as they
 * were. Cost: about 1.5 us with two grippers, a pass over all wafers where something happens or a gripper has gone far. */
void wh_trace_slice(wh_trace_t *trace, const double axes[], size_t axis_count, const wh_state_t *state);

/* What the last slice left is wanted exactly. */
void wh_trace_mark(wh_trace_t *trace);

/* No more slices. */
void wh_trace_finish(wh_trace_t *trace);

void wh_trace_close(wh_trace_t *trace);

/* Within: each gripper against the wafer that it holds or would take. */
void wh_trace_proximity(wh_trace_t *trace, const wh_state_t *state);

#endif
