/* How far out a robot's arms may be while it turns or goes along its rail, so that blades and wafers stay
 * within the layout's circle about theta's axis.
 *
 * A robot's `transit` is a radius about theta's axis, mm. A point p of a blade is at R e_x + Rz(yaw) p
 * from that axis, seen along the arm. With p at the distance d and in the direction a, it is within the
 * circle while R <= sqrt(transit^2 - d^2 (1 - c^2)) - d c, c being the largest cos(a + yaw) on the way.
 * The check takes the parts that hang on grippers of the arm, and on each of these grippers a wafer, even if
 * there is none, turned over as far as the flip is. If the flip turns on the way, each point counts as far
 * aside as its distance from the flip's axis. Round shapes are replaced by an outline of 48 corners that
 * encloses them.
 *
 * All functions are reentrant. They end the program if out of memory.
 */
#ifndef WH_LAYOUT_TRANSIT_H
#define WH_LAYOUT_TRANSIT_H

#include "../motion/track.h"
#include "layout.h"

/* The transit of a robot on its way. */
typedef struct {
    wh_real_t reach[WH_POLAR_ARMS]; /* the largest R of each arm, mm */
    wh_real_t r;                    /* R of the arm which is beyond, the first if both are */
} wh_transit_t;

/* The largest R of an arm (0, 1) on the way from some axes of the robot's own to others (rad, mm), mm; below
 * 0 if there is none. The robot has a transit. Cost: linear in the corners of what hangs on the arm. */
wh_real_t wh_transit_reach(const wh_layout_t *layout, size_t robot, size_t arm, const wh_real_t from[],
                           const wh_real_t to[]);

/* The least transit for which R at its travel's inner end would do, of all arms, mm. */
wh_real_t wh_transit_least(const wh_layout_t *layout, size_t robot, const wh_real_t from[],
                           const wh_real_t to[]);

/* True if the robot has a transit and turns, or goes along its rail, and an arm is beyond its largest R at an
 * end; fills in `transit` then. Cost as above. */
bool wh_transit_leaves(const wh_layout_t *layout, size_t robot, const wh_real_t from[], const wh_real_t to[],
                       wh_transit_t *transit);

/* True if the robot has a transit, and turns, or goes along its rail, on its way to a point or from there.
 * Fills in the largest R of each arm for every yaw that may occur while one of these legs runs into the
 * other. Cost as above. */
bool wh_transit_corner(const wh_layout_t *layout, size_t robot, const wh_real_t from[],
                       const wh_real_t point[], const wh_real_t to[], wh_real_t reach[WH_POLAR_ARMS]);

/* Makes a segment of kind AXES that begins at these axes one of kind WAY, if a robot leaves its transit in
 * it. */
void wh_transit_keep(const wh_layout_t *layout, const wh_real_t from[WH_AXES], wh_segment_t *segment);

/* Says which transit would leave room to turn on such a way. The axes' travel allows its ends. */
void wh_transit_say(const wh_layout_t *layout, const wh_real_t from[WH_AXES], const wh_segment_t *segment,
                    char *text, size_t size);

#endif
