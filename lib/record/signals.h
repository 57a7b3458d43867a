/* What a run's page shows over time: collected slice by slice while the run goes, thinned as it comes.
 *
 * Axes (a door's is where the wall truly is), vacuum, and each gripper against the wafer that it holds or
 * would take are curves (record/path.h). Valves, sensors and places of wafers change in steps and are kept as
 * they are. Poses of grippers and of the arm's links follow from the axes. A gripper that is elsewhere has
 * poses of its own from then on (record/thin.h): its machine is not the layout's, or a log does not tell the
 * axes. Everything is exact at events and wherever wh_signals_mark is called. Slices count as in the run: a
 * value of slice n is true at its end; slice 0 is before the first.
 *
 * Memory: what thinning leaves, steps, and 4 bytes a wafer.
 */
#ifndef WH_RECORD_SIGNALS_H
#define WH_RECORD_SIGNALS_H

#include "../layout/layout.h"
#include "../sim/slice.h"
#include "path.h"
#include "scans.h"
#include "thin.h"

/* Tolerances to begin with. A signal's tolerance grows if it has more points than it may. */
#define WH_SIGNALS_MM 0.02  /* of axes */
#define WH_SIGNALS_RAD 2e-5 /* less for a robot with a longer lever than WH_SIGNALS_LEVER */
#define WH_SIGNALS_LEVER 1290.0
#define WH_SIGNALS_OWN_MM 0.05 /* of poses that do not follow from axes */
#define WH_SIGNALS_OWN_RAD 5e-4
#define WH_SIGNALS_VACUUM 1e-3
#define WH_SIGNALS_PROJZ 0.005
#define WH_SIGNALS_PROJXY 0.05
#define WH_SIGNALS_PLANAR 1e-6

/* How many points a signal may have beside those that are exact. */
#define WH_SIGNALS_POINTS 60000

/* The share of a tolerance that thinning may use. The rest is for rounding to decimals. */
#define WH_SIGNALS_SHARE 0.98

/* A gripper is shown against a wafer while |dr_proj_z| is less than this, mm, and |dr_proj_xy| less than
 * twice the layout's near_projxy. */
#define WH_SIGNALS_REACH 20.0

/* What a gripper is measured by against its nearest wafer. */
typedef enum {
    WH_MEASURE_PROJZ,  /* |dr_proj_z|, mm */
    WH_MEASURE_PROJXY, /* |dr_proj_xy|, mm */
    WH_MEASURE_PLANAR, /* n1_proj_n2 */
    WH_MEASURES
} wh_measure_t;

/* The most links: of each arm WH_ARM_LIFT to WH_ARM_HAND, then WH_ARM_BASE. */
#define WH_SIGNALS_LINKS (WH_LAYOUT_ARMS * WH_ARM_BODIES)

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

/* The wafers near a gripper, valid while it is near `centre`. */
typedef struct {
    int32_t *wafers;
    size_t count, capacity;
    wh_vec3_t centre;
    bool is_known;
} wh_neighbours_t;

/* Zero it to begin with. Read only. */
typedef struct {
    const wh_layout_t *layout; /* null before the first slice; borrowed */
    size_t axis_count;
    wh_path_t axes[WH_AXES], vacuum[WH_GRIPPERS];
    wh_path_t proximity[WH_GRIPPERS][WH_MEASURES];
    wh_thin_t own[WH_GRIPPERS]; /* base_from_gripper from its first point on, if any: else of the axes */
    wh_steps_t valves[WH_GRIPPERS], sensors[WH_GRIPPERS];
    wh_steps_t nearest[WH_GRIPPERS]; /* the wafer that it is measured against, or WH_NONE */
    wh_stay_t *stays;                /* in order of time */
    size_t stay_count, stay_capacity;
    int32_t *stay_of; /* each wafer's last one */
    wh_mark_t *marks;
    size_t mark_count, mark_capacity;
    wh_edge_scans_t scans;
    int64_t first, last; /* slices */
    wh_neighbours_t vicinity[WH_GRIPPERS];
} wh_signals_t;

/* When a slice ends, s. */
double wh_signals_seconds(const wh_signals_t *signals, int64_t slice);

/* mm: so far a gripper's origin is off at most by an error of theta and yaw, for each rad of it. */
double wh_signals_lever(const wh_layout_t *layout);

/* Begins with everything as the layout has it before the first slice. With `at_home` that is the first
 * sample. Without, the next slice is: the run's beginning is missing. */
void wh_signals_begin(wh_signals_t *signals, const wh_layout_t *layout, bool at_home);

/* Adds an accepted slice, later than the last one. `axes` has axis_count numbers; null if they are not known.
 * Cost: about 1 us with two grippers, and a pass over all wafers if something happens or a gripper has gone
 * far. */
void wh_signals_slice(wh_signals_t *signals, const double axes[], size_t axis_count, const wh_state_t *state);

/* Makes the last slice exact. */
void wh_signals_mark(wh_signals_t *signals);

/* No more slices. */
void wh_signals_finish(wh_signals_t *signals);

void wh_signals_close(wh_signals_t *signals);

/* Where a gripper is shown at a slice. The signals must be finished and have slices. Cost: log n. */
void wh_signals_gripper(const wh_signals_t *signals, size_t gripper, int64_t slice,
                        wh_pose_t *base_from_gripper);

/* Where a door's wall is shown at a slice, base_from_door. As wh_signals_gripper. */
void wh_signals_door(const wh_signals_t *signals, size_t door, int64_t slice, wh_pose_t *base_from_door);

/* The links that move, by the numbers of their bodies (layout/arms.h); returns how many there are. Of two
 * arms of a robot what both share counts once, and the column of the usual robot does not. */
size_t wh_signals_link_bodies(const wh_layout_t *layout, int32_t bodies[WH_SIGNALS_LINKS]);

/* Where these are shown at a slice; false if no gripper is on a robot. */
bool wh_signals_links(const wh_signals_t *signals, int64_t slice,
                      wh_pose_t base_from_links[WH_SIGNALS_LINKS]);

/* Calls `visit` for slices in order, so close that grippers and links move between them nearly on straight
 * lines: at the points of all that moves them, and at places between. */
void wh_signals_walk(const wh_signals_t *signals, void (*visit)(void *user, int64_t slice), void *user);

#endif
