#include "transfer.h"

#include "calls.h"
#include "failed.h"
#include "safe.h"

/* So long after now that all that has begun has ended: for a beginning that nobody knows. */
#define UNKNOWN_US INT64_C(1000000000000000)

int64_t wh_flow_pick_us(const wh_flow_state_t *state, int32_t robot, int32_t station) {
    const size_t of = wh_flow_of(state->tool, robot, station);
    return state->tool->doors[of].open_us + state->tool->pick_us[of];
}

int64_t wh_flow_loaded_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us) {
    const int64_t wait_us = begin_us == WH_FLOW_NEVER ? UNKNOWN_US : begin_us - state->now_us;
    return wait_us + wh_flow_pick_us(state, robot, wh_flow_station_of(state, wafer));
}

int64_t wh_flow_process_us(const wh_flow_state_t *state, int32_t wafer, int32_t station) {
    const int32_t step = state->wafers[wafer].step;
    return step == 0
               ? 0
               : wh_flow_step_us(wh_flow_step_of(state->plan, wafer, step), &state->tool->stations[station],
                                 wh_flow_recipe_of(state->plan, wafer, step));
}

bool wh_flow_may_enter(const wh_flow_state_t *state, int32_t robot, int32_t station) {
    const wh_flow_station_state_t *now = &state->stations[station];
    if (now->user != WH_FLOW_NONE || now->real.is_shutting || now->shut_us > state->now_us ||
        now->down_us != WH_FLOW_NEVER || wh_flow_is_port_shut(state, station)) {
        return false;
    }
    return !state->tool->stations[station].is_lock ||
           (now->pump_us == WH_FLOW_NEVER &&
            wh_flow_sides_agree(state->tool->sides[wh_flow_of(state->tool, robot, station)], now->side));
}

/* ------------------------------------------------------------------------------------------------ targets */

static int64_t later(int64_t a_us, int64_t b_us) {
    return a_us > b_us ? a_us : b_us;
}

/* When a clean that is due in a place without a wafer, or behind its wafer, begins: the door is shut then. */
static int64_t clean_begin_us(const wh_flow_state_t *state, int32_t place) {
    const wh_flow_station_state_t *now = &state->stations[state->tool->place_stations[place]];
    return state->places[place].wafer != WH_FLOW_NONE ? now->busy_us : later(now->shut_us, state->now_us);
}

/* When the place will be empty and clean, or WH_FLOW_NEVER; `empty_us` is when it will be empty. */
static int64_t clean_from(const wh_flow_state_t *state, int32_t place, int64_t *empty_us) {
    const wh_flow_place_t *at = &state->places[place];
    const bool has_wafer = at->wafer != WH_FLOW_NONE;
    if (at->coming != WH_FLOW_NONE || (has_wafer && at->leaving_us == WH_FLOW_NEVER)) {
        return WH_FLOW_NEVER;
    }
    *empty_us = has_wafer ? at->leaving_us : state->now_us;
    if (at->clean_us != WH_FLOW_NEVER) {
        return at->clean_us;
    }
    if (!at->is_clean_due && !(has_wafer && wh_flow_is_clean_behind(state, place))) {
        return *empty_us;
    }
    return clean_begin_us(state, place) + state->tool->stations[state->tool->place_stations[place]].clean_us;
}

/* Since when it is empty, or will be; 0 if no wafer ever lay there. */
static int64_t emptied_us(const wh_flow_place_t *place) {
    const int64_t us = place->wafer == WH_FLOW_NONE ? place->empty_us : place->leaving_us;
    return us < 0 ? 0 : us;
}

/* When a robot that is there could begin, as far as the station is concerned; WH_FLOW_NEVER: not known,
 * for a lock has another pressure and does not pump. */
static int64_t open_from(const wh_flow_state_t *state, int32_t robot, int32_t station) {
    const wh_flow_station_state_t *now = &state->stations[station];
    const size_t of = wh_flow_of(state->tool, robot, station);
    const wh_flow_side_t side = state->tool->sides[of];
    int64_t us = now->busy_us;
    us = now->down_us != WH_FLOW_NEVER ? later(us, now->down_us) : us;
    if (wh_flow_is_port_shut(state, station)) {
        return WH_FLOW_NEVER;
    }
    if (!state->tool->stations[station].is_lock) {
        return us;
    }
    if (now->pump_us != WH_FLOW_NEVER) {
        return wh_flow_sides_agree(side, now->pump_to) ? later(us, now->pump_us) : WH_FLOW_NEVER;
    }
    return wh_flow_sides_agree(side, now->side) ? us : WH_FLOW_NEVER;
}

/* The targets of one question, the best first. */
typedef struct {
    wh_flow_target_t *targets;
    size_t count, most;
} found_t;

static bool is_better(const wh_flow_state_t *state, const wh_flow_target_t *a, const wh_flow_target_t *b) {
    return a->place_us != b->place_us
               ? a->place_us < b->place_us
               : emptied_us(&state->places[a->place]) < emptied_us(&state->places[b->place]);
}

/* Keeps the best ones. Equal ones stay in the order in which they are listed. */
static void add_target(const wh_flow_state_t *state, found_t *found, const wh_flow_target_t *target) {
    size_t at = found->count;
    while (at > 0 && is_better(state, target, &found->targets[at - 1])) {
        --at;
    }
    if (at == found->most) {
        return;
    }
    const size_t last = found->count < found->most ? found->count++ : found->most - 1;
    for (size_t i = last; i > at; --i) {
        found->targets[i] = found->targets[i - 1];
    }
    found->targets[at] = *target;
}

/* `there_us`: when the blade is in front, its door open. */
static void look_at(const wh_flow_state_t *state, int32_t robot, int32_t place, int64_t there_us,
                    found_t *found) {
    const int32_t station = state->tool->place_stations[place];
    const size_t of = wh_flow_of(state->tool, robot, station);
    int64_t empty_us = 0;
    if (!wh_flow_sides_agree(state->tool->slot_sides[place], state->tool->sides[of]) ||
        state->stations[station].down_us != WH_FLOW_NEVER || wh_flow_is_port_shut(state, station)) {
        return;
    }
    const int64_t clean_us = clean_from(state, place, &empty_us);
    if (clean_us == WH_FLOW_NEVER || empty_us > there_us) {
        return;
    }
    const int64_t open_us = open_from(state, robot, station);
    const wh_flow_target_t target = {
        place, open_us == WH_FLOW_NEVER
                   ? WH_FLOW_NEVER
                   : later(there_us, later(clean_us, open_us) + state->tool->doors[of].open_us)};
    add_target(state, found, &target);
}

/* True if this wafer of any route counts in that step of that route; `comes`: it is on its way to there. */
static bool counts_in(const wh_flow_state_t *state, int32_t wafer, int32_t route, int32_t step, bool comes) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    return state->plan->lots[state->plan->wafers[wafer].lot].route == route && !at->is_over &&
           (comes ? wh_flow_next_step(state, wafer) : at->step) == step;
}

/* The place's wafers of that step: the one that lies there, if it does, and the one that comes. */
static int32_t count_own(const wh_flow_state_t *state, const wh_flow_place_t *place, bool lies, int32_t route,
                         int32_t step) {
    return (lies && counts_in(state, place->wafer, route, step, false)) +
           (place->coming != WH_FLOW_NONE && counts_in(state, place->coming, route, step, true));
}

wh_flow_room_t wh_flow_room(const wh_flow_state_t *state, int32_t route, int32_t number, int64_t at_us,
                            int32_t leaver) {
    const wh_flow_step_t *step = &state->plan->routes[route].steps[number];
    wh_flow_room_t room = {0, 0};
    int32_t down = 0;
    for (size_t i = 0; i < step->station_count; ++i) {
        const wh_flow_station_t *station = &state->tool->stations[step->stations[i]];
        const bool is_down = state->stations[step->stations[i]].down_us != WH_FLOW_NEVER;
        for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
            const wh_flow_place_t *place = &state->places[p];
            const bool lies =
                place->wafer != WH_FLOW_NONE && place->wafer != leaver && place->leaving_us > at_us;
            const bool is_empty = !lies && place->coming == WH_FLOW_NONE;
            const int32_t own = count_own(state, place, lies, route, number);
            down += is_down && is_empty;
            room.holds += own;
            room.may += is_empty || own > 0;
        }
    }
    room.may -= step->kept_empty > down ? step->kept_empty : down;
    return room;
}

/* All places of a station; if the wafer must end in one, in that alone. */
static void look_at_all(const wh_flow_state_t *state, int32_t robot, int32_t station, int32_t end,
                        int64_t there_us, found_t *found) {
    const int32_t first = state->tool->stations[station].first_place;
    const int32_t behind = first + state->tool->stations[station].slots;
    if (end != WH_FLOW_NONE) {
        if (end >= first && end < behind) {
            look_at(state, robot, end, there_us, found);
        }
        return;
    }
    for (int32_t place = first; place < behind; ++place) {
        look_at(state, robot, place, there_us, found);
    }
}

static bool has_room(const wh_flow_state_t *state, int32_t wafer, int32_t step, int64_t at_us,
                     int32_t leaver) {
    const int32_t route = state->plan->lots[state->plan->wafers[wafer].lot].route;
    const wh_flow_room_t room = wh_flow_room(state, route, step, at_us, leaver);
    return room.holds < room.may;
}

/* Fills `found`. `leaver`: see wh_flow_room. */
static void find_targets(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t from,
                         int64_t loaded_us, int32_t station, int32_t leaver, found_t *found) {
    const wh_flow_tool_t *tool = state->tool;
    const int32_t next = wh_flow_next_step(state, wafer);
    if (next == WH_FLOW_NONE) {
        return;
    }
    const wh_flow_step_t *step = wh_flow_step_of(state->plan, wafer, next);
    const int32_t end = wh_flow_end_of(state->plan, wafer, next);
    for (size_t i = 0; i < step->station_count; ++i) {
        const int32_t to = step->stations[i];
        if ((station != WH_FLOW_NONE && to != station) || !tool->serves[wh_flow_of(tool, robot, to)]) {
            continue;
        }
        const int64_t there_us = state->now_us + loaded_us + wh_flow_move_us(tool, robot, from, to) +
                                 tool->doors[wh_flow_of(tool, robot, to)].open_us;
        if (step->kept_empty > 0 && !has_room(state, wafer, next, there_us, leaver)) {
            continue;
        }
        look_at_all(state, robot, to, end, there_us, found);
    }
}

size_t wh_flow_targets(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t from,
                       int64_t loaded_us, int32_t station, wh_flow_target_t targets[], size_t most) {
    found_t found = {targets, 0, most};
    find_targets(state, robot, wafer, from, loaded_us, station, wafer, &found);
    return found.count;
}

wh_flow_target_t wh_flow_target(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t from,
                                int64_t loaded_us, int32_t station) {
    wh_flow_target_t best = {WH_FLOW_NONE, WH_FLOW_NEVER};
    (void)wh_flow_targets(state, robot, wafer, from, loaded_us, station, &best, 1);
    return best;
}

size_t wh_flow_swapped_targets(const wh_flow_state_t *state, int32_t robot, int32_t wafer,
                               wh_flow_target_t targets[], size_t most) {
    found_t found = {targets, 0, most};
    find_targets(state, robot, wafer, wh_flow_station_of(state, wafer),
                 wh_flow_loaded_us(state, robot, wafer, WH_FLOW_NEVER), WH_FLOW_NONE, WH_FLOW_NONE, &found);
    return found.count;
}

int32_t wh_flow_safe_place(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us,
                           int32_t station) {
    const int32_t from = wh_flow_station_of(state, wafer);
    wh_flow_target_t targets[WH_FLOW_TARGETS];
    const size_t count =
        wh_flow_targets(state, robot, wafer, from, wh_flow_loaded_us(state, robot, wafer, begin_us), station,
                        targets, WH_FLOW_TARGETS);
    for (size_t i = 0; i < count; ++i) {
        const wh_flow_into_t into = {wafer, targets[i].place};
        if (!state->checks_safety || wh_flow_is_safe(state, &into, 1)) {
            return targets[i].place;
        }
    }
    return WH_FLOW_NONE;
}

/* The first time after now from which on a place of the station that is being emptied will be empty after so
 * long. */
static int64_t next_emptied_us(const wh_flow_state_t *state, int32_t station, int64_t ahead_us) {
    const wh_flow_station_t *of = &state->tool->stations[station];
    int64_t next_us = WH_FLOW_NEVER;
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        const int64_t leaving_us = state->places[p].leaving_us;
        const int64_t us = leaving_us == WH_FLOW_NEVER ? WH_FLOW_NEVER : leaving_us - ahead_us;
        next_us = us > state->now_us && us < next_us ? us : next_us;
    }
    return next_us;
}

int64_t wh_flow_in_time_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    const wh_flow_tool_t *tool = state->tool;
    const int32_t from = state->robots[robot].station, number = wh_flow_next_step(state, wafer);
    int64_t next_us = WH_FLOW_NEVER;
    if (number == WH_FLOW_NONE) {
        return next_us;
    }
    const wh_flow_step_t *step = wh_flow_step_of(state->plan, wafer, number);
    for (size_t i = 0; i < step->station_count; ++i) {
        const int32_t to = step->stations[i];
        if (!tool->serves[wh_flow_of(tool, robot, to)]) {
            continue;
        }
        const int64_t ahead_us = wh_flow_pick_us(state, robot, from) +
                                 wh_flow_move_us(tool, robot, from, to) +
                                 tool->doors[wh_flow_of(tool, robot, to)].open_us;
        const int64_t us = next_emptied_us(state, to, ahead_us);
        next_us = us < next_us ? us : next_us;
    }
    return next_us;
}

int64_t wh_flow_begin_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t *there_us) {
    const int64_t from_us = wh_flow_takeable_us(state, robot, wafer);
    *there_us = state->now_us + wh_flow_move_us(state->tool, robot, state->robots[robot].station,
                                                wh_flow_station_of(state, wafer));
    return from_us == WH_FLOW_NEVER ? WH_FLOW_NEVER : later(from_us, *there_us);
}

/* ------------------------------------------------------------------------------------------------- taking */

bool wh_flow_is_carrier(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int32_t station = wh_flow_station_of(state, wafer);
    if (station == WH_FLOW_NONE || at->is_moving || at->is_over ||
        !state->tool->serves[wh_flow_of(state->tool, robot, station)]) {
        return false;
    }
    const int32_t next = wh_flow_next_step(state, wafer);
    return next != WH_FLOW_NONE &&
           wh_flow_step_is_served(state->tool, wh_flow_step_of(state->plan, wafer, next), robot);
}

bool wh_flow_may_take(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    return wh_flow_is_carrier(state, robot, wafer) && wh_flow_free_arm(state, robot, wafer) != WH_FLOW_NONE;
}

int64_t wh_flow_takeable_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    const int64_t open_us = open_from(state, robot, wh_flow_station_of(state, wafer));
    int64_t from_us = state->wafers[wafer].done_us;
    if (from_us == WH_FLOW_NEVER || open_us == WH_FLOW_NEVER) {
        return WH_FLOW_NEVER;
    }
    from_us = later(from_us, open_us);
    return state->wafers[wafer].step == 0 ? later(from_us, state->next.start_us) : from_us;
}
