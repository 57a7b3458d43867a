#include <inttypes.h>

#include "schedule_print.h"

static double seconds(int64_t us) {
    return (double)us / 1e6;
}

static const char *many(size_t count, const char *one, const char *several) {
    return count == 1 ? one : several;
}

/* --------------------------------------------------------------------------------------------------- rows */

static void put_cell(FILE *out, const char *column, const char *text) {
    if (text[0] != '\0') {
        fprintf(out, ", %s ", column);
        wh_style_put(out, text);
    }
}

/* All columns that a row has. */
static void put_row(FILE *out, const wh_schedule_t *schedule, size_t number) {
    const wh_schedule_row_t *row = &schedule->rows[number];
    fprintf(out, "  line %zu: action %s", row->line, wh_schedule_words[row->action]);
    put_cell(out, "robot", wh_schedule_text(&schedule->robots, row->robot));
    put_cell(out, "wafer", wh_schedule_text(&schedule->wafers, row->wafer));
    put_cell(out, "wafer2", wh_schedule_text(&schedule->wafers, row->wafer2));
    put_cell(out, "station", wh_schedule_text(&schedule->stations, row->station));
    fprintf(out, ", slot %d", (int)row->slot);
    put_cell(out, "to", wh_schedule_text(&schedule->stations, row->to));
    put_cell(out, "value", row->side == WH_FLOW_BOTH ? "" : wh_flow_side_words[row->side]);
    if (row->arm > 0) {
        fprintf(out, ", arm %d", (int)row->arm);
    }
    fprintf(out, ", begin_s %.10g, end_s %.10g\n", seconds(row->begin_us), seconds(row->end_us));
}

static void put_place(FILE *out, const wh_schedule_report_t *report, const wh_schedule_finding_t *finding) {
    wh_style_put(out, report->schedule->path);
    fprintf(out, ":%zu: ", report->schedule->rows[finding->row].line);
    wh_style_put(out, finding->text);
}

/* The first line that no tool can do. */
static void put_first(FILE *out, const wh_schedule_report_t *report) {
    const wh_schedule_finding_t *first = wh_schedule_first(report);
    if (!first) {
        return;
    }
    put_place(out, report, first);
    fprintf(out, "\n  rule %d: %s\n", first->rule, wh_schedule_rules[first->rule]);
    put_row(out, report->schedule, first->row);
    if (first->other != WH_SCHEDULE_NO_ROW) {
        put_row(out, report->schedule, first->other);
    }
    fputc('\n', out);
}

/* -------------------------------------------------------------------------------------------------- rules */

static void put_rule(FILE *out, const wh_style_t *style, const wh_schedule_report_t *report, int rule) {
    const wh_schedule_verdict_t *verdict = &report->rules[rule];
    const bool is_warning = rule == WH_SCHEDULE_RULE_LEFT;
    fprintf(out, "%2d  %-50s", rule, wh_schedule_rules[rule]);
    if (verdict->found > 0) {
        wh_style_print(style, out, is_warning ? WH_INK_WARN : WH_INK_BAD, "%zu %s", verdict->found,
                       is_warning ? many(verdict->found, "warning", "warnings") : "found");
    } else if (verdict->is_looked) {
        wh_style_print(style, out, WH_INK_GOOD, "none");
    } else {
        wh_style_print(style, out, WH_INK_WARN, "not looked at");
    }
    if (verdict->but) {
        fputs(verdict->is_looked ? "; " : ": ", out);
        wh_style_put(out, verdict->but);
    }
    fputc('\n', out);
}

static void put_findings(FILE *out, const wh_schedule_report_t *report) {
    for (int rule = 1; rule < WH_SCHEDULE_RULES; ++rule) {
        if (report->rules[rule].found == 0) {
            continue;
        }
        fprintf(out, "\nRule %d: %s\n", rule, wh_schedule_rules[rule]);
        for (size_t i = 0; i < report->count; ++i) {
            if (report->findings[i].rule == rule) {
                fputs("  ", out);
                put_place(out, report, &report->findings[i]);
                fputc('\n', out);
            }
        }
    }
}

/* -------------------------------------------------------------------------------------------------- notes */

/* Times in another unit make all else senseless: it comes first. */
static void put_unit(FILE *out, const wh_style_t *style, const wh_schedule_report_t *report) {
    if (report->scale > 1) {
        wh_style_print(
            style, out, WH_INK_WARN,
            "! picks and places are some 1000 times too short: are begin_s and end_s given in seconds? "
            "(a map's scale is the factor to seconds)\n\n");
    } else if (report->scale < 1) {
        wh_style_print(style, out, WH_INK_WARN,
                       "! picks and places are far too long: are begin_s and end_s in %s? (expected seconds; "
                       "--columns with scale = %g)\n\n",
                       wh_schedule_unit(report->scale), report->scale);
    }
}

static void put_notes(FILE *out, const wh_style_t *style, const wh_schedule_report_t *report) {
    if (!report->schedule->ends_whole) {
        wh_style_print(style, out, WH_INK_WARN, "! the last line has no line end: the file may be cut\n");
    }
    if (report->assumed > 0) {
        fprintf(out, "! %zu %s no start: %s where the first row finds %s, since time 0\n", report->assumed,
                many(report->assumed, "wafer has", "wafers have"), many(report->assumed, "it is", "each is"),
                many(report->assumed, "it", "it"));
    }
}

static void put_unused(FILE *out, const wh_schedule_names_t *unused) {
    for (size_t i = 0; i < unused->count; ++i) {
        fputs(i > 0                ? ", "
              : unused->count == 1 ? "! nothing uses this column: "
                                   : "! nothing uses these columns: ",
              out);
        wh_style_put(out, unused->texts[i]);
    }
    if (unused->count > 0) {
        fputc('\n', out);
    }
}

static void put_verdict(FILE *out, const wh_style_t *style, const wh_schedule_report_t *report) {
    const size_t found = report->count - report->warnings, wafers = report->schedule->wafers.count;
    fputc('\n', out);
    if (found > 0) {
        wh_style_print(style, out, WH_INK_BAD, "not possible: %zu found", found);
    } else if (!wh_schedule_is_looked(report)) {
        wh_style_print(style, out, WH_INK_WARN,
                       "not known: nothing was found, but one of the rules 1 to %d was not looked at",
                       WH_SCHEDULE_NEEDED);
    } else if (report->scale != 1) {
        wh_style_print(style, out, WH_INK_WARN,
                       "not known: nothing was found, but times do not look like seconds");
    } else if (report->warnings > 0) {
        wh_style_print(style, out, WH_INK_WARN,
                       "not finished: nothing was found, but %zu %s left aboard or short of %s",
                       report->warnings, many(report->warnings, "wafer is", "wafers are"),
                       many(report->warnings, "its end", "their ends"));
    } else {
        wh_style_print(style, out, WH_INK_GOOD, "good, as far as it was looked at");
    }
    fprintf(out, "; %zu %s, %zu %s, %.10g s\n", report->schedule->count,
            many(report->schedule->count, "row", "rows"), wafers, many(wafers, "wafer", "wafers"),
            seconds(report->end_us));
}

/* --------------------------------------------------------------------------------------------------- play */

static void put_apart(FILE *out, const wh_schedule_t *schedule, const char *what, size_t row,
                      int64_t played_us) {
    const wh_schedule_row_t *of = &schedule->rows[row];
    fprintf(out, "  %s: line %zu, %s of ", what, of->line, wh_schedule_words[of->action]);
    wh_style_put(out, wh_schedule_text(&schedule->wafers, of->wafer));
    fputs(" at ", out);
    wh_style_put(out, wh_schedule_text(&schedule->stations, of->station));
    fprintf(out, ": at %.10g s, and at %.10g s as played\n", seconds(of->begin_us), seconds(played_us));
}

static void put_play(FILE *out, const wh_style_t *style, const wh_schedule_report_t *report,
                     const wh_schedule_play_t *play) {
    const wh_flow_result_t *result = &play->figures.result;
    fputs("\nPlayed by timed robots, each in the schedule's order, as soon as it can be\n", out);
    if (result->end != WH_FLOW_DONE) {
        wh_style_print(style, out, WH_INK_BAD, "  not to its end: ");
        wh_style_put(out, result->why ? result->why : "no reason");
        fputc('\n', out);
    }
    fprintf(out, "  makespan %.10g s; by the schedule %.10g s\n", seconds(result->makespan_us),
            seconds(play->makespan_us));
    fprintf(out, "  %zu of %zu picks and places begin at another time\n", play->differing, play->played);
    if (play->played < play->actions) {
        wh_style_print(style, out, WH_INK_BAD, "  %zu of %zu did not come about\n",
                       play->actions - play->played, play->actions);
    }
    if (play->differing > 0) {
        put_apart(out, report->schedule, "the first", play->first_row, play->first_us);
        put_apart(out, report->schedule, "the most apart", play->widest_row, play->widest_us);
    }
    if (play->figures.stays.late_count > 0) {
        wh_style_print(style, out, WH_INK_BAD, "  %zu %s beyond their windows as played\n",
                       play->figures.stays.late_count, many(play->figures.stays.late_count, "stay", "stays"));
    }
    if (play->resting > 0) {
        fprintf(out, "  ! %zu %s never carried: left out\n", play->resting,
                many(play->resting, "wafer is", "wafers are"));
    }
    fputs("  ! cleans and doors are the flow's own; rows that move a robot are left out\n", out);
}

int wh_schedule_print_table(const wh_schedule_report_t *report, const wh_schedule_play_t *play, FILE *out,
                            const wh_style_t *style) {
    put_unit(out, style, report);
    put_first(out, report);
    for (int rule = 1; rule < WH_SCHEDULE_RULES; ++rule) {
        put_rule(out, style, report, rule);
    }
    put_findings(out, report);
    put_notes(out, style, report);
    put_unused(out, &report->schedule->unused);
    put_verdict(out, style, report);
    if (play && play->is_played) {
        put_play(out, style, report, play);
    }
    return ferror(out) ? -1 : 0;
}
