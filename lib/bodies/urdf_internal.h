/* Shared by the comparison of a URDF with its robot (urdf.c) and the search for its joints' extremes
 * (urdf_limits.c). */
#ifndef WH_BODIES_URDF_INTERNAL_H
#define WH_BODIES_URDF_INTERNAL_H

#include "urdf.h"

/* A map's robot: its carrier, or null, its axes among the machine's, and the first of its arms. */
typedef struct {
    const wh_carrier_t *carrier;
    size_t first, count;
    size_t arm;
} wh_urdf_robot_t;

wh_urdf_robot_t wh_urdf_robot(const wh_urdf_map_t *map, const wh_layout_t *layout);

/* Theta, R or yaw of a robot, by its number in motion/robot.h; 0 where it has none. */
wh_real_t wh_urdf_axis(const wh_urdf_robot_t *robot, const wh_layout_t *layout, const wh_real_t axes[],
                       size_t axis);

/* The machine's axis that moves arm `number` of a polar robot out. */
size_t wh_urdf_radial_axis(const wh_urdf_robot_t *robot, size_t number);

/* Writes what joints can follow, and how much each arm is stretched: above 1 the links do not reach, near 0
 * and 1 rounding turns them. */
void wh_urdf_sources(const wh_urdf_map_t *map, const wh_layout_t *layout, const wh_real_t axes[],
                     wh_real_t sources[], wh_real_t stretched[]);

/* True if the links of each arm that folds reach. Other configurations are not checked; stretched links reach
 * up to rounding. */
bool wh_urdf_is_reached(const wh_urdf_map_t *map, const wh_real_t stretched[]);

/* A value of a joint, and the axes there. */
typedef struct {
    wh_real_t value;
    wh_real_t axes[WH_AXES];
} wh_urdf_extreme_t;

/* By link, the least and the largest value of its joint that are known. */
typedef struct {
    bool is_known;
    wh_urdf_extreme_t of[WH_URDF_LINKS][2];
} wh_urdf_extremes_t;

/* Takes the limited joints' values at a place that the links reach. */
void wh_urdf_note_extremes(const wh_urdf_map_t *map, const wh_real_t axes[], const wh_real_t sources[],
                           wh_urdf_extremes_t *extremes);

/* Goes on from the extremes that are known, and writes the first joint that gets beyond a limit, by more than
 * 1e-6 mm or rad, with its farthest place; `beyond` stays -1 if none does. */
void wh_urdf_check_limits(const wh_urdf_map_t *map, const wh_layout_t *layout, wh_urdf_extremes_t *extremes,
                          wh_urdf_findings_t *findings);

#endif
