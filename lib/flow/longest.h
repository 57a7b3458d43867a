/* How long a flow may take at most. Times are whole us in 64 bits, and half of those stand for ever. */
#ifndef WH_FLOW_LONGEST_H
#define WH_FLOW_LONGEST_H

#include "plan.h"

/* Null: all that the plan's wafers could meet, one after another, ends within the times that can be told.
 * Else the caller frees the reason, which names the times that are too long. */
char *wh_flow_check_longest(const wh_flow_plan_t *plan, const wh_flow_tool_t *tool);

#endif
