/* Lists: each robot carries out its own lines in their order. */
#include <stdio.h>

#include "../text/array.h"
#include "failed.h"
#include "rules.h"
#include "transfer.h"

static bool leads_to(const wh_flow_state_t *state, int32_t wafer, int32_t station) {
    const int32_t next = wh_flow_next_step(state, wafer);
    return next != WH_FLOW_NONE && wh_flow_step_has(wh_flow_step_of(state->plan, wafer, next), station);
}

/* True if the line may mean this wafer, which lies in its station. */
static bool fits_line(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line,
                      int32_t wafer) {
    if (state->wafers[wafer].is_moving || state->wafers[wafer].is_over ||
        (line->wafer != WH_FLOW_NONE && line->wafer != wafer)) {
        return false;
    }
    return line->what == WH_FLOW_TRANSFER
               ? leads_to(state, wafer, line->to)
               : line->what != WH_FLOW_KEEP || wh_flow_is_carrier(state, robot, wafer);
}

static bool entered_before(const wh_flow_state_t *state, int32_t a, int32_t b) {
    const int64_t a_us = state->wafers[a].entered_us, b_us = state->wafers[b].entered_us;
    return a_us != b_us ? a_us < b_us : a < b;
}

/* With more slots than this the wafers of the steps are looked through, of which few lie in a station. */
#define MANY_SLOTS 32

/* Wafers of a step stand in the order in which they entered, and in their first places also in the plan's. */
static void find_in_step(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line, size_t step,
                         int32_t *best) {
    for (int32_t w = state->heads[step]; w != WH_FLOW_NONE; w = state->wafers[w].next) {
        if (wh_flow_station_of(state, w) == line->from && fits_line(state, robot, line, w)) {
            *best = *best == WH_FLOW_NONE || entered_before(state, w, *best) ? w : *best;
            if (state->wafers[w].step == 0) {
                return;
            }
        }
    }
}

static int32_t wafer_among_many(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line) {
    int32_t best = WH_FLOW_NONE;
    for (size_t step = 0; step < state->plan->step_count; ++step) {
        find_in_step(state, robot, line, step, &best);
    }
    return best;
}

/* The wafer that a line means, if it lies in the station: the one named, or the first that entered. */
static int32_t wafer_in(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line) {
    const wh_flow_station_t *station = &state->tool->stations[line->from];
    if (station->slots > MANY_SLOTS) {
        return wafer_among_many(state, robot, line);
    }
    int32_t best = WH_FLOW_NONE;
    for (int32_t place = station->first_place; place < station->first_place + station->slots; ++place) {
        const int32_t wafer = state->places[place].wafer;
        if (wafer != WH_FLOW_NONE && fits_line(state, robot, line, wafer) &&
            (best == WH_FLOW_NONE || entered_before(state, wafer, best))) {
            best = wafer;
        }
    }
    return best;
}

static int32_t kept_for(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    int32_t best = WH_FLOW_NONE;
    int64_t best_us = WH_FLOW_NEVER;
    for (int32_t arm = 0; arm < 2; ++arm) {
        const int32_t wafer = at->arms[arm];
        if (wafer != WH_FLOW_NONE && leads_to(state, wafer, line->to) &&
            (line->wafer == WH_FLOW_NONE || line->wafer == wafer) && at->kept_us[arm] < best_us) {
            best = wafer;
            best_us = at->kept_us[arm];
        }
    }
    return best;
}

/* True if some wafer lies, or will lie, in the line's station before a step that the line serves. */
static bool is_possible(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line) {
    for (int32_t w = state->next.wafer; w < (int32_t)state->plan->wafer_count; ++w) {
        const int32_t last = wh_flow_last_step(state->plan, w);
        if (state->wafers[w].is_over || (line->wafer != WH_FLOW_NONE && line->wafer != w)) {
            continue;
        }
        for (int32_t k = state->wafers[w].step; k < last; ++k) {
            const bool is_here = k == 0
                                     ? state->tool->place_stations[state->plan->wafers[w].home] == line->from
                                     : wh_flow_step_has(wh_flow_step_of(state->plan, w, k), line->from);
            const wh_flow_step_t *next = wh_flow_step_of(state->plan, w, k + 1);
            const bool goes = line->what == WH_FLOW_KEEP ? wh_flow_step_is_served(state->tool, next, robot)
                                                         : wh_flow_step_has(next, line->to);
            if (is_here && goes) {
                return true;
            }
        }
    }
    return false;
}

/* True also if it was possible when it was asked last, and no wafer has gone anywhere since. */
static bool stays_possible(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line,
                           bool is_known) {
    return is_known || is_possible(state, robot, line);
}

static bool has_no_arm(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    return at->arms[0] != WH_FLOW_NONE &&
           (state->tool->robots[robot].arms < 2 || at->arms[1] != WH_FLOW_NONE);
}

/* The order of an exchange: it waits until the wafer that comes out is there. */
static void order_swap(const wh_flow_state_t *state, const wh_flow_line_t *line, wh_flow_order_t *order) {
    const int32_t place = state->wafers[line->out].place;
    order->onward = WH_FLOW_NONE;
    order->place = place;
    if (place == WH_FLOW_NONE || state->tool->place_stations[place] != line->to) {
        order->what = WH_FLOW_KEEP;
        order->wafer = order->place = WH_FLOW_NONE;
    }
}

const char *wh_flow_order_line(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line,
                               bool is_known, wh_flow_order_t *order) {
    *order = (wh_flow_order_t){.what = line->what,
                               .wafer = WH_FLOW_NONE,
                               .at = line->from,
                               .station = line->to,
                               .place = WH_FLOW_NONE,
                               .side = line->side};
    if (line->what == WH_FLOW_BRING || line->what == WH_FLOW_SWAP) {
        order->at = line->to;
        order->wafer = kept_for(state, robot, line);
        if (order->wafer == WH_FLOW_NONE) {
            return "no wafer on an arm goes there next";
        }
        if (line->what == WH_FLOW_SWAP) {
            order_swap(state, line, order);
        } else if (line->slot > 0) {
            order->place = state->tool->stations[line->to].first_place + line->slot - 1;
        }
        return NULL;
    }
    if (line->what != WH_FLOW_PUMP) {
        order->wafer = wafer_in(state, robot, line);
        if (order->wafer == WH_FLOW_NONE && !stays_possible(state, robot, line, is_known)) {
            return "no wafer lies there, or will, whose next step it serves";
        }
        if (has_no_arm(state, robot)) {
            return "each arm has a wafer";
        }
    }
    return NULL;
}

bool wh_flow_ask_list(wh_flow_state_t *state, int32_t robot, wh_flow_order_t *order) {
    const wh_flow_list_t *list = &state->plan->lists[robot];
    wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t number = at->mark;
    if ((size_t)number >= list->count) {
        return false;
    }
    const wh_flow_line_t *line = &list->lines[number];
    const bool is_known = at->possible == number && at->possible_at == state->changes;
    if (is_known && at->has_wish) {
        *order = at->wish;
        return true;
    }
    const char *why = wh_flow_order_line(state, robot, line, is_known, order);
    order->mark = number + 1;
    if (!why) {
        at->possible = number;
        at->possible_at = state->changes;
    }
    if (!why && order->what != WH_FLOW_PUMP && line->behind > state->stations[order->at].accesses) {
        order->what = WH_FLOW_KEEP; /* it goes there, and waits for those before it */
        order->wafer = order->place = WH_FLOW_NONE;
    }
    if (why) {
        char text[200];
        (void)snprintf(text, sizeof text, "list of %s, line %d: %s", state->tool->robots[robot].name,
                       (int)number + 1, why);
        state->cause = wh_text_copy(text);
    }
    return !why;
}

/* True if the robot stands in front of the wafer of its line, which waits for a place alone, and not for the
 * station where it lies. */
static bool waits_for_place(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const wh_flow_order_t *wish = &at->wish;
    return at->action == WH_FLOW_IDLE && at->has_wish && wish->what == WH_FLOW_TRANSFER &&
           at->kept_out.station == WH_FLOW_NONE && wish->wafer != WH_FLOW_NONE && at->station == wish->at &&
           at->held_us <= state->now_us && wh_flow_may_take(state, robot, wish->wafer) &&
           wh_flow_takeable_us(state, robot, wish->wafer) <= state->now_us;
}

int64_t wh_flow_list_next(const wh_flow_state_t *state) {
    int64_t next_us = WH_FLOW_NEVER;
    for (int32_t r = 0; state->plan->rule == WH_FLOW_LISTS && r < (int32_t)state->tool->robot_count; ++r) {
        if (waits_for_place(state, r)) {
            const int64_t us = wh_flow_in_time_us(state, r, state->robots[r].wish.wafer);
            next_us = us < next_us ? us : next_us;
        }
    }
    return next_us == WH_FLOW_NEVER ? WH_FLOW_NEVER : wh_flow_slice_us(state, next_us);
}
