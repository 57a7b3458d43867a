/* Jerk-limited profiles in closed form move one axis from rest to rest in the shortest time.
 *
 * A profile has seven phases: jerk, constant acceleration, jerk back, cruise, and the first three mirrored.
 * Distance and limits decide which of them vanish. With v, a, j for the limits of speed, acceleration and
 * jerk, and d = |distance|:
 *
 *     jerk time  tj = a/j        if v/a >= a/j, else sqrt(v/j) and the acceleration limit is never reached;
 *     rise       T  = tj + v/a,  or 2 tj; cruise if d >= v T: duration T + d/v;
 *     no cruise  T  = (tj + sqrt(tj^2 + 4 d/a)) / 2   if d >= 2 a tj^2,
 *                T  = 2 tj, tj = cbrt(d / (2 j))      else; duration 2 T.
 *
 * This is the symmetric S-curve of the textbooks, for instance L. Biagiotti and C. Melchiorri, Trajectory
 * Planning for Automatic Machines and Robots, 2008, section 3.4, for zero speeds and accelerations at both
 * ends.
 *
 * Units: that of the distance (mm or rad), and seconds. A profile is a plain struct without pointers: copy
 * it freely. No function keeps a reference to an argument. All functions are reentrant.
 */
#ifndef WH_MOTION_PROFILE_H
#define WH_MOTION_PROFILE_H

#include "../math/status.h"
#include "../math/vector.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(profile);

/* The limits of an axis, as magnitudes: mm/s, mm/s^2, mm/s^3 or rad/s, rad/s^2, rad/s^3. */
typedef struct {
    wh_real_t speed, acceleration, jerk;
} wh_limits_t;

/* The state of an axis at an instant, relative to the start; all signed. */
typedef struct {
    wh_real_t position, speed, acceleration, jerk;
} wh_motion_t;

/* A planned profile. Only wh_profile_plan and wh_profile_stretch write it; callers may read its fields. */
typedef struct {
    wh_real_t distance;     /* signed */
    wh_real_t duration;     /* s; 0 for no distance */
    wh_real_t jerk_end;     /* s: end of the first phase */
    wh_real_t hold_end;     /* s: end of constant acceleration */
    wh_real_t rise_end;     /* s: peak speed reached */
    wh_real_t jerk;         /* signed, of the first phase */
    wh_real_t acceleration; /* signed, of the second phase */
    wh_real_t speed;        /* signed, of the cruise: the peak */
    wh_real_t jerk_speed;   /* at jerk_end */
    wh_real_t jerk_position;
    wh_real_t rise_position; /* at rise_end */
} wh_profile_t;

/* A smaller distance counts as none: its duration is 0 and the end is reached at once. */
#if defined(WH_FLOAT)
#define WH_PROFILE_TINY 1e-25F
#else
#define WH_PROFILE_TINY 1e-150
#endif

/* WH_STATUS_BAD_LIMITS unless all three are finite and > 0. */
wh_status_t wh_limits_validate(const wh_limits_t *limits) WH_SYMBOL(wh_limits_validate);

/* Plans the fastest profile over `distance` (signed, finite) within the limits. The duration is the
 * analytic optimum to a relative 1e-14 (1e-5 in float); no limit is exceeded by more than a relative 1e-14
 * (1e-5). Errors, which leave *profile unchanged: WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE (distance),
 * WH_STATUS_BAD_LIMITS (also if the limits are so extreme that a time or the jerk cannot be represented).
 * Cost: about 20 ns, 40 if only the jerk is limiting. */
wh_status_t wh_profile_plan(wh_profile_t *profile, wh_real_t distance, const wh_limits_t *limits)
    WH_SYMBOL(wh_profile_plan);

/* s, never negative. */
static inline wh_real_t wh_profile_duration(const wh_profile_t *profile) {
    return profile->duration;
}

/* Slows the whole profile uniformly to `duration` (s), which is then exactly its duration. A factor k in
 * time divides speeds by k, accelerations by k^2, jerks by k^3. Without distance the profile only waits.
 * Errors, which leave *profile unchanged: WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE,
 * WH_STATUS_OUT_OF_RANGE if `duration` is shorter than the profile's, or so long that the factor cannot be
 * represented. Cost: 10 to 25 ns. */
wh_status_t wh_profile_stretch(wh_profile_t *profile, wh_real_t duration) WH_SYMBOL(wh_profile_stretch);

/* The state at `t` seconds after the start. For t <= 0 (and NaN) all is zero; from the duration on the axis
 * rests at exactly `distance`. A profile of duration 0 is at its end from t = 0 on. Where two phases meet,
 * their values agree to rounding: a few 1e-16 of the distance, the peak speed and so on. No pointer may be
 * null. Cost: about 10 ns. */
void wh_profile_at(const wh_profile_t *profile, wh_real_t t, wh_motion_t *motion) WH_SYMBOL(wh_profile_at);

/* The position alone, with equal bits. Cost: about 5 ns. */
wh_real_t wh_profile_position(const wh_profile_t *profile, wh_real_t t) WH_SYMBOL(wh_profile_position);

/* The largest magnitudes over the whole profile, analytically. */
static inline wh_real_t wh_profile_peak_speed(const wh_profile_t *profile) {
    return profile->speed < 0 ? -profile->speed : profile->speed;
}

static inline wh_real_t wh_profile_peak_acceleration(const wh_profile_t *profile) {
    return profile->acceleration < 0 ? -profile->acceleration : profile->acceleration;
}

static inline wh_real_t wh_profile_peak_jerk(const wh_profile_t *profile) {
    return profile->jerk < 0 ? -profile->jerk : profile->jerk;
}

WH_HEADER_END

#endif
