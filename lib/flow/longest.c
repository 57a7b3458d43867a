#include "longest.h"

#include <stdio.h>

#include "../text/array.h"

/* No rule asks for more actions of robots, or pumps of locks, for each wafer in each step. */
#define ACTIONS 100

/* Times of one kind: how often each wafer meets one in each step, and the longest. */
typedef struct {
    const char *name;
    double often;
    int64_t us;
} part_t;

enum { PROCESSES, CLEANS, PUMPS, ACTS, CARRIERS, TAKT, PARTS };

static void take(part_t *part, int64_t us) {
    part->us = us > part->us && us != WH_FLOW_NEVER ? us : part->us;
}

static void take_stations(part_t parts[PARTS], const wh_flow_tool_t *tool) {
    for (size_t s = 0; s < tool->station_count; ++s) {
        const wh_flow_station_t *station = &tool->stations[s];
        take(&parts[PROCESSES], station->process_us);
        for (size_t r = 0; station->has_recipes && r < WH_FLOW_RECIPES; ++r) {
            take(&parts[PROCESSES], station->by_recipe[r].process_us);
        }
        take(&parts[CLEANS], station->clean_us);
        for (size_t side = 0; side < 2; ++side) {
            take(&parts[PUMPS], station->pump_us[side]);
            take(&parts[PUMPS], station->empty_pump_us[side]);
        }
        take(&parts[CARRIERS], station->comes_us);
        take(&parts[CARRIERS], station->goes_us);
    }
}

static void take_robots(part_t *acts, const wh_flow_tool_t *tool) {
    const size_t pairs = tool->robot_count * tool->station_count;
    for (size_t i = 0; i < pairs; ++i) {
        take(acts, tool->pick_us[i]);
        take(acts, tool->place_us[i]);
        take(acts, tool->swap_us[i]);
        take(acts, tool->doors[i].open_us);
        take(acts, tool->doors[i].close_us);
    }
    for (size_t i = 0; i < pairs * tool->station_count; ++i) {
        take(acts, tool->move_us[i]);
    }
}

/* The most steps of a route. */
static size_t take_routes(part_t *processes, const wh_flow_plan_t *plan) {
    size_t most = 0;
    for (size_t r = 0; r < plan->route_count; ++r) {
        const wh_flow_route_t *route = &plan->routes[r];
        most = route->step_count > most ? route->step_count : most;
        for (size_t k = 1; k < route->step_count; ++k) {
            take(processes, route->steps[k].process_us);
        }
    }
    return most;
}

/* Arrivals, and failures that end. */
static double waits_of(const wh_flow_plan_t *plan) {
    double us = 0;
    for (size_t i = 0; i < plan->lot_count; ++i) {
        const double arrives_us = (double)plan->lots[i].arrives_us;
        us = arrives_us > us ? arrives_us : us;
    }
    for (size_t i = 0; i < plan->down_count; ++i) {
        const wh_flow_down_t *down = &plan->downs[i];
        us += (double)down->at_us + (down->for_us == WH_FLOW_FOR_EVER ? 0 : (double)down->for_us);
    }
    return us;
}

static char *tell(const wh_flow_plan_t *plan, size_t steps, const part_t *worst, double us) {
    char text[300];
    (void)snprintf(text, sizeof text,
                   "%s: up to %.10g s (expected times with which the flow ends within %.1e s: with %zu "
                   "wafers in up to %zu steps it could take %.1e s)",
                   worst->name, (double)worst->us / 1e6, (double)WH_FLOW_FOR_EVER / 1e6, plan->wafer_count,
                   steps - 1, us / 1e6);
    return wh_text_copy(text);
}

char *wh_flow_check_longest(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool) {
    part_t parts[PARTS] = {[PROCESSES] = {"process", 1, 0},        [CLEANS] = {"clean", 2, 0},
                           [PUMPS] = {"pump", ACTIONS, 0},         [ACTS] = {"a robot's action", ACTIONS, 0},
                           [CARRIERS] = {"a carrier's way", 1, 0}, [TAKT] = {"takt", 1, plan->takt_us}};
    const part_t *worst = parts;
    take_stations(parts, tool);
    take_robots(&parts[ACTS], tool);
    const size_t steps = take_routes(&parts[PROCESSES], plan);
    double us = waits_of(plan);
    for (size_t i = 0; i < PARTS; ++i) {
        const double part_us = parts[i].often * (double)parts[i].us;
        us += part_us * (double)plan->wafer_count * (double)steps;
        worst = part_us > worst->often * (double)worst->us ? &parts[i] : worst;
    }
    const bool is_cut = plan->until_us != WH_FLOW_NEVER;
    return is_cut || us < (double)WH_FLOW_FOR_EVER ? NULL : tell(plan, steps, worst, us);
}
