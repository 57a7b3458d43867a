/* Stations given by the axes with which they were taught: where they then are, and what is refused. */
#include <math.h>

#include "support/layout.h"

#include "layout/layout.h"

#define ONE(robot, stations)                                                                                 \
    "robot = { " robot " }, grippers = { { name = 'EE' } }, stations = { " stations " }"

static const wh_pose_t *place_of(const wh_layout_t *layout, const char *name) {
    const int32_t s = wh_layout_find_station(layout, name);
    assert_int_not_equal(s, WH_NONE);
    return &layout->places[s].base_from_station;
}

static void expect_place(const wh_pose_t *place, double x, double y, double z, double heading_deg) {
    assert_near(place->r.x, x, 1e-9);
    assert_near(place->r.y, y, 1e-9);
    assert_near(place->r.z, z, 1e-9);
    const wh_mat3_t R = wh_mat3_from_rpy_deg(0, 0, (wh_real_t)heading_deg);
    for (int i = 0; i < 9; ++i) {
        assert_near(place->R.m[i / 3][i % 3], R.m[i / 3][i % 3], 1e-12);
    }
}

static void a_robot_with_a_wrist(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(ONE("", "A = { axes = { theta = 90, r = 700, z = 905.5, yaw = 10 } }, "
                           "B = { at = { 700, 0, 900 } }"));
    expect_place(place_of(layout, "A"), 0, 700, 905.5, 100);
    assert_true(layout->stations[0].by_axes);
    assert_false(layout->stations[1].by_axes);
}

/* Also at the very end of an axis's travel, with a blade that sits elsewhere on the hand. */
static void a_blade_beside_the_hand(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "grippers = { { name = 'ONE' }, { name = 'TWO', at = { 0, 50, -20 }, rpy = { 0, 0, 5 } } }, "
        "stations = { A = { effector = 'TWO', axes = { theta = 540, r = 600, z = 900, yaw = -270 } } }");
    /* Theta points to -x, the blade is turned a quarter to the left: its y is the hand's. */
    expect_place(place_of(layout, "A"), -600 + 50, 0, 880, 180 - 270 + 5);
}

static void an_arm_without_a_wrist(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound("robot = { kind = 'TRZ', at = { 100, 0, 0 }, heading = 90, arms = { {}, { heading = 180, "
                   "height = 10 } } }, "
                   "grippers = { { name = 'ONE' }, { name = 'TWO', arm = 2 } }, "
                   "stations = { A = { axes = { theta = 30, r = 700, z = 900 } }, "
                   "B = { effector = 'TWO', axes = { theta = -90, r = 500, z = 900 } } }");
    const double c = cos(120 * 3.14159265358979323846 / 180), s = sin(120 * 3.14159265358979323846 / 180);
    expect_place(place_of(layout, "A"), 100 + 700 * c, 700 * s, 900, 120);
    expect_place(place_of(layout, "B"), 100 - 500, 0, 910, 180);
    expect_refused("robot = { kind = 'TRZ' }, grippers = { { name = 'EE' } }, "
                   "stations = { A = { axes = { theta = 0, r = 700, z = 900, yaw = 0 } } }",
                   "stations.A.axes.yaw: 0 (expected nothing: the arm that goes there has no such axis)");
}

/* The sign of the elbow says its side. */
static void a_scara_on_a_rail(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(ONE("kind = 'SCARA', links = { 400, 300 }, rail = { min = -500, max = 500 }",
                       "A = { axes = { theta = 0, forearm = 90, z = 900, yaw = -45, rail = 120 } }, "
                       "B = { axes = { theta = 0, forearm = -90, z = 900, yaw = 90, rail = -20 } }"));
    expect_place(place_of(layout, "A"), 120 + 400, 300, 900, 45);
    expect_place(place_of(layout, "B"), -20 + 400, -300, 900, 0);
    assert_near(layout->stations[0].rail, 120, 0);
    assert_int_equal(layout->stations[0].elbow, WH_ELBOW_RIGHT);
    assert_int_equal(layout->stations[1].elbow, WH_ELBOW_LEFT);
    expect_refused(ONE("kind = 'SCARA', links = { 400, 300 }",
                       "A = { axes = { theta = 0, r = 500, z = 900, yaw = 0 } }"),
                   "stations.A.axes.r: 500 (expected nothing: the arm that goes there has no such axis)");
    expect_refused(ONE("kind = 'SCARA', links = { 400, 300 }",
                       "A = { elbow = 'left', axes = { theta = 0, forearm = 90, z = 900, yaw = 0 } }"),
                   "stations.A.elbow: \"left\" (expected nothing: `axes` says where slot 1 is)");
}

static void a_column_that_tilts(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(ONE("tilt = {}, flip = {}",
                       "A = { axes = { theta = 0, r = 700, z = 900, yaw = 0, tilt_x = 1, tilt_y = 0 } }"));
    assert_near(place_of(layout, "A")->R.m[2][2], cos(3.14159265358979323846 / 180), 1e-12);
    assert_near(place_of(layout, "A")->R.m[2][1], sin(3.14159265358979323846 / 180), 1e-12);
}

/* The chuck stands where its station is. */
static void a_prealigner(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { P = { kind = 'prealigner', "
        "axes = { theta = 180, r = 600, z = 950, yaw = 0 } } }");
    expect_place(&layout->machine.mounts[1].base_from_station, -600, 0, 950, 180);
}

#define TWO(station)                                                                                         \
    "robots = { L = {}, R = { at = { 1400, 0, 0 } } }, grippers = { { name = 'GL', on = 'L' }, "             \
    "{ name = 'GR', on = 'R' } }, stations = { A = { " station " } }"

/* The first of them by name places the station; the other one stands where it was taught it. */
static void several_robots(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(TWO("by = { L = { axes = { theta = 0, r = 700, z = 900, yaw = 0 } }, "
                       "R = { axes = { theta = 180, r = 699, z = 900.5, yaw = 0 } } }"));
    expect_place(place_of(layout, "A"), 700, 0, 900, 0);
    const wh_layout_approach_t *by = layout->stations[0].by;
    assert_false(by[0].is_turned);
    assert_true(by[1].is_turned);
    assert_near(by[1].R.m[0][0], -1, 1e-12);
    assert_near(by[1].aside.x, 1, 1e-9);
    assert_near(by[1].aside.z, 0.5, 1e-9);
    layout = read_sound(
        TWO("at = { 701, 0, 900 }, by = { L = { axes = { theta = 0, r = 700, z = 900, yaw = 0 } } }"));
    expect_place(place_of(layout, "A"), 701, 0, 900, 0);
    assert_near(layout->stations[0].by[0].aside.x, -1, 1e-9);
    expect_refused(TWO("axes = { theta = 0, r = 700, z = 900, yaw = 0 }"),
                   "stations.A.axes: a table (expected nothing: with several robots `by` says it of each)");
    expect_refused(
        TWO("by = { L = { axes = { theta = 0, r = 700, z = 900, yaw = 0 } }, R = { at = { 700, 0, 900 } } }"),
        "stations.A.by.R.at: { 700, 0, 900 } (expected nothing: the station has no `at` that it is beside)");
    expect_refused(TWO("rpy = { 0, 0, 9 }, by = { L = { axes = { theta = 0, r = 700, z = 900, yaw = 0 } } }"),
                   "stations.A.rpy: { 0, 0, 9 } (expected nothing: `axes` in `by` says where slot 1 is)");
    expect_refused(TWO("at = { 700, 0, 900 }, by = { L = { at = { 700, 0, 900 }, axes = {} } }"),
                   "stations.A.by.L.at: { 700, 0, 900 } (expected nothing: `axes` says where slot 1 is)");
    expect_refused(
        TWO("at = { 700, 0, 900 }, by = { L = { axes = { theta = 0, r = 706, z = 900, yaw = 0 } } }"),
        "stations.A.by.L.axes: a table (expected axes that bring GL up to 5 mm beside the station; it "
        "stands 6, 0, 0 mm beside it)");
}

static void wrong_axes(void **state) {
    (void)state;
    expect_refused(ONE("", "A = { at = { 700, 0, 900 }, axes = { theta = 0, r = 700, z = 900, yaw = 0 } }"),
                   "stations.A.at: { 700, 0, 900 } (expected nothing: `axes` says where slot 1 is)");
    expect_refused(ONE("", "A = { rpy = { 0, 0, 0 }, axes = { theta = 0, r = 700, z = 900, yaw = 0 } }"),
                   "stations.A.rpy: { 0, 0, 0 } (expected nothing: `axes` says where slot 1 is)");
    expect_refused(ONE("", "A = { axes = { theta = 0, r = 901, z = 900, yaw = 0 } }"),
                   "stations.A.axes.r: 901 (expected a number from 300 to 900");
    expect_refused(ONE("", "A = { axes = { theta = 541, r = 700, z = 900, yaw = 0 } }"),
                   "stations.A.axes.theta: 541 (expected a number from -540 to 540");
    expect_refused(ONE("", "A = { axes = { r = 700, z = 900, yaw = 0 } }"),
                   "stations.A.axes.theta: nothing (expected");
    expect_refused(ONE("", "A = { axes = { theta = 0, r = 700, z = 900, yaw = 0, x = 1 } }"),
                   "stations.A.axes.x: 1 (expected one of the fields");
    expect_refused(ONE("", "A = {}"), "stations.A.at: nothing");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_robot_with_a_wrist),   cmocka_unit_test(a_blade_beside_the_hand),
        cmocka_unit_test(an_arm_without_a_wrist), cmocka_unit_test(a_scara_on_a_rail),
        cmocka_unit_test(a_column_that_tilts),    cmocka_unit_test(a_prealigner),
        cmocka_unit_test(several_robots),         cmocka_unit_test(wrong_axes)};
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
