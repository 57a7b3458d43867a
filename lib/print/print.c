/* What the report's parts share: names, numbers and the columns of measured values. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "print_internal.h"

void wh_print_title(const wh_printer_t *report, const char *title) {
    fputc('\n', report->out);
    wh_style_print(report->style, report->out, WH_INK_BOLD, "%s", title);
    fputc('\n', report->out);
}

/* The first `length` bytes of a text. */
static int put_printable(const wh_printer_t *report, const char *text, size_t length) {
    char *part = strndup(text, length);
    char *printable = part ? wh_style_printable(part) : NULL;
    if (printable) {
        fputs(printable, report->out);
    }
    const int status = printable ? 0 : -1;
    free(part);
    free(printable);
    return status;
}

int wh_print_put(const wh_printer_t *report, const char *text) {
    int status = 0;
    const char *rest = text ? text : "";
    while (*rest != '\0') {
        const size_t length = strcspn(rest, "\n\t");
        status |= put_printable(report, rest, length);
        rest += length;
        if (*rest != '\0') {
            fputs(*rest == '\n' ? "\n  " : "  ", report->out);
            ++rest;
        }
    }
    return status;
}

const char *wh_print_wafer(const wh_printer_t *report, int32_t wafer) {
    const char *name = wh_record_wafer_name(report->record, wafer);
    return name ? name : "-";
}

const char *wh_print_gripper(const wh_printer_t *report, int32_t gripper) {
    const char *name = wh_record_gripper_name(report->record, gripper);
    return name ? name : "-";
}

wh_grid_digits_t wh_print_seconds(void) {
    const wh_grid_digits_t digits = {3, 6, false, 0};
    return digits;
}

wh_grid_digits_t wh_print_millimetres(void) {
    const wh_grid_digits_t digits = {4, 9, false, 0};
    return digits;
}

void wh_print_limit(char text[WH_REPORT_NUMBER_SIZE], double limit) {
    snprintf(text, WH_REPORT_NUMBER_SIZE, "%.10g", limit);
}

void wh_print_count(char text[WH_REPORT_NUMBER_SIZE], int64_t count) {
    char digits[WH_REPORT_NUMBER_SIZE / 2 + 2];
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

double wh_print_tilt_deg(double n1_proj_n2) {
    const wh_real_t cosine = (wh_real_t)n1_proj_n2;
    const wh_real_t square = (1 - cosine) * (1 + cosine);
    return (double)wh_deg_from_rad(wh_atan2(wh_real_sqrt(square > 0 ? square : 0), cosine));
}

/* The gripper's normal in base: the end-effector is level, and a chuck turns about its station's z. */
static wh_vec3_t gripper_normal(const wh_layout_t *layout, int32_t gripper) {
    const int32_t station = layout->grippers[gripper].station;
    return station == WH_NONE ? wh_vec3(0, 0, 1)
                              : wh_mat3_column(&layout->places[station].base_from_station.R, 2);
}

double wh_print_rim_gap(const wh_printer_t *report, const wh_event_t *event) {
    const wh_layout_t *layout = report->record->layout;
    const wh_vec3_t n2 = gripper_normal(layout, event->gripper);
    const double cosine = (double)event->measured.n1_proj_n2;
    const double square = (1 - cosine) * (1 + cosine);
    const double sine = (double)wh_real_sqrt((wh_real_t)(square > 0 ? square : 0));
    const double centre = (double)wh_real_abs(wh_vec3_dot(&event->measured.dr, &n2));
    return centre + layout->wafer_diameter / 2 * sine;
}

static void limited_column(const wh_printer_t *report, wh_grid_t *grid, const char *value,
                           const char *relation, double limit, int decimals) {
    char heading[64 + WH_REPORT_NUMBER_SIZE];
    char number[WH_REPORT_NUMBER_SIZE];
    const wh_grid_digits_t digits = {decimals, decimals, report->record->layout != NULL, limit};
    wh_print_limit(number, limit);
    snprintf(heading, sizeof heading, "%s %s %s", value, relation, number);
    wh_grid_number_column(grid, report->record->layout ? heading : value, digits);
}

void wh_print_measured_columns(const wh_printer_t *report, wh_grid_t *grid) {
    static const wh_tolerance_t unknown = {0, 0, 0};
    const wh_layout_t *layout = report->record->layout;
    const wh_tolerance_t *limits = layout ? &layout->grasp.tolerance : &unknown;
    const wh_grid_digits_t rim = {4, 4, false, 0};
    limited_column(report, grid, "|dr_proj_z|", "<", (double)limits->projz, 4);
    wh_grid_number_column(grid, "rim gap", rim);
    wh_grid_glue(grid);
    limited_column(report, grid, "|dr_proj_xy|", "<", (double)limits->projxy, 4);
    wh_grid_glue(grid);
    limited_column(report, grid, "n1_proj_n2", ">", (double)limits->planar, 6);
    wh_grid_glue(grid);
}

void wh_print_measured(const wh_printer_t *report, wh_grid_t *grid, size_t first, const wh_event_t *event) {
    const wh_proximity_t *p = &event->measured;
    const wh_ink_t projz = p->failed & WH_FAILED_PROJZ ? WH_INK_BAD : WH_INK_PLAIN;
    const wh_ink_t projxy = p->failed & WH_FAILED_PROJXY ? WH_INK_BAD : WH_INK_PLAIN;
    const wh_ink_t planar = p->failed & WH_FAILED_PLANAR ? WH_INK_BAD : WH_INK_PLAIN;
    wh_grid_number(grid, first, projz, (double)wh_real_abs(p->dr_proj_z));
    if (wh_record_gripper_name(report->record, event->gripper)) {
        wh_grid_number(grid, first + 1, WH_INK_DIM, wh_print_rim_gap(report, event));
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
