/* The seat of a wafer in an edge grip: its place once the plunger has closed.
 *
 * The slice in which the plunger meets a wafer decides it (grasp/edge.h), so the event of that slice gives
 * it. It becomes true unless the plunger is opened, or a fault keeps it from closing.
 */
#ifndef WH_RECORD_SEAT_H
#define WH_RECORD_SEAT_H

#include "record.h"

/* The seat by an event of this state, which is sound. There is none for events by which no edge grip takes
 * a wafer, and without a layout (null). Cost: that of wh_edge_at. */
wh_seat_t wh_seat_of(const wh_layout_t *layout, const wh_state_t *state, const wh_event_t *event);

#endif
