/* The seat of a wafer in an edge grip: where it lies once the plunger has closed.
 *
 * The slice in which the plunger meets a wafer decides it (grasp/edge.h), so the event of that slice tells.
 * It comes to pass unless the plunger is opened, or kept from closing by a fault.
 */
#ifndef WH_RECORD_SEAT_H
#define WH_RECORD_SEAT_H

#include "record.h"

/* Of an event of this state, which is sound. Not there: of events by which no edge grip takes a wafer, and
 * without a layout (null).
 * Cost: that of wh_edge_at. */
wh_seat_t wh_seat_of(const wh_layout_t *layout, const wh_state_t *state, const wh_event_t *event);

#endif
