/* Wafers through a tool: plays lots along their routes by events, with robots that are times alone.
 * Nothing is looked at but times: no place, no way, no collision. */
#ifndef WH_FLOW_FLOW_H
#define WH_FLOW_FLOW_H

#include "rules.h"

typedef enum {
    WH_FLOW_DONE,   /* every wafer is at its end */
    WH_FLOW_STUCK,  /* nobody can go on; `why` tells who waits for whom */
    WH_FLOW_BROKEN, /* a list or a rule asked what can never be; `why` tells what */
    WH_FLOW_CUT,    /* `until_us` is over */
} wh_flow_end_t;

typedef struct {
    wh_flow_end_t end;
    int64_t makespan_us; /* from 0 to the end of the last placing */
    int64_t cycle_us;    /* over `period` wafers; WH_FLOW_NEVER if there is no steady cycle */
    int32_t period;
    char *no_cycle; /* why there is none; null: there is one */
    double mean_us; /* between two wafers' ends, over the middle third of at least nine; 0: there are fewer */
    bool is_steady; /* it was cut because it was steady: the cycle is that of a lot without end */
    size_t over;    /* wafers at their ends, without dummies */
    size_t left;    /* wafers that are not at their ends, with dummies */
    size_t lost;    /* wafers in stations that failed, or on arms with nowhere to go; not among those left */
    size_t skipped; /* wafers that were left in their carriers; not among those left */
    char *why;      /* null if done; see wh_flow_result_close */
    uint64_t asked; /* how often a rule was asked */
    /* Rule swap, several robots, and stations that lead back to themselves: wafers may block each other for
     * all that, since what one robot carries may be in the way of the others. */
    bool may_block;
} wh_flow_result_t;

/* Plays the plan from time 0 to its end. The plan must be finished (wh_flow_plan_finish). The listener,
 * which may be null, hears of each action when it has ended. Cost: for each instant at which something
 * happens, the robots times the steps of the routes; memory does not grow with time. Deterministic. */
void wh_flow_play(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_listener_t *listener,
                  wh_flow_result_t *result);
void wh_flow_result_close(wh_flow_result_t *result);

/* The steady cycle of placings at the wafers' ends: the least k up to 24 for which `ends[i + k] - ends[i]`
 * is the same to 1 us over the middle third; with real robots to 1 %, and the mean is taken. Returns null,
 * with k in `period` and that difference in `cycle_us`; or why there is none, by malloc, with 0 and
 * WH_FLOW_NEVER there: too few wafers, and how many would do; ends that do not repeat; ends that repeat
 * within a burst alone, faster than a station works; ends at one instant. */
char *wh_flow_find_cycle(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const int64_t *ends_us,
                         size_t count, int32_t *period, int64_t *cycle_us);

/* Why nobody can go on: each wafer that could be taken, what it waits for, and who stands there. The
 * caller frees it. */
char *wh_flow_stuck_text(const wh_flow_state_t *state);

#endif
