/* Where the links of a layout's robots are, slice by slice, by what its grippers and axes say. */
#ifndef WH_LAYOUT_LINKS_H
#define WH_LAYOUT_LINKS_H

#include "layout.h"

/* How far the axes of a command may be from where they brought the end-effector, mm: rounding. */
#define WH_LINKS_SAME WH_REAL(1e-6)

/* What the next call goes by of an arm. */
typedef struct {
    wh_pose_t base_from_effector;
    wh_real_t axes[WH_CARRIER_AXES]; /* its robot's, at which the links are, of a robot with a carrier */
} wh_links_arm_t;

typedef struct {
    wh_links_arm_t arms[WH_LAYOUT_ARMS];
    wh_pose_t bodies[WH_LAYOUT_ARMS * WH_ARM_BODIES]; /* base_from_body, by its number: arms.h */
} wh_links_t;

/* All robots at home. */
void wh_links_home(wh_links_t *links, const wh_layout_t *layout);

/* The robots at these axes, all of the machine's. */
void wh_links_at(wh_links_t *links, const wh_layout_t *layout, const wh_real_t axes[]);

/* The first gripper on an arm tells where its end-effector is, for a fault may keep both from where the
 * axes should have brought them. Without such a gripper all stays. The links of the usual robot follow from
 * that. Of a robot with a carrier the links are at the command's axes, if these bring the end-effector there
 * to `slack` mm; else at axes which do, with rail, flip and the elbow's side as they were; if
 * there are none, where they were. `axes`, in the machine's order, may be null: not known. Cost: that of
 * wh_arm_place_carrier for each arm; of several arms that have not moved next to nothing. */
void wh_links_follow(wh_links_t *links, const wh_layout_t *layout, const wh_pose_t base_from_grippers[],
                     const wh_real_t axes[], wh_real_t slack);

#endif
