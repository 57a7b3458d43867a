/* Oracle: the axes' derivatives by time, from power series of the straight path in long double. No
 * formula of the code under test is used for R or theta. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "math/trig.h"
#include "motion/line.h"
#include "support/pose.h"

#define LINES (5000 / WH_TEST_SHARE)
#define INSTANTS 20

#if defined(WH_FLOAT)
#define MM 2e-3
#define RAD 5e-6
#define LIMIT_TOLERANCE 1e-4
#else
#define MM 2e-12
#define RAD 5e-15
#define LIMIT_TOLERANCE 1e-9
#endif

/* A quantity and its first three derivatives by time. */
typedef struct {
    long double d[4];
} jet_t;

static jet_t times(jet_t a, jet_t b) {
    const jet_t c = {{a.d[0] * b.d[0], a.d[1] * b.d[0] + a.d[0] * b.d[1],
                      a.d[2] * b.d[0] + 2 * a.d[1] * b.d[1] + a.d[0] * b.d[2],
                      a.d[3] * b.d[0] + 3 * a.d[2] * b.d[1] + 3 * a.d[1] * b.d[2] + a.d[0] * b.d[3]}};
    return c;
}

static jet_t plus(jet_t a, jet_t b, long double factor) {
    for (int k = 0; k < 4; ++k) {
        a.d[k] += factor * b.d[k];
    }
    return a;
}

/* From a = root * root, derivative by derivative. */
static jet_t root_of(jet_t a) {
    jet_t r;
    r.d[0] = sqrtl(a.d[0]);
    r.d[1] = a.d[1] / (2 * r.d[0]);
    r.d[2] = (a.d[2] - 2 * r.d[1] * r.d[1]) / (2 * r.d[0]);
    r.d[3] = (a.d[3] - 6 * r.d[1] * r.d[2]) / (2 * r.d[0]);
    return r;
}

/* q with a = q * b. */
static jet_t over(jet_t a, jet_t b) {
    jet_t q;
    q.d[0] = a.d[0] / b.d[0];
    q.d[1] = (a.d[1] - q.d[0] * b.d[1]) / b.d[0];
    q.d[2] = (a.d[2] - 2 * q.d[1] * b.d[1] - q.d[0] * b.d[2]) / b.d[0];
    q.d[3] = (a.d[3] - 3 * q.d[2] * b.d[1] - 3 * q.d[1] * b.d[2] - q.d[0] * b.d[3]) / b.d[0];
    return q;
}

static jet_t shifted(jet_t a) {
    const jet_t b = {{a.d[1], a.d[2], a.d[3], 0}};
    return b;
}

typedef struct {
    wh_real_t from[WH_ROBOT_AXES];
    wh_real_t step[3];
    wh_real_t cap;
} task_t;

static wh_robot_t standard(void) {
    wh_robot_t robot;
    wh_robot_default(&robot);
    return robot;
}

static task_t random_task(const wh_robot_t *robot, int i) {
    task_t task;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        task.from[axis] =
            (wh_real_t)wh_test_uniform((double)robot->travel[axis].min, (double)robot->travel[axis].max);
    }
    const double length = wh_test_decades(1e-3, 1500);
    const double direction = wh_test_uniform(-4, 4);
    const double climb = i % 2 == 0 ? 0 : wh_test_uniform(-1.58, 1.58);
    task.step[0] = (wh_real_t)(length * cos(direction) * cos(climb));
    task.step[1] = (wh_real_t)(length * sin(direction) * cos(climb));
    task.step[2] = (wh_real_t)(length * sin(climb));
    task.cap = i % 5 == 0 ? (wh_real_t)wh_test_decades(1, 2000) : 0;
    return task;
}

static wh_status_t plan(wh_line_t *line, const wh_robot_t *robot, const task_t *task) {
    return wh_line_plan(line, robot, task->from, task->step[0], task->step[1], task->step[2], task->cap);
}

/* The axes' derivatives at t, for the straight path of the task. */
static void oracle(const wh_line_t *line, const task_t *task, wh_real_t t, jet_t q[WH_ROBOT_AXES]) {
    wh_motion_t m;
    wh_profile_at(&line->path, t, &m);
    const long double theta = (long double)task->from[0];
    const long double R = (long double)task->from[1];
    const long double dx = (long double)task->step[0];
    const long double dy = (long double)task->step[1];
    const long double dz = (long double)task->step[2];
    const long double length = sqrtl(dx * dx + dy * dy + dz * dz);
    const jet_t zero = {{0, 0, 0, 0}};
    const jet_t s = {
        {(long double)m.position, (long double)m.speed, (long double)m.acceleration, (long double)m.jerk}};
    jet_t x = plus(zero, s, dx / length);
    jet_t y = plus(zero, s, dy / length);
    q[2] = plus(zero, s, dz / length);
    x.d[0] += R * cosl(theta);
    y.d[0] += R * sinl(theta);
    q[2].d[0] += (long double)task->from[2];
    const jet_t square = plus(times(x, x), times(y, y), 1);
    q[1] = root_of(square);
    const jet_t rate = over(plus(times(x, shifted(y)), times(y, shifted(x)), -1), square);
    const long double direction = atan2l(y.d[0], x.d[0]);
    q[0] = zero;
    q[0].d[0] = direction;
    memcpy(&q[0].d[1], rate.d, 3 * sizeof rate.d[0]);
    q[3] = plus(zero, q[0], -1);
}

/* The share of its limits that the axis uses: the factor in time by which it could be slowed to
 * just keep them. */
static double worst_use(const jet_t *q, const wh_limits_t *limits) {
    const double speed = fabs((double)q->d[1]) / (double)limits->speed;
    const double acceleration = sqrt(fabs((double)q->d[2]) / (double)limits->acceleration);
    const double jerk = cbrt(fabs((double)q->d[3]) / (double)limits->jerk);
    return fmax(speed, fmax(acceleration, jerk));
}

/* The instant at which the line is nearest to length s. */
static wh_real_t instant_of(const wh_line_t *line, double s) {
    double early = 0;
    double late = (double)wh_line_duration(line);
    for (int k = 0; k < 30; ++k) {
        wh_motion_t m;
        wh_profile_at(&line->path, (wh_real_t)((early + late) / 2), &m);
        *((double)m.position < s ? &early : &late) = (early + late) / 2;
    }
    return (wh_real_t)early;
}

/* Half the instants are anywhere, half are near the point closest to base's axis, where theta and R
 * bend most. */
static wh_real_t telling_instant(const wh_line_t *line, int k) {
    if (k % 2 == 0) {
        return (wh_real_t)wh_test_uniform(0, (double)wh_line_duration(line));
    }
    const double R = (double)line->from[1];
    const double closest = -R * (double)line->direction.x;
    const double beside = R * fabs((double)line->direction.y);
    return instant_of(line, closest + beside * wh_test_uniform(-1.5, 1.5));
}

/* The greatest use of a limit on the line, at any of many instants and for any axis. */
static double greatest_use(const wh_line_t *line, const wh_robot_t *robot, const task_t *task) {
    double use = 0;
    for (int k = 0; k < 4 * INSTANTS; ++k) {
        jet_t q[WH_ROBOT_AXES];
        oracle(line, task, telling_instant(line, k), q);
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            use = fmax(use, worst_use(&q[axis], &robot->limits[axis]));
        }
    }
    return use;
}

static void no_axis_exceeds_its_limits(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    int planned = 0;
    double loosest = 1;
    for (int i = 0; i < LINES; ++i) {
        const task_t task = random_task(&robot, i);
        wh_line_t line;
        if (plan(&line, &robot, &task) != WH_OK) {
            continue;
        }
        ++planned;
        const double use = greatest_use(&line, &robot, &task);
        assert_true(use <= 1 + LIMIT_TOLERANCE);
        if (task.cap == 0) {
            loosest = fmin(loosest, use);
        }
    }
    printf("%d of %d lines planned; the least used of them could be %.2f times as fast\n", planned, LINES,
           1 / loosest);
    assert_true(planned > LINES / 10);
    assert_true(loosest > 0.5);
}

/* Arms with a high limit of one kind and a low one of another, passing close by base's axis: each
 * bound decides somewhere. */
static void odd_robots_keep_their_limits(void **state) {
    (void)state;
    double sum = 0;
    for (int i = 0; i < LINES; ++i) {
        wh_robot_t robot = standard();
        robot.travel[WH_AXIS_R].min = 1;
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            robot.limits[axis].speed *= (wh_real_t)wh_test_decades(0.1, 1000);
            robot.limits[axis].acceleration *= (wh_real_t)wh_test_decades(0.1, 1000);
            robot.limits[axis].jerk *= (wh_real_t)wh_test_decades(0.1, 1000);
        }
        const double begin = wh_test_uniform(-700, 100);
        const double end = begin + wh_test_uniform(1, 700);
        const double beside = wh_test_decades(2, 300);
        const task_t task = {
            {(wh_real_t)atan2(beside, begin), (wh_real_t)sqrt(begin * begin + beside * beside), 900, 0},
            {(wh_real_t)(end - begin), 0, 0},
            0};
        wh_line_t line;
        assert_int_equal(plan(&line, &robot, &task), WH_OK);
        const double use = greatest_use(&line, &robot, &task);
        assert_true(use <= 1 + LIMIT_TOLERANCE);
        sum += use;
    }
    printf("odd robots use %.3f of what their limits allow in the mean\n", sum / LINES);
    assert_true(sum / LINES > 0.5);
}

static void the_effector_keeps_to_the_line(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < LINES; ++i) {
        const task_t task = random_task(&robot, i);
        wh_line_t line;
        if (plan(&line, &robot, &task) != WH_OK) {
            continue;
        }
        wh_real_t before = task.from[0];
        for (int k = 0; k <= INSTANTS; ++k) {
            const wh_real_t t = wh_line_duration(&line) * (wh_real_t)k / INSTANTS;
            jet_t want[WH_ROBOT_AXES];
            wh_real_t q[WH_ROBOT_AXES];
            oracle(&line, &task, t, want);
            wh_line_at(&line, t, q);
            assert_near((double)q[1] * cos((double)q[0]), (double)(want[1].d[0] * cosl(want[0].d[0])), MM);
            assert_near((double)q[1] * sin((double)q[0]), (double)(want[1].d[0] * sinl(want[0].d[0])), MM);
            assert_near(q[2], (double)want[2].d[0], MM);
            assert_near((double)q[0] + (double)q[3], (double)task.from[0] + (double)task.from[3], RAD);
            assert_true(fabs((double)(q[0] - before)) < 3.15); /* no turn is lost between two instants */
            before = q[0];
        }
    }
}

static void ends_are_exact(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < LINES; ++i) {
        const task_t task = random_task(&robot, i);
        wh_line_t line;
        if (plan(&line, &robot, &task) != WH_OK) {
            continue;
        }
        wh_real_t q[WH_ROBOT_AXES];
        const wh_real_t begin[] = {0, -1, (wh_real_t)NAN};
        for (size_t k = 0; k < 3; ++k) {
            wh_line_at(&line, begin[k], q);
            assert_memory_equal(q, task.from, sizeof q);
        }
        const wh_real_t end[] = {wh_line_duration(&line), 1000, (wh_real_t)INFINITY};
        for (size_t k = 0; k < 3; ++k) {
            wh_line_at(&line, end[k], q);
            assert_memory_equal(q, line.to, sizeof q);
        }
        wh_pose_t pose;
        wh_robot_forward(line.to, &pose);
        assert_near(pose.r.x, (double)task.from[1] * cos((double)task.from[0]) + (double)task.step[0], MM);
        assert_near(pose.r.y, (double)task.from[1] * sin((double)task.from[0]) + (double)task.step[1], MM);
        assert_near(pose.r.z, task.from[2] + task.step[2], MM);
    }
}

/* It is refused exactly if a point of the line is out of travel. */
static void travel_is_checked_everywhere(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < LINES; ++i) {
        const task_t task = random_task(&robot, i);
        const double x = (double)task.from[1] * cos((double)task.from[0]);
        const double y = (double)task.from[1] * sin((double)task.from[0]);
        double least = 1e9;
        double most = 0;
        for (int k = 0; k <= 1000; ++k) {
            const double px = x + (double)task.step[0] * k / 1000;
            const double py = y + (double)task.step[1] * k / 1000;
            const double R = sqrt(px * px + py * py);
            least = fmin(least, R);
            most = fmax(most, R);
        }
        wh_line_t line;
        const wh_status_t status = plan(&line, &robot, &task);
        if (least < 299.99 || most > 900.01) {
            assert_int_equal(status, WH_STATUS_OUT_OF_REACH);
        } else if (least > 300.01 && most < 899.99) {
            assert_true(status == WH_OK || status == WH_STATUS_LIMIT_EXCEEDED);
        }
        if (status == WH_OK) {
            assert_int_equal(wh_robot_check_travel(&robot, line.to), WH_OK);
        }
    }
}

/* A radial line is R's own move, a vertical one Z's. */
static void simple_lines_are_not_slowed(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    for (int i = 0; i < 1000; ++i) {
        const double theta = wh_test_uniform(-9, 9);
        const double reach = wh_test_uniform(0.01, 500);
        const double lift = wh_test_uniform(0.01, 300);
        const wh_real_t from[WH_ROBOT_AXES] = {(wh_real_t)theta, 400, 900, 1};
        wh_line_t line;
        wh_profile_t alone;
        assert_int_equal(wh_line_plan(&line, &robot, from, (wh_real_t)(reach * cos(theta)),
                                      (wh_real_t)(reach * sin(theta)), 0, 0),
                         WH_OK);
        assert_int_equal(wh_profile_plan(&alone, (wh_real_t)reach, &robot.limits[WH_AXIS_R]), WH_OK);
        assert_near(wh_line_duration(&line), alone.duration, MM);
        assert_near(line.to[0], theta, 10 * RAD);
        assert_near(line.to[1], 400 + reach, MM);
        assert_int_equal(wh_line_plan(&line, &robot, from, 0, 0, (wh_real_t)lift, 0), WH_OK);
        assert_int_equal(wh_profile_plan(&alone, (wh_real_t)lift, &robot.limits[WH_AXIS_Z]), WH_OK);
        assert_near(wh_line_duration(&line), alone.duration, MM);
        assert_true(line.to[0] == from[0] && line.to[1] == from[1] && line.to[3] == from[3]);
        assert_near(line.slowed, 1, 0);
    }
}

static void the_cap_limits_the_speed(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    wh_line_t line;
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 0, 10, 20), WH_OK);
    assert_near(wh_profile_peak_speed(&line.path), 20, 1e-4);
    assert_true(wh_line_duration(&line) > WH_REAL(0.5));
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 500, 0, 0, 1e6), WH_OK);
    assert_near(wh_profile_peak_speed(&line.path), 1000, 1e-2);
}

static void the_cap_limits_the_acceleration(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    const wh_vec3_t up = wh_vec3(0, 0, 10);
    const wh_line_caps_t speed_alone = {20, 0};
    const wh_line_caps_t both = {20, 100};
    const wh_line_caps_t high = {20, 1e5};
    const wh_line_caps_t negative = {20, -1};
    const wh_line_caps_t nan = {20, (wh_real_t)NAN};
    wh_line_t line;
    wh_line_t plain;
    assert_int_equal(wh_line_plan(&plain, &robot, robot.home, 0, 0, 10, 20), WH_OK);
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, &up, &speed_alone), WH_OK);
    assert_true(wh_line_duration(&line) == wh_line_duration(&plain));
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, &up, &high), WH_OK);
    assert_true(wh_line_duration(&line) == wh_line_duration(&plain));
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, &up, &both), WH_OK);
    assert_near(wh_profile_peak_acceleration(&line.path), 100, 1e-3);
    assert_true(wh_line_duration(&line) > wh_line_duration(&plain));
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, &up, &negative), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, &up, &nan), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, &up, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_line_plan_capped(&line, &robot, robot.home, NULL, &both), WH_STATUS_NULL_ARGUMENT);
}

static void no_length_takes_no_time(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    wh_line_t line;
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 0, 0, 0), WH_OK);
    assert_near(wh_line_duration(&line), 0, 0);
    assert_memory_equal(line.to, robot.home, sizeof line.to);
    assert_true(line.direction.x == 1 && line.direction.y == 0 && line.direction.z == 0);
    assert_near(line.slowed, 1, 0);
}

static void a_line_near_the_axis_is_refused(void **state) {
    (void)state;
    wh_robot_t robot = standard();
    wh_line_t line;
    const wh_real_t from[WH_ROBOT_AXES] = {0, 500, 900, 0};
    assert_int_equal(wh_line_plan(&line, &robot, from, -1000, 0, 0, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_line_plan(&line, &robot, from, -1000, 100, 0, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_line_plan(&line, &robot, from, -201, 0, 0, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_line_plan(&line, &robot, from, -200, 0, 0, 0), WH_OK);
    robot.travel[WH_AXIS_R].min = 0;
    assert_int_equal(wh_line_plan(&line, &robot, from, -1000, 0, 0, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_line_plan(&line, &robot, from, -500, 0, 0, 0), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_line_plan(&line, &robot, from, -499, 0, 0, 0), WH_OK);
    /* Past it at 1 mm: half a turn of theta, slowly. */
    const wh_real_t beside[WH_ROBOT_AXES] = {WH_PI / 2, 1, 900, 0};
    assert_int_equal(wh_line_plan(&line, &robot, beside, 100, 0, 0, 0), WH_OK);
    assert_near(line.to[0], atan2(1, 100), 1e-5);
    assert_true(line.slowed > 10);
}

static void other_axes_travel_is_checked(void **state) {
    (void)state;
    wh_robot_t robot = standard();
    wh_line_t line;
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 0, 401, 0), WH_STATUS_LIMIT_EXCEEDED);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 0, 400, 0), WH_OK);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 601, 0, 0, 0), WH_STATUS_OUT_OF_REACH);
    robot.travel[WH_AXIS_YAW].min = WH_REAL(-0.1);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 200, 0, 0), WH_STATUS_LIMIT_EXCEEDED);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, -200, 0, 0), WH_OK);
    robot.travel[WH_AXIS_THETA].min = WH_REAL(-0.1);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, -200, 0, 0), WH_STATUS_LIMIT_EXCEEDED);
    wh_real_t q[WH_ROBOT_AXES] = {0, 300, 599, 0};
    assert_int_equal(wh_line_plan(&line, &robot, q, 0, 0, 50, 0), WH_STATUS_LIMIT_EXCEEDED);
}

static void bad_arguments_change_nothing(void **state) {
    (void)state;
    const wh_robot_t robot = standard();
    wh_line_t line;
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 100, 50, 25, 0), WH_OK);
    wh_line_t before;
    memcpy(&before, &line, sizeof line);
    const wh_real_t nan = (wh_real_t)NAN;
    const wh_real_t lost[WH_ROBOT_AXES] = {0, nan, 900, 0};
    assert_int_equal(wh_line_plan(NULL, &robot, robot.home, 1, 0, 0, 0), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_line_plan(&line, NULL, robot.home, 1, 0, 0, 0), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_line_plan(&line, &robot, NULL, 1, 0, 0, 0), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_line_plan(&line, &robot, lost, 1, 0, 0, 0), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, nan, 0, 0, 0), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, nan, 0, 0), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 0, (wh_real_t)INFINITY, 0),
                     WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 1, 0, 0, nan), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 1, 0, 0, -1), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 1e6, 0, 0, 0), WH_STATUS_OUT_OF_REACH);
    assert_memory_equal(&line, &before, sizeof line);
}

/* Limits and caps with which the line would take longer than a number can say. */
static void limits_too_extreme_are_refused(void **state) {
    (void)state;
    const wh_real_t least = sizeof(wh_real_t) == 4 ? WH_REAL(1e-45) : WH_REAL(5e-324);
    wh_robot_t robot = standard();
    wh_line_t line;
    memset(&line, 0x5a, sizeof line);
    const wh_line_t before = line;
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 100, 0, 0, least), WH_STATUS_BAD_LIMITS);
    robot.limits[WH_AXIS_THETA].speed = least;
    assert_int_equal(wh_robot_validate(&robot), WH_OK);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 0, 100, 0, 0), WH_STATUS_BAD_LIMITS);
    assert_memory_equal(&line, &before, sizeof line);
    assert_int_equal(wh_line_plan(&line, &robot, robot.home, 100, 0, 0, 0), WH_OK);
}

/* ------------------------------------------------------------ by how much a line is slowed */
/* Oracle: the slowing of a line, from the axes' derivatives at very many of its points. The
 * closed-form maxima of motion/line.c are neither above nor below the values that occur. */
#define SLOWED_LINES (3000 / WH_TEST_SHARE)
#define POINTS 400

#if defined(WH_FLOAT)
#define SLOWED_TOLERANCE 1e-3
#else
#define SLOWED_TOLERANCE 1e-4
#endif

/* A horizontal line that passes base's axis `d` beside it, from `begin` to `end` of the closest point. */
typedef struct {
    double d, begin, end;
} passage_t;

typedef struct {
    double first, second, third;
} most_t;

static void keep(most_t *most, double first, double second, double third) {
    most->first = fmax(most->first, fabs(first));
    most->second = fmax(most->second, fabs(second));
    most->third = fmax(most->third, fabs(third));
}

/* The derivatives of R = sqrt(c^2 + d^2) and theta = atan(c / d) by c. */
static void look_at(const passage_t *p, double c, most_t *R_most, most_t *theta_most) {
    const double d = p->d;
    const double R = sqrt(c * c + d * d);
    keep(R_most, c / R, d * d / pow(R, 3), 3 * d * d * c / pow(R, 5));
    keep(theta_most, d / (R * R), 2 * d * c / pow(R, 4), 2 * d * (3 * c * c - d * d) / pow(R, 6));
}

/* Evenly over the line, and again within a few d of the closest point, where the values change. */
static void look_along(const passage_t *p, most_t *R_most, most_t *theta_most) {
    const most_t none = {0, 0, 0};
    *R_most = *theta_most = none;
    for (int k = 0; k <= POINTS; ++k) {
        const double even = p->begin + (p->end - p->begin) * k / POINTS;
        const double close = (4.0 * k / POINTS - 2) * p->d;
        look_at(p, even, R_most, theta_most);
        look_at(p, fmin(fmax(close, p->begin), p->end), R_most, theta_most);
    }
}

static double slowing(const most_t *q, double v, double a, double j, const wh_limits_t *limits) {
    const double speed = q->first * v;
    const double acceleration = q->second * v * v + q->first * a;
    const double jerk = q->third * v * v * v + 3 * q->second * v * a + q->first * j;
    return fmax(speed / (double)limits->speed,
                fmax(sqrt(acceleration / (double)limits->acceleration), cbrt(jerk / (double)limits->jerk)));
}

static wh_limits_t random_limits(double size) {
    const wh_limits_t limits = {WH_REAL(size * wh_test_decades(0.1, 10)),
                                WH_REAL(5 * size * wh_test_decades(0.1, 10)),
                                WH_REAL(50 * size * wh_test_decades(0.1, 10))};
    return limits;
}

/* Any limits, and an arm that may come close to its own column. */
static wh_robot_t random_robot(void) {
    wh_robot_t robot;
    wh_robot_default(&robot);
    robot.travel[WH_AXIS_R].min = 0;
    const double pace = wh_test_decades(1e-5, 1);
    robot.limits[WH_AXIS_R] = random_limits(1000 * pace);
    robot.limits[WH_AXIS_Z] = random_limits(400 * pace);
    robot.limits[WH_AXIS_THETA] = random_limits(4 * pace);
    robot.limits[WH_AXIS_YAW] = random_limits(6 * pace);
    return robot;
}

/* The factor by the header's definition, for the path before it was slowed. */
static double expected(const wh_line_t *line, const wh_robot_t *robot, const passage_t *p, double share) {
    const double k = (double)line->slowed;
    const double v = share * (double)wh_profile_peak_speed(&line->path) * k;
    const double a = share * (double)wh_profile_peak_acceleration(&line->path) * k * k;
    const double j = share * (double)wh_profile_peak_jerk(&line->path) * k * k * k;
    most_t R;
    most_t theta;
    look_along(p, &R, &theta);
    const double arm = fmax(slowing(&R, v, a, j, &robot->limits[WH_AXIS_R]),
                            slowing(&theta, v, a, j, &robot->limits[WH_AXIS_THETA]));
    return fmax(1, fmax(arm, slowing(&theta, v, a, j, &robot->limits[WH_AXIS_YAW])));
}

static void a_line_is_slowed_by_what_occurs_on_it(void **state) {
    (void)state;
    int slowed = 0;
    int past = 0;
    for (int i = 0; i < SLOWED_LINES; ++i) {
        const wh_robot_t robot = random_robot();
        const double R = i % 3 == 0 ? wh_test_decades(0.5, 30) : wh_test_uniform(30, 800);
        const double way = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
        const double length = i % 2 == 0 ? wh_test_decades(0.1, 100) : wh_test_uniform(1, 800);
        const double dz = i % 5 == 0 ? wh_test_uniform(-200, 200) : 0;
        const wh_real_t from[WH_ROBOT_AXES] = {0, WH_REAL(R), 900, 0};
        const passage_t p = {fabs(R * sin(way)), R * cos(way), R * cos(way) + length};
        wh_line_t line;
        if (p.d < 0.05 * R || wh_line_plan(&line, &robot, from, WH_REAL(length * cos(way)),
                                           WH_REAL(length * sin(way)), WH_REAL(dz), 0) != WH_OK) {
            continue;
        }
        const double share = length / sqrt(length * length + dz * dz);
        const double want = expected(&line, &robot, &p, share);
        assert_near((double)line.slowed / want, 1, SLOWED_TOLERANCE);
        slowed += want > 1;
        past += want > 1 && p.begin < 0 && p.end > 0;
    }
    assert_true(slowed > SLOWED_LINES / 5 && past > SLOWED_LINES / 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_axis_exceeds_its_limits),
        cmocka_unit_test(odd_robots_keep_their_limits),
        cmocka_unit_test(the_effector_keeps_to_the_line),
        cmocka_unit_test(ends_are_exact),
        cmocka_unit_test(travel_is_checked_everywhere),
        cmocka_unit_test(simple_lines_are_not_slowed),
        cmocka_unit_test(the_cap_limits_the_speed),
        cmocka_unit_test(the_cap_limits_the_acceleration),
        cmocka_unit_test(no_length_takes_no_time),
        cmocka_unit_test(a_line_near_the_axis_is_refused),
        cmocka_unit_test(other_axes_travel_is_checked),
        cmocka_unit_test(bad_arguments_change_nothing),
        cmocka_unit_test(limits_too_extreme_are_refused),
        cmocka_unit_test(a_line_is_slowed_by_what_occurs_on_it),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
