#include <stdio.h>
#include <stdlib.h>

#include "../text/array.h"
#include "check_internal.h"

/* The numbers of the schedule's names in the layout. */
static void find_names(wh_schedule_state_t *check) {
    const wh_schedule_t *schedule = check->schedule;
    for (size_t i = 0; i < schedule->robots.count; ++i) {
        wh_check_robot_t *robot = &check->robots[i];
        robot->tool = wh_flow_robot_named(check->tool, schedule->robots.texts[i]);
        if (robot->tool != WH_FLOW_NONE) {
            robot->station = check->tool->robots[robot->tool].at;
            robot->arms = check->tool->robots[robot->tool].arms;
        }
    }
    for (size_t i = 0; i < schedule->stations.count; ++i) {
        wh_check_station_t *station = &check->stations[i];
        station->tool = wh_flow_station_named(check->tool, schedule->stations.texts[i]);
        if (station->tool != WH_FLOW_NONE) {
            station->side = check->tool->stations[station->tool].side;
        }
    }
}

/* A name that the layout does not have. */
static bool refuse_name(const wh_schedule_state_t *check, const wh_schedule_row_t *row, const char *column,
                        const char *name, const char *kind) {
    (void)snprintf(check->report->message, sizeof check->report->message,
                   "%.200s:%zu: %s: %s (expected a %s of the layout)", check->schedule->path, row->line,
                   column, name, kind);
    return false;
}

static bool check_names(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    const wh_schedule_t *schedule = check->schedule;
    const int32_t station = check->stations[row->station].tool;
    if (row->robot != WH_FLOW_NONE && check->robots[row->robot].tool == WH_FLOW_NONE) {
        return refuse_name(check, row, "robot", schedule->robots.texts[row->robot], "robot");
    }
    if (station == WH_FLOW_NONE) {
        return refuse_name(check, row, "station", schedule->stations.texts[row->station], "station");
    }
    if (row->to != WH_FLOW_NONE && check->stations[row->to].tool == WH_FLOW_NONE) {
        return refuse_name(check, row, "to", schedule->stations.texts[row->to], "station");
    }
    if (row->recipe > 0 && wh_check_recipe(check, row) == 0) {
        return refuse_name(check, row, "value", schedule->recipes.texts[row->recipe - 1], "recipe");
    }
    if (row->slot > check->tool->stations[station].slots) {
        (void)snprintf(check->report->message, sizeof check->report->message,
                       "%.200s:%zu: slot: %d (expected one of %s in the layout, 1 to %d)", schedule->path,
                       row->line, (int)row->slot, schedule->stations.texts[row->station],
                       (int)check->tool->stations[station].slots);
        return false;
    }
    return true;
}

bool wh_check_take_names(wh_schedule_state_t *check) {
    find_names(check);
    for (size_t i = 0; i < check->schedule->count; ++i) {
        if (!check_names(check, &check->schedule->rows[i])) {
            return false;
        }
    }
    return true;
}

/* True if the first row of a wafer finds it in its place. */
static bool is_found(const wh_schedule_row_t *first, int32_t wafer) {
    return first->action == WH_SCHEDULE_PICK || first->action == WH_SCHEDULE_PROCESS ||
           (first->action == WH_SCHEDULE_SWAP && first->wafer2 == wafer);
}

/* Several wafers in one slot: as many as that it holds, unless the layout says otherwise. */
static void stack(wh_schedule_state_t *check, int32_t row, wh_check_place_t *place) {
    wh_check_text_t text;
    const wh_schedule_row_t *first = wh_check_row(check, row);
    if (check->tool) {
        wh_check_found(check, WH_SCHEDULE_RULE_FULL, row, check->wafers[place->head].row,
                       "slot: %d (expected another one: at the beginning %s is in %s, too)", (int)first->slot,
                       wh_schedule_text(&check->schedule->wafers, place->head),
                       wh_check_place_name(check, first->place, &text));
        return;
    }
    check->report->stacked += place->count == 1;
    ++place->capacity;
}

/* A wafer without a start is where its first row, in time, finds it. */
static void assume_wafer(wh_schedule_state_t *check, int32_t number) {
    wh_check_wafer_t *wafer = &check->wafers[number];
    if (wafer->row == WH_CHECK_NO_ROW || wafer->has_start ||
        !is_found(wh_check_row(check, wafer->row), number)) {
        return;
    }
    const int32_t into = wh_check_row(check, wafer->row)->place;
    if (check->places[into].count > 0) {
        stack(check, wafer->row, &check->places[into]);
    }
    ++check->report->assumed;
    wh_check_lay(check, number, into);
    wafer->where = WH_CHECK_LIES;
    wh_check_set_out(check, number, into);
}

static bool is_sooner(const wh_schedule_state_t *check, int32_t row, int32_t than) {
    return than == WH_CHECK_NO_ROW ||
           wh_check_row(check, row)->begin_us < wh_check_row(check, than)->begin_us;
}

static void note_wafer(wh_schedule_state_t *check, int32_t row, int32_t number) {
    wh_check_wafer_t *wafer = &check->wafers[number];
    wafer->has_start = wafer->has_start || wh_check_row(check, row)->action == WH_SCHEDULE_START;
    wafer->row = is_sooner(check, row, wafer->row) ? row : wafer->row;
}

/* Notes all that must be known before the first instant. */
static void note_row(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const bool tells_wafer = wh_schedule_is_access(of->action) || of->action == WH_SCHEDULE_START ||
                             of->action == WH_SCHEDULE_PROCESS;
    if (of->wafer != WH_FLOW_NONE && tells_wafer) {
        note_wafer(check, row, of->wafer);
    }
    if (of->action == WH_SCHEDULE_SWAP) {
        note_wafer(check, row, of->wafer2);
    }
    if (of->action == WH_SCHEDULE_PICK && of->arm == 0) {
        check->robots[of->robot].tells_arms = false;
    }
    check->stations[of->station].has_pumps |= of->action == WH_SCHEDULE_PUMP;
    check->has_cleans |= of->action == WH_SCHEDULE_CLEAN;
    if (!wh_schedule_is_instant(of->action) && of->end_us > check->report->end_us) {
        check->report->end_us = of->end_us;
    }
}

/* How many slots of each station rows tell of. */
static void count_slots(wh_schedule_state_t *check) {
    for (size_t i = 0; i < check->schedule->place_count; ++i) {
        ++check->stations[check->schedule->places[i].station].slots;
    }
}

void wh_check_open(wh_schedule_state_t *check) {
    const wh_schedule_t *schedule = check->schedule;
    check->wafers = wh_array_new(schedule->wafers.count + 1, sizeof *check->wafers);
    check->places = wh_array_new(schedule->place_count + 1, sizeof *check->places);
    check->stations = wh_array_new(schedule->stations.count + 1, sizeof *check->stations);
    check->robots = wh_array_new(schedule->robots.count + 1, sizeof *check->robots);
    for (size_t i = 0; i < schedule->wafers.count; ++i) {
        wh_check_wafer_t *wafer = &check->wafers[i];
        wafer->place = wafer->robot = wafer->next = wafer->home = WH_FLOW_NONE;
        wafer->row = wafer->process_row = WH_CHECK_NO_ROW;
        wafer->whole_us = WH_FLOW_NEVER;
    }
    for (size_t i = 0; i < schedule->place_count; ++i) {
        wh_check_place_t *place = &check->places[i];
        place->head = WH_FLOW_NONE;
        place->capacity = 1;
        place->cleaned_us = -1;
        place->clean_row = place->placing_row = WH_CHECK_NO_ROW;
    }
    for (size_t i = 0; i < schedule->stations.count; ++i) {
        check->stations[i].tool = WH_FLOW_NONE;
        check->stations[i].pump_row = check->stations[i].access_row = WH_CHECK_NO_ROW;
    }
    count_slots(check);
    for (size_t i = 0; i < schedule->robots.count; ++i) {
        wh_check_robot_t *robot = &check->robots[i];
        robot->tool = robot->on[0] = robot->on[1] = WH_FLOW_NONE;
        robot->row = WH_CHECK_NO_ROW;
        robot->tells_arms = true;
    }
}

void wh_check_close(wh_schedule_state_t *check) {
    free(check->wafers);
    free(check->places);
    free(check->stations);
    free(check->robots);
    free(check->doors);
}

void wh_check_begin(wh_schedule_state_t *check) {
    for (int32_t i = 0; i < (int32_t)check->schedule->count; ++i) {
        note_row(check, i);
    }
    wh_check_open_doors(check);
    for (int32_t w = 0; w < (int32_t)check->schedule->wafers.count; ++w) {
        assume_wafer(check, w);
    }
}
