/* Holding: Coulomb's law against its formula, and its verdict at the limit. */
#include "support/pose.h"

#include "grasp/hold.h"

#define DT WH_REAL(0.001)

#if defined(WH_FLOAT)
#define CLOSELY 1e-5
#else
#define CLOSELY 1e-9
#endif

static wh_pads_t pads;
static wh_carry_t carry;
static wh_mat3_t level_pads;

static int set_up(void **state) {
    (void)state;
    pads.friction = WH_REAL(0.3);
    pads.force = 6;
    pads.mass = wh_wafer_mass(300, WH_REAL(0.775));
    pads.gravity = WH_REAL(9.81);
    memset(&carry, 0, sizeof carry);
    level_pads = wh_mat3_identity();
    return 0;
}

static void the_mass_of_silicon(void **state) {
    (void)state;
    assert_true(fabs((double)wh_wafer_mass(300, WH_REAL(0.775)) - 0.12759) < 1e-5);
    assert_true(fabs((double)wh_wafer_mass(200, WH_REAL(0.725)) - 0.05305) < 1e-5);
}

static void ranges(void **state) {
    (void)state;
    wh_pads_t none = wh_pads_none();
    assert_int_equal(wh_pads_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_pads_validate(&pads), WH_OK);
    assert_int_equal(wh_pads_validate(&none), WH_OK);
    static const double bad[4][2] = {{-1e-9, 101}, {-1e-9, 1.1e6}, {1e-7, 1001}, {-1e-9, 1001}};
    for (size_t field = 0; field < 4; ++field) {
        wh_pads_t some = pads;
        wh_pads_t few = none;
        wh_real_t *const fields[] = {&some.friction, &some.force, &some.mass, &some.gravity};
        wh_real_t *const others[] = {&few.friction, &few.force, &few.mass, &few.gravity};
        *fields[field] = (wh_real_t)NAN;
        assert_int_equal(wh_pads_validate(&some), WH_STATUS_NOT_FINITE);
        for (size_t i = 0; i < 2; ++i) {
            *fields[field] = (wh_real_t)bad[field][i];
            assert_int_equal(wh_pads_validate(&some), WH_STATUS_OUT_OF_RANGE);
        }
        *others[field] = 1;
        assert_int_equal(wh_pads_validate(&few), field == 2 ? WH_OK : WH_STATUS_OUT_OF_RANGE);
    }
}

static void the_ends_of_the_ranges(void **state) {
    (void)state;
    const wh_pads_t most = {100, WH_REAL(1e6), 1000, 1000};
    const wh_pads_t least = {0, 0, WH_REAL(1e-6), 0};
    assert_int_equal(wh_pads_validate(&most), WH_OK);
    assert_int_equal(wh_pads_validate(&least), WH_OK);
}

/* Level, without vacuum: mu g. With: mu (g + F / m). */
static void the_limit_on_the_level(void **state) {
    (void)state;
    for (int i = 0; i <= 10; ++i) {
        const double share = i / 10.0;
        const double limit = (double)pads.friction * 1000 *
                             ((double)pads.gravity + (double)pads.force * share / (double)pads.mass);
        for (int side = -1; side <= 1; side += 2) {
            const double asked = limit * (1 + side * CLOSELY);
            const wh_vec3_t acceleration = wh_vec3((wh_real_t)(0.6 * asked), (wh_real_t)(-0.8 * asked), 0);
            const wh_hold_t hold = wh_hold_judge(&pads, (wh_real_t)share, &level_pads, &acceleration);
            assert_true(hold.slips == (side > 0));
            assert_true(fabs((double)hold.carried - limit) < CLOSELY * limit);
            assert_true(fabs((double)hold.asked - asked) < CLOSELY * limit);
        }
    }
}

/* Pads tilted by the angle of friction: there it begins to slide by itself. */
static void a_tilted_gripper_at_rest(void **state) {
    (void)state;
    const wh_vec3_t rest = {0, 0, 0};
    const double angle = atan((double)pads.friction);
    for (int side = -1; side <= 1; side += 2) {
        const wh_mat3_t tilted = wh_test_rotation(1, 2, 0, angle * (1 + side * CLOSELY));
        assert_true(wh_hold_judge(&pads, 0, &tilted, &rest).slips == (side > 0));
    }
}

static void down_faster_than_gravity_and_vacuum(void **state) {
    (void)state;
    const double limit = 1000 * ((double)pads.gravity + (double)pads.force / (double)pads.mass);
    for (int side = -1; side <= 1; side += 2) {
        const wh_vec3_t down = wh_vec3(0, 0, (wh_real_t)(-limit * (1 + side * CLOSELY)));
        const wh_hold_t hold = wh_hold_judge(&pads, 1, &level_pads, &down);
        assert_true(hold.slips == (side > 0));
        assert_true(hold.asked > hold.carried || side < 0);
    }
}

/* What is asked for and what carries are the same number. */
static void at_the_limit_it_holds(void **state) {
    (void)state;
    pads.friction = 1;
    pads.gravity = 8;
    const wh_vec3_t acceleration = wh_vec3(8000, 0, 0);
    const wh_hold_t hold = wh_hold_judge(&pads, 0, &level_pads, &acceleration);
    assert_near(hold.asked, 8000, 0);
    assert_near(hold.carried, 8000, 0);
    assert_false(hold.slips);
}

/* Nothing presses the wafer on the pads: friction carries nothing. A little less, and the wafer is torn off. */
static void without_pressure_friction_carries_nothing(void **state) {
    (void)state;
    pads.force = pads.gravity = 0;
    const wh_vec3_t aside = wh_vec3(3, 4, 0);
    const wh_hold_t slid = wh_hold_judge(&pads, 1, &level_pads, &aside);
    assert_true(slid.slips);
    assert_near(slid.asked, 5, 0);
    assert_near(slid.carried, 0, 0);
    const wh_vec3_t down = wh_vec3(3, 4, WH_REAL(-0.5));
    const wh_hold_t torn = wh_hold_judge(&pads, 1, &level_pads, &down);
    assert_true(torn.slips);
    assert_near(torn.asked, 0.5, 0);
    assert_near(torn.carried, 0, 0);
}

static void the_formula_in_any_frame(void **state) {
    (void)state;
    for (int run = 0; run < 2000; ++run) {
        const wh_mat3_t turn = wh_test_random_turn(1);
        const double a[3] = {wh_test_uniform(-2e4, 2e4), wh_test_uniform(-2e4, 2e4),
                             wh_test_uniform(-1e3, 2e4)};
        const wh_vec3_t acceleration = wh_vec3((wh_real_t)a[0], (wh_real_t)a[1], (wh_real_t)a[2]);
        const double needed[3] = {a[0], a[1], a[2] + 9810};
        double along = 0;
        double square = 0;
        for (int i = 0; i < 3; ++i) {
            along += needed[i] * (double)turn.m[i][2];
            square += needed[i] * needed[i];
        }
        const double across = sqrt(square - along * along);
        const double carried =
            (double)pads.friction * (1000 * (double)pads.force / (double)pads.mass + along);
        const wh_hold_t hold = wh_hold_judge(&pads, 1, &turn, &acceleration);
        assert_true(carried < 0 || fabs((double)hold.asked - across) < 1e3 * CLOSELY * sqrt(square));
        assert_true(carried < 0 || fabs((double)hold.carried - carried) < 1e3 * CLOSELY * 6e4);
    }
}

/* A run along x of constant acceleration, for so many slices; returns how many slips began. */
static int run(double acceleration, int slices) {
    int begun = 0;
    for (int n = 0; n < slices; ++n) {
        const double t = n * (double)DT;
        const wh_vec3_t centre = wh_vec3((wh_real_t)(0.5 * acceleration * t * t), 700, 900);
        wh_hold_t hold;
        begun += wh_carry_update(&carry, &pads, 1, &level_pads, &centre, DT, &hold) ? 1 : 0;
        assert_int_equal(carry.known, n == 0 ? 1 : 2);
    }
    return begun;
}

/* In float the second difference of positions has fewer digits than that. */
static void a_run_of_constant_acceleration(void **state) {
    (void)state;
    const double margin = 1e6 * WH_TEST_ROUNDING > 1e-9 ? 0.2 : 1e-9;
    const double limit =
        (double)pads.friction * 1000 * ((double)pads.gravity + (double)pads.force / (double)pads.mass);
    assert_int_equal(run(limit * (1 - margin), 100), 0);
    assert_false(carry.slips);
    memset(&carry, 0, sizeof carry);
    assert_true(run(limit * (1 + margin), 100) >= 1);
    assert_true(carry.slips);
}

static void the_first_two_slices_are_not_judged(void **state) {
    (void)state;
    assert_int_equal(run(1e9, 2), 0);
    memset(&carry, 0, sizeof carry);
    assert_int_equal(run(1e9, 3), 1);
    assert_true(carry.slips);
}

/* Along each axis of base a centre that goes 0, 1, 4 mm in quarters of a second gains 2 mm: 32 mm/s^2. */
static void acceleration_along_each_axis(void **state) {
    (void)state;
    static const wh_vec3_t along[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (size_t axis = 0; axis < 3; ++axis) {
        const wh_vec3_t expected = wh_vec3_scale(32, &along[axis]);
        const wh_hold_t judged = wh_hold_judge(&pads, 1, &level_pads, &expected);
        wh_hold_t hold;
        memset(&carry, 0, sizeof carry);
        for (int n = 0; n < 3; ++n) {
            const wh_vec3_t centre = wh_vec3_scale((wh_real_t)(n * n), &along[axis]);
            (void)wh_carry_update(&carry, &pads, 1, &level_pads, &centre, WH_REAL(0.25), &hold);
        }
        assert_near(hold.asked, judged.asked, 0);
        assert_near(hold.carried, judged.carried, 0);
    }
}

static void each_excursion_is_told_once(void **state) {
    (void)state;
    const double x[] = {0, 0, 0, 100, 300, 600, 900, 1200, 1500, 1700};
    const bool begins[] = {false, false, false, true, false, false, false, false, false, true};
    for (size_t n = 0; n < sizeof x / sizeof x[0]; ++n) {
        const wh_vec3_t centre = wh_vec3((wh_real_t)x[n], 0, 0);
        wh_hold_t hold;
        assert_int_equal(wh_carry_update(&carry, &pads, 1, &level_pads, &centre, DT, &hold), begins[n]);
        assert_true(hold.slips == carry.slips);
    }
}

static void without_a_wafer_nothing_is_known(void **state) {
    (void)state;
    wh_hold_t hold;
    run(1e9, 5);
    assert_false(wh_carry_update(&carry, &pads, 1, &level_pads, NULL, DT, &hold));
    assert_true(carry.known == 0 && !carry.slips);
    for (size_t i = 0; i < 2; ++i) {
        const wh_vec3_t *before = &carry.before[i];
        assert_true(before->x == 0 && before->y == 0 && before->z == 0);
    }
    assert_true(hold.asked == 0 && hold.carried == 0 && !hold.slips);
}

/* A gripper that goes from one end of the numbers to the other, or as far as leaves none. */
static void a_motion_beyond_all_numbers_slips(void **state) {
    (void)state;
    const wh_pads_t rubber = {WH_REAL(0.3), 10, WH_REAL(0.13), WH_REAL(9.81)};
    const wh_mat3_t level = wh_mat3_identity();
    const wh_real_t far = WH_REAL_LARGEST;
    const wh_vec3_t accelerations[] = {{far, 0, 0},
                                       {far, far, far},
                                       {-far, far, -far},
                                       {(wh_real_t)INFINITY, 0, 0},
                                       {0, 0, (wh_real_t)INFINITY},
                                       {0, (wh_real_t)INFINITY, -(wh_real_t)INFINITY},
                                       {(wh_real_t)NAN, 0, 0},
                                       {0, 0, (wh_real_t)NAN}};
    for (size_t i = 0; i < sizeof accelerations / sizeof accelerations[0]; ++i) {
        const wh_hold_t hold = wh_hold_judge(&rubber, 1, &level, &accelerations[i]);
        assert_true(hold.slips);
        assert_true(hold.asked == WH_REAL_LARGEST && wh_real_is_finite(hold.carried));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(the_mass_of_silicon, set_up),
        cmocka_unit_test_setup(ranges, set_up),
        cmocka_unit_test_setup(the_ends_of_the_ranges, set_up),
        cmocka_unit_test_setup(the_limit_on_the_level, set_up),
        cmocka_unit_test_setup(a_tilted_gripper_at_rest, set_up),
        cmocka_unit_test_setup(down_faster_than_gravity_and_vacuum, set_up),
        cmocka_unit_test_setup(at_the_limit_it_holds, set_up),
        cmocka_unit_test_setup(without_pressure_friction_carries_nothing, set_up),
        cmocka_unit_test_setup(the_formula_in_any_frame, set_up),
        cmocka_unit_test_setup(a_run_of_constant_acceleration, set_up),
        cmocka_unit_test_setup(the_first_two_slices_are_not_judged, set_up),
        cmocka_unit_test_setup(acceleration_along_each_axis, set_up),
        cmocka_unit_test_setup(each_excursion_is_told_once, set_up),
        cmocka_unit_test_setup(without_a_wafer_nothing_is_known, set_up),
        cmocka_unit_test(a_motion_beyond_all_numbers_slips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
