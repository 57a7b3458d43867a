/* Where the wafers are at the end, and which of them a gripper carries tilted. */
#include <stdlib.h>

#include "../math/trig.h"
#include "../text/array.h"
#include "print_internal.h"

enum { NAME, HELD_BY, LIES_IN, DX };

/* Above this many wafers only those are listed that something happened to. */
#define LISTED_ALL 30

/* A tilt that is worth a sentence, degrees: what the table shows as more than 0.000. */
#define TILT_SHOWN_DEG 0.0005

/* By wafer: 1 + index of the last event that names it, and of the last pick by an end-effector; 0: none. */
typedef struct {
    size_t *named, *picked;
} history_t;

static void read_history(const wh_record_t *record, const history_t *history) {
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (event->wafer < 0 || (size_t)event->wafer >= record->layout->wafer_count) {
            continue;
        }
        const bool taken = event->kind == WH_EVENT_PICKED || event->kind == WH_EVENT_HANDED_OVER;
        history->named[event->wafer] = i + 1;
        if (taken && wh_is_index(event->gripper, record->layout->machine.gripper_count) &&
            record->layout->grippers[event->gripper].station == WH_NONE) {
            history->picked[event->wafer] = i + 1;
        }
    }
}

static void fill_place(const wh_printer_t *printer, wh_grid_t *grid, const wh_wafer_record_t *wafer) {
    const wh_place_t *place = &wafer->place;
    const char *station = wh_record_station_name(printer->record, place->station);
    if (!station) {
        wh_grid_text(grid, LIES_IN, wafer->holder == WH_NONE ? WH_INK_BAD : WH_INK_PLAIN, "no slot");
        return;
    }
    wh_grid_text(grid, LIES_IN, WH_INK_PLAIN, "%s %d", station, (int)place->slot);
    const double values[] = {place->dx, place->dy, place->dz, wh_deg_from_rad(place->tilt)};
    wh_grid_numbers(grid, DX, values, 4);
}

static void add_wafer(const wh_printer_t *printer, wh_grid_t *grid, size_t i) {
    const wh_wafer_record_t *wafer = &printer->record->wafers[i];
    wh_grid_named_row(grid, wh_print_wafer(printer, (int32_t)i));
    if (wafer->holder != WH_NONE) {
        wh_grid_text(grid, HELD_BY, WH_INK_PLAIN, "%s", wh_print_gripper(printer, wafer->holder));
    }
    fill_place(printer, grid, wafer);
}

/* Returns how many wafers were left out. */
static size_t add_wafers(const wh_printer_t *printer, wh_grid_t *grid, const history_t *history) {
    const wh_record_t *record = printer->record;
    const size_t count = record->layout->wafer_count;
    size_t left_out = 0;
    for (size_t i = 0; i < count; ++i) {
        if (count <= LISTED_ALL || history->named[i] != 0 || record->wafers[i].holder != WH_NONE) {
            add_wafer(printer, grid, i);
        } else {
            ++left_out;
        }
    }
    return left_out;
}

static void say_tilt(const wh_printer_t *printer, size_t wafer, const wh_event_t *pick, double tilt_deg) {
    const bool seated = printer->record->layout->grasp.seat;
    const char *degree = wh_style_glyph(printer->style, WH_GLYPH_DEGREE);
    wh_print_put(printer, wh_print_wafer(printer, (int32_t)wafer));
    fprintf(printer->out, seated ? " was at %.3f%s to " : " keeps %.3f%s against ", tilt_deg, degree);
    wh_print_put(printer, wh_print_gripper(printer, pick->gripper));
    if (seated) {
        fputs(" when it was taken, and was drawn flat onto the pads.\n", printer->out);
    } else {
        fprintf(printer->out, ", its rim %.2f mm from the pads' plane: the robot cannot tilt.\n",
                wh_print_rim_gap(printer, pick));
    }
}

static void say_tilts(const wh_printer_t *printer, const history_t *history) {
    for (size_t i = 0; i < printer->record->layout->wafer_count; ++i) {
        if (history->picked[i] == 0) {
            continue;
        }
        const wh_event_t *pick = &printer->record->events[history->picked[i] - 1].event;
        const double tilt_deg = wh_print_tilt_deg((double)pick->measured.n1_proj_n2);
        if (tilt_deg >= TILT_SHOWN_DEG) {
            say_tilt(printer, i, pick, tilt_deg);
        }
    }
}

static void print_wafers(const wh_printer_t *printer, const history_t *history) {
    const wh_grid_digits_t tilt = {3, 6, false, 0};
    wh_grid_t *grid = wh_grid_new(printer->style, 1);
    wh_grid_text_columns(grid, "wafer", "held by", "lies in", NULL);
    wh_grid_number_columns(grid, wh_print_millimetres, "dX mm", "dY mm", "dz mm", NULL);
    wh_grid_number_columns(grid, tilt, "tilt deg", NULL);
    const size_t left_out = add_wafers(printer, grid, history);
    wh_print_title(printer, "Wafers");
    if (left_out < printer->record->layout->wafer_count) {
        wh_grid_print(grid, printer->out);
    } else {
        wh_grid_free(grid);
    }
    if (left_out > 0) {
        wh_print_counted(printer->out, (int64_t)left_out, "wafer lies", "wafers lie");
        fputs(" where nothing happened to them\n", printer->out);
    }
    say_tilts(printer, history);
}

void wh_print_wafers(const wh_printer_t *printer) {
    const wh_layout_t *layout = printer->record->layout;
    if (!layout || layout->wafer_count == 0) {
        return;
    }
    const history_t history = {wh_array_new(layout->wafer_count, sizeof(size_t)),
                               wh_array_new(layout->wafer_count, sizeof(size_t))};
    read_history(printer->record, &history);
    print_wafers(printer, &history);
    free(history.named);
    free(history.picked);
}
