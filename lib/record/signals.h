/* The signals that a run's page shows over time: collected slice by slice during the run, and thinned at
 * once.
 *
 * Curves (record/path.h) are axes (a door's is its true position), vacuum, and each gripper against the
 * wafer that it holds or may take. Valves, sensors and places of wafers change in steps and are kept
 * unchanged. Poses of grippers and of the arm's links follow from the axes. A gripper that is elsewhere has
 * poses of its own from then on (record/thin.h). Its machine is not the layout's, or a log does not tell
 * the axes. Everything is exact at events and wherever wh_signals_mark is called. Slices count as in the
 * run: a value of slice n is valid at its end; slice 0 is before the first.
 *
 * Memory: the points after thinning, steps, and 4 bytes for each wafer.
 */
#ifndef WH_RECORD_SIGNALS_H
#define WH_RECORD_SIGNALS_H

#include "../layout/layout.h"
#include "../sim/slice.h"
#include "path.h"
#include "scans.h"
#include "thin.h"

/* Initial tolerances. A signal's tolerance grows if it has more points than it may. */
#define WH_SIGNALS_MM 0.02  /* of axes */
#define WH_SIGNALS_RAD 2e-5 /* less for a robot with a longer lever than WH_SIGNALS_LEVER */
#define WH_SIGNALS_LEVER 1290.0
#define WH_SIGNALS_OWN_MM 0.05 /* of poses that do not follow from axes */
#define WH_SIGNALS_OWN_RAD 5e-4
#define WH_SIGNALS_VACUUM 1e-3
#define WH_SIGNALS_PROJZ 0.005
#define WH_SIGNALS_PROJXY 0.05
#define WH_SIGNALS_PLANAR 1e-6

/* The number of points that a signal may have besides the exact ones. */
#define WH_SIGNALS_POINTS 60000

/* The share of a tolerance that thinning may use. The rest is for rounding to decimals. */
#define WH_SIGNALS_SHARE 0.98

/* A gripper is shown against a wafer while |dr_proj_z| is less than this, mm, and |dr_proj_xy| is less than
 * twice the layout's near_projxy. */
#define WH_SIGNALS_REACH 20.0

/* The values of a gripper against its nearest wafer. */
typedef enum {
    WH_MEASURE_PROJZ,  /* |dr_proj_z|, mm */
    WH_MEASURE_PROJXY, /* |dr_proj_xy|, mm */
    WH_MEASURE_PLANAR, /* n1_proj_n2 */
    WH_MEASURES
} wh_measure_t;

/* The most links: WH_ARM_LIFT to WH_ARM_HAND of each arm, then WH_ARM_BASE. */
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

/* The place of a wafer from a slice on. */
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

/* A gripper's measurement, valid while it, all wafers and those that carry some stand. */
typedef struct {
    wh_pose_t pose;    /* of the gripper */
    wh_pose_t carried; /* of the wafer that it carries, in base: its last bits may change after the pick */
    double values[WH_MEASURES];
    int32_t nearest;
    bool is_known;
} wh_measured_t;

/* Zero it to begin with. Read only. */
typedef struct {
    const wh_layout_t *layout; /* null before the first slice; borrowed */
    size_t axis_count;
    wh_path_t axes[WH_AXES], vacuum[WH_GRIPPERS];
    wh_path_t proximity[WH_GRIPPERS][WH_MEASURES];
    wh_thin_t own[WH_GRIPPERS]; /* base_from_gripper from its first point on; before, the axes give it */
    wh_steps_t valves[WH_GRIPPERS], sensors[WH_GRIPPERS];
    wh_steps_t nearest[WH_GRIPPERS]; /* the wafer that it is measured against, or WH_NONE */
    wh_stay_t *stays;                /* in order of time */
    size_t stay_count, stay_capacity;
    int32_t *stay_of; /* the last one of each wafer */
    wh_mark_t *marks;
    size_t mark_count, mark_capacity;
    wh_edge_scans_t scans;
    int64_t first, last; /* slices */
    wh_neighbours_t vicinity[WH_GRIPPERS];
    wh_measured_t measured[WH_GRIPPERS];
} wh_signals_t;

/* The end of a slice, s. */
double wh_signals_seconds(const wh_signals_t *signals, int64_t slice);

/* mm for each rad: the greatest error of a gripper's origin by an error of theta and yaw. */
double wh_signals_lever(const wh_layout_t *layout);

/* Begins with the layout's state before the first slice. With `at_home` that state is the first sample.
 * Otherwise the next slice is: the run's beginning is missing. */
void wh_signals_begin(wh_signals_t *signals, const wh_layout_t *layout, bool at_home);

/* Adds an accepted slice, later than the last one. `axes` has axis_count numbers; null if they are not
 * known. Cost: about 1 us with two grippers, and a pass over all wafers if an event occurs or a gripper has
 * moved far. */
void wh_signals_slice(wh_signals_t *signals, const double axes[], size_t axis_count, const wh_state_t *state);

/* Makes the last slice exact. */
void wh_signals_mark(wh_signals_t *signals);

/* Ends the signals; no slices follow. */
void wh_signals_finish(wh_signals_t *signals);

void wh_signals_close(wh_signals_t *signals);

/* The shown place of a gripper at a slice. The signals must be finished and have slices. Cost: log n. */
void wh_signals_gripper(const wh_signals_t *signals, size_t gripper, int64_t slice,
                        wh_pose_t *base_from_gripper);

/* The shown place of a door's wall at a slice, base_from_door. The conditions of wh_signals_gripper
 * apply. */
void wh_signals_door(const wh_signals_t *signals, size_t door, int64_t slice, wh_pose_t *base_from_door);

/* The links that move, by the numbers of their bodies (layout/arms.h); returns their number. Links shared
 * by two arms of a robot count once; the column of the usual robot does not count. */
size_t wh_signals_link_bodies(const wh_layout_t *layout, int32_t bodies[WH_SIGNALS_LINKS]);

/* The shown places of these at a slice; false if no gripper is on a robot. */
bool wh_signals_links(const wh_signals_t *signals, int64_t slice,
                      wh_pose_t base_from_links[WH_SIGNALS_LINKS]);

/* Calls `visit` for slices in order. They are so close that grippers and links move nearly straight between
 * them: the points of all signals that move them, and places between. */
void wh_signals_walk(const wh_signals_t *signals, void (*visit)(void *user, int64_t slice), void *user);

#endif
