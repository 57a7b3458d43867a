/* The machine: the robot's four axes, the chucks' axes after them, and what each gripper rides on.
 *
 * Axes 0 to 3 are theta (rad), R (mm), Z (mm) and yaw (rad) of wh_robot_t; each axis from 4 on turns a chuck
 * (rad). A machine is a description: it does not change once it is filled in. Poses are base_from_gripper.
 */
#ifndef WH_MOTION_MACHINE_H
#define WH_MOTION_MACHINE_H

#include <stdbool.h>

#include "../grasp/grasp.h"
#include "move.h"
#include "robot.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(machine);

/* The most grippers of a machine, and of a command message. */
#define WH_GRIPPERS 8

/* Chucks turn without a stop, up to this many radians from zero. */
#define WH_CHUCK_TRAVEL WH_REAL(1e4)

/* What a gripper is fixed to. `axis` and one of the poses must be filled in; the rest may be zero. */
typedef struct {
    int32_t axis;                /* the chuck's axis (4 and up); WH_NONE: on the robot's end-effector */
    wh_pose_t base_from_station; /* of a chuck: its contact plane at angle 0 */
    /* on the robot: true if effector_from_gripper counts; false if the gripper's frame is the end-effector's
     * own, to the last bit */
    bool is_shifted;
    /* level: an offset and a turn about z alone, such as for one blade of two */
    wh_pose_t effector_from_gripper;
} wh_mount_t;

typedef struct {
    wh_robot_t robot;
    wh_limits_t chuck_limits; /* rad/s, rad/s^2, rad/s^3, of every chuck */
    size_t axis_count;        /* 4 to WH_AXES */
    size_t gripper_count;     /* 1 to WH_GRIPPERS */
    wh_mount_t mounts[WH_GRIPPERS];
} wh_machine_t;

/* What wh_machine_update need not compute again: the axes of its last call and what followed from them. All
 * zero before the first call; only that function writes it. */
typedef struct {
    bool is_taken; /* the rest belongs to `axes` */
    wh_real_t axes[WH_AXES];
    wh_real_t sine, cosine; /* of theta */
    wh_real_t heading;      /* theta + yaw */
    wh_pose_t base_from_effector;
} wh_machine_cache_t;

/* WH_OK, or WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE (a count or a mount's axis), WH_STATUS_NOT_LEVEL
 * (a shifted gripper whose z is not the end-effector's, to the last bit), or what wh_robot_validate and
 * wh_pose_validate say. Cost: linear in the grippers. */
wh_status_t wh_machine_validate(const wh_machine_t *machine) WH_SYMBOL(wh_machine_validate);

/* The limits of one axis; `axis` is not checked. */
const wh_limits_t *wh_machine_limits(const wh_machine_t *machine, size_t axis) WH_SYMBOL(wh_machine_limits);

/* Checks that axes[0 .. axis_count - 1] are within their travel: what wh_robot_check_travel says of the first
 * four, then WH_STATUS_NOT_FINITE or WH_STATUS_LIMIT_EXCEEDED for a chuck. */
wh_status_t wh_machine_check_travel(const wh_machine_t *machine, const wh_real_t axes[])
    WH_SYMBOL(wh_machine_check_travel);

/* Where each gripper is: writes poses[0 .. gripper_count - 1] from axes[0 .. axis_count - 1]. No argument is
 * checked. Cost: a sine and cosine for the robot and for each chuck, a product of poses for each shifted
 * gripper. */
void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[])
    WH_SYMBOL(wh_machine_grippers);

/* wh_machine_grippers, bit for bit, for one slice after another. Writes base_from_gripper of the grippers
 * that have moved since the last call with this cache; the others must still have what that call left.
 * `machine` must be the same in all calls. Cost: that of what has moved; a comparison of all axes if nothing
 * has. */
void wh_machine_update(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache,
                       wh_gripper_input_t grippers[]) WH_SYMBOL(wh_machine_update);

/* The axes that bring gripper `gripper`, which is on the robot, to the point `at` (base, mm) with its x along
 * `heading`: wh_robot_inverse of the end-effector's place for that, with its errors and what it leaves
 * unchanged. On a level arm the end-effector's straight lines at constant heading are the gripper's too.
 * `machine` and `gripper` are not checked. */
wh_status_t wh_machine_inverse(const wh_machine_t *machine, size_t gripper, const wh_vec3_t *at,
                               wh_real_t heading, const wh_real_t near_q[WH_ROBOT_AXES],
                               wh_real_t q[WH_ROBOT_AXES]) WH_SYMBOL(wh_machine_inverse);

WH_HEADER_END

#endif
