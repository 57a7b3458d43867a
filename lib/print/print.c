/* Shared by the tables' parts: names, numbers and the columns of measured values. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"
#include "print_internal.h"

void wh_print_title(const wh_printer_t *printer, const char *title) {
    fputc('\n', printer->out);
    wh_style_print(printer->style, printer->out, WH_INK_BOLD, "%s", title);
    fputc('\n', printer->out);
}

void wh_print_say(const wh_printer_t *printer, const char *format, ...) {
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&text, format, arguments) < 0) {
        wh_memory_out();
    }
    va_end(arguments);
    char *rest = text;
    for (char *end = strpbrk(rest, "\n\t"); end; end = strpbrk(rest, "\n\t")) {
        const char *between = *end == '\n' ? "\n  " : "  ";
        *end = '\0';
        wh_style_put(printer->out, rest);
        fputs(between, printer->out);
        rest = end + 1;
    }
    wh_style_put(printer->out, rest);
    free(text);
}

void wh_print_titled(const wh_printer_t *printer, const char *title, wh_grid_t *grid) {
    if (wh_grid_rows(grid) > 0) {
        wh_print_title(printer, title);
    }
    wh_grid_print(grid, printer->out);
}

const char *wh_print_wafer(const wh_printer_t *printer, int32_t wafer) {
    const char *name = wh_record_wafer_name(printer->record, wafer);
    return name ? name : "-";
}

const char *wh_print_gripper(const wh_printer_t *printer, int32_t gripper) {
    const char *name = wh_record_gripper_name(printer->record, gripper);
    return name ? name : "-";
}

const char *wh_print_count(char text[WH_PRINT_NUMBER_SIZE], int64_t count) {
    char digits[WH_PRINT_NUMBER_SIZE / 2 + 2];
    const int length = snprintf(digits, sizeof digits, "%" PRId64, count);
    size_t to = 0;
    for (int i = 0; i < length; ++i) {
        if (i > 0 && (length - i) % 3 == 0 && digits[i - 1] != '-') {
            text[to++] = ',';
        }
        text[to++] = digits[i];
    }
    text[to] = '\0';
    return text;
}

void wh_print_counted(FILE *out, int64_t count, const char *one, const char *many) {
    char text[WH_PRINT_NUMBER_SIZE];
    fprintf(out, "%s %s", wh_print_count(text, count), count == 1 ? one : many);
}

const char *wh_print_default(const wh_layout_t *layout, size_t limit) {
    return layout->tolerance_default[limit] ? " (default)" : "";
}

const char *wh_print_check(const wh_layout_t *layout) {
    return layout->grasp.check == WH_CHECK_SWEPT ? "along the whole of each slice of" : "once a slice, every";
}

/* The gripper's normal in base: the end-effector is level, and a chuck turns about its station's z. */
static wh_vec3_t gripper_normal(const wh_layout_t *layout, int32_t gripper) {
    const int32_t station = layout->grippers[gripper].station;
    return station == WH_NONE ? wh_vec3(0, 0, 1)
                              : wh_mat3_column(&layout->places[station].base_from_station.R, 2);
}

double wh_print_rim_gap(const wh_printer_t *printer, const wh_event_t *event) {
    const wh_layout_t *layout = printer->record->layout;
    const wh_vec3_t n2 = gripper_normal(layout, event->gripper);
    const double cosine = event->measured.n1_proj_n2;
    const double square = (1 - cosine) * (1 + cosine);
    const double sine = wh_real_sqrt((square > 0 ? square : 0));
    const double centre = wh_real_abs(wh_vec3_dot(&event->measured.dr, &n2));
    return centre + layout->wafer_diameter / 2 * sine;
}

static void limited_column(wh_grid_t *grid, const char *value, double limit, int decimals) {
    char column[64 + WH_PRINT_NUMBER_SIZE];
    snprintf(column, sizeof column, "%s %.10g{%d}", value, limit, decimals);
    wh_grid_columns(grid, column);
    wh_grid_limit(grid, limit);
}

void wh_print_measured_columns(const wh_printer_t *printer, wh_grid_t *grid) {
    if (!printer->record->layout) {
        wh_grid_columns(grid, "|dr_proj_z|{4};+rim gap{4};+|dr_proj_xy|{4};+n1_proj_n2{6}");
        return;
    }
    const wh_tolerance_t *limits = &printer->record->layout->grasp.tolerance;
    limited_column(grid, "|dr_proj_z| <", limits->projz, 4);
    wh_grid_columns(grid, "+rim gap{4}");
    limited_column(grid, "+|dr_proj_xy| <", limits->projxy, 4);
    limited_column(grid, "+n1_proj_n2 >", limits->planar, 6);
}

void wh_print_measured(const wh_printer_t *printer, wh_grid_t *grid, size_t first, const wh_event_t *event) {
    const wh_proximity_t *p = &event->measured;
    const wh_ink_t projz = p->failed & WH_FAILED_PROJZ ? WH_INK_BAD : WH_INK_PLAIN;
    const wh_ink_t projxy = p->failed & WH_FAILED_PROJXY ? WH_INK_BAD : WH_INK_PLAIN;
    const wh_ink_t planar = p->failed & WH_FAILED_PLANAR ? WH_INK_BAD : WH_INK_PLAIN;
    wh_grid_number(grid, first, projz, wh_real_abs(p->dr_proj_z));
    if (wh_record_gripper_name(printer->record, event->gripper)) {
        wh_grid_number(grid, first + 1, WH_INK_DIM, wh_print_rim_gap(printer, event));
    }
    wh_grid_number(grid, first + 2, projxy, p->dr_proj_xy_norm);
    wh_grid_number(grid, first + 3, planar, p->n1_proj_n2);
}

bool wh_print_is_complaint(wh_event_kind_t kind) {
    return kind == WH_EVENT_CONTESTED || wh_record_is_complaint(kind);
}
