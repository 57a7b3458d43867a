/* Writes what a flow played as a schedule. */
#ifndef WH_SCHEDULE_WRITE_H
#define WH_SCHEDULE_WRITE_H

#include <stdio.h>

#include "../flow/figures.h"

/* A table with all columns, by the begin of the rows: where wafers lie at first, robots' moves, picks, places
 * and swaps, processes, cleans, pumps, doors. Actions that have not ended when the flow ends are left out;
 * so are failures, which a schedule does not know. The figures must have visits and ways. False if `out`
 * does not take it. */
bool wh_schedule_write(const wh_flow_figures_t *figures, FILE *out);

#endif
