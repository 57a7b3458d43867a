/* Within motion control: playing segments, one at a time (play.c) or several (lanes.c). */
#ifndef WH_MCS_PLAYING_H
#define WH_MCS_PLAYING_H

#include "native.h"

/* The budget is charged for slices in portions, so that a long wait can be ended within one. */
#define WH_MCS_SLICES_PER_CHARGE 1024

/* The segment at stack index 1, a table or the number of a planned one: the track has begun it, and `planned`
 * tells what it is. Raises if that cannot be. */
void wh_mcs_begin_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned);

/* Sends the slice in which the track now is. If it was refused or did not go out, the track is again where it
 * was: at `before`. */
wh_status_t wh_mcs_play_slice(wh_mcs_t *mcs, const wh_real_t before[WH_AXES]);

/* The sensors as a track takes them that awaits this: of an end switch all are on, or none. */
uint32_t wh_mcs_sensors(const wh_mcs_t *mcs, const wh_awaited_t *awaited);

/* The table on top of the stack, { door = } or { gripper = }, says what is awaited; the segment at stack
 * index 1 has the timeout. */
void wh_mcs_await_arrival(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment, wh_awaited_t *awaited);

/* Before the first slice of a portion: one that was given up may be refused later. Then the next one has its
 * number, too. */
wh_status_t wh_mcs_resume(wh_mcs_t *mcs);

bool wh_mcs_stop_has_come(const wh_mcs_t *mcs);

/* The STOP that has come is heard; returns who sent it, a constant text, and writes what it ends: commands
 * that have one of these axes. */
const char *wh_mcs_take_stop(wh_mcs_t *mcs, uint32_t *axes);

/* Commands of tasks that wait for what others have end with this, for the reason `why`, a constant text. */
void wh_mcs_end_waits(wh_mcs_t *mcs, wh_status_t status, const char *why);

/* The link has answered a slice with this. A script may catch that its link was stopped, by a signal, but
 * only once: it would else not end. */
void wh_mcs_note_refused(wh_mcs_t *mcs, wh_status_t status);

/* Raises what the link has answered a slice with, once that was noted. */
void wh_mcs_raise_refused(lua_State *L, wh_mcs_t *mcs, wh_status_t status) __attribute__((noreturn));

#endif
