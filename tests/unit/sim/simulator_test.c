/* The simulator: its refusals, the contents of a state, and that the cell judges. */
#include "support/pose.h"

#include "sim/simulator.h"

enum { WAFERS = 2, GRIPPERS = 2, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_station_t station;
static wh_simulator_t simulator;
static wh_command_t command;
static wh_state_t answer;

static wh_grasp_storage_t storage_here(void) {
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, NULL, 0};
    return storage;
}

static wh_cell_t cell_here(void) {
    const wh_cell_t cell = {.stations = &station, .count = 1, .tolerance = wh_tolerance_paper()};
    return cell;
}

/* Wafer 0 in the station's slot at (700, 0, 900), wafer 1 far away; both grippers wait, closed. */
static int set_up(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = storage_here();
    const wh_cell_t cell = cell_here();
    station.base_from_station = wh_test_at(700, 0, 900);
    station.slots = 1;
    station.pitch = 10;
    station.chuck = WH_NONE;
    wafers[0].base_from_wafer = wh_test_at(700, 0, 900);
    wafers[1].base_from_wafer = wh_test_at(-700, 0, 900);
    memset(&simulator, 0x5a, sizeof simulator);
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_OK);
    memset(&command, 0, sizeof command);
    command.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        command.grippers[g].base_from_gripper = wh_test_at(0, 1000 * g, 0);
        command.grippers[g].valve = CLOSED;
    }
    return 0;
}

static void step(double x, double z, int valve) {
    ++command.seq;
    command.utime = 1000 * command.seq;
    command.grippers[0].base_from_gripper = wh_test_at(x, 0, z);
    command.grippers[0].valve = valve;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
}

/* Wafer 0 lies face down, and gripper 0 comes from above, turned over, its valve open. */
static void hang(double force) {
    static const wh_grip_t vacuum[GRIPPERS];
    static wh_wafer_t seen[WAFERS];
    const wh_grips_parts_t parts = {.thickness = WH_REAL(0.775), .dt = 0.001, .grips = vacuum, .seen = seen};
    const wh_pose_t slot = wh_test_at(700, 0, 900);
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = storage_here();
    wh_cell_t cell = cell_here();
    wh_physics_t physics = wh_physics_default();
    cell.thickness = parts.thickness;
    physics.pads = (wh_pads_t){1, WH_REAL(force), WH_REAL(0.1276), WH_REAL(9.81)};
    wh_face_frame(&slot, parts.thickness, WH_FACE_FRONT, &wafers[0].base_from_wafer);
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_OK);
    assert_int_equal(wh_simulator_set_physics(&simulator, &physics), WH_OK);
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_OK);
    for (int z = 2; z >= -6; --z) { /* down to 0.25 mm above the back face, and up by 1 mm */
        ++command.seq;
        command.grippers[0].base_from_gripper =
            wh_test_at(700, 0, 900.775 + (z >= 0 ? 0.25 + z : 0.25 - z / 6.0));
        command.grippers[0].base_from_gripper.R = wh_mat3_from_rpy_deg(180, 0, 0);
        command.grippers[0].valve = z > 0 ? CLOSED : OPEN;
        assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
    }
}

static void a_wafer_hangs_on_pads_that_carry_its_weight(void **state) {
    (void)state;
    hang(1.26);
    assert_int_equal(wafers[0].holder, 0);
    assert_near(wafers[0].base_from_wafer.r.z, 901.775, 1e5 * WH_TEST_ROUNDING);
    command.seq = 0;
    hang(1.24); /* 0.1276 kg weigh 1.2518 N */
    assert_int_equal(wafers[0].holder, WH_NONE);
    assert_near(wafers[0].base_from_wafer.r.z, 900.775, 1e5 * WH_TEST_ROUNDING);
}

static void grips_are_refused_that_the_simulator_does_not_take(void **state) {
    (void)state;
    wh_grip_t grips[GRIPPERS] = {{.kind = WH_GRIP_VACUUM}};
    wh_wafer_t seen[WAFERS];
    wh_grips_parts_t parts = {.dt = 0.001, .grips = grips, .seen = seen};
    assert_int_equal(wh_simulator_set_grips(&simulator, NULL), WH_STATUS_NULL_ARGUMENT);
    parts.thickness = 1;
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_STATUS_OUT_OF_RANGE);
    parts.thickness = 0;
    grips[1].kind = WH_GRIP_EDGE;
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_STATUS_OUT_OF_RANGE);
    grips[1].edge = wh_edge_default(150);
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_STATUS_NULL_ARGUMENT);
    grips[1].kind = WH_GRIP_VACUUM;
    assert_null(simulator.given.gripping);
    parts.dt = 0.002; /* plungers would go twice as fast */
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_STATUS_OUT_OF_RANGE);
    parts.dt = 0.001;
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_OK);
    wh_physics_t slower = wh_physics_default();
    slower.slice_s = WH_REAL(0.002);
    assert_int_equal(wh_simulator_set_physics(&simulator, &slower), WH_STATUS_OUT_OF_RANGE);
    step(0, 0, CLOSED);
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_STATUS_OUT_OF_RANGE);
}

/* Gripper 0 is passive, and the slot's plane takes wafers over from it. */
static void give_passive_pads(void) {
    static const wh_grip_t grips[GRIPPERS] = {{.kind = WH_GRIP_PASSIVE}};
    static wh_wafer_t seen[WAFERS];
    static wh_pose_t support;
    support = wh_station_slot(&station, 1);
    const wh_grips_parts_t parts = {
        .dt = 0.001, .grips = grips, .supports = &support, .support_count = 1, .seen = seen};
    assert_int_equal(wh_simulator_set_grips(&simulator, &parts), WH_OK);
}

static bool has_slipped(void) {
    bool any = false;
    for (size_t i = 0; i < answer.event_count; ++i) {
        any = any || answer.events[i].kind == WH_EVENT_SLIPPED;
    }
    return any;
}

static void passive_pads_lift_a_wafer_whatever_their_valve_does(void **state) {
    (void)state;
    give_passive_pads();
    for (int i = 0; i <= 20; ++i) {
        step(700, 899 + 0.1 * i, i % 2);
        assert_int_equal(wafers[0].holder, i < 11 ? WH_NONE : 0);
        assert_int_equal(answer.sensors & 1U, i < 11 ? 0 : 1);
        assert_true(answer.physics->vacuum[0].level == 0 && !has_slipped());
    }
    for (int i = 19; i >= 0; --i) {
        step(700, 899 + 0.1 * i, OPEN);
        assert_int_equal(wafers[0].holder, i > 10 ? 0 : WH_NONE);
    }
    assert_near(wafers[0].base_from_wafer.r.z, 900, 1e5 * WH_TEST_ROUNDING);
}

/* Friction of 0.2 holds 1962 mm/s^2: a constant acceleration is 0.001962 mm per slice squared. */
/* Half the acceleration that friction of 0.2 holds is 0.000981 mm per slice squared; a float's
 * places are good to 6e-5 mm. */
#if defined(WH_FLOAT)
#define TOO_FAST 0.0012
#define SLOW 0.0008
#else
#define TOO_FAST 0.000983
#define SLOW 0.000979
#endif

static void on_passive_pads_a_wafer_slips_beyond_friction_without_pads_in_the_cell(void **state) {
    (void)state;
    for (int over = 0; over < 2; ++over) {
        bool slipped = false;
        set_up(state);
        give_passive_pads();
        step(700, 899.5, OPEN);
        for (int i = 0; i < 20; ++i) {
            step(700 + (over ? TOO_FAST : SLOW) * i * i, 901, OPEN);
            slipped = slipped || has_slipped();
        }
        assert_int_equal(wafers[0].holder, 0);
        assert_int_equal(slipped, over);
        command.seq = 0;
    }
}

static void init_refuses_what_it_cannot_use(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = storage_here();
    const wh_cell_t cell = cell_here();
    const wh_simulator_t before = simulator;
    wh_grasp_storage_t large = storage;
    large.gripper_count = WH_GRIPPERS + 1;
    const wh_cell_t nowhere = {.stations = NULL, .count = 1, .tolerance = cell.tolerance};
    wh_grasp_config_t wide = config;
    wide.tolerance.projz = -1;
    assert_int_equal(wh_simulator_init(NULL, &config, &storage, &cell), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_init(&simulator, NULL, &storage, &cell), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_init(&simulator, &config, NULL, &cell), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &nowhere), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_init(&simulator, &config, &large, &cell), WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_simulator_init(&simulator, &wide, &storage, &cell), WH_STATUS_BAD_TOLERANCE);
    assert_memory_equal(&simulator, &before, sizeof simulator);
}

/* Counts beyond the arrays always; what does not go on where that is asked for. */
static void counts_and_times_are_looked_at(void **state) {
    (void)state;
    command.axis_count = 4000000;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_OUT_OF_RANGE);
    command.axis_count = WH_AXES;
    step(0, 0, CLOSED);
    command.seq = -7;
    command.utime = -7000;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);

    assert_int_equal(wh_simulator_set_strict(NULL, true), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_set_strict(&simulator, true), WH_OK);
    /* The slices that it saw before count. */
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_OUT_OF_RANGE);
    command.seq += 1;
    command.utime += 1;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
    assert_int_equal(wh_simulator_set_strict(&simulator, true), WH_OK);
    const uint64_t hash = wh_simulator_hash(&simulator);
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_OUT_OF_RANGE);
    command.utime += 1;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_OUT_OF_RANGE);
    command.seq += 1;
    command.utime -= 1;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_OUT_OF_RANGE);
    assert_true(wh_simulator_hash(&simulator) == hash);
    command.utime += 1;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
    assert_int_equal(wh_simulator_set_strict(&simulator, false), WH_OK);
    command.seq = 1;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
    memset(&simulator, 0, sizeof simulator);
    assert_int_equal(wh_simulator_set_strict(&simulator, true), WH_STATUS_NOT_INITIALISED);
}

static void init_refuses_a_cell_that_is_none(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = storage_here();
    const wh_simulator_t before = simulator;
    wh_cell_t cell = cell_here();
    cell.tolerance.projxy = WH_REAL(NAN);
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_STATUS_BAD_TOLERANCE);
    cell = cell_here();
    station.pitch = 0;
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_STATUS_OUT_OF_RANGE);
    station.pitch = 10;
    station.slots = -3;
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_STATUS_OUT_OF_RANGE);
    station.slots = 1;
    station.chuck = GRIPPERS;
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_STATUS_OUT_OF_RANGE);
    assert_memory_equal(&simulator, &before, sizeof simulator);
}

/* Zeroed, or with anything else in its memory: nothing of it is read but the mark, and nothing is written. */
static void a_simulator_that_was_never_initialised_is_refused(void **state) {
    (void)state;
    static const int bytes[] = {0, 0xff, 0x5a};
    const wh_physics_t physics = wh_physics_default();
    const wh_simulator_t good = simulator;
    for (size_t i = 0; i < sizeof bytes / sizeof bytes[0]; ++i) {
        memset(&simulator, bytes[i], sizeof simulator);
        const wh_simulator_t before = simulator;
        memset(&answer, 0x5a, sizeof answer);
        command.seq = 7;
        command.utime = 7000;
        assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_NOT_INITIALISED);
        assert_int_equal(answer.status, WH_STATUS_NOT_INITIALISED);
        assert_int_equal(answer.seq, 7);
        assert_int_equal(answer.utime, 7000);
        assert_true(answer.wafer_count + answer.gripper_count + answer.event_count + answer.sensors == 0);
        assert_null(answer.wafers);
        assert_null(answer.grippers);
        assert_null(answer.events);
        assert_null(answer.physics);
        assert_int_equal(wh_simulator_set_physics(&simulator, &physics), WH_STATUS_NOT_INITIALISED);
        assert_true(wh_simulator_hash(&simulator) == 0);
        assert_memory_equal(&simulator, &before, sizeof simulator);
    }
    memcpy(&simulator, &good, sizeof simulator);
    simulator.table.mark = 0; /* somebody overwrote it */
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_STATUS_NOT_INITIALISED);
}

/* The largest number of grippers in a command; all of them release at once, each in the air. */
static void all_grippers_at_once(void **state) {
    (void)state;
    static wh_wafer_t many_wafers[WH_GRIPPERS];
    static wh_gripper_t many_grippers[WH_GRIPPERS];
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {many_wafers, WH_GRIPPERS, many_grippers, WH_GRIPPERS, NULL, 0};
    const wh_cell_t cell = cell_here();
    command.gripper_count = WH_GRIPPERS;
    for (int g = 0; g < WH_GRIPPERS; ++g) {
        many_wafers[g].base_from_wafer = wh_test_at(0, 1000 * g, 0);
        command.grippers[g].base_from_gripper = many_wafers[g].base_from_wafer;
        command.grippers[g].valve = OPEN;
    }
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_OK);
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
    assert_int_equal(answer.event_count, WH_GRIPPERS);
    assert_int_equal(answer.sensors, (1U << WH_GRIPPERS) - 1);
    for (int g = 0; g < WH_GRIPPERS; ++g) {
        command.grippers[g].valve = CLOSED;
    }
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
    assert_int_equal(answer.event_count, 2 * WH_GRIPPERS);
    assert_int_equal(answer.sensors, 0);
}

static void a_cell_without_stations_is_allowed(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = storage_here();
    const wh_cell_t empty = {.stations = NULL, .count = 0, .tolerance = config.tolerance};
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &empty), WH_OK);
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
}

static void the_view_before_the_first_slice(void **state) {
    (void)state;
    memset(&answer, 0x5a, sizeof answer);
    wh_simulator_view(&simulator, &answer);
    assert_ptr_equal(answer.wafers, wafers);
    assert_int_equal(answer.wafer_count, WAFERS);
    assert_ptr_equal(answer.grippers, grippers);
    assert_int_equal(answer.gripper_count, GRIPPERS);
    assert_int_equal(answer.event_count, 0);
    assert_int_equal(answer.sensors, 0);
}

static void a_state_answers_its_command(void **state) {
    (void)state;
    command.seq = 41;
    step(0, 0, CLOSED);
    assert_int_equal(answer.seq, 42);
    assert_int_equal(answer.utime, 42000);
    assert_int_equal(answer.status, WH_OK);
    assert_int_equal(answer.event_count, 0);
}

static void a_pick_shows_in_holder_sensor_and_events(void **state) {
    (void)state;
    step(700, 899.8, OPEN);
    assert_int_equal(answer.wafers[0].holder, 0);
    assert_int_equal(answer.sensors, 1);
    assert_int_equal(answer.event_count, 1);
    assert_int_equal(answer.events[0].kind, WH_EVENT_PICKED);
    step(700, 950, OPEN);
    assert_int_equal(answer.event_count, 0);
    assert_int_equal(answer.sensors, 1);
    assert_near(answer.wafers[0].base_from_wafer.r.z, 950.2, 2048 * WH_TEST_ROUNDING);
}

static void each_gripper_has_its_own_sensor_bit(void **state) {
    (void)state;
    command.grippers[1].base_from_gripper = wh_test_at(-700, 0, 900);
    command.grippers[1].valve = OPEN;
    step(0, 0, CLOSED);
    assert_int_equal(answer.sensors, 2);
    step(700, 900, OPEN);
    assert_int_equal(answer.sensors, 3);
}

static void the_cell_judges_a_release_in_the_same_slice(void **state) {
    (void)state;
    step(700, 900, OPEN);
    step(300, 900, CLOSED);
    assert_int_equal(answer.sensors, 0);
    assert_int_equal(answer.event_count, 2);
    assert_int_equal(answer.events[0].kind, WH_EVENT_RELEASED);
    assert_int_equal(answer.events[1].kind, WH_EVENT_RELEASED_UNSUPPORTED);
    assert_near(answer.events[1].height, 900, 2048 * WH_TEST_ROUNDING);
}

/* A refused command is answered and counted, and nothing has moved. */
static void expect_refused(wh_status_t status, size_t events) {
    const uint64_t hash = simulator.link.hash(&simulator.link);
    const uint64_t refused = simulator.table.counters.refused;
    command.seq = 77;
    command.utime = 77000;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), status);
    assert_int_equal(answer.status, status);
    assert_int_equal(answer.seq, 77);
    assert_int_equal(answer.utime, 77000);
    assert_int_equal(answer.event_count, events);
    assert_int_equal(answer.sensors, 1);
    assert_int_equal(answer.wafer_count, WAFERS);
    assert_int_equal(simulator.table.counters.refused, refused + 1);
    assert_true(simulator.link.hash(&simulator.link) == hash);
}

static void a_refused_command_changes_nothing_and_is_counted(void **state) {
    (void)state;
    step(700, 900, OPEN);
    command.grippers[1].valve = 2;
    expect_refused(WH_STATUS_BAD_VALVE, 1);
    assert_int_equal(answer.events[0].kind, WH_EVENT_BAD_INPUT);
    assert_int_equal(answer.events[0].gripper, 1);
    command.grippers[1].valve = CLOSED;
    command.grippers[0].base_from_gripper.r.x = (wh_real_t)NAN;
    expect_refused(WH_STATUS_NOT_FINITE, 1);
    command.grippers[0].base_from_gripper = wh_test_at(700, 0, 900);
    static const size_t counts[] = {0, GRIPPERS - 1, GRIPPERS + 1, WH_GRIPPERS + 1, SIZE_MAX};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        command.gripper_count = counts[i];
        expect_refused(WH_STATUS_OUT_OF_RANGE, 0);
    }
}

static void null_pointers_touch_nothing(void **state) {
    (void)state;
    const uint64_t refused = simulator.table.counters.refused;
    assert_int_equal(wh_simulator_step(NULL, &command, &answer), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_step(&simulator, NULL, &answer), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_step(&simulator, &command, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(simulator.table.counters.refused, refused);
    assert_int_equal(simulator.table.slice, 0);
}

static void entries_beyond_the_count_are_not_looked_at(void **state) {
    (void)state;
    command.grippers[GRIPPERS].valve = 99;
    command.grippers[GRIPPERS].base_from_gripper.r.x = (wh_real_t)NAN;
    step(700, 900, OPEN);
    assert_int_equal(answer.sensors, 1);
}

/* The interface that an MCS uses. */
static void the_link_is_the_simulator(void **state) {
    (void)state;
    wh_link_t *link = &simulator.link;
    command.grippers[0].base_from_gripper = wh_test_at(700, 0, 900);
    command.grippers[0].valve = OPEN;
    command.seq = 1;
    assert_int_equal(link->exchange(link, &command, &answer), WH_OK);
    assert_int_equal(answer.sensors, 1);
    assert_true(link->hash(link) == wh_grasp_hash(&simulator.table));
    assert_int_equal(link->missed(link), 0); /* a call is never late */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(init_refuses_what_it_cannot_use, set_up),
        cmocka_unit_test_setup(counts_and_times_are_looked_at, set_up),
        cmocka_unit_test_setup(init_refuses_a_cell_that_is_none, set_up),
        cmocka_unit_test_setup(a_simulator_that_was_never_initialised_is_refused, set_up),
        cmocka_unit_test_setup(all_grippers_at_once, set_up),
        cmocka_unit_test_setup(a_cell_without_stations_is_allowed, set_up),
        cmocka_unit_test_setup(the_view_before_the_first_slice, set_up),
        cmocka_unit_test_setup(a_state_answers_its_command, set_up),
        cmocka_unit_test_setup(a_pick_shows_in_holder_sensor_and_events, set_up),
        cmocka_unit_test_setup(each_gripper_has_its_own_sensor_bit, set_up),
        cmocka_unit_test_setup(the_cell_judges_a_release_in_the_same_slice, set_up),
        cmocka_unit_test_setup(a_refused_command_changes_nothing_and_is_counted, set_up),
        cmocka_unit_test_setup(null_pointers_touch_nothing, set_up),
        cmocka_unit_test_setup(entries_beyond_the_count_are_not_looked_at, set_up),
        cmocka_unit_test_setup(the_link_is_the_simulator, set_up),
        cmocka_unit_test_setup(a_wafer_hangs_on_pads_that_carry_its_weight, set_up),
        cmocka_unit_test_setup(grips_are_refused_that_the_simulator_does_not_take, set_up),
        cmocka_unit_test_setup(passive_pads_lift_a_wafer_whatever_their_valve_does, set_up),
        cmocka_unit_test_setup(on_passive_pads_a_wafer_slips_beyond_friction_without_pads_in_the_cell,
                               set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
