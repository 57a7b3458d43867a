/* The simulator's state: which ones are refused, and which fields the hash covers. */
#include "support/faults.h"

#if defined(WH_FLOAT)
#define HASH UINT64_C(0xded51337dbb365d2)
#else
#define HASH UINT64_C(0xf24464e63c42ba4a)
#endif

static void conditions_that_no_simulator_leaves(void **state) {
    (void)state;
    wh_fault_t f = fault_of(WH_FAULT_WAFER_SHIFTED, 0);
    bring(0, &f);
    step(880, CLOSED);
    const wh_physics_state_t good = simulator.physics;
    wh_physics_state_t bad[15];
    for (size_t i = 0; i < 15; ++i) {
        bad[i] = good;
    }
    bad[0].vacuum[1].command = 2;
    bad[1].told[1] = -1;
    bad[2].carry[1].before[0].z = (wh_real_t)NAN;
    bad[3].carry[0].before[1].x = (wh_real_t)NAN;
    bad[4].vacuum[0].level = WH_REAL(1.001);
    bad[5].vacuum[0].level = (wh_real_t)NAN;
    bad[6].carry[0].known = 3;
    bad[7].carry[0].known = -1;
    bad[8].faults.slots[0].fault.from = 0;
    bad[9].faults.slots[0].placed.r.x = (wh_real_t)NAN;
    bad[10].faults.slots[0].before.R.m[0][0] = 2;
    bad[11].faults.slots[0].phase = (wh_fault_phase_t)5;
    bad[12].carry[0].before[0].y = (wh_real_t)INFINITY;
    bad[13].vacuum[1].level = WH_REAL(-0.001);
    bad[14].faults.slots[0].fault = fault_of(WH_FAULT_SENSOR_ON, 0); /* takes no wafer */
    bad[14].faults.slots[0].phase = WH_FAULT_TAKEN;
    assert_int_equal(wh_physics_state_validate(&good, GRIPPERS, WAFERS), WH_OK);
    for (size_t i = 0; i < 15; ++i) {
        assert_int_not_equal(wh_physics_state_validate(&bad[i], GRIPPERS, WAFERS), WH_OK);
    }
    wh_physics_state_t more = good;
    more.faults.count = WH_FAULTS + 1;
    assert_int_not_equal(wh_physics_state_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more = good;
    more.vacuum[0].command = OPEN;
    more.told[0] = OPEN;
    assert_int_equal(wh_physics_state_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more = good;
    more.vacuum[GRIPPERS].level = 7; /* beyond the existing ones */
    more.faults.count = 2;           /* a free slot */
    assert_int_equal(wh_physics_state_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more.faults.slots[0].phase = WH_FAULT_OVER; /* its poses do not matter any more */
    more.faults.slots[0].placed.r.x = (wh_real_t)NAN;
    assert_int_equal(wh_physics_state_validate(&more, GRIPPERS, WAFERS), WH_OK);
    more.faults.slots[0].phase = WH_FAULT_TAKEN;
    assert_int_equal(wh_physics_state_validate(&more, GRIPPERS, WAFERS), WH_OK);
}

/* A fault of gripper 1, with 2 grippers and 1 wafer, and the other way round. */
static void grippers_and_wafers_are_counted_apart(void **state) {
    (void)state;
    wh_physics_t physics = wh_physics_default();
    physics.faults[0] = fault_of(WH_FAULT_SENSOR_ON, 1);
    physics.fault_count = 1;
    wh_physics_state_t condition;
    wh_physics_state_start(&condition, &physics);
    assert_int_equal(wh_physics_validate(&physics, 2, 1), WH_OK);
    assert_int_equal(wh_physics_validate(&physics, 1, 2), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_physics_state_validate(&condition, 2, 1), WH_OK);
    assert_int_equal(wh_physics_state_validate(&condition, 1, 2), WH_STATUS_OUT_OF_RANGE);
}

/* A state has room for WH_GRIPPERS. Under the address sanitizer this shows that nothing beyond is read. */
static void more_grippers_than_there_is_room_for(void **state) {
    (void)state;
    static const size_t counts[] = {WH_GRIPPERS + 1, 33, 1000000, SIZE_MAX};
    wh_physics_t physics = wh_physics_default();
    const size_t size = sizeof(wh_physics_state_t);
    wh_physics_state_t *const alone = malloc(size);
    assert_non_null(alone);
    wh_physics_state_start(alone, &physics);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        alone->vacuum[g].on = true;
    }
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        assert_int_equal(wh_physics_state_validate(alone, counts[i], WAFERS), WH_STATUS_BAD_CAPACITY);
        assert_int_equal(wh_physics_validate(&physics, counts[i], WAFERS), WH_STATUS_BAD_CAPACITY);
        assert_int_equal(wh_physics_state_sensors(alone, counts[i]), (1U << WH_GRIPPERS) - 1);
    }
    assert_int_equal(wh_physics_state_validate(alone, WH_GRIPPERS, WAFERS), WH_OK);
    assert_int_equal(wh_physics_validate(&physics, WH_GRIPPERS, WAFERS), WH_OK);
    free(alone);
}

/* A table of its own may have more grippers than a simulator: the hash covers those that a state
 * can contain. */
static void a_large_table_has_a_hash(void **state) {
    (void)state;
    static wh_gripper_t many[WH_GRIPPERS + 3];
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, many, WH_GRIPPERS + 3, NULL, 0};
    wh_grasp_t table;
    assert_int_equal(wh_grasp_init(&table, &config, &storage), WH_OK);
    const wh_physics_t physics = wh_physics_default();
    wh_physics_state_t *const alone = malloc(sizeof *alone);
    assert_non_null(alone);
    wh_physics_state_start(alone, &physics);
    assert_true(wh_physics_state_hash(alone, &table) == wh_grasp_hash(&table));
    free(alone);
}

static void no_sensor_is_beyond_the_last_gripper(void **state) {
    (void)state;
    static const int32_t targets[] = {WH_GRIPPERS, 31, 32, 99, INT32_MAX};
    wh_faults_t faults;
    for (size_t i = 0; i < 5; ++i) {
        for (int off = 0; off < 2; ++off) {
            wh_faults_clear(&faults);
            faults.count = 1;
            faults.slots[0].phase = WH_FAULT_ACTING;
            faults.slots[0].fault = fault_of(off ? WH_FAULT_SENSOR_OFF : WH_FAULT_SENSOR_ON, targets[i]);
            assert_int_equal(wh_faults_sensors(&faults, 5), 5);
        }
    }
}

static void null_is_refused(void **state) {
    (void)state;
    wh_faults_t faults;
    wh_faults_clear(&faults);
    assert_int_equal(wh_physics_validate(NULL, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_physics_state_validate(NULL, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_fault_validate(NULL, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_faults_validate(NULL, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_faults_check(NULL, NULL, 0, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_faults_check(&faults, NULL, 1, 1, 1), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_faults_check(&faults, NULL, 0, 1, 1), WH_OK);
}

enum { CHANGES = 19 };

static void the_hash_covers_each_word(void **state) {
    (void)state;
    bring_kind(WH_FAULT_WAFER_SHIFTED, 0);
    pick();
    const wh_physics_state_t good = simulator.physics;
    static wh_physics_state_t changed[CHANGES];
    for (size_t i = 0; i < CHANGES; ++i) {
        changed[i] = good;
    }
    changed[0].vacuum[0].level = WH_REAL(0.5);
    changed[1].vacuum[0].on = false;
    changed[2].vacuum[1].command = OPEN;
    changed[3].carry[0].known = 1;
    changed[4].carry[0].known = 1;
    changed[4].carry[0].slips = true;
    changed[5].carry[0].known = 1;
    changed[5].carry[0].before[1].x = 1;
    changed[6].faults.slots[0].phase = WH_FAULT_OVER;
    changed[7].faults.slots[0].fault.kind = WH_FAULT_WAFER_TILTED;
    changed[8].faults.slots[0].fault.target = 1;
    changed[9].faults.slots[0].fault.other = 1;
    changed[10].faults.slots[0].fault.value = 1;
    changed[11].faults.slots[0].fault.offset.r.y = 1;
    changed[12].faults.slots[0].fault.until = 9;
    changed[13].faults.slots[0].before.r.x = 1;
    changed[14].faults.slots[0].placed.r.x = 1;
    changed[15].vacuum[0].level = WH_REAL(0.5);
    changed[15].vacuum[0].on = false;
    changed[16] = changed[15];
    changed[16].vacuum[1].command = OPEN;
    changed[17].carry[0].known = 1;
    changed[17].carry[0].before[0].x = 1;
    changed[18].faults.slots[0].fault.from = 9;
    for (size_t i = 0; i < CHANGES; ++i) {
        const uint64_t hash = wh_physics_state_hash(&changed[i], &simulator.table);
        assert_true(hash != wh_simulator_hash(&simulator));
        for (size_t k = 0; k < i; ++k) {
            assert_true(hash != wh_physics_state_hash(&changed[k], &simulator.table));
        }
    }
}

/* Stored hashes of a run are compared with those of another machine, another compiler, another year. */
static void the_hash_is_this_number(void **state) {
    (void)state;
    wh_fault_t fault = fault_of(WH_FAULT_LEAK, 0);
    fault.value = WH_REAL(0.25);
    bring(1, &fault);
    pick();
    wh_physics_state_t some = simulator.physics;
    for (int g = 0; g < GRIPPERS; ++g) {
        some.vacuum[g].level = WH_REAL(0.5);
        some.vacuum[g].on = true;
        some.carry[g].known = 1 + g;
        some.carry[g].before[0] = wh_vec3(1, 2, 3);
        some.carry[g].before[1] = wh_vec3(4, 5, 6);
        some.carry[g].slips = g == 0;
    }
    assert_true(wh_physics_state_hash(&some, &simulator.table) == HASH);
}

static void without_any_it_is_the_tables_hash(void **state) {
    (void)state;
    pick();
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
    step(880, CLOSED);
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
    simulator.physics.faults.count = 1; /* a free slot does not count */
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
    bring_kind(WH_FAULT_SENSOR_ON, 0);
    step(880, CLOSED);
    assert_true(wh_simulator_hash(&simulator) != wh_grasp_hash(&simulator.table));
    wh_faults_clear(&simulator.physics.faults);
    assert_true(wh_simulator_hash(&simulator) == wh_grasp_hash(&simulator.table));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(conditions_that_no_simulator_leaves, set_up),
        cmocka_unit_test_setup(grippers_and_wafers_are_counted_apart, set_up),
        cmocka_unit_test_setup(more_grippers_than_there_is_room_for, set_up),
        cmocka_unit_test_setup(a_large_table_has_a_hash, set_up),
        cmocka_unit_test_setup(no_sensor_is_beyond_the_last_gripper, set_up),
        cmocka_unit_test_setup(null_is_refused, set_up),
        cmocka_unit_test_setup(the_hash_covers_each_word, set_up),
        cmocka_unit_test_setup(the_hash_is_this_number, set_up),
        cmocka_unit_test_setup(without_any_it_is_the_tables_hash, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
