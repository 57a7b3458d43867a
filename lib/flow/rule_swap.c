/* swap: a robot with two arms takes a wafer, and where its next place is full it exchanges the two, and
 * goes on with what it took until a place was empty. It takes one only if the exchanges that follow lead
 * to an empty place. */
#include "failed.h"
#include "rules.h"
#include "safe.h"
#include "transfer.h"

/* The most exchanges in a row. */
#define LONGEST 64

/* The wafer that goes on first, and in `other` the one behind it; one that is over stays on its arm. */
static int32_t carried(const wh_flow_state_t *state, const wh_flow_robot_state_t *robot, int32_t *other) {
    int32_t a = robot->arms[0], b = robot->arms[1];
    a = a != WH_FLOW_NONE && state->wafers[a].is_over ? WH_FLOW_NONE : a;
    b = b != WH_FLOW_NONE && state->wafers[b].is_over ? WH_FLOW_NONE : b;
    *other = WH_FLOW_NONE;
    if (a == WH_FLOW_NONE || b == WH_FLOW_NONE) {
        return a == WH_FLOW_NONE ? b : a;
    }
    const bool a_first = robot->kept_us[0] <= robot->kept_us[1];
    *other = a_first ? b : a;
    return a_first ? a : b;
}

/* True if the first wafer, and not the second, is the one to swap against: the robot carries it on; it is
 * done first; then by priority, the later step, the one that entered first. */
static bool is_before(const wh_flow_state_t *state, int32_t robot, int32_t a, int32_t b) {
    const bool a_goes = wh_flow_is_carrier(state, robot, a), b_goes = wh_flow_is_carrier(state, robot, b);
    const wh_flow_wafer_state_t *one = &state->wafers[a], *other = &state->wafers[b];
    if (a_goes != b_goes || one->done_us != other->done_us) {
        return a_goes != b_goes ? a_goes : one->done_us < other->done_us;
    }
    return wh_flow_compare(state, a, b) < 0;
}

/* True if the robot may swap this wafer against the one in the place: no other is on its way there. */
static bool may_swap_in(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t place) {
    const wh_flow_place_t *at = &state->places[place];
    const int32_t station = state->tool->place_stations[place];
    const size_t of = wh_flow_of(state->tool, robot, station);
    return at->wafer != WH_FLOW_NONE && (at->coming == WH_FLOW_NONE || at->coming == wafer) &&
           state->tool->serves[of] && state->stations[station].down_us == WH_FLOW_NEVER &&
           wh_flow_sides_agree(state->tool->sides[of], state->tool->slot_sides[place]);
}

/* The best of the next step's full places, or WH_FLOW_NONE. */
static int32_t best_full(const wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    const int32_t next = wh_flow_next_step(state, wafer);
    int32_t best = WH_FLOW_NONE;
    if (next == WH_FLOW_NONE) {
        return best;
    }
    const wh_flow_step_t *step = wh_flow_step_of(state->plan, wafer, next);
    const int32_t end = wh_flow_end_of(state->plan, wafer, next);
    for (size_t i = 0; i < step->station_count; ++i) {
        const wh_flow_station_t *station = &state->tool->stations[step->stations[i]];
        for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
            if ((end == WH_FLOW_NONE || end == p) && may_swap_in(state, robot, wafer, p) &&
                (best == WH_FLOW_NONE ||
                 is_before(state, robot, state->places[p].wafer, state->places[best].wafer))) {
                best = p;
            }
        }
    }
    return best;
}

static bool is_among(const wh_flow_into_t moves[], size_t count, int32_t wafer) {
    for (size_t i = 0; i < count; ++i) {
        if (moves[i].wafer == wafer) {
            return true;
        }
    }
    return false;
}

/* True if the robot carries the wafer on and may take it with this arm; WH_FLOW_NONE: nobody knows which. */
static bool is_taken_by(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t arm) {
    const bool second_alone = wh_flow_step_of(state->plan, wafer, state->wafers[wafer].step)->second_arm;
    return wh_flow_is_carrier(state, robot, wafer) && !(second_alone && arm == 0);
}

/* The places for a wafer that goes behind `count` others, the best first. */
static size_t find_targets(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us,
                           size_t count, wh_flow_target_t targets[]) {
    return count > 0 ? wh_flow_swapped_targets(state, robot, wafer, targets, WH_FLOW_TARGETS)
                     : wh_flow_targets(state, robot, wafer, wh_flow_station_of(state, wafer),
                                       wh_flow_loaded_us(state, robot, wafer, begin_us), WH_FLOW_NONE,
                                       targets, WH_FLOW_TARGETS);
}

/* Ends the exchanges in the best place after which the tool is safe. False if there is none. */
static bool end_way(const wh_flow_state_t *state, const wh_flow_target_t targets[], size_t target_count,
                    wh_flow_into_t moves[], size_t count) {
    for (size_t i = 0; i < target_count; ++i) {
        moves[count].place = targets[i].place;
        if (!state->checks_safety || wh_flow_is_safe(state, moves, count + 1)) {
            return true;
        }
    }
    return false;
}

int32_t wh_flow_swap_way(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us) {
    wh_flow_into_t moves[LONGEST] = {{0}};
    wh_flow_target_t targets[WH_FLOW_TARGETS];
    int32_t arm = wh_flow_free_arm(state, robot, wafer);
    for (size_t count = 0; count < LONGEST && !is_among(moves, count, wafer); ++count) {
        const size_t found = find_targets(state, robot, wafer, begin_us, count, targets);
        moves[count] = (wh_flow_into_t){wafer, WH_FLOW_NONE};
        if (found > 0) {
            return end_way(state, targets, found, moves, count) ? moves[0].place : WH_FLOW_NONE;
        }
        moves[count].place = best_full(state, robot, wafer);
        if (moves[count].place == WH_FLOW_NONE) {
            return WH_FLOW_NONE;
        }
        wafer = state->places[moves[count].place].wafer;
        arm = arm == WH_FLOW_NONE ? WH_FLOW_NONE : 1 - arm;
        if (!is_taken_by(state, robot, wafer, arm)) {
            return WH_FLOW_NONE;
        }
    }
    return WH_FLOW_NONE;
}

/* Before a full place: against its wafer, as soon as that is done. A clean that is due comes between. */
static void exchange(const wh_flow_state_t *state, int32_t robot, int32_t place, wh_flow_order_t *order) {
    const int32_t other = state->places[place].wafer;
    if (!wh_flow_may_take(state, robot, other) || state->wafers[other].done_us > state->now_us ||
        state->robots[robot].station != order->at) {
        return;
    }
    const int32_t onward = wh_flow_swap_way(state, robot, other, state->now_us);
    if (onward != WH_FLOW_NONE && wh_flow_is_clean_behind(state, place)) {
        order->what = WH_FLOW_KEEP;
        order->wafer = other;
        order->place = onward;
    } else if (onward != WH_FLOW_NONE) {
        order->what = WH_FLOW_SWAP;
        order->onward = onward;
    }
}

static bool is_full(const wh_flow_place_t *place) {
    return place->wafer != WH_FLOW_NONE && place->leaving_us == WH_FLOW_NEVER;
}

/* The place for which the wafer goes on. A full one is chosen anew at each instant; one that is or will be
 * empty is kept: the transfer into it has begun. */
static int32_t choose_place(wh_flow_state_t *state, int32_t robot, int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    if (at->heading != WH_FLOW_NONE && state->places[at->heading].coming == wafer) {
        const int32_t station = state->tool->place_stations[at->heading];
        if (!is_full(&state->places[at->heading]) && !wh_flow_has_failed(state, station)) {
            return at->heading;
        }
        wh_flow_come(state, at->heading, WH_FLOW_NONE);
    }
    if (state->failures.stations > 0 && !wh_flow_recount(state, wafer)) {
        return WH_FLOW_NONE;
    }
    const wh_flow_target_t target =
        wh_flow_target(state, robot, wafer, state->robots[robot].station, 0, WH_FLOW_NONE);
    return target.place != WH_FLOW_NONE ? target.place : best_full(state, robot, wafer);
}

/* With a wafer: to an empty place of its next step, else to a full one. */
static bool carry_on(wh_flow_state_t *state, int32_t robot, int32_t wafer, wh_flow_order_t *order) {
    wh_flow_wafer_state_t *at = &state->wafers[wafer];
    at->heading = choose_place(state, robot, wafer);
    if (at->heading == WH_FLOW_NONE) {
        return false;
    }
    wh_flow_come(state, at->heading, wafer);
    const int32_t station = state->tool->place_stations[at->heading];
    *order = (wh_flow_order_t){.what = WH_FLOW_BRING,
                               .wafer = wafer,
                               .at = station,
                               .station = station,
                               .place = at->heading,
                               .onward = WH_FLOW_NONE};
    if (is_full(&state->places[at->heading])) {
        exchange(state, robot, at->heading, order);
    }
    return true;
}

/* The find of an empty-handed robot in a step. */
typedef struct {
    int32_t wafer, place;
    bool is_any; /* a wafer lies there, though perhaps none may be taken */
} found_t;

static bool entered_before(const wh_flow_state_t *state, int32_t a, int32_t b) {
    const wh_flow_wafer_state_t *one = &state->wafers[a], *other = &state->wafers[b];
    if (one->entered_us != other->entered_us) {
        return one->entered_us < other->entered_us;
    }
    return wh_flow_priority(state->plan, a) != wh_flow_priority(state->plan, b)
               ? wh_flow_priority(state->plan, a) > wh_flow_priority(state->plan, b)
               : a < b;
}

static void look_into(const wh_flow_state_t *state, int32_t robot, const wh_flow_task_t *task,
                      found_t *found) {
    const size_t step = state->plan->routes[task->route].first_step + (size_t)task->step;
    for (int32_t wafer = wh_flow_next_in(state, step, WH_FLOW_NONE); wafer != WH_FLOW_NONE;
         wafer = wh_flow_next_in(state, step, wafer)) {
        int64_t there_us = 0;
        if (!wh_flow_may_take(state, robot, wafer)) {
            continue;
        }
        found->is_any = true;
        if (found->wafer != WH_FLOW_NONE && !entered_before(state, wafer, found->wafer)) {
            continue;
        }
        const int64_t begin_us = wh_flow_begin_us(state, robot, wafer, &there_us);
        const int32_t place = wh_flow_swap_way(state, robot, wafer, begin_us);
        if (place != WH_FLOW_NONE) {
            found->wafer = wafer;
            found->place = place;
        }
    }
}

/* The first step of its route that the robot empties. */
static bool is_first(const wh_flow_round_t *round, const wh_flow_task_t *task) {
    for (size_t i = 0; i < round->count; ++i) {
        if (round->tasks[i].is_direct && round->tasks[i].route == task->route &&
            round->tasks[i].step < task->step) {
            return false;
        }
    }
    return task->is_direct;
}

static bool is_coming(const wh_flow_state_t *state, const wh_flow_task_t *task) {
    const size_t step = state->plan->routes[task->route].first_step + (size_t)task->step;
    return !state->is_relaxed && (wh_flow_still_to_come(state, task->route, task->step) > 0 ||
                                  state->counts[step] > state->leaving[step]);
}

/* Looks into first steps to which wafers are still to come, or in which they lie. False if there are none. */
static bool look_into_first(const wh_flow_state_t *state, int32_t robot, const wh_flow_round_t *round,
                            found_t *found) {
    bool is_awaited = false;
    for (size_t i = 0; i < round->count; ++i) {
        if (is_first(round, &round->tasks[i]) && is_coming(state, &round->tasks[i])) {
            is_awaited = true;
            look_into(state, robot, &round->tasks[i], found);
        }
    }
    return is_awaited;
}

/* Looks into all steps from the earliest on until there is a wafer. Those of one number, in several routes,
 * are one. */
static void look_into_all(const wh_flow_state_t *state, int32_t robot, const wh_flow_round_t *round,
                          found_t *found) {
    int32_t step = WH_FLOW_NONE;
    for (size_t i = round->count; i > 0; --i) {
        const wh_flow_task_t *task = &round->tasks[i - 1];
        if (found->wafer != WH_FLOW_NONE && task->step != step) {
            return;
        }
        step = task->step;
        look_into(state, robot, task, found);
    }
}

/* Empty-handed: from first steps while wafers are still to come to them or lie there, else from the
 * earliest. */
static bool take(const wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                 wh_flow_order_t *order) {
    const wh_flow_round_t *round = &rules->rounds[robot];
    found_t found = {WH_FLOW_NONE, WH_FLOW_NONE, false};
    const bool is_awaited = look_into_first(state, robot, round, &found);
    if (is_awaited && !found.is_any) {
        return false;
    }
    look_into_all(state, robot, round, &found);
    *order = (wh_flow_order_t){.what = WH_FLOW_KEEP,
                               .wafer = found.wafer,
                               .at = found.wafer == WH_FLOW_NONE ? WH_FLOW_NONE
                                                                 : wh_flow_station_of(state, found.wafer),
                               .station = WH_FLOW_NONE,
                               .place = found.place};
    return found.wafer != WH_FLOW_NONE;
}

/* True if the place is or will be empty. */
static bool is_open(const wh_flow_state_t *state, int32_t place) {
    return place != WH_FLOW_NONE && !is_full(&state->places[place]);
}

bool wh_flow_ask_swap(wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                      wh_flow_order_t *order) {
    int32_t other = WH_FLOW_NONE;
    const int32_t has = carried(state, &state->robots[robot], &other);
    if (has == WH_FLOW_NONE) {
        return take(state, rules, robot, order);
    }
    const bool goes_on = carry_on(state, robot, has, order);
    if (other == WH_FLOW_NONE || (goes_on && is_open(state, order->place))) {
        return goes_on;
    }
    /* Both arms are full, so that nothing can be exchanged: the place of the first wafer has failed. */
    return is_open(state, choose_place(state, robot, other)) ? carry_on(state, robot, other, order) : goes_on;
}
