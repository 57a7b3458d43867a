/* The arms of a layout: one for each robot, and one more for a second arm or wrist; their bodies and names.
 *
 * Arms are counted robot by robot. Body b of arm a has the number a * WH_ARM_BODIES + b, which parts of kind
 * WH_PART_ARM have as owner. */
#ifndef WH_LAYOUT_ARMS_H
#define WH_LAYOUT_ARMS_H

#include "layout.h"

/* Fills in layout->arms and `carried_by` from the machine, once robots and grippers are read, and gives them
 * to the world if there are several. */
void wh_layout_find_arms(wh_layout_t *layout);

/* The number of arms, also in a layout that knows of no robot: 1 or more. */
size_t wh_layout_arms(const wh_layout_t *layout);

/* The arm as the machine knows it, and its robot's first axis; null: that of motion/robot.h. */
const wh_carrier_t *wh_layout_arm(const wh_layout_t *layout, size_t arm, size_t *first);

/* The lengths of a robot's links, if it is polar, and the least height of its contact plane, mm. */
const wh_arm_t *wh_layout_arm_lengths(const wh_layout_t *layout, size_t robot);
wh_real_t wh_layout_lowest(const wh_layout_t *layout, size_t robot);

/* True for a body that is the arm's own: not one that it shares with the robot's first arm. */
bool wh_layout_has_body(const wh_layout_t *layout, size_t number);

/* The name of a body by its number, such as "forearm", of a robot's second arm "forearm 2", and with several
 * robots "VAC forearm". `foot` is what the column is called. */
void wh_layout_name_body(const wh_layout_t *layout, size_t number, const char *foot, char *name, size_t size);

#endif
