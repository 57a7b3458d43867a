/* The machine: the robot's four axes, the chucks' axes after them, and what each gripper rides on.
 *
 * Axes 0 to 3 are theta (rad), R (mm), Z (mm) and yaw (rad) of wh_robot_t; each axis from 4 on turns a chuck
 * (rad). A description, immutable once it is filled in; poses are base_from_gripper.
 */
#ifndef WH_MOTION_MACHINE_H
#define WH_MOTION_MACHINE_H

#include <stdbool.h>

#include "../grasp/grasp.h"
#include "move.h"
#include "robot.h"

/* Grippers a machine can have, as many as a command message carries. */
#define WH_GRIPPERS 8

/* Chucks turn without a stop, up to this many radians from zero. */
#define WH_CHUCK_TRAVEL WH_REAL(1e4)

/* What a gripper is fixed to. All zero but the axis and one of the poses is fine. */
typedef struct {
    int32_t axis;                /* the chuck's axis (4 and up), or WH_NONE: the robot's end-effector */
    wh_pose_t base_from_station; /* of a chuck: where its contact plane is at angle 0 */
    bool is_shifted; /* on the robot: effector_from_gripper counts; false: the gripper's frame is the
                                  * end-effector's own, to the last bit */
    wh_pose_t effector_from_gripper; /* level: a place and a turn about z alone, as of one blade of two */
} wh_mount_t;

typedef struct {
    wh_robot_t robot;
    wh_limits_t chuck_limits; /* rad/s, rad/s^2, rad/s^3, of every chuck */
    size_t axis_count;        /* 4 to WH_AXES */
    size_t gripper_count;     /* 1 to WH_GRIPPERS */
    wh_mount_t mounts[WH_GRIPPERS];
} wh_machine_t;

/* Where the machine stood when wh_machine_update was last called: what it need not compute again. All zero before the first
 * call; written by it only. */
typedef struct {
    bool is_taken; /* the rest is of `axes` */
    wh_real_t axes[WH_AXES];
    wh_real_t sine, cosine; /* of theta */
    wh_real_t heading;      /* theta + yaw */
    wh_pose_t base_from_effector;
} wh_machine_cache_t;

/* WH_OK, or WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE (a count or a mount's axis), WH_STATUS_NOT_LEVEL (a
 * shifted gripper whose z is not the end-effector's, to the last bit), or what wh_robot_validate and
 * wh_pose_validate say. Cost: linear in the grippers. */
wh_status_t wh_machine_validate(const wh_machine_t *machine);

/* The limits of one axis; `axis` is not checked. */
const wh_limits_t *wh_machine_limits(const wh_machine_t *machine, size_t axis);

/* Whether axes[0 .. axis_count - 1] are within their travel: what wh_robot_check_travel says of the first four, then
 * WH_STATUS_NOT_FINITE or WH_STATUS_LIMIT_EXCEEDED for a chuck. */
wh_status_t wh_machine_check_travel(const wh_machine_t *machine, const wh_real_t axes[]);

/* Where each gripper is: poses[0 .. gripper_count - 1] from axes[0 .. axis_count - 1]. No argument is
 * checked. Cost: a sine and cosine for the robot and for each chuck, a product of poses for each shifted gripper.
 */
void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[]);

/* The same, bit for bit, for one slice after another: writes base_from_gripper of the grippers that have moved since the
 * last call with this stance; those of the others must be as that call left them. `machine` must be the same in all of
 * them. Cost: what has moved, of the above; a comparison of all axes for one that stands still. */
void wh_machine_update(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache,
                       wh_gripper_input_t grippers[]);

/* The axes that bring gripper `gripper`, which is on the robot, to the point `at` (base, mm) with its x along `heading`:
 * wh_robot_inverse of where the end-effector then is, with its errors and what it leaves unchanged. On a level
 * arm the end-effector's straight lines at constant heading are the gripper's. `machine` and `gripper` are not
 * checked. */
wh_status_t wh_machine_inverse(const wh_machine_t *machine, size_t gripper, const wh_vec3_t *at,
                               wh_real_t heading, const wh_real_t near_q[WH_ROBOT_AXES],
                               wh_real_t q[WH_ROBOT_AXES]);

#endif
