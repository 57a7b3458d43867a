/* Ways of two arms, on a rail, with a flip: random ones keep all limits and the circle at each
 * millisecond, end exactly, and are close to the lower bound of all ways. With via points a rail is
 * passed, too, and so are points of an elbow and of two arms. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "motion/track.h"
#include "support/support.h"

#define WAYS (200 / WH_TEST_SHARE > 10 ? 200 / WH_TEST_SHARE : 10)
#define LONGEST 30000
#define RAIL 4
#define FLIP 5
#define SECOND 6
#define COUNT 7

#if defined(WH_FLOAT)
#define TOLERANCE 2e-3
#define ROUNDING 1e-6
#define NEAR 0.05
#else
#define TOLERANCE 1e-9
#define ROUNDING 2.3e-16
#define NEAR 1e-6
#endif

static wh_polar_t robot;
static wh_real_t from[WH_CARRIER_AXES], to[WH_CARRIER_AXES], reach[WH_POLAR_ARMS];
static wh_way_t way;
static wh_real_t sampled[LONGEST][WH_CARRIER_AXES];

/* theta, R, Z, yaw, a rail, a flip and a second R. */
static void usual_robot(void) {
    wh_robot_t usual;
    wh_robot_default(&usual);
    robot = wh_polar_from_robot(&usual);
    robot.axis_count = COUNT;
    robot.limits[RAIL] = (wh_limits_t){1000, 3000, 30000};
    robot.limits[FLIP] = (wh_limits_t){WH_PI, 4 * WH_PI, 40 * WH_PI};
    robot.limits[SECOND] = robot.limits[WH_AXIS_R];
    robot.rail = RAIL;
    robot.second = SECOND;
}

/* R is an elbow's angle. */
static bool bends;

static wh_real_t random_place(size_t axis) {
    static const double most[COUNT] = {3, 900, 1300, 2, 800, 3.1, 900};
    static const double least[COUNT] = {-3, 300, 600, -2, -800, 0, 300};
    return bends && axis == WH_AXIS_R ? WH_REAL(wh_test_uniform(-2.8, 2.8))
                                      : WH_REAL(wh_test_uniform(least[axis], most[axis]));
}

static void random_way(void) {
    usual_robot();
    memset(from, 0, sizeof from);
    memset(to, 0, sizeof to);
    for (size_t axis = 0; axis < COUNT; ++axis) {
        robot.limits[axis].speed *= WH_REAL(wh_test_decades(0.5, 2));
        robot.limits[axis].acceleration *= WH_REAL(wh_test_decades(0.5, 2));
        from[axis] = random_place(axis);
        to[axis] = wh_test_uniform(0, 1) < 0.3 ? from[axis] : random_place(axis);
    }
    for (size_t arm = 0; arm < WH_POLAR_ARMS; ++arm) {
        reach[arm] = WH_REAL(wh_test_uniform(300, 700));
    }
}

/* Each millisecond, from three before its begin to three after its end; returns how many there are. */
static int sample(void) {
    const int all = (int)(1000 * (double)wh_way_duration(&way)) + 8;
    assert_in_range(all, 8, LONGEST);
    for (int k = 0; k < all; ++k) {
        wh_way_at(&way, WH_REAL(0.001 * (k - 3)), sampled[k]);
    }
    return all;
}

static void assert_limits_kept(int all) {
    for (size_t axis = 0; axis < COUNT; ++axis) {
        const wh_limits_t *limits = &robot.limits[axis];
        const double most[] = {(double)limits->speed, (double)limits->acceleration, (double)limits->jerk};
        for (int k = 0; k + 3 < all; ++k) {
            const double a = (double)sampled[k][axis], b = (double)sampled[k + 1][axis];
            const double c = (double)sampled[k + 2][axis], d = (double)sampled[k + 3][axis];
            const double differences[] = {b - a, c - 2 * b + a, d - 3 * c + 3 * b - a};
            for (int order = 1; order <= 3; ++order) {
                const double noise = 16 * ROUNDING * 1300 / pow(0.001, order);
                assert_true(fabs(differences[order - 1]) / pow(0.001, order) <=
                            most[order - 1] * (1 + TOLERANCE) + noise);
            }
        }
    }
}

/* More than rounding. */
static bool has_moved(const wh_real_t q[], const wh_real_t before[], size_t axis) {
    return fabs((double)q[axis] - (double)before[axis]) > 16 * ROUNDING * (1 + fabs((double)q[axis]));
}

/* Within a millisecond a turn may begin, or end: one of its ends is within the circle. An arm that
 * is within it at both ends never leaves it. */
static void assert_circle_kept(int all) {
    static const size_t arms[] = {WH_AXIS_R, SECOND};
    for (int k = 1; k < all; ++k) {
        const wh_real_t *q = sampled[k];
        const wh_real_t *before = sampled[k - 1];
        const bool turns = has_moved(q, before, WH_AXIS_THETA) || has_moved(q, before, WH_AXIS_YAW) ||
                           has_moved(q, before, RAIL);
        for (size_t arm = 0; arm < WH_POLAR_ARMS; ++arm) {
            const double r = fmin((double)q[arms[arm]], (double)before[arms[arm]]);
            assert_false(turns && r > (double)reach[arm] + NEAR);
        }
    }
}

static void ways_of_all_axes_keep_limits_and_circle(void **state) {
    (void)state;
    int both = 0;
    for (int i = 0; i < WAYS; ++i) {
        random_way();
        assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_OK);
        const int all = sample();
        assert_memory_equal(sampled[0], from, COUNT * sizeof from[0]);
        assert_memory_equal(sampled[all - 1], to, COUNT * sizeof to[0]);
        assert_limits_kept(all);
        assert_circle_kept(all);
        both += way.out_count == WH_POLAR_ARMS;
    }
    assert_true(both > WAYS / 4);
}

/* The time at which an arm that never brakes has moved this far. */
static double passes(double distance) {
    wh_profile_t far;
    assert_int_equal(wh_profile_plan(&far, 1000000, &robot.limits[WH_AXIS_R]), WH_OK);
    double early = 0;
    double late = 100;
    for (int i = 0; i < 60; ++i) {
        const double middle = (early + late) / 2;
        *((double)wh_profile_position(&far, WH_REAL(middle)) < distance ? &early : &late) = middle;
    }
    return early;
}

/* One arm comes in from 700 mm and the other moves out to 700 mm, with a circle of 400 mm; or the
 * same arm does both. */
static void two_arms_are_near_their_bound(void **state) {
    (void)state;
    double worst = 0;
    usual_robot();
    reach[0] = 400;
    reach[1] = 400;
    for (int turn_deg = 30; turn_deg <= 180; turn_deg += 25) {
        for (int same = 0; same < 3; ++same) {
            wh_profile_t turn;
            memset(from, 0, sizeof from);
            memset(to, 0, sizeof to);
            from[WH_AXIS_R] = 700;
            from[SECOND] = same == 2 ? 700 : 300;
            to[WH_AXIS_R] = same > 0 ? 700 : 300;
            to[SECOND] = same == 1 ? 300 : 700;
            to[0] = wh_rad_from_deg((wh_real_t)turn_deg);
            assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_OK);
            assert_int_equal(wh_profile_plan(&turn, to[0], &robot.limits[WH_AXIS_THETA]), WH_OK);
            const double bound = 2 * passes(300) + (double)turn.duration;
            const double above = (double)wh_way_duration(&way) / bound - 1;
            print_message("%3d degrees, case %d: %.2f %% above the bound\n", turn_deg, same, 100 * above);
            assert_true(above > -1e-3);
            worst = fmax(worst, above);
        }
    }
    assert_true(worst <= 0.03);
}

static void bad_ways_change_nothing(void **state) {
    (void)state;
    random_way();
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_OK);
    const wh_way_t good = way;
    assert_int_equal(wh_way_plan_polar(NULL, &robot, from, to, reach), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_way_plan_polar(&way, NULL, from, to, reach), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_way_plan_polar(&way, &robot, NULL, to, reach), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, NULL, reach), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, NULL), WH_STATUS_NULL_ARGUMENT);
    reach[1] = 299;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_REACH);
    reach[1] = (wh_real_t)NAN;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_NOT_FINITE);
    reach[1] = 500;
    to[SECOND] = (wh_real_t)INFINITY;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_NOT_FINITE);
    to[SECOND] = 500;
    robot.limits[FLIP].speed = 0;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_BAD_LIMITS);
    usual_robot();
    const wh_polar_t sound = robot;
    robot.axis_count = WH_ROBOT_AXES - 1;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_RANGE);
    robot.axis_count = WH_CARRIER_AXES + 1;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_RANGE);
    robot = sound;
    robot.rail = COUNT;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_RANGE);
    robot = sound;
    robot.second = COUNT;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_RANGE);
    robot = sound;
    robot.links[0] = 400;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_RANGE);
    robot.links[1] = 400;
    assert_int_equal(wh_way_plan_polar(&way, &robot, from, to, reach), WH_STATUS_OUT_OF_RANGE);
    assert_memory_equal(&way, &good, sizeof way);
}

/* R's end moves along with the rail: a point for the rail alone is passed within the blend. */
static void a_rail_passes_a_point(void **state) {
    (void)state;
    static wh_via_t via;
    wh_via_point_t point = {.q = {0, 400, 900, 0, 500, 0, 300}, .blend = 60};
    usual_robot();
    const wh_real_t begin[WH_CARRIER_AXES] = {0, 400, 900, 0, 0, 0, 300};
    const wh_real_t end[WH_CARRIER_AXES] = {1, 400, 900, 0, 500, 0, 300};
    assert_int_equal(wh_via_plan_polar(&via, &robot, begin, &point, 1, end), WH_OK);
    assert_true(via.begin[1] < via.end[0]);
    double nearest = 1e9;
    double turned = 1e9; /* the way that the rail still has when theta begins to turn */
    for (double t = 0; t <= (double)wh_via_duration(&via); t += 1e-4) {
        wh_real_t q[WH_CARRIER_AXES];
        wh_via_at(&via, WH_REAL(t), q);
        const double x = (double)q[1] * cos((double)q[0]) + (double)q[RAIL] - 900;
        nearest = fmin(nearest, hypot(x, (double)q[1] * sin((double)q[0])));
        turned = q[0] > 0 && turned > 1e8 ? 500 - (double)q[RAIL] : turned;
    }
    assert_true(nearest <= 60.3);
    assert_true(turned <= 60 + 0.3 && turned > 1);
    point.reach[1] = -1;
    assert_int_equal(wh_via_plan_polar(&via, &robot, begin, &point, 1, end), WH_STATUS_OUT_OF_RANGE);
    point.reach[1] = 0;
    robot.rail = COUNT;
    assert_int_equal(wh_via_plan_polar(&via, &robot, begin, &point, 1, end), WH_STATUS_OUT_OF_RANGE);
}

/* The distance between an arm's end at two places, for a SCARA, or for the polar arm with this R. */
static double between_ends(const wh_real_t a[], const wh_real_t b[], size_t arm) {
    double complex ends[2];
    const wh_real_t *const q[2] = {a, b};
    for (int i = 0; i < 2; ++i) {
        const double complex along = cexp((double complex)I * (double)q[i][WH_AXIS_THETA]);
        const double complex bent = cexp((double complex)I * (double)q[i][WH_AXIS_R]);
        ends[i] = (double)q[i][RAIL];
        ends[i] += robot.links[0] > 0 ? along * ((double)robot.links[0] + (double)robot.links[1] * bent)
                                      : along * (double)q[i][arm];
    }
    return hypot(cabs(ends[0] - ends[1]), (double)a[WH_AXIS_Z] - (double)b[WH_AXIS_Z]);
}

/* While one leg blends into the other no arm is beyond the point's reach. */
static void assert_reach_kept(const wh_via_t *via, const wh_via_point_t *point) {
    const wh_real_t overlap = via->end[0] - via->begin[1];
    for (int k = 0; point->reach[0] > 0 && overlap > 0 && k <= 50; ++k) {
        wh_real_t q[WH_CARRIER_AXES];
        wh_via_at(via, via->begin[1] + overlap * WH_REAL(k) / 50, q);
        assert_true((double)q[WH_AXIS_R] <= (double)point->reach[0] + 100 * NEAR);
        assert_true((double)q[SECOND] <= (double)point->reach[1] + 100 * NEAR);
    }
}

/* Random ways by one point that can be shortened: at the begin of the second leg, and at the end of
 * the first one, each arm's end is within the blend. Returns how many such ways there were. */
static int pass_points(int ways) {
    static wh_via_t via;
    int blended = 0;
    for (int i = 0; i < ways; ++i) {
        wh_via_point_t point = {.blend = WH_REAL(wh_test_decades(10, 300))};
        memset(from, 0, sizeof from);
        memset(to, 0, sizeof to);
        for (size_t axis = 0; axis < COUNT; ++axis) {
            from[axis] = random_place(axis);
            point.q[axis] = random_place(axis);
            to[axis] = random_place(axis);
        }
        if (robot.second > 0 && i % 2 == 0) {
            point.reach[0] = point.q[WH_AXIS_R] + WH_REAL(wh_test_uniform(1, 100));
            point.reach[1] = point.q[SECOND] + WH_REAL(wh_test_uniform(1, 100));
        }
        assert_int_equal(wh_via_plan_polar(&via, &robot, from, &point, 1, to), WH_OK);
        assert_reach_kept(&via, &point);
        const wh_real_t ends[] = {via.begin[1], via.end[0]};
        for (int end = 0; end < 2 && via.begin[1] < via.end[0]; ++end) {
            wh_real_t q[WH_CARRIER_AXES];
            wh_via_at(&via, ends[end], q);
            assert_true(between_ends(q, point.q, WH_AXIS_R) <= (double)point.blend + 100 * NEAR);
            assert_true(robot.second == 0 ||
                        between_ends(q, point.q, SECOND) <= (double)point.blend + 100 * NEAR);
            ++blended;
        }
    }
    return blended / 2;
}

static void ends_of_all_arms_pass_within_the_blend(void **state) {
    (void)state;
    usual_robot();
    assert_true(pass_points(WAYS) > WAYS / 4);
    usual_robot();
    robot.second = 0;
    robot.links[0] = 400;
    robot.links[1] = 350;
    robot.limits[WH_AXIS_R] = robot.limits[WH_AXIS_THETA];
    bends = true;
    const int blended = pass_points(WAYS);
    bends = false;
    assert_true(blended > WAYS / 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ways_of_all_axes_keep_limits_and_circle),
        cmocka_unit_test(two_arms_are_near_their_bound),
        cmocka_unit_test(bad_ways_change_nothing),
        cmocka_unit_test(a_rail_passes_a_point),
        cmocka_unit_test(ends_of_all_arms_pass_within_the_blend),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
