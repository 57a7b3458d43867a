#include "machine.h"

#include "../math/exact_internal.h"
#include "../math/trig.h"

/* A tilt, however slight, shows in one of these entries; a turn about z alone leaves none of it, even with
 * rounding. */
static bool is_level(const wh_mat3_t *R) {
    return !(wh_real_abs(R->m[0][2]) > 0 || wh_real_abs(R->m[1][2]) > 0 || wh_real_abs(R->m[2][0]) > 0 ||
             wh_real_abs(R->m[2][1]) > 0 || wh_real_abs(R->m[2][2] - 1) > 0);
}

static wh_status_t validate_shift(const wh_mount_t *mount) {
    if (!mount->is_shifted) {
        return WH_OK;
    }
    const wh_status_t status = wh_pose_validate(&mount->effector_from_gripper);
    if (status != WH_OK) {
        return status;
    }
    return is_level(&mount->effector_from_gripper.R) ? WH_OK : WH_STATUS_NOT_LEVEL;
}

static wh_status_t validate_mount(const wh_machine_t *machine, const wh_mount_t *mount) {
    if (mount->axis == WH_NONE) {
        return validate_shift(mount);
    }
    if (mount->axis < WH_ROBOT_AXES || (size_t)mount->axis >= machine->axis_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return wh_pose_validate(&mount->base_from_station);
}

wh_status_t wh_machine_validate(const wh_machine_t *machine) {
    if (!machine) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (machine->axis_count < WH_ROBOT_AXES || machine->axis_count > WH_AXES || machine->gripper_count < 1 ||
        machine->gripper_count > WH_GRIPPERS) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_status_t status = wh_robot_validate(&machine->robot);
    if (status == WH_OK) {
        status = wh_limits_validate(&machine->chuck_limits);
    }
    for (size_t g = 0; g < machine->gripper_count && status == WH_OK; ++g) {
        status = validate_mount(machine, &machine->mounts[g]);
    }
    return status;
}

const wh_limits_t *wh_machine_limits(const wh_machine_t *machine, size_t axis) {
    return axis < WH_ROBOT_AXES ? &machine->robot.limits[axis] : &machine->chuck_limits;
}

wh_status_t wh_machine_check_travel(const wh_machine_t *machine, const wh_real_t axes[]) {
    const wh_status_t status = wh_robot_check_travel(&machine->robot, axes);
    if (status != WH_OK) {
        return status;
    }
    for (size_t axis = WH_ROBOT_AXES; axis < machine->axis_count; ++axis) {
        if (!wh_real_is_finite(axes[axis])) {
            return WH_STATUS_NOT_FINITE;
        }
        if (wh_real_abs(axes[axis]) > WH_CHUCK_TRAVEL) {
            return WH_STATUS_LIMIT_EXCEEDED;
        }
    }
    return WH_OK;
}

/* -------------------------------------------------------------------------------------------------- poses */

/* Places a gripper on the robot. */
static void place_on_robot(const wh_mount_t *mount, const wh_pose_t *base_from_effector, wh_pose_t *pose) {
    if (mount->is_shifted) {
        wh_pose_compose_to(base_from_effector, &mount->effector_from_gripper, pose);
    } else {
        *pose = *base_from_effector;
    }
}

static void place_on_chuck(const wh_mount_t *mount, wh_real_t angle, wh_pose_t *pose) {
    const wh_mat3_t turn = wh_mat3_about_z(angle);
    wh_mat3_multiply_to(&mount->base_from_station.R, &turn, &pose->R);
    pose->r = mount->base_from_station.r;
}

void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[]) {
    wh_pose_t base_from_effector;
    wh_robot_forward(axes, &base_from_effector);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis == WH_NONE) {
            place_on_robot(mount, &base_from_effector, &poses[g]);
        } else {
            place_on_chuck(mount, axes[mount->axis], &poses[g]);
        }
    }
}

/* Compares bits: 0 and -0 differ, and NaN equals itself. */
static bool is_same(wh_real_t a, wh_real_t b) {
    return wh_bits(a) == wh_bits(b);
}

/* Keeps the axes in the cache. Returns bit a for each axis a that has moved since the last call. */
static uint32_t take_axes(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache) {
    uint32_t moved = 0;
    for (size_t axis = 0; axis < machine->axis_count; ++axis) {
        moved |= cache->is_taken && is_same(axes[axis], cache->axes[axis]) ? 0 : 1U << axis;
        cache->axes[axis] = axes[axis];
    }
    return moved;
}

static bool has_moved(uint32_t moved, size_t axis) {
    return (moved >> axis & 1U) != 0;
}

/* wh_robot_forward with the sines of the cache. */
static void move_effector(const wh_real_t q[], uint32_t moved, wh_machine_cache_t *cache) {
    const wh_real_t heading = q[WH_AXIS_THETA] + q[WH_AXIS_YAW];
    wh_pose_t *effector = &cache->base_from_effector;
    if (has_moved(moved, WH_AXIS_THETA)) {
        wh_sin_cos(q[WH_AXIS_THETA], &cache->sine, &cache->cosine);
    }
    effector->r = wh_vec3(q[WH_AXIS_R] * cache->cosine, q[WH_AXIS_R] * cache->sine, q[WH_AXIS_Z]);
    if (!cache->is_taken || !is_same(heading, cache->heading)) {
        effector->R = is_same(heading, q[WH_AXIS_THETA]) ? wh_mat3_turn_z(cache->sine, cache->cosine)
                                                         : wh_mat3_about_z(heading);
    }
    cache->heading = heading;
}

void wh_machine_update(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache,
                       wh_gripper_input_t grippers[]) {
    const uint32_t moved = take_axes(machine, axes, cache);
    const bool robot = (moved & ((1U << WH_ROBOT_AXES) - 1)) != 0;
    if (robot) {
        move_effector(axes, moved, cache);
    }
    for (size_t g = 0; moved != 0 && g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis != WH_NONE && has_moved(moved, (size_t)mount->axis)) {
            place_on_chuck(mount, axes[mount->axis], &grippers[g].base_from_gripper);
        } else if (mount->axis == WH_NONE && robot) {
            place_on_robot(mount, &cache->base_from_effector, &grippers[g].base_from_gripper);
        }
    }
    cache->is_taken = true;
}

wh_status_t wh_machine_inverse(const wh_machine_t *machine, size_t gripper, const wh_vec3_t *at,
                               wh_real_t heading, const wh_real_t near_q[WH_ROBOT_AXES],
                               wh_real_t q[WH_ROBOT_AXES]) {
    const wh_mount_t *mount = &machine->mounts[gripper];
    if (!mount->is_shifted) {
        return wh_robot_inverse(&machine->robot, at->x, at->y, at->z, heading, near_q, q);
    }
    const wh_pose_t *shift = &mount->effector_from_gripper;
    const wh_real_t turned = heading - wh_atan2(shift->R.m[1][0], shift->R.m[0][0]);
    if (!(wh_real_abs(turned) <= WH_TRIG_MAX_RAD)) {
        return wh_real_is_finite(turned) ? WH_STATUS_OUT_OF_RANGE : WH_STATUS_NOT_FINITE;
    }
    const wh_mat3_t turn = wh_mat3_about_z(turned);
    const wh_vec3_t reach = wh_mat3_transform(&turn, &shift->r);
    const wh_vec3_t effector = wh_vec3_subtract(at, &reach);
    return wh_robot_inverse(&machine->robot, effector.x, effector.y, effector.z, turned, near_q, q);
}
