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

void wh_flow_engine_result(wh_flow_engine_t *engine, wh_flow_result_t *result) {
    const wh_flow_state_t *state = &engine->state;
    const wh_flow_plan_t *plan = state->plan;
    *result = (wh_flow_result_t){.end = engine->end,
                                 .makespan_us = state->last_us,
                                 .cycle_us = WH_FLOW_NEVER,
                                 .over = engine->count,
                                 .left = plan->wafer_count - state->over,
                                 .asked = engine->asked};
    result->may_block =
        state->checks_safety && plan->rule == WH_FLOW_SWAPPING && has_several_with_two(state->tool);
    if (engine->listener.end) {
        engine->listener.end(engine->listener.context, state);
    }
    if (result->end == WH_FLOW_CUT && engine->period > 0) {
        result->is_steady = true;
        result->period = engine->period;
        result->cycle_us = engine->cycle_us;
    } else if (result->end == WH_FLOW_DONE || result->end == WH_FLOW_CUT) {
        result->no_cycle = wh_flow_find_cycle(state->tool, plan, engine->ends_us, engine->count,
                                              &result->period, &result->cycle_us);
    } else {
        result->no_cycle = wh_text_copy("the flow did not go on to its end");
    }
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
