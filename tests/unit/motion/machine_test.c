/* The machine: which descriptions are refused, whose limits an axis has, and where grippers ride. */
#include "support/pose.h"

#include "math/trig.h"
#include "motion/machine.h"
#include "sim/slice.h"

/* The default robot, a gripper on it, and one on a chuck at (-600, 0, 950), turned by 180 degrees. */
static wh_machine_t machine_with_chuck(void) {
    wh_machine_t machine;
    memset(&machine, 0, sizeof machine);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[WH_AXIS_YAW];
    machine.axis_count = 5;
    machine.gripper_count = 2;
    machine.mounts[0].axis = WH_NONE;
    machine.mounts[0].base_from_station = wh_pose_identity();
    machine.mounts[1].axis = 4;
    machine.mounts[1].base_from_station.R = wh_mat3_from_rpy_deg(0, 0, 180);
    machine.mounts[1].base_from_station.r = wh_vec3(-600, 0, 950);
    return machine;
}

static void a_sound_machine_passes(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_chuck();
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
}

static void null_is_refused(void **state) {
    (void)state;
    assert_int_equal(wh_machine_validate(NULL), WH_STATUS_NULL_ARGUMENT);
}

static void counts_out_of_range_are_refused(void **state) {
    (void)state;
    static const size_t axes[] = {0, 3, WH_AXES + 1};
    static const size_t grippers[] = {0, WH_GRIPPERS + 1};
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; ++i) {
        wh_machine_t machine = machine_with_chuck();
        machine.axis_count = axes[i];
        assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    }
    for (size_t i = 0; i < sizeof grippers / sizeof grippers[0]; ++i) {
        wh_machine_t machine = machine_with_chuck();
        machine.gripper_count = grippers[i];
        assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    }
}

static void the_greatest_counts_pass(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    machine.axis_count = WH_AXES;
    machine.gripper_count = WH_GRIPPERS;
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        machine.mounts[g] = machine.mounts[1];
        machine.mounts[g].axis = WH_AXES - 1;
    }
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
}

/* Without a chuck: four axes, one gripper on the robot. */
static void the_least_counts_pass(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    machine.axis_count = WH_ROBOT_AXES;
    machine.gripper_count = 1;
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
    const wh_real_t axes[] = {0, 300, 900, 0, 2 * WH_CHUCK_TRAVEL};
    assert_int_equal(wh_machine_check_travel(&machine, axes), WH_OK);
}

static void every_mount_is_looked_at(void **state) {
    (void)state;
    for (size_t g = 0; g < 2; ++g) {
        wh_machine_t machine = machine_with_chuck();
        machine.mounts[g].axis = 9;
        assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    }
}

/* Two chucks and the robot, in any order; what is beyond the counts is neither read nor written. */
static void each_gripper_has_its_pose(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    machine.axis_count = 6;
    machine.gripper_count = 3;
    machine.mounts[2] = machine.mounts[0];
    machine.mounts[0] = machine.mounts[1];
    machine.mounts[1].axis = 5;
    const wh_real_t axes[] = {WH_REAL(0.7), 512, 1001, WH_REAL(-1.2), 1, 2, WH_REAL(NAN)};
    wh_pose_t effector;
    wh_pose_t poses[4];
    memset(poses, 0x5a, sizeof poses);
    const wh_pose_t untouched = poses[3];
    wh_robot_forward(axes, &effector);
    wh_machine_grippers(&machine, axes, poses);
    for (size_t g = 0; g < 2; ++g) {
        const wh_mat3_t turn = wh_mat3_about_z(axes[4 + g]);
        assert_near(poses[g].R.m[0][0], -turn.m[0][0], 1e-6);
        assert_near(poses[g].R.m[1][0], -turn.m[1][0], 1e-6);
        assert_memory_equal(&poses[g].r, &machine.mounts[0].base_from_station.r, sizeof poses[g].r);
    }
    assert_memory_equal(&poses[2], &effector, sizeof effector);
    assert_memory_equal(&poses[3], &untouched, sizeof untouched);
    assert_int_equal(wh_machine_check_travel(&machine, axes), WH_OK);
    const wh_real_t far[] = {0, 300, 900, 0, 0, 2 * WH_CHUCK_TRAVEL};
    assert_int_equal(wh_machine_check_travel(&machine, far), WH_STATUS_LIMIT_EXCEEDED);
}

static void a_mount_on_no_chuck_axis_is_refused(void **state) {
    (void)state;
    static const int32_t axes[] = {-2, 0, 3, 5, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; ++i) {
        wh_machine_t machine = machine_with_chuck();
        machine.mounts[1].axis = axes[i];
        assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    }
}

static void a_chuck_that_stands_nowhere_is_refused(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    machine.mounts[1].base_from_station.R.m[0][0] = WH_REAL(-1.1);
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_A_ROTATION);
    machine = machine_with_chuck();
    machine.mounts[1].base_from_station.r.x = (wh_real_t)NAN;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_FINITE);
}

/* The robot's grippers are where the robot is: what stands in their mount does not matter. */
static void the_robots_mount_is_not_looked_at(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    machine.mounts[0].base_from_station.r.x = (wh_real_t)NAN;
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
}

static void bad_limits_are_refused(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    machine.chuck_limits.jerk = 0;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_BAD_LIMITS);
    machine = machine_with_chuck();
    machine.robot.limits[WH_AXIS_Z].speed = -1;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_BAD_LIMITS);
}

static void each_axis_has_its_own_limits(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_chuck();
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        assert_ptr_equal(wh_machine_limits(&machine, axis), &machine.robot.limits[axis]);
    }
    assert_ptr_equal(wh_machine_limits(&machine, WH_ROBOT_AXES), &machine.chuck_limits);
    assert_ptr_equal(wh_machine_limits(&machine, WH_AXES - 1), &machine.chuck_limits);
}

static void travel_is_checked_on_every_axis(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_chuck();
    const wh_real_t home[] = {0, 300, 900, 0, 0};
    static const struct {
        size_t axis;
        wh_real_t position;
        wh_status_t status;
    } rows[] = {{0, 0, WH_OK},
                {WH_AXIS_R, 900, WH_OK},
                {WH_AXIS_R, 901, WH_STATUS_OUT_OF_REACH},
                {WH_AXIS_R, 299, WH_STATUS_OUT_OF_REACH},
                {WH_AXIS_Z, 1301, WH_STATUS_LIMIT_EXCEEDED},
                {WH_AXIS_THETA, 10, WH_STATUS_LIMIT_EXCEEDED},
                {WH_AXIS_YAW, -5, WH_STATUS_LIMIT_EXCEEDED},
                {4, WH_CHUCK_TRAVEL, WH_OK},
                {4, -WH_CHUCK_TRAVEL, WH_OK},
                {4, WH_CHUCK_TRAVEL + 1, WH_STATUS_LIMIT_EXCEEDED},
                {4, -WH_CHUCK_TRAVEL - 1, WH_STATUS_LIMIT_EXCEEDED},
                {4, (wh_real_t)NAN, WH_STATUS_NOT_FINITE},
                {4, (wh_real_t)INFINITY, WH_STATUS_NOT_FINITE},
                {WH_AXIS_YAW, (wh_real_t)NAN, WH_STATUS_NOT_FINITE}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        wh_real_t axes[5];
        memcpy(axes, home, sizeof axes);
        axes[rows[i].axis] = rows[i].position;
        assert_int_equal(wh_machine_check_travel(&machine, axes), rows[i].status);
    }
}

static void the_robots_gripper_is_the_robots_effector(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_chuck();
    const wh_real_t axes[] = {WH_REAL(0.7), 512, 1001, WH_REAL(-1.2), 3};
    wh_pose_t effector;
    wh_pose_t poses[2];
    wh_robot_forward(axes, &effector);
    wh_machine_grippers(&machine, axes, poses);
    assert_memory_equal(&poses[0], &effector, sizeof effector);
}

/* Turning by `angle` carries a point on the chuck round its own axis, tilted as the station is. */
static void a_chuck_turns_about_its_own_z(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_chuck();
    wh_pose_t *station = &machine.mounts[1].base_from_station;
    station->R = wh_test_rotation(1, 2, 3, 0.4);
    for (int i = -4; i <= 4; ++i) {
        const double angle = 0.3 * i;
        const wh_real_t axes[] = {0, 300, 900, 0, (wh_real_t)angle};
        wh_pose_t poses[2];
        wh_machine_grippers(&machine, axes, poses);
        assert_memory_equal(&poses[1].r, &station->r, sizeof station->r);
        for (size_t row = 0; row < 3; ++row) {
            const double x = station->R.m[row][0];
            const double y = station->R.m[row][1];
            assert_near(poses[1].R.m[row][0], x * cos(angle) + y * sin(angle), 16 * WH_TEST_ROUNDING);
            assert_near(poses[1].R.m[row][1], y * cos(angle) - x * sin(angle), 16 * WH_TEST_ROUNDING);
            assert_near(poses[1].R.m[row][2], station->R.m[row][2], 0);
        }
    }
}

/* The chuck's whole travel is within what the sine reduces: a valid pose at both ends. */
static void a_chuck_has_a_pose_over_its_whole_travel(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_chuck();
    for (int end = -1; end <= 1; end += 2) {
        const wh_real_t axes[] = {0, 300, 900, 0, (wh_real_t)end * WH_CHUCK_TRAVEL};
        wh_pose_t poses[2];
        wh_machine_grippers(&machine, axes, poses);
        assert_int_equal(wh_pose_validate(&poses[1]), WH_OK);
    }
}

/* Two blades back to back, one above the other. */
static wh_machine_t machine_with_two_blades(void) {
    wh_machine_t machine = machine_with_chuck();
    machine.mounts[1] = machine.mounts[0];
    machine.mounts[1].is_shifted = true;
    machine.mounts[1].effector_from_gripper.r = wh_vec3(-40, 5, 12);
    machine.mounts[1].effector_from_gripper.R = wh_mat3_from_rpy_deg(0, 0, 180);
    machine.axis_count = WH_ROBOT_AXES;
    return machine;
}

static void a_shifted_gripper_sits_beside_the_effector(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_two_blades();
    const wh_real_t axes[] = {WH_PI / 2, 500, 1000, 0};
    wh_pose_t poses[2];
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
    wh_machine_grippers(&machine, axes, poses);
    assert_near(poses[0].r.y, 500, 1e-3);
    assert_near(poses[1].r.x, -5, 1e-3);
    assert_near(poses[1].r.y, 460, 1e-3);
    assert_near(poses[1].r.z, 1012, 1e-3);
    assert_near(poses[1].R.m[1][0], -1, 1e-6);
}

/* A flag that is not set leaves every bit alone, whatever stands in the pose. */
static void a_gripper_that_is_not_shifted_is_the_effector(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_two_blades();
    const wh_real_t axes[] = {WH_REAL(0.7), 512, 1001, WH_REAL(-1.2)};
    wh_pose_t poses[2];
    machine.mounts[1].is_shifted = false;
    machine.mounts[1].effector_from_gripper.r.x = (wh_real_t)NAN;
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
    wh_machine_grippers(&machine, axes, poses);
    assert_memory_equal(&poses[1], &poses[0], sizeof poses[0]);
}

static void a_tilted_or_broken_shift_is_refused(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_two_blades();
    machine.mounts[1].effector_from_gripper.R = wh_mat3_from_rpy_deg(0, WH_REAL(0.01), 90);
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_LEVEL);
    machine.mounts[1].effector_from_gripper.R = wh_mat3_from_rpy_deg(180, 0, 0);
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_LEVEL);
    machine = machine_with_two_blades();
    machine.mounts[1].effector_from_gripper.r.z = (wh_real_t)NAN;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_FINITE);
    machine = machine_with_two_blades();
    machine.mounts[1].effector_from_gripper.R.m[0][0] = 0;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_A_ROTATION);
}

/* As slight as that, and seen in any one entry. */
static void the_slightest_tilt_shows(void **state) {
    static const size_t places[][2] = {{0, 2}, {1, 2}, {2, 0}, {2, 1}, {2, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        wh_machine_t machine = machine_with_two_blades();
        machine.mounts[1].effector_from_gripper.R.m[places[i][0]][places[i][1]] += WH_REAL(2e-7);
        assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_LEVEL);
    }
}

/* Each gripper comes to the point, with its own x along the heading; the plain one by the robot's own inverse. */
static void the_inverse_brings_each_gripper_there(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_two_blades();
    machine.mounts[1].effector_from_gripper.R = wh_mat3_from_rpy_deg(0, 0, 170);
    const wh_vec3_t at = wh_vec3(350, -420, 1015);
    for (int turn = -3; turn <= 3; ++turn) {
        const wh_real_t heading = WH_REAL(0.9) * (wh_real_t)turn;
        wh_real_t plain[WH_ROBOT_AXES];
        wh_real_t axes[WH_ROBOT_AXES];
        wh_pose_t poses[2];
        assert_int_equal(
            wh_robot_inverse(&machine.robot, at.x, at.y, at.z, heading, machine.robot.home, plain), WH_OK);
        assert_int_equal(wh_machine_inverse(&machine, 0, &at, heading, machine.robot.home, axes), WH_OK);
        assert_memory_equal(axes, plain, sizeof axes);
        assert_int_equal(wh_machine_inverse(&machine, 1, &at, heading, machine.robot.home, axes), WH_OK);
        wh_machine_grippers(&machine, axes, poses);
        assert_near(poses[1].r.x, at.x, 1e3 * 16 * WH_TEST_ROUNDING);
        assert_near(poses[1].r.y, at.y, 1e3 * 16 * WH_TEST_ROUNDING);
        assert_near(poses[1].r.z, at.z, 1e3 * 16 * WH_TEST_ROUNDING);
        assert_near(poses[1].R.m[0][0], cos((double)heading), 64 * WH_TEST_ROUNDING);
        assert_near(poses[1].R.m[1][0], sin((double)heading), 64 * WH_TEST_ROUNDING);
    }
}

static void the_inverse_refuses_what_the_robots_does(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_two_blades();
    const wh_vec3_t at = wh_vec3(350, -420, 1015);
    const wh_vec3_t far = wh_vec3(3500, -420, 1015);
    const wh_real_t untouched[WH_ROBOT_AXES] = {1, 2, 3, 4};
    const wh_real_t *home = machine.robot.home;
    wh_real_t q[WH_ROBOT_AXES] = {1, 2, 3, 4};
    for (size_t g = 0; g < 2; ++g) {
        assert_int_equal(wh_machine_inverse(&machine, g, &far, 0, home, q), WH_STATUS_OUT_OF_REACH);
        assert_int_equal(wh_machine_inverse(&machine, g, &at, (wh_real_t)NAN, home, q), WH_STATUS_NOT_FINITE);
        assert_int_equal(wh_machine_inverse(&machine, g, &at, 2 * WH_TRIG_MAX_RAD, home, q),
                         WH_STATUS_OUT_OF_RANGE);
        assert_memory_equal(q, untouched, sizeof q);
    }
}

/* ---------------------------------------------- followed from slice to slice */
/* Grippers followed from slice to slice: the poses of wh_machine_grippers, to the last bit, whatever moves and whatever
 * stands still; and what stands still is left alone. */
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
        cmocka_unit_test(a_shifted_gripper_sits_beside_the_effector),
        cmocka_unit_test(a_gripper_that_is_not_shifted_is_the_effector),
        cmocka_unit_test(a_tilted_or_broken_shift_is_refused),
        cmocka_unit_test(the_slightest_tilt_shows),
        cmocka_unit_test(the_inverse_brings_each_gripper_there),
        cmocka_unit_test(the_inverse_refuses_what_the_robots_does),
        cmocka_unit_test(a_sound_machine_passes),
        cmocka_unit_test(null_is_refused),
        cmocka_unit_test(counts_out_of_range_are_refused),
        cmocka_unit_test(the_greatest_counts_pass),
        cmocka_unit_test(the_least_counts_pass),
        cmocka_unit_test(every_mount_is_looked_at),
        cmocka_unit_test(each_gripper_has_its_pose),
        cmocka_unit_test(a_mount_on_no_chuck_axis_is_refused),
        cmocka_unit_test(a_chuck_that_stands_nowhere_is_refused),
        cmocka_unit_test(the_robots_mount_is_not_looked_at),
        cmocka_unit_test(bad_limits_are_refused),
        cmocka_unit_test(each_axis_has_its_own_limits),
        cmocka_unit_test(travel_is_checked_on_every_axis),
        cmocka_unit_test(the_robots_gripper_is_the_robots_effector),
        cmocka_unit_test(a_chuck_turns_about_its_own_z),
        cmocka_unit_test(a_chuck_has_a_pose_over_its_whole_travel),
        cmocka_unit_test_setup(the_poses_are_the_machines, set_up),
        cmocka_unit_test_setup(the_bits_decide, set_up),
        cmocka_unit_test_setup(what_stands_still_is_not_written, set_up),
        cmocka_unit_test_setup(the_axes_beyond_the_last_are_left_alone, set_up),
        cmocka_unit_test_setup(a_command_follows_a_track, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
