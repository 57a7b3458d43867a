#include "event.h"

const char *wh_event_name(wh_event_kind_t kind) {
    static const char *const names[WH_EVENT_KINDS] = {
        [WH_EVENT_PICKED] = "picked",
        [WH_EVENT_RELEASED] = "released",
        [WH_EVENT_HANDED_OVER] = "handed_over",
        [WH_EVENT_NEAR_MISS] = "near_miss",
        [WH_EVENT_CONTESTED] = "contested",
        [WH_EVENT_BAD_INPUT] = "bad_input",
        [WH_EVENT_RELEASED_UNSUPPORTED] = "released_unsupported",
        [WH_EVENT_SLOT_OCCUPIED] = "slot_occupied",
        [WH_EVENT_PLACED_OFF_CENTRE] = "placed_off_centre",
        [WH_EVENT_PLACED_ASKEW] = "placed_askew",
        [WH_EVENT_SETTLED] = "settled",
        [WH_EVENT_HIT] = "hit",
        [WH_EVENT_UNDECIDED] = "undecided",
        [WH_EVENT_TOO_CLOSE] = "too_close",
        [WH_EVENT_SLIPPED] = "slipped",
        [WH_EVENT_VACUUM_LOST] = "vacuum_lost",
        [WH_EVENT_FAULT_ARMED] = "fault_armed",
        [WH_EVENT_FAULT_CLEARED] = "fault_cleared",
        [WH_EVENT_PUSHED_THROUGH] = "pushed_through",
    };
    return (unsigned)kind < WH_EVENT_KINDS ? names[kind] : "unknown";
}
