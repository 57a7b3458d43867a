/* Stations' clocks, as the engine of a flow hears and asks them. */
#include <stdio.h>

#include "../flow/failed.h"
#include "../text/array.h"
#include "flow_played.h"

/* How much longer than described something may take in a station, us: as wait_for has it. */
#define GRACE_US INT64_C(60000000)

/* How often on_error may have a station waited for longer. */
#define MOST_WAITS 100

int64_t wh_flow_played_now(const wh_flow_played_t *played) {
    const wh_track_t *track = &played->mcs->track;
    return track->slice * track->slice_us - played->flow->began_us;
}

static int32_t number_of(const wh_flow_played_t *played, int32_t wafer) {
    return wafer == WH_FLOW_NONE ? WH_FLOW_NONE : played->numbers[wafer];
}

bool wh_flow_played_hear(const wh_mcs_t *mcs, const wh_clocks_telling_t *telling,
                         const wh_clock_event_t *event) {
    wh_flow_played_t *played = mcs->lanes ? mcs->lanes->flow : NULL;
    if (!played) {
        return false;
    }
    played->heard =
        wh_array_grow(played->heard, played->heard_count, &played->heard_capacity, sizeof *played->heard);
    wh_flow_heard_t *heard = &played->heard[played->heard_count++];
    *heard = (wh_flow_heard_t){telling->of->station, *event, 0};
    if (event->kind == WH_CLOCK_TAKEN) {
        heard->lifted_us = telling->clocks->places[telling->of->first + (size_t)event->slot].lifted_us;
    }
    played->is_due = true;
    wh_mcs_call(played->mcs);
    return number_of(played, event->wafer) != WH_FLOW_NONE;
}

/* ------------------------------------------------------------------------------------------------ telling */

/* True if the wafer lies in a place of this station, as the engine has it. */
static bool lies_in(const wh_flow_state_t *state, int32_t wafer, int32_t station) {
    return wafer != WH_FLOW_NONE && wh_flow_station_of(state, wafer) == station;
}

/* Beginnings are seen; whatever goes wrong fails the run by itself. */
static void tell(const wh_flow_played_t *played, wh_flow_state_t *state, const wh_flow_heard_t *heard) {
    const wh_clock_event_t *event = &heard->event;
    const int64_t end_us = event->at_us - played->flow->began_us, begin_us = end_us - event->us;
    const int32_t wafer = number_of(played, event->wafer);
    const bool is_its = lies_in(state, wafer, heard->station);
    if (event->kind == WH_CLOCK_PROCESS_BEGINS || event->kind == WH_CLOCK_CLEAN_BEGINS ||
        event->kind == WH_CLOCK_PUMP_BEGINS) {
        wh_flow_tell_closed(state, heard->station, end_us);
    } else if (event->kind == WH_CLOCK_PROCESS_ENDS && is_its) {
        wh_flow_tell_process(state, wafer, begin_us, end_us);
    } else if (event->kind == WH_CLOCK_CLEAN_ENDS) {
        wh_flow_tell_clean(state, played->tool->stations[heard->station].first_place + event->slot, wafer,
                           begin_us, end_us);
    } else if (event->kind == WH_CLOCK_PUMP_ENDS) {
        state->stations[heard->station].side = event->side;
        wh_flow_tell_pump(state, heard->station, begin_us, end_us);
    } else if (event->kind == WH_CLOCK_TAKEN && is_its) {
        const int64_t lifted_us = heard->lifted_us - played->flow->began_us;
        wh_flow_tell_left(state, wafer, lifted_us - event->us, lifted_us);
    }
}

/* ----------------------------------------------------------------------------------------------- stalling */

/* The first one is told, unless on_error has said that the station is waited for. False if it is. */
static bool is_told(const wh_flow_played_t *played, int32_t station) {
    return played->stall.station == WH_FLOW_NONE &&
           wh_flow_played_now(played) >= played->patience[station].until_us;
}

static void stall(wh_flow_played_t *played, int32_t station, const char *action, const char *what) {
    if (is_told(played, station)) {
        played->stall.station = station;
        played->stall.action = action;
        (void)snprintf(played->stall.text, sizeof played->stall.text,
                       "STATION_TIMEOUT: %s: %s takes 60 s longer than described",
                       played->tool->stations[station].name, what);
    }
}

bool wh_flow_wait_on(wh_flow_played_t *played, int32_t station) {
    wh_flow_patience_t *patience = &played->patience[station];
    patience->until_us = wh_flow_played_now(played) + GRACE_US;
    return ++patience->asked <= MOST_WAITS;
}

/* Something in the place lasts too long: a fault keeps it up. */
static bool is_stalled(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us) {
    const int64_t lasts_us = now_us - place->begun_us - GRACE_US;
    return (place->phase == WH_CLOCK_PROCESSING && lasts_us > wh_clock_process_us(of, place)) ||
           (place->phase == WH_CLOCK_CLEANING && lasts_us > of->clean_us);
}

static void check_stall(wh_flow_played_t *played, const wh_clocked_t *of, const wh_clock_t *clock) {
    const struct wh_clocks *clocks = played->mcs->clocks;
    const int64_t now_us = clocks->state->utime;
    for (int32_t slot = 0; slot < of->of.slots; ++slot) {
        const wh_clock_place_t *place = &clocks->places[of->first + (size_t)slot];
        if (is_stalled(&of->of, place, now_us)) {
            const bool is_process = place->phase == WH_CLOCK_PROCESSING;
            stall(played, of->station, is_process ? "process" : "clean",
                  is_process ? "a process" : "a clean");
        }
    }
    if (clock->is_pumping &&
        now_us - clock->begun_us - GRACE_US > wh_flow_pump_us(&of->of, clock->pump_to, false)) {
        stall(played, of->station, "pump", "pumping");
    }
}

static bool find_unbegun(wh_flow_played_t *played, const wh_flow_state_t *state, const wh_clocked_t *of) {
    const struct wh_clocks *clocks = played->mcs->clocks;
    for (int32_t slot = 0; slot < of->of.slots && !of->is_down; ++slot) {
        const wh_clock_place_t *place = &clocks->places[of->first + (size_t)slot];
        const int32_t wafer = number_of(played, place->wafer);
        char why[WH_CLOCKS_WHY_BYTES];
        if (place->phase != WH_CLOCK_WAITING || wafer == WH_FLOW_NONE || state->wafers[wafer].is_over) {
            continue;
        }
        if (is_told(played, of->station)) {
            const char *bad = wh_clocks_why_bad(clocks, of, slot, why);
            played->stall.station = of->station;
            played->stall.action = "process";
            (void)snprintf(played->stall.text, sizeof played->stall.text,
                           "the process of %s in %s slot %d has not begun: %s",
                           played->flow->plan.wafers[wafer].name, played->tool->stations[of->station].name,
                           (int)slot + 1, bad ? bad : "a door of it is not shut");
        }
        return true;
    }
    return false;
}

bool wh_flow_find_unbegun(wh_flow_played_t *played, const wh_flow_state_t *state) {
    const struct wh_clocks *clocks = played->mcs->clocks;
    bool found = false;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        found = find_unbegun(played, state, &clocks->of[i]) || found;
    }
    return found;
}

/* ------------------------------------------------------------------------------------------------ looking */

void wh_flow_hear(void *context, wh_flow_state_t *state) {
    wh_flow_played_t *played = context;
    for (size_t i = 0; i < played->heard_count; ++i) {
        tell(played, state, &played->heard[i]);
    }
    played->heard_count = 0;
}

void wh_flow_look(void *context, wh_flow_state_t *state) {
    wh_flow_played_t *played = context;
    const struct wh_clocks *clocks = played->mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        const wh_clocked_t *of = &clocks->of[i];
        wh_flow_see_station(state, of->station, &of->of, &clocks->clocks[i], &clocks->places[of->first],
                            played->flow->began_us);
        check_stall(played, of, &clocks->clocks[i]);
    }
    wh_flow_look_at_ports(played, state);
}

bool wh_flow_pump_lock(void *context, int32_t station, wh_flow_side_t side) {
    const wh_flow_played_t *played = context;
    return wh_mcs_pump(played->mcs, station, side);
}

void wh_flow_hold_station(void *context, int32_t station, bool is_down) {
    const wh_flow_played_t *played = context;
    wh_mcs_set_down(played->mcs, station, is_down);
}

/* A study's error of the station's process is that of a step's own, too. */
void wh_flow_set_process(const wh_flow_played_t *played, int32_t wafer, int32_t place) {
    const wh_flow_state_t *state = &played->engine->state;
    const struct wh_clocks *clocks = played->mcs->clocks;
    const int32_t station = played->tool->place_stations[place];
    const int32_t next = wh_flow_next_step(state, wafer);
    const int64_t own_us = wh_flow_step_of(&played->flow->plan, wafer, next)->process_us;
    const int32_t number = wh_clocks_find(played->mcs, station);
    if (number == WH_NONE) {
        return;
    }
    const wh_clocked_t *of = &clocks->of[number];
    wh_clock_place_t *clock = &clocks->places[of->first + (size_t)wh_flow_slot(played->tool, place) - 1];
    clock->has_next = true;
    clock->next_recipe = wh_flow_recipe_of(&played->flow->plan, wafer, next);
    clock->next_us = own_us > 0 && own_us + of->error_us < 1 ? 1
                     : own_us > 0                            ? own_us + of->error_us
                                                             : own_us;
}

void wh_flow_forget_processes(const wh_flow_played_t *played) {
    const struct wh_clocks *clocks = played->mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->place_count; ++i) {
        clocks->places[i].has_next = false;
    }
}
