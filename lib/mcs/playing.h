/* Within motion control: playing segments, one at a time (play.c) or several (lanes.c). */
#ifndef WH_MCS_PLAYING_H
#define WH_MCS_PLAYING_H

#include "native.h"

/* The budget is charged for slices in portions, so that a long wait can end within a portion. */
#define WH_MCS_SLICES_PER_CHARGE 1024

/* Raises the error of a request, the table at stack index 1. Its `where` and its `target` tell the place of
 * the arm: "on the way into A slot 3". */
void wh_mcs_refuse_request(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *reason);

/* Reads the segment table at stack index 1. It has one of axes, line (with speed, acceleration and the
 * gripper that goes), valves, dwell, sensor (with timeout), arrives (likewise). Raises if it has none. */
wh_segment_t wh_mcs_read_segment(lua_State *L, wh_mcs_t *mcs, wh_awaited_t *awaited);

/* Begins the segment at stack index 1, a table or the number of a planned one, in the track, and describes it
 * in `planned`. Raises if that fails. */
void wh_mcs_begin_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned);

/* Sends the slice in which the track now is. If it was refused or did not go out, the track goes back to
 * `before`. */
wh_status_t wh_mcs_play_slice(wh_mcs_t *mcs, const wh_real_t before[WH_AXES]);

/* With tasks: the track and the recorder have the running segments of all tasks. */
void wh_mcs_show_lanes(wh_mcs_t *mcs);

/* The sensors for a track that awaits this. For an end switch all bits are on, or none. */
uint32_t wh_mcs_sensors(const wh_mcs_t *mcs, const wh_awaited_t *awaited);

/* Reads what is awaited from the table on top of the stack, { door = }, { gripper = } or { station = }; the
 * segment at stack index 1 has the timeout. */
void wh_mcs_await_arrival(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment, wh_awaited_t *awaited);

/* Call it before the first slice of a portion. A slice that was given up may be refused later; the next one
 * then has its number. */
wh_status_t wh_mcs_resume(wh_mcs_t *mcs);

bool wh_mcs_stop_has_come(const wh_mcs_t *mcs);

/* True for a STOP that does not come at a slice, or the end of a motion by its robot's controller. */
bool wh_mcs_is_told_to_stop(const wh_mcs_t *mcs);

/* Takes the STOP that has come. Returns its sender, a constant text, and writes the axes; commands that
 * have one of them end. */
const char *wh_mcs_take_stop(wh_mcs_t *mcs, uint32_t *axes);

/* Begins to slow down what a track moves. False: it stands at once, for so it is in this cell, or nothing
 * moves. */
bool wh_mcs_begin_ramp(wh_mcs_t *mcs, wh_ramp_t *ramp, const wh_track_t *track);

/* Stops a lane's segment: it slows down, if it is one that moves in a cell where that is so; else it ends at
 * once. `after`: what ends its job then; WH_OK: the segment was given up. */
void wh_mcs_stop_lane(wh_mcs_t *mcs, wh_lane_t *lane, wh_status_t after);

/* Ends the commands of waiting tasks with this status, for the reason `why`, a constant text. */
void wh_mcs_end_waits(wh_mcs_t *mcs, wh_status_t status, const char *why);

/* The link has answered a slice with this status. A script may catch a signal's stop of its link only
 * once, or it would not end. */
void wh_mcs_note_refused(wh_mcs_t *mcs, wh_status_t status);

/* Raises the status with which the link has answered a slice, after it was noted. */
void wh_mcs_raise_refused(lua_State *L, wh_mcs_t *mcs, wh_status_t status) __attribute__((noreturn));

#endif
