/* Internal to the room: a gripper's motion between two slices, and the time at which a resting wafer comes
 * within its reach.
 *
 * With the wafer at rest (3) is linear and (5) squared is quadratic in t. With the rotation interpolated as
 * the normalised quaternion (1-t) 1 + t q, (2) times the quaternion's squared length is quadratic, too. So
 * all three limits have closed roots.
 */
#ifndef WH_GRASP_SWEEP_INTERNAL_H
#define WH_GRASP_SWEEP_INTERNAL_H

#include "proximity.h"

typedef struct {
    const wh_pose_t *begin, *end; /* the caller's */
    wh_vec3_t travel;             /* end.r - begin.r */
    wh_real_t w;                  /* the turn begin.R^T end.R as a unit quaternion, w >= 0 */
    wh_vec3_t v;
} wh_sweep_t;

/* A part of the slice, 0 <= first <= last <= 1. */
typedef struct {
    wh_real_t first, last;
} wh_span_t;

void wh_sweep_between(const wh_pose_t *begin, const wh_pose_t *end, wh_sweep_t *sweep)
    WH_SYMBOL(wh_sweep_between);

/* The pose at t in [0, 1]; at 1 exactly `end`. */
void wh_sweep_pose_at(const wh_sweep_t *sweep, wh_real_t t, wh_pose_t *pose) WH_SYMBOL(wh_sweep_pose_at);

/* The part of the slice in which |dr_proj_z| <= projz and |dr_proj_xy| <= projxy; false if there is none.
 */
bool wh_sweep_within(const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer, wh_real_t projz,
                     wh_real_t projxy, wh_span_t *part) WH_SYMBOL(wh_sweep_within);

/* The first instant at which the wafer is ready, by the rule in grasp.h; false if there is none. */
bool wh_sweep_first_ready(const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer,
                          const wh_tolerance_t *tolerance, wh_real_t *t) WH_SYMBOL(wh_sweep_first_ready);

/* The instant within `part` at which (dr_proj_z / projz)^2 + (|dr_proj_xy| / projxy)^2 is smallest. */
wh_real_t wh_sweep_closest(const wh_sweep_t *sweep, const wh_pose_t *base_from_wafer, const wh_span_t *part,
                           wh_real_t projz, wh_real_t projxy) WH_SYMBOL(wh_sweep_closest);

#endif
