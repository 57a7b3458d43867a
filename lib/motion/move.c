#include "motion/move.h"

/* How long the slowest axis takes alone. Plans and forgets, which is cheaper than 1 kB of stack for a second
 * move. */
static wh_status_t slowest(size_t count, const wh_real_t from[], const wh_real_t to[],
                           const wh_limits_t limits[], wh_real_t *longest) {
    wh_real_t shortest = 0;
    *longest = 0;
    for (size_t axis = 0; axis < count; ++axis) {
        wh_profile_t alone;
        const wh_status_t status = wh_profile_plan(&alone, to[axis] - from[axis], &limits[axis]);
        if (status != WH_OK) {
            return status;
        }
        const wh_real_t duration = wh_profile_duration(&alone);
        *longest = duration > *longest ? duration : *longest;
        if (duration > 0 && (shortest == 0 || duration < shortest)) {
            shortest = duration;
        }
    }
    /* The largest factor by which an axis is going to be stretched. */
    return shortest > 0 && !wh_real_is_finite(*longest / shortest) ? WH_STATUS_BAD_LIMITS : WH_OK;
}

/* Cannot fail after `slowest` has planned the same and looked at the factor. Reads before it writes: `from`
 * may be move->to. */
static void plan_axis(wh_move_t *move, size_t axis, wh_real_t from, wh_real_t to, const wh_limits_t *limits) {
    const wh_status_t planned = wh_profile_plan(&move->profile[axis], to - from, limits);
    const wh_status_t stretched = wh_profile_stretch(&move->profile[axis], move->duration);
    WH_ASSERT(planned == WH_OK && stretched == WH_OK);
    (void)planned;
    (void)stretched;
    move->from[axis] = from;
    move->to[axis] = to;
}

wh_status_t wh_move_plan(wh_move_t *move, size_t count, const wh_real_t from[], const wh_real_t to[],
                         const wh_limits_t limits[]) {
    if (move == NULL || from == NULL || to == NULL || limits == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (count == 0 || count > WH_AXES) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_real_t duration;
    const wh_status_t status = slowest(count, from, to, limits, &duration);
    if (status != WH_OK) {
        return status;
    }
    move->count = count;
    move->duration = duration;
    for (size_t axis = 0; axis < count; ++axis) {
        plan_axis(move, axis, from[axis], to[axis], &limits[axis]);
    }
    return WH_OK;
}

void wh_move_at(const wh_move_t *move, wh_real_t t, wh_real_t position[]) {
    for (size_t axis = 0; axis < move->count; ++axis) {
        if (t >= move->duration) {
            position[axis] = move->to[axis];
        } else {
            position[axis] = move->from[axis] + wh_profile_position(&move->profile[axis], t);
        }
    }
}
