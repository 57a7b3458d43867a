/* Misses and complaints: what almost happened or should not have, and which condition failed by how much. */
#include <string.h>

#include "../math/trig.h"
#include "../sim/faults.h"
#include "print_internal.h"

enum { AT, WHAT, WAFER, GRIPPER, MEASURED, WHY = MEASURED + WH_PRINT_MEASURED_COLUMNS };

static wh_grid_t *new_grid(const wh_printer_t *printer) {
    wh_grid_t *grid = wh_grid_new(printer->style, 1);
    wh_grid_number_column(grid, "at s", wh_print_seconds);
    wh_grid_text_column(grid, "what");
    wh_grid_text_column(grid, "wafer");
    wh_grid_text_column(grid, "gripper");
    wh_print_measured_columns(printer, grid);
    wh_grid_text_column(grid, "why");
    return grid;
}

/* The fewest decimals, at least `least`, with which the difference is not zero. */
static int decimals_for(double difference, int least) {
    int decimals = least;
    double unit = 1;
    for (int i = 0; i < least; ++i) {
        unit /= 10;
    }
    while (difference > 0 && difference < unit && decimals < 15) {
        unit /= 10;
        ++decimals;
    }
    return decimals;
}

/* A condition of a proximity check, and how it reads. */
typedef struct {
    unsigned bit;
    const char *name, *relation, *unit;
    int decimals;
    double value, limit, margin;
} condition_t;

static void list_conditions(const wh_proximity_t *p, const wh_tolerance_t *limits,
                            condition_t conditions[3]) {
    const condition_t list[3] = {
        {WH_FAILED_PROJZ, "|dr_proj_z|", "below", " mm", 3, (double)wh_real_abs(p->dr_proj_z),
         (double)limits->projz, (double)p->margin_projz},
        {WH_FAILED_PROJXY, "|dr_proj_xy|", "below", " mm", 3, (double)p->dr_proj_xy_norm,
         (double)limits->projxy, (double)p->margin_projxy},
        {WH_FAILED_PLANAR, "n1_proj_n2", "above", "", 6, (double)p->n1_proj_n2, (double)limits->planar,
         (double)p->margin_planar},
    };
    memcpy(conditions, list, sizeof list);
}

/* "by 5.000 mm": how far a value is beyond its limit. */
static void describe_excess(char *text, size_t size, const condition_t *condition, int decimals) {
    if (condition->margin < 0) {
        snprintf(text, size, "by %.*f%s", decimals, -condition->margin, condition->unit);
    } else {
        snprintf(text, size, "it is equal");
    }
}

static void say_condition(const wh_printer_t *printer, wh_grid_t *grid, const condition_t *condition) {
    char limit[WH_PRINT_NUMBER_SIZE];
    char excess[WH_GRID_NUMBER_SIZE];
    char tilt[64] = "";
    const int decimals = decimals_for(-condition->margin, condition->decimals);
    wh_print_limit(limit, condition->limit);
    describe_excess(excess, sizeof excess, condition, decimals);
    if (condition->bit == WH_FAILED_PLANAR) {
        snprintf(tilt, sizeof tilt, ": tilted by %.3f%s", wh_print_tilt_deg(condition->value),
                 wh_style_degree(printer->style));
    }
    wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s %.*f is not %s %s (%s)%s", condition->name, decimals,
                 condition->value, condition->relation, limit, excess, tilt);
}

/* One row for each failed condition, the first of them the event's own. */
static void say_failed(const wh_printer_t *printer, wh_grid_t *grid, double at, const wh_proximity_t *p) {
    condition_t conditions[3];
    bool is_first = true;
    list_conditions(p, &printer->record->layout->grasp.tolerance, conditions);
    for (size_t i = 0; i < 3; ++i) {
        if (!(p->failed & conditions[i].bit)) {
            continue;
        }
        if (!is_first) {
            wh_grid_row(grid);
            wh_grid_number(grid, AT, WH_INK_DIM, at);
        }
        say_condition(printer, grid, &conditions[i]);
        is_first = false;
    }
    if (is_first) {
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "ready, but not taken");
    }
}

static const char *part_name(const wh_printer_t *printer, int32_t part) {
    const wh_layout_t *layout = printer->record->layout;
    const char *name = layout ? wh_layout_part_name(layout, part) : NULL;
    return name ? name : "more than can be looked at";
}

/* Vacuum, holding, faults on purpose. */
static void say_physics(wh_grid_t *grid, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_SLIPPED:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "the motion asks for %.0f mm/s^2, the pads carry %.0f",
                     (double)event->value, (double)event->limit);
        break;
    case WH_EVENT_VACUUM_LOST:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%.0f %% of the full vacuum, the sensor wants %.0f",
                     100 * (double)event->value, 100 * (double)event->limit);
        break;
    case WH_EVENT_FAULT_ARMED:
    case WH_EVENT_FAULT_CLEARED:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s, fault %d", wh_fault_name((wh_fault_kind_t)event->parts[1]),
                     (int)event->parts[0] + 1);
        break;
    default:
        break;
    }
}

/* Contact and clearances, how a wafer was set down. */
static void say_of_cell(const wh_printer_t *printer, wh_grid_t *grid, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_HIT:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s and %s touch at %.3f, %.3f, %.3f mm",
                     part_name(printer, event->parts[0]), part_name(printer, event->parts[1]),
                     (double)event->at.x, (double)event->at.y, (double)event->at.z);
        break;
    case WH_EVENT_UNDECIDED:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "whether %s and %s touch could not be decided",
                     part_name(printer, event->parts[0]), part_name(printer, event->parts[1]));
        break;
    case WH_EVENT_TOO_CLOSE:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s and %s: %.3f mm apart (limit %g mm)",
                     part_name(printer, event->parts[0]), part_name(printer, event->parts[1]),
                     (double)event->value, (double)event->limit);
        break;
    case WH_EVENT_PLACED_OFF_CENTRE:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%.3f mm beside the centre (limit %g mm)", (double)event->value,
                     (double)event->limit);
        break;
    case WH_EVENT_PLACED_ASKEW:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "tilted by %.3f%s (limit %g%s)", wh_deg_from_rad(event->value),
                     wh_style_degree(printer->style), wh_deg_from_rad(event->limit),
                     wh_style_degree(printer->style));
        break;
    default:
        say_physics(grid, event);
        break;
    }
}

static void say_why(const wh_printer_t *printer, wh_grid_t *grid, double at, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_CONTESTED:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "ready, but %s holds it",
                     wh_print_gripper(printer, event->other));
        break;
    case WH_EVENT_BAD_INPUT:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s", wh_record_error_text(event->status));
        break;
    case WH_EVENT_RELEASED_UNSUPPORTED:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "in no slot, %.3f mm above what is below",
                     (double)event->height);
        break;
    case WH_EVENT_SLOT_OCCUPIED:
        wh_grid_text(grid, WHY, WH_INK_PLAIN, "%s lies in that slot", wh_print_wafer(printer, event->other));
        break;
    case WH_EVENT_NEAR_MISS:
        if (printer->record->layout) {
            say_failed(printer, grid, at, &event->measured);
        }
        break;
    default:
        say_of_cell(printer, grid, event);
        break;
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
    wh_grid_t *grid = new_grid(printer);
    for (size_t i = first; i < record->event_count; ++i) {
        if (wh_print_is_miss(record->events[i].event.kind)) {
            add_event(printer, grid, &record->events[i]);
        }
    }
    wh_print_titled(printer, "Misses and complaints", grid);
}
