/* Oracle: by how much a line is slowed, from the axes' derivatives along it at very many of its points. The closed-form
 * maxima of motion/line.c are neither above nor below what occurs. */
#include "motion/line.h"
#include "support/pose.h"

#define LINES 3000
#define POINTS 400

#if defined(WH_FLOAT)
#define TOLERANCE 1e-3
#else
#define TOLERANCE 1e-4
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

/* Evenly over the line, and again within a few d of the closest point, where everything happens. */
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

/* What the header says the factor is, for the path as it was before it was slowed. */
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
    for (int i = 0; i < LINES; ++i) {
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
        assert_near((double)line.slowed / want, 1, TOLERANCE);
        slowed += want > 1;
        past += want > 1 && p.begin < 0 && p.end > 0;
    }
    assert_true(slowed > LINES / 5 && past > LINES / 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_is_slowed_by_what_occurs_on_it),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
