#include "motion/machine.h"

#include "motion/trig.h"

/* A tilt, however slight, shows in one of these; rounding leaves none of it in a turn about z alone. */
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

void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[]) {
    wh_pose_t base_from_effector;
    wh_robot_forward(axes, &base_from_effector);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        if (mount->axis == WH_NONE) {
            poses[g] = mount->is_shifted ? wh_pose_compose(&base_from_effector, &mount->effector_from_gripper)
                                         : base_from_effector;
        } else {
            const wh_mat3_t turn = wh_mat3_about_z(axes[mount->axis]);
            poses[g].R = wh_mat3_multiply(&mount->base_from_station.R, &turn);
            poses[g].r = mount->base_from_station.r;
        }
    }
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
