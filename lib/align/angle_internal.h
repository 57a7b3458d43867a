/* Angles in double, even if the library's own numbers are floats; internal to the room. On a rim of 150 mm
 * a float's sine has an error of 10 um. */
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

/* The nearest whole number, for |x| below 1e15. */
static inline double wh_align_nearest(double x) {
    return (double)(int64_t)(x < 0 ? x - 0.5 : x + 0.5);
}

/* Converts a direction to -pi to pi. */
static inline double wh_align_wrap(double angle) {
    if (angle > -WH_ALIGN_PI && angle <= WH_ALIGN_PI) {
        return angle;
    }
    return angle - WH_ALIGN_TURN * wh_align_nearest(angle / WH_ALIGN_TURN);
}

#if defined(WH_FLOAT)
/* Series up to x^15 and x^16, for angles below pi / 4; exact to 1e-15. */
static inline void wh_align_sin_cos(double angle, double *sine, double *cosine) {
    const double wrapped = wh_align_wrap(angle);
    const double quarter = wh_align_nearest(wrapped * (2 / WH_ALIGN_PI));
    const double x = wrapped - quarter * (WH_ALIGN_PI / 2);
    const double xx = x * x;
    double s = 1;
    double c = 1;
    for (int k = 15; k > 1; k -= 2) {
        s = 1 - s * xx / (k * (k - 1));
        c = 1 - c * xx / ((k + 1) * k);
    }
    s *= x;
    c = 1 - c * xx / 2;
    const int64_t turned = (int64_t)quarter & 3;
    *sine = turned == 0 ? s : turned == 1 ? c : turned == 2 ? -s : -c;
    *cosine = turned == 0 ? c : turned == 1 ? -s : turned == 2 ? -c : s;
}

/* A float's result, and the rest of the angle. */
static inline double wh_align_atan2(double y, double x) {
    const double angle = (double)wh_atan2((wh_real_t)y, (wh_real_t)x);
    double s;
    double c;
    wh_align_sin_cos(angle, &s, &c);
    const double along = x * c + y * s;
    return along > 0 ? angle + (y * c - x * s) / along : angle;
}
#else
static inline void wh_align_sin_cos(double angle, double *sine, double *cosine) {
    wh_sin_cos(wh_align_wrap(angle), sine, cosine);
}

static inline double wh_align_atan2(double y, double x) {
    return wh_atan2(y, x);
}
#endif

/* Turns the point (x, y) about the origin. */
static inline void wh_align_turn(double angle, double *x, double *y) {
    const double before_x = *x;
    const double before_y = *y;
    double s;
    double c;
    wh_align_sin_cos(angle, &s, &c);
    *x = before_x * c - before_y * s;
    *y = before_y * c + before_x * s;
}

#endif
