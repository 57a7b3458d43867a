#include "locks.h"

#include "failed.h"
#include "outside.h"
#include "transfer.h"

static int64_t pump_us(const wh_flow_state_t *state, int32_t number, wh_flow_side_t to) {
    return wh_flow_pump_us(&state->tool->stations[number], to, state->stations[number].wafers == 0);
}

/* Nobody is in it, its door is shut, and it neither pumps nor has failed. */
static bool is_closed(const wh_flow_state_t *state, const wh_flow_station_state_t *station) {
    return station->pump_us == WH_FLOW_NEVER && station->user == WH_FLOW_NONE && !station->real.is_shutting &&
           station->shut_us <= state->now_us && station->down_us == WH_FLOW_NEVER;
}

bool wh_flow_lock_pump(wh_flow_state_t *state, int32_t number, wh_flow_side_t side) {
    wh_flow_station_state_t *station = &state->stations[number];
    if (station->pump_us != WH_FLOW_NEVER && station->pump_to == side) {
        return true;
    }
    if (station->pump_us == WH_FLOW_NEVER && station->side == side) {
        return true;
    }
    if (!is_closed(state, station) || !wh_flow_pump_real(state, number, side)) {
        return false;
    }
    station->pump_to = side;
    wh_flow_touch(state, number);
    station->pump_us = state->now_us + pump_us(state, number, side);
    station->pump_began_us = state->now_us;
    return true;
}

/* Since when a side waits for a lock; WH_FLOW_NEVER: it does not. */
typedef struct {
    int64_t since_us[2];
} wants_t;

static void want(wants_t *wants, wh_flow_side_t side, int64_t since_us) {
    if (side != WH_FLOW_BOTH && since_us < wants->since_us[side]) {
        wants->since_us[side] = since_us;
    }
}

static bool is_swapping(const wh_flow_state_t *state, int32_t robot) {
    return state->plan->rule == WH_FLOW_SWAPPING && state->tool->robots[robot].arms > 1;
}

/* Transfers into the lock that have begun: their place is or will be empty, or an exchange. */
static void want_begun(const wh_flow_state_t *state, int32_t lock, wants_t *wants) {
    const wh_flow_station_t *of = &state->tool->stations[lock];
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        const wh_flow_place_t *place = &state->places[p];
        if (place->coming == WH_FLOW_NONE) {
            continue;
        }
        const int32_t robot = state->wafers[place->coming].taker;
        const bool is_empty = place->wafer == WH_FLOW_NONE || place->leaving_us != WH_FLOW_NEVER;
        if (is_empty || (is_swapping(state, robot) && wh_flow_is_carrier(state, robot, place->wafer))) {
            want(wants, state->tool->sides[wh_flow_of(state->tool, robot, lock)],
                 state->wafers[place->coming].done_us);
        }
    }
}

/* True if a robot could begin to carry the wafer into or out of the lock but for pressure and where it
 * stands. */
static bool is_able(const wh_flow_state_t *state, int32_t lock, int32_t robot, int32_t wafer) {
    const int32_t station = wh_flow_station_of(state, wafer);
    if (is_swapping(state, robot)) {
        const int32_t place = wh_flow_swap_way(state, robot, wafer, WH_FLOW_NEVER);
        return place != WH_FLOW_NONE && (station == lock || state->tool->place_stations[place] == lock);
    }
    return wh_flow_safe_place(state, robot, wafer, WH_FLOW_NEVER, station == lock ? WH_FLOW_NONE : lock) !=
           WH_FLOW_NONE;
}

static void want_wafer(const wh_flow_state_t *state, int32_t lock, int32_t wafer, wants_t *able,
                       wants_t *lying) {
    const int32_t step = wh_flow_next_step(state, wafer);
    if (step == WH_FLOW_NONE) {
        return;
    }
    const wh_flow_step_t *next = wh_flow_step_of(state->plan, wafer, step);
    const bool is_out = wh_flow_station_of(state, wafer) == lock;
    if (state->wafers[wafer].done_us > state->now_us || (!is_out && !wh_flow_step_has(next, lock))) {
        return;
    }
    for (int32_t r = 0; r < (int32_t)state->tool->robot_count; ++r) {
        const wh_flow_side_t side = state->tool->sides[wh_flow_of(state->tool, r, lock)];
        if (!state->tool->serves[wh_flow_of(state->tool, r, lock)] || !wh_flow_is_carrier(state, r, wafer)) {
            continue;
        }
        if (is_able(state, lock, r, wafer)) {
            want(able, side, state->wafers[wafer].done_us);
        } else if (is_out) {
            want(lying, side, state->wafers[wafer].done_us);
        }
    }
}

static void want_all(const wh_flow_state_t *state, int32_t lock, wants_t *able, wants_t *lying) {
    for (size_t step = 0; step < state->plan->step_count; ++step) {
        for (int32_t w = wh_flow_next_in(state, step, WH_FLOW_NONE); w != WH_FLOW_NONE;
             w = wh_flow_next_in(state, step, w)) {
            want_wafer(state, lock, w, able, lying);
        }
    }
}

/* A free robot in front of the lock is told to bring a wafer that it has. */
static bool is_told_to_bring(const wh_flow_robot_state_t *robot, int32_t lock) {
    const wh_flow_order_t *wish = &robot->wish;
    return robot->action == WH_FLOW_IDLE && robot->has_wish && wish->what == WH_FLOW_BRING &&
           wish->at == lock && robot->station == lock &&
           (robot->arms[0] == wish->wafer || robot->arms[1] == wish->wafer);
}

/* Lists and functions have a robot bring a wafer that it keeps, which waits for the pressure alone. */
static bool is_bringing(const wh_flow_state_t *state, int32_t lock, int32_t robot) {
    const wh_flow_order_t *wish = &state->robots[robot].wish;
    const bool is_listed = state->plan->rule == WH_FLOW_LISTS || state->plan->rule == WH_FLOW_OWN;
    if (!is_listed || !is_told_to_bring(&state->robots[robot], lock)) {
        return false;
    }
    const int32_t place = wh_flow_target(state, robot, wish->wafer, lock, 0, lock).place;
    return place != WH_FLOW_NONE && state->places[place].wafer == WH_FLOW_NONE;
}

static void want_kept(const wh_flow_state_t *state, int32_t lock, wants_t *able) {
    for (int32_t r = 0; r < (int32_t)state->tool->robot_count; ++r) {
        if (is_bringing(state, lock, r)) {
            want(able, state->tool->sides[wh_flow_of(state->tool, r, lock)],
                 state->wafers[state->robots[r].wish.wafer].done_us);
        }
    }
}

/* The side to which the lock should turn, or that it has: for transfers into it that have begun, else for
 * wafers that could be carried into or out of it, else for those in it; among several the one done longest
 * decides. */
static wh_flow_side_t turn_to(const wh_flow_state_t *state, int32_t lock) {
    const wh_flow_side_t side = state->stations[lock].side;
    const wh_flow_side_t other = side == WH_FLOW_VACUUM ? WH_FLOW_ATMOSPHERE : WH_FLOW_VACUUM;
    wants_t kinds[3];
    for (size_t i = 0; i < 3; ++i) {
        kinds[i] = (wants_t){{WH_FLOW_NEVER, WH_FLOW_NEVER}};
    }
    want_begun(state, lock, &kinds[0]);
    if (kinds[0].since_us[side] != WH_FLOW_NEVER) {
        return side;
    }
    if (kinds[0].since_us[other] == WH_FLOW_NEVER) {
        want_all(state, lock, &kinds[1], &kinds[2]);
        want_kept(state, lock, &kinds[1]);
    }
    for (size_t i = 0; i < 3; ++i) {
        if (kinds[i].since_us[0] != WH_FLOW_NEVER || kinds[i].since_us[1] != WH_FLOW_NEVER) {
            return kinds[i].since_us[other] < kinds[i].since_us[side] ? other : side;
        }
    }
    return side;
}

/* By the lock's own list: the next turn as soon as all that comes before it has been. */
static void turn_by_list(wh_flow_state_t *state, int32_t number) {
    const wh_flow_turns_t *list = &state->plan->turns[number];
    wh_flow_station_state_t *station = &state->stations[number];
    while ((size_t)station->turned < list->count &&
           list->turns[station->turned].behind <= station->accesses && station->pump_us == WH_FLOW_NEVER) {
        (void)wh_flow_lock_pump(state, number, list->turns[station->turned++].side);
    }
}

void wh_flow_lock_turn(wh_flow_state_t *state, int32_t number) {
    const wh_flow_station_state_t *station = &state->stations[number];
    if (station->is_listed || !is_closed(state, station)) {
        return;
    }
    if (state->plan->turns) {
        turn_by_list(state, number);
        return;
    }
    const wh_flow_side_t side = turn_to(state, number);
    if (side != station->side) {
        (void)wh_flow_lock_pump(state, number, side);
    }
}

void wh_flow_locks_turn_for_kept(wh_flow_state_t *state) {
    const bool are_told = state->plan->rule == WH_FLOW_LISTS || state->plan->rule == WH_FLOW_OWN;
    if (state->plan->turns || !are_told) {
        return;
    }
    for (size_t k = 0; k < state->ahead.acting_count; ++k) {
        const int32_t i = state->ahead.acting[k];
        bool is_awaited = false;
        for (int32_t r = 0; state->tool->stations[i].is_lock && r < (int32_t)state->tool->robot_count; ++r) {
            is_awaited = is_awaited || is_bringing(state, i, r);
        }
        if (is_awaited) {
            wh_flow_lock_turn(state, i);
        }
    }
}
