#include "rules.h"
#include "transfer.h"

/* A step is waited for if it is full, or if no wafer is still to come into it. */
static bool is_worth_waiting(const wh_flow_state_t *state, const wh_flow_task_t *task) {
    if (task->step == 0 || state->is_relaxed || wh_flow_still_to_come(state, task->route, task->step) == 0) {
        return true;
    }
    const wh_flow_room_t room = wh_flow_room(state, task->route, task->step, -1, WH_FLOW_NONE);
    return room.holds >= room.may;
}

/* The wafer to take out of a step, and its place: the first that entered, but for those for which there is
 * none. */
static int32_t first_of(const wh_flow_state_t *state, int32_t robot, const wh_flow_task_t *task,
                        int32_t *place) {
    const size_t step = state->plan->routes[task->route].first_step + (size_t)task->step;
    for (int32_t wafer = wh_flow_next_in(state, step, WH_FLOW_NONE); wafer != WH_FLOW_NONE;
         wafer = wh_flow_next_in(state, step, wafer)) {
        int64_t there_us = 0;
        if (!wh_flow_may_take(state, robot, wafer)) {
            continue;
        }
        const int64_t begin_us = wh_flow_begin_us(state, robot, wafer, &there_us);
        *place = wh_flow_safe_place(state, robot, wafer, begin_us, WH_FLOW_NONE);
        if (*place != WH_FLOW_NONE) {
            return wafer;
        }
    }
    return WH_FLOW_NONE;
}

bool wh_flow_ask_backward(const wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                          wh_flow_order_t *order) {
    const wh_flow_round_t *round = &rules->rounds[robot];
    for (size_t i = 0; i < round->count; ++i) {
        const size_t at = ((size_t)state->robots[robot].mark + i) % round->count;
        int32_t place = WH_FLOW_NONE;
        const int32_t wafer = is_worth_waiting(state, &round->tasks[at])
                                  ? first_of(state, robot, &round->tasks[at], &place)
                                  : WH_FLOW_NONE;
        if (wafer != WH_FLOW_NONE) {
            *order = (wh_flow_order_t){.what = WH_FLOW_TRANSFER,
                                       .wafer = wafer,
                                       .at = wh_flow_station_of(state, wafer),
                                       .station = WH_FLOW_NONE,
                                       .place = place,
                                       .mark = (int32_t)((at + 1) % round->count)};
            return true;
        }
    }
    return false;
}
