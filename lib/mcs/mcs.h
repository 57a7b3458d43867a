/* Motion control in the host: the C side under lua/mcs.
 *
 * Lua decides, this code executes. It reads the layout, plans segments and plays them slice by slice against
 * the simulator; a recorder keeps the results. A slice is a command in and a state out, over a link. Motion
 * control knows the cell only from the layout and the states. Lua sees it as a table of functions that only
 * lua/mcs has; scripts see the operator's words that lua/mcs/init.lua makes from them.
 */
#ifndef WH_MCS_MCS_H
#define WH_MCS_MCS_H

#include "state.h"

/* ------------------------------------------------------------------------------------------- questions */

/* The cell's layout; null until the script has named it. */
const wh_layout_t *wh_mcs_layout(const wh_mcs_t *mcs);

/* The layout with a trial's errors, which the simulator goes by; for reports. */
const wh_layout_t *wh_mcs_true_layout(const wh_mcs_t *mcs);

/* The run's link; null until connected. */
wh_link_t *wh_mcs_link(const wh_mcs_t *mcs);

/* Commands, expectations, cycles and events. */
const wh_record_t *wh_mcs_record(const wh_mcs_t *mcs);

/* True if a script's file is run: only then does the run have a verdict. False: lines of a session. */
bool wh_mcs_is_script(const wh_mcs_t *mcs);

/* Simulated microseconds so far. */
int64_t wh_mcs_utime(const wh_mcs_t *mcs);

/* The number of the running task; 0: the script itself. */
int32_t wh_mcs_task(const wh_mcs_t *mcs);

/* The text of the running command; null: none runs. */
const char *wh_mcs_running_text(const wh_mcs_t *mcs);

/* The lane of the current task, once there are tasks. */
const wh_lane_t *wh_mcs_current_lane(const wh_mcs_t *mcs);

/* The last scan, pass and centring. */
const wh_mcs_measuring_t *wh_mcs_measuring(const wh_mcs_t *mcs);

/* Empty unless wanted. */
const wh_mcs_kept_t *wh_mcs_kept(const wh_mcs_t *mcs);

/* Opens the operator's words in a sandbox for one run of `script`. `mcs` and `record` must outlive the
 * sandbox. False, and the reason in `result`, if the sandbox has no room for it. */
bool wh_mcs_open(wh_mcs_t *mcs, wh_sandbox_t *sandbox, const char *script, wh_record_t *record,
                 wh_sandbox_result_t *result);

/* Leaves three functions on the stack of L, within a protected call: one executes a typed line, one
 * completes a line, one plays jobs. See lua/mcs/prompt.lua, lua/mcs/completion.lua and
 * lua/mcs/tasks.lua. */
void wh_mcs_push_prompt(lua_State *L);

/* Call it protected at the end of a script: the run ends when all its tasks are over. Raises the error of
 * a failed task if no other task has got it. */
int wh_mcs_wait_for_tasks(lua_State *L);

/* A script has failed: the running commands of its tasks end where they are. */
void wh_mcs_stop_tasks(wh_mcs_t *mcs);

/* Takes a state that the link has received, in the order of arrival. States of exchanges need not be
 * passed. */
void wh_mcs_hear(wh_mcs_t *mcs, const wh_state_t *state);

/* A STOP, from within the link's exchange or between two commands: the running command ends with
 * WH_STATUS_STOPPED after this slice, the next one before its first. A script can catch that error. */
void wh_mcs_stop(wh_mcs_t *mcs);

#define WH_MCS_ALL UINT32_MAX

/* Bits of a robot's axes. */
uint32_t wh_mcs_robot_axes(const wh_machine_t *machine, size_t robot);

/* Finds the axes, bits, of a mechanism by its name: "robot" (all robots), a robot's name, or the name of a
 * chuck's gripper or its station. False if the cell has none of that name. */
bool wh_mcs_find_mechanism(const wh_mcs_t *mcs, const char *name, uint32_t *axes);

/* A STOP of that mechanism: only the command that has it ends, as by wh_mcs_stop. Without one it does
 * nothing. False if there is no such mechanism. */
bool wh_mcs_stop_mechanism(wh_mcs_t *mcs, const char *name);

/* A STOP while no command runs and none will come. This robot's held command is given up, the arm stands in
 * the station, and RECOVER or HOME must bring it out. Without a held command it does nothing. WH_NONE: all
 * robots. */
void wh_mcs_give_up(wh_mcs_t *mcs, int32_t robot);

/* This robot's held command; WH_NONE: the first held command of any robot. Null: none. */
const wh_mcs_held_t *wh_mcs_find_held(const wh_mcs_t *mcs, int32_t robot);

/* A job has come while others are played: from within a slice. */
void wh_mcs_call(wh_mcs_t *mcs);

/* The job's command ends after this slice with `status`, for the reason `why`, a constant text. Its next
 * line is not played. If the job is not being played, nothing changes. */
void wh_mcs_end_job(wh_mcs_t *mcs, int32_t job, wh_status_t status, const char *why);

/* True if a robot's controller has ended its motion, which the next slice would tell. */
bool wh_mcs_is_to_end(const wh_mcs_t *mcs);

/* The job's motion stands still after this slice, while others go on; or it goes on, from there. */
void wh_mcs_hold_job(wh_mcs_t *mcs, int32_t job, bool is_held);

/* A STOP that comes next ends what stands still: nothing slows down. */
void wh_mcs_stop_standing(wh_mcs_t *mcs);

/* True while the job waits for something that another one has, and may not wait for ever. */
bool wh_mcs_job_waits(const wh_mcs_t *mcs, int32_t job);

/* True if this error was armed, by fault { error = N } of this job or of none; it is then disarmed. For
 * a caller that answers in place of motion control, such as a busy port. */
bool wh_mcs_take_alarm(wh_mcs_t *mcs, wh_status_t error, int32_t job);

/* The faults that have not begun by now, and the errors that still wait for a command, as a list in words:
 * what they were to show was not tried. Null: there are none; to be freed. */
char *wh_mcs_tell_never_came(const wh_mcs_t *mcs);

/* Room for the text of wh_mcs_describe. */
#define WH_MCS_DESCRIPTION_BYTES 24576

/* Describes what motion control does, as name=value pairs with blanks between them, spelt as in answers at
 * the prompt. `phase` is idle, running or held. `command` runs or is held (`taskn.command` for task n); if
 * held, `stop` is its phase. `seq` and `time` (s) are of the last slice whose state has come, 0 before the
 * first. For that slice `theta` and `yaw` (degrees), `r` and `z` (mm) are the commanded axes, and `holds`
 * is the wafer of each gripper. `error` is the number of the last failed command in this run, with its
 * `error_name` and `error_command`, or 0. May be called from within the link's exchange. */
void wh_mcs_describe(const wh_mcs_t *mcs, char text[WH_MCS_DESCRIPTION_BYTES]);

/* The poses of the grippers at the axes of that slice, base_from_gripper; none without a cell. */
void wh_mcs_see_grippers(const wh_mcs_t *mcs, wh_pose_t poses[WH_GRIPPERS]);

/* A load port as it is now: names, which live as long as the layout; null: none. */
typedef struct {
    const char *is;      /* the state that it has reached */
    const char *does;    /* the step that runs */
    const char *carrier; /* that is there, comes or goes */
    const char *failed;  /* the step that ended its last handshake */
} wh_mcs_load_port_t;

/* False: the station is none. */
bool wh_mcs_see_load_port(const wh_mcs_t *mcs, size_t station, wh_mcs_load_port_t *seen);

/* "open", "shut" or "moving", from the door's switches. */
const char *wh_mcs_door_word(const wh_mcs_t *mcs, size_t door);

/* Room for the text of wh_mcs_name_mechanisms. */
#define WH_MCS_MECHANISMS_BYTES ((WH_LAYOUT_ROBOTS + WH_GRIPPERS + WH_DOORS) * (WH_NAME_SIZE + 2))

/* Writes the names of the mechanisms that have these axes (bits): the robots, then each chuck's gripper,
 * with commas between them; empty for none. */
void wh_mcs_name_mechanisms(const wh_mcs_t *mcs, uint32_t axes, char text[WH_MCS_MECHANISMS_BYTES]);

/* The running command has ended with an error outside of Lua. Without a running command it does
 * nothing. */
void wh_mcs_cut_short(wh_mcs_t *mcs, wh_status_t error, const char *message);

/* Reports and records a command that failed before its first slice. No command may be running. */
void wh_mcs_refuse(wh_mcs_t *mcs, const char *text, wh_status_t error, const char *message);

/* Closes the record: wafers, slices, hash. The sandbox must still be there. */
void wh_mcs_finish(wh_mcs_t *mcs);

/* Frees the data that the run collected; the record stays with its owner. */
void wh_mcs_close(wh_mcs_t *mcs);

#endif
