/* The collision world's rules, one by one. */
#include <stdlib.h>

#include "collision/world.h"
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
static wh_pose_t effector;
static wh_gripper_input_t inputs[2];

static wh_part_t box_part(wh_part_kind_t kind, int owner, double x, double y, double z, wh_vec3_t size) {
    wh_part_t part = {.kind = kind, .owner = owner};
    part.convex.kind = WH_CONVEX_BOX;
    part.convex.half = wh_vec3_scale(WH_REAL(0.5), &size);
    part.convex.body_from_shape = wh_test_at(x, y, z);
    return part;
}

/* A thin wall at x = 1000; ledges of station 0's slots 1 and 2, left and right, their upper sides in the slots' planes;
 * then a blade 160 x 150 x 3, a hand, a forearm, and the chuck of station 2. */
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
    config.arm.reach = 250;
    config.arm.link = 350;
    config.wafer.kind = WH_CONVEX_CYLINDER;
    config.wafer.half = wh_vec3(150, 0, WH_REAL(0.3875));
    config.wafer.body_from_shape = wh_test_at(0, 0, WH_REAL(0.3875));
}

/* The effector stands at (400, 0, 897) looking along x; wafer 0 lies in slot 1, the others out of the way. */
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

/* What the table's last step left. */
static wh_world_input_t seen(void) {
    const wh_world_input_t input = {table.slice, table.storage.wafers, table.storage.grippers, effector};
    return input;
}

/* After the scene is as a test wants it. */
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

/* The effector goes there with this valve; returns how many events the world had. */
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
    assert_int_equal(go(400, 0, 950, WH_VALVE_CLOSED), 0); /* the first hit is the run's */
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

static void links_of_the_arm_are_neighbours(void **state) {
    (void)state;
    begin(); /* hand and forearm cut each other as they are described, blade and hand touch */
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
    wafers[0].base_from_wafer.r.z = 900 + 9.5; /* lies in slot 2, and so do its ledges' rules */
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
    parts[FIXED + 1].kind = WH_PART_FIXED; /* behind one that hangs */
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

int main(void) {
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_world, close_world)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        TEST(nothing_tunnels_through_a_thin_wall),
        TEST(a_blade_that_scrapes_a_wafer_is_named),
        TEST(a_blade_takes_its_wafer_without_a_hit),
        TEST(a_held_wafer_hits_a_ledge_of_another_slot),
        TEST(a_wafer_let_go_rests_where_it_is),
        TEST(letting_go_on_the_way_is_no_contact),
        TEST(a_wafer_that_was_put_elsewhere_is_there),
        TEST(links_of_the_arm_are_neighbours),
        TEST(a_limit_is_reported_once),
        TEST(a_full_list_loses_events_but_no_figures),
        TEST(cost_is_flat_in_what_rests_elsewhere),
        TEST(stepping_allocates_nothing),
        TEST(all_that_touches_before_a_run_is_found),
        TEST(bad_descriptions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
