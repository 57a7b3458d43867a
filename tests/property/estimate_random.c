/* Random stations and axes, measured with noise: estimates lie within their standard deviations of the truth and within the goals,
 * and what measurements do not tell is never a wrong number. */
#include "support/support.h"

#include "estimate/frame.h"
#include "estimate/limits.h"
#include "motion/profile.h"
#include "support/pose.h"

#define FRAMES (2000 / WH_TEST_SHARE)
#define AXES (30 / WH_TEST_SHARE)
#define MOVES 200

/* Standard deviations beyond which an estimate is wrong; those of few points have wider tails. */
#define WRONG 6

static double noise(double sd) {
    const double u = wh_test_uniform(1e-12, 1);
    return sd * sqrt(-2 * log(u)) * cos(wh_test_uniform(0, 6.283185307179586));
}

static wh_vec3_t near_to(wh_vec3_t point, double sd) {
    return wh_vec3(point.x + noise(sd), point.y + noise(sd), point.z + noise(sd));
}

/* ------------------------------------------------------------------------------------------------- frames */

/* Deviations of the estimate from the truth in its standard deviations, squared and summed over the six. */
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
        assert_true(fabs(part) < WRONG);
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
    for (int round = 0; round < FRAMES; ++round) {
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
    assert_near(sum / FRAMES, 1.06, 0.12);
}

static void points_on_a_line_are_never_a_frame(void **state) {
    (void)state;
    for (int round = 0; round < FRAMES; ++round) {
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
    for (int round = 0; round < AXES; ++round) {
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
    for (int round = 0; round < AXES; ++round) {
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
    for (int round = 0; round < AXES / 3; ++round) {
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
        for (int i = 0; i < MOVES; ++i) { /* times that have nothing to do with distances */
            moves[i].seconds = wh_test_uniform(0.1, 2);
        }
        assert_int_not_equal(wh_limits_estimate(moves, MOVES, false, &found), WH_OK);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_lie_within_their_deviations),
        cmocka_unit_test(points_on_a_line_are_never_a_frame),
        cmocka_unit_test(the_goal_is_met_for_an_axis_of_the_usual_kind),
        cmocka_unit_test(limits_are_right_or_not_determined),
        cmocka_unit_test(times_of_another_law_are_refused),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
