#include "flow.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "engine.h"

/* True if there are several robots, and one of them may exchange. */
static bool has_several_with_two(const wh_flow_tool_t *tool) {
    bool has_two = false;
    for (size_t i = 0; i < tool->robot_count; ++i) {
        has_two = has_two || tool->robots[i].arms > 1;
    }
    return has_two && tool->robot_count > 1;
}

static int by_time(const void *a, const void *b) {
    const int64_t one = *(const int64_t *)a, other = *(const int64_t *)b;
    return one < other ? -1 : one > other ? 1 : 0;
}

/* The times of the last placings of wafers that have gone their ways, dummies left out, in order. */
static int64_t *list_ends(const wh_flow_state_t *state, size_t *count) {
    int64_t *ends_us = wh_array_new(state->plan->wafer_count + 1, sizeof *ends_us);
    *count = 0;
    for (size_t w = 0; w < state->plan->wafer_count; ++w) {
        const wh_flow_wafer_state_t *at = &state->wafers[w];
        if (at->is_over && !at->is_lost && at->step > 0 &&
            !state->plan->lots[state->plan->wafers[w].lot].is_dummy) {
            ends_us[(*count)++] = at->entered_us;
        }
    }
    qsort(ends_us, *count, sizeof *ends_us, by_time);
    return ends_us;
}

/* The fewest wafers whose middle third says anything. */
#define FEWEST 9

static double mean_of(const int64_t ends_us[], size_t count) {
    const size_t first = count / 3, last = count - count / 3 - 1;
    return count < FEWEST ? 0 : (double)(ends_us[last] - ends_us[first]) / (double)(last - first);
}

void wh_flow_engine_result(wh_flow_engine_t *engine, wh_flow_result_t *result) {
    const wh_flow_state_t *state = &engine->state;
    const wh_flow_plan_t *plan = state->plan;
    *result = (wh_flow_result_t){.end = engine->end,
                                 .makespan_us = state->last_us,
                                 .cycle_us = WH_FLOW_NEVER,
                                 .lost = state->failures.wafers,
                                 .skipped = state->calls.skipped,
                                 .left = plan->wafer_count - state->over,
                                 .asked = engine->asked};
    result->may_block =
        state->checks_safety && plan->rule == WH_FLOW_SWAPPING && has_several_with_two(state->tool);
    if (engine->listener.end) {
        engine->listener.end(engine->listener.context, state);
    }
    int64_t *ends_us = list_ends(state, &result->over);
    if (result->end == WH_FLOW_CUT && engine->period > 0) {
        result->is_steady = true;
        result->period = engine->period;
        result->cycle_us = engine->cycle_us;
    } else if (result->end == WH_FLOW_DONE || result->end == WH_FLOW_CUT) {
        result->no_cycle =
            wh_flow_find_cycle(state->tool, plan, ends_us, result->over, &result->period, &result->cycle_us);
    } else {
        result->no_cycle = wh_text_copy("the flow did not go on to its end");
    }
    result->mean_us = mean_of(ends_us, result->over);
    free(ends_us);
    if (result->end == WH_FLOW_STUCK) {
        result->why = wh_flow_stuck_text(state);
    } else if (state->cause) {
        result->why = wh_text_copy(state->cause);
    }
}

void wh_flow_play(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_listener_t *listener,
                  wh_flow_result_t *result) {
    wh_flow_engine_t engine;
    wh_flow_engine_open(&engine, tool, plan, listener, NULL);
    for (int64_t next_us = 0; !engine.is_over;) {
        next_us = wh_flow_engine_step(&engine, next_us);
    }
    wh_flow_engine_result(&engine, result);
    wh_flow_engine_close(&engine);
}

void wh_flow_result_close(wh_flow_result_t *result) {
    free(result->why);
    free(result->no_cycle);
    memset(result, 0, sizeof *result);
}
