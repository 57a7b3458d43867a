#include "failed.h"

#include "transfer.h"

bool wh_flow_step_has_failed(const wh_flow_state_t *state, const wh_flow_step_t *step) {
    for (size_t i = 0; i < step->station_count; ++i) {
        if (!wh_flow_has_failed(state, step->stations[i])) {
            return false;
        }
    }
    return true;
}

/* True if the place is one of those of this step of the wafer's route. */
static bool is_of_step(const wh_flow_state_t *state, int32_t wafer, int32_t step, int32_t place) {
    const int32_t end = wh_flow_end_of(state->plan, wafer, step);
    return place != WH_FLOW_NONE && (end == WH_FLOW_NONE || end == place) &&
           wh_flow_step_has(wh_flow_step_of(state->plan, wafer, step), state->tool->place_stations[place]);
}

int32_t wh_flow_following_open(const wh_flow_state_t *state, int32_t wafer, int32_t step, int32_t place) {
    const int32_t last = wh_flow_last_step(state->plan, wafer);
    bool is_out = false;
    for (int32_t next = step + 1; next <= last; ++next) {
        const bool has_failed = wh_flow_step_has_failed(state, wh_flow_step_of(state->plan, wafer, next));
        if (!has_failed && !(is_out && is_of_step(state, wafer, next, place))) {
            return next;
        }
        is_out = is_out || has_failed;
    }
    return WH_FLOW_NONE;
}

static void uncount(wh_flow_state_t *state, int32_t wafer) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    if (at->toward != WH_FLOW_NONE) {
        --state->counts[wh_flow_step_index(state, wafer, at->toward)];
        at->toward = WH_FLOW_NONE;
    }
}

static void end_aboard(wh_flow_state_t *state, int32_t wafer) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    at->is_over = at->is_lost = true;
    at->is_moving = false;
    at->done_us = WH_FLOW_NEVER;
    wh_flow_note_over(state);
    ++state->failures.wafers;
}

bool wh_flow_recount(wh_flow_state_t *state, int32_t wafer) {
    const int32_t next =
        wh_flow_following(state, wafer, state->wafers[wafer].step, state->wafers[wafer].place);
    if (next != state->wafers[wafer].toward) {
        uncount(state, wafer);
    }
    if (next == WH_FLOW_NONE) {
        end_aboard(state, wafer);
        return false;
    }
    if (state->wafers[wafer].toward == WH_FLOW_NONE) {
        state->wafers[wafer].toward = next;
        ++state->counts[wh_flow_step_index(state, wafer, next)];
    }
    return true;
}

bool wh_flow_turn_away(wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t *place) {
    if (*place != WH_FLOW_NONE) {
        wh_flow_come(state, *place, WH_FLOW_NONE);
        *place = WH_FLOW_NONE;
    }
    uncount(state, wafer);
    if (wh_flow_next_step(state, wafer) == WH_FLOW_NONE) {
        end_aboard(state, wafer);
        return false;
    }
    *place = wh_flow_target(state, robot, wafer, state->robots[robot].station, 0, WH_FLOW_NONE).place;
    if (*place == WH_FLOW_NONE) {
        return false;
    }
    wh_flow_come(state, *place, wafer);
    return wh_flow_recount(state, wafer);
}

/* Where it lies. */
static void end_lying(wh_flow_state_t *state, int32_t wafer, bool is_lost) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const wh_flow_event_t event = wh_flow_event_at(state, WH_FLOW_EVENT_ENDS, wafer, state->now_us);
    at->is_lost = is_lost;
    state->failures.wafers += is_lost ? 1 : 0;
    wh_flow_tell(state, &event);
    at->is_over = true;
    at->done_us = WH_FLOW_NEVER;
    wh_flow_step_leave(state, wafer);
    --state->counts[wh_flow_step_index(state, wafer, at->step)];
    wh_flow_note_over(state);
}

void wh_flow_end_routes(wh_flow_state_t *state) {
    for (int32_t w = 0; state->failures.stations > 0 && w < (int32_t)state->plan->wafer_count; ++w) {
        const wh_flow_wafer_state_t *at = &state->wafers[w];
        if (at->is_over || at->place == WH_FLOW_NONE || at->taker != WH_FLOW_NONE) {
            continue;
        }
        const bool is_lost = wh_flow_has_failed(state, state->tool->place_stations[at->place]);
        if (is_lost || wh_flow_following(state, w, at->step, at->place) == WH_FLOW_NONE) {
            end_lying(state, w, is_lost);
        }
    }
}
