/* A layout and records of runs, built by hand; the tests of JSON and tables print them. */
#ifndef WH_TESTS_SUPPORT_RECORD_H
#define WH_TESTS_SUPPORT_RECORD_H

#include <string.h>

#include "math/trig.h"
#include "record/record.h"

enum { FIXTURE_WAFERS = 3, FIXTURE_STATIONS = 3 };
enum { FIXTURE_EE, FIXTURE_PA };
enum { FIXTURE_A, FIXTURE_B, FIXTURE_P };

typedef struct {
    char layout_path[32], script[32];
    char texts[8][80];
    wh_layout_t layout;
    wh_layout_station_t stations[FIXTURE_STATIONS];
    wh_station_t places[FIXTURE_STATIONS];
    wh_layout_wafer_t layout_wafers[FIXTURE_WAFERS];
    wh_record_t record;
    wh_command_record_t commands[8];
    wh_event_record_t events[16];
    wh_expectation_record_t expectations[8];
    wh_wafer_record_t wafers[FIXTURE_WAFERS];
} fixture_t;

/* A pose tilted by `degrees` about base's x. */
static inline wh_mat3_t fixture_tilt(double degrees) {
    const double radians = degrees * WH_PI / 180;
    const double s = sin(radians), c = cos(radians);
    const wh_mat3_t R = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    return R;
}

static inline void fixture_layout(fixture_t *f) {
    static const char *const stations[] = {"A", "B", "P"};
    static const char *const wafers[] = {"Wafer 1", "Wafer 2", "Wäfer №3"};
    wh_layout_t *layout = &f->layout;
    strcpy(f->layout_path, "lua/layouts/paper.lua");
    layout->path = f->layout_path;
    strcpy(layout->tolerance_name, "paper");
    layout->wafer_diameter = 300;
    layout->wafer_thickness = 0.775;
    layout->notch_depth = 1;
    layout->grasp.tolerance.projz = 0.5;
    layout->grasp.tolerance.projxy = 50;
    layout->grasp.tolerance.planar = 0.99;
    layout->slice_us = 1000;
    layout->machine.gripper_count = 2;
    strcpy(layout->grippers[FIXTURE_EE].name, "EE");
    layout->grippers[FIXTURE_EE].station = WH_NONE;
    strcpy(layout->grippers[FIXTURE_PA].name, "PA");
    layout->grippers[FIXTURE_PA].station = FIXTURE_P;
    for (size_t i = 0; i < FIXTURE_STATIONS; ++i) {
        strcpy(f->stations[i].name, stations[i]);
        f->places[i].base_from_station = wh_pose_identity();
    }
    f->places[FIXTURE_A].base_from_station.R = fixture_tilt(1.5);
    for (size_t i = 0; i < FIXTURE_WAFERS; ++i) {
        strcpy(f->layout_wafers[i].name, wafers[i]);
    }
    layout->station_count = FIXTURE_STATIONS;
    layout->stations = f->stations;
    layout->places = f->places;
    layout->wafer_count = FIXTURE_WAFERS;
    layout->wafers = f->layout_wafers;
}

/* A record of nothing: no layout, no script. */
static inline void fixture_empty(fixture_t *f) {
    memset(f, 0, sizeof *f);
    f->record.ok = true;
    f->record.commands = f->commands;
    f->record.events = f->events;
    f->record.expectations = f->expectations;
    f->record.wafers = f->wafers;
}

/* A run without commands so far, on the paper's layout. */
static inline void fixture_begin(fixture_t *f) {
    fixture_empty(f);
    fixture_layout(f);
    strcpy(f->script, "lua/examples/01_transfer.lua");
    f->record.script = f->script;
    f->record.layout = &f->layout;
    for (size_t i = 0; i < FIXTURE_WAFERS; ++i) {
        f->wafers[i].base_from_wafer = wh_pose_identity();
        f->wafers[i].holder = WH_NONE;
        f->wafers[i].place.station = WH_NONE;
    }
}

static inline wh_command_record_t *fixture_command(fixture_t *f, int line, const char *text, double begin_s,
                                                   double end_s) {
    const size_t i = f->record.command_count++;
    wh_command_record_t *command = &f->commands[i];
    strcpy(f->texts[i], text);
    command->line = line;
    command->text = f->texts[i];
    command->begin_s = begin_s;
    command->end_s = end_s;
    return command;
}

/* An event during the last command. */
static inline wh_event_t *fixture_event(fixture_t *f, wh_event_kind_t kind, int64_t utime, int32_t wafer,
                                        int32_t gripper) {
    wh_event_record_t *record = &f->events[f->record.event_count++];
    record->utime = utime;
    record->command = (int32_t)f->record.command_count - 1;
    record->event.kind = kind;
    record->event.wafer = wafer;
    record->event.gripper = gripper;
    record->event.other = WH_NONE;
    record->event.slice = (uint64_t)(utime / 1000);
    record->event.measured_slice = record->event.slice;
    return &record->event;
}

/* The values that a level gripper measures on a wafer at dx, dy, dz from it, tilted by `degrees`. */
static inline void fixture_measure(fixture_t *f, wh_event_t *event, double dx, double dy, double dz,
                                   double degrees) {
    const wh_pose_t base_from_gripper = wh_pose_identity();
    wh_pose_t base_from_wafer = wh_pose_identity();
    base_from_wafer.R = fixture_tilt(degrees);
    base_from_wafer.r = wh_vec3(dx, dy, dz);
    (void)wh_proximity_measure(&base_from_wafer, &base_from_gripper, &f->layout.grasp.tolerance,
                               &event->measured);
}

static inline void fixture_place(fixture_t *f, size_t wafer, int32_t station, int32_t slot, double dx,
                                 double dy, double dz, double tilt) {
    const wh_place_t place = {station, slot, dx, dy, dz, tilt * WH_PI / 180, WH_FACE_BACK};
    f->wafers[wafer].place = place;
}

static inline void fixture_expect(fixture_t *f, int line, char *text, bool ok) {
    wh_expectation_record_t *expectation = &f->expectations[f->record.expectation_count++];
    expectation->line = line;
    expectation->text = text;
    expectation->ok = ok;
}

/* The paper's first run. */
static inline void fixture_transfer(fixture_t *f) {
    static char first[] = "Wafer 1 in B 2 at 0, 0", second[] = "Wafer 2 in B 10 at 13.794, 7.2385";
    fixture_begin(f);
    fixture_command(f, 3, "GET A 1", 0, 6.412);
    fixture_measure(f, fixture_event(f, WH_EVENT_PICKED, 4013000, 0, FIXTURE_EE), 0, 0, 0.45, 1.5);
    fixture_command(f, 3, "PUT B 2", 6.412, 13.09);
    fixture_measure(f, fixture_event(f, WH_EVENT_RELEASED, 11002000, 0, FIXTURE_EE), 0, 0, 0.45, 1.5);
    fixture_command(f, 4, "GET B 1", 13.09, 17.955);
    fixture_measure(f, fixture_event(f, WH_EVENT_PICKED, 15871000, 1, FIXTURE_EE), 13.794, 7.2385, 0.45, 0);
    fixture_command(f, 4, "PUT B 10", 17.955, 22.87);
    fixture_measure(f, fixture_event(f, WH_EVENT_RELEASED, 20900000, 1, FIXTURE_EE), 13.794, 7.2385, 0.45, 0);
    fixture_place(f, 0, FIXTURE_B, 2, 1.1e-13, -0.0, 0.2, 1.5);
    fixture_place(f, 1, FIXTURE_B, 10, 13.794, 7.2385, 0.2, 0);
    fixture_place(f, 2, FIXTURE_A, 25, 0, 0, 0, 0);
    fixture_expect(f, 5, first, true);
    fixture_expect(f, 6, second, true);
    f->record.slices = 22870;
    f->record.simulated_s = 22.87;
    f->record.wall_s = 0.0087;
    f->record.hash = UINT64_C(0x00c0ffee12345678);
}

static inline void fixture_misses(fixture_t *f) {
    static char message[] = "wafer missing: nothing was on the gripper after the stroke";
    wh_command_record_t *command = fixture_command(f, 9, "GET A 3", 30.5, 33.75);
    command->error = WH_STATUS_WAFER_MISSING;
    command->message = message;
    fixture_measure(f, fixture_event(f, WH_EVENT_NEAR_MISS, 32100000, 2, FIXTURE_EE), 55, 0, 0.7, 0);
    wh_event_t *event = fixture_event(f, WH_EVENT_CONTESTED, 32500000, 1, FIXTURE_PA);
    fixture_measure(f, event, 1, 1, 0.1, 0);
    event->other = FIXTURE_EE;
    event = fixture_event(f, WH_EVENT_RELEASED_UNSUPPORTED, 33000000, 1, FIXTURE_EE);
    event->height = 12.5;
    event = fixture_event(f, WH_EVENT_SLOT_OCCUPIED, 33100000, 1, FIXTURE_EE);
    event->other = 0;
    event = fixture_event(f, WH_EVENT_BAD_INPUT, 33200000, WH_NONE, FIXTURE_EE);
    event->status = WH_STATUS_NOT_FINITE;
}

/* A run through the prealigner that goes wrong in every way that a report knows. */
static inline void fixture_failed(fixture_t *f) {
    static char met[] = "PA holds Wafer 2", unmet[] = "Wafer 3 on EE, but nobody holds it";
    static char failure[] = "02_prealigner.lua:9: error 42: wafer missing";
    fixture_begin(f);
    fixture_command(f, 3, "GET B 10", 0, 4.9);
    fixture_measure(f, fixture_event(f, WH_EVENT_PICKED, 2816000, 1, FIXTURE_EE), 13.794, 7.2385, 0.45, 0);
    fixture_command(f, 4, "PUT P 1", 4.9, 11.22);
    wh_event_t *event = fixture_event(f, WH_EVENT_HANDED_OVER, 9220000, 1, FIXTURE_PA);
    fixture_measure(f, event, 13.794, 7.2385, 0.2, 0);
    event->other = FIXTURE_EE;
    fixture_misses(f);
    fixture_place(f, 0, FIXTURE_A, 1, 0, 0, 0, 0);
    fixture_place(f, 1, FIXTURE_P, 1, 13.794, 7.2385, 0.2, 0);
    f->wafers[1].holder = FIXTURE_PA;
    fixture_expect(f, 6, met, true);
    fixture_expect(f, 12, unmet, false);
    f->record.ok = false;
    f->record.failure = failure;
    f->record.slices = 33750;
    f->record.simulated_s = 33.75;
    f->record.wall_s = 0.012;
}

#endif
