/* Doors in a simulator: they follow their axes, faults hold them, and the state contains all of it. */
#include "support/faults.h"

#include "sim/snapshot.h"

enum { DOORS = 2, FIRST = 4 };

static wh_door_t doors[DOORS];
static const wh_door_set_t set = {doors, DOORS, FIRST};

/* Door 0 is shut at home, door 1 open; each moves 100 mm, at most 200 mm/s: 0.2 mm per slice. */
static int set_up_doors(void **state) {
    set_up(state);
    for (int d = 0; d < DOORS; ++d) {
        doors[d] = (wh_door_t){{0, 0, 1}, 100, d == 1, {200, 800, 8000}};
    }
    assert_int_equal(wh_simulator_set_doors(&simulator, &set), WH_OK);
    command.axis_count = FIRST + DOORS;
    command.axes[FIRST + 1] = 100;
    return 0;
}

static void go(double first, double second) {
    command.axes[FIRST] = (wh_real_t)first;
    command.axes[FIRST + 1] = (wh_real_t)second;
    step(880, CLOSED);
}

static const wh_real_t *at(void) {
    return simulator.physics.doors.at;
}

static void doors_begin_at_home(void **state) {
    (void)state;
    assert_int_equal(simulator.physics.doors.count, DOORS);
    assert_near(at()[0], 0, 0);
    assert_near(at()[1], 100, 0);
    assert_near(wh_door_pose(&doors[0], 40).r.z, 40, 0);
}

/* The order of the calls does not matter: physics that come later leave the doors at home. */
static void doors_stay_when_physics_come_later(void **state) {
    (void)state;
    const wh_physics_t physics = wh_physics_default();
    assert_int_equal(wh_simulator_set_physics(&simulator, &physics), WH_OK);
    doors_begin_at_home(state);
    go(0.2, 99.8);
    assert_near(at()[0], WH_REAL(0.2), 0);
    assert_near(at()[1], WH_REAL(99.8), 0);
}

static void a_door_follows_its_axis_to_the_bit(void **state) {
    (void)state;
    for (int i = 1; i <= 10; ++i) {
        go(0.17 * i, 100 - 0.19 * i);
        assert_true(at()[0] == command.axes[FIRST] && at()[1] == command.axes[FIRST + 1]);
    }
}

static void a_stuck_door_stays_and_comes_after(void **state) {
    (void)state;
    wh_fault_t fault = fault_of(WH_FAULT_DOOR_STUCK, 0);
    fault.until = command.seq + 11;
    bring(0, &fault);
    for (int i = 1; i <= 10; ++i) {
        go(0.2 * i, 100);
        assert_near(at()[0], 0, 0);
    }
    for (int i = 1; i <= 10; ++i) {
        go(2, 100);
        assert_near(at()[0], i < 10 ? 0.2 * 1.001 * i : 2, 1e-4);
    }
    assert_near(at()[1], 100, 0);
}

static void a_slow_door_goes_as_fast_as_its_fault_says(void **state) {
    (void)state;
    wh_fault_t fault = wh_fault_make(WH_FAULT_DOOR_SLOW, 1, 50, 1, WH_FAULT_FOREVER);
    bring(3, &fault);
    for (int i = 1; i <= 20; ++i) {
        go(0, 100 - 0.2 * i);
        assert_near(at()[1], 100 - 0.05 * i, 1e-4);
    }
}

static void a_lost_command_keeps_all_doors(void **state) {
    (void)state;
    bring_kind(WH_FAULT_COMMAND_LOST, WH_NONE);
    go(0.2, 99.8);
    assert_near(at()[0], 0, 0);
    assert_near(at()[1], 100, 0);
}

/* A command without the doors' axes moves none. */
static void a_command_without_their_axes_keeps_them(void **state) {
    (void)state;
    command.axis_count = FIRST;
    go(0.2, 99.8);
    assert_near(at()[0], 0, 0);
    assert_near(at()[1], 100, 0);
}

static void the_hash_has_the_doors_that_are_not_shut(void **state) {
    (void)state;
    const uint64_t one_open = wh_simulator_hash(&simulator);
    simulator.physics.doors.at[1] = 0;
    const uint64_t both_shut = wh_simulator_hash(&simulator);
    assert_true(one_open != both_shut);
    assert_true(both_shut == wh_grasp_hash(&simulator.table));
    simulator.physics.doors.at[0] = 100;
    assert_true(wh_simulator_hash(&simulator) != both_shut && wh_simulator_hash(&simulator) != one_open);
}

/* Entries that belong to nobody are neither hashed nor taken over: otherwise a state would count
 * less than it is. */
static void a_simulator_takes_no_state_of_what_it_was_not_given(void **state) {
    (void)state;
    const wh_physics_state_t good = simulator.physics;
    wh_physics_state_t bad[5] = {good, good, good, good, good};
    assert_true(wh_simulator_hash(&simulator) == wh_physics_state_hash(&good, &simulator.table));
    assert_true(wh_simulator_may_have(&simulator, &good));
    bad[0].doors.count = DOORS - 1;
    bad[1].doors.count = 0;
    bad[2].scan.number = 1;
    bad[3].latches.number = 1;
    bad[4].grips[GRIPPERS - 1].phase = WH_GRIP_CLOSED;
    for (int i = 0; i < 5; ++i) {
        assert_false(wh_simulator_may_have(&simulator, &bad[i]));
    }
    set_up(state);
    assert_null(simulator.given.hash);
    assert_false(wh_simulator_may_have(&simulator, &good));
    assert_true(wh_simulator_may_have(&simulator, &bad[1]));
    assert_true(wh_simulator_hash(&simulator) == wh_physics_state_hash(&simulator.physics, &simulator.table));
}

static void states_that_no_doors_have_are_refused(void **state) {
    (void)state;
    const wh_physics_state_t good = simulator.physics;
    wh_physics_state_t bad[5] = {good, good, good, good, good};
    assert_int_equal(wh_physics_state_validate(&good, GRIPPERS, WAFERS), WH_OK);
    bad[0].doors.count = WH_DOORS + 1;
    bad[1].doors.count = -1;
    bad[2].doors.at[0] = (wh_real_t)NAN;
    bad[3].doors.at[1] = -1;
    bad[4].doors.at[DOORS] = 1;
    for (int i = 0; i < 5; ++i) {
        assert_int_not_equal(wh_physics_state_validate(&bad[i], GRIPPERS, WAFERS), WH_OK);
    }
}

static void a_snapshot_brings_them_back(void **state) {
    (void)state;
    static uint8_t bytes[WH_SNAPSHOT_SIZE(WAFERS, GRIPPERS)];
    static wh_wafer_t room_wafers[WAFERS];
    static wh_gripper_t room_grippers[GRIPPERS];
    static wh_snapshot_room_t room;
    size_t size = 0;
    go(0.1, 99.9);
    const uint64_t hash = wh_simulator_hash(&simulator);
    assert_int_equal(wh_simulator_save(&simulator, bytes, sizeof bytes, &size), WH_OK);
    go(0.2, 99.7);
    assert_true(wh_simulator_hash(&simulator) != hash);
    room.wafers = room_wafers;
    room.grippers = room_grippers;
    assert_int_equal(wh_simulator_load(&simulator, bytes, size, &room), WH_OK);
    assert_true(wh_simulator_hash(&simulator) == hash);
    assert_near(at()[0], 0.1, 1e-6);
}

/* More than eight, as many as there are axes for: their snapshot is longer, and has a version of its own, so that
 * programs which know fewer refuse it by name. */
static void many_doors_come_back_as_well(void **state) {
    (void)state;
    static wh_door_t all[WH_DOORS];
    static const wh_door_set_t many = {all, WH_DOORS, FIRST};
    static uint8_t bytes[WH_SNAPSHOT_SIZE(WAFERS, GRIPPERS)];
    static wh_wafer_t room_wafers[WAFERS];
    static wh_gripper_t room_grippers[GRIPPERS];
    static wh_snapshot_room_t room;
    size_t size = 0;
    for (int d = 0; d < WH_DOORS; ++d) {
        all[d] = (wh_door_t){{0, 0, 1}, 100, d % 2 == 1, {200, 800, 8000}};
    }
    assert_int_equal(wh_simulator_set_doors(&simulator, &many), WH_OK);
    simulator.physics.doors.at[WH_DOORS - 1] = WH_REAL(12.5);
    const uint64_t hash = wh_simulator_hash(&simulator);
    assert_int_equal(wh_simulator_save(&simulator, bytes, sizeof bytes, &size), WH_OK);
    assert_int_equal(bytes[6], WH_DOORS > 8 ? WH_SNAPSHOT_MANY : WH_SNAPSHOT_VERSION);
    assert_int_equal(size, wh_simulator_saved_size(&simulator));
    simulator.physics.doors.at[WH_DOORS - 1] = 0;
    assert_true(wh_simulator_hash(&simulator) != hash);
    room.wafers = room_wafers;
    room.grippers = room_grippers;
    assert_int_equal(wh_simulator_load(&simulator, bytes, size, &room), WH_OK);
    assert_true(wh_simulator_hash(&simulator) == hash);
    assert_near(simulator.physics.doors.at[WH_DOORS - 1], 12.5, 0);
}

static void doors_are_set_before_the_first_slice(void **state) {
    (void)state;
    const wh_door_set_t none = {NULL, 1, FIRST};
    const wh_door_set_t many = {doors, WH_DOORS + 1, FIRST};
    assert_int_equal(wh_simulator_set_doors(&simulator, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_set_doors(&simulator, &none), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_simulator_set_doors(&simulator, &many), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(simulator.physics.doors.count, DOORS);
    go(0, 100);
    assert_int_equal(wh_simulator_set_doors(&simulator, &set), WH_STATUS_OUT_OF_RANGE);
}

static void faults_of_doors_name_one(void **state) {
    (void)state;
    wh_fault_t fault = fault_of(WH_FAULT_DOOR_STUCK, WH_DOORS - 1);
    assert_int_equal(wh_fault_validate(&fault, 0, 0), WH_OK);
    fault.target = WH_DOORS;
    assert_int_not_equal(wh_fault_validate(&fault, 9, 9), WH_OK);
    fault = wh_fault_make(WH_FAULT_DOOR_SLOW, 0, WH_REAL(10001), 1, 2);
    assert_int_not_equal(wh_fault_validate(&fault, 9, 9), WH_OK);
    assert_true(wh_fault_is_of_door(WH_FAULT_DOOR_SLOW) && !wh_fault_is_of_wafer(WH_FAULT_DOOR_SLOW));
    bring_kind(WH_FAULT_DOOR_STUCK, 1);
    step(880, CLOSED);
    assert_int_equal(find(WH_EVENT_FAULT_ARMED)->gripper, WH_NONE);
}

int main(void) {
#define TEST(name) cmocka_unit_test_setup(name, set_up_doors)
    const struct CMUnitTest tests[] = {
        TEST(doors_begin_at_home),
        TEST(doors_stay_when_physics_come_later),
        TEST(a_door_follows_its_axis_to_the_bit),
        TEST(a_stuck_door_stays_and_comes_after),
        TEST(a_slow_door_goes_as_fast_as_its_fault_says),
        TEST(a_lost_command_keeps_all_doors),
        TEST(a_command_without_their_axes_keeps_them),
        TEST(the_hash_has_the_doors_that_are_not_shut),
        TEST(a_simulator_takes_no_state_of_what_it_was_not_given),
        TEST(states_that_no_doors_have_are_refused),
        TEST(a_snapshot_brings_them_back),
        TEST(many_doors_come_back_as_well),
        TEST(doors_are_set_before_the_first_slice),
        TEST(faults_of_doors_name_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
