/* How one frame lies as seen from another, against closed forms and against what must hold of any two. */
#include "math/relation.h"
#include "support/pose.h"
#include "support/support.h"

/* Tolerances are written for double. */
#define NUMBERS (WH_TEST_ROUNDING * 9007199254740992.0)

static wh_pose_t turned(double x, double y, double z, double angle) {
    return wh_test_pose(wh_test_rotation(1, 0, 0, angle), x, y, z);
}

static wh_pose_t rolled(double x, double y, double z, double angle) {
    return wh_test_pose(wh_test_rotation(0, 0, 1, angle), x, y, z);
}

static void axes_are_the_first_frame_s(void **state) {
    (void)state;
    const wh_pose_t first = rolled(100, 200, 300, WH_TEST_PI / 2);
    const wh_pose_t second = rolled(103, 204, 312, WH_TEST_PI / 2);
    const wh_relation_t relation = wh_relate(&first, &second);
    assert_near(relation.distance, 13, 1e-13 * NUMBERS);
    assert_near(relation.r.x, 4, 1e-13 * NUMBERS);
    assert_near(relation.r.y, -3, 1e-13 * NUMBERS);
    assert_near(relation.r.z, 12, 1e-13 * NUMBERS);
    assert_near(relation.angle, 0, 0);
    assert_near(relation.turn, 0, 1e-16 * NUMBERS);
}

/* About z the z axes stay together, about x they go apart by as much as all turns. */
static void angles_small_and_large(void **state) {
    (void)state;
    static const double angles[] = {0, 1e-12, 1e-8, 1e-3, 0.5, 1.5, 3, WH_TEST_PI - 1e-8, WH_TEST_PI};
    const wh_pose_t base = wh_pose_identity();
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; ++i) {
        const wh_pose_t about_x = turned(0, 0, 0, -angles[i]);
        const wh_pose_t about_z = rolled(0, 0, 0, angles[i]);
        assert_near(wh_relate(&base, &about_x).angle, angles[i], 4e-16 * NUMBERS);
        assert_near(wh_relate(&base, &about_x).turn, angles[i], 4e-16 * NUMBERS);
        assert_near(wh_relate(&base, &about_z).angle, 0, 0);
        assert_near(wh_relate(&base, &about_z).turn, angles[i], 4e-16 * NUMBERS);
    }
}

/* A tilt after a turn: cos t/2 is the product of the two halves' cosines. */
static void a_whole_turn_is_more_than_the_tilt(void **state) {
    (void)state;
    const wh_pose_t tilt = turned(0, 0, 0, 0.3);
    const wh_pose_t turn = rolled(0, 0, 0, 1.1);
    const wh_pose_t both = wh_pose_compose(&turn, &tilt);
    const wh_pose_t base = wh_pose_identity();
    const wh_relation_t relation = wh_relate(&base, &both);
    assert_near(relation.angle, 0.3, 1e-15 * NUMBERS);
    assert_near(cos(relation.turn / 2), cos(0.15) * cos(0.55), 1e-15 * NUMBERS);
}

/* Either way round it is as far and as much, and both ways lead back. */
static void both_ways(void **state) {
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        const wh_pose_t a = wh_test_random_pose(1000);
        const wh_pose_t b = wh_test_random_pose(1000);
        const wh_relation_t there = wh_relate(&a, &b);
        const wh_relation_t back = wh_relate(&b, &a);
        const wh_vec3_t way = wh_mat3_transform(&a.R, &there.r);
        assert_near(there.distance, back.distance, 0);
        assert_near(there.distance, wh_vec3_norm(&there.r), 1e-11 * NUMBERS);
        assert_near(there.angle, back.angle, 1e-14 * NUMBERS);
        assert_near(there.turn, back.turn, 1e-14 * NUMBERS);
        assert_true(there.turn >= there.angle - 1e-14 * NUMBERS);
        assert_near(a.r.x + way.x, b.r.x, 1e-11 * NUMBERS);
        assert_near(a.r.y + way.y, b.r.y, 1e-11 * NUMBERS);
        assert_near(a.r.z + way.z, b.r.z, 1e-11 * NUMBERS);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axes_are_the_first_frame_s),
        cmocka_unit_test(angles_small_and_large),
        cmocka_unit_test(a_whole_turn_is_more_than_the_tilt),
        cmocka_unit_test(both_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
