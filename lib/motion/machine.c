#include "motion/machine.h"

#include "motion/trig.h"

static wh_status_t validate_mount(const wh_machine_t *machine, const wh_mount_t *mount) {
    if (mount->axis == WH_NONE) {
        return WH_OK;
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
            poses[g] = base_from_effector;
        } else {
            const wh_mat3_t turn = wh_mat3_about_z(axes[mount->axis]);
            poses[g].R = wh_mat3_multiply(&mount->base_from_station.R, &turn);
            poses[g].r = mount->base_from_station.r;
        }
    }
}
