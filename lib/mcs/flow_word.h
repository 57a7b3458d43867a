/* The word `flow`: what it is given, and what it returns. */
#ifndef WH_MCS_FLOW_WORD_H
#define WH_MCS_FLOW_WORD_H

#include "native.h"

/* Reads the description at stack index 1 into the record's new flow, with a finished plan. Raises what is
 * wrong with it, and a second flow in a run. */
wh_flow_t *wh_flow_read_word(lua_State *L, wh_mcs_t *mcs, const wh_flow_tool_t *tool);

/* The flow has been played: judges it for the run, and pushes its figures, or raises the error on top of the
 * stack if a function of the script `has_failed`. */
int wh_flow_return_word(lua_State *L, wh_mcs_t *mcs, bool has_failed);

/* The run fails: the flow did not come to its end, for this reason. */
void wh_flow_fail_word(const wh_mcs_t *mcs, const char *why);

#endif
