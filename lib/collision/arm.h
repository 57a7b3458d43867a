/* The poses of the links of a robot's arm. Theta, R, Z and yaw of a polar arm leave one choice to its
 * builder: the elbow.
 *
 * A polar arm is of the usual kind. A column lifts and turns; an upper arm and a forearm of equal length
 * fold over each other. A wrist carries the end-effector, `reach` behind its origin. The end-effector's
 * pose gives the wrist. The elbow is the point that both links reach, on the left as seen from the column
 * (on the right with `right_handed`). All links are level; lengths are mm in base. It uses no heap.
 *
 * If an arm has a height of its own, it is the hand's height: the links are as high as those of the other
 * arm.
 *
 * A SCARA's axes give its links' poses, and its wrist carries the end-effector's origin. A robot on a rail
 * moves its column, too; a tilt turns the arm, not the column; a flip turns the blade, not the hand.
 */
#ifndef WH_COLLISION_ARM_H
#define WH_COLLISION_ARM_H

#include "../motion/carrier.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(arm);

/* The bodies of the robot, each hanging on the one before it. */
typedef enum WH_FOUR_BYTES {
    WH_ARM_BASE,    /* base itself: the column's foot */
    WH_ARM_LIFT,    /* at (0, 0, Z), not turned */
    WH_ARM_UPPER,   /* at (0, 0, Z), x along the upper arm to the elbow */
    WH_ARM_FOREARM, /* at the elbow, height Z, x to the wrist */
    WH_ARM_HAND,    /* at the wrist, height Z, x along the end-effector's */
    WH_ARM_BODIES
} wh_arm_body_t;

typedef struct {
    wh_real_t reach; /* from the wrist to the end-effector's origin, mm, >= 0 */
    wh_real_t link;  /* length of each of the two links, mm, > 0 */
    bool right_handed;
} wh_arm_t;

/* True if a body is already there: both poses have equal numbers. */
bool wh_arm_is_at(const wh_pose_t *body, const wh_pose_t *base_from_body) WH_SYMBOL(wh_arm_is_at);

/* True if both links together reach the wrist of this end-effector's pose. */
bool wh_arm_reaches(const wh_arm_t *arm, const wh_pose_t *base_from_effector) WH_SYMBOL(wh_arm_reaches);

/* Writes bodies[WH_ARM_BODIES]: base_from_body. If the links are too short, they point at the wrist. If the
 * wrist is on the column's axis (to 1e-9 mm), the arm folds along the end-effector's x. Arguments are not
 * checked. Cost: three square roots. */
void wh_arm_place(const wh_arm_t *arm, const wh_pose_t *base_from_effector, wh_pose_t bodies[])
    WH_SYMBOL(wh_arm_place);

/* Writes the poses for a robot of any kind at these axes, in the machine's order. `arm` counts for polar
 * arms only. The upper arm's origin is on theta's axis, the hand's at the wrist, as if nothing was flipped.
 * `known` may have the result of carrier->forward for these axes; otherwise it is null. Cost: six products
 * of poses, and that of wh_chain_forward if `known` is null or the robot has a flip. */
void wh_arm_place_carrier(const wh_arm_t *arm, const wh_carrier_t *carrier, const wh_real_t axes[],
                          const wh_pose_t *known, wh_pose_t bodies[]) WH_SYMBOL(wh_arm_place_carrier);

WH_HEADER_END

#endif
