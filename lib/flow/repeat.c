#include "repeat.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "calls.h"
#include "outside.h"

/* The numbers of a robot and of a station that say what it does next. */
#define OF_ROBOT 5
#define OF_STATION 4

/* How often states must come again if a function is asked. */
#define OFTEN 10000

/* The most states that are kept; then they are forgotten. */
#define MOST 10000

static bool is_ahead(const wh_flow_state_t *state, int64_t us) {
    return us < WH_FLOW_FOR_EVER && us > state->now_us;
}

/* True if a robot carries a wafer on, or is about to. */
static bool is_any_under_way(const wh_flow_state_t *state) {
    const wh_flow_robot_state_t *robot = state->robots, *const behind = robot + state->tool->robot_count;
    while (robot < behind && (robot->action == WH_FLOW_IDLE || robot->action == WH_FLOW_MOVING ||
                              robot->action == WH_FLOW_WAITING)) {
        ++robot;
    }
    return robot < behind;
}

static bool is_any_in(const wh_flow_state_t *state, const wh_flow_station_state_t *station) {
    return is_ahead(state, station->done_us) || is_ahead(state, station->clean_us) ||
           is_ahead(state, station->idle_us) || is_ahead(state, station->down_us);
}

/* True if the plan has something to come by its time: a lot, a carrier, a failure, a start. */
static bool is_planned(const wh_flow_state_t *state) {
    const wh_flow_plan_t *plan = state->plan;
    const bool comes =
        state->next.lot < plan->lot_count && is_ahead(state, plan->lots[state->next.lot].arrives_us);
    return comes || is_ahead(state, state->next.start_us) || state->next.down < plan->down_count ||
           is_ahead(state, wh_flow_calls_next(state));
}

/* True if something ends or comes without a robot: a process, a clean, what is planned. */
static bool is_any_to_come(const wh_flow_state_t *state) {
    bool found = false;
    for (size_t i = 0; i < state->tool->station_count && !found; ++i) {
        found = is_any_in(state, &state->stations[i]);
    }
    for (size_t r = 0; r < state->tool->robot_count && !found; ++r) {
        found = is_ahead(state, state->robots[r].held_us);
    }
    return found || wh_flow_is_real_busy(state) || is_planned(state);
}

static int64_t left(const wh_flow_state_t *state, int64_t us) {
    return is_ahead(state, us) ? us - state->now_us : -1;
}

static void write(const wh_flow_state_t *state, int64_t numbers[]) {
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        const wh_flow_robot_state_t *robot = &state->robots[r];
        const int64_t of[OF_ROBOT] = {robot->action, robot->station, left(state, robot->until_us),
                                      robot->mark, state->is_relaxed};
        memcpy(numbers, of, sizeof of);
        numbers += OF_ROBOT;
    }
    for (size_t i = 0; i < state->tool->station_count; ++i) {
        const wh_flow_station_state_t *station = &state->stations[i];
        const int64_t of[OF_STATION] = {station->side,
                                        is_ahead(state, station->pump_us) ? (int64_t)station->pump_to : -1,
                                        left(state, station->pump_us), left(state, station->shut_us)};
        memcpy(numbers, of, sizeof of);
        numbers += OF_STATION;
    }
}

void wh_flow_repeat_anew(wh_flow_repeat_t *repeat) {
    repeat->count = repeat->times = 0;
}

/* True if the state of this instant is among the others; else it is kept, too. */
static bool comes_again(wh_flow_repeat_t *repeat, const wh_flow_state_t *state) {
    repeat->length = OF_ROBOT * state->tool->robot_count + OF_STATION * state->tool->station_count;
    repeat->count = repeat->count < MOST ? repeat->count : 0;
    const size_t bytes = repeat->length * sizeof *repeat->states;
    repeat->states = wh_array_reserve(repeat->states, repeat->count + 1, &repeat->capacity, bytes);
    int64_t *const now = &repeat->states[repeat->count * repeat->length];
    bool found = false;
    write(state, now);
    for (size_t i = 0; i < repeat->count && !found; ++i) {
        found = memcmp(now, &repeat->states[i * repeat->length], bytes) == 0;
    }
    repeat->count += found ? 0 : 1;
    return found;
}

bool wh_flow_repeats(wh_flow_repeat_t *repeat, const wh_flow_state_t *state) {
    repeat->is_anew = is_any_under_way(state) || is_any_to_come(state);
    if (repeat->is_anew) {
        wh_flow_repeat_anew(repeat);
        return false;
    }
    repeat->times += comes_again(repeat, state) ? 1 : 0;
    return repeat->times >= (state->plan->rule == WH_FLOW_OWN ? OFTEN : 1);
}

void wh_flow_repeat_close(wh_flow_repeat_t *repeat) {
    free(repeat->states);
    memset(repeat, 0, sizeof *repeat);
}
