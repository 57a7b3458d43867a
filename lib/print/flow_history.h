/* Each wafer's history in a flow, one line for each change, in the order of time; and the states of
 * modules' places. The words are those of SEMI E90 (substrates) and E116 (equipment performance). */
#ifndef WH_PRINT_FLOW_HISTORY_H
#define WH_PRINT_FLOW_HISTORY_H

#include <stdbool.h>
#include <stdio.h>

#include "../flow/figures.h"

/* JSON lines, or a table of comma-separated values with the same columns: time_s; wafer, lot, place,
 * location (AtSource, AtWork, AtDestination), processing (NeedsProcessing, InProcess, Processed) of a
 * wafer; module, ept (BUSY, BLOCKED, IDLE) of a place that processes. A wafer has a line when its lot
 * arrives, when it is taken, placed, begins to be processed and has been. A module is BUSY while it
 * processes, BLOCKED until the wafer is taken, then IDLE. False if `out` does not take it. */
bool wh_flow_history_write(const wh_flow_figures_t *figures, bool is_csv, FILE *out);

#endif
