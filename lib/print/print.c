/* What the tables' parts share: names, numbers and the columns of measured values. */
#include <inttypes.h>
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

void wh_print_put(const wh_printer_t *printer, const char *text) {
    char *copy = wh_text_copy(text ? text : "");
    char *rest = copy;
    for (char *end = strpbrk(rest, "\n\t"); end; end = strpbrk(rest, "\n\t")) {
        const char *between = *end == '\n' ? "\n  " : "  ";
        *end = '\0';
        wh_style_put(printer->out, rest);
        fputs(between, printer->out);
        rest = end + 1;
    }
    wh_style_put(printer->out, rest);
    free(copy);
}

void wh_print_titled(const wh_printer_t *printer, const char *title, wh_grid_t *grid) {
    if (wh_grid_rows(grid) > 0) {
        wh_print_title(printer, title);
        wh_grid_print(grid, printer->out);
    } else {
        wh_grid_free(grid);
    }
}

const char *wh_print_wafer(const wh_printer_t *printer, int32_t wafer) {
    const char *name = wh_record_wafer_name(printer->record, wafer);
    return name ? name : "-";
}

const char *wh_print_gripper(const wh_printer_t *printer, int32_t gripper) {
    const char *name = wh_record_gripper_name(printer->record, gripper);
    return name ? name : "-";
}

void wh_print_count(char text[WH_PRINT_NUMBER_SIZE], int64_t count) {
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
}

void wh_print_counted(FILE *out, int64_t count, const char *one, const char *many) {
    char text[WH_PRINT_NUMBER_SIZE];
    wh_print_count(text, count);
    fprintf(out, "%s %s", text, count == 1 ? one : many);
}

double wh_print_tilt_deg(double n1_proj_n2) {
    return (double)wh_deg_from_rad(wh_acos((wh_real_t)n1_proj_n2));
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
    const double cosine = (double)event->measured.n1_proj_n2;
    const double square = (1 - cosine) * (1 + cosine);
    const double sine = (double)wh_real_sqrt((wh_real_t)(square > 0 ? square : 0));
    const double centre = (double)wh_real_abs(wh_vec3_dot(&event->measured.dr, &n2));
    return centre + layout->wafer_diameter / 2 * sine;
}

static void limited_column(const wh_printer_t *printer, wh_grid_t *grid, const char *value,
                           const char *relation, double limit, int decimals) {
    char heading[64 + WH_PRINT_NUMBER_SIZE];
    const wh_grid_digits_t digits = {decimals, decimals, printer->record->layout != NULL, limit};
    snprintf(heading, sizeof heading, "%s %s %.10g", value, relation, limit);
    wh_grid_number_columns(grid, digits, printer->record->layout ? heading : value, NULL);
}

void wh_print_measured_columns(const wh_printer_t *printer, wh_grid_t *grid) {
    static const wh_tolerance_t unknown = {0, 0, 0};
    const wh_layout_t *layout = printer->record->layout;
    const wh_tolerance_t *limits = layout ? &layout->grasp.tolerance : &unknown;
    const wh_grid_digits_t rim = {4, 4, false, 0};
    limited_column(printer, grid, "|dr_proj_z|", "<", (double)limits->projz, 4);
    wh_grid_number_columns(grid, rim, "rim gap", NULL);
    wh_grid_glue(grid);
    limited_column(printer, grid, "|dr_proj_xy|", "<", (double)limits->projxy, 4);
    wh_grid_glue(grid);
    limited_column(printer, grid, "n1_proj_n2", ">", (double)limits->planar, 6);
    wh_grid_glue(grid);
}

void wh_print_measured(const wh_printer_t *printer, wh_grid_t *grid, size_t first, const wh_event_t *event) {
    const wh_proximity_t *p = &event->measured;
    const wh_ink_t projz = p->failed & WH_FAILED_PROJZ ? WH_INK_BAD : WH_INK_PLAIN;
    const wh_ink_t projxy = p->failed & WH_FAILED_PROJXY ? WH_INK_BAD : WH_INK_PLAIN;
    const wh_ink_t planar = p->failed & WH_FAILED_PLANAR ? WH_INK_BAD : WH_INK_PLAIN;
    wh_grid_number(grid, first, projz, (double)wh_real_abs(p->dr_proj_z));
    if (wh_record_gripper_name(printer->record, event->gripper)) {
        wh_grid_number(grid, first + 1, WH_INK_DIM, wh_print_rim_gap(printer, event));
    }
    wh_grid_number(grid, first + 2, projxy, (double)p->dr_proj_xy_norm);
    wh_grid_number(grid, first + 3, planar, (double)p->n1_proj_n2);
}

bool wh_print_is_miss(wh_event_kind_t kind) {
    static const uint32_t others = 1U << WH_EVENT_NEAR_MISS | 1U << WH_EVENT_PLACED_OFF_CENTRE |
                                   1U << WH_EVENT_PLACED_ASKEW | 1U << WH_EVENT_VACUUM_LOST |
                                   1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    return (others >> (unsigned)kind & 1U) != 0 || wh_print_is_complaint(kind);
}

bool wh_print_is_complaint(wh_event_kind_t kind) {
    return kind == WH_EVENT_CONTESTED || wh_record_is_complaint(kind);
}
