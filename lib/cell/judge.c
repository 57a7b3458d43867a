#include "cell_internal.h"

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

wh_event_t *wh_cell_append(size_t release, wh_event_list_t *list, wh_event_kind_t kind) {
    if (list->count >= list->capacity) {
        return NULL;
    }
    wh_event_t *said = &list->events[list->count++];
    *said = list->events[release];
    said->kind = kind;
    return said;
}

static void judge_unsupported(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                              size_t release) {
    const int32_t wafer = list->events[release].wafer;
    wh_event_t *said = wh_cell_append(release, list, WH_EVENT_RELEASED_UNSUPPORTED);
    if (said != NULL) {
        said->height = height_above_support(cell, &table->storage.wafers[wafer].base_from_wafer);
    }
}

static void judge_occupied(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                           size_t release, const wh_place_t *place) {
    const int32_t other = find_other(cell, table, list->events[release].wafer, place);
    wh_event_t *said = other == WH_NONE ? NULL : wh_cell_append(release, list, WH_EVENT_SLOT_OCCUPIED);
    if (said != NULL) {
        said->other = other;
    }
}

/* Says that `found` is above a limit that is set. */
static void judge_limit(wh_event_list_t *list, size_t release, wh_event_kind_t kind, wh_real_t found,
                        wh_real_t limit) {
    wh_event_t *said = limit > 0 && found > limit ? wh_cell_append(release, list, kind) : NULL;
    if (said != NULL) {
        said->value = found;
        said->limit = limit;
    }
}

static void judge_release(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                          size_t release) {
    const int32_t wafer = list->events[release].wafer;
    wh_place_t place;
    if (!wh_cell_locate(cell, &table->storage.wafers[wafer].base_from_wafer, &place)) {
        judge_unsupported(cell, table, list, release);
        return;
    }
    judge_occupied(cell, table, list, release, &place);
    const wh_real_t aside = wh_real_sqrt(place.dx * place.dx + place.dy * place.dy);
    judge_limit(list, release, WH_EVENT_PLACED_OFF_CENTRE, aside, cell->off_centre);
    judge_limit(list, release, WH_EVENT_PLACED_ASKEW, place.tilt, cell->askew);
}

size_t wh_cell_judge(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list) {
    const size_t count = list->count;
    for (size_t i = 0; i < count; ++i) {
        if (list->events[i].kind == WH_EVENT_RELEASED) {
            judge_release(cell, table, list, i);
        }
    }
    return list->count - count;
}
