/* Faults on purpose in the simulator: their names, what is refused, when they begin and end. */
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

/* An offset that is none of a wafer's says nothing: a fault that has one is a mistake, as with a wrong `other`. */
static void only_a_wafers_fault_has_an_offset(void **state) {
    (void)state;
    for (int kind = 0; kind < WH_FAULT_KINDS; ++kind) {
        const bool of_wafer = wh_fault_is_of_wafer((wh_fault_kind_t)kind);
        for (int entry = 0; entry < 5; ++entry) {
            wh_fault_t f = wh_fault_make((wh_fault_kind_t)kind, 0, WH_REAL(0.5), 1, 9);
            f.other = kind == WH_FAULT_WAFER_DOUBLED ? 1 : f.other;
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

/* As they are made, or with the one thing more that their kind needs, a cell takes them and they act. */
static void faults_are_made_ready_to_be_taken(void **state) {
    (void)state;
    for (int i = 0; i < WH_FAULT_KINDS; ++i) {
        const wh_fault_kind_t kind = (wh_fault_kind_t)i;
        assert_int_equal(set_up(NULL), 0);
        command.seq = 0;
        wh_fault_t fault = wh_fault_make(kind, 0, WH_REAL(0.5), 2, 4);
        fault.other = kind == WH_FAULT_WAFER_DOUBLED ? 1 : fault.other;
        assert_int_equal(wh_fault_validate(&fault, GRIPPERS, WAFERS), WH_OK);
        bring(3, &fault);
        step(880, CLOSED);
        assert_int_equal(answer.event_count, 0);
        step(880, CLOSED);
        expect_event(WH_EVENT_FAULT_ARMED, wh_fault_is_of_wafer(kind) ? 0 : WH_NONE,
                     wh_fault_is_of_wafer(kind) || kind == WH_FAULT_COMMAND_LOST ? WH_NONE : 0, 3);
        assert_true(kind != WH_FAULT_WAFER_MISSING || wafers[0].base_from_wafer.r.z == WH_REAL(900 - 1e5));
        step(880, CLOSED);
        step(880, CLOSED);
        assert_non_null(find(WH_EVENT_FAULT_CLEARED));
    }
}

static void values_have_their_ranges(void **state) {
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

/* Where numbers end, too, a wafer that faults move stays where a table can have it. */
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

/* Told late that it was to end long ago, it ends now. */
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

/* Nothing is left of the fault that a slot had before. */
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

/* A new one whose slices are past is taken, and is over in that slice: no event, nothing acts. */
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

/* One that is cleared before it began was never there, for whoever reads events. */
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
