/* Vacuum under a gripper: command, level and sensor, each by its own rule. */
#include "support/pose.h"

#include "grasp/vacuum.h"

enum { OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

#define DT WH_REAL(0.001)
/* How closely a thousand slices follow a formula. */
#define CLOSELY (1e4 * WH_TEST_ROUNDING)

static wh_vacuum_config_t config;
static wh_vacuum_fault_t upset;
static wh_vacuum_t vacuum;

static int set_up(void **state) {
    (void)state;
    config = wh_vacuum_delayed();
    upset = wh_vacuum_sound();
    vacuum = wh_vacuum_start();
    return 0;
}

/* One slice; returns what the valve does. A wafer is on the pads before and after as long as the valve acts open. */
static int32_t slice(int32_t command, bool wafer) {
    const int32_t valve = wh_vacuum_before(&config, &upset, command, wafer, DT, &vacuum);
    (void)wh_vacuum_after(&config, &upset, wafer && valve == OPEN, DT, &vacuum);
    return valve;
}

static void the_presets_are_valid(void **state) {
    (void)state;
    const wh_vacuum_config_t ideal = wh_vacuum_ideal();
    assert_int_equal(wh_vacuum_validate(&config), WH_OK);
    assert_int_equal(wh_vacuum_validate(&ideal), WH_OK);
    assert_int_equal(vacuum.command, CLOSED);
    assert_true(vacuum.level == 0 && !vacuum.on && upset.full == 1 && upset.build == 0);
}

static void refuse(size_t field, double value, wh_status_t status) {
    wh_vacuum_config_t bad = wh_vacuum_delayed();
    wh_real_t *const fields[] = {&bad.build, &bad.vent, &bad.idle, &bad.on, &bad.off, &bad.release};
    *fields[field] = (wh_real_t)value;
    assert_int_equal(wh_vacuum_validate(&bad), status);
}

static void what_is_out_of_range_is_refused(void **state) {
    /* build, vent, idle, on, off, release: one below, one above */
    static const double bad[6][2] = {{-1e-9, 3601}, {-1e-9, 3601}, {-1e-9, 0.6},
                                     {0.59, 1.01},  {0, 0.71},     {0, 1.01}};
    (void)state;
    assert_int_equal(wh_vacuum_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    for (size_t i = 0; i < 6; ++i) {
        refuse(i, (double)NAN, WH_STATUS_NOT_FINITE);
        refuse(i, (double)INFINITY, WH_STATUS_NOT_FINITE);
        refuse(i, bad[i][0], WH_STATUS_OUT_OF_RANGE);
        refuse(i, bad[i][1], WH_STATUS_OUT_OF_RANGE);
    }
    refuse(1, 3600, WH_OK);
    refuse(2, 0, WH_OK);
    refuse(3, 1, WH_OK);
    refuse(4, 0.7, WH_OK);
    refuse(5, 1, WH_OK);
}

static void ideal_is_who_holds_and_what_is_commanded(void **state) {
    (void)state;
    config = wh_vacuum_ideal();
    for (int i = 0; i < 1000; ++i) {
        const int32_t command = (int32_t)wh_test_below(2);
        const bool before = wh_test_below(2) == 0;
        const bool after = command == OPEN && wh_test_below(2) == 0;
        assert_int_equal(wh_vacuum_before(&config, &upset, command, before, DT, &vacuum), command);
        (void)wh_vacuum_after(&config, &upset, after, DT, &vacuum);
        assert_true(vacuum.on == after && vacuum.level == (after ? 1 : 0));
        assert_int_equal(vacuum.command, command);
    }
}

static void it_builds_up_only_with_a_wafer(void **state) {
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        assert_int_equal(slice(OPEN, false), OPEN);
        assert_true(vacuum.level <= config.idle && !vacuum.on);
    }
    assert_true(vacuum.level == config.idle);
    for (int i = 1; i <= 1000; ++i) {
        slice(OPEN, true);
        const double lag = pow((double)config.build / ((double)config.build + (double)DT), i);
        const double expected = 1 - (1 - (double)config.idle) * lag;
        if (1 - expected > 1.01e-4) {
            assert_true(fabs((double)vacuum.level - expected) < CLOSELY);
            assert_true(vacuum.on == (vacuum.level >= config.on));
        }
    }
    assert_true(vacuum.level == 1);
}

static void a_closed_valve_lets_go_below_the_threshold(void **state) {
    (void)state;
    while (vacuum.level < 1) {
        slice(OPEN, true);
    }
    int slices = 0;
    while (slice(CLOSED, true) == OPEN) {
        assert_true(vacuum.level >= config.release);
        assert_int_equal(vacuum.command, CLOSED);
        ++slices;
    }
    assert_true(vacuum.level < config.release);
    /* (vent / (vent + dt))^(slices + 1) is the first below release. */
    assert_int_equal(slices, 24);
    assert_int_equal(slice(CLOSED, false), CLOSED);
    assert_false(vacuum.on);
}

static void nothing_held_is_let_go_at_once(void **state) {
    (void)state;
    while (vacuum.level < 1) {
        slice(OPEN, true);
    }
    assert_int_equal(slice(CLOSED, false), CLOSED);
    assert_true(vacuum.level > config.release);
    /* And a wafer that has no vacuum yet, too. */
    vacuum = wh_vacuum_start();
    slice(OPEN, true);
    assert_int_equal(slice(CLOSED, true), CLOSED);
}

static void the_sensor_has_two_thresholds(void **state) {
    static const struct {
        double full;
        bool before, after;
    } cases[] = {{0.7, false, true}, {0.69, false, false}, {0.6, true, true}, {0.59, true, false}};
    (void)state;
    config.vent = 0;
    config.build = 0;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        vacuum.on = cases[i].before;
        upset.full = (wh_real_t)cases[i].full;
        slice(OPEN, true);
        assert_true(vacuum.on == cases[i].after);
    }
}

static void a_loss_is_told_once(void **state) {
    (void)state;
    while (vacuum.level < 1) {
        slice(OPEN, true);
    }
    int told = 0;
    upset.full = WH_REAL(0.2);
    for (int i = 0; i < 200; ++i) {
        assert_int_equal(wh_vacuum_before(&config, &upset, OPEN, true, DT, &vacuum), OPEN);
        const bool was_on = vacuum.on;
        const bool lost = wh_vacuum_after(&config, &upset, true, DT, &vacuum);
        assert_true(lost == (was_on && !vacuum.on));
        told += lost ? 1 : 0;
    }
    assert_int_equal(told, 1);
    assert_true(vacuum.level == upset.full);
}

/* Neither a wafer that is gone nor a valve that closes is a loss. */
static void what_is_no_loss(void **state) {
    (void)state;
    config = wh_vacuum_ideal();
    slice(OPEN, true);
    assert_true(vacuum.on);
    (void)wh_vacuum_before(&config, &upset, OPEN, true, DT, &vacuum);
    assert_false(wh_vacuum_after(&config, &upset, false, DT, &vacuum));
    slice(OPEN, true);
    (void)wh_vacuum_before(&config, &upset, CLOSED, true, DT, &vacuum);
    assert_false(wh_vacuum_after(&config, &upset, true, DT, &vacuum));
    assert_false(vacuum.on);
}

static void a_slow_pump_is_slower_only(void **state) {
    (void)state;
    upset.build = WH_REAL(0.5);
    slice(OPEN, true);
    const wh_real_t slow = vacuum.level;
    vacuum = wh_vacuum_start();
    upset.build = WH_REAL(0.01);
    slice(OPEN, true);
    const wh_real_t same = vacuum.level;
    vacuum = wh_vacuum_start();
    upset.build = 0;
    slice(OPEN, true);
    assert_true(vacuum.level == same && slow < same);
    assert_true(fabs((double)slow - 0.001 / 0.501) < CLOSELY);
}

static void any_slice_keeps_the_level_within_its_range(void **state) {
    (void)state;
    for (int run = 0; run < 20000; ++run) {
        config.build = (wh_real_t)wh_test_decades(1e-9, 3600);
        config.vent = (wh_real_t)wh_test_decades(1e-9, 3600);
        upset.full = (wh_real_t)wh_test_uniform(0, 1);
        vacuum.level = (wh_real_t)wh_test_uniform(0, 1);
        const wh_real_t before = vacuum.level;
        const wh_real_t dt = (wh_real_t)wh_test_decades(1e-6, 1);
        (void)wh_vacuum_before(&config, &upset, OPEN, true, dt, &vacuum);
        (void)wh_vacuum_after(&config, &upset, true, dt, &vacuum);
        const wh_real_t low = before < upset.full ? before : upset.full;
        const wh_real_t high = before < upset.full ? upset.full : before;
        assert_true(vacuum.level >= low && vacuum.level <= high);
    }
}

static void no_valve_changes_nothing(void **state) {
    (void)state;
    slice(OPEN, true);
    const wh_vacuum_t before = vacuum;
    assert_int_equal(wh_vacuum_before(&config, &upset, 2, true, DT, &vacuum), 2);
    assert_int_equal(wh_vacuum_before(&config, &upset, -1, true, DT, &vacuum), -1);
    assert_true(vacuum.level == before.level && vacuum.command == before.command && vacuum.on == before.on);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(the_presets_are_valid, set_up),
        cmocka_unit_test_setup(what_is_out_of_range_is_refused, set_up),
        cmocka_unit_test_setup(ideal_is_who_holds_and_what_is_commanded, set_up),
        cmocka_unit_test_setup(it_builds_up_only_with_a_wafer, set_up),
        cmocka_unit_test_setup(a_closed_valve_lets_go_below_the_threshold, set_up),
        cmocka_unit_test_setup(nothing_held_is_let_go_at_once, set_up),
        cmocka_unit_test_setup(the_sensor_has_two_thresholds, set_up),
        cmocka_unit_test_setup(a_loss_is_told_once, set_up),
        cmocka_unit_test_setup(what_is_no_loss, set_up),
        cmocka_unit_test_setup(a_slow_pump_is_slower_only, set_up),
        cmocka_unit_test_setup(any_slice_keeps_the_level_within_its_range, set_up),
        cmocka_unit_test_setup(no_valve_changes_nothing, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
