/* Within a log's run: what motion control told of it. */
#ifndef WH_LOG_LOG_RUN_INTERNAL_H
#define WH_LOG_LOG_RUN_INTERNAL_H

#include "log_run.h"

/* Keeps a message, unless it says nothing of a run. */
void wh_log_run_add_told(wh_log_run_t *run, const waferhand_mcs *message);

/* Keeps what was told of the wanted run alone, sorted. */
void wh_log_run_choose_told(wh_log_run_t *run);

/* Takes what was told of slices before this one. */
void wh_log_run_take_told(wh_log_run_t *run, int64_t seq);

/* How the run ended. */
void wh_log_run_judge(wh_log_run_t *run);

void wh_log_run_forget_told(wh_log_told_t *told);

#endif
