/* The waits of a flow, summed by cause; and who had the most to do. */
#ifndef WH_FLOW_WAITS_H
#define WH_FLOW_WAITS_H

#include "figures.h"

/* Either all robots' waiting for one thing (a wafer to be done, a place, a clean, a pump, a failure, another
 * robot), or all done wafers' waiting in their places for one robot or one station. */
typedef struct {
    const char *cause; /* of robots, such as "wafer"; null for wafers */
    int32_t robot, station;
    double us;
} wh_flow_wait_t;

/* Robots' waits, then wafers', each the longest first; those of no time are left out. The caller frees
 * them. */
wh_flow_wait_t *wh_flow_waits(const wh_flow_figures_t *figures, size_t *count);

/* The robot or the station that has the least time to spare: its share of the time in moves, picks, places,
 * swaps, doors, or in processes, cleans, pumps and handling. Both are WH_FLOW_NONE if nobody did anything. */
typedef struct {
    int32_t robot, station;
    double share;
} wh_flow_busy_t;

wh_flow_busy_t wh_flow_busiest(const wh_flow_figures_t *figures);

#endif
