/* Between log_run.c, which reads a run slice by slice, log_run_told.c, which takes what was told,
 * log_run_lanes.c, which keeps several commands apart, and log_run_passes.c, which puts together what beams
 * told. */
#ifndef WH_LOG_LOG_RUN_INTERNAL_H
#define WH_LOG_LOG_RUN_INTERNAL_H

#include "log_run.h"

/* Takes a message over, unless it says nothing of a run. */
void wh_log_run_add_told(wh_log_run_t *run, waferhand_mcs *message);

/* Keeps what was told of the wanted run. */
void wh_log_run_choose_told(wh_log_run_t *run);

/* Takes what was told of slices before this one into the record. */
void wh_log_run_take_told_before(wh_log_run_t *run, int64_t seq);

/* The lane of a task that runs a command, or null. */
wh_log_lane_t *wh_log_run_find_lane(wh_log_run_t *run, int32_t task);

/* What is told to the recorder next is of this task. */
void wh_log_run_choose_task(wh_log_run_t *run, int32_t task);

/* What the recorder now runs for that task is kept. */
void wh_log_run_keep_task(wh_log_run_t *run);

/* Before the events of a slice: the recorder's parts are the commands that run, once there are tasks. */
void wh_log_run_set_parts(wh_log_run_t *run);

/* Before the recorder counts the slice, and while `last` is the one before: what each part does in it. */
void wh_log_run_count_parts(wh_log_run_t *run, const bool moving[WH_AXES]);

/* True if this slice's valve of the gripper, told before faults, has switched: motion control may wait for it
 * from then on, for vacuum that builds up or goes, or for an edge grip's plunger. */
bool wh_log_run_begins_wait(const wh_log_run_t *run, size_t g);

/* What the state of an accepted slice tells of beams: a pass that has ended is added to the record. */
void wh_log_run_hear_passes(wh_log_run_t *run);
void wh_log_run_close_passes(wh_log_run_t *run);

/* Takes what motion control told last of all: the verdict. */
void wh_log_run_judge(wh_log_run_t *run);

#endif
