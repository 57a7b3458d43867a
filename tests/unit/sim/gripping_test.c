/* A simulator whose gripper has an edge grip: its sensor, its faults, and that a step depends on
 * its state alone. */
#include "support/pose.h"

#include "sim/snapshot.h"

enum { OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED, STROKE = 310 };

/* One simulator with all that belongs to it. */
typedef struct {
    wh_simulator_t simulator;
    wh_wafer_t wafer;
    wh_gripper_t gripper;
    wh_wafer_t seen;
} run_t;

static wh_station_t station;
static wh_pose_t support;
static wh_grip_t grip;
static wh_edge_wafer_t shape;
static run_t run, twin;
static wh_command_t command;
static wh_state_t answer;

static void begin_with(run_t *of, wh_grip_kind_t kind, double x, double y) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {&of->wafer, 1, &of->gripper, 1, NULL, 0};
    const wh_cell_t cell = {.stations = &station, .count = 1, .tolerance = wh_tolerance_paper()};
    const wh_grips_parts_t parts = {.dt = 0.001,
                                    .grips = &grip,
                                    .shapes = &shape,
                                    .seen = &of->seen,
                                    .supports = &support,
                                    .support_count = 1};
    memset(of, 0x5a, sizeof *of);
    station = (wh_station_t){wh_test_at(700, 0, 900), 1, 10, WH_NONE};
    of->wafer.base_from_wafer = wh_test_at(700 + x, y, 900);
    support = wh_station_slot(&station, 1);
    grip = (wh_grip_t){kind, wh_edge_default(150)};
    shape = wh_edge_wafer_nominal(150);
    assert_int_equal(wh_simulator_init(&of->simulator, &config, &storage, &cell), WH_OK);
    assert_int_equal(wh_simulator_set_grips(&of->simulator, &parts), WH_OK);
    memset(&command, 0, sizeof command);
    command.gripper_count = 1;
    command.grippers[0].base_from_gripper = wh_test_at(700, 0, 900);
}

static void begin(run_t *of, double x, double y) {
    begin_with(of, WH_GRIP_EDGE, x, y);
}

static void step(run_t *of, int valve) {
    ++command.seq;
    command.grippers[0].valve = valve;
    assert_int_equal(wh_simulator_step(&of->simulator, &command, &answer), WH_OK);
    command.fault_count = 0;
}

static void steps(run_t *of, int count, int valve) {
    for (int i = 0; i < count; ++i) {
        step(of, valve);
    }
}

static const wh_grip_state_t *state_of(const run_t *of) {
    return &of->simulator.physics.grips[0];
}

static void arm(wh_fault_kind_t kind, double value, int64_t lasting) {
    const int64_t from = command.seq + 1;
    command.fault_count = 1;
    command.faults[0].index = 0;
    command.faults[0].fault = wh_fault_make(kind, 0, (wh_real_t)value, from, from + lasting);
}

static void a_plunger_that_stands_in_its_window_puts_the_sensor_on(void **state) {
    (void)state;
    begin(&run, 0.5, -1);
    step(&run, CLOSED);
    assert_int_equal(state_of(&run)->phase, WH_GRIP_OPEN);
    for (int i = 0; i < STROKE; ++i) {
        step(&run, OPEN);
        const bool is_held = state_of(&run)->phase == WH_GRIP_CLOSED;
        assert_int_equal(answer.sensors, is_held ? 1 : 0);
        assert_int_equal(run.gripper.wafer, 0);
    }
    assert_int_equal(state_of(&run)->phase, WH_GRIP_CLOSED);
    assert_near(run.gripper.gripper_from_wafer.r.x, 0, 1e3 * WH_TEST_ROUNDING);
    assert_near(run.gripper.gripper_from_wafer.r.y, 0, 1e3 * WH_TEST_ROUNDING);
    step(&run, CLOSED);
    assert_int_equal(run.gripper.wafer, WH_NONE);
    assert_int_equal(answer.sensors, 0);
    steps(&run, STROKE, CLOSED);
    assert_int_equal(state_of(&run)->phase, WH_GRIP_OPEN);
}

static void a_jam_and_a_miss_leave_the_wafer_and_the_sensor(void **state) {
    (void)state;
    begin(&run, -3, 0);
    steps(&run, STROKE, OPEN);
    assert_int_equal(state_of(&run)->phase, WH_GRIP_JAMMED);
    assert_near(state_of(&run)->excess, 0.5, 1e3 * WH_TEST_ROUNDING);
    assert_int_equal(answer.sensors, 0);
    begin(&run, 20, 0);
    steps(&run, STROKE, OPEN);
    assert_int_equal(state_of(&run)->phase, WH_GRIP_MISSED);
    assert_int_equal(answer.sensors, 0);
    assert_near(run.wafer.base_from_wafer.r.x, 720, WH_TEST_ROUNDING);
}

static void a_stuck_plunger_neither_closes_nor_lets_go(void **state) {
    (void)state;
    begin(&run, 0, 0);
    arm(WH_FAULT_PLUNGER_STUCK, 0, 100);
    steps(&run, 100, OPEN);
    assert_near(state_of(&run)->s, -8, 1e-12);
    steps(&run, STROKE, OPEN);
    assert_int_equal(state_of(&run)->phase, WH_GRIP_CLOSED);
    arm(WH_FAULT_PLUNGER_STUCK, 0, 50);
    steps(&run, 50, CLOSED);
    assert_int_equal(run.gripper.wafer, 0);
    assert_int_equal(answer.sensors, 1);
    step(&run, CLOSED);
    assert_int_equal(run.gripper.wafer, WH_NONE);
}

/* Sums of steps, mm. */
static const double exact = sizeof(wh_real_t) == sizeof(double) ? 1e-9 : 1e-3;

static void a_slow_plunger_goes_as_fast_as_its_fault_lets_it(void **state) {
    (void)state;
    begin(&run, 0, 0);
    arm(WH_FAULT_PLUNGER_SLOW, 10, 200);
    steps(&run, 201, OPEN);
    assert_near(state_of(&run)->s, -8 + 199 * 0.01 + 0.04, exact);
    arm(WH_FAULT_PLUNGER_SLOW, 1e4, 10);
    const double before = state_of(&run)->s;
    steps(&run, 2, OPEN);
    assert_near(state_of(&run)->s, before + 2 * 0.04, exact);
}

/* It is saved in each slice of the plunger's way and read by a second simulator: both continue with
 * the same hash. */
static void a_snapshot_has_all_of_a_plunger_on_its_way(void **state) {
    (void)state;
    static uint8_t bytes[WH_SNAPSHOT_SIZE(1, 1)];
    static wh_wafer_t wafers[1];
    static wh_gripper_t grippers[1];
    static wh_snapshot_room_t room = {.wafers = wafers, .grippers = grippers};
    begin(&run, -0.7, 1.1);
    for (int i = 0; i < STROKE; ++i) {
        size_t size = 0;
        step(&run, i < 270 ? OPEN : CLOSED);
        assert_int_equal(wh_simulator_save(&run.simulator, bytes, sizeof bytes, &size), WH_OK);
        const wh_command_t kept = command;
        begin(&twin, 0, 0);
        command = kept;
        assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
        assert_true(wh_simulator_hash(&twin.simulator) == wh_simulator_hash(&run.simulator));
        step(&twin, i < 269 ? OPEN : CLOSED);
        command = kept;
        const uint64_t next = wh_simulator_hash(&twin.simulator);
        run_t ahead = run;
        const wh_grasp_storage_t storage = {&ahead.wafer, 1, &ahead.gripper, 1, NULL, 0};
        assert_int_equal(wh_simulator_relink(&ahead.simulator, &storage), WH_OK);
        step(&ahead, i < 269 ? OPEN : CLOSED);
        command = kept;
        assert_true(wh_simulator_hash(&ahead.simulator) == next);
    }
}

/* Saves `run`, loads the bytes into `twin`, and relinks a copy; each has the hash of `run`, and keeps it in the next
 * step. */
static void expect_equal_copies(int valve) {
    static uint8_t bytes[WH_SNAPSHOT_SIZE(1, 1)];
    static wh_wafer_t wafers[1];
    static wh_gripper_t grippers[1];
    static wh_snapshot_room_t room = {.wafers = wafers, .grippers = grippers};
    const wh_grip_t kept_grip = grip;
    const wh_command_t kept = command;
    run_t ahead = run;
    const wh_grasp_storage_t storage = {&ahead.wafer, 1, &ahead.gripper, 1, NULL, 0};
    size_t size = 0;
    assert_int_equal(wh_simulator_save(&run.simulator, bytes, sizeof bytes, &size), WH_OK);
    begin_with(&twin, kept_grip.kind, 0, 0);
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
    assert_int_equal(wh_simulator_relink(&ahead.simulator, &storage), WH_OK);
    command = kept;
    step(&twin, valve);
    command = kept;
    step(&ahead, valve);
    command = kept;
    step(&run, valve);
    assert_true(wh_simulator_hash(&twin.simulator) == wh_simulator_hash(&run.simulator));
    assert_true(wh_simulator_hash(&ahead.simulator) == wh_simulator_hash(&run.simulator));
}

static void what_holds_with_a_closed_valve_can_be_saved(void **state) {
    (void)state;
    begin(&run, 0, 0);
    steps(&run, STROKE, OPEN);
    arm(WH_FAULT_PLUNGER_STUCK, 0, 50);
    steps(&run, 20, CLOSED);
    assert_int_equal(run.gripper.wafer, 0);
    expect_equal_copies(CLOSED);
    begin_with(&run, WH_GRIP_PASSIVE, 0, 0);
    command.grippers[0].base_from_gripper.r.z = 899;
    for (int i = 0; i < 200; ++i) {
        command.grippers[0].base_from_gripper.r.z += 0.01;
        step(&run, CLOSED);
    }
    assert_int_equal(run.gripper.wafer, 0);
    expect_equal_copies(CLOSED);
}

/* The wafer that the blade held before leaves nothing in the state of a plunger that closes on none of its own. */
static void a_jam_after_a_hold_can_be_saved(void **state) {
    (void)state;
    begin(&run, 0.5, 0.3);
    steps(&run, STROKE, OPEN);
    steps(&run, STROKE, CLOSED);
    command.grippers[0].base_from_gripper.r.x += 5;
    steps(&run, 10, OPEN);
    assert_int_equal(run.gripper.wafer, WH_NONE);
    assert_int_equal(state_of(&run)->phase, WH_GRIP_CLOSING);
    assert_true(state_of(&run)->x == 0 && state_of(&run)->y == 0);
    begin(&run, 0.5, 0.3);
    steps(&run, STROKE, OPEN);
    steps(&run, STROKE, CLOSED);
    command.grippers[0].base_from_gripper.r.x += 5;
    expect_equal_copies(OPEN);
}

static void states_that_no_step_leaves_are_refused(void **state) {
    (void)state;
    begin(&run, 0, 0);
    steps(&run, 100, OPEN);
    const wh_grip_state_t good = *state_of(&run);
    const wh_grips_parts_t parts = run.simulator.given.grips.parts;
    wh_grip_state_t other = good;
    memset(&other.lying.radius, 0, sizeof other.lying.radius);
    assert_int_equal(wh_grips_complete(&parts, &run.gripper, 1, 1, &other), WH_OK);
    assert_memory_equal(&other, &good, sizeof other);
#define REFUSED(field, value, expected)                                                                      \
    other = good;                                                                                            \
    other.field = value;                                                                                     \
    assert_int_equal(wh_grips_complete(&parts, &run.gripper, 1, 1, &other), expected)
    REFUSED(phase, (wh_grip_phase_t)6, WH_STATUS_OUT_OF_RANGE);
    REFUSED(phase, WH_GRIP_JAMMED, WH_STATUS_OUT_OF_RANGE);
    REFUSED(phase, WH_GRIP_OPEN, WH_STATUS_OUT_OF_RANGE);
    REFUSED(wafer, 1, WH_STATUS_OUT_OF_RANGE);
    REFUSED(wafer, WH_NONE, WH_STATUS_OUT_OF_RANGE);
    REFUSED(s, 4.1, WH_STATUS_OUT_OF_RANGE);
    REFUSED(s, (double)NAN, WH_STATUS_NOT_FINITE);
    REFUSED(excess, 1, WH_STATUS_OUT_OF_RANGE);
    REFUSED(lying.x, 51, WH_STATUS_OUT_OF_RANGE);
    REFUSED(lying.notch_x, (double)INFINITY, WH_STATUS_NOT_FINITE);
    grip.kind = WH_GRIP_VACUUM;
    REFUSED(excess, 0, WH_STATUS_OUT_OF_RANGE);
    run.gripper.valve = CLOSED;
    REFUSED(phase, WH_GRIP_OPEN, WH_STATUS_OUT_OF_RANGE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plunger_that_stands_in_its_window_puts_the_sensor_on),
        cmocka_unit_test(a_jam_and_a_miss_leave_the_wafer_and_the_sensor),
        cmocka_unit_test(a_stuck_plunger_neither_closes_nor_lets_go),
        cmocka_unit_test(a_slow_plunger_goes_as_fast_as_its_fault_lets_it),
        cmocka_unit_test(a_snapshot_has_all_of_a_plunger_on_its_way),
        cmocka_unit_test(what_holds_with_a_closed_valve_can_be_saved),
        cmocka_unit_test(a_jam_after_a_hold_can_be_saved),
        cmocka_unit_test(states_that_no_step_leaves_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
