/* A way between two stations: the arm comes in, the robot turns, and the arm moves out again, overlapped.
 *
 * While theta or yaw moves, R is at most `reach`. R moves from its present position to an inner position at
 * or below `reach` and on to its target. Theta and yaw move from the instant when R has come in to the one
 * when R moves out. If they need longer than R is inside, R waits at its inner position; if R is inside for
 * longer than they need, they are slowed to fit. Z moves over the whole way. Every axis keeps its limits
 * and is at rest at both ends, R also at the inner position.
 *
 * The further R moves in, the less it has begun to brake when it passes `reach`, and the longer its way.
 * The search finds the inner position with the shortest duration: first at 33 positions from R's travel to
 * `reach`, then by golden section about the best of them. On the test's ways the result is within 0.1 % of
 * the best of 200 positions. For a turn that R need not wait for it is within 3 % of t_in + t_turn + t_out,
 * where t_in and t_out are those of an arm that never brakes before it has come in.
 *
 * If R begins and ends at or below `reach`, all axes move at once, from the first instant to the last.
 *
 * A rail moves with theta and yaw, while the arm is in. Tilts and a flip move over the whole way, like Z.
 * With two arms each comes in to a reach of its own. The turn begins when both are in, and ends when the
 * first of them moves out. An arm that is in at both ends moves all the time. Their inner positions are
 * searched in turn, three times each, each with the last result of the other.
 *
 * A way is a plain struct without pointers: copy it freely. All functions are reentrant.
 */
#ifndef WH_MOTION_WAY_H
#define WH_MOTION_WAY_H

#include "polar.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(way);

/* An arm's way out. */
typedef struct {
    size_t axis;     /* its R */
    wh_real_t begin; /* s after the start */
    wh_profile_t profile;
} wh_way_out_t;

/* A planned way. Only wh_way_plan and wh_way_plan_polar write it; callers may read its fields. Times are s
 * after the start. */
typedef struct {
    size_t axis_count;
    wh_profile_t profiles[WH_CARRIER_AXES]; /* by axis; the way in of an arm that leaves the circle */
    wh_real_t begins[WH_CARRIER_AXES];
    size_t out_count; /* the number of arms that leave the circle */
    wh_way_out_t outs[WH_POLAR_ARMS];
    wh_real_t duration;
    wh_real_t from[WH_CARRIER_AXES], to[WH_CARRIER_AXES]; /* the axes at its ends */
} wh_way_t;

/* Plans the way from axes `from` to axes `to` (rad, mm). The robot must pass wh_robot_validate, both ends
 * wh_robot_check_travel. `reach` is in mm. Errors, which leave *way unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_OUT_OF_REACH  `reach` is below R's travel
 *   WH_STATUS_BAD_LIMITS    see wh_profile_plan
 * Cost: about 40 us. */
wh_status_t wh_way_plan(wh_way_t *way, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_real_t to[WH_ROBOT_AXES], wh_real_t reach) WH_SYMBOL(wh_way_plan);

/* Plans a way for a robot with other axes; with a single arm reach[1] is ignored. A SCARA and a robot that
 * wh_polar_is_sound does not pass give WH_STATUS_OUT_OF_RANGE, too. Cost: about 40 us, 240 us with two arms
 * that both leave the circle. */
wh_status_t wh_way_plan_polar(wh_way_t *way, const wh_polar_t *robot, const wh_real_t from[],
                              const wh_real_t to[], const wh_real_t reach[WH_POLAR_ARMS])
    WH_SYMBOL(wh_way_plan_polar);

/* s, never negative. */
static inline wh_real_t wh_way_duration(const wh_way_t *way) {
    return way->duration;
}

/* Writes the planned axes at `t` seconds after the start: exactly `from` for t <= 0 (and NaN), exactly `to`
 * from the duration on. No pointer may be null. Cost: about 30 ns. */
void wh_way_at(const wh_way_t *way, wh_real_t t, wh_real_t q[]) WH_SYMBOL(wh_way_at);

WH_HEADER_END

#endif
