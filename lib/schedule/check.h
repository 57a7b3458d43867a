/* Holds a schedule against the rules that no tool can break, and says which of them it has looked at.
 *
 * All rows are taken in the order of time. At one instant what ends goes first. A process or a pump
 * without a row of its own is taken to begin as soon as it can, and so is a clean in a schedule that has no
 * row of any clean. After a finding it goes on as if the row were
 * right. */
#ifndef WH_SCHEDULE_CHECK_H
#define WH_SCHEDULE_CHECK_H

#include "schedule.h"

/* The rules by number. */
enum {
    WH_SCHEDULE_RULE_BUSY = 1,
    WH_SCHEDULE_RULE_ARMS,
    WH_SCHEDULE_RULE_ABSENT,
    WH_SCHEDULE_RULE_NOT_ABOARD,
    WH_SCHEDULE_RULE_FULL,
    WH_SCHEDULE_RULE_MOVE,
    WH_SCHEDULE_RULE_SHORT,
    WH_SCHEDULE_RULE_PROCESS,
    WH_SCHEDULE_RULE_WINDOW,
    WH_SCHEDULE_RULE_CLEAN,
    WH_SCHEDULE_RULE_PRESSURE,
    WH_SCHEDULE_RULE_BOTH_OPEN,
    WH_SCHEDULE_RULE_DOOR,
    WH_SCHEDULE_RULE_SERVES,
    WH_SCHEDULE_RULE_ROUTE,
    WH_SCHEDULE_RULE_TWO_PLACES,
    WH_SCHEDULE_RULE_LEFT, /* a warning */
    WH_SCHEDULE_RULES
};

/* Without these rules a schedule is not good: they need nothing but the schedule and arms. */
#define WH_SCHEDULE_NEEDED WH_SCHEDULE_RULE_FULL

/* By number; the first one is null. */
extern const char *const wh_schedule_rules[WH_SCHEDULE_RULES];

#define WH_SCHEDULE_NO_ROW SIZE_MAX

typedef struct {
    int rule;
    size_t row, other; /* other: the row that it collides with, or WH_SCHEDULE_NO_ROW */
    bool is_warning;
    char *text; /* "begin_s: 50 (expected 51.5 or later: ...)" */
} wh_schedule_finding_t;

typedef struct {
    bool is_looked; /* at all that the schedule has for it, but for `but` */
    char *but;      /* why it was not looked at, or what was left out; or null */
    size_t found;
} wh_schedule_verdict_t;

/* Zero it at the beginning. */
typedef struct {
    const wh_schedule_t *schedule;
    wh_schedule_finding_t *findings; /* in the order of time */
    size_t count, capacity, warnings;
    wh_schedule_verdict_t rules[WH_SCHEDULE_RULES]; /* by number */
    int64_t end_us;                                 /* of the last row */
    size_t placed;                                  /* wafers once placed by a robot */
    size_t assumed;    /* wafers without a start, which are where their first row finds them */
    size_t stacked;    /* places that hold several of those, without a layout */
    size_t repeated;   /* processes of a wafer behind the first one of a stay, without a layout */
    double scale;      /* what all times should be multiplied by, as they look; 1: they look like seconds */
    char message[600]; /* why it could not be looked at: a name that the layout does not have */
} wh_schedule_report_t;

/* All else that is known. */
typedef struct {
    const wh_flow_tool_t *tool; /* null: no layout */
    const int32_t *arms;        /* by the number of the robot's name; 0: not known; null: of none */
} wh_schedule_given_t;

/* Fills a zero report, which is to be closed in any case. False, with a message, if a name or a slot is not
 * the layout's. Cost: a sort of the rows, then constant for each of them. */
bool wh_schedule_check(wh_schedule_report_t *report, const wh_schedule_t *schedule,
                       const wh_schedule_given_t *given);
void wh_schedule_report_close(wh_schedule_report_t *report);

/* "s", "ms" or "us", by the report's scale. */
const char *wh_schedule_unit(double scale);

/* The first finding that is no warning; null: there is none. */
const wh_schedule_finding_t *wh_schedule_first(const wh_schedule_report_t *report);

/* The first finding for which it cannot be carried out: all but warnings and stays beyond windows, which
 * happen; null: there is none. */
const wh_schedule_finding_t *wh_schedule_first_bar(const wh_schedule_report_t *report);

/* True if all rules up to WH_SCHEDULE_NEEDED were looked at. */
bool wh_schedule_is_looked(const wh_schedule_report_t *report);

/* True if it is good: nothing was found, no wafer is left short of its end, all rules up to
 * WH_SCHEDULE_NEEDED were looked at, and the times look like seconds. */
bool wh_schedule_is_good(const wh_schedule_report_t *report);

#endif
