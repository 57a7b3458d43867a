/* Within the reading of a log. */
#ifndef WH_LOG_LOG_INTERNAL_H
#define WH_LOG_LOG_INTERNAL_H

#include "log_run.h"

/* A run begins, of which a state will be taken: what was collected of another is forgotten. */
void wh_log_begin_run(wh_log_run_t *run);

/* A state of the run; an older one and one once more are passed over. */
void wh_log_take_state(wh_log_run_t *run, const waferhand_state *message);

/* What motion control says of its commands. */
void wh_log_take_mcs(wh_log_run_t *run, const waferhand_mcs *message);

/* Whether a command begins or ends with the last slice. */
bool wh_log_is_boundary(const wh_log_run_t *run);

/* The log is over: closes the record and the trace. */
void wh_log_finish_run(wh_log_run_t *run);

/* Frees what was collected. */
void wh_log_drop_run(wh_log_run_t *run);

#endif
