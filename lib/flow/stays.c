#include "stays.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "transfer.h"

void wh_flow_stays_open(wh_flow_stays_t *stays, const wh_flow_tool_t *tool) {
    *stays = (wh_flow_stays_t){.windows = wh_array_new(tool->station_count, sizeof *stays->windows)};
}

void wh_flow_stays_close(wh_flow_stays_t *stays) {
    free(stays->windows);
    free(stays->late);
    memset(stays, 0, sizeof *stays);
}

/* An earlier one stays before a later one with an equal gap. */
static void keep_nearest(wh_flow_stays_t *stays, const wh_flow_stay_t *stay) {
    const int64_t gap_us = wh_flow_gap_us(stay);
    if (stays->nearest_count == WH_FLOW_NEAREST) {
        if (gap_us >= wh_flow_gap_us(&stays->nearest[WH_FLOW_NEAREST - 1])) {
            return;
        }
        --stays->nearest_count;
    }
    size_t at = stays->nearest_count++;
    for (; at > 0 && wh_flow_gap_us(&stays->nearest[at - 1]) > gap_us; --at) {
        stays->nearest[at] = stays->nearest[at - 1];
    }
    stays->nearest[at] = *stay;
}

static void add_to_window(wh_flow_stays_t *stays, const wh_flow_stay_t *stay) {
    wh_flow_window_t *window = &stays->windows[stay->station];
    const int64_t gap_us = wh_flow_gap_us(stay);
    if (window->count++ == 0 || gap_us < wh_flow_gap_us(&window->nearest)) {
        window->nearest = *stay;
    }
    keep_nearest(stays, stay);
    if (gap_us < 0) {
        ++window->late;
        stays->late =
            wh_array_grow(stays->late, stays->late_count, &stays->late_capacity, sizeof *stays->late);
        stays->late[stays->late_count++] = *stay;
    }
}

void wh_flow_stays_add(wh_flow_stays_t *stays, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    const int64_t window_us = state->tool->stations[event->station].window_us;
    const int64_t stay_us = wh_flow_stay_us(state, event);
    const bool has_window = window_us != WH_FLOW_NEVER;
    const bool is_behind = wh_flow_process_us(state, event->wafer, event->station) > 0 || has_window;
    if (event->step == 0 || !is_behind) {
        return;
    }
    stays->longest_us = stay_us > stays->longest_us ? stay_us : stays->longest_us;
    if (has_window) {
        const wh_flow_stay_t stay = {event->wafer,  event->station, event->step, event->end_us - stay_us,
                                     event->end_us, window_us};
        add_to_window(stays, &stay);
    }
}
