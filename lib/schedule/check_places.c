/* Wafers in places and on arms: rules 3, 4, 5 and 16. */
#include "check_internal.h"

#include <string.h>

static const char *name_of(const wh_schedule_state_t *check, int32_t wafer) {
    return wh_schedule_text(&check->schedule->wafers, wafer);
}

/* ---------------------------------------------------------------------------------------- lists of places */

void wh_check_lay(wh_schedule_state_t *check, int32_t wafer, int32_t place) {
    wh_check_place_t *into = &check->places[place];
    check->wafers[wafer].place = place;
    check->wafers[wafer].next = into->head;
    into->head = wafer;
    ++into->count;
    ++check->stations[check->schedule->places[place].station].wafers;
}

static void lift(wh_schedule_state_t *check, int32_t wafer) {
    wh_check_wafer_t *lifted = &check->wafers[wafer];
    wh_check_place_t *from = &check->places[lifted->place];
    int32_t *link = &from->head;
    while (*link != wafer) {
        link = &check->wafers[*link].next;
    }
    *link = lifted->next;
    --from->count;
    --check->stations[check->schedule->places[lifted->place].station].wafers;
    lifted->place = WH_FLOW_NONE;
}

static void drop(wh_schedule_state_t *check, int32_t wafer) {
    wh_check_wafer_t *dropped = &check->wafers[wafer];
    if (dropped->robot != WH_FLOW_NONE) {
        wh_check_robot_t *robot = &check->robots[dropped->robot];
        --robot->aboard;
        for (int i = 0; i < 2; ++i) {
            robot->on[i] = robot->on[i] == wafer ? WH_FLOW_NONE : robot->on[i];
        }
    }
    dropped->robot = WH_FLOW_NONE;
    dropped->arm = 0;
}

/* After a finding the wafer is where the row says, and nowhere else. */
static void detach(wh_schedule_state_t *check, int32_t wafer) {
    if (check->wafers[wafer].place != WH_FLOW_NONE) {
        lift(check, wafer);
    }
    drop(check, wafer);
    check->wafers[wafer].where = WH_CHECK_NOWHERE;
}

/* ------------------------------------------------------------------------------------------------- starts */

/* The wafers of a carrier that is over make room for those of the next one. */
static void change_carrier(wh_schedule_state_t *check, int32_t place, int64_t begin_us) {
    const wh_flow_station_t *station = wh_check_station(check, check->schedule->places[place].station);
    int32_t there = check->places[place].head;
    if (!station || !station->is_load_port || begin_us == 0) {
        return;
    }
    while (there != WH_FLOW_NONE) {
        const int32_t next = check->wafers[there].next;
        if (check->wafers[there].where == WH_CHECK_LIES && check->wafers[there].visits > 0) {
            detach(check, there);
        }
        there = next;
    }
}

void wh_check_begin_start(wh_schedule_state_t *check, int32_t row) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[of->wafer];
    wh_check_place_t *place = &check->places[of->place];
    if (wafer->where != WH_CHECK_NOWHERE) {
        wh_check_found(check, WH_SCHEDULE_RULE_TWO_PLACES, row, wafer->row,
                       "wafer: %s (expected one that is not in the tool yet: it %s)",
                       name_of(check, of->wafer), wh_check_where(check, of->wafer, &text));
        detach(check, of->wafer);
    }
    change_carrier(check, of->place, of->begin_us);
    if (place->count >= place->capacity) {
        wh_check_found(check, WH_SCHEDULE_RULE_FULL, row, check->wafers[place->head].row,
                       "slot: %d (expected an empty place: in %s is %s)", (int)of->slot,
                       wh_check_place_name(check, of->place, &text), name_of(check, place->head));
    }
    wh_check_lay(check, of->wafer, of->place);
    wafer->where = WH_CHECK_LIES;
    wafer->placed_us = wafer->done_us = of->begin_us;
    wafer->whole_us = WH_FLOW_NEVER;
    wafer->around_us = 0;
    wafer->row = row;
    wafer->recipe = wafer->stay_recipe = wh_check_recipe(check, of);
    wh_check_set_out(check, of->wafer, of->place);
}

/* Its carrier takes the wafer away. It may come again. */
void wh_check_begin_leave(wh_schedule_state_t *check, int32_t row) {
    wh_check_text_t text, place;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[of->wafer];
    if (wafer->where != WH_CHECK_LIES || wafer->place != of->place) {
        wh_check_found(check, WH_SCHEDULE_RULE_ABSENT, row, wafer->row,
                       "wafer: %s (expected one that lies in %s: it %s)", name_of(check, of->wafer),
                       wh_check_place_name(check, of->place, &place),
                       wh_check_where(check, of->wafer, &text));
    } else if (wafer->visits > 0) {
        wh_check_finish_route(check, of->wafer);
    }
    detach(check, of->wafer);
    wafer->row = wafer->process_row = WH_CHECK_NO_ROW;
    wafer->visits = 0;
    wafer->is_lost = false;
}

/* -------------------------------------------------------------------------------------------------- takes */

void wh_check_begin_take(wh_schedule_state_t *check, int32_t row, int32_t number) {
    wh_check_text_t text, place;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[number];
    if (wafer->where != WH_CHECK_LIES || wafer->place != of->place) {
        wh_check_found(check, WH_SCHEDULE_RULE_ABSENT, row, wafer->row,
                       "%s: %s (expected one that lies in %s: it %s)",
                       of->action == WH_SCHEDULE_SWAP ? "wafer2" : "wafer", name_of(check, number),
                       wh_check_place_name(check, of->place, &place), wh_check_where(check, number, &text));
        detach(check, number);
    } else {
        wh_check_leave(check, row, number);
    }
    wafer->where = WH_CHECK_TAKEN;
    wafer->robot = of->robot;
    wafer->row = row;
}

void wh_check_end_take(wh_schedule_state_t *check, int32_t row, int32_t number) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[number];
    if (wafer->where != WH_CHECK_TAKEN || wafer->row != row) {
        return;
    }
    if (wafer->place != WH_FLOW_NONE) {
        wh_check_place_t *place = &check->places[wafer->place];
        lift(check, number);
        place->empty_us = of->end_us;
        ++place->since;
    }
    wafer->where = WH_CHECK_ABOARD;
}

/* --------------------------------------------------------------------------------------------------- puts */

static bool is_on_other_arm(const wh_check_wafer_t *wafer, const wh_schedule_row_t *row) {
    return wafer->arm > 0 && row->arm > 0 && wafer->arm != row->arm;
}

void wh_check_need_aboard(wh_schedule_state_t *check, int32_t row, int32_t number) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[number];
    const char *robot = wh_schedule_text(&check->schedule->robots, of->robot);
    if (wafer->where == WH_CHECK_ABOARD && wafer->robot == of->robot && !is_on_other_arm(wafer, of)) {
        return;
    }
    if (wafer->where == WH_CHECK_ABOARD && wafer->robot == of->robot) {
        wh_check_found(check, WH_SCHEDULE_RULE_NOT_ABOARD, row, wafer->row,
                       "arm: %d (expected %d, on which %s is)", (int)of->arm, (int)wafer->arm,
                       name_of(check, number));
        return;
    }
    wh_check_found(check, WH_SCHEDULE_RULE_NOT_ABOARD, row, wafer->row,
                   "wafer: %s (expected one aboard %s: it %s)", name_of(check, number), robot,
                   wh_check_where(check, number, &text));
    detach(check, number);
    wafer->where = WH_CHECK_ABOARD;
    wafer->robot = of->robot;
    ++check->robots[of->robot].aboard;
}

/* `leaving` wafers come out of the place in the same action. */
void wh_check_begin_put(wh_schedule_state_t *check, int32_t row, int32_t number, int32_t leaving) {
    wh_check_text_t text;
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[number];
    wh_check_place_t *place = &check->places[of->place];
    if (place->count - leaving >= place->capacity) {
        wh_check_found(check, WH_SCHEDULE_RULE_FULL, row, check->wafers[place->head].row,
                       "slot: %d (expected an empty place: in %s is %s)", (int)of->slot,
                       wh_check_place_name(check, of->place, &text), name_of(check, place->head));
    }
    wh_check_enter(check, row, leaving);
    wh_check_visit(check, row, number);
    wh_check_lay(check, number, of->place);
    wafer->where = WH_CHECK_PLACED;
    wafer->row = row;
    place->placing_us = of->end_us;
    place->placing_row = row;
}

void wh_check_end_put(wh_schedule_state_t *check, int32_t row, int32_t number) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_wafer_t *wafer = &check->wafers[number];
    if (wafer->where != WH_CHECK_PLACED || wafer->row != row) {
        return;
    }
    drop(check, number);
    wafer->where = WH_CHECK_LIES;
    wafer->process_row = WH_CHECK_NO_ROW;
    wafer->processed_us = 0;
    wafer->whole_us = WH_FLOW_NEVER;
    wafer->around_us = 0;
    wafer->placed_us = of->end_us;
    if (check->tool) {
        wafer->placed_us += check->tool->doors[wh_check_pair(check, of)].close_us;
    }
    wafer->stay_recipe = check->places[of->place].recipe = wafer->recipe;
    wafer->done_us = wafer->placed_us + wh_check_process_us(check, number);
}
