#include "waiting.h"

#include "transfer.h"

/* Why a blade may not go into a station where the wafer or the place is ready. */
static wh_flow_robot_class_t entrance(const wh_flow_state_t *state, int32_t station) {
    const wh_flow_station_state_t *at = &state->stations[station];
    if (at->down_us != WH_FLOW_NEVER) {
        return WH_FLOW_ROBOT_WAITS_DOWN;
    }
    if (at->user != WH_FLOW_NONE || at->real.is_shutting || at->shut_us > state->now_us) {
        return WH_FLOW_ROBOT_WAITS_ROBOT;
    }
    return WH_FLOW_ROBOT_WAITS_PUMP;
}

static wh_flow_robot_class_t placing(const wh_flow_state_t *state, int32_t number) {
    const wh_flow_place_t *place = number == WH_FLOW_NONE ? NULL : &state->places[number];
    if (!place || place->wafer != WH_FLOW_NONE) {
        return WH_FLOW_ROBOT_WAITS_PLACE;
    }
    return place->clean_us != WH_FLOW_NEVER || place->is_clean_due
               ? WH_FLOW_ROBOT_WAITS_CLEAN
               : entrance(state, state->tool->place_stations[number]);
}

static wh_flow_robot_class_t taking(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    if (wafer == WH_FLOW_NONE || state->wafers[wafer].done_us > state->now_us ||
        (state->wafers[wafer].step == 0 && state->next.start_us > state->now_us)) {
        return WH_FLOW_ROBOT_WAITS_WAFER;
    }
    const int32_t station = wh_flow_station_of(state, wafer);
    return station == WH_FLOW_NONE || wh_flow_may_enter(state, robot, station) ? WH_FLOW_ROBOT_WAITS_PLACE
                                                                               : entrance(state, station);
}

static wh_flow_robot_class_t wishing(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const wh_flow_order_t *wish = &at->wish;
    if (!at->has_wish) {
        return WH_FLOW_ROBOT_IDLE;
    }
    switch (wish->what) {
    case WH_FLOW_PUMP:
        return WH_FLOW_ROBOT_WAITS_PUMP;
    case WH_FLOW_SWAP:
        return taking(state, robot, state->places[wish->place].wafer);
    case WH_FLOW_BRING: {
        const wh_flow_target_t target =
            wh_flow_target(state, robot, wish->wafer, at->station, 0, at->station);
        return placing(state, target.place);
    }
    case WH_FLOW_TRANSFER:
    case WH_FLOW_KEEP:
    default:
        return taking(state, robot, wish->wafer);
    }
}

/* The classes of robots that do something. */
static const wh_flow_robot_class_t classes[] = {
    [WH_FLOW_MOVING] = WH_FLOW_ROBOT_EMPTY_WAY, [WH_FLOW_CARRYING] = WH_FLOW_ROBOT_LOADED_WAY,
    [WH_FLOW_OPENING] = WH_FLOW_ROBOT_DOOR,     [WH_FLOW_PICKING] = WH_FLOW_ROBOT_PICK,
    [WH_FLOW_PLACING] = WH_FLOW_ROBOT_PLACE,    [WH_FLOW_SWAPS] = WH_FLOW_ROBOT_SWAP,
};

wh_flow_robot_class_t wh_flow_robot_class(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const bool rests = at->action == WH_FLOW_IDLE || at->action == WH_FLOW_WAITING;
    if ((rests && at->held_us > state->now_us) || at->asked.stands) {
        return WH_FLOW_ROBOT_WAITS_DOWN;
    }
    return !rests                          ? classes[at->action]
           : at->action == WH_FLOW_WAITING ? placing(state, at->to)
                                           : wishing(state, robot);
}
