/* Shared by log_run.c, which reads a run, log_run_states.c, which takes its slices, log_run_told.c, which
 * takes the messages of motion control, log_run_lanes.c, which separates parallel commands, and
 * log_run_passes.c, which collects the passes through beams. */
#ifndef WH_LOG_LOG_RUN_INTERNAL_H
#define WH_LOG_LOG_RUN_INTERNAL_H

#include "log_run.h"

/* The replay's listeners, with the run as their user: one hears recorded states, the other a simulator's
 * own. */
void wh_log_run_on_state(void *user, const waferhand_command *command, const waferhand_state *message);
void wh_log_run_on_stepped(void *user, const waferhand_command *command, const wh_protocol_server_t *server);

/* Takes a message over, if it belongs to a run. */
void wh_log_run_add_told(wh_log_run_t *run, waferhand_mcs *message);

/* Keeps the messages of the wanted run. */
void wh_log_run_choose_told(wh_log_run_t *run);

/* Takes the messages about slices before this one into the record. */
void wh_log_run_take_told_before(wh_log_run_t *run, int64_t seq);

/* The lane of a task that runs a command, or null. */
wh_log_lane_t *wh_log_run_find_lane(wh_log_run_t *run, int32_t task);

/* The recorder's next data belongs to this task. */
void wh_log_run_choose_task(wh_log_run_t *run, int32_t task);

/* Keeps the recorder's running command for that task. */
void wh_log_run_keep_task(wh_log_run_t *run);

/* Call it before the events of a slice: once there are tasks, the recorder's parts are the running
 * commands. */
void wh_log_run_set_parts(wh_log_run_t *run);

/* Call it before the recorder counts the slice, while `last` is the previous one: counts the activity of
 * each part. */
void wh_log_run_count_parts(wh_log_run_t *run, const bool moving[WH_AXES]);

/* True if the gripper's commanded valve, before faults, has switched in this slice. From then on motion
 * control may wait, for the vacuum to build up or to vent, or for an edge grip's plunger. */
bool wh_log_run_begins_wait(const wh_log_run_t *run, size_t g);

/* Takes the beams' latches from the state of an accepted slice; a pass that has ended is added to the
 * record. */
void wh_log_run_hear_passes(wh_log_run_t *run);
void wh_log_run_close_passes(wh_log_run_t *run);

/* Takes motion control's last message: the verdict. */
void wh_log_run_judge(wh_log_run_t *run);

#endif
