/* Load locks turn between two pressures. */
#ifndef WH_FLOW_LOCKS_H
#define WH_FLOW_LOCKS_H

#include "state.h"

/* Begins to pump a lock. False while it pumps already, a blade is in it, or its door is not shut. A lock
 * that has this pressure needs nothing: true. */
bool wh_flow_lock_pump(wh_flow_state_t *state, int32_t station, wh_flow_side_t side);

/* Turns the lock if it should: for transfers into it that have begun, else for wafers that could be carried
 * into or out of it, else for those in it; or by its own list. */
void wh_flow_lock_turn(wh_flow_state_t *state, int32_t station);

/* Robots have been asked: locks turn for the wafers that lists and functions have them bring from their
 * arms, if nobody has begun anything for another side. */
void wh_flow_locks_turn_for_kept(wh_flow_state_t *state);

#endif
