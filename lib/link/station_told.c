#include "station_told.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char *const sides[] = {"atmosphere", "vacuum", "both"};

#define SIDES (sizeof sides / sizeof sides[0])

void wh_station_told_write(const wh_station_event_record_t *event, char text[WH_STATION_TOLD_BYTES]) {
    const wh_clock_event_t *of = &event->event;
    (void)snprintf(text, WH_STATION_TOLD_BYTES,
                   "kind=%s station=%" PRId32 " slot=%" PRId32 " wafer=%" PRId32 " side=%s at=%" PRId64
                   " us=%" PRId64,
                   wh_clock_kind_name(of->kind), event->station, of->slot == WH_FLOW_NONE ? -1 : of->slot + 1,
                   of->wafer, sides[of->side], of->at_us, of->us);
}

/* The number of a kind or of a side; their counts: there is none of that name. */
static size_t find_kind(const char *name) {
    size_t kind = 0;
    while (kind < WH_CLOCK_KINDS && strcmp(wh_clock_kind_name((wh_clock_kind_t)kind), name) != 0) {
        ++kind;
    }
    return kind;
}

static size_t find_side(const char *name) {
    size_t side = 0;
    while (side < SIDES && strcmp(sides[side], name) != 0) {
        ++side;
    }
    return side;
}

bool wh_station_told_read(const char *text, size_t station_count, size_t wafer_count,
                          wh_station_event_record_t *event) {
    char kind[20];
    char side[12];
    int32_t slot = 0;
    wh_clock_event_t *of = &event->event;
    memset(event, 0, sizeof *event);
    const int read = sscanf(text,
                            "kind=%19[a-z_] station=%" SCNd32 " slot=%" SCNd32 " wafer=%" SCNd32
                            " side=%11[a-z] at=%" SCNd64 " us=%" SCNd64,
                            kind, &event->station, &slot, &of->wafer, side, &of->at_us, &of->us);
    if (read != 7 || find_kind(kind) == WH_CLOCK_KINDS || find_side(side) == SIDES) {
        return false;
    }
    of->kind = (wh_clock_kind_t)find_kind(kind);
    of->side = (wh_flow_side_t)find_side(side);
    of->slot = slot < 0 ? WH_FLOW_NONE : slot - 1;
    return wh_is_index(event->station, station_count) && slot != 0 && of->slot < WH_LAYOUT_SLOTS &&
           (of->wafer == WH_FLOW_NONE || wh_is_index(of->wafer, wafer_count)) && of->at_us >= 0;
}
