/* A schedule that was held against the rules, as text and as JSON. */
#ifndef WH_PRINT_SCHEDULE_PRINT_H
#define WH_PRINT_SCHEDULE_PRINT_H

#include <stdio.h>

#include "../schedule/check.h"
#include "../schedule/play.h"
#include "../text/style.h"

/* The first finding with its rows, then each rule, then all findings by rule, and what was played; `play` may
 * be null. 0, or -1 if `out` does not take it. */
int wh_schedule_print_table(const wh_schedule_report_t *report, const wh_schedule_play_t *play, FILE *out,
                            const wh_style_t *style);
int wh_schedule_print_json(const wh_schedule_report_t *report, const wh_schedule_play_t *play, FILE *out);

#endif
