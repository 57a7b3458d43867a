/* A robot of any kind (motion/chain.h) as a machine takes it, with axes in the machine's order.
 *
 *     0 theta, 1 R or a SCARA's elbow, 2 Z, 3 yaw, then those that it has of: rail, tilt_x, tilt_y, flip,
 *     and of a second arm its R, or of a second wrist its yaw
 *
 * The first four are always there, so that they mean the same in each machine; TRZ's yaw stands at 0. The
 * functions are reached by pointers that wh_carrier_init sets: a firmware whose robot is that of
 * motion/robot.h does not link them.
 *
 * A machine with several robots has a carrier for each of them, in a list. A carrier is filled in once and
 * handed on by const pointer. No heap; all functions are reentrant.
 */
#ifndef WH_MOTION_CARRIER_H
#define WH_MOTION_CARRIER_H

#include "chain_line.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(carrier);

#define WH_CARRIER_AXES 9

/* In wh_carrier_t's axes: the other arm's or wrist's alone. */
#define WH_CARRIER_OTHERS 0xFF

typedef struct wh_carrier wh_carrier_t;

/* A robot, by its first arm or wrist, or its second. Written by wh_carrier_init and wh_carrier_add only, but
 * for `next`; reading chain, axis_count and axes is fine. In the calls all arrays of axes have axis_count
 * entries, in the order above; those of the other arm alone are not moved. Errors, cost and accuracy are
 * those of the chain's function of the same name. The first arm's check_travel looks at both. */
struct wh_carrier {
    const wh_carrier_t *next;   /* the caller's: the machine's next robot; null: there is none */
    const wh_carrier_t *second; /* the caller's: the second arm or wrist; null: none, or it is that */
    wh_chain_t chain;
    size_t axis_count;             /* 4 to WH_CARRIER_AXES */
    uint8_t axes[WH_CARRIER_AXES]; /* by the machine's axis the chain's */
    wh_status_t (*check_travel)(const wh_carrier_t *carrier, const wh_real_t axes[]);
    void (*forward)(const wh_carrier_t *carrier, const wh_real_t axes[], wh_pose_t *base_from_effector);
    wh_status_t (*inverse)(const wh_carrier_t *carrier, const wh_pose_t *base_from_effector,
                           const wh_chain_choice_t *choice, const wh_real_t near_axes[], wh_real_t axes[]);
    wh_status_t (*plan_line)(const wh_carrier_t *carrier, wh_chain_line_t *line, const wh_real_t from[],
                             const wh_vec3_t *travel, const wh_line_caps_t *caps);
    void (*line_at)(const wh_carrier_t *carrier, const wh_chain_line_t *line, wh_real_t t, wh_real_t axes[]);
};

/* Copies the chain; `next` becomes null. Errors, *carrier then unchanged: WH_STATUS_NULL_ARGUMENT, or what
 * wh_chain_validate says. */
wh_status_t wh_carrier_init(wh_carrier_t *carrier, const wh_chain_t *chain) WH_SYMBOL(wh_carrier_init);

/* Gives the robot of `first`, which must have one arm, a second one in `second`: of kind TRZ an arm with
 * an R of its own that points along `heading` (rad) when theta is 0, of a SCARA a wrist with a yaw of its
 * own whose home is by `heading` beyond the first one's, both `height` mm above base_from_effector of R's
 * or yaw's chain without height. All else is as of the first. `first` points to `second`: neither may be
 * moved. Errors, both then unchanged: WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE for kind TRZY and
 * for one with a second, or what wh_chain_validate says of the second. */
wh_status_t wh_carrier_add(wh_carrier_t *first, wh_carrier_t *second, wh_real_t heading, wh_real_t height)
    WH_SYMBOL(wh_carrier_add);

/* The chain that has this one of a first arm's axes, and its index in the chain. */
static inline const wh_chain_t *wh_carrier_axis(const wh_carrier_t *carrier, size_t own, size_t *axis) {
    const bool is_others = carrier->axes[own] == WH_CARRIER_OTHERS;
    const wh_carrier_t *arm = is_others ? carrier->second : carrier;
    *axis = arm->axes[own];
    return &arm->chain;
}

/* What a pose does not decide, as it is at these axes: rail and flip, and the elbow on its side. */
static inline wh_chain_choice_t wh_carrier_choice(const wh_carrier_t *carrier, const wh_real_t axes[]) {
    wh_chain_choice_t choice = {0, 0, WH_ELBOW_NEAR};
    for (size_t i = 0; i < carrier->axis_count; ++i) {
        choice.rail = carrier->axes[i] == WH_CHAIN_RAIL ? axes[i] : choice.rail;
        choice.flip = carrier->axes[i] == WH_CHAIN_FLIP ? axes[i] : choice.flip;
    }
    return choice;
}

WH_HEADER_END

#endif
