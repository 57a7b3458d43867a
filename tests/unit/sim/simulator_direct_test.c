/* The simulator's two ways through a slice: a cell without faults and with an immediate vacuum
 * takes the short one. Here each run takes both: a second simulator has a fault that never begins,
 * and so takes the long way. */
#include "support/pose.h"

#include "sim/simulator.h"

enum { WAFERS = 4, GRIPPERS = 3, OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED, SLICES = 4000 };

typedef struct {
    wh_wafer_t wafers[WAFERS];
    wh_gripper_t grippers[GRIPPERS];
    wh_simulator_t simulator;
    wh_state_t state;
} way_t;

static way_t plain, faulty;
static wh_physics_t physics;

static wh_fault_t never(void) {
    const wh_fault_t fault = {.kind = WH_FAULT_NO_VACUUM,
                              .other = WH_NONE,
                              .offset = wh_pose_identity(),
                              .from = INT64_MAX - 1,
                              .until = WH_FAULT_FOREVER};
    return fault;
}

static void start(way_t *way, const wh_physics_t *with) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {way->wafers, WAFERS, way->grippers, GRIPPERS, NULL, 0};
    const wh_cell_t cell = {.tolerance = wh_tolerance_paper()};
    memset(way, 0, sizeof *way);
    for (int w = 0; w < WAFERS; ++w) {
        way->wafers[w].base_from_wafer = wh_test_at(0, 0, 3 * w);
    }
    assert_int_equal(wh_simulator_init(&way->simulator, &config, &storage, &cell), WH_OK);
    assert_int_equal(wh_simulator_set_physics(&way->simulator, with), WH_OK);
}

static void start_both(void) {
    wh_physics_t with = physics;
    start(&plain, &with);
    with.faults[0] = never();
    with.fault_count = 1;
    start(&faulty, &with);
    assert_int_equal(faulty.simulator.physics.faults.count, 1);
}

static int set_up(void **state) {
    (void)state;
    physics = wh_physics_default();
    return 0;
}

/* Grippers move up and down among the wafers; now and then a valve or a pose is invalid. */
static wh_command_t any_command(int64_t seq) {
    wh_command_t command;
    memset(&command, 0, sizeof command);
    command.seq = seq;
    command.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        command.grippers[g].base_from_gripper = wh_test_at(0, 0, wh_test_uniform(-1, 10));
        command.grippers[g].valve = wh_test_below(3) == 0 ? CLOSED : OPEN;
    }
    if (wh_test_below(16) == 0) {
        command.grippers[wh_test_below(GRIPPERS)].valve = 2;
    }
    if (wh_test_below(16) == 0) {
        command.grippers[wh_test_below(GRIPPERS)].base_from_gripper.r.x = WH_REAL(NAN);
    }
    return command;
}

static void compare_conditions(const wh_physics_state_t *a, const wh_physics_state_t *b) {
    for (int g = 0; g < GRIPPERS; ++g) {
        assert_memory_equal(&a->vacuum[g].level, &b->vacuum[g].level, sizeof a->vacuum[g].level);
        assert_int_equal(a->vacuum[g].command, b->vacuum[g].command);
        assert_int_equal(a->vacuum[g].on, b->vacuum[g].on);
        assert_int_equal(a->told[g], b->told[g]);
        assert_memory_equal(&a->carry[g].before, &b->carry[g].before, sizeof a->carry[g].before);
        assert_int_equal(a->carry[g].known, b->carry[g].known);
    }
}

static void compare(void) {
    assert_int_equal(plain.state.status, faulty.state.status);
    assert_true(wh_grasp_hash(&plain.simulator.table) == wh_grasp_hash(&faulty.simulator.table));
    assert_int_equal(plain.simulator.table.counters.refused, faulty.simulator.table.counters.refused);
    assert_int_equal(plain.state.sensors, faulty.state.sensors);
    assert_int_equal(plain.state.event_count, faulty.state.event_count);
    for (size_t i = 0; i < plain.state.event_count; ++i) {
        assert_int_equal(plain.state.events[i].kind, faulty.state.events[i].kind);
        assert_int_equal(plain.state.events[i].wafer, faulty.state.events[i].wafer);
        assert_int_equal(plain.state.events[i].gripper, faulty.state.events[i].gripper);
    }
    compare_conditions(&plain.simulator.physics, &faulty.simulator.physics);
}

/* Returns the number of slices in which some gripper held a wafer. */
static int step_both(void) {
    int held = 0;
    for (int64_t seq = 1; seq <= SLICES; ++seq) {
        const wh_command_t command = any_command(seq);
        (void)wh_simulator_step(&plain.simulator, &command, &plain.state);
        (void)wh_simulator_step(&faulty.simulator, &command, &faulty.state);
        compare();
        held += plain.state.sensors != 0 ? 1 : 0;
    }
    return held;
}

static void ideal_vacuum_goes_both_ways(void **state) {
    (void)state;
    start_both();
    assert_true(step_both() > SLICES / 2);
}

/* Levels and sensors that a vacuum with another config left behind: the first slice corrects them. */
static void whatever_the_levels_were(void **state) {
    (void)state;
    for (int i = 0; i < 8; ++i) {
        start_both();
        for (int g = 0; g < GRIPPERS; ++g) {
            const wh_vacuum_t odd = {(wh_real_t)wh_test_uniform(0, 1), (int32_t)wh_test_below(2),
                                     wh_test_below(2) == 0, 0};
            plain.simulator.physics.vacuum[g] = odd;
            faulty.simulator.physics.vacuum[g] = odd;
        }
        assert_true(step_both() > SLICES / 2);
    }
}

/* Each of them alone keeps a level from being 0 or 1. */
static void vacuum_that_takes_time_or_is_never_gone(void **state) {
    wh_real_t *const times[] = {&physics.vacuum.build, &physics.vacuum.vent, &physics.vacuum.idle};
    (void)state;
    for (size_t i = 0; i < 3; ++i) {
        physics = wh_physics_default();
        *times[i] = WH_REAL(0.01);
        start_both();
        (void)step_both();
        int between = 0;
        for (int64_t seq = SLICES; seq < 2 * SLICES; ++seq) {
            const wh_command_t command = any_command(seq);
            (void)wh_simulator_step(&plain.simulator, &command, &plain.state);
            for (int g = 0; g < GRIPPERS; ++g) {
                const wh_real_t level = plain.simulator.physics.vacuum[g].level;
                between += level > 0 && level < 1 ? 1 : 0;
            }
        }
        assert_true(between > 0);
    }
}

static void thresholds_do_not_matter(void **state) {
    (void)state;
    physics.vacuum.on = 1;
    physics.vacuum.off = WH_REAL(0.01);
    physics.vacuum.release = 1;
    start_both();
    assert_true(step_both() > SLICES / 2);
}

static void pads_are_looked_at_on_both_ways(void **state) {
    (void)state;
    physics.pads.mass = WH_REAL(0.128);
    physics.pads.friction = WH_REAL(0.2);
    physics.pads.force = 4;
    physics.pads.gravity = WH_REAL(9.81);
    start_both();
    assert_true(step_both() > SLICES / 2);
}

/* From the very slice in which a command brings it. */
static void a_fault_is_not_overlooked(void **state) {
    (void)state;
    start_both();
    for (int64_t seq = 1; seq <= 2; ++seq) {
        wh_command_t command = any_command(seq);
        for (int g = 0; g < GRIPPERS; ++g) {
            command.grippers[g].base_from_gripper = wh_test_at(0, 100 * g, 0);
            command.grippers[g].valve = OPEN;
        }
        command.fault_count = seq == 1 ? 1 : 0;
        command.faults[0].fault = never();
        command.faults[0].fault.from = 1;
        assert_int_equal(wh_simulator_step(&plain.simulator, &command, &plain.state), WH_OK);
        assert_int_equal(plain.state.grippers[0].wafer, 0);
        assert_int_equal(plain.state.sensors, 0);
    }
}

static wh_gripper_input_t seen[GRIPPERS];

static void look(void *user, const wh_command_t *command, const wh_gripper_input_t inputs[],
                 const wh_grasp_t *table, wh_event_list_t *list) {
    (void)command;
    (void)user;
    (void)list;
    memcpy(seen, inputs, table->storage.gripper_count * sizeof inputs[0]);
}

static void an_observer_sees_the_steps_inputs(void **state) {
    way_t *const ways[] = {&plain, &faulty};
    (void)state;
    start_both();
    for (size_t i = 0; i < 2; ++i) {
        wh_command_t command;
        memset(&command, 0, sizeof command);
        command.gripper_count = GRIPPERS;
        command.seq = 1;
        for (int g = 0; g < GRIPPERS; ++g) {
            command.grippers[g].base_from_gripper = wh_test_at(g, 2 * g, 3 * g);
            command.grippers[g].valve = g & 1;
        }
        memset(seen, 0, sizeof seen);
        ways[i]->simulator.observer.look = look;
        assert_int_equal(wh_simulator_step(&ways[i]->simulator, &command, &ways[i]->state), WH_OK);
        for (int g = 0; g < GRIPPERS; ++g) {
            assert_memory_equal(&seen[g].base_from_gripper, &command.grippers[g].base_from_gripper,
                                sizeof(wh_pose_t));
            assert_int_equal(seen[g].valve, g & 1);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(ideal_vacuum_goes_both_ways, set_up),
        cmocka_unit_test_setup(whatever_the_levels_were, set_up),
        cmocka_unit_test_setup(vacuum_that_takes_time_or_is_never_gone, set_up),
        cmocka_unit_test_setup(thresholds_do_not_matter, set_up),
        cmocka_unit_test_setup(pads_are_looked_at_on_both_ways, set_up),
        cmocka_unit_test_setup(a_fault_is_not_overlooked, set_up),
        cmocka_unit_test_setup(an_observer_sees_the_steps_inputs, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
