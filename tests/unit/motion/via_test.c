/* Ways by via points: random ones keep all limits when sampled each millisecond, pass each point
 * within its blend, and are faster than stopping there. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "motion/track.h"
#include "support/support.h"

#define WAYS (120 / WH_TEST_SHARE + 2)
#define LONGEST 20000

#if defined(WH_FLOAT)
#define TOLERANCE 2e-3
#define ROUNDING 1e-6
#else
#define TOLERANCE 1e-9
#define ROUNDING 2.3e-16
#endif

static wh_robot_t robot;
static wh_real_t from[WH_ROBOT_AXES], to[WH_ROBOT_AXES];
static wh_via_point_t points[WH_VIA_POINTS];
static size_t count;
static wh_via_t via;
static wh_real_t sampled[LONGEST][WH_ROBOT_AXES];

static void random_axes(wh_real_t q[WH_ROBOT_AXES]) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const double min = (double)robot.travel[axis].min;
        const double max = (double)robot.travel[axis].max;
        const double middle = (min + max) / 2;
        const double part = axis == WH_AXIS_R || axis == WH_AXIS_Z ? 1 : 0.3;
        q[axis] = WH_REAL(wh_test_uniform(middle + part * (min - middle), middle + part * (max - middle)));
    }
}

/* Some axes stand still on a leg, as when an arm comes in first. */
static void random_way(int i) {
    wh_robot_default(&robot);
    count = (size_t)i % WH_VIA_POINTS + 1;
    random_axes(from);
    random_axes(to);
    for (size_t p = 0; p < count; ++p) {
        const wh_real_t *before = p > 0 ? points[p - 1].q : from;
        random_axes(points[p].q);
        points[p].blend = WH_REAL(i % 7 == 0 ? 0 : wh_test_decades(1, 300));
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            points[p].q[axis] = wh_test_uniform(0, 1) < 0.4 ? before[axis] : points[p].q[axis];
        }
    }
}

/* Each millisecond, from three before its begin to three after its end; returns how many there are. */
static int sample(void) {
    const int all = (int)(1000 * (double)wh_via_duration(&via)) + 8;
    assert_in_range(all, 8, LONGEST);
    for (int k = 0; k < all; ++k) {
        wh_via_at(&via, WH_REAL(0.001 * (k - 3)), sampled[k]);
    }
    return all;
}

/* The largest divided difference of an order. */
static double difference(int all, size_t axis, int order) {
    double most = 0;
    for (int k = 0; k + order < all; ++k) {
        const double a = (double)sampled[k][axis], b = (double)sampled[k + 1][axis];
        const double c = (double)sampled[order > 1 ? k + 2 : k][axis];
        const double d = (double)sampled[order > 2 ? k + 3 : k][axis];
        most = fmax(most, fabs(order == 1 ? b - a : order == 2 ? c - 2 * b + a : d - 3 * c + 3 * b - a));
    }
    return most / pow(0.001, order);
}

static void assert_limits_kept(int all) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_limits_t *limits = &robot.limits[axis];
        const double most[] = {(double)limits->speed, (double)limits->acceleration, (double)limits->jerk};
        for (int order = 1; order <= 3; ++order) {
            const double noise = 16 * ROUNDING * 1300 / pow(0.001, order);
            assert_true(difference(all, axis, order) <= most[order - 1] * (1 + TOLERANCE) + noise);
        }
    }
}

static double distance(const wh_real_t a[], const wh_real_t b[]) {
    return sqrt(pow((double)a[1] * cos((double)a[0]) - (double)b[1] * cos((double)b[0]), 2) +
                pow((double)a[1] * sin((double)a[0]) - (double)b[1] * sin((double)b[0]), 2) +
                pow((double)a[2] - (double)b[2], 2));
}

/* In a tenth of a millisecond each axis moves at most 0.1 mm. */
static void assert_passed_near(const wh_via_point_t *point) {
    double nearest = 1e9;
    for (double t = 0; t <= (double)wh_via_duration(&via) + 1e-4; t += 1e-4) {
        wh_real_t q[WH_ROBOT_AXES];
        wh_via_at(&via, WH_REAL(t), q);
        nearest = fmin(nearest, distance(q, point->q));
    }
    assert_true(nearest <= (double)point->blend + 0.3);
}

static void ways_keep_limits_and_pass_within_the_blend(void **state) {
    (void)state;
    int blended = 0;
    for (int i = 0; i < WAYS; ++i) {
        random_way(i);
        assert_int_equal(wh_via_plan(&via, &robot, from, points, count, to), WH_OK);
        const int all = sample();
        assert_memory_equal(sampled[0], from, sizeof from);
        assert_memory_equal(sampled[all - 1], to, sizeof to);
        assert_limits_kept(all);
        for (size_t p = 0; p < count; ++p) {
            assert_passed_near(&points[p]);
            blended += via.begin[p + 1] < via.end[p];
            assert_true(via.begin[p + 1] <= via.end[p]);
            assert_true(i % 7 != 0 || via.begin[p + 1] >= via.end[p]);
        }
    }
    assert_true(blended > WAYS / 2);
}

/* Never slower than stopping at each point. */
static void a_blend_saves_time(void **state) {
    (void)state;
    wh_robot_default(&robot);
    const wh_real_t begin[] = {0, 700, 900, 0}, middle[] = {0, 350, 900, 0}, end[] = {2, 350, 900, 0};
    points[0].blend = 0;
    memcpy(points[0].q, middle, sizeof middle);
    assert_int_equal(wh_via_plan(&via, &robot, begin, points, 1, end), WH_OK);
    const double stops = (double)wh_via_duration(&via);
    double before = stops;
    for (int blend = 10; blend <= 160; blend *= 2) {
        points[0].blend = (wh_real_t)blend;
        assert_int_equal(wh_via_plan(&via, &robot, begin, points, 1, end), WH_OK);
        assert_true((double)wh_via_duration(&via) <= before);
        before = (double)wh_via_duration(&via);
    }
    assert_true(before < 0.85 * stops);
}

static void bad_ways_change_nothing(void **state) {
    (void)state;
    random_way(2);
    assert_int_equal(wh_via_plan(&via, &robot, from, points, count, to), WH_OK);
    const wh_via_t good = via;
    assert_int_equal(wh_via_plan(NULL, &robot, from, points, 1, to), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_via_plan(&via, NULL, from, points, 1, to), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_via_plan(&via, &robot, NULL, points, 1, to), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_via_plan(&via, &robot, from, NULL, 1, to), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_via_plan(&via, &robot, from, points, 1, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_via_plan(&via, &robot, from, points, 0, to), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_via_plan(&via, &robot, from, points, WH_VIA_POINTS + 1, to), WH_STATUS_OUT_OF_RANGE);
    points[0].blend = -1;
    assert_int_equal(wh_via_plan(&via, &robot, from, points, 1, to), WH_STATUS_OUT_OF_RANGE);
    points[0].blend = (wh_real_t)NAN;
    assert_int_equal(wh_via_plan(&via, &robot, from, points, 1, to), WH_STATUS_OUT_OF_RANGE);
    points[0].blend = 1;
    points[0].q[2] = (wh_real_t)NAN;
    assert_int_equal(wh_via_plan(&via, &robot, from, points, 1, to), WH_STATUS_NOT_FINITE);
    assert_memory_equal(&via, &good, sizeof via);
}

static void a_track_goes_by_points_that_it_may_reach(void **state) {
    (void)state;
    wh_machine_t machine = {.axis_count = WH_ROBOT_AXES, .gripper_count = 1};
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.mounts[0].axis = WH_NONE;
    wh_track_t track;
    assert_int_equal(wh_track_init(&track, &machine, 1000), WH_OK);
    wh_segment_t segment = wh_track_blank(&track);
    wh_via_point_t point = {.q = {1, 400, 950, 0}, .blend = 50};
    segment.kind = WH_SEGMENT_VIA;
    segment.target[WH_AXIS_R] = 700;
    segment.points = &point;
    segment.point_count = 1;
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_BAD_SEGMENT);
    wh_track_take_vias(&track);
    point.q[WH_AXIS_R] = 100;
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_OUT_OF_REACH);
    point.q[WH_AXIS_R] = 400;
    point.q[WH_AXIS_Z] = 2000;
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_LIMIT_EXCEEDED);
    point.q[WH_AXIS_Z] = 950;
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    double nearest = 1e9;
    while (wh_track_next(&track, 0) == WH_TRACK_MOVING) {
        nearest = fmin(nearest, distance(track.axes, point.q));
    }
    assert_true(nearest <= 51);
    assert_memory_equal(track.axes, segment.target, sizeof track.axes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ways_keep_limits_and_pass_within_the_blend),
        cmocka_unit_test(a_blend_saves_time),
        cmocka_unit_test(bad_ways_change_nothing),
        cmocka_unit_test(a_track_goes_by_points_that_it_may_reach),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
