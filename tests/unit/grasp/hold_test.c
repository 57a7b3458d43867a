/* Holding: Coulomb's law compared with its formula, and its verdict at the limit; the edge grip's
 * path compared with the forms of its header. */
#include "support/pose.h"

#include "grasp/edge.h"
#include "grasp/hold.h"

#define DT WH_REAL(0.001)

#if defined(WH_FLOAT)
#define CLOSELY 1e-5
#define EDGE_NEAR 5e-4 /* mm, of an edge grip's path */
#define EDGE_SAME 1e-5 /* of a number that it hands on */
#else
#define CLOSELY 1e-9
#define EDGE_NEAR 1e-9
#define EDGE_SAME 0
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

/* Pads tilted by the angle of friction: at this angle it begins to slide by itself. */
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

/* The required and the available force are the same number. */
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

/* Nothing presses the wafer on the pads: friction carries nothing. A little less force, and the
 * wafer is torn off. */
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
    for (int run = 0; run < 2000 / WH_TEST_SHARE; ++run) {
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

/* A run along x with constant acceleration, for the given number of slices; returns how many slips began. */
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

/* In float the second difference of positions has fewer digits. */
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

/* Along each axis of base a centre at 0, 1 and 4 mm in quarters of a second gains 2 mm: 32 mm/s^2. */
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

/* A gripper that moves from one end of the range of numbers to the other, or so far that no number
 * is left. */
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

static wh_edge_place_t edge_at(const wh_edge_t *edge, const wh_edge_wafer_t *wafer, double s) {
    wh_edge_place_t place;
    assert_int_equal(wh_edge_at(edge, wafer, s, &place), WH_OK);
    return place;
}

/* The nominal wafer of 300 mm with the notch at this angle from +x, deg. */
static wh_edge_wafer_t notch_at(double degrees) {
    wh_edge_wafer_t wafer = wh_edge_wafer_nominal(150);
    wafer.notch_x = cos(degrees * WH_TEST_PI / 180);
    wafer.notch_y = sin(degrees * WH_TEST_PI / 180);
    return wafer;
}

static double shift_with_notch_at(double degrees) {
    const wh_edge_t edge = wh_edge_default(150);
    const wh_edge_wafer_t wafer = notch_at(degrees);
    const wh_edge_place_t place = edge_at(&edge, &wafer, 4);
    assert_true(place.phase == WH_EDGE_SEATED && place.held);
    return hypot(place.x, place.y);
}

/* Over diameters, offsets and angles: the exact form, wherever the wafer began. */
static void an_edge_grip_seats_a_round_wafer_by_the_exact_form(void **state) {
    (void)state;
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        wh_edge_t edge = wh_edge_default(wh_test_uniform(25, 225));
        edge.rest = wh_test_uniform(0.5, 5);
        edge.alpha = wh_test_uniform(25, 60) * WH_TEST_PI / 180;
        wh_edge_wafer_t wafer = wh_edge_wafer_nominal(edge.radius);
        wafer.radius += wh_test_uniform(-0.15, 0.15);
        const double off = wh_test_uniform(0, edge.clearance);
        const double towards = wh_test_uniform(-4, 4);
        wafer.x = off * cos(towards);
        wafer.y = off * sin(towards);
        wafer.depth = 0;
        const double reach = edge.radius + edge.rest;
        const double across = reach * sin(edge.alpha);
        const double x = reach * cos(edge.alpha) - sqrt(pow(wafer.radius + edge.rest, 2) - across * across);
        const wh_edge_place_t place = edge_at(&edge, &wafer, edge.end);
        assert_true(place.phase == WH_EDGE_SEATED);
        assert_near(place.x, x, EDGE_NEAR);
        assert_near(place.y, 0, EDGE_NEAR);
        assert_near(place.s, x - (wafer.radius - edge.radius), EDGE_NEAR);
        assert_true(place.held == (place.s >= edge.gripped_from && place.s <= edge.gripped_to));
    }
    const wh_edge_t edge = wh_edge_default(150);
    wh_edge_wafer_t larger = notch_at(90);
    larger.radius = 150.1;
    assert_near(edge_at(&edge, &larger, 4).x, -0.115457, 5e-7 + EDGE_NEAR);
}

/* Known values: 3 mm rests in a SEMI notch; the largest shift of all angles. */
static void a_rest_over_the_notch_sinks_in(void **state) {
    (void)state;
    double largest = 0;
    double angle = 0;
    for (double a = -0.7; a < 0.7; a += 0.001) {
        const double shift = shift_with_notch_at(30 - a);
        angle = shift > largest ? a : angle;
        largest = shift > largest ? shift : largest;
        assert_near(shift_with_notch_at(-30 + a), shift, EDGE_NEAR);
    }
    assert_near(shift_with_notch_at(30), 0.550, 5e-4);
    assert_near(largest, 0.867, 7e-4);
    assert_near(fabs(angle), 0.164, 3e-3);
    const double sign = angle < 0 ? 1 : -1;
    assert_near(shift_with_notch_at(30 - sign * 0.1), 0.369, 5e-4);
    assert_near(shift_with_notch_at(30 + sign * 0.4), 0.046, 5e-4);
    assert_near(shift_with_notch_at(30 + 0.8), 0, EDGE_NEAR);
}

/* The pin's distance from points along both flanks, up to the corners. */
static double nearest_of_outline(const wh_edge_wafer_t *wafer, double x, double y) {
    const double h = wafer->opening / 2;
    const double apex = wafer->radius - wafer->depth - wafer->bottom * (1 / sin(h) - 1);
    double corner = 3;
    for (double step = 1; step > 1e-12; step /= 2) {
        corner -= hypot(apex + (corner - step) * cos(h), (corner - step) * sin(h)) > wafer->radius ? step : 0;
    }
    double least = 1e9;
    for (int i = 0; i <= 20000; ++i) {
        const double first = wafer->bottom / tan(h);
        const double u = first + (corner - first) * i / 20000;
        for (int side = -1; side <= 1; side += 2) {
            const double along = apex + u * cos(h);
            const double aside = side * u * sin(h);
            least = fmin(least, hypot(x - along * wafer->notch_x + aside * wafer->notch_y,
                                      y - along * wafer->notch_y - aside * wafer->notch_x));
        }
    }
    return least;
}

/* Random notches at a rest: the other rest touches the circle, this one the outline. */
static void a_sunk_rest_touches_the_notchs_outline(void **state) {
    (void)state;
    for (int i = 0; i < 300 / WH_TEST_SHARE; ++i) {
        wh_edge_t edge = wh_edge_default(150);
        edge.alpha = wh_test_uniform(25, 60) * WH_TEST_PI / 180;
        edge.gripped_to = 3;
        const double notch = edge.alpha + wh_test_uniform(-0.5, 0.5) * WH_TEST_PI / 180;
        wh_edge_wafer_t wafer = wh_edge_wafer_nominal(150 + wh_test_uniform(-0.1, 0.1));
        wafer.depth = wh_test_uniform(1, 1.25);
        wafer.opening = wh_test_uniform(89, 95) * WH_TEST_PI / 180;
        wafer.notch_x = cos(notch);
        wafer.notch_y = sin(notch);
        const wh_edge_place_t place = edge_at(&edge, &wafer, edge.end);
        const double x = 151.5 * cos(edge.alpha) - place.x;
        const double y = 151.5 * sin(edge.alpha) - place.y;
        assert_true(place.phase == WH_EDGE_SEATED);
        assert_true(wh_edge_meets_notch(&wafer, 151.5 * cos(edge.alpha), 151.5 * sin(edge.alpha)));
        assert_near(hypot(x, -151.5 * sin(edge.alpha) - place.y), wafer.radius + 1.5, EDGE_NEAR);
        assert_near(nearest_of_outline(&wafer, x, y), 1.5, 1e-6 + EDGE_NEAR);
    }
}

static void a_notch_at_the_plunger_moves_the_plunger_alone(void **state) {
    (void)state;
    const wh_edge_t edge = wh_edge_default(150);
    wh_edge_wafer_t wafer = notch_at(180);
    const wh_edge_place_t place = edge_at(&edge, &wafer, 4);
    assert_near(place.x, 0, EDGE_NEAR);
    assert_near(place.y, 0, EDGE_NEAR);
    assert_near(place.s, 1 - 0.6 * (sqrt(2) - 1), EDGE_NEAR);
    assert_true(place.held);
    static const double spread[2][3] = {{1, 89, 0.744}, {1.25, 95, 1.036}};
    for (size_t i = 0; i < 2; ++i) {
        wafer.depth = spread[i][0];
        wafer.opening = spread[i][1] * WH_TEST_PI / 180;
        assert_near(edge_at(&edge, &wafer, 4).s, spread[i][2], 5e-4);
    }
}

/* From retracted to the end in steps of the plunger: the wafer moves with it, and never runs ahead.
 * It passes through the phases in their order, and begins at its old place. */
static void on_its_path_the_wafer_never_jumps(void **state) {
    (void)state;
    int seen = 0;
    for (int i = 0; i < 1500 / WH_TEST_SHARE; ++i) {
        const wh_edge_t edge = wh_edge_default(150);
        wh_edge_wafer_t wafer =
            notch_at(i % 3 == 0 ? wh_test_uniform(29.4, 30.6) : wh_test_uniform(-180, 180));
        const double off = wh_test_uniform(0, 2.5);
        const double towards = wh_test_uniform(-4, 4);
        wafer.radius += wh_test_uniform(-0.1, 0.1);
        wafer.x = off * cos(towards);
        wafer.y = off * sin(towards);
        wh_edge_place_t before = edge_at(&edge, &wafer, edge.retracted);
        assert_true(before.phase == WH_EDGE_FREE && before.window == WH_EDGE_RETRACTED);
        assert_near(before.x, wafer.x, EDGE_SAME);
        assert_near(before.y, wafer.y, EDGE_SAME);
        for (double s = edge.retracted; s < edge.end; s += 0.01) {
            const wh_edge_place_t now = edge_at(&edge, &wafer, s);
            assert_true(now.phase >= before.phase && now.phase <= WH_EDGE_SEATED);
            assert_true(hypot(now.x - before.x, now.y - before.y) < 0.1);
            assert_true(now.phase == WH_EDGE_SEATED || fabs(now.s - s) <= EDGE_SAME);
            seen |= 1 << now.phase;
            before = now;
        }
        assert_true(before.phase == WH_EDGE_SEATED);
    }
    assert_int_equal(seen, 31);
}

static void beyond_the_clearance_a_wafer_jams(void **state) {
    (void)state;
    const wh_edge_t edge = wh_edge_default(150);
    wh_edge_wafer_t wafer = notch_at(90);
    wafer.x = -2.5;
    assert_true(edge_at(&edge, &wafer, 4).held);
    wafer.x = -2.75;
    wh_edge_place_t place = edge_at(&edge, &wafer, 4);
    assert_true(place.phase == WH_EDGE_JAMMED && place.window == WH_EDGE_SHORT && !place.held);
    assert_near(place.excess, 0.25, 1e-12);
    assert_near(place.s, -2.75, EDGE_NEAR);
    assert_true(place.x == wafer.x && place.y == 0);
    assert_int_equal(edge_at(&edge, &wafer, -2.76).phase, WH_EDGE_FREE);
    wafer.x = 0;
    wafer.y = 2.6;
    place = edge_at(&edge, &wafer, 4);
    assert_true(place.phase == WH_EDGE_JAMMED && place.window == WH_EDGE_GRIPPED && !place.held);
}

/* Its rim is behind the open plunger, which does not move. */
static void a_wafer_over_the_open_plunger_jams_there(void **state) {
    (void)state;
    const wh_edge_t edge = wh_edge_default(150);
    wh_edge_wafer_t wafer = notch_at(90);
    wafer.x = -40;
    for (int way = 0; way <= 12; ++way) {
        const wh_edge_place_t place = edge_at(&edge, &wafer, edge.retracted + way);
        assert_true(place.phase == WH_EDGE_JAMMED && place.window == WH_EDGE_RETRACTED && !place.held);
        assert_true(place.s == edge.retracted && place.x == -40 && place.y == 0);
        assert_near(place.excess, 37.5, 1e-12);
    }
}

static void a_miss_an_empty_blade_and_a_large_wafer_are_told_apart(void **state) {
    (void)state;
    const wh_edge_t edge = wh_edge_default(150);
    wh_edge_wafer_t wafer = notch_at(90);
    wafer.x = 3;
    wh_edge_place_t place = edge_at(&edge, &wafer, 3.5);
    assert_true(place.phase == WH_EDGE_FREE && place.window == WH_EDGE_OVERTRAVEL && !place.held);
    assert_int_equal(edge_at(&edge, &wafer, 9).phase, WH_EDGE_MISSED);
    place = edge_at(&edge, NULL, 9);
    assert_true(place.phase == WH_EDGE_MISSED && place.window == WH_EDGE_OVERTRAVEL && place.s == 4);
    wafer = notch_at(90);
    wafer.radius = 150.2;
    place = edge_at(&edge, &wafer, 4);
    assert_true(place.phase == WH_EDGE_SEATED && place.window == WH_EDGE_SHORT && !place.held);
}

static void an_edge_grip_refuses_what_is_out_of_range(void **state) {
    (void)state;
    wh_edge_t edge = wh_edge_default(150);
    wh_edge_wafer_t wafer = notch_at(0);
    wh_edge_place_t place;
    wh_edge_place_t before;
    memset(&place, 1, sizeof place);
    memcpy(&before, &place, sizeof place);
    double *const of_edge[] = {&edge.radius,    &edge.rest,      &edge.plunger,      &edge.alpha,
                               &edge.clearance, &edge.retracted, &edge.gripped_from, &edge.gripped_to,
                               &edge.end,       &edge.speed};
    double *const of_wafer[] = {&wafer.radius,  &wafer.x,      &wafer.y,      &wafer.depth,
                                &wafer.opening, &wafer.bottom, &wafer.notch_x};
    static const double bad_edges[] = {9, 0.05, 21, 0.4, 11, -3, -9, 6, 1, 0};
    static const double bad_wafers[] = {148.9, 51, -51, 0.1, 1.4, 1.6, 0.9};
    for (size_t i = 0; i < 17; ++i) {
        double *field = i < 10 ? of_edge[i] : of_wafer[i - 10];
        const double good = *field;
        *field = i < 10 ? bad_edges[i] : bad_wafers[i - 10];
        assert_int_equal(wh_edge_at(&edge, &wafer, 0, &place), WH_STATUS_OUT_OF_RANGE);
        *field = (double)NAN;
        assert_int_equal(wh_edge_at(&edge, &wafer, 0, &place), WH_STATUS_NOT_FINITE);
        *field = good;
    }
    assert_int_equal(wh_edge_at(NULL, &wafer, 0, &place), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_edge_wafer_validate(&edge, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_edge_at(&edge, &wafer, 0, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_edge_at(&edge, &wafer, (double)INFINITY, &place), WH_STATUS_NOT_FINITE);
    assert_memory_equal(&place, &before, sizeof place);
    assert_int_equal(wh_edge_at(&edge, &wafer, 0, &place), WH_OK);
}

/* Its depth, up to a fiftieth of the radius, and its opening; both ends belong to the range. */
static void the_ends_of_a_notchs_ranges(void **state) {
    (void)state;
    static const struct {
        double depth, degrees;
        wh_status_t status;
    } cases[] = {{1, 84.9, WH_STATUS_OUT_OF_RANGE},
                 {1, 85, WH_OK},
                 {1, 120, WH_OK},
                 {1, 120.1, WH_STATUS_OUT_OF_RANGE},
                 {0.19, 90, WH_STATUS_OUT_OF_RANGE},
                 {0.2, 90, WH_OK},
                 {3, 90, WH_OK},
                 {3.01, 90, WH_STATUS_OUT_OF_RANGE}};
    const wh_edge_t edge = wh_edge_default(150);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        wh_edge_wafer_t wafer = notch_at(0);
        wafer.bottom = 0; /* any depth leaves it straight flanks */
        wafer.depth = cases[i].depth;
        wafer.opening = cases[i].degrees * WH_TEST_PI / 180;
        assert_int_equal(wh_edge_wafer_validate(&edge, &wafer), cases[i].status);
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
        cmocka_unit_test(an_edge_grip_seats_a_round_wafer_by_the_exact_form),
        cmocka_unit_test(a_rest_over_the_notch_sinks_in),
        cmocka_unit_test(a_sunk_rest_touches_the_notchs_outline),
        cmocka_unit_test(a_notch_at_the_plunger_moves_the_plunger_alone),
        cmocka_unit_test(on_its_path_the_wafer_never_jumps),
        cmocka_unit_test(beyond_the_clearance_a_wafer_jams),
        cmocka_unit_test(a_wafer_over_the_open_plunger_jams_there),
        cmocka_unit_test(a_miss_an_empty_blade_and_a_large_wafer_are_told_apart),
        cmocka_unit_test(an_edge_grip_refuses_what_is_out_of_range),
        cmocka_unit_test(the_ends_of_a_notchs_ranges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
