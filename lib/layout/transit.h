/* How far out the robot's arm may be while it turns, so that blades and wafers stay within the layout's
 * circle.
 *
 * A robot's `transit` is a radius about theta's axis, mm. A point p of a blade is at R e_x + Rz(yaw) p
 * from that axis, seen along the arm. With p at the distance d and in the direction a, it is within the
 * circle while R <= sqrt(transit^2 - d^2 (1 - c^2)) - d c, c being the largest cos(a + yaw) on the way.
 * Looked at are the parts that hang on grippers of the robot, and on each of these grippers a wafer, if there
 * is one or not. What is not polygonal is taken by an outline of 48 corners that encloses it.
 *
 * All functions are reentrant. They end the program if out of memory.
 */
#ifndef WH_LAYOUT_TRANSIT_H
#define WH_LAYOUT_TRANSIT_H

#include "../motion/track.h"
#include "layout.h"

/* The largest R while yaw goes from one value to the other (rad), mm; below 0 if there is none. The
 * robot has a transit. Cost: linear in the corners of what hangs on the robot. */
wh_real_t wh_transit_reach(const wh_layout_t *layout, size_t robot, wh_real_t yaw_from, wh_real_t yaw_to);

/* The least transit for which R at its travel's inner end would do, mm. */
wh_real_t wh_transit_least(const wh_layout_t *layout, size_t robot, wh_real_t yaw_from, wh_real_t yaw_to);

/* Makes a segment of kind AXES that begins at these axes one of kind WAY, if a robot with a transit turns in
 * it and R is beyond the largest at one of its ends. Cost as above. */
void wh_transit_keep(const wh_layout_t *layout, const wh_real_t from[WH_AXES], wh_segment_t *segment);

/* Says of such a way, whose ends the axes' travel allows, which transit would leave room to turn. */
void wh_transit_say(const wh_layout_t *layout, const wh_real_t from[WH_AXES], const wh_segment_t *segment,
                    char *text, size_t size);

#endif
