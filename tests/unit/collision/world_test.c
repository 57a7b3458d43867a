/* The collision world's rules, one by one. */
#include <stdlib.h>

#include "collision/world_internal.h"
#include "support/heap.h"
#include "support/station.h"

enum { WAFERS = 3, FIXED = 5, PARTS = FIXED + 4, EVENTS = 8 };

static wh_part_t parts[PARTS];
static wh_world_config_t config;
static wh_grasp_t table;
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[2];
static wh_world_t *world;
static void *memory;
static wh_event_t events[EVENTS];
static wh_event_list_t list;
static const wh_arm_t arm = {.reach = 250, .link = 350};
static wh_pose_t effector, links[WH_ARM_BODIES], base_from_door;
static wh_gripper_input_t inputs[2];

static wh_part_t box_part(wh_part_kind_t kind, int owner, double x, double y, double z, wh_vec3_t size) {
    wh_part_t part = {.kind = kind, .owner = owner};
    part.convex.kind = WH_CONVEX_BOX;
    part.convex.half = wh_vec3_scale(WH_REAL(0.5), &size);
    part.convex.body_from_shape = wh_test_at(x, y, z);
    return part;
}

/* A thin wall at x = 1000; ledges of station 0's slots 1 and 2, left and right, their upper sides
 * in the slots' planes; then a blade 160 x 150 x 3, a hand, a forearm, and the chuck of station 2. */
static void describe(void) {
    parts[0] = box_part(WH_PART_FIXED, WH_NONE, 1000, 0, 900, wh_vec3(WH_REAL(0.02), 2000, 2000));
    for (int slot = 1; slot <= 2; ++slot) {
        for (int side = 0; side < 2; ++side) {
            wh_part_t *ledge = &parts[2 * slot - 1 + side];
            *ledge = box_part(WH_PART_LEDGE, 0, 700, side == 0 ? 145 : -145, 890 + 10 * slot - WH_REAL(0.25),
                              wh_vec3(100, 10, WH_REAL(0.5)));
            ledge->slot = slot;
        }
    }
    parts[FIXED] = box_part(WH_PART_BLADE, 0, 0, 0, -1.5, wh_vec3(160, 150, 3));
    parts[FIXED + 1] = box_part(WH_PART_ARM, WH_ARM_HAND, 0, 0, -10, wh_vec3(20, 20, 10));
    parts[FIXED + 2] = box_part(WH_PART_ARM, WH_ARM_FOREARM, 150, 0, -80, wh_vec3(300, 60, 30));
    parts[FIXED + 3] = box_part(WH_PART_CHUCK, 1, 0, 0, -10, wh_vec3(60, 60, 20));
    config =
        (wh_world_config_t){.parts = parts, .part_count = PARTS, .gripper_count = 2, .wafer_count = WAFERS};
    config.cell = &cell;
    config.grasp = &table.config;
    config.wafer.kind = WH_CONVEX_CYLINDER;
    config.wafer.half = wh_vec3(150, 0, WH_REAL(0.3875));
    config.wafer.body_from_shape = wh_test_at(0, 0, WH_REAL(0.3875));
}

/* The effector stands at (400, 0, 897) and points along x; wafer 0 lies in slot 1, the others out
 * of the way. */
static int open_world(void **state) {
    set_up(state);
    describe();
    wafers[0].base_from_wafer = wh_test_at(700, 0, 900);
    wafers[1].base_from_wafer = wh_test_at(0, 2000, 0);
    wafers[2].base_from_wafer = wh_test_at(0, 3000, 0);
    const wh_grasp_config_t grasp = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, 2, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &grasp, &storage), WH_OK);
    effector = wh_test_at(400, 0, 897);
    inputs[0] = (wh_gripper_input_t){effector, WH_VALVE_CLOSED};
    inputs[1] = (wh_gripper_input_t){stations[2].base_from_station, WH_VALVE_CLOSED};
    assert_int_equal(wh_world_validate(&config, NULL), WH_OK);
    return 0;
}

/* The result of the table's last step. */
static wh_world_input_t seen(void) {
    wh_arm_place(&arm, &effector, links);
    const wh_world_input_t input = {table.slice, table.storage.wafers, table.storage.grippers, links,
                                    &base_from_door};
    return input;
}

/* Call this once the scene is as a test wants it. */
static void begin(void) {
    grippers[0].base_from_gripper = inputs[0].base_from_gripper;
    grippers[1].base_from_gripper = inputs[1].base_from_gripper;
    memory = malloc(wh_world_bytes(&config));
    const wh_world_input_t input = seen();
    world = wh_world_init(&config, &input, memory, wh_world_bytes(&config));
    assert_non_null(world);
}

static int close_world(void **state) {
    (void)state;
    free(memory);
    memory = NULL;
    return 0;
}

/* Moves the effector there with this valve; returns how many events the world had. */
static size_t go(double x, double y, double z, int valve) {
    wh_event_t steps[2 * WH_EVENTS_PER_GRIPPER];
    wh_event_list_t picks = {steps, 2 * WH_EVENTS_PER_GRIPPER, 0};
    effector = wh_test_at(x, y, z);
    inputs[0].base_from_gripper = effector;
    inputs[0].valve = valve;
    assert_int_equal(wh_grasp_step(&table, inputs, &picks), WH_OK);
    list = (wh_event_list_t){events, EVENTS, 0};
    const wh_world_input_t input = seen();
    wh_world_step(world, &input, &list);
    return list.count;
}

static const wh_clearance_t *least(wh_clearance_kind_t kind) {
    return &wh_world_clearances(world)[kind];
}

static bool is_pair(const int32_t pair[2], int a, int b) {
    return (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
}

/* ------------------------------------------------------------------------------------------------------- contact */

static void nothing_tunnels_through_a_thin_wall(void **state) {
    (void)state;
    begin();
    assert_int_equal(go(400, 0, 950, WH_VALVE_CLOSED), 0);
    assert_int_equal(go(1300, 0, 950, WH_VALVE_CLOSED), 1);
    assert_int_equal(events[0].kind, WH_EVENT_HIT);
    assert_true(is_pair(events[0].parts, 0, FIXED) || is_pair(events[0].parts, 0, FIXED + 1) ||
                is_pair(events[0].parts, 0, FIXED + 2));
    assert_int_equal(events[0].slice, 2);
    assert_near(events[0].at.x, 1000, 400);
    assert_true(least(WH_CLEARANCE_BLADE_OTHER)->gap <= 0 || least(WH_CLEARANCE_ARM_OTHER)->gap <= 0);
    assert_int_equal(go(400, 0, 950, WH_VALVE_CLOSED), 0); /* the first hit counts for the run */
}

static void a_blade_that_scrapes_a_wafer_is_named(void **state) {
    (void)state;
    begin();
    assert_int_equal(go(520, 0, 900.5, WH_VALVE_CLOSED), 1);
    assert_int_equal(events[0].kind, WH_EVENT_HIT);
    assert_true(is_pair(events[0].parts, FIXED, PARTS));
    assert_int_equal(events[0].wafer, 0);
    assert_int_equal(events[0].gripper, 0);
    assert_near(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->gap + least(WH_CLEARANCE_BLADE_WAFER_BELOW)->gap,
                WH_CLEARANCE_RANGE, 0);
}

static void a_blade_takes_its_wafer_without_a_hit(void **state) {
    (void)state;
    begin();
    assert_int_equal(go(700, 0, 897, WH_VALVE_CLOSED), 0);
    assert_near(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->gap, 3, 1e-3);
    assert_int_equal(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->slice, 1);
    for (int step = 0; step <= 12; ++step) {
        assert_int_equal(go(700, 0, 897 + 0.5 * step, WH_VALVE_OPEN), 0);
    }
    assert_int_equal(grippers[0].wafer, 0);
    assert_int_equal(go(640, 0, 903, WH_VALVE_OPEN), 0); /* out of the slot: now its ledges count */
    assert_near(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->gap, 3, 1e-3);
    assert_near(least(WH_CLEARANCE_WAFER_LEDGE)->gap, 3, 1e-3);
}

/* It lies on its ledges, but not in the middle of its slot. */
static void a_wafer_aside_is_taken_without_a_hit(void **state) {
    (void)state;
    wafers[0].base_from_wafer = wh_test_at(712, -9, 900);
    begin();
    assert_int_equal(go(712, -9, 897, WH_VALVE_CLOSED), 0);
    for (int step = 0; step <= 12; ++step) {
        assert_int_equal(go(712, -9, 897 + 0.5 * step, WH_VALVE_OPEN), 0);
    }
    assert_int_equal(grippers[0].wafer, 0);
    for (int step = 12; step >= 5; --step) {
        assert_int_equal(go(712, -9, 897 + 0.5 * step, WH_VALVE_OPEN), 0);
    }
    for (int step = 5; step >= 0; --step) {
        assert_int_equal(go(712, -9, 897 + 0.5 * step, WH_VALVE_CLOSED), 0);
    }
    assert_int_equal(grippers[0].wafer, WH_NONE);
}

static void a_held_wafer_hits_a_ledge_of_another_slot(void **state) {
    (void)state;
    begin();
    go(700, 0, 899.7, WH_VALVE_OPEN);
    assert_int_equal(grippers[0].wafer, 0);
    assert_int_equal(go(700, 0, 903, WH_VALVE_OPEN), 0);
    assert_int_equal(go(700, 0, 912, WH_VALVE_OPEN), 1);
    assert_int_equal(events[0].kind, WH_EVENT_HIT);
    assert_int_equal(events[0].wafer, 0);
    assert_true(events[0].parts[0] == 3 || events[0].parts[0] == 4 || events[0].parts[1] == 3 ||
                events[0].parts[1] == 4);
}

static void a_wafer_let_go_rests_where_it_is(void **state) {
    (void)state;
    begin();
    go(700, 0, 899.7, WH_VALVE_OPEN);
    go(700, 0, 903, WH_VALVE_OPEN);
    go(400, 0, 903, WH_VALVE_OPEN);
    assert_int_equal(go(400, 0, 903, WH_VALVE_CLOSED), 0);
    assert_int_equal(grippers[0].wafer, WH_NONE);
    assert_int_equal(go(400, 0, 899, WH_VALVE_CLOSED), 0); /* down from it */
    assert_int_equal(go(340, 0, 899, WH_VALVE_CLOSED), 0);
    assert_int_equal(go(400, 0, 904.5, WH_VALVE_CLOSED), 1); /* and up into it */
    assert_int_equal(events[0].kind, WH_EVENT_HIT);
    assert_int_equal(events[0].wafer, 0);
}

static void letting_go_on_the_way_is_no_contact(void **state) {
    (void)state;
    config.limits[WH_CLEARANCE_BLADE_WAFER_ABOVE] = 1;
    begin();
    go(700, 0, 899.7, WH_VALVE_OPEN);
    go(700, 0, 903, WH_VALVE_OPEN);
    go(400, 0, 903, WH_VALVE_OPEN);
    assert_int_equal(go(400.2, 0, 902.9, WH_VALVE_CLOSED), 0);
    assert_int_equal(grippers[0].wafer, WH_NONE);
    assert_int_equal(go(400.2, 0, 899, WH_VALVE_CLOSED), 0);
    assert_near(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->gap, WH_CLEARANCE_RANGE, 0);
}

static void a_wafer_that_was_put_elsewhere_is_there(void **state) {
    (void)state;
    begin();
    const wh_pose_t there = wh_test_at(400, 0, 950);
    assert_int_equal(wh_grasp_place(&table, 1, &there), WH_OK);
    wh_world_place(world, 1, &wafers[1].base_from_wafer);
    assert_int_equal(go(400, 0, 951, WH_VALVE_CLOSED), 1);
    assert_int_equal(events[0].wafer, 1);
}

/* Earlier results for two held wafers do not help for the next one, to which the blade went empty. */
static void the_next_wafer_hits_one_on_another_gripper(void **state) {
    (void)state;
    inputs[1] = (wh_gripper_input_t){wh_test_at(300, 600, 950), WH_VALVE_OPEN};
    wafers[1].base_from_wafer = inputs[1].base_from_gripper;
    wafers[2].base_from_wafer = wh_test_at(400, 180, 970);
    begin();
    size_t count = go(400, 0, 897, WH_VALVE_CLOSED);
    assert_int_equal(grippers[1].wafer, 1);
    count += go(700, 0, 897, WH_VALVE_CLOSED);
    count += go(700, 0, 899.7, WH_VALVE_OPEN);
    count += go(700, 0, 903, WH_VALVE_OPEN);
    count += go(400, 0, 903, WH_VALVE_OPEN);
    count += go(400, -300, 903, WH_VALVE_OPEN);
    count += go(400, -300, 903, WH_VALVE_CLOSED);
    count += go(400, -300, 895, WH_VALVE_CLOSED);
    for (int y = -300; y <= 180; y += 10) {
        count += go(400, y, 895, WH_VALVE_CLOSED);
    }
    count += go(400, 180, 969.7, WH_VALVE_OPEN);
    count += go(400, 180, 972, WH_VALVE_OPEN);
    assert_int_equal(count, 0);
    assert_int_equal(grippers[0].wafer, 2);
    assert_int_equal(go(400, 330, 950, WH_VALVE_OPEN), 1);
    assert_int_equal(events[0].kind, WH_EVENT_HIT);
    assert_true(is_pair(events[0].parts, PARTS + 1, PARTS + 2));
}

static void links_of_the_arm_are_neighbours(void **state) {
    (void)state;
    begin(); /* hand and forearm overlap as described, blade and hand touch */
    for (int step = 0; step < 20; ++step) {
        assert_int_equal(go(400 + 5 * step, 10 * step, 960, WH_VALVE_CLOSED), 0);
    }
}

/* -------------------------------------------------------------------------------------------------- clearances */

static void a_limit_is_reported_once(void **state) {
    (void)state;
    config.limits[WH_CLEARANCE_BLADE_WAFER_ABOVE] = 2;
    begin();
    assert_int_equal(go(560, 0, 897, WH_VALVE_CLOSED), 0);
    assert_int_equal(go(560, 0, 898.5, WH_VALVE_CLOSED), 1);
    assert_int_equal(events[0].kind, WH_EVENT_TOO_CLOSE);
    assert_near(events[0].value, 1.5, 1e-3);
    assert_near(events[0].limit, 2, 0);
    assert_int_equal(go(560, 0, 899, WH_VALVE_CLOSED), 0);
    assert_near(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->gap, 1, 1e-3);
    assert_int_equal(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->slice, 3);
    assert_true(is_pair(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->parts, FIXED, PARTS));
}

static void a_full_list_loses_events_but_no_figures(void **state) {
    (void)state;
    begin();
    effector = wh_test_at(520, 0, 900.5);
    inputs[0].base_from_gripper = effector;
    assert_int_equal(wh_grasp_step(&table, inputs, NULL), WH_OK);
    const wh_world_input_t input = seen();
    wh_world_step(world, &input, NULL);
    assert_int_equal(go(520, 0, 900.6, WH_VALVE_CLOSED), 0);
    assert_near(least(WH_CLEARANCE_BLADE_WAFER_ABOVE)->gap * least(WH_CLEARANCE_BLADE_WAFER_BELOW)->gap, 0,
                0);
}

static void cost_is_flat_in_what_rests_elsewhere(void **state) {
    enum { MANY = 20000 };
    static wh_wafer_t many[MANY];
    wh_world_counters_t counters[2];
    (void)state;
    for (int round = 0; round < 2; ++round) {
        const size_t count = round == 0 ? WAFERS : MANY;
        for (size_t w = 0; w < count; ++w) {
            many[w].base_from_wafer =
                w < WAFERS ? wafers[w].base_from_wafer
                           : wh_test_at(5000 + 400 * (double)(w % 50), 5000, 10 * (double)(w / 50));
        }
        const wh_grasp_config_t grasp = wh_grasp_config_default();
        const wh_grasp_storage_t storage = {many, count, grippers, 2, NULL, 0};
        assert_int_equal(wh_grasp_init(&table, &grasp, &storage), WH_OK);
        config.wafer_count = count;
        effector = inputs[0].base_from_gripper = wh_test_at(400, 0, 897);
        begin();
        for (int step = 0; step < 300; ++step) {
            assert_int_equal(go(400 + step, 0, 897, WH_VALVE_CLOSED), 0);
        }
        counters[round] = *wh_world_counters(world);
        free(memory);
    }
    memory = NULL;
    assert_memory_equal(&counters[0], &counters[1], sizeof counters[0]);
    assert_true(counters[0].pairs > 0 && counters[0].measured > 0);
}

static void stepping_allocates_nothing(void **state) {
    (void)state;
#if defined(WH_TEST_COUNTS_HEAP)
    begin();
    const unsigned long before = calls;
    for (int step = 0; step < 300; ++step) {
        (void)go(400 + step, 0, 897, WH_VALVE_CLOSED);
    }
    for (int step = 0; step < 60; ++step) {
        (void)go(700, 0, 897 + 0.1 * step, WH_VALVE_OPEN);
    }
    assert_int_equal(grippers[0].wafer, 0);
    for (int step = 0; step < 300; ++step) {
        (void)go(700 - step, 0, 903 + 0.05 * step, WH_VALVE_OPEN); /* into the ledges of the next slot */
    }
    assert_true(wh_world_counters(world)->measured > 50 && wh_world_counters(world)->relisted > 5);
    assert_int_equal(calls - before, 0);
#else
    skip();
#endif
}

/* ------------------------------------------------------------------------------------------------ before a run */

static void all_that_touches_before_a_run_is_found(void **state) {
    int32_t found[4][2];
    (void)state;
    begin();
    const wh_world_input_t input = seen();
    assert_int_equal(wh_world_check_rest(world, &input, found, 4), 0);
    free(memory);
    wafers[0].base_from_wafer.r.z = 900 + 9.5; /* it lies in slot 2, so that slot's ledge rules apply */
    begin();
    assert_int_equal(wh_world_check_rest(world, &input, found, 4), 0);
    free(memory);
    wafers[0].base_from_wafer.r.x = 900;
    begin();
    const size_t count = wh_world_check_rest(world, &input, found, 4);
    assert_true(count >= 1 && count <= 4);
    assert_true(is_pair(found[0], 0, PARTS));
    assert_int_equal(wh_world_check_rest(world, &input, NULL, 0), count);
    for (size_t i = 0; i < count; ++i) {
        for (size_t k = i + 1; k < count; ++k) {
            assert_false(is_pair(found[i], found[k][0], found[k][1]));
        }
    }
}

static void bad_descriptions_are_refused(void **state) {
    int32_t part = 77;
    (void)state;
    assert_int_equal(wh_world_validate(NULL, &part), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(part, WH_NONE);
    parts[1].slot = 26;
    assert_int_equal(wh_world_validate(&config, &part), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(part, 1);
    parts[1].slot = 1;
    parts[FIXED].owner = 2;
    assert_int_equal(wh_world_validate(&config, &part), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(part, FIXED);
    parts[FIXED].owner = 0;
    parts[FIXED + 1].kind = WH_PART_FIXED; /* it stands behind a hanging part */
    assert_int_equal(wh_world_validate(&config, &part), WH_STATUS_OUT_OF_RANGE);
    parts[FIXED + 1].kind = WH_PART_WAFER;
    assert_int_equal(wh_world_validate(&config, &part), WH_STATUS_OUT_OF_RANGE);
    parts[FIXED + 1].kind = WH_PART_ARM;
    parts[0].convex.half.x = 0;
    assert_int_not_equal(wh_world_validate(&config, &part), WH_OK);
    assert_int_equal(part, 0);
    parts[0].convex.half.x = 1;
    config.gripper_count = WH_WORLD_GRIPPERS + 1;
    assert_int_equal(wh_world_validate(&config, &part), WH_STATUS_BAD_CAPACITY);
    config.gripper_count = 2;
    const wh_world_input_t input = seen();
    assert_null(wh_world_init(&config, &input, events, 8));
}

/* -------------------------------------------------------------------------------------------- robots' links */

/* On a rail that leads sideways, with a column that tilts. */
static wh_chain_t chain_of(wh_chain_kind_t kind) {
    wh_chain_t chain = {.kind = kind, .is_placed = true, .has_rail = true, .has_tilt = true};
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        chain.travel[axis] = (wh_travel_t){-1, 1};
        chain.limits[axis] = (wh_limits_t){1, 10, 100};
    }
    chain.travel[WH_CHAIN_REACH].min = 0;
    chain.links[0] = 300;
    chain.links[1] = 400;
    chain.base_from_robot = wh_test_at(100, 200, 30);
    chain.base_from_robot.R = wh_mat3_from_rpy_deg(0, 0, 90);
    return chain;
}

static void assert_way(const wh_pose_t *from, double along, const wh_pose_t *to) {
    const wh_vec3_t x = wh_mat3_column(&from->R, 0);
    const wh_vec3_t way = wh_vec3_scale(along, &x);
    const wh_vec3_t there = wh_vec3_add(&from->r, &way);
    const wh_vec3_t off = wh_vec3_subtract(&there, &to->r);
    assert_true(wh_vec3_norm(&off) < 1e-9);
}

/* This is the distance of the elbow from the line between shoulder and wrist, in the arm's own plane. */
static double aside(const wh_pose_t bodies[]) {
    const wh_vec3_t out = wh_vec3_subtract(&bodies[WH_ARM_HAND].r, &bodies[WH_ARM_UPPER].r);
    const wh_vec3_t elbow = wh_vec3_subtract(&bodies[WH_ARM_FOREARM].r, &bodies[WH_ARM_UPPER].r);
    const wh_vec3_t normal = wh_mat3_column(&bodies[WH_ARM_UPPER].R, 2);
    const wh_vec3_t across = wh_vec3_cross(&out, &elbow);
    return wh_vec3_dot(&across, &normal);
}

/* Each link begins where the one before it ends, and the last one carries the end-effector. */
static void links_of_every_kind_hang_together(void **state) {
    static const wh_real_t axes[][7] = {{0.3, 700, 900, 0.2, 120, 0.05, -0.03},
                                        {-2, 420, 650, 1.5, -300, -0.2, 0.1},
                                        {1, 610, 700, 0, 0, 0, 0.3}};
    (void)state;
    for (int i = 0; i < 9; ++i) {
        const wh_chain_kind_t kind = (wh_chain_kind_t)(i % 3);
        const wh_chain_t chain = chain_of(kind);
        const bool is_scara = kind == WH_CHAIN_SCARA;
        const wh_arm_t polar = {.reach = 250, .link = 400, .right_handed = i > 4};
        wh_carrier_t carrier;
        wh_real_t q[7];
        wh_pose_t bodies[WH_ARM_BODIES];
        wh_pose_t end;
        memcpy(q, axes[i / 3], sizeof q);
        q[1] = is_scara ? 0.5 * (i / 3 - 1) + 0.7 : q[1];
        q[3] = kind == WH_CHAIN_TRZ ? 0 : q[3];
        assert_int_equal(wh_carrier_init(&carrier, &chain), WH_OK);
        carrier.forward(&carrier, q, &end);
        wh_arm_place_carrier(&polar, &carrier, q, NULL, bodies);
        const wh_vec3_t foot = wh_vec3(100, 200 + q[4], 30);
        const wh_vec3_t lift = wh_vec3(100, 200 + q[4], 30 + q[2]);
        assert_near(bodies[WH_ARM_BASE].r.x - foot.x, 0, 1e-9);
        assert_near(bodies[WH_ARM_BASE].r.y - foot.y, 0, 1e-9);
        assert_near(bodies[WH_ARM_BASE].r.z - foot.z, 0, 1e-9);
        assert_near(bodies[WH_ARM_LIFT].r.z - lift.z, 0, 1e-9);
        assert_near(bodies[WH_ARM_LIFT].R.m[2][2], 1, 1e-15);
        assert_way(&bodies[WH_ARM_LIFT], 0, &bodies[WH_ARM_UPPER]);
        assert_way(&bodies[WH_ARM_UPPER], is_scara ? 300 : 400, &bodies[WH_ARM_FOREARM]);
        assert_way(&bodies[WH_ARM_FOREARM], 400, &bodies[WH_ARM_HAND]);
        assert_way(&bodies[WH_ARM_HAND], is_scara ? 0 : 250, &end);
        assert_true((aside(bodies) < 0) == (is_scara ? q[1] > 0 : polar.right_handed));
        for (int k = 0; k < 9; ++k) {
            assert_near(bodies[WH_ARM_HAND].R.m[k / 3][k % 3], end.R.m[k / 3][k % 3], 1e-12);
            assert_near(bodies[WH_ARM_UPPER].R.m[k / 3][2], end.R.m[k / 3][2], 1e-12);
            assert_near(bodies[WH_ARM_FOREARM].R.m[k / 3][2], end.R.m[k / 3][2], 1e-12);
        }
    }
}

/* A second robot beside the first: its hand must not touch what the first robot's hand must not touch. */
static void parts_of_two_robots_are_judged(void **state) {
    (void)state;
    static const wh_world_arm_t arms[] = {{0, WH_ARM_BASE}, {1, WH_ARM_BASE}, {1, WH_ARM_UPPER}};
    static const uint8_t carried_by[] = {0, WH_WORLD_NO_ARM};
    config.arm_count = 3;
    config.arms = arms;
    config.carried_by = carried_by;
    assert_int_equal(wh_world_validate(&config, NULL), WH_OK);
    static const struct {
        int32_t one, other; /* numbers of bodies */
        bool together;
    } rows[] = {
        {WH_ARM_HAND, WH_ARM_FOREARM, true},
        {WH_ARM_HAND, WH_ARM_BODIES + WH_ARM_FOREARM, false},
        {WH_ARM_BASE, WH_ARM_BODIES + WH_ARM_BASE, false},
        {WH_ARM_BODIES + WH_ARM_LIFT, 2 * WH_ARM_BODIES + WH_ARM_UPPER, true},
        {WH_ARM_BODIES + WH_ARM_UPPER, 2 * WH_ARM_BODIES + WH_ARM_UPPER, true},
        {WH_ARM_BODIES + WH_ARM_UPPER, 2 * WH_ARM_BODIES + WH_ARM_FOREARM, false},
        {WH_ARM_BODIES + WH_ARM_FOREARM, 2 * WH_ARM_BODIES + WH_ARM_FOREARM, false},
        {WH_ARM_LIFT, 2 * WH_ARM_BODIES + WH_ARM_UPPER, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        const wh_part_t one = {.kind = WH_PART_ARM, .owner = rows[i].one};
        const wh_part_t other = {.kind = WH_PART_ARM, .owner = rows[i].other};
        assert_int_equal(wh_world_belong_together(&config, &one, &other), rows[i].together);
        assert_int_equal(wh_world_belong_together(&config, &other, &one), rows[i].together);
    }
    const wh_part_t blade = {.kind = WH_PART_BLADE, .owner = 0};
    const wh_part_t hand = {.kind = WH_PART_ARM, .owner = WH_ARM_HAND};
    const wh_part_t other_hand = {.kind = WH_PART_ARM, .owner = WH_ARM_BODIES + WH_ARM_HAND};
    assert_true(wh_world_belong_together(&config, &blade, &hand));
    assert_false(wh_world_belong_together(&config, &blade, &other_hand));
}

/* At one wrist both hands are on one axis, and each blade passes the other hand. Only the blades
 * themselves are checked. */
static void hands_at_one_wrist_belong_together(void **state) {
    (void)state;
    static const wh_world_arm_t arms[] = {{0, WH_ARM_BASE}, {0, WH_ARM_HAND}};
    static const uint8_t carried_by[] = {0, 1};
    config.arm_count = 2;
    config.arms = arms;
    config.carried_by = carried_by;
    const wh_part_t hand = {.kind = WH_PART_ARM, .owner = WH_ARM_BODIES + WH_ARM_HAND};
    const wh_part_t first_hand = {.kind = WH_PART_ARM, .owner = WH_ARM_HAND};
    const wh_part_t forearm = {.kind = WH_PART_ARM, .owner = WH_ARM_FOREARM};
    const wh_part_t upper = {.kind = WH_PART_ARM, .owner = WH_ARM_UPPER};
    const wh_part_t blade = {.kind = WH_PART_BLADE, .owner = 0};
    const wh_part_t second = {.kind = WH_PART_BLADE, .owner = 1};
    assert_true(wh_world_belong_together(&config, &hand, &first_hand));
    assert_true(wh_world_belong_together(&config, &hand, &forearm));
    assert_false(wh_world_belong_together(&config, &hand, &upper));
    assert_true(wh_world_belong_together(&config, &hand, &blade));
    assert_false(wh_world_belong_together(&config, &blade, &second));
}

static void arms_beyond_the_room_are_refused(void **state) {
    (void)state;
    static const wh_world_arm_t arms[WH_WORLD_ARMS + 1];
    static const uint8_t bad[] = {2, 0};
    static const uint8_t good[] = {1, 0};
    config.arm_count = 2;
    assert_int_equal(wh_world_validate(&config, NULL), WH_STATUS_NULL_ARGUMENT);
    config.arms = arms;
    config.carried_by = bad;
    assert_int_equal(wh_world_validate(&config, NULL), WH_STATUS_OUT_OF_RANGE);
    config.carried_by = good;
    assert_int_equal(wh_world_validate(&config, NULL), WH_OK);
    config.arm_count = WH_WORLD_ARMS + 1;
    assert_int_equal(wh_world_validate(&config, NULL), WH_STATUS_BAD_CAPACITY);
}

/* Instead of the chuck, a door hangs in its frame, the wall. It moves down from above: through the
 * wall, and then onto wafer 0 or beside it. */
static void lower_door(double x, size_t *hits, double *z) {
    free(memory);
    parts[FIXED + 3] = box_part(WH_PART_DOOR, 0, 0, 0, 0, wh_vec3(20, 100, 100));
    config.door_count = 1;
    base_from_door = wh_test_at(x, 0, 1100);
    assert_int_equal(wh_world_validate(&config, NULL), WH_OK);
    memory = malloc(wh_world_bytes(&config));
    wh_world_input_t input = seen();
    world = wh_world_init(&config, &input, memory, wh_world_bytes(&config));
    list = (wh_event_list_t){events, EVENTS, 0};
    for (*z = 1100; *z > 800 && list.count == 0; *z -= 1) {
        base_from_door.r.z = (wh_real_t)*z;
        input = seen();
        wh_world_step(world, &input, &list);
    }
    *hits = list.count;
}

static void a_door_passes_its_frame_and_hits_what_is_in_its_way(void **state) {
    (void)state;
    size_t hits = 0;
    double z = 0;
    lower_door(1000, &hits, &z); /* in the wall */
    assert_int_equal(hits, 0);
    lower_door(700, &hits, &z);
    assert_int_equal(hits, 1);
    assert_int_equal(events[0].kind, WH_EVENT_HIT);
    assert_int_equal(events[0].wafer, 0);
    assert_near(z, 949, 1.5); /* its lower side reached the wafer's upper one */
    config.door_count = 0;
    assert_int_equal(wh_world_validate(&config, NULL), WH_STATUS_OUT_OF_RANGE);
    config.door_count = WH_WORLD_DOORS + 1;
    assert_int_equal(wh_world_validate(&config, NULL), WH_STATUS_BAD_CAPACITY);
}

int main(void) {
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_world, close_world)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        TEST(nothing_tunnels_through_a_thin_wall),
        TEST(a_blade_that_scrapes_a_wafer_is_named),
        TEST(a_blade_takes_its_wafer_without_a_hit),
        TEST(a_wafer_aside_is_taken_without_a_hit),
        TEST(a_held_wafer_hits_a_ledge_of_another_slot),
        TEST(a_wafer_let_go_rests_where_it_is),
        TEST(letting_go_on_the_way_is_no_contact),
        TEST(a_wafer_that_was_put_elsewhere_is_there),
        TEST(the_next_wafer_hits_one_on_another_gripper),
        TEST(links_of_the_arm_are_neighbours),
        TEST(a_limit_is_reported_once),
        TEST(a_full_list_loses_events_but_no_figures),
        TEST(cost_is_flat_in_what_rests_elsewhere),
        TEST(stepping_allocates_nothing),
        TEST(all_that_touches_before_a_run_is_found),
        TEST(bad_descriptions_are_refused),
        TEST(links_of_every_kind_hang_together),
        TEST(parts_of_two_robots_are_judged),
        TEST(hands_at_one_wrist_belong_together),
        TEST(arms_beyond_the_room_are_refused),
        TEST(a_door_passes_its_frame_and_hits_what_is_in_its_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
