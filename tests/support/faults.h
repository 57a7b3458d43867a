/* A small cell for one test file about faults: two wafers, two grippers, a simulator, and faults
 * for its next command. */
#ifndef WH_TESTS_SUPPORT_FAULTS_H
#define WH_TESTS_SUPPORT_FAULTS_H

#include "support/pose.h"

#include "sim/simulator.h"

enum { WAFERS = 2, GRIPPERS = 2, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_simulator_t simulator;
static wh_command_t command;
static wh_state_t answer;

/* Wafer 0 at (700, 0, 900), wafer 1 10 mm above; gripper 0 waits 20 mm below them, gripper 1 far away. */
static inline int set_up(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    const wh_cell_t cell = {.tolerance = wh_tolerance_paper()};
    wafers[0].base_from_wafer = wh_test_at(700, 0, 900);
    wafers[1].base_from_wafer = wh_test_at(700, 0, 910);
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_OK);
    memset(&command, 0, sizeof command);
    command.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        command.grippers[g].base_from_gripper = wh_test_at(700, 1000 * g, 880);
        command.grippers[g].valve = CLOSED;
    }
    return 0;
}

static inline wh_status_t try_step(double z, int valve) {
    ++command.seq;
    command.grippers[0].base_from_gripper = wh_test_at(700, 0, z);
    command.grippers[0].valve = valve;
    const wh_status_t status = wh_simulator_step(&simulator, &command, &answer);
    command.fault_count = 0;
    return status;
}

static inline void step(double z, int valve) {
    assert_int_equal(try_step(z, valve), WH_OK);
}

static inline wh_fault_t fault_of(wh_fault_kind_t kind, int32_t target) {
    wh_fault_t fault = wh_fault_make(kind, target, 0, command.seq + 1, WH_FAULT_FOREVER);
    fault.target = target;
    fault.offset = wh_pose_identity();
    return fault;
}

/* These faults act on the next command. */
static inline void bring(int32_t index, const wh_fault_t *fault) {
    command.faults[command.fault_count].index = index;
    command.faults[command.fault_count].fault = *fault;
    ++command.fault_count;
}

static inline void bring_kind(wh_fault_kind_t kind, int32_t target) {
    const wh_fault_t fault = fault_of(kind, target);
    bring(0, &fault);
}

static inline const wh_event_t *find(wh_event_kind_t kind) {
    for (size_t i = 0; i < answer.event_count; ++i) {
        if (answer.events[i].kind == kind) {
            return &answer.events[i];
        }
    }
    return NULL;
}

static inline void expect_event(wh_event_kind_t kind, int32_t wafer, int32_t gripper, int32_t part) {
    const wh_event_t *event = find(kind);
    assert_non_null(event);
    assert_int_equal(event->wafer, wafer);
    assert_int_equal(event->gripper, gripper);
    assert_int_equal(event->parts[0], part);
    assert_int_equal(event->parts[1], simulator.physics.faults.slots[part].fault.kind);
    assert_int_equal(event->other, WH_NONE);
    assert_int_equal(event->slice, simulator.table.slice);
}

static inline void pick(void) {
    step(880, OPEN);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
}

#endif
