/* A robot of any kind (motion/chain.h) for use in a machine, with axes in the machine's order.
 *
 *     0 theta, 1 R or a SCARA's elbow, 2 Z, 3 yaw, then those that it has of: rail, tilt_x, tilt_y, flip,
 *     and of a second arm its R, or of a second wrist its yaw
 *
 * The first four always exist, so that they have one meaning in every machine; TRZ's yaw stands at 0. The
 * functions are called through pointers that wh_carrier_init sets: a firmware whose robot is that of
 * motion/robot.h does not link them.
 *
 * A machine with several robots has a carrier for each of them, in a list. A carrier is filled in once and
 * handed on by const pointer. It uses no heap; all functions are reentrant.
 */
#ifndef WH_MOTION_CARRIER_H
#define WH_MOTION_CARRIER_H

#include "chain_line.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(carrier);

#define WH_CARRIER_AXES 9

/* An entry of wh_carrier_t's axes: this axis belongs to the other arm or wrist alone. */
#define WH_CARRIER_OTHERS 0xFF

typedef struct wh_carrier wh_carrier_t;

/* A robot, by its first arm or wrist, or its second. Only wh_carrier_init and wh_carrier_add write it,
 * except `next`; callers may read chain, axis_count and axes. In the calls all arrays of axes have
 * axis_count entries, in the order above; axes of the other arm alone do not move. Errors, cost and
 * accuracy are those of the chain's function with that name. The first arm's check_travel checks both. */
struct wh_carrier {
    const wh_carrier_t *next;   /* the caller sets it: the machine's next robot; null: there is none */
    const wh_carrier_t *second; /* the caller's: the second arm or wrist; null: none, or this is the second */
    wh_chain_t chain;
    size_t axis_count;             /* 4 to WH_CARRIER_AXES */
    uint8_t axes[WH_CARRIER_AXES]; /* for each axis of the machine, the chain's axis */
    wh_status_t (*check_travel)(const wh_carrier_t *carrier, const wh_real_t axes[]);
    void (*forward)(const wh_carrier_t *carrier, const wh_real_t axes[], wh_pose_t *base_from_effector);
    wh_status_t (*inverse)(const wh_carrier_t *carrier, const wh_pose_t *base_from_effector,
                           const wh_chain_choice_t *choice, const wh_real_t near_axes[], wh_real_t axes[]);
    wh_status_t (*plan_line)(const wh_carrier_t *carrier, wh_chain_line_t *line, const wh_real_t from[],
                             const wh_vec3_t *travel, const wh_line_caps_t *caps);
    void (*line_at)(const wh_carrier_t *carrier, const wh_chain_line_t *line, wh_real_t t, wh_real_t axes[]);
};

/* Copies the chain; `next` becomes null. Errors, which leave *carrier unchanged: WH_STATUS_NULL_ARGUMENT,
 * or those of wh_chain_validate. */
wh_status_t wh_carrier_init(wh_carrier_t *carrier, const wh_chain_t *chain) WH_SYMBOL(wh_carrier_init);

/* Gives the robot of `first`, which must have one arm, a second one in `second`. For kind TRZ it is an arm
 * with an R of its own that points along `heading` (rad) when theta is 0. For a SCARA it is a wrist with a
 * yaw of its own whose home is `heading` beyond the first one's. Both are `height` mm above
 * base_from_effector of R's or yaw's chain without height. Everything else is as for the first. `first`
 * points to `second`: neither may be moved. Errors, which leave both unchanged: WH_STATUS_NULL_ARGUMENT,
 * WH_STATUS_OUT_OF_RANGE for kind TRZY and for a robot with a second arm, or those of wh_chain_validate for
 * the second. */
wh_status_t wh_carrier_add(wh_carrier_t *first, wh_carrier_t *second, wh_real_t heading, wh_real_t height)
    WH_SYMBOL(wh_carrier_add);

/* The chain that has this axis of a first arm, and the axis' index in the chain. */
static inline const wh_chain_t *wh_carrier_axis(const wh_carrier_t *carrier, size_t own, size_t *axis) {
    const bool is_others = carrier->axes[own] == WH_CARRIER_OTHERS;
    const wh_carrier_t *arm = is_others ? carrier->second : carrier;
    *axis = arm->axes[own];
    return &arm->chain;
}

/* A carrier's calls, for one that is written as a constant: see WH_CARRIER_CALLS. */
wh_status_t wh_carrier_check_travel(const wh_carrier_t *carrier, const wh_real_t axes[])
    WH_SYMBOL(wh_carrier_check_travel);
void wh_carrier_forward(const wh_carrier_t *carrier, const wh_real_t axes[], wh_pose_t *base_from_effector)
    WH_SYMBOL(wh_carrier_forward);
wh_status_t wh_carrier_inverse(const wh_carrier_t *carrier, const wh_pose_t *base_from_effector,
                               const wh_chain_choice_t *choice, const wh_real_t near_axes[], wh_real_t axes[])
    WH_SYMBOL(wh_carrier_inverse);
wh_status_t wh_carrier_plan_line(const wh_carrier_t *carrier, wh_chain_line_t *line, const wh_real_t from[],
                                 const wh_vec3_t *travel, const wh_line_caps_t *caps)
    WH_SYMBOL(wh_carrier_plan_line);
void wh_carrier_line_at(const wh_carrier_t *carrier, const wh_chain_line_t *line, wh_real_t t,
                        wh_real_t axes[]) WH_SYMBOL(wh_carrier_line_at);

/* The last members of a constant carrier, whose other members have the values that wh_carrier_init and
 * wh_carrier_add gave one like it (`waferhand run --segments` writes such). Nothing checks them. */
#define WH_CARRIER_CALLS                                                                                     \
    wh_carrier_check_travel, wh_carrier_forward, wh_carrier_inverse, wh_carrier_plan_line, wh_carrier_line_at

/* The choices that a pose leaves open, as they are at these axes: rail, flip, and the side of the elbow. */
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
