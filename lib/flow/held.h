/* Robots that are held: for a time that the plan gives, or as long as somebody's request stands. Either way a
 * robot begins nothing more until it is released.
 *
 * By the plan it ends what it has begun, with the way of the wafer that it has. So does one that is times
 * alone by a request. A real one stands at the end of the segment that runs, within its action; whoever
 * plays it tells that it stands. */
#ifndef WH_FLOW_HELD_H
#define WH_FLOW_HELD_H

#include "state.h"

/* ---- told between two instants; the next instant goes by it */

/* From now on a request holds the robot, or it does no more. */
void wh_flow_tell_hold(wh_flow_state_t *state, int32_t robot, bool is_held);

/* The real robot, which a request holds, stands within what it does. */
void wh_flow_tell_standing(wh_flow_state_t *state, int32_t robot);

/* ---- for the engine */

/* The plan holds the robot from now on, for so long. */
void wh_flow_begin_hold(wh_flow_state_t *state, const wh_flow_down_t *down);

/* Begins and ends what requests have told. */
void wh_flow_take_holds(wh_flow_state_t *state);

/* Tells the holds that end now. */
void wh_flow_end_holds(wh_flow_state_t *state);

/* The robot begins something else. */
void wh_flow_stand_anew(wh_flow_state_t *state, int32_t robot);

/* How long the robot has stood within its present action. */
int64_t wh_flow_stood_us(const wh_flow_state_t *state, int32_t robot);

/* True if a request holds any robot: it will go on once it is released. */
bool wh_flow_is_any_asked(const wh_flow_state_t *state);

#endif
