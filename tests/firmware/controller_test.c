/* An example to copy: tests of the firmware in controller.c. bench.h simulates the machine around it, here with cmocka. */
#include "with_cmocka.h"

/* -------------------------------------------------------------------------------------------------- good commands */

static void a_wafer_goes_from_slot_to_slot(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    assert_held(0);
    assert_said("picked: wafer 0, gripper 0: |dr_proj_z| 0.4");
    assert_int_equal(put(1, 1), CONTROLLER_READY);
    assert_lies_in(0, 1, 1);
    assert_int_equal(get(1, 2), CONTROLLER_READY);
    assert_held(1);
    assert_int_equal(put(0, 3), CONTROLLER_READY);
    assert_lies_in(1, 0, 3);
    assert_not_said("near miss");
    assert_not_said("unsupported");
    assert_not_said("occupied");
    assert_not_said("off centre");
}

/* The switch comes on some time after the blade touches the wafer. The arm must wait for it. */
static void a_get_waits_for_the_vacuum(void **unused) {
    (void)unused;
    int64_t touched = 0;
    int64_t sensed = 0;
    assert_int_equal(controller_get(&controller, 0, 1), CONTROLLER_BUSY);
    while (controller.phase != RETRACT) {
        tick();
        touched = touched == 0 && wafers[0].holder == 0 ? command.seq : touched;
        sensed = sensed == 0 && registers.sensor ? command.seq : sensed;
    }
    assert_true(touched > 0 && sensed > touched + 40);
    assert_true(command.seq > sensed);
}

/* A pump three times as slow is still in time. */
static void a_slower_pump_is_waited_for(void **unused) {
    (void)unused;
    break_it(WH_FAULT_SLOW_VACUUM, WH_REAL(0.3));
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    assert_held(0);
}

/* ---------------------------------------------------------------------------------------------- commands that fail */

static void what_cannot_be_done_is_refused_at_once(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 0), ERROR_NO_SUCH_SLOT);
    assert_int_equal(get(0, 4), ERROR_NO_SUCH_SLOT);
    assert_int_equal(get(2, 1), ERROR_NO_SUCH_SLOT);
    assert_int_equal(put(0, 2), ERROR_NO_WAFER);
    assert_int_equal(controller_get(&controller, 0, 1), CONTROLLER_BUSY);
    assert_int_equal(controller_put(&controller, 1, 1), ERROR_BUSY);
    assert_int_equal(finish(CONTROLLER_BUSY), CONTROLLER_READY);
    assert_int_equal(get(1, 2), ERROR_WAFER_ON_BLADE);
}

static void an_empty_slot_is_found_empty(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 2), ERROR_NOT_TAKEN);
    assert_int_equal(controller.phase, IDLE);
    assert_false(registers.vacuum_on);
    assert_int_equal(get(0, 1), CONTROLLER_READY); /* the next command works */
}

/* The slot was taught 55 mm short. The stroke misses the wafer, and Waferhand names the cause. */
static void a_badly_taught_slot_is_explained(void **unused) {
    (void)unused;
    taught[0].reach = 645;
    assert_int_equal(get(0, 1), ERROR_NOT_TAKEN);
    assert_said("near miss: wafer 0, gripper 0: |dr_proj_xy| 55.000 is not below 50 (by 5.000 mm)");
    assert_lies_in(0, 0, 1);
}

/* The wafer lies on the blade even without vacuum. The arm must put it back instead of dragging it along. */
static void a_dead_pump_leaves_the_wafer_in_its_slot(void **unused) {
    (void)unused;
    break_it(WH_FAULT_NO_VACUUM, 0);
    assert_int_equal(get(0, 1), ERROR_NOT_TAKEN);
    assert_said("fault armed: gripper 0: no_vacuum, fault 0");
    assert_lies_in(0, 0, 1);
    mend_it();
    assert_int_equal(get(0, 1), CONTROLLER_READY);
}

static void a_pump_that_is_too_slow_ends_the_get(void **unused) {
    (void)unused;
    break_it(WH_FAULT_SLOW_VACUUM, 2);
    assert_int_equal(get(0, 1), ERROR_NOT_TAKEN);
    assert_lies_in(0, 0, 1);
}

static void a_switch_that_stays_off_ends_the_get(void **unused) {
    (void)unused;
    break_it(WH_FAULT_SENSOR_OFF, 0);
    assert_int_equal(get(0, 1), ERROR_NOT_TAKEN);
    assert_lies_in(0, 0, 1);
}

static void a_switch_that_stays_on_forbids_the_get(void **unused) {
    (void)unused;
    break_it(WH_FAULT_SENSOR_ON, 0);
    tick();
    assert_int_equal(get(0, 1), ERROR_WAFER_ON_BLADE);
}

/* The arm stops where it is; the wafer still rests on the blade. */
static void a_leak_on_the_way_stops_the_arm(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    break_it(WH_FAULT_LEAK, WH_REAL(0.2));
    assert_int_equal(put(1, 1), ERROR_WAFER_LOST);
    assert_said("vacuum lost: wafer 0, gripper 0: ");
    assert_true(registers.axis[THETA] < 90);
    assert_held(0);
}

/* The valve does not shut. The arm must not go down and away while a wafer still hangs on it. */
static void a_stuck_valve_ends_the_put_in_the_slot(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    break_it(WH_FAULT_VALVE_STUCK, 0);
    assert_int_equal(put(1, 1), ERROR_NOT_LEFT);
    assert_held(0);
    assert_true(registers.axis[Z] > 900);
}

/* No switch tells the firmware that a slot is taken. The test sees it. */
static void a_put_onto_a_wafer_is_seen_from_outside(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    assert_int_equal(put(1, 2), CONTROLLER_READY);
    assert_said("slot occupied: wafer 0, gripper 0: wafer 1 lies in that slot");
}

static void a_put_beside_the_middle_is_seen_from_outside(void **unused) {
    (void)unused;
    taught[1].reach = 698;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    assert_int_equal(put(1, 1), CONTROLLER_READY);
    assert_said("placed off centre: wafer 0, gripper 0: 2.000 mm beside the centre (limit 0.5 mm)");
}

/* ------------------------------------------------------------------------------------------------------ a snapshot */

/* All that the test has: a copy of it is a moment to which it can go back. */
typedef struct {
    wh_simulator_t machine;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[1];
    wh_command_t command;
    controller_t controller;
    registers_t registers;
} moment_t;

static void save(moment_t *moment) {
    moment->machine = machine;
    memcpy(moment->wafers, wafers, sizeof wafers);
    memcpy(moment->grippers, grippers, sizeof grippers);
    moment->command = command;
    moment->controller = controller;
    moment->registers = registers;
}

static void go_back_to(const moment_t *moment) {
    machine = moment->machine;
    memcpy(wafers, moment->wafers, sizeof wafers);
    memcpy(grippers, moment->grippers, sizeof grippers);
    command = moment->command;
    controller = moment->controller;
    registers = moment->registers;
}

static void begin_get_up_to_the_switch(void) {
    assert_int_equal(controller_get(&controller, 0, 1), CONTROLLER_BUSY);
    while (controller.phase != SWITCH) {
        tick();
    }
}

/* The way to the slot is simulated once; each fault is then tried from that state. */
static void many_faults_are_tried_from_one_moment(void **unused) {
    (void)unused;
    static const wh_fault_kind_t kinds[] = {WH_FAULT_NO_VACUUM, WH_FAULT_SENSOR_OFF, WH_FAULT_COMMAND_LOST};
    static const answer_t answers[] = {ERROR_NOT_TAKEN, ERROR_NOT_TAKEN, ERROR_NOT_TAKEN};
    static moment_t before;
    begin_get_up_to_the_switch();
    save(&before);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        go_back_to(&before);
        break_it(kinds[i], 0);
        assert_int_equal(finish(CONTROLLER_BUSY), answers[i]);
    }
}

/* A machine that went back to a moment ends as one that went on, to the bit. */
static void a_moment_goes_on_as_it_did(void **unused) {
    (void)unused;
    static moment_t before;
    static moment_t after;
    begin_get_up_to_the_switch();
    save(&before);
    assert_int_equal(finish(CONTROLLER_BUSY), CONTROLLER_READY);
    save(&after);
    break_it(WH_FAULT_LEAK, WH_REAL(0.2));
    assert_int_equal(put(1, 1), ERROR_WAFER_LOST);
    go_back_to(&before);
    assert_int_equal(finish(CONTROLLER_BUSY), CONTROLLER_READY);
    wh_grasp_t expected = after.machine.table;
    expected.storage.wafers = after.wafers;
    expected.storage.grippers = after.grippers;
    assert_same_table(&expected);
    assert_true(wh_simulator_hash(&machine) == wh_simulator_hash(&after.machine));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_wafer_goes_from_slot_to_slot, set_up),
        cmocka_unit_test_setup(a_get_waits_for_the_vacuum, set_up),
        cmocka_unit_test_setup(a_slower_pump_is_waited_for, set_up),
        cmocka_unit_test_setup(what_cannot_be_done_is_refused_at_once, set_up),
        cmocka_unit_test_setup(an_empty_slot_is_found_empty, set_up),
        cmocka_unit_test_setup(a_badly_taught_slot_is_explained, set_up),
        cmocka_unit_test_setup(a_dead_pump_leaves_the_wafer_in_its_slot, set_up),
        cmocka_unit_test_setup(a_pump_that_is_too_slow_ends_the_get, set_up),
        cmocka_unit_test_setup(a_switch_that_stays_off_ends_the_get, set_up),
        cmocka_unit_test_setup(a_switch_that_stays_on_forbids_the_get, set_up),
        cmocka_unit_test_setup(a_leak_on_the_way_stops_the_arm, set_up),
        cmocka_unit_test_setup(a_stuck_valve_ends_the_put_in_the_slot, set_up),
        cmocka_unit_test_setup(a_put_onto_a_wafer_is_seen_from_outside, set_up),
        cmocka_unit_test_setup(a_put_beside_the_middle_is_seen_from_outside, set_up),
        cmocka_unit_test_setup(many_faults_are_tried_from_one_moment, set_up),
        cmocka_unit_test_setup(a_moment_goes_on_as_it_did, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
