#include "engine.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "failed.h"
#include "held.h"
#include "locks.h"
#include "outside.h"
#include "robots.h"
#include "stations.h"

/* How often at most all robots are asked at one instant: with times of 0 a rule of one's own may send a
 * robot to and fro. */
#define MOST_ROUNDS 100000

static void hear(void *context, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    wh_flow_engine_t *engine = context;
    if (event->kind == WH_FLOW_EVENT_PLACE || event->kind == WH_FLOW_EVENT_SWAP) {
        const int32_t wafer = event->kind == WH_FLOW_EVENT_PLACE ? event->wafer : event->other;
        const wh_flow_lot_t *lot = &state->plan->lots[state->plan->wafers[wafer].lot];
        const int32_t step = state->wafers[wafer].toward;
        if (wh_flow_following(state, wafer, step, event->place) == WH_FLOW_NONE && !lot->is_dummy) {
            engine->ends_us =
                wh_array_grow(engine->ends_us, engine->count, &engine->capacity, sizeof *engine->ends_us);
            engine->ends_us[engine->count++] = event->end_us;
        }
    }
    if (engine->listener.event) {
        engine->listener.event(engine->listener.context, state, event);
    }
}

static void pass_on(void *context, const wh_flow_state_t *state, int64_t to_us) {
    const wh_flow_engine_t *engine = context;
    if (engine->listener.advance) {
        engine->listener.advance(engine->listener.context, state, to_us);
    }
}

/* ----------------------------------------------------------------------------------------------- instants */

static void end_robots(wh_flow_state_t *state) {
    wh_flow_robot_state_t *const robots = state->robots;
    const int32_t count = (int32_t)state->tool->robot_count;
    const int64_t now_us = state->now_us;
    for (int32_t r = 0; r < count; ++r) {
        if (robots[r].is_ended || robots[r].until_us == now_us) {
            robots[r].is_ended = false;
            wh_flow_robot_end(state, r);
        }
    }
}

static void end_all(wh_flow_state_t *state) {
    if (state->outside) {
        wh_flow_take_holds(state);
    }
    wh_flow_stations_end(state);
    if (state->outside) {
        state->outside->hear(state->outside->context, state);
    }
    end_robots(state);
    if (state->outside || state->next.down > 0) {
        wh_flow_end_holds(state);
    }
    if (state->outside) {
        wh_flow_end_told(state);
        state->outside->look(state->outside->context, state);
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

/* True if it waits for a station that has not changed since it was asked. More may change than that if
 * somebody else plays, if carriers come, and if stations have failed. */
static bool is_kept_out(const wh_flow_state_t *state, const wh_flow_kept_out_t *kept_out) {
    return kept_out->station != WH_FLOW_NONE &&
           state->stations[kept_out->station].changes == kept_out->changes && !state->outside &&
           !state->calls.are_there && state->failures.stations == 0;
}

static bool is_free(const wh_flow_state_t *state, const wh_flow_robot_state_t *robot) {
    return (robot->action == WH_FLOW_IDLE || robot->action == WH_FLOW_WAITING) &&
           robot->held_us <= state->now_us && !is_kept_out(state, &robot->kept_out);
}

/* A free robot is asked, one in front of its place places. True if something began. */
static bool begin_robot(wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                        uint64_t *asked) {
    wh_flow_robot_state_t *at = &state->robots[robot];
    if (!is_free(state, at)) {
        return false;
    }
    at->kept_out.station = WH_FLOW_NONE;
    if (at->action == WH_FLOW_WAITING) {
        return wh_flow_robot_place(state, robot);
    }
    at->has_wish = wh_flow_ask(state, rules, robot, &at->wish);
    ++*asked;
    return at->has_wish && begin_order(state, robot, &at->wish);
}

static bool is_any_over(const wh_flow_state_t *state) {
    const wh_flow_robot_state_t *robot = state->robots, *const behind = robot + state->tool->robot_count;
    while (robot < behind && robot->until_us != state->now_us) {
        ++robot;
    }
    return robot < behind;
}

/* Asks all robots in their order. True if something began. */
static bool begin_robots(wh_flow_state_t *state, const wh_flow_rules_t *rules, uint64_t *asked) {
    const int32_t count = (int32_t)state->tool->robot_count;
    bool begun = false;
    for (int32_t r = 0; r < count && !state->cause; ++r) {
        begun = (is_free(state, &state->robots[r]) && begin_robot(state, rules, r, asked)) || begun;
    }
    return begun;
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
        while (!state->cause && begin_robots(state, rules, asked)) {
        }
        wh_flow_locks_turn_for_kept(state);
    } while (is_any_over(state) && !state->cause);
}

static int64_t next_instant(wh_flow_state_t *state) {
    const wh_flow_robot_state_t *robot = state->robots, *const behind = robot + state->tool->robot_count;
    const int64_t now_us = state->now_us;
    int64_t idle_us = WH_FLOW_NEVER;
    int64_t next_us = wh_flow_stations_next(state, &idle_us);
    for (; robot < behind; ++robot) {
        const int64_t until_us = robot->until_us, held_us = robot->held_us;
        next_us = until_us > now_us && until_us < next_us ? until_us : next_us;
        next_us = held_us > now_us && held_us < next_us ? held_us : next_us;
    }
    const int64_t list_us = wh_flow_list_next(state);
    next_us = list_us < next_us ? list_us : next_us;
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
    const bool is_over = next_us == WH_FLOW_NEVER && !wh_flow_is_real_busy(state);
    return is_over && relax(state, rules, asked) ? state->now_us : next_us;
}

void wh_flow_engine_open(wh_flow_engine_t *engine, const wh_flow_tool_t *tool, const wh_flow_plan_t *plan,
                         const wh_flow_listener_t *listener, const wh_flow_outside_t *outside) {
    memset(engine, 0, sizeof *engine);
    if (listener) {
        engine->listener = *listener;
    }
    wh_flow_state_open(&engine->state, tool, plan);
    engine->state.listener = (wh_flow_listener_t){engine, hear, pass_on, NULL};
    engine->state.outside = outside;
    wh_flow_rules_open(&engine->rules, &engine->state);
    engine->steadily = plan->ends_steady ? wh_flow_steadily_open(tool, plan) : NULL;
}

static int64_t end_with(wh_flow_engine_t *engine, wh_flow_end_t end) {
    engine->is_over = true;
    engine->end = end;
    return WH_FLOW_NEVER;
}

/* Time has come to this instant. */
static void go_to(wh_flow_state_t *state, int64_t now_us) {
    if (now_us > state->now_us) {
        state->listener.advance(state->listener.context, state, now_us);
        state->now_us = now_us;
    }
}

/* Once more wafers are at their ends. */
static bool is_steady(wh_flow_engine_t *engine) {
    if (!engine->steadily || engine->count == engine->looked) {
        return false;
    }
    engine->looked = engine->count;
    engine->period = wh_flow_steadily_look(engine->steadily, &engine->state, engine->ends_us, engine->count,
                                           &engine->cycle_us);
    return engine->period > 0;
}

/* Plays this instant as often as something begins in it. True if the flow is over then, with its end. */
static bool play_on(wh_flow_engine_t *engine, int64_t *next_us) {
    wh_flow_state_t *state = &engine->state;
    *next_us = state->now_us;
    while (*next_us == state->now_us) {
        play_instant(state, &engine->rules, &engine->asked);
        if (state->cause || state->over == state->plan->wafer_count) {
            (void)end_with(engine, state->cause ? WH_FLOW_BROKEN : WH_FLOW_DONE);
            return true;
        }
        *next_us = find_next(state, &engine->rules, &engine->repeat, &engine->asked);
    }
    if (is_steady(engine)) {
        tell_late(state);
        (void)end_with(engine, state->cause ? WH_FLOW_BROKEN : WH_FLOW_CUT);
        return true;
    }
    return false;
}

int64_t wh_flow_engine_step(wh_flow_engine_t *engine, int64_t now_us) {
    wh_flow_state_t *state = &engine->state;
    int64_t next_us = WH_FLOW_NEVER;
    if (now_us > state->plan->until_us) {
        return end_with(engine, cut(state));
    }
    go_to(state, now_us);
    if (play_on(engine, &next_us)) {
        return WH_FLOW_NEVER;
    }
    if (next_us == WH_FLOW_NEVER && !wh_flow_is_real_busy(state)) {
        return end_with(engine, WH_FLOW_STUCK);
    }
    const int64_t cut_us = state->plan->until_us == WH_FLOW_NEVER ? WH_FLOW_NEVER : state->plan->until_us + 1;
    return next_us < cut_us ? next_us : cut_us;
}

void wh_flow_engine_close(wh_flow_engine_t *engine) {
    free(engine->ends_us);
    wh_flow_steadily_close(engine->steadily);
    wh_flow_repeat_close(&engine->repeat);
    wh_flow_rules_close(&engine->rules, engine->state.tool);
    wh_flow_state_close(&engine->state);
}
