/* A flow's rule as a function of the script, and its function for problems: the tool as they see it. */
#ifndef WH_MCS_FLOW_OWN_H
#define WH_MCS_FLOW_OWN_H

#include <lua.h>
#include <stdbool.h>

#include "../flow/state.h"

/* Takes the functions `rule` and `on_error`, where they are functions, out of the description at stack
 * index 1 into the plan. Close it before the plan. */
void wh_flow_own_open(lua_State *L, const wh_flow_tool_t *tool, wh_flow_plan_t *plan);

/* From now on the functions are called on this thread. */
void wh_flow_own_use(lua_State *L, const wh_flow_plan_t *plan);

/* Pushes on_error and the tool, which can be read until wh_flow_own_end_on_error; false and nothing: there is
 * none. So the caller can call it where commands may wait. */
bool wh_flow_own_push_on_error(lua_State *L, const wh_flow_plan_t *plan, const wh_flow_state_t *state,
                               int64_t (*now)(const void *), const void *clock);
void wh_flow_own_end_on_error(const wh_flow_plan_t *plan);

/* The flow is over: what the functions kept of the tool tells nothing any more. Pushes the error that
 * ended one of them and returns true, if there was one. */
bool wh_flow_own_close(lua_State *L, wh_flow_plan_t *plan);

#endif
