#include "check.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "check_internal.h"

/* How often what takes no time is looked through at one instant for what can go first. */
#define MOST_PASSES 64

const char *const wh_schedule_rules[WH_SCHEDULE_RULES] = {NULL,
                                                          "two actions of a robot at once",
                                                          "more wafers aboard than arms",
                                                          "a pick of a wafer that is not there",
                                                          "a place of a wafer that is not aboard",
                                                          "a place into a full one",
                                                          "less time than a move between two stations",
                                                          "an action shorter than the layout says",
                                                          "a process cut short, or done twice",
                                                          "a stay beyond the window",
                                                          "a place during a clean, or a clean left out",
                                                          "wrong pressure in a load lock",
                                                          "both doors of a load lock open",
                                                          "a shut door, or an open one during a process",
                                                          "a robot that does not serve the station",
                                                          "a step out of the route's order",
                                                          "a wafer in two places",
                                                          "a wafer left aboard, or short of its route's end"};

/* -------------------------------------------------------------------------------------------------- texts */

void wh_check_found(wh_schedule_state_t *check, int rule, int32_t row, int32_t other, const char *format,
                    ...) {
    wh_schedule_report_t *report = check->report;
    char text[1200];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    report->findings =
        wh_array_grow(report->findings, report->count, &report->capacity, sizeof *report->findings);
    report->findings[report->count++] = (wh_schedule_finding_t){
        .rule = rule,
        .row = (size_t)row,
        .other = other == WH_CHECK_NO_ROW || other == row ? WH_SCHEDULE_NO_ROW : (size_t)other,
        .is_warning = rule == WH_SCHEDULE_RULE_LEFT,
        .text = wh_text_copy(text)};
    report->warnings += rule == WH_SCHEDULE_RULE_LEFT;
    ++report->rules[rule].found;
}

bool wh_check_is_early(wh_schedule_state_t *check, int rule, int32_t row, int64_t us, int32_t other) {
    wh_check_text_t text;
    const int64_t begin_us = wh_check_row(check, row)->begin_us;
    const bool is_early = wh_check_is_behind(us, begin_us);
    if (is_early) {
        wh_check_found(check, rule, row, other, "begin_s: %.10g (expected %.10g or later, behind %s)",
                       wh_check_seconds(begin_us), wh_check_seconds(us),
                       wh_check_describe(check, other, &text));
    }
    return is_early;
}

const char *wh_check_place_name(const wh_schedule_state_t *check, int32_t place, wh_check_text_t *text) {
    const wh_schedule_place_t *of = &check->schedule->places[place];
    (void)snprintf(text->text, sizeof text->text, "%s %d",
                   wh_schedule_text(&check->schedule->stations, of->station), (int)of->slot);
    return text->text;
}

const char *wh_check_describe(const wh_schedule_state_t *check, int32_t row, wh_check_text_t *text) {
    const wh_schedule_t *schedule = check->schedule;
    const wh_schedule_row_t *of = &schedule->rows[row];
    (void)snprintf(text->text, sizeof text->text, "line %zu: %s%s%s%s%s at %s %d, %.10g to %.10g s", of->line,
                   wh_schedule_text(&schedule->robots, of->robot), of->robot == WH_FLOW_NONE ? "" : "'s ",
                   wh_schedule_words[of->action], of->wafer == WH_FLOW_NONE ? "" : " of ",
                   wh_schedule_text(&schedule->wafers, of->wafer),
                   wh_schedule_text(&schedule->stations, of->station), (int)of->slot,
                   wh_check_seconds(of->begin_us), wh_check_seconds(of->end_us));
    return text->text;
}

const char *wh_check_where(const wh_schedule_state_t *check, int32_t number, wh_check_text_t *text) {
    const wh_check_wafer_t *wafer = &check->wafers[number];
    wh_check_text_t place = {""};
    const char *robot = wh_schedule_text(&check->schedule->robots, wafer->robot);
    if (wafer->place != WH_FLOW_NONE) {
        (void)wh_check_place_name(check, wafer->place, &place);
    }
    switch (wafer->where) {
    case WH_CHECK_LIES:
        (void)snprintf(text->text, sizeof text->text, "lies in %.300s", place.text);
        break;
    case WH_CHECK_TAKEN:
        (void)snprintf(text->text, sizeof text->text, "is being picked by %s", robot);
        break;
    case WH_CHECK_ABOARD:
        (void)snprintf(text->text, sizeof text->text, "is aboard %s", robot);
        break;
    case WH_CHECK_PLACED:
        (void)snprintf(text->text, sizeof text->text, "is being placed into %.300s", place.text);
        break;
    case WH_CHECK_NOWHERE:
    default:
        (void)snprintf(text->text, sizeof text->text, "is nowhere yet");
        break;
    }
    return text->text;
}

const wh_flow_station_t *wh_check_station(const wh_schedule_state_t *check, int32_t station) {
    return check->tool ? &check->tool->stations[check->stations[station].tool] : NULL;
}

size_t wh_check_pair(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    return wh_flow_of(check->tool, check->robots[row->robot].tool, check->stations[row->station].tool);
}

/* ------------------------------------------------------------------------------------------------ actions */

static void begin_access(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_robot_begins(check, row);
    wh_check_access(check, row);
    if (of->action == WH_SCHEDULE_PICK) {
        wh_check_begin_take(check, row, of->wafer);
        wh_check_takes_aboard(check, row, of->wafer, of->arm);
        return;
    }
    wh_check_need_aboard(check, row, of->wafer);
    if (of->action == WH_SCHEDULE_SWAP) {
        const int32_t arm = check->wafers[of->wafer].arm;
        wh_check_begin_take(check, row, of->wafer2);
        wh_check_takes_aboard(check, row, of->wafer2, arm > 0 ? 3 - arm : 0);
        const wh_check_wafer_t *out = &check->wafers[of->wafer2];
        wh_check_begin_put(check, row, of->wafer, out->place == of->place ? 1 : 0);
    } else {
        wh_check_begin_put(check, row, of->wafer, 0);
    }
}

static void begin_row(wh_schedule_state_t *check, int32_t row) {
    static void (*const begins[WH_SCHEDULE_ACTIONS])(wh_schedule_state_t * check, int32_t row) = {
        [WH_SCHEDULE_START] = wh_check_begin_start, [WH_SCHEDULE_PICK] = begin_access,
        [WH_SCHEDULE_PLACE] = begin_access,         [WH_SCHEDULE_SWAP] = begin_access,
        [WH_SCHEDULE_MOVE] = wh_check_robot_begins, [WH_SCHEDULE_PROCESS] = wh_check_begin_process,
        [WH_SCHEDULE_CLEAN] = wh_check_begin_clean, [WH_SCHEDULE_PUMP] = wh_check_begin_pump,
        [WH_SCHEDULE_OPEN] = wh_check_begin_door,   [WH_SCHEDULE_CLOSE] = wh_check_begin_door,
        [WH_SCHEDULE_LEAVE] = wh_check_begin_leave};
    begins[wh_check_row(check, row)->action](check, row);
}

static void end_row(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    if (of->action == WH_SCHEDULE_PICK) {
        wh_check_end_take(check, row, of->wafer);
    } else if (of->action == WH_SCHEDULE_PLACE) {
        wh_check_end_put(check, row, of->wafer);
    } else if (of->action == WH_SCHEDULE_SWAP) {
        wh_check_end_take(check, row, of->wafer2);
        wh_check_end_put(check, row, of->wafer);
    } else if (of->action == WH_SCHEDULE_PUMP) {
        wh_check_end_pump(check, row);
    } else if (of->action == WH_SCHEDULE_OPEN || of->action == WH_SCHEDULE_CLOSE) {
        wh_check_end_door(check, row);
    }
}

/* ----------------------------------------------------------------------------------------------- instants */

/* An instant, in this order. */
enum { ENDS, LEAVES, COMES, IN_NO_TIME, BEGINS };

typedef struct {
    int64_t us;
    int32_t row;
    int32_t phase;
} moment_t;

static int by_time(const void *a, const void *b) {
    const moment_t *one = a, *other = b;
    if (one->us != other->us) {
        return one->us < other->us ? -1 : 1;
    }
    return one->phase != other->phase ? one->phase - other->phase : one->row < other->row ? -1 : 1;
}

/* A begin comes behind all that ends within an instant of it. A row shorter than that begins and ends
 * at once. */
static size_t list_moments(const wh_schedule_t *schedule, moment_t moments[]) {
    size_t count = 0;
    for (int32_t i = 0; i < (int32_t)schedule->count; ++i) {
        const wh_schedule_row_t *row = &schedule->rows[i];
        const int64_t begin_us = row->begin_us + WH_SCHEDULE_INSTANT_US;
        if (wh_schedule_is_instant(row->action)) {
            const bool leaves = row->action == WH_SCHEDULE_LEAVE;
            moments[count++] = (moment_t){row->begin_us, i, leaves ? LEAVES : COMES};
        } else if (row->end_us <= begin_us) {
            moments[count++] = (moment_t){begin_us, i, IN_NO_TIME};
        } else {
            moments[count++] = (moment_t){begin_us, i, BEGINS};
            moments[count++] = (moment_t){row->end_us, i, ENDS};
        }
    }
    qsort(moments, count, sizeof *moments, by_time);
    return count;
}

static bool lies_there(const wh_schedule_state_t *check, int32_t wafer, int32_t place) {
    return check->wafers[wafer].where == WH_CHECK_LIES && check->wafers[wafer].place == place;
}

static bool is_aboard(const wh_schedule_state_t *check, const wh_schedule_row_t *row) {
    const wh_check_wafer_t *wafer = &check->wafers[row->wafer];
    return wafer->where == WH_CHECK_ABOARD && wafer->robot == row->robot;
}

/* True if an action without duration fits what is so far. */
static bool is_possible(const wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_check_place_t *place = &check->places[of->place];
    if (of->action == WH_SCHEDULE_PICK) {
        const wh_check_robot_t *robot = &check->robots[of->robot];
        const bool has_arm = robot->arms == 0 || robot->aboard < robot->arms;
        return has_arm && lies_there(check, of->wafer, of->place);
    }
    if (of->action == WH_SCHEDULE_PLACE) {
        return is_aboard(check, of) && place->count < place->capacity;
    }
    return of->action != WH_SCHEDULE_SWAP ||
           (is_aboard(check, of) && lies_there(check, of->wafer2, of->place));
}

/* All that takes no time at one instant: what can go first goes first. */
static void go_in_no_time(wh_schedule_state_t *check, moment_t moments[], size_t count) {
    size_t left = count;
    for (int pass = 0; left > 0; ++pass) {
        size_t kept = 0;
        for (size_t i = 0; i < left; ++i) {
            const bool is_forced = pass >= MOST_PASSES;
            if (is_forced || is_possible(check, moments[i].row)) {
                begin_row(check, moments[i].row);
                end_row(check, moments[i].row);
            } else {
                moments[kept++] = moments[i];
            }
        }
        pass = kept == left ? MOST_PASSES : pass; /* none can: they go as they stand */
        left = kept;
    }
}

static void go(wh_schedule_state_t *check, moment_t moments[], size_t count) {
    for (size_t i = 0; i < count;) {
        if (moments[i].phase != IN_NO_TIME) {
            if (moments[i].phase == ENDS) {
                end_row(check, moments[i].row);
            } else {
                begin_row(check, moments[i].row);
            }
            ++i;
            continue;
        }
        size_t end = i;
        while (end < count && moments[end].us == moments[i].us && moments[end].phase == IN_NO_TIME) {
            ++end;
        }
        go_in_no_time(check, moments + i, end - i);
        i = end;
    }
}

/* -------------------------------------------------------------------------------------------------- whole */

static void check_all(wh_schedule_state_t *check) {
    moment_t *moments = wh_array_new(2 * check->schedule->count + 1, sizeof *moments);
    const size_t count = list_moments(check->schedule, moments);
    wh_check_begin(check);
    go(check, moments, count);
    wh_check_guess_unit(check);
    wh_check_finish_stays(check);
    wh_check_finish_routes(check);
    wh_check_judge(check);
    free(moments);
}

bool wh_schedule_check(wh_schedule_report_t *report, const wh_schedule_t *schedule,
                       const wh_schedule_given_t *given) {
    wh_schedule_state_t check = {.schedule = schedule, .tool = given->tool, .report = report};
    report->schedule = schedule;
    wh_check_open(&check);
    const bool good = !check.tool || wh_check_take_names(&check);
    for (size_t i = 0; given->arms && i < schedule->robots.count; ++i) {
        check.robots[i].arms = given->arms[i] > 0 ? given->arms[i] : check.robots[i].arms;
    }
    if (good) {
        check_all(&check);
    }
    wh_check_close(&check);
    return good;
}

void wh_schedule_report_close(wh_schedule_report_t *report) {
    for (size_t i = 0; i < report->count; ++i) {
        free(report->findings[i].text);
    }
    for (size_t i = 0; i < WH_SCHEDULE_RULES; ++i) {
        free(report->rules[i].but);
    }
    free(report->findings);
    memset(report, 0, sizeof *report);
}

const wh_schedule_finding_t *wh_schedule_first(const wh_schedule_report_t *report) {
    for (size_t i = 0; i < report->count; ++i) {
        if (!report->findings[i].is_warning) {
            return &report->findings[i];
        }
    }
    return NULL;
}

const wh_schedule_finding_t *wh_schedule_first_bar(const wh_schedule_report_t *report) {
    for (size_t i = 0; i < report->count; ++i) {
        const wh_schedule_finding_t *finding = &report->findings[i];
        if (!finding->is_warning && finding->rule != WH_SCHEDULE_RULE_WINDOW) {
            return finding;
        }
    }
    return NULL;
}

bool wh_schedule_is_good(const wh_schedule_report_t *report) {
    return report->count == 0 && wh_schedule_is_looked(report) && report->scale == 1;
}

bool wh_schedule_is_looked(const wh_schedule_report_t *report) {
    for (int i = 1; i <= WH_SCHEDULE_NEEDED; ++i) {
        if (!report->rules[i].is_looked) {
            return false;
        }
    }
    return true;
}
