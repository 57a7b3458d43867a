/* Angles in double for the room, also where the library's own numbers are floats: within the room.
 *
 * A float's sine is good to 1e-7, which is 1e-6 mm on 10 mm: enough here. The angle itself is brought into
 * one turn in double first. */
#ifndef WH_ALIGN_ANGLE_INTERNAL_H
#define WH_ALIGN_ANGLE_INTERNAL_H

#include <math.h>

#include "../math/trig.h"

#define WH_ALIGN_PI 3.14159265358979323846
#define WH_ALIGN_TURN (2 * WH_ALIGN_PI)

/* Neither NaN nor infinite. */
static inline bool wh_align_is_finite(double x) {
    return x - x == 0;
}

/* The nearest whole number; |x| below 1e15. */
static inline double wh_align_nearest(double x) {
    return (double)(int64_t)(x < 0 ? x - 0.5 : x + 0.5);
}

/* The same direction from -pi to pi. */
static inline double wh_align_wrap(double angle) {
    if (angle > -WH_ALIGN_PI && angle <= WH_ALIGN_PI) {
        return angle;
    }
    return angle - WH_ALIGN_TURN * wh_align_nearest(angle / WH_ALIGN_TURN);
}

static inline void wh_align_sin_cos(double angle, double *sine, double *cosine) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos((wh_real_t)wh_align_wrap(angle), &s, &c);
    *sine = (double)s;
    *cosine = (double)c;
}

static inline double wh_align_atan2(double y, double x) {
    return (double)wh_atan2((wh_real_t)y, (wh_real_t)x);
}

#endif
