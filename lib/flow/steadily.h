/* Finds that a flow is steady while it goes on: all that decides what comes next is as it was some wafers
 * ago, but for the time. So it goes on like that for as long as wafers of the lot are still to come.
 *
 * Compared are robots with their orders and wafers, stations, their places with what runs in them, the order
 * of wafers in each step, and marks of rules, all times from now on. Left out are the stations in which lots
 * begin and end: there wafers wait, or are over. Nothing is found while a failure or another lot is to come,
 * nor with lists and rules of one's own, whose next answers nobody knows. */
#ifndef WH_FLOW_STEADILY_H
#define WH_FLOW_STEADILY_H

#include "state.h"

typedef struct wh_flow_steadily wh_flow_steadily_t;

/* By malloc; close it. */
wh_flow_steadily_t *wh_flow_steadily_open(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan);
void wh_flow_steadily_close(wh_flow_steadily_t *steadily);

/* Looks at an instant that is played, after ends[count - 1]. Returns the least number of wafers, up to 24,
 * after which their ends repeat to 1 us, with that time in `cycle_us`; 0: it is not steady, or repeats after
 * more. Cost: linear in places, steps and robots. */
int32_t wh_flow_steadily_look(wh_flow_steadily_t *steadily, const wh_flow_state_t *state,
                              const int64_t ends_us[], size_t count, int64_t *cycle_us);

#endif
