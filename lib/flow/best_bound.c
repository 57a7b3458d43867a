/* A time that no schedule which goes on from a node is below. It is the greatest of two kinds of bounds.
 *
 * A wafer's own: from when it is ready, each of its remaining carries takes at least its pick, its least move
 * and its placing, and each process its time.
 *
 * A step's: n wafers are still to come into its stations, which have m places. Let p be the least process of
 * these visits, and r(1) <= r(2) <= ... the earliest instants at which their wafers, alone, could be in it.
 * Between the end of a process in a place and the end of the next placing there lies at least g: a
 * pick and a placing; if one robot with one arm alone serves the station, it must first carry away what it
 * took, and fetch the next. So each place takes its visits at least p + g apart, beginning at r(i) at the
 * earliest. Among all ways to deal n equal visits with release times to m equal machines, dealing them in the
 * order of release, each to the machine that is free first, ends the last one soonest (an exchange of any two
 * visits out of that order delays neither). The last process ends then, and the rest of that wafer's way
 * takes at least the least rest of these visits. Stations that several steps share count their visits
 * together: with the least p and the least rest of all. */
#include <stdlib.h>

#include "best_internal.h"

#define MOST_VISITS 64

static int64_t less(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* The stations of step k; of step 0 the one in `home`. */
static size_t stations_of(const problem_t *problem, int32_t wafer, int32_t k, int32_t *home,
                          const int32_t **stations) {
    if (k > 0) {
        const wh_flow_step_t *step = wh_flow_step_of(problem->plan, wafer, k);
        *stations = step->stations;
        return step->station_count;
    }
    *home = problem->tool->place_stations[problem->plan->wafers[wafer].home];
    *stations = home;
    return 1;
}

static int64_t one_carry_us(const wh_flow_tool_t *tool, int32_t from, int32_t to) {
    int64_t least = WH_FLOW_NEVER;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const size_t a = wh_flow_of(tool, r, from), b = wh_flow_of(tool, r, to);
        if (tool->serves[a] && tool->serves[b]) {
            least = less(least, tool->pick_us[a] + wh_flow_move_us(tool, r, from, to) + tool->place_us[b]);
        }
    }
    return least;
}

int64_t wh_best_carry_us(const problem_t *problem, int32_t wafer, int32_t k) {
    const int32_t *from = NULL, *to = NULL;
    int32_t homes[2];
    const size_t from_count = stations_of(problem, wafer, k, &homes[0], &from);
    const size_t to_count = stations_of(problem, wafer, k + 1, &homes[1], &to);
    int64_t least = WH_FLOW_NEVER;
    for (size_t i = 0; i < from_count; ++i) {
        for (size_t j = 0; j < to_count; ++j) {
            least = less(least, one_carry_us(problem->tool, from[i], to[j]));
        }
    }
    return least;
}

static int64_t least_process_us(const problem_t *problem, int32_t wafer, int32_t k) {
    const wh_flow_step_t *step = wh_flow_step_of(problem->plan, wafer, k);
    int64_t least = WH_FLOW_NEVER;
    for (size_t i = 0; i < step->station_count; ++i) {
        least = less(least, wh_flow_step_us(step, &problem->tool->stations[step->stations[i]],
                                            problem->plan->wafers[wafer].recipe));
    }
    return least;
}

/* The rest of its way once the process of step k is over. */
static int64_t rest_us(const problem_t *problem, int32_t wafer, int32_t k) {
    const int32_t last = wh_flow_last_step(problem->plan, wafer);
    int64_t us = 0;
    for (; k < last; ++k) {
        us += wh_best_carry_us(problem, wafer, k);
        us += k + 1 < last ? least_process_us(problem, wafer, k + 1) : 0;
    }
    return us;
}

/* When the wafer could have been placed in its next step, alone. */
static int64_t next_us(const problem_t *problem, const node_t *node, int32_t w) {
    const int64_t from_us = later(node->ready_us[w], node->now_us);
    int64_t least = WH_FLOW_NEVER;
    if (node->at[w] > OVER) {
        return from_us + wh_best_carry_us(problem, w, node->step[w]);
    }
    const wh_flow_step_t *step = wh_flow_step_of(problem->plan, w, node->step[w] + 1);
    const int32_t robot = -3 - node->at[w];
    for (size_t i = 0; i < step->station_count; ++i) {
        least = less(least, problem->tool->place_us[wh_flow_of(problem->tool, robot, step->stations[i])]);
    }
    return from_us + least;
}

/* The least time between the end of a process in a place and the end of the next placing there. `robot`: the
 * one that alone serves the station, with one arm, or WH_FLOW_NONE. */
static int64_t gap_us(const problem_t *problem, int32_t station, int32_t robot, int32_t wafer, int32_t k) {
    const wh_flow_tool_t *tool = problem->tool;
    const size_t of = wh_flow_of(tool, robot == WH_FLOW_NONE ? 0 : robot, station);
    int64_t pick_us = WH_FLOW_NEVER, place_us = WH_FLOW_NEVER;
    for (int32_t r = 0; r < problem->robots; ++r) {
        if (tool->serves[wh_flow_of(tool, r, station)]) {
            pick_us = less(pick_us, tool->pick_us[wh_flow_of(tool, r, station)]);
            place_us = less(place_us, tool->place_us[wh_flow_of(tool, r, station)]);
        }
    }
    if (robot == WH_FLOW_NONE) {
        return pick_us + place_us;
    }
    const int32_t *before = NULL, *behind = NULL;
    int32_t homes[2];
    int64_t least = WH_FLOW_NEVER;
    const size_t before_count = stations_of(problem, wafer, k - 1, &homes[0], &before);
    const size_t behind_count = stations_of(problem, wafer, k + 1, &homes[1], &behind);
    for (size_t i = 0; i < behind_count; ++i) {
        for (size_t j = 0; j < before_count; ++j) {
            const int32_t to = behind[i], from = before[j];
            least = less(least, wh_flow_move_us(tool, robot, station, to) +
                                    tool->place_us[wh_flow_of(tool, robot, to)] +
                                    wh_flow_move_us(tool, robot, to, from) +
                                    tool->pick_us[wh_flow_of(tool, robot, from)] +
                                    wh_flow_move_us(tool, robot, from, station));
        }
    }
    return tool->pick_us[of] + least + tool->place_us[of];
}

/* The visits of a step's stations that are still to come, and their places. */
typedef struct {
    int64_t release_us[MOST_VISITS];
    size_t count;
    int64_t process_us, rest_us, gap_us; /* the least of all */
    int64_t free_us[WH_BEST_PLACES];     /* when the end of a placing can be */
    size_t place_count;
} visits_t;

/* No other step uses any of its stations: what lies there goes where this step's wafers go. */
static bool is_alone(const problem_t *problem, const wh_flow_step_t *step) {
    size_t uses = 0;
    for (size_t i = 0; i < problem->plan->route_count; ++i) {
        const wh_flow_route_t *route = &problem->plan->routes[i];
        for (size_t k = 1; k < route->step_count; ++k) {
            for (size_t s = 0; s < step->station_count; ++s) {
                uses += wh_flow_step_has(&route->steps[k], step->stations[s]) ? 1 : 0;
            }
        }
    }
    return uses == step->station_count;
}

static bool share_stations(const wh_flow_step_t *a, const wh_flow_step_t *b) {
    bool same = a->station_count == b->station_count;
    for (size_t i = 0; same && i < a->station_count; ++i) {
        same = wh_flow_step_has(b, a->stations[i]);
    }
    return same;
}

static void add_visit(visits_t *visits, int64_t release_us) {
    if (visits->count == MOST_VISITS) {
        return; /* fewer visits take less time */
    }
    size_t at = visits->count++;
    for (; at > 0 && visits->release_us[at - 1] > release_us; --at) {
        visits->release_us[at] = visits->release_us[at - 1];
    }
    visits->release_us[at] = release_us;
}

static void take_gap(const problem_t *problem, const wh_flow_step_t *step, int32_t wafer, int32_t k,
                     visits_t *visits) {
    const bool alone = is_alone(problem, step);
    for (size_t i = 0; i < step->station_count; ++i) {
        const int32_t station = step->stations[i];
        const int32_t robot =
            alone ? problem->carrier[problem->tool->stations[station].first_place] : WH_FLOW_NONE;
        visits->gap_us = less(visits->gap_us, gap_us(problem, station, robot, wafer, k));
    }
}

/* All coming visits to the stations of this step, by any wafer in any step. */
static void find_visits(const problem_t *problem, const node_t *node, const wh_flow_step_t *step,
                        visits_t *visits) {
    for (int32_t w = 0; w < problem->wafers; ++w) {
        const int32_t last = wh_flow_last_step(problem->plan, w);
        int64_t us = node->at[w] == OVER ? 0 : next_us(problem, node, w);
        for (int32_t k = node->step[w] + 1; node->at[w] != OVER && k < last; ++k) {
            if (share_stations(step, wh_flow_step_of(problem->plan, w, k))) {
                add_visit(visits, us);
                visits->process_us = less(visits->process_us, least_process_us(problem, w, k));
                visits->rest_us = less(visits->rest_us, rest_us(problem, w, k));
                take_gap(problem, step, w, k, visits);
            }
            us += least_process_us(problem, w, k) + wh_best_carry_us(problem, w, k);
        }
    }
}

static void find_places(const problem_t *problem, const node_t *node, const wh_flow_step_t *step,
                        visits_t *visits) {
    for (size_t i = 0; i < step->station_count; ++i) {
        const wh_flow_station_t *station = &problem->tool->stations[step->stations[i]];
        for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
            const int32_t w = node->wafer[p];
            visits->free_us[visits->place_count++] =
                w == WH_FLOW_NONE ? node->empty_us[p]
                                  : later(node->ready_us[w], node->now_us) + visits->gap_us;
        }
    }
}

static int64_t step_bound_us(const problem_t *problem, const node_t *node, const wh_flow_step_t *step) {
    visits_t visits = {.process_us = WH_FLOW_NEVER, .rest_us = WH_FLOW_NEVER, .gap_us = WH_FLOW_NEVER};
    int64_t end_us = 0;
    find_visits(problem, node, step, &visits);
    if (visits.count == 0) {
        return 0;
    }
    find_places(problem, node, step, &visits);
    for (size_t i = 0; i < visits.count; ++i) {
        size_t first = 0;
        for (size_t m = 1; m < visits.place_count; ++m) {
            first = visits.free_us[m] < visits.free_us[first] ? m : first;
        }
        const int64_t begin_us = later(visits.free_us[first], visits.release_us[i]);
        end_us = later(end_us, begin_us + visits.process_us);
        visits.free_us[first] = begin_us + visits.process_us + visits.gap_us;
    }
    return end_us + visits.rest_us;
}

void wh_best_bound(const problem_t *problem, node_t *node) {
    node->bound_us = node->now_us;
    node->rest_us = 0;
    for (int32_t w = 0; w < problem->wafers; ++w) {
        const int32_t last = wh_flow_last_step(problem->plan, w);
        const int32_t next = node->step[w] + 1;
        int64_t own_us = node->ready_us[w];
        if (node->at[w] != OVER) {
            own_us = next_us(problem, node, w) +
                     (next < last ? least_process_us(problem, w, next) + rest_us(problem, w, next) : 0);
        }
        node->bound_us = later(node->bound_us, own_us);
        node->rest_us += own_us;
    }
    for (size_t i = 0; i < problem->plan->route_count; ++i) {
        const wh_flow_route_t *route = &problem->plan->routes[i];
        for (size_t k = 1; k + 1 < route->step_count; ++k) {
            node->bound_us = later(node->bound_us, step_bound_us(problem, node, &route->steps[k]));
        }
    }
}
