#include "pace.h"

bool wh_pace_validate(int64_t baud) {
    return baud == 0 || (baud >= WH_PACE_LEAST && baud <= WH_PACE_MOST);
}

size_t wh_pace_take(wh_pace_t *pace, size_t waiting, int64_t now_us) {
    if (pace->baud == 0 || waiting == 0) {
        pace->is_busy = false;
        return waiting;
    }
    if (!pace->is_busy) {
        pace->is_busy = true;
        pace->begin_us = now_us;
        pace->through = 0;
    }
    /* Byte n of the run is through when n + 1 bytes' bits fit into the time since it began. */
    const uint64_t bits_us = (uint64_t)(now_us - pace->begin_us) * (uint64_t)pace->baud;
    const uint64_t by_now = bits_us / (WH_PACE_BITS * 1000000ULL);
    const uint64_t news = by_now - pace->through;
    const size_t taken = news < waiting ? (size_t)news : waiting;
    pace->through += taken;
    pace->is_busy = taken < waiting;
    return taken;
}
