#include "schedule.h"

#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"

const char *const wh_schedule_words[WH_SCHEDULE_ACTIONS + 1] = {
    "start", "pick", "place", "swap", "move", "process", "clean", "pump", "open", "close", "leave", NULL};

const char *const wh_schedule_columns[WH_SCHEDULE_COLUMNS + 1] = {
    "robot", "action", "wafer", "station", "slot", "begin_s", "end_s", "arm", "wafer2", "to", "value", NULL};

/* -------------------------------------------------------------------------------------------------- names */

/* Where the name stands in the table, or the free entry for it. */
static size_t find_entry(const wh_schedule_names_t *names, const char *text) {
    const uint64_t hash = wh_hash_text(WH_HASH_START, text);
    size_t at = (size_t)(hash ^ (hash >> 32)) & (names->slot_count - 1);
    while (names->slots[at] != WH_FLOW_NONE && strcmp(names->texts[names->slots[at]], text) != 0) {
        at = (at + 1) & (names->slot_count - 1);
    }
    return at;
}

/* At least half of the entries stay free. */
static void widen(wh_schedule_names_t *names) {
    names->slot_count = names->slot_count == 0 ? 64 : 2 * names->slot_count;
    free(names->slots);
    names->slots = wh_array_new(names->slot_count, sizeof *names->slots);
    for (size_t i = 0; i < names->slot_count; ++i) {
        names->slots[i] = WH_FLOW_NONE;
    }
    for (size_t i = 0; i < names->count; ++i) {
        names->slots[find_entry(names, names->texts[i])] = (int32_t)i;
    }
}

int32_t wh_schedule_name(wh_schedule_names_t *names, const char *text) {
    if (2 * (names->count + 1) > names->slot_count) {
        widen(names);
    }
    const size_t at = find_entry(names, text);
    if (names->slots[at] == WH_FLOW_NONE) {
        names->texts = wh_array_grow(names->texts, names->count, &names->capacity, sizeof *names->texts);
        names->texts[names->count] = wh_text_copy(text);
        names->slots[at] = (int32_t)names->count++;
    }
    return names->slots[at];
}

const char *wh_schedule_text(const wh_schedule_names_t *names, int32_t number) {
    return number == WH_FLOW_NONE ? "" : names->texts[number];
}

static void close_names(wh_schedule_names_t *names) {
    for (size_t i = 0; i < names->count; ++i) {
        free(names->texts[i]);
    }
    free(names->texts);
    free(names->slots);
}

/* ------------------------------------------------------------------------------------------------- places */

static int by_place(const void *a, const void *b) {
    const wh_schedule_place_t *one = a, *other = b;
    if (one->station != other->station) {
        return one->station < other->station ? -1 : 1;
    }
    return one->slot < other->slot ? -1 : one->slot > other->slot;
}

void wh_schedule_finish(wh_schedule_t *schedule) {
    wh_schedule_place_t *places = wh_array_new(schedule->count + 1, sizeof *places);
    size_t count = 0;
    for (size_t i = 0; i < schedule->count; ++i) {
        places[i] = (wh_schedule_place_t){schedule->rows[i].station, schedule->rows[i].slot};
    }
    qsort(places, schedule->count, sizeof *places, by_place);
    for (size_t i = 0; i < schedule->count; ++i) {
        if (count == 0 || by_place(&places[count - 1], &places[i]) != 0) {
            places[count++] = places[i];
        }
    }
    for (size_t i = 0; i < schedule->count; ++i) {
        const wh_schedule_place_t key = {schedule->rows[i].station, schedule->rows[i].slot};
        const wh_schedule_place_t *found = bsearch(&key, places, count, sizeof key, by_place);
        schedule->rows[i].place = (int32_t)(found - places);
    }
    schedule->places = places;
    schedule->place_count = count;
}

void wh_schedule_close(wh_schedule_t *schedule) {
    free(schedule->path);
    free(schedule->rows);
    free(schedule->places);
    close_names(&schedule->robots);
    close_names(&schedule->wafers);
    close_names(&schedule->stations);
    close_names(&schedule->recipes);
    close_names(&schedule->unused);
    memset(schedule, 0, sizeof *schedule);
}
