/* A straight line of the end-effector in base, at constant heading: entries, retractions and strokes.
 *
 * Let the line pass base's axis at the distance d, and let c be the signed distance along it from that
 * closest point. Then R = sqrt(c^2 + d^2), theta turns by d/R^2 per mm, and yaw turns back as much. The
 * derivatives of R and theta by c have closed-form maxima on the line, which bound each axis's speed,
 * acceleration and jerk. First the line is planned as one axis (motion/profile.h) with R's limits for its
 * horizontal share and Z's for its vertical one. Then, if a bound is above an axis's limit, the whole line
 * is slowed uniformly by one factor. The bounds add magnitudes that need not occur at one instant. So all
 * limits hold, but a line that passes base's axis sideways takes some extra time. On 4,400 random lines of
 * the default robot that was never more than a factor of 1.5.
 *
 * A line is a plain struct without pointers: copy it freely. No function keeps a reference to an argument.
 * All functions are reentrant.
 */
#ifndef WH_MOTION_LINE_H
#define WH_MOTION_LINE_H

#include "robot.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(line);

/* A planned line. Only wh_line_plan writes it; callers may read its fields. */
typedef struct {
    wh_profile_t path;                                /* over the line's length, mm */
    wh_real_t from[WH_ROBOT_AXES], to[WH_ROBOT_AXES]; /* the axes at its ends */
    wh_vec3_t direction; /* of length 1, as the arm sees it at the start: outward, to its left, up */
    wh_real_t slowed;    /* the factor in time that the axes' limits require, >= 1 */
} wh_line_t;

/* Plans the line from axes from_q over (dx, dy, dz) mm in base. `speed_cap` (mm/s) is a further limit of
 * the speed along it; 0 means none. The robot must pass wh_robot_validate. A line without length takes no
 * time. Limits of all axes hold to a relative 1e-9 (1e-4 in float). A vertical line is not slowed; nor is a
 * horizontal one straight away from base's axis or towards it.
 *
 * Errors, which leave *line unchanged: WH_STATUS_NULL_ARGUMENT; WH_STATUS_NOT_FINITE;
 * WH_STATUS_OUT_OF_RANGE (negative speed_cap); WH_STATUS_OUT_OF_REACH (R leaves its travel anywhere on the
 * line, also at its closest point to base's axis); WH_STATUS_LIMIT_EXCEEDED (another axis leaves its
 * travel; checking its ends is enough, because those axes never turn back); WH_STATUS_BAD_LIMITS (see
 * wh_profile_plan, or an axis so slow that the duration cannot be represented). Cost: about 280 ns.
 */
wh_status_t wh_line_plan(wh_line_t *line, const wh_robot_t *robot, const wh_real_t from_q[WH_ROBOT_AXES],
                         wh_real_t dx, wh_real_t dy, wh_real_t dz, wh_real_t speed_cap)
    WH_SYMBOL(wh_line_plan);

/* Limits of a line in addition to those of the axes; 0 means none. */
typedef struct {
    wh_real_t speed;        /* along it, mm/s */
    wh_real_t acceleration; /* along it, mm/s^2 */
} wh_line_caps_t;

/* Plans a line over `travel` (base, mm) with two caps. They must not be negative nor, unless 0, so small
 * that no profile exists. wh_line_plan gives the same bits as this function without a cap of
 * acceleration. */
wh_status_t wh_line_plan_capped(wh_line_t *line, const wh_robot_t *robot,
                                const wh_real_t from_q[WH_ROBOT_AXES], const wh_vec3_t *travel,
                                const wh_line_caps_t *caps) WH_SYMBOL(wh_line_plan_capped);

/* s, never negative. */
static inline wh_real_t wh_line_duration(const wh_line_t *line) {
    return wh_profile_duration(&line->path);
}

/* Writes the axes at `t` seconds after the start: exactly from_q for t <= 0 (and NaN), exactly `to` from
 * the duration on. In between the end-effector is on the line to 1e-12 mm (1e-3 in float), and its heading
 * is kept to rounding. theta and yaw are continuous from from_q. No pointer may be null. Cost: about 40
 * ns. */
void wh_line_at(const wh_line_t *line, wh_real_t t, wh_real_t q[WH_ROBOT_AXES]) WH_SYMBOL(wh_line_at);

WH_HEADER_END

#endif
