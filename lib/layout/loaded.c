/* `loaded` of robots and grippers: limits for the way of a wafer that is carried. */
#include "layout.h"

/* The smaller of two limits; 0 means no limit. */
static wh_real_t stricter(wh_real_t a, wh_real_t b) {
    return !(b > 0) || (a > 0 && a < b) ? a : b;
}

wh_limits_t wh_layout_loaded(const wh_layout_t *layout, size_t gripper) {
    const wh_mount_t *mount = &layout->machine.mounts[gripper];
    const wh_limits_t *own = &layout->grippers[gripper].loaded;
    wh_limits_t limits = *own;
    if (mount->axis == WH_NONE) {
        const wh_limits_t *robot = &layout->robots[mount->robot].loaded;
        limits.speed = stricter(own->speed, robot->speed);
        limits.acceleration = stricter(own->acceleration, robot->acceleration);
        limits.jerk = stricter(own->jerk, robot->jerk);
    }
    return limits;
}

static bool is_limited(const wh_limits_t *limits) {
    return limits->speed > 0 || limits->acceleration > 0 || limits->jerk > 0;
}

bool wh_layout_has_loaded(const wh_layout_t *layout) {
    bool any = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_limits_t limits = wh_layout_loaded(layout, g);
        any = any || is_limited(&limits);
    }
    return any;
}
