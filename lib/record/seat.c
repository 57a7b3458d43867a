#include "seat.h"

wh_seat_t wh_seat_of(const wh_layout_t *layout, const wh_state_t *state, const wh_event_t *event) {
    wh_seat_t seat = {0};
    const bool takes = event->kind == WH_EVENT_PICKED || event->kind == WH_EVENT_HANDED_OVER;
    if (!takes || !layout || layout->grips[event->gripper].kind != WH_GRIP_EDGE) {
        return seat;
    }
    const wh_edge_t *edge = &layout->grips[event->gripper].edge;
    const wh_grip_state_t *grip = &state->physics->grips[event->gripper];
    wh_edge_place_t place;
    if (grip->wafer == event->wafer && wh_edge_at(edge, &grip->lying, edge->end, &place) == WH_OK) {
        seat = (wh_seat_t){true, place.held, place.x, place.y, place.s};
    }
    return seat;
}
