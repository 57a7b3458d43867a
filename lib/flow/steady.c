#include "flow.h"

#include <math.h>
#include <stdio.h>

#include "../text/array.h"

/* The longest period that is looked for, in wafers. */
#define LONGEST 24

/* The ends of wafers, in order. Real robots go to slots at different heights: their ends repeat about. */
typedef struct {
    const int64_t *us;
    size_t count;
    bool are_real;
} ends_t;

/* True if the differences over k wafers differ by at most 1 us from the first of the middle third; with real
 * robots by at most a hundredth of it. */
static bool is_steady(const ends_t *ends, size_t begin, size_t end, size_t k) {
    const int64_t first_us = ends->us[begin + k] - ends->us[begin];
    const int64_t most_us = ends->are_real ? first_us / 100 : 1;
    for (size_t i = begin; i + k < end; ++i) {
        const int64_t off_us = ends->us[i + k] - ends->us[i] - first_us;
        if (off_us > most_us || off_us < -most_us) {
            return false;
        }
    }
    return true;
}

/* With real robots the mean over whole periods of the middle third. */
static int64_t measure_cycle(const ends_t *ends, size_t begin, size_t end, size_t k) {
    const size_t periods = ends->are_real ? (end - 1 - begin) / k : 1;
    return (ends->us[begin + periods * k] - ends->us[begin]) / (int64_t)periods;
}

static int32_t find_period(const ends_t *ends, int64_t *cycle_us) {
    const size_t begin = ends->count / 3, end = ends->count - ends->count / 3;
    *cycle_us = WH_FLOW_NEVER;
    for (size_t k = 1; k <= LONGEST && begin + 3 * k < end; ++k) {
        if (is_steady(ends, begin, end, k)) {
            *cycle_us = measure_cycle(ends, begin, end, k);
            return (int32_t)k;
        }
    }
    return 0;
}

/* How long a wafer keeps a place besides its process, at least: it is brought and taken by the quickest. */
static int64_t handled_us(const wh_flow_tool_t *tool, int32_t station) {
    int64_t pick_us = WH_FLOW_NEVER / 2, place_us = WH_FLOW_NEVER / 2, swap_us = WH_FLOW_NEVER;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const size_t of = wh_flow_of(tool, r, station);
        if (tool->serves[of]) {
            pick_us = tool->pick_us[of] < pick_us ? tool->pick_us[of] : pick_us;
            place_us = tool->place_us[of] < place_us ? tool->place_us[of] : place_us;
        }
        if (tool->serves[of] && tool->robots[r].arms > 1 && tool->swap_us[of] < swap_us) {
            swap_us = tool->swap_us[of];
        }
    }
    return pick_us + place_us < swap_us ? pick_us + place_us : swap_us;
}

/* How long a wafer of this recipe and route keeps places of this station alone. */
static int64_t kept_us(const wh_flow_tool_t *tool, const wh_flow_route_t *route, int32_t station,
                       int32_t recipe) {
    int64_t sum_us = 0;
    for (size_t i = 1; i + 1 < route->step_count; ++i) {
        const wh_flow_step_t *step = &route->steps[i];
        if (step->station_count == 1 && step->stations[0] == station) {
            sum_us += wh_flow_step_us(step, &tool->stations[station], recipe) + handled_us(tool, station);
        }
    }
    return sum_us;
}

/* The least of the lot's wafers. */
static double lot_us(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, size_t lot, int32_t station) {
    const wh_flow_lot_t *of = &plan->lots[lot];
    double least_us = HUGE_VAL;
    int32_t before = -1;
    for (size_t w = of->first_wafer; w < of->first_wafer + of->wafer_count; ++w) {
        const int32_t recipe = plan->wafers[w].recipe;
        if (recipe != before) {
            least_us = fmin(least_us, (double)kept_us(tool, &plan->routes[of->route], station, recipe));
        }
        before = recipe;
    }
    return least_us;
}

/* The station that each wafer keeps for longer than one leaves in this cycle, and for how long: routes that
 * come back to a station end in bursts. A step that may go elsewhere does not count. */
static int32_t find_outrun(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, double wafer_us,
                           double *least_us) {
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        *least_us = HUGE_VAL;
        for (size_t l = 0; l < plan->lot_count; ++l) {
            *least_us = fmin(*least_us, lot_us(tool, plan, l, s) / tool->stations[s].slots);
        }
        if (*least_us > wafer_us + 1) {
            return s;
        }
    }
    return WH_FLOW_NONE;
}

/* The least number of wafers among which a period of k is looked for. */
static size_t wafers_for(size_t k) {
    size_t count = 9 * k;
    while (count / 3 + 3 * k >= count - count / 3) {
        ++count;
    }
    return count;
}

/* A period for which there are too few wafers, and which ends show all the same; 0: there is none. */
static size_t find_likely(const ends_t *ends, size_t shortest) {
    const size_t count = ends->count;
    for (size_t k = shortest; k <= LONGEST && count / 3 + 2 * k <= count; ++k) {
        const size_t third = count - count / 3, twice = count / 3 + 2 * k;
        if (is_steady(ends, count / 3, twice > third ? twice : third, k)) {
            return k;
        }
    }
    return 0;
}

/* The period that a tool like this is likely to have: the places of a step that processes, as often as wafers
 * between two cleans of one; up to LONGEST. */
static size_t natural_period(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    size_t longest = 1;
    for (size_t r = 0; r < plan->route_count; ++r) {
        for (size_t k = 1; k < plan->routes[r].step_count; ++k) {
            const wh_flow_step_t *step = &plan->routes[r].steps[k];
            size_t places = 0, wafers = 1;
            for (size_t i = 0; i < step->station_count && k + 1 < plan->routes[r].step_count; ++i) {
                const wh_flow_station_t *station = &tool->stations[step->stations[i]];
                places +=
                    wh_flow_step_us(step, station, plan->wafers[0].recipe) > 0 ? (size_t)station->slots : 0;
                wafers = (size_t)station->clean_after > wafers ? (size_t)station->clean_after : wafers;
            }
            longest = places * wafers > longest ? places * wafers : longest;
        }
    }
    return longest < LONGEST ? longest : LONGEST;
}

static char *tell_no_period(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const ends_t *ends) {
    char text[200];
    size_t shortest = 1;
    while (shortest <= LONGEST && wafers_for(shortest) <= ends->count) {
        ++shortest;
    }
    const size_t likely = find_likely(ends, shortest);
    if (shortest > LONGEST) {
        return wh_text_copy("the wafers' ends do not repeat within their middle third");
    }
    if (likely > 0) {
        (void)snprintf(text, sizeof text,
                       "too few wafers: their ends seem to repeat every %zu, which %zu would show", likely,
                       wafers_for(likely));
    } else {
        const size_t natural = natural_period(tool, plan);
        const size_t next = 2 * shortest < LONGEST ? 2 * shortest : LONGEST;
        const size_t period = natural >= shortest ? natural : next;
        (void)snprintf(text, sizeof text, "too few wafers: %zu would show any that repeats every %s%zu%s",
                       wafers_for(period), period > 1 ? "1 to " : "", period, period > 1 ? "" : " wafer");
    }
    return wh_text_copy(text);
}

char *wh_flow_find_cycle(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const int64_t *ends_us,
                         size_t count, int32_t *period, int64_t *cycle_us) {
    char text[400];
    double least_us;
    const ends_t ends = {ends_us, count, wh_flow_has_real(tool)};
    *period = find_period(&ends, cycle_us);
    if (*period == 0) {
        return tell_no_period(tool, plan, &ends);
    }
    if (*cycle_us <= 0) {
        *period = 0;
        *cycle_us = WH_FLOW_NEVER;
        return wh_text_copy("the wafers of the middle third end at one instant: no rate can be told");
    }
    const double wafer_us = (double)*cycle_us / *period;
    const int32_t station = find_outrun(tool, plan, wafer_us, &least_us);
    if (station == WH_FLOW_NONE) {
        return NULL;
    }
    (void)snprintf(text, sizeof text,
                   "wafers end one in %.10g s within a burst alone, where %.200s takes %.10g s a wafer",
                   wafer_us * 1e-6, tool->stations[station].name, least_us * 1e-6);
    *period = 0;
    *cycle_us = WH_FLOW_NEVER;
    return wh_text_copy(text);
}
