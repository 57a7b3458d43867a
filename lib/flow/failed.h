/* Stations that fail for ever: routes go on without them, or end. Nothing here costs anything while none has
 * failed.
 *
 * A step all of whose stations have failed is left out, and so is one behind it in whose place the wafer lies
 * already. A wafer that lies in a station that fails is lost. One that is picked there, or on its way, goes
 * on. */
#ifndef WH_FLOW_FAILED_H
#define WH_FLOW_FAILED_H

#include "state.h"

static inline bool wh_flow_has_failed(const wh_flow_state_t *state, int32_t station) {
    return state->stations[station].down_us == WH_FLOW_FOR_EVER;
}

/* True if all stations of the step have failed. */
bool wh_flow_step_has_failed(const wh_flow_state_t *state, const wh_flow_step_t *step);

/* The step behind this one for a wafer that lies in `place` (or WH_FLOW_NONE); WH_FLOW_NONE: its route ends
 * there. The first one is asked once some station has failed. */
int32_t wh_flow_following_open(const wh_flow_state_t *state, int32_t wafer, int32_t step, int32_t place);

static inline int32_t wh_flow_following(const wh_flow_state_t *state, int32_t wafer, int32_t step,
                                        int32_t place) {
    if (state->failures.stations > 0) {
        return wh_flow_following_open(state, wafer, step, place);
    }
    return step < wh_flow_last_step(state->plan, wafer) ? step + 1 : WH_FLOW_NONE;
}

/* The step to which the wafer goes, or has begun to go; WH_FLOW_NONE: none is left. */
static inline int32_t wh_flow_next_step(const wh_flow_state_t *state, int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    return at->toward != WH_FLOW_NONE ? at->toward : wh_flow_following(state, wafer, at->step, at->place);
}

/* The station at which the robot waits with a wafer has failed: chooses another place. True if it goes on
 * there; else it waits aboard, or its route ends on the arm. */
bool wh_flow_turn_away(wh_flow_state_t *state, int32_t robot, int32_t wafer, int32_t *place);

/* The wafer counts in its next step as it is now. False if none is left: it ends on the arm. */
bool wh_flow_recount(wh_flow_state_t *state, int32_t wafer);

/* Ends the routes of wafers that lie in stations that have failed, and of those with no step left. */
void wh_flow_end_routes(wh_flow_state_t *state);

#endif
