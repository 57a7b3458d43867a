#include "flow.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "repeat.h"
#include "robots.h"
#include "stations.h"

/* How often at most all robots are asked at one instant: with times of 0 a rule of one's own may send a
 * robot to and fro. */
#define MOST_ROUNDS 100000

/* The user's listener, and the times of the last placings. */
typedef struct {
    wh_flow_listener_t listener;
    int64_t *ends_us;
    size_t count, capacity;
} play_t;

static void hear(void *context, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    play_t *play = context;
    if (event->kind == WH_FLOW_EVENT_PLACE || event->kind == WH_FLOW_EVENT_SWAP) {
        const int32_t wafer = event->kind == WH_FLOW_EVENT_PLACE ? event->wafer : event->other;
        const wh_flow_lot_t *lot = &state->plan->lots[state->plan->wafers[wafer].lot];
        if (state->wafers[wafer].step + 1 == wh_flow_last_step(state->plan, wafer) && !lot->is_dummy) {
            play->ends_us = wh_array_grow(play->ends_us, play->count, &play->capacity, sizeof *play->ends_us);
            play->ends_us[play->count++] = event->end_us;
        }
    }
    if (play->listener.event) {
        play->listener.event(play->listener.context, state, event);
    }
}

static void pass_on(void *context, const wh_flow_state_t *state, int64_t to_us) {
    const play_t *play = context;
    if (play->listener.advance) {
        play->listener.advance(play->listener.context, state, to_us);
    }
}

/* ----------------------------------------------------------------------------------------------- instants */

static void end_all(wh_flow_state_t *state) {
    wh_flow_stations_end(state);
    for (int32_t r = 0; r < (int32_t)state->tool->robot_count; ++r) {
        if (state->robots[r].until_us == state->now_us) {
            wh_flow_robot_end(state, r);
        }
    }
}

/* A robot that begins anything but an empty way ends the time in which nobody waits for steps to fill. */
static bool begin_order(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order) {
    const bool begun = wh_flow_robot_begin(state, robot, order);
    const wh_flow_action_t action = state->robots[robot].action;
    if (begun && action != WH_FLOW_MOVING && action != WH_FLOW_IDLE) {
        state->is_relaxed = false;
    }
    return begun;
}

/* A free robot is asked, one in front of its place places. True if something began. */
static bool begin_robot(wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                        uint64_t *asked) {
    if (state->robots[robot].action == WH_FLOW_WAITING) {
        return wh_flow_robot_place(state, robot);
    }
    if (state->robots[robot].action != WH_FLOW_IDLE) {
        return false;
    }
    wh_flow_order_t order;
    const bool has_wish = wh_flow_ask(state, rules, robot, &order);
    ++*asked;
    state->robots[robot].has_wish = has_wish;
    if (!has_wish) {
        return false;
    }
    state->robots[robot].wish = order;
    return begin_order(state, robot, &order);
}

static bool is_any_over(const wh_flow_state_t *state) {
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        if (state->robots[r].until_us == state->now_us) {
            return true;
        }
    }
    return false;
}

/* One instant: all that ends, then what stations begin, then robots, until nobody begins anything; once
 * more if what began takes no time. */
static void play_instant(wh_flow_state_t *state, const wh_flow_rules_t *rules, uint64_t *asked) {
    int rounds = 0;
    do {
        if (++rounds > MOST_ROUNDS) {
            state->cause = wh_text_copy("robots go to and fro at one instant without an end");
        }
        end_all(state);
        wh_flow_stations_begin(state);
        bool begun = true;
        while (begun && !state->cause) {
            begun = false;
            for (int32_t r = 0; r < (int32_t)state->tool->robot_count && !state->cause; ++r) {
                begun = begin_robot(state, rules, r, asked) || begun;
            }
        }
    } while (is_any_over(state) && !state->cause);
}

static int64_t next_instant(const wh_flow_state_t *state) {
    int64_t idle_us = WH_FLOW_NEVER;
    int64_t next_us = wh_flow_stations_next(state, &idle_us);
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        const int64_t until_us = state->robots[r].until_us;
        next_us = until_us > state->now_us && until_us < next_us ? until_us : next_us;
    }
    return next_us != WH_FLOW_NEVER && idle_us < next_us ? idle_us : next_us;
}

/* Nobody can go on: shipped rules are asked once more, without waiting for steps to fill. True if a robot
 * begins. */
static bool relax(wh_flow_state_t *state, const wh_flow_rules_t *rules, uint64_t *asked) {
    if (state->plan->rule == WH_FLOW_LISTS || state->plan->rule == WH_FLOW_OWN) {
        return false;
    }
    const bool was_relaxed = state->is_relaxed;
    bool begun = false;
    state->is_relaxed = true;
    for (int32_t r = 0; r < (int32_t)state->tool->robot_count && !begun; ++r) {
        begun = begin_robot(state, rules, r, asked);
    }
    state->is_relaxed = state->is_relaxed && was_relaxed;
    return begun;
}

/* The plan's own function hears of each wafer that still lies in its place beyond the window. */
static void tell_late(wh_flow_state_t *state) {
    wh_flow_event_t stay;
    for (int32_t w = 0; w < (int32_t)state->plan->wafer_count; ++w) {
        const int64_t over_us = wh_flow_open_stay(state, w, &stay) ? wh_flow_over_window_us(state, &stay) : 0;
        if (over_us > 0) {
            const wh_flow_problem_t late = {WH_FLOW_LATE, WH_FLOW_NONE, w, stay.station, over_us};
            wh_flow_tell_problem(state, &late);
        }
    }
}

/* All that runs at the cut runs up to it. */
static wh_flow_end_t cut(wh_flow_state_t *state) {
    state->listener.advance(state->listener.context, state, state->plan->until_us);
    state->now_us = state->plan->until_us;
    tell_late(state);
    return state->cause ? WH_FLOW_BROKEN : WH_FLOW_CUT;
}

/* Nobody makes progress: true if shipped rules wait for no fuller step from now on, as where nobody can go
 * on; false if they do not even so. */
static bool relax_on(wh_flow_state_t *state, wh_flow_repeat_t *repeat) {
    if (state->is_relaxed || state->plan->rule == WH_FLOW_LISTS || state->plan->rule == WH_FLOW_OWN) {
        return false;
    }
    wh_flow_repeat_anew(repeat);
    state->is_relaxed = true;
    return true;
}

/* The next instant; this one, if robots begin something now after all; WH_FLOW_NEVER: nobody can go on. */
static int64_t find_next(wh_flow_state_t *state, const wh_flow_rules_t *rules, wh_flow_repeat_t *repeat,
                         uint64_t *asked) {
    if (wh_flow_repeats(repeat, state) && !relax_on(state, repeat)) {
        return WH_FLOW_NEVER;
    }
    state->is_relaxed = state->is_relaxed && !repeat->is_anew;
    const int64_t next_us = next_instant(state);
    return next_us == WH_FLOW_NEVER && relax(state, rules, asked) ? state->now_us : next_us;
}

static wh_flow_end_t play_on(wh_flow_state_t *state, const wh_flow_rules_t *rules, wh_flow_repeat_t *repeat,
                             uint64_t *asked) {
    while (true) {
        play_instant(state, rules, asked);
        if (state->cause || state->over == state->plan->wafer_count) {
            return state->cause ? WH_FLOW_BROKEN : WH_FLOW_DONE;
        }
        const int64_t next_us = find_next(state, rules, repeat, asked);
        if (next_us == WH_FLOW_NEVER) {
            return WH_FLOW_STUCK;
        }
        if (next_us > state->plan->until_us) {
            return cut(state);
        }
        if (next_us > state->now_us) {
            state->listener.advance(state->listener.context, state, next_us);
            state->now_us = next_us;
        }
    }
}

/* True if there are several robots, and one of them may exchange. */
static bool has_several_with_two(const wh_flow_tool_t *tool) {
    bool has_two = false;
    for (size_t i = 0; i < tool->robot_count; ++i) {
        has_two = has_two || tool->robots[i].arms > 1;
    }
    return has_two && tool->robot_count > 1;
}

void wh_flow_play(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_listener_t *listener,
                  wh_flow_result_t *result) {
    play_t play = {0};
    wh_flow_state_t state;
    wh_flow_rules_t rules;
    wh_flow_repeat_t repeat = {0};
    if (listener) {
        play.listener = *listener;
    }
    *result = (wh_flow_result_t){.cycle_us = WH_FLOW_NEVER};
    wh_flow_state_open(&state, tool, plan);
    state.listener = (wh_flow_listener_t){&play, hear, pass_on, NULL};
    wh_flow_rules_open(&rules, &state);
    result->may_block = state.checks_safety && plan->rule == WH_FLOW_SWAPPING && has_several_with_two(tool);
    result->end = play_on(&state, &rules, &repeat, &result->asked);
    wh_flow_repeat_close(&repeat);
    result->makespan_us = state.last_us;
    if (play.listener.end) {
        play.listener.end(play.listener.context, &state);
    }
    result->over = play.count;
    result->left = plan->wafer_count - state.over;
    if (result->end == WH_FLOW_DONE || result->end == WH_FLOW_CUT) {
        result->no_cycle =
            wh_flow_find_cycle(tool, plan, play.ends_us, play.count, &result->period, &result->cycle_us);
    } else {
        result->no_cycle = wh_text_copy("the flow did not go on to its end");
    }
    if (result->end == WH_FLOW_STUCK) {
        result->why = wh_flow_stuck_text(&state);
    } else if (state.cause) {
        result->why = wh_text_copy(state.cause);
    }
    free(play.ends_us);
    wh_flow_rules_close(&rules, tool);
    wh_flow_state_close(&state);
}

void wh_flow_result_close(wh_flow_result_t *result) {
    free(result->why);
    free(result->no_cycle);
    memset(result, 0, sizeof *result);
}
