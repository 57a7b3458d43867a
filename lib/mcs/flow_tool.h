/* A cell with axes as a flow sees it. */
#ifndef WH_MCS_FLOW_TOOL_H
#define WH_MCS_FLOW_TOOL_H

#include <lua.h>

#include "../flow/tool.h"
#include "../layout/layout.h"

/* The tool of a cell with axes: its robots with axes, doors and stations that take time are real. It lives
 * as long as the Lua state. */
wh_flow_tool_t *wh_flow_tool_of_layout(lua_State *L, const wh_layout_t *layout);

/* The gripper that is an arm, 0 or 1, of the layout's robot. */
int32_t wh_flow_gripper_of(const wh_layout_t *layout, int32_t robot, int32_t arm);

#endif
