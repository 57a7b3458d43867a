#include "rules.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* Step 0 of a route lies where its lots do. */
static bool serves_home(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, int32_t robot,
                        int32_t route) {
    for (size_t w = 0; w < plan->wafer_count; ++w) {
        const int32_t home = tool->place_stations[plan->wafers[w].home];
        if (plan->lots[plan->wafers[w].lot].route == route && tool->serves[wh_flow_of(tool, robot, home)]) {
            return true;
        }
    }
    return false;
}

/* True if the robot serves the step's stations and those of the next one; behind the last step lie those
 * to which wafers go back. */
static bool empties(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, int32_t robot, int32_t route,
                    int32_t k) {
    const wh_flow_route_t *of = &plan->routes[route];
    const wh_flow_step_t *step = &of->steps[k], *next = step + 1;
    if (k > 0 && !wh_flow_step_is_served(tool, step, robot)) {
        return false;
    }
    if (k == 0 && !serves_home(tool, plan, robot, route)) {
        return false;
    }
    if ((size_t)k + 1 < of->step_count) {
        return wh_flow_step_is_served(tool, next, robot);
    }
    for (size_t w = 0; w < plan->wafer_count; ++w) {
        if (plan->lots[plan->wafers[w].lot].route == route && plan->wafers[w].goes_back &&
            tool->serves[wh_flow_of(tool, robot, plan->wafers[w].back_station)]) {
            return true;
        }
    }
    return false;
}

/* True if a station fails for ever. */
static bool has_endless(const wh_flow_plan_t *plan) {
    bool found = false;
    for (size_t i = 0; i < plan->down_count; ++i) {
        found = found || plan->downs[i].for_us == WH_FLOW_FOR_EVER;
    }
    return found;
}

/* True if a step may be left out, so that the robot empties this one into a later one. */
static bool may_empty(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, int32_t robot, int32_t route,
                      int32_t k) {
    return has_endless(plan) && (k == 0 ? serves_home(tool, plan, robot, route)
                                        : wh_flow_step_is_served(tool, &plan->routes[route].steps[k], robot));
}

static void open_round(wh_flow_round_t *round, const wh_flow_tool_t *tool, const wh_flow_plan_t *plan,
                       int32_t robot) {
    size_t longest = 0;
    for (size_t i = 0; i < plan->route_count; ++i) {
        longest = plan->routes[i].step_count > longest ? plan->routes[i].step_count : longest;
    }
    for (int32_t k = (int32_t)longest - 1; k >= 0; --k) {
        for (int32_t i = 0; i < (int32_t)plan->route_count; ++i) {
            if ((size_t)k >= plan->routes[i].step_count) {
                continue;
            }
            const bool is_direct = empties(tool, plan, robot, i, k);
            if (is_direct || may_empty(tool, plan, robot, i, k)) {
                round->tasks =
                    wh_array_grow(round->tasks, round->count, &round->capacity, sizeof *round->tasks);
                round->tasks[round->count++] = (wh_flow_task_t){i, k, is_direct};
            }
        }
    }
}

/* Marks in `leads` that each station of a step leads to each of the next. */
static void lead(const wh_flow_step_t *step, const wh_flow_step_t *next, size_t count, bool *leads) {
    for (size_t i = 0; i < step->station_count; ++i) {
        for (size_t j = 0; j < next->station_count; ++j) {
            leads[(size_t)step->stations[i] * count + (size_t)next->stations[j]] = true;
        }
    }
}

/* By routes and by ways back. */
static void lead_all(const wh_flow_plan_t *plan, size_t count, bool *leads) {
    for (size_t i = 0; i < plan->route_count; ++i) {
        const wh_flow_route_t *route = &plan->routes[i];
        for (size_t k = 1; k + 1 < route->step_count; ++k) {
            lead(&route->steps[k], &route->steps[k + 1], count, leads);
        }
    }
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        const int32_t last = wh_flow_last_step(plan, w);
        if (plan->wafers[w].goes_back && last > 1) {
            lead(wh_flow_step_of(plan, w, last - 1), wh_flow_step_of(plan, w, last), count, leads);
        }
    }
}

/* True if some station leads back to itself. */
static bool find_circle(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    const size_t count = tool->station_count;
    bool *leads = wh_array_new(count * count, sizeof *leads), found = false;
    lead_all(plan, count, leads);
    for (size_t by = 0; by < count; ++by) {
        for (size_t from = 0; from < count; ++from) {
            for (size_t to = 0; leads[from * count + by] && to < count; ++to) {
                leads[from * count + to] = leads[from * count + to] || leads[by * count + to];
            }
        }
    }
    for (size_t i = 0; i < count; ++i) {
        found = found || leads[i * count + i];
    }
    free(leads);
    return found;
}

void wh_flow_rules_open(wh_flow_rules_t *rules, wh_flow_state_t *state) {
    const wh_flow_tool_t *tool = state->tool;
    const wh_flow_plan_t *plan = state->plan;
    const bool is_shipped = plan->rule != WH_FLOW_LISTS && plan->rule != WH_FLOW_OWN;
    state->checks_safety = plan->is_safe && is_shipped && (has_endless(plan) || find_circle(tool, plan));
    rules->rounds = wh_array_new(tool->robot_count, sizeof *rules->rounds);
    for (size_t i = 0; i < tool->robot_count; ++i) {
        open_round(&rules->rounds[i], tool, plan, (int32_t)i);
    }
}

void wh_flow_rules_close(wh_flow_rules_t *rules, const wh_flow_tool_t *tool) {
    for (size_t i = 0; rules->rounds && i < tool->robot_count; ++i) {
        free(rules->rounds[i].tasks);
    }
    free(rules->rounds);
    memset(rules, 0, sizeof *rules);
}

bool wh_flow_ask(wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                 wh_flow_order_t *order) {
    switch (state->plan->rule) {
    case WH_FLOW_BACKWARD:
        return wh_flow_ask_backward(state, rules, robot, order);
    case WH_FLOW_SWAPPING:
        return state->tool->robots[robot].arms > 1 ? wh_flow_ask_swap(state, rules, robot, order)
                                                   : wh_flow_ask_backward(state, rules, robot, order);
    case WH_FLOW_LISTS:
        return wh_flow_ask_list(state, robot, order);
    case WH_FLOW_OWN:
        return wh_flow_ask_own(state, robot, order);
    case WH_FLOW_FIRST_COME:
    case WH_FLOW_LONGEST_WAIT:
    default:
        return wh_flow_ask_ready(state, rules, robot, order);
    }
}
