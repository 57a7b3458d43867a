/* Faults on purpose in the simulator: their names, the refusals, and their begin and end. */
#include "support/faults.h"

static void faults_have_names(void **state) {
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

static void what_no_cell_can_have_is_refused(void **state) {
    (void)state;
    wh_fault_t f = fault_of((wh_fault_kind_t)WH_FAULT_KINDS, 0);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_SENSOR_ON, GRIPPERS);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_SENSOR_ON, WH_NONE);
    refuse_fault(&f, WH_STATUS_OUT_OF_RANGE);
    f = fault_of(WH_FAULT_BEAM_LIT, WH_BEAMS);
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

static bool needs_other(wh_fault_kind_t kind) {
    return kind == WH_FAULT_WAFER_DOUBLED || kind == WH_FAULT_E84_STUCK || kind == WH_FAULT_E84_LATE;
}

/* An offset that moves no wafer has no meaning: a fault with such an offset is a mistake, and so is
 * one with a wrong `other`. */
static void only_a_wafers_fault_has_an_offset(void **state) {
    (void)state;
    for (int kind = 0; kind < WH_FAULT_KINDS; ++kind) {
        const bool of_wafer = wh_fault_is_of_wafer((wh_fault_kind_t)kind);
        for (int entry = 0; entry < 5; ++entry) {
            wh_fault_t f = wh_fault_make((wh_fault_kind_t)kind, 0, WH_REAL(0.001), 1, 9);
            f.other = needs_other((wh_fault_kind_t)kind) ? 1 : f.other;
            assert_int_equal(wh_fault_validate(&f, GRIPPERS, WAFERS), WH_OK);
            wh_real_t *const entries[] = {&f.offset.r.x, &f.offset.r.y, &f.offset.r.z};
            if (entry < 3) {
                *entries[entry] += entry == 0 ? 123 : WH_REAL(1e-30);
            } else {
                f.offset.R = wh_test_rotation(entry == 3, 0, entry == 4, 0.1);
            }
            const wh_pose_t made = wh_fault_make((wh_fault_kind_t)kind, 0, 0, 1, 9).offset;
            const bool is_other = memcmp(&made, &f.offset, sizeof made) != 0;
            assert_int_equal(wh_fault_validate(&f, GRIPPERS, WAFERS),
                             of_wafer || !is_other ? WH_OK : WH_STATUS_OUT_OF_RANGE);
            assert_true(of_wafer || is_other);
        }
    }
    wh_fault_t nan = fault_of(WH_FAULT_LEAK, 0);
    nan.value = (wh_real_t)NAN;
    refuse_fault(&nan, WH_STATUS_OUT_OF_RANGE);
}

static bool is_of_no_gripper(wh_fault_kind_t kind) {
    return wh_fault_is_of_wafer(kind) || wh_fault_is_of_door(kind) || wh_fault_is_of_beam(kind) ||
           wh_fault_is_of_station(kind) || wh_fault_is_of_controller(kind) || kind == WH_FAULT_COMMAND_LOST;
}

/* Faults as they are made, or with the one more field that their kind needs: a cell accepts them
 * and they act. */
static void faults_are_made_ready_to_be_taken(void **state) {
    (void)state;
    for (int i = 0; i < WH_FAULT_KINDS; ++i) {
        const wh_fault_kind_t kind = (wh_fault_kind_t)i;
        assert_int_equal(set_up(NULL), 0);
        command.seq = 0;
        wh_fault_t fault = wh_fault_make(kind, 0, WH_REAL(0.001), 2, 4);
        fault.other = needs_other(kind) ? 1 : fault.other;
        assert_int_equal(wh_fault_validate(&fault, GRIPPERS, WAFERS), WH_OK);
        bring(3, &fault);
        step(880, CLOSED);
        assert_int_equal(answer.event_count, 0);
        step(880, CLOSED);
        expect_event(WH_EVENT_FAULT_ARMED, wh_fault_is_of_wafer(kind) ? 0 : WH_NONE,
                     is_of_no_gripper(kind) ? WH_NONE : 0, 3);
        assert_true(kind != WH_FAULT_WAFER_MISSING || wafers[0].base_from_wafer.r.z == WH_REAL(900 - 1e5));
        step(880, CLOSED);
        step(880, CLOSED);
        assert_int_equal(find(WH_EVENT_FAULT_CLEARED) != NULL, kind != WH_FAULT_WAFER_PLACED);
    }
}

static void values_have_their_ranges(void **state) {
    static const struct {
        wh_fault_kind_t kind;
        double bad[2];
    } cases[] = {{WH_FAULT_LEAK, {-1e-9, 1.001}},
                 {WH_FAULT_SLOW_VACUUM, {-1e-9, 3601}},
                 {WH_FAULT_BEAM_LATE, {-1e-9, 0.0101}},
                 {WH_FAULT_EDGE_SENSOR_STUCK, {-1e-9, 1.001}},
                 {WH_FAULT_EDGE_SENSOR_LATE, {-1e-9, 0.00101}},
                 {WH_FAULT_STATION_SLOW, {-1e-9, 1001}},
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

static void the_ends_of_the_ranges(void **state) {
    static const struct {
        wh_fault_kind_t kind;
        double value;
    } cases[] = {
        {WH_FAULT_LEAK, 0}, {WH_FAULT_LEAK, 1}, {WH_FAULT_SLOW_VACUUM, 0}, {WH_FAULT_SLOW_VACUUM, 3600}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        wh_fault_t f = fault_of(cases[i].kind, 0);
        f.value = (wh_real_t)cases[i].value;
        assert_int_equal(wh_fault_validate(&f, GRIPPERS, WAFERS), WH_OK);
    }
}

/* Also at the ends of the number range, a wafer that faults move stays at a place that a table can hold. */
static void no_offset_takes_a_wafer_out_of_the_numbers(void **state) {
    (void)state;
    wh_real_t *const parts[] = {&command.faults[0].fault.offset.r.x, &command.faults[0].fault.offset.r.y,
                                &command.faults[0].fault.offset.r.z};
    for (size_t i = 0; i < 3; ++i) {
        bring_kind(WH_FAULT_WAFER_SHIFTED, 0);
        *parts[i] = WH_REAL(1.001e6);
        assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
        --command.seq;
    }
    const wh_pose_t last = {wafers[0].base_from_wafer.R,
                            {WH_TEST_LARGEST, -WH_TEST_LARGEST, WH_TEST_LARGEST}};
    assert_int_equal(wh_grasp_place(&simulator.table, 0, &last), WH_OK);
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    f.offset.r = wh_vec3(WH_REAL(1e6), WH_REAL(-1e6), WH_REAL(1e6));
    f.offset.R = wh_test_rotation(0, 0, 1, 0.1);
    bring(0, &f);
    bring(1, &f);
    step(880, CLOSED);
    assert_non_null(find(WH_EVENT_FAULT_ARMED));
    assert_int_equal(wh_pose_validate(&wafers[0].base_from_wafer), WH_OK);
    assert_int_equal(wh_physics_state_validate(&simulator.physics, GRIPPERS, WAFERS), WH_OK);
}

static void faults_take_slots(void **state) {
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
    /* It is accepted now, except for the very same fault with another end. */
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
    /* It is over, so its slot is free for another; so is a slot below that was never used. */
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
static void a_refused_input_brings_no_fault(void **state) {
    (void)state;
    step(880, CLOSED);
    const uint64_t hash = wh_simulator_hash(&simulator);
    bring_kind(WH_FAULT_VALVE_STUCK, 0);
    assert_int_equal(try_step(880, 7), WH_STATUS_BAD_VALVE);
    assert_non_null(find(WH_EVENT_BAD_INPUT));
    bring_kind(WH_FAULT_AXIS_STOPPED, 0);
    assert_int_equal(try_step((double)NAN, CLOSED), WH_STATUS_NOT_FINITE);
    assert_true(wh_simulator_hash(&simulator) == hash);
    assert_int_equal(simulator.physics.faults.count, 0);
}

/* ------------------------------------------------------------------------------------------------------- times */

static void a_fault_acts_from_and_until(void **state) {
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

/* The news that it ended long ago comes late: it ends now. */
static void an_end_that_has_passed(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_SENSOR_ON, 1);
    bring(0, &f);
    for (int slice = 1; slice <= 4; ++slice) {
        step(880, CLOSED);
        assert_int_equal(answer.sensors, 2);
    }
    f.until = 3;
    bring(0, &f);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_CLEARED, WH_NONE, 1, 0);
    assert_int_equal(answer.sensors, 0);
}

/* Nothing is left of the slot's earlier fault. */
static void a_slot_that_is_used_again_is_new(void **state) {
    (void)state;
    static const wh_pose_t none;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 1);
    f.offset = wh_test_at(7, 0, 0);
    f.until = 2;
    bring(0, &f);
    step(880, CLOSED);
    step(880, CLOSED);
    const wh_fault_slot_t *slot = &simulator.physics.faults.slots[0];
    assert_int_equal(slot->phase, WH_FAULT_OVER);
    assert_true(slot->placed.r.x > 0);
    bring_kind(WH_FAULT_SENSOR_ON, 0);
    step(880, CLOSED);
    assert_memory_equal(&slot->before, &none, sizeof none);
    assert_memory_equal(&slot->placed, &none, sizeof none);
}

/* A new fault whose slices are past is accepted, and is over in that slice: no event, no effect. */
static void a_fault_whose_slices_are_past(void **state) {
    (void)state;
    for (int i = 0; i < 9; ++i) {
        step(880, CLOSED);
    }
    for (int64_t until = 0; until <= 10; ++until) {
        const wh_fault_t sensor = wh_fault_make(WH_FAULT_SENSOR_ON, 1, 0, 1, until);
        const wh_fault_t wafer = wh_fault_make(WH_FAULT_WAFER_MISSING, 1, 0, 1, until);
        bring(0, &sensor);
        bring(1, &wafer);
        step(880, CLOSED);
        assert_int_equal(answer.event_count, 0);
        assert_int_equal(answer.sensors, 0);
        assert_true(wafers[1].base_from_wafer.r.z == 910);
        assert_int_equal(simulator.physics.faults.slots[0].phase, WH_FAULT_OVER);
        assert_int_equal(simulator.physics.faults.slots[1].phase, WH_FAULT_OVER);
    }
}

/* A fault that is cleared before it began does not appear in the events. */
static void a_fault_that_never_begins(void **state) {
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

/* -------------------------------------------------------------------------------------------------- effects */

/* The effects of faults on signals, axes and wafers. */

/* ----------------------------------------------------------------------------------------------------- signals */

static void no_vacuum(void **state) {
    (void)state;
    bring_kind(WH_FAULT_NO_VACUUM, 0);
    pick();
    assert_int_equal(answer.sensors, 0);
    step(905, OPEN);
    assert_true(answer.wafers[0].base_from_wafer.r.z == 905); /* it rests on the blade */
    step(905, CLOSED);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
}

static void leak(void **state) {
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

/* Each gripper has its own faults. */
static void a_neighbours_faults_do_not_count(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_LEAK, 1);
    bring(0, &f);
    f = fault_of(WH_FAULT_SLOW_VACUUM, 1);
    f.value = 2;
    bring(1, &f);
    pick();
    assert_int_equal(answer.sensors, 1);
    assert_true(answer.physics->vacuum[0].level == 1);
    bring_kind(WH_FAULT_NO_VACUUM, 1);
    command.faults[0].index = 2;
    step(900, OPEN);
    assert_int_equal(answer.sensors, 1);
}

/* Before it begins, and after it is over, commands and sensors pass unchanged. */
static void only_while_it_acts(void **state) {
    static const wh_fault_kind_t kinds[] = {WH_FAULT_AXIS_STOPPED, WH_FAULT_COMMAND_LOST,
                                            WH_FAULT_VALVE_STUCK, WH_FAULT_SENSOR_ON};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        set_up(state);
        wh_fault_t f = fault_of(kinds[i], kinds[i] == WH_FAULT_COMMAND_LOST ? WH_NONE : 0);
        f.from = 4;
        f.until = 5;
        bring(0, &f);
        for (int slice = 1; slice <= 6; ++slice) {
            const double z = 880 + slice;
            const int valve = slice % 2 == 0 ? OPEN : CLOSED;
            step(z, valve);
            const bool through = grippers[0].base_from_gripper.r.z == (wh_real_t)z &&
                                 grippers[0].valve == valve && answer.sensors == 0;
            assert_int_equal(through, slice != 4);
        }
    }
}

/* The worst of several counts. */
static void several_at_one_gripper(void **state) {
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
    assert_true(fabs((double)answer.physics->vacuum[0].level - 0.06) < 1e-6);
    for (int i = 0; i < 200; ++i) {
        step(900, OPEN);
    }
    assert_true(answer.physics->vacuum[0].level == WH_REAL(0.6));
    assert_int_equal(answer.sensors, 1);
}

static void sensor_off(void **state) {
    (void)state;
    bring_kind(WH_FAULT_SENSOR_OFF, 0);
    pick();
    assert_int_equal(answer.sensors, 0);
    assert_true(answer.physics->vacuum[0].on);
    assert_null(find(WH_EVENT_VACUUM_LOST));
}

static void a_valve_stuck(void **state) {
    (void)state;
    bring_kind(WH_FAULT_VALVE_STUCK, 0);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
    assert_int_equal(answer.physics->told[0], OPEN);
    wh_fault_t f = simulator.physics.faults.slots[0].fault;
    f.until = command.seq + 1;
    bring(0, &f);
    step(900, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
    bring_kind(WH_FAULT_VALVE_STUCK, 0);
    step(905, CLOSED);
    assert_int_equal(answer.grippers[0].wafer, 0);
    assert_int_equal(answer.grippers[0].valve, OPEN);
    assert_int_equal(answer.physics->told[0], CLOSED);
}

static void axes_stopped(void **state) {
    (void)state;
    step(880, OPEN);
    bring_kind(WH_FAULT_AXIS_STOPPED, 0);
    command.grippers[1].base_from_gripper.r.x = 0;
    step(900, OPEN);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 880);
    assert_true(answer.grippers[1].base_from_gripper.r.x == 0);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
}

static void a_command_lost(void **state) {
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

static void in_the_first_slice_nothing_was_before(void **state) {
    (void)state;
    bring_kind(WH_FAULT_AXIS_STOPPED, 0);
    step(890, OPEN);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 890);
    step(900, OPEN);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 890);
}

/* ------------------------------------------------------------------------------------------------------ wafers */

static void clear_slot(int32_t index) {
    wh_fault_t f = simulator.physics.faults.slots[index].fault;
    f.until = command.seq + 1;
    bring(index, &f);
}

static void a_wafer_is_moved_and_put_back(void **state) {
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

/* Two rotations that each just pass, but their product does not. */
static void a_turn_that_just_passes_is_mended(void **state) {
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

static void doubled_is_onto_the_other(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_DOUBLED, 0);
    f.other = 1;
    f.offset = wh_test_at(0, 0, 1);
    bring(0, &f);
    step(880, CLOSED);
    assert_true(answer.wafers[0].base_from_wafer.r.z == 911);
}

/* A wafer that a gripper carries lies in no slot: the second fault waits until it does. */
static void doubled_waits_while_the_other_is_held(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_DOUBLED, 0);
    f.other = 1;
    f.offset = wh_test_at(0, 0, 1);
    step(910, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 1);
    bring(0, &f);
    step(912, OPEN);
    assert_null(find(WH_EVENT_FAULT_ARMED));
    assert_true(answer.wafers[0].base_from_wafer.r.z == 900);
    step(912, CLOSED);
    step(912, CLOSED);
    expect_event(WH_EVENT_FAULT_ARMED, 0, WH_NONE, 0);
    assert_true(answer.wafers[0].base_from_wafer.r.z == 913);
}

/* A wafer that a gripper took in the meantime stays at its new place. */
static void a_wafer_that_was_taken_is_not_put_back(void **state) {
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
    /* Now it is released at another place before the fault is cleared. */
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

/* Among two faults of one wafer the first may end first, or both at once. In the end the wafer lies
 * where it lay before both. */
static void two_faults_of_one_wafer(void **state) {
    (void)state;
    for (int together = 0; together < 2; ++together) {
        wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
        f.offset = wh_test_at(3, 0, 0);
        bring(0, &f);
        step(880, CLOSED);
        f = fault_of(WH_FAULT_WAFER_TILTED, 0);
        f.offset.R = wh_test_rotation(1, 0, 0, 0.1);
        bring(1, &f);
        step(880, CLOSED);
        clear_slot(0);
        if (together == 0) {
            step(880, CLOSED);
            assert_true(answer.wafers[0].base_from_wafer.r.x == 703);
        }
        clear_slot(1);
        step(880, CLOSED);
        assert_true(answer.wafers[0].base_from_wafer.r.x == 700);
        assert_true(answer.wafers[0].base_from_wafer.R.m[2][1] == 0);
    }
}

static void shift(int32_t slot, int32_t wafer) {
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, wafer);
    f.offset = wh_test_at(3, 0, 0);
    bring(slot, &f);
    step(880, CLOSED);
}

static void expect_x_after_clearing(int32_t slot, double x) {
    clear_slot(slot);
    step(880, CLOSED);
    assert_true(wafers[0].base_from_wafer.r.x == WH_REAL(x));
}

/* Each passes the wafer's earlier place on to the fault that moved it next, and to no other. */
static void three_faults_of_one_wafer_among_others(void **state) {
    (void)state;
    wh_fault_t waiting = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    waiting.from = 1000;
    const wh_fault_t sensor = fault_of(WH_FAULT_SENSOR_ON, 0);
    bring(5, &waiting);
    bring(3, &sensor);
    shift(2, 0);
    shift(0, 0);
    shift(1, 0);
    /* the other wafer lies where the second fault had put this one */
    const wh_pose_t same = wh_test_at(706, 0, 900);
    assert_int_equal(wh_grasp_place(&simulator.table, 1, &same), WH_OK);
    shift(4, 1);
    expect_x_after_clearing(0, 709);
    expect_x_after_clearing(1, 703);
    expect_x_after_clearing(2, 700);
    assert_true(wafers[1].base_from_wafer.r.x == 709);
    expect_x_after_clearing(4, 700);
    assert_true(wafers[1].base_from_wafer.r.x == 706);
}

/* Not only the first fault in the slots acts. */
static void faults_overrule_grippers_each_in_turn(void **state) {
    (void)state;
    step(880, CLOSED);
    const wh_fault_t stuck = fault_of(WH_FAULT_VALVE_STUCK, 1);
    const wh_fault_t stopped = fault_of(WH_FAULT_AXIS_STOPPED, 0);
    bring(0, &stuck);
    bring(1, &stopped);
    step(880, CLOSED);
    command.grippers[1].valve = OPEN;
    step(890, CLOSED);
    assert_int_equal(answer.grippers[1].valve, CLOSED);
    assert_true(answer.grippers[0].base_from_gripper.r.z == 880);
}

/* A wafer that is taken at the fault's place is the gripper's, though it has not moved since. */
static void a_wafer_that_is_held_in_its_place_is_not_put_back(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    f.offset = wh_test_at(7, 0, 0);
    bring(0, &f);
    pick();
    const wh_pose_t placed = simulator.physics.faults.slots[0].placed;
    assert_memory_equal(&wafers[0].base_from_wafer, &placed, sizeof placed);
    f.until = command.seq + 1;
    bring(0, &f);
    step(900, OPEN);
    expect_event(WH_EVENT_FAULT_CLEARED, 0, WH_NONE, 0);
    assert_memory_equal(&wafers[0].base_from_wafer, &placed, sizeof placed);
    assert_int_equal(wafers[0].holder, 0);
    assert_int_equal(simulator.table.counters.refused, 0);
}

/* Shifts wafer 0; then gripper 0 takes it and puts it down at the same place, with the same bits. */
static void take_and_set_down(void) {
    const wh_pose_t placed = wafers[0].base_from_wafer;
    step(880, OPEN);
    step(900, OPEN);
    assert_int_equal(wafers[0].holder, 0);
    step(890, OPEN);
    step(900, CLOSED);
    assert_int_equal(wafers[0].holder, WH_NONE);
    assert_memory_equal(&wafers[0].base_from_wafer, &placed, sizeof placed);
    step(880, CLOSED);
}

/* A wafer that a gripper has put down stays there, even if it is exactly where the fault had put it. */
static void a_wafer_that_was_set_down_in_its_place_is_not_put_back(void **state) {
    (void)state;
    shift(2, 0);
    take_and_set_down();
    assert_int_equal(simulator.physics.faults.slots[2].phase, WH_FAULT_TAKEN);
    assert_int_equal(wh_physics_state_validate(&simulator.physics, GRIPPERS, WAFERS), WH_OK);
    clear_slot(2);
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_CLEARED, 0, WH_NONE, 2);
    assert_int_equal(simulator.physics.faults.slots[2].phase, WH_FAULT_OVER);
    assert_true(wafers[0].base_from_wafer.r.x == 703);
}

/* Taken and let go again within the fewest slices. */
static void a_wafer_that_was_held_for_one_slice_is_not_put_back(void **state) {
    (void)state;
    shift(0, 0);
    step(900, OPEN);
    step(900, CLOSED);
    assert_int_equal(wafers[0].holder, WH_NONE);
    expect_x_after_clearing(0, 703);
}

/* Neither fault moves back the wafer that was put down between them; a later one finds it at that place. */
static void a_fault_after_the_taking_puts_back_to_where_the_wafer_was_set_down(void **state) {
    (void)state;
    for (int order = 0; order < 2; ++order) {
        set_up(state);
        command.seq = 0;
        shift(1, 0);
        shift(2, 0);
        take_and_set_down();
        shift(0, 0);
        shift(3, 0);
        assert_true(wafers[0].base_from_wafer.r.x == 712);
        expect_x_after_clearing(order == 0 ? 1 : 2, 712);
        expect_x_after_clearing(order == 0 ? 2 : 1, 712);
        expect_x_after_clearing(order == 0 ? 3 : 0, order == 0 ? 709 : 712);
        expect_x_after_clearing(order == 0 ? 0 : 3, 706);
    }
}

/* The wafer is moved by hand, and moved back later; or it is moved to a place from which another
 * fault takes it to the old one. */
static void a_wafer_that_was_placed_by_hand_is_not_put_back(void **state) {
    (void)state;
    const wh_pose_t away = wh_test_at(700, 0, 900);
    shift(1, 0);
    const wh_pose_t placed = wafers[0].base_from_wafer;
    assert_int_equal(wh_grasp_place(&simulator.table, 0, &away), WH_OK);
    step(880, CLOSED);
    assert_int_equal(wh_grasp_place(&simulator.table, 0, &placed), WH_OK);
    step(880, CLOSED);
    expect_x_after_clearing(1, 703);
    set_up(state);
    command.seq = 0;
    shift(1, 0);
    assert_int_equal(wh_grasp_place(&simulator.table, 0, &away), WH_OK);
    shift(0, 0);
    assert_true(wafers[0].base_from_wafer.r.x == 703);
    expect_x_after_clearing(1, 703);
    expect_x_after_clearing(0, 700);
}

/* The end of a fault whose wafer was taken can still be changed, and its slot is not free before that. */
static void a_taken_wafers_fault_goes_on(void **state) {
    (void)state;
    shift(0, 0);
    take_and_set_down();
    wh_fault_t f = fault_of(WH_FAULT_SENSOR_ON, 0);
    bring(0, &f);
    assert_int_equal(try_step(880, CLOSED), WH_STATUS_OUT_OF_RANGE);
    f = simulator.physics.faults.slots[0].fault;
    f.until = command.seq + 3;
    bring(0, &f);
    step(880, CLOSED);
    assert_null(find(WH_EVENT_FAULT_CLEARED));
    step(880, CLOSED);
    assert_null(find(WH_EVENT_FAULT_CLEARED));
    step(880, CLOSED);
    expect_event(WH_EVENT_FAULT_CLEARED, 0, WH_NONE, 0);
}

/* A wafer that is placed stays there: the fault is over at once, and its slot is free. */
static void a_placed_wafer_stays(void **state) {
    (void)state;
    wh_fault_t fault = wh_fault_make(WH_FAULT_WAFER_PLACED, 0, 0, 1, WH_FAULT_FOREVER);
    for (int i = 0; i < 3; ++i) {
        fault.offset = wh_test_at(10 * i, 20, 500);
        fault.from = command.seq + 1;
        bring(15, &fault);
        step(880, CLOSED);
        expect_event(WH_EVENT_FAULT_ARMED, 0, WH_NONE, 15);
        assert_memory_equal(&answer.wafers[0].base_from_wafer, &fault.offset, sizeof fault.offset);
        assert_int_equal(simulator.physics.faults.slots[15].phase, WH_FAULT_OVER);
    }
    step(880, CLOSED);
    assert_int_equal(answer.event_count, 0);
    assert_memory_equal(&answer.wafers[0].base_from_wafer, &fault.offset, sizeof fault.offset);
}

/* The steps of a handshake have numbers from 1. */
static void a_handshakes_fault_names_its_step(void **state) {
    (void)state;
    wh_fault_t fault = wh_fault_make(WH_FAULT_E84_STUCK, 0, 0, 1, 9);
    for (int32_t step = -1; step < 8; ++step) {
        fault.other = step;
        assert_int_equal(wh_fault_validate(&fault, GRIPPERS, WAFERS),
                         step >= 1 && step <= WH_FAULT_E84_STEPS ? WH_OK : WH_STATUS_OUT_OF_RANGE);
    }
}

static void a_held_wafer_is_waited_for(void **state) {
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(faults_have_names, set_up),
        cmocka_unit_test_setup(what_no_cell_can_have_is_refused, set_up),
        cmocka_unit_test_setup(only_a_wafers_fault_has_an_offset, set_up),
        cmocka_unit_test_setup(faults_are_made_ready_to_be_taken, set_up),
        cmocka_unit_test_setup(values_have_their_ranges, set_up),
        cmocka_unit_test_setup(the_ends_of_the_ranges, set_up),
        cmocka_unit_test_setup(no_offset_takes_a_wafer_out_of_the_numbers, set_up),
        cmocka_unit_test_setup(faults_take_slots, set_up),
        cmocka_unit_test_setup(a_refused_input_brings_no_fault, set_up),
        cmocka_unit_test_setup(a_fault_acts_from_and_until, set_up),
        cmocka_unit_test_setup(an_end_that_has_passed, set_up),
        cmocka_unit_test_setup(a_slot_that_is_used_again_is_new, set_up),
        cmocka_unit_test_setup(a_fault_that_never_begins, set_up),
        cmocka_unit_test_setup(a_fault_whose_slices_are_past, set_up),
        cmocka_unit_test_setup(no_vacuum, set_up),
        cmocka_unit_test_setup(leak, set_up),
        cmocka_unit_test_setup(a_neighbours_faults_do_not_count, set_up),
        cmocka_unit_test_setup(only_while_it_acts, set_up),
        cmocka_unit_test_setup(several_at_one_gripper, set_up),
        cmocka_unit_test_setup(sensor_off, set_up),
        cmocka_unit_test_setup(a_valve_stuck, set_up),
        cmocka_unit_test_setup(axes_stopped, set_up),
        cmocka_unit_test_setup(a_command_lost, set_up),
        cmocka_unit_test_setup(in_the_first_slice_nothing_was_before, set_up),
        cmocka_unit_test_setup(a_wafer_is_moved_and_put_back, set_up),
        cmocka_unit_test_setup(a_turn_that_just_passes_is_mended, set_up),
        cmocka_unit_test_setup(doubled_is_onto_the_other, set_up),
        cmocka_unit_test_setup(a_placed_wafer_stays, set_up),
        cmocka_unit_test_setup(a_handshakes_fault_names_its_step, set_up),
        cmocka_unit_test_setup(doubled_waits_while_the_other_is_held, set_up),
        cmocka_unit_test_setup(a_wafer_that_was_taken_is_not_put_back, set_up),
        cmocka_unit_test_setup(two_faults_of_one_wafer, set_up),
        cmocka_unit_test_setup(three_faults_of_one_wafer_among_others, set_up),
        cmocka_unit_test_setup(faults_overrule_grippers_each_in_turn, set_up),
        cmocka_unit_test_setup(a_wafer_that_is_held_in_its_place_is_not_put_back, set_up),
        cmocka_unit_test_setup(a_wafer_that_was_set_down_in_its_place_is_not_put_back, set_up),
        cmocka_unit_test_setup(a_wafer_that_was_held_for_one_slice_is_not_put_back, set_up),
        cmocka_unit_test_setup(a_fault_after_the_taking_puts_back_to_where_the_wafer_was_set_down, set_up),
        cmocka_unit_test_setup(a_wafer_that_was_placed_by_hand_is_not_put_back, set_up),
        cmocka_unit_test_setup(a_taken_wafers_fault_goes_on, set_up),
        cmocka_unit_test_setup(a_held_wafer_is_waited_for, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
