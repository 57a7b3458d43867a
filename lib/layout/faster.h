/* A cell in which one mechanism or station takes less time: how much would it bring? */
#ifndef WH_LAYOUT_FASTER_H
#define WH_LAYOUT_FASTER_H

#include "layout.h"

#define WH_LAYOUT_PACED_BYTES (WH_NAME_SIZE + 12)

/* The number of mechanisms and stations whose time a layout gives: each robot, the chucks together, stages,
 * pins and flippers, doors, and the stations that take time. */
size_t wh_layout_paced(const wh_layout_t *layout);

/* The number of a station of the layout among them; SIZE_MAX: it takes no time. */
size_t wh_layout_paced_station(const wh_layout_t *layout, size_t station);

/* The name of number `i` of them: that of the robot, the gripper, the door or the station, or "chucks". */
void wh_layout_name_paced(const wh_layout_t *layout, size_t i, char name[WH_LAYOUT_PACED_BYTES]);

/* Number `i` of them takes `share` (above 0, below 1) less time: a mechanism goes its ways in so much less,
 * by its limits, those with a wafer, too; strokes whose speed the layout or a command gives stay. A station's
 * processes, cleans, pumps and, of a tool of times alone, doors take so much less. To be called before
 * anything is made from the layout. */
void wh_layout_hasten(wh_layout_t *layout, size_t i, double share);

#endif
