/* Carriers that call at load ports with their lots: they come, stay until their lots are over, and go.
 *
 * A carrier comes once its first lot arrives and the port is free. Its wafers may be taken when it is open
 * and mapped. It is closed and taken away once all of them are at their ends, and no wafer of another lot is
 * still to end there. In a tool of times alone each takes the port's seconds; in a cell with axes somebody
 * else tells when it is done (wh_flow_tell_call), and a carrier goes only if its lot says so, or if the next
 * one waits for its port. A timed port at which no lot begins has one carrier after the other: when all of
 * its places have wafers at their ends, it is changed for an empty one. */
#ifndef WH_FLOW_CALLS_H
#define WH_FLOW_CALLS_H

#include "state.h"

/* True if no blade may enter the station because no open carrier stands there. The first one is asked of
 * stations with carriers. */
bool wh_flow_is_without_carrier(const wh_flow_state_t *state, int32_t station);

static inline bool wh_flow_is_port_shut(const wh_flow_state_t *state, int32_t station) {
    return state->tool->stations[station].has_carriers && wh_flow_is_without_carrier(state, station);
}

/* True for a timed port at which no lot begins: wafers end there, in one carrier after the other. */
bool wh_flow_is_for_ends(const wh_flow_state_t *state, int32_t station);

/* Carriers come and go at this instant, as far as they can. True if any phase of a call ended or began. */
bool wh_flow_calls_go(wh_flow_state_t *state);

/* True if the lot may come now, as far as its carrier is concerned. */
bool wh_flow_has_called(const wh_flow_state_t *state, size_t lot);

/* The next time at which a carrier has come or gone by itself, or WH_FLOW_NEVER. */
int64_t wh_flow_calls_next(const wh_flow_state_t *state);

/* True if every wafer of the lot is at its end. */
bool wh_flow_is_lot_over(const wh_flow_state_t *state, int32_t lot);

/* True if a wafer that has come is still to end in the station, or to pass it. */
bool wh_flow_is_awaited(const wh_flow_state_t *state, int32_t station);

#endif
