#include "cell/station.h"

/* How far a wafer is above what is under it: the nearest slot plane below, or base's floor. */
static wh_real_t height_above_support(const wh_cell_t *cell, const wh_pose_t *base_from_wafer) {
    wh_real_t height = base_from_wafer->r.z;
    bool found = false;
    for (size_t s = 0; s < cell->count; ++s) {
        const wh_station_t *station = &cell->stations[s];
        for (int32_t slot = 1; slot <= station->slots; ++slot) {
            const wh_place_t place = wh_station_measure(station, slot, base_from_wafer);
            const wh_real_t aside = wh_real_sqrt(place.dx * place.dx + place.dy * place.dy);
            if (aside < cell->tolerance.projxy && place.dz >= 0 && (!found || place.dz < height)) {
                height = place.dz;
                found = true;
            }
        }
    }
    return height;
}

/* Whether a wafer lies in this very slot. One that a blade holds over it does not: it passes. */
static bool occupies(const wh_cell_t *cell, const wh_wafer_t *wafer, const wh_place_t *place) {
    wh_place_t other;
    return (wafer->holder == WH_NONE || wafer->holder == cell->stations[place->station].chuck) &&
           wh_cell_locate(cell, &wafer->base_from_wafer, &other) && other.station == place->station &&
           other.slot == place->slot;
}

static int32_t find_other(const wh_cell_t *cell, const wh_grasp_t *table, int32_t wafer,
                          const wh_place_t *place) {
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        if ((int32_t)w != wafer && occupies(cell, &table->storage.wafers[w], place)) {
            return (int32_t)w;
        }
    }
    return WH_NONE;
}

/* What the cell has to say of one release: true when there is something, then in `said`. */
static bool judge_release(const wh_cell_t *cell, const wh_grasp_t *table, const wh_event_t *release,
                          wh_event_t *said) {
    const wh_pose_t *base_from_wafer = &table->storage.wafers[release->wafer].base_from_wafer;
    wh_place_t place;
    *said = *release;
    if (!wh_cell_locate(cell, base_from_wafer, &place)) {
        said->kind = WH_EVENT_RELEASED_UNSUPPORTED;
        said->height = height_above_support(cell, base_from_wafer);
        return true;
    }
    said->kind = WH_EVENT_SLOT_OCCUPIED;
    said->other = find_other(cell, table, release->wafer, &place);
    return said->other != WH_NONE;
}

size_t wh_cell_judge(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list) {
    const size_t count = list->count;
    for (size_t i = 0; i < count; ++i) {
        wh_event_t said;
        if (list->events[i].kind == WH_EVENT_RELEASED &&
            judge_release(cell, table, &list->events[i], &said)) {
            WH_ASSERT(list->count < list->capacity);
            list->events[list->count] = said;
            ++list->count;
        }
    }
    return list->count - count;
}
