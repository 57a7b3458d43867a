/* Between log_run.c, which reads a run slice by slice, and log_run_told.c, which takes what was told. */
#ifndef WH_LOG_LOG_RUN_INTERNAL_H
#define WH_LOG_LOG_RUN_INTERNAL_H

#include "log_run.h"

/* Takes a message over, unless it says nothing of a run. */
void wh_log_run_add_told(wh_log_run_t *run, waferhand_mcs *message);

/* Keeps what was told of the wanted run. */
void wh_log_run_choose_told(wh_log_run_t *run);

/* Takes what was told of slices before this one into the record. */
void wh_log_run_take_told_before(wh_log_run_t *run, int64_t seq);

/* Takes what motion control told last of all: the verdict. */
void wh_log_run_judge(wh_log_run_t *run);

#endif
