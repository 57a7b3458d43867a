/* An example to copy: the same controller, with checks for what its arm runs into. Besides
 * libwaferhand.a it needs libwaferhand_collision.a and libccd, so it has no float build. */
#include "waferhand_collision.h"

#include "with_cmocka.h"

/* Part 0 is the blade, 160 x 150 x 3 mm, its upper side the contact plane; parts 1 and 2 are wafers
 * 0 and 1. */
static wh_part_t blade;
static wh_world_config_t shapes;
static wh_world_t *world;

/* Aligned as malloc's memory would be. */
static union {
    double number;
    void *pointer;
    uint8_t bytes[256 * 1024];
} memory;

static wh_world_input_t seen(const wh_grasp_t *table) {
    static const wh_arm_t arm = {.reach = 250, .link = 350};
    static wh_pose_t links[WH_ARM_BODIES];
    const wh_pose_t effector = gripper_pose();
    const wh_world_input_t input = {table->slice, table->storage.wafers, table->storage.grippers, links,
                                    NULL};
    wh_arm_place(&arm, &effector, links);
    return input;
}

/* The machine passes each slice to the world, which adds its events to the slice's own. */
static void look(void *user, const wh_command_t *order, const wh_gripper_input_t inputs[],
                 const wh_grasp_t *table, wh_event_list_t *list) {
    const wh_world_input_t input = seen(table);
    (void)user;
    (void)order;
    (void)inputs;
    wh_world_step(world, &input, list);
}

static void describe(void) {
    blade.kind = WH_PART_BLADE;
    blade.owner = 0;
    blade.convex.kind = WH_CONVEX_BOX;
    blade.convex.half = wh_vec3(80, 75, 1.5);
    blade.convex.body_from_shape = wh_pose_identity();
    blade.convex.body_from_shape.r.z = -1.5;
    memset(&shapes, 0, sizeof shapes);
    shapes.parts = &blade;
    shapes.part_count = 1;
    shapes.wafer.kind = WH_CONVEX_CYLINDER;
    shapes.wafer.half = wh_vec3(150, 0, 0.3875);
    shapes.wafer.body_from_shape = wh_pose_identity();
    shapes.wafer.body_from_shape.r.z = 0.3875;
    shapes.gripper_count = 1;
    shapes.wafer_count = WAFERS;
    shapes.cell = &machine.cell;
    shapes.grasp = &machine.table.config;
}

static int set_up_with_shapes(void **unused) {
    if (set_up(unused) != 0) {
        return -1;
    }
    describe();
    tick(); /* the arm is where the controller says */
    const wh_world_input_t input = seen(&machine.table);
    if (wh_world_validate(&shapes, NULL) != WH_OK || wh_world_bytes(&shapes) > sizeof memory) {
        return -1;
    }
    world = wh_world_init(&shapes, &input, memory.bytes, sizeof memory);
    machine.observer.look = look;
    return world ? 0 : -1;
}

static void a_good_get_and_put_touch_nothing(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    assert_int_equal(put(1, 1), CONTROLLER_READY);
    assert_not_said("hit");
    assert_not_said("undecided");
    /* Slot 1 of station 1 is 10 mm below wafer 1. The other wafer comes in 3 mm above its plane and
     * 0.48 mm above the blade. */
    const wh_clearance_t *nearest = &wh_world_clearances(world)[WH_CLEARANCE_WAFER_WAFER];
    assert_true(nearest->gap > 5.72 && nearest->gap < 5.77);
}

/* If it is taught 3.4 mm too high, the blade goes in at the wafer's own height. */
static void a_station_taught_too_high_is_a_collision(void **unused) {
    (void)unused;
    taught[0].z += 3.4;
    (void)get(0, 1);
    assert_said("hit: ");
    assert_said("part 0 and part 1 touch at ");
}

/* No switch tells the firmware that a wafer lies in the slot. The blade comes in above the slot's
 * plane and runs into the wafer. */
static void a_put_onto_a_wafer_is_a_collision(void **unused) {
    (void)unused;
    assert_int_equal(get(0, 1), CONTROLLER_READY);
    assert_not_said("hit");
    (void)put(1, 2);
    assert_said("hit: ");
    assert_said("part 0 and part 2 touch at ");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_good_get_and_put_touch_nothing, set_up_with_shapes),
        cmocka_unit_test_setup(a_station_taught_too_high_is_a_collision, set_up_with_shapes),
        cmocka_unit_test_setup(a_put_onto_a_wafer_is_a_collision, set_up_with_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
