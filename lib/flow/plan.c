#include "plan.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "longest.h"

static void close_names(wh_flow_names_t *names) {
    for (size_t i = 0; i < names->count; ++i) {
        free(names->items[i]);
    }
    free(names->items);
}

void wh_flow_plan_close(wh_flow_plan_t *plan, const wh_flow_tool_t *tool) {
    for (size_t i = 0; plan->backs && i < tool->station_count; ++i) {
        free(plan->backs[i].stations);
    }
    free(plan->backs);
    for (size_t i = 0; i < plan->route_count; ++i) {
        wh_flow_route_close(&plan->routes[i]);
    }
    for (size_t i = 0; i < plan->lot_count; ++i) {
        free(plan->lots[i].name);
    }
    for (size_t i = 0; i < plan->wafer_count; ++i) {
        free(plan->wafers[i].name);
    }
    for (size_t i = 0; plan->lists && i < tool->robot_count; ++i) {
        free(plan->lists[i].lines);
    }
    free(plan->routes);
    free(plan->lots);
    free(plan->calls);
    free(plan->wafers);
    free(plan->downs);
    for (size_t i = 0; plan->turns && i < tool->station_count; ++i) {
        free(plan->turns[i].turns);
    }
    free(plan->turns);
    free(plan->lists);
    close_names(&plan->asked);
    memset(plan, 0, sizeof *plan);
}

int32_t wh_flow_recipe_of(const wh_flow_plan_t *plan, int32_t wafer, int32_t step) {
    const int32_t of_step = wh_flow_step_of(plan, wafer, step)->recipe;
    return of_step > 0 ? of_step : plan->wafers[wafer].recipe;
}

bool wh_flow_step_is_served(const wh_flow_tool_t *tool, const wh_flow_step_t *step, int32_t robot) {
    for (size_t i = 0; i < step->station_count; ++i) {
        if (tool->serves[wh_flow_of(tool, robot, step->stations[i])]) {
            return true;
        }
    }
    return false;
}

/* ---------------------------------------------------------------------------------------------- finishing */

__attribute__((format(printf, 1, 2))) static char *problem_of(const char *format, ...) {
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return wh_text_copy(text);
}

/* True if a robot with so many arms carries from this station to one of the step's, from side to side. */
static bool is_carried(const wh_flow_tool_t *tool, int32_t from, const wh_flow_step_t *step, int32_t arms) {
    for (size_t r = 0; r < tool->robot_count; ++r) {
        if (tool->robots[r].arms >= arms && tool->serves[wh_flow_of(tool, (int32_t)r, from)] &&
            wh_flow_step_is_served(tool, step, (int32_t)r)) {
            return true;
        }
    }
    return false;
}

/* Some of its places are not kept empty. */
static char *check_step(const wh_flow_step_t *step, const wh_flow_route_t *route, size_t k,
                        const wh_flow_tool_t *tool) {
    int32_t places = 0;
    for (size_t i = 0; i < step->station_count; ++i) {
        places += tool->stations[step->stations[i]].slots;
    }
    return places > step->kept_empty
               ? NULL
               : problem_of("route %s, step %zu: %d of its %d places are kept empty (expected fewer)",
                            route->name, k, (int)step->kept_empty, (int)places);
}

/* `is_hot`: the second arm alone takes the wafer there. */
static char *check_way(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool, const wh_flow_route_t *route,
                       const wh_flow_step_t *next, size_t k, int32_t from, bool is_hot) {
    if (next->station_count == 1 && next->stations[0] == from && !plan->is_given) {
        return problem_of("route %s: step %zu is %s again (expected another station)", route->name, k,
                          tool->stations[from].name);
    }
    if (is_hot && is_carried(tool, from, next, 1) && !is_carried(tool, from, next, 2)) {
        return problem_of(
            "route %s: no robot with two arms carries a wafer from %s, which is hot, to step %zu, %s",
            route->name, tool->stations[from].name, k, tool->stations[next->stations[0]].name);
    }
    if (!is_carried(tool, from, next, 1)) {
        return problem_of("route %s: no robot carries a wafer from %s to step %zu, %s", route->name,
                          tool->stations[from].name, k, tool->stations[next->stations[0]].name);
    }
    return NULL;
}

static char *check_route(const wh_flow_plan_t *plan, const wh_flow_route_t *route,
                         const wh_flow_tool_t *tool) {
    char *problem = NULL;
    for (size_t k = 1; k < route->step_count && !problem; ++k) {
        problem = check_step(&route->steps[k], route, k, tool);
        const wh_flow_step_t *before = &route->steps[k - 1];
        for (size_t i = 0; k > 1 && i < before->station_count && !problem; ++i) {
            problem =
                check_way(plan, tool, route, &route->steps[k], k, before->stations[i], before->second_arm);
        }
    }
    return problem;
}

/* The wafer goes back by a step of its own, unless its route ends there alone. */
static void find_back(wh_flow_plan_t *plan, const wh_flow_tool_t *tool, int32_t w) {
    wh_flow_wafer_t *wafer = &plan->wafers[w];
    const wh_flow_route_t *route = wh_flow_route_of(plan, w);
    const wh_flow_step_t *last = &route->steps[route->step_count - 1];
    if (wafer->back == WH_FLOW_NONE) {
        return;
    }
    wafer->back_station = tool->place_stations[wafer->back];
    wafer->goes_back = last->station_count != 1 || last->stations[0] != wafer->back_station;
    wh_flow_step_t *step = &plan->backs[wafer->back_station];
    if (step->station_count == 0) {
        *step = (wh_flow_step_t){.stations = wh_array_new(1, sizeof *step->stations),
                                 .station_count = 1,
                                 .process_us = WH_FLOW_NONE};
        step->stations[0] = wafer->back_station;
    }
}

/* True if a station of the wafer's route has times by recipe. */
static bool meets_recipes(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool, int32_t w) {
    bool meets = false;
    for (int32_t k = 1; k <= wh_flow_last_step(plan, w); ++k) {
        const wh_flow_step_t *step = wh_flow_step_of(plan, w, k);
        for (size_t i = 0; i < step->station_count; ++i) {
            meets = meets || tool->stations[step->stations[i]].has_recipes;
        }
    }
    return meets;
}

static char *check_recipe(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool, int32_t w) {
    const int32_t recipe = plan->wafers[w].recipe;
    return recipe == 0 || plan->is_given || meets_recipes(plan, tool, w)
               ? NULL
               : problem_of("%s has the recipe %s, but no station of route %s has times by recipe (expected "
                            "one, or no recipe)",
                            plan->wafers[w].name, tool->recipes.names[recipe - 1],
                            wh_flow_route_of(plan, w)->name);
}

static bool has_axes(const wh_flow_tool_t *tool) {
    bool has_any = false;
    for (size_t r = 0; r < tool->robot_count; ++r) {
        has_any = has_any || tool->robots[r].is_real;
    }
    return has_any;
}

/* The process in a last step. Wafers of a cell with axes may have recipes of their own, which are not known
 * yet: then the longest. */
static int64_t end_us(const wh_flow_tool_t *tool, const wh_flow_step_t *step,
                      const wh_flow_station_t *station, int32_t recipe) {
    int64_t longest_us = wh_flow_step_us(step, station, recipe);
    for (int32_t i = 1; recipe == 0 && has_axes(tool) && i <= tool->recipes.count; ++i) {
        const int64_t us = wh_flow_step_us(step, station, i);
        longest_us = us > longest_us ? us : longest_us;
    }
    return longest_us;
}

/* A process in the last step would begin when the wafer is at its end: it would count nowhere. */
static char *check_end(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool, int32_t w) {
    const int32_t k = wh_flow_last_step(plan, w);
    const wh_flow_step_t *last = wh_flow_step_of(plan, w, k);
    if (last->work != WH_FLOW_WORK_NONE) {
        return problem_of(
            "route %s: in its last step, %d, wafers are aligned or turned over (expected one more step "
            "where they end, or back in the lot)",
            wh_flow_route_of(plan, w)->name, (int)k);
    }
    for (size_t i = 0; i < last->station_count; ++i) {
        const wh_flow_station_t *station = &tool->stations[last->stations[i]];
        const int64_t process_us = end_us(tool, last, station, plan->wafers[w].recipe);
        if (process_us > 0) {
            return problem_of(
                "route %s: its last step, %d, is %s, which processes for %.6g s (expected one more "
                "step where wafers end, back in the lot, or process = 0 in this step)",
                wh_flow_route_of(plan, w)->name, (int)k, station->name, (double)process_us / 1e6);
        }
    }
    return NULL;
}

/* Each wafer can leave its first place, and can get back. */
static char *check_wafer(wh_flow_plan_t *plan, const wh_flow_tool_t *tool, int32_t w) {
    const wh_flow_route_t *route = wh_flow_route_of(plan, w);
    const wh_flow_step_t *last = &route->steps[route->step_count - 1];
    char *problem =
        check_way(plan, tool, route, &route->steps[1], 1, tool->place_stations[plan->wafers[w].home], false);
    find_back(plan, tool, w);
    for (size_t i = 0; plan->wafers[w].goes_back && i < last->station_count && !problem; ++i) {
        problem = check_way(plan, tool, route, &plan->backs[plan->wafers[w].back_station], route->step_count,
                            last->stations[i], last->second_arm);
    }
    problem = problem ? problem : check_recipe(plan, tool, w);
    return problem ? problem : check_end(plan, tool, w);
}

bool wh_flow_is_first_call(const wh_flow_plan_t *plan, const wh_flow_call_t *call) {
    bool is_first = true;
    for (const wh_flow_call_t *before = plan->calls; before < call; ++before) {
        is_first = is_first && before->station != call->station;
    }
    return is_first;
}

/* True if wafers of both lots lie in one place: one carrier cannot bring both. */
static bool do_overlap(const wh_flow_plan_t *plan, const wh_flow_lot_t *a, const wh_flow_lot_t *b) {
    const int32_t first = plan->wafers[a->first_wafer].home, other = plan->wafers[b->first_wafer].home;
    return first < other + (int32_t)b->wafer_count && other < first + (int32_t)a->wafer_count;
}

/* True if a lot that comes by this call comes from the same places. */
static bool is_taken(const wh_flow_plan_t *plan, const wh_flow_lot_t *lot, size_t call) {
    bool is_taken = false;
    for (const wh_flow_lot_t *other = plan->lots; other < lot; ++other) {
        is_taken = is_taken || (other->call == (int32_t)call + 1 && do_overlap(plan, other, lot));
    }
    return is_taken;
}

/* The number, from 1, of the call of another lot by which this one comes, too; 0: there is none. */
static int32_t find_call(const wh_flow_plan_t *plan, const wh_flow_station_t *station, int32_t number,
                         const wh_flow_lot_t *lot) {
    for (size_t i = 0; i < plan->call_count; ++i) {
        const wh_flow_call_t *call = &plan->calls[i];
        const bool is_its =
            station->is_real_port ? call->carrier == lot->carrier : call->arrives_us == lot->arrives_us;
        if (call->station == number && is_its && !is_taken(plan, lot, i)) {
            return (int32_t)i + 1;
        }
    }
    return 0;
}

/* The call of the lot's carrier; a new one is added. 0: its station has no carriers that come and go. */
static int32_t call_of(wh_flow_plan_t *plan, const wh_flow_tool_t *tool, const wh_flow_lot_t *lot) {
    const int32_t number = tool->place_stations[plan->wafers[lot->first_wafer].home];
    const wh_flow_station_t *station = &tool->stations[number];
    if (!station->has_carriers) {
        return 0;
    }
    const int32_t found = find_call(plan, station, number, lot);
    if (found > 0) {
        plan->calls[found - 1].leaves = plan->calls[found - 1].leaves || lot->leaves;
        return found;
    }
    wh_flow_call_t *call = &plan->calls[plan->call_count++];
    *call = (wh_flow_call_t){number, lot->carrier, lot->arrives_us, lot->leaves, false};
    call->is_there = !station->is_real_port && !station->is_absent && lot->arrives_us == 0 &&
                     wh_flow_is_first_call(plan, call);
    return (int32_t)plan->call_count;
}

static void find_calls(wh_flow_plan_t *plan, const wh_flow_tool_t *tool) {
    plan->calls = wh_array_new(plan->lot_count + 1, sizeof *plan->calls);
    for (size_t i = 0; i < plan->lot_count; ++i) {
        plan->lots[i].call = call_of(plan, tool, &plan->lots[i]);
    }
}

/* True if some carrier comes to the station, or is there. */
static bool is_called(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool, int32_t station) {
    const wh_flow_station_t *of = &tool->stations[station];
    bool is_called = !of->has_carriers || of->is_real_port || !of->is_absent;
    for (size_t i = 0; i < plan->call_count; ++i) {
        is_called = is_called || plan->calls[i].station == station;
    }
    return is_called;
}

static char *check_ports(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool) {
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        for (int32_t k = 1; k <= wh_flow_last_step(plan, w); ++k) {
            const wh_flow_step_t *step = wh_flow_step_of(plan, w, k);
            for (size_t i = 0; i < step->station_count; ++i) {
                if (!is_called(plan, tool, step->stations[i])) {
                    return problem_of("%s goes to %s, a load port without a carrier (expected a lot that "
                                      "comes there, or another `port.state` than absent)",
                                      plan->wafers[w].name, tool->stations[step->stations[i]].name);
                }
            }
        }
    }
    return NULL;
}

char *wh_flow_plan_finish(wh_flow_plan_t *plan, const wh_flow_tool_t *tool) {
    plan->step_count = 0;
    plan->backs = wh_array_new(tool->station_count, sizeof *plan->backs);
    for (size_t i = 0; i < plan->route_count; ++i) {
        plan->routes[i].first_step = plan->step_count;
        plan->step_count += plan->routes[i].step_count + 1;
        char *problem = check_route(plan, &plan->routes[i], tool);
        if (problem) {
            return problem;
        }
    }
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        char *problem = check_wafer(plan, tool, w);
        if (problem) {
            return problem;
        }
    }
    find_calls(plan, tool);
    char *problem = check_ports(plan, tool);
    return problem ? problem : wh_flow_check_longest(plan, tool);
}
