/* The simulator with a delayed vacuum and with pads: the values that a caller gets, and that ideal
 * vacuum gives the paper's results. */
#include "support/pose.h"

#include "sim/simulator.h"

enum { WAFERS = 6, GRIPPERS = 3, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_simulator_t simulator;
static wh_physics_t physics;
static wh_command_t command;
static wh_state_t answer;

static wh_grasp_storage_t place_wafers(wh_wafer_t w[], wh_gripper_t g[]) {
    const wh_grasp_storage_t storage = {w, WAFERS, g, GRIPPERS, NULL, 0};
    for (int i = 0; i < WAFERS; ++i) {
        w[i].base_from_wafer = wh_test_at(0, 0, 3 * i);
    }
    return storage;
}

static int set_up(void **state) {
    (void)state;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = place_wafers(wafers, grippers);
    const wh_cell_t cell = {.tolerance = wh_tolerance_paper()};
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_OK);
    physics = wh_physics_default();
    memset(&command, 0, sizeof command);
    command.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        command.grippers[g].base_from_gripper = wh_test_at(0, 1000 * g, -10);
        command.grippers[g].valve = CLOSED;
    }
    return 0;
}

static void use(void) {
    assert_int_equal(wh_simulator_set_physics(&simulator, &physics), WH_OK);
}

static void step(double x, double z, int valve) {
    ++command.seq;
    command.grippers[0].base_from_gripper = wh_test_at(x, 0, z);
    command.grippers[0].valve = valve;
    assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
}

static size_t count(wh_event_kind_t kind) {
    size_t found = 0;
    for (size_t i = 0; i < answer.event_count; ++i) {
        found += answer.events[i].kind == kind ? 1 : 0;
    }
    return found;
}

static void what_is_refused(void **state) {
    (void)state;
    wh_physics_t bad[6] = {physics, physics, physics, physics, physics, physics};
    bad[0].vacuum.on = 0;
    bad[1].pads.friction = 1;
    bad[2].slice_s = 0;
    bad[3].slice_s = WH_REAL(1.001);
    bad[4].fault_count = WH_FAULTS + 1;
    bad[5].fault_count = 1; /* all zero: no rotation */
    const uint64_t hash = wh_simulator_hash(&simulator);
    for (size_t i = 0; i < 6; ++i) {
        assert_int_not_equal(wh_simulator_set_physics(&simulator, &bad[i]), WH_OK);
    }
    assert_int_equal(wh_simulator_set_physics(NULL, &physics), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_simulator_set_physics(&simulator, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_true(wh_simulator_hash(&simulator) == hash);
    step(0, -10, CLOSED);
    assert_int_equal(wh_simulator_set_physics(&simulator, &physics), WH_STATUS_OUT_OF_RANGE);
}

/* Random moves and valves: wafers and events are those of a grasp table alone, bit for bit, and the
 * sensors show which gripper holds one. */
static void ideal_is_the_paper(void **state) {
    static wh_wafer_t plain_wafers[WAFERS];
    static wh_gripper_t plain_grippers[GRIPPERS];
    wh_event_t events[GRIPPERS * WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list = {events, sizeof events / sizeof events[0], 0};
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = place_wafers(plain_wafers, plain_grippers);
    wh_grasp_t table;
    uint64_t held = 0;
    (void)state;
    assert_int_equal(wh_grasp_init(&table, &config, &storage), WH_OK);
    use();
    for (command.seq = 1; command.seq <= 20000; ++command.seq) {
        for (int g = 0; g < GRIPPERS; ++g) {
            command.grippers[g].base_from_gripper = wh_test_at(0, 0, wh_test_uniform(-2, 18));
            command.grippers[g].valve = wh_test_below(5) == 0 ? CLOSED : OPEN;
        }
        assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
        assert_int_equal(wh_grasp_step(&table, command.grippers, &list), WH_OK);
        assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&table));
        assert_true(answer.event_count >= list.count);
        for (size_t i = 0; i < list.count; ++i) {
            assert_int_equal(answer.events[i].kind, events[i].kind);
        }
        for (uint32_t g = 0; g < GRIPPERS; ++g) {
            assert_int_equal(answer.sensors >> g & 1U, plain_grippers[g].wafer != WH_NONE);
            held += plain_grippers[g].wafer != WH_NONE ? 1 : 0;
        }
    }
    assert_true(held > 10000);
}

static void delayed_goes_its_own_way(void **state) {
    (void)state;
    physics.vacuum = wh_vacuum_delayed();
    use();
    step(0, -1, OPEN);
    int until_on = 0;
    while ((step(0, 0, OPEN), answer.sensors) == 0) {
        assert_int_equal(answer.grippers[0].wafer, 0);
        ++until_on;
    }
    assert_int_equal(until_on, 60); /* 1 - 0.7 = (50 / 51)^n, n = 60.8 */
    int until_released = 0;
    step(0, 1, OPEN);
    while ((step(0, 1, CLOSED), answer.grippers[0].wafer) == 0) {
        assert_int_equal(count(WH_EVENT_RELEASED), 0);
        assert_int_equal(answer.physics->vacuum[0].command, CLOSED);
        assert_int_equal(answer.grippers[0].valve, OPEN);
        ++until_released;
    }
    assert_int_equal(count(WH_EVENT_RELEASED), 1);
    assert_true(until_released > 10);
    assert_int_equal(count(WH_EVENT_VACUUM_LOST), 0);
}

/* One second, and nothing else that takes time. */
static void a_slow_pump_alone(void **state) {
    (void)state;
    physics.vacuum.build = 1;
    use();
    step(0, -1, OPEN);
    step(0, 0, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
    assert_int_equal(answer.sensors, 0);
    assert_true(answer.physics->vacuum[0].level < WH_REAL(0.01));
}

/* Pads whose limit is in the wafer's plane: a run along x just below and just above it. */
static void run_along(double factor, size_t slips) {
    const double limit = 0.25 * (9810 + 1000 * 5 / 0.125);
    size_t begun = 0;
    set_up(NULL);
    physics.pads.friction = WH_REAL(0.25);
    physics.pads.force = 5;
    physics.pads.mass = WH_REAL(0.125);
    physics.pads.gravity = WH_REAL(9.81);
    use();
    step(0, -10, OPEN);
    for (int n = 0; n < 100; ++n) {
        const double t = 1e-3 * n;
        step(0.5 * factor * limit * t * t, 0, OPEN);
        assert_int_equal(answer.grippers[0].wafer, 0);
        for (size_t i = 0; i < answer.event_count; ++i) {
            const wh_event_t *event = &answer.events[i];
            if (event->kind == WH_EVENT_SLIPPED) {
                ++begun;
                assert_true(event->value > event->limit);
                assert_true(fabs((double)event->limit - limit) < 1e-3 * limit);
                assert_int_equal(event->wafer, 0);
                assert_int_equal(event->gripper, 0);
                assert_int_equal(event->other, WH_NONE);
                assert_int_equal(event->parts[0], WH_NONE);
                assert_int_equal(event->parts[1], WH_NONE);
                assert_int_equal(event->slice, command.seq);
                assert_int_equal(event->measured_slice, command.seq);
            }
        }
    }
    assert_true(sizeof(wh_real_t) == 4 || begun == slips);
}

static void a_wafer_that_would_slip_is_named(void **state) {
    (void)state;
    const double margin = sizeof(wh_real_t) == 4 ? 0.2 : 1e-9;
    run_along(1 - margin, 0);
    run_along(1 + margin, 1);
}

/* All grippers take a wafer and jerk it away, some in one slice and the others in another. */
static void each_gripper_slips_for_itself(void **state) {
    (void)state;
    physics.pads.friction = WH_REAL(0.25);
    physics.pads.mass = WH_REAL(0.125);
    physics.pads.gravity = WH_REAL(9.81);
    use();
    for (int g = 0; g < GRIPPERS; ++g) {
        const wh_pose_t place = wh_test_at(1000 * g, 0, 0);
        assert_int_equal(wh_grasp_place(&simulator.table, (size_t)g, &place), WH_OK);
    }
    for (int jerked = 0; jerked < GRIPPERS; ++jerked) {
        for (int slice = 0; slice < 5; ++slice) {
            for (int g = 0; g < GRIPPERS; ++g) {
                command.grippers[g].base_from_gripper = wh_test_at(1000 * g, 0, 0);
                command.grippers[g].valve = OPEN;
            }
            command.grippers[jerked].base_from_gripper.r.x += slice == 4 ? 5 : 0;
            ++command.seq;
            assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
        }
        assert_int_equal(count(WH_EVENT_SLIPPED), 1);
        assert_int_equal(answer.events[0].gripper, jerked);
        for (int slice = 0; slice < 5; ++slice) {
            ++command.seq;
            assert_int_equal(wh_simulator_step(&simulator, &command, &answer), WH_OK);
        }
    }
}

/* In these states a gripper seems to hold a wafer by its vacuum. */
static void what_is_beyond_the_grippers_is_left_alone(void **state) {
    (void)state;
    physics.vacuum = wh_vacuum_delayed();
    use();
    simulator.table.storage.gripper_count = command.gripper_count = GRIPPERS - 1;
    wh_vacuum_t *vacuum = &simulator.physics.vacuum[GRIPPERS - 1];
    wh_gripper_input_t *input = &simulator.inputs[GRIPPERS - 1];
    grippers[GRIPPERS - 1].wafer = 0;
    vacuum->level = 1;
    input->valve = CLOSED;
    const wh_vacuum_t before = *vacuum;
    step(0, -10, CLOSED);
    assert_memory_equal(vacuum, &before, sizeof before);
    assert_int_equal(input->valve, CLOSED);
}

/* Each fault is reported, though many begin in one slice. */
static void all_slots_at_once(void **state) {
    (void)state;
    use();
    simulator.physics.faults.count = WH_FAULTS;
    step(0, -10, OPEN);
    for (size_t i = 0; i < WH_FAULTS; ++i) {
        wh_fault_slot_t *slot = &simulator.physics.faults.slots[i];
        memset(slot, 0, sizeof *slot);
        slot->fault.kind = WH_FAULT_SENSOR_ON;
        slot->fault.from = 1;
        slot->fault.until = WH_FAULT_FOREVER;
        slot->phase = WH_FAULT_WAITING;
    }
    step(0, -10, OPEN);
    assert_int_equal(answer.event_count, WH_FAULTS);
    assert_int_equal(answer.sensors, 1);
}

/* The layout has it from the beginning. */
static void a_fault_from_the_beginning(void **state) {
    (void)state;
    wh_fault_t *fault = &physics.faults[0];
    fault->kind = WH_FAULT_WAFER_SHIFTED;
    fault->other = WH_NONE;
    fault->offset = wh_test_at(7, 0, 0);
    fault->from = 2;
    fault->until = WH_FAULT_FOREVER;
    physics.fault_count = 1;
    use();
    step(0, -10, CLOSED);
    assert_true(answer.wafers[0].base_from_wafer.r.x == 0);
    step(0, -10, CLOSED);
    assert_true(answer.wafers[0].base_from_wafer.r.x == 7);
    assert_int_equal(count(WH_EVENT_FAULT_ARMED), 1);
}

/* An observer that leaves no room for later events, and counts the wafers that faults move. */
static void fill(void *user, const wh_command_t *order, const wh_gripper_input_t inputs[],
                 const wh_grasp_t *table, wh_event_list_t *list) {
    (void)order;
    (void)user;
    (void)inputs;
    (void)table;
    while (list->count < list->capacity) {
        memset(&list->events[list->count], 0, sizeof list->events[0]);
        list->events[list->count++].kind = WH_EVENT_HIT;
    }
}

static void count_placed(void *user, const wh_grasp_t *table, int32_t wafer) {
    int *placed = user;
    assert_ptr_equal(table, &simulator.table);
    assert_int_equal(wafer, 1);
    ++*placed;
}

static void what_does_not_fit_is_not_told(void **state) {
    (void)state;
    int placed = 0;
    use();
    simulator.observer.look = fill;
    simulator.observer.placed = count_placed;
    simulator.observer.user = &placed;
    step(0, 0, OPEN);
    wh_fault_t fault = {.kind = WH_FAULT_LEAK, .other = WH_NONE, .from = 1, .until = WH_FAULT_FOREVER};
    fault.offset = wh_pose_identity();
    command.faults[0].fault = fault;
    fault.kind = WH_FAULT_WAFER_SHIFTED;
    fault.target = 1;
    command.faults[1].fault = fault;
    command.faults[1].index = 1;
    command.fault_count = 2;
    step(0, 0, OPEN);
    command.fault_count = 0;
    assert_int_equal(answer.event_count, WH_SLICE_EVENTS);
    assert_int_equal(count(WH_EVENT_HIT), WH_SLICE_EVENTS);
    assert_true(answer.has_lost_events);
    assert_int_equal(answer.sensors, 0); /* it was lost all the same */
    assert_int_equal(placed, 1);
    step(0, 0, OPEN);
    assert_int_equal(placed, 1);
}

/* A cell with one station of two slots, 10 mm apart, with the first wafer in slot 2, and a slow vacuum. */
static wh_station_t shelf;

static void stand_on_a_shelf(void) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = place_wafers(wafers, grippers);
    for (int i = 1; i < WAFERS; ++i) {
        wafers[i].base_from_wafer = wh_test_at(5000, 0, 50 * i);
    }
    wafers[0].base_from_wafer = wh_test_at(0, 0, 0);
    shelf = (wh_station_t){wh_test_at(0, 0, -10), 2, 10, WH_NONE};
    const wh_cell_t cell = {.stations = &shelf, .count = 1, .tolerance = wh_tolerance_paper()};
    assert_int_equal(wh_simulator_init(&simulator, &config, &storage, &cell), WH_OK);
    physics.vacuum = wh_vacuum_delayed();
    physics.vacuum.vent = 10; /* s: it holds through the whole test */
    use();
    step(0, 0, OPEN);
    for (int i = 0; i < 500; ++i) {
        step(0, WH_REAL(0.01) * (wh_real_t)i, OPEN);
    }
    assert_int_equal(answer.grippers[0].wafer, 0);
}

static wh_real_t height(void) {
    return answer.wafers[0].base_from_wafer.r.z;
}

static void a_support_stops_a_wafer_whose_vacuum_still_holds(void **state) {
    (void)state;
    stand_on_a_shelf();
    for (int i = 0; i <= 16; ++i) {
        step(0, 5 - WH_REAL(0.3) * (wh_real_t)i, CLOSED);
        assert_int_equal(answer.grippers[0].wafer, 0);
        assert_near(height(), 5 - 0.3 * i, 1e-5);
    }
    step(0, WH_REAL(-0.1), CLOSED);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
    assert_int_equal(count(WH_EVENT_RELEASED), 1);
    assert_near(height(), 0, 1e-6);
    step(100, WH_REAL(-5.0), CLOSED);
    assert_near(height(), 0, 1e-6);
    assert_near(answer.wafers[0].base_from_wafer.r.x, 0, 0);
}

/* At the plane itself, as in a PUT of a seated wafer: the support takes it as soon as the valve closes. */
static void a_wafer_at_the_plane_stays_there(void **state) {
    (void)state;
    stand_on_a_shelf();
    step(0, 0, OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
    step(0, 0, CLOSED);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
    step(0, WH_REAL(-0.002), CLOSED);
    assert_near(height(), 0, 1e-6);
}

/* In a tilted slot, or with a low `release`, the wafer is below the plane when its valve closes. */
static void a_wafer_a_little_below_the_plane_goes_no_farther(void **state) {
    (void)state;
    stand_on_a_shelf();
    step(0, WH_REAL(-0.004), OPEN);
    step(0, WH_REAL(-0.3), OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
    step(0, WH_REAL(-0.3), CLOSED);
    assert_int_equal(answer.grippers[0].wafer, WH_NONE);
    step(0, WH_REAL(-5.0), CLOSED);
    assert_near(height(), 0, 1e-6);
}

static void only_a_support_below_stops_a_wafer(void **state) {
    (void)state;
    /* With an open valve the blade pulls the wafer on: the collision check reports that. */
    stand_on_a_shelf();
    step(0, WH_REAL(0.5), OPEN);
    step(0, WH_REAL(-0.7), OPEN);
    assert_int_equal(answer.grippers[0].wafer, 0);
    /* Also from farther below the plane, and upwards through the plane of slot 2. */
    step(0, WH_REAL(-1.0), CLOSED);
    step(0, WH_REAL(1.0), CLOSED);
    assert_int_equal(answer.grippers[0].wafer, 0);
    /* Beside the slot there is no support. */
    step(100, WH_REAL(1.0), CLOSED);
    step(100, WH_REAL(-1.0), CLOSED);
    assert_int_equal(answer.grippers[0].wafer, 0);
    assert_near(height(), -1, 1e-5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(what_is_refused, set_up),
        cmocka_unit_test_setup(ideal_is_the_paper, set_up),
        cmocka_unit_test_setup(delayed_goes_its_own_way, set_up),
        cmocka_unit_test_setup(a_slow_pump_alone, set_up),
        cmocka_unit_test_setup(a_wafer_that_would_slip_is_named, set_up),
        cmocka_unit_test_setup(each_gripper_slips_for_itself, set_up),
        cmocka_unit_test_setup(what_is_beyond_the_grippers_is_left_alone, set_up),
        cmocka_unit_test_setup(all_slots_at_once, set_up),
        cmocka_unit_test_setup(a_fault_from_the_beginning, set_up),
        cmocka_unit_test_setup(what_does_not_fit_is_not_told, set_up),
        cmocka_unit_test_setup(a_support_stops_a_wafer_whose_vacuum_still_holds, set_up),
        cmocka_unit_test_setup(a_wafer_at_the_plane_stays_there, set_up),
        cmocka_unit_test_setup(a_wafer_a_little_below_the_plane_goes_no_farther, set_up),
        cmocka_unit_test_setup(only_a_support_below_stops_a_wafer, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
