#include "trig.h"

#include "exact_internal.h"

/* Minimax polynomials (Remez exchange in 70 digits, then each coefficient rounded) on |x| <= pi/4:
 *   sin x = x + x^3 S(x^2), relative error of sin 2^-56.3 in double, 2^-26.8 in float;
 *   cos x = 1 - x^2/2 + x^4 C(x^2), relative error of cos 2^-59.7 and 2^-32.4.
 * pi/2 is split into parts so short that n * part is exact for |n| < 2^16; the last part is rounded to full
 * length. The remaining error of pi/2 is 7e-39 in double, 3e-20 in float. */
#if defined(WH_FLOAT)
#define TERMS 3
#define PARTS 6
#define TINY 0x1p-13F
static const wh_real_t sin_terms[TERMS] = {-0x1.555546p-3F, 0x1.11073ap-7F, -0x1.9943d4p-13F};
static const wh_real_t cos_terms[TERMS] = {0x1.55554ap-5F, -0x1.6c0c34p-10F, 0x1.99eba8p-16F};
static const wh_real_t half_pi[PARTS] = {0x1.92p+0F,  0x1.ep-12F,  0x1.b4p-16F,
                                         0x1.44p-24F, 0x1.08p-34F, 0x1.a308d4p-41F};
static const wh_exact_t rad_per_deg = {0x1.1df46ap-6F, 0x1.294e9cp-33F};
static const wh_exact_t deg_per_rad = {0x1.ca5dc2p+5F, -0x1.670f82p-21F};
#else
#define TERMS 6
#define PARTS 3
#define TINY 0x1p-27
static const wh_real_t sin_terms[TERMS] = {-0x1.5555555555548p-3,  0x1.111111110f7cfp-7,
                                           -0x1.a01a019bfdc72p-13, 0x1.71de3567b46a7p-19,
                                           -0x1.ae5e5a7b7db99p-26, 0x1.5d8fcbc702065p-33};
static const wh_real_t cos_terms[TERMS] = {0x1.555555555554bp-5,  -0x1.6c16c16c14f92p-10,
                                           0x1.a01a019c84585p-16, -0x1.27e4f7eaca8a3p-22,
                                           0x1.1ee9d7b87f657p-29, -0x1.8fa49bc27d868p-37};
static const wh_real_t half_pi[PARTS] = {0x1.921fb5444p+0, 0x1.68c234c4p-39, 0x1.8cc51701b839ap-72};
static const wh_exact_t rad_per_deg = {0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62};
static const wh_exact_t deg_per_rad = {0x1.ca5dc1a63c1f8p+5, -0x1.1e7ab456405f9p-49};
#endif

#define QUARTERS_PER_RAD WH_REAL(0x1.45f306dc9c883p-1)

/* An angle as n quarter turns and a rest within a hair of [-pi/4, pi/4]. */
typedef struct {
    int32_t quarters;
    wh_exact_t rest;
} reduced_t;

static wh_real_t polynomial(const wh_real_t *terms, wh_real_t z) {
    wh_real_t sum = terms[TERMS - 1];
    for (int term = TERMS - 2; term >= 0; --term) {
        sum = sum * z + terms[term];
    }
    return sum;
}

/* sin(hi + lo) to first order in lo. */
static wh_real_t sin_of(wh_exact_t x) {
    const wh_real_t z = x.hi * x.hi;
    if (wh_real_abs(x.hi) < TINY) {
        return x.hi; /* also keeps the sign of zero */
    }
    return x.hi + (x.hi * z * polynomial(sin_terms, z) + x.lo * (1 - z / 2));
}

/* cos(hi + lo) to first order in lo; the rounding error of 1 - z/2 is added back. */
static wh_real_t cos_of(wh_exact_t x) {
    const wh_real_t z = x.hi * x.hi;
    const wh_real_t about = 1 - z / 2;
    return about + (((1 - about) - z / 2) + (z * z * polynomial(cos_terms, z) - x.hi * x.lo));
}

static reduced_t reduce_rad(wh_real_t x) {
    reduced_t angle = {wh_nearest_whole(x * QUARTERS_PER_RAD), {x, 0}};
    if (angle.quarters != 0) {
        const wh_real_t n = (wh_real_t)angle.quarters;
        wh_real_t lost = 0;
        for (size_t part = 0; part < PARTS; ++part) {
            angle.rest = wh_exact_sum(angle.rest.hi, -n * half_pi[part]);
            lost += angle.rest.lo;
        }
        angle.rest = wh_exact_sum(angle.rest.hi, lost);
    }
    return angle;
}

/* deg - 90 n is exact; its product with pi/180 is kept in two numbers. */
static reduced_t reduce_deg(wh_real_t deg) {
    reduced_t angle;
    angle.quarters = wh_nearest_whole(deg / 90);
    const wh_real_t rest = deg - 90 * (wh_real_t)angle.quarters;
    angle.rest = wh_exact_product(rest, rad_per_deg.hi);
    angle.rest.lo += rest * rad_per_deg.lo;
    return angle;
}

/* The sine, for successive quarters: sin, cos, -sin, -cos of the rest. The cosine is the sine one quarter
 * further. */
static wh_real_t sin_in_quarter(int32_t quarters, wh_exact_t rest) {
    const uint32_t quarter = (uint32_t)quarters & 3U;
    const wh_real_t value = (quarter & 1U) != 0 ? cos_of(rest) : sin_of(rest);
    return (quarter & 2U) != 0 ? -value : value;
}

wh_real_t wh_sin(wh_real_t x) {
    if (!(wh_real_abs(x) <= WH_TRIG_MAX_RAD)) {
        return (wh_real_t)NAN;
    }
    const reduced_t angle = reduce_rad(x);
    return sin_in_quarter(angle.quarters, angle.rest);
}

wh_real_t wh_cos(wh_real_t x) {
    if (!(wh_real_abs(x) <= WH_TRIG_MAX_RAD)) {
        return (wh_real_t)NAN;
    }
    const reduced_t angle = reduce_rad(x);
    return sin_in_quarter(angle.quarters + 1, angle.rest);
}

void wh_sin_cos(wh_real_t x, wh_real_t *sine, wh_real_t *cosine) {
    if (!(wh_real_abs(x) <= WH_TRIG_MAX_RAD)) {
        *sine = *cosine = (wh_real_t)NAN;
        return;
    }
    const reduced_t angle = reduce_rad(x);
    *sine = sin_in_quarter(angle.quarters, angle.rest);
    *cosine = sin_in_quarter(angle.quarters + 1, angle.rest);
}

void wh_sin_cos_deg(wh_real_t deg, wh_real_t *sine, wh_real_t *cosine) {
    if (!(wh_real_abs(deg) <= WH_TRIG_MAX_DEG)) {
        *sine = *cosine = (wh_real_t)NAN;
        return;
    }
    const reduced_t angle = reduce_deg(deg);
    /* + 0 turns -0 into 0. */
    *sine = sin_in_quarter(angle.quarters, angle.rest) + 0;
    *cosine = sin_in_quarter(angle.quarters + 1, angle.rest) + 0;
}

static wh_real_t times(wh_real_t x, wh_exact_t factor) {
    const wh_exact_t product = wh_exact_product(x, factor.hi);
    return product.hi + (product.lo + x * factor.lo);
}

wh_real_t wh_rad_from_deg(wh_real_t deg) {
    return times(deg, rad_per_deg);
}

wh_real_t wh_deg_from_rad(wh_real_t rad) {
    return times(rad, deg_per_rad);
}

wh_mat3_t wh_mat3_about_z(wh_real_t angle) {
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(angle, &s, &c);
    return wh_mat3_turn_z(s, c);
}

wh_mat3_t wh_mat3_from_rpy_deg(wh_real_t roll, wh_real_t pitch, wh_real_t yaw) {
    wh_real_t sx;
    wh_real_t cx;
    wh_real_t sy;
    wh_real_t cy;
    wh_real_t sz;
    wh_real_t cz;
    wh_sin_cos_deg(roll, &sx, &cx);
    wh_sin_cos_deg(pitch, &sy, &cy);
    wh_sin_cos_deg(yaw, &sz, &cz);
    wh_mat3_t R = {{{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx},
                    {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx},
                    {0 - sy, cy * sx, cy * cx}}};
    return R;
}
