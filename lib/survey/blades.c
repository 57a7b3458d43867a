/* Blades that are in each other's way on the end-effector, or on two arms at home. */
#include <stdio.h>

#include "../bodies/shapes.h"
#include "../collision/gap.h"
#include "feasibility_internal.h"

static bool is_on_robot(const wh_layout_t *layout, int32_t gripper) {
    return layout->grippers[gripper].station == WH_NONE;
}

/* The n-th part of a gripper that hangs on nothing else, or null: fingers and palm come first, then what
 * leads to the wrist, where blades may meet. */
static const wh_part_t *part_of(const wh_layout_t *layout, int32_t gripper, size_t n) {
    const wh_world_config_t *world = &layout->world;
    for (size_t i = 0; i + layout->hung_count < world->part_count; ++i) {
        if (world->parts[i].kind == WH_PART_BLADE && world->parts[i].owner == gripper && n-- == 0) {
            return &world->parts[i];
        }
    }
    return NULL;
}

enum { BLADE_PARTS = 3, ALL_PARTS = WH_SHAPES_GRIPPER, WAFER = ALL_PARTS };

/* A gripper's n-th shape on the end-effector: a part, or the wafer that it may hold. */
static const wh_convex_t *shape_of(const wh_layout_t *layout, int32_t gripper, size_t n) {
    if (n == WAFER) {
        return &layout->world.wafer;
    }
    const wh_part_t *part = part_of(layout, gripper, n);
    return part ? &part->convex : NULL;
}

static const char *name_of(const wh_layout_t *layout, int32_t gripper, size_t n) {
    const wh_part_t *part = n == WAFER ? NULL : part_of(layout, gripper, n);
    return part ? layout->part_names[part - layout->world.parts] : "a wafer";
}

/* Seen from the end-effector; of two arms or wrists from base, at home. */
static wh_pose_t pose_of(const wh_machine_t *machine, int32_t gripper, bool has_two) {
    wh_pose_t poses[WH_GRIPPERS];
    wh_real_t home[WH_AXES];
    if (!has_two) {
        return machine->mounts[gripper].effector_from_gripper;
    }
    wh_machine_home(machine, home);
    wh_machine_grippers(machine, home, poses);
    return poses[gripper];
}

/* True if two shapes of different grippers overlap, on the end-effector. */
static bool is_in_the_way(const wh_layout_t *layout, int32_t a, size_t n, int32_t b, size_t m) {
    const wh_convex_t *one = shape_of(layout, a, n);
    const wh_convex_t *other = shape_of(layout, b, m);
    const bool is_wrist = n >= BLADE_PARTS && n != WAFER && m >= BLADE_PARTS && m != WAFER;
    if (!one || !other || is_wrist) {
        return false;
    }
    const wh_machine_t *machine = &layout->machine;
    const bool has_two = machine->mounts[a].arm != machine->mounts[b].arm;
    const wh_pose_t one_at = pose_of(machine, a, has_two);
    const wh_pose_t other_at = pose_of(machine, b, has_two);
    const wh_pose_t from_one = wh_pose_compose(&one_at, &one->body_from_shape);
    const wh_pose_t from_other = wh_pose_compose(&other_at, &other->body_from_shape);
    wh_gap_t gap;
    wh_gap_measure(one, &from_one, other, &from_other, 0, wh_vec3(0, 0, 0), &gap);
    return gap.state == WH_GAP_HIT || gap.state == WH_GAP_UNDECIDED;
}

static void say_blades(wh_feasibility_t *check, int32_t a, size_t n, int32_t b, size_t m) {
    const wh_layout_t *layout = check->layout;
    (void)wh_feasibility_add(
        check, WH_FINDING_BLADES, WH_NONE, "%s and %s are in each other's way: %s%s%s overlaps %s%s%s",
        layout->grippers[a].name, layout->grippers[b].name, name_of(layout, a, n), n == WAFER ? " on " : "",
        n == WAFER ? layout->grippers[a].name : "", name_of(layout, b, m), m == WAFER ? " on " : "",
        m == WAFER ? layout->grippers[b].name : "");
}

/* The first shapes of two grippers that overlap: blades before wafers. */
static void compare_blades(wh_feasibility_t *check, int32_t a, int32_t b) {
    for (size_t n = 0; n <= WAFER; ++n) {
        for (size_t m = 0; m <= WAFER; ++m) {
            if (is_in_the_way(check->layout, a, n, b, m)) {
                say_blades(check, a, n, b, m);
                return;
            }
        }
    }
}

void wh_feasibility_blades(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    const int32_t count = (int32_t)layout->machine.gripper_count;
    for (int32_t a = 0; a < count; ++a) {
        for (int32_t b = a + 1; b < count; ++b) {
            if (is_on_robot(layout, a) && is_on_robot(layout, b) &&
                layout->machine.mounts[a].robot == layout->machine.mounts[b].robot) {
                compare_blades(check, a, b);
            }
        }
    }
}
