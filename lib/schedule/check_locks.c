/* Load locks and doors: rules 11, 12 and 13. */
#include <stdlib.h>

#include "../text/array.h"
#include "check_internal.h"

/* The side of a robot's row at a lock of the layout; WH_FLOW_BOTH: none. */
static wh_flow_side_t side_of(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    return check->tool && row->robot != WH_FLOW_NONE ? check->tool->sides[wh_check_pair(check, row)]
                                                     : WH_FLOW_BOTH;
}

/* -------------------------------------------------------------------------------------------------- doors */

static bool is_door(const wh_schedule_row_t *row) {
    return row->action == WH_SCHEDULE_OPEN || row->action == WH_SCHEDULE_CLOSE;
}

static int32_t key_of(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    const wh_flow_side_t side = is_door(row) && row->side != WH_FLOW_BOTH ? row->side : side_of(check, row);
    return side != WH_FLOW_BOTH ? (int32_t)side : 2 + row->robot;
}

static int by_door(const void *a, const void *b) {
    const wh_check_door_t *one = a, *other = b;
    if (one->station != other->station) {
        return one->station < other->station ? -1 : 1;
    }
    return one->key < other->key ? -1 : one->key > other->key;
}

/* The first row of a door says what it was before, if nobody goes through it sooner. */
static void begin_door_shut(const wh_schedule_state_t *check, wh_check_door_t *door, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    if (door->row == WH_CHECK_NO_ROW || of->begin_us < wh_check_row(check, door->row)->begin_us) {
        door->row = row;
        door->state = of->action == WH_SCHEDULE_OPEN ? WH_CHECK_SHUT : WH_CHECK_OPEN;
    }
}

/* All doors of which rows tell, each once. */
static void list_doors(wh_schedule_state_t *check) {
    const wh_schedule_t *schedule = check->schedule;
    size_t capacity = 0, count = 0;
    for (size_t i = 0; i < schedule->count; ++i) {
        if (is_door(&schedule->rows[i])) {
            check->doors = wh_array_grow(check->doors, count, &capacity, sizeof *check->doors);
            check->doors[count++] = (wh_check_door_t){.station = schedule->rows[i].station,
                                                      .key = key_of(check, &schedule->rows[i]),
                                                      .row = WH_CHECK_NO_ROW,
                                                      .access_row = WH_CHECK_NO_ROW};
        }
    }
    if (count > 0) {
        qsort(check->doors, count, sizeof *check->doors, by_door);
    }
    for (size_t i = 0; i < count; ++i) {
        if (check->door_count == 0 || by_door(&check->doors[check->door_count - 1], &check->doors[i]) != 0) {
            check->doors[check->door_count++] = check->doors[i];
        }
    }
}

/* True if the schedule, or the layout, says how the tool begins: with doors that are shut. */
static bool has_beginning(const wh_schedule_state_t *check) {
    bool has_start = false;
    for (size_t i = 0; i < check->schedule->count; ++i) {
        has_start = has_start || check->schedule->rows[i].action == WH_SCHEDULE_START;
    }
    return check->tool || has_start;
}

/* Somebody must have opened the door for an access before its first row. */
static void begin_access_shut(const wh_schedule_state_t *check, const wh_schedule_row_t *access) {
    wh_check_door_t *door = wh_check_door_of(check, access);
    if (door && access->begin_us < wh_check_row(check, door->row)->begin_us) {
        door->state = WH_CHECK_SHUT;
    }
}

void wh_check_open_doors(wh_schedule_state_t *check) {
    const wh_schedule_t *schedule = check->schedule;
    const bool begins = has_beginning(check);
    list_doors(check);
    for (size_t i = 0; i < schedule->count; ++i) {
        if (is_door(&schedule->rows[i])) {
            begin_door_shut(check, wh_check_door_of(check, &schedule->rows[i]), (int32_t)i);
        }
    }
    for (size_t i = 0; i < check->door_count && !begins; ++i) {
        check->doors_from_open += check->doors[i].state == WH_CHECK_OPEN ? 1 : 0;
    }
    for (size_t i = 0; i < schedule->count && begins; ++i) {
        if (wh_schedule_is_access(schedule->rows[i].action)) {
            begin_access_shut(check, &schedule->rows[i]);
        }
    }
}

wh_check_door_t *wh_check_door_of(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    const wh_check_door_t key = {.station = row->station, .key = key_of(check, row)};
    return check->door_count == 0 ? NULL
                                  : bsearch(&key, check->doors, check->door_count, sizeof key, by_door);
}

/* A lock's door on this side; null: none is told of. */
static const wh_check_door_t *door_on(const wh_schedule_state_t *check, int32_t station, int32_t side) {
    const wh_check_door_t key = {.station = station, .key = side};
    return check->door_count == 0 ? NULL
                                  : bsearch(&key, check->doors, check->door_count, sizeof key, by_door);
}

/* Rule 12. The other side of a lock. */
static void check_other_door(wh_schedule_state_t *check, int32_t row, const wh_check_door_t *door) {
    wh_check_text_t text;
    const wh_check_door_t *other = door->key < 2 ? door_on(check, door->station, 1 - door->key) : NULL;
    if (other && other->state != WH_CHECK_SHUT) {
        wh_check_found(check, WH_SCHEDULE_RULE_BOTH_OPEN, row, other->row,
                       "begin_s: %.10g (expected a time when the other door is shut: behind it, %s)",
                       wh_check_seconds(wh_check_row(check, row)->begin_us),
                       wh_check_describe(check, other->row, &text));
    }
}

/* Rule 11 of a door: its side has the lock's pressure. */
static void check_door_side(wh_schedule_state_t *check, int32_t row, const wh_check_door_t *door) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_check_station_t *station = &check->stations[of->station];
    const bool is_lock = check->tool && check->tool->stations[station->tool].is_lock;
    if (is_lock && door->key < 2 && station->has_pumps && (int32_t)station->side != door->key) {
        wh_check_found(check, WH_SCHEDULE_RULE_PRESSURE, row, station->pump_row,
                       "begin_s: %.10g (expected a time when %s is at %s)", wh_check_seconds(of->begin_us),
                       wh_schedule_text(&check->schedule->stations, of->station),
                       wh_flow_side_words[door->key]);
    }
}

/* The station's first door that is not shut; null: none. */
static const wh_check_door_t *find_open_door(const wh_schedule_state_t *check, int32_t station) {
    size_t low = 0, high = check->door_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (check->doors[middle].station < station) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    while (low < check->door_count && check->doors[low].station == station &&
           check->doors[low].state == WH_CHECK_SHUT) {
        ++low;
    }
    return low < check->door_count && check->doors[low].station == station ? &check->doors[low] : NULL;
}

bool wh_check_has_one_slot(const wh_schedule_state_t *check, int32_t station) {
    return (check->tool ? wh_check_station(check, station)->slots : check->stations[station].slots) == 1;
}

/* Rule 13 of a process: it begins behind a shut door. A station of several slots may open for another one. */
void wh_check_process_door(wh_schedule_state_t *check, int32_t row, const wh_check_wafer_t *wafer) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_check_door_t *door = find_open_door(check, of->station);
    if (door && wh_check_has_one_slot(check, of->station)) {
        wh_check_found(check, WH_SCHEDULE_RULE_DOOR, row, door->row,
                       "begin_s: %.10g (expected a time when the door is shut: before it, %s)",
                       wh_check_seconds(of->begin_us), wh_check_describe(check, door->row, &text));
    } else if (!door && wh_check_is_behind(wafer->placed_us, of->begin_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_DOOR, row, wafer->row,
                       "begin_s: %.10g (expected %.10g or later, when the door is shut)",
                       wh_check_seconds(of->begin_us), wh_check_seconds(wafer->placed_us));
    }
}

/* Rule 13 of a door: it does not open while its wafer is processed. */
static void check_inside(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const int32_t number = check->places[of->place].head;
    if (number == WH_FLOW_NONE || !wh_check_has_one_slot(check, of->station)) {
        return;
    }
    const wh_check_wafer_t *wafer = &check->wafers[number];
    const bool is_told = wafer->process_row != WH_CHECK_NO_ROW;
    if (wafer->where == WH_CHECK_LIES && (is_told || wafer->visits > 0) &&
        wh_check_is_behind(wafer->done_us, of->begin_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_DOOR, row, is_told ? wafer->process_row : wafer->row,
                       "begin_s: %.10g (expected %.10g or later, when the process of %s is over)",
                       wh_check_seconds(of->begin_us), wh_check_seconds(wafer->done_us),
                       wh_schedule_text(&check->schedule->wafers, number));
    }
}

/* Rule 13 of a door: it does not open, or shut, twice without the other between. */
static void check_door_again(wh_schedule_state_t *check, int32_t row, const wh_check_door_t *door) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_schedule_row_t *before = wh_check_row(check, door->row);
    const bool is_access_told = of->action == WH_SCHEDULE_CLOSE && door->access_us > before->end_us;
    if (door->row == row || before->action != of->action || before->begin_us > of->begin_us ||
        is_access_told) {
        return; /* who went through a shut door is found, and shuts it behind him */
    }
    wh_check_found(check, WH_SCHEDULE_RULE_DOOR, row, door->row,
                   "begin_s: %.10g (expected a time when the door is %s: before it, %s)",
                   wh_check_seconds(of->begin_us), of->action == WH_SCHEDULE_OPEN ? "shut" : "open",
                   wh_check_describe(check, door->row, &text));
}

void wh_check_begin_door(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const bool opens = of->action == WH_SCHEDULE_OPEN;
    wh_check_door_t *door = wh_check_door_of(check, of);
    check_door_again(check, row, door);
    if (opens) {
        check_inside(check, row);
        check_other_door(check, row, door);
        check_door_side(check, row, door);
    } else {
        (void)wh_check_is_early(check, WH_SCHEDULE_RULE_DOOR, row, door->access_us, door->access_row);
    }
    if (check->tool && of->robot != WH_FLOW_NONE) {
        const wh_flow_door_t *times = &check->tool->doors[wh_check_pair(check, of)];
        wh_check_length(check, row, opens ? times->open_us : times->close_us);
    }
    door->state = opens ? WH_CHECK_OPENING : WH_CHECK_CLOSING;
    door->row = row;
}

void wh_check_end_door(wh_schedule_state_t *check, int32_t row) {
    wh_check_door_t *door = wh_check_door_of(check, wh_check_row(check, row));
    if (door->row == row) {
        door->state = door->state == WH_CHECK_OPENING ? WH_CHECK_OPEN : WH_CHECK_SHUT;
    }
}

/* -------------------------------------------------------------------------------------------------- locks */

static int64_t pump_us(const wh_schedule_state_t *check, int32_t station, wh_flow_side_t to) {
    return wh_flow_pump_us(wh_check_station(check, station), to, check->stations[station].wafers == 0);
}

/* A lock without pumps in the schedule turns as soon as nobody is in it. */
static bool is_turned(const wh_schedule_state_t *check, const wh_schedule_row_t *of, wh_flow_side_t side) {
    const wh_check_station_t *station = &check->stations[of->station];
    const int64_t open_us = check->tool->doors[wh_check_pair(check, of)].open_us;
    return !station->has_pumps && !wh_check_is_behind(station->access_us + pump_us(check, of->station, side),
                                                      of->begin_us - open_us);
}

/* Rule 11. */
static void check_pressure(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_station_t *station = &check->stations[of->station];
    const wh_flow_side_t side = side_of(check, of);
    if (!check->tool->stations[station->tool].is_lock || side == WH_FLOW_BOTH) {
        return;
    }
    const bool is_pumping =
        wh_check_is_early(check, WH_SCHEDULE_RULE_PRESSURE, row, station->pump_us, station->pump_row);
    if (!is_pumping && station->side != side && !is_turned(check, of, side)) {
        wh_check_found(check, WH_SCHEDULE_RULE_PRESSURE, row, station->pump_row,
                       "begin_s: %.10g (expected a time when %s is at %s, the side of %s)",
                       wh_check_seconds(of->begin_us),
                       wh_schedule_text(&check->schedule->stations, of->station), wh_flow_side_words[side],
                       wh_schedule_text(&check->schedule->robots, of->robot));
    }
    station->side = side;
}

/* Rule 13. */
static void check_door(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_door_t *door = wh_check_door_of(check, of);
    if (!door) {
        return;
    }
    if (door->state != WH_CHECK_OPEN) {
        wh_check_found(check, WH_SCHEDULE_RULE_DOOR, row, door->row,
                       "begin_s: %.10g (expected a time when the door of %s is open)",
                       wh_check_seconds(of->begin_us),
                       wh_schedule_text(&check->schedule->stations, of->station));
    }
    if (of->end_us > door->access_us) {
        door->access_us = of->end_us;
        door->access_row = row;
    }
}

void wh_check_access(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_station_t *station = &check->stations[of->station];
    int64_t end_us = of->end_us;
    if (check->tool) {
        check_pressure(check, row);
        end_us += station->has_pumps ? 0 : check->tool->doors[wh_check_pair(check, of)].close_us;
    }
    check_door(check, row);
    if (end_us > station->access_us) {
        station->access_us = end_us;
        station->access_row = row;
    }
}

/* A lock goes one way at a time, whichever row comes first in the file. */
void wh_check_begin_pump(wh_schedule_state_t *check, int32_t row) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_station_t *station = &check->stations[of->station];
    (void)wh_check_is_early(check, WH_SCHEDULE_RULE_PRESSURE, row, station->pump_us, station->pump_row);
    if (check->tool && check->tool->stations[station->tool].is_lock) {
        (void)wh_check_is_early(check, WH_SCHEDULE_RULE_PRESSURE, row, station->access_us,
                                station->access_row);
        wh_check_length(check, row, station->side == of->side ? 0 : pump_us(check, of->station, of->side));
    }
    for (int32_t side = 0; side < 2; ++side) {
        const wh_check_door_t *door = door_on(check, of->station, side);
        if (door && door->state != WH_CHECK_SHUT) {
            wh_check_found(check, WH_SCHEDULE_RULE_PRESSURE, row, door->row,
                           "begin_s: %.10g (expected a time when both doors are shut: behind it, %s)",
                           wh_check_seconds(of->begin_us), wh_check_describe(check, door->row, &text));
        }
    }
    if (station->pump_row == WH_CHECK_NO_ROW || of->end_us >= station->pump_us) {
        station->pump_us = of->end_us;
        station->pump_row = row;
    }
}

void wh_check_end_pump(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    check->stations[of->station].side = of->side;
}
