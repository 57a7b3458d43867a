/* Chooses the turn of an angle that an axis takes; internal to the room. */
#ifndef WH_MOTION_TURNS_INTERNAL_H
#define WH_MOTION_TURNS_INTERNAL_H

#include "../math/exact_internal.h"
#include "../math/trig.h"
#include "robot.h"

/* 2 pi as the sum of two numbers. */
#if defined(WH_FLOAT)
static const wh_exact_t wh_turn = {0x1.921fb6p+2F, -0x1.777a5cp-23F};
#else
static const wh_exact_t wh_turn = {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};
#endif

static inline bool wh_travel_has(const wh_travel_t *travel, wh_real_t slack, wh_real_t position) {
    return position >= travel->min - slack && position <= travel->max + slack;
}

/* True if it is finite, with min < max, and not beyond `widest`. The comparisons also fail for NaN. */
static inline bool wh_travel_is_sound(const wh_travel_t *travel, wh_real_t widest) {
    return travel->min < travel->max && travel->min >= -widest && travel->max <= widest;
}

/* The number of turns to add to `angle` to bring it into (-pi, pi]. */
static inline int32_t wh_turns_to_half(wh_real_t angle) {
    const int32_t turns = -wh_nearest_whole(angle / wh_turn.hi);
    const wh_real_t rest = angle + (wh_real_t)turns * wh_turn.hi;
    return rest <= WH_SLACK_RAD - WH_PI ? turns + 1 : turns;
}

static inline wh_real_t wh_turns_added(wh_exact_t angle, int32_t turns) {
    const wh_real_t n = (wh_real_t)turns;
    const wh_exact_t sum = wh_exact_sum(angle.hi, n * wh_turn.hi);
    return sum.hi + (sum.lo + (angle.lo + n * wh_turn.lo));
}

/* The shorter way round from `now` to the direction `there`, or the other way if only that one is within
 * travel. */
static inline wh_real_t wh_turns_nearest(const wh_travel_t *travel, wh_real_t there, wh_real_t now) {
    const wh_exact_t direction = {there, 0};
    const int32_t turns = wh_turns_to_half(there - now);
    const wh_real_t shorter = wh_turns_added(direction, turns);
    const wh_real_t longer = wh_turns_added(direction, shorter > now ? turns - 1 : turns + 1);
    const bool detour =
        !wh_travel_has(travel, WH_SLACK_RAD, shorter) && wh_travel_has(travel, WH_SLACK_RAD, longer);
    return detour ? longer : shorter;
}

/* The turn from the direction `from` to the direction `to`, in (-pi, pi]. */
static inline wh_real_t wh_turns_between(wh_real_t from, wh_real_t to) {
    const wh_exact_t between = wh_exact_sum(to, -from);
    return wh_turns_added(between, wh_turns_to_half(between.hi));
}

#endif
