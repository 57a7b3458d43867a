/* The best schedule of a flow that was found, for people and for programs.
 *
 * As JSON one object: format (1), script, rule_s (the makespan of the script's own rule), best_s (null: none
 * was found), bound_s (no schedule takes less), optimal, lacks_swaps (swaps are shorter than a pick and a
 * placing, and the lists have none), nodes (looked at), order: by robot the list of lines [from, to, wafer],
 * "keep" for an arm, as a flow's lists (null likewise)
 */
#ifndef WH_PRINT_BEST_PRINT_H
#define WH_PRINT_BEST_PRINT_H

#include <stdio.h>

#include "../flow/best.h"
#include "../text/style.h"

typedef struct {
    const char *script;
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    int64_t rule_us; /* the makespan of the script's own rule */
    const wh_flow_best_t *best;
} wh_best_result_t;

/* 0, or -1 if writing failed. */
int wh_best_print_table(const wh_best_result_t *result, FILE *out, const wh_style_t *style);
int wh_best_print_json(const wh_best_result_t *result, FILE *out);

#endif
