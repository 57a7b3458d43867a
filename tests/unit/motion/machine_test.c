/* The machine: which descriptions are refused, which limits an axis has, and where grippers are mounted. */
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

/* The chuck on a stage that moves 5 mm to either side, and pins beside it, 3 mm below its plane at rest. */
static wh_machine_t machine_with_stage(void) {
    wh_machine_t machine = machine_with_chuck();
    static const wh_limits_t limits = {50, 500, 5000};
    machine.gripper_count = 3;
    machine.axis_count = 8;
    machine.mounts[1].kind = WH_MOUNT_STAGE;
    machine.mounts[1].travel.max = 5;
    machine.mounts[1].limits = limits;
    machine.mounts[2] = machine.mounts[1];
    machine.mounts[2].kind = WH_MOUNT_PINS;
    machine.mounts[2].axis = 7;
    machine.mounts[2].travel.min = -3;
    return machine;
}

/* The station's x points to base's -x. */
static void a_stage_shifts_its_chuck_and_pins_go_up(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_stage();
    wh_real_t q[WH_AXES];
    wh_pose_t poses[3];
    wh_gripper_input_t grippers[3];
    wh_machine_cache_t last = {.is_taken = false};
    assert_int_equal(wh_machine_validate(&machine), WH_OK);
    wh_machine_home(&machine, q);
    wh_machine_update(&machine, q, &last, grippers);
    assert_near(grippers[2].base_from_gripper.r.z, 947, 1e-9);
    static const wh_real_t moved[] = {1, 2, -3, 4};
    for (size_t axis = 4; axis < 8; ++axis) {
        q[axis] = moved[axis - 4];
        wh_machine_update(&machine, q, &last, grippers);
        wh_machine_grippers(&machine, q, poses);
        assert_memory_equal(&grippers[1].base_from_gripper, &poses[1], sizeof poses[1]);
        assert_memory_equal(&grippers[2].base_from_gripper, &poses[2], sizeof poses[2]);
    }
    assert_near(poses[1].r.x, -602, 1e-3);
    assert_near(poses[1].r.y, 3, 1e-3);
    assert_near(poses[1].R.m[0][0], -wh_cos(1), 1e-6);
    assert_near(poses[2].r.z, 954, 1e-3);
    assert_near(poses[2].R.m[0][0], -1, 1e-6);
}

static void stages_and_pins_have_limits_of_their_own(void **state) {
    (void)state;
    const wh_machine_t machine = machine_with_stage();
    static const wh_real_t ends[4][2] = {{-WH_CHUCK_TRAVEL, WH_CHUCK_TRAVEL}, {-5, 5}, {-5, 5}, {-3, 5}};
    wh_real_t q[WH_AXES];
    assert_ptr_equal(wh_machine_limits(&machine, 4), &machine.chuck_limits);
    assert_ptr_equal(wh_machine_limits(&machine, 5), &machine.mounts[1].limits);
    assert_ptr_equal(wh_machine_limits(&machine, 6), &machine.mounts[1].limits);
    assert_ptr_equal(wh_machine_limits(&machine, 7), &machine.mounts[2].limits);
    for (size_t axis = 4; axis < 8; ++axis) {
        const wh_travel_t travel = wh_machine_beside(&machine, axis);
        assert_near(travel.min, ends[axis - 4][0], 0);
        assert_near(travel.max, ends[axis - 4][1], 0);
        for (int end = 0; end < 2; ++end) {
            wh_machine_home(&machine, q);
            q[axis] = ends[axis - 4][end];
            assert_int_equal(wh_machine_check_travel(&machine, q), WH_OK);
            q[axis] *= WH_REAL(1.01);
            assert_int_equal(wh_machine_check_travel(&machine, q), WH_STATUS_LIMIT_EXCEEDED);
        }
    }
}

static void a_stage_or_pins_that_cannot_be_are_refused(void **state) {
    (void)state;
    wh_machine_t machine = machine_with_stage();
    machine.axis_count = 7; /* pins have none left */
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    machine = machine_with_stage();
    machine.mounts[1].axis = 6; /* nor does a stage have its third one */
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    machine = machine_with_stage();
    machine.mounts[2].kind = (wh_mount_kind_t)4;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_OUT_OF_RANGE);
    machine = machine_with_stage();
    machine.mounts[1].travel.max = 0;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_BAD_LIMITS);
    machine = machine_with_stage();
    machine.mounts[2].travel.max = -3;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_BAD_LIMITS);
    machine.mounts[2].travel.max = (wh_real_t)NAN;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_FINITE);
    machine = machine_with_stage();
    machine.mounts[2].limits.jerk = 0;
    assert_int_equal(wh_machine_validate(&machine), WH_STATUS_BAD_LIMITS);
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

/* Two chucks and the robot, in any order; entries beyond the counts are neither read nor written. */
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

/* The robot's grippers move with the robot: the values in their mount do not matter. */
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

/* A turn by `angle` carries a point on the chuck round its own axis, tilted as the station is. */
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

/* The chuck's whole travel is within the sine's range: both ends give a valid pose. */
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

/* A flag that is not set leaves every bit alone, whatever the pose contains. */
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

/* A difference this small is seen in any one entry. */
static void the_slightest_tilt_shows(void **state) {
    static const size_t places[][2] = {{0, 2}, {1, 2}, {2, 0}, {2, 1}, {2, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        wh_machine_t machine = machine_with_two_blades();
        machine.mounts[1].effector_from_gripper.R.m[places[i][0]][places[i][1]] += WH_REAL(2e-7);
        assert_int_equal(wh_machine_validate(&machine), WH_STATUS_NOT_LEVEL);
    }
}

/* Each gripper comes to the point, with its own x along the heading; the plain one by the robot's
 * own inverse. */
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
/* Grippers followed from slice to slice: the poses of wh_machine_grippers, to the last bit,
 * whatever moves and whatever stands still. Grippers that stand still are left alone. */
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

/* Any of the axes move, also to earlier places; now and then only theta and yaw, against each other. */
static void the_poses_are_the_machines(void **state) {
    static const wh_real_t angles[] = {0, WH_REAL(-0.0), 1, WH_REAL(-2.5), WH_PI, -WH_PI};
    wh_real_t axes[WH_AXES] = {0, 300, 900, 0, 0, 0};
    (void)state;
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
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

/* Zeros of different sign are different angles, and NaN is followed as well. */
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

/* Entries beyond the axes in use are no axes. */
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

/* A command that follows a track contains the track's values, and keeps the faults that it is to bring. */
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

/* ------------------------------------------------------------------------------------- robots of other kinds */

static wh_chain_t chain_of(wh_chain_kind_t kind) {
    static const size_t axes[WH_ROBOT_AXES] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    const wh_limits_t limits = {1, 10, 100};
    wh_chain_t chain;
    wh_robot_t robot;
    memset(&chain, 0, sizeof chain);
    wh_robot_default(&robot);
    chain.kind = kind;
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        chain.travel[axes[i]] = robot.travel[i];
        chain.limits[axes[i]] = robot.limits[i];
        chain.home[axes[i]] = robot.home[i];
    }
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        const bool is_tilt = axis == WH_CHAIN_TILT_X || axis == WH_CHAIN_TILT_Y;
        if (is_tilt || axis == WH_CHAIN_RAIL || axis == WH_CHAIN_FLIP) {
            chain.travel[axis].min = axis == WH_CHAIN_RAIL ? -500 : is_tilt ? WH_REAL(-0.1) : -WH_PI;
            chain.travel[axis].max = -chain.travel[axis].min;
            chain.limits[axis] = limits;
        }
    }
    if (kind == WH_CHAIN_SCARA) {
        chain.links[0] = chain.links[1] = 450;
        chain.travel[WH_CHAIN_REACH].min = -3;
        chain.travel[WH_CHAIN_REACH].max = 3;
        chain.home[WH_CHAIN_REACH] = -2;
    }
    return chain;
}

/* The carrier's robot, a gripper on it 20 mm ahead of its end-effector, and one on a chuck after its axes. */
static wh_machine_t machine_with_carrier(wh_carrier_t *carrier, const wh_chain_t *chain) {
    wh_machine_t carried = machine_with_chuck();
    assert_int_equal(wh_carrier_init(carrier, chain), WH_OK);
    wh_machine_take_carrier(&carried, carrier);
    carried.mounts[0].is_shifted = true;
    carried.mounts[0].effector_from_gripper = wh_pose_identity();
    carried.mounts[0].effector_from_gripper.r.x = 20;
    carried.mounts[1].axis = (int32_t)carried.axis_count++;
    assert_int_equal(wh_machine_validate(&carried), WH_OK);
    return carried;
}

static void a_carriers_axes_have_an_order(void **state) {
    (void)state;
    wh_carrier_t carrier;
    wh_chain_t chain = chain_of(WH_CHAIN_SCARA);
    chain.has_rail = chain.has_flip = true;
    chain.home[WH_CHAIN_RAIL] = 7;
    const wh_machine_t carried = machine_with_carrier(&carrier, &chain);
    static const size_t order[] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z,
                                   WH_CHAIN_YAW,   WH_CHAIN_RAIL,  WH_CHAIN_FLIP};
    wh_real_t home[WH_AXES];
    wh_machine_home(&carried, home);
    assert_int_equal(wh_machine_robot_axes(&carried), 6);
    assert_int_equal(carried.axis_count, 7);
    for (size_t axis = 0; axis < 6; ++axis) {
        assert_memory_equal(wh_machine_limits(&carried, axis), &chain.limits[order[axis]],
                            sizeof(wh_limits_t));
        assert_memory_equal(wh_machine_travel(&carried, axis), &chain.travel[order[axis]],
                            sizeof(wh_travel_t));
        assert_near(home[axis], chain.home[order[axis]], 0);
    }
    assert_near(home[6], 0, 0);
    assert_ptr_equal(wh_machine_limits(&carried, 6), &carried.chuck_limits);
    home[4] = 501;
    assert_int_equal(wh_machine_check_travel(&carried, home), WH_STATUS_LIMIT_EXCEEDED);
    home[4] = 500;
    home[6] = WH_CHUCK_TRAVEL + 1;
    assert_int_equal(wh_machine_check_travel(&carried, home), WH_STATUS_LIMIT_EXCEEDED);
}

static void a_bad_chain_makes_no_carrier(void **state) {
    (void)state;
    wh_carrier_t carrier;
    wh_chain_t chain = chain_of(WH_CHAIN_TRZ);
    assert_int_equal(wh_carrier_init(NULL, &chain), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_carrier_init(&carrier, NULL), WH_STATUS_NULL_ARGUMENT);
    chain.limits[WH_CHAIN_Z].jerk = 0;
    assert_int_equal(wh_carrier_init(&carrier, &chain), WH_STATUS_BAD_LIMITS);
}

/* The last gives the poses of wh_machine_grippers, and the inverse leads back to them. */
static void a_carrier_goes_where_it_is_brought(void **state) {
    (void)state;
    static const wh_chain_kind_t kinds[] = {WH_CHAIN_TRZY, WH_CHAIN_TRZ, WH_CHAIN_SCARA};
    for (size_t k = 0; k < 3; ++k) {
        wh_carrier_t carrier;
        wh_chain_t chain = chain_of(kinds[k]);
        chain.has_rail = chain.has_tilt = chain.is_placed = true;
        chain.base_from_robot.R = wh_mat3_from_rpy_deg(0, 0, 35);
        chain.base_from_robot.r = wh_vec3(120, -80, 40);
        const wh_machine_t carried = machine_with_carrier(&carrier, &chain);
        wh_real_t q[WH_AXES] = {WH_REAL(0.4), 500, 950, WH_REAL(0.3), 60, WH_REAL(0.02), WH_REAL(-0.03), 1};
        q[1] = kinds[k] == WH_CHAIN_SCARA ? WH_REAL(-1.1) : q[1];
        q[3] = kinds[k] == WH_CHAIN_TRZ ? 0 : q[3];
        wh_machine_cache_t last = {.is_taken = false};
        wh_gripper_input_t grippers[2];
        wh_pose_t poses[2];
        wh_real_t home[WH_AXES], found[WH_AXES];
        wh_machine_home(&carried, home);
        wh_machine_update(&carried, home, &last, grippers);
        wh_machine_update(&carried, q, &last, grippers);
        wh_machine_grippers(&carried, q, poses);
        assert_memory_equal(&grippers[0].base_from_gripper, &poses[0], sizeof poses[0]);
        assert_memory_equal(&grippers[1].base_from_gripper, &poses[1], sizeof poses[1]);
        const wh_chain_choice_t choice = {60, 0, WH_ELBOW_LEFT};
        assert_int_equal(wh_machine_bring(&carried, 0, &poses[0], &choice, home, found), WH_OK);
        for (size_t axis = 0; axis < 7; ++axis) {
            assert_near(found[axis], q[axis], 1e6 * WH_TEST_ROUNDING);
        }
    }
}

/* Turned over about an axis 5 mm above its contact plane the gripper hangs 10 mm higher, face down.
 * It is brought to a point with the flip unchanged, and its lines are straight there, too. */
static void a_flip_is_held(void **state) {
    (void)state;
    static const wh_chain_kind_t kinds[] = {WH_CHAIN_TRZY, WH_CHAIN_TRZ, WH_CHAIN_SCARA};
    for (size_t k = 0; k < 3; ++k) {
        wh_carrier_t carrier;
        wh_chain_t chain = chain_of(kinds[k]);
        chain.has_flip = true;
        chain.flip_height = 5;
        const wh_machine_t carried = machine_with_carrier(&carrier, &chain);
        wh_real_t q[WH_AXES], found[WH_AXES];
        wh_pose_t up[2], down[2];
        wh_machine_home(&carried, q);
        q[0] = WH_REAL(0.7);
        wh_machine_grippers(&carried, q, up);
        q[4] = WH_PI;
        wh_machine_grippers(&carried, q, down);
        assert_near(down[0].r.x, up[0].r.x, 1e4 * WH_TEST_ROUNDING);
        assert_near(down[0].r.y, up[0].r.y, 1e4 * WH_TEST_ROUNDING);
        assert_near(down[0].r.z, up[0].r.z + 10, 1e4 * WH_TEST_ROUNDING);
        assert_near(down[0].R.m[2][2], -1, 10 * WH_TEST_ROUNDING);
        const wh_real_t heading = wh_atan2(down[0].R.m[1][0], down[0].R.m[0][0]);
        assert_int_equal(wh_machine_inverse(&carried, 0, &down[0].r, heading, q, found), WH_OK);
        for (size_t axis = 0; axis < 5; ++axis) {
            assert_near(found[axis], q[axis], 1e6 * WH_TEST_ROUNDING);
        }
        const wh_vec3_t ahead = wh_mat3_column(&down[0].R, 0);
        const wh_vec3_t travel = wh_vec3_scale(kinds[k] == WH_CHAIN_SCARA ? 50 : 120, &ahead);
        wh_track_t track;
        wh_pose_t at[2];
        assert_int_equal(wh_track_init(&track, &carried, 1000), WH_OK);
        memcpy(track.axes, q, sizeof q);
        wh_segment_t line = wh_track_blank(&track);
        line.kind = WH_SEGMENT_LINE;
        line.travel = travel;
        assert_int_equal(wh_track_begin(&track, &line), WH_OK);
        wh_track_skip(&track);
        assert_near(track.axes[4], WH_PI, 0);
        wh_machine_grippers(&carried, track.axes, at);
        const wh_vec3_t gone = wh_vec3_subtract(&at[0].r, &down[0].r);
        const wh_vec3_t off = wh_vec3_subtract(&gone, &travel);
        assert_true(wh_vec3_norm(&off) < 1e6 * WH_TEST_ROUNDING);
    }
}

/* The second gripper moves 60 mm ahead, in a line from its place at these axes; the axis `still`
 * does not move. */
static void go_ahead(wh_track_t *track, const wh_machine_t *carried, const wh_real_t q[],
                     const wh_pose_t *from, size_t still) {
    wh_pose_t again[2];
    const wh_vec3_t ahead = wh_mat3_column(&from->R, 0);
    assert_int_equal(wh_track_init(track, carried, 1000), WH_OK);
    memcpy(track->axes, q, sizeof track->axes);
    wh_segment_t line = wh_track_blank(track);
    line.kind = WH_SEGMENT_LINE;
    line.gripper = 1;
    line.travel = wh_vec3_scale(60, &ahead);
    assert_int_equal(wh_track_begin(track, &line), WH_OK);
    while (wh_track_next(track, 0) == WH_TRACK_MOVING) {
        wh_machine_grippers(carried, track->axes, again);
        const wh_vec3_t gone = wh_vec3_subtract(&again[1].r, &from->r);
        const wh_vec3_t off = wh_vec3_cross(&gone, &ahead);
        assert_true(wh_vec3_norm(&off) < 1e6 * WH_TEST_ROUNDING);
        assert_near(track->axes[still], q[still], 0);
    }
    const wh_vec3_t gone = wh_vec3_subtract(&again[1].r, &from->r);
    assert_near(wh_vec3_dot(&gone, &ahead), 60, 1e6 * WH_TEST_ROUNDING);
    line.gripper = 2;
    assert_int_equal(wh_track_begin(track, &line), WH_STATUS_BAD_SEGMENT);
}

/* Two arms of a TRZ, opposite to each other, and two wrists of a SCARA. Each gripper is brought by
 * its own arm and follows its own lines, while the other arm's own axis stands still. */
static void a_second_arm_goes_its_own_way(void **state) {
    (void)state;
    static const wh_chain_kind_t kinds[] = {WH_CHAIN_TRZ, WH_CHAIN_SCARA};
    for (size_t k = 0; k < 2; ++k) {
        const size_t still = kinds[k] == WH_CHAIN_TRZ ? 1 : 3;
        wh_carrier_t carrier, second;
        wh_chain_t chain = chain_of(kinds[k]);
        chain.has_rail = true;
        wh_machine_t carried = machine_with_carrier(&carrier, &chain);
        assert_int_equal(wh_carrier_add(&carrier, &second, kinds[k] == WH_CHAIN_TRZ ? WH_PI : 1, 12), WH_OK);
        wh_machine_take_carrier(&carried, &carrier);
        carried.mounts[1] = carried.mounts[0];
        carried.mounts[1].arm = 1;
        assert_int_equal(wh_machine_validate(&carried), WH_OK);
        assert_int_equal(carried.axis_count, 6);
        assert_ptr_equal(wh_machine_travel(&carried, 5),
                         &second.chain.travel[kinds[k] == WH_CHAIN_TRZ ? WH_CHAIN_REACH : WH_CHAIN_YAW]);
        wh_real_t home[WH_AXES], q[WH_AXES], found[WH_AXES];
        wh_pose_t poses[2];
        wh_gripper_input_t updated[2];
        wh_machine_cache_t last = {.is_taken = false};
        wh_machine_home(&carried, home);
        memcpy(q, home, sizeof q);
        q[0] = WH_REAL(0.3);
        q[4] = 40;
        q[5] += kinds[k] == WH_CHAIN_TRZ ? 150 : WH_REAL(0.5);
        wh_machine_grippers(&carried, q, poses);
        assert_near(poses[1].r.z, poses[0].r.z + 12, 1e4 * WH_TEST_ROUNDING);
        wh_machine_update(&carried, home, &last, updated);
        wh_machine_update(&carried, q, &last, updated);
        assert_memory_equal(&updated[1].base_from_gripper, &poses[1], sizeof poses[1]);
        const wh_chain_choice_t choice = {40, 0, WH_ELBOW_NEAR};
        memcpy(found, home, sizeof found);
        assert_int_equal(wh_machine_bring(&carried, 1, &poses[1], &choice, home, found), WH_OK);
        assert_near(found[5], q[5], 1e6 * WH_TEST_ROUNDING);
        assert_near(found[still], home[still], 0);
        wh_track_t track;
        go_ahead(&track, &carried, q, &poses[1], still);
        track.axes[5] = 1e6;
        assert_int_not_equal(wh_machine_check_travel(&carried, track.axes), WH_OK);
        carried.mounts[1].arm = 2;
        assert_int_equal(wh_machine_validate(&carried), WH_STATUS_OUT_OF_RANGE);
    }
}

static void a_second_arm_is_of_some_kinds(void **state) {
    (void)state;
    wh_carrier_t carrier, second;
    wh_chain_t chain = chain_of(WH_CHAIN_TRZY);
    assert_int_equal(wh_carrier_init(&carrier, &chain), WH_OK);
    assert_int_equal(wh_carrier_add(&carrier, NULL, 0, 0), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_carrier_add(NULL, &second, 0, 0), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_carrier_add(&carrier, &second, 0, 0), WH_STATUS_OUT_OF_RANGE);
    chain = chain_of(WH_CHAIN_SCARA);
    assert_int_equal(wh_carrier_init(&carrier, &chain), WH_OK);
    assert_int_equal(wh_carrier_add(&carrier, &second, 100, 0), WH_STATUS_BAD_LIMITS);
    assert_null(carrier.second);
    assert_int_equal(carrier.axis_count, 4);
    assert_int_equal(wh_carrier_add(&carrier, &second, 1, 0), WH_OK);
    assert_int_equal(wh_carrier_add(&carrier, &second, 1, 0), WH_STATUS_OUT_OF_RANGE);
}

/* Worked out by hand: a station at (700, 250, 900), rolled by 1.5 degrees, entered over 300 mm. */
static void a_tilting_robot_comes_in_the_stations_own_plane(void **state) {
    (void)state;
    wh_carrier_t carrier;
    wh_chain_t chain = chain_of(WH_CHAIN_TRZY);
    chain.has_tilt = true;
    wh_machine_t carried = machine_with_carrier(&carrier, &chain);
    carried.mounts[0].is_shifted = false;
    const wh_chain_choice_t choice = {0, 0, WH_ELBOW_NEAR};
    static const double expected[2][3] = {{32.0142, 471.74, 893.4535}, {19.6600, 743.33, 893.4535}};
    wh_real_t q[WH_AXES];
    wh_machine_home(&carried, q);
    for (int end = 0; end < 2; ++end) {
        const wh_pose_t slot = {wh_mat3_from_rpy_deg(WH_REAL(1.5), 0, 0), {end == 0 ? 400 : 700, 250, 900}};
        assert_int_equal(wh_machine_bring(&carried, 0, &slot, &choice, q, q), WH_OK);
        assert_near(wh_deg_from_rad(q[WH_AXIS_THETA]), expected[end][0], 1e-3);
        assert_near(q[WH_AXIS_R], expected[end][1], 1e-2);
        assert_near(q[WH_AXIS_Z], expected[end][2], 1e-3);
        assert_near(q[WH_AXIS_YAW], -q[WH_AXIS_THETA], 1e-5);
        assert_near(wh_deg_from_rad(q[4]), 1.5, 1e-4);
        assert_near(q[5], 0, 1e-6);
    }
}

/* A track plays lines of each kind: on the way the gripper stays on the line, and its heading stays. */
static void a_track_plays_a_carriers_lines(void **state) {
    (void)state;
    static const wh_chain_kind_t kinds[] = {WH_CHAIN_TRZY, WH_CHAIN_TRZ, WH_CHAIN_SCARA};
    for (size_t k = 0; k < 3; ++k) {
        wh_carrier_t carrier;
        wh_chain_t chain = chain_of(kinds[k]);
        chain.has_rail = true;
        const wh_machine_t carried = machine_with_carrier(&carrier, &chain);
        wh_track_t track;
        wh_pose_t begin[2], poses[2];
        assert_int_equal(wh_track_init(&track, &carried, 1000), WH_OK);
        wh_track_take_ways(&track);
        wh_machine_grippers(&carried, track.axes, begin);
        wh_segment_t segment = wh_track_blank(&track);
        segment.kind = WH_SEGMENT_LINE;
        segment.travel = wh_vec3(100, kinds[k] == WH_CHAIN_TRZ ? 0 : 40, 10);
        assert_int_equal(wh_track_begin(&track, &segment), WH_OK);
        int slices = 0;
        while (wh_track_next(&track, 0) == WH_TRACK_MOVING) {
            wh_machine_grippers(&carried, track.axes, poses);
            const wh_vec3_t gone = wh_vec3_subtract(&poses[0].r, &begin[0].r);
            const wh_real_t share = gone.x / 100;
            assert_near(gone.y, share * segment.travel.y, 1e7 * WH_TEST_ROUNDING);
            assert_near(gone.z, share * segment.travel.z, 1e7 * WH_TEST_ROUNDING);
            assert_near(poses[0].R.m[1][0], begin[0].R.m[1][0], 1e4 * WH_TEST_ROUNDING);
            ++slices;
        }
        assert_true(slices > 50);
        assert_near(poses[0].r.x, begin[0].r.x + 100, 1e7 * WH_TEST_ROUNDING);
        segment = wh_track_blank(&track);
        segment.kind = WH_SEGMENT_WAY;
        segment.reach = 500;
        segment.target[WH_AXIS_THETA] += WH_REAL(0.5);
        segment.target[4] += 10; /* the rail moves with it */
        assert_int_equal(wh_track_begin(&track, &segment),
                         kinds[k] == WH_CHAIN_SCARA ? WH_STATUS_BAD_SEGMENT : WH_OK);
        segment.kind = WH_SEGMENT_LINE;
        segment.travel = wh_vec3(0, 0, 1000);
        assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_LIMIT_EXCEEDED);
        segment.travel = wh_vec3(0, 50, 0);
        assert_int_equal(wh_track_begin(&track, &segment),
                         kinds[k] == WH_CHAIN_TRZ ? WH_STATUS_NOT_ALONG_ARM : WH_OK);
    }
}

/* A SCARA at (0, 0) and a polar arm without wrist at (1500, 200), a gripper on each, and no chuck. */
static wh_machine_t machine_with_two(wh_carrier_t carriers[2]) {
    wh_machine_t two = machine_with_chuck();
    wh_chain_t chain = chain_of(WH_CHAIN_SCARA);
    assert_int_equal(wh_carrier_init(&carriers[0], &chain), WH_OK);
    chain = chain_of(WH_CHAIN_TRZ);
    chain.is_placed = true;
    chain.base_from_robot.R = wh_mat3_from_rpy_deg(0, 0, 180);
    chain.base_from_robot.r = wh_vec3(1500, 200, 0);
    chain.home[WH_CHAIN_REACH] = 444;
    assert_int_equal(wh_carrier_init(&carriers[1], &chain), WH_OK);
    carriers[0].next = &carriers[1];
    wh_machine_take_carrier(&two, carriers);
    two.mounts[1] = two.mounts[0];
    two.mounts[1].robot = 1;
    assert_int_equal(wh_machine_validate(&two), WH_OK);
    return two;
}

static void several_robots_have_axes_one_after_another(void **state) {
    (void)state;
    wh_carrier_t carriers[2];
    wh_machine_t two = machine_with_two(carriers);
    wh_real_t q[WH_AXES];
    size_t first, own = 99;
    assert_int_equal(two.axis_count, 8);
    assert_int_equal(wh_machine_robot_axes(&two), 8);
    assert_int_equal(wh_machine_robots(&two), 2);
    assert_ptr_equal(wh_machine_carrier(&two, 1, &first), &carriers[1]);
    assert_int_equal(first, 4);
    assert_int_equal(wh_machine_robot_of(&two, 3, &own), 0);
    assert_int_equal(own, 3);
    assert_int_equal(wh_machine_robot_of(&two, 5, &own), 1);
    assert_int_equal(own, 1);
    assert_int_equal(wh_machine_robot_of(&two, 8, &own), WH_NONE);
    assert_int_equal(own, 1);
    assert_ptr_equal(wh_machine_limits(&two, 5), &carriers[1].chain.limits[WH_CHAIN_REACH]);
    assert_ptr_equal(wh_machine_travel(&two, 5), &carriers[1].chain.travel[WH_CHAIN_REACH]);
    assert_null(wh_machine_travel(&two, 8));
    assert_ptr_equal(wh_machine_limits(&two, 8), &two.chuck_limits);
    wh_machine_home(&two, q);
    assert_near(q[1], -2, 0);
    assert_near(q[5], 444, 0);
    assert_int_equal(wh_machine_check_travel(&two, q), WH_OK);
    q[5] = 99999;
    assert_int_equal(wh_machine_check_travel(&two, q), WH_STATUS_OUT_OF_REACH);
    two.mounts[0].robot = 2;
    assert_int_equal(wh_machine_validate(&two), WH_STATUS_OUT_OF_RANGE);
    two.mounts[0].robot = 0;
    two.axis_count = 7;
    assert_int_equal(wh_machine_validate(&two), WH_STATUS_OUT_OF_RANGE);
}

/* A motion of one robot leaves the other's grippers and axes unchanged, to the last bit. */
static void each_robot_goes_by_itself(void **state) {
    (void)state;
    wh_carrier_t carriers[2];
    const wh_machine_t two = machine_with_two(carriers);
    wh_real_t home[WH_AXES], q[WH_AXES], found[WH_AXES];
    wh_machine_cache_t last = {.is_taken = false};
    wh_gripper_input_t grippers[2];
    wh_pose_t poses[2], effector;
    wh_machine_home(&two, home);
    wh_machine_update(&two, home, &last, grippers);
    wh_machine_grippers(&two, home, poses);
    assert_near(poses[1].r.x, 1500 - 444, 1e3 * WH_TEST_ROUNDING);
    memcpy(q, home, sizeof q);
    q[4] += WH_REAL(0.25);
    q[5] += 30;
    memset(&grippers[0], 0x55, sizeof grippers[0]); /* it must not be written */
    const wh_gripper_input_t untouched = grippers[0];
    wh_machine_update(&two, q, &last, grippers);
    wh_machine_grippers(&two, q, poses);
    wh_machine_effector(&two, 1, q, &effector);
    assert_memory_equal(&grippers[0], &untouched, sizeof untouched);
    assert_memory_equal(&grippers[1].base_from_gripper, &poses[1], sizeof poses[1]);
    assert_memory_equal(&effector, &poses[1], sizeof effector);
    const wh_chain_choice_t choice = {0, 0, WH_ELBOW_NEAR};
    memcpy(found, home, sizeof found);
    assert_int_equal(wh_machine_bring(&two, 1, &poses[1], &choice, home, found), WH_OK);
    assert_memory_equal(found, home, 4 * sizeof found[0]);
    for (size_t axis = 4; axis < 8; ++axis) {
        assert_near(found[axis], q[axis], 1e6 * WH_TEST_ROUNDING);
    }
    const wh_real_t heading = wh_atan2(poses[1].R.m[1][0], poses[1].R.m[0][0]);
    assert_int_equal(wh_machine_inverse(&two, 1, &poses[1].r, heading, home, found), WH_OK);
    assert_near(found[5], q[5], 1e6 * WH_TEST_ROUNDING);
    assert_memory_equal(found, home, 4 * sizeof found[0]);
}

/* Plays a segment; the four axes of the other robot, from `from` on, stay. */
static void play_alone(wh_track_t *track, const wh_segment_t *segment, size_t from) {
    wh_real_t before[WH_AXES];
    memcpy(before, track->axes, sizeof before);
    assert_int_equal(wh_track_begin(track, segment), WH_OK);
    while (wh_track_next(track, 0) == WH_TRACK_MOVING) {
        assert_memory_equal(&track->axes[from], &before[from], 4 * sizeof before[0]);
    }
}

static void a_track_moves_the_robot_that_is_named(void **state) {
    (void)state;
    wh_carrier_t carriers[2];
    const wh_machine_t two = machine_with_two(carriers);
    wh_track_t track;
    wh_pose_t begin[2], poses[2];
    assert_int_equal(wh_track_init(&track, &two, 1000), WH_OK);
    wh_track_take_ways(&track);
    wh_machine_grippers(&two, track.axes, begin);
    wh_segment_t segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_LINE;
    segment.travel = wh_vec3(-100, 0, 10); /* straight out: the arm without wrist looks along -x */
    segment.gripper = 1;
    play_alone(&track, &segment, 0);
    wh_machine_grippers(&two, track.axes, poses);
    assert_near(poses[1].r.x, begin[1].r.x - 100, 1e7 * WH_TEST_ROUNDING);
    assert_near(poses[1].r.z, begin[1].r.z + 10, 1e7 * WH_TEST_ROUNDING);
    segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_LINE;
    segment.travel = wh_vec3(50, 20, 0); /* without a name it is the first one */
    play_alone(&track, &segment, 4);
    wh_machine_grippers(&two, track.axes, poses);
    assert_near(poses[0].r.y, begin[0].r.y + 20, 1e7 * WH_TEST_ROUNDING);
    segment = wh_track_blank(&track);
    segment.kind = WH_SEGMENT_WAY;
    segment.gripper = 1;
    segment.reach = 500;
    segment.target[4] += 1;
    play_alone(&track, &segment, 0);
    assert_memory_equal(track.axes, segment.target, 8 * sizeof track.axes[0]);
    segment.target[0] += 1; /* the other one's */
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_BAD_SEGMENT);
    segment.gripper = WH_NONE; /* a SCARA takes no ways */
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_BAD_SEGMENT);
    segment.kind = WH_SEGMENT_LINE;
    segment.gripper = 2;
    assert_int_equal(wh_track_begin(&track, &segment), WH_STATUS_BAD_SEGMENT);
}

/* Doors have the last axes: their travel, limits and homes are their own. */
static void doors_have_the_last_axes(void **state) {
    (void)state;
    wh_door_t doors[2] = {{{0, 0, 1}, 100, false, {200, 800, 8000}}, {{1, 0, 0}, 50, true, {20, 80, 800}}};
    wh_machine_t cell = machine_with_chuck();
    wh_real_t axes[WH_AXES];
    cell.axis_count = 7;
    cell.doors = doors;
    cell.door_count = 2;
    assert_int_equal(wh_machine_validate(&cell), WH_OK);
    assert_int_equal(wh_machine_door_axis(&cell, 1), 6);
    assert_true(wh_machine_limits(&cell, 6) == &doors[1].limits);
    wh_machine_home(&cell, axes);
    assert_near(axes[5], 0, 0);
    assert_near(axes[6], 50, 0);
    assert_int_equal(wh_machine_check_travel(&cell, axes), WH_OK);
    axes[6] = WH_REAL(50.1);
    assert_int_equal(wh_machine_check_travel(&cell, axes), WH_STATUS_LIMIT_EXCEEDED);
    doors[0].way.x = 1;
    assert_int_equal(wh_machine_validate(&cell), WH_STATUS_BAD_LIMITS);
    doors[0].way.x = (wh_real_t)NAN;
    assert_int_equal(wh_machine_validate(&cell), WH_STATUS_NOT_FINITE);
    cell.doors = NULL;
    assert_int_equal(wh_machine_validate(&cell), WH_STATUS_NULL_ARGUMENT);
    cell.door_count = 4;
    assert_int_equal(wh_machine_validate(&cell), WH_STATUS_OUT_OF_RANGE);
    cell.doors = doors;
    cell.door_count = 3; /* the chuck's axis would be one of theirs */
    assert_int_not_equal(wh_machine_validate(&cell), WH_OK);
}

/* A flipper turns about x through `height`: half a turn brings its plane to twice the height,
 * upside down, and back again to the same bits. */
static void a_flipper_turns_about_the_middle_of_a_wafer(void **state) {
    (void)state;
    wh_machine_t cell = machine_with_chuck();
    wh_real_t axes[WH_AXES];
    wh_pose_t flat[2], over[2], again[2];
    cell.mounts[1].kind = WH_MOUNT_FLIPPER;
    cell.mounts[1].travel.max = WH_PI;
    cell.mounts[1].limits = cell.chuck_limits;
    cell.mounts[1].height = WH_REAL(0.3875);
    assert_int_equal(wh_machine_validate(&cell), WH_OK);
    wh_machine_home(&cell, axes);
    wh_machine_grippers(&cell, axes, flat);
    axes[4] = WH_PI;
    assert_int_equal(wh_machine_check_travel(&cell, axes), WH_OK);
    wh_machine_grippers(&cell, axes, over);
    axes[4] = 0;
    wh_machine_grippers(&cell, axes, again);
    assert_memory_equal(&again[1], &flat[1], sizeof flat[1]);
    assert_near(over[1].r.z - flat[1].r.z, 0.775, 1e-4);
    assert_near(over[1].r.x - flat[1].r.x, 0, 1e-4);
    assert_near(over[1].r.y - flat[1].r.y, 0, 1e-4);
    assert_near(over[1].R.m[2][2], -1, 1e-6);
    assert_near(over[1].R.m[0][0], flat[1].R.m[0][0], 1e-6);
    axes[4] = 4;
    assert_int_equal(wh_machine_check_travel(&cell, axes), WH_STATUS_LIMIT_EXCEEDED);
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
        cmocka_unit_test(a_stage_shifts_its_chuck_and_pins_go_up),
        cmocka_unit_test(stages_and_pins_have_limits_of_their_own),
        cmocka_unit_test(a_stage_or_pins_that_cannot_be_are_refused),
        cmocka_unit_test(a_chuck_that_stands_nowhere_is_refused),
        cmocka_unit_test(the_robots_mount_is_not_looked_at),
        cmocka_unit_test(bad_limits_are_refused),
        cmocka_unit_test(each_axis_has_its_own_limits),
        cmocka_unit_test(travel_is_checked_on_every_axis),
        cmocka_unit_test(the_robots_gripper_is_the_robots_effector),
        cmocka_unit_test(a_chuck_turns_about_its_own_z),
        cmocka_unit_test(a_chuck_has_a_pose_over_its_whole_travel),
        cmocka_unit_test(a_carriers_axes_have_an_order),
        cmocka_unit_test(a_bad_chain_makes_no_carrier),
        cmocka_unit_test(a_carrier_goes_where_it_is_brought),
        cmocka_unit_test(a_flip_is_held),
        cmocka_unit_test(a_second_arm_goes_its_own_way),
        cmocka_unit_test(a_second_arm_is_of_some_kinds),
        cmocka_unit_test(a_tilting_robot_comes_in_the_stations_own_plane),
        cmocka_unit_test(a_track_plays_a_carriers_lines),
        cmocka_unit_test(several_robots_have_axes_one_after_another),
        cmocka_unit_test(each_robot_goes_by_itself),
        cmocka_unit_test(a_track_moves_the_robot_that_is_named),
        cmocka_unit_test_setup(the_poses_are_the_machines, set_up),
        cmocka_unit_test_setup(the_bits_decide, set_up),
        cmocka_unit_test_setup(what_stands_still_is_not_written, set_up),
        cmocka_unit_test_setup(the_axes_beyond_the_last_are_left_alone, set_up),
        cmocka_unit_test_setup(a_command_follows_a_track, set_up),
        cmocka_unit_test(doors_have_the_last_axes),
        cmocka_unit_test(a_flipper_turns_about_the_middle_of_a_wafer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
