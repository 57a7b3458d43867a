/* The machine: the robot's four axes, the chucks' axes after them, and what each gripper rides on.
 *
 * Axes 0 to 3 are theta (rad), R (mm), Z (mm) and yaw (rad) of wh_robot_t; each axis from 4 on turns a chuck
 * (rad). A description, immutable once it is filled in; poses are base_from_gripper.
 */
#ifndef WH_MOTION_MACHINE_H
#define WH_MOTION_MACHINE_H

#include "motion/move.h"
#include "motion/robot.h"

/* Grippers a machine can have, as many as a command message carries. */
#define WH_GRIPPERS 8

/* Chucks turn without a stop, up to this many radians from zero. */
#define WH_CHUCK_TRAVEL WH_REAL(1e4)

/* What a gripper is fixed to. */
typedef struct {
    int32_t axis;                /* the chuck's axis (4 and up), or WH_NONE: the robot's end-effector */
    wh_pose_t base_from_station; /* of a chuck: where its contact plane is at angle 0 */
} wh_mount_t;

typedef struct {
    wh_robot_t robot;
    wh_limits_t chuck_limits; /* rad/s, rad/s^2, rad/s^3, of every chuck */
    size_t axis_count;        /* 4 to WH_AXES */
    size_t gripper_count;     /* 1 to WH_GRIPPERS */
    wh_mount_t mounts[WH_GRIPPERS];
} wh_machine_t;

/* WH_OK, or WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE (a count or a mount's axis), or what
 * wh_robot_validate and wh_pose_validate say. Cost: linear in the grippers. */
wh_status_t wh_machine_validate(const wh_machine_t *machine);

/* The limits of one axis; `axis` is not checked. */
const wh_limits_t *wh_machine_limits(const wh_machine_t *machine, size_t axis);

/* Whether axes[0 .. axis_count - 1] are within their travel: what wh_robot_check_travel says of the first four, then
 * WH_STATUS_NOT_FINITE or WH_STATUS_LIMIT_EXCEEDED for a chuck. */
wh_status_t wh_machine_check_travel(const wh_machine_t *machine, const wh_real_t axes[]);

/* Where each gripper is: poses[0 .. gripper_count - 1] from axes[0 .. axis_count - 1]. No argument is
 * checked. Cost: a sine and cosine for the robot and for each chuck. */
void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[]);

#endif
