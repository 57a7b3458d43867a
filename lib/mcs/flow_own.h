/* A flow's rule as a function of the script, and its function for problems: the tool as they see it. */
#ifndef WH_MCS_FLOW_OWN_H
#define WH_MCS_FLOW_OWN_H

#include <lua.h>
#include <stdbool.h>

#include "../flow/plan.h"

/* Takes the functions `rule` and `on_error`, where they are functions, out of the description at stack
 * index 1 into the plan, and pushes one value, which must stay on the stack until wh_flow_own_close. */
void wh_flow_own_open(lua_State *L, const wh_flow_tool_t *tool, wh_flow_plan_t *plan);

/* The flow is over: what the functions kept of the tool tells nothing any more. Pushes the error that
 * ended one of them and returns true, if there was one. `index` is that of the value that was pushed. */
bool wh_flow_own_close(lua_State *L, int index, wh_flow_plan_t *plan);

#endif
