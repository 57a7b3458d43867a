/* A robot's axes as ways use them (motion/way.h, motion/via.h): theta, R or a SCARA's elbow, Z, yaw, and a
 * carrier's other axes, in its order. */
#ifndef WH_MOTION_POLAR_H
#define WH_MOTION_POLAR_H

#include "carrier.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(polar);

/* The most arms of a robot. */
#define WH_POLAR_ARMS 2

typedef struct {
    size_t axis_count; /* WH_ROBOT_AXES to WH_CARRIER_AXES */
    wh_limits_t limits[WH_CARRIER_AXES];
    size_t rail;                    /* the rail's axis; 0: there is none */
    size_t second;                  /* the R of a second arm; 0: there is none */
    wh_real_t inner[WH_POLAR_ARMS]; /* the begin of the travel of each arm's R, mm; unused for a SCARA */
    wh_real_t links[2];             /* SCARA: its links, mm; polar arm: 0 */
} wh_polar_t;

/* False if a count, an axis or a link is out of range. Limits are checked where a motion is planned. */
static inline bool wh_polar_is_sound(const wh_polar_t *robot) {
    return robot->axis_count >= WH_ROBOT_AXES && robot->axis_count <= WH_CARRIER_AXES &&
           robot->rail < robot->axis_count && robot->second < robot->axis_count &&
           (robot->links[0] > 0) == (robot->links[1] > 0);
}

/* A robot of motion/robot.h. */
static inline wh_polar_t wh_polar_from_robot(const wh_robot_t *robot) {
    wh_polar_t polar;
    polar.axis_count = WH_ROBOT_AXES;
    polar.rail = 0;
    polar.second = 0;
    polar.inner[0] = robot->travel[WH_AXIS_R].min;
    polar.inner[1] = robot->travel[WH_AXIS_R].min;
    polar.links[0] = 0;
    polar.links[1] = 0;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        polar.limits[axis] = robot->limits[axis];
    }
    return polar;
}

WH_HEADER_END

#endif
