/* Which drawn error of a study costs most. */
#ifndef WH_PRINT_STUDY_CAUSES_H
#define WH_PRINT_STUDY_CAUSES_H

#include <jansson.h>

#include "study_print.h"

/* A drawn error, and its correlations. */
typedef struct {
    const wh_cause_t *cause;
    size_t index;              /* among the study's causes */
    wh_correlation_t by_size;  /* of failing with the size of the draw */
    wh_correlation_t by_value; /* with the value; not determined for delays, which have one direction */
    wh_correlation_t end;      /* the strongest of those with the ends of wafers, and a flow's figures */
    size_t wafer, quantity;    /* to which it belongs, when it is determined */
    bool is_flow;              /* it is of the flow, and `quantity` a wh_flow_sum_t */
} wh_cause_told_t;

/* All of them, to be freed. The one that correlates with failing most strongly comes first; then those whose
 * correlation is not determined, by `end`; then the rest in the order of drawing. Their count is
 * study->cause_count. */
wh_cause_told_t *wh_causes_told(const wh_study_result_t *result);

/* "Wafer 1 dx mm", "vacuum s". */
#define WH_CAUSE_NAME 190
void wh_cause_name(const wh_cause_t *cause, const wh_layout_t *layout, char name[WH_CAUSE_NAME]);

/* The list `drawn` of print/study_print.h. */
json_t *wh_causes_to_json(const wh_study_result_t *result);

#endif
