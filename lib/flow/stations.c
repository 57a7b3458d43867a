#include "stations.h"

#include "calls.h"
#include "failed.h"
#include "held.h"
#include "locks.h"
#include "outside.h"
#include "transfer.h"

/* Told for a station alone, up to now. */
static void tell(const wh_flow_state_t *state, wh_flow_event_kind_t kind, int32_t station, int64_t begin_us) {
    wh_flow_event_t event = wh_flow_event_of_station(kind, station, begin_us, state->now_us);
    event.side = state->stations[station].side;
    wh_flow_tell(state, &event);
}

static void end_wafer(wh_flow_state_t *state, int32_t wafer) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    at->is_over = true;
    at->done_us = WH_FLOW_NEVER;
    wh_flow_step_leave(state, wafer);
    --state->counts[wh_flow_step_index(state, wafer, at->step)];
    wh_flow_note_over(state);
}

static bool is_last(const wh_flow_state_t *state, int32_t wafer) {
    return wh_flow_following(state, wafer, state->wafers[wafer].step, state->wafers[wafer].place) ==
           WH_FLOW_NONE;
}

/* Notes the next clean in a station's places. */
static void plan_cleans(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_t *of = &state->tool->stations[number];
    wh_flow_station_state_t *station = &state->stations[number];
    wh_flow_touch(state, number);
    station->clean_us = station->idle_us = WH_FLOW_NEVER;
    station->has_due = false;
    for (int32_t place = of->first_place; place < of->first_place + of->slots; ++place) {
        const wh_flow_place_t *at = &state->places[place];
        station->clean_us = at->clean_us < station->clean_us ? at->clean_us : station->clean_us;
        station->idle_us = at->idle_us < station->idle_us ? at->idle_us : station->idle_us;
        station->has_due = station->has_due || at->is_clean_due;
    }
}

static void plan_own_cleans(wh_flow_state_t *state, int32_t number) {
    if (wh_flow_is_cleaned(&state->tool->stations[number])) {
        plan_cleans(state, number);
    }
}

void wh_flow_station_entered(wh_flow_state_t *state, int32_t wafer) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int32_t number = state->tool->place_stations[at->place];
    wh_flow_station_state_t *station = &state->stations[number];
    ++station->wafers;
    state->places[at->place].idle_us = WH_FLOW_NEVER;
    state->places[at->place].recipe = wh_flow_recipe_of(state->plan, wafer, at->step);
    if (is_last(state, wafer)) {
        end_wafer(state, wafer);
        return;
    }
    if (wh_flow_begin_real(state, wafer, number)) {
        return;
    }
    const int64_t for_us = wh_flow_process_us(state, wafer, number);
    const wh_flow_station_t *of = &state->tool->stations[number];
    at->process_us = for_us;
    at->clean_us = of->cleans_full && wh_flow_is_clean_next(state, at->place) ? of->clean_us : 0;
    const int64_t lasts_us = for_us + at->clean_us;
    const int64_t begin_us = station->down_us != WH_FLOW_NEVER && station->down_us > station->shut_us
                                 ? station->down_us
                                 : station->shut_us;
    at->done_us = lasts_us == 0 ? station->shut_us : begin_us + lasts_us;
    plan_own_cleans(state, number);
    if (lasts_us > 0 && at->done_us < station->done_us) {
        wh_flow_touch(state, number);
        station->done_us = at->done_us;
    }
}

void wh_flow_station_left(wh_flow_state_t *state, int32_t number) {
    const int32_t station = state->tool->place_stations[number];
    const wh_flow_station_t *of = &state->tool->stations[station];
    wh_flow_place_t *place = &state->places[number];
    --state->stations[station].wafers;
    if (of->is_real) {
        return;
    }
    const bool is_due = wh_flow_is_clean_next(state, number);
    ++place->since_clean;
    if (wh_flow_is_cleaned(of)) {
        place->is_clean_due = is_due && !of->cleans_full;
        place->since_clean = is_due && of->cleans_full ? 0 : place->since_clean;
        const int64_t idle_us = wh_flow_treatment(of, place->recipe).idle_us;
        place->idle_us = idle_us == WH_FLOW_NEVER ? WH_FLOW_NEVER : state->now_us + idle_us;
        plan_cleans(state, station);
    }
}

/* --------------------------------------------------------------------------------------------------- ends */

/* A process ends before the clean around its wafer. */
static void tell_process(const wh_flow_state_t *state, int32_t wafer, int32_t station) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int64_t end_us = at->done_us - at->clean_us;
    wh_flow_event_t event =
        wh_flow_event_of_station(WH_FLOW_EVENT_PROCESS, station, end_us - at->process_us, end_us);
    event.wafer = wafer;
    event.place = at->place;
    event.step = at->step;
    wh_flow_tell(state, &event);
}

static void tell_clean(const wh_flow_state_t *state, int32_t place, int32_t wafer, int64_t for_us) {
    wh_flow_event_t event = wh_flow_event_of_station(WH_FLOW_EVENT_CLEAN, state->tool->place_stations[place],
                                                     state->now_us - for_us, state->now_us);
    event.wafer = wafer;
    event.place = place;
    wh_flow_tell(state, &event);
}

static void end_processes(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_t *of = &state->tool->stations[number];
    wh_flow_station_state_t *station = &state->stations[number];
    station->done_us = WH_FLOW_NEVER;
    for (int32_t place = of->first_place; place < of->first_place + of->slots; ++place) {
        const int32_t wafer = state->places[place].wafer;
        if (wafer == WH_FLOW_NONE || state->wafers[wafer].is_over) {
            continue;
        }
        const int64_t done_us = state->wafers[wafer].done_us;
        if (done_us == state->now_us) {
            tell_process(state, wafer, number);
            if (state->wafers[wafer].clean_us > 0) {
                tell_clean(state, place, wafer, state->wafers[wafer].clean_us);
            }
        } else if (done_us > state->now_us && done_us < station->done_us) {
            station->done_us = done_us;
        }
    }
}

static void end_cleans(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_t *of = &state->tool->stations[number];
    for (int32_t i = of->first_place; i < of->first_place + of->slots; ++i) {
        wh_flow_place_t *place = &state->places[i];
        if (place->clean_us == state->now_us) {
            place->clean_us = WH_FLOW_NEVER;
            place->since_clean = 0;
            place->is_clean_due = false;
            tell_clean(state, i, WH_FLOW_NONE, of->clean_us);
        }
    }
    plan_cleans(state, number);
}

static void end_doings(wh_flow_state_t *state, int32_t number) {
    wh_flow_station_state_t *station = &state->stations[number];
    if (station->done_us == state->now_us) {
        end_processes(state, number);
    }
    if (station->clean_us == state->now_us) {
        end_cleans(state, number);
    }
    if (station->pump_us == state->now_us) {
        station->side = station->pump_to;
        station->pump_us = WH_FLOW_NEVER;
        tell(state, WH_FLOW_EVENT_PUMP, number, station->pump_began_us);
    }
}

/* Something of the station ends now, or its times have changed. */
static void end_station(wh_flow_state_t *state, int32_t number) {
    wh_flow_station_state_t *station = &state->stations[number];
    wh_flow_touch(state, number);
    if (!state->tool->stations[number].is_real) {
        end_doings(state, number);
    }
    if (station->down_us == state->now_us) {
        station->down_us = WH_FLOW_NEVER;
        tell(state, WH_FLOW_EVENT_DOWN, number, station->down_began_us);
        wh_flow_set_down(state, number, false);
    }
}

void wh_flow_stations_end(wh_flow_state_t *state) {
    const wh_flow_ahead_t *ahead = &state->ahead;
    const int32_t count = (int32_t)state->tool->station_count;
    if (ahead->touched_count == 0 && ahead->soonest_us > state->now_us) {
        return;
    }
    for (int32_t i = 0; i < count; ++i) {
        if (ahead->next_us[i] <= state->now_us) {
            end_station(state, i);
        }
    }
}

/* --------------------------------------------------------------------------------------------- beginnings */

static void begin_cleans(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_t *of = &state->tool->stations[number];
    for (int32_t i = of->first_place; i < of->first_place + of->slots; ++i) {
        wh_flow_place_t *place = &state->places[i];
        if ((place->is_clean_due || place->idle_us <= state->now_us) && place->wafer == WH_FLOW_NONE &&
            place->clean_us == WH_FLOW_NEVER && state->stations[number].down_us == WH_FLOW_NEVER &&
            state->stations[number].shut_us <= state->now_us) {
            place->clean_us = state->now_us + of->clean_us;
            place->is_clean_due = false;
            place->idle_us = WH_FLOW_NEVER;
        }
    }
    plan_cleans(state, number);
}

/* Nobody takes it: it is over where it lies. */
static void skip(wh_flow_state_t *state, wh_flow_wafer_state_t *wafer) {
    wafer->is_over = true;
    wafer->done_us = WH_FLOW_NEVER;
    ++state->calls.skipped;
    wh_flow_note_over(state);
}

static void arrive(wh_flow_state_t *state, const wh_flow_lot_t *lot) {
    for (size_t i = lot->first_wafer; i < lot->first_wafer + lot->wafer_count; ++i) {
        wh_flow_wafer_state_t *wafer = &state->wafers[i];
        wafer->place = state->plan->wafers[i].home;
        wafer->entered_us = wafer->done_us = state->now_us;
        wh_flow_stir(state, state->tool->place_stations[wafer->place]);
        state->places[wafer->place].wafer = (int32_t)i;
        state->places[wafer->place].recipe = state->plan->wafers[i].recipe;
        ++state->stations[state->tool->place_stations[wafer->place]].wafers;
        if (state->plan->wafers[i].is_skipped) {
            skip(state, wafer);
            continue;
        }
        ++state->counts[wh_flow_step_index(state, (int32_t)i, 0)];
        wh_flow_step_enter(state, (int32_t)i);
        if (state->plan->wafers[i].back != WH_FLOW_NONE) {
            state->places[state->plan->wafers[i].back].owner = state->plan->wafers[i].lot;
        }
    }
}

/* True if a wafer of a lot that is not over ends in this place. */
static bool is_owned(const wh_flow_state_t *state, int32_t place) {
    const int32_t owner = place == WH_FLOW_NONE ? WH_FLOW_NONE : state->places[place].owner;
    return owner != WH_FLOW_NONE && !wh_flow_is_lot_over(state, owner);
}

/* Wafers of lots that are over leave the load ports where a lot arrives. False if others lie there, come, or
 * will come back there, or to where this lot's wafers end. */
static bool make_room(wh_flow_state_t *state, const wh_flow_lot_t *lot) {
    for (size_t i = lot->first_wafer; i < lot->first_wafer + lot->wafer_count; ++i) {
        const wh_flow_place_t *place = &state->places[state->plan->wafers[i].home];
        if (place->coming != WH_FLOW_NONE || is_owned(state, state->plan->wafers[i].home) ||
            is_owned(state, state->plan->wafers[i].back) ||
            (place->wafer != WH_FLOW_NONE &&
             !wh_flow_is_lot_over(state, state->plan->wafers[place->wafer].lot))) {
            return false;
        }
    }
    for (size_t i = lot->first_wafer; i < lot->first_wafer + lot->wafer_count; ++i) {
        const int32_t place = state->plan->wafers[i].home, wafer = state->places[place].wafer;
        if (wafer != WH_FLOW_NONE) {
            wh_flow_stir(state, state->tool->place_stations[place]);
            state->places[place].wafer = WH_FLOW_NONE;
            state->wafers[wafer].place = WH_FLOW_NONE;
            --state->stations[state->tool->place_stations[place]].wafers;
        }
    }
    return true;
}

/* True if the lot comes now. */
static bool begin_lot(wh_flow_state_t *state, size_t number) {
    const wh_flow_lot_t *lot = &state->plan->lots[number];
    if (state->calls.has_come[number] || !wh_flow_has_called(state, number) || !make_room(state, lot)) {
        return false;
    }
    state->calls.has_come[number] = true;
    arrive(state, lot);
    wh_flow_end_routes(state);
    return true;
}

/* Lots come in their order, as far as their places are free; one whose carrier is not there yet keeps back
 * those alone that come with it. True if any came. */
static bool begin_lots(wh_flow_state_t *state) {
    const wh_flow_plan_t *plan = state->plan;
    bool is_held = false, came = false;
    for (size_t i = state->next.lot; i < plan->lot_count && plan->lots[i].arrives_us <= state->now_us; ++i) {
        const wh_flow_lot_t *lot = &plan->lots[i];
        came = ((lot->call > 0 || !is_held) && begin_lot(state, i)) || came;
        is_held = is_held || (lot->call == 0 && !state->calls.has_come[i]);
    }
    while (state->next.lot < plan->lot_count && state->calls.has_come[state->next.lot]) {
        ++state->next.lot;
    }
    return came;
}

/* A process that would begin from now on begins when the failure is over. */
static void put_off(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_t *of = &state->tool->stations[number];
    wh_flow_station_state_t *station = &state->stations[number];
    wh_flow_touch(state, number);
    station->done_us = WH_FLOW_NEVER;
    for (int32_t place = of->first_place; place < of->first_place + of->slots; ++place) {
        const int32_t number_there = state->places[place].wafer;
        if (number_there == WH_FLOW_NONE || state->wafers[number_there].is_over) {
            continue;
        }
        wh_flow_wafer_state_t *wafer = &state->wafers[number_there];
        const int64_t lasts_us = wh_flow_process_us(state, number_there, number) + wafer->clean_us;
        if (lasts_us > 0 && wafer->done_us - lasts_us >= state->now_us) {
            wafer->done_us = station->down_us + lasts_us;
        }
        if (wafer->done_us > state->now_us && wafer->done_us < station->done_us) {
            station->done_us = wafer->done_us;
        }
    }
}

/* Robots that would begin to carry a wafer there at this very instant do not. */
static void hold_back(wh_flow_state_t *state, int32_t number) {
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        wh_flow_robot_state_t *robot = &state->robots[r];
        if (!state->tool->robots[r].is_real && robot->action == WH_FLOW_CARRYING &&
            robot->since_us == state->now_us && robot->to != WH_FLOW_NONE && robot->station == number &&
            robot->until_us > state->now_us) {
            robot->station = robot->from;
            robot->action = WH_FLOW_WAITING;
            robot->until_us = WH_FLOW_NEVER;
        }
    }
}

static void begin_down(wh_flow_state_t *state, const wh_flow_down_t *down) {
    if (down->robot != WH_FLOW_NONE) {
        wh_flow_begin_hold(state, down);
        return;
    }
    wh_flow_station_state_t *station = &state->stations[down->station];
    const int64_t until_us = down->for_us == WH_FLOW_FOR_EVER
                                 ? WH_FLOW_FOR_EVER
                                 : wh_flow_slice_us(state, state->now_us + down->for_us);
    wh_flow_touch(state, down->station);
    station->down_began_us = station->down_us == WH_FLOW_NEVER ? state->now_us : station->down_began_us;
    station->down_us =
        station->down_us == WH_FLOW_NEVER || station->down_us < until_us ? until_us : station->down_us;
    if (down->for_us == WH_FLOW_FOR_EVER) {
        ++state->failures.stations;
        ++state->changes;
        hold_back(state, down->station);
    }
    if (state->tool->stations[down->station].is_real) {
        wh_flow_set_down(state, down->station, true);
    } else {
        put_off(state, down->station);
    }
    const wh_flow_problem_t fails = {WH_FLOW_FAILS, WH_FLOW_NONE, WH_FLOW_NONE, down->station, down->for_us};
    wh_flow_tell_problem(state, &fails);
}

static bool is_any_clean_due(const wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_state_t *station = &state->stations[number];
    return !state->tool->stations[number].is_real && (station->has_due || station->idle_us <= state->now_us);
}

void wh_flow_stations_begin(wh_flow_state_t *state) {
    const wh_flow_plan_t *plan = state->plan;
    bool goes_on = true;
    while (state->next.down < plan->down_count && plan->downs[state->next.down].at_us <= state->now_us) {
        begin_down(state, &plan->downs[state->next.down++]);
    }
    if (state->failures.stations > 0) {
        wh_flow_end_routes(state); /* a lot may be over by that, and make room for another one */
    }
    while (goes_on) {
        goes_on = state->calls.are_there && wh_flow_calls_go(state);
        goes_on = begin_lots(state) || goes_on;
    }
    for (size_t k = 0; k < state->ahead.acting_count; ++k) {
        const int32_t i = state->ahead.acting[k];
        if (is_any_clean_due(state, i)) {
            begin_cleans(state, i);
        }
        if (state->tool->stations[i].is_lock) {
            wh_flow_lock_turn(state, i);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- next */

/* `best_us` is at most WH_FLOW_FOR_EVER. */
static int64_t sooner(int64_t now_us, int64_t best_us, int64_t us) {
    return us < best_us && us > now_us ? us : best_us;
}

static int64_t or_never(int64_t us) {
    return us < WH_FLOW_FOR_EVER ? us : WH_FLOW_NEVER;
}

/* The station is aside now, or no longer. */
static void note_aside(wh_flow_state_t *state, int32_t number, bool is_aside) {
    wh_flow_ahead_t *ahead = &state->ahead;
    state->stations[number].is_aside = is_aside;
    if (is_aside) {
        ahead->aside[ahead->aside_count++] = number;
        return;
    }
    size_t at = 0;
    while (ahead->aside[at] != number) {
        ++at;
    }
    ahead->aside[at] = ahead->aside[--ahead->aside_count];
}

/* Notes when something of the station ends next, WH_FLOW_FOR_EVER: nothing does. */
static void note_next(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_state_t *station = &state->stations[number];
    const int64_t now_us = state->now_us;
    int64_t next_us = sooner(now_us, WH_FLOW_FOR_EVER, station->shut_us);
    next_us = sooner(now_us, next_us, station->down_us);
    if (!state->tool->stations[number].is_real) {
        next_us = sooner(now_us, next_us, station->done_us);
        next_us = sooner(now_us, next_us, station->clean_us);
        next_us = sooner(now_us, next_us, station->pump_us);
    }
    const bool is_aside = station->clean_us != WH_FLOW_NEVER || station->pump_us != WH_FLOW_NEVER ||
                          station->down_us != WH_FLOW_NEVER;
    if (is_aside != station->is_aside) {
        note_aside(state, number, is_aside);
    }
    state->ahead.next_us[number] = next_us;
}

/* Looks again at the stations whose times have changed, or at all of them if others may change these. */
static void note_nexts(wh_flow_state_t *state) {
    wh_flow_ahead_t *ahead = &state->ahead;
    for (size_t k = 0; k < ahead->touched_count; ++k) {
        note_next(state, ahead->touched[k]);
    }
    for (int32_t i = 0; state->outside && i < (int32_t)state->tool->station_count; ++i) {
        note_next(state, i);
    }
    ahead->touched_count = 0;
}

/* The next end of something in any station. */
static int64_t next_end(const wh_flow_state_t *state) {
    const int64_t *us = state->ahead.next_us, *const behind = us + state->tool->station_count;
    int64_t next_us = WH_FLOW_FOR_EVER;
    for (; us < behind; ++us) {
        next_us = *us < next_us ? *us : next_us;
    }
    return next_us;
}

/* When a clean is due next because no wafer came, WH_FLOW_FOR_EVER: none is. */
static int64_t next_idle(const wh_flow_state_t *state) {
    int64_t idle_us = WH_FLOW_FOR_EVER;
    for (size_t k = 0; k < state->ahead.acting_count; ++k) {
        const int32_t i = state->ahead.acting[k];
        if (!state->tool->stations[i].is_real) {
            idle_us = sooner(state->now_us, idle_us, state->stations[i].idle_us);
        }
    }
    return idle_us;
}

int64_t wh_flow_stations_next(wh_flow_state_t *state, int64_t *idle_us) {
    const wh_flow_plan_t *plan = state->plan;
    const int64_t now_us = state->now_us;
    note_nexts(state);
    int64_t next_us = next_end(state);
    state->ahead.soonest_us = next_us;
    *idle_us = or_never(next_idle(state));
    next_us = sooner(now_us, next_us, state->next.start_us);
    if (state->next.lot < plan->lot_count) {
        next_us = sooner(now_us, next_us, plan->lots[state->next.lot].arrives_us);
    }
    if (state->calls.are_there) {
        next_us = sooner(now_us, next_us, wh_flow_calls_next(state));
    }
    if (state->next.down < plan->down_count) {
        next_us = sooner(now_us, next_us, plan->downs[state->next.down].at_us);
    }
    return or_never(next_us);
}
