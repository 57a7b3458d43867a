/* The best schedule of a small flow, by searching through the orders in which robots carry wafers.
 *
 * A schedule is built from the left: node after node one more doing of a robot begins, never before the one
 * that was added last. Each level of the search keeps the nodes that could still give the shortest
 * schedule, by a bound that no schedule can be below, and of equal places of all wafers those alone that no
 * other node beats in every time. If a level never had more than `width` nodes, or if the best schedule meets
 * the least bound of all that was left out, it is optimal.
 *
 * No schedule that is found has an exchange with two arms: keeping wafers on both arms stands in for it. If
 * exchanges take less than a pick and a placing, that is said, and a second search finds a bound that no
 * schedule with exchanges is below either.
 *
 * Small: at most 8 wafers, which lie there at time 0, 4 robots, and 24 places. The robots may keep wafers on
 * two arms. A station to which several robots come has one slot. There are no locks, doors, cleans, windows,
 * failures, takt, and no places that are kept empty. */
#ifndef WH_FLOW_BEST_H
#define WH_FLOW_BEST_H

#include "plan.h"

#define WH_BEST_WAFERS 8
#define WH_BEST_ROBOTS 4
#define WH_BEST_PLACES 24

typedef struct {
    int64_t makespan_us;   /* of the best schedule that was found; WH_FLOW_NEVER: none was */
    int64_t bound_us;      /* no schedule takes less */
    wh_flow_list_t *lists; /* by robot: that schedule, as a rule; null: none was found */
    uint64_t nodes;        /* that were looked at */
    bool lacks_swaps;      /* exchanges are shorter than a pick and a placing, and the lists have none */
} wh_flow_best_t;

/* Hears how far the search is, up to 1. */
typedef void wh_flow_best_progress_t(void *user, double share);

/* Why the flow is not of the small kind, to be freed; null: it is. */
char *wh_flow_best_refuses(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan);

/* Searches with at most `width` nodes a level. `progress` may be null. Deterministic. Cost: some 10 us a
 * node; about 1 kB for each node of two levels. Close the result in any case. */
void wh_flow_best(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, size_t width,
                  wh_flow_best_progress_t *progress, void *user, wh_flow_best_t *best);
void wh_flow_best_close(wh_flow_best_t *best, const wh_flow_tool_t *tool);

#endif
