#include "held.h"

/* --------------------------------------------------------------------------------------- between instants */

void wh_flow_tell_hold(wh_flow_state_t *state, int32_t robot, bool is_held) {
    state->robots[robot].asked.is_wanted = is_held;
}

void wh_flow_tell_standing(wh_flow_state_t *state, int32_t robot) {
    state->robots[robot].asked.is_told = true;
}

/* -------------------------------------------------------------------------------------------- by the plan */

/* Whatever it does comes to its end. */
void wh_flow_begin_hold(wh_flow_state_t *state, const wh_flow_down_t *down) {
    wh_flow_robot_state_t *robot = &state->robots[down->robot];
    const int64_t until_us = wh_flow_slice_us(state, state->now_us + down->for_us);
    int64_t *const planned_us = robot->asked.is_on ? &robot->asked.planned_us : &robot->held_us;
    robot->held_began_us = robot->held_us > state->now_us ? robot->held_began_us : state->now_us;
    *planned_us = until_us > *planned_us ? until_us : *planned_us;
    const wh_flow_problem_t held = {WH_FLOW_FAILS, down->robot, WH_FLOW_NONE, WH_FLOW_NONE, down->for_us};
    wh_flow_tell_problem(state, &held);
}

static void end_hold(wh_flow_state_t *state, int32_t number) {
    wh_flow_event_t held = wh_flow_event_of_station(WH_FLOW_EVENT_HELD, WH_FLOW_NONE,
                                                    state->robots[number].held_began_us, state->now_us);
    held.robot = number;
    state->robots[number].held_us = 0;
    wh_flow_tell(state, &held);
}

void wh_flow_end_holds(wh_flow_state_t *state) {
    const int32_t count = (int32_t)state->tool->robot_count;
    for (int32_t r = 0; r < count; ++r) {
        if (state->robots[r].held_us > 0 && state->robots[r].held_us == state->now_us) {
            end_hold(state, r);
        }
    }
}

/* -------------------------------------------------------------------------------------------- by requests */

static void begin_asked(const wh_flow_state_t *state, wh_flow_robot_state_t *robot) {
    const bool is_held = robot->held_us > state->now_us;
    robot->asked.is_on = true;
    robot->asked.planned_us = is_held ? robot->held_us : 0;
    robot->held_began_us = is_held ? robot->held_began_us : state->now_us;
    robot->held_us = WH_FLOW_NEVER;
}

static void go_on(const wh_flow_state_t *state, wh_flow_asked_t *asked) {
    asked->stood_us += asked->stands ? state->now_us - asked->since_us : 0;
    asked->stands = asked->is_told = false;
}

/* The plan may hold it longer. */
static void end_asked(const wh_flow_state_t *state, wh_flow_robot_state_t *robot) {
    go_on(state, &robot->asked);
    robot->asked.is_on = false;
    robot->held_us = robot->asked.planned_us > state->now_us ? robot->asked.planned_us : state->now_us;
}

static void take_hold(const wh_flow_state_t *state, wh_flow_robot_state_t *robot) {
    if (robot->asked.is_wanted && !robot->asked.is_on) {
        begin_asked(state, robot);
    } else if (!robot->asked.is_wanted && robot->asked.is_on) {
        end_asked(state, robot);
    }
    if (robot->asked.is_on && robot->asked.is_told && !robot->asked.stands) {
        robot->asked.stands = true;
        robot->asked.since_us = state->now_us;
    }
}

void wh_flow_take_holds(wh_flow_state_t *state) {
    wh_flow_robot_state_t *robot = state->robots, *const behind = robot + state->tool->robot_count;
    for (; robot < behind; ++robot) {
        if (robot->asked.is_wanted || robot->asked.is_on) {
            take_hold(state, robot);
        }
    }
}

void wh_flow_stand_anew(wh_flow_state_t *state, int32_t robot) {
    wh_flow_asked_t *asked = &state->robots[robot].asked;
    asked->stands = asked->is_told = false;
    asked->stood_us = 0;
}

int64_t wh_flow_stood_us(const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_asked_t *asked = &state->robots[robot].asked;
    return asked->stood_us + (asked->stands ? state->now_us - asked->since_us : 0);
}

bool wh_flow_is_any_asked(const wh_flow_state_t *state) {
    bool is_any = false;
    for (size_t r = 0; r < state->tool->robot_count; ++r) {
        is_any = is_any || state->robots[r].asked.is_on;
    }
    return is_any;
}
