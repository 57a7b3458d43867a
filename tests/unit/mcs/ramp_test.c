/* A STOP that slows down: the axes stay on their way and within their limits, in differences of their places, and
 * stand at its end; in a cruise of one axis it takes the time of the closed form. */
#include "support/support.h"

#include "grasp/grasp.h"
#include "math/trig.h"
#include "mcs/ramp.h"

static wh_machine_t machine;

static wh_track_t begin_track(int64_t slice_us) {
    wh_track_t track;
    memset(&machine, 0, sizeof machine);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.axis_count = WH_ROBOT_AXES;
    machine.gripper_count = 1;
    machine.mounts[0].axis = WH_NONE;
    assert_int_equal(wh_track_init(&track, &machine, slice_us), WH_OK);
    return track;
}

/* Goes on to the slice; false: the segment is over before. */
static bool go_to(wh_track_t *track, int64_t slice) {
    for (int64_t i = 0; i < slice; ++i) {
        if (wh_track_next(track, 0) != WH_TRACK_MOVING) {
            return false;
        }
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------ the oracle */

/* The last four places of an axis, from which its differences come. */
typedef struct {
    double at[4][WH_ROBOT_AXES];
} places_t;

static void note(places_t *places, const wh_real_t axes[]) {
    memmove(places->at[0], places->at[1], 3 * sizeof places->at[0]);
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        places->at[3][axis] = (double)axes[axis];
    }
}

/* Each difference by the limits of the axis: what the ramp may have more than they say is a thousandth. */
static void check_limits(const places_t *places, double dt) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_limits_t *limits = wh_machine_limits(&machine, axis);
        const double *a = places->at[0], *b = places->at[1], *c = places->at[2], *d = places->at[3];
        const double speed = (d[axis] - c[axis]) / dt;
        const double acceleration = (d[axis] - 2 * c[axis] + b[axis]) / (dt * dt);
        const double jerk = (d[axis] - 3 * c[axis] + 3 * b[axis] - a[axis]) / (dt * dt * dt);
        assert_true(fabs(speed) <= (double)limits->speed * 1.0011);
        assert_true(fabs(acceleration) <= (double)limits->acceleration * 1.0011 + 1e-3);
        assert_true(fabs(jerk) <= (double)limits->jerk * 1.0011 + 1);
    }
}

/* True if the axes are on the way from `from` to `to`, each as far as its own share. */
static void check_between(const wh_real_t axes[], const wh_real_t from[], const wh_real_t to[]) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const double least = fmin((double)from[axis], (double)to[axis]) - 1e-9;
        const double most = fmax((double)from[axis], (double)to[axis]) + 1e-9;
        assert_true((double)axes[axis] >= least && (double)axes[axis] <= most);
    }
}

/* Stops the segment after `slice` slices. Returns how many more it takes, or -1 if it is over before. */
static int64_t stop_after(wh_track_t *track, const wh_segment_t *segment, int64_t slice) {
    wh_ramp_t ramp;
    places_t places;
    wh_real_t from[WH_AXES];
    const double dt = (double)track->slice_us / 1e6;
    memcpy(from, track->axes, sizeof from);
    if (wh_track_begin(track, segment) != WH_OK) {
        return -1;
    }
    for (int i = 0; i < 4; ++i) {
        note(&places, track->axes);
    }
    for (int64_t i = 0; i < slice; ++i) {
        if (!go_to(track, 1)) {
            return -1;
        }
        note(&places, track->axes);
    }
    const int64_t rest = track->segment_slices - track->segment_slice;
    const int64_t before = track->slice;
    const bool moves = wh_ramp_begin(&ramp, track, false);
    assert_int_equal(moves, rest > 0 && slice > 0);
    while (moves && wh_ramp_next(&ramp, track)) {
        note(&places, track->axes);
        check_limits(&places, dt);
        check_between(track->axes, from, segment->target);
    }
    for (int i = 0; i < 4; ++i) { /* it stands */
        note(&places, track->axes);
        check_limits(&places, dt);
    }
    assert_true(track->slice - before <= rest);
    return track->slice - before;
}

/* --------------------------------------------------------------------------------------------------- tests */

static void stays_within_limits_wherever_it_is_stopped(void **state) {
    (void)state;
    int64_t stopped = 0, early = 0;
    wh_rounds_t rounds = WH_ROUNDS(40, 2000, 2);
    while (wh_round(&rounds)) {
        wh_track_t track = begin_track(1000);
        wh_segment_t segment = wh_track_blank(&track);
        segment.kind = WH_SEGMENT_AXES;
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            const bool moves = wh_test_below(3) > 0;
            const wh_travel_t *travel = wh_machine_travel(&machine, axis);
            const double part = wh_test_uniform(0, wh_test_below(2) ? 1 : 0.1);
            segment.target[axis] += moves ? (wh_real_t)part * (travel->max - track.axes[axis]) : 0;
        }
        wh_track_t whole = track;
        assert_int_equal(wh_track_begin(&whole, &segment), WH_OK);
        const int64_t slice = (int64_t)wh_test_below((uint32_t)whole.segment_slices + 2);
        const int64_t more = stop_after(&track, &segment, slice);
        stopped += more > 0 ? 1 : 0;
        early += more > 0 && slice + more < whole.segment_slices ? 1 : 0;
    }
    assert_true(stopped > rounds.made / 2 && early > rounds.made / 8);
}

/* Half a ramp's time passes on the way at full speed: v T / 2; its slowest part is 1.5 v / T, its jerk 6 v / T^2. */
static void takes_the_time_of_the_closed_form(void **state) {
    (void)state;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = wh_track_blank(&track);
    const wh_limits_t *limits = &machine.robot.limits[WH_AXIS_THETA];
    segment.kind = WH_SEGMENT_AXES;
    segment.target[WH_AXIS_THETA] = machine.robot.travel[WH_AXIS_THETA].max;
    wh_track_t whole = track;
    assert_int_equal(wh_track_begin(&whole, &segment), WH_OK);
    const int64_t middle = whole.segment_slices / 2;
    const double speed = (double)limits->speed;
    const double by_acceleration = 1.5 * speed / (double)limits->acceleration;
    const double by_jerk = sqrt(6 * speed / (double)limits->jerk);
    const double seconds = fmax(by_acceleration, by_jerk);
    const int64_t more = stop_after(&track, &segment, middle);
    assert_true((double)more * 1e-3 >= seconds * 0.999 - 1e-3);
    assert_true((double)more * 1e-3 <= seconds * 1.02 + 5e-3);
    wh_track_t there = whole;
    (void)go_to(&there, middle);
    const double way = (double)(track.axes[WH_AXIS_THETA] - there.axes[WH_AXIS_THETA]);
    assert_true(fabs(way - speed * (double)more * 1e-3 / 2) < speed * 1e-3);
}

static void what_waits_stands_at_once(void **state) {
    (void)state;
    wh_ramp_t ramp;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = wh_track_blank(&track);
    segment.seconds = 1;
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    assert_true(go_to(&track, 10));
    assert_false(wh_ramp_begin(&ramp, &track, false));
}

/* Slices of other lengths have the same ramp, but for their rounding. */
static void does_not_depend_on_the_slice(void **state) {
    (void)state;
    double first = 0;
    static const int64_t slices_us[] = {1000, 500, 2000, 4000};
    for (size_t i = 0; i < sizeof slices_us / sizeof slices_us[0]; ++i) {
        wh_track_t track = begin_track(slices_us[i]);
        wh_segment_t segment = wh_track_blank(&track);
        segment.kind = WH_SEGMENT_AXES;
        segment.target[WH_AXIS_THETA] = 3;
        segment.target[WH_AXIS_Z] += 100;
        const int64_t more = stop_after(&track, &segment, 800000 / slices_us[i]);
        const double seconds = (double)(more * slices_us[i]) / 1e6;
        first = i == 0 ? seconds : first;
        assert_true(more > 0 && fabs(seconds - first) < 0.05 * first + 0.02);
    }
}

static void a_line_stays_straight(void **state) {
    (void)state;
    wh_ramp_t ramp;
    wh_track_t track = begin_track(1000);
    wh_segment_t segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_LINE;
    segment.travel = wh_vec3(200, 0, 0);
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    assert_true(go_to(&track, track.segment_slices / 3));
    wh_pose_t before, now;
    wh_robot_forward(track.axes, &before);
    assert_true(wh_ramp_begin(&ramp, &track, false));
    while (wh_ramp_next(&ramp, &track)) { /* straight along x */
        wh_robot_forward(track.axes, &now);
        assert_true(fabs((double)(now.r.y - before.r.y)) < 1e-9 && now.r.x >= before.r.x);
    }
    assert_true(now.r.x > before.r.x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stays_within_limits_wherever_it_is_stopped),
        cmocka_unit_test(takes_the_time_of_the_closed_form),
        cmocka_unit_test(what_waits_stands_at_once),
        cmocka_unit_test(does_not_depend_on_the_slice),
        cmocka_unit_test(a_line_stays_straight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
