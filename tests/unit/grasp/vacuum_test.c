/* Vacuum under a gripper: command, level and sensor, each by its own rule. Pads without vacuum:
 * which wafers they take, and where they leave them. */
#include "support/pose.h"

#include "grasp/face.h"
#include "grasp/passive.h"
#include "grasp/vacuum.h"

enum { OPEN = WH_VALVE_OPEN, CLOSED = WH_VALVE_CLOSED };

#define DT WH_REAL(0.001)
/* The tolerance with which a thousand slices follow a formula. */
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

/* One slice; returns the valve's action. A wafer is on the pads before and after, as long as the
 * valve acts as open. */
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
    config.debounce = -1;
    assert_int_equal(wh_vacuum_validate(&config), WH_STATUS_OUT_OF_RANGE);
    config.debounce = WH_VACUUM_DEBOUNCE + 1;
    assert_int_equal(wh_vacuum_validate(&config), WH_STATUS_OUT_OF_RANGE);
    config.debounce = WH_VACUUM_DEBOUNCE;
    assert_int_equal(wh_vacuum_validate(&config), WH_OK);
}

/* With an ideal vacuum the switch turns with the wafer, so each slice's switch is known. */
static void a_turn_of_the_switch_is_told_once_it_has_stood(void **state) {
    static const char wafers[] = "..######..###.#...##....####"; /* #: one is there */
    static const char told[] = ".....##################....#";   /* #: the sensor says so */
    (void)state;
    config = wh_vacuum_ideal();
    config.debounce = 3;
    for (size_t i = 0; i < sizeof wafers - 1; ++i) {
        (void)slice(OPEN, wafers[i] == '#');
        assert_int_equal(vacuum.on, told[i] == '#');
        assert_true(vacuum.waits <= 3);
    }
}

/* A level between the thresholds keeps the switch where it stands, also while it waits. */
static void thresholds_hold_while_it_waits(void **state) {
    static const struct {
        double full;
        bool on;
    } slices[] = {{0.65, false}, {0.75, false}, {0.65, false}, {0.65, true},
                  {0.55, true},  {0.65, true},  {0.65, false}, {0.75, false}};
    (void)state;
    config.build = config.vent = 0;
    config.debounce = 2;
    for (size_t i = 0; i < sizeof slices / sizeof slices[0]; ++i) {
        upset.full = WH_REAL(slices[i].full);
        (void)slice(OPEN, true);
        assert_int_equal(vacuum.on, slices[i].on);
    }
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
    /* A wafer that has no vacuum yet behaves in the same way. */
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

/* Neither a wafer that is gone nor a closing valve is a loss. */
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
    for (int run = 0; run < 20000 / WH_TEST_SHARE; ++run) {
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

static wh_passive_t passive;
static wh_passive_wafer_t lying;
static wh_pose_t pads;

/* A wafer on a support at base's origin, with pads 1 mm below. */
static int set_up_passive(void **state) {
    (void)state;
    passive.tolerance = wh_tolerance_paper();
    passive.check = WH_CHECK_SAMPLED;
    passive.thickness = WH_REAL(0.775);
    memset(&lying, 0, sizeof lying);
    lying.base_from_wafer = wh_pose_identity();
    pads = wh_test_at(0, 0, -1);
    return 0;
}

/* The pads move on to (x, 0, z); returns the event. */
static void pads_to(double x, double z, wh_passive_change_t expected) {
    const wh_pose_t support = wh_pose_identity();
    const wh_pose_t begin = pads;
    wh_passive_change_t change = (wh_passive_change_t)7;
    pads.r.x = WH_REAL(x);
    pads.r.z = WH_REAL(z);
    assert_int_equal(wh_passive_step(&passive, &begin, &pads, &support, &lying, &change), WH_OK);
    assert_int_equal(change, expected);
    assert_int_equal(lying.carried, lying.base_from_wafer.r.z > 0);
}

static void expect_wafer_at(double x, double z) {
    assert_near(lying.base_from_wafer.r.x, x, 1e3 * WH_TEST_ROUNDING);
    assert_near(lying.base_from_wafer.r.z, z, 1e3 * WH_TEST_ROUNDING);
}

static void lifted_off_its_support_a_wafer_is_carried_until_a_support_takes_it_over(void **state) {
    (void)state;
    pads_to(0, -0.25, WH_PASSIVE_STAYS);
    pads_to(0, 0, WH_PASSIVE_STAYS);
    pads_to(0, 0.25, WH_PASSIVE_TAKEN);
    expect_wafer_at(0, 0.25);
    pads_to(30, 2, WH_PASSIVE_STAYS);
    expect_wafer_at(30, 2);
    pads_to(30, 1, WH_PASSIVE_STAYS);
    pads_to(30, 0, WH_PASSIVE_LEFT);
    expect_wafer_at(30, 0);
    pads_to(30, -2, WH_PASSIVE_STAYS);
    expect_wafer_at(30, 0);
}

/* Sampled, the wafer is lifted from its place. Swept, it moves with the pads from the instant of
 * contact, and is left at the instant of contact. */
static void swept_the_instant_counts(void **state) {
    if (!WH_SWEEP_BUILT) {
        skip();
    }
    (void)state;
    pads_to(4, 3, WH_PASSIVE_TAKEN);
    expect_wafer_at(0, 3);
    pads_to(8, -1, WH_PASSIVE_LEFT);
    expect_wafer_at(4, 0);
    set_up_passive(state);
    passive.check = WH_CHECK_SWEPT;
    pads_to(4, 3, WH_PASSIVE_TAKEN);
    expect_wafer_at(3, 3);
    pads_to(8, -1, WH_PASSIVE_LEFT);
    expect_wafer_at(6, 0);
}

static void what_passes_beside_or_from_above_takes_nothing(void **state) {
    (void)state;
    pads.r.x = 50;
    pads_to(50, 1, WH_PASSIVE_STAYS);
    pads_to(0, 1, WH_PASSIVE_STAYS);
    pads_to(0, -1, WH_PASSIVE_STAYS);
    pads_to(wh_test_ulps(50, -1), -1, WH_PASSIVE_STAYS);
    pads_to(wh_test_ulps(50, -1), 1, WH_PASSIVE_TAKEN);
    pads_to(200, 1, WH_PASSIVE_STAYS);
    const double x = (double)lying.base_from_wafer.r.x;
    assert_true(x > 100);
    const wh_pose_t support = wh_pose_identity();
    const wh_pose_t below = wh_test_at(200, 0, -3);
    wh_passive_change_t change;
    assert_int_equal(wh_passive_step(&passive, &pads, &below, &support, &lying, &change), WH_OK);
    assert_true(change == WH_PASSIVE_STAYS && lying.carried);
    assert_near(lying.base_from_wafer.r.z, -3, 1e3 * WH_TEST_ROUNDING);
}

/* A wafer that lies face down is lifted by its front; its frame, in its back, is higher by its thickness. */
static void a_wafer_face_down_is_lifted_by_its_front(void **state) {
    (void)state;
    const wh_pose_t support = wh_pose_identity();
    wh_passive_change_t change;
    lying.base_from_wafer = wh_test_pose(wh_test_rotation(1, 0, 0, WH_TEST_PI), 0, 0, 0.775);
    for (int slice = 1; slice <= 8; ++slice) {
        const wh_pose_t begin = pads;
        pads.r.z = WH_REAL(-1 + 0.25 * slice);
        assert_int_equal(wh_passive_step(&passive, &begin, &pads, &support, &lying, &change), WH_OK);
        assert_int_equal(change, slice == 5 ? WH_PASSIVE_TAKEN : WH_PASSIVE_STAYS);
        assert_near(lying.base_from_wafer.r.z, fmax((double)pads.r.z, 0) + 0.775, 1e3 * WH_TEST_ROUNDING);
    }
}

/* Random moves of tilted pads, swept: a wafer is never both carried and supported, and is on the
 * pads' plane or on the support's. It is taken or left at an instant that obeys the rule's text. */
static void a_random_walk_keeps_the_wafer_on_one_plane(void **state) {
    const wh_pose_t support = wh_pose_identity();
    int changes[3] = {0, 0, 0};
    set_up_passive(state);
    for (int slice = 0; slice < 200000; ++slice) {
        const wh_pose_t begin = pads;
        const wh_passive_wafer_t before = lying;
        wh_passive_change_t change;
        passive.check = WH_SWEEP_BUILT && slice % 2 == 0 ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
        pads = wh_test_pose(wh_test_random_turn(0.05), wh_test_uniform(-5, 5), wh_test_uniform(-5, 5),
                            wh_test_uniform(-1, 1.5));
        assert_int_equal(wh_passive_step(&passive, &begin, &pads, &support, &lying, &change), WH_OK);
        ++changes[change];
        assert_true(lying.carried ==
                    (change == WH_PASSIVE_TAKEN || (before.carried && change == WH_PASSIVE_STAYS)));
        assert_int_equal(wh_pose_validate(&lying.base_from_wafer), WH_OK);
        if (lying.carried) {
            const wh_pose_t carried = wh_pose_compose(&pads, &lying.gripper_from_wafer);
            assert_true(wh_test_difference_r(&carried, &lying.base_from_wafer) <= 1e4 * WH_TEST_ROUNDING);
            assert_near(lying.gripper_from_wafer.r.z, 0, 1e6 * WH_TEST_ROUNDING);
        } else if (before.carried) {
            assert_near(lying.base_from_wafer.r.z, 0, 1e4 * WH_TEST_ROUNDING);
        } else {
            assert_memory_equal(&lying.base_from_wafer, &before.base_from_wafer,
                                sizeof lying.base_from_wafer);
        }
        if (!lying.carried) {
            lying.base_from_wafer = wh_pose_identity();
        }
    }
    assert_true(changes[WH_PASSIVE_TAKEN] > 10000 && changes[WH_PASSIVE_LEFT] > 10000);
}

/* Pads and a grip that just pass wh_pose_validate: their product would not. */
static void a_carried_wafer_can_go_on_to_the_next_slice(void **state) {
    (void)state;
    const wh_real_t length = 1 + WH_REAL(0.49) * WH_ROTATION_TOLERANCE;
    wh_passive_change_t change;
    pads.r.z = 1;
    for (int i = 0; i < 3; ++i) {
        pads.R.m[i][i] = length;
    }
    lying.gripper_from_wafer = pads;
    lying.carried = true;
    for (int slice = 0; slice < 3; ++slice) {
        assert_int_equal(wh_passive_step(&passive, &pads, &pads, NULL, &lying, &change), WH_OK);
        assert_int_equal(wh_pose_validate(&lying.base_from_wafer), WH_OK);
    }
}

static void pads_move_over(const wh_pose_t *support, double height) {
    const wh_pose_t begin = pads;
    const wh_pose_t over = wh_test_at(0, 0, height);
    wh_passive_change_t change;
    pads = wh_pose_compose(support, &over);
    assert_int_equal(wh_passive_step(&passive, &begin, &pads, support, &lying, &change), WH_OK);
}

static void pads_that_stop_within_rounding_of_a_support_miss_neither_wafer_nor_support(void **state) {
    set_up_passive(state);
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        const wh_pose_t support = wh_test_random_pose(1000);
        const double rounding = wh_test_uniform(-1, 1) * (double)WH_TEST_ROUNDING;
        passive.check = i % 2 == 0 || !WH_SWEEP_BUILT ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT;
        lying.base_from_wafer = support;
        lying.carried = false;
        pads = support;
        pads_move_over(&support, -1);
        pads_move_over(&support, rounding);
        pads_move_over(&support, rounding);
        pads_move_over(&support, 1);
        assert_true(lying.carried);
        pads_move_over(&support, -rounding);
        pads_move_over(&support, -rounding);
        pads_move_over(&support, -1);
        assert_false(lying.carried);
        const wh_vec3_t off = wh_vec3_subtract(&lying.base_from_wafer.r, &support.r);
        assert_true(wh_vec3_norm(&off) < 1e5 * WH_TEST_ROUNDING);
    }
}

static void a_passive_step_refuses_what_it_cannot_judge(void **state) {
    (void)state;
    const wh_pose_t good = wh_pose_identity();
    const wh_passive_wafer_t before = lying;
    wh_passive_change_t change = (wh_passive_change_t)7;
    wh_pose_t bad = good;
    bad.R.m[1][1] = 2;
    assert_int_equal(wh_passive_step(NULL, &good, &good, &good, &lying, &change), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_passive_step(&passive, NULL, &good, &good, &lying, &change), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_passive_step(&passive, &good, NULL, &good, &lying, &change), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, NULL, &change), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, &lying, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_passive_step(&passive, &bad, &good, &good, &lying, &change),
                     WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_passive_step(&passive, &good, &bad, &good, &lying, &change),
                     WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_passive_step(&passive, &good, &good, &bad, &lying, &change),
                     WH_STATUS_NOT_A_ROTATION);
    lying.carried = true;
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, &lying, &change),
                     WH_STATUS_NOT_A_ROTATION);
    lying.carried = false;
    passive.check = (wh_check_t)2;
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, &lying, &change), WH_STATUS_OUT_OF_RANGE);
    set_up_passive(state);
    passive.thickness = -1;
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, &lying, &change), WH_STATUS_OUT_OF_RANGE);
    passive.thickness = (wh_real_t)NAN;
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, &lying, &change), WH_STATUS_NOT_FINITE);
    set_up_passive(state);
    passive.tolerance.planar = 1;
    assert_int_equal(wh_passive_step(&passive, &good, &good, &good, &lying, &change),
                     WH_STATUS_BAD_TOLERANCE);
    assert_memory_equal(&lying, &before, sizeof lying);
    assert_int_equal(change, 7);
}

/* Just below the limit a wafer holds in the worst direction, just above it slips. */
static void the_limit_of_friction_alone(void **state) {
    (void)state;
    const wh_pads_t grip = {WH_REAL(0.3), 0, WH_REAL(0.128), WH_REAL(9.81)};
    const wh_mat3_t level_pads = wh_mat3_identity();
    const wh_mat3_t down = wh_test_rotation(1, 0, 0, WH_TEST_PI);
    assert_near(wh_passive_limit(&grip, &level_pads), 2943, 1e4 * WH_TEST_ROUNDING);
    assert_true(wh_passive_limit(&grip, &down) < 0);
    for (int i = 0; i < 2000; ++i) {
        const double tilt = wh_test_uniform(1e-3, 0.25);
        const double towards = wh_test_uniform(-3, 3);
        const wh_mat3_t R = wh_test_rotation(cos(towards), sin(towards), 0, tilt);
        const double limit = (double)wh_passive_limit(&grip, &R);
        assert_near(limit, 9810 * (0.3 * cos(tilt) - sin(tilt)), 1e6 * WH_TEST_ROUNDING);
        const wh_vec3_t n = wh_mat3_column(&R, 2);
        const wh_vec3_t up = {0, 0, 1};
        const wh_vec3_t back = wh_vec3_scale(n.z, &n);
        wh_vec3_t along = wh_vec3_subtract(&up, &back);
        const double size = (double)wh_vec3_norm(&along);
        for (int sign = -1; sign <= 1; sign += 2) {
            const wh_vec3_t asked = wh_vec3_scale(WH_REAL((limit + sign * 0.1) / size), &along);
            assert_int_equal(wh_hold_judge(&grip, 0, &R, &asked).slips, sign > 0);
        }
    }
}

static void passive_pads_have_no_force_and_usual_ones_where_there_are_none(void **state) {
    (void)state;
    const wh_pads_t given = {WH_REAL(0.3), 6, WH_REAL(0.128), WH_REAL(1.62)};
    const wh_pads_t none = wh_pads_none();
    const wh_pads_t usual = wh_passive_pads(&none);
    const wh_pads_t own = wh_passive_pads(&given);
    const wh_mat3_t level_pads = wh_mat3_identity();
    assert_true(own.friction == given.friction && own.gravity == given.gravity && own.mass == given.mass);
    assert_true(own.force == 0 && usual.force == 0 && usual.mass > 0);
    assert_near(wh_passive_limit(&usual, &level_pads), 1962, 1e4 * WH_TEST_ROUNDING);
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
        cmocka_unit_test_setup(a_turn_of_the_switch_is_told_once_it_has_stood, set_up),
        cmocka_unit_test_setup(thresholds_hold_while_it_waits, set_up),
        cmocka_unit_test_setup(a_loss_is_told_once, set_up),
        cmocka_unit_test_setup(what_is_no_loss, set_up),
        cmocka_unit_test_setup(a_slow_pump_is_slower_only, set_up),
        cmocka_unit_test_setup(any_slice_keeps_the_level_within_its_range, set_up),
        cmocka_unit_test_setup(no_valve_changes_nothing, set_up),
        cmocka_unit_test_setup(lifted_off_its_support_a_wafer_is_carried_until_a_support_takes_it_over,
                               set_up_passive),
        cmocka_unit_test_setup(swept_the_instant_counts, set_up_passive),
        cmocka_unit_test_setup(what_passes_beside_or_from_above_takes_nothing, set_up_passive),
        cmocka_unit_test_setup(a_wafer_face_down_is_lifted_by_its_front, set_up_passive),
        cmocka_unit_test_setup(a_random_walk_keeps_the_wafer_on_one_plane, set_up_passive),
        cmocka_unit_test_setup(a_carried_wafer_can_go_on_to_the_next_slice, set_up_passive),
        cmocka_unit_test(pads_that_stop_within_rounding_of_a_support_miss_neither_wafer_nor_support),
        cmocka_unit_test_setup(a_passive_step_refuses_what_it_cannot_judge, set_up_passive),
        cmocka_unit_test(the_limit_of_friction_alone),
        cmocka_unit_test(passive_pads_have_no_force_and_usual_ones_where_there_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
