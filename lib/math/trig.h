/* Sine, cosine, arc tangent and cube root with equal bits on every machine, and rotations made from them.
 *
 * The C library's sin and atan2 differ between machines, and on one machine they differ with its
 * instruction set. These functions use only + - * / in round-to-nearest. All are pure functions of their
 * arguments: no state, no loop of unknown length. The polynomials are minimax fits made for this library.
 * Errors are in units in the last place of the result (ulp), double first, float in brackets. They were
 * measured on four million seeded arguments against long double, on the double neighbours of every multiple
 * of pi/2 in range against 75 digits, and on every float in range against double. Costs here and in
 * lib/motion's other headers are for double on a server's x86-64, gcc -O2.
 */
#ifndef WH_MATH_TRIG_H
#define WH_MATH_TRIG_H

#include "vector.h"

WH_HEADER_BEGIN

/* pi, rounded once to the number type. */
#define WH_PI WH_REAL(3.14159265358979323846264338327950288)

/* The largest |x| (rad) that wh_sin and wh_cos reduce, and the largest |deg| of wh_sin_cos_deg. */
#define WH_TRIG_MAX_RAD WH_REAL(1e5)
#define WH_TRIG_MAX_DEG WH_REAL(5e6)

/* sin x and cos x, x in rad. For |x| <= WH_TRIG_MAX_RAD the error is below 0.80 ulp (0.85); beyond, and for
 * NaN or an infinite x, the result is NaN. wh_sin(-0.0) is -0.0. Cost: about 14 ns. */
wh_real_t wh_sin(wh_real_t x) WH_SYMBOL(wh_sin);
wh_real_t wh_cos(wh_real_t x) WH_SYMBOL(wh_cos);

/* Both at once, with the bits of wh_sin and wh_cos. Neither pointer may be null. Cost: about 20 ns. */
void wh_sin_cos(wh_real_t x, wh_real_t *sine, wh_real_t *cosine) WH_SYMBOL(wh_sin_cos);

/* Both of an angle in degrees, with exact reduction. Multiples of 90 give exactly 0 (never -0), 1 or -1,
 * and x and x + 360 n give equal bits wherever x + 360 n is exact. For |deg| <= WH_TRIG_MAX_DEG the error
 * is below 0.80 ulp (0.85); beyond, and for NaN, both are NaN. Neither pointer may be null. Cost: about 20
 * ns. */
void wh_sin_cos_deg(wh_real_t deg, wh_real_t *sine, wh_real_t *cosine) WH_SYMBOL(wh_sin_cos_deg);

/* The angle of the point (x, y) in [-pi, pi] rad, with quadrants as in C99's annex F: the sign is that of y
 * (also of a zero), atan2(0, -1) = pi, atan2(-0.0, -1) = -pi, atan2(0, 0) = 0, infinities included. Both
 * have one unit, which does not matter. The result is at most pi rounded to the number type. It is NaN if
 * either is NaN. The error is below 0.58 ulp (0.59). Cost: about 15 ns. */
wh_real_t wh_atan2(wh_real_t y, wh_real_t x) WH_SYMBOL(wh_atan2);

/* The angle in [0, pi] rad with this cosine, by wh_atan2; 0 or pi beyond 1 or -1, NaN for NaN. Near 1 and
 * -1 a cosine gives the angle only to about 1e-8. Cost: about 25 ns. */
wh_real_t wh_acos(wh_real_t cosine) WH_SYMBOL(wh_acos);

/* The real cube root, sign and signed zero kept; infinite and NaN pass through. Cubes of whole numbers give
 * the whole number. The error is below 0.51 ulp. Cost: about 16 ns, 40 far from 1. */
wh_real_t wh_cbrt(wh_real_t x) WH_SYMBOL(wh_cbrt);

/* Converts degrees to radians and back; the error is below 0.51 ulp: 180 gives WH_PI. It is valid for
 * |deg|, |rad| <= 1e30; beyond, the result may be NaN. Cost: about 2 ns. */
wh_real_t wh_rad_from_deg(wh_real_t deg) WH_SYMBOL(wh_rad_from_deg);
wh_real_t wh_deg_from_rad(wh_real_t rad) WH_SYMBOL(wh_deg_from_rad);

/* The rotation by `angle` rad about z, counter-clockwise seen from +z. Entries are NaN where wh_sin is. */
wh_mat3_t wh_mat3_about_z(wh_real_t angle) WH_SYMBOL(wh_mat3_about_z);

/* The rotation from sin and cos of the angle. */
static inline wh_mat3_t wh_mat3_turn_z(wh_real_t sine, wh_real_t cosine) {
    const wh_mat3_t R = {{{cosine, 0 - sine, 0}, {sine, cosine, 0}, {0, 0, 1}}};
    return R;
}

/* R = Rz(yaw) * Ry(pitch) * Rx(roll), in degrees about base's fixed axes: a layout's `rpy`. Multiples of 90
 * give exact entries. Entries are NaN where wh_sin_cos_deg is. */
wh_mat3_t wh_mat3_from_rpy_deg(wh_real_t roll, wh_real_t pitch, wh_real_t yaw)
    WH_SYMBOL(wh_mat3_from_rpy_deg);

WH_HEADER_END

#endif
