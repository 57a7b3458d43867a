#include "robots.h"

#include "calls.h"
#include "failed.h"
#include "held.h"
#include "locks.h"
#include "outside.h"
#include "stations.h"
#include "transfer.h"

/* When an action of a timed robot ends. Where slices are stepped a wafer changes its place with one. */
static int64_t end_of(const wh_flow_state_t *state, wh_flow_action_t action, int64_t for_us) {
    const bool is_access = action == WH_FLOW_PICKING || action == WH_FLOW_PLACING || action == WH_FLOW_SWAPS;
    const int64_t least_us = state->outside && is_access ? state->outside->slice_us : 0;
    return wh_flow_slice_us(state, state->now_us + (for_us > least_us ? for_us : least_us));
}

/* Somebody tells the end of what is real: an action of a real robot, or the opening of a real door. */
static void act(wh_flow_state_t *state, int32_t robot, wh_flow_action_t action, int64_t for_us) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    at->action = action;
    at->since_us = state->now_us;
    at->kept_out.station = WH_FLOW_NONE;
    wh_flow_stand_anew(state, robot);
    at->is_begun = wh_flow_is_played(state, robot);
    at->until_us = for_us == WH_FLOW_NEVER || at->is_begun ? WH_FLOW_NEVER : end_of(state, action, for_us);
}

static void rest(wh_flow_state_t *state, int32_t robot) {
    act(state, robot, WH_FLOW_IDLE, WH_FLOW_NEVER);
    state->robots[robot].from = state->robots[robot].to = WH_FLOW_NONE;
}

static bool is_loaded(const wh_flow_robot_state_t *robot) {
    return robot->arms[0] != WH_FLOW_NONE || robot->arms[1] != WH_FLOW_NONE;
}

/* The blade goes in after the door, if there is one. */
static void enter(wh_flow_state_t *state, int32_t robot, wh_flow_action_t action, int64_t for_us) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const wh_flow_door_t *door = &state->tool->doors[wh_flow_of(state->tool, robot, at->station)];
    const int64_t open_us = door->open_us, close_us = door->close_us;
    wh_flow_stir(state, at->station);
    state->stations[at->station].user = robot;
    state->stations[at->station].busy_us = state->now_us + open_us + for_us + close_us;
    at->then = action;
    const bool opens = open_us > 0 || door->is_real;
    act(state, robot, opens ? WH_FLOW_OPENING : action, opens ? open_us : for_us);
}

static int64_t time_of(const wh_flow_state_t *state, int32_t robot, wh_flow_action_t action) {
    const size_t of = wh_flow_of(state->tool, robot, state->robots[robot].station);
    return action == WH_FLOW_PICKING   ? state->tool->pick_us[of]
           : action == WH_FLOW_PLACING ? state->tool->place_us[of]
                                       : state->tool->swap_us[of];
}

static int32_t *count_of(wh_flow_state_t *state, int32_t wafer, int32_t step) {
    return &state->counts[wh_flow_step_index(state, wafer, step)];
}

/* --------------------------------------------------------------------------------------------- beginnings */

static void go(wh_flow_state_t *state, int32_t robot, int32_t to) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int64_t move_us = wh_flow_move_us(state->tool, robot, at->station, to);
    at->from = at->station;
    at->station = to;
    act(state, robot, is_loaded(at) ? WH_FLOW_CARRYING : WH_FLOW_MOVING, move_us);
}

/* It counts in its next step from now on. */
static void count_ahead(wh_flow_state_t *state, int32_t wafer) {
    if (state->wafers[wafer].toward == WH_FLOW_NONE) {
        const int32_t next = wh_flow_next_step(state, wafer);
        state->wafers[wafer].toward = next;
        ++*count_of(state, wafer, next);
    }
}

/* Under swap the place may be full. */
static void head_for(wh_flow_state_t *state, int32_t wafer, int32_t place) {
    if (place != WH_FLOW_NONE) {
        state->wafers[wafer].heading = place;
        wh_flow_come(state, place, wafer);
        count_ahead(state, wafer);
    }
}

/* The wafer is on its way into this place. */
static void reserve(wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t place) {
    state->robots[robot].to = place;
    wh_flow_come(state, place, wafer);
    state->wafers[wafer].is_moving = true;
    count_ahead(state, wafer);
}

/* The wafer's stay ends when its door is open. */
static void tell_stay(wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t open_us) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int32_t station = state->tool->place_stations[at->place];
    const wh_flow_event_t stay = {.kind = WH_FLOW_EVENT_STAY,
                                  .begin_us = at->done_us,
                                  .end_us = state->now_us + open_us,
                                  .robot = robot,
                                  .wafer = wafer,
                                  .other = WH_FLOW_NONE,
                                  .place = at->place,
                                  .station = station,
                                  .step = at->step};
    wh_flow_tell(state, &stay);
    const int64_t over_us = wh_flow_over_window_us(state, &stay);
    if (over_us > 0 && !state->tool->stations[station].is_real) {
        const wh_flow_problem_t late = {WH_FLOW_LATE, robot, wafer, station, over_us};
        wh_flow_tell_problem(state, &late);
    }
}

/* Nobody knows how long a real door opens: the stay is told when it has. */
static void leave(wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t for_us) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int32_t station = state->tool->place_stations[at->place];
    const wh_flow_door_t *door = &state->tool->doors[wh_flow_of(state->tool, robot, station)];
    state->places[at->place].leaving_us = state->now_us + for_us;
    ++state->changes;
    state->robots[robot].from = at->place;
    state->wafers[wafer].taker = robot;
    ++state->leaving[wh_flow_step_index(state, wafer, at->step)];
    if (at->step == 0 && state->plan->takt_us > 0) {
        state->next.start_us = state->now_us + state->plan->takt_us;
    }
    if (!door->is_real) {
        tell_stay(state, robot, wafer, door->open_us);
    }
}

/* It waits for the station alone; by other rules than lists a free robot may be told something else. */
static void keep_out(wh_flow_state_t *state, int32_t robot, int32_t station) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    if (at->action == WH_FLOW_WAITING || state->plan->rule == WH_FLOW_LISTS) {
        at->kept_out = (wh_flow_kept_out_t){station, state->stations[station].changes};
    }
}

static bool begin_pick(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    if (order->wafer == WH_FLOW_NONE) {
        return false;
    }
    if (state->wafers[order->wafer].done_us > state->now_us ||
        !wh_flow_may_enter(state, robot, at->station)) {
        keep_out(state, robot, at->station);
        return false;
    }
    if (!wh_flow_may_take(state, robot, order->wafer) ||
        wh_flow_takeable_us(state, robot, order->wafer) > state->now_us) {
        return false;
    }
    const int64_t pick_us = wh_flow_pick_us(state, robot, at->station);
    if (order->what == WH_FLOW_TRANSFER) {
        const int32_t to =
            order->place != WH_FLOW_NONE
                ? order->place
                : wh_flow_target(state, robot, order->wafer, at->station, pick_us, order->station).place;
        if (to == WH_FLOW_NONE) {
            return false;
        }
        reserve(state, robot, order->wafer, to);
    } else {
        head_for(state, order->wafer, order->place);
    }
    at->order = *order;
    at->mark = order->mark;
    at->arm = wh_flow_free_arm(state, robot, order->wafer);
    state->wafers[order->wafer].is_moving = true;
    leave(state, robot, order->wafer, pick_us);
    enter(state, robot, WH_FLOW_PICKING, time_of(state, robot, WH_FLOW_PICKING));
    return true;
}

static int32_t arm_of(const wh_flow_robot_state_t *robot, int32_t wafer) {
    return robot->arms[0] == wafer ? 0 : 1;
}

static bool begin_bring(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t to = order->place != WH_FLOW_NONE
                           ? order->place
                           : wh_flow_target(state, robot, order->wafer, at->station, 0, at->station).place;
    if (to == WH_FLOW_NONE || state->places[to].wafer != WH_FLOW_NONE ||
        state->places[to].clean_us != WH_FLOW_NEVER || state->places[to].is_clean_due ||
        !wh_flow_may_enter(state, robot, at->station)) {
        return false;
    }
    at->order = *order;
    at->mark = order->mark;
    at->arm = arm_of(at, order->wafer);
    reserve(state, robot, order->wafer, to);
    state->places[to].idle_us = WH_FLOW_NEVER;
    enter(state, robot, WH_FLOW_PLACING, time_of(state, robot, WH_FLOW_PLACING));
    return true;
}

static bool begin_swap(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t out = state->places[order->place].wafer;
    const bool has_way = order->onward != WH_FLOW_NONE || state->plan->rule == WH_FLOW_LISTS;
    if (out == WH_FLOW_NONE || !has_way || state->wafers[out].is_moving ||
        wh_flow_takeable_us(state, robot, out) > state->now_us ||
        !wh_flow_may_enter(state, robot, at->station)) {
        return false;
    }
    at->order = *order;
    at->mark = order->mark;
    at->arm = arm_of(at, order->wafer);
    reserve(state, robot, order->wafer, order->place);
    state->wafers[out].is_moving = true;
    const int64_t open_us = state->tool->doors[wh_flow_of(state->tool, robot, at->station)].open_us;
    leave(state, robot, out, open_us + time_of(state, robot, WH_FLOW_SWAPS));
    head_for(state, out, order->onward);
    at->to = order->place;
    enter(state, robot, WH_FLOW_SWAPS, time_of(state, robot, WH_FLOW_SWAPS));
    return true;
}

static bool begin_pump(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    if (!wh_flow_lock_pump(state, order->station, order->side)) {
        keep_out(state, robot, order->station);
        return false;
    }
    state->robots[robot].mark = order->mark;
    return true;
}

bool wh_flow_robot_begin(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    if (order->what == WH_FLOW_PUMP) {
        return begin_pump(state, robot, order);
    }
    if (state->robots[robot].station != order->at && wh_flow_is_port_shut(state, order->at)) {
        return false;
    }
    if (state->robots[robot].station != order->at) {
        state->robots[robot].order = *order;
        go(state, robot, order->at);
        return true;
    }
    switch (order->what) {
    case WH_FLOW_BRING:
        return begin_bring(state, robot, order);
    case WH_FLOW_SWAP:
        return begin_swap(state, robot, order);
    case WH_FLOW_TRANSFER:
    case WH_FLOW_KEEP:
    case WH_FLOW_PUMP:
    default:
        return begin_pick(state, robot, order);
    }
}

/* The robot waits for a place that has failed, or for any at all. True if it goes to another one. */
static bool turn_away(wh_flow_state_t *state, int32_t robot) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t wafer = at->order.wafer;
    int32_t to = at->to;
    const bool goes = wh_flow_turn_away(state, robot, wafer, &to);
    at->to = to;
    if (goes) {
        go(state, robot, state->tool->place_stations[to]);
        at->to = to;
    } else if (state->wafers[wafer].is_over) {
        rest(state, robot);
    }
    return goes;
}

bool wh_flow_robot_place(wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    if (at->to == WH_FLOW_NONE ||
        (state->failures.stations > 0 && wh_flow_has_failed(state, state->tool->place_stations[at->to]))) {
        return turn_away(state, robot);
    }
    const wh_flow_place_t *place = &state->places[at->to];
    if (place->wafer != WH_FLOW_NONE || place->clean_us != WH_FLOW_NEVER || place->is_clean_due ||
        !wh_flow_may_enter(state, robot, at->station)) {
        keep_out(state, robot, at->station);
        return false;
    }
    state->places[at->to].idle_us = WH_FLOW_NEVER;
    enter(state, robot, WH_FLOW_PLACING, time_of(state, robot, WH_FLOW_PLACING));
    return true;
}

/* --------------------------------------------------------------------------------------------------- ends */

static void tell_action(const wh_flow_state_t *state, int32_t robot, wh_flow_event_kind_t kind, int32_t wafer,
                        int32_t other) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const wh_flow_event_t event = {.kind = kind,
                                   .begin_us = at->since_us,
                                   .end_us = state->now_us,
                                   .robot = robot,
                                   .arm = at->arm,
                                   .wafer = wafer,
                                   .other = other,
                                   .place = kind == WH_FLOW_EVENT_PICK ? at->from : at->to,
                                   .station = at->station,
                                   .from = at->from,
                                   .step = wafer == WH_FLOW_NONE ? 0 : state->wafers[wafer].step,
                                   .stood_us = wh_flow_stood_us(state, robot)};
    wh_flow_tell(state, &event);
}

static void take_out(wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t arm) {
    wh_flow_wafer_state_t *taken = &state->wafers[wafer];
    wh_flow_place_t *place = &state->places[taken->place];
    --*count_of(state, wafer, taken->step);
    --state->leaving[wh_flow_step_index(state, wafer, taken->step)];
    wh_flow_step_leave(state, wafer);
    place->wafer = WH_FLOW_NONE;
    place->leaving_us = WH_FLOW_NEVER;
    place->empty_us = state->now_us;
    taken->place = WH_FLOW_NONE;
    taken->robot = robot;
    taken->arm = arm;
    state->robots[robot].arms[arm] = wafer;
    state->robots[robot].kept_us[arm] = state->now_us;
}

static void put_in(wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t number) {
    wh_flow_wafer_state_t *put = &state->wafers[wafer];
    state->robots[robot].arms[put->arm] = WH_FLOW_NONE;
    wh_flow_come(state, number, WH_FLOW_NONE);
    state->places[number].wafer = wafer;
    put->robot = put->taker = WH_FLOW_NONE;
    put->place = number;
    put->is_moving = false;
    put->heading = WH_FLOW_NONE;
    put->entered_us = state->now_us;
    put->step = put->toward;
    put->toward = WH_FLOW_NONE;
    wh_flow_step_enter(state, wafer);
    state->last_us = state->now_us;
}

/* The blade is out. */
static void come_out(wh_flow_state_t *state, int32_t robot) {
    wh_flow_station_state_t *station = &state->stations[state->robots[robot].station];
    const wh_flow_door_t *door =
        &state->tool->doors[wh_flow_of(state->tool, robot, state->robots[robot].station)];
    station->user = WH_FLOW_NONE;
    ++station->accesses;
    station->real.is_shutting = door->is_real;
    station->real.shutter = robot;
    station->real.shutting_us = state->now_us;
    station->busy_us = state->now_us + door->close_us;
    wh_flow_touch(state, state->robots[robot].station);
    station->shut_us = door->is_real ? state->now_us : wh_flow_slice_us(state, station->busy_us);
}

static void end_pick(wh_flow_state_t *state, int32_t robot) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t wafer = at->order.wafer;
    take_out(state, robot, wafer, at->arm);
    come_out(state, robot);
    wh_flow_station_left(state, at->from);
    tell_action(state, robot, WH_FLOW_EVENT_PICK, wafer, WH_FLOW_NONE);
    if (at->order.what == WH_FLOW_TRANSFER) {
        const int32_t to = at->to;
        if (wh_flow_has_failed(state, state->tool->place_stations[to])) {
            act(state, robot, WH_FLOW_WAITING, WH_FLOW_NEVER);
        } else {
            go(state, robot, state->tool->place_stations[to]);
        }
        at->to = to;
    } else {
        state->wafers[wafer].is_moving = false;
        rest(state, robot);
    }
}

static void end_place(wh_flow_state_t *state, int32_t robot) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t wafer = at->order.wafer;
    tell_action(state, robot, WH_FLOW_EVENT_PLACE, wafer, WH_FLOW_NONE);
    put_in(state, robot, wafer, at->to);
    come_out(state, robot);
    wh_flow_station_entered(state, wafer);
    rest(state, robot);
}

static void end_swap(wh_flow_state_t *state, int32_t robot) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t in = at->order.wafer, out = state->places[at->to].wafer;
    tell_action(state, robot, WH_FLOW_EVENT_SWAP, out, in);
    take_out(state, robot, out, 1 - at->arm);
    state->wafers[out].is_moving = false;
    put_in(state, robot, in, at->to);
    come_out(state, robot);
    wh_flow_station_left(state, at->to);
    wh_flow_station_entered(state, in);
    rest(state, robot);
}

/* A real door is open for a pick or a swap. */
static void tell_opened_stay(wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const wh_flow_door_t *door = &state->tool->doors[wh_flow_of(state->tool, robot, at->station)];
    if (door->is_real && at->then != WH_FLOW_PLACING) {
        tell_stay(state, robot, at->then == WH_FLOW_PICKING ? at->order.wafer : state->places[at->to].wafer,
                  0);
    }
}

void wh_flow_robot_end(wh_flow_state_t *state, int32_t robot) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    wh_flow_learn(state, robot);
    switch (at->action) {
    case WH_FLOW_MOVING:
        tell_action(state, robot, WH_FLOW_EVENT_MOVE, WH_FLOW_NONE, WH_FLOW_NONE);
        rest(state, robot);
        break;
    case WH_FLOW_CARRYING:
        tell_action(state, robot, WH_FLOW_EVENT_MOVE, at->order.wafer, WH_FLOW_NONE);
        if (at->to == WH_FLOW_NONE) {
            rest(state, robot);
        } else {
            act(state, robot, WH_FLOW_WAITING, WH_FLOW_NEVER);
        }
        break;
    case WH_FLOW_OPENING:
        tell_action(state, robot, WH_FLOW_EVENT_OPEN, WH_FLOW_NONE, WH_FLOW_NONE);
        tell_opened_stay(state, robot);
        act(state, robot, at->then, time_of(state, robot, at->then));
        break;
    case WH_FLOW_PICKING:
        end_pick(state, robot);
        break;
    case WH_FLOW_PLACING:
        end_place(state, robot);
        break;
    case WH_FLOW_SWAPS:
        end_swap(state, robot);
        break;
    case WH_FLOW_IDLE:
    case WH_FLOW_WAITING:
    default:
        break;
    }
}
