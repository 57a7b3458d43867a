/* Stays of wafers behind their processes, against the windows of their stations: those that were too long,
 * and those that came nearest to it. */
#ifndef WH_FLOW_STAYS_H
#define WH_FLOW_STAYS_H

#include "state.h"

/* How many of the smallest gaps are kept. */
#define WH_FLOW_NEAREST 20

/* From the end of the process to the begin of the pick. */
typedef struct {
    int32_t wafer, station, step;
    int64_t done_us, taken_us, window_us;
} wh_flow_stay_t;

/* All stays in one station; without a window there are none. */
typedef struct {
    size_t count, late;
    wh_flow_stay_t nearest; /* the one with the smallest gap, or the longest beyond the window */
} wh_flow_window_t;

typedef struct {
    wh_flow_window_t *windows; /* by station */
    wh_flow_stay_t *late;      /* beyond their windows, in the order of their ends */
    size_t late_count, late_capacity;
    /* The smallest gap first, those beyond their windows with them. */
    wh_flow_stay_t nearest[WH_FLOW_NEAREST];
    size_t nearest_count;
    int64_t longest_us; /* behind a process */
} wh_flow_stays_t;

/* How much is left of the window; below 0: the stay is beyond it by so much. */
static inline int64_t wh_flow_gap_us(const wh_flow_stay_t *stay) {
    return stay->window_us - (stay->taken_us - stay->done_us);
}

void wh_flow_stays_open(wh_flow_stays_t *stays, const wh_flow_tool_t *tool);
void wh_flow_stays_close(wh_flow_stays_t *stays);

/* Takes a stay (WH_FLOW_EVENT_STAY), before the wafer is placed elsewhere; one in its first place does not
 * count. */
void wh_flow_stays_add(wh_flow_stays_t *stays, const wh_flow_state_t *state, const wh_flow_event_t *event);

#endif
