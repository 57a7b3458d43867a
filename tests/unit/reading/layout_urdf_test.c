/* Robots with links from a URDF: their parts, the agreement with the robots' kinematics, and the
 * refusals. */
#include <math.h>
#include <stdarg.h>
#include <unistd.h>

#include "support/layout.h"
#include "support/parts.h"
#include "support/random.h"

#include "bodies/urdf_file.h"
#include "layout/arms.h"
#include "layout/axes.h"
#include "layout/layout.h"
#include "layout/links.h"
#include "math/trig.h"

#define GRIPPERS "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, "
#define PREALIGNER "P = { kind = 'prealigner', at = { -600, 0, 950 }, rpy = { 0, 0, 180 } }, "
#define FOUP "F = { kind = 'foup', at = { 760, 0, 900 } }, "
#define STATIONS "stations = { " FOUP PREALIGNER "}, "
#define CELL GRIPPERS STATIONS

/* If a file's links form a loop, liburdfdom keeps them: each holds the next one. */
const char *__lsan_default_suppressions(void);

const char *__lsan_default_suppressions(void) {
    return "leak:liburdfdom_model\n";
}

/* ------------------------------------------------------------------------------------------------ one robot */

/* Writes a text to a new file and returns its path; the caller unlinks it. */
static char *write_file(char path[WH_TEST_PATH], const char *name, const char *text) {
    const int descriptor = mkstemp(wh_test_path(path, name));
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    assert_int_equal(close(descriptor), 0);
    return path;
}

/* All lengths in m, with enough digits to restore their bits. */
static void describe_link(char *text, size_t size, const wh_layout_t *layout, int32_t body) {
    static const char *const names[WH_ARM_BODIES] = {"foot", "lift", "upper", "fore", "hand"};
    size_t length = strlen(text);
    length += (size_t)snprintf(text + length, size - length, "<link name='%s'>",
                               names[body % (int32_t)WH_ARM_BODIES]);
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_part_t *p = &layout->world.parts[i];
        const wh_vec3_t *r = &p->convex.body_from_shape.r;
        const wh_vec3_t *half = &p->convex.half;
        if (p->kind != WH_PART_ARM || p->owner != body) {
            continue;
        }
        length += (size_t)snprintf(text + length, size - length,
                                   "<collision><origin xyz='%.17g %.17g %.17g'/><geometry>", r->x / 1000,
                                   r->y / 1000, r->z / 1000);
        length +=
            (size_t)(p->convex.kind == WH_CONVEX_BOX
                         ? snprintf(text + length, size - length, "<box size='%.17g %.17g %.17g'/>",
                                    half->x / 500, half->y / 500, half->z / 500)
                         : snprintf(text + length, size - length, "<cylinder radius='%.17g' length='%.17g'/>",
                                    half->x / 1000, half->z / 500));
        length += (size_t)snprintf(text + length, size - length, "</geometry></collision>");
    }
    (void)snprintf(text + length, size - length, "</link>");
}

static void describe_joint(char *text, size_t size, const char *name, const char *type, const char *parent,
                           const char *child, double x) {
    const size_t length = strlen(text);
    (void)snprintf(text + length, size - length,
                   "<joint name='%s' type='%s'><parent link='%s'/><child link='%s'/><origin xyz='%.17g 0 0'/>"
                   "<axis xyz='0 0 1'/><limit lower='-100' upper='100' effort='1' velocity='1'/></joint>",
                   name, type, parent, child, x / 1000);
}

/* A URDF of a robot's one arm, part for part. */
static void describe_arm_of(char *text, size_t size, const wh_layout_t *layout, size_t robot) {
    const wh_arm_t *arm = wh_layout_arm_lengths(layout, robot);
    const bool is_scara = wh_layout_is_scara(layout, robot);
    (void)snprintf(text, size, "<robot name='arm'><link name='ee'/>");
    for (int32_t body = 0; body < (int32_t)WH_ARM_BODIES; ++body) {
        describe_link(text, size, layout, (int32_t)(robot * WH_ARM_BODIES) + body);
    }
    describe_joint(text, size, "z", "prismatic", "foot", "lift", 0);
    describe_joint(text, size, "j1", "continuous", "lift", "upper", 0);
    describe_joint(text, size, "j2", "continuous", "upper", "fore",
                   is_scara ? layout->carrier.chain.links[0] : arm->link);
    describe_joint(text, size, "j3", "continuous", "fore", "hand",
                   is_scara ? layout->carrier.chain.links[1] : arm->link);
    describe_joint(text, size, "flange", "fixed", "hand", "ee", is_scara ? 0 : arm->reach);
    const size_t length = strlen(text);
    (void)snprintf(text + length, size - length, "</robot>");
}

static void expect_same_parts(const wh_layout_t *a, const wh_layout_t *b) {
    assert_int_equal(a->world.part_count, b->world.part_count);
    for (size_t i = 0; i < a->world.part_count; ++i) {
        const wh_part_t *p = &a->world.parts[i];
        const wh_part_t *q = &b->world.parts[i];
        assert_true(p->kind == q->kind && p->owner == q->owner && p->convex.kind == q->convex.kind);
        assert_memory_equal(&p->convex.half, &q->convex.half, sizeof p->convex.half);
        for (size_t k = 0; k < 9; ++k) {
            assert_near(p->convex.body_from_shape.R.m[k / 3][k % 3],
                        q->convex.body_from_shape.R.m[k / 3][k % 3], 0);
        }
        assert_near(p->convex.body_from_shape.r.x, q->convex.body_from_shape.r.x, 0);
        assert_near(p->convex.body_from_shape.r.y, q->convex.body_from_shape.r.y, 0);
        assert_near(p->convex.body_from_shape.r.z, q->convex.body_from_shape.r.z, 0);
    }
}

/* A cell's world while its robot moves. */
typedef struct {
    const wh_layout_t *layout;
    wh_world_t *world;
    wh_links_t links;
    wh_event_t events[16];
    wh_event_list_t list;
} going_t;

static void go_to(going_t *going, uint64_t slice, const double axes[]) {
    const wh_layout_t *layout = going->layout;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_pose_t poses[WH_GRIPPERS];
    memset(grippers, 0, sizeof grippers);
    wh_machine_grippers(&layout->machine, axes, poses);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        grippers[g].base_from_gripper = poses[g];
        grippers[g].wafer = grippers[g].approach.wafer = grippers[g].contest.wafer = WH_NONE;
    }
    wh_links_at(&going->links, layout, axes);
    const wh_world_input_t input = {slice, layout->start, grippers, going->links.bodies, NULL};
    if (going->world) {
        wh_world_step(going->world, &input, &going->list);
    } else {
        const size_t bytes = wh_world_bytes(&layout->world);
        going->world = wh_world_init(&layout->world, &input, calloc(1, bytes), bytes);
    }
}

static void expect_same_end(const going_t going[2]) {
    assert_int_equal(going[0].list.count, going[1].list.count);
    for (size_t i = 0; i < going[0].list.count; ++i) {
        assert_true(going[0].events[i].kind == going[1].events[i].kind);
        assert_memory_equal(going[0].events[i].parts, going[1].events[i].parts,
                            sizeof going[0].events[i].parts);
    }
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        const wh_clearance_t *p = &wh_world_clearances(going[0].world)[kind];
        const wh_clearance_t *q = &wh_world_clearances(going[1].world)[kind];
        assert_memory_equal(&p->gap, &q->gap, sizeof p->gap);
        assert_true(p->slice == q->slice && p->parts[0] == q->parts[0] && p->parts[1] == q->parts[1]);
    }
}

/* Both robots do the same; returns the events of both. */
static size_t expect_same_run(const wh_layout_t *a, const wh_layout_t *b, uint64_t slices) {
    going_t going[2] = {{.layout = a}, {.layout = b}};
    double axes[WH_AXES];
    double rate[WH_AXES] = {0};
    wh_machine_home(&a->machine, axes);
    for (size_t i = 0; i < wh_machine_robot_axes(&a->machine); ++i) {
        const wh_travel_t *travel = wh_machine_travel(&a->machine, i);
        const double to = i == 0 ? wh_test_uniform(-3, 3) : wh_test_uniform(travel->min, travel->max);
        rate[i] = (to - axes[i]) / (double)slices;
    }
    for (uint64_t slice = 0; slice < slices; ++slice) {
        for (int k = 0; k < 2; ++k) {
            going[k].list = (wh_event_list_t){going[k].events, 16, slice > 0 ? going[k].list.count : 0};
            go_to(&going[k], slice, axes);
        }
        for (size_t i = 0; i < WH_AXES; ++i) {
            axes[i] += rate[i];
        }
    }
    expect_same_end(going);
    free(going[0].world);
    free(going[1].world);
    return going[0].list.count;
}

/* Part for part the usual arm's shapes: all bits of the gaps are the usual arm's. */
static void a_urdf_of_the_usual_arm_is_the_usual_arm(void **state) {
    (void)state;
    static const char *const robots[][2] = {
        {"", "joints = { z = 'z', j1 = 'shoulder', j2 = 'elbow', j3 = 'wrist' }"},
        {"kind = 'TRZ', at = { 10, 20, 30 }, heading = 33, ",
         "joints = { z = 'z', j1 = 'shoulder', j2 = 'elbow', j3 = 'wrist' }"},
        {"tilt = {}, rail = {}, ", NULL}, /* its column tilts: no link of this URDF does */
        {"kind = 'SCARA', links = { 410.5, 390.25 }, ",
         "joints = { z = 'z', j1 = 'theta', j2 = 'forearm', j3 = { axis = 'yaw', factor = 1, offset = 0 } }"},
    };
    static char text[16384];
    size_t events = 0;
    for (size_t i = 0; i < sizeof robots / sizeof robots[0]; ++i) {
        char fields[2048];
        char path[WH_TEST_PATH];
        const bool right = i == 1;
        const char *shapes = right ? "shapes = { arm = { right_handed = true } }, collision = true, " CELL
                                   : "collision = true, " CELL;
        (void)snprintf(fields, sizeof fields, "robot = { %s }, %s", robots[i][0], shapes);
        const wh_layout_t *usual = read_sound(fields);
        describe_arm_of(text, sizeof text, usual, 0);
        write_file(path, "arm", text);
        const char *joints = robots[i][1] ? robots[i][1] : robots[0][1];
        (void)snprintf(fields, sizeof fields, "robot = { %s urdf = '%s', tool = 'ee', %s }, %s", robots[i][0],
                       path, joints, shapes);
        if (!robots[i][1]) {
            expect_refused(fields, "where the end-effector is, to 1e-06 mm and 1e-09 rad");
            assert_int_equal(unlink(path), 0);
            continue;
        }
        const wh_layout_t *layout = read_sound(fields);
        assert_int_equal(unlink(path), 0);
        assert_non_null(layout->robots[0].urdf);
        assert_true(layout->shapes.arm.right_handed == right);
        expect_same_parts(usual, layout);
        assert_true(wh_layout_world_hash(usual) == wh_layout_world_hash(layout));
        for (int run = 0; run < 12; ++run) {
            events += expect_same_run(usual, layout, 60);
        }
    }
    assert_true(events > 0);
}

#define FOLDING                                                                                              \
    "<robot name='arm'>"                                                                                     \
    "<link name='foot'><collision><origin xyz='0 0 0.1'/><geometry><cylinder radius='0.12' length='0.2'/>"   \
    "</geometry></collision></link>"                                                                         \
    "<joint name='lift' type='prismatic'><parent link='foot'/><child link='column'/><axis xyz='0 0 1'/>"     \
    "<limit lower='0.3' upper='1.5' effort='1' velocity='1'/></joint><link name='column'/>"                  \
    "<joint name='turn' type='continuous'><parent link='column'/><child link='table'/><axis xyz='0 0 1'/>"   \
    "</joint><link name='table'/>"                                                                           \
    "<joint name='q3' type='continuous'><parent link='table'/><child link='upper'/><axis xyz='0 0 1'/>"      \
    "</joint><link name='upper'><collision><origin xyz='0.172 0 -0.1375'/><geometry>"                        \
    "<box size='0.414 0.07 0.045'/></geometry></collision></link>"                                           \
    "<joint name='elbow' type='continuous'><parent link='upper'/><child link='fore'/>"                       \
    "<origin xyz='0.344 0 0'/><axis xyz='0 0 1'/><mimic joint='q3' multiplier='-2'/></joint>"                \
    "<link name='fore'><visual><origin xyz='0.172 0 -0.0875'/><geometry>MESH</geometry></visual></link>"     \
    "<joint name='wrist' type='continuous'><parent link='fore'/><child link='hand'/>"                        \
    "<origin xyz='0.344 0 0'/><axis xyz='0 0 1'/><mimic joint='q3'/></joint>"                                \
    "<link name='hand'><collision><origin xyz='0 0 -0.03'/><geometry><sphere radius='0.025'/></geometry>"    \
    "</collision></link>"                                                                                    \
    "<joint name='flange' type='fixed'><parent link='hand'/><child link='ee'/><origin xyz='0.25 0 0'/>"      \
    "</joint><link name='ee'/></robot>"

/* A box of 412 by 70 by 44 mm with a dent in its middle. */
static const char dented[] = "solid s\n"
#define FACET(a, b, c)                                                                                       \
    "facet normal 0 0 0 outer loop vertex " a " vertex " b " vertex " c " endloop endfacet\n"
    FACET("-206 -35 -22", "206 -35 -22", "0 0 0") FACET("206 35 -22", "-206 35 -22", "0 0 0")
        FACET("-206 -35 22", "206 -35 22", "206 35 22") FACET("-206 -35 22", "206 35 22", "-206 35 22")
            FACET("-206 -35 -22", "-206 35 -22", "0 0 0")
                FACET("206 -35 -22", "206 35 -22", "0 0 0") "endsolid s\n";

static void replace(char *text, size_t size, const char *from, const char *to) {
    static char rest[16384];
    char *at = strstr(text, from);
    assert_non_null(at);
    (void)snprintf(rest, sizeof rest, "%s", at + strlen(from));
    (void)snprintf(at, size - (size_t)(at - text), "%s%s", to, rest);
}

/* Writes FOLDING to a file, with one text replaced by another, and a box instead of a MESH that is left. */
static void write_folding(char path[WH_TEST_PATH], const char *from, const char *to) {
    static char text[16384];
    (void)snprintf(text, sizeof text, "%s", FOLDING);
    replace(text, sizeof text, from, to);
    if (strstr(text, "MESH")) {
        replace(text, sizeof text, "MESH", "<box size='0.4 0.1 0.1'/>");
    }
    write_file(path, "folding", text);
}

static void folding_fields(char *fields, size_t size, const char *path, const char *more) {
    (void)snprintf(
        fields, size,
        "robot = { kind = 'TRZ', r = { min = 260, home = 300 }, urdf = '%s', %s }, collision = true, " CELL,
        path, more);
}

#define DRIVEN "tool = 'ee', joints = { lift = 'z', turn = 'theta', q3 = 'fold' }"

static uint64_t hash_of_folding(const char *mesh) {
    char fields[2048];
    char path[WH_TEST_PATH];
    write_folding(path, "MESH", mesh);
    folding_fields(fields, sizeof fields, path, DRIVEN);
    const wh_layout_t *layout = read_sound(fields);
    assert_int_equal(unlink(path), 0);
    assert_near(layout->shapes.arm.link, 344, 0);
    assert_near(layout->shapes.arm.reach, 250, 0);
    return wh_layout_world_hash(layout);
}

static void a_mesh_becomes_its_hull(void **state) {
    (void)state;
    char fields[2048];
    char path[WH_TEST_PATH];
    char stl[WH_TEST_PATH];
    char mesh[512];
    write_file(stl, "mesh", dented);
    (void)snprintf(mesh, sizeof mesh, "<mesh filename='file://%s' scale='0.001 -0.001 0.0005'/>", stl);
    write_folding(path, "MESH", mesh);
    folding_fields(fields, sizeof fields, path, DRIVEN);
    const wh_layout_t *layout = read_sound(fields);
    const wh_part_t *hull = part(layout, "fore hull");
    assert_int_equal(hull->owner, WH_ARM_FOREARM);
    assert_int_equal(hull->convex.point_count, 8);
    assert_near(hull->convex.points[0].x, -206, 1e-9);
    assert_near(hull->convex.points[0].y, 35, 1e-9);
    assert_near(hull->convex.points[0].z, -11, 1e-9);
    assert_near(hull->convex.body_from_shape.r.x, 172, 0);
    const wh_part_t *ball = part(layout, "hand");
    assert_true(ball->convex.kind == WH_CONVEX_CAPSULE && ball->owner == WH_ARM_HAND);
    assert_near(ball->convex.half.x, 25, 0);
    const uint64_t of_mesh = hash_of_folding(mesh);
    assert_true(wh_layout_world_hash(layout) == of_mesh);
    (void)snprintf(mesh, sizeof mesh, "<mesh filename='file://%s' scale='0.001 -0.001 0.0006'/>", stl);
    assert_true(hash_of_folding(mesh) != of_mesh);
    const uint64_t of_box = hash_of_folding("<box size='0.4 0.1 0.1'/>");
    assert_true(of_box != of_mesh && hash_of_folding("<box size='0.4 0.1 0.101'/>") != of_box);
    assert_int_equal(unlink(stl), 0);
    assert_int_equal(unlink(path), 0);
    assert_true(strstr(layout->part_names[find(layout, "upper")], "hull") == NULL);
}

/* In FOLDING `to` replaces `from`, and the robot has `more`. */
static const struct {
    const char *from, *to, *more, *message;
} urdf_cases[] = {
    {"MESH", "<box size='1 1 1'/>", "tool = 'ee', joints = { lift = 'z', turn = 'theta' }",
     "cell.lua: robot.joints.q3: nothing (expected an axis, or { axis = , factor = , offset = }"},
    {"MESH", "<box size='1 1 1'/>", "tool = 'ee', joints = { lift = 'z', turn = 'thta', q3 = 'fold' }",
     "robot.joints.turn: \"thta\" (expected what this robot has: theta, r, z, fold, shoulder, elbow, "
     "wrist)"},
    {"MESH", "<box size='1 1 1'/>", "tool = 'ee', joints = { lift = 'theta', turn = 'theta', q3 = 'fold' }",
     "robot.joints.lift: \"theta\" (expected an axis that slides, as joint \"lift\" of"},
    {"MESH", "<box size='1 1 1'/>", "tool = 'ee', joints = { elbow = 'fold' }",
     "robot.joints.elbow: \"fold\" (expected one of the fields lift turn q3"},
    {"MESH", "<box size='1 1 1'/>", "joints = { lift = 'z', turn = 'theta', q3 = 'fold' }",
     "robot.tool: nothing (expected"},
    {"MESH", "<box size='1 1 1'/>", "tool = 'hnd', joints = { lift = 'z', turn = 'theta', q3 = 'fold' }",
     "robot.tool: \"hnd\" (expected a link of "},
    {"MESH", "<box size='1 1 1'/>", "tool = 'hand', joints = { lift = 'z', turn = 'theta', q3 = 'fold' }",
     "\"hand\" (expected a link without shapes"},
    {"MESH", "<box size='1 1 1'/>",
     "tool = 'ee', joints = { lift = 'z', turn = 'theta', q3 = { axis = 'fold', offset = 1 } }",
     "(expected \"ee\" where the end-effector is, to 1e-06 mm and 1e-09 rad; at theta "},
    {"MESH", "<box size='1 0 1'/>", DRIVEN, "one of link \"fore\": "},
    {"MESH", "<mesh filename='no_such.stl'/>", DRIVEN,
     "robot.urdf: \"no_such.stl\" (expected an STL mesh for link \"fore\": "},
    {"MESH", "<mesh filename='a.stl' scale='1 0 1'/>", DRIVEN,
     "link \"fore\": scale 1 0 1 of mesh \"a.stl\""},
    {"MESH", "<mesh filename='package://my/a.stl'/>", DRIVEN,
     "\"package://my/a.stl\" (expected packages = { [\"my\"] = \"FOLDER\" } beside urdf)"},
    {"MESH", "<mesh filename='http://my/a.stl'/>", DRIVEN, "\"http://my/a.stl\" (expected a mesh beside "},
    {"MESH", "<mesh filename='file://a.stl'/>", DRIVEN,
     "robot.urdf: \"file://a.stl\" (expected a mesh beside "},
    {"0.25 0 0", "1e308 0 0", DRIVEN, "joint \"flange\": origin inf 0 0 m (expected within 100 m)"},
    {"0.25 0 0", "0.25 0.002 0", DRIVEN, "it is 2 mm and 0 degrees off: at ("},
    {"<origin xyz='0.344 0 0'/>", "<origin xyz='0.345 0 0'/>", DRIVEN,
     "(expected \"ee\" where the end-effector is"},
    {"multiplier='-2'", "multiplier='-1.9'", DRIVEN, "(expected \"ee\" where the end-effector is"},
    {"<mimic joint='q3'/>", "<mimic joint='q4'/>", DRIVEN,
     "joint \"wrist\" mimics \"q4\" (expected a joint that turns, too)"},
    {"<mimic joint='q3'/>", "<mimic joint='wrist'/>", DRIVEN, "joint \"wrist\" mimics itself"},
    {"<mimic joint='q3'/>", "<mimic joint='lift'/>", DRIVEN, "joint \"wrist\" mimics \"lift\""},
    {"lower='0.3' upper='1.5'", "lower='0.3' upper='0.9'", DRIVEN,
     "(expected travels within the limits of joint \"lift\", 300 to 900; at theta "},
    {"name='turn' type='continuous'", "name='turn' type='planar'", DRIVEN,
     "joint \"turn\": type planar (expected revolute, continuous, prismatic or fixed)"},
    {"<axis xyz='0 0 1'/>", "<axis xyz='0 0 0'/>", DRIVEN,
     "joint \"lift\": axis 0 0 0 (expected a direction)"},
    {"<child link='ee'/>", "<child link='hand'/>", DRIVEN, "(expected"},
    {"<parent link='foot'/>", "<parent link='fore'/>", DRIVEN, "(expected a URDF file: "},
    {"<link name='ee'/>", "<link name='ee'/><link name='ee'/>", DRIVEN, "(expected a URDF file: "},
    {"</robot>", "", DRIVEN, ": at its end: Error reading Element value. (expected XML)"},
    {"</robot>", "</robt>", DRIVEN, ": Error reading end tag. (expected XML)"},
    {"<link name='ee'/>", "<link name='ee'></lnk>", DRIVEN, ": line "},
    {"<link name='ee'/>", "<xacro:include filename='ee.xacro'/>", DRIVEN,
     ": it is written for xacro (expected what `xacro FILE` makes of it)"},
    {"<link name='ee'/>", "<link name='${prefix}ee'/>", DRIVEN, ": it is written for xacro"},
    {"xyz='0.25 0 0'", "xyz='0.25 0 0' rpy='0 0 3.141592653589793'", DRIVEN, "mm and 180 degrees off: at ("},
    {"xyz='0.25 0 0'", "xyz='0.25 0 0' rpy='0 1 0'", DRIVEN, "it is 0 mm and 57.2957795 degrees off: at ("},
    {"xyz='0.25 0 0'", "xyz='0.25 0 0' rpy='0 0 2e-9'", DRIVEN, " it is 0 mm and 1.14591"},
    {"<link name='table'/>",
     "<link name='table'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>", DRIVEN,
     "\"table\" moves with none of them"},
};

static void bad_urdfs(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof urdf_cases / sizeof urdf_cases[0]; ++i) {
        char fields[2048];
        char path[WH_TEST_PATH];
        write_folding(path, urdf_cases[i].from, urdf_cases[i].to);
        folding_fields(fields, sizeof fields, path, urdf_cases[i].more);
        expect_refused(fields, urdf_cases[i].message);
        assert_int_equal(unlink(path), 0);
    }
    expect_refused("robot = { urdf = 'no_such.urdf' }, " CELL,
                   "cell.lua: robot.urdf: \"no_such.urdf\" (expected a URDF file: no_such.urdf: No such file "
                   "or directory)");
    expect_refused("robot = { urdf = '/' }, " CELL, "/: it is no regular file");
    expect_refused("robot = { tool = 'ee' }, " CELL, "robot.tool: \"ee\" (expected nothing without urdf)");
}

/* The replacement of a text of FOLDING, and the message about it. */
static const struct {
    const char *from, *to, *error;
} unreadable[] = {
    {"MESH", "<box size='nan 1 1'/>", "component [nan] to a double"},
    {"MESH", "<box size='0,36 1 1'/>", "component [0,36] to a double"},
    {"MESH", "<box size='1 1'/>", "2 elements but 3 expected"},
    {"MESH", "<box size='1 %s%s%s%n 1'/>", "component [%s%s%s%n] to a double"},
    {"MESH", "<box/>", "Box shape has no size attribute"},
    {"MESH", "<cylinder radius='nan' length='1'/>", "radius [nan] is not a valid float"},
    {"MESH", "<cylinder radius='1' length='1,5'/>", "length [1,5] is not a valid float"},
    {"MESH", "<cylinder length='1'/>", "Cylinder shape must have both length and radius"},
    {"MESH", "<sphere/>", "Sphere shape must have a radius attribute"},
    {"MESH", "<sphere radius='1e400'/>", "radius [1e400] is not a valid float"},
    {"MESH", "<sphere radius='0x1'/>", "radius [0x1] is not a valid float"},
    {"MESH", "<capsule radius='1' length='1'/>", "Unknown geometry type 'capsule'"},
    {"MESH", "", "Geometry tag contains no child element."},
    {"MESH", "<mesh/>", "Mesh must contain a filename attribute"},
    {"MESH", "<mesh filename='a.stl' scale='nan 1 1'/>", "component [nan] to a double"},
    {"<geometry>MESH</geometry>", "", "Could not parse visual element for Link [fore]"},
    {"xyz='0.172 0 -0.0875'", "xyz='0.172 inf -0.0875'", "component [inf] to a double"},
    {"xyz='0.172 0 -0.0875'", "xyz='0.172 0 -0.0875' rpy='0 0x1 0'", "component [0x1] to a double"},
    {"<link name='fore'>", "<link name='fore'><inertial/>", "Inertial element must have a mass element"},
    {"<link name='fore'>", "<link name='fore'><collision><geometry><box size='a'/></geometry></collision>",
     "component [a] to a double"},
};

/* A shape that cannot be read does not affect others, and nothing replaces it. */
static void what_cannot_be_read_refuses_the_file(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof unreadable / sizeof unreadable[0]; ++i) {
        char path[WH_TEST_PATH];
        char message[1024];
        static wh_urdf_file_t file;
        write_folding(path, unreadable[i].from, unreadable[i].to);
        assert_false(wh_urdf_read(path, &file, message, sizeof message));
        assert_int_equal(unlink(path), 0);
        if (strncmp(message, path, strlen(path)) != 0 || !strstr(message, unreadable[i].error) ||
            !strstr(message, " element for Link [fore]")) {
            fail_msg("\"%s\" in place of \"%s\": %s", unreadable[i].to, unreadable[i].from, message);
        }
    }
}

/* liburdfdom reads these as if the rejected parts were not there. */
static void what_it_passes_over_refuses_the_file(void **state) {
    (void)state;
    static const char *const over[][3] = {
        {"MESH", "<sphere radius='1'/><box size='1 1 1'/>",
         "link \"fore\": visual (expected one geometry in it, with one shape)"},
        {"<geometry>MESH</geometry>",
         "<geometry><sphere radius='1'/></geometry><geometry><box size='1 1 1'/></geometry>",
         "link \"fore\": visual (expected one geometry"},
        {"<link name='fore'>",
         "<link name='fore'><colision><geometry><box size='1 1 1'/></geometry></colision>",
         "link \"fore\": element \"colision\" (expected collision, visual or others; did you mean "
         "collision?)"}};
    for (size_t i = 0; i < sizeof over / sizeof over[0]; ++i) {
        static wh_urdf_file_t file;
        char path[WH_TEST_PATH];
        char message[1024] = "";
        write_folding(path, over[i][0], over[i][1]);
        assert_false(wh_urdf_read(path, &file, message, sizeof message));
        assert_int_equal(unlink(path), 0);
        if (!strstr(message, over[i][2]) || !strstr(message, ": line ")) {
            fail_msg("%s", message);
        }
    }
}

/* The paint of a link has no effect, and % is a letter like any other. */
static void paint_and_percents_are_read(void **state) {
    (void)state;
    static const char *const paints[] = {"<material name='no such'/>",
                                         "<material name='red'><color rgba='1 0 0 x'/></material>",
                                         "<material name='red'><color rgba='1 0 0 1'/></material>"};
    for (size_t i = 0; i < sizeof paints / sizeof paints[0]; ++i) {
        static wh_urdf_file_t file;
        char path[WH_TEST_PATH];
        char message[1024] = "";
        char shape[512];
        (void)snprintf(shape, sizeof shape, "<geometry><mesh filename='100%%s.stl'/></geometry>%s",
                       paints[i]);
        write_folding(path, "<geometry>MESH</geometry>", shape);
        if (!wh_urdf_read(path, &file, message, sizeof message)) {
            fail_msg("%s", message);
        }
        assert_int_equal(unlink(path), 0);
        assert_int_equal(file.shape_count, 4);
        assert_string_equal(file.shapes[2].mesh, "100%s.stl");
    }
}

/* ------------------------------------------------------------------------------------------ several robots */

static void put(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));

static void put(char *text, size_t size, const char *format, ...) {
    const size_t length = strlen(text);
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text + length, size - length, format, values);
    va_end(values);
}

static void put_joint(char *text, size_t size, const char *name, const char *parent, const char *child,
                      double x, const char *axis) {
    const bool slides = strcmp(name, "rail") == 0 || strcmp(name, "z") == 0;
    put(text, size,
        "<joint name='%s' type='%s'><parent link='%s'/><child link='%s'/><origin xyz='%.17g 0 0'/>"
        "<axis xyz='%s'/><limit lower='-9' upper='9' effort='1' velocity='1'/></joint>",
        name, slides ? "prismatic" : "continuous", parent, child, x / 1000, axis);
}

/* The place of each link's shape in its link's frame, mm. */
static const double middles[WH_ARM_BODIES][3] = {
    {20, -15, 100}, {5, 10, -260}, {150, -7, -137}, {160, 9, -87}, {-12, 4, -30}};
static const char *const link_names[WH_ARM_BODIES] = {"foot", "lift", "upper", "fore", "hand"};

/* An arm on a rail, with a joint for theta and one for the upper arm, and a blade that turns over. */
static void describe_robot(char *text, size_t size, const double links[2], double reach) {
    (void)snprintf(text, size,
                   "<robot name='arm'><link name='ground'/><link name='table'/><link name='ee'/>");
    for (size_t i = 0; i < WH_ARM_BODIES; ++i) {
        put(text, size,
            "<link name='%s'><collision><origin xyz='%.17g %.17g %.17g'/><geometry><box size='0.1 0.06 "
            "0.03'/>"
            "</geometry></collision></link>",
            link_names[i], middles[i][0] / 1000, middles[i][1] / 1000, middles[i][2] / 1000);
    }
    put_joint(text, size, "rail", "ground", "foot", 0, "1 0 0");
    put_joint(text, size, "z", "foot", "lift", 0, "0 0 1");
    put_joint(text, size, "turn", "lift", "table", 0, "0 0 1");
    put_joint(text, size, "j1", "table", "upper", 0, "0 0 1");
    put_joint(text, size, "j2", "upper", "fore", links[0], "0 0 1");
    put_joint(text, size, "j3", "fore", "hand", links[1], "0 0 1");
    put_joint(text, size, "flip", "hand", "ee", reach, "1 0 0");
    put(text, size, "</robot>");
}

/* A place and a heading, by plain trigonometry. */
typedef struct {
    double x, y, z, heading;
} place_t;

static place_t go(place_t from, double x, double y, double z, double turn) {
    const double c = cos(from.heading);
    const double s = sin(from.heading);
    return (place_t){from.x + c * x - s * y, from.y + s * x + c * y, from.z + z, from.heading + turn};
}

/* One of the robots of PLACED, with its arm's lengths. */
typedef struct {
    const char *name;
    double at[3], heading;
    double links[2], reach;
} placed_t;

static const placed_t placed[] = {
    {"A", {-1500, 200, 35}, 40, {410.5, 390.25}, 0},
    {"B", {1200, -300, -20}, 215, {351.5, 351.5}, 222.25},
    {"C", {0, 2500, 10}, -75, {344.5, 344.5}, 250},
};
enum { PLACED = sizeof placed / sizeof placed[0] };

static const char placed_text[] =
    "robots = { "
    "A = { kind = 'SCARA', at = { -1500, 200, 35 }, heading = 40, links = { 410.5, 390.25 }, rail = {}, "
    "flip = {}, urdf = '%s', tool = 'ee', joints = { rail = 'rail', z = 'z', turn = {}, j1 = 'theta', "
    "j2 = 'forearm', j3 = 'yaw', flip = 'flip' } }, "
    "B = { kind = 'TRZ', at = { 1200, -300, -20 }, heading = 215, rail = {}, r = { min = 260 }, "
    "urdf = '%s', tool = 'ee', joints = { rail = 'rail', z = 'z', turn = 'theta', j1 = 'fold', "
    "j2 = { axis = 'fold', factor = -2 }, j3 = 'fold', flip = {} } }, "
    "C = { kind = 'TRZY', at = { 0, 2500, 10 }, heading = -75, yaw = { min = -20, max = 20 }, "
    "urdf = '%s', tool = 'ee', joints = { rail = {}, z = 'z', turn = {}, j1 = 'shoulder', j2 = 'elbow', "
    "j3 = 'wrist', flip = {} } } }, "
    "grippers = { { name = 'a', on = 'A' }, { name = 'b', on = 'B' }, { name = 'c', on = 'C' } }, "
    "stations = { S = { at = { 1900, -300, 900 }, by = { B = { rail = 0 } } } }, collision = true, ";

static const wh_layout_t *read_placed(void) {
    static char text[8192];
    char paths[PLACED][WH_TEST_PATH];
    char fields[3000];
    for (size_t i = 0; i < PLACED; ++i) {
        describe_robot(text, sizeof text, placed[i].links, placed[i].reach);
        write_file(paths[i], "placed", text);
    }
    (void)snprintf(fields, sizeof fields, placed_text, paths[0], paths[1], paths[2]);
    const wh_layout_t *layout = read_sound(fields);
    for (size_t i = 0; i < PLACED; ++i) {
        assert_int_equal(unlink(paths[i]), 0);
    }
    return layout;
}

/* A robot's axis by its name among the machine's axes; 0 if it has none. */
static double axis(const wh_layout_t *layout, const double axes[], const char *robot, const char *name) {
    for (size_t i = 0; i < wh_machine_robot_axes(&layout->machine); ++i) {
        size_t own;
        const int32_t of = wh_machine_robot_of(&layout->machine, i, &own);
        if (strcmp(layout->robots[of].name, robot) == 0 &&
            strcmp(wh_axis_name(&layout->machine, i), name) == 0) {
            return axes[i];
        }
    }
    return 0;
}

/* The angles of the three joints at the arm's links, each against the one before it. */
static void solve_arm(const wh_layout_t *layout, const double axes[], const placed_t *robot,
                      double joints[3]) {
    const double theta = axis(layout, axes, robot->name, "theta");
    const double r = axis(layout, axes, robot->name, "r");
    const double yaw = axis(layout, axes, robot->name, "yaw");
    joints[0] = theta;
    joints[1] = axis(layout, axes, robot->name, "forearm");
    joints[2] = yaw;
    if (robot->reach > 0) {
        const double x = r - robot->reach * cos(yaw);
        const double y = -robot->reach * sin(yaw);
        const double fold = acos(hypot(x, y) / (2 * robot->links[0]));
        joints[0] = theta + atan2(y, x) + fold;
        joints[1] = -2 * fold;
        joints[2] = theta + yaw - joints[0] - joints[1];
    }
}

static void expect_at(const wh_layout_t *layout, const wh_links_t *links, const char *name, place_t there) {
    const wh_part_t *p = part(layout, name);
    const wh_pose_t is = wh_pose_compose(&links->bodies[p->owner], &p->convex.body_from_shape);
    assert_near(is.r.x, there.x, 1e-6);
    assert_near(is.r.y, there.y, 1e-6);
    assert_near(is.r.z, there.z, 1e-6);
    assert_near(is.R.m[0][0], cos(there.heading), 1e-9);
    assert_near(is.R.m[1][0], sin(there.heading), 1e-9);
}

static void expect_robot(const wh_layout_t *layout, const double axes[], size_t index) {
    const placed_t *robot = &placed[index];
    const double turn = robot->heading * acos(-1) / 180;
    const double flip = axis(layout, axes, robot->name, "flip");
    double joints[3];
    place_t at[WH_ARM_BODIES];
    wh_links_t links;
    wh_pose_t effector;
    solve_arm(layout, axes, robot, joints);
    const place_t foot = {robot->at[0], robot->at[1], robot->at[2], turn};
    at[0] = go(foot, axis(layout, axes, robot->name, "rail"), 0, 0, 0);
    at[1] = go(at[0], 0, 0, axis(layout, axes, robot->name, "z"), 0);
    at[2] = go(at[1], 0, 0, 0, joints[0]);
    at[3] = go(at[2], robot->links[0], 0, 0, joints[1]);
    at[4] = go(at[3], robot->links[1], 0, 0, joints[2]);
    wh_links_at(&links, layout, axes);
    for (size_t i = 0; i < WH_ARM_BODIES; ++i) {
        char name[80];
        (void)snprintf(name, sizeof name, "%s %s", robot->name, link_names[i]);
        expect_at(layout, &links, name, go(at[i], middles[i][0], middles[i][1], middles[i][2], 0));
        assert_int_equal(part(layout, name)->owner, WH_ARM_BODIES * index + i);
    }
    const place_t tool = go(at[4], robot->reach, 0, 0, 0);
    wh_machine_effector(&layout->machine, index, axes, &effector);
    assert_near(effector.r.x, tool.x, 1e-6);
    assert_near(effector.r.y, tool.y, 1e-6);
    assert_near(effector.r.z, tool.z, 1e-6);
    assert_near(effector.R.m[0][0], cos(tool.heading), 1e-9);
    assert_near(effector.R.m[2][2], cos(flip), 1e-9);
}

static void configure(const wh_layout_t *layout, double axes[]) {
    wh_machine_home(&layout->machine, axes);
    for (size_t i = 0; i < wh_machine_robot_axes(&layout->machine); ++i) {
        const wh_travel_t *travel = wh_machine_travel(&layout->machine, i);
        axes[i] = wh_test_uniform(travel->min, travel->max);
    }
}

/* A SCARA with a flip, an arm that one motor folds, both on a rail, and a usual arm: in other
 * places, turned, each with a file of its own. */
static void each_robot_has_its_links_where_its_urdf_says(void **state) {
    (void)state;
    const wh_layout_t *layout = read_placed();
    assert_int_equal(layout->robot_count, PLACED);
    for (size_t i = 1; i < PLACED; ++i) {
        assert_near(wh_layout_arm_lengths(layout, i)->link, placed[i].links[0], 0);
        assert_near(wh_layout_arm_lengths(layout, i)->reach, placed[i].reach, 0);
    }
    for (int k = 0; k < 500; ++k) {
        double axes[WH_AXES];
        configure(layout, axes);
        for (size_t i = 0; i < PLACED; ++i) {
            expect_robot(layout, axes, i);
        }
    }
}

#define TWO_GRIPPERS                                                                                         \
    "grippers = { { name = 'a', on = 'A' }, { name = 'b', on = 'B' } }, "                                    \
    "stations = { S = { at = { -700, 0, 900 }, rpy = { 0, 0, 180 } } }, collision = true, "

/* One robot with a URDF of its usual shapes: all bits are those of the usual cell. */
static void a_urdf_of_one_of_two_is_the_usual_cell(void **state) {
    (void)state;
    static const char usual_text[] =
        "robots = { A = {%s}, B = { kind = 'TRZ', at = { 2000, 90, 0 }, heading = "
        "170%s } }, shapes = { arms = { %s B = { right_handed = true } } }, " TWO_GRIPPERS;
    static const char driven[] =
        ", urdf = '%s', tool = 'ee', joints = { z = 'z', j1 = 'shoulder', j2 = 'elbow', j3 = 'wrist' }";
    static char text[16384];
    for (size_t robot = 0; robot < 2; ++robot) {
        char path[WH_TEST_PATH];
        char fields[2000];
        char more[300];
        (void)snprintf(fields, sizeof fields, usual_text, "", "", "");
        const wh_layout_t *usual = read_sound(fields);
        describe_arm_of(text, sizeof text, usual, robot);
        write_file(path, "arm", text);
        (void)snprintf(more, sizeof more, driven, path);
        (void)snprintf(fields, sizeof fields, usual_text, robot == 0 ? more + 2 : "", robot == 1 ? more : "",
                       "");
        const wh_layout_t *layout = read_sound(fields);
        assert_int_equal(unlink(path), 0);
        assert_true(layout->robots[robot].urdf && !layout->robots[1 - robot].urdf);
        expect_same_parts(usual, layout);
        assert_true(wh_layout_world_hash(usual) == wh_layout_world_hash(layout));
        assert_true(wh_layout_hash(usual) == wh_layout_hash(layout));
        for (int run = 0; run < 6; ++run) {
            (void)expect_same_run(usual, layout, 60);
        }
    }
}

/* The distance of a ball's middle from a box of half these sizes, in the box's frame. */
static double distance_to_box(const wh_vec3_t *from, const double least[3], const double most[3]) {
    const double at[3] = {from->x, from->y, from->z};
    double squares = 0;
    for (size_t i = 0; i < 3; ++i) {
        const double off = fmax(fmax(least[i] - at[i], at[i] - most[i]), 0);
        squares += off * off;
    }
    return sqrt(squares);
}

/* The usual blade of 300 mm: two fingers, palm and neck. */
static double distance_to_blade(const wh_vec3_t *from) {
    static const double boxes[][2][3] = {{{-55, 50, -3}, {100, 75, 0}},
                                         {{-55, -75, -3}, {100, -50, 0}},
                                         {{-80, -75, -3}, {-55, 75, 0}},
                                         {{-250, -37.5, -3}, {-80, 37.5, 0}}};
    double least = HUGE_VAL;
    for (size_t i = 0; i < sizeof boxes / sizeof boxes[0]; ++i) {
        least = fmin(least, distance_to_box(from, boxes[i][0], boxes[i][1]));
    }
    return least;
}

/* The first slice at which a blade of A, at these axes, meets the ball; SIZE_MAX: it does not. */
static size_t meets(const wh_layout_t *layout, const double from[], double to_r, const place_t *ball,
                    double radius, size_t slices) {
    double axes[WH_AXES];
    memcpy(axes, from, sizeof axes);
    for (size_t slice = 0; slice <= slices; ++slice) {
        wh_pose_t effector;
        axes[WH_AXIS_R] = from[WH_AXIS_R] + (to_r - from[WH_AXIS_R]) * (double)slice / (double)slices;
        wh_machine_effector(&layout->machine, 0, axes, &effector);
        const wh_vec3_t at = {ball->x, ball->y, ball->z};
        const wh_vec3_t off = wh_vec3_subtract(&at, &effector.r);
        const wh_vec3_t own = wh_mat3_transform_back(&effector.R, &off);
        if (distance_to_blade(&own) < radius) {
            return slice;
        }
    }
    return SIZE_MAX;
}

/* The slice at which the world finds a contact of B's forearm with A's blade; SIZE_MAX: it does not. */
static size_t hits(const wh_layout_t *layout, const double from[], double to_r, size_t slices) {
    going_t going = {.layout = layout};
    double axes[WH_AXES];
    size_t found = SIZE_MAX;
    memcpy(axes, from, sizeof axes);
    for (size_t slice = 0; slice <= slices && found == SIZE_MAX; ++slice) {
        axes[WH_AXIS_R] = from[WH_AXIS_R] + (to_r - from[WH_AXIS_R]) * (double)slice / (double)slices;
        going.list = (wh_event_list_t){going.events, 16, 0};
        go_to(&going, slice, axes);
        for (size_t i = 0; i < going.list.count; ++i) {
            const wh_event_t *event = &going.events[i];
            const char *one = wh_layout_part_name(layout, event->parts[0]);
            const char *two = wh_layout_part_name(layout, event->parts[1]);
            const bool is_blade = strncmp(one, "a ", 2) == 0 || strncmp(two, "a ", 2) == 0;
            const bool is_link = strcmp(one, "B fore") == 0 || strcmp(two, "B fore") == 0;
            found = event->kind == WH_EVENT_HIT && is_blade && is_link ? slice : found;
        }
    }
    free(going.world);
    return found;
}

/* A beside B; B's forearm is a ball of 30 mm and has all of its shapes. */
static const wh_layout_t *read_ball(void) {
    static const double links[2] = {340, 340};
    static char text[8192];
    char path[WH_TEST_PATH];
    char fields[2000];
    (void)snprintf(text, sizeof text,
                   "<robot name='arm'><link name='foot'/><link name='lift'/><link name='table'/>"
                   "<link name='upper'/><link name='hand'/><link name='ee'/><link name='fore'><collision>"
                   "<origin xyz='0.2 0.01 -0.0875'/><geometry><sphere radius='0.03'/></geometry></collision>"
                   "</link>");
    put_joint(text, sizeof text, "z", "foot", "lift", 0, "0 0 1");
    put_joint(text, sizeof text, "turn", "lift", "table", 0, "0 0 1");
    put_joint(text, sizeof text, "j1", "table", "upper", 0, "0 0 1");
    put_joint(text, sizeof text, "j2", "upper", "fore", links[0], "0 0 1");
    put_joint(text, sizeof text, "j3", "fore", "hand", links[1], "0 0 1");
    put_joint(text, sizeof text, "flip", "hand", "ee", 250, "1 0 0");
    put(text, sizeof text, "</robot>");
    write_file(path, "ball", text);
    (void)snprintf(
        fields, sizeof fields,
        "robots = { A = {}, B = { kind = 'TRZ', at = { 1150, 40, 30 }, heading = 175, r = { min = 260 "
        "}, urdf = '%s', tool = 'ee', joints = { z = 'z', turn = 'theta', j1 = 'fold', j2 = { axis "
        "= 'fold', factor = -2 }, j3 = 'fold', flip = {} } } }, " TWO_GRIPPERS,
        path);
    const wh_layout_t *layout = read_sound(fields);
    assert_int_equal(unlink(path), 0);
    return layout;
}

/* A's blade moves out to B's forearm: the contact is found when a plain distance shows it. The
 * world reports a run's first contact, and there is no other one. */
static void a_link_of_one_robot_meets_the_blade_of_another(void **state) {
    (void)state;
    enum { SLICES = 300 };
    const wh_layout_t *layout = read_ball();
    int met = 0;
    for (int run = 0; run < 400; ++run) {
        double from[WH_AXES];
        wh_machine_home(&layout->machine, from);
        const double z = wh_test_uniform(800, 1000);
        const double theta = wh_test_uniform(-0.9, 0.9);
        const double r = wh_test_uniform(300, 800);
        from[WH_AXIS_THETA] = wh_test_uniform(-0.3, 0.3);
        from[WH_AXIS_Z] = z + 30 - 87.5 + wh_test_uniform(-45, 45);
        from[WH_ROBOT_AXES + WH_AXIS_THETA] = theta;
        from[WH_ROBOT_AXES + WH_AXIS_R] = r;
        from[WH_ROBOT_AXES + WH_AXIS_Z] = z;
        const double fold = acos((r - 250) / 680);
        const place_t foot = {1150, 40, 30, 175 * acos(-1) / 180};
        const place_t elbow = go(go(foot, 0, 0, z, theta + fold), 340, 0, 0, -2 * fold);
        const place_t ball = go(elbow, 200, 10, -87.5, 0);
        const size_t should = meets(layout, from, 900, &ball, 30, SLICES);
        const size_t is = hits(layout, from, 900, SLICES);
        if (should == 0) { /* they overlap from the beginning */
            continue;
        }
        if (should == SIZE_MAX || is == SIZE_MAX) {
            assert_true(should == is);
        } else {
            assert_in_range(is, should - 1, should + 1);
            ++met;
        }
    }
    assert_in_range(met, 20, 180);
}

/* ---------------------------------------------------------------------------------------- joints' limits */

/* A usual arm of these lengths, whose joint has limits, rad; the robot has these travels, mm and degrees. */
typedef struct {
    double link, reach;
    double theta[2], r[2], yaw[2];
    bool right_handed;
    double more; /* the extra length of the first link, mm */
} limited_t;

static const char *write_limited(const limited_t *arm, const char *joint, double least, double most,
                                 char path[WH_TEST_PATH]) {
    static const char *const names[4][3] = {
        {"z", "foot", "lift"}, {"j1", "lift", "upper"}, {"j2", "upper", "fore"}, {"j3", "fore", "hand"}};
    static char text[8192];
    (void)snprintf(text, sizeof text,
                   "<robot name='arm'><link name='foot'/><link name='lift'/><link name='ee'/>");
    for (size_t i = 2; i < WH_ARM_BODIES; ++i) {
        put(text, sizeof text,
            "<link name='%s'><collision><geometry><sphere radius='0.03'/></geometry></collision></link>",
            link_names[i]);
    }
    for (size_t i = 0; i < 4; ++i) {
        const bool is_it = strcmp(names[i][0], joint) == 0;
        put(text, sizeof text,
            "<joint name='%s' type='%s'><parent link='%s'/><child link='%s'/><origin xyz='%.17g 0 0'/>"
            "<axis xyz='0 0 1'/><limit lower='%.17g' upper='%.17g' effort='1' velocity='1'/></joint>",
            names[i][0], i == 0 ? "prismatic" : "revolute", names[i][1], names[i][2],
            i < 2 ? 0 : (arm->link + (i == 2 ? arm->more : 0)) / 1000, is_it ? least : -99,
            is_it ? most : 99);
    }
    put(text, sizeof text,
        "<joint name='flange' type='fixed'><parent link='hand'/><child link='ee'/><origin xyz='%.17g 0 0'/>"
        "</joint></robot>",
        arm->reach / 1000);
    return write_file(path, "limited", text);
}

static void limited_fields(char *fields, size_t size, const limited_t *arm, const char *path) {
    (void)snprintf(
        fields, size,
        "robot = { urdf = '%s', tool = 'ee', joints = { z = 'z', j1 = 'shoulder', j2 = 'elbow', j3 = 'wrist' "
        "}, theta = { min = %.17g, max = %.17g }, r = { min = %.17g, max = %.17g, home = %.17g }, yaw = { "
        "min "
        "= %.17g, max = %.17g } }, shapes = { arm = { right_handed = %s } }, collision = true, grippers = { "
        "{ "
        "name = 'EE' } }, stations = { F = { at = { 600, 0, 900 }, retract = 10 } }",
        path, arm->theta[0], arm->theta[1], arm->r[0], arm->r[1], arm->r[0], arm->yaw[0], arm->yaw[1],
        arm->right_handed ? "true" : "false");
}

static double limited_value(const limited_t *arm, size_t joint, double theta, double r, double yaw) {
    const double x = r - arm->reach * cos(yaw);
    const double y = -arm->reach * sin(yaw);
    const double side = arm->right_handed ? -1 : 1;
    const double fold = side * acos(hypot(x, y) / (2 * arm->link));
    const double values[3] = {theta + atan2(y, x) + fold, -2 * fold, yaw - atan2(y, x) + fold};
    return values[joint];
}

/* The extremes of a joint's value, rad, by a fine grid that includes its edge at the links' reach. */
static void limited_extremes(const limited_t *arm, size_t joint, double extremes[2]) {
    enum { STEPS = 4000 };
    const double degree = acos(-1) / 180;
    extremes[0] = HUGE_VAL;
    extremes[1] = -HUGE_VAL;
    for (int i = 0; i <= STEPS; ++i) {
        const double yaw = degree * (arm->yaw[0] + (arm->yaw[1] - arm->yaw[0]) * i / STEPS);
        const double aside = arm->reach * sin(yaw);
        const double edge = arm->reach * cos(yaw) + sqrt(4 * arm->link * arm->link - aside * aside);
        const double most = fmin(arm->r[1], edge);
        for (int k = 0; k <= 200 && most >= arm->r[0]; ++k) {
            const double r = k == 200 ? most : arm->r[0] + (most - arm->r[0]) * k / 200;
            for (int end = 0; end < 2; ++end) {
                const double value = limited_value(arm, joint, degree * arm->theta[end], r, yaw);
                if (!isnan(value)) {
                    extremes[0] = fmin(extremes[0], value);
                    extremes[1] = fmax(extremes[1], value);
                }
            }
        }
    }
}

/* Limits this many degrees beyond the extremes are kept; limits nearer by as much are not. */
static void expect_limits(const limited_t *arm, size_t joint, double by) {
    static const char *const names[3] = {"j1", "j2", "j3"};
    const double nearer = by * acos(-1) / 180;
    double extremes[2];
    limited_extremes(arm, joint, extremes);
    for (int beyond = 0; beyond < 3; ++beyond) {
        char path[WH_TEST_PATH];
        char fields[2000];
        char message[64];
        const double least = extremes[0] + (beyond == 1 ? nearer : -nearer);
        const double most = extremes[1] - (beyond == 2 ? nearer : -nearer);
        limited_fields(fields, sizeof fields, arm, write_limited(arm, names[joint], least, most, path));
        if (beyond == 0) {
            (void)read_sound(fields);
        } else {
            (void)snprintf(message, sizeof message, "travels within the limits of joint \"%s\", ",
                           names[joint]);
            expect_refused(fields, message);
        }
        assert_int_equal(unlink(path), 0);
    }
}

/* The shoulder follows theta, beyond half a turn: 84 degrees before it, at R = 300. */
static void full_turns_count_in_limits(void **state) {
    (void)state;
    const double degree = acos(-1) / 180;
    const limited_t arm = {360, 230, {-180, 180}, {300, 900}, {-1, 1}, false, 0};
    char path[WH_TEST_PATH];
    char fields[2000];
    limited_fields(fields, sizeof fields, &arm, write_limited(&arm, "j1", -200 * degree, 200 * degree, path));
    expect_refused(fields, "joint \"j1\", -200 to 200; at theta 180, r 300, z ");
    assert_int_equal(unlink(path), 0);
    limited_fields(fields, sizeof fields, &arm, write_limited(&arm, "j1", -180 * degree, 268 * degree, path));
    (void)read_sound(fields);
    assert_int_equal(unlink(path), 0);
}

static void limits_are_kept_between_the_configurations(void **state) {
    (void)state;
    static const limited_t arms[] = {
        {360, 230, {-540, 540}, {300, 800}, {-60, 60}, false, 0},
        {360, 230, {-100, 300}, {300, 800}, {-60, 20}, true, 0},
        {351.5, 222.25, {-180, 180}, {310, 760}, {-170, 170}, false, 0},
    };
    for (size_t i = 0; i < sizeof arms / sizeof arms[0]; ++i) {
        for (size_t joint = 0; joint < 3; ++joint) {
            expect_limits(&arms[i], joint, 1e-3);
        }
    }
}

static void limits_are_kept_where_the_links_just_reach(void **state) {
    (void)state;
    static const limited_t arms[] = {
        {360, 230, {-180, 180}, {400, 1200}, {-90, 60}, false, 0},
        {300, 280, {-180, 180}, {350, 1200}, {-10, 120}, true, 0},
        {300, 150, {-180, 180}, {580, 700}, {-150, 150}, false, 0},
        {321.3, 138.4, {-344, 404}, {214.5, 526.6}, {-84, 152}, true, 0},
    };
    for (size_t i = 0; i < sizeof arms / sizeof arms[0]; ++i) {
        for (size_t joint = 0; joint < 3; ++joint) {
            expect_limits(&arms[i], joint, 0.1);
        }
    }
}

/* Differences that the agreement allows do not count as a link that moves otherwise. */
static void rounding_of_a_length_is_no_other_motion(void **state) {
    (void)state;
    char path[WH_TEST_PATH];
    char fields[2048];
    const limited_t arm = {360, 230, {-180, 180}, {300, 900}, {-60, 60}, false, 0.9e-6};
    limited_fields(fields, sizeof fields, &arm, write_limited(&arm, "j1", -99, 99, path));
    (void)read_sound(fields);
    assert_int_equal(unlink(path), 0);
}

/* --------------------------------------------------------------------------------------------- two arms */

#define TWO_ARMS                                                                                             \
    "kind = 'TRZ', r = { min = 260, home = 300 }, z = { min = 500, max = 1200 }, arms = { {}, { heading = "  \
    "180, height = 10 } }, urdf = 'lua/layouts/two_arms.urdf', "
#define TWO_TOOLS "tool = 'effector', tool2 = 'effector 2', "
#define TWO_JOINTS "joints = { lift = 'z', turn = 'theta', fold = 'fold', fold2 = 'fold2' } "
#define ON_BOTH                                                                                              \
    "grippers = { { name = 'one', on = 'A', arm = 1 }, { name = 'two', on = 'A', arm = 2 }, { name = 'b', "  \
    "on = 'B' } }, stations = { S = { at = { -700, 0, 900 }, rpy = { 0, 0, 180 } } }, collision = true, "

/* Both arms of one robot, beside another one. */
static void two_arms_have_their_links_where_their_urdf_says(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound("robots = { A = { at = { 100, 200, 30 }, heading = 50, " TWO_ARMS TWO_TOOLS TWO_JOINTS
                   "}, B = { at = { -2000, 0, 0 } } }, " ON_BOTH);
    const double straight = acos(-1);
    assert_near(layout->shapes.arm.link, 340, 0);
    assert_near(layout->shapes.arm.reach, 250, 0);
    for (int k = 0; k < 300; ++k) {
        static const char *const axes_of[2] = {"r", "r2"};
        static const char *const hulls[2] = {"A forearm hull", "A forearm 2 hull"};
        static const char *const hands[2] = {"A hand", "A hand 2"};
        double axes[WH_AXES];
        wh_links_t links;
        wh_pose_t grippers[WH_GRIPPERS];
        configure(layout, axes);
        wh_links_at(&links, layout, axes);
        wh_machine_grippers(&layout->machine, axes, grippers);
        for (size_t arm = 0; arm < 2; ++arm) {
            const double fold = acos((axis(layout, axes, "A", axes_of[arm]) - 250) / 680);
            const place_t foot = {100, 200, 30, 50 * straight / 180};
            const double out = axis(layout, axes, "A", "theta") + (double)arm * straight;
            const place_t upper = go(foot, 0, 0, axis(layout, axes, "A", "z"), out + fold);
            const place_t fore = go(upper, 340, 0, 0, -2 * fold);
            const place_t hand = go(fore, 340, 0, 10 * (double)arm, fold);
            const place_t tool = go(hand, 250, 0, 0, 0);
            expect_at(layout, &links, hulls[arm], go(fore, 170, 0, -87.5, 0));
            expect_at(layout, &links, hands[arm], go(hand, 0, 0, -31.5, 0));
            assert_near(grippers[arm].r.x, tool.x, 1e-6);
            assert_near(grippers[arm].r.y, tool.y, 1e-6);
            assert_near(grippers[arm].r.z, tool.z, 1e-6);
        }
    }
    assert_int_equal(part(layout, "A column")->owner, WH_ARM_BASE);
    assert_int_equal(part(layout, "A forearm 2 hull")->owner, WH_ARM_BODIES + WH_ARM_FOREARM);
}

/* The second shape of a link, beside another link with the name that such a shape would get. */
static void parts_of_a_urdf_have_names_of_their_own(void **state) {
    (void)state;
    static const char second[] =
        "<box size='0.1 0.1 0.1'/></geometry></visual><visual><geometry><sphere radius='0.02'/></geometry>"
        "</visual></link><joint name='held' type='fixed'><parent link='fore'/><child link='fore 2'/></joint>"
        "<link name='fore 2'><visual><geometry><sphere radius='0.01'/>";
    char fields[2000];
    char path[WH_TEST_PATH];
    write_folding(path, "MESH", second);
    folding_fields(fields, sizeof fields, path, DRIVEN);
    const wh_layout_t *layout = read_sound(fields);
    assert_int_equal(unlink(path), 0);
    assert_near(part(layout, "fore")->convex.half.x, 50, 0);
    assert_near(part(layout, "fore shape 2")->convex.half.x, 20, 0);
    assert_near(part(layout, "fore 2")->convex.half.x, 10, 0);
}

/* The fields of robot A; B has no fields unless they say so. */
static const char *const wrong_robots[][2] = {
    {"urdf = 'no_such.urdf'",
     "cell.lua: robots.A.urdf: \"no_such.urdf\" (expected a URDF file: no_such.urdf: No such file"},
    {"tool = 'ee'", "robots.A.tool: \"ee\" (expected nothing without urdf)"},
    {"packages = { x = 'y' }", "robots.A.packages: a table (expected nothing without urdf)"},
    {"tool2 = 'ee'", "robots.A.tool2: \"ee\" (expected nothing without urdf)"},
    {"kind = 'TRZ', r = { min = 260, home = 300 }, urdf = 'lua/layouts/folding.urdf', tool = 'effector', "
     "joints = { lift = 'z', turn = 'rail', q3 = 'fold' }",
     "robots.A.joints.turn: \"rail\" (expected what this robot has: theta, r, z, fold, shoulder, elbow, "
     "wrist)"},
    {"kind = 'TRZ', r = { min = 260, home = 300 }, urdf = 'lua/layouts/folding.urdf', tool = 'effector', "
     "tool2 = 'hand', joints = { lift = 'z', turn = 'theta', q3 = 'fold' }",
     "robots.A.tool2: \"hand\" (expected nothing: it is for a robot with two arms or two wrists)"},
    {"kind = 'TRZ', r = { min = 260, home = 300 }, urdf = 'lua/layouts/folding.urdf', tool = 'effector', "
     "joints = { lift = 'z', turn = 'theta', q3 = 'fold2' }",
     "robots.A.joints.q3: \"fold2\" (expected what this robot has: theta, r, z, fold, shoulder, elbow, "
     "wrist)"},
    {"kind = 'TRZ', r = { min = 260, home = 300 }, urdf = 'lua/layouts/folding.urdf', tool = 'effector', "
     "joints = { lift = 'z', turn = { axis = 'theta', offset = 1 }, q3 = 'fold' }",
     "robots.A.urdf: \"lua/layouts/folding.urdf\" (expected \"effector\" where the end-effector is, to 1e-06 "
     "mm and 1e-09 rad; at theta "},
    {"at = { 0, 5, 0 }, kind = 'TRZ', r = { min = 260, home = 300 }, z = { max = 1500 }, urdf = "
     "'lua/layouts/folding.urdf', tool = 'effector', joints = { lift = 'z', turn = 'theta', q3 = 'fold' }",
     "robots.A.urdf: \"lua/layouts/folding.urdf\" (expected travels within the limits of joint \"lift\", 400 "
     "to "
     "1400; at theta "},
    {"kind = 'TRZ', r = { min = 260, home = 300 }, urdf = 'lua/layouts/folding.urdf', tool = 'effector', "
     "joints = { lift = 'z', turn = 'theta', q3 = 'fold' } } }, shapes = { arms = { A = { link = 340 }",
     "robots.A.urdf: \"lua/layouts/folding.urdf\" (expected shapes.arms.A without reach and link: "},
    {TWO_ARMS TWO_JOINTS ", tool = 'effector'", "robots.A.tool2: nothing (expected"},
    {TWO_ARMS TWO_JOINTS ", tool = 'effector', tool2 = 'effector'",
     "(expected two links of 10 to 5000 mm, and 0 to 2000 mm from the wrist to \"effector\""},
    {TWO_ARMS TWO_JOINTS ", tool = 'effector 2', tool2 = 'effector'",
     "(expected two links of 10 to 5000 mm, and 0 to 2000 mm from the wrist to \"effector 2\""},
    {TWO_ARMS TWO_TOOLS
     "joints = { lift = 'z', turn = 'theta', fold = 'fold', fold2 = { axis = 'fold2', factor "
     "= -1 } }",
     "moves with none of them (is the elbow on the other side? then shapes.arms.A.right_handed"},
    {TWO_ARMS TWO_TOOLS "joints = { lift = 'z', turn = 'theta', fold = 'fold', fold2 = 'fold' }",
     "(expected \"effector 2\" where the end-effector is, to 1e-06 mm and 1e-09 rad; at theta "},
};

static void what_is_wrong_names_the_robot(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof wrong_robots / sizeof wrong_robots[0]; ++i) {
        const bool is_two = strstr(wrong_robots[i][0], "two_arms") != NULL;
        char fields[2000];
        (void)snprintf(fields, sizeof fields, "robots = { B = { at = { -2000, 0, 0 } }, A = { %s } }, %s",
                       wrong_robots[i][0], is_two ? ON_BOTH : TWO_GRIPPERS);
        expect_refused(fields, wrong_robots[i][1]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_urdf_of_the_usual_arm_is_the_usual_arm),
        cmocka_unit_test(a_mesh_becomes_its_hull),
        cmocka_unit_test(bad_urdfs),
        cmocka_unit_test(what_cannot_be_read_refuses_the_file),
        cmocka_unit_test(what_it_passes_over_refuses_the_file),
        cmocka_unit_test(paint_and_percents_are_read),
        cmocka_unit_test(full_turns_count_in_limits),
        cmocka_unit_test(limits_are_kept_between_the_configurations),
        cmocka_unit_test(limits_are_kept_where_the_links_just_reach),
        cmocka_unit_test(rounding_of_a_length_is_no_other_motion),
        cmocka_unit_test(each_robot_has_its_links_where_its_urdf_says),
        cmocka_unit_test(a_urdf_of_one_of_two_is_the_usual_cell),
        cmocka_unit_test(a_link_of_one_robot_meets_the_blade_of_another),
        cmocka_unit_test(two_arms_have_their_links_where_their_urdf_says),
        cmocka_unit_test(parts_of_a_urdf_have_names_of_their_own),
        cmocka_unit_test(what_is_wrong_names_the_robot),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
