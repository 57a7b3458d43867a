/* Faults on purpose in the simulator: when they begin and end, what they do to signals and wafers, what is refused. */
#include "support_pose.h"

#include "sim/simulator.h"

enum { WAFERS = 2, GRIPPERS = 2, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_simulator_t simulator;
static wh_command_t command;
static wh_state_t answer;

/* Wafer 0 at (700, 0, 900), wafer 1 10 mm above; gripper 0 waits 20 mm below them, gripper 1 far away. */
static int set_up(void **state) {
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

static wh_status_t try_step(double z, int valve) {
    ++command.seq;
    command.grippers[0].base_from_gripper = wh_test_at(700, 0, z);
    command.grippers[0].valve = valve;
    const wh_status_t status = wh_simulator_step(&simulator, &command, &answer);
    command.fault_count = 0;
    return status;
}

static void step(double z, int valve) {
    assert_int_equal(try_step(z, valve), WH_OK);
}

static wh_fault_t fault_of(wh_fault_kind_t kind, int32_t target) {
    wh_fault_t fault;
    memset(&fault, 0, sizeof fault);
    fault.kind = kind;
    fault.target = target;
    fault.other = WH_NONE;
    fault.offset = wh_pose_identity();
    fault.from = command.seq + 1;
    fault.until = WH_FAULT_FOREVER;
    return fault;
}

/* For the next command. */
static void bring(int32_t index, const wh_fault_t *fault) {
    command.faults[command.fault_count].index = index;
    command.faults[command.fault_count].fault = *fault;
    ++command.fault_count;
}

static void bring_kind(wh_fault_kind_t kind, int32_t target) {
    const wh_fault_t fault = fault_of(kind, target);
    bring(0, &fault);
}

static const wh_event_t *find(wh_event_kind_t kind) {
    for (size_t i = 0; i < answer.event_count; ++i) {
        if (answer.events[i].kind == kind) {
            return &answer.events[i];
        }
    }
    return NULL;
}

static void expect_event(wh_event_kind_t kind, int32_t wafer, int32_t gripper, int32_t part) {
    const wh_event_t *event = find(kind);
    assert_non_null(event);
    assert_int_equal(event->wafer, wafer);
    assert_int_equal(event->gripper, gripper);
    assert_int_equal(event->parts[0], part);
    assert_int_equal(event->parts[1], simulator.condition.faults.slots[part].fault.kind);
    assert_int_equal(event->other, WH_NONE);
    assert_int_equal(event->slice, simulator.table.slice);
}

static void test_names(void **state) {
    (void)state;
    for (int i = 0; i < WH_FAULT_KINDS; ++i) {
        const char *name = wh_fault_name((wh_fault_kind_t)i);
        assert_int_equal(strncmp(name, "wafer_", 6) == 0, wh_fault_is_of_wafer((wh_fault_kind_t)i));
        for (int j = 0; j < i; ++j) {
            assert_string_not_equal(name, wh_fault_name((wh_fault_kind_t)j));
        }
    }
    assert_string_equal(wh_fault_name((wh_fault_kind_t)WH_FAULT_KINDS), "unknown");
}

/* ---------------------------------------------------------------------------------------------------- refusals */

static void refuse_fault(const wh_fault_t *fault, wh_status_t status) {
    const uint64_t hash = wh_simulator_hash(&simulator);
    bring(0, fault);
    assert_int_equal(try_step(880, CLOSED), status);
    --command.seq;
    assert_int_equal(answer.event_count, 0);
    assert_true(wh_simulator_hash(&simulator) == hash);
}

static void test_what_no_cell_can_have_is_refused(void **state) {
    (void)state;
    wh_fault_t f = fault_of((wh_fault_kind_t)WH_FAULT_KINDS, 0);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_SENSOR_ON, GRIPPERS);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_SENSOR_ON, WH_NONE);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_WAFER_MISSING, WAFERS);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f.target = 0;
    f.other = 1;
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_COMMAND_LOST, 0);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f.target = WH_NONE;
    f.other = 0;
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_WAFER_DOUBLED, 0);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f.other = 0;
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_SENSOR_ON, 0);
    f.from = 0;
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_SENSOR_ON, 0);
    f.until = -1;
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    f.offset.r.x = (wh_real_t)NAN;
    refuse_fault(&f, WH_STATUS_NOT_FINITE);
}

static void test_values_have_their_ranges(void **state) {
    static const struct {
        wh_fault_kind_t kind;
        double bad[2];
    } cases[] = {{WH_FAULT_LEAK, {-1e-9, 1.001}},
                 {WH_FAULT_SLOW_VACUUM, {-1e-9, 3601}},
                 {WH_FAULT_SENSOR_ON, {-1, 1}}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        for (size_t k = 0; k < 2; ++k) {
            wh_fault_t f = fault_of(cases[i].kind, 0);
            f.value = (wh_real_t)cases[i].bad[k];
            refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
        }
    }
}

static void test_slots(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_SENSOR_ON, 0);
    bring(-1, &f);
    assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
    bring(WH_FAULTS, &f);
    assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
    bring(3, &f);
    bring(3, &f);
    assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
    command.fault_count = WH_COMMAND_FAULTS + 1;
    assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
    bring(3, &f);
    step(880, CLOSED);
    /* Taken now, but for the very same fault with another end. */
    wh_fault_t others[10] = {f, f, f, f, f, f, f, f, f, f};
    others[0].kind = WH_FAULT_SENSOR_OFF;
    others[1].target = 1;
    others[2].from += 1;
    others[3] = fault_of(WH_FAULT_WAFER_DOUBLED, 0);
    others[3].other = 1;
    others[4].offset.r.y = 1;
    others[5].offset.R = wh_test_rotation(0, 0, 1, 0.1);
    others[6].offset.r.x = 1;
    others[7].offset.r.z = 1;
    others[8].other = 1;
    others[9].value = 1;
    for (size_t i = 0; i < 10; ++i) {
        bring(3, &others[i]);
        assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
    }
    f.until = command.seq + 1;
    bring(3, &f);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_CLEARED, WH_NONE, 0, 3);
    /* Over: free for another; so is one below that was never used. */
    others[0].from = command.seq + 1;
    bring(3, &others[0]);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_ARMED, WH_NONE, 0, 3);
    others[0].from = command.seq + 1;
    bring(1, &others[0]);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_ARMED, WH_NONE, 0, 1);
}

/* Neither the fault nor the input that it would overrule. */
static void test_a_refused_input_brings_no_fault(void **state) {
    (void)state;
    step(880, CLOSED);
    const uint64_t hash = wh_simulator_hash(&simulator);
    bring_kind(WH_FAULT_VALVE_STUCK, 0);
    assert_int_equal(try_step(880, 7), WH_STATUS_BAD_VALVE);
    assert_non_null(find(WH_EVENT_BAD_INPUT));
    bring_kind(WH_FAULT_AXIS_STOPPED, 0);
    assert_int_equal(try_step((double)NAN, CLOSED), WH_STATUS_NOT_FINITE);
    assert_true(wh_simulator_hash(&simulator) == hash);
    assert_int_equal(simulator.condition.faults.count, 0);
}

/* ------------------------------------------------------------------------------------------------------- times */

static void test_a_fault_acts_from_and_until(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_SENSOR_ON, 1);
    f.from = 3;
    f.until = 5;
    bring(0, &f);
    for (int slice = 1; slice <= 6; ++slice) {
        step(880, CLOSED);
        assert_int_equal(answer.sensors, slice == 3 || slice == 4 ? 2 : 0);
        assert_int_equal(find(WH_EVENT_FAULT_ARMED) != NULL, slice == 3);
        assert_int_equal(find(WH_EVENT_FAULT_CLEARED) != NULL, slice == 5);
    }
}

/* One that is cleared before it began was never there, for whoever reads events. */
static void test_a_fault_that_never_begins(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_SENSOR_ON, 1);
    f.from = 4;
    bring(0, &f);
    step(880, CLOSED);
    f.until = 2;
    bring(0, &f);
    for (int slice = 2; slice <= 6; ++slice) {
        step(880, CLOSED);
        assert_int_equal(answer.event_count, 0);
        assert_int_equal(answer.sensors, 0);
    }
}

/* ----------------------------------------------------------------------------------------------------- signals */

static void pick(void) {
    step(880, OPEN);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
}

static void test_no_vacuum(void **state) {
    (void)state;
    bring_kind(WH_FAULT_NO_VACUUM, 0);
    pick();
    assert_int_equal(answer.sensors, 0);
    step(905, OPEN);
    assert_true(answer.wafers[0].base_from_wafer.r.z == 905); /* it rests on the blade */
    step(905, CLOSED);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
}

static void test_leak(void **state) {
    (void)state;
    pick();
    assert_int_equal(answer.sensors, 1);
    wh_fault_t f = fault_of(WH_FAULT_LEAK, 0);
    f.value = WH_REAL(0.25);
    bring(0, &f);
    step(900, OPEN);
    expect_event(WH_EVENT_FAULT_ARMED, WH_NONE, 0, 0);
    const wh_event_t *lost = find(WH_EVENT_VACUUM_LOST);
    assert_non_null(lost);
    assert_true(lost->value == f.value && lost->limit == wh_vacuum_ideal().off);
    assert_int_equal(lost->wafer, 0);
    assert_int_equal(lost->gripper, 0);
    assert_int_equal(answer.sensors, 0);
    step(905, OPEN);
    assert_null(find(WH_EVENT_VACUUM_LOST));
    assert_int_equal(answer.grippers[0].wafer, 0);
}

/* The worst of several counts. */
static void test_several_at_one_gripper(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_LEAK, 0);
    f.value = WH_REAL(0.6);
    bring(0, &f);
    f.value = WH_REAL(0.8);
    bring(1, &f);
    f = fault_of(WH_FAULT_SLOW_VACUUM, 0);
    f.value = WH_REAL(0.009);
    bring(2, &f);
    f.value = WH_REAL(0.001);
    bring(3, &f);
    step(900, OPEN);
    assert_true(fabs((double)answer.condition->vacuum[0].level - 0.06) < 1e-6);
    for (int i = 0; i < 200; ++i) {
        step(900, OPEN);
    }
    assert_true(answer.condition->vacuum[0].level == WH_REAL(0.6));
    assert_int_equal(answer.sensors, 1);
}

static void test_sensor_off(void **state) {
    (void)state;
    bring_kind(WH_FAULT_SENSOR_OFF, 0);
    pick();
    assert_int_equal(answer.sensors, 0);
    assert_true(answer.condition->vacuum[0].on);
    assert_null(find(WH_EVENT_VACUUM_LOST));
}

static void test_a_valve_stuck(void **state) {
    (void)state;
    bring_kind(WH_FAULT_VALVE_STUCK, 0);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
    assert_int_equal(answer.condition->told[0], OPEN);
    wh_fault_t f = simulator.condition.faults.slots[0].fault;
    f.until = command.seq + 1;
    bring(0, &f);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
    bring_kind(WH_FAULT_VALVE_STUCK, 0);
    step(905, CLOSED);
    assert_int_equal(answer.grippers[0].wafer, 0);
    assert_int_equal(answer.grippers[0].valve, OPEN);
    assert_int_equal(answer.condition->told[0], CLOSED);
}

static void test_axes_stopped(void **state) {
    (void)state;
    step(880, OPEN);
    bring_kind(WH_FAULT_AXIS_STOPPED, 0);
    command.grippers[1].base_from_gripper.r.x = 0;
    step(900, OPEN);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 880);
    assert_true(answer.grippers[1].base_from_gripper.r.x == 0);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
}

static void test_a_command_lost(void **state) {
    (void)state;
    step(880, OPEN);
    wh_fault_t f = fault_of(WH_FAULT_COMMAND_LOST, WH_NONE);
    f.until = f.from + 1;
    bring(0, &f);
    command.grippers[1].base_from_gripper.r.x = 0;
    step(900, CLOSED);
    expect_event(WH_EVENT_FAULT_ARMED, WH_NONE, WH_NONE, 0);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 880);
    assert_true(answer.grippers[1].base_from_gripper.r.x == 700);
    assert_int_equal(answer.grippers[0].valve, OPEN);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
}

static void test_in_the_first_slice_nothing_was_before(void **state) {
    (void)state;
    bring_kind(WH_FAULT_AXIS_STOPPED, 0);
    step(890, OPEN);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 890);
    step(900, OPEN);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 890);
}

/* ------------------------------------------------------------------------------------------------------ wafers */

static void clear_slot(int32_t index) {
    wh_fault_t f = simulator.condition.faults.slots[index].fault;
    f.until = command.seq + 1;
    bring(index, &f);
}

static void test_a_wafer_is_moved_and_put_back(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    f.offset = wh_test_at(3, -4, 5);
    f.offset.R = wh_test_rotation(1, 0, 0, 0.1);
    bring(0, &f);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_ARMED, 0, WH_NONE, 0);
    assert_true(answer.wafers[0].base_from_wafer.r.x == 703 && answer.wafers[0].base_from_wafer.r.z == 905);
    assert_true(answer.wafers[0].base_from_wafer.R.m[2][1] == f.offset.R.m[2][1]);
    clear_slot(0);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_CLEARED, 0, WH_NONE, 0);
    assert_true(answer.wafers[0].base_from_wafer.r.x == 700 && answer.wafers[0].base_from_wafer.r.z == 900);
    assert_true(answer.wafers[0].base_from_wafer.R.m[2][1] == 0);
}

/* Two rotations that each just pass, but not their product. */
static void test_a_turn_that_just_passes_is_mended(void **state) {
    (void)state;
    wh_pose_t worn = wh_test_at(700, 0, 900);
    wh_fault_t f = fault_of(WH_FAULT_WAFER_TILTED, 0);
    for (size_t i = 0; i < 3; ++i) {
        worn.R.m[i][i] += WH_REAL(0.4) * WH_ROTATION_TOLERANCE;
        f.offset.R.m[i][i] = worn.R.m[i][i];
    }
    assert_int_equal(wh_grasp_place(&simulator.table, 0, &worn), WH_OK);
    bring(0, &f);
    step(880, CLOSED);
    assert_int_equal(wh_pose_validate(&answer.wafers[0].base_from_wafer), WH_OK);
    assert_non_null(find(WH_EVENT_FAULT_ARMED));
}

static void test_doubled_is_onto_the_other(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_DOUBLED, 0);
    f.other = 1;
    f.offset = wh_test_at(0, 0, 1);
    bring(0, &f);
    step(880, CLOSED);
    assert_true(answer.wafers[0].base_from_wafer.r.z == 911);
}

/* A wafer that somebody took meanwhile stays where it came to. */
static void test_a_wafer_that_was_taken_is_not_put_back(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    f.offset = wh_test_at(3, 0, 0);
    bring(0, &f);
    step(880, CLOSED);
    step(900, OPEN);
    clear_slot(0);
    step(902, OPEN);
    expect_event(WH_EVENT_FAULT_CLEARED, 0, WH_NONE, 0);
    assert_true(answer.wafers[0].base_from_wafer.r.x == 703 && answer.wafers[0].base_from_wafer.r.z == 902);
    assert_int_equal(answer.grippers[0].wafer, 0);
    /* The same again, let go somewhere else before it is cleared. */
    f = fault_of(WH_FAULT_WAFER_SHIFTED, 1);
    f.offset = wh_test_at(0, 0, 3);
    bring(0, &f);
    step(902, CLOSED);
    f = fault_of(WH_FAULT_WAFER_MISSING, 1);
    f.offset = wh_test_at(0, 0, -100);
    bring(1, &f);
    step(902, CLOSED);
    clear_slot(0);
    step(902, CLOSED);
    assert_true(answer.wafers[1].base_from_wafer.r.z == 813);
}

static void test_a_held_wafer_is_waited_for(void **state) {
    (void)state;
    pick();
    bring_kind(WH_FAULT_WAFER_MISSING, 0);
    command.faults[0].fault.offset = wh_test_at(0, 0, -1000);
    step(901, OPEN);
    assert_null(find(WH_EVENT_FAULT_ARMED));
    step(901, CLOSED);
    assert_null(find(WH_EVENT_FAULT_ARMED));
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_ARMED, 0, WH_NONE, 0);
    assert_true(answer.wafers[0].base_from_wafer.r.z == -99);
}

/* ---------------------------------------------------------------------------------------------- state and hash */

static void test_conditions_that_no_simulator_leaves(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    bring(0, &f);
    step(880, CLOSED);
    const wh_condition_t good = simulator.condition;
    wh_condition_t bad[13];
    for (size_t i = 0; i < 13; ++i) {
        bad[i] = good;
    }
    bad[0].vacuum[1].command = 2;
    bad[1].told[1] = -1;
    bad[2].carry[1].before[0].z = (wh_real_t)NAN;
    bad[3].carry[0].before[1].x = (wh_real_t)NAN;
    bad[4].vacuum[0].level = WH_REAL(1.001);
    bad[5].vacuum[0].level = (wh_real_t)NAN;
    bad[6].carry[0].known = 3;
    bad[7].carry[0].known = -1;
    bad[8].faults.slots[0].fault.from = 0;
    bad[9].faults.slots[0].placed.r.x = (wh_real_t)NAN;
    bad[10].faults.slots[0].before.R.m[0][0] = 2;
    bad[11].faults.slots[0].phase = (wh_fault_phase_t)4;
    bad[12].carry[0].before[0].y = (wh_real_t)INFINITY;
    assert_int_equal(wh_condition_validate(&good, GRIPPERS, WAFERS), WH_OK);
    for (size_t i = 0; i < 13; ++i) {
        assert_int_not_equal(wh_condition_validate(&bad[i], GRIPPERS, WAFERS), WH_OK);
    }
    wh_condition_t more = good;
    more.faults.count = WH_FAULTS + 1;
    assert_int_not_equal(wh_condition_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more = good;
    more.vacuum[0].command = OPEN;
    more.told[0] = OPEN;
    assert_int_equal(wh_condition_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more = good;
    more.vacuum[GRIPPERS].level = 7; /* beyond those that there are */
    more.faults.count = 2;           /* a free slot */
    assert_int_equal(wh_condition_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more.faults.slots[0].phase = WH_FAULT_OVER; /* its poses do not matter any more */
    more.faults.slots[0].placed.r.x = (wh_real_t)NAN;
    assert_int_equal(wh_condition_validate(&more, GRIPPERS, WAFERS), WH_OK);
}

static void test_the_hash_covers_each_word(void **state) {
    (void)state;
    bring_kind(WH_FAULT_WAFER_SHIFTED, 0);
    pick();
    const wh_condition_t good = simulator.condition;
    wh_condition_t changed[15];
    for (size_t i = 0; i < 15; ++i) {
        changed[i] = good;
    }
    changed[0].vacuum[0].level = WH_REAL(0.5);
    changed[1].vacuum[0].on = false;
    changed[2].vacuum[1].command = OPEN;
    changed[3].carry[0].known = 1;
    changed[4].carry[0].known = 1;
    changed[4].carry[0].slips = true;
    changed[5].carry[0].known = 1;
    changed[5].carry[0].before[1].x = 1;
    changed[6].faults.slots[0].phase = WH_FAULT_OVER;
    changed[7].faults.slots[0].fault.kind = WH_FAULT_WAFER_TILTED;
    changed[8].faults.slots[0].fault.target = 1;
    changed[9].faults.slots[0].fault.other = 1;
    changed[10].faults.slots[0].fault.value = 1;
    changed[11].faults.slots[0].fault.offset.r.y = 1;
    changed[12].faults.slots[0].fault.until = 9;
    changed[13].faults.slots[0].before.r.x = 1;
    changed[14].faults.slots[0].placed.r.x = 1;
    for (size_t i = 0; i < 15; ++i) {
        const uint64_t hash = wh_condition_hash(&changed[i], &simulator.table);
        assert_true(hash != wh_simulator_hash(&simulator));
        for (size_t k = 0; k < i; ++k) {
            assert_true(hash != wh_condition_hash(&changed[k], &simulator.table));
        }
    }
}

static void test_without_any_it_is_the_tables_hash(void **state) {
    (void)state;
    pick();
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
    step(880, CLOSED);
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
    simulator.condition.faults.count = 1; /* a free slot is none */
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
    bring_kind(WH_FAULT_SENSOR_ON, 0);
    step(880, CLOSED);
    assert_true(wh_simulator_hash(&simulator) != wh_grasp_hash(&simulator.table));
    wh_faults_clear(&simulator.condition.faults);
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_names, set_up),
        cmocka_unit_test_setup(test_what_no_cell_can_have_is_refused, set_up),
        cmocka_unit_test_setup(test_values_have_their_ranges, set_up),
        cmocka_unit_test_setup(test_slots, set_up),
        cmocka_unit_test_setup(test_a_refused_input_brings_no_fault, set_up),
        cmocka_unit_test_setup(test_a_fault_acts_from_and_until, set_up),
        cmocka_unit_test_setup(test_a_fault_that_never_begins, set_up),
        cmocka_unit_test_setup(test_no_vacuum, set_up),
        cmocka_unit_test_setup(test_leak, set_up),
        cmocka_unit_test_setup(test_several_at_one_gripper, set_up),
        cmocka_unit_test_setup(test_sensor_off, set_up),
        cmocka_unit_test_setup(test_a_valve_stuck, set_up),
        cmocka_unit_test_setup(test_axes_stopped, set_up),
        cmocka_unit_test_setup(test_a_command_lost, set_up),
        cmocka_unit_test_setup(test_in_the_first_slice_nothing_was_before, set_up),
        cmocka_unit_test_setup(test_a_wafer_is_moved_and_put_back, set_up),
        cmocka_unit_test_setup(test_a_turn_that_just_passes_is_mended, set_up),
        cmocka_unit_test_setup(test_doubled_is_onto_the_other, set_up),
        cmocka_unit_test_setup(test_a_wafer_that_was_taken_is_not_put_back, set_up),
        cmocka_unit_test_setup(test_a_held_wafer_is_waited_for, set_up),
        cmocka_unit_test_setup(test_conditions_that_no_simulator_leaves, set_up),
        cmocka_unit_test_setup(test_the_hash_covers_each_word, set_up),
        cmocka_unit_test_setup(test_without_any_it_is_the_tables_hash, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
