/* What was looked at: each rule, and why not. */
#include <stdarg.h>
#include <stdio.h>

#include "../text/array.h"
#include "check_internal.h"

typedef struct {
    size_t rows[WH_SCHEDULE_ACTIONS]; /* by action */
    bool has_windows, has_cleans, has_locks;
} facts_t;

static facts_t find_facts(const wh_check_t *check) {
    facts_t facts = {{0}, false, false, false};
    for (size_t i = 0; i < check->schedule->count; ++i) {
        ++facts.rows[check->schedule->rows[i].action];
    }
    for (size_t s = 0; check->tool && s < check->tool->station_count; ++s) {
        const wh_flow_station_t *station = &check->tool->stations[s];
        facts.has_windows = facts.has_windows || station->window_us != WH_FLOW_NEVER;
        facts.has_cleans = facts.has_cleans || station->clean_after > 0 || station->idle_us != WH_FLOW_NEVER;
        facts.has_locks = facts.has_locks || station->is_lock;
    }
    return facts;
}

/* `but`: why not, or what was left out; null: nothing was. */
__attribute__((format(printf, 4, 5))) static void judge(wh_check_t *check, int rule, bool is_looked,
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
static void judge_arms(wh_check_t *check, bool has_picks) {
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

static void judge_needed(wh_check_t *check, const facts_t *facts) {
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

static void judge_times(wh_check_t *check, const facts_t *facts) {
    const char *no_layout = check->tool ? NULL : "no layout";
    judge(check, WH_SCHEDULE_RULE_MOVE, check->tool != NULL, no_layout ? "%s" : NULL, no_layout);
    judge(check, WH_SCHEDULE_RULE_SHORT, check->tool != NULL, no_layout ? "%s" : NULL, no_layout);
    if (check->tool) {
        judge(check, WH_SCHEDULE_RULE_PROCESS, true, NULL);
    } else if (facts->rows[WH_SCHEDULE_PROCESS] > 0) {
        judge(check, WH_SCHEDULE_RULE_PROCESS, true, "by the schedule's own processes: no layout");
    } else {
        judge(check, WH_SCHEDULE_RULE_PROCESS, false, "no layout, and no process in the schedule");
    }
    judge(check, WH_SCHEDULE_RULE_WINDOW, facts->has_windows,
          facts->has_windows ? NULL
          : check->tool      ? "no window in the layout"
                             : "no layout");
    if (facts->has_cleans) {
        judge(check, WH_SCHEDULE_RULE_CLEAN, true, NULL);
    } else if (facts->rows[WH_SCHEDULE_CLEAN] > 0) {
        judge(check, WH_SCHEDULE_RULE_CLEAN, true, "places during cleans alone: %s",
              check->tool ? "the layout has no clean" : "no layout");
    } else {
        judge(check, WH_SCHEDULE_RULE_CLEAN, false, "no clean in the schedule%s",
              check->tool ? ", nor in the layout" : ", and no layout");
    }
}

static void judge_locks(wh_check_t *check, const facts_t *facts) {
    const char *no_lock = check->tool ? "no load lock in the layout" : "no layout";
    const size_t doors = facts->rows[WH_SCHEDULE_OPEN] + facts->rows[WH_SCHEDULE_CLOSE];
    bool has_two = false, has_other = false;
    for (size_t i = 0; i < check->door_count; ++i) {
        const wh_check_door_t *door = &check->doors[i];
        has_two = has_two || (door->key == 1 && i > 0 && check->doors[i - 1].key == 0 &&
                              check->doors[i - 1].station == door->station);
    }
    for (size_t i = 0; i < check->schedule->count && !has_other; ++i) {
        const wh_schedule_row_t *row = &check->schedule->rows[i];
        has_other = wh_schedule_is_access(row->action) && !wh_check_door_of(check, row);
    }
    judge(check, WH_SCHEDULE_RULE_PRESSURE, facts->has_locks, facts->has_locks ? NULL : "%s", no_lock);
    judge(check, WH_SCHEDULE_RULE_BOTH_OPEN, has_two,
          has_two ? NULL : "no load lock whose doors both open or close in the schedule");
    judge(check, WH_SCHEDULE_RULE_DOOR, doors > 0,
          doors == 0  ? "no door opens or closes in the schedule"
          : has_other ? "but for the stations whose doors the schedule does not tell of"
                      : NULL);
}

void wh_check_judge(wh_check_t *check) {
    const facts_t facts = find_facts(check);
    const bool has_routes = check->tool && check->tool->route_count > 0;
    const char *no_routes = check->tool ? "no routes in the layout" : "no layout";
    judge_needed(check, &facts);
    judge_times(check, &facts);
    judge_locks(check, &facts);
    judge(check, WH_SCHEDULE_RULE_SERVES, check->tool != NULL, check->tool ? NULL : "no layout");
    judge(check, WH_SCHEDULE_RULE_ROUTE, has_routes, has_routes ? NULL : "%s", no_routes);
    judge(check, WH_SCHEDULE_RULE_TWO_PLACES, true, NULL);
    judge(check, WH_SCHEDULE_RULE_LEFT, true, has_routes ? NULL : "wafers aboard alone: %s", no_routes);
}
