/* The machine: the axes of its robots, then those of chucks, stages and pins, and doors last. It also says
 * what carries each gripper.
 *
 * Axes 0 to 3 are theta (rad), R (mm), Z (mm) and yaw (rad) of wh_robot_t. A robot of another kind
 * (motion/carrier.h) may have up to five more. A machine may have several robots of those kinds: each one's
 * axes follow those of the one before. Each axis after the robots' turns a chuck (rad), shifts one on its
 * stage, lifts pins or moves a door (mm), or turns a flipper over (rad). A machine is a description: it
 * does not change after it is filled in. Poses are base_from_gripper.
 */
#ifndef WH_MOTION_MACHINE_H
#define WH_MOTION_MACHINE_H

#include <stdbool.h>

#include "../grasp/grasp.h"
#include "carrier.h"
#include "door.h"
#include "move.h"
#include "robot.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(machine);

/* Chucks turn without a stop, up to this number of radians from zero. */
#define WH_CHUCK_TRAVEL WH_REAL(1e4)

/* The way in which the axes of a gripper that is not on a robot move it, in its station's frame. */
typedef enum WH_FOUR_BYTES {
    WH_MOUNT_CHUCK, /* `axis` turns it about z */
    WH_MOUNT_STAGE, /* likewise; the next two axes shift it along x and y, mm: each by up to travel.max */
    WH_MOUNT_PINS,  /* `axis` is its height, mm, from travel.min, where it is at home, to travel.max */
    /* `axis` turns it over about x, `height` above the station's plane, from 0 to travel.max */
    WH_MOUNT_FLIPPER
} wh_mount_kind_t;

/* The mount of a gripper. `axis` and one of the poses must be filled in; the rest may be zero. */
typedef struct {
    int32_t axis;                /* the chuck's axis, after the robots'; WH_NONE: on a robot's end-effector */
    wh_pose_t base_from_station; /* of a chuck: its contact plane at angle 0 */
    /* on a robot: true if effector_from_gripper is used; false if the gripper's frame is the end-effector's
     * own, to the last bit */
    bool is_shifted;
    uint8_t robot; /* on a robot: its number, from 0 */
    uint8_t arm;   /* the arm or wrist of that robot: 0, or 1 for the second */
    /* level: an offset and a turn about z alone, such as for one blade of two */
    wh_pose_t effector_from_gripper;
    wh_mount_kind_t kind; /* unless it is on the robot */
    wh_travel_t travel;   /* of a stage, pins or a flipper, with their limits */
    wh_limits_t limits;
    wh_real_t height; /* of a flipper's axis, mm */
} wh_mount_t;

typedef struct {
    wh_robot_t robot;         /* with a carrier: the carrier's values of axes 0 to 3 */
    wh_limits_t chuck_limits; /* rad/s, rad/s^2, rad/s^3, of every chuck */
    size_t axis_count;        /* the robots' to WH_AXES */
    size_t gripper_count;     /* 1 to WH_GRIPPERS */
    wh_mount_t mounts[WH_GRIPPERS];
    /* the caller's: robot 0, and the others by carrier->next; NULL: one robot, that of motion/robot.h */
    const wh_carrier_t *carrier;
    const wh_door_t *doors; /* the caller's; door_count of them have the last axes, in their order */
    size_t door_count;      /* 0 to WH_DOORS */
} wh_machine_t;

/* Gives the machine robots of any kind: the carrier's and all that follow it by `next`. It fills in carrier
 * and axis_count, and robot from the first. No pointer may be null. */
void wh_machine_take_carrier(wh_machine_t *machine, const wh_carrier_t *carrier)
    WH_SYMBOL(wh_machine_take_carrier);

/* The number of axes from `axis` on that belong to a mount; 0 for a mount on a robot. */
static inline size_t wh_mount_axes(const wh_mount_t *mount) {
    size_t own = 1;
    if (mount->kind == WH_MOUNT_STAGE) {
        own = 3;
    }
    return mount->axis == WH_NONE ? 0 : own;
}

/* Bit a for each axis a that moves a gripper which is not on a robot. */
static inline uint32_t wh_mount_moved_by(const wh_mount_t *mount) {
    return mount->axis == WH_NONE ? 0 : ((1U << wh_mount_axes(mount)) - 1U) << (uint32_t)mount->axis;
}

/* The axis of a door, which the machine must have. */
static inline size_t wh_machine_door_axis(const wh_machine_t *machine, size_t door) {
    return machine->axis_count - machine->door_count + door;
}

/* The number of axes of the robots. Cost: linear in robots. */
static inline size_t wh_machine_robot_axes(const wh_machine_t *machine) {
    size_t count = machine->carrier ? 0 : WH_ROBOT_AXES;
    for (const wh_carrier_t *carrier = machine->carrier; carrier; carrier = carrier->next) {
        count += carrier->axis_count;
    }
    return count;
}

/* Bit a for each axis a of the robots. */
static inline uint32_t wh_machine_robot_bits(const wh_machine_t *machine) {
    const uint32_t count = (uint32_t)wh_machine_robot_axes(machine);
    return count > 0 ? UINT32_MAX >> (32U - count) : 0;
}

/* The number of robots: 1 or more. */
size_t wh_machine_robots(const wh_machine_t *machine) WH_SYMBOL(wh_machine_robots);

/* A robot's carrier, and its first axis if `first` is not null; a null result: it is the robot of
 * motion/robot.h. The machine must have a robot of this number. */
const wh_carrier_t *wh_machine_carrier(const wh_machine_t *machine, size_t robot, size_t *first)
    WH_SYMBOL(wh_machine_carrier);

/* The arm that carries a gripper on a robot with a carrier, and the robot's first axis. */
const wh_carrier_t *wh_machine_arm(const wh_machine_t *machine, size_t gripper, size_t *first)
    WH_SYMBOL(wh_machine_arm);

/* The robot that has this axis, and the axis's index within it; WH_NONE for a chuck's axis, and `own` is
 * then unchanged. */
int32_t wh_machine_robot_of(const wh_machine_t *machine, size_t axis, size_t *own)
    WH_SYMBOL(wh_machine_robot_of);

/* Values that wh_machine_update need not compute again: the axes of its last call and the results. All zero
 * before the first call; only that function writes it. */
typedef struct {
    bool is_taken; /* the rest belongs to `axes` */
    wh_real_t axes[WH_AXES];
    wh_real_t sine, cosine; /* of theta */
    wh_real_t heading;      /* theta + yaw */
    wh_pose_t base_from_effector;
} wh_machine_cache_t;

/* Returns WH_OK, or WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE (a count, a mount's axis, kind, robot
 * or arm), WH_STATUS_NOT_LEVEL (a shifted gripper whose z is not the end-effector's, to the last bit),
 * WH_STATUS_BAD_LIMITS (the travel of a stage, of pins, of a flipper or of a door), or the status of
 * wh_robot_validate, wh_pose_validate and wh_limits_validate. Cost: linear in the grippers. */
wh_status_t wh_machine_validate(const wh_machine_t *machine) WH_SYMBOL(wh_machine_validate);

/* The limits of one axis; `axis` is not checked. */
const wh_limits_t *wh_machine_limits(const wh_machine_t *machine, size_t axis) WH_SYMBOL(wh_machine_limits);

/* The travel of one of the robots' axes; null if they have no axis of this number. */
const wh_travel_t *wh_machine_travel(const wh_machine_t *machine, size_t axis) WH_SYMBOL(wh_machine_travel);

/* The travel of an axis after the robots'; `axis` is not checked. Cost: linear in the grippers. */
wh_travel_t wh_machine_beside(const wh_machine_t *machine, size_t axis) WH_SYMBOL(wh_machine_beside);

/* Writes axes[0 .. axis_count - 1]: the robots at home, chucks and stages at 0, pins down, doors at
 * home. */
void wh_machine_home(const wh_machine_t *machine, wh_real_t axes[]) WH_SYMBOL(wh_machine_home);

/* Writes the pose of a robot's end-effector, on the first arm, as in wh_machine_grippers. */
void wh_machine_effector(const wh_machine_t *machine, size_t robot, const wh_real_t axes[],
                         wh_pose_t *base_from_effector) WH_SYMBOL(wh_machine_effector);

/* Checks that axes[0 .. axis_count - 1] are within their travel. Returns the status of
 * wh_robot_check_travel, or of the carriers, for the robots' axes, then WH_STATUS_NOT_FINITE or
 * WH_STATUS_LIMIT_EXCEEDED for another axis. */
wh_status_t wh_machine_check_travel(const wh_machine_t *machine, const wh_real_t axes[])
    WH_SYMBOL(wh_machine_check_travel);

/* Writes the pose of each gripper: poses[0 .. gripper_count - 1] from axes[0 .. axis_count - 1]. No
 * argument is checked. Cost: a sine and cosine for each robot and for each chuck, a product of poses for
 * each shifted gripper. */
void wh_machine_grippers(const wh_machine_t *machine, const wh_real_t axes[], wh_pose_t poses[])
    WH_SYMBOL(wh_machine_grippers);

/* Gives the bits of wh_machine_grippers, for one slice after another. Writes base_from_gripper of the
 * grippers that have moved since the last call with this cache; the others must still have the values of
 * that call. `machine` must be the same in all calls. Cost: that of the parts that have moved; a comparison
 * of all axes if none has. */
void wh_machine_update(const wh_machine_t *machine, const wh_real_t axes[], wh_machine_cache_t *cache,
                       wh_gripper_input_t grippers[]) WH_SYMBOL(wh_machine_update);

/* The axes that bring gripper `gripper`, which is on a robot, to the point `at` (base, mm) with its x along
 * `heading`. It is wh_robot_inverse of the end-effector's place for that, with its errors, and leaves the
 * same unchanged. On a level arm the end-effector's straight lines at constant heading are the gripper's
 * too. Near_q and q have all axes of the machine; only those of the gripper's robot are read and written. A
 * carrier moves the gripper there level, with rail, flip and elbow as in near_q, and has the errors of
 * wh_chain_inverse. `machine` and `gripper` are not checked. */
wh_status_t wh_machine_inverse(const wh_machine_t *machine, size_t gripper, const wh_vec3_t *at,
                               wh_real_t heading, const wh_real_t near_q[], wh_real_t q[])
    WH_SYMBOL(wh_machine_inverse);

/* Does this for a machine with a carrier, and a pose that need not be level. */
wh_status_t wh_machine_bring(const wh_machine_t *machine, size_t gripper, const wh_pose_t *base_from_gripper,
                             const wh_chain_choice_t *choice, const wh_real_t near_q[], wh_real_t q[])
    WH_SYMBOL(wh_machine_bring);

WH_HEADER_END

#endif
