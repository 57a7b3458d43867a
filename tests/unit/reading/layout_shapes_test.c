/* A layout's parts for the collision check: defaults by wafer size, obstacles, and refusals. */
#include <unistd.h>

#include "support/layout.h"
#include "support/parts.h"

#include "layout/layout.h"
#include "layout/links.h"
#include "layout/transit.h"
#include "math/trig.h"

#define GRIPPERS "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, "
#define PREALIGNER "P = { kind = 'prealigner', at = { -600, 0, 950 }, rpy = { 0, 0, 180 } }, "
#define FOUP "F = { kind = 'foup', at = { 760, 0, 900 } }, "
#define STATIONS "stations = { " FOUP PREALIGNER "}, "
#define CELL GRIPPERS STATIONS

/* A box from x0 to x1 and so on, in its body's frame, or of a part that is mounted on nothing and
 * is not turned. */
static void expect_box(const wh_layout_t *layout, const char *name, double x0, double x1, double y0,
                       double y1, double z0, double z1) {
    const wh_convex_t *convex = &part(layout, name)->convex;
    assert_int_equal(convex->kind, WH_CONVEX_BOX);
    const wh_vec3_t *r = &convex->body_from_shape.r;
    assert_near(r->x - convex->half.x, x0, 1e-9);
    assert_near(r->x + convex->half.x, x1, 1e-9);
    assert_near(r->y - convex->half.y, y0, 1e-9);
    assert_near(r->y + convex->half.y, y1, 1e-9);
    assert_near(r->z - convex->half.z, z0, 1e-9);
    assert_near(r->z + convex->half.z, z1, 1e-9);
}

static void expect_cylinder(const wh_layout_t *layout, const char *name, double radius, double z0,
                            double z1) {
    const wh_convex_t *convex = &part(layout, name)->convex;
    assert_int_equal(convex->kind, WH_CONVEX_CYLINDER);
    assert_near(convex->half.x, radius, 1e-9);
    assert_near(convex->body_from_shape.r.z - convex->half.z, z0, 1e-9);
    assert_near(convex->body_from_shape.r.z + convex->half.z, z1, 1e-9);
}

/* ------------------------------------------------------------------------------------------------- defaults */

static void shapes_of_300_mm(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    assert_false(layout->collision);
    expect_box(layout, "EE finger left", -55, 100, 50, 75, -3, 0);
    expect_box(layout, "EE finger right", -55, 100, -75, -50, -3, 0);
    expect_box(layout, "EE palm", -80, -55, -75, 75, -3, 0);
    expect_box(layout, "EE neck", -250, -80, -37.5, 37.5, -3, 0);
    expect_cylinder(layout, "PA chuck", 40, -20, 0);
    expect_box(layout, "F ledge 1 left", 685, 835, 140, 152, 899.5, 900);
    expect_box(layout, "F ledge 25 right", 685, 835, -152, -140, 1139.5, 1140);
    assert_near(layout->world.wafer.half.x, 150, 0);
    assert_near(layout->world.wafer.half.z, 0.775 / 2, 1e-12);
    assert_near(layout->world.wafer.body_from_shape.r.z, 0.775 / 2, 1e-12);
    assert_near(layout->shapes.arm.link, 0.53 * 650, 1e-9);
}

static void shapes_of_smaller_wafers(void **state) {
    (void)state;
    const wh_layout_t *of_200 = read_sound("wafer = { diameter = 200 }, " CELL);
    expect_box(of_200, "EE palm", -80 / 1.5, -55 / 1.5, -50, 50, -2, 0);
    expect_box(of_200, "F ledge 2 left", 710, 810, 100 - 10 / 1.5, 102, 905.85, 906.35);
    assert_near(of_200->stations[0].stroke, 4, 0);
    assert_near(of_200->stations[0].offset, 2, 0);
    const wh_layout_t *of_150 = read_sound("wafer = { diameter = 150 }, " CELL);
    expect_box(of_150, "EE finger left", -27.5, 50, 25, 37.5, -1.5, 0);
    expect_box(of_150, "F ledge 2 left", 722.5, 797.5, 70, 77, 904.26, 904.76);
    expect_cylinder(of_150, "PA chuck", 20, -20, 0);
    assert_near(of_150->stations[0].stroke, 3, 0);
    assert_near(of_150->stations[0].offset, 1.5, 0);
}

static void a_foup_has_its_shell(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    expect_box(layout, "F wall left", 602, 923, 158, 163, 875, 1160);
    expect_box(layout, "F wall right", 602, 923, -163, -158, 875, 1160);
    expect_box(layout, "F wall behind", 918, 923, -158, 158, 875, 1160);
    expect_box(layout, "F roof", 602, 923, -163, 163, 1160, 1165);
    expect_box(layout, "F floor", 602, 923, -163, 163, 870, 875);
    expect_box(layout, "F load port", 602, 973, -173, 173, 0, 870);
    assert_int_equal(part(layout, "F roof")->owner, 0);
    /* The station is too low for a load port below it. */
    const wh_layout_t *low =
        read_sound(GRIPPERS "stations = { F = { kind = 'foup', at = { 760, 0, 49 } }, " PREALIGNER "}");
    assert_int_equal(find(low, "F load port"), WH_NONE);
    assert_int_not_equal(find(low, "F floor"), WH_NONE);
}

static void a_robot_has_its_shapes(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(CELL);
    expect_cylinder(layout, "column", 120, 0, 425);
    expect_cylinder(layout, "lift", 90, -590, -165);
    expect_box(layout, "upper arm", -35, 379.5, -35, 35, -160, -115);
    expect_box(layout, "forearm", -35, 379.5, -35, 35, -110, -65);
    expect_cylinder(layout, "hand", 40, -60, -3);
    assert_int_equal(part(layout, "forearm")->owner, WH_ARM_FOREARM);
    const wh_layout_t *low =
        read_sound("robot = { z = { min = 100 } }, shapes = { arm = { reach = 50 } }, " CELL);
    assert_int_equal(find(low, "column"), WH_NONE);
    assert_int_equal(find(low, "EE neck"), WH_NONE);
}

/* The distance of a point, in the gripper's frame, outside a box or a cylinder along its worst axis. */
static double outside(const wh_convex_t *convex, wh_vec3_t point) {
    const wh_vec3_t dr = wh_vec3_subtract(&point, &convex->body_from_shape.r);
    const wh_vec3_t at = wh_mat3_transform_back(&convex->body_from_shape.R, &dr);
    const double along = fabs(at.z) - convex->half.z;
    if (convex->kind == WH_CONVEX_CYLINDER) {
        return fmax(hypot(at.x, at.y) - convex->half.x, along);
    }
    return fmax(fmax(fabs(at.x) - convex->half.x, fabs(at.y) - convex->half.y), along);
}

/* Wherever a blade is on the end-effector, its moving parts are in the world, and none is without a
 * carrier. */
static void a_blade_is_joined_to_the_wrist(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(6, 300, 0.2);
    while (wh_round(&rounds)) {
        char text[700];
        const double x = wh_test_uniform(-400, 400), y = wh_test_uniform(-400, 400);
        const double z = wh_test_uniform(-120, 60), yaw = wh_test_uniform(-180, 180);
        const double reach = rounds.number % 3 == 0 ? 0 : wh_test_uniform(0, 300);
        (void)snprintf(
            text, sizeof text,
            "shapes = { arm = { reach = %.17g } }, grippers = { { name = 'EE', at = { %.17g, %.17g, "
            "%.17g }, rpy = { 0, 0, %.17g } } }, stations = { A = { at = { 760, 0, 900 } } }, ",
            reach, x, y, z, yaw);
        const wh_layout_t *layout = read_sound(text);
        const wh_pose_t *pose = &layout->machine.mounts[0].effector_from_gripper;
        const wh_vec3_t wrist = {-reach, 0, 0}, dr = wh_vec3_subtract(&wrist, &pose->r);
        const wh_vec3_t at = wh_mat3_transform_back(&pose->R, &dr);
        const wh_convex_t *neck = &part(layout, "EE neck")->convex;
        assert_true(outside(neck, wh_vec3(-80, 0, -1.5)) < 1e-9);
        assert_true(outside(neck, wh_vec3(at.x, at.y, -1.5)) < 1e-9);
        /* The hand reaches from 60 to 3 mm below the wrist's plane. */
        if (z > 0) {
            assert_true(outside(&part(layout, "EE post")->convex, wh_vec3(at.x, at.y, -3)) < 1e-9);
            assert_true(outside(&part(layout, "EE post")->convex, wh_vec3(at.x, at.y, -z - 3)) < 1e-9);
        } else if (z < -60) {
            assert_true(outside(&part(layout, "EE post")->convex, wh_vec3(at.x, at.y, 0)) < 1e-9);
            assert_true(outside(&part(layout, "EE post")->convex, wh_vec3(at.x, at.y, -z - 60)) < 1e-9);
        } else {
            assert_int_equal(find(layout, "EE post"), WH_NONE);
        }
    }
}

static void names_and_order(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(CELL "wafers = { { name = 'W', station = 'F', slot = 1 } }, "
                        "obstacles = { { box = { 1, 1, 1 }, at = { 0, 0, 0 }, on = 'hand' }, "
                        "{ box = { 1, 1, 1 }, at = { 0, 0, 0 } } }");
    const int32_t count = (int32_t)layout->world.part_count;
    /* 50 ledges, 5 walls, a load port, a body and an obstacle; then 5 of the robot, 5 of grippers
     * and one more. */
    assert_int_equal(count, 58 + 11);
    assert_int_equal(find(layout, "obstacle 2"), 57);
    assert_int_equal(find(layout, "obstacle 1"), count - 1);
    assert_int_equal(layout->hung_count, 1);
    assert_string_equal(wh_layout_part_name(layout, count), "W");
    assert_null(wh_layout_part_name(layout, count + 1));
    assert_null(wh_layout_part_name(layout, -1));
}

static void own_sizes(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        CELL "collision = true, clearance = { blade_wafer_above = 1.5 }, "
             "shapes = { blade = { thickness = 2, half_width = 60, finger = 20, length = 90, palm = 70 }, "
             "ledge = { inner = 130, outer = 160, thickness = 3, length = 20 }, "
             "foup = { room = 10, wall = 2, floor = 30, roof = 40 }, chuck = { radius = 30, height = 12, "
             "body = 100 }, "
             "arm = { reach = 200, link = 400, right_handed = true } }");
    assert_true(layout->collision);
    assert_near(layout->world.limits[WH_CLEARANCE_BLADE_WAFER_ABOVE], 1.5, 0);
    assert_near(layout->world.limits[WH_CLEARANCE_BLADE_WAFER_BELOW], 0, 0);
    expect_box(layout, "EE finger left", -50, 90, 40, 60, -2, 0);
    expect_box(layout, "EE neck", -200, -70, -30, 30, -2, 0);
    expect_box(layout, "F ledge 1 right", 750, 770, -160, -130, 897, 900);
    expect_box(layout, "F roof", 600, 922, -162, 162, 1180, 1182);
    expect_cylinder(layout, "PA chuck", 30, -12, 0);
    expect_cylinder(layout, "P body", 100, 950 - 220, 950 - 13);
    assert_near(layout->shapes.arm.link, 400, 0);
    assert_true(layout->shapes.arm.right_handed);
}

/* ------------------------------------------------------------------------------------------------ obstacles */

static void obstacles_of_each_kind(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        CELL
        "obstacles = { "
        "{ name = 'wall', box = { 10, 20, 30 }, at = { 1, 2, 3 }, rpy = { 0, 0, 90 } }, "
        "{ name = 'post', cylinder = { radius = 5, height = 40 }, at = { 4, 5, 6 }, on = 'base' }, "
        "{ name = 'hose', capsule = { radius = 3, height = 20 }, at = { 0, 0, -20 }, on = 'upper arm' }, "
        "{ name = 'camera', box = { 5, 5, 5 }, at = { -100, 0, 10 }, on = 'EE' }, "
        "{ name = 'cap', box = { 5, 5, 5 }, at = { 0, 0, -10 }, on = 'PA' } }");
    const wh_part_t *wall = part(layout, "wall");
    assert_int_equal(wall->kind, WH_PART_FIXED);
    assert_int_equal(wall->owner, WH_NONE);
    assert_near(wall->convex.half.y, 10, 0);
    assert_near(wall->convex.body_from_shape.r.z, 3, 0);
    assert_near(wall->convex.body_from_shape.R.m[1][0], 1, 0);
    expect_cylinder(layout, "post", 5, -14, 26);
    const wh_part_t *hose = part(layout, "hose");
    assert_int_equal(hose->kind, WH_PART_ARM);
    assert_int_equal(hose->owner, WH_ARM_UPPER);
    assert_int_equal(hose->convex.kind, WH_CONVEX_CAPSULE);
    assert_near(hose->convex.half.z, 10, 0);
    assert_int_equal(part(layout, "camera")->kind, WH_PART_BLADE);
    assert_int_equal(part(layout, "cap")->kind, WH_PART_CHUCK);
    assert_int_equal(part(layout, "cap")->owner, 1);
    assert_int_equal(layout->hung_count, 3);
}

/* A corner of a cube, cut off: in inches. */
static void write_tetrahedron(FILE *file) {
    static const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    static const int facets[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    fputs("solid corner\n", file);
    for (int f = 0; f < 4; ++f) {
        fputs("facet normal 0 0 0\nouter loop\n", file);
        for (int c = 0; c < 3; ++c) {
            const double *at = corners[facets[f][c]];
            fprintf(file, "vertex %g %g %g\n", at[0], at[1], at[2]);
        }
        fputs("endloop\nendfacet\n", file);
    }
    fputs("endsolid corner\n", file);
}

static void obstacle_of_a_mesh(void **state) {
    (void)state;
    char path[WH_TEST_PATH];
    char fields[512];
    const int descriptor = mkstemp(wh_test_path(path, "mesh"));
    assert_true(descriptor >= 0);
    FILE *file = fdopen(descriptor, "w");
    assert_non_null(file);
    write_tetrahedron(file);
    assert_int_equal(fclose(file), 0);
    snprintf(fields, sizeof fields,
             CELL "obstacles = { { name = 'corner', mesh = '%s', unit = 'inch', at = { 7, 0, 0 } } }", path);
    const wh_layout_t *layout = read_layout(fields);
    assert_int_equal(unlink(path), 0);
    assert_non_null(layout);
    const wh_convex_t *convex = &part(layout, "corner")->convex;
    assert_int_equal(convex->kind, WH_CONVEX_MESH);
    assert_int_equal(convex->point_count, 4);
    wh_vec3_t low;
    wh_vec3_t high;
    wh_convex_bounds(convex, &convex->body_from_shape, &low, &high);
    assert_near(low.x, 7, 1e-9);
    assert_near(high.x, 7 + 25.4, 1e-9);
    assert_near(high.y, 50.8, 1e-9);
    assert_near(high.z, 76.2, 1e-9);
}

/* -------------------------------------------------------------------------------------------------- refusals */

static void bad_obstacles(void **state) {
    (void)state;
    static const struct {
        const char *obstacle, *message;
    } cases[] = {
        {"box = { 1, 1, 1 }, cylinder = { radius = 1, height = 1 }, at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].cylinder: \"cylinder\" (expected one shape; box is given as well)"},
        {"at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].box: nothing (expected a shape: box = { x, y, z }, cylinder, "},
        {"box = { 1, 1, 1 }", "cell.lua: obstacles[1].at: nothing (expected a list of three numbers)"},
        {"box = { 1, 1, 1 }, at = { 0, 0, 0 }, on = 'nowhere'",
         "cell.lua: obstacles[1].on: \"nowhere\" (expected \"base\", \"lift\""},
        {"box = { 1, 0, 1 }, at = { 0, 0, 0 }, name = 'flat'",
         "cell.lua: obstacles[1].box: { 1, 0, 1 } (expected three sizes of at least 0.01 mm)"},
        {"cylinder = { radius = 1 }, at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].cylinder.height: nothing (expected a number"},
        {"capsule = { radius = -1, height = 1 }, at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].capsule.radius: -1 (expected a number"},
        {"box = { 1, 1, 1 }, at = { 0, 0, 0 }, colour = 1",
         "cell.lua: obstacles[1].colour: 1 (expected one of the fields"},
        {"mesh = 'no_such.stl', at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].unit: nothing (expected the mesh's unit: \"mm\""},
        {"mesh = 'no_such.stl', unit = 'mm', at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].mesh: \"no_such.stl\" (expected a convex mesh in an STL file: "
         "no_such.stl: "},
        {"mesh = 'no_such.stl', unit = 'ell', at = { 0, 0, 0 }",
         "cell.lua: obstacles[1].unit: \"ell\" (expected \"mm\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char fields[1024];
        snprintf(fields, sizeof fields, CELL "obstacles = { { %s } }", cases[i].obstacle);
        expect_refused(fields, cases[i].message);
    }
}

static void bad_shapes(void **state) {
    (void)state;
    expect_refused(CELL "shapes = { blade = { thickness = 0 } }",
                   "cell.lua: shapes.blade.thickness: 0 (expected a number from 0.1 to 50)");
    expect_refused(CELL "shapes = { blade = { finger = 80 } }",
                   "cell.lua: shapes.blade.finger: 80 (expected a number");
    expect_refused(CELL "shapes = { ledge = { inner = 152 } }",
                   "cell.lua: shapes.ledge.inner: 152 (expected a number");
    expect_refused(CELL "shapes = { arm = { elbow = 1 } }",
                   "cell.lua: shapes.arm.elbow: 1 (expected one of the fields");
    expect_refused(CELL "shapes = { chuck = { radius = 0 } }",
                   "cell.lua: shapes.chuck.radius: 0 (expected a number from 1 to 500)");
    expect_refused(CELL "shapes = { tail = {} }", "cell.lua: shapes.tail: ");
    expect_refused(CELL "clearance = { blade_wafer = 1 }",
                   "cell.lua: clearance.blade_wafer: 1 (expected one of the fields");
    expect_refused(CELL "clearance = { arm_other = 21 }",
                   "cell.lua: clearance.arm_other: 21 (expected a number from 0 to 20)");
    expect_refused(CELL "collision = 1", "cell.lua: collision: 1 (expected true or false)");
}

#define MANY(n, item) "(function() local t = {} for i = 1, " #n " do t[i] = " item " end return t end)()"
#define SHELVES                                                                                              \
    GRIPPERS "stations = (function() local t = { " PREALIGNER "} for i = 1, 50 do "                          \
             "t['S' .. i] = { at = { 700, 0, 900 }, slots = 1000 } end return t end)(), "

static void too_many(void **state) {
    (void)state;
    expect_refused(CELL "obstacles = " MANY(1001, "{ box = { 1, 1, 1 }, at = { 0, 0, 0 } }"),
                   "cell.lua: obstacles: 1001 (expected at most 1000 obstacles)");
    expect_refused(CELL "obstacles = " MANY(190, "{ box = { 1, 1, 1 }, at = { 0, 0, 0 }, on = 'hand' }"),
                   "cell.lua: obstacles: 200 (expected at most 192 parts on robot, grippers and doors "
                   "together, their own "
                   "included; the arm has 195 of them: join");
    expect_refused(SHELVES "collision = true", "cell.lua: collision: 1000");
    const wh_layout_t *unchecked = read_sound(SHELVES);
    assert_int_equal(unchecked->world.part_count, 0);
    assert_null(wh_layout_part_name(unchecked, 0));
}

/* --------------------------------------------------------------------------------------------------- the transit */

enum { WAYS = 720 };
static wh_vec3_t ways[WAYS];

static int open_sandbox_and_ways(void **state) {
    for (int k = 0; k < WAYS; ++k) {
        ways[k] = wh_vec3(wh_cos(k * WH_PI / (WAYS / 2)), wh_sin(k * WH_PI / (WAYS / 2)), 0);
    }
    return open_sandbox(state);
}

/* The distance of the parts on gripper `g` from theta's axis, by support points in all directions. */
static double outermost(const wh_layout_t *layout, size_t g, double R, double yaw, double flip) {
    wh_pose_t effector = {wh_mat3_about_z(yaw), {R, 0, 0}};
    wh_chain_turn_over(&effector.R, flip);
    const wh_mount_t *mount = &layout->machine.mounts[g];
    const wh_pose_t gripper =
        mount->is_shifted ? wh_pose_compose(&effector, &mount->effector_from_gripper) : effector;
    double most = 0;
    for (size_t i = 0; i <= layout->world.part_count; ++i) {
        const wh_part_t *hung = &layout->world.parts[i];
        const bool is_wafer = i == layout->world.part_count;
        if (!is_wafer && (hung->kind != WH_PART_BLADE || hung->owner != (int32_t)g)) {
            continue;
        }
        const wh_convex_t *convex = is_wafer ? &layout->world.wafer : &hung->convex;
        const wh_pose_t base_from_shape = wh_pose_compose(&gripper, &convex->body_from_shape);
        for (int k = 0; k<WAYS; k += WH_TEST_SHARE> 1 ? 8 : 1) {
            const wh_vec3_t point = wh_convex_support(convex, &base_from_shape, ways[k]);
            most = fmax(most, wh_vec3_dot(&point, &ways[k]));
        }
    }
    return most;
}

static double outermost_while_turning(const wh_layout_t *layout, double R, double from, double to) {
    double most = 0;
    for (int k = 0; k <= 90; ++k) {
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            if (layout->grippers[g].station == WH_NONE) {
                most = fmax(most, outermost(layout, g, R, from + (to - from) * k / 90, 0));
            }
        }
    }
    return most;
}

/* Up to the reach the circle is kept, and not far beyond it. */
static void a_circle_is_kept(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "robot = { transit = 600 }, grippers = { { name = 'EE' }, { name = 'LO', at = { -30, 20, -12 }, "
        "rpy = { 0, 0, 25 } } }, stations = { " FOUP "}, "
        "obstacles = { { name = 'camera', on = 'EE', box = { 40, 20, 30 }, at = { -210, 60, 10 } } }, ");
    assert_near(layout->robots[0].transit, 600, 0);
    wh_rounds_t rounds = WH_ROUNDS(4, 40, 0.3);
    while (wh_round(&rounds)) {
        const double from = wh_test_uniform(-5, 5);
        const double to = rounds.number % 4 == 0 ? from : from + wh_test_uniform(-7, 7);
        const wh_real_t begin[WH_ROBOT_AXES] = {0, 0, 0, from}, end[WH_ROBOT_AXES] = {1, 0, 0, to};
        const double reach = wh_transit_reach(layout, 0, 0, begin, end);
        assert_true(reach > 300);
        assert_true(outermost_while_turning(layout, reach, from, to) <= 600 + 1e-6);
        assert_true(outermost_while_turning(layout, reach + 3, from, to) > 600);
        const double least = wh_transit_least(layout, 0, begin, end);
        assert_true(least >= outermost_while_turning(layout, 300, from, to) - 1e-6);
        assert_true(least <= outermost_while_turning(layout, 300, from, to) + 3);
    }
}

/* A blade that turns over, or is turned over; the flip's axis is in the contact plane. */
static void a_circle_is_kept_by_a_flip(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "robot = { transit = 600, flip = {}, rail = {} }, grippers = { { name = 'EE', at = { -30, 20, -12 }, "
        "rpy = { 0, 0, 25 } } }, stations = { " FOUP "}, "
        "obstacles = { { name = 'camera', on = 'EE', box = { 40, 20, 30 }, at = { -210, 60, 40 } } }, ");
    wh_rounds_t rounds = WH_ROUNDS(2, 30, 0.5);
    while (wh_round(&rounds)) {
        const bool is_turned = rounds.number % 2 != 0;
        wh_real_t begin[WH_CARRIER_AXES] = {0, 300, 900, wh_test_uniform(-3, 3), 0, 0};
        wh_real_t end[WH_CARRIER_AXES] = {1, 300, 900, wh_test_uniform(-3, 3), 50, 0};
        begin[5] = wh_test_uniform(0, WH_PI);
        end[5] = !is_turned ? begin[5] : wh_test_uniform(0, WH_PI);
        const double reach = wh_transit_reach(layout, 0, 0, begin, end);
        double most = 0;
        double beyond = 0;
        for (int k = 0; k <= 40; ++k) {
            for (int l = 0; l <= (is_turned ? 40 : 0); ++l) {
                const double yaw = begin[3] + (end[3] - begin[3]) * k / 40;
                const double flip = begin[5] + (end[5] - begin[5]) * l / 40;
                most = fmax(most, outermost(layout, 0, reach, yaw, flip));
                beyond = fmax(beyond, outermost(layout, 0, reach + 3, yaw, flip));
            }
        }
        assert_true(reach > 300 && most <= 600 + 1e-6);
        assert_true(is_turned || beyond > 600);
    }
}

/* Each of two arms has a reach of its own, which depends on the parts on it. */
static void a_circle_is_kept_by_two_arms(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(
        "robot = { kind = 'TRZ', transit = 600, arms = { {}, { heading = 180, height = 10 } } }, grippers = "
        "{ "
        "{ name = 'EE' }, { name = 'UP', arm = 2, at = { 40, 0, 0 } } }, stations = { " FOUP "}, ");
    const wh_real_t begin[WH_CARRIER_AXES] = {0, 300, 900, 0, 300};
    const wh_real_t end[WH_CARRIER_AXES] = {1, 700, 900, 0, 300};
    const wh_real_t aside[WH_CARRIER_AXES] = {0, 700, 900, 0, 700};
    for (size_t arm = 0; arm < 2; ++arm) {
        const double reach = wh_transit_reach(layout, 0, arm, begin, end);
        assert_true(reach > 300 && outermost(layout, arm, reach, 0, 0) <= 600 + 1e-6);
        assert_true(outermost(layout, arm, reach + 3, 0, 0) > 600);
    }
    wh_transit_t transit;
    assert_true(wh_transit_leaves(layout, 0, begin, end, &transit));
    assert_near(transit.r, 700, 0);
    assert_near(transit.reach[0] - transit.reach[1], 40, 0.2);
    assert_false(wh_transit_leaves(layout, 0, begin, begin, &transit));
    assert_false(wh_transit_leaves(layout, 0, begin, aside, &transit)); /* nothing turns */
}

static void the_circle_is_read(void **state) {
    (void)state;
    assert_near(read_sound(CELL)->robots[0].transit, 0, 0);
    expect_refused("robot = { transit = 0 }, " CELL,
                   "cell.lua: robot.transit: 0 (expected a number from 1 to 100000)");
    expect_refused("robot = { transit = 'wide' }, " CELL,
                   "cell.lua: robot.transit: \"wide\" (expected a number from 1 to 100000)");
    const wh_layout_t *plain = read_sound(CELL);
    const uint64_t without = wh_layout_hash(plain);
    assert_true(wh_layout_hash(read_sound("robot = { transit = 500 }, " CELL)) != without &&
                without == wh_layout_hash(read_sound(CELL)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_of_300_mm),
        cmocka_unit_test(shapes_of_smaller_wafers),
        cmocka_unit_test(a_foup_has_its_shell),
        cmocka_unit_test(a_robot_has_its_shapes),
        cmocka_unit_test(a_blade_is_joined_to_the_wrist),
        cmocka_unit_test(names_and_order),
        cmocka_unit_test(own_sizes),
        cmocka_unit_test(obstacles_of_each_kind),
        cmocka_unit_test(obstacle_of_a_mesh),
        cmocka_unit_test(bad_obstacles),
        cmocka_unit_test(bad_shapes),
        cmocka_unit_test(too_many),
        cmocka_unit_test(a_circle_is_kept),
        cmocka_unit_test(a_circle_is_kept_by_a_flip),
        cmocka_unit_test(a_circle_is_kept_by_two_arms),
        cmocka_unit_test(the_circle_is_read),
    };
    return cmocka_run_group_tests(tests, open_sandbox_and_ways, close_sandbox);
}
