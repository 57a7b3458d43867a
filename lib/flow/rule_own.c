/* A rule of the user's: its answers are lines as lists have them, in order of preference. */
#include <stdio.h>

#include "../text/array.h"
#include "rules.h"
#include "transfer.h"

static const char *name_of(const wh_flow_state_t *state, int32_t station) {
    return station == WH_FLOW_NONE ? "keep" : state->tool->stations[station].name;
}

static bool refuse(wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line, const char *why) {
    char text[400];
    const bool is_named = line->wafer != WH_FLOW_NONE;
    (void)snprintf(text, sizeof text, "rule for %s: { %s, %s%s%s }: %s", state->tool->robots[robot].name,
                   name_of(state, line->from), name_of(state, line->to), is_named ? ", " : "",
                   is_named ? state->plan->wafers[line->wafer].name : "", why);
    state->cause = wh_text_copy(text);
    return false;
}

static bool is_served(const wh_flow_tool_t *tool, int32_t robot, int32_t station) {
    return station == WH_FLOW_NONE || tool->serves[wh_flow_of(tool, robot, station)];
}

/* True if it can begin as soon as the robot is there. */
static bool can_begin(const wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    if (order->what == WH_FLOW_BRING) {
        const wh_flow_target_t target =
            wh_flow_target(state, robot, order->wafer, state->robots[robot].station, 0, order->station);
        return target.place != WH_FLOW_NONE && state->places[target.place].wafer == WH_FLOW_NONE;
    }
    if (order->wafer == WH_FLOW_NONE || !wh_flow_may_take(state, robot, order->wafer)) {
        return false;
    }
    int64_t there_us = 0;
    const int64_t begin_us = wh_flow_begin_us(state, robot, order->wafer, &there_us);
    return begin_us == there_us &&
           (order->what == WH_FLOW_KEEP ||
            wh_flow_safe_place(state, robot, order->wafer, begin_us, order->station) != WH_FLOW_NONE);
}

bool wh_flow_ask_own(wh_flow_state_t *state, int32_t robot, wh_flow_order_t *order) {
    wh_flow_line_t lines[WH_FLOW_ANSWERS];
    wh_flow_order_t orders[WH_FLOW_ANSWERS];
    const int count = state->plan->own(state->plan->own_context, state, robot, lines, &state->cause);
    for (int i = 0; i < count; ++i) {
        const bool is_its =
            is_served(state->tool, robot, lines[i].from) && is_served(state->tool, robot, lines[i].to);
        const char *why = is_its ? wh_flow_order_line(state, robot, &lines[i], false, &orders[i])
                                 : "the robot does not serve that station";
        if (why) {
            return refuse(state, robot, &lines[i], why);
        }
    }
    if (count < 0 && !state->cause) {
        state->cause = wh_text_copy("the rule failed");
    }
    if (count <= 0) {
        return false;
    }
    *order = orders[0];
    for (int i = 0; i < count; ++i) {
        if (can_begin(state, robot, &orders[i])) {
            *order = orders[i];
            return true;
        }
    }
    return true;
}
