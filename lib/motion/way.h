/* A way between two stations: the arm comes in, turns and goes out again, overlapped.
 *
 * While theta or yaw moves, R is at most `reach`. R goes from where it is to an inner position at or below
 * `reach` and on to its target; theta and yaw move from the instant when R has come in to the one when R goes
 * out. If they need longer than R is inside, R waits at its inner position; if R's way inside takes longer
 * than they need, they are slowed to fit it. Z moves over the whole way. Every axis keeps its limits and is
 * at rest at both ends, R also at the inner position.
 *
 * The further R goes in, the less it has begun to brake when it passes `reach`, and the longer its way. The
 * inner position with the shortest duration is searched for: at 33 positions from R's travel to `reach`, then
 * by golden section about the best of them. On the test's ways that is within 0.1 % of the best of 200
 * positions, and for a turn that R need not wait for within 3 % of t_in + t_turn + t_out, where t_in and
 * t_out are those of an arm that never brakes before it has come in.
 *
 * If R begins and ends at or below `reach`, all axes move at once, from the first instant to the last.
 *
 * A way is a plain struct without pointers: copy it freely. All functions are reentrant.
 */
#ifndef WH_MOTION_WAY_H
#define WH_MOTION_WAY_H

#include "robot.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(way);

/* A planned way. Written by wh_way_plan only; reading its fields is fine. Times are s after the start. */
typedef struct {
    wh_profile_t in, out;                             /* of R; `out` begins at out_begin */
    wh_profile_t theta, yaw;                          /* begin at turn_begin */
    wh_profile_t Z;                                   /* the whole way */
    wh_real_t turn_begin, out_begin, duration;        /* s */
    wh_real_t from[WH_ROBOT_AXES], to[WH_ROBOT_AXES]; /* the axes at its ends */
} wh_way_t;

/* Plans the way from axes `from` to axes `to` (rad, mm). The robot must pass wh_robot_validate, both ends
 * wh_robot_check_travel. `reach` is in mm. Errors, *way then unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_OUT_OF_REACH  `reach` is below R's travel
 *   WH_STATUS_BAD_LIMITS    see wh_profile_plan
 * Cost: about 40 us. */
wh_status_t wh_way_plan(wh_way_t *way, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_real_t to[WH_ROBOT_AXES], wh_real_t reach) WH_SYMBOL(wh_way_plan);

/* s, never negative. */
static inline wh_real_t wh_way_duration(const wh_way_t *way) {
    return way->duration;
}

/* Writes the axes at `t` seconds after the start: exactly `from` for t <= 0 (and NaN), exactly `to` from the
 * duration on. No pointer may be null. Cost: about 30 ns. */
void wh_way_at(const wh_way_t *way, wh_real_t t, wh_real_t q[WH_ROBOT_AXES]) WH_SYMBOL(wh_way_at);

WH_HEADER_END

#endif
