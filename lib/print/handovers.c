/* The hand-overs: what the chuck measured when it took the wafer, in the paper's words. */
#include "print_internal.h"

/* As many are shown in full. */
#define SHOWN 8

enum { VALUE, MEASURED, LIMIT, MARGIN };

static void add_value(wh_grid_t *grid, const char *name, double value) {
    wh_grid_named_row(grid, name);
    wh_grid_number(grid, MEASURED, WH_INK_PLAIN, value);
}

static void add_limit(wh_grid_t *grid, const char *relation, double limit, double margin) {
    wh_grid_text(grid, LIMIT, WH_INK_PLAIN, "%s %.10g", relation, limit);
    wh_grid_number(grid, MARGIN, margin > 0 ? WH_INK_GOOD : WH_INK_BAD, margin);
}

static wh_grid_t *new_grid(const wh_printer_t *printer) {
    const wh_grid_digits_t digits = {6, 6, false, 0};
    const wh_grid_digits_t margin = {6, 6, true, 0};
    wh_grid_t *grid = wh_grid_new(printer->style, 1);
    wh_grid_text_columns(grid, "", NULL);
    wh_grid_number_columns(grid, digits, "measured", NULL);
    wh_grid_text_columns(grid, "limit", NULL);
    wh_grid_number_columns(grid, margin, "margin", NULL);
    return grid;
}

static void print_values(const wh_printer_t *printer, const wh_proximity_t *p) {
    const wh_tolerance_t *limits = &printer->record->layout->grasp.tolerance;
    wh_grid_t *grid = new_grid(printer);
    add_value(grid, "  |dr_proj_z|", (double)wh_real_abs(p->dr_proj_z));
    add_limit(grid, "<", (double)limits->projz, (double)p->margin_projz);
    add_value(grid, "  |dr_proj_xy|", (double)p->dr_proj_xy_norm);
    add_limit(grid, "<", (double)limits->projxy, (double)p->margin_projxy);
    add_value(grid, "  n1_proj_n2", (double)p->n1_proj_n2);
    add_limit(grid, ">", (double)limits->planar, (double)p->margin_planar);
    add_value(grid, "  dr_proj_xy  x", (double)p->dr_proj_xy.x);
    add_value(grid, "              y", (double)p->dr_proj_xy.y);
    add_value(grid, "              z", (double)p->dr_proj_xy.z);
    wh_grid_print(grid, printer->out);
}

static void print_handover(const wh_printer_t *printer, const wh_event_record_t *record) {
    const wh_event_t *event = &record->event;
    const bool ready = event->measured.ready;
    const double at = (double)record->utime / 1e6;
    wh_print_put(printer, wh_print_wafer(printer, event->wafer));
    fputs(", ", printer->out);
    wh_print_put(printer, wh_print_gripper(printer, event->other));
    fprintf(printer->out, " %s ", wh_style_glyph(printer->style, WH_GLYPH_ARROW));
    wh_print_put(printer, wh_print_gripper(printer, event->gripper));
    fprintf(printer->out, ", at %.*f s: isReadyToPick", wh_grid_decimals(&wh_print_seconds, at), at);
    wh_print_put(printer, wh_print_gripper(printer, event->gripper));
    fputs(": ", printer->out);
    wh_style_print(printer->style, printer->out, ready ? WH_INK_GOOD : WH_INK_BAD, "%s",
                   ready ? "true" : "false");
    fputc('\n', printer->out);
    print_values(printer, &event->measured);
}

void wh_print_handovers(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    size_t count = 0;
    for (size_t i = 0; i < record->event_count && record->layout; ++i) {
        if (record->events[i].event.kind != WH_EVENT_HANDED_OVER) {
            continue;
        }
        if (++count <= SHOWN) {
            wh_print_title(printer, "Hand-over");
            print_handover(printer, &record->events[i]);
        }
    }
    if (count > SHOWN) {
        fprintf(printer->out, "\n%zu more hand-overs; their values stand in the table above.\n",
                count - SHOWN);
    }
}
