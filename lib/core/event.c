#include "core/event.h"

const char *wh_event_name(wh_event_kind_t kind) {
    switch (kind) {
    case WH_EVENT_PICKED:
        return "picked";
    case WH_EVENT_RELEASED:
        return "released";
    case WH_EVENT_HANDED_OVER:
        return "handed_over";
    case WH_EVENT_NEAR_MISS:
        return "near_miss";
    case WH_EVENT_CONTESTED:
        return "contested";
    case WH_EVENT_BAD_INPUT:
        return "bad_input";
    case WH_EVENT_RELEASED_UNSUPPORTED:
        return "released_unsupported";
    case WH_EVENT_SLOT_OCCUPIED:
        return "slot_occupied";
    }
    return "unknown";
}
