/* The rules by which a robot that is free chooses what it does next. */
#ifndef WH_FLOW_RULES_H
#define WH_FLOW_RULES_H

#include "state.h"

/* A step that a robot empties. */
typedef struct {
    int32_t route, step;
    bool is_direct; /* into the next step; else only into later ones, if those between fail */
} wh_flow_task_t;

/* A robot's round: from the last step to the first; of one number, in the order of the routes. */
typedef struct {
    wh_flow_task_t *tasks;
    size_t count, capacity;
} wh_flow_round_t;

typedef struct {
    wh_flow_round_t *rounds; /* by robot */
} wh_flow_rules_t;

/* Also sets `checks_safety` of the state: shipped rules, if the plan is to be safe and some station leads
 * back to itself. */
void wh_flow_rules_open(wh_flow_rules_t *rules, wh_flow_state_t *state);
void wh_flow_rules_close(wh_flow_rules_t *rules, const wh_flow_tool_t *tool);

/* Fills the order for a robot that is free. An order whose time has not come yet sends the robot ahead.
 * False if there is none; the flow ends if then `state->cause` says why. The rules one by one do likewise. */
bool wh_flow_ask(wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot, wh_flow_order_t *order);
bool wh_flow_ask_backward(const wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                          wh_flow_order_t *order);
bool wh_flow_ask_ready(const wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                       wh_flow_order_t *order);
/* It fixes where a wafer on an arm goes. */
bool wh_flow_ask_swap(wh_flow_state_t *state, const wh_flow_rules_t *rules, int32_t robot,
                      wh_flow_order_t *order);
bool wh_flow_ask_list(wh_flow_state_t *state, int32_t robot, wh_flow_order_t *order);
/* The next time after now at which a transfer of a list may begin though nothing ends then: its place, which
 * is being emptied, will be empty in time. WH_FLOW_NEVER: there is none. */
int64_t wh_flow_list_next(const wh_flow_state_t *state);
bool wh_flow_ask_own(wh_flow_state_t *state, int32_t robot, wh_flow_order_t *order);

/* Fills the order that carries out a line. Null, or why the line can never be carried out; `is_known`: it
 * could be, and no wafer has gone anywhere since. */
const char *wh_flow_order_line(const wh_flow_state_t *state, int32_t robot, const wh_flow_line_t *line,
                               bool is_known, wh_flow_order_t *order);

#endif
