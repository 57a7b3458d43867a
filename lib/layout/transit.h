/* How far out a robot's arms may be while it turns or goes along its rail, so that blades and wafers stay
 * within the layout's circle about theta's axis.
 *
 * A robot's `transit` is a radius about theta's axis, mm. A point p of a blade is at R e_x + Rz(yaw) p
 * from that axis, seen along the arm. With p at the distance d and in the direction a, it is within the
 * circle while R <= sqrt(transit^2 - d^2 (1 - c^2)) - d c, c being the largest cos(a + yaw) on the way.
 * Looked at are the parts that hang on grippers of the arm, and on each of these grippers a wafer, if there
 * is one or not, turned over as far as the flip is. If the flip turns on the way, points are taken to be as
 * far aside as they are from its axis at most. What is not polygonal is taken by an outline of 48 corners
 * that encloses it.
 *
 * All functions are reentrant. They end the program if out of memory.
 */
#ifndef WH_LAYOUT_TRANSIT_H
#define WH_LAYOUT_TRANSIT_H

#include "../motion/track.h"
#include "layout.h"

/* What a way of a robot needs to know of it. */
typedef struct {
    wh_real_t reach[WH_POLAR_ARMS]; /* the largest R of each arm, mm */
    wh_real_t r;                    /* that of the arm which is beyond, the first if both are */
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
 * Fills in the largest R of each arm for all that yaw may be while one of these legs runs into the other.
 * Cost as above. */
bool wh_transit_corner(const wh_layout_t *layout, size_t robot, const wh_real_t from[],
                       const wh_real_t point[], const wh_real_t to[], wh_real_t reach[WH_POLAR_ARMS]);

/* Makes a segment of kind AXES that begins at these axes one of kind WAY, if a robot leaves its transit in
 * it. */
void wh_transit_keep(const wh_layout_t *layout, const wh_real_t from[WH_AXES], wh_segment_t *segment);

/* Says of such a way, whose ends the axes' travel allows, which transit would leave room to turn. */
void wh_transit_say(const wh_layout_t *layout, const wh_real_t from[WH_AXES], const wh_segment_t *segment,
                    char *text, size_t size);

#endif
