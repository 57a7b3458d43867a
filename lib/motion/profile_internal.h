/* Shared by profile.c and move.c: plans a profile again, slower. move.c is a separate file so that a
 * firmware that plans single axes does not link it. */
#ifndef WH_MOTION_PROFILE_INTERNAL_H
#define WH_MOTION_PROFILE_INTERNAL_H

#include "profile.h"

/* The three times that fix a profile's shape. */
typedef struct {
    wh_real_t jerk, rise, duration;
} wh_profile_times_t;

static inline wh_profile_times_t wh_profile_times(const wh_profile_t *profile) {
    const wh_profile_times_t times = {profile->jerk_end, profile->rise_end, profile->duration};
    return times;
}

/* The profile over `distance` with these times, stretched to `duration`. It has the bits of wh_profile_plan
 * and then wh_profile_stretch, if neither refuses. */
void wh_profile_shape(wh_profile_t *profile, wh_real_t distance, const wh_profile_times_t *times,
                      wh_real_t duration) WH_SYMBOL(wh_profile_shape);

#endif
