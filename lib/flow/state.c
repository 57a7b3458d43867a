#include "state.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "safe.h"

/* A real station begins its cleans by itself. */
static int64_t idle_of(const wh_flow_station_t *station) {
    return station->is_real ? WH_FLOW_NEVER : station->idle_us;
}

static void open_stations(wh_flow_state_t *state) {
    const wh_flow_tool_t *tool = state->tool;
    state->calls.are_there = state->plan->call_count > 0;
    for (size_t i = 0; i < tool->place_count; ++i) {
        const int64_t idle_us = idle_of(&tool->stations[tool->place_stations[i]]);
        state->places[i] = (wh_flow_place_t){
            WH_FLOW_NONE, WH_FLOW_NONE, -1, WH_FLOW_NEVER, WH_FLOW_NEVER, idle_us, 0, WH_FLOW_NONE, false, 0};
    }
    for (size_t i = 0; i < tool->station_count; ++i) {
        state->stations[i] = (wh_flow_station_state_t){
            .user = WH_FLOW_NONE,
            .clean_us = WH_FLOW_NEVER,
            .idle_us = idle_of(&tool->stations[i]),
            .down_us = WH_FLOW_NEVER,
            .pump_us = WH_FLOW_NEVER,
            .done_us = WH_FLOW_NEVER,
            .changed_us = WH_FLOW_NEVER,
            .side = tool->stations[i].side,
            .real = {.shutter = WH_FLOW_NONE, .work_wafer = WH_FLOW_NONE, .closed_us = -1}};
        state->calls.are_there = state->calls.are_there || tool->stations[i].has_carriers;
        state->ahead.touched[state->ahead.touched_count++] = (int32_t)i;
    }
}

static void find_acting(wh_flow_state_t *state) {
    const wh_flow_tool_t *tool = state->tool;
    for (size_t i = 0; i < tool->station_count; ++i) {
        const bool turns = tool->stations[i].is_lock && !state->stations[i].is_listed;
        if (turns || wh_flow_is_cleaned(&tool->stations[i])) {
            state->ahead.acting[state->ahead.acting_count++] = (int32_t)i;
        }
    }
}

static void open_robots(wh_flow_state_t *state) {
    const wh_flow_plan_t *plan = state->plan;
    for (size_t i = 0; i < state->tool->robot_count; ++i) {
        state->robots[i] = (wh_flow_robot_state_t){.until_us = WH_FLOW_NEVER,
                                                   .station = state->tool->robots[i].at,
                                                   .from = WH_FLOW_NONE,
                                                   .to = WH_FLOW_NONE,
                                                   .possible = WH_FLOW_NONE,
                                                   .kept_out = {WH_FLOW_NONE, 0},
                                                   .arms = {WH_FLOW_NONE, WH_FLOW_NONE}};
        for (size_t k = 0; plan->lists && k < plan->lists[i].count; ++k) {
            if (plan->lists[i].lines[k].what == WH_FLOW_PUMP) {
                state->stations[plan->lists[i].lines[k].to].is_listed = true;
            }
        }
    }
}

void wh_flow_state_open(wh_flow_state_t *state, const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    *state = (wh_flow_state_t){
        .tool = tool,
        .plan = plan,
        .places = wh_array_new(tool->place_count, sizeof *state->places),
        .stations = wh_array_new(tool->station_count, sizeof *state->stations),
        .robots = wh_array_new(tool->robot_count, sizeof *state->robots),
        .wafers = wh_array_new(plan->wafer_count, sizeof *state->wafers),
        .ahead = {.next_us = wh_array_new(tool->station_count, sizeof *state->ahead.next_us),
                  .touched = wh_array_new(tool->station_count, sizeof *state->ahead.touched),
                  .aside = wh_array_new(tool->station_count, sizeof *state->ahead.aside),
                  .acting = wh_array_new(tool->station_count, sizeof *state->ahead.acting)},
        .calls.of = wh_array_new(plan->call_count + 1, sizeof *state->calls.of),
        .calls.has_come = wh_array_new(plan->lot_count + 1, sizeof *state->calls.has_come),
        .counts = wh_array_new(plan->step_count, sizeof *state->counts),
        .leaving = wh_array_new(plan->step_count, sizeof *state->leaving),
        .heads = wh_array_new(plan->step_count, sizeof *state->heads),
        .tails = wh_array_new(plan->step_count, sizeof *state->tails),
        .coming.places = wh_array_new(tool->place_count, sizeof *state->coming.places),
        .safety = wh_flow_safety_open(tool),
    };
    open_stations(state);
    open_robots(state);
    find_acting(state);
    for (size_t i = 0; i < plan->wafer_count; ++i) {
        state->wafers[i] = (wh_flow_wafer_state_t){.place = WH_FLOW_NONE,
                                                   .robot = WH_FLOW_NONE,
                                                   .taker = WH_FLOW_NONE,
                                                   .heading = WH_FLOW_NONE,
                                                   .toward = WH_FLOW_NONE,
                                                   .next = WH_FLOW_NONE,
                                                   .before = WH_FLOW_NONE,
                                                   .done_us = WH_FLOW_NEVER};
    }
    for (size_t i = 0; i < plan->step_count; ++i) {
        state->heads[i] = state->tails[i] = WH_FLOW_NONE;
    }
}

void wh_flow_state_close(wh_flow_state_t *state) {
    free(state->places);
    free(state->stations);
    free(state->robots);
    free(state->wafers);
    free(state->ahead.next_us);
    free(state->ahead.touched);
    free(state->ahead.aside);
    free(state->ahead.acting);
    free(state->calls.of);
    free(state->calls.has_come);
    free(state->counts);
    free(state->leaving);
    free(state->heads);
    free(state->tails);
    free(state->coming.places);
    wh_flow_safety_close(state->safety);
    free(state->cause);
    memset(state, 0, sizeof *state);
}

void wh_flow_note_over(wh_flow_state_t *state) {
    ++state->over;
    ++state->changes;
    while (state->next.wafer < (int32_t)state->plan->wafer_count &&
           state->wafers[state->next.wafer].is_over) {
        ++state->next.wafer;
    }
}

void wh_flow_step_enter(wh_flow_state_t *state, int32_t wafer) {
    wh_flow_wafer_state_t *entering = &state->wafers[wafer];
    const size_t step = wh_flow_step_index(state, wafer, entering->step);
    ++state->changes;
    entering->before = state->tails[step];
    entering->next = WH_FLOW_NONE;
    if (entering->before != WH_FLOW_NONE) {
        state->wafers[entering->before].next = wafer;
    } else {
        state->heads[step] = wafer;
    }
    state->tails[step] = wafer;
}

void wh_flow_step_leave(wh_flow_state_t *state, int32_t wafer) {
    const wh_flow_wafer_state_t *leaving = &state->wafers[wafer];
    const size_t step = wh_flow_step_index(state, wafer, leaving->step);
    ++state->changes;
    if (leaving->before != WH_FLOW_NONE) {
        state->wafers[leaving->before].next = leaving->next;
    } else {
        state->heads[step] = leaving->next;
    }
    if (leaving->next != WH_FLOW_NONE) {
        state->wafers[leaving->next].before = leaving->before;
    } else {
        state->tails[step] = leaving->before;
    }
}

void wh_flow_come(wh_flow_state_t *state, int32_t place, int32_t wafer) {
    const bool came = state->places[place].coming != WH_FLOW_NONE;
    state->places[place].coming = wafer;
    ++state->changes;
    if (!came && wafer != WH_FLOW_NONE) {
        state->coming.places[state->coming.count++] = place;
    }
    for (size_t i = 0; came && wafer == WH_FLOW_NONE && i < state->coming.count; ++i) {
        if (state->coming.places[i] == place) {
            state->coming.places[i] = state->coming.places[--state->coming.count];
            return;
        }
    }
}

/* The last wafer of its lot if both are in their first places, else the wafer itself. A lot enters them as
 * one. */
static int32_t last_of_lot(const wh_flow_state_t *state, int32_t wafer) {
    const wh_flow_lot_t *lot = &state->plan->lots[state->plan->wafers[wafer].lot];
    int32_t last = (int32_t)(lot->first_wafer + lot->wafer_count) - 1;
    while (last > wafer && state->plan->wafers[last].is_skipped) {
        --last;
    }
    const bool are_there = state->wafers[wafer].step == 0 && state->wafers[last].step == 0 &&
                           state->wafers[last].place != WH_FLOW_NONE;
    return are_there && wh_flow_end_of(state->plan, last, 1) == WH_FLOW_NONE ? last : wafer;
}

int32_t wh_flow_next_in(const wh_flow_state_t *state, size_t step, int32_t wafer) {
    const wh_flow_plan_t *plan = state->plan;
    int32_t next = wafer == WH_FLOW_NONE ? state->heads[step] : state->wafers[last_of_lot(state, wafer)].next;
    while (next != WH_FLOW_NONE &&
           (state->wafers[next].is_moving || (wafer != WH_FLOW_NONE && state->wafers[next].step == 0 &&
                                              plan->wafers[next].lot == plan->wafers[wafer].lot &&
                                              wh_flow_end_of(plan, next, 1) == WH_FLOW_NONE))) {
        next = state->wafers[next].next;
    }
    return next;
}

int wh_flow_compare(const wh_flow_state_t *state, int32_t a, int32_t b) {
    const wh_flow_wafer_state_t *one = &state->wafers[a], *other = &state->wafers[b];
    const int32_t priority = wh_flow_priority(state->plan, a), against = wh_flow_priority(state->plan, b);
    if (priority != against) {
        return priority > against ? -1 : 1;
    }
    if (one->step != other->step) {
        return one->step > other->step ? -1 : 1;
    }
    return one->entered_us < other->entered_us ? -1 : one->entered_us > other->entered_us ? 1 : 0;
}

/* Counted one by one: a wafer may leave out steps. */
static int32_t count_to_come(const wh_flow_state_t *state, int32_t route, int32_t step) {
    int32_t sum = 0;
    for (size_t w = 0; w < state->plan->wafer_count; ++w) {
        const wh_flow_wafer_state_t *at = &state->wafers[w];
        const bool has_come = at->place != WH_FLOW_NONE || at->robot != WH_FLOW_NONE;
        const int32_t counts_in = at->toward != WH_FLOW_NONE ? at->toward : at->step;
        if (state->plan->lots[state->plan->wafers[w].lot].route == route && has_come && !at->is_over &&
            counts_in < step) {
            ++sum;
        }
    }
    return sum;
}

int32_t wh_flow_still_to_come(const wh_flow_state_t *state, int32_t route, int32_t step) {
    if (state->failures.stations > 0) {
        return count_to_come(state, route, step);
    }
    const size_t first = state->plan->routes[route].first_step;
    int32_t sum = step > 0 ? -state->leaving[first + (size_t)step - 1] : 0;
    for (int32_t k = 0; k < step; ++k) {
        sum += state->counts[first + (size_t)k];
    }
    return sum;
}

int32_t wh_flow_free_arm(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    const bool second_alone = wh_flow_step_of(state->plan, wafer, state->wafers[wafer].step)->second_arm;
    for (int32_t arm = second_alone ? 1 : 0; arm < state->tool->robots[robot].arms; ++arm) {
        if (state->robots[robot].arms[arm] == WH_FLOW_NONE) {
            return arm;
        }
    }
    return WH_FLOW_NONE;
}

wh_flow_event_t wh_flow_event_of_station(wh_flow_event_kind_t kind, int32_t station, int64_t begin_us,
                                         int64_t end_us) {
    return (wh_flow_event_t){.kind = kind,
                             .begin_us = begin_us,
                             .end_us = end_us,
                             .robot = WH_FLOW_NONE,
                             .wafer = WH_FLOW_NONE,
                             .other = WH_FLOW_NONE,
                             .place = WH_FLOW_NONE,
                             .station = station,
                             .from = WH_FLOW_NONE};
}

void wh_flow_tell(const wh_flow_state_t *state, const wh_flow_event_t *event) {
    if (state->listener.event) {
        state->listener.event(state->listener.context, state, event);
    }
}

void wh_flow_tell_problem(wh_flow_state_t *state, const wh_flow_problem_t *problem) {
    if (state->plan->on_problem && !state->cause) {
        state->cause = state->plan->on_problem(state->plan->own_context, state, problem);
    }
}

wh_flow_event_t wh_flow_event_at(const wh_flow_state_t *state, wh_flow_event_kind_t kind, int32_t wafer,
                                 int64_t begin_us) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    return (wh_flow_event_t){.kind = kind,
                             .begin_us = begin_us,
                             .end_us = state->now_us,
                             .robot = WH_FLOW_NONE,
                             .wafer = wafer,
                             .other = WH_FLOW_NONE,
                             .place = at->place,
                             .station = state->tool->place_stations[at->place],
                             .step = at->step};
}

bool wh_flow_open_stay(const wh_flow_state_t *state, int32_t wafer, wh_flow_event_t *stay) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    if (at->is_over || at->step == 0 || at->place == WH_FLOW_NONE || at->taker != WH_FLOW_NONE ||
        at->done_us - at->clean_us > state->now_us) {
        return false;
    }
    *stay = wh_flow_event_at(state, WH_FLOW_EVENT_STAY, wafer, at->done_us);
    return true;
}

int64_t wh_flow_stay_us(const wh_flow_state_t *state, const wh_flow_event_t *stay) {
    return stay->end_us - stay->begin_us + state->wafers[stay->wafer].clean_us;
}

int64_t wh_flow_over_window_us(const wh_flow_state_t *state, const wh_flow_event_t *stay) {
    const int64_t window_us = state->tool->stations[stay->station].window_us;
    return stay->step == 0 || window_us == WH_FLOW_NEVER ? -1 : wh_flow_stay_us(state, stay) - window_us;
}
