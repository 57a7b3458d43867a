/* Tools and plans for tests, from short texts: "LLA>PM11:60>PM12|PM13:139>LLB" is a route with processes in s. */
#ifndef TESTS_SUPPORT_FLOW_H
#define TESTS_SUPPORT_FLOW_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flow/flow.h"
#include "support/support.h"
#include "text/array.h"

#define FLOW_S 1000000

typedef struct {
    wh_flow_tool_t tool;
    wh_flow_plan_t plan;
} flow_case_t;

/* Stations by name, "LLA*5 LLB*5 PM1"; robots likewise, in the order of their names. */
static inline void flow_open(flow_case_t *flow, const char *robots, const char *stations) {
    char text[2][600], *rest = NULL;
    size_t counts[2] = {0, 0};
    const char *lists[2] = {robots, stations};
    for (int i = 0; i < 2; ++i) {
        (void)snprintf(text[i], sizeof text[i], "%s", lists[i]);
        for (char *name = strtok_r(text[i], " ", &rest); name; name = strtok_r(NULL, " ", &rest)) {
            ++counts[i];
        }
        (void)snprintf(text[i], sizeof text[i], "%s", lists[i]);
    }
    wh_flow_tool_open(&flow->tool, counts[0], counts[1]);
    for (int i = 0; i < 2; ++i) {
        size_t k = 0;
        for (char *name = strtok_r(text[i], " ", &rest); name; name = strtok_r(NULL, " ", &rest), ++k) {
            char *star = strchr(name, '*');
            const int number = star ? atoi(star + 1) : 1;
            if (star) {
                *star = '\0';
            }
            if (i == 0) {
                flow->tool.robots[k].name = wh_text_copy(name);
                flow->tool.robots[k].arms = number;
            } else {
                flow->tool.stations[k].name = wh_text_copy(name);
                flow->tool.stations[k].slots = number;
            }
        }
    }
    wh_flow_tool_number(&flow->tool);
    flow->plan = (wh_flow_plan_t){.until_us = WH_FLOW_NEVER, .is_safe = true};
}

static inline void flow_close(flow_case_t *flow) {
    wh_flow_plan_close(&flow->plan, &flow->tool);
    wh_flow_tool_close(&flow->tool);
}

/* The robot serves these stations, with these times in s, standing at the first. */
static inline void flow_robot(flow_case_t *flow, const char *robot, const char *stations, double pick,
                              double place, double move, double swap) {
    wh_flow_tool_t *tool = &flow->tool;
    const int32_t r = wh_flow_robot_named(tool, robot);
    char text[600], *rest = NULL;
    (void)snprintf(text, sizeof text, "%s", stations);
    bool first = true;
    for (char *name = strtok_r(text, " ", &rest); name; name = strtok_r(NULL, " ", &rest)) {
        const int32_t s = wh_flow_station_named(tool, name);
        if (first) {
            tool->robots[r].at = s;
        }
        first = false;
        tool->serves[wh_flow_of(tool, r, s)] = true;
    }
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        const size_t of = wh_flow_of(tool, r, s);
        tool->pick_us[of] = (int64_t)(pick * FLOW_S + 0.5);
        tool->place_us[of] = (int64_t)(place * FLOW_S + 0.5);
        tool->swap_us[of] = (int64_t)((swap > 0 ? swap : pick + move + place) * FLOW_S + 0.5);
        for (size_t to = 0; to < tool->station_count; ++to) {
            tool->move_us[of * tool->station_count + to] = (int64_t)(move * FLOW_S + 0.5);
        }
    }
}

static inline void flow_step(flow_case_t *flow, wh_flow_step_t *step, char *text) {
    char *process = strchr(text, ':'), *rest = NULL;
    step->process_us = WH_FLOW_NONE;
    if (process) {
        *process = '\0';
        step->process_us = (int64_t)(atof(process + 1) * FLOW_S + 0.5);
    }
    step->stations = wh_array_new(8, sizeof *step->stations);
    for (char *name = strtok_r(text, "|", &rest); name; name = strtok_r(NULL, "|", &rest)) {
        step->stations[step->station_count++] = wh_flow_station_named(&flow->tool, name);
    }
}

/* A route from "LLA>PM1:60>LLB", and a lot of so many wafers in the first station's slots from `slot` on. */
static inline void flow_lot(flow_case_t *flow, const char *route_text, int32_t wafers, int32_t slot,
                            double arrives) {
    wh_flow_plan_t *plan = &flow->plan;
    plan->routes = realloc(plan->routes, (plan->route_count + 1) * sizeof *plan->routes);
    wh_flow_route_t *route = &plan->routes[plan->route_count];
    *route = (wh_flow_route_t){.name = wh_text_copy("A"), .steps = wh_array_new(24, sizeof *route->steps)};
    char text[600], *rest = NULL;
    (void)snprintf(text, sizeof text, "%s", route_text);
    char *home = strtok_r(text, ">", &rest);
    route->step_count = 1;
    for (char *step = strtok_r(NULL, ">", &rest); step; step = strtok_r(NULL, ">", &rest)) {
        flow_step(flow, &route->steps[route->step_count++], step);
    }
    plan->lots = realloc(plan->lots, (plan->lot_count + 1) * sizeof *plan->lots);
    plan->lots[plan->lot_count] = (wh_flow_lot_t){.name = wh_text_copy("lot"),
                                                  .route = (int32_t)plan->route_count++,
                                                  .arrives_us = (int64_t)(arrives * FLOW_S + 0.5),
                                                  .first_wafer = plan->wafer_count,
                                                  .wafer_count = (size_t)wafers};
    plan->wafers = realloc(plan->wafers, (plan->wafer_count + (size_t)wafers) * sizeof *plan->wafers);
    const int32_t first =
        flow->tool.stations[wh_flow_station_named(&flow->tool, home)].first_place + slot - 1;
    for (int32_t i = 0; i < wafers; ++i) {
        char name[16];
        (void)snprintf(name, sizeof name, "W%d", (int)plan->wafer_count + 1);
        plan->wafers[plan->wafer_count++] = (wh_flow_wafer_t){.name = wh_text_copy(name),
                                                              .lot = (int32_t)plan->lot_count,
                                                              .home = first + i,
                                                              .back = WH_FLOW_NONE,
                                                              .back_station = WH_FLOW_NONE};
    }
    ++plan->lot_count;
}

/* Adds a line to a robot's list: "PM1 PM2" a transfer, "PM1 keep" and "keep PM2" by way of an arm. */
static inline void flow_line(flow_case_t *flow, const char *robot, const char *from, const char *to) {
    wh_flow_plan_t *plan = &flow->plan;
    if (!plan->lists) {
        plan->lists = wh_array_new(flow->tool.robot_count, sizeof *plan->lists);
        plan->rule = WH_FLOW_LISTS;
    }
    wh_flow_list_t *list = &plan->lists[wh_flow_robot_named(&flow->tool, robot)];
    list->lines = wh_array_grow(list->lines, list->count, &list->capacity, sizeof *list->lines);
    const bool keeps = strcmp(to, "keep") == 0, brings = strcmp(from, "keep") == 0;
    wh_flow_line_t *line = &list->lines[list->count++];
    *line = WH_FLOW_NO_LINE;
    line->what = keeps ? WH_FLOW_KEEP : brings ? WH_FLOW_BRING : WH_FLOW_TRANSFER;
    line->from = brings ? WH_FLOW_NONE : wh_flow_station_named(&flow->tool, from);
    line->to = keeps ? WH_FLOW_NONE : wh_flow_station_named(&flow->tool, to);
}

static inline void flow_finish(flow_case_t *flow) {
    char *problem = wh_flow_plan_finish(&flow->plan, &flow->tool);
    if (problem) {
        print_message("%s\n", problem);
    }
    assert_null(problem);
}

#endif
