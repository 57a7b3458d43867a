/* first_come and longest_wait: among the transfers that can begin as soon as the robot is there. If none
 * can, the robot goes ahead to the one that can begin soonest; of several, to the one that it would take. */
#include "rules.h"
#include "transfer.h"

typedef struct {
    int32_t wafer, place;
    int64_t begin_us; /* when its pick could begin */
    bool is_ready;    /* as soon as the robot is there */
} candidate_t;

/* At last by the lot's order. */
static bool wins_tie(const wh_flow_state_t *state, int32_t a, int32_t b) {
    const int order = wh_flow_compare(state, a, b);
    return order != 0 ? order < 0 : a < b;
}

static bool is_better(const wh_flow_state_t *state, const candidate_t *a, const candidate_t *b) {
    if (b->wafer == WH_FLOW_NONE || a->is_ready != b->is_ready) {
        return b->wafer == WH_FLOW_NONE || a->is_ready;
    }
    if (!a->is_ready && a->begin_us != b->begin_us) {
        return a->begin_us < b->begin_us;
    }
    if (state->plan->rule == WH_FLOW_FIRST_COME) {
        return a->wafer < b->wafer;
    }
    const int64_t a_us = state->wafers[a->wafer].done_us, b_us = state->wafers[b->wafer].done_us;
    return a_us != b_us ? a_us < b_us : wins_tie(state, a->wafer, b->wafer);
}

static void look_at_step(const wh_flow_state_t *state, int32_t robot, const wh_flow_task_t *task,
                         candidate_t *best) {
    const size_t step = state->plan->routes[task->route].first_step + (size_t)task->step;
    for (int32_t wafer = wh_flow_next_in(state, step, WH_FLOW_NONE); wafer != WH_FLOW_NONE;
         wafer = wh_flow_next_in(state, step, wafer)) {
        if (!wh_flow_may_take(state, robot, wafer)) {
            continue;
        }
        int64_t there_us = 0;
        const int64_t begin_us = wh_flow_begin_us(state, robot, wafer, &there_us);
        candidate_t candidate = {wafer, WH_FLOW_NONE, begin_us, begin_us == there_us};
        if (begin_us != WH_FLOW_NEVER && is_better(state, &candidate, best)) {
            candidate.place = wh_flow_safe_place(state, robot, wafer, begin_us, WH_FLOW_NONE);
            *best = candidate.place != WH_FLOW_NONE ? candidate : *best;
        }
    }
}

bool wh_flow_ask_ready(const wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                       wh_flow_order_t *order) {
    candidate_t best = {WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_NEVER, false};
    for (size_t i = 0; i < rules->rounds[robot].count; ++i) {
        look_at_step(state, robot, &rules->rounds[robot].tasks[i], &best);
    }
    if (best.wafer == WH_FLOW_NONE) {
        return false;
    }
    *order = (wh_flow_order_t){.what = WH_FLOW_TRANSFER,
                               .wafer = best.wafer,
                               .at = wh_flow_station_of(state, best.wafer),
                               .station = WH_FLOW_NONE,
                               .place = best.place};
    return true;
}
