/* The needs of a transfer, and when it could be: asked by rules, and by the engine before it begins one. */
#ifndef WH_FLOW_TRANSFER_H
#define WH_FLOW_TRANSFER_H

#include "state.h"

/* Where a wafer would be placed, and from when on. */
typedef struct {
    int32_t place; /* WH_FLOW_NONE: no place is or will be empty, as far as what has begun tells */
    int64_t place_us;
} wh_flow_target_t;

/* The best place of the wafer's next step for a robot whose blade, with the wafer, could be in front of it
 * `loaded_us` after now plus the way from `from`. Best: placing can begin first, then longest empty, then as
 * listed. `station`: this one alone, or WH_FLOW_NONE. */
wh_flow_target_t wh_flow_target(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t from,
                                int64_t loaded_us, int32_t station);

/* All such places, at most `most` of them, the best first; their number. */
size_t wh_flow_targets(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t from,
                       int64_t loaded_us, int32_t station, wh_flow_target_t targets[], size_t most);

/* Likewise for a wafer that an exchange will take out: its own place is filled again. */
size_t wh_flow_swapped_targets(const wh_flow_state_t *state, int32_t robot, int32_t wafer,
                               wh_flow_target_t targets[], size_t most);

/* How many of the best places are looked at for one after which the tool is safe. */
#define WH_FLOW_TARGETS 64

/* How long after now the robot has the wafer if its pick, the door's opening included, begins at `begin_us`;
 * WH_FLOW_NEVER: nobody knows when, and the answer is a time after all that has begun. */
int64_t wh_flow_loaded_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us);

/* When the robot is in front of the wafer, and when its pick could begin then; WH_FLOW_NEVER: not known. */
int64_t wh_flow_begin_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t *there_us);

/* The best place for a wafer that is picked from `begin_us` on, WH_FLOW_NEVER: not known when; of those
 * after which the tool is safe, if that is checked. `station`: this one alone, or WH_FLOW_NONE.
 * WH_FLOW_NONE: there is none. */
int32_t wh_flow_safe_place(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us,
                           int32_t station);

/* swap: where a robot with two arms would go with a wafer that it takes from `begin_us` on, or
 * WH_FLOW_NONE: the exchanges that follow must end in a place that is or will be empty, and the tool must
 * be safe then. */
int32_t wh_flow_swap_way(const wh_flow_state_t *state, int32_t robot, int32_t wafer, int64_t begin_us);

/* How many wafers a step of a route holds, and how many it may: its places without those that hold or
 * await wafers of other steps and routes, and without those kept empty or, if more, those that have failed
 * and are empty. Picks that have begun and end by `at_us` have ended. So has the one of `leaver`, which is
 * about to be taken, or WH_FLOW_NONE. */
typedef struct {
    int32_t holds, may;
} wh_flow_room_t;
wh_flow_room_t wh_flow_room(const wh_flow_state_t *state, int32_t route, int32_t step, int64_t at_us,
                            int32_t leaver);

/* True if the robot serves the place in which the wafer lies and one of its next step, and nobody has
 * begun to take it. */
bool wh_flow_is_carrier(const wh_flow_state_t *state, int32_t robot, int32_t wafer);

/* True if a robot may take the wafer once it is there and done: it lies in a place that the robot serves,
 * nobody has begun to take it, the robot's arm for it is free, and a place of its next step is served,
 * too. */
bool wh_flow_may_take(const wh_flow_state_t *state, int32_t robot, int32_t wafer);

/* From when on the wafer may be taken: it is done, its station is free, up and at the robot's pressure,
 * and `takt` has run out, as far as what has begun tells. WH_FLOW_NEVER if that is not known: a lock at
 * another pressure that does not pump. */
int64_t wh_flow_takeable_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer);

/* For a robot in front of a wafer: the first time after now from which on a place of the wafer's next step
 * that is being emptied will be empty by the time the wafer comes there; WH_FLOW_NEVER: none is. */
int64_t wh_flow_in_time_us(const wh_flow_state_t *state, int32_t robot, int32_t wafer);

/* True if at this instant a robot that stands in front of the station may put its blade in: it is not in use,
 * its door is not shutting, it has not failed, and its pressure is the robot's. */
bool wh_flow_may_enter(const wh_flow_state_t *state, int32_t robot, int32_t station);

/* How long a wafer is processed in a station at its present step, us. */
int64_t wh_flow_process_us(const wh_flow_state_t *state, int32_t wafer, int32_t station);

/* The time for which a pick occupies the robot, its door's opening included. */
int64_t wh_flow_pick_us(const wh_flow_state_t *state, int32_t robot, int32_t station);

#endif
