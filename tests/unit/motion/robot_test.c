/* Oracle: the C library's sin, cos and remainders, in long double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "math/trig.h"
#include "motion/robot.h"
#include "support/support.h"

#define SAMPLES 100000
#define PI 3.14159265358979323846264338327950288L

#if defined(WH_FLOAT)
#define MM 1e-3
#define RAD 3e-6
#else
#define MM 1.5e-12
#define RAD 3e-15
#endif

#define DEG(d) wh_rad_from_deg((wh_real_t)(d))

static wh_robot_t standard(void) {
    wh_robot_t robot;
    wh_robot_default(&robot);
    assert_int_equal(wh_robot_validate(&robot), WH_OK);
    return robot;
}

static wh_real_t in_travel(const wh_robot_t *robot, size_t axis) {
    return (wh_real_t)wh_test_uniform((double)robot->travel[axis].min, (double)robot->travel[axis].max);
}

static double whole_turns_off(long double angle) {
    const long double turns = angle / (2 * PI);
    return (double)((turns - floorl(turns + 0.5L)) * 2 * PI);
}

static void forward_is_the_formula(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < SAMPLES; ++i) {
        wh_real_t q[WH_ROBOT_AXES];
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            q[axis] = in_travel(&robot, axis);
        }
        wh_pose_t pose;
        wh_robot_forward(q, &pose);
        assert_int_equal(wh_pose_validate(&pose), WH_OK);
        assert_near(pose.r.x, (double)((long double)q[1] * cosl((long double)q[0])), MM);
        assert_near(pose.r.y, (double)((long double)q[1] * sinl((long double)q[0])), MM);
        assert_near(pose.r.z, q[2], 0);
        const long double heading = (long double)q[0] + (long double)q[3];
        assert_near(pose.R.m[0][0], (double)cosl(heading), RAD);
        assert_near(pose.R.m[1][0], (double)sinl(heading), RAD);
        assert_true(pose.R.m[2][0] == 0 && pose.R.m[2][1] == 0 && pose.R.m[2][2] == 1);
    }
}

static void inverse_brings_the_effector_there(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < SAMPLES; ++i) {
        const double direction = wh_test_uniform(-3.1416, 3.1416);
        const double reach = wh_test_uniform(300.01, 899.99);
        const wh_real_t x = (wh_real_t)(reach * cos(direction));
        const wh_real_t y = (wh_real_t)(reach * sin(direction));
        const wh_real_t z = in_travel(&robot, WH_AXIS_Z);
        const wh_real_t heading = (wh_real_t)wh_test_uniform(-20, 20);
        const wh_real_t near_q[WH_ROBOT_AXES] = {in_travel(&robot, WH_AXIS_THETA), 300, 900, 0};
        wh_real_t q[WH_ROBOT_AXES];
        assert_int_equal(wh_robot_inverse(&robot, x, y, z, heading, near_q, q), WH_OK);
        wh_pose_t pose;
        wh_robot_forward(q, &pose);
        assert_near(pose.r.x, x, MM);
        assert_near(pose.r.y, y, MM);
        assert_near(pose.r.z, z, 0);
        assert_near(whole_turns_off((long double)q[0] + (long double)q[3] - (long double)heading), 0,
                    2 * RAD);
        assert_true((double)q[3] > -(double)PI && (double)q[3] <= (double)PI + (double)WH_SLACK_RAD);
        /* The shorter way, unless it leaves the travel. */
        const double way = fabs((double)(q[0] - near_q[0]));
        const double other = q[0] < near_q[0] ? (double)q[0] + 2 * (double)PI : (double)q[0] - 2 * (double)PI;
        assert_true(way <= (double)PI + RAD || fabs(other) > 3 * (double)PI);
    }
}

typedef struct {
    double near_deg, x, y, heading_deg; /* asked */
    double theta_deg, reach, yaw_deg;   /* expected */
} example_t;

static void examples(void **state) {
    (void)state;
    static const example_t table[] = {
        {0, 700, 0, 0, 0, 700, 0},
        {0, 0, 700, 90, 90, 700, 0},
        {0, 0, -700, -90, -90, 700, 0},
        {0, -600, 0, 180, 180, 600, 0},    /* half a turn: positive */
        {0, -600, -0.0, 180, 180, 600, 0}, /* from below the axis as well */
        {-180, 600, 0, 0, 0, 600, 0},      /* and from -180 */
        {90, 0, -700, -90, 270, 700, 0},   /* 270 and -90 are one heading */
        {360, 700, 0, 0, 360, 700, 0},     /* stays in its own turn */
        {400, 0, 700, 0, 450, 700, -90},
        {530, 0, -600, 0, 630 - 360, 600, 90}, /* the shorter way leaves the travel */
        {-530, 0, 600, 0, -270, 600, -90},
        {500, -500, 0, 0, 540, 500, 180}, /* the very end of it; yaw 180, not -180 */
        {0, 700, 0, 180, 0, 700, 180},
        {0, 700, 0, -180, 0, 700, 180},
        {0, 700, 0, 540, 0, 700, 180},
        {45, 400, 400, -100, 45, 565.685424949238, -145},
    };
    const wh_robot_t robot = standard();
    for (size_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        const example_t *e = &table[i];
        wh_real_t q[WH_ROBOT_AXES] = {DEG(e->near_deg), 300, 900, 0};
        assert_int_equal(
            wh_robot_inverse(&robot, (wh_real_t)e->x, (wh_real_t)e->y, 900, DEG(e->heading_deg), q, q),
            WH_OK);
        assert_near(wh_deg_from_rad(q[0]), e->theta_deg, 200 * RAD);
        assert_near(q[1], e->reach, MM);
        assert_near(wh_deg_from_rad(q[3]), e->yaw_deg, 200 * RAD);
    }
}

/* Rounding must not decide a tie: exactly opposite points, computed, all turn in the positive direction. */
static void half_a_turn_goes_positive_everywhere(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < 10000 / WH_TEST_SHARE; ++i) {
        const wh_real_t theta = (wh_real_t)wh_test_uniform(-9.4, 6.28);
        const wh_real_t now[WH_ROBOT_AXES] = {theta, 500, 900, 0};
        wh_pose_t pose;
        wh_robot_forward(now, &pose);
        wh_real_t q[WH_ROBOT_AXES];
        assert_int_equal(wh_robot_inverse(&robot, -pose.r.x, -pose.r.y, 900, theta, now, q), WH_OK);
        assert_near(q[0], (double)theta + (double)PI, 3 * RAD);
        assert_near(q[3], (double)PI, 6 * RAD);
    }
}

static void a_turn_more_changes_nothing_but_theta(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < 10000 / WH_TEST_SHARE; ++i) {
        const double direction = wh_test_uniform(-3.1, 3.1);
        const wh_real_t x = (wh_real_t)(600 * cos(direction));
        const wh_real_t y = (wh_real_t)(600 * sin(direction));
        wh_real_t first[WH_ROBOT_AXES] = {(wh_real_t)direction, 300, 900, 0};
        assert_int_equal(wh_robot_inverse(&robot, x, y, 900, 1, first, first), WH_OK);
        for (int turn = -1; turn <= 1; ++turn) {
            wh_real_t q[WH_ROBOT_AXES] = {(wh_real_t)(direction + 2 * turn * (double)PI), 300, 900, 0};
            assert_int_equal(wh_robot_inverse(&robot, x, y, 900, 1, q, q), WH_OK);
            wh_pose_t pose;
            wh_robot_forward(q, &pose);
            assert_near((double)q[0] - (double)first[0], 2 * turn * (double)PI, RAD);
            assert_near(q[1], first[1], 0);
            assert_near(q[3], first[3], RAD);
            assert_near(pose.r.x, x, MM);
            assert_near(pose.r.y, y, MM);
        }
    }
}

static wh_status_t inverse(const wh_robot_t *robot, double x, double y, double z, double heading) {
    static const wh_real_t home[WH_ROBOT_AXES] = {0, 300, 900, 0};
    wh_real_t q[WH_ROBOT_AXES] = {1, 2, 3, 4};
    const wh_status_t status =
        wh_robot_inverse(robot, (wh_real_t)x, (wh_real_t)y, (wh_real_t)z, (wh_real_t)heading, home, q);
    if (status != WH_OK) {
        const wh_real_t untouched[WH_ROBOT_AXES] = {1, 2, 3, 4};
        assert_memory_equal(q, untouched, sizeof q);
    }
    return status;
}

static void out_of_travel_is_refused(void **state) {
    (void)state;
    wh_robot_t robot = standard();
    const double slack = (double)WH_SLACK_MM;
    assert_int_equal(inverse(&robot, 900 + slack / 2, 0, 900, 0), WH_OK);
    assert_int_equal(inverse(&robot, 300 - slack / 2, 0, 900, 0), WH_OK);
    assert_int_equal(inverse(&robot, 900 + 2 * slack, 0, 900, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(inverse(&robot, 300 - 2 * slack, 0, 900, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(inverse(&robot, 1e30, -1e30, 900, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(inverse(&robot, 0, 0, 900, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(inverse(&robot, 700, 0, 600 - slack / 2, 0), WH_OK);
    assert_int_equal(inverse(&robot, 700, 0, 600 - 2 * slack, 0), WH_STATUS_LIMIT_EXCEEDED);
    assert_int_equal(inverse(&robot, 700, 0, 1300 + 2 * slack, 0), WH_STATUS_LIMIT_EXCEEDED);
    robot.travel[WH_AXIS_YAW].min = -1;
    robot.travel[WH_AXIS_YAW].max = 1;
    assert_int_equal(inverse(&robot, 700, 0, 900, 1), WH_OK);
    assert_int_equal(inverse(&robot, 700, 0, 900, 1.1), WH_STATUS_LIMIT_EXCEEDED);
    const double rad_slack = (double)WH_SLACK_RAD;
    assert_int_equal(inverse(&robot, 700, 0, 900, 1 + rad_slack / 2), WH_OK);
    assert_int_equal(inverse(&robot, 700, 0, 900, -1 - 2 * rad_slack), WH_STATUS_LIMIT_EXCEEDED);
    assert_int_equal(inverse(&robot, 700, 0, 900, 2e5), WH_STATUS_OUT_OF_RANGE);
    robot.travel[WH_AXIS_THETA].min = -2;
    robot.travel[WH_AXIS_THETA].max = 2;
    assert_int_equal(inverse(&robot, -700, 0, 900, 3.14), WH_STATUS_LIMIT_EXCEEDED);
    robot.travel[WH_AXIS_R].min = 0;
    assert_int_equal(inverse(&robot, 0, 0, 900, 0), WH_STATUS_OUT_OF_REACH);
}

static void bad_numbers_are_refused(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < 4; ++i) {
        double a[4] = {700, 0, 900, 0};
        a[i] = (double)NAN;
        assert_int_equal(inverse(&robot, a[0], a[1], a[2], a[3]), WH_STATUS_NOT_FINITE);
        a[i] = -(double)INFINITY;
        assert_int_equal(inverse(&robot, a[0], a[1], a[2], a[3]), WH_STATUS_NOT_FINITE);
    }
    assert_int_equal(inverse(&robot, 700, 0, 900, 2e5), WH_STATUS_OUT_OF_RANGE);
    wh_real_t q[WH_ROBOT_AXES] = {(wh_real_t)NAN, 300, 900, 0};
    assert_int_equal(wh_robot_inverse(&robot, 700, 0, 900, 0, q, q), WH_STATUS_NOT_FINITE);
    q[0] = WH_REAL(1e30);
    assert_int_equal(wh_robot_inverse(&robot, 700, 0, 900, 0, q, q), WH_STATUS_OUT_OF_RANGE);
    q[0] = 0;
    assert_int_equal(wh_robot_inverse(NULL, 700, 0, 900, 0, q, q), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_robot_inverse(&robot, 700, 0, 900, 0, NULL, q), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_robot_inverse(&robot, 700, 0, 900, 0, q, NULL), WH_STATUS_NULL_ARGUMENT);
}

static void travel_is_checked_by_axis(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    assert_int_equal(wh_robot_check_travel(&robot, robot.home), WH_OK);
    static const wh_status_t expected[WH_ROBOT_AXES] = {WH_STATUS_LIMIT_EXCEEDED, WH_STATUS_OUT_OF_REACH,
                                                        WH_STATUS_LIMIT_EXCEEDED, WH_STATUS_LIMIT_EXCEEDED};
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        wh_real_t q[WH_ROBOT_AXES];
        memcpy(q, robot.home, sizeof q);
        q[axis] = robot.travel[axis].max;
        assert_int_equal(wh_robot_check_travel(&robot, q), WH_OK);
        q[axis] = robot.travel[axis].max + WH_REAL(0.01);
        assert_int_equal(wh_robot_check_travel(&robot, q), expected[axis]);
        q[axis] = robot.travel[axis].min - WH_REAL(0.01);
        assert_int_equal(wh_robot_check_travel(&robot, q), expected[axis]);
        q[axis] = (wh_real_t)NAN;
        assert_int_equal(wh_robot_check_travel(&robot, q), WH_STATUS_NOT_FINITE);
    }
    assert_int_equal(wh_robot_check_travel(NULL, robot.home), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_robot_check_travel(&robot, NULL), WH_STATUS_NULL_ARGUMENT);
}

/* The table in motion/robot.h, angles in degrees. */
static void the_default_robot_is_the_documented_one(void **state) {
    (void)state;
    static const double table[WH_ROBOT_AXES][6] = {
        {-540, 540, 0, 300, 1000, 10000},
        {300, 900, 300, 1000, 5000, 50000},
        {600, 1300, 900, 400, 2000, 20000},
        {-270, 270, 0, 360, 1500, 15000},
    };
    wh_robot_t robot;
    wh_robot_default(&robot);
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_limits_t *limits = &robot.limits[axis];
        const wh_real_t got[] = {robot.travel[axis].min, robot.travel[axis].max, robot.home[axis],
                                 limits->speed,          limits->acceleration,   limits->jerk};
        const double unit = axis == WH_AXIS_THETA || axis == WH_AXIS_YAW ? 3.14159265358979323846 / 180 : 1;
        for (int k = 0; k < 6; ++k) {
            assert_near(got[k], table[axis][k] * unit, fabs(table[axis][k]) * 1e-7);
        }
    }
    assert_int_equal(wh_robot_validate(&robot), WH_OK);
    /* An arm may reach to its own column, but not through it. */
    robot.travel[WH_AXIS_R].min = 0;
    assert_int_equal(wh_robot_validate(&robot), WH_OK);
    robot.travel[WH_AXIS_R].min = WH_REAL(-1e-6);
    assert_int_equal(wh_robot_validate(&robot), WH_STATUS_BAD_LIMITS);
}

static void unsound_robots_are_refused(void **state) {
    (void)state;
    assert_int_equal(wh_robot_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    static const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (size_t i = 0; i < 3 * WH_ROBOT_AXES; ++i) {
        const size_t axis = i / 3;
        wh_robot_t robot[5] = {standard(), standard(), standard(), standard(), standard()};
        robot[0].travel[axis].min = (wh_real_t)bad[i % 3];
        robot[1].travel[axis].max = (wh_real_t)bad[i % 3];
        robot[2].limits[axis].jerk = (wh_real_t)bad[i % 3];
        robot[3].home[axis] = (wh_real_t)bad[i % 3];
        robot[4].travel[axis].max = robot[4].travel[axis].min;
        for (size_t k = 0; k < 5; ++k) {
            assert_int_equal(wh_robot_validate(&robot[k]), WH_STATUS_BAD_LIMITS);
        }
    }
    wh_robot_t robot = standard();
    robot.travel[WH_AXIS_R].min = -1;
    assert_int_equal(wh_robot_validate(&robot), WH_STATUS_BAD_LIMITS);
    robot = standard();
    robot.travel[WH_AXIS_THETA].max = WH_TRIG_MAX_RAD;
    assert_int_equal(wh_robot_validate(&robot), WH_STATUS_BAD_LIMITS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forward_is_the_formula),
        cmocka_unit_test(inverse_brings_the_effector_there),
        cmocka_unit_test(examples),
        cmocka_unit_test(half_a_turn_goes_positive_everywhere),
        cmocka_unit_test(a_turn_more_changes_nothing_but_theta),
        cmocka_unit_test(out_of_travel_is_refused),
        cmocka_unit_test(bad_numbers_are_refused),
        cmocka_unit_test(travel_is_checked_by_axis),
        cmocka_unit_test(the_default_robot_is_the_documented_one),
        cmocka_unit_test(unsound_robots_are_refused),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
