/* Scans of an edge sensor, slice by slice: each sample comes once, as the sensor reads it there;
 * orders that are refused; scans that end early; states that are copied, saved and hashed. */
#include "sim/scanning.h"

#include "math/hash.h"
#include "math/trig.h"
#include "sim/snapshot.h"
#include "support/pose.h"

enum { WAFERS = 2, GRIPPERS = 2, CHUCK = 1, MOST = 8000 };

typedef struct {
    wh_simulator_t simulator;
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    wh_command_t command;
    wh_state_t state;
    int32_t samples[MOST];
    int32_t count;
} run_t;

static run_t run, twin;
static wh_station_t station;
static wh_scanner_t scanner;
static wh_rim_t rim;
static wh_vec3_t lies_at;
static const wh_rim_t *const rims[WAFERS] = {&rim, &rim};

/* A chuck that holds wafer 0 once it is stepped, unless the wafer is face down. */
static void begin_turned(run_t *of, double slice_s, wh_mat3_t turn) {
    const wh_grasp_storage_t storage = {of->wafers, WAFERS, of->grippers, GRIPPERS, NULL, 0};
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_cell_t cell = {.stations = &station, .count = 1, .tolerance = config.tolerance};
    const wh_scanning_t scanning = {&scanner, 1, rims};
    wh_physics_t physics = wh_physics_default();
    physics.slice_s = (wh_real_t)slice_s;
    memset(of, 0, sizeof *of);
    station = (wh_station_t){{wh_test_rotation(0, 0, 1, 2.5), {400, -300, 900}}, 1, 10, CHUCK};
    const wh_pose_t lies = {turn, lies_at};
    of->wafers[0].base_from_wafer = wh_pose_compose(&station.base_from_station, &lies);
    of->wafers[1].base_from_wafer = wh_test_at(0, 0, 0);
    assert_int_equal(wh_simulator_init(&of->simulator, &config, &storage, &cell), WH_OK);
    assert_int_equal(wh_simulator_set_physics(&of->simulator, &physics), WH_OK);
    assert_int_equal(wh_simulator_set_scanning(&of->simulator, &scanning), WH_OK);
    of->command.gripper_count = GRIPPERS;
    of->command.grippers[0].base_from_gripper = wh_test_at(0, 0, 500);
    of->command.grippers[0].valve = WH_VALVE_CLOSED;
}

static void begin(run_t *of, double slice_s) {
    rim = wh_rim_nominal(150);
    lies_at = (wh_vec3_t){2, -1, 0};
    scanner =
        (wh_scanner_t){wh_sensor_nominal(150), CHUCK, 7, {wh_test_rotation(0, 0, 1, 2.5), {400, -300, 900}}};
    scanner.sensor.noise = 0.005;
    begin_turned(of, slice_s, wh_test_rotation(0, 0, 1, 0.4));
}

/* One slice with the chuck at this turn; keeps its samples. */
static wh_status_t step(run_t *of, double turn) {
    const wh_pose_t at = {wh_test_rotation(0, 0, 1, turn), {0, 0, 0}};
    ++of->command.seq;
    of->command.grippers[CHUCK].base_from_gripper = wh_pose_compose(&station.base_from_station, &at);
    const wh_status_t status = wh_simulator_step(&of->simulator, &of->command, &of->state);
    memset(&of->command.scan, 0, sizeof of->command.scan);
    const wh_scan_t *scan = &of->state.physics->scan;
    for (int32_t i = 0; status == WH_OK && i < scan->sample_count; ++i) {
        assert_true(of->count < MOST);
        of->samples[of->count++] = scan->samples[i];
    }
    return status;
}

static void arm(run_t *of, int64_t first, int32_t count) {
    of->command.scan = (wh_scan_order_t){WH_SCAN_ARM, CHUCK, count, first};
}

/* The chuck turns from 0 by `turn` in this number of slices. It is armed in the first of them, and
 * stands in that one. */
static const wh_scan_t *turn_by(run_t *of, double turn, int slices, int64_t first, int32_t count) {
    of->count = 0;
    arm(of, first, count);
    for (int i = 0; i <= slices; ++i) {
        assert_int_equal(step(of, turn * i / slices), WH_OK);
    }
    return &of->state.physics->scan;
}

static void each_sample_is_what_the_sensor_reads_there(void **state) {
    (void)state;
    begin(&run, 0.001);
    const wh_scan_t *scan = turn_by(&run, 2 * WH_TEST_PI + 0.01, 700, 1, 3600);
    assert_int_equal(run.grippers[CHUCK].wafer, 0);
    assert_int_equal(scan->taken, 3600);
    assert_false(scan->armed);
    assert_int_equal(run.count, 3600);
    const wh_placement_t placement = {2, -1, 0.4};
    for (int32_t k = 1; k <= 3600; ++k) {
        const wh_glance_t glance = {wh_sensor_angle(&scanner.sensor, k), 8.9, {7, 1}, (uint32_t)k - 1};
        const int32_t wanted = wh_sensor_read(&scanner.sensor, &rim, &placement, &glance);
        assert_in_range(run.samples[k - 1] - wanted + 1, 0, 2);
    }
}

static void slices_and_the_way_round_do_not_matter(void **state) {
    (void)state;
    begin(&run, 0.001);
    begin(&twin, 0.003);
    (void)turn_by(&run, 6.3, 1000, 5, 3000);
    (void)turn_by(&twin, 6.3, 431, 5, 3000);
    assert_int_equal(run.count, 3000);
    assert_int_equal(twin.count, 3000);
    assert_memory_equal(run.samples, twin.samples, 3000 * sizeof run.samples[0]);
    /* down, and a whole turn lower */
    scanner.sensor.noise = 0;
    begin_turned(&run, 0.001, wh_test_rotation(0, 0, 1, 0.4));
    begin_turned(&twin, 0.001, wh_test_rotation(0, 0, 1, 0.4));
    (void)turn_by(&run, 6.4, 1000, 1, 3599);
    (void)turn_by(&twin, -6.4, 1000, -1 - 3600, -3599);
    assert_int_equal(run.count, 3599);
    assert_int_equal(twin.count, 3599);
    for (int i = 0; i < 3599; ++i) {
        assert_in_range(run.samples[i] - twin.samples[3598 - i] + 1, 0, 2);
    }
}

static void noise_is_named_by_seed_and_number(void **state) {
    (void)state;
    begin(&run, 0.001);
    begin(&twin, 0.001);
    (void)turn_by(&run, 1, 200, 1, 500);
    (void)turn_by(&twin, 1, 200, 1, 500);
    assert_memory_equal(run.samples, twin.samples, 500 * sizeof run.samples[0]);
    assert_true(wh_simulator_hash(&run.simulator) == wh_simulator_hash(&twin.simulator));
    const wh_scan_t *second = turn_by(&twin, 1, 200, 1, 500);
    assert_int_equal(second->number, 2);
    assert_int_equal(twin.count, 500);
    assert_memory_not_equal(run.samples, twin.samples, 500 * sizeof run.samples[0]);
}

static void refuse(int32_t kind, int32_t gripper, int32_t count, int64_t first) {
    const uint64_t before = wh_simulator_hash(&run.simulator);
    run.command.scan = (wh_scan_order_t){(wh_scan_order_kind_t)kind, gripper, count, first};
    assert_int_equal(step(&run, 0), WH_STATUS_OUT_OF_RANGE);
    assert_true(wh_simulator_hash(&run.simulator) == before);
}

static void an_order_that_cannot_be_taken_changes_nothing(void **state) {
    (void)state;
    begin(&run, 0.001);
    refuse(WH_SCAN_ARM, 0, 100, 0);
    refuse(WH_SCAN_ARM, CHUCK, 0, 0);
    refuse(WH_SCAN_ARM, CHUCK, 36001, 0);
    refuse(WH_SCAN_ARM, CHUCK, INT32_MIN, 0);
    refuse(WH_SCAN_ARM, CHUCK, 100, 3600001);
    refuse(WH_SCAN_ARM, CHUCK, 100, INT64_MIN);
    refuse(3, 0, 0, 0);
    run.simulator.given.scans = NULL;
    refuse(WH_SCAN_ARM, CHUCK, 100, 0);
    refuse(WH_SCAN_DISARM, 0, 0, 0);
}

static void a_sensor_that_cannot_be_is_refused(void **state) {
    (void)state;
    begin(&run, 0.001);
    begin(&twin, 0.001);
    wh_scanner_t two[2] = {scanner, scanner};
    const wh_rim_t bad_rim = {.radius = 5};
    const wh_rim_t *const bad_rims[WAFERS] = {&rim, &bad_rim};
    assert_int_equal(wh_scanning_validate(&(wh_scanning_t){two, 2, rims}, GRIPPERS, WAFERS),
                     WH_STATUS_OUT_OF_RANGE);
    two[1].gripper = 0;
    assert_int_equal(wh_scanning_validate(&(wh_scanning_t){two, 2, rims}, GRIPPERS, WAFERS), WH_OK);
    assert_int_equal(wh_scanning_validate(&(wh_scanning_t){two, 2, rims}, 1, WAFERS), WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_scanning_validate(&(wh_scanning_t){two, 2, NULL}, GRIPPERS, WAFERS),
                     WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_scanning_validate(&(wh_scanning_t){two, 2, bad_rims}, GRIPPERS, WAFERS),
                     WH_STATUS_OUT_OF_RANGE);
    two[0].sensor.pixel = (double)NAN;
    assert_int_equal(wh_scanning_validate(&(wh_scanning_t){two, 1, rims}, GRIPPERS, WAFERS),
                     WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_scanning_validate(NULL, GRIPPERS, WAFERS), WH_STATUS_NULL_ARGUMENT);
    const wh_scanning_t none = {NULL, 0, NULL};
    assert_int_equal(wh_simulator_set_scanning(&run.simulator, &none), WH_OK);
    assert_null(run.simulator.given.scans);
    assert_int_equal(step(&twin, 0), WH_OK);
    assert_int_equal(wh_simulator_set_scanning(&twin.simulator, &none), WH_STATUS_OUT_OF_RANGE);
    twin.simulator.mark = 0;
    assert_int_equal(wh_simulator_set_scanning(&twin.simulator, &none), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_simulator_set_scanning(NULL, &none), WH_STATUS_NULL_ARGUMENT);
}

static void a_scan_that_is_too_fast_ends_early(void **state) {
    (void)state;
    begin(&run, 0.01);
    const wh_scan_t *scan = turn_by(&run, 0.5, 10, 1, 3600); /* 28 a slice */
    assert_int_equal(run.count, 286);
    assert_true(scan->armed);
    assert_int_equal(step(&run, 0.62), WH_OK); /* 69 */
    assert_false(scan->armed);
    assert_int_equal(scan->taken, 286);
    begin(&run, 0.0001);
    scan = turn_by(&run, 0.0101, 1, 1, 3600); /* 101 rad/s, 5 samples */
    assert_false(scan->armed);
    assert_int_equal(scan->taken, 0);
}

/* A chuck that turns the wrong way for ever is not followed for ever. */
static void a_scan_that_waits_in_vain_ends(void **state) {
    (void)state;
    begin(&run, 1);
    arm(&run, -3600 * 1000, 10);
    int slices = 0;
    do {
        assert_int_equal(step(&run, -0.5 * slices), WH_OK);
        assert_int_equal(wh_physics_state_validate(&run.simulator.physics, GRIPPERS, WAFERS), WH_OK);
        ++slices;
    } while (run.state.physics->scan.armed);
    assert_in_range(slices, 5000, 6000);
    assert_int_equal(run.count, 0);
}

static void a_chuck_that_stands_or_turns_back_gives_no_sample_twice(void **state) {
    (void)state;
    begin(&run, 0.01);
    (void)turn_by(&run, 0.1, 10, 1, 3600);
    assert_int_equal(run.count, 57);
    assert_int_equal(step(&run, 0.1), WH_OK);
    assert_int_equal(step(&run, 0.05), WH_OK);
    assert_int_equal(step(&run, 0.08), WH_OK);
    assert_int_equal(run.count, 57);
    assert_int_equal(step(&run, 0.12), WH_OK);
    assert_int_equal(run.count, 68);
    run.command.scan.kind = WH_SCAN_DISARM;
    assert_int_equal(step(&run, 0.13), WH_OK);
    assert_int_equal(run.count, 74);
    assert_int_equal(step(&run, 0.14), WH_OK);
    assert_int_equal(run.count, 74);
    assert_false(run.state.physics->scan.armed);
}

static void without_a_wafer_there_is_nothing_and_face_down_it_is_mirrored(void **state) {
    (void)state;
    begin(&run, 0.001);
    run.wafers[0].base_from_wafer.r.z += 20;
    const wh_scan_t *scan = turn_by(&run, 0.1, 20, 1, 50);
    assert_int_equal(scan->taken, 50);
    for (int i = 0; i < 50; ++i) {
        assert_int_equal(run.samples[i], 0);
    }
    /* A notch is seen when the chuck, turning clockwise, has brought it to direction 0. */
    scanner.sensor.noise = 0;
    rim.notch.direction = 0.3;
    lies_at = (wh_vec3_t){0, 0, 0};
    begin_turned(&run, 0.001, wh_test_rotation(0, 0, 1, 0.1));
    (void)turn_by(&run, -7, 1000, -1, -3600);
    int deepest = 0;
    for (int i = 1; i < run.count; ++i) {
        deepest = run.samples[i] < run.samples[deepest] ? i : deepest;
    }
    assert_int_equal(run.count, 3600);
    assert_true(fabs(deepest * 2 * WH_TEST_PI / 3600 - 0.4) < 0.01);
    /* A wafer that the chuck does not hold stays in its place: here its notch, mirrored, is below
     * the sensor. */
    const wh_mat3_t turned = wh_test_rotation(0, 0, 1, 0.3);
    const wh_mat3_t over = wh_test_rotation(1, 0, 0, WH_TEST_PI);
    begin_turned(&run, 0.001, wh_mat3_multiply(&turned, &over));
    (void)turn_by(&run, -7, 1000, -1, -3600);
    assert_int_equal(run.count, 3600);
    for (int i = 0; i < run.count; ++i) {
        assert_in_range(run.samples[i], 1856, 1858);
    }
}

/* The fault's command comes with the arming. */
static void bring(run_t *of, wh_fault_kind_t kind, double value) {
    of->command.fault_count = 1;
    of->command.faults[0].index = 0;
    of->command.faults[0].fault =
        wh_fault_make(kind, CHUCK, (wh_real_t)value, of->command.seq + 1, WH_FAULT_FOREVER);
}

static void a_sensor_that_a_fault_breaks_down_says_so(void **state) {
    (void)state;
    const double parts[] = {0, 0.5, 1};
    for (size_t i = 0; i < 3; ++i) {
        begin(&run, 0.001);
        bring(&run, WH_FAULT_EDGE_SENSOR_STUCK, parts[i]);
        arm(&run, 1, 100);
        assert_int_equal(step(&run, 0), WH_OK);
        run.command.fault_count = 0;
        for (int k = 1; k <= 40; ++k) {
            assert_int_equal(step(&run, 0.01 * k), WH_OK);
        }
        assert_int_equal(run.count, 100);
        for (int32_t k = 0; k < 100; ++k) {
            assert_int_equal(run.samples[k], (int32_t)(parts[i] * 4000));
        }
    }
}

/* The effect equals that of a latency that is longer by as much. */
static void a_sensor_that_a_fault_makes_late_reads_what_comes_later(void **state) {
    (void)state;
    begin(&run, 0.001);
    scanner.sensor.noise = 0;
    begin_turned(&run, 0.001, wh_test_rotation(0, 0, 1, 0.4));
    bring(&run, WH_FAULT_EDGE_SENSOR_LATE, 0.0005);
    (void)turn_by(&run, 1, 100, 1, 500);
    scanner.sensor.error.latency = 0.0005;
    begin_turned(&twin, 0.001, wh_test_rotation(0, 0, 1, 0.4));
    (void)turn_by(&twin, 1, 100, 1, 500);
    assert_true(run.count == 500 && twin.count == 500);
    for (int32_t k = 0; k < 500; ++k) {
        assert_in_range(run.samples[k] - twin.samples[k] + 1, 0, 2);
    }
}

static void a_run_without_a_scan_hashes_as_if_there_were_no_sensor(void **state) {
    (void)state;
    begin(&run, 0.001);
    begin(&twin, 0.001);
    twin.simulator.given.scans = NULL;
    for (int i = 0; i < 100; ++i) {
        assert_int_equal(step(&run, 0.02 * i), WH_OK);
        assert_int_equal(step(&twin, 0.02 * i), WH_OK);
        assert_true(wh_simulator_hash(&run.simulator) == wh_simulator_hash(&twin.simulator));
    }
    arm(&run, 1200, 10);
    assert_int_equal(step(&run, 2), WH_OK);
    assert_int_equal(step(&twin, 2), WH_OK);
    assert_true(wh_simulator_hash(&run.simulator) != wh_simulator_hash(&twin.simulator));
}

static void a_saved_scan_goes_on_bit_for_bit(void **state) {
    (void)state;
    static uint8_t bytes[WH_SNAPSHOT_SIZE(WAFERS, GRIPPERS)];
    static wh_wafer_t wafers[WAFERS];
    static wh_gripper_t grippers[GRIPPERS];
    static wh_snapshot_room_t room = {.wafers = wafers, .grippers = grippers};
    size_t size = 0;
    begin(&run, 0.001);
    (void)turn_by(&run, 1, 100, 3, 3600);
    begin(&twin, 0.001);
    assert_int_equal(wh_simulator_save(&run.simulator, bytes, sizeof bytes, &size), WH_OK);
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_OK);
    twin.command.seq = run.command.seq;
    for (int i = 1; i <= 100; ++i) {
        assert_int_equal(step(&run, 1 + 0.01 * i), WH_OK);
        assert_int_equal(step(&twin, 1 + 0.01 * i), WH_OK);
        assert_true(wh_simulator_hash(&run.simulator) == wh_simulator_hash(&twin.simulator));
    }
    assert_memory_equal(&run.simulator.physics.scan, &twin.simulator.physics.scan,
                        sizeof run.simulator.physics.scan);
    /* not into a cell with another sensor, and no scan that a simulator cannot have */
    scanner.sensor.noise = 0.004;
    assert_int_equal(wh_simulator_load(&twin.simulator, bytes, size, &room), WH_STATUS_OTHER_SNAPSHOT);
    wh_physics_state_t broken = run.simulator.physics;
    broken.scan.taken = broken.scan.count;
    assert_int_equal(wh_physics_state_validate(&broken, GRIPPERS, WAFERS), WH_STATUS_OUT_OF_RANGE);
    broken = run.simulator.physics;
    broken.scan.samples[63] = -1;
    assert_int_equal(wh_physics_state_validate(&broken, GRIPPERS, WAFERS), WH_STATUS_OUT_OF_RANGE);
    broken = run.simulator.physics;
    broken.scan.gripper = GRIPPERS;
    assert_int_equal(wh_physics_state_validate(&broken, GRIPPERS, WAFERS), WH_STATUS_OUT_OF_RANGE);
    /* a state without any scan fits a cell without grippers, too */
    wh_physics_state_start(&broken, NULL);
    assert_int_equal(wh_physics_state_validate(&broken, 0, WAFERS), WH_OK);
    broken = run.simulator.physics;
    broken.scan.turn = (double)NAN;
    assert_int_equal(wh_physics_state_validate(&broken, GRIPPERS, WAFERS), WH_STATUS_NOT_FINITE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_sample_is_what_the_sensor_reads_there),
        cmocka_unit_test(slices_and_the_way_round_do_not_matter),
        cmocka_unit_test(noise_is_named_by_seed_and_number),
        cmocka_unit_test(an_order_that_cannot_be_taken_changes_nothing),
        cmocka_unit_test(a_sensor_that_cannot_be_is_refused),
        cmocka_unit_test(a_scan_that_is_too_fast_ends_early),
        cmocka_unit_test(a_scan_that_waits_in_vain_ends),
        cmocka_unit_test(a_chuck_that_stands_or_turns_back_gives_no_sample_twice),
        cmocka_unit_test(without_a_wafer_there_is_nothing_and_face_down_it_is_mirrored),
        cmocka_unit_test(a_sensor_that_a_fault_breaks_down_says_so),
        cmocka_unit_test(a_sensor_that_a_fault_makes_late_reads_what_comes_later),
        cmocka_unit_test(a_run_without_a_scan_hashes_as_if_there_were_no_sensor),
        cmocka_unit_test(a_saved_scan_goes_on_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
