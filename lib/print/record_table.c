#include "record_print.h"

#include <inttypes.h>

#include "../sim/event_text.h"
#include "../text/array.h"
#include "print_internal.h"

/* ------------------------------------------------------------------------------------------------ heading */

/* "tolerance paper: |dr_proj_z| < 0.5 mm, ...; sampled every 1 ms" */
static void print_tolerance(const wh_printer_t *printer) {
    const wh_layout_t *layout = printer->record->layout;
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    fprintf(
        printer->out,
        "tolerance %s: |dr_proj_z| < %.10g mm%s, |dr_proj_xy| < %.10g mm%s, n1_proj_n2 > %.10g (%.2f%s)%s\n",
        layout->tolerance_name, limits->projz, wh_print_default(layout, 0), limits->projxy,
        wh_print_default(layout, 1), limits->planar, wh_print_tilt_deg(limits->planar),
        wh_style_glyph(printer->style, WH_GLYPH_DEGREE), wh_print_default(layout, 2));
    fprintf(printer->out, "checked %s %g ms; wafers %s\n", wh_print_check(layout),
            (double)layout->slice_us / 1e3,
            layout->grasp.seat ? "are drawn flat onto the pads" : "stay as they were taken");
}

static void print_heading(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    wh_print_say(printer, "%s on %s", record->script ? record->script : "(no script)",
                 record->layout ? record->layout->path : "no layout");
    fputc('\n', printer->out);
    if (wh_record_is_timed(record)) {
        fprintf(printer->out, "times alone: the robots are of kind \"timed\", and nothing stands anywhere\n");
    } else if (record->layout) {
        print_tolerance(printer);
    }
    for (size_t i = 0; i < record->error_count; ++i) {
        wh_print_say(printer, "%s%s", i == 0 ? "! off by " : ", ", record->errors[i]);
    }
    if (record->error_count > 0) {
        fputc('\n', printer->out);
    }
    if (record->trial) {
        fprintf(printer->out, "! off by what trial %" PRIu64 " of seed %" PRIu64 " draws\n",
                record->trial->trial, record->trial->seed);
    }
}

/* --------------------------------------------------------------------------------------------- complaints */

/* Misses and complaints: events that almost happened or should not have happened, and which condition failed
 * by how much. */
enum { AT, WHAT, WAFER, GRIPPER, MEASURED, WHY = MEASURED + WH_PRINT_MEASURED_COLUMNS };

static const char *part_name(const wh_layout_t *layout, int32_t part) {
    const char *name = layout ? wh_layout_part_name(layout, part) : NULL;
    return name ? name : "none";
}

static const char *find_name(const void *user, wh_name_kind_t kind, int32_t index) {
    const wh_printer_t *printer = user;
    if (kind == WH_NAME_PART) {
        return part_name(printer->record->layout, index);
    }
    return kind == WH_NAME_WAFER ? wh_print_wafer(printer, index) : wh_print_gripper(printer, index);
}

/* One row for each reason, the first of them the event's own. */
static void say_why(const wh_printer_t *printer, wh_grid_t *grid, double at, const wh_event_t *event) {
    const wh_layout_t *layout = printer->record->layout;
    const wh_event_names_t names = {find_name, printer, 1, layout ? &layout->grasp.tolerance : NULL,
                                    wh_style_glyph(printer->style, WH_GLYPH_DEGREE)};
    char why[WH_EVENT_TEXT_SIZE];
    const bool is_unknown = event->kind == WH_EVENT_NEAR_MISS && !layout;
    for (size_t i = 0; !is_unknown && wh_event_reason(event, &names, i, why, sizeof why) > 0; ++i) {
        if (i > 0) {
            wh_grid_row(grid);
            wh_grid_number(grid, AT, WH_INK_DIM, at);
        }
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s", why);
    }
}

static void add_event(const wh_printer_t *printer, wh_grid_t *grid, const wh_event_record_t *record) {
    const wh_event_t *event = &record->event;
    const double at = (double)record->utime / 1e6;
    char what[32];
    wh_text_words(what, sizeof what, wh_event_name(event->kind));
    wh_grid_row(grid);
    wh_grid_number(grid, AT, WH_INK_PLAIN, at);
    wh_grid_text(grid, WHAT, wh_print_is_complaint(event->kind) ? WH_INK_BAD : WH_INK_WARN, "%s", what);
    wh_grid_text(grid, WAFER, WH_INK_PLAIN, "%s", wh_print_wafer(printer, event->wafer));
    wh_grid_text(grid, GRIPPER, WH_INK_PLAIN, "%s", wh_print_gripper(printer, event->gripper));
    if (event->kind == WH_EVENT_NEAR_MISS || event->kind == WH_EVENT_CONTESTED) {
        wh_print_measured(printer, grid, MEASURED, event);
    }
    say_why(printer, grid, at, event);
}

/* True if an event belongs among the misses: no wafer that a carrier brings or takes. */
static bool is_miss(const wh_event_t *event) {
    static const uint32_t others = 1U << WH_EVENT_NEAR_MISS | 1U << WH_EVENT_VACUUM_LOST |
                                   1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    return !wh_record_is_carried(event) &&
           ((others >> (unsigned)event->kind & 1U) != 0 || wh_print_is_complaint(event->kind));
}

/* A brief run has complaints alone: all of them are there. */
static void print_complaints(const wh_printer_t *printer, bool is_brief) {
    const wh_record_t *record = printer->record;
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "at s{3,6};what;wafer;gripper");
    wh_print_measured_columns(printer, grid);
    wh_grid_columns(grid, "why");
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (is_brief ? wh_record_is_complaint(event->kind) : is_miss(event)) {
            add_event(printer, grid, &record->events[i]);
        }
    }
    wh_print_titled(printer, is_brief ? "Complaints" : "Misses and complaints", grid);
}

/* ------------------------------------------------------------------------------------------- expectations */

enum { MARK, LINE, TEXT };

static size_t count_unmet(const wh_record_t *record) {
    size_t unmet = 0;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        unmet += record->expectations[i].ok ? 0 : 1;
    }
    return unmet;
}

static void print_unmet(const wh_printer_t *printer) {
    wh_grid_t *grid = wh_grid_new(printer->style, 0, ";line{0};expected");
    for (size_t i = 0; i < printer->record->expectation_count; ++i) {
        const wh_expectation_record_t *expectation = &printer->record->expectations[i];
        if (expectation->ok) {
            continue;
        }
        wh_grid_row(grid);
        wh_grid_text(grid, MARK, WH_INK_BAD, "%s", wh_style_glyph(printer->style, WH_GLYPH_CROSS));
        if (expectation->line > 0) {
            wh_grid_number(grid, LINE, WH_INK_DIM, expectation->line);
        }
        wh_grid_text(grid, TEXT, WH_INK_PLAIN, "%s", expectation->text ? expectation->text : "");
    }
    wh_grid_print(grid, printer->out);
}

static void print_expectations(const wh_printer_t *printer) {
    const size_t count = wh_record_expectations(printer->record);
    const size_t unmet = count_unmet(printer->record);
    if (count == 0) {
        return;
    }
    wh_print_title(printer, "Expectations");
    if (unmet > 0) {
        print_unmet(printer);
    }
    if (unmet < count) {
        wh_style_print(printer->style, printer->out, WH_INK_GOOD, "%s",
                       wh_style_glyph(printer->style, WH_GLYPH_TICK));
        fprintf(printer->out, " %s%zu met\n", unmet == 0 && count > 1 ? "all " : "", count - unmet);
    }
}

/* ------------------------------------------------------------------------------------------------ summary */

static void print_times_alone(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    fprintf(printer->out, "\n%.6f s by events; %.3f s of wall time\nhash %016llx\n", record->simulated_s,
            record->wall_s, (unsigned long long)record->hash);
}

static void print_times(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    if (wh_record_is_timed(record)) {
        print_times_alone(printer);
        return;
    }
    fputc('\n', printer->out);
    wh_print_counted(printer->out, (int64_t)wh_record_commands(record), "command", "commands");
    fprintf(printer->out, ", %.3f s simulated in ", record->simulated_s);
    wh_print_counted(printer->out, record->slices, "slice", "slices");
    if (record->missed > 0) {
        fprintf(printer->out, ", of which the simulator missed %lld", (long long)record->missed);
    }
    if (record->crowded > 0) {
        fprintf(printer->out, ", of which %lld had more events than are told", (long long)record->crowded);
    }
    fprintf(printer->out, "; %.3f s of wall time", record->wall_s);
    if (record->wall_s > 0 && record->simulated_s > record->wall_s) {
        const double times = record->simulated_s / record->wall_s;
        char text[WH_PRINT_NUMBER_SIZE];
        (void)wh_print_count(text, times < 9e15 ? (int64_t)times : INT64_C(9000000000000000));
        if (times < 10) {
            snprintf(text, sizeof text, "%.1f", times);
        }
        fprintf(printer->out, ", %s times faster than real time", text);
    }
    fputc('\n', printer->out);
    wh_print_throughput(printer);
    fprintf(printer->out, "hash %016llx\n", (unsigned long long)record->hash);
}

static void print_counted(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const wh_counted_record_t *counted = &record->counted;
    char count[WH_PRINT_NUMBER_SIZE];
    if (counted->is_wanted && wh_record_is_timed(record)) {
        fputs("played by events: there were no slices that --counted could leave out\n", printer->out);
    }
    if (!counted->is_wanted || wh_record_is_timed(record)) {
        return;
    }
    fprintf(printer->out, "played %s of ", wh_print_count(count, record->slices - counted->left_out));
    wh_print_counted(printer->out, record->slices, "slice", "slices");
    fputs(": nothing was decided in the others\n", printer->out);
    fprintf(printer->out, "counted %s of ", wh_print_count(count, (int64_t)counted->commands));
    wh_print_counted(printer->out, (int64_t)wh_record_commands(record), "command", "commands");
    fputs(", of which slices were left out: the others were played whole\n", printer->out);
    if (counted->is_verified) {
        fprintf(printer->out, "verified %s of ", wh_print_count(count, (int64_t)counted->verified));
        wh_print_counted(printer->out, (int64_t)counted->stretches, "stretch", "stretches");
        fputs(" that could be left out, by playing them\n", printer->out);
    }
    if (record->checked && counted->moving > 0) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fprintf(printer->out, WH_RECORD_COUNTED_UNLOOKED " were looked for in %s of ",
                wh_print_count(count, record->slices - counted->moving));
        wh_print_counted(printer->out, record->slices, "slice", "slices");
        fputc('\n', printer->out);
    }
}

/* A reason for the verdict, if there is one. */
static void put_reason(FILE *out, const char **before, size_t count, const char *one, const char *many) {
    if (count > 0) {
        fputs(*before, out);
        wh_print_counted(out, (int64_t)count, one, many);
        *before = ", ";
    }
}

/* Errors that the script caught are no reason. Complaints are, whatever was expected. */
static void put_reasons(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const size_t unmet = count_unmet(record);
    const size_t expected = wh_record_expectations(record);
    size_t complaints = 0;
    for (size_t i = 0; i < record->event_count; ++i) {
        complaints += wh_record_is_complaint(record->events[i].event.kind) ? 1 : 0;
    }
    const char *before = ": ";
    put_reason(printer->out, &before, unmet, "expectation not met", "expectations not met");
    put_reason(printer->out, &before, record->failure ? wh_record_errors(record) : 0, "command with an error",
               "commands with errors");
    put_reason(printer->out, &before, complaints, "complaint", "complaints");
    if (before[0] == ',' && unmet == 0 && expected > 0) {
        fprintf(printer->out, ", though %s met",
                expected == 1 ? "the expectation is" : "all expectations are");
    }
}

static void print_cut(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    if (record->flow && wh_flow_is_cut(record->flow)) {
        const wh_flow_figures_t *figures = &record->flow->figures;
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        const size_t wafers = figures->plan->wafer_count;
        fprintf(printer->out, "%s at %.10g s: %zu of %zu %s not at %s\n",
                figures->result.is_steady ? "steady, and ended" : "cut", (double)figures->end_us / 1e6,
                figures->result.left, wafers, wafers == 1 ? "wafer" : "wafers",
                figures->result.left == 1 ? "its end" : "their ends");
    } else if (record->flow && record->flow->asks_steady &&
               record->flow->figures.result.end == WH_FLOW_DONE) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fputs(
            "not all in it came again, so that the flow was played to its end, and not until it is steady\n",
            printer->out);
    }
}

static void print_summary(const wh_printer_t *printer, bool is_brief) {
    const wh_record_t *record = printer->record;
    const char *verdict = record->ok ? "ok" : "failed";
    wh_ink_t ink = record->ok ? WH_INK_GOOD : WH_INK_BAD;
    if (wh_record_moved_nothing(record)) {
        verdict = "nothing moved";
        ink = WH_INK_WARN;
    }
    print_times(printer);
    print_counted(printer);
    if (is_brief) {
        fputs("brief: commands, near misses, stations' times and places of wafers are not listed\n",
              printer->out);
    }
    if (record->unlooked) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fprintf(printer->out, "%s\n", record->unlooked);
    }
    if (record->times_alone) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        wh_style_put(printer->out, record->times_alone);
        fputs(": " WH_RECORD_SOME_ALONE "\n", printer->out);
    }
    print_cut(printer);
    if (record->never_came) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fprintf(printer->out, "never came, and so were not tried: %s\n", record->never_came);
    }
    wh_style_print(printer->style, printer->out, ink, "%s", verdict);
    if (!record->ok) {
        put_reasons(printer);
    } else {
        const char *before = ", ";
        put_reason(printer->out, &before, wh_record_errors(record), "error caught", "errors caught");
    }
    fputc('\n', printer->out);
    if (record->failure) {
        wh_print_say(printer, "%s", record->failure);
        fputc('\n', printer->out);
    }
}

/* ------------------------------------------------------------------------------------------------- window */

static void print_window(const wh_printer_t *printer, const wh_record_sections_t *wanted) {
    const wh_record_t *record = printer->record;
    const bool is_whole = !(wanted->from_s > 0) && !(wanted->to_s > 0);
    const int64_t end = wanted->to_s > 0 ? wh_print_slice_at(printer, wanted->to_s) : record->slices;
    const wh_print_window_t window = {wh_print_slice_at(printer, wanted->from_s), end, is_whole};
    if (window.end <= window.begin && !is_whole) {
        wh_print_title(printer, "Gantt");
        fprintf(printer->out, "nothing: no slice of the run, which took %.3f s, lies there\n",
                record->simulated_s);
        return;
    }
    wh_print_gantt(printer, &window);
    wh_print_times(printer, &window);
}

/* ---------------------------------------------------------------------------------------------------- all */

static void print_rows(const wh_printer_t *printer) {
    if (!wh_record_is_timed(printer->record)) {
        wh_print_commands(printer);
    }
    wh_print_flow(printer);
    wh_print_errors(printer);
    wh_print_handovers(printer);
    print_complaints(printer, false);
    wh_print_stations(printer);
    wh_print_clearances(printer);
    wh_print_wafers(printer);
}

int wh_record_print_table(const wh_record_t *record, FILE *out, const wh_style_t *style,
                          const wh_record_sections_t *sections) {
    static const wh_record_sections_t none = {0};
    const wh_record_sections_t *wanted = sections ? sections : &none;
    const wh_printer_t printer = {record, style, out};
    print_heading(&printer);
    if (wanted->brief) {
        wh_print_flow(&printer);
        print_complaints(&printer, true);
        wh_print_clearances(&printer);
    } else {
        print_rows(&printer);
    }
    if (wanted->gantt) {
        print_window(&printer, wanted);
    }
    if (wanted->cycle) {
        wh_print_cycle(&printer);
    }
    if (wanted->margins) {
        wh_print_margins(&printer);
    }
    print_expectations(&printer);
    print_summary(&printer, wanted->brief);
    return fflush(out) != 0 || ferror(out) ? -1 : 0;
}
