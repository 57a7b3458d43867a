#include "record_print.h"

#include <inttypes.h>
#include <stdlib.h>

#include "../layout/grips.h"
#include "../layout/ports.h"
#include "../math/trig.h"
#include "../sim/event_text.h"
#include "../text/array.h"
#include "print_internal.h"

/* ------------------------------------------------------------------------------------------------ heading */

/* The angle, in degrees, between wafer and gripper whose cosine is (2). */
static double tilt_deg_of(double n1_proj_n2) {
    return wh_deg_from_rad(wh_acos(n1_proj_n2));
}

/* "tolerance paper: |dr_proj_z| < 0.5 mm, ...; sampled every 1 ms" */
static void print_tolerance(const wh_printer_t *printer) {
    const wh_layout_t *layout = printer->record->layout;
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    fprintf(
        printer->out,
        "tolerance %s: |dr_proj_z| < %.10g mm%s, |dr_proj_xy| < %.10g mm%s, n1_proj_n2 > %.10g (%.2f%s)%s\n",
        layout->tolerance_name, limits->projz, wh_print_default(layout, 0), limits->projxy,
        wh_print_default(layout, 1), limits->planar, tilt_deg_of(limits->planar),
        wh_style_glyph(printer->style, WH_GLYPH_DEGREE), wh_print_default(layout, 2));
    fprintf(printer->out, "checked %s %g ms; wafers %s\n", wh_print_check(layout),
            (double)layout->slice_us / 1e3,
            layout->grasp.seat ? "are drawn flat onto the pads" : "stay as they were taken");
}

static void print_heading(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    wh_print_say(printer, "%s on %s", record->script ? record->script : "(no script)",
                 record->layout ? record->layout->path : "no layout");
    fputc('\n', printer->out);
    if (wh_record_is_timed(record)) {
        fprintf(printer->out, "times alone: the robots are of kind \"timed\", and nothing stands anywhere\n");
    } else if (record->layout) {
        print_tolerance(printer);
    }
    for (size_t i = 0; i < record->error_count; ++i) {
        wh_print_say(printer, "%s%s", i == 0 ? "! off by " : ", ", record->errors[i]);
    }
    if (record->error_count > 0) {
        fputc('\n', printer->out);
    }
    if (record->trial) {
        fprintf(printer->out, "! off by what trial %" PRIu64 " of seed %" PRIu64 " draws\n",
                record->trial->trial, record->trial->seed);
    }
}

/* --------------------------------------------------------------------------------------------- complaints */

/* Misses and complaints: events that almost happened or should not have happened, and which condition failed
 * by how much. */
enum { AT, WHAT, WAFER, GRIPPER, MEASURED, WHY = MEASURED + WH_PRINT_MEASURED_COLUMNS };

static const char *part_name(const wh_layout_t *layout, int32_t part) {
    const char *name = layout ? wh_layout_part_name(layout, part) : NULL;
    return name ? name : "none";
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

static void add_event(const wh_printer_t *printer, wh_grid_t *grid, const wh_event_record_t *record) {
    const wh_event_t *event = &record->event;
    const double at = (double)record->utime / 1e6;
    char what[32];
    wh_text_words(what, sizeof what, wh_event_name(event->kind));
    wh_grid_row(grid);
    wh_grid_number(grid, AT, WH_INK_PLAIN, at);
    wh_grid_text(grid, WHAT, wh_print_is_complaint(event->kind) ? WH_INK_BAD : WH_INK_WARN, "%s", what);
    wh_grid_text(grid, WAFER, WH_INK_PLAIN, "%s", wh_print_wafer(printer, event->wafer));
    wh_grid_text(grid, GRIPPER, WH_INK_PLAIN, "%s", wh_print_gripper(printer, event->gripper));
    if (event->kind == WH_EVENT_NEAR_MISS || event->kind == WH_EVENT_CONTESTED) {
        wh_print_measured(printer, grid, MEASURED, event);
    }
    say_why(printer, grid, at, event);
}

/* True if an event belongs among the misses: no wafer that a carrier brings or takes. */
static bool is_miss(const wh_event_t *event) {
    static const uint32_t others = 1U << WH_EVENT_NEAR_MISS | 1U << WH_EVENT_VACUUM_LOST |
                                   1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    const bool is_brought =
        event->kind == WH_EVENT_FAULT_ARMED && event->parts[1] == (int32_t)WH_FAULT_WAFER_PLACED;
    return !is_brought && ((others >> (unsigned)event->kind & 1U) != 0 || wh_print_is_complaint(event->kind));
}

static void print_complaints(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "at s{3,6};what;wafer;gripper");
    wh_print_measured_columns(printer, grid);
    wh_grid_columns(grid, "why");
    for (size_t i = 0; i < record->event_count; ++i) {
        if (is_miss(&record->events[i].event)) {
            add_event(printer, grid, &record->events[i]);
        }
    }
    wh_print_titled(printer, "Misses and complaints", grid);
}

/* ------------------------------------------------------------------------------------------------- wafers */

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
        tilts ? tilt_deg_of(wh_real_abs(layout->start[wafer].base_from_wafer.R.m[2][2])) : 0;
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
        const double tilt_deg = tilt_deg_of(pick->measured.n1_proj_n2);
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

static void print_wafers(const wh_printer_t *printer) {
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

/* ------------------------------------------------------------------------------------------- expectations */

enum { MARK, LINE, TEXT };

static size_t count_unmet(const wh_record_t *record) {
    size_t unmet = 0;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        unmet += record->expectations[i].ok ? 0 : 1;
    }
    return unmet;
}

static void print_unmet(const wh_printer_t *printer) {
    wh_grid_t *grid = wh_grid_new(printer->style, 0, ";line{0};expected");
    for (size_t i = 0; i < printer->record->expectation_count; ++i) {
        const wh_expectation_record_t *expectation = &printer->record->expectations[i];
        if (expectation->ok) {
            continue;
        }
        wh_grid_row(grid);
        wh_grid_text(grid, MARK, WH_INK_BAD, "%s", wh_style_glyph(printer->style, WH_GLYPH_CROSS));
        if (expectation->line > 0) {
            wh_grid_number(grid, LINE, WH_INK_DIM, expectation->line);
        }
        wh_grid_text(grid, TEXT, WH_INK_PLAIN, "%s", expectation->text ? expectation->text : "");
    }
    wh_grid_print(grid, printer->out);
}

static void print_expectations(const wh_printer_t *printer) {
    const size_t count = printer->record->expectation_count;
    const size_t unmet = count_unmet(printer->record);
    if (count == 0) {
        return;
    }
    wh_print_title(printer, "Expectations");
    if (unmet > 0) {
        print_unmet(printer);
    }
    if (unmet < count) {
        wh_style_print(printer->style, printer->out, WH_INK_GOOD, "%s",
                       wh_style_glyph(printer->style, WH_GLYPH_TICK));
        fprintf(printer->out, " %s%zu met\n", unmet == 0 && count > 1 ? "all " : "", count - unmet);
    }
}

/* ------------------------------------------------------------------------------------------------ summary */

static void print_times_alone(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    fprintf(printer->out, "\n%.6f s by events; %.3f s of wall time\nhash %016llx\n", record->simulated_s,
            record->wall_s, (unsigned long long)record->hash);
}

static void print_times(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    if (wh_record_is_timed(record)) {
        print_times_alone(printer);
        return;
    }
    fputc('\n', printer->out);
    wh_print_counted(printer->out, (int64_t)record->command_count, "command", "commands");
    fprintf(printer->out, ", %.3f s simulated in ", record->simulated_s);
    wh_print_counted(printer->out, record->slices, "slice", "slices");
    if (record->missed > 0) {
        fprintf(printer->out, ", of which the simulator missed %lld", (long long)record->missed);
    }
    if (record->crowded > 0) {
        fprintf(printer->out, ", of which %lld had more events than are told", (long long)record->crowded);
    }
    fprintf(printer->out, "; %.3f s of wall time", record->wall_s);
    if (record->wall_s > 0 && record->simulated_s > record->wall_s) {
        const double times = record->simulated_s / record->wall_s;
        char text[WH_PRINT_NUMBER_SIZE];
        (void)wh_print_count(text, times < 9e15 ? (int64_t)times : INT64_C(9000000000000000));
        if (times < 10) {
            snprintf(text, sizeof text, "%.1f", times);
        }
        fprintf(printer->out, ", %s times faster than real time", text);
    }
    fputc('\n', printer->out);
    wh_print_throughput(printer);
    fprintf(printer->out, "hash %016llx\n", (unsigned long long)record->hash);
}

static void print_counted(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const wh_counted_record_t *counted = &record->counted;
    char count[WH_PRINT_NUMBER_SIZE];
    if (!counted->is_wanted || wh_record_is_timed(record)) {
        return;
    }
    fprintf(printer->out, "played %s of ", wh_print_count(count, record->slices - counted->left_out));
    wh_print_counted(printer->out, record->slices, "slice", "slices");
    fputs(": nothing was decided in the others\n", printer->out);
    if (counted->is_verified) {
        fprintf(printer->out, "verified %s of ", wh_print_count(count, (int64_t)counted->verified));
        wh_print_counted(printer->out, (int64_t)counted->stretches, "stretch", "stretches");
        fputs(" that could be left out, by playing them\n", printer->out);
    }
    if (record->checked && counted->moving > 0) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fprintf(printer->out, WH_RECORD_COUNTED_UNLOOKED " were looked for in %s of ",
                wh_print_count(count, record->slices - counted->moving));
        wh_print_counted(printer->out, record->slices, "slice", "slices");
        fputc('\n', printer->out);
    }
}

/* A reason for the verdict, if there is one. */
static void put_reason(FILE *out, const char **before, size_t count, const char *one, const char *many) {
    if (count > 0) {
        fputs(*before, out);
        wh_print_counted(out, (int64_t)count, one, many);
        *before = ", ";
    }
}

static size_t count_errors(const wh_record_t *record) {
    size_t errors = 0;
    for (size_t i = 0; i < record->command_count; ++i) {
        errors += record->commands[i].error != WH_OK ? 1 : 0;
    }
    return errors;
}

/* Errors that the script caught are no reason. Complaints are, whatever was expected. */
static void put_reasons(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const size_t unmet = count_unmet(record);
    const size_t expected = record->expectation_count;
    size_t complaints = 0;
    for (size_t i = 0; i < record->event_count; ++i) {
        complaints += wh_record_is_complaint(record->events[i].event.kind) ? 1 : 0;
    }
    const char *before = ": ";
    put_reason(printer->out, &before, unmet, "expectation not met", "expectations not met");
    put_reason(printer->out, &before, record->failure ? count_errors(record) : 0, "command with an error",
               "commands with errors");
    put_reason(printer->out, &before, complaints, "complaint", "complaints");
    if (before[0] == ',' && unmet == 0 && expected > 0) {
        fprintf(printer->out, ", though %s met",
                expected == 1 ? "the expectation is" : "all expectations are");
    }
}

static void print_cut(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    if (record->flow && wh_flow_is_cut(record->flow)) {
        const wh_flow_figures_t *figures = &record->flow->figures;
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        const size_t wafers = figures->plan->wafer_count;
        fprintf(printer->out, "cut at %.10g s: %zu of %zu %s not at %s\n", (double)figures->end_us / 1e6,
                figures->result.left, wafers, wafers == 1 ? "wafer" : "wafers",
                figures->result.left == 1 ? "its end" : "their ends");
    }
}

static void print_summary(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const char *verdict = record->ok ? "ok" : "failed";
    wh_ink_t ink = record->ok ? WH_INK_GOOD : WH_INK_BAD;
    if (wh_record_moved_nothing(record)) {
        verdict = "nothing moved";
        ink = WH_INK_WARN;
    }
    print_times(printer);
    print_counted(printer);
    if (record->unlooked) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fprintf(printer->out, "%s\n", record->unlooked);
    }
    print_cut(printer);
    if (record->never_came) {
        wh_style_print(printer->style, printer->out, WH_INK_WARN, "! ");
        fprintf(printer->out, "never came, and so were not tried: %s\n", record->never_came);
    }
    wh_style_print(printer->style, printer->out, ink, "%s", verdict);
    if (!record->ok) {
        put_reasons(printer);
    } else {
        const char *before = ", ";
        put_reason(printer->out, &before, count_errors(record), "error caught", "errors caught");
    }
    fputc('\n', printer->out);
    if (record->failure) {
        wh_print_say(printer, "%s", record->failure);
        fputc('\n', printer->out);
    }
}

/* ------------------------------------------------------------------------------------------------- window */

static void print_window(const wh_printer_t *printer, const wh_record_sections_t *wanted) {
    const wh_record_t *record = printer->record;
    const bool is_whole = !(wanted->from_s > 0) && !(wanted->to_s > 0);
    const int64_t end = wanted->to_s > 0 ? wh_print_slice_at(printer, wanted->to_s) : record->slices;
    const wh_print_window_t window = {wh_print_slice_at(printer, wanted->from_s), end, is_whole};
    if (window.end <= window.begin && !is_whole) {
        wh_print_title(printer, "Gantt");
        fprintf(printer->out, "nothing: no slice of the run, which took %.3f s, lies there\n",
                record->simulated_s);
        return;
    }
    wh_print_gantt(printer, &window);
    wh_print_times(printer, &window);
}

/* ---------------------------------------------------------------------------------------------------- all */

int wh_record_print_table(const wh_record_t *record, FILE *out, const wh_style_t *style,
                          const wh_record_sections_t *sections) {
    static const wh_record_sections_t none = {0};
    const wh_record_sections_t *wanted = sections ? sections : &none;
    const wh_printer_t printer = {record, style, out};
    print_heading(&printer);
    if (!wh_record_is_timed(record)) {
        wh_print_commands(&printer);
    }
    wh_print_flow(&printer);
    wh_print_errors(&printer);
    wh_print_handovers(&printer);
    print_complaints(&printer);
    wh_print_stations(&printer);
    wh_print_clearances(&printer);
    print_wafers(&printer);
    if (wanted->gantt) {
        print_window(&printer, wanted);
    }
    if (wanted->cycle) {
        wh_print_cycle(&printer);
    }
    if (wanted->margins) {
        wh_print_margins(&printer);
    }
    print_expectations(&printer);
    print_summary(&printer);
    return fflush(out) != 0 || ferror(out) ? -1 : 0;
}
