/* The common checks of lines and their slowing, for every kind of arm; internal to the room. */
#ifndef WH_MOTION_LINE_INTERNAL_H
#define WH_MOTION_LINE_INTERNAL_H

#include "line.h"

/* A factor in time this close to 1 comes from rounding, not from a limit. */
#if defined(WH_FLOAT)
#define WH_LINE_UNSLOWED 1.00001F
#else
#define WH_LINE_UNSLOWED 1.0000000001
#endif

static inline wh_status_t wh_line_check_caps(const wh_line_caps_t *caps) {
    if (!wh_real_is_finite(caps->speed) || !wh_real_is_finite(caps->acceleration)) {
        return WH_STATUS_NOT_FINITE;
    }
    return caps->speed < 0 || caps->acceleration < 0 ? WH_STATUS_OUT_OF_RANGE : WH_OK;
}

/* Slows the whole line by a factor in time that its axes require. */
static inline wh_status_t wh_line_slow_down(wh_line_t *line, wh_real_t factor) {
    if (factor <= WH_LINE_UNSLOWED) {
        line->slowed = 1;
        return WH_OK;
    }
    line->slowed = factor;
    const wh_status_t status = wh_profile_stretch(&line->path, factor * wh_profile_duration(&line->path));
    return status == WH_OK ? WH_OK : WH_STATUS_BAD_LIMITS;
}

#endif
