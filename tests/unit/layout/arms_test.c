/* Links of several robots and arms: their parts by name, their places, and the pairs of them that
 * may touch. */
#include <math.h>
#include <stdlib.h>

#include "support/layout.h"

#include "layout/arms.h"
#include "layout/collision.h"
#include "layout/links.h"
#include "math/trig.h"

#define THREE                                                                                                \
    "robots = { ATM = { at = { -700, 0, 0 }, rail = {} }, "                                                  \
    "SC = { kind = 'SCARA', links = { 450, 400 }, at = { 600, 2000, 0 }, "                                   \
    "wrists = { {}, { heading = 10, height = 20 } } }, "                                                     \
    "VAC = { kind = 'TRZ', at = { 650, 0, 0 }, arms = { {}, { heading = 180, height = 10 } } } }, "          \
    "grippers = { { name = 'A', on = 'ATM' }, { name = 'V2', on = 'VAC', arm = 2 }, "                        \
    "{ name = 'V1', on = 'VAC' }, { name = 'S1', on = 'SC', at = { 250, 0, 0 } }, "                          \
    "{ name = 'S2', on = 'SC', wrist = 2, at = { 250, 0, 0 } }, { name = 'PA', on = 'P' } }, "               \
    "stations = { P = { kind = 'prealigner', at = { -1400, 0, 950 }, rpy = { 0, 0, 180 } } }, "

static int32_t find(const wh_layout_t *layout, const char *name) {
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        if (strcmp(layout->part_names[i], name) == 0) {
            return (int32_t)i;
        }
    }
    return WH_NONE;
}

static int32_t owner_of(const wh_layout_t *layout, const char *name) {
    const int32_t part = find(layout, name);
    if (part == WH_NONE) {
        fail_msg("no part \"%s\"", name);
    }
    return layout->world.parts[part].owner;
}

static void parts_are_named_by_robot_and_arm(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(THREE);
    static const char *const names[] = {"ATM column", "ATM forearm", "SC hand",    "SC hand 2",
                                        "VAC lift",   "VAC hand",    "VAC hand 2", "VAC upper arm 2"};
    static const int32_t owners[] = {WH_ARM_BASE,
                                     WH_ARM_FOREARM,
                                     WH_ARM_BODIES + WH_ARM_HAND,
                                     2 * WH_ARM_BODIES + WH_ARM_HAND,
                                     3 * WH_ARM_BODIES + WH_ARM_LIFT,
                                     3 * WH_ARM_BODIES + WH_ARM_HAND,
                                     4 * WH_ARM_BODIES + WH_ARM_HAND,
                                     4 * WH_ARM_BODIES + WH_ARM_UPPER};
    static const uint8_t carried_by[] = {0, 4, 3, 1, 2, WH_WORLD_NO_ARM};
    for (size_t i = 0; i < sizeof owners / sizeof owners[0]; ++i) {
        assert_int_equal(owner_of(layout, names[i]), owners[i]);
    }
    assert_int_equal(find(layout, "VAC column 2"), WH_NONE); /* both arms share it */
    assert_int_equal(find(layout, "SC forearm 2"), WH_NONE);
    assert_int_equal(layout->world.arm_count, 5);
    assert_memory_equal(layout->carried_by, carried_by, sizeof carried_by);
    assert_int_equal(wh_world_validate(&layout->world, NULL), WH_OK);
}

static void each_robot_has_its_own_lengths(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound(THREE "shapes = { arms = { VAC = { reach = 200, link = 400, right_handed = true } } }");
    assert_near(wh_layout_arm_lengths(layout, 0)->reach, 250, 0);
    assert_near(wh_layout_arm_lengths(layout, 1)->reach, 0, 0);
    assert_near(wh_layout_arm_lengths(layout, 2)->link, 400, 0);
    assert_true(wh_layout_arm_lengths(layout, 2)->right_handed);
}

/* The axes of one robot: theta and so on are those of the machine from `first` on. */
static size_t first_of(const wh_layout_t *layout, size_t robot) {
    size_t first;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    return first;
}

static void assert_at(const wh_pose_t *pose, double x, double y, double z) {
    assert_near(pose->r.x, x, 1e-9);
    assert_near(pose->r.y, y, 1e-9);
    assert_near(pose->r.z, z, 1e-9);
}

/* Computed by hand: at home theta and yaw are 0, R is 300 and Z 900. The wrist is 250 behind the
 * end-effector, and the elbow where both links reach. */
static void links_stand_on_their_robots(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(THREE);
    wh_links_t links;
    wh_real_t axes[WH_AXES];
    wh_machine_home(&layout->machine, axes);
    const size_t atm = first_of(layout, 0);
    axes[atm + WH_ROBOT_AXES] = 120; /* the rail */
    wh_links_at(&links, layout, axes);
    assert_at(&links.bodies[WH_ARM_BASE], -580, 0, 0);
    assert_at(&links.bodies[WH_ARM_HAND], -530, 0, 900);
    const wh_pose_t *vac = &links.bodies[3 * WH_ARM_BODIES];
    assert_at(&vac[WH_ARM_LIFT], 650, 0, 900);
    assert_at(&vac[WH_ARM_HAND], 700, 0, 900);
    const double link = 0.53 * 650;
    assert_at(&vac[WH_ARM_FOREARM], 675, sqrt(link * link - 25 * 25), 900);
    const wh_pose_t *second = &links.bodies[4 * WH_ARM_BODIES];
    assert_at(&second[WH_ARM_HAND], 600, 0, 910); /* 10 higher, except for its links */
    assert_at(&second[WH_ARM_FOREARM], 625, -sqrt(link * link - 25 * 25), 900);
    const wh_pose_t *scara = &links.bodies[1 * WH_ARM_BODIES];
    assert_at(&scara[WH_ARM_FOREARM], 600 + 450, 2000, 900);
    const wh_pose_t *shared = &links.bodies[2 * WH_ARM_BODIES + WH_ARM_FOREARM];
    assert_at(shared, scara[WH_ARM_FOREARM].r.x, scara[WH_ARM_FOREARM].r.y, scara[WH_ARM_FOREARM].r.z);
}

/* Followed from slice to slice, grippers have the very poses of the axes. If nothing moves nothing
 * is computed, with the same result, and so it is if the axes' poses are told. */
static void links_follow_the_grippers(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(THREE);
    wh_links_t followed, placed, told;
    wh_real_t axes[WH_AXES];
    wh_pose_t poses[WH_GRIPPERS];
    wh_gripper_input_t inputs[WH_GRIPPERS];
    wh_machine_cache_t cache = {.is_taken = false};
    wh_machine_home(&layout->machine, axes);
    wh_links_home(&followed, layout);
    wh_links_home(&told, layout);
    for (int step = 0; step < 40; ++step) {
        axes[first_of(layout, (size_t)step % 3) + WH_AXIS_THETA] += 0.03;
        axes[first_of(layout, 2) + layout->robots[2].carrier.axis_count - 1] += step % 2 == 0 ? 2 : 0;
        wh_machine_grippers(&layout->machine, axes, poses);
        wh_links_follow(&followed, layout, poses, axes, NULL, WH_LINKS_SAME);
        wh_links_at(&placed, layout, axes);
        assert_memory_equal(followed.bodies, placed.bodies, sizeof placed.bodies);
        wh_machine_update(&layout->machine, axes, &cache, inputs);
        wh_links_follow(&told, layout, poses, axes, inputs, WH_LINKS_SAME);
        assert_memory_equal(told.bodies, placed.bodies, sizeof placed.bodies);
    }
}

/* A gripper that a fault keeps elsewhere is not where the axes say, whether these poses are told or not. */
static void links_follow_a_gripper_that_stays_behind(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(THREE);
    wh_links_t followed, told;
    wh_real_t axes[WH_AXES];
    wh_pose_t poses[WH_GRIPPERS];
    wh_gripper_input_t inputs[WH_GRIPPERS];
    wh_machine_cache_t cache = {.is_taken = false};
    wh_machine_home(&layout->machine, axes);
    wh_links_home(&followed, layout);
    wh_links_home(&told, layout);
    wh_machine_grippers(&layout->machine, axes, poses);
    axes[first_of(layout, 0) + WH_AXIS_THETA] += 0.2;
    wh_machine_update(&layout->machine, axes, &cache, inputs);
    wh_links_follow(&followed, layout, poses, axes, NULL, WH_LINKS_SAME);
    wh_links_follow(&told, layout, poses, axes, inputs, WH_LINKS_SAME);
    assert_memory_equal(told.bodies, followed.bodies, sizeof told.bodies);
    wh_links_home(&followed, layout);
    const wh_vec3_t *hand = &followed.bodies[WH_ARM_HAND].r;
    assert_at(&told.bodies[WH_ARM_HAND], hand->x, hand->y, hand->z);
}

/* -------------------------------------------------------------------------------------------------- contacts */

/* The first hit while one axis of one robot moves up to `to` and the others rest. */
static const wh_event_t *first_hit(const wh_layout_t *layout, wh_real_t axes[], size_t axis, double to) {
    static wh_event_t event;
    wh_event_list_t list = {&event, 1, 0};
    wh_collision_t collision = {.layout = layout};
    wh_gripper_t grippers[WH_GRIPPERS] = {{.wafer = WH_NONE}};
    wh_pose_t poses[WH_GRIPPERS];
    void *memory = malloc(wh_collision_bytes(layout));
    wh_links_home(&collision.links, layout);
    wh_world_t *world = NULL;
    const double from = axes[axis];
    for (int step = 0; step <= 100 && list.count == 0; ++step) {
        axes[axis] = from + (to - from) * step / 100;
        wh_machine_grippers(&layout->machine, axes, poses);
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            grippers[g].base_from_gripper = poses[g];
            grippers[g].wafer = WH_NONE;
            grippers[g].valve = WH_VALVE_CLOSED;
        }
        wh_links_follow(&collision.links, layout, poses, axes, NULL, WH_LINKS_SAME);
        const wh_world_input_t input = {(uint64_t)step, layout->start, grippers, collision.links.bodies,
                                        NULL};
        if (world) {
            wh_world_step(world, &input, &list);
        } else {
            world = wh_world_init(&layout->world, &input, memory, wh_collision_bytes(layout));
        }
    }
    free(memory);
    return list.count > 0 ? &event : NULL;
}

static void expect_hit(const wh_layout_t *layout, const wh_event_t *hit, const char *one, const char *two) {
    assert_non_null(hit);
    assert_int_equal(hit->kind, WH_EVENT_HIT);
    const char *a = wh_layout_part_name(layout, hit->parts[0]);
    const char *b = wh_layout_part_name(layout, hit->parts[1]);
    if (!((strcmp(a, one) == 0 && strcmp(b, two) == 0) || (strcmp(a, two) == 0 && strcmp(b, one) == 0))) {
        fail_msg("%s and %s, wanted %s and %s", a, b, one, two);
    }
}

static void robots_hit_each_other(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(THREE);
    wh_real_t axes[WH_AXES];
    wh_machine_home(&layout->machine, axes);
    const size_t atm = first_of(layout, 0);
    axes[atm + WH_AXIS_R] = 500;
    /* Its rail carries it along to the other robot's second blade, which is 10 higher. */
    expect_hit(layout, first_hit(layout, axes, atm + WH_ROBOT_AXES, 1000), "A palm", "VAC hand 2");
}

/* Arms of one robot: at home and stretched they are clear of each other. */
static void two_arms_of_a_robot_are_clear(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(THREE);
    const size_t vac = first_of(layout, 2);
    const size_t last = vac + layout->robots[2].carrier.axis_count - 1;
    wh_real_t axes[WH_AXES];
    wh_machine_home(&layout->machine, axes);
    axes[first_of(layout, 0) + WH_AXIS_THETA] = WH_PI / 2; /* out of the way */
    assert_null(first_hit(layout, axes, vac + WH_AXIS_R, 890));
    assert_null(first_hit(layout, axes, last, 890));
}

/* Two arms that point the same way, one above the other by less than a blade and a link need. */
static void arms_one_above_the_other_touch(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound("robot = { kind = 'TRZ', arms = { {}, { heading = 25, height = 10 } } }, "
                   "grippers = { { name = 'L' }, { name = 'U', arm = 2 } }, "
                   "stations = { A = { at = { 700, 0, 900 } } }, ");
    wh_real_t axes[WH_AXES];
    wh_machine_home(&layout->machine, axes);
    axes[WH_ROBOT_AXES] = 600;
    assert_int_equal(owner_of(layout, "forearm 2"), WH_ARM_BODIES + WH_ARM_FOREARM);
    assert_non_null(first_hit(layout, axes, WH_AXIS_R, 890));
}

/* The largest numbers of robots, axes and grippers. */
static void eight_robots_fill_the_machine(void **state) {
    (void)state;
    const wh_layout_t *layout =
        read_sound("robots = (function() local t = {} for i = 1, 8 do t['R' .. i] = { at = { 3000 * i, 0, 0 "
                   "} } end return t "
                   "end)(), grippers = (function() local t = {} for i = 1, 16 do t[i] = { name = 'G' .. i, "
                   "on = 'R' .. (i + 1) // 2, at = { 0, 0, i % 2 * 20 } } end return t end)(), "
                   "stations = { A = { at = { 3700, 0, 900 } } }, ");
    assert_int_equal(layout->machine.axis_count, 32);
    assert_int_equal(layout->machine.gripper_count, 16);
    assert_int_equal(layout->world.arm_count, 8);
    assert_int_equal(layout->carried_by[15], 7);
    assert_int_equal(wh_machine_robot_bits(&layout->machine), UINT32_MAX);
    assert_int_equal(wh_world_validate(&layout->world, NULL), WH_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_named_by_robot_and_arm),
        cmocka_unit_test(each_robot_has_its_own_lengths),
        cmocka_unit_test(links_stand_on_their_robots),
        cmocka_unit_test(links_follow_the_grippers),
        cmocka_unit_test(links_follow_a_gripper_that_stays_behind),
        cmocka_unit_test(robots_hit_each_other),
        cmocka_unit_test(two_arms_of_a_robot_are_clear),
        cmocka_unit_test(arms_one_above_the_other_touch),
        cmocka_unit_test(eight_robots_fill_the_machine),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
