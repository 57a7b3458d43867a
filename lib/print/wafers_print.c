#include <stdlib.h>

#include "../layout/grips.h"
#include "../layout/ports.h"
#include "../math/trig.h"
#include "../text/array.h"
#include "print_internal.h"

double wh_print_tilt_deg(double n1_proj_n2) {
    return wh_deg_from_rad(wh_acos(n1_proj_n2));
}

/* Where the wafers are at the end, and which of them a gripper carries tilted. */
enum { NAME, HELD_BY, LIES_IN, DX, FACE = DX + 4 };

/* Above this number of wafers, only those with an event are listed. */
#define LISTED_ALL 30

/* The least tilt that gets a sentence, degrees: the table shows it as more than 0.000. */
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
    if (!station && wh_layout_is_outside(&wafer->base_from_wafer)) {
        wh_grid_text(grid, LIES_IN, WH_INK_PLAIN, "not in the cell");
        return;
    }
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
    if (printer->record->layout->has_faces) {
        wh_grid_text(grid, FACE, WH_INK_PLAIN, "%s", wh_layout_face_of(&wafer->base_from_wafer));
    }
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

/* The robot of a gripper. */
static bool robot_tilts(const wh_layout_t *layout, int32_t gripper) {
    const size_t robot = layout->machine.mounts[gripper].robot;
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, NULL);
    return carrier && carrier->chain.has_tilt;
}

static void say_tilt(const wh_printer_t *printer, size_t wafer, const wh_event_t *pick, double tilt_deg) {
    const bool seated = printer->record->layout->grasp.seat;
    const char *degree = wh_style_glyph(printer->style, WH_GLYPH_DEGREE);
    wh_print_say(printer, seated ? "%s was at %.3f%s to %s" : "%s keeps %.3f%s against %s",
                 wh_print_wafer(printer, (int32_t)wafer), tilt_deg, degree,
                 wh_print_gripper(printer, pick->gripper));
    if (seated) {
        fputs(" when it was taken, and was drawn flat onto the pads.\n", printer->out);
    } else {
        fprintf(printer->out, ", its rim %.2f mm from the pads' plane%s.\n", wh_print_rim_gap(printer, pick),
                robot_tilts(printer->record->layout, pick->gripper) ? "" : ": the robot cannot tilt");
    }
}

/* Says that the robot took a wafer in the wafer's own plane, if the wafer began out of level. */
static void say_no_tilt(const wh_printer_t *printer, size_t wafer, const wh_event_t *pick, double tilt_deg) {
    const wh_layout_t *layout = printer->record->layout;
    const bool tilts = robot_tilts(layout, pick->gripper);
    const double began_deg =
        tilts ? wh_print_tilt_deg(wh_real_abs(layout->start[wafer].base_from_wafer.R.m[2][2])) : 0;
    if (tilts && began_deg >= TILT_SHOWN_DEG) {
        const char *degree = wh_style_glyph(printer->style, WH_GLYPH_DEGREE);
        wh_print_say(printer, "%s, tilted by %.3f%s when the run began, keeps %.3f%s against %s",
                     wh_print_wafer(printer, (int32_t)wafer), began_deg, degree, tilt_deg, degree,
                     wh_print_gripper(printer, pick->gripper));
        fputs(": the robot tilts.\n", printer->out);
    }
}

static void say_tilts(const wh_printer_t *printer, const history_t *history) {
    for (size_t i = 0; i < printer->record->layout->wafer_count; ++i) {
        if (history->picked[i] == 0) {
            continue;
        }
        const wh_event_t *pick = &printer->record->events[history->picked[i] - 1].event;
        const double tilt_deg = wh_print_tilt_deg(pick->measured.n1_proj_n2);
        if (tilt_deg >= TILT_SHOWN_DEG) {
            say_tilt(printer, i, pick, tilt_deg);
        } else {
            say_no_tilt(printer, i, pick, tilt_deg);
        }
    }
}

/* Says that a wafer which another one went through, as the lower one of a double does, is left in the air. */
static void say_hanging(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        const wh_wafer_record_t *left = &record->wafers[event->other == WH_NONE ? 0 : event->other];
        if (event->kind == WH_EVENT_PUSHED_THROUGH && event->other != WH_NONE && left->holder == WH_NONE &&
            left->place.station != WH_NONE && left->place.dz > record->layout->cell.drop) {
            wh_print_say(printer, "%s hangs %.3f mm over %s %d, on nothing.\n",
                         wh_print_wafer(printer, event->other), left->place.dz,
                         record->layout->stations[left->place.station].name, (int)left->place.slot);
        }
    }
}

static void print_ends(const wh_printer_t *printer, const history_t *history) {
    static const char *const heads[] = {
        "wafer;held by;lies in;dX mm{4,9};dY mm{4,9};dz mm{4,9};tilt deg{3,6}",
        "wafer;held by;lies in;dX mm{4,9};dY mm{4,9};dz mm{4,9};tilt deg{3,6};face"};
    wh_grid_t *grid = wh_grid_new(printer->style, 1, heads[printer->record->layout->has_faces ? 1 : 0]);
    const size_t left_out = add_wafers(printer, grid, history);
    wh_print_title(printer, "Wafers");
    wh_grid_print(grid, printer->out);
    if (left_out > 0) {
        wh_print_counted(printer->out, (int64_t)left_out, "wafer lies", "wafers lie");
        fputs(" where nothing happened to them\n", printer->out);
    }
    say_tilts(printer, history);
    say_hanging(printer);
}

void wh_print_wafers(const wh_printer_t *printer) {
    const wh_layout_t *layout = printer->record->layout;
    if (!layout || layout->wafer_count == 0) {
        return;
    }
    const history_t history = {wh_array_new(layout->wafer_count, sizeof(size_t)),
                               wh_array_new(layout->wafer_count, sizeof(size_t))};
    read_history(printer->record, &history);
    print_ends(printer, &history);
    free(history.named);
    free(history.picked);
}
