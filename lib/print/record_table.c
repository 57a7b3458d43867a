#include "record_table.h"

#include "print_internal.h"

/* "tolerance paper: |dr_proj_z| < 0.5 mm, ...; sampled every 1 ms" */
static void print_tolerance(const wh_printer_t *report) {
    const wh_layout_t *layout = report->record->layout;
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    char projz[WH_REPORT_NUMBER_SIZE];
    char projxy[WH_REPORT_NUMBER_SIZE];
    char planar[WH_REPORT_NUMBER_SIZE];
    wh_print_limit(projz, (double)limits->projz);
    wh_print_limit(projxy, (double)limits->projxy);
    wh_print_limit(planar, (double)limits->planar);
    fprintf(report->out,
            "tolerance %s: |dr_proj_z| < %s mm, |dr_proj_xy| < %s mm, n1_proj_n2 > %s (%.2f%s)\n",
            layout->tolerance_name, projz, projxy, planar, wh_print_tilt_deg((double)limits->planar),
            wh_style_degree(report->style));
    fprintf(report->out, "checked %s %g ms; wafers %s\n",
            layout->grasp.check == WH_CHECK_SWEPT ? "along the whole of each slice of"
                                                  : "once a slice, every",
            (double)layout->slice_us / 1e3,
            layout->grasp.seat ? "are drawn flat onto the pads" : "stay as they were taken");
}

static int print_heading(const wh_printer_t *report) {
    const wh_record_t *record = report->record;
    int status = wh_print_put(report, record->script ? record->script : "(no script)");
    fputs(" on ", report->out);
    status |= wh_print_put(report, record->layout ? record->layout->path : "no layout");
    fputc('\n', report->out);
    if (record->layout) {
        print_tolerance(report);
    }
    return status;
}

int wh_record_print_table(const wh_record_t *record, FILE *out, const wh_style_t *style) {
    return wh_record_print_table_with(record, out, style, 0);
}

int wh_record_print_table_with(const wh_record_t *record, FILE *out, const wh_style_t *style,
                               unsigned sections) {
    const wh_printer_t report = {record, style, out};
    int status = print_heading(&report);
    status |= wh_print_commands(&report);
    status |= wh_print_errors(&report);
    status |= wh_print_handovers(&report);
    status |= wh_print_complaints(&report);
    status |= wh_print_clearances(&report);
    status |= wh_print_curves(&report);
    status |= wh_print_wafers(&report);
    status |= sections & WH_TABLE_GANTT ? wh_print_gantt(&report) | wh_print_times(&report) : 0;
    status |= sections & WH_TABLE_MARGINS ? wh_print_margins(&report) : 0;
    status |= wh_print_expectations(&report);
    status |= wh_print_summary(&report);
    return status != 0 || fflush(out) != 0 || ferror(out) ? -1 : 0;
}
