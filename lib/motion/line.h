/* A straight line of the end-effector in base, at constant heading: entries, retractions and strokes.
 *
 * Along the line, d mm from base's axis at its closest and at signed distance c from that point, R = sqrt(c^2
 * + d^2) and theta turns by d/R^2 per mm; yaw turns back as much. The derivatives of both by c have
 * closed-form maxima on the line, which bound each axis's speed, acceleration and jerk. First the line is
 * planned as one axis (motion/profile.h) with R's limits for its horizontal share and Z's for its vertical
 * one; then, where a bound is above an axis's limit, the whole line is slowed uniformly by one factor. The
 * bounds add magnitudes that need not occur at one instant: limits hold, at the price of some time where a
 * line passes base's axis sideways (on 4,400 random lines of the default robot never more than a factor
 * of 1.5).
 *
 * A line is a plain struct without pointers: copy it freely; nothing keeps a reference to an argument. All
 * functions are reentrant.
 */
#ifndef WH_MOTION_LINE_H
#define WH_MOTION_LINE_H

#include "robot.h"

/* A planned line. Written by wh_line_plan only; reading its fields is fine. */
typedef struct {
    wh_profile_t path;                                /* over the line's length, mm */
    wh_real_t from[WH_ROBOT_AXES], to[WH_ROBOT_AXES]; /* the axes at its ends */
    wh_vec3_t direction; /* of length 1, as the arm sees it at the start: outward, to its left, up */
    wh_real_t slowed;    /* the factor in time that the axes' limits asked for, >= 1 */
} wh_line_t;

/* Plans the line from axes from_q over (dx, dy, dz) mm in base. `speed_cap` (mm/s) limits the speed along it
 * further; 0 is none. The robot must pass wh_robot_validate. A line without length takes no time. Limits of
 * all axes hold to 1e-9 (1e-4 in float) of themselves. A horizontal line straight away from base's axis or
 * towards it, or a vertical one, is not slowed.
 * Errors: WH_STATUS_NULL_ARGUMENT; WH_STATUS_NOT_FINITE; WH_STATUS_OUT_OF_RANGE (negative speed_cap);
 * WH_STATUS_OUT_OF_REACH (R leaves its travel anywhere on the line, its closest point to base's axis
 * included); WH_STATUS_LIMIT_EXCEEDED (another axis, at either end: they turn and lift one way only);
 * WH_STATUS_BAD_LIMITS (see wh_profile_plan, or an axis so slow that the line's duration cannot be represented);
 * *line is then unchanged. Cost: about 280 ns. */
wh_status_t wh_line_plan(wh_line_t *line, const wh_robot_t *robot, const wh_real_t from_q[WH_ROBOT_AXES],
                         wh_real_t dx, wh_real_t dy, wh_real_t dz, wh_real_t speed_cap);

/* Limits of a line beyond those of the axes; 0 is none. */
typedef struct {
    wh_real_t speed;        /* along it, mm/s */
    wh_real_t acceleration; /* along it, mm/s^2 */
} wh_line_caps_t;

/* The same over `travel` (base, mm) with two caps, neither negative nor, unless 0, so small that no profile comes of
 * it: wh_line_plan is this without a cap of acceleration, bit for bit. */
wh_status_t wh_line_plan_capped(wh_line_t *line, const wh_robot_t *robot,
                                const wh_real_t from_q[WH_ROBOT_AXES], const wh_vec3_t *travel,
                                const wh_line_caps_t *caps);

/* s, never negative. */
static inline wh_real_t wh_line_duration(const wh_line_t *line) {
    return wh_profile_duration(&line->path);
}

/* Writes the axes at `t` seconds after the start: exactly from_q for t <= 0 (and NaN), exactly `to` from the
 * duration on; in between the end-effector is on the line to 1e-12 mm (1e-3 in float) with its heading kept
 * to rounding. theta and yaw run on continuously from from_q. No pointer may be null. Cost: about 40 ns. */
void wh_line_at(const wh_line_t *line, wh_real_t t, wh_real_t q[WH_ROBOT_AXES]);

#endif
