/* An example to copy: a bench for grips without vacuum. Blade 0 has an edge grip, whose plunger the firmware in
 * edge_gripper.c drives, and blade 1 has passive pads, on which a wafer lies by its weight. Each blade is where
 * `height` says, above the plane of its slot; the wafers are where the test puts them.
 *
 * It needs libwaferhand.a and no test framework: BENCH_FAIL ends a test that fails, as in bench.h. */
#ifndef GRIP_BENCH_H
#define GRIP_BENCH_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <waferhand.h>

#if defined(__cplusplus)
extern "C" {
#endif
#include "edge_gripper.h"
#if defined(__cplusplus)
}
#endif

#if !defined(BENCH_FAIL)
#define BENCH_FAIL(text) (fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, text), exit(1))
#endif
#define BENCH_CHECK(condition)                                                                               \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            BENCH_FAIL(#condition);                                                                          \
        }                                                                                                    \
    } while (0)

enum { EDGE, PASSIVE, BLADES };

static const wh_station_t slots[BLADES] = {
    {{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {700, 0, 900}}, 1, 10, WH_NONE},
    {{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {-700, 0, 900}}, 1, 10, WH_NONE}};

static gripper_registers_t registers;
static edge_gripper_t gripper;
static wh_wafer_t wafers[BLADES];
static wh_wafer_t seen[BLADES]; /* of the library's own use */
static wh_gripper_t blades[BLADES];
static wh_pose_t supports[BLADES];
static wh_grip_t grips[BLADES];
static wh_edge_wafer_t shapes[BLADES];
static wh_simulator_t machine;
static wh_command_t command;
static wh_state_t state;
static wh_real_t height[BLADES];

/* Wafer 0 lies (x, y) mm beside the middle of slot 0, wafer 1 in the middle of slot 1. Both blades are 2 mm below. Returns 0
 * if all is well. */
static inline int bench_set_up(double x, double y) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, BLADES, blades, BLADES, NULL, 0};
    const wh_cell_t cell = {slots, BLADES, wh_tolerance_paper(), 0, 0, true, 0, 0};
    wh_grips_parts_t parts;
    memset(&command, 0, sizeof command);
    memset(&registers, 0, sizeof registers);
    memset(&parts, 0, sizeof parts);
    for (size_t blade = 0; blade < BLADES; ++blade) {
        supports[blade] = wh_station_slot(&slots[blade], 1);
        wafers[blade].base_from_wafer = supports[blade];
        shapes[blade] = wh_edge_wafer_nominal(150);
        grips[blade].kind = blade == EDGE ? WH_GRIP_EDGE : WH_GRIP_PASSIVE;
        grips[blade].edge = wh_edge_default(150);
        height[blade] = -2;
    }
    wafers[EDGE].base_from_wafer.r.x += WH_CAST(wh_real_t, x);
    wafers[EDGE].base_from_wafer.r.y += WH_CAST(wh_real_t, y);
    parts.dt = 0.001;
    parts.grips = grips;
    parts.shapes = shapes;
    parts.seen = seen;
    parts.supports = supports;
    parts.support_count = BLADES;
    gripper_init(&gripper, &registers);
    registers.retracted = true;
    return wh_simulator_init(&machine, &config, &storage, &cell) == WH_OK &&
                   wh_simulator_set_grips(&machine, &parts) == WH_OK
               ? 0
               : -1;
}

/* The switches show the window that the plunger is in. */
static inline void read_switches(void) {
    const double s = state.physics->grips[EDGE].s;
    const wh_edge_t *edge = &grips[EDGE].edge;
    registers.retracted = s <= edge->retracted;
    registers.gripped = s >= edge->gripped_from && s <= edge->gripped_to;
    registers.overtravel = s > edge->gripped_to;
}

/* One millisecond: first the firmware, then the machine. A passive grip has no valve: it stays open. */
static inline void tick(void) {
    gripper_tick(&gripper);
    ++command.seq;
    command.utime = 1000 * command.seq;
    command.gripper_count = BLADES;
    for (size_t blade = 0; blade < BLADES; ++blade) {
        command.grippers[blade].base_from_gripper = supports[blade];
        command.grippers[blade].base_from_gripper.r.z += height[blade];
        command.grippers[blade].valve = WH_VALVE_OPEN;
    }
    command.grippers[EDGE].valve = registers.closes ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    BENCH_CHECK(wh_simulator_step(&machine, &command, &state) == WH_OK);
    command.fault_count = 0;
    read_switches();
}

/* ------------------------------------------------------------------------------------------------ for the tests */

static inline void wait_ms(int ms) {
    for (; ms > 0; --ms) {
        tick();
    }
}

/* A blade goes to this height, 0.02 mm a millisecond. */
static inline void move_to(int blade, double target) {
    while (height[blade] != WH_CAST(wh_real_t, target)) {
        const double way = target - WH_CAST(double, height[blade]);
        height[blade] = way > 0.02    ? height[blade] + WH_REAL(0.02)
                        : way < -0.02 ? height[blade] - WH_REAL(0.02)
                                      : WH_CAST(wh_real_t, target);
        tick();
    }
}

static inline gripper_answer_t finish(void) {
    for (int ms = 0; gripper.answer == GRIPPER_BUSY && ms < 5000; ++ms) {
        tick();
    }
    return gripper.answer;
}

static inline gripper_answer_t close_it(void) {
    gripper_close(&gripper);
    return finish();
}

static inline gripper_answer_t open_it(void) {
    gripper_open(&gripper);
    return finish();
}

/* The truth, whatever the switches say. */
static inline wh_grip_phase_t phase(void) {
    return state.physics->grips[EDGE].phase;
}

/* It acts from the next millisecond on. */
static inline void break_it(wh_fault_kind_t kind, double value) {
    command.faults[0].index = 0;
    command.faults[0].fault =
        wh_fault_make(kind, EDGE, WH_CAST(wh_real_t, value), command.seq + 1, WH_FAULT_FOREVER);
    command.fault_count = 1;
}

/* The blade's own wafer is held by it, or by none. */
static inline void assert_held_by(int blade, bool is_held) {
    static char why[WH_GRASP_TEXT_SIZE(BLADES, BLADES)];
    if ((wafers[blade].holder == blade) != is_held) {
        (void)wh_grasp_text(&machine.table, NULL, why, sizeof why);
        BENCH_FAIL(why);
    }
}

/* Wafer `wafer` is here, mm beside and above the middle of its slot, to a thousandth. */
static inline void assert_lies_at(int wafer, double x, double y, double z) {
    static char why[WH_GRASP_TEXT_SIZE(BLADES, BLADES)];
    const wh_vec3_t *at = &wafers[wafer].base_from_wafer.r;
    const wh_vec3_t *slot = &supports[wafer].r;
    const double beside[] = {WH_CAST(double, at->x - slot->x) - x, WH_CAST(double, at->y - slot->y) - y,
                             WH_CAST(double, at->z - slot->z) - z};
    for (size_t i = 0; i < 3; ++i) {
        if (beside[i] > 1e-3 || beside[i] < -1e-3) {
            (void)wh_grasp_text(&machine.table, NULL, why, sizeof why);
            BENCH_FAIL(why);
        }
    }
}

#endif
