/* An example to copy: a bench for a controller's firmware, with a simulated machine. Each
 * millisecond the firmware runs once, Waferhand moves the gripper to the place that the axes give,
 * and the vacuum switch is read back. `said` holds the events in words.
 *
 * To make it yours: put your firmware's registers into `tick`, your robot's kinematics into
 * `gripper_pose`, your stations into `stations` and `taught`. It needs libwaferhand.a and no test
 * framework, is C99 and C++11, and runs on a host as on a Cortex-M. with_cmocka.h, with_unity.h,
 * with_cpputest.h, with_gtest.h and with_catch2.h fit it into one. Without any, BENCH_FAIL ends the
 * program with status 1. */
#ifndef BENCH_H
#define BENCH_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <waferhand.h>

#if defined(__cplusplus)
extern "C" {
#endif
#include "controller.h"
#if defined(__cplusplus)
}
#endif

/* Ends the test that runs, as failed; `text` says why. */
#if !defined(BENCH_FAIL)
#define BENCH_FAIL(text) (fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, text), exit(1))
#endif
#define BENCH_CHECK(condition)                                                                               \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            BENCH_FAIL(#condition);                                                                          \
        }                                                                                                    \
    } while (0)

enum { STATIONS = 2, WAFERS = 2, SAID = 4000, WHY = 2000 };

/* The real machine: two stacks of three slots, 700 mm from the robot, at 0 and at 90 degrees. */
static const wh_station_t stations[STATIONS] = {
    {{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {700, 0, 900}}, 3, 10, WH_NONE},
    {{{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {0, 700, 900}}, 3, 10, WH_NONE}};

/* The machine as it was taught; a test may teach it badly. */
static taught_t taught[STATIONS];

static registers_t registers;
static controller_t controller;
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[1];
static wh_simulator_t machine;
static wh_command_t command;
static wh_state_t state;
static char said[SAID];
static char why[WHY]; /* of a failure, with the table behind it */

/* The pose of the gripper. This robot is of Waferhand's own kind: theta, R, Z and yaw. */
static inline wh_pose_t gripper_pose(void) {
    const wh_real_t q[WH_ROBOT_AXES] = {wh_rad_from_deg(WH_REAL(registers.axis[THETA])),
                                        WH_REAL(registers.axis[R]), WH_REAL(registers.axis[Z]),
                                        wh_rad_from_deg(WH_REAL(registers.axis[YAW]))};
    wh_pose_t pose;
    wh_robot_forward(q, &pose);
    return pose;
}

static inline void note_events(void) {
    for (size_t i = 0; i < state.event_count; ++i) {
        const size_t length = strlen(said);
        BENCH_CHECK(wh_event_text(&state.events[i], NULL, said + length, SAID - length - 1) <
                    SAID - length - 1);
        strcat(said, "\n");
    }
}

/* One millisecond: first the firmware, then the machine. */
static inline void tick(void) {
    controller_tick(&controller);
    ++command.seq;
    command.utime = 1000 * command.seq;
    command.gripper_count = 1;
    command.grippers[0].base_from_gripper = gripper_pose();
    command.grippers[0].valve = registers.vacuum_on ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
    BENCH_CHECK(wh_simulator_step(&machine, &command, &state) == WH_OK);
    command.fault_count = 0;
    registers.sensor = (state.sensors & 1U) != 0;
    note_events();
}

/* Wafer 0 lies in slot 1 of station 0, wafer 1 in slot 2 of station 1. The vacuum takes some time
 * to build up, and a released wafer settles. Returns 0 if all is well. */
static inline int bench_set_up(void) {
    static const taught_t usual[STATIONS] = {{0, 700, 900, 3, 10, 3}, {90, 700, 900, 3, 10, 3}};
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, 1, NULL, 0};
    const wh_cell_t cell = {stations, STATIONS, wh_tolerance_paper(), WH_REAL(0.5), 0, true, 0, 0};
    wh_physics_t physics = wh_physics_default();
    physics.vacuum = wh_vacuum_delayed();
    wafers[0].base_from_wafer = wh_station_slot(&stations[0], 1);
    wafers[1].base_from_wafer = wh_station_slot(&stations[1], 2);
    memset(&command, 0, sizeof command);
    memset(&registers, 0, sizeof registers);
    said[0] = '\0';
    memcpy(taught, usual, sizeof taught);
    controller_init(&controller, &registers, taught, STATIONS);
    const bool good = wh_simulator_init(&machine, &config, &storage, &cell) == WH_OK &&
                      wh_simulator_set_physics(&machine, &physics) == WH_OK;
    return good ? 0 : -1;
}

/* ------------------------------------------------------------------------------------------------ for the tests */

/* Fails, and says where all wafers and the gripper are. */
static inline void fail_with_table(const char *what) {
    (void)snprintf(why, sizeof why, "%s:\n", what);
    const size_t length = strlen(why);
    (void)wh_grasp_text(&machine.table, NULL, why + length, sizeof why - length);
    BENCH_FAIL(why);
}

/* A check of wafers and gripper. */
#define BENCH_CHECK_TABLE(condition)                                                                         \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            fail_with_table("not " #condition);                                                              \
        }                                                                                                    \
    } while (0)

static inline answer_t finish(answer_t answer) {
    for (int ms = 0; answer == CONTROLLER_BUSY && ms < 20000; ++ms) {
        tick();
        answer = controller.answer;
    }
    return answer;
}

static inline answer_t get(int station, int slot) {
    return finish(controller_get(&controller, station, slot));
}

static inline answer_t put(int station, int slot) {
    return finish(controller_put(&controller, station, slot));
}

/* It acts from the next millisecond on, and replaces an earlier fault of this kind. */
static inline void break_it(wh_fault_kind_t kind, wh_real_t value) {
    command.faults[0].index = 0;
    command.faults[0].fault = wh_fault_make(kind, 0, value, command.seq + 1, WH_FAULT_FOREVER);
    command.fault_count = 1;
}

static inline void mend_it(void) {
    command.faults[0].fault.until = command.seq + 1;
    command.fault_count = 1;
}

static inline void assert_said(const char *text) {
    if (!strstr(said, text)) {
        fprintf(stderr, "not said: %s\n%s", text, said);
        BENCH_FAIL(text);
    }
}

static inline void assert_not_said(const char *text) {
    if (strstr(said, text)) {
        fprintf(stderr, "said: %s\n%s", text, said);
        BENCH_FAIL(text);
    }
}

/* The wafer lies flat in this slot, within 0.1 mm of its middle. */
static inline void assert_lies_in(size_t wafer, int station, int slot) {
    wh_pose_t pose;
    int32_t holder;
    wh_place_t place;
    BENCH_CHECK_TABLE(wh_grasp_wafer(&machine.table, wafer, &pose, &holder) == WH_OK);
    BENCH_CHECK_TABLE(holder == WH_NONE);
    BENCH_CHECK_TABLE(wh_cell_locate(&machine.cell, &pose, &place));
    BENCH_CHECK_TABLE(place.station == station);
    BENCH_CHECK_TABLE(place.slot == slot);
    BENCH_CHECK_TABLE(wh_real_abs(place.dx) < WH_REAL(0.1) && wh_real_abs(place.dy) < WH_REAL(0.1) &&
                      wh_real_abs(place.dz) < WH_REAL(0.1));
}

static inline void assert_held(size_t wafer) {
    BENCH_CHECK_TABLE(wafers[wafer].holder == 0);
}

/* The machine's table is as this one, to the bit. */
static inline void assert_same_table(const wh_grasp_t *expected) {
    if (wh_grasp_difference(expected, &machine.table, NULL, why, sizeof why) > 0) {
        BENCH_FAIL(why);
    }
}

#endif
