#include "steadily.h"

#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"

/* States of so many wafers' ends are kept; the most wafers of a period. */
#define KEPT 96
#define LONGEST 24

/* Time that is over does not matter, but for how long ago. */
#define OVER (-1)

typedef struct {
    int64_t *numbers;
    size_t count, capacity;
    uint64_t hash;
    size_t ends; /* wafers at their ends by then */
} snapshot_t;

struct wh_flow_steadily {
    bool *is_outer; /* by station: lots begin or end there */
    snapshot_t kept[KEPT];
    size_t next; /* the number of the next one */
};

static void mark_step(bool *is_outer, const wh_flow_step_t *step) {
    for (size_t i = 0; i < step->station_count; ++i) {
        is_outer[step->stations[i]] = true;
    }
}

wh_flow_steadily_t *wh_flow_steadily_open(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    wh_flow_steadily_t *steadily = wh_array_new(1, sizeof *steadily);
    steadily->is_outer = wh_array_new(tool->station_count, sizeof *steadily->is_outer);
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        steadily->is_outer[tool->place_stations[plan->wafers[w].home]] = true;
        mark_step(steadily->is_outer, wh_flow_step_of(plan, w, wh_flow_last_step(plan, w)));
    }
    /* A station through which routes lead is none of them. */
    for (size_t i = 0; i < plan->route_count; ++i) {
        for (size_t k = 1; k + 1 < plan->routes[i].step_count; ++k) {
            const wh_flow_step_t *step = &plan->routes[i].steps[k];
            for (size_t s = 0; s < step->station_count; ++s) {
                steadily->is_outer[step->stations[s]] = false;
            }
        }
    }
    return steadily;
}

void wh_flow_steadily_close(wh_flow_steadily_t *steadily) {
    for (size_t i = 0; steadily && i < KEPT; ++i) {
        free(steadily->kept[i].numbers);
    }
    if (steadily) {
        free(steadily->is_outer);
        free(steadily);
    }
}

/* ------------------------------------------------------------------------------------------------ a state */

static void add(snapshot_t *into, int64_t number) {
    into->numbers = wh_array_grow(into->numbers, into->count, &into->capacity, sizeof *into->numbers);
    into->numbers[into->count++] = number;
    into->hash = wh_hash_word(into->hash, (uint64_t)number);
}

/* A time to come, from now on. */
static void add_ahead(snapshot_t *into, const wh_flow_state_t *state, int64_t us) {
    add(into, us == WH_FLOW_NEVER || us >= WH_FLOW_FOR_EVER ? us
              : us > state->now_us                          ? us - state->now_us
                                                            : OVER);
}

/* A time that rules compare: how long ago. Below 0: it never came. */
static void add_since(snapshot_t *into, const wh_flow_state_t *state, int64_t us) {
    add(into, us == WH_FLOW_NEVER || us < 0 ? us : us - state->now_us);
}

/* Wafers of one lot are alike, but for their steps and recipes. */
static void add_wafer(snapshot_t *into, const wh_flow_state_t *state, int32_t w) {
    if (w == WH_FLOW_NONE) {
        add(into, WH_FLOW_NONE);
        return;
    }
    const wh_flow_wafer_state_t *wafer = &state->wafers[w];
    add(into, (int64_t)state->plan->wafers[w].lot * 1000 + wafer->step);
    add(into, state->plan->wafers[w].recipe);
    add(into,
        (wafer->toward != WH_FLOW_NONE ? 1 : 0) + (wafer->is_moving ? 2 : 0) + (wafer->is_over ? 4 : 0));
    add(into, wafer->taker);
}

static void add_place(snapshot_t *into, const wh_flow_steadily_t *steadily, const wh_flow_state_t *state,
                      int32_t place) {
    const bool is_outer = place == WH_FLOW_NONE || steadily->is_outer[state->tool->place_stations[place]];
    add(into, is_outer ? WH_FLOW_NONE : place);
}

static void add_order(snapshot_t *into, const wh_flow_steadily_t *steadily, const wh_flow_state_t *state,
                      const wh_flow_order_t *order) {
    add(into, order->what);
    add(into, order->at);
    add(into, order->station);
    add(into, order->mark);
    add(into, order->side);
    add_place(into, steadily, state, order->place);
    add_place(into, steadily, state, order->onward);
    add_wafer(into, state, order->wafer);
}

static void add_robot(snapshot_t *into, const wh_flow_steadily_t *steadily, const wh_flow_state_t *state,
                      const wh_flow_robot_state_t *robot) {
    add(into, robot->action);
    add(into, robot->then);
    add(into, robot->station);
    add(into, robot->mark);
    add(into, robot->arm);
    add_ahead(into, state, robot->until_us);
    add_ahead(into, state, robot->held_us);
    add_place(into, steadily, state, robot->from);
    add_place(into, steadily, state, robot->to);
    for (size_t arm = 0; arm < 2; ++arm) {
        add_wafer(into, state, robot->arms[arm]);
        if (robot->arms[arm] != WH_FLOW_NONE) {
            add_since(into, state, robot->kept_us[arm]);
            add_place(into, steadily, state, state->wafers[robot->arms[arm]].heading);
        }
    }
    if (robot->action != WH_FLOW_IDLE) {
        add_order(into, steadily, state, &robot->order);
    }
}

static void add_station(snapshot_t *into, const wh_flow_state_t *state,
                        const wh_flow_station_state_t *station) {
    add(into, station->user);
    add(into, station->side);
    add(into, station->pump_us == WH_FLOW_NEVER ? WH_FLOW_NONE : (int64_t)station->pump_to);
    add(into, station->has_due);
    add_ahead(into, state, station->shut_us);
    add_ahead(into, state, station->busy_us);
    add_ahead(into, state, station->clean_us);
    add_ahead(into, state, station->idle_us);
    add_ahead(into, state, station->down_us);
    add_ahead(into, state, station->pump_us);
    add_ahead(into, state, station->done_us);
}

/* The number of wafers after which a clean is due by any recipe; what is above that decides nothing. */
static int32_t most_before_clean(const wh_flow_station_t *of) {
    int32_t most = of->clean_after;
    for (size_t i = 0; of->has_recipes && i < WH_FLOW_RECIPES; ++i) {
        most = of->by_recipe[i].clean_after > most ? of->by_recipe[i].clean_after : most;
    }
    return most;
}

static void add_place_state(snapshot_t *into, const wh_flow_state_t *state, const wh_flow_station_t *of,
                            const wh_flow_place_t *place) {
    const int32_t most = most_before_clean(of);
    add_wafer(into, state, place->wafer);
    add_wafer(into, state, place->coming);
    add(into, place->is_clean_due);
    add(into, place->since_clean < most ? place->since_clean : most);
    add(into, place->recipe);
    add_ahead(into, state, place->leaving_us);
    add_ahead(into, state, place->clean_us);
    add_ahead(into, state, place->idle_us);
    if (place->wafer == WH_FLOW_NONE) {
        add_since(into, state, place->empty_us);
    } else {
        const wh_flow_wafer_state_t *wafer = &state->wafers[place->wafer];
        add_since(into, state, wafer->done_us);
        add_since(into, state, wafer->entered_us);
        add(into, wafer->clean_us);
    }
}

static void add_stations(snapshot_t *into, const wh_flow_steadily_t *steadily, const wh_flow_state_t *state) {
    for (size_t s = 0; s < state->tool->station_count; ++s) {
        const wh_flow_station_t *of = &state->tool->stations[s];
        add_station(into, state, &state->stations[s]);
        for (int32_t p = of->first_place; !steadily->is_outer[s] && p < of->first_place + of->slots; ++p) {
            add_place_state(into, state, of, &state->places[p]);
        }
    }
}

/* The order in which wafers stand in each step but the first, and whether more are to come. */
static void add_steps(snapshot_t *into, const wh_flow_state_t *state) {
    for (size_t i = 0; i < state->plan->route_count; ++i) {
        const wh_flow_route_t *route = &state->plan->routes[i];
        for (int32_t k = 1; k <= (int32_t)route->step_count; ++k) {
            const size_t step = route->first_step + (size_t)k;
            add(into, wh_flow_still_to_come(state, (int32_t)i, k) > 0);
            add(into, (int64_t)state->counts[step] * 1000 + state->leaving[step]);
            for (int32_t w = state->heads[step]; w != WH_FLOW_NONE; w = state->wafers[w].next) {
                add(into, state->wafers[w].place);
            }
        }
        add(into, state->heads[route->first_step] != WH_FLOW_NONE);
    }
}

static void take(const wh_flow_steadily_t *steadily, const wh_flow_state_t *state, snapshot_t *into) {
    into->count = 0;
    into->hash = WH_HASH_START;
    add(into, state->is_relaxed);
    add_ahead(into, state, state->next.start_us);
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        add_robot(into, steadily, state, &state->robots[r]);
    }
    add_stations(into, steadily, state);
    add_steps(into, state);
}

/* ------------------------------------------------------------------------------------------------ looking */

/* The end of wafer i of a period of k wafers that goes on; `first` is the first of them. */
static int64_t end_of(const int64_t ends_us[], size_t first, size_t k, size_t i) {
    const int64_t period_us = ends_us[first + k] - ends_us[first];
    return ends_us[first + i % k] + (int64_t)(i / k) * period_us;
}

/* The least number of wafers after which the ends of this period repeat; 0: more than LONGEST. */
static int32_t least_period(const int64_t ends_us[], size_t first, size_t k, int64_t *cycle_us) {
    for (size_t least = 1; least <= LONGEST; ++least) {
        bool repeats = true;
        const int64_t way_us = end_of(ends_us, first, k, least) - end_of(ends_us, first, k, 0);
        for (size_t i = 0; i < k && repeats; ++i) {
            const int64_t off_us =
                end_of(ends_us, first, k, i + least) - end_of(ends_us, first, k, i) - way_us;
            repeats = off_us >= -1 && off_us <= 1;
        }
        if (repeats) {
            *cycle_us = way_us;
            return way_us > 0 ? (int32_t)least : 0;
        }
    }
    return 0;
}

static bool is_equal(const snapshot_t *a, const snapshot_t *b) {
    return a->hash == b->hash && a->count == b->count &&
           memcmp(a->numbers, b->numbers, a->count * sizeof *a->numbers) == 0;
}

int32_t wh_flow_steadily_look(wh_flow_steadily_t *steadily, const wh_flow_state_t *state,
                              const int64_t ends_us[], size_t count, int64_t *cycle_us) {
    const wh_flow_plan_t *plan = state->plan;
    if (plan->rule == WH_FLOW_LISTS || plan->rule == WH_FLOW_OWN || state->next.down < plan->down_count ||
        state->next.lot < plan->lot_count) {
        return 0;
    }
    snapshot_t *now = &steadily->kept[steadily->next % KEPT];
    take(steadily, state, now);
    now->ends = count;
    const size_t kept = steadily->next < KEPT - 1 ? steadily->next : KEPT - 1;
    ++steadily->next;
    for (size_t i = 1; i <= kept; ++i) {
        const snapshot_t *before = &steadily->kept[(steadily->next - 1 - i) % KEPT];
        if (before->ends < count && is_equal(before, now)) {
            return least_period(ends_us, before->ends - 1, count - before->ends, cycle_us);
        }
    }
    return 0;
}
