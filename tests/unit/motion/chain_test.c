/* Chains: the poses of the textbook, the refusals with their reasons, and lines to places that a
 * chain can reach. */
#include "math/trig.h"
#include "motion/chain_line.h"
#include "support/pose.h"

#if defined(WH_FLOAT)
#define MM 1e-3
#define RAD 1e-6
#else
#define MM 1e-9
#define RAD 1e-12
#endif

#define DEG(d) wh_rad_from_deg((wh_real_t)(d))

static void set_axis(wh_chain_t *chain, size_t axis, wh_real_t min, wh_real_t max, wh_real_t speed) {
    const wh_travel_t travel = {min, max};
    const wh_limits_t limits = {speed, 5 * speed, 50 * speed};
    chain->travel[axis] = travel;
    chain->limits[axis] = limits;
    chain->home[axis] = wh_chain_has(chain, axis) ? (min + max) / 2 : 0;
}

/* A chain of a kind, with rail, tilt and flip if `everything`. */
static wh_chain_t chain_of(wh_chain_kind_t kind, bool everything) {
    wh_chain_t chain;
    memset(&chain, 0, sizeof chain);
    chain.kind = kind;
    chain.has_rail = chain.has_tilt = chain.has_flip = everything;
    chain.links[0] = chain.links[1] = 300;
    set_axis(&chain, WH_CHAIN_RAIL, -1000, 1000, 800);
    set_axis(&chain, WH_CHAIN_Z, 600, 1300, 400);
    set_axis(&chain, WH_CHAIN_TILT_X, DEG(-3), DEG(3), WH_REAL(0.1));
    set_axis(&chain, WH_CHAIN_TILT_Y, DEG(-3), DEG(3), WH_REAL(0.1));
    set_axis(&chain, WH_CHAIN_THETA, DEG(-540), DEG(540), 5);
    set_axis(&chain, WH_CHAIN_REACH, 300, 900, 1000);
    if (kind == WH_CHAIN_SCARA) {
        set_axis(&chain, WH_CHAIN_REACH, DEG(-175), DEG(175), 5);
    }
    set_axis(&chain, WH_CHAIN_YAW, DEG(-540), DEG(540), 6);
    set_axis(&chain, WH_CHAIN_FLIP, DEG(-185), DEG(185), 3);
    assert_int_equal(wh_chain_validate(&chain), WH_OK);
    return chain;
}

static wh_pose_t level(double x, double y, double z, double heading_deg) {
    return wh_test_pose(wh_mat3_about_z(DEG(heading_deg)), x, y, z);
}

/* Any TRZY chain that stands at the origin is the robot of motion/robot.h, also for its lines. */
static void a_plain_chain_is_the_robot(void **state) {
    (void)state;
    static const size_t axes[] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    const wh_chain_t chain = chain_of(WH_CHAIN_TRZY, false);
    wh_robot_t robot;
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        robot.travel[i] = chain.travel[axes[i]];
        robot.limits[i] = chain.limits[axes[i]];
        robot.home[i] = chain.home[axes[i]];
    }
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        wh_real_t q[WH_CHAIN_AXES] = {0};
        wh_real_t four[WH_ROBOT_AXES];
        for (size_t k = 0; k < WH_ROBOT_AXES; ++k) {
            four[k] = q[axes[k]] =
                WH_REAL(wh_test_uniform((double)robot.travel[k].min, (double)robot.travel[k].max));
        }
        wh_pose_t pose;
        wh_pose_t want;
        wh_chain_forward(&chain, q, &pose);
        wh_robot_forward(four, &want);
        assert_true(wh_test_difference_r(&pose, &want) == 0 && wh_test_difference_R(&pose, &want) == 0);
        const wh_vec3_t step =
            wh_vec3(WH_REAL(wh_test_uniform(-300, 300)), WH_REAL(wh_test_uniform(-300, 300)),
                    WH_REAL(wh_test_uniform(-30, 30)));
        const wh_line_caps_t caps = {0, 2000};
        wh_chain_line_t line;
        wh_line_t own;
        const wh_status_t status = wh_chain_line_plan(&line, &chain, q, &step, &caps);
        assert_int_equal(status, wh_line_plan_capped(&own, &robot, four, &step, &caps));
        if (status == WH_OK) {
            assert_memory_equal(&line.path.path, &own.path, sizeof own.path);
            wh_chain_line_at(&line, wh_line_duration(&own) / 3, q);
            wh_line_at(&own, wh_line_duration(&own) / 3, four);
            for (size_t k = 0; k < WH_ROBOT_AXES; ++k) {
                assert_true(q[axes[k]] == four[k]);
            }
        }
    }
}

/* A station at (700, 250, 900) that leans by 1.5 degrees about x, entered over 300 mm: Z stands
 * still, theta and R follow. */
static void a_tilting_robot_serves_a_tilted_station(void **state) {
    (void)state;
    wh_chain_t chain = chain_of(WH_CHAIN_TRZY, false);
    chain.has_tilt = true;
    const wh_pose_t station = wh_test_pose(wh_mat3_from_rpy_deg(WH_REAL(1.5), 0, 0), 700, 250, 900);
    const wh_vec3_t back = wh_vec3(-300, 0, 0);
    wh_pose_t door = station;
    door.r = wh_vec3_add(&station.r, &back);
    const wh_chain_choice_t choice = {0, 0, WH_ELBOW_NEAR};
    const wh_real_t at_rest[WH_CHAIN_AXES] = {0};
    wh_real_t q[WH_CHAIN_AXES];
    assert_int_equal(wh_chain_inverse(&chain, &door, &choice, at_rest, q), WH_OK);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_TILT_X]), 1.5, 1e-5);
    assert_near((double)q[WH_CHAIN_TILT_Y], 0, RAD);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_THETA]), 32.0142, 5e-5);
    assert_near((double)q[WH_CHAIN_REACH], 471.74, 5e-3);
    assert_near((double)q[WH_CHAIN_Z], 893.4535, 1e-4);
    const wh_vec3_t entry = wh_vec3(300, 0, 0);
    const wh_line_caps_t caps = {0, 0};
    wh_chain_line_t line;
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &entry, &caps), WH_OK);
    for (int k = 0; k <= 10; ++k) {
        wh_chain_line_at(&line, wh_chain_line_duration(&line) * (wh_real_t)k / 10, q);
        assert_near((double)q[WH_CHAIN_Z], 893.4535, 1e-4);
        assert_near((double)(q[WH_CHAIN_YAW] + q[WH_CHAIN_THETA]), 0, 10 * RAD);
    }
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_THETA]), 19.6600, 5e-5);
    assert_near((double)q[WH_CHAIN_REACH], 743.33, 5e-3);
    wh_pose_t pose;
    wh_chain_forward(&chain, q, &pose);
    assert_true(wh_test_difference_r(&pose, &station) < MM && wh_test_difference_R(&pose, &station) < RAD);
    chain.has_tilt = false;
    assert_int_equal(wh_chain_inverse(&chain, &station, &choice, at_rest, q), WH_STATUS_NOT_LEVEL);
}

/* Two flips restore the pose; one turns the contact plane over, at twice the axis's height. */
static void a_flip_turns_the_blade_over(void **state) {
    (void)state;
    wh_chain_t chain = chain_of(WH_CHAIN_TRZY, false);
    chain.has_flip = true;
    chain.flip_height = 12;
    wh_real_t q[WH_CHAIN_AXES] = {0};
    q[WH_CHAIN_REACH] = 500;
    q[WH_CHAIN_Z] = 900;
    wh_pose_t before;
    wh_pose_t over;
    wh_pose_t after;
    wh_chain_forward(&chain, q, &before);
    q[WH_CHAIN_FLIP] = WH_PI;
    wh_chain_forward(&chain, q, &over);
    assert_near((double)over.r.z, 924, MM);
    assert_near((double)over.R.m[2][2], -1, RAD);
    assert_near((double)over.R.m[0][0], 1, RAD);
    wh_real_t found[WH_CHAIN_AXES];
    const wh_chain_choice_t choice = {0, WH_PI, WH_ELBOW_NEAR};
    assert_int_equal(wh_chain_inverse(&chain, &over, &choice, q, found), WH_OK);
    assert_near((double)found[WH_CHAIN_REACH], 500, MM);
    q[WH_CHAIN_FLIP] = 2 * WH_PI;
    wh_chain_forward(&chain, q, &after);
    assert_true(wh_test_difference_r(&before, &after) < MM && wh_test_difference_R(&before, &after) < RAD);
}

/* The second arm of two points backward, 10 mm higher. */
static void an_arm_of_two_points_its_own_way(void **state) {
    (void)state;
    wh_chain_t chain = chain_of(WH_CHAIN_TRZ, false);
    chain.arm_heading = WH_PI;
    chain.height = 10;
    const wh_chain_choice_t choice = {0, 0, WH_ELBOW_NEAR};
    const wh_real_t at_rest[WH_CHAIN_AXES] = {0};
    wh_real_t q[WH_CHAIN_AXES];
    const wh_pose_t ahead = level(0, 500, 900, 90);
    assert_int_equal(wh_chain_inverse(&chain, &ahead, &choice, at_rest, q), WH_OK);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_THETA]), -90, 1e-4);
    assert_near((double)q[WH_CHAIN_Z], 890, MM);
    const wh_pose_t askew = level(0, 500, 900, 91);
    assert_int_equal(wh_chain_inverse(&chain, &askew, &choice, at_rest, q), WH_STATUS_NOT_ALONG_ARM);
    assert_near((double)q[WH_CHAIN_Z], 890, MM);
    const wh_line_caps_t caps = {0, 0};
    const wh_vec3_t in = wh_vec3(0, 200, 5);
    const wh_vec3_t aside = wh_vec3(1, 200, 5);
    wh_chain_line_t line;
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &aside, &caps), WH_STATUS_NOT_ALONG_ARM);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &in, &caps), WH_OK);
    const wh_real_t theta = q[WH_CHAIN_THETA];
    wh_chain_line_at(&line, wh_chain_line_duration(&line) / 3, q);
    assert_true(q[WH_CHAIN_THETA] == theta && q[WH_CHAIN_YAW] == 0);
    wh_chain_line_at(&line, wh_chain_line_duration(&line), q);
    assert_near((double)q[WH_CHAIN_REACH], 700, MM);
    assert_near((double)q[WH_CHAIN_Z], 895, MM);
}

/* Links of 300 mm that reach 300 * sqrt(2): the elbow is bent by a right angle, to one side or the other. */
static void an_elbow_has_two_sides(void **state) {
    (void)state;
    const wh_chain_t chain = chain_of(WH_CHAIN_SCARA, false);
    const wh_pose_t pose = level(300 * sqrt(2.0), 0, 900, 0);
    wh_real_t near_q[WH_CHAIN_AXES] = {0};
    wh_real_t q[WH_CHAIN_AXES];
    wh_chain_choice_t choice = {0, 0, WH_ELBOW_LEFT};
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, near_q, q), WH_OK);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_REACH]), -90, 1e-4);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_THETA]), 45, 1e-4);
    choice.elbow = WH_ELBOW_RIGHT;
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, near_q, q), WH_OK);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_REACH]), 90, 1e-4);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_YAW]), -45, 1e-4);
    choice.elbow = WH_ELBOW_NEAR;
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, q, q), WH_OK);
    assert_near((double)wh_deg_from_rad(q[WH_CHAIN_REACH]), 90, 1e-4);
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, near_q, q), WH_OK);
    assert_true(q[WH_CHAIN_REACH] < 0);
    choice.elbow = (wh_elbow_t)3;
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, near_q, q), WH_STATUS_OUT_OF_RANGE);
}

static void a_scara_line_stays_bent(void **state) {
    (void)state;
    wh_chain_t chain = chain_of(WH_CHAIN_SCARA, false);
    const wh_pose_t pose = level(400, 0, 900, 0);
    const wh_chain_choice_t choice = {0, 0, WH_ELBOW_LEFT};
    const wh_line_caps_t caps = {0, 0};
    wh_real_t q[WH_CHAIN_AXES] = {0};
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, q, q), WH_OK);
    wh_chain_line_t line;
    memset(&line, 0x5a, sizeof line);
    const wh_chain_line_t untouched = line;
    const wh_vec3_t too_far = wh_vec3(201, 0, 0);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &too_far, &caps), WH_STATUS_OUT_OF_REACH);
    const wh_vec3_t too_straight = wh_vec3(WH_REAL(199.996), 0, 0);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &too_straight, &caps), WH_STATUS_LIMIT_EXCEEDED);
    const wh_vec3_t through = wh_vec3(-800, 0, 0);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &through, &caps), WH_STATUS_OUT_OF_REACH);
    const wh_vec3_t far = wh_vec3(190, 0, 0);
    chain.travel[WH_CHAIN_YAW].min = chain.travel[WH_CHAIN_YAW].max = q[WH_CHAIN_YAW];
    chain.travel[WH_CHAIN_YAW].min -= DEG(5);
    chain.travel[WH_CHAIN_YAW].max += DEG(5);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &far, &caps), WH_STATUS_LIMIT_EXCEEDED);
    assert_memory_equal(&line, &untouched, sizeof line);
    chain.travel[WH_CHAIN_YAW].min = -DEG(540);
    chain.travel[WH_CHAIN_YAW].max = DEG(540);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &far, &caps), WH_OK);
    assert_true(line.path.slowed >= 1);
    wh_chain_line_at(&line, 1000, q);
    wh_pose_t end;
    wh_chain_forward(&chain, q, &end);
    assert_near((double)end.r.x, 590, 10 * MM);
    assert_near((double)end.r.y, 0, 10 * MM);
}

/* Straight up: neither joint moves, and Z's own profile is the line's. */
static void straight_up_only_z_moves(void **state) {
    (void)state;
    const wh_chain_t chain = chain_of(WH_CHAIN_SCARA, true);
    wh_real_t q[WH_CHAIN_AXES] = {0};
    q[WH_CHAIN_Z] = 900;
    q[WH_CHAIN_REACH] = 1;
    const wh_vec3_t up = wh_vec3(0, 0, 50);
    const wh_line_caps_t caps = {0, 0};
    wh_chain_line_t line;
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &up, &caps), WH_OK);
    wh_profile_t alone;
    assert_int_equal(wh_profile_plan(&alone, 50, &chain.limits[WH_CHAIN_Z]), WH_OK);
    assert_near((double)wh_chain_line_duration(&line), (double)alone.duration, 1e-6);
    assert_near((double)(line.to[WH_CHAIN_REACH] - q[WH_CHAIN_REACH]), 0, 10 * RAD);
    assert_near((double)(line.to[WH_CHAIN_THETA] - q[WH_CHAIN_THETA]), 0, 10 * RAD);
    const wh_vec3_t nowhere = wh_vec3(0, 0, 0);
    assert_int_equal(wh_chain_line_plan(&line, &chain, q, &nowhere, &caps), WH_OK);
    assert_true(wh_chain_line_duration(&line) == 0);
    assert_memory_equal(line.to, q, sizeof q);
}

/* Nearly stretched, stretched or nearly folded: up and down the arm still goes, and no other way. */
static void a_nearly_stretched_scara_goes_up_alone(void **state) {
    (void)state;
    static const double elbows[] = {-0.4, 0, 0.4, -174.9};
    const wh_chain_t chain = chain_of(WH_CHAIN_SCARA, false);
    const wh_line_caps_t caps = {0, 0};
    const wh_vec3_t up = wh_vec3(0, 0, 5);
    const wh_vec3_t in = wh_vec3(-1, 0, 0);
    const wh_vec3_t out = wh_vec3(1, 0, 0);
    wh_real_t q[WH_CHAIN_AXES] = {0};
    q[WH_CHAIN_THETA] = WH_REAL(0.3);
    q[WH_CHAIN_Z] = 900;
    for (size_t i = 0; i < sizeof elbows / sizeof elbows[0]; ++i) {
        q[WH_CHAIN_REACH] = DEG(elbows[i]);
        wh_chain_line_t line;
        assert_int_equal(wh_chain_line_plan(&line, &chain, q, &up, &caps), WH_OK);
        assert_near((double)line.to[WH_CHAIN_Z], 905, 10 * MM);
        wh_real_t between[WH_CHAIN_AXES];
        wh_chain_line_at(&line, wh_chain_line_duration(&line) / 2, between);
        assert_near((double)(between[WH_CHAIN_REACH] - q[WH_CHAIN_REACH]), 0, 10 * RAD);
        assert_near((double)(between[WH_CHAIN_THETA] - q[WH_CHAIN_THETA]), 0, 10 * RAD);
        assert_near((double)between[WH_CHAIN_Z], 902.5, 10 * MM);
        if (i < 3) { /* it reaches, but no joint is fast enough; farther out it does not reach */
            assert_int_equal(wh_chain_line_plan(&line, &chain, q, &in, &caps), WH_STATUS_LIMIT_EXCEEDED);
            assert_int_equal(wh_chain_line_plan(&line, &chain, q, &out, &caps), WH_STATUS_OUT_OF_REACH);
        }
    }
}

static void unsound_chains_are_refused(void **state) {
    (void)state;
    const wh_chain_t sound = chain_of(WH_CHAIN_SCARA, true);
    wh_chain_t chain = sound;
    assert_int_equal(wh_chain_validate(NULL), WH_STATUS_NULL_ARGUMENT);
    chain.kind = (wh_chain_kind_t)3;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_OUT_OF_RANGE);
    chain = sound;
    chain.links[1] = 0;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_OUT_OF_RANGE);
    chain = sound;
    chain.height = (wh_real_t)NAN;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_OUT_OF_RANGE);
    chain = sound;
    chain.arm_heading = 7;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_OUT_OF_RANGE);
    chain = sound;
    chain.travel[WH_CHAIN_TILT_X].max = WH_REAL(1.2);
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_BAD_LIMITS);
    chain = sound;
    chain.travel[WH_CHAIN_REACH].max = 4;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_BAD_LIMITS);
    chain = sound;
    chain.limits[WH_CHAIN_FLIP].jerk = 0;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_BAD_LIMITS);
    chain = sound;
    chain.home[WH_CHAIN_RAIL] = 1001;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_BAD_LIMITS);
    chain = sound;
    chain.has_rail = false;
    chain.home[WH_CHAIN_RAIL] = 1;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_BAD_LIMITS);
    chain = sound;
    chain.is_placed = true;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_NOT_A_ROTATION);
    chain = chain_of(WH_CHAIN_TRZ, false);
    chain.travel[WH_CHAIN_REACH].min = -1;
    assert_int_equal(wh_chain_validate(&chain), WH_STATUS_BAD_LIMITS);
}

static void bad_questions_change_nothing(void **state) {
    (void)state;
    const wh_chain_t chain = chain_of(WH_CHAIN_SCARA, false);
    const wh_pose_t pose = level(400, 100, 900, 0);
    const wh_real_t at_rest[WH_CHAIN_AXES] = {0};
    wh_chain_choice_t choice = {0, 0, WH_ELBOW_NEAR};
    wh_real_t q[WH_CHAIN_AXES];
    memset(q, 0x5a, sizeof q);
    wh_real_t untouched[WH_CHAIN_AXES];
    memcpy(untouched, q, sizeof q);
    assert_int_equal(wh_chain_inverse(&chain, &pose, NULL, at_rest, q), WH_STATUS_NULL_ARGUMENT);
    wh_pose_t odd = pose;
    odd.r.y = (wh_real_t)NAN;
    assert_int_equal(wh_chain_inverse(&chain, &odd, &choice, at_rest, q), WH_STATUS_NOT_FINITE);
    odd = pose;
    odd.R.m[2][1] = (wh_real_t)INFINITY;
    assert_int_equal(wh_chain_inverse(&chain, &odd, &choice, at_rest, q), WH_STATUS_NOT_FINITE);
    wh_real_t lost[WH_CHAIN_AXES] = {0};
    lost[WH_CHAIN_YAW] = WH_REAL(2e5);
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, lost, q), WH_STATUS_OUT_OF_RANGE);
    const wh_pose_t far = level(601, 0, 900, 0);
    const wh_pose_t on_axis = level(0, 0, 900, 0);
    const wh_pose_t high = level(400, 0, 1301, 0);
    assert_int_equal(wh_chain_inverse(&chain, &far, &choice, at_rest, q), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_chain_inverse(&chain, &on_axis, &choice, at_rest, q), WH_STATUS_OUT_OF_REACH);
    assert_int_equal(wh_chain_inverse(&chain, &high, &choice, at_rest, q), WH_STATUS_LIMIT_EXCEEDED);
    choice.rail = 5;
    assert_int_equal(wh_chain_inverse(&chain, &pose, &choice, at_rest, q), WH_STATUS_LIMIT_EXCEEDED);
    assert_memory_equal(q, untouched, sizeof q);
    const wh_line_caps_t negative = {-1, 0};
    const wh_vec3_t step = wh_vec3(10, 0, 0);
    wh_chain_line_t line;
    wh_real_t bent[WH_CHAIN_AXES] = {0};
    bent[WH_CHAIN_Z] = 900;
    bent[WH_CHAIN_REACH] = -1;
    assert_int_equal(wh_chain_line_plan(&line, &chain, bent, &step, &negative), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_chain_line_plan(&line, &chain, bent, &step, NULL), WH_STATUS_NULL_ARGUMENT);
    const wh_vec3_t endless = wh_vec3((wh_real_t)INFINITY, 0, 0);
    const wh_line_caps_t none = {0, 0};
    assert_int_equal(wh_chain_line_plan(&line, &chain, bent, &endless, &none), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_chain_line_plan(&line, &chain, untouched, &step, &none), WH_STATUS_OUT_OF_REACH);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_chain_is_the_robot),
        cmocka_unit_test(a_tilting_robot_serves_a_tilted_station),
        cmocka_unit_test(a_flip_turns_the_blade_over),
        cmocka_unit_test(an_arm_of_two_points_its_own_way),
        cmocka_unit_test(an_elbow_has_two_sides),
        cmocka_unit_test(a_scara_line_stays_bent),
        cmocka_unit_test(straight_up_only_z_moves),
        cmocka_unit_test(a_nearly_stretched_scara_goes_up_alone),
        cmocka_unit_test(unsound_chains_are_refused),
        cmocka_unit_test(bad_questions_change_nothing),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
