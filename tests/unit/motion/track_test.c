/* Tracks: segments end exactly, take the right number of slices, wait, time out, and refuse without
 * a change. */
#include "support/support.h"

#include "grasp/grasp.h"
#include "math/trig.h"
#include "motion/track.h"

/* The smallest positive number. */
#if defined(WH_FLOAT)
#define TINIEST 1e-45
#else
#define TINIEST 5e-324
#endif

static wh_machine_t machine;

static wh_track_t begin_track(int64_t slice_us) {
    wh_track_t track;
    memset(&machine, 0, sizeof machine);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.axis_count = 5;
    machine.gripper_count = 2;
    machine.mounts[0].axis = WH_NONE;
    machine.mounts[1].axis = 4;
    machine.mounts[1].base_from_station = wh_pose_identity();
    assert_int_equal(wh_track_init(&track, &machine, slice_us), WH_OK);
    return track;
}

static wh_segment_t blank(const wh_track_t *track, wh_segment_kind_t kind) {
    wh_segment_t segment = wh_track_blank(track);
    segment.kind = kind;
    return segment;
}

/* Plays to the end; returns the number of slices. */
static int64_t play(wh_track_t *track, const wh_segment_t *segment) {
    const int64_t before = track->slice;
    assert_int_equal(wh_track_begin(track, segment), WH_OK);
    while (wh_track_next(track, 0) == WH_TRACK_MOVING) {
    }
    return track->slice - before;
}

static int64_t dwell(wh_track_t *track, double seconds) {
    wh_segment_t segment = blank(track, WH_SEGMENT_DWELL);
    segment.seconds = (wh_real_t)seconds;
    return play(track, &segment);
}

static void starts_at_home_with_closed_valves(void **state) {
    (void)state;
    const wh_track_t track = begin_track(1000);
    const wh_real_t home[] = {0, 300, 900, 0, 0, 0, 0, 0};
    assert_memory_equal(track.axes, home, sizeof home);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        assert_int_equal(track.valves[g], WH_VALVE_CLOSED);
    }
    assert_int_equal(track.slice, 0);
    assert_ptr_equal(track.machine, &machine);
}

static void init_refuses_and_leaves_the_track(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    const wh_track_t before = track;
    static const int64_t bad[] = {0, -1, 1000001, INT64_MAX, INT64_MIN};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_int_equal(wh_track_init(&track, &machine, bad[i]), WH_STATUS_OUT_OF_RANGE);
    }
    assert_int_equal(wh_track_init(NULL, &machine, 1000), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_track_init(&track, NULL, 1000), WH_STATUS_NULL_ARGUMENT);
    machine.axis_count = 3;
    assert_int_equal(wh_track_init(&track, &machine, 1000), WH_STATUS_OUT_OF_RANGE);
    assert_memory_equal(&track, &before, sizeof track);
}

/* Zeroed, or in memory that held anything else: nothing of it is read but its mark. */
static void a_track_that_was_never_initialised_is_refused(void **state) {
    (void)state;
    const int fills[] = {0, 0xA5};
    const wh_track_t good = begin_track(1000);
    const wh_segment_t segment = wh_track_blank(&good);
    for (size_t i = 0; i < 2; ++i) {
        wh_track_t track;
        wh_track_t before;
        memset(&track, fills[i], sizeof track);
        before = track;
        assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_NOT_INITIALISED);
        assert_int_equal(wh_track_next(&track, 1), WH_TRACK_DONE);
        wh_track_skip(&track);
        assert_memory_equal(&track, &before, sizeof track);
    }
}

static void a_blank_segment_changes_nothing(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        track.axes[axis] += WH_REAL(0.5);
    }
    wh_segment_t segment = wh_track_blank(&track);
    assert_int_equal(segment.kind, WH_SEGMENT_DWELL);
    assert_true(segment.travel.x == 0 && segment.travel.y == 0 && segment.travel.z == 0);
    assert_true(segment.speed == 0 && segment.seconds == 0);
    assert_int_equal(segment.gripper, WH_NONE);
    assert_memory_equal(segment.target, track.axes, sizeof track.axes);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        assert_int_equal(segment.valves[g], WH_NONE);
    }
    track = begin_track(1000);
    segment = wh_track_blank(&track);
    assert_int_equal(play(&track, &segment), 0);
    assert_int_equal(track.valves[0], WH_VALVE_CLOSED);
    assert_true(track.axes[WH_AXIS_R] == 300);
}

/* 2.007 * 1e6 is 2007000.0000000002 in double: rounding must not cost a slice. */
static void a_whole_number_of_slices_is_just_that_many(void **state) {
    (void)state;
    static const int64_t slices_us[] = {1, 250, 1000, 10000};
    for (size_t i = 0; i < sizeof slices_us / sizeof slices_us[0]; ++i) {
        wh_track_t track = begin_track(slices_us[i]);
        for (int n = 0; n < 4000; n += 1 + (int)wh_test_below(5)) {
            assert_int_equal(dwell(&track, (double)(n * slices_us[i]) / 1e6), n);
        }
    }
    wh_track_t track = begin_track(1000);
    assert_int_equal(dwell(&track, 2.007), 2007);
}

static void a_dwell_is_rounded_up(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    assert_int_equal(dwell(&track, 0), 0);
    assert_int_equal(dwell(&track, 1e-9), 1);
    assert_int_equal(dwell(&track, 0.001), 1);
    assert_int_equal(dwell(&track, 0.0010001), 2);
    assert_int_equal(dwell(&track, 0.0119), 12);
    assert_int_equal(track.slice, 16);
}

/* Whatever the slice, the last one has exactly the target's bits, and is the first at or after the
 * duration. */
static void moves_end_on_the_targets_bits(void **state) {
    (void)state;
    for (int i = 0; i < 400; ++i) {
        wh_track_t track = begin_track(1 + (int64_t)wh_test_below(20000));
        wh_segment_t segment = blank(&track, WH_SEGMENT_AXES);
        segment.target[WH_AXIS_THETA] = (wh_real_t)wh_test_uniform(-4, 4);
        segment.target[WH_AXIS_R] = (wh_real_t)wh_test_uniform(300, 900);
        segment.target[WH_AXIS_Z] = (wh_real_t)wh_test_uniform(600, 1300);
        segment.target[4] = (wh_real_t)wh_test_uniform(-30, 30);
        assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
        const double duration = wh_move_duration(&track.plan.move);
        wh_track_skip(&track);
        assert_memory_equal(track.axes, segment.target, machine.axis_count * sizeof track.axes[0]);
        const double count = (double)track.segment_slices;
        const double exact = duration * 1e6 / (double)track.slice_us;
        assert_true(count >= exact * (1 - 1e-6) && count < exact * (1 + 1e-6) + 1);
    }
}

/* Slice by slice at the move's position for that time, and in the last slice at its end. */
static void each_slice_of_a_move_is_on_its_plan(void **state) {
    (void)state;
    wh_track_t track = begin_track(7000);
    wh_limits_t limits[WH_AXES];
    for (size_t axis = 0; axis < machine.axis_count; ++axis) {
        limits[axis] = *wh_machine_limits(&machine, axis);
    }
    wh_segment_t segment = blank(&track, WH_SEGMENT_AXES);
    segment.target[WH_AXIS_THETA] = 1;
    segment.target[WH_AXIS_R] = 612;
    segment.target[4] = -2;
    wh_move_t move;
    assert_int_equal(wh_move_plan(&move, machine.axis_count, track.axes, segment.target, limits), WH_OK);
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    for (int slice = 1; wh_track_next(&track, 0) == WH_TRACK_MOVING; ++slice) {
        wh_real_t want[WH_AXES];
        wh_move_at(&move, (wh_real_t)(slice * 7000) / WH_REAL(1e6), want);
        assert_memory_equal(track.axes, want, machine.axis_count * sizeof want[0]);
    }
    assert_int_equal(track.slice, ceil((double)wh_move_duration(&move) / 0.007));
}

static void each_slice_of_a_line_is_on_its_plan(void **state) {
    (void)state;
    wh_track_t track = begin_track(7000);
    wh_segment_t segment = blank(&track, WH_SEGMENT_LINE);
    segment.travel = wh_vec3(100, 200, 50);
    segment.speed = 300;
    wh_line_t line;
    assert_int_equal(wh_line_plan(&line, &machine.robot, track.axes, 100, 200, 50, 300), WH_OK);
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    for (int slice = 1; wh_track_next(&track, 0) == WH_TRACK_MOVING; ++slice) {
        wh_real_t want[WH_ROBOT_AXES];
        wh_line_at(&line, (wh_real_t)(slice * 7000) / WH_REAL(1e6), want);
        assert_memory_equal(track.axes, want, sizeof want);
    }
    assert_int_equal(track.slice, ceil((double)wh_line_duration(&line) / 0.007));
}

static void a_line_ends_on_its_end(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = blank(&track, WH_SEGMENT_LINE);
    segment.travel = wh_vec3(200, 0, -50);
    const int64_t slices = play(&track, &segment);
    assert_true(slices > 200 && slices < 2000);
    assert_near(track.axes[WH_AXIS_R], 500, 1e-4);
    assert_near(track.axes[WH_AXIS_Z], 850, 1e-4);
    wh_segment_t slow = blank(&track, WH_SEGMENT_LINE);
    slow.travel = wh_vec3(0, 0, 20);
    slow.speed = 10;
    assert_true(play(&track, &slow) > 2000);
    assert_near(track.axes[WH_AXIS_Z], 870, 1e-4);
}

static void skipping_equals_playing(void **state) {
    (void)state;
    wh_track_t played = begin_track(1000);
    wh_track_t skipped = played;
    wh_segment_t segment = blank(&played, WH_SEGMENT_LINE);
    segment.travel = wh_vec3(100, 250, 0);
    (void)play(&played, &segment);
    assert_int_equal(wh_track_begin(&skipped, &segment), WH_OK);
    wh_track_skip(&skipped);
    assert_memory_equal(played.axes, skipped.axes, sizeof played.axes);
    assert_int_equal(skipped.slice, 0);
    const wh_track_t before = skipped;
    wh_track_skip(&skipped); /* it is over already */
    assert_memory_equal(&skipped, &before, sizeof skipped);
    assert_int_equal(wh_track_next(&skipped, 0), WH_TRACK_DONE);
}

static void valves_take_one_slice(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = blank(&track, WH_SEGMENT_VALVES);
    segment.valves[1] = WH_VALVE_OPEN;
    assert_int_equal(play(&track, &segment), 1);
    assert_int_equal(track.valves[0], WH_VALVE_CLOSED);
    assert_int_equal(track.valves[1], WH_VALVE_OPEN);
    segment.valves[1] = WH_NONE;
    segment.valves[0] = WH_VALVE_OPEN;
    assert_int_equal(play(&track, &segment), 1);
    assert_int_equal(track.valves[0], WH_VALVE_OPEN);
    assert_int_equal(track.valves[1], WH_VALVE_OPEN);
    segment.valves[1] = WH_VALVE_CLOSED;
    segment.valves[0] = WH_NONE;
    assert_int_equal(play(&track, &segment), 1);
    assert_int_equal(track.valves[0], WH_VALVE_OPEN);
    assert_int_equal(track.valves[1], WH_VALVE_CLOSED);
}

static void a_sensor_ends_the_wait(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = blank(&track, WH_SEGMENT_SENSOR);
    segment.gripper = 1;
    segment.seconds = WH_REAL(0.25);
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    for (int i = 0; i < 7; ++i) {
        assert_int_equal(wh_track_next(&track, 1U), WH_TRACK_MOVING); /* the other gripper's */
    }
    assert_int_equal(wh_track_next(&track, 2U), WH_TRACK_DONE);
    assert_int_equal(track.slice, 7);
}

static void a_sensor_that_is_on_takes_no_slice(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = blank(&track, WH_SEGMENT_SENSOR);
    segment.gripper = 0;
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    assert_int_equal(wh_track_next(&track, 1U), WH_TRACK_DONE);
    assert_int_equal(track.slice, 0);
}

static void a_wait_times_out_after_its_slices(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = blank(&track, WH_SEGMENT_SENSOR);
    segment.gripper = 0;
    segment.seconds = WH_REAL(0.0041);
    assert_int_equal(play(&track, &segment), 5);
    assert_int_equal(wh_track_next(&track, 0), WH_TRACK_TIMED_OUT);
    /* At the last moment is in time. */
    assert_int_equal(wh_track_next(&track, 1U), WH_TRACK_DONE);
    assert_int_equal(track.slice, 5);
}

typedef struct {
    wh_segment_kind_t kind;
    void (*spoil)(wh_segment_t *segment);
    wh_status_t status;
} refusal_t;

static void far_target(wh_segment_t *s) {
    s->target[WH_AXIS_R] = 1000;
}
static void high_target(wh_segment_t *s) {
    s->target[WH_AXIS_Z] = 2000;
}
static void far_chuck(wh_segment_t *s) {
    s->target[4] = 2 * WH_CHUCK_TRAVEL;
}
static void nan_target(wh_segment_t *s) {
    s->target[4] = (wh_real_t)NAN;
}
static void far_line(wh_segment_t *s) {
    s->travel = wh_vec3(601, 0, 0);
}
static void nan_line(wh_segment_t *s) {
    s->travel = wh_vec3(0, 0, (wh_real_t)NAN);
}
static void endless_line(wh_segment_t *s) {
    s->travel = wh_vec3(0, 0, 100), s->speed = WH_REAL(1e-30);
}
static void backward_line(wh_segment_t *s) {
    s->travel = wh_vec3(0, 0, 1), s->speed = -1;
}
static void half_valve(wh_segment_t *s) {
    s->valves[0] = 2;
}
static void absent_valve(wh_segment_t *s) {
    s->valves[2] = WH_VALVE_OPEN;
}
static void negative_time(wh_segment_t *s) {
    s->seconds = -1;
}
static void endless_time(wh_segment_t *s) {
    s->seconds = WH_REAL(1.1e6);
}
static void nan_time(wh_segment_t *s) {
    s->seconds = (wh_real_t)NAN;
}
static void absent_gripper(wh_segment_t *s) {
    s->gripper = 2;
}
static void no_gripper(wh_segment_t *s) {
    s->gripper = WH_NONE;
}
static void no_kind(wh_segment_t *s) {
    s->kind = (wh_segment_kind_t)99;
}

/* Effects of the machine's limits on a segment: it is longer than a segment may be, or cannot be planned. */
static void slow_axes_are_refused(void **state) {
    (void)state;
    static const struct {
        double speed;
        wh_status_t status;
    } rows[] = {{5e-5, WH_OK}, {9e-6, WH_STATUS_BAD_SEGMENT}, {TINIEST, WH_STATUS_BAD_LIMITS}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        wh_track_t track = begin_track(1000);
        machine.chuck_limits.speed = (wh_real_t)rows[i].speed;
        wh_segment_t segment = blank(&track, WH_SEGMENT_AXES);
        segment.target[4] = 10;
        wh_track_t before;
        memcpy(&before, &track, sizeof before);
        assert_int_equal(wh_track_begin(&track, &segment), rows[i].status);
        assert_true(rows[i].status == WH_OK || memcmp(&track, &before, sizeof track) == 0);
    }
}

/* The time that the last axis takes for this way, at 2^-17 rad/s. */
static double slow_seconds(const wh_track_t *track, wh_real_t target) {
    wh_limits_t limits[WH_AXES];
    wh_real_t to[WH_AXES];
    wh_move_t move;
    memcpy(to, track->axes, sizeof to);
    to[machine.axis_count - 1] = target;
    for (size_t axis = 0; axis < machine.axis_count; ++axis) {
        limits[axis] = *wh_machine_limits(&machine, axis);
    }
    assert_int_equal(wh_move_plan(&move, machine.axis_count, track->axes, to, limits), WH_OK);
    return (double)wh_move_duration(&move);
}

/* To the last bit: the way is halved until it takes just 1e6 s. */
static void a_segment_of_just_the_longest_duration(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    machine.chuck_limits.speed = WH_REAL(0x1p-17);
    wh_segment_t segment = blank(&track, WH_SEGMENT_AXES);
    wh_real_t near = 7;
    wh_real_t far = 8;
    wh_real_t *target = &segment.target[machine.axis_count - 1];
    for (int i = 0; i < 60 && slow_seconds(&track, near) != 1e6; ++i) {
        *target = near + (far - near) / 2;
        if (slow_seconds(&track, *target) > 1e6) {
            far = *target;
        } else {
            near = *target;
        }
    }
    assert_true(slow_seconds(&track, near) == 1e6);
    *target = near;
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    track = begin_track(1000);
    machine.chuck_limits.speed = WH_REAL(0x1p-17);
    while (slow_seconds(&track, *target) <= 1e6) {
        *target += WH_REAL(0x1p-21);
    }
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_BAD_SEGMENT);
}

/* The largest number of axes. */
static void a_move_of_every_axis(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    machine.axis_count = WH_AXES;
    assert_int_equal(wh_track_init(&track, &machine, 1000), WH_OK);
    wh_segment_t segment = blank(&track, WH_SEGMENT_AXES);
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        segment.target[axis] = track.axes[axis] + WH_REAL(0.25);
    }
    assert_true(play(&track, &segment) > 0);
    assert_memory_equal(track.axes, segment.target, sizeof track.axes);
}

/* In the middle of another segment: that one continues as if there had been no request. */
static void a_refused_segment_leaves_the_track(void **state) {
    (void)state;
    static const refusal_t refusals[] = {
        {WH_SEGMENT_AXES, far_target, WH_STATUS_OUT_OF_REACH},
        {WH_SEGMENT_AXES, high_target, WH_STATUS_LIMIT_EXCEEDED},
        {WH_SEGMENT_AXES, far_chuck, WH_STATUS_LIMIT_EXCEEDED},
        {WH_SEGMENT_AXES, nan_target, WH_STATUS_NOT_FINITE},
        {WH_SEGMENT_LINE, far_line, WH_STATUS_OUT_OF_REACH},
        {WH_SEGMENT_LINE, nan_line, WH_STATUS_NOT_FINITE},
        {WH_SEGMENT_LINE, endless_line, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_LINE, backward_line, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_VALVES, half_valve, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_VALVES, absent_valve, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_DWELL, negative_time, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_DWELL, endless_time, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_SENSOR, nan_time, WH_STATUS_NOT_FINITE},
        {WH_SEGMENT_SENSOR, absent_gripper, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_SENSOR, no_gripper, WH_STATUS_BAD_SEGMENT},
        {WH_SEGMENT_DWELL, no_kind, WH_STATUS_BAD_SEGMENT},
    };
    wh_track_t track = begin_track(1000);
    wh_segment_t running = blank(&track, WH_SEGMENT_LINE);
    running.travel = wh_vec3(100, 0, 0);
    assert_int_equal(wh_track_begin(&track, &running), WH_OK);
    assert_int_equal(wh_track_next(&track, 0), WH_TRACK_MOVING);
    const wh_track_t before = track;
    for (size_t i = 0; i < sizeof refusals / sizeof refusals[0]; ++i) {
        wh_segment_t segment = blank(&track, refusals[i].kind);
        refusals[i].spoil(&segment);
        assert_int_equal(wh_track_begin(&track, &segment), refusals[i].status);
        assert_memory_equal(&track, &before, sizeof track);
    }
    assert_int_equal(wh_track_begin(NULL, &running), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_track_begin(&track, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_memory_equal(&track, &before, sizeof track);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_at_home_with_closed_valves),
        cmocka_unit_test(init_refuses_and_leaves_the_track),
        cmocka_unit_test(a_track_that_was_never_initialised_is_refused),
        cmocka_unit_test(a_blank_segment_changes_nothing),
        cmocka_unit_test(a_whole_number_of_slices_is_just_that_many),
        cmocka_unit_test(a_dwell_is_rounded_up),
        cmocka_unit_test(moves_end_on_the_targets_bits),
        cmocka_unit_test(each_slice_of_a_move_is_on_its_plan),
        cmocka_unit_test(each_slice_of_a_line_is_on_its_plan),
        cmocka_unit_test(a_line_ends_on_its_end),
        cmocka_unit_test(skipping_equals_playing),
        cmocka_unit_test(valves_take_one_slice),
        cmocka_unit_test(a_sensor_ends_the_wait),
        cmocka_unit_test(a_sensor_that_is_on_takes_no_slice),
        cmocka_unit_test(a_wait_times_out_after_its_slices),
        cmocka_unit_test(slow_axes_are_refused),
        cmocka_unit_test(a_segment_of_just_the_longest_duration),
        cmocka_unit_test(a_move_of_every_axis),
        cmocka_unit_test(a_refused_segment_leaves_the_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
