/* Grippers followed from slice to slice: the poses of wh_machine_grippers, to the last bit, whatever moves and whatever
 * stands still; and what stands still is left alone. */
#include "support/pose.h"

#include "math/trig.h"
#include "motion/machine.h"
#include "sim/slice.h"

enum { AXES = 6, GRIPPERS = 4 };

static wh_machine_t machine;
static wh_machine_cache_t cache;
static wh_gripper_input_t followed[GRIPPERS];

/* Two blades on the robot, one of them beside the end-effector, and two chucks, one of them tilted. */
static int set_up(void **state) {
    (void)state;
    memset(&machine, 0, sizeof machine);
    memset(&cache, 0, sizeof cache);
    memset(followed, 0, sizeof followed);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.axis_count = AXES;
    machine.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        machine.mounts[g].axis = g < 2 ? WH_NONE : 2 + g;
        machine.mounts[g].base_from_station = wh_test_at(-600, 100 * g, 950);
    }
    machine.mounts[1].is_shifted = true;
    machine.mounts[1].effector_from_gripper = wh_test_at(-20, 5, 10);
    machine.mounts[1].effector_from_gripper.R = wh_mat3_from_rpy_deg(0, 0, 170);
    machine.mounts[3].base_from_station.R = wh_mat3_from_rpy_deg(1.5, -0.3, 80);
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
    return 0;
}

static void follow(const wh_real_t axes[]) {
    wh_pose_t poses[GRIPPERS];
    wh_machine_grippers(&machine, axes, poses);
    wh_machine_update(&machine, axes, &cache, followed);
    for (int g = 0; g < GRIPPERS; ++g) {
        assert_memory_equal(&followed[g].base_from_gripper, &poses[g], sizeof poses[g]);
    }
}

/* Any of the axes move, to places where they were before, too; now and then theta and yaw alone, against each other. */
static void the_poses_are_the_machines(void **state) {
    static const wh_real_t angles[] = {0, WH_REAL(-0.0), 1, WH_REAL(-2.5), WH_PI, -WH_PI};
    wh_real_t axes[WH_AXES] = {0, 300, 900, 0, 0, 0};
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        const uint64_t moving = wh_test_below(64);
        for (size_t axis = 0; axis < AXES; ++axis) {
            const bool is_length = axis == WH_AXIS_R || axis == WH_AXIS_Z;
            if ((moving >> axis & 1U) != 0) {
                axes[axis] = is_length ? (wh_real_t)wh_test_uniform(300, 900) : angles[wh_test_below(6)];
            }
        }
        if (wh_test_below(8) == 0) {
            const wh_real_t turn = (wh_real_t)wh_test_uniform(-3, 3);
            axes[WH_AXIS_THETA] += turn;
            axes[WH_AXIS_YAW] -= turn;
        }
        follow(axes);
    }
}

/* Zeros of different sign are different angles, and what is no number is followed as well. */
static void the_bits_decide(void **state) {
    static const wh_real_t angles[] = {0, WH_REAL(-0.0), 0, WH_REAL(NAN), WH_REAL(NAN), 1, WH_REAL(INFINITY)};
    (void)state;
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; ++i) {
        const wh_real_t turned[AXES] = {angles[i], 300, 900, WH_REAL(-0.0), angles[i], angles[i]};
        const wh_real_t wrist[AXES] = {WH_REAL(-0.0), 300, 900, angles[i], angles[i], 0};
        follow(turned);
        follow(wrist);
    }
}

static void what_stands_still_is_not_written(void **state) {
    wh_real_t axes[AXES] = {0, 300, 900, 0, 0, 0};
    wh_gripper_input_t mark[GRIPPERS];
    (void)state;
    for (size_t axis = 0; axis < AXES + 1; ++axis) {
        const bool robot = axis < WH_ROBOT_AXES;
        const bool moves[GRIPPERS] = {robot, robot, axis == 4, axis == 5};
        set_up(NULL);
        follow(axes);
        memset(followed, 0x5a, sizeof followed);
        memcpy(mark, followed, sizeof mark);
        if (axis < AXES) {
            axes[axis] += 1;
        }
        wh_machine_update(&machine, axes, &cache, followed);
        for (int g = 0; g < GRIPPERS; ++g) {
            const int differs =
                memcmp(&followed[g].base_from_gripper, &mark[g].base_from_gripper, sizeof(wh_pose_t));
            assert_int_equal(differs != 0, moves[g]);
            assert_int_equal(followed[g].valve, mark[g].valve);
        }
    }
}

/* What stands beyond the axes in use is none of them. */
static void the_axes_beyond_the_last_are_left_alone(void **state) {
    (void)state;
    wh_real_t axes[AXES + 1] = {0, 300, 900, 0, 0, 0, 7};
    cache.axes[AXES] = 5;
    follow(axes);
    axes[WH_AXIS_R] = 310;
    follow(axes);
    assert_near(cache.axes[AXES], 5, 0);
    assert_near(cache.axes[AXES - 1], 0, 0);
}

/* A command that follows a track says what the track says, and keeps the faults that it is to bring. */
static void a_command_follows_a_track(void **state) {
    wh_track_t track;
    wh_command_t command;
    (void)state;
    memset(&command, 0, sizeof command);
    command.fault_count = 1;
    command.grippers[GRIPPERS].valve = 7;
    assert_int_equal(wh_track_init(&track, &machine, 250), WH_OK);
    wh_segment_t segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_AXES;
    segment.target[WH_AXIS_R] = 310;
    segment.target[5] = 1;
    assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
    track.valves[3] = WH_VALVE_OPEN;
    int64_t seq = 0;
    while (wh_track_next(&track, 0) == WH_TRACK_MOVING) {
        wh_pose_t poses[GRIPPERS];
        wh_command_from_track(&command, &cache, &track);
        wh_machine_grippers(&machine, track.axes, poses);
        ++seq;
        assert_int_equal(command.seq, seq);
        assert_int_equal(command.utime, 250 * seq);
        assert_int_equal(command.gripper_count, GRIPPERS);
        assert_int_equal(command.axis_count, AXES);
        assert_int_equal(command.fault_count, 1);
        assert_memory_equal(command.axes, track.axes, sizeof command.axes);
        for (int g = 0; g < GRIPPERS; ++g) {
            assert_memory_equal(&command.grippers[g].base_from_gripper, &poses[g], sizeof poses[g]);
            assert_int_equal(command.grippers[g].valve, track.valves[g]);
        }
        assert_int_equal(command.grippers[GRIPPERS].valve, 7);
    }
    assert_true(seq > 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(the_poses_are_the_machines, set_up),
        cmocka_unit_test_setup(the_bits_decide, set_up),
        cmocka_unit_test_setup(what_stands_still_is_not_written, set_up),
        cmocka_unit_test_setup(the_axes_beyond_the_last_are_left_alone, set_up),
        cmocka_unit_test_setup(a_command_follows_a_track, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
