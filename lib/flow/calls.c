#include "calls.h"

bool wh_flow_is_lot_over(const wh_flow_state_t *state, int32_t number) {
    const wh_flow_lot_t *lot = &state->plan->lots[number];
    for (size_t i = lot->first_wafer; i < lot->first_wafer + lot->wafer_count; ++i) {
        if (!state->wafers[i].is_over) {
            return false;
        }
    }
    return true;
}

/* True if the lot's wafers come to the station. */
static bool goes_to(const wh_flow_state_t *state, const wh_flow_lot_t *lot, int32_t station) {
    const int32_t w = (int32_t)lot->first_wafer;
    for (int32_t k = 1; k <= wh_flow_last_step(state->plan, w); ++k) {
        if (wh_flow_step_has(wh_flow_step_of(state->plan, w, k), station)) {
            return true;
        }
    }
    return false;
}

bool wh_flow_is_awaited(const wh_flow_state_t *state, int32_t station) {
    bool is_awaited = false;
    for (size_t i = 0; i < state->plan->lot_count && !is_awaited; ++i) {
        is_awaited = state->calls.has_come[i] && goes_to(state, &state->plan->lots[i], station) &&
                     !wh_flow_is_lot_over(state, (int32_t)i);
    }
    return is_awaited;
}

/* True if a carrier is still to call at the station, or calls there. */
static bool is_to_call(const wh_flow_state_t *state, int32_t station) {
    bool is_to_call = false;
    for (size_t i = 0; i < state->plan->call_count; ++i) {
        is_to_call = is_to_call || state->plan->calls[i].station == station;
    }
    return is_to_call;
}

bool wh_flow_is_for_ends(const wh_flow_state_t *state, int32_t station) {
    const wh_flow_station_t *of = &state->tool->stations[station];
    return of->has_carriers && !of->is_real_port && !is_to_call(state, station);
}

bool wh_flow_is_without_carrier(const wh_flow_state_t *state, int32_t station) {
    const wh_flow_station_t *of = &state->tool->stations[station];
    const wh_flow_station_state_t *at = &state->stations[station];
    if (at->call > 0) {
        return at->real.is_port_shut || state->calls.of[at->call - 1].phase != WH_FLOW_CALL_THERE;
    }
    return of->is_real_port ? at->real.is_port_shut
                            : at->changed_us != WH_FLOW_NEVER || is_to_call(state, station);
}

bool wh_flow_has_called(const wh_flow_state_t *state, size_t lot) {
    const int32_t call = state->plan->lots[lot].call;
    return call == 0 || state->calls.of[call - 1].phase == WH_FLOW_CALL_THERE;
}

/* ------------------------------------------------------------------------------------------------ telling */

static void tell_at(wh_flow_state_t *state, int32_t station, wh_flow_event_kind_t kind, int64_t begin_us) {
    const wh_flow_event_t event = wh_flow_event_of_station(kind, station, begin_us, state->now_us);
    wh_flow_tell(state, &event);
}

static void tell(wh_flow_state_t *state, size_t number, wh_flow_event_kind_t kind) {
    tell_at(state, state->plan->calls[number].station, kind, state->calls.of[number].since_us);
}

static void set_phase(wh_flow_state_t *state, size_t number, wh_flow_call_phase_t phase, int64_t for_us) {
    const bool is_real = state->tool->stations[state->plan->calls[number].station].is_real_port;
    state->calls.of[number] = (wh_flow_call_state_t){
        phase, state->now_us,
        is_real || for_us == WH_FLOW_NEVER ? WH_FLOW_NEVER : wh_flow_slice_us(state, state->now_us + for_us),
        false};
    ++state->changes;
}

/* ------------------------------------------------------------------------------------------------- phases */

/* A carrier that calls with no lot goes before, once no wafer is to end in it. */
static bool is_free(const wh_flow_state_t *state, int32_t station) {
    const wh_flow_station_state_t *at = &state->stations[station];
    return at->call == 0 && !(at->real.has_carrier && wh_flow_is_awaited(state, station));
}

static bool come(wh_flow_state_t *state, size_t number) {
    const wh_flow_call_t *call = &state->plan->calls[number];
    if (call->arrives_us > state->now_us ||
        (call->is_there ? state->stations[call->station].call > 0 : !is_free(state, call->station))) {
        return false;
    }
    state->stations[call->station].call = (int32_t)number + 1;
    set_phase(state, number, call->is_there ? WH_FLOW_CALL_THERE : WH_FLOW_CALL_COMING,
              call->is_there ? WH_FLOW_NEVER : state->tool->stations[call->station].comes_us);
    return true;
}

static bool has_ended(const wh_flow_state_t *state, size_t number) {
    return state->calls.of[number].is_told || state->calls.of[number].until_us <= state->now_us;
}

static bool open(wh_flow_state_t *state, size_t number) {
    if (!has_ended(state, number)) {
        return false;
    }
    tell(state, number, WH_FLOW_EVENT_COMES);
    set_phase(state, number, WH_FLOW_CALL_THERE, WH_FLOW_NEVER);
    return true;
}

/* True if all lots of the call have come and are over. */
static bool are_lots_over(const wh_flow_state_t *state, size_t number) {
    for (size_t i = 0; i < state->plan->lot_count; ++i) {
        if (state->plan->lots[i].call == (int32_t)number + 1 &&
            (!state->calls.has_come[i] || !wh_flow_is_lot_over(state, (int32_t)i))) {
            return false;
        }
    }
    return true;
}

/* True if a later carrier waits for the port. */
static bool is_wanted(const wh_flow_state_t *state, size_t number) {
    bool is_wanted = false;
    for (size_t i = number + 1; i < state->plan->call_count; ++i) {
        is_wanted = is_wanted || (state->plan->calls[i].station == state->plan->calls[number].station &&
                                  state->plan->calls[i].arrives_us <= state->now_us);
    }
    return is_wanted;
}

static bool close(wh_flow_state_t *state, size_t number) {
    const wh_flow_call_t *call = &state->plan->calls[number];
    const bool is_real = state->tool->stations[call->station].is_real_port;
    if ((is_real && !call->leaves && !is_wanted(state, number)) || !are_lots_over(state, number) ||
        wh_flow_is_awaited(state, call->station) || state->stations[call->station].user != WH_FLOW_NONE) {
        return false;
    }
    set_phase(state, number, WH_FLOW_CALL_GOING, state->tool->stations[call->station].goes_us);
    return true;
}

/* The wafers in the carrier leave with it. */
static void take_wafers(wh_flow_state_t *state, int32_t station) {
    const wh_flow_station_t *of = &state->tool->stations[station];
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        wh_flow_place_t *place = &state->places[p];
        if (place->wafer != WH_FLOW_NONE) {
            state->wafers[place->wafer].place = WH_FLOW_NONE;
            place->wafer = WH_FLOW_NONE;
            place->empty_us = state->now_us;
            --state->stations[station].wafers;
        }
    }
}

static bool leave(wh_flow_state_t *state, size_t number) {
    const int32_t station = state->plan->calls[number].station;
    if (!has_ended(state, number)) {
        return false;
    }
    take_wafers(state, station);
    tell(state, number, WH_FLOW_EVENT_GOES);
    set_phase(state, number, WH_FLOW_CALL_GONE, WH_FLOW_NEVER);
    state->stations[station].call = 0;
    return true;
}

static bool go(wh_flow_state_t *state, size_t number) {
    switch (state->calls.of[number].phase) {
    case WH_FLOW_CALL_AWAITED:
        return come(state, number);
    case WH_FLOW_CALL_COMING:
        return open(state, number);
    case WH_FLOW_CALL_THERE:
        return close(state, number);
    case WH_FLOW_CALL_GOING:
        return leave(state, number);
    case WH_FLOW_CALL_GONE:
    default:
        return false;
    }
}

/* ------------------------------------------------------------------------------------------------ changes */

/* True if each of its places has a wafer at its end. */
static bool is_full(const wh_flow_state_t *state, int32_t station) {
    const wh_flow_station_t *of = &state->tool->stations[station];
    bool is_full = state->stations[station].wafers == of->slots &&
                   state->stations[station].user == WH_FLOW_NONE &&
                   state->stations[station].shut_us <= state->now_us;
    for (int32_t p = of->first_place; is_full && p < of->first_place + of->slots; ++p) {
        is_full = state->places[p].wafer != WH_FLOW_NONE && state->wafers[state->places[p].wafer].is_over;
    }
    return is_full;
}

/* A full carrier goes, and an empty one comes. */
static bool change(wh_flow_state_t *state, int32_t station) {
    wh_flow_station_state_t *at = &state->stations[station];
    const wh_flow_station_t *of = &state->tool->stations[station];
    const bool goes_on = at->changed_us != WH_FLOW_NEVER;
    if (wh_flow_is_for_ends(state, station) && !goes_on && is_full(state, station)) {
        at->change_us = state->now_us;
        at->changed_us = wh_flow_slice_us(state, state->now_us + of->goes_us + of->comes_us);
        ++state->changes;
        return true;
    }
    if (!wh_flow_is_for_ends(state, station) || at->changed_us > state->now_us) {
        return false;
    }
    take_wafers(state, station);
    at->changed_us = WH_FLOW_NEVER;
    ++state->changes;
    tell_at(state, station, WH_FLOW_EVENT_COMES, at->change_us);
    return true;
}

bool wh_flow_calls_go(wh_flow_state_t *state) {
    bool went = false;
    for (int32_t s = 0; state->calls.are_there && s < (int32_t)state->tool->station_count; ++s) {
        went = change(state, s) || went;
    }
    for (size_t i = 0; i < state->plan->call_count; ++i) {
        went = go(state, i) || went;
    }
    return went;
}

static int64_t sooner(const wh_flow_state_t *state, int64_t us, int64_t than_us) {
    return us > state->now_us && us < than_us ? us : than_us;
}

int64_t wh_flow_calls_next(const wh_flow_state_t *state) {
    const wh_flow_plan_t *plan = state->plan;
    int64_t next_us = WH_FLOW_NEVER;
    for (size_t s = 0; state->calls.are_there && s < state->tool->station_count; ++s) {
        next_us = sooner(state, state->stations[s].changed_us, next_us);
    }
    for (size_t i = 0; i < plan->call_count; ++i) {
        next_us = sooner(state, state->calls.of[i].until_us, next_us);
        next_us = sooner(state, plan->calls[i].arrives_us, next_us);
    }
    for (size_t i = state->next.lot; plan->call_count > 0 && i < plan->lot_count; ++i) {
        next_us = sooner(state, plan->lots[i].arrives_us, next_us);
    }
    return next_us;
}
