/* Whether the links of a robot reach the stations that it serves. */
#ifndef WH_LAYOUT_REACH_H
#define WH_LAYOUT_REACH_H

#include "layout.h"

/* A place that the links of the robot that serves a station do not reach. */
typedef struct {
    int32_t slot;
    bool is_before; /* at the outer end of the way into it */
    char text[80];
} wh_unreached_t;

/* The number of places that are checked at a station: in its first slot, before it, in its last slot,
 * before that. */
#define WH_REACH_PLACES 4

/* True if the two links reach there, or if there is no such place. Runs call it before they begin, and so
 * does a check of the layout. A SCARA is refused by its inverse. */
bool wh_layout_reaches(const wh_layout_t *layout, size_t station, size_t place, wh_unreached_t *unreached);

/* True if the robot that serves a station tilts. */
bool wh_layout_tilts(const wh_layout_t *layout, size_t station);

/* base_from_gripper with the end-effector in a slot, heading in: level, unless the robot tilts. */
wh_pose_t wh_layout_come_level(const wh_layout_t *layout, const wh_station_t *station, int32_t slot);

#endif
