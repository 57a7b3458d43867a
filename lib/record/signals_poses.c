/* Where a trace shows grippers and links. */
#include "../layout/collision.h"
#include "signals.h"

/* From one point to the next, poses are looked at in at most so many places. */
#define PLACES 32

static void read_grippers(const wh_signals_t *signals, int64_t slice, wh_pose_t poses[WH_GRIPPERS]) {
    const wh_machine_t *machine = &signals->layout->machine;
    double axes[WH_AXES] = {0};
    for (size_t axis = 0; axis < WH_AXES && signals->axes[axis].list.count > 0; ++axis) {
        axes[axis] = wh_path_read(&signals->axes[axis], slice, NULL);
    }
    wh_machine_grippers(machine, axes, poses);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_thin_t *own = &signals->own[g];
        if (own->list.count > 0 && slice >= own->list.points[0].slice) {
            wh_thin_read_pose(own, slice, &poses[g]);
        }
    }
}

void wh_signals_gripper(const wh_signals_t *signals, size_t gripper, int64_t slice,
                        wh_pose_t *base_from_gripper) {
    wh_pose_t poses[WH_GRIPPERS];
    read_grippers(signals, slice, poses);
    *base_from_gripper = poses[gripper];
}

bool wh_signals_links(const wh_signals_t *signals, int64_t slice, wh_pose_t base_from_links[WH_TRACE_LINKS]) {
    wh_pose_t poses[WH_GRIPPERS];
    wh_pose_t base_from_effector;
    wh_pose_t bodies[WH_ARM_BODIES];
    read_grippers(signals, slice, poses);
    if (!wh_collision_effector(&signals->layout->machine, poses, &base_from_effector)) {
        return false;
    }
    wh_arm_place(&signals->layout->shapes.arm, &base_from_effector, bodies);
    for (size_t i = 0; i < WH_TRACE_LINKS; ++i) {
        base_from_links[i] = bodies[WH_ARM_LIFT + i];
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------
 * walk */

/* How far the points of each signal have been passed. */
typedef struct {
    size_t axes[WH_AXES], own[WH_GRIPPERS];
} passed_t;

/* The first slice after `slice` at which a signal has a point, or the trace's last. */
static int64_t next_point(const wh_signals_t *signals, passed_t *passed, int64_t slice) {
    int64_t next = signals->last;
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        next = wh_points_next(&signals->axes[axis].list, &passed->axes[axis], slice, next);
    }
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        next = wh_points_next(&signals->own[g].list, &passed->own[g], slice, next);
    }
    return next;
}

void wh_signals_walk(const wh_signals_t *signals, void (*visit)(void *user, int64_t slice), void *user) {
    passed_t passed = {{0}, {0}};
    int64_t slice = signals->first;
    visit(user, slice);
    while (slice < signals->last) {
        const int64_t next = next_point(signals, &passed, slice);
        const int64_t width = next - slice;
        const int64_t places = width < PLACES ? width : PLACES;
        for (int64_t i = 1; i < places; ++i) {
            visit(user, slice + (int64_t)((double)width * (double)i / (double)places));
        }
        visit(user, next);
        slice = next;
    }
}
