/* Robots, doors and stations that are real: somebody else plays them, slice by slice. The engine
 * begins their actions, as it does those of timed ones. It is told their ends here. Timed robots may stand
 * among them: their actions end by themselves, with a slice, but for the opening of real doors.
 *
 * Nobody knows beforehand how long they take. Where a rule asks when a placing could begin, a robot takes as
 * long as the last time: for this pick, placing or swap at this station, for this pair of stations, for this
 * door; 0 s before the first time. A station takes what its clock has left. An estimate decides what is begun
 * first, never whether it can be: each action waits until its place is empty and its wafer is done.
 */
#ifndef WH_FLOW_OUTSIDE_H
#define WH_FLOW_OUTSIDE_H

#include "clock.h"
#include "state.h"

/* ---- told between two instants; the next instant goes by it */

/* The real robot's action has ended. */
void wh_flow_tell_end(wh_flow_state_t *state, int32_t robot);

/* The station's real door is shut behind a blade. */
void wh_flow_tell_shut(wh_flow_state_t *state, int32_t station);

/* The carrier that came to the real load port is open and mapped, or the one that went is gone. */
void wh_flow_tell_call(wh_flow_state_t *state, int32_t station);

/* The work in a step, an ALIGN or a FLIP, has ended. */
void wh_flow_tell_worked(wh_flow_state_t *state, int32_t station);

/* ---- told while the engine hears: see wh_flow_outside_t */

/* A process, a clean (around a wafer, or without one: WH_FLOW_NONE) or a pump has ended. */
void wh_flow_tell_process(wh_flow_state_t *state, int32_t wafer, int64_t begin_us, int64_t end_us);
void wh_flow_tell_clean(wh_flow_state_t *state, int32_t place, int32_t wafer, int64_t begin_us,
                        int64_t end_us);
void wh_flow_tell_pump(wh_flow_state_t *state, int32_t station, int64_t begin_us, int64_t end_us);

/* A wafer that was done from `done_us` on was lifted at `lifted_us`, and has left the station. */
void wh_flow_tell_left(wh_flow_state_t *state, int32_t wafer, int64_t done_us, int64_t lifted_us);

/* Something has begun in the station for which its doors must be shut: by their switches, if not to their
 * ends. */
void wh_flow_tell_closed(wh_flow_state_t *state, int32_t station, int64_t at_us);

/* ---- told while it looks */

/* The station's clock stands so; `of` is the station as it truly is, `began_us` the clock's time when the
 * flow began. */
void wh_flow_see_station(wh_flow_state_t *state, int32_t station, const wh_flow_station_t *of,
                         const wh_clock_t *clock, const wh_clock_place_t places[], int64_t began_us);

/* The load port stands so. `has_carrier`: one is there, comes or goes; `runs`: a step. */
void wh_flow_see_port(wh_flow_state_t *state, int32_t station, bool is_open, bool has_carrier, bool runs);

/* True if wafers that have come are to leave the load port, to end in it or to pass it. */
bool wh_flow_is_port_needed(const wh_flow_state_t *state, int32_t station);

/* ---- for the engine */

/* True if somebody else plays what the robot does now: it is real, or opens a real door. */
bool wh_flow_is_played(const wh_flow_state_t *state, int32_t robot);

/* Keeps how long an action took that somebody else has played, and that has just ended. */
void wh_flow_learn(wh_flow_state_t *state, int32_t robot);

/* A wafer was placed. True if the station is real, or something is done with the wafer there: its end will be
 * told. */
bool wh_flow_begin_real(wh_flow_state_t *state, int32_t wafer, int32_t station);

/* Asks a real lock to pump; true also of a lock that is not real. */
bool wh_flow_pump_real(wh_flow_state_t *state, int32_t station, wh_flow_side_t side);

void wh_flow_set_down(const wh_flow_state_t *state, int32_t station, bool is_down);

/* Ends what was told between two instants, but robots' actions. */
void wh_flow_end_told(wh_flow_state_t *state);

/* True while something real goes on, whose end will be told, or a request holds a robot. */
bool wh_flow_is_real_busy(const wh_flow_state_t *state);

#endif
