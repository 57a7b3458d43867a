/* Which rules were looked at, and why others were not. */
#include <stdarg.h>
#include <stdio.h>

#include "../text/array.h"
#include "check_internal.h"

typedef struct {
    size_t rows[WH_SCHEDULE_ACTIONS]; /* by action */
    bool has_windows, has_cleans, has_locks, has_doors;
} facts_t;

static facts_t find_facts(const wh_schedule_state_t *check) {
    facts_t facts = {{0}, false, false, false, false};
    for (size_t i = 0; i < check->schedule->count; ++i) {
        ++facts.rows[check->schedule->rows[i].action];
    }
    for (size_t s = 0; check->tool && s < check->tool->station_count; ++s) {
        const wh_flow_station_t *station = &check->tool->stations[s];
        facts.has_windows = facts.has_windows || station->window_us != WH_FLOW_NEVER;
        facts.has_cleans = facts.has_cleans || wh_flow_is_cleaned(station);
        facts.has_locks = facts.has_locks || station->is_lock;
    }
    for (size_t i = 0; check->tool && i < check->tool->robot_count * check->tool->station_count; ++i) {
        facts.has_doors = facts.has_doors || check->tool->doors[i].close_us > 0;
    }
    return facts;
}

/* `but`: why not, or what was left out; null: nothing was. */
__attribute__((format(printf, 4, 5))) static void judge(wh_schedule_state_t *check, int rule, bool is_looked,
                                                        const char *but, ...) {
    wh_schedule_verdict_t *verdict = &check->report->rules[rule];
    char text[600];
    verdict->is_looked = is_looked;
    if (but) {
        va_list arguments;
        va_start(arguments, but);
        (void)vsnprintf(text, sizeof text, but, arguments);
        va_end(arguments);
        verdict->but = wh_text_copy(text);
    }
}

/* Robots that pick, and whose arms nobody knows. */
static void judge_arms(wh_schedule_state_t *check, bool has_picks) {
    char names[400] = "";
    const char *first = NULL;
    size_t length = 0;
    for (size_t i = 0; i < check->schedule->robots.count; ++i) {
        const wh_check_robot_t *robot = &check->robots[i];
        const bool acts = robot->row != WH_CHECK_NO_ROW;
        if (acts && robot->arms == 0 && !robot->tells_arms && length < 250) {
            first = first ? first : check->schedule->robots.texts[i];
            length += (size_t)snprintf(names + length, sizeof names - length, "%s%.120s",
                                       length > 0 ? ", " : "", check->schedule->robots.texts[i]);
        }
    }
    if (!has_picks) {
        judge(check, WH_SCHEDULE_RULE_ARMS, false, "no robot picks");
    } else if (length > 0) {
        judge(check, WH_SCHEDULE_RULE_ARMS, false,
              "nobody says how many arms these have: %s (--arms %.120s=1)", names, first);
    } else {
        judge(check, WH_SCHEDULE_RULE_ARMS, true, NULL);
    }
}

static void judge_needed(wh_schedule_state_t *check, const facts_t *facts) {
    const size_t picks = facts->rows[WH_SCHEDULE_PICK] + facts->rows[WH_SCHEDULE_SWAP];
    const size_t places = facts->rows[WH_SCHEDULE_PLACE] + facts->rows[WH_SCHEDULE_SWAP];
    const size_t moves = facts->rows[WH_SCHEDULE_MOVE];
    judge(check, WH_SCHEDULE_RULE_BUSY, picks + places + moves > 0,
          picks + places + moves > 0 ? NULL : "no robot acts");
    judge_arms(check, picks > 0);
    judge(check, WH_SCHEDULE_RULE_ABSENT, picks > 0, picks > 0 ? NULL : "no robot picks");
    judge(check, WH_SCHEDULE_RULE_NOT_ABOARD, places > 0, places > 0 ? NULL : "no robot places");
    if (places > 0 && check->report->stacked > 0) {
        judge(check, WH_SCHEDULE_RULE_FULL, true,
              "where several wafers begin in one slot, it holds as many: in %zu", check->report->stacked);
    } else {
        judge(check, WH_SCHEDULE_RULE_FULL, places > 0, places > 0 ? NULL : "no robot places");
    }
}

/* A rule for which the layout has what is needed, or not; `without` says what is missing then. */
static void judge_layout(wh_schedule_state_t *check, int rule, bool has_it, const char *without) {
    if (has_it) {
        judge(check, rule, true, NULL);
    } else {
        judge(check, rule, false, "%s", check->tool ? without : "no layout");
    }
}

static void judge_times(wh_schedule_state_t *check, const facts_t *facts) {
    judge_layout(check, WH_SCHEDULE_RULE_MOVE, check->tool != NULL, "");
    judge_layout(check, WH_SCHEDULE_RULE_SHORT, check->tool != NULL, "");
    judge_layout(check, WH_SCHEDULE_RULE_WINDOW, facts->has_windows, "no window in the layout");
    if (check->tool) {
        judge(check, WH_SCHEDULE_RULE_PROCESS, true, NULL);
    } else if (facts->rows[WH_SCHEDULE_PROCESS] > 0 && check->report->repeated > 0) {
        judge(
            check, WH_SCHEDULE_RULE_PROCESS, true,
            "by the schedule's own processes: no layout, which would say whether %zu of them may come again",
            check->report->repeated);
    } else if (facts->rows[WH_SCHEDULE_PROCESS] > 0) {
        judge(check, WH_SCHEDULE_RULE_PROCESS, true, "by the schedule's own processes: no layout");
    } else {
        judge(check, WH_SCHEDULE_RULE_PROCESS, false, "no layout, and no process in the schedule");
    }
}

static void judge_cleans(wh_schedule_state_t *check, const facts_t *facts) {
    if (facts->has_cleans && check->has_cleans) {
        judge(check, WH_SCHEDULE_RULE_CLEAN, true, NULL);
    } else if (facts->has_cleans) {
        judge(check, WH_SCHEDULE_RULE_CLEAN, true,
              "by time alone: no clean in the schedule, so each that is due counts where it would fit");
    } else if (facts->rows[WH_SCHEDULE_CLEAN] > 0) {
        judge(check, WH_SCHEDULE_RULE_CLEAN, true, "places during cleans alone: %s",
              check->tool ? "the layout has no clean" : "no layout");
    } else {
        judge(check, WH_SCHEDULE_RULE_CLEAN, false, "no clean in the schedule%s",
              check->tool ? ", nor in the layout" : ", and no layout");
    }
}

/* True if the schedule tells of both doors of a load lock. */
static bool has_two_doors(const wh_schedule_state_t *check) {
    for (size_t i = 1; i < check->door_count; ++i) {
        const wh_check_door_t *one = &check->doors[i - 1], *other = &check->doors[i];
        if (one->station == other->station && one->key == 0 && other->key == 1) {
            return true;
        }
    }
    return false;
}

/* True if a robot reaches into a station of whose door the schedule does not tell. */
static bool has_other_stations(const wh_schedule_state_t *check) {
    for (size_t i = 0; i < check->schedule->count; ++i) {
        const wh_schedule_row_t *row = &check->schedule->rows[i];
        if (wh_schedule_is_access(row->action) && !wh_check_door_of(check, row)) {
            return true;
        }
    }
    return false;
}

/* True if the schedule tells of a door of a station with several slots. */
static bool has_door_of_many(const wh_schedule_state_t *check) {
    for (size_t i = 0; i < check->door_count; ++i) {
        if (!wh_check_has_one_slot(check, check->doors[i].station)) {
            return true;
        }
    }
    return false;
}

static void judge_locks(wh_schedule_state_t *check, const facts_t *facts) {
    judge_layout(check, WH_SCHEDULE_RULE_PRESSURE, facts->has_locks, "no load lock in the layout");
    if (has_two_doors(check)) {
        judge(check, WH_SCHEDULE_RULE_BOTH_OPEN, true, NULL);
    } else {
        judge(check, WH_SCHEDULE_RULE_BOTH_OPEN, false, "no load lock with two doors in the schedule");
    }
    if (check->door_count == 0 && facts->has_doors) {
        judge(check, WH_SCHEDULE_RULE_DOOR, true, "processes alone: no door opens or closes in the schedule");
    } else if (check->door_count == 0) {
        judge(check, WH_SCHEDULE_RULE_DOOR, false, "no door opens or closes in the schedule");
    } else if (check->doors_from_open > 0) {
        judge(check, WH_SCHEDULE_RULE_DOOR, true,
              "where the schedule tells of doors, but not before the first row of %zu: it shuts, and nothing "
              "has a start",
              check->doors_from_open);
    } else if (has_door_of_many(check)) {
        judge(check, WH_SCHEDULE_RULE_DOOR, true,
              "where the schedule tells of doors; open ones during a process: at stations of one slot");
    } else if (has_other_stations(check)) {
        judge(check, WH_SCHEDULE_RULE_DOOR, true, "at the stations of whose doors the schedule tells");
    } else {
        judge(check, WH_SCHEDULE_RULE_DOOR, true, NULL);
    }
}

void wh_check_judge(wh_schedule_state_t *check) {
    const facts_t facts = find_facts(check);
    const bool has_routes = check->tool && check->tool->route_count > 0;
    judge_needed(check, &facts);
    judge_times(check, &facts);
    judge_cleans(check, &facts);
    judge_locks(check, &facts);
    judge_layout(check, WH_SCHEDULE_RULE_SERVES, check->tool != NULL, "");
    judge_layout(check, WH_SCHEDULE_RULE_ROUTE, has_routes, "no routes in the layout");
    judge(check, WH_SCHEDULE_RULE_TWO_PLACES, true, NULL);
    if (has_routes) {
        judge(check, WH_SCHEDULE_RULE_LEFT, true, NULL);
    } else {
        judge(check, WH_SCHEDULE_RULE_LEFT, true, "wafers aboard%s alone: %s",
              check->tool ? ", in locks, and where there is a process" : "",
              check->tool ? "no routes in the layout" : "no layout");
    }
}
