#include "station_told.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
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
    if (of->kind >= WH_CLOCK_PORT_BEGINS) {
        const size_t length = strlen(text);
        (void)snprintf(text + length, WH_STATION_TOLD_BYTES - length, " step=%s carrier=%s",
                       wh_load_port_step_name(event->step), event->carrier);
    }
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

static size_t find_step(const char *name) {
    size_t step = 0;
    while (step < WH_LOAD_PORT_STEPS &&
           strcmp(wh_load_port_step_name((wh_load_port_step_t)step), name) != 0) {
        ++step;
    }
    return step;
}

/* Skips `name=` and the value behind it, and a blank; returns the value, or null: it is not there. */
static const char *take_value(const char **at, const char *name) {
    const size_t length = strlen(name);
    if (strncmp(*at, name, length) != 0 || (*at)[length] != '=') {
        return NULL;
    }
    const char *value = *at + length + 1;
    *at = value + strcspn(value, " ");
    *at += **at == ' ' ? 1 : 0;
    return value;
}

static bool take_word(const char **at, const char *name, char *word, size_t size) {
    const char *value = take_value(at, name);
    const size_t length = value ? strcspn(value, " ") : size;
    if (length >= size) {
        return false;
    }
    memcpy(word, value, length);
    word[length] = '\0';
    return true;
}

static bool take_number(const char **at, const char *name, int64_t most, int64_t *number) {
    char *end = NULL;
    const char *value = take_value(at, name);
    if (!value) {
        return false;
    }
    errno = 0;
    *number = strtoll(value, &end, 10);
    return errno == 0 && end > value && (*end == ' ' || *end == '\0') && *number >= -most && *number <= most;
}

static bool is_within(const wh_station_event_record_t *event, size_t station_count, size_t wafer_count) {
    const wh_clock_event_t *of = &event->event;
    return wh_is_index(event->station, station_count) && of->slot < WH_LAYOUT_SLOTS &&
           (of->wafer == WH_FLOW_NONE || wh_is_index(of->wafer, wafer_count)) && of->at_us >= 0;
}

enum { STATION, SLOT, WAFER, AT, TOOK, NUMBERS };

/* Room for the words. */
enum { KIND_BYTES = 20, SIDE_BYTES = 12 };

/* The numbers from `first` on, `count` of them, as they stand in the text. */
static bool take_numbers(const char **at, size_t first, size_t count, int64_t numbers[NUMBERS]) {
    static const char *const names[NUMBERS] = {"station", "slot", "wafer", "at", "us"};
    bool is_good = true;
    for (size_t i = first; i < first + count && is_good; ++i) {
        is_good = take_number(at, names[i], i < AT ? INT32_MAX : INT64_MAX, &numbers[i]);
    }
    return is_good;
}

/* The step of a load port, and behind it the carrier's name up to the end. */
static bool take_step(const char **at, wh_station_event_record_t *event) {
    static const char name[] = "carrier=";
    char word[12];
    if (!take_word(at, "step", word, sizeof word) || strncmp(*at, name, sizeof name - 1) != 0) {
        return false;
    }
    const size_t step = find_step(word);
    const char *carrier = *at + sizeof name - 1;
    if (step == WH_LOAD_PORT_STEPS || strlen(carrier) >= sizeof event->carrier) {
        return false;
    }
    event->step = (wh_load_port_step_t)step;
    (void)snprintf(event->carrier, sizeof event->carrier, "%s", carrier);
    return true;
}

/* The words of the text, and the numbers between them. */
static bool take_all(const char **at, char kind[KIND_BYTES], char side[SIDE_BYTES],
                     int64_t numbers[NUMBERS]) {
    return take_word(at, "kind", kind, KIND_BYTES) && take_numbers(at, STATION, 3, numbers) &&
           take_word(at, "side", side, SIDE_BYTES) && take_numbers(at, AT, 2, numbers);
}

bool wh_station_told_read(const char *text, size_t station_count, size_t wafer_count,
                          wh_station_event_record_t *event) {
    char kind[KIND_BYTES];
    char side[SIDE_BYTES];
    int64_t numbers[NUMBERS];
    memset(event, 0, sizeof *event);
    if (!take_all(&text, kind, side, numbers)) {
        return false;
    }
    const size_t number = find_kind(kind);
    const size_t at = find_side(side);
    if (number == WH_CLOCK_KINDS || at == SIDES) {
        return false;
    }
    *event = (wh_station_event_record_t){
        .station = (int32_t)numbers[STATION],
        .event = {.kind = (wh_clock_kind_t)number,
                  .side = (wh_flow_side_t)at,
                  .slot = numbers[SLOT] < 0 ? WH_FLOW_NONE : (int32_t)numbers[SLOT] - 1,
                  .wafer = (int32_t)numbers[WAFER],
                  .at_us = numbers[AT],
                  .us = numbers[TOOK]}};
    const bool is_whole = number < WH_CLOCK_PORT_BEGINS || take_step(&text, event);
    return is_whole && is_within(event, station_count, wafer_count) && numbers[SLOT] != 0;
}
