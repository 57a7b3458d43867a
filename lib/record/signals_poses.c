/* The shown places of grippers and links at a slice, and the slices to visit. */
#include "signals.h"

#include <string.h>

#include "../layout/arms.h"
#include "../layout/links.h"

/* wh_signals_walk visits at most this number of places from one point to the next. */
#define PLACES 32

/* Thinned axes and poses agree to this, mm, unless a fault kept the robot away from its axes' positions. */
#define NEAR_MM 1.0

/* -------------------------------------------------------------------------------------------------- poses */

static void read_axes(const wh_signals_t *signals, int64_t slice, double axes[WH_AXES]) {
    memset(axes, 0, WH_AXES * sizeof axes[0]);
    for (size_t axis = 0; axis < WH_AXES && signals->axes[axis].list.count > 0; ++axis) {
        axes[axis] = wh_path_read(&signals->axes[axis], slice, NULL);
    }
}

static void read_grippers(const wh_signals_t *signals, int64_t slice, const double axes[],
                          wh_pose_t poses[WH_GRIPPERS]) {
    const wh_machine_t *machine = &signals->layout->machine;
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
    double axes[WH_AXES];
    read_axes(signals, slice, axes);
    read_grippers(signals, slice, axes, poses);
    *base_from_gripper = poses[gripper];
}

void wh_signals_door(const wh_signals_t *signals, size_t door, int64_t slice, wh_pose_t *base_from_door) {
    const wh_machine_t *machine = &signals->layout->machine;
    double axes[WH_AXES];
    read_axes(signals, slice, axes);
    *base_from_door = wh_door_pose(&machine->doors[door], axes[wh_machine_door_axis(machine, door)]);
}

size_t wh_signals_link_bodies(const wh_layout_t *layout, int32_t bodies[WH_SIGNALS_LINKS]) {
    size_t count = 0;
    for (size_t i = 0; i < wh_layout_arms(layout) * WH_ARM_BODIES; ++i) {
        const size_t arm = i / WH_ARM_BODIES;
        const size_t number = arm * WH_ARM_BODIES + (i + 1) % WH_ARM_BODIES; /* each arm's base comes last */
        const bool moves = layout->machine.carrier || number % WH_ARM_BODIES != WH_ARM_BASE;
        if (moves && wh_layout_has_body(layout, number)) {
            bodies[count++] = (int32_t)number;
        }
    }
    return count;
}

bool wh_signals_links(const wh_signals_t *signals, int64_t slice,
                      wh_pose_t base_from_links[WH_SIGNALS_LINKS]) {
    const wh_machine_t *machine = &signals->layout->machine;
    wh_pose_t poses[WH_GRIPPERS];
    double axes[WH_AXES];
    wh_links_t links;
    int32_t bodies[WH_SIGNALS_LINKS];
    bool on_robot = false;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        on_robot = on_robot || machine->mounts[g].axis == WH_NONE;
    }
    if (!on_robot) {
        return false;
    }
    read_axes(signals, slice, axes);
    read_grippers(signals, slice, axes, poses);
    wh_links_at(&links, signals->layout, axes);
    wh_links_follow(&links, signals->layout, poses, axes, NULL, NEAR_MM);
    const size_t count = wh_signals_link_bodies(signals->layout, bodies);
    for (size_t i = 0; i < count; ++i) {
        base_from_links[i] = links.bodies[bodies[i]];
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------- walk */

/* The number of points of each signal that the walk has passed. */
typedef struct {
    size_t axes[WH_AXES], own[WH_GRIPPERS];
} passed_t;

/* The first slice after `slice` at which a signal has a point, or the last slice of all. */
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
