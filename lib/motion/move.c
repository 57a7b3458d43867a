#include "move.h"

#include "profile_internal.h"

/* Plans each axis alone: its times, and the duration of the slowest. It keeps no other part of the
 * profiles: planning them twice is cheaper than 1 kB of stack for a second move. */
static wh_status_t plan_alone(size_t count, const wh_real_t from[], const wh_real_t to[],
                              const wh_limits_t limits[], wh_profile_times_t times[], wh_real_t *longest) {
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
        times[axis] = wh_profile_times(&alone);
    }
    /* longest / shortest is the largest factor by which an axis will be stretched. */
    return shortest > 0 && !wh_real_is_finite(*longest / shortest) ? WH_STATUS_BAD_LIMITS : WH_OK;
}

/* It reads before it writes, because `from` may be move->to. */
static void plan_axis(wh_move_t *move, size_t axis, wh_real_t from, wh_real_t to,
                      const wh_profile_times_t *times) {
    wh_profile_shape(&move->profile[axis], to - from, times, move->duration);
    move->from[axis] = from;
    move->to[axis] = to;
}

wh_status_t wh_move_plan_within(wh_move_t *move, size_t count, const wh_real_t from[], const wh_real_t to[],
                                const wh_limits_t limits[], wh_real_t most) {
    if (move == NULL || from == NULL || to == NULL || limits == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (count == 0 || count > WH_AXES) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_profile_times_t times[WH_AXES];
    wh_real_t duration;
    const wh_status_t status = plan_alone(count, from, to, limits, times, &duration);
    if (status != WH_OK) {
        return status;
    }
    if (duration > most) {
        return WH_STATUS_BAD_SEGMENT;
    }
    move->count = count;
    move->duration = duration;
    for (size_t axis = 0; axis < count; ++axis) {
        plan_axis(move, axis, from[axis], to[axis], &times[axis]);
    }
    return WH_OK;
}

wh_status_t wh_move_plan(wh_move_t *move, size_t count, const wh_real_t from[], const wh_real_t to[],
                         const wh_limits_t limits[]) {
    return wh_move_plan_within(move, count, from, to, limits, WH_REAL_LARGEST);
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
