/* Random stations, axes and robots, measured with noise. Estimates lie within their standard
 * deviations of the truth and within the goals. If measurements do not determine a value, no wrong
 * number comes out. */
#include "support/support.h"

#include "estimate/frame.h"
#include "estimate/geometry.h"
#include "estimate/limits.h"
#include "motion/profile.h"
#include "support/pose.h"

#define FRAMES 2000
#define AXES 30
#define MOVES 200
#define ROBOTS 120

/* The number of standard deviations beyond which an estimate is wrong; estimates from few points
 * have wider tails. */
#define WRONG 6

static double noise(double sd) {
    const double u = wh_test_uniform(1e-12, 1);
    return sd * sqrt(-2 * log(u)) * cos(wh_test_uniform(0, 6.283185307179586));
}

static wh_vec3_t near_to(wh_vec3_t point, double sd) {
    return wh_vec3(point.x + noise(sd), point.y + noise(sd), point.z + noise(sd));
}

/* ------------------------------------------------------------------------------------------------- frames */

/* The bound that is as rare as WRONG deviations of a normal error, if so few numbers give the
 * deviation itself (D. L. Wallace, 1959). */
static double wrong_of(double freedom) {
    const double z = WRONG * (8 * freedom + 3) / (8 * freedom + 1);
    return sqrt(freedom * (exp(z * z / freedom) - 1));
}

/* The deviations of the estimate from the truth in its standard deviations, squared and summed over
 * the six. */
static double judge_frame(const wh_frame_estimate_t *frame, const wh_pose_t *truth) {
    const wh_vec3_t off = wh_vec3_subtract(&frame->base_from_station.r, &truth->r);
    const double rpy[3] = {atan2(truth->R.m[2][1], truth->R.m[2][2]), asin(-truth->R.m[2][0]),
                           atan2(truth->R.m[1][0], truth->R.m[0][0])};
    const double by[6] = {off.x,
                          off.y,
                          off.z,
                          frame->rpy[0] - rpy[0],
                          frame->rpy[1] - rpy[1],
                          remainder(frame->rpy[2] - rpy[2], 6.283185307179586)};
    double sum = 0;
    for (int i = 0; i < 6; ++i) {
        const double part = by[i] / (i < 3 ? frame->at_sd[i] : frame->rpy_sd[i - 3]);
        assert_true(fabs(part) < wrong_of(3 * (double)frame->used - 6));
        sum += part * part;
    }
    return sum;
}

static wh_pose_t random_station(void) {
    const double tilt = wh_test_uniform(0, 6.283);
    const wh_mat3_t yaw = wh_test_rotation(0, 0, 1, wh_test_uniform(-3.14, 3.14));
    const wh_mat3_t tilted = wh_test_rotation(cos(tilt), sin(tilt), 0, wh_test_uniform(0, 0.5));
    const wh_mat3_t both = wh_mat3_multiply(&yaw, &tilted);
    return wh_test_pose(both, wh_test_uniform(-900, 900), wh_test_uniform(-900, 900),
                        wh_test_uniform(0, 1300));
}

static void frames_lie_within_their_deviations(void **state) {
    (void)state;
    double sum = 0;
    wh_rounds_t rounds = WH_ROUNDS(100, FRAMES, 0.1);
    while (wh_round(&rounds)) {
        wh_frame_point_t points[30];
        const size_t count = 12 + wh_test_below(19);
        const double sd = wh_test_decades(1e-3, 0.1);
        const wh_pose_t station = random_station();
        for (size_t i = 0; i < count; ++i) {
            points[i].known =
                wh_vec3(wh_test_uniform(-150, 150), wh_test_uniform(-150, 150), wh_test_uniform(0, 240));
            points[i].touched = near_to(wh_pose_point(&station, &points[i].known), sd);
        }
        wh_frame_estimate_t frame;
        assert_int_equal(wh_frame_estimate(points, count, &frame), WH_OK);
        sum += judge_frame(&frame, &station) / 6;
    }
    /* The mean square of a deviation is 1, and a little more for few points. */
    assert_near(sum / rounds.made, 1.06, 0.1 + 2.6 / sqrt(rounds.made));
}

/* Up to a quarter of the points are wrong, by 100 deviations and more. These are set aside, hardly
 * any other point is, and the frame lies within its deviations. */
static void wrong_points_are_set_aside(void **state) {
    (void)state;
    size_t good = 0;
    size_t good_aside = 0;
    wh_rounds_t rounds = WH_ROUNDS(20, FRAMES, 0.1);
    while (wh_round(&rounds)) {
        wh_frame_point_t points[30];
        const size_t count = 8 + wh_test_below(23);
        const size_t wrong = 1 + wh_test_below((uint32_t)count / 4);
        const double sd = wh_test_decades(1e-3, 0.1);
        const wh_pose_t station = random_station();
        for (size_t i = 0; i < count; ++i) {
            points[i].known =
                wh_vec3(wh_test_uniform(-150, 150), wh_test_uniform(-150, 150), wh_test_uniform(0, 240));
            points[i].touched = near_to(wh_pose_point(&station, &points[i].known), sd);
            points[i].touched.x += i < wrong ? (i % 2 == 0 ? 1 : -1) * wh_test_uniform(100, 500) * sd : 0;
        }
        wh_frame_estimate_t frame;
        assert_int_equal(wh_frame_estimate(points, count, &frame), WH_OK);
        (void)judge_frame(&frame, &station);
        assert_int_equal(frame.used + frame.set_aside, count);
        for (size_t i = 0; i < count; ++i) {
            assert_true(i >= wrong || points[i].is_set_aside);
            good += i >= wrong ? 1 : 0;
            good_aside += i >= wrong && points[i].is_set_aside ? 1 : 0;
        }
    }
    assert_true((double)good_aside < 2 + 1e-3 * (double)good);
}

static void points_on_a_line_are_never_a_frame(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(20, FRAMES, 0.1);
    while (wh_round(&rounds)) {
        wh_frame_point_t points[30];
        const size_t count = 3 + wh_test_below(28);
        const wh_pose_t station = random_station();
        const wh_vec3_t way = wh_vec3(wh_test_uniform(-1, 1), wh_test_uniform(-1, 1), wh_test_uniform(-1, 1));
        const double sd = wh_test_decades(1e-3, 0.1);
        for (size_t i = 0; i < count; ++i) {
            const double along = wh_test_uniform(-200, 200);
            const wh_vec3_t known = wh_vec3(along * way.x, along * way.y, along * way.z);
            points[i].touched = near_to(wh_pose_point(&station, &known), sd);
            points[i].known = known;
        }
        wh_frame_estimate_t frame;
        assert_int_equal(wh_frame_estimate(points, count, &frame), WH_STATUS_NOT_DETERMINED);
        assert_true(frame.reason[0] != '\0');
    }
}

/* ------------------------------------------------------------------------------------------------- limits */

static wh_timed_move_t moves[MOVES];

static double seconds_of(const wh_limits_t *limits, double distance) {
    wh_profile_t profile;
    assert_int_equal(wh_profile_plan(&profile, distance, limits), WH_OK);
    return profile.duration;
}

/* Over 1 to 100 % of the travel; the first few have a pause. */
static void make_moves(const wh_limits_t *limits, double travel, double sd, int paused) {
    for (int i = 0; i < MOVES; ++i) {
        const double distance = travel * wh_test_uniform(0.01, 1);
        const double pause = i < paused ? wh_test_uniform(0.05, 2) : 0;
        moves[i] = (wh_timed_move_t){distance, seconds_of(limits, distance) + noise(sd) + pause, false};
    }
}

static void the_goal_is_met_for_an_axis_of_the_usual_kind(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, AXES, 0.1);
    while (wh_round(&rounds)) {
        const wh_limits_t limits = {wh_test_uniform(0.9, 1.1) * 1000, wh_test_uniform(0.9, 1.1) * 5000,
                                    wh_test_uniform(0.9, 1.1) * 50000};
        const double truth[3] = {limits.speed, limits.acceleration, limits.jerk};
        wh_limits_estimate_t found;
        make_moves(&limits, 600, 1e-3, (int)wh_test_below(20));
        assert_int_equal(wh_limits_estimate(moves, MOVES, false, &found), WH_OK);
        for (int k = 0; k < 3; ++k) {
            assert_true(found.values[k].is_determined);
            assert_near(found.values[k].value / truth[k], 1, 0.015);
            assert_near((found.values[k].value - truth[k]) / found.values[k].sd, 0, WRONG);
        }
        for (double distance = 10; distance < 590; distance += 10) {
            assert_near(wh_limits_seconds(&found, distance) / seconds_of(&limits, distance), 1, 0.01);
        }
    }
}

static void limits_are_right_or_not_determined(void **state) {
    (void)state;
    int untold = 0;
    wh_rounds_t rounds = WH_ROUNDS(6, AXES, 0.15);
    while (wh_round(&rounds)) {
        wh_limits_t limits = {.speed = wh_test_decades(50, 2000)};
        limits.acceleration = limits.speed * wh_test_decades(2, 20);
        limits.jerk = limits.acceleration * wh_test_decades(3, 40);
        const double truth[3] = {limits.speed, limits.acceleration, limits.jerk};
        wh_limits_estimate_t found;
        make_moves(&limits, limits.speed * wh_test_decades(0.03, 3), 1e-3, (int)wh_test_below(10));
        if (wh_limits_estimate(moves, MOVES, false, &found) != WH_OK) {
            assert_int_equal(found.status, WH_STATUS_NOT_DETERMINED);
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            if (found.values[k].is_determined) {
                assert_near((found.values[k].value - truth[k]) / found.values[k].sd, 0, WRONG);
            } else {
                assert_true(found.at_least[k] <= truth[k] && found.reason[0] != '\0');
                ++untold;
            }
        }
    }
    assert_true(untold > 0);
}

static void times_of_another_law_are_refused(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, AXES / 3, 0.1);
    while (wh_round(&rounds)) {
        const wh_limits_t limits = {1000, 5000, 50000};
        wh_limits_estimate_t found;
        make_moves(&limits, 600, 1e-3, 0);
        const double delay = wh_test_uniform(0.02, 0.3);
        for (int i = 0; i < MOVES; ++i) {
            moves[i].seconds += delay;
        }
        assert_int_equal(wh_limits_estimate(moves, MOVES, false, &found), WH_STATUS_NO_FIT);
        assert_int_equal(wh_limits_estimate(moves, MOVES, true, &found), WH_OK);
        assert_near((found.values[WH_LIMIT_DELAY].value - delay) / found.values[WH_LIMIT_DELAY].sd, 0, WRONG);
        for (int i = 0; i < MOVES; ++i) { /* times that do not depend on the distances */
            moves[i].seconds = wh_test_uniform(0.1, 2);
        }
        assert_int_not_equal(wh_limits_estimate(moves, MOVES, false, &found), WH_OK);
    }
}

/* ------------------------------------------------------------------------------------------------- robots */

#define DEG 0.017453292519943295
#define NUMBERS WH_GEOMETRY_PARAMETERS

static wh_touch_t touches[120];

static void turn(double *a, double *b, double angle) {
    const double old = *a;
    *a = old * cos(angle) - *b * sin(angle);
    *b = old * sin(angle) + *b * cos(angle);
}

/* The place of the point that touches: the test's own forward kinematics, from the tool outwards to
 * the floor. */
static wh_vec3_t reached(const double *p, const double *q) {
    double x = p[WH_GEOMETRY_TOOL_X];
    double y = p[WH_GEOMETRY_TOOL_Y];
    double z = p[WH_GEOMETRY_SCALE + 2] * q[2] + p[WH_GEOMETRY_ZERO + 2];
    turn(&x, &y, p[WH_GEOMETRY_SCALE + 3] * q[3]);
    x += p[WH_GEOMETRY_SCALE + 1] * q[1] + p[WH_GEOMETRY_ZERO + 1];
    turn(&x, &y, p[WH_GEOMETRY_SCALE] * q[0] + p[WH_GEOMETRY_ZERO]);
    turn(&z, &x, p[WH_GEOMETRY_TILT_Y]);
    turn(&y, &z, p[WH_GEOMETRY_TILT_X]);
    return wh_vec3(x + p[WH_GEOMETRY_X], y + p[WH_GEOMETRY_Y], z);
}

/* The direction in which the tool's x points. */
static double headed(const double *p, const double *q) {
    double x = 1;
    double y = 0;
    double z = 0;
    turn(&x, &y,
         p[WH_GEOMETRY_SCALE] * q[0] + p[WH_GEOMETRY_ZERO] + p[WH_GEOMETRY_SCALE + 3] * q[3] +
             p[WH_GEOMETRY_ZERO + 3]);
    turn(&z, &x, p[WH_GEOMETRY_TILT_Y]);
    turn(&y, &z, p[WH_GEOMETRY_TILT_X]);
    return atan2(y, x);
}

static void random_robot(double *p) {
    static const double most[NUMBERS] = {2000, 2000, 0.02, 0.02, 3.1, 5, 1000, 3.1, 200, 200};
    for (int k = 0; k < NUMBERS; ++k) {
        p[k] = k < WH_GEOMETRY_SCALE ? wh_test_uniform(-most[k], most[k]) : 1;
    }
}

/* The axes whose bits are set vary; theta is bit 0 and r is bit 1. */
static void touch_points(const double *p, size_t count, double sd, unsigned varied) {
    static const double least[4] = {-150 * DEG, 350, 700, -100 * DEG};
    static const double most[4] = {150 * DEG, 850, 1200, 100 * DEG};
    double at[4];
    for (int k = 0; k < 4; ++k) {
        at[k] = wh_test_uniform(least[k], most[k]);
    }
    for (size_t i = 0; i < count; ++i) {
        wh_touch_t *touch = &touches[i];
        for (int k = 0; k < 4; ++k) {
            touch->axes[k] = (varied >> k & 1U) != 0 ? wh_test_uniform(least[k], most[k]) : at[k];
        }
        touch->touched = near_to(reached(p, touch->axes), sd);
        touch->heading = (double)NAN;
    }
}

static double off_by(const wh_geometry_estimate_t *found, const double *truth, int k) {
    const double off = found->values[k].value - truth[k];
    const bool turns = k == WH_GEOMETRY_ZERO || k == WH_GEOMETRY_ZERO + 3;
    return (turns ? remainder(off, 6.283185307179586) : off) / found->values[k].sd;
}

/* Makes the first lines wrong, and measures headings. */
static void spoil(const double *truth, size_t count, size_t wrong, double sd) {
    for (size_t i = 0; i < count; ++i) {
        if (i < wrong) {
            const int axis = (int)wh_test_below(4);
            touches[i].axes[axis] += axis == 1 || axis == 2 ? 2 + 200 * sd : 2 * DEG + sd;
        }
        touches[i].heading = headed(truth, touches[i].axes) + noise(0.02 * DEG);
    }
}

/* Returns how many of the good lines were set aside; all wrong lines that show are set aside. */
static size_t count_aside(const double *truth, size_t count, size_t wrong, double sd) {
    size_t aside = 0;
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t there = reached(truth, touches[i].axes);
        const wh_vec3_t off = wh_vec3_subtract(&there, &touches[i].touched);
        assert_true(touches[i].is_set_aside || sqrt(wh_vec3_dot(&off, &off)) < 12 * sd);
        aside += touches[i].is_set_aside && i >= wrong ? 1 : 0;
    }
    return aside;
}

static void robots_lie_within_their_deviations(void **state) {
    (void)state;
    int near = 0;
    int all = 0;
    double squares = 0;
    size_t wrongly_aside = 0;
    wh_rounds_t rounds = WH_ROUNDS(8, ROBOTS, 0.1);
    while (wh_round(&rounds)) {
        double truth[NUMBERS];
        wh_geometry_estimate_t found;
        const size_t count = 20 + wh_test_below(60);
        const size_t wrong = wh_test_below((uint32_t)count / 8);
        const double sd = wh_test_decades(1e-3, 0.1);
        random_robot(truth);
        touch_points(truth, count, sd, 15);
        spoil(truth, count, wrong, sd);
        assert_int_equal(wh_geometry_estimate(touches, count, false, &found), WH_OK);
        assert_string_equal(found.reason, "");
        wrongly_aside += count_aside(truth, count, wrong, sd);
        for (int k = 0; k < WH_GEOMETRY_SCALE; ++k) {
            const double off = off_by(&found, truth, k);
            assert_true(found.values[k].is_determined);
            assert_near(off, 0, WRONG);
            near += fabs(off) < 2 ? 1 : 0;
            squares += off * off;
            ++all;
        }
    }
    print_message("robots: %.4f within 2 deviations, %.4f\n", (double)near / all, squares / all);
    assert_near((double)near / all, 0.95, 0.02 + 0.9 / sqrt(all));
    assert_near(squares / all, 1.05,
                0.02 + 3.3 * sqrt(2.0 / all)); /* the mean of as many squares of deviates */
    assert_true(wrongly_aside <= 2);
}

/* The derivatives, by differences, of a residual's sum of squares and of the values from which the
 * points are found. */
static void differ(const double *p, const double *q, double by[3][NUMBERS]) {
    for (int k = 0; k < NUMBERS; ++k) {
        const double step = k < 2 || (k >= WH_GEOMETRY_ZERO + 1 && k <= WH_GEOMETRY_TOOL_Y) ? 1e-3 : 1e-6;
        double moved[NUMBERS];
        memcpy(moved, p, sizeof moved);
        moved[k] = p[k] + step;
        const wh_vec3_t more = reached(moved, q);
        moved[k] = p[k] - step;
        const wh_vec3_t less = reached(moved, q);
        by[0][k] = (more.x - less.x) / (2 * step);
        by[1][k] = (more.y - less.y) / (2 * step);
        by[2][k] = (more.z - less.z) / (2 * step);
    }
}

/* Solves a x = b, where b is the k-th unit vector, for the numbers of the list; returns x's own
 * entry: a variance. */
static double inverse_entry(double a[NUMBERS][NUMBERS], const int *list, int count, int which) {
    double m[NUMBERS][NUMBERS + 1];
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < count; ++k) {
            m[i][k] = a[list[i]][list[k]];
        }
        m[i][count] = i == which ? 1 : 0;
    }
    for (int i = 0; i < count; ++i) { /* positive definite: no pivots */
        for (int row = 0; row < count; ++row) {
            const double part = m[row][i] / m[i][i];
            for (int k = i; row != i && k <= count; ++k) {
                m[row][k] -= part * m[i][k];
            }
        }
    }
    return m[which][count] / m[which][which];
}

/* The normal equations at a fit: products of derivatives, slopes of the squares, the squares. */
typedef struct {
    double products[NUMBERS][NUMBERS], slopes[NUMBERS], squares;
} normal_t;

static void add_normal(normal_t *normal, const wh_geometry_estimate_t *found, const wh_touch_t *touch) {
    double by[3][NUMBERS];
    const wh_vec3_t there = reached(found->fitted, touch->axes);
    const wh_vec3_t rest = wh_vec3_subtract(&touch->touched, &there);
    const wh_vec3_t off = wh_geometry_residual(found, touch);
    assert_near(off.x, rest.x, 1e-9);
    assert_near(off.y, rest.y, 1e-9);
    assert_near(off.z, rest.z, 1e-9);
    differ(found->fitted, touch->axes, by);
    for (int i = 0; i < NUMBERS && !touch->is_set_aside; ++i) {
        for (int k = 0; k < NUMBERS; ++k) {
            normal->products[i][k] += by[0][i] * by[0][k] + by[1][i] * by[1][k] + by[2][i] * by[2][k];
        }
        normal->slopes[i] += by[0][i] * rest.x + by[1][i] * rest.y + by[2][i] * rest.z;
    }
    normal->squares += touch->is_set_aside ? 0 : wh_vec3_dot(&rest, &rest);
}

static void judge_robot(const wh_geometry_estimate_t *found, normal_t *normal, const double *truth) {
    int list[NUMBERS];
    int count = 0;
    for (int k = 0; k < (found->has_scales ? NUMBERS : WH_GEOMETRY_SCALE); ++k) {
        list[count] = k;
        count += k == WH_GEOMETRY_ZERO + 3 ? 0 : 1;
    }
    const double variance = normal->squares / (3 * (double)found->used - count);
    for (int i = 0; i < count; ++i) {
        const int k = list[i];
        const double sd = sqrt(variance * inverse_entry(normal->products, list, count, i));
        assert_true(found->values[k].is_determined);
        assert_near(found->values[k].sd / sd, 1, 1e-4);
        assert_near(off_by(found, truth, k), 0, WRONG);
        assert_near(normal->slopes[k] / sqrt(normal->products[k][k] * normal->squares), 0, 1e-5);
    }
}

/* No other numbers fit better, and deviations are those of the normal equations. */
static void robots_are_the_best_fit_by_differences(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(2, ROBOTS / 3, 0.1);
    while (wh_round(&rounds)) {
        const bool scales = rounds.number % 2 == 1;
        const size_t count = 30 + wh_test_below(60);
        double truth[NUMBERS];
        normal_t normal = {.squares = 0};
        wh_geometry_estimate_t found;
        random_robot(truth);
        truth[WH_GEOMETRY_TOOL_X] = 150;
        for (int k = WH_GEOMETRY_SCALE; scales && k < NUMBERS; ++k) {
            truth[k] = wh_test_uniform(0.99, 1.01);
        }
        touch_points(truth, count, 0.02, 15);
        assert_int_equal(wh_geometry_estimate(touches, count, scales, &found), WH_OK);
        for (size_t i = 0; i < count; ++i) {
            add_normal(&normal, &found, &touches[i]);
        }
        judge_robot(&found, &normal, truth);
    }
}

/* Headings give the scale of yaw better than touches; with a short tool touches do not give it at
 * all: no contradiction. If touches give a scale that the headings contradict, that is a
 * contradiction. */
static void headings_and_scales_go_together(void **state) {
    (void)state;
    int near = 0;
    int all = 0;
    wh_rounds_t rounds = WH_ROUNDS(6, ROBOTS / 2, 0.1);
    while (wh_round(&rounds)) {
        const size_t count = 30 + wh_test_below(60);
        const double precision = wh_test_decades(1e-4, 1e-2) * DEG;
        double truth[NUMBERS];
        wh_geometry_estimate_t found;
        random_robot(truth);
        truth[WH_GEOMETRY_TOOL_X] = wh_test_uniform(20, 200);
        for (int k = WH_GEOMETRY_SCALE; k < NUMBERS; ++k) {
            truth[k] = wh_test_uniform(0.99, 1.01);
        }
        touch_points(truth, count, wh_test_decades(5e-3, 0.05), 15);
        for (size_t i = 0; i < count; ++i) {
            touches[i].heading = headed(truth, touches[i].axes) + noise(precision);
        }
        const wh_status_t status = wh_geometry_estimate(touches, count, true, &found);
        if (status != WH_OK) {
            fail_msg("%s", found.reason);
        }
        assert_near(off_by(&found, truth, WH_GEOMETRY_ZERO + 3), 0, WRONG);
        near += fabs(off_by(&found, truth, WH_GEOMETRY_ZERO + 3)) < 2 ? 1 : 0;
        ++all;
        for (size_t i = 0; i < count; ++i) {
            touches[i].heading -= 0.1 * touches[i].axes[WH_AXIS_YAW];
        }
        assert_int_equal(wh_geometry_estimate(touches, count, true, &found), WH_STATUS_NO_FIT);
    }
    assert_true(near > 0.9 * all - 1.2 * sqrt(all));
}

/* The values that a fit to touches with some axes varied must give, and those that it must not
 * give; the values that it gives are right. */
static void judge_varied(const wh_geometry_estimate_t *found, const double *truth, unsigned varied) {
    const bool reaches = (varied & 3) != 0;
    for (int k = 0; k < NUMBERS; ++k) {
        if (found->values[k].is_determined) {
            assert_near(off_by(found, truth, k), 0, WRONG);
        }
    }
    assert_false(found->values[WH_GEOMETRY_ZERO + 3].is_determined);
    assert_non_null(strstr(found->reason, "zero_yaw"));
    assert_int_equal(found->values[WH_GEOMETRY_ZERO + 1].is_determined, (varied & 9) == 9);
    assert_int_equal(found->values[WH_GEOMETRY_TOOL_X].is_determined, (varied & 8) != 0 && reaches);
    assert_true(reaches || !found->values[WH_GEOMETRY_X].is_determined);
}

/* The axes that a reason names, as bits. */
static unsigned named_by(const char *reason) {
    static const char *const says[4] = {"theta turned", "other r", "other z", "yaw turned"};
    unsigned named = 0;
    for (unsigned k = 0; k < 4; ++k) {
        named |= strstr(reason, says[k]) ? 1U << k : 0;
    }
    return named;
}

/* Touches with all sets of axes varied. Once the moves that are reported as missing are made, all
 * values are given. */
static void robots_are_right_or_not_determined(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(WH_TEST_SHARE > 1 ? 4 : 16, ROBOTS, 0.1);
    while (wh_round(&rounds)) {
        const unsigned varied = (unsigned)rounds.number * 5 % 16;
        const size_t count = 24 + wh_test_below(20);
        const double sd = wh_test_decades(1e-3, 0.05);
        double truth[NUMBERS];
        wh_geometry_estimate_t found;
        random_robot(truth);
        touch_points(truth, count, sd, varied);
        const wh_status_t status = wh_geometry_estimate(touches, count, false, &found);
        assert_true(status == WH_OK || status == WH_STATUS_NOT_DETERMINED);
        judge_varied(&found, truth, varied);
        touch_points(truth, count, sd, varied | named_by(found.reason));
        for (size_t i = 0; i < count; ++i) {
            touches[i].heading = headed(truth, touches[i].axes);
        }
        assert_int_equal(wh_geometry_estimate(touches, count, false, &found), WH_OK);
        for (int k = 0; k < WH_GEOMETRY_SCALE; ++k) {
            assert_true(found.values[k].is_determined);
        }
    }
}

static void robots_of_another_kind_are_refused(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, ROBOTS / 5, 0.1);
    while (wh_round(&rounds)) {
        double truth[NUMBERS];
        wh_geometry_estimate_t found;
        random_robot(truth);
        truth[WH_GEOMETRY_TOOL_X] = 120;
        touch_points(truth, 40, 0.02, 15);
        for (size_t i = 0; i < 40; i += 2) { /* moved in between */
            touches[i].touched.x += 3;
        }
        assert_int_equal(wh_geometry_estimate(touches, 40, false, &found), WH_STATUS_NO_FIT);
        touch_points(truth, 40, 0.02, 15);
        for (size_t i = 0; i < 40; ++i) { /* given in the other direction */
            touches[i].axes[0] = -touches[i].axes[0];
        }
        assert_int_equal(wh_geometry_estimate(touches, 40, false, &found), WH_STATUS_NO_FIT);
        const int axis = WH_GEOMETRY_SCALE + (int)wh_test_below(4);
        truth[axis] = 1.003;
        touch_points(truth, 40, 0.02, 15);
        assert_int_equal(wh_geometry_estimate(touches, 40, false, &found), WH_STATUS_NO_FIT);
        assert_int_equal(wh_geometry_estimate(touches, 40, true, &found), WH_OK);
        assert_true(found.values[axis].is_determined);
        assert_near(off_by(&found, truth, axis), 0, WRONG);
        truth[axis] = 1;
        touch_points(truth, 20, 0.02, 7);
        touches[7].axes[3] += 1; /* only this one is turned, and a millimetre off: nothing could show it */
        touches[7].touched = reached(truth, touches[7].axes);
        touches[7].touched.x += 1;
        assert_int_equal(wh_geometry_estimate(touches, 20, false, &found), WH_OK);
        assert_false(found.values[WH_GEOMETRY_TOOL_X].is_determined);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_lie_within_their_deviations),
        cmocka_unit_test(wrong_points_are_set_aside),
        cmocka_unit_test(points_on_a_line_are_never_a_frame),
        cmocka_unit_test(the_goal_is_met_for_an_axis_of_the_usual_kind),
        cmocka_unit_test(limits_are_right_or_not_determined),
        cmocka_unit_test(times_of_another_law_are_refused),
        cmocka_unit_test(robots_lie_within_their_deviations),
        cmocka_unit_test(robots_are_the_best_fit_by_differences),
        cmocka_unit_test(robots_are_right_or_not_determined),
        cmocka_unit_test(headings_and_scales_go_together),
        cmocka_unit_test(robots_of_another_kind_are_refused),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
