/* Random tools with lots, failures and rules, as test programs play them: one to three robots in a row, each with
 * modules of its own, with buffers or load locks between two of them. */
#ifndef TESTS_SUPPORT_RANDOM_TOOL_H
#define TESTS_SUPPORT_RANDOM_TOOL_H

#include "support/flow.h"

/* The most robots in a row, and modules of each. */
#define RANDOM_ROBOTS 3
#define RANDOM_MODULES 4

typedef struct {
    flow_case_t flow;
    bool is_round; /* whole seconds: much ends at one instant */
    int32_t robots, modules[RANDOM_ROBOTS];
    bool has_locks, is_one_link; /* a link both ways, else one in and one out */
} random_tool_t;

static inline int64_t random_us(const random_tool_t *random, double least_s, double most_s) {
    return random->is_round ? FLOW_S * (int64_t)wh_test_uniform(least_s, most_s + 1)
                            : 1000 * (int64_t)(1000 * wh_test_uniform(least_s, most_s));
}

static inline bool random_in(uint32_t count) {
    return wh_test_below(count) == 0;
}

/* ------------------------------------------------------------------------------------------------ the tool */

/* "LP*25 OUT*25 P11 P12 L1I L1O ..." */
static inline void random_name_stations(random_tool_t *random, char *text, size_t size) {
    size_t length = (size_t)snprintf(text, size, "LP*%d OUT*25", random_in(4) ? 4 : 25);
    for (int32_t r = 0; r < random->robots; ++r) {
        random->modules[r] = 1 + (int32_t)wh_test_below(RANDOM_MODULES);
        for (int32_t m = 0; m < random->modules[r]; ++m) {
            length += (size_t)snprintf(text + length, size - length, " P%d%d%s", (int)r + 1, (int)m + 1,
                                       random_in(6) ? "*2" : "");
        }
        if (r + 1 < random->robots) {
            const int in = 1 + (int)wh_test_below(3), out = 1 + (int)wh_test_below(2);
            length += (size_t)(random->is_one_link
                                   ? snprintf(text + length, size - length, " L%d*%d", (int)r + 1, in + 1)
                                   : snprintf(text + length, size - length, " L%dI*%d L%dO*%d", (int)r + 1,
                                              in, (int)r + 1, out));
        }
    }
}

static inline void random_serve(random_tool_t *random, int32_t robot, const char *station) {
    wh_flow_tool_t *tool = &random->flow.tool;
    const int32_t s = wh_flow_station_named(tool, station);
    tool->serves[wh_flow_of(tool, robot, s)] = true;
    tool->robots[robot].at =
        random_in(3) || tool->robots[robot].at == WH_FLOW_NONE ? s : tool->robots[robot].at;
}

static inline void random_serve_link(random_tool_t *random, int32_t robot, int32_t link) {
    static const char *const ends[] = {"I", "O"};
    char name[40];
    for (int i = 0; i < (random->is_one_link ? 1 : 2); ++i) {
        (void)snprintf(name, sizeof name, "L%d%s", (int)link + 1, random->is_one_link ? "" : ends[i]);
        random_serve(random, robot, name);
    }
}

/* By station, or the same everywhere. */
static inline void random_times(random_tool_t *random, int32_t robot) {
    wh_flow_tool_t *tool = &random->flow.tool;
    const bool by_station = random_in(3), is_instant = random_in(30);
    const int64_t pick_us = random_us(random, 1, 6), place_us = random_us(random, 1, 6),
                  move_us = is_instant ? 0 : random_us(random, 1, 5), swap_us = random_us(random, 2, 9);
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        const size_t of = wh_flow_of(tool, robot, s);
        tool->pick_us[of] = by_station ? random_us(random, 1, 6) : pick_us;
        tool->place_us[of] = by_station ? random_us(random, 1, 6) : place_us;
        tool->swap_us[of] = by_station ? random_us(random, 2, 9) : swap_us;
        for (size_t to = 0; to < tool->station_count; ++to) {
            tool->move_us[of * tool->station_count + to] = by_station ? random_us(random, 1, 6) : move_us;
        }
    }
}

static inline void random_robot(random_tool_t *random, int32_t robot) {
    random->flow.tool.robots[robot].arms = random_in(2) ? 2 : 1;
    random->flow.tool.robots[robot].at = WH_FLOW_NONE;
    random_times(random, robot);
    for (int32_t m = 0; m < random->modules[robot]; ++m) {
        char name[40];
        (void)snprintf(name, sizeof name, "P%d%d", (int)robot + 1, (int)m + 1);
        random_serve(random, robot, name);
    }
    if (robot == 0) {
        random_serve(random, robot, "LP");
        random_serve(random, robot, "OUT");
    } else {
        random_serve_link(random, robot, robot - 1);
    }
    if (robot + 1 < random->robots) {
        random_serve_link(random, robot, robot);
    }
}

static inline void random_lock(random_tool_t *random, int32_t s) {
    wh_flow_tool_t *tool = &random->flow.tool;
    wh_flow_station_t *station = &tool->stations[s];
    station->is_lock = true;
    station->side = random_in(2) ? WH_FLOW_VACUUM : WH_FLOW_ATMOSPHERE;
    for (int i = 0; i < 2; ++i) {
        station->pump_us[i] = random_us(random, 3, 25);
        station->empty_pump_us[i] = random_in(2) ? station->pump_us[i] : random_us(random, 2, 10);
    }
    tool->sides[wh_flow_of(tool, 0, s)] = WH_FLOW_ATMOSPHERE;
    tool->sides[wh_flow_of(tool, 1, s)] = WH_FLOW_VACUUM;
    if (random->is_one_link && random_in(3)) {
        tool->slot_sides[station->first_place] = WH_FLOW_ATMOSPHERE;
        tool->slot_sides[station->first_place + 1] = WH_FLOW_VACUUM;
    }
}

static inline void random_module(random_tool_t *random, wh_flow_station_t *station) {
    station->process_us = random_in(8) ? 0 : random_us(random, 5, 90);
    station->window_us = random_in(3) ? random_us(random, 0, 20) : WH_FLOW_NEVER;
    if (random_in(3)) {
        station->clean_us = random_us(random, 3, 40);
        station->clean_after = (int32_t)wh_test_below(4);
        station->cleans_full = station->clean_after > 0 && random_in(4);
        station->idle_us = !station->cleans_full && random_in(4) ? random_us(random, 20, 120) : WH_FLOW_NEVER;
    }
}

static inline void random_stations(random_tool_t *random) {
    wh_flow_tool_t *tool = &random->flow.tool;
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        wh_flow_station_t *station = &tool->stations[s];
        const bool is_first_link = station->name[0] == 'L' && station->name[1] == '1';
        station->is_load_port = s < 2 && random_in(2);
        if (station->name[0] == 'P') {
            random_module(random, station);
        } else if (is_first_link && random->has_locks) {
            random_lock(random, s);
        }
        for (int32_t r = 0; s > 1 && random_in(3) && r < (int32_t)tool->robot_count; ++r) {
            tool->doors[wh_flow_of(tool, r, s)] =
                (wh_flow_door_t){random_us(random, 0, 2), random_us(random, 0, 2), false};
        }
    }
}

static inline void random_open(random_tool_t *random) {
    char robots[40] = "", stations[400];
    memset(random, 0, sizeof *random);
    random->is_round = random_in(2);
    random->robots = 1 + (int32_t)wh_test_below(RANDOM_ROBOTS);
    random->has_locks = random_in(2);
    random->is_one_link = random_in(3);
    for (int32_t r = 0; r < random->robots; ++r) {
        (void)snprintf(robots + strlen(robots), sizeof robots - strlen(robots), "%sR%d", r > 0 ? " " : "",
                       (int)r + 1);
    }
    random_name_stations(random, stations, sizeof stations);
    flow_open(&random->flow, robots, stations);
    for (int32_t r = 0; r < random->robots; ++r) {
        random_robot(random, r);
    }
    random_stations(random);
}

/* ---------------------------------------------------------------------------------------------- the routes */

/* One step of parallel modules of the robot, with a process of its own now and then. */
static inline size_t random_step(const random_tool_t *random, int32_t robot, int32_t first, char *text,
                                 size_t size) {
    const int32_t count = random_in(2) ? 1 + (int32_t)wh_test_below((uint32_t)random->modules[robot]) : 1;
    size_t length = 0;
    for (int32_t i = 0; i < count; ++i) {
        length += (size_t)snprintf(text + length, size - length, "%sP%d%d", i > 0 ? "|" : "", (int)robot + 1,
                                   (int)((first + i) % random->modules[robot]) + 1);
    }
    if (random_in(3)) {
        length += (size_t)snprintf(text + length, size - length, ":%d", 5 + (int)wh_test_below(60));
    }
    length += (size_t)snprintf(text + length, size - length, ">");
    return length;
}

static inline size_t random_visit(const random_tool_t *random, int32_t robot, char *text, size_t size) {
    const int32_t steps = (int32_t)wh_test_below(3);
    size_t length = 0;
    int32_t first = (int32_t)wh_test_below((uint32_t)random->modules[robot]);
    for (int32_t k = 0; k < steps; ++k) {
        length += random_step(random, robot, first, text + length, size - length);
        first += 1 + (int32_t)wh_test_below(3);
    }
    return length;
}

/* "LP>P11>L1I>P21|P22>L1O>OUT": inwards to some robot, and back. */
static inline void random_route(const random_tool_t *random, char *text, size_t size) {
    const int32_t depth = (int32_t)wh_test_below((uint32_t)random->robots);
    size_t length = (size_t)snprintf(text, size, "LP>");
    for (int32_t r = 0; r <= depth; ++r) {
        length += random_visit(random, r, text + length, size - length);
        if (r < depth) {
            length += (size_t)snprintf(text + length, size - length, "L%d%s>", (int)r + 1,
                                       random->is_one_link ? "" : "I");
        } else {
            length += random_step(random, r, (int32_t)wh_test_below(9), text + length, size - length);
        }
    }
    for (int32_t r = depth - 1; r >= 0; --r) {
        length += (size_t)snprintf(text + length, size - length, "L%d%s>", (int)r + 1,
                                   random->is_one_link ? "" : "O");
        length += random_in(3) ? random_visit(random, r, text + length, size - length) : 0;
    }
    (void)snprintf(text + length, size - length, "OUT");
}

static inline void random_decorate(random_tool_t *random, wh_flow_route_t *route) {
    for (size_t k = 1; k + 1 < route->step_count; ++k) {
        route->steps[k].kept_empty = route->steps[k].station_count > 1 && random_in(8) ? 1 : 0;
        route->steps[k].second_arm = random_in(40);
    }
    (void)random;
}

/* ------------------------------------------------------------------------------------------------ the plan */

static inline void random_lots(random_tool_t *random) {
    wh_flow_plan_t *plan = &random->flow.plan;
    const int32_t lots = 1 + (int32_t)wh_test_below(3), slots = random->flow.tool.stations[0].slots;
    const bool shares_slots = random_in(4), goes_back = random_in(3);
    int32_t slot = 1;
    double at_s = 0;
    for (int32_t i = 0; i < lots && slot <= slots; ++i) {
        char route[400];
        const int32_t most = slots - slot + 1 < 8 ? slots - slot + 1 : 8;
        const int32_t count = 1 + (int32_t)wh_test_below((uint32_t)most);
        random_route(random, route, sizeof route);
        flow_lot(&random->flow, route, count, slot, at_s);
        random_decorate(random, &plan->routes[plan->route_count - 1]);
        plan->lots[i].priority = (int32_t)wh_test_below(3);
        plan->lots[i].is_dummy = i > 0 && random_in(6);
        for (size_t w = plan->lots[i].first_wafer; goes_back && w < plan->wafer_count; ++w) {
            plan->wafers[w].back = plan->wafers[w].home;
        }
        slot += shares_slots ? 0 : count;
        at_s += random_in(2) ? 0 : (double)random_us(random, 10, 200) / FLOW_S;
    }
}

static inline void random_downs(random_tool_t *random) {
    wh_flow_plan_t *plan = &random->flow.plan;
    const size_t count = random_in(2) ? 0 : 1 + wh_test_below(2);
    int64_t at_us = 0;
    plan->downs = wh_array_new(count + 1, sizeof *plan->downs);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t inner = (uint32_t)random->flow.tool.station_count - 2;
        at_us += random_us(random, 5, 200);
        plan->downs[plan->down_count++] =
            (wh_flow_down_t){2 + (int32_t)wh_test_below(inner), at_us,
                             random_in(3) ? WH_FLOW_FOR_EVER : random_us(random, 10, 200), WH_FLOW_NONE};
    }
}

/* All but lists and functions; false if the plan is refused, as one with two stations alike in succession. */
static inline bool random_plan(random_tool_t *random) {
    static const wh_flow_rule_t rules[] = {WH_FLOW_BACKWARD, WH_FLOW_SWAPPING, WH_FLOW_FIRST_COME,
                                           WH_FLOW_LONGEST_WAIT};
    wh_flow_plan_t *plan = &random->flow.plan;
    random_lots(random);
    random_downs(random);
    plan->rule = rules[wh_test_below(4)];
    plan->takt_us = random_in(5) ? random_us(random, 5, 40) : 0;
    plan->until_us = random_in(12) ? random_us(random, 50, 400) : WH_FLOW_NEVER;
    plan->is_safe = !random_in(5);
    char *problem = wh_flow_plan_finish(plan, &random->flow.tool);
    const bool is_good = !problem;
    free(problem);
    return is_good;
}

/* ----------------------------------------------------------------------------------------- what was drawn */

static inline void random_tell_route(const wh_flow_tool_t *tool, const wh_flow_route_t *route) {
    for (size_t k = 1; k < route->step_count; ++k) {
        print_message(" > ");
        for (size_t i = 0; i < route->steps[k].station_count; ++i) {
            print_message("%s%s", i > 0 ? "|" : "", tool->stations[route->steps[k].stations[i]].name);
        }
        print_message("%s", route->steps[k].kept_empty > 0 ? " (one stays empty)" : "");
    }
    print_message("\n");
}

static inline void random_tell(const flow_case_t *flow) {
    const wh_flow_tool_t *tool = &flow->tool;
    const wh_flow_plan_t *plan = &flow->plan;
    print_message("rule %d, safe %d, takt %lld us\n", (int)plan->rule, plan->is_safe,
                  (long long)plan->takt_us);
    for (size_t r = 0; r < tool->robot_count; ++r) {
        print_message("%s has %d arms, begins at %s\n", tool->robots[r].name, (int)tool->robots[r].arms,
                      tool->stations[tool->robots[r].at].name);
    }
    for (size_t s = 0; s < tool->station_count; ++s) {
        const wh_flow_station_t *of = &tool->stations[s];
        print_message("%s: %d slots, process %lld us, clean after %d for %lld us%s%s\n", of->name,
                      (int)of->slots, (long long)of->process_us, (int)of->clean_after,
                      (long long)of->clean_us, of->cleans_full ? " around it" : "",
                      of->is_lock ? ", a lock" : "");
    }
    for (size_t l = 0; l < plan->lot_count; ++l) {
        print_message("%zu wafers from %lld us on%s", plan->lots[l].wafer_count,
                      (long long)plan->lots[l].arrives_us,
                      plan->wafers[plan->lots[l].first_wafer].goes_back ? ", and back" : "");
        random_tell_route(tool, &plan->routes[plan->lots[l].route]);
    }
    for (size_t i = 0; i < plan->down_count; ++i) {
        print_message("%s is down at %lld us for %lld us\n", tool->stations[plan->downs[i].station].name,
                      (long long)plan->downs[i].at_us, (long long)plan->downs[i].for_us);
    }
}

#endif
