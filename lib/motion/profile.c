#include "../math/trig.h"
#include "profile_internal.h"

static bool is_positive(wh_real_t x) {
    return x > 0 && wh_real_is_finite(x);
}

wh_status_t wh_limits_validate(const wh_limits_t *limits) {
    if (limits == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const bool sound =
        is_positive(limits->speed) && is_positive(limits->acceleration) && is_positive(limits->jerk);
    return sound ? WH_OK : WH_STATUS_BAD_LIMITS;
}

/* The shortest times without cruise: with constant acceleration if there is room for it, otherwise with
 * jerk only. */
static wh_profile_times_t shortest_without_cruise(wh_real_t d, const wh_limits_t *limits) {
    wh_profile_times_t times;
    const wh_real_t full = limits->acceleration / limits->jerk;
    if (d >= 2 * limits->acceleration * full * full) {
        times.jerk = full;
        times.rise = (full + wh_real_sqrt(full * full + 4 * (d / limits->acceleration))) / 2;
    } else {
        times.jerk = wh_cbrt(d / (2 * limits->jerk));
        times.rise = 2 * times.jerk;
    }
    times.duration = 2 * times.rise;
    return times;
}

static wh_profile_times_t shortest(wh_real_t d, const wh_limits_t *limits) {
    wh_profile_times_t times;
    const wh_real_t full = limits->acceleration / limits->jerk;
    const wh_real_t ramp = limits->speed / limits->acceleration;
    if (ramp >= full) {
        times.jerk = full;
        times.rise = full + ramp;
    } else {
        times.jerk = wh_real_sqrt(limits->speed / limits->jerk);
        times.rise = 2 * times.jerk;
    }
    const wh_real_t pass = d / limits->speed;
    if (pass < times.rise) {
        return shortest_without_cruise(d, limits);
    }
    times.duration = times.rise + pass;
    return times;
}

/* True if no phase was lost to overflow or underflow, so that from_times can divide: the rise is at least two
 * jerk times, the duration two rises. */
static bool times_are_sound(const wh_profile_times_t *times) {
    return is_positive(times->jerk) && wh_real_is_finite(times->duration);
}

/* Everything follows from the distance and the three times. Jerk, acceleration and speed are computed from
 * them, so that the phases add up to the distance. */
static wh_profile_t from_times(wh_real_t distance, const wh_profile_times_t *times) {
    wh_profile_t p;
    p.distance = distance;
    p.duration = times->duration;
    p.jerk_end = times->jerk;
    p.hold_end = times->rise - times->jerk;
    p.rise_end = times->rise;
    p.speed = distance / (times->duration - times->rise);
    p.acceleration = p.speed / p.hold_end;
    p.jerk = p.acceleration / p.jerk_end;
    p.jerk_speed = p.acceleration * p.jerk_end / 2;
    p.jerk_position = p.jerk_speed * p.jerk_end / 3;
    p.rise_position = p.speed * p.rise_end / 2;
    return p;
}

static wh_profile_t at_once(wh_real_t distance, wh_real_t duration) {
    const wh_profile_t p = {.distance = distance, .duration = duration};
    return p;
}

static bool is_tiny(wh_real_t distance) {
    return wh_real_abs(distance) < WH_PROFILE_TINY;
}

wh_status_t wh_profile_plan(wh_profile_t *profile, wh_real_t distance, const wh_limits_t *limits) {
    if (profile == NULL || limits == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_real_is_finite(distance)) {
        return WH_STATUS_NOT_FINITE;
    }
    if (wh_limits_validate(limits) != WH_OK) {
        return WH_STATUS_BAD_LIMITS;
    }
    if (is_tiny(distance)) {
        *profile = at_once(distance, 0);
        return WH_OK;
    }
    const wh_profile_times_t times = shortest(wh_real_abs(distance), limits);
    if (!times_are_sound(&times)) {
        return WH_STATUS_BAD_LIMITS;
    }
    const wh_profile_t planned = from_times(distance, &times);
    if (!is_positive(wh_real_abs(planned.jerk))) {
        return WH_STATUS_BAD_LIMITS;
    }
    *profile = planned;
    return WH_OK;
}

/* If the times already have that duration, the factor is 1 and they keep every bit. */
static wh_profile_times_t slowed(const wh_profile_times_t *times, wh_real_t duration) {
    const wh_real_t slower = duration / times->duration;
    const wh_profile_times_t stretched = {times->jerk * slower, times->rise * slower, duration};
    return stretched;
}

void wh_profile_shape(wh_profile_t *profile, wh_real_t distance, const wh_profile_times_t *times,
                      wh_real_t duration) {
    if (is_tiny(distance)) {
        *profile = at_once(distance, duration);
    } else {
        const wh_profile_times_t stretched = slowed(times, duration);
        *profile = from_times(distance, &stretched);
    }
}

wh_status_t wh_profile_stretch(wh_profile_t *profile, wh_real_t duration) {
    if (profile == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_real_is_finite(duration)) {
        return WH_STATUS_NOT_FINITE;
    }
    if (is_tiny(profile->distance) && duration >= profile->duration) {
        profile->duration = duration;
    }
    if (duration == profile->duration) {
        return WH_OK;
    }
    if (duration < profile->duration) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_profile_times_t own = wh_profile_times(profile);
    const wh_profile_times_t times = slowed(&own, duration);
    if (!times_are_sound(&times)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    *profile = from_times(profile->distance, &times);
    return WH_OK;
}

/* The first half of the profile, 0 < s <= duration/2, up to the middle of the cruise. */
static inline wh_motion_t first_half(const wh_profile_t *p, wh_real_t s) {
    wh_motion_t m;
    if (s < p->jerk_end) {
        m.jerk = p->jerk;
        m.acceleration = p->jerk * s;
        m.speed = m.acceleration * s * WH_REAL(0.5);
        m.position = m.acceleration * s * s * WH_REAL(1.0 / 6);
    } else if (s < p->hold_end) {
        const wh_real_t u = s - p->jerk_end;
        m.jerk = 0;
        m.acceleration = p->acceleration;
        m.speed = p->jerk_speed + p->acceleration * u;
        m.position = p->jerk_position + (p->jerk_speed + p->acceleration * u * WH_REAL(0.5)) * u;
    } else if (s < p->rise_end) {
        const wh_real_t u = p->rise_end - s;
        m.jerk = -p->jerk;
        m.acceleration = p->jerk * u;
        m.speed = p->speed - m.acceleration * u * WH_REAL(0.5);
        m.position = p->rise_position - (p->speed - m.acceleration * u * WH_REAL(1.0 / 6)) * u;
    } else {
        m.jerk = 0;
        m.acceleration = 0;
        m.speed = p->speed;
        m.position = p->rise_position + p->speed * (s - p->rise_end);
    }
    return m;
}

void wh_profile_at(const wh_profile_t *profile, wh_real_t t, wh_motion_t *motion) {
    const wh_motion_t rest = {0, 0, 0, 0};
    if (t >= profile->duration) {
        *motion = rest;
        motion->position = profile->distance;
        return;
    }
    if (!(t > 0)) {
        *motion = rest;
        return;
    }
    const wh_real_t left = profile->duration - t;
    if (t <= left) {
        *motion = first_half(profile, t);
        return;
    }
    /* The second half is the first one in reverse. */
    *motion = first_half(profile, left);
    motion->position = profile->distance - motion->position;
    motion->acceleration = -motion->acceleration;
}

wh_real_t wh_profile_position(const wh_profile_t *profile, wh_real_t t) {
    if (t >= profile->duration) {
        return profile->distance;
    }
    if (!(t > 0)) {
        return 0;
    }
    const wh_real_t left = profile->duration - t;
    return t <= left ? first_half(profile, t).position
                     : profile->distance - first_half(profile, left).position;
}
