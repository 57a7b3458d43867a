/* Misses and complaints: what almost happened or should not have, and which condition failed by how much. */
#include "../sim/event_text.h"
#include "print_internal.h"

enum { AT, WHAT, WAFER, GRIPPER, MEASURED, WHY = MEASURED + WH_PRINT_MEASURED_COLUMNS };

static const char *part_name(const wh_layout_t *layout, int32_t part) {
    const char *name = layout ? wh_layout_part_name(layout, part) : NULL;
    return name ? name : "more than can be looked at";
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

/* The event's name with spaces. */
static void say_what(wh_grid_t *grid, wh_event_kind_t kind) {
    char what[32];
    snprintf(what, sizeof what, "%s", wh_event_name(kind));
    for (char *c = what; *c != '\0'; ++c) {
        *c = *c == '_' ? ' ' : *c;
    }
    wh_grid_text(grid, WHAT, wh_print_is_complaint(kind) ? WH_INK_BAD : WH_INK_WARN, "%s", what);
}

static void add_event(const wh_printer_t *printer, wh_grid_t *grid, const wh_event_record_t *record) {
    const wh_event_t *event = &record->event;
    const double at = (double)record->utime / 1e6;
    wh_grid_row(grid);
    wh_grid_number(grid, AT, WH_INK_PLAIN, at);
    say_what(grid, event->kind);
    wh_grid_text(grid, WAFER, WH_INK_PLAIN, "%s", wh_print_wafer(printer, event->wafer));
    wh_grid_text(grid, GRIPPER, WH_INK_PLAIN, "%s", wh_print_gripper(printer, event->gripper));
    if (event->kind == WH_EVENT_NEAR_MISS || event->kind == WH_EVENT_CONTESTED) {
        wh_print_measured(printer, grid, MEASURED, event);
    }
    say_why(printer, grid, at, event);
}

void wh_print_complaints(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    size_t first = 0;
    while (first < record->event_count && !wh_print_is_miss(record->events[first].event.kind)) {
        ++first;
    }
    if (first == record->event_count) {
        return;
    }
    wh_grid_t *grid = wh_grid_new(printer->style, 1);
    wh_grid_number_columns(grid, wh_print_seconds, "at s", NULL);
    wh_grid_text_columns(grid, "what", "wafer", "gripper", NULL);
    wh_print_measured_columns(printer, grid);
    wh_grid_text_columns(grid, "why", NULL);
    for (size_t i = first; i < record->event_count; ++i) {
        if (wh_print_is_miss(record->events[i].event.kind)) {
            add_event(printer, grid, &record->events[i]);
        }
    }
    wh_print_titled(printer, "Misses and complaints", grid);
}
