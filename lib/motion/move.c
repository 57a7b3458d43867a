#include "motion/move.h"

static wh_status_t plan_each(wh_move_t *move, const wh_limits_t limits[]) {
    for (size_t axis = 0; axis < move->count; ++axis) {
        const wh_real_t distance = move->to[axis] - move->from[axis];
        const wh_status_t status = wh_profile_plan(&move->profile[axis], distance, &limits[axis]);
        if (status != WH_OK) {
            return status;
        }
        if (wh_profile_duration(&move->profile[axis]) > move->duration) {
            move->duration = wh_profile_duration(&move->profile[axis]);
        }
    }
    return WH_OK;
}

static wh_status_t synchronise(wh_move_t *move) {
    for (size_t axis = 0; axis < move->count; ++axis) {
        const wh_status_t status = wh_profile_stretch(&move->profile[axis], move->duration);
        if (status != WH_OK) {
            return status;
        }
    }
    return WH_OK;
}

static wh_move_t at_rest(size_t count, const wh_real_t from[], const wh_real_t to[]) {
    wh_move_t move = {.count = count};
    for (size_t axis = 0; axis < count; ++axis) {
        move.from[axis] = from[axis];
        move.to[axis] = to[axis];
    }
    return move;
}

wh_status_t wh_move_plan(wh_move_t *move, size_t count, const wh_real_t from[], const wh_real_t to[],
                         const wh_limits_t limits[]) {
    if (move == NULL || from == NULL || to == NULL || limits == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (count == 0 || count > WH_AXES) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_move_t planned = at_rest(count, from, to);
    wh_status_t status = plan_each(&planned, limits);
    if (status == WH_OK) {
        status = synchronise(&planned);
    }
    if (status == WH_OK) {
        *move = planned;
    }
    return status;
}

void wh_move_at(const wh_move_t *move, wh_real_t t, wh_real_t position[]) {
    for (size_t axis = 0; axis < move->count; ++axis) {
        if (t >= move->duration) {
            position[axis] = move->to[axis];
        } else {
            wh_motion_t motion;
            wh_profile_at(&move->profile[axis], t, &motion);
            position[axis] = move->from[axis] + motion.position;
        }
    }
}
