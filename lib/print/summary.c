/* The report's end: what was expected, how long it took, and the verdict. */
#include <inttypes.h>

#include "../record/record.h"
#include "print_internal.h"

enum { MARK, LINE, TEXT };

static size_t count_unmet(const wh_record_t *record) {
    size_t unmet = 0;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        unmet += record->expectations[i].ok ? 0 : 1;
    }
    return unmet;
}

static void add_unmet(const wh_printer_t *report, wh_grid_t *grid,
                      const wh_expectation_record_t *expectation) {
    wh_grid_row(grid);
    wh_grid_text(grid, MARK, WH_INK_BAD, "%s", wh_style_cross(report->style));
    if (expectation->line > 0) {
        wh_grid_number(grid, LINE, WH_INK_DIM, expectation->line);
    }
    wh_grid_text(grid, TEXT, WH_INK_PLAIN, "%s", expectation->text ? expectation->text : "");
}

static int print_unmet(const wh_printer_t *report) {
    const wh_grid_digits_t whole = {0, 0, false, 0};
    wh_grid_t *grid = wh_grid_new(report->style, 0);
    wh_grid_text_column(grid, "");
    wh_grid_number_column(grid, "line", whole);
    wh_grid_text_column(grid, "expected");
    for (size_t i = 0; i < report->record->expectation_count; ++i) {
        if (!report->record->expectations[i].ok) {
            add_unmet(report, grid, &report->record->expectations[i]);
        }
    }
    return wh_grid_print(grid, report->out);
}

int wh_print_expectations(const wh_printer_t *report) {
    const size_t count = report->record->expectation_count;
    const size_t unmet = count_unmet(report->record);
    int status = 0;
    if (count == 0) {
        return 0;
    }
    wh_print_title(report, "Expectations");
    if (unmet > 0) {
        status = print_unmet(report);
    }
    if (unmet < count) {
        wh_style_print(report->style, report->out, WH_INK_GOOD, "%s", wh_style_tick(report->style));
        fprintf(report->out, " %s%zu met\n", unmet == 0 && count > 1 ? "all " : "", count - unmet);
    }
    return status;
}

static void put_counted(FILE *out, int64_t count, const char *one, const char *many) {
    char text[WH_REPORT_NUMBER_SIZE];
    wh_print_count(text, count);
    fprintf(out, "%s %s", text, count == 1 ? one : many);
}

static void print_times(const wh_printer_t *report) {
    const wh_record_t *record = report->record;
    fputc('\n', report->out);
    put_counted(report->out, (int64_t)record->command_count, "command", "commands");
    fprintf(report->out, ", %.3f s simulated in ", record->simulated_s);
    put_counted(report->out, record->slices, "slice", "slices");
    if (record->missed > 0) {
        fprintf(report->out, ", of which the simulator missed %lld", (long long)record->missed);
    }
    fprintf(report->out, "; %.3f s of wall time", record->wall_s);
    if (record->wall_s > 0 && record->simulated_s > record->wall_s) {
        const double times = record->simulated_s / record->wall_s;
        if (times < 10) {
            fprintf(report->out, ", %.1f", times);
        } else {
            char text[WH_REPORT_NUMBER_SIZE];
            wh_print_count(text, times < 9e15 ? (int64_t)times : INT64_C(9000000000000000));
            fprintf(report->out, ", %s", text);
        }
        fputs(" times faster than real time", report->out);
    }
    fputc('\n', report->out);
    wh_print_throughput(report);
    fprintf(report->out, "hash %016" PRIx64 "\n", record->hash);
}

/* A reason for the verdict; true when there is one. */
static bool put_reason(FILE *out, bool is_first, size_t count, const char *one, const char *many) {
    if (count == 0) {
        return false;
    }
    fputs(is_first ? ": " : ", ", out);
    put_counted(out, (int64_t)count, one, many);
    return true;
}

static size_t count_errors(const wh_record_t *record) {
    size_t errors = 0;
    for (size_t i = 0; i < record->command_count; ++i) {
        errors += record->commands[i].error != WH_OK ? 1 : 0;
    }
    return errors;
}

/* Errors that the script caught are none. Complaints are, whatever was expected. */
static void put_reasons(const wh_printer_t *report) {
    const wh_record_t *record = report->record;
    const size_t unmet = count_unmet(record);
    const size_t expected = record->expectation_count;
    size_t complaints = 0;
    for (size_t i = 0; i < record->event_count; ++i) {
        complaints += wh_record_is_complaint(record->events[i].event.kind) ? 1 : 0;
    }
    bool more = put_reason(report->out, true, unmet, "expectation not met", "expectations not met");
    more |= put_reason(report->out, !more, record->failure ? count_errors(record) : 0,
                       "command with an error", "commands with errors");
    more |= put_reason(report->out, !more, complaints, "complaint", "complaints");
    if (more && unmet == 0 && expected > 0) {
        fprintf(report->out, ", though %s met",
                expected == 1 ? "the expectation is" : "all expectations are");
    }
}

int wh_print_summary(const wh_printer_t *report) {
    const wh_record_t *record = report->record;
    int status = 0;
    print_times(report);
    wh_style_print(report->style, report->out, record->ok ? WH_INK_GOOD : WH_INK_BAD, "%s",
                   record->ok ? "ok" : "failed");
    if (!record->ok) {
        put_reasons(report);
    }
    fputc('\n', report->out);
    if (record->failure) {
        status = wh_print_put(report, record->failure);
        fputc('\n', report->out);
    }
    return status;
}
