/* A point-to-point move: up to WH_AXES axes (math/config.h) set out together and arrive together.
 *
 * The slowest axis takes its own shortest time (motion/profile.h). Every other axis is slowed uniformly to
 * that time, so no axis exceeds a limit. In the space of the axes the path is straight only if all profiles
 * have one shape.
 *
 * A move is a plain struct without pointers: copy it freely. No function keeps a reference to an argument.
 * All functions are reentrant.
 */
#ifndef WH_MOTION_MOVE_H
#define WH_MOTION_MOVE_H

#include "profile.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(move);

/* A planned move. Only wh_move_plan writes it; callers may read its fields. */
typedef struct {
    size_t count;
    wh_real_t duration; /* s; 0 if no axis moves */
    wh_real_t from[WH_AXES], to[WH_AXES];
    wh_profile_t profile[WH_AXES]; /* relative to `from`, all of the move's duration */
} wh_move_t;

/* Plans the shortest synchronised move from `from` to `to`, both arrays of `count` axis positions (mm or
 * rad), within `limits`, one for each axis. An axis that does not move needs sound limits as well. Each
 * axis stays between `from` and `to`; the caller decides about travel and the direction of turns
 * (motion/robot.h). `from` may be move->to, to continue from the end of a move.
 *
 * Errors, which leave *move unchanged: WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE (count 0 or above
 * WH_AXES), WH_STATUS_NOT_FINITE (a position, or a distance too large to represent), WH_STATUS_BAD_LIMITS
 * (see wh_profile_plan, or durations of axes too far apart). Cost: about 200 ns for four axes.
 */
wh_status_t wh_move_plan(wh_move_t *move, size_t count, const wh_real_t from[], const wh_real_t to[],
                         const wh_limits_t limits[]) WH_SYMBOL(wh_move_plan);

/* wh_move_plan that also refuses a move of more than `most` seconds: WH_STATUS_BAD_SEGMENT. */
wh_status_t wh_move_plan_within(wh_move_t *move, size_t count, const wh_real_t from[], const wh_real_t to[],
                                const wh_limits_t limits[], wh_real_t most) WH_SYMBOL(wh_move_plan_within);

/* s, never negative. */
static inline wh_real_t wh_move_duration(const wh_move_t *move) {
    return move->duration;
}

/* Writes the `count` positions at `t` seconds after the start: exactly `from` for t <= 0 (and NaN), exactly
 * `to` from the duration on. In between each axis is within [from, to] to rounding; an axis without distance
 * is at `from`. A move of duration 0 is at `to` from t = 0 on. No pointer may be null. Cost: about 20 ns for
 * four axes. */
void wh_move_at(const wh_move_t *move, wh_real_t t, wh_real_t position[]) WH_SYMBOL(wh_move_at);

WH_HEADER_END

#endif
