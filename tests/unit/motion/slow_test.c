/* Slow motions: a pace stretches time, shares come on top, the path stays, and nonsense is refused. */
#include "support/pose.h"

#include "grasp/grasp.h"
#include "motion/slow.h"

static wh_machine_t machine;
static wh_track_t track;
static wh_slow_t room;

static int set_up(void **state) {
    (void)state;
    memset(&machine, 0, sizeof machine);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.axis_count = 5;
    machine.gripper_count = 2;
    machine.mounts[0].axis = WH_NONE;
    machine.mounts[1].axis = 4;
    machine.mounts[1].base_from_station = wh_pose_identity();
    assert_int_equal(wh_track_init(&track, &machine, 1000), WH_OK);
    return 0;
}

static wh_segment_t to(size_t axis, double target) {
    wh_segment_t segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_AXES;
    segment.target[axis] = (wh_real_t)target;
    return segment;
}

static double duration(const wh_segment_t *segment, double speed, double acceleration, double pace) {
    const wh_slowness_t slowness = {{(wh_real_t)speed, (wh_real_t)acceleration}, (wh_real_t)pace};
    wh_track_t begun = track;
    assert_int_equal(wh_track_begin_slowly(&begun, segment, &slowness, &room), WH_OK);
    assert_true(begun.machine == &machine);
    return (double)wh_move_duration(&begun.plan.move);
}

/* Speed by the pace, acceleration by its square, jerk by its cube: the same motion in a longer time. */
static void a_pace_stretches_time(void **state) {
    (void)state;
    static const double paces[] = {1, 0.9, 0.5, 0.25, 0.01};
    static const struct {
        size_t axis;
        double target;
    } ways[] = {{0, 2}, {1, 700}, {2, 903}, {3, 1e-3}, {4, 3}};
    for (size_t way = 0; way < sizeof ways / sizeof ways[0]; ++way) {
        const wh_segment_t segment = to(ways[way].axis, ways[way].target);
        const double full = duration(&segment, 1, 1, 1);
        for (size_t i = 0; i < sizeof paces / sizeof paces[0]; ++i) {
            const double slowed = duration(&segment, 1, 1, paces[i]) * paces[i];
            assert_true(fabs(slowed - full) <= 100 * WH_TEST_ROUNDING * full);
        }
    }
}

/* A long way with a small share of the speed takes its distance over that speed, and a little. */
static void a_share_limits_the_speed(void **state) {
    (void)state;
    const wh_segment_t segment = to(1, 900);
    const double slowed = duration(&segment, 0.01, 1, 1);
    const double at_speed = 600 / (0.01 * (double)machine.robot.limits[1].speed);
    assert_true(slowed > at_speed && slowed < at_speed * 1.01);
    assert_true(duration(&segment, 1, 0.1, 1) > duration(&segment, 1, 1, 1));
}

static void what_is_no_part_is_refused(void **state) {
    (void)state;
    const double bad[] = {0, -0.5, 1.0001, (double)NAN, (double)INFINITY};
    const wh_segment_t segment = to(1, 700);
    const wh_track_t before = track;
    wh_slowness_t slowness = {{1, 1}, 1};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        for (int member = 0; member < 3; ++member) {
            slowness = (wh_slowness_t){{1, 1}, 1};
            *(member == 0   ? &slowness.share.speed
              : member == 1 ? &slowness.share.acceleration
                            : &slowness.pace) = (wh_real_t)bad[i];
            assert_int_equal(wh_track_begin_slowly(&track, &segment, &slowness, &room),
                             WH_STATUS_OUT_OF_RANGE);
        }
    }
    slowness = (wh_slowness_t){{1, 1}, WH_REAL(0.5)};
    assert_int_equal(wh_track_begin_slowly(NULL, &segment, &slowness, &room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_track_begin_slowly(&track, NULL, &slowness, &room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_track_begin_slowly(&track, &segment, NULL, &room), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_track_begin_slowly(&track, &segment, &slowness, NULL), WH_STATUS_NULL_ARGUMENT);
    const wh_segment_t beyond = to(1, 2000);
    assert_int_equal(wh_track_begin_slowly(&track, &beyond, &slowness, &room), WH_STATUS_OUT_OF_REACH);
    assert_memory_equal(&track, &before, sizeof track);
    wh_track_t never;
    memset(&never, 0, sizeof never);
    assert_int_equal(wh_track_begin_slowly(&never, &segment, &slowness, &room), WH_STATUS_NOT_INITIALISED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_pace_stretches_time, set_up),
        cmocka_unit_test_setup(a_share_limits_the_speed, set_up),
        cmocka_unit_test_setup(what_is_no_part_is_refused, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
