/* Doors: walls that an axis of a machine moves, such as a load lock's.
 *
 * A door's axis is 0 while it is shut and `travel` (mm) while it is open. In between the wall moves
 * straight, and does not turn. A door is a description: it does not change after it is filled in.
 */
#ifndef WH_MOTION_DOOR_H
#define WH_MOTION_DOOR_H

#include <stdbool.h>

#include "../math/pose.h"
#include "profile.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(door);

/* The most doors of a machine: all axes that its robot leaves, or 8 where there are few axes (math/config.h).
 * A machine with at most 8 has equal bits, equal hashes and equal snapshots with both. */
#if WH_AXES > 12
#define WH_DOORS (WH_AXES - 4)
#else
#define WH_DOORS 8
#endif

typedef struct {
    wh_vec3_t way;    /* base, of length 1: the direction in which the door opens */
    wh_real_t travel; /* from shut to open, mm, above 0 */
    bool is_open;     /* at home */
    wh_limits_t limits;
} wh_door_t;

/* base_from_door with its axis at `at`: the identity while it is shut. */
static inline wh_pose_t wh_door_pose(const wh_door_t *door, wh_real_t at) {
    wh_pose_t pose = wh_pose_identity();
    pose.r = wh_vec3_scale(at, &door->way);
    return pose;
}

/* The position of its axis at home. */
static inline wh_real_t wh_door_home(const wh_door_t *door) {
    return door->is_open ? door->travel : 0;
}

/* Returns WH_OK, WH_STATUS_NOT_FINITE, WH_STATUS_BAD_LIMITS for a way whose length is not 1 or no travel,
 * or the status of wh_limits_validate. `door` must not be null. */
wh_status_t wh_door_validate(const wh_door_t *door) WH_SYMBOL(wh_door_validate);

WH_HEADER_END

#endif
