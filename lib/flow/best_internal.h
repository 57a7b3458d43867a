/* Within the search for the best schedule: its nodes, and the bound. */
#ifndef WH_FLOW_BEST_INTERNAL_H
#define WH_FLOW_BEST_INTERNAL_H

#include "best.h"

#define HOME (-1) /* in its first place */
#define OVER (-2)
#define ON_ARM(robot) (-3 - (robot)) /* on an arm of that robot */

typedef struct {
    int64_t now_us, bound_us, rest_us; /* rest: of equal bounds the lesser one is the better */
    uint64_t kind;                     /* hash of all but times */
    int32_t parent;                    /* the step by which it came: see step_t */
    int16_t step[WH_BEST_WAFERS];
    int16_t at[WH_BEST_WAFERS]; /* a place, HOME, OVER, or an arm */
    int64_t ready_us[WH_BEST_WAFERS];
    int16_t robot_at[WH_BEST_ROBOTS]; /* the station */
    int64_t free_us[WH_BEST_ROBOTS];
    int16_t wafer[WH_BEST_PLACES];     /* that lies there, or WH_FLOW_NONE */
    int64_t picked_us[WH_BEST_PLACES]; /* the begin of the last pick out of it */
    int64_t empty_us[WH_BEST_PLACES];  /* and its end */
    int64_t taken_us[WH_BEST_PLACES];  /* the begin of the last doing that brought a wafer there */
} node_t;

static inline int64_t later(int64_t a, int64_t b) {
    return a > b ? a : b;
}

/* Shared by all nodes. */
typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    int32_t wafers, robots, places;
    /* The only robot of the place's station, if it has one arm; else WH_FLOW_NONE. */
    int32_t carrier[WH_BEST_PLACES];
} problem_t;

/* The places of all steps but the last ones, and which stations have them. */
int32_t wh_best_places(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, bool used[]);

/* The least time from the begin of the pick out of step k to the end of the placing in step k + 1. */
int64_t wh_best_carry_us(const problem_t *problem, int32_t wafer, int32_t k);

/* Fills in bound_us and rest_us. */
void wh_best_bound(const problem_t *problem, node_t *node);

/* The node's `kind`. Wafers of one lot in their first places are alike: they are taken in order. */
uint64_t wh_best_kind(const problem_t *problem, const node_t *node);

/* Puts the nodes in order of their bounds. */
void wh_best_sort(node_t nodes[], size_t count);

/* Drops each node from which nothing can go on that could not go on as early from another one of its kind.
 * Returns how many are left. */
size_t wh_best_drop_beaten(const problem_t *problem, node_t nodes[], size_t count);

#endif
