/* Within the core: the measurement without its checks, for poses that have passed them. */
#ifndef WH_GRASP_PROXIMITY_INTERNAL_H
#define WH_GRASP_PROXIMITY_INTERNAL_H

#include "proximity.h"

void wh_proximity_values(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                         const wh_tolerance_t *tolerance, wh_proximity_t *result);

#endif
