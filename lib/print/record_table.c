#include "record_print.h"

#include "../mcs/mcs.h"
#include "print_internal.h"

/* ------------------------------------------------------------------------------------------------ heading */

/* "tolerance paper: |dr_proj_z| < 0.5 mm, ...; sampled every 1 ms" */
static void print_tolerance(const wh_printer_t *printer) {
    const wh_layout_t *layout = printer->record->layout;
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    fprintf(printer->out,
            "tolerance %s: |dr_proj_z| < %.10g mm, |dr_proj_xy| < %.10g mm, n1_proj_n2 > %.10g (%.2f%s)\n",
            layout->tolerance_name, (double)limits->projz, (double)limits->projxy, (double)limits->planar,
            wh_print_tilt_deg((double)limits->planar), wh_style_glyph(printer->style, WH_GLYPH_DEGREE));
    fprintf(printer->out, "checked %s %g ms; wafers %s\n",
            layout->grasp.check == WH_CHECK_SWEPT ? "along the whole of each slice of"
                                                  : "once a slice, every",
            (double)layout->slice_us / 1e3,
            layout->grasp.seat ? "are drawn flat onto the pads" : "stay as they were taken");
}

static void print_heading(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    wh_print_put(printer, record->script ? record->script : "(no script)");
    fputs(" on ", printer->out);
    wh_print_put(printer, record->layout ? record->layout->path : "no layout");
    fputc('\n', printer->out);
    if (record->layout) {
        print_tolerance(printer);
    }
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
    wh_grid_t *grid = wh_grid_new(printer->style, 0);
    wh_grid_text_columns(grid, "", NULL);
    wh_grid_number_columns(grid, wh_grid_whole, "line", NULL);
    wh_grid_text_columns(grid, "expected", NULL);
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
    const size_t count = printer->record->expectation_count;
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

static void print_times(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    fputc('\n', printer->out);
    wh_print_counted(printer->out, (int64_t)record->command_count, "command", "commands");
    fprintf(printer->out, ", %.3f s simulated in ", record->simulated_s);
    wh_print_counted(printer->out, record->slices, "slice", "slices");
    if (record->missed > 0) {
        fprintf(printer->out, ", of which the simulator missed %lld", (long long)record->missed);
    }
    fprintf(printer->out, "; %.3f s of wall time", record->wall_s);
    if (record->wall_s > 0 && record->simulated_s > record->wall_s) {
        const double times = record->simulated_s / record->wall_s;
        if (times < 10) {
            fprintf(printer->out, ", %.1f", times);
        } else {
            char text[WH_PRINT_NUMBER_SIZE];
            wh_print_count(text, times < 9e15 ? (int64_t)times : INT64_C(9000000000000000));
            fprintf(printer->out, ", %s", text);
        }
        fputs(" times faster than real time", printer->out);
    }
    fputc('\n', printer->out);
    wh_print_throughput(printer);
    fprintf(printer->out, "hash %016llx\n", (unsigned long long)record->hash);
}

/* A reason for the verdict, if there is one. */
static void put_reason(FILE *out, const char **before, size_t count, const char *one, const char *many) {
    if (count > 0) {
        fputs(*before, out);
        wh_print_counted(out, (int64_t)count, one, many);
        *before = ", ";
    }
}

static size_t count_errors(const wh_record_t *record) {
    size_t errors = 0;
    for (size_t i = 0; i < record->command_count; ++i) {
        errors += record->commands[i].error != WH_OK ? 1 : 0;
    }
    return errors;
}

/* Errors that the script caught are none. Complaints are, whatever was expected. */
static void put_reasons(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const size_t unmet = count_unmet(record);
    const size_t expected = record->expectation_count;
    size_t complaints = 0;
    for (size_t i = 0; i < record->event_count; ++i) {
        complaints += wh_record_is_complaint(record->events[i].event.kind) ? 1 : 0;
    }
    const char *before = ": ";
    put_reason(printer->out, &before, unmet, "expectation not met", "expectations not met");
    put_reason(printer->out, &before, record->failure ? count_errors(record) : 0, "command with an error",
               "commands with errors");
    put_reason(printer->out, &before, complaints, "complaint", "complaints");
    if (before[0] == ',' && unmet == 0 && expected > 0) {
        fprintf(printer->out, ", though %s met",
                expected == 1 ? "the expectation is" : "all expectations are");
    }
}

static void print_summary(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    print_times(printer);
    wh_style_print(printer->style, printer->out, record->ok ? WH_INK_GOOD : WH_INK_BAD, "%s",
                   record->ok ? "ok" : "failed");
    if (!record->ok) {
        put_reasons(printer);
    }
    fputc('\n', printer->out);
    if (record->failure) {
        wh_print_put(printer, record->failure);
        fputc('\n', printer->out);
    }
}

/* ---------------------------------------------------------------------------------------------------- all */

int wh_record_print_table(const wh_record_t *record, FILE *out, const wh_style_t *style, unsigned sections) {
    const wh_printer_t printer = {record, style, out};
    print_heading(&printer);
    wh_print_commands(&printer);
    wh_print_errors(&printer);
    wh_print_handovers(&printer);
    wh_print_complaints(&printer);
    wh_print_clearances(&printer);
    wh_print_curves(&printer);
    wh_print_wafers(&printer);
    if (sections & WH_TABLE_GANTT) {
        wh_print_gantt(&printer);
        wh_print_times(&printer);
    }
    if (sections & WH_TABLE_MARGINS) {
        wh_print_margins(&printer);
    }
    print_expectations(&printer);
    print_summary(&printer);
    return fflush(out) != 0 || ferror(out) ? -1 : 0;
}
