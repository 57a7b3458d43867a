/* Where the links of a layout's robots are, slice by slice, by what its grippers and axes say. */
#ifndef WH_LAYOUT_LINKS_H
#define WH_LAYOUT_LINKS_H

#include "layout.h"

/* How far the axes of a command may be from where they brought the end-effector, mm: rounding. */
#define WH_LINKS_SAME WH_REAL(1e-6)

/* The state of an arm that the next call starts from. */
typedef struct {
    wh_pose_t base_from_effector;
    wh_real_t axes[WH_CARRIER_AXES]; /* its robot's, at which the links are, of a robot with a carrier */
} wh_links_arm_t;

/* A call in which each arm stood was told this: the next one that is told so has nothing to do. */
typedef struct {
    bool is_known;
    wh_real_t axes[WH_AXES];
    wh_pose_t base_from_grippers[WH_GRIPPERS];
} wh_links_told_t;

typedef struct {
    wh_links_told_t standing;
    wh_links_arm_t arms[WH_LAYOUT_ARMS];
    wh_pose_t bodies[WH_LAYOUT_ARMS * WH_ARM_BODIES]; /* base_from_body, by its number: arms.h */
} wh_links_t;

/* Room for the reason of wh_links_reach. */
#define WH_LINKS_BYTES 80

/* False if two links of a polar arm do not reach its wrist at the axes `to`, which are not all as in
 * `from`: of the first such arm `reason` says it. Arms whose robot keeps its axes are not asked. A SCARA
 * is refused by its inverse. Cost: that of wh_arm_place_carrier for each arm. */
bool wh_links_reach(const wh_layout_t *layout, const wh_real_t from[], const wh_real_t to[],
                    char reason[WH_LINKS_BYTES]);

/* All robots at home. */
void wh_links_home(wh_links_t *links, const wh_layout_t *layout);

/* The robots at these axes, all of the machine's. */
void wh_links_at(wh_links_t *links, const wh_layout_t *layout, const wh_real_t axes[]);

/* The first gripper on an arm tells where its end-effector is, because a fault may keep both from the place
 * to which the axes should have brought them. Without such a gripper nothing changes. The links of the usual
 * robot follow from the end-effector. If a robot has a carrier and the command's axes bring the end-effector
 * there to `slack` mm, its links are at these axes. Otherwise they are at axes that do so, with rail, flip
 * and the elbow's side unchanged; if there are none, they stay. `axes`, in the machine's order, may be null:
 * not known. `told`, which may be null too, are the poses of all grippers that wh_machine_update made of
 * these axes with the layout's machine: they save the way from axes to end-effector. Cost: that of
 * wh_arm_place_carrier for each arm; one that has not moved costs next to nothing. */
void wh_links_follow(wh_links_t *links, const wh_layout_t *layout, const wh_pose_t base_from_grippers[],
                     const wh_real_t axes[], const wh_gripper_input_t told[], wh_real_t slack);

#endif
