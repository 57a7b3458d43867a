/* Sums and products without rounding error, rounding to whole numbers, and bits; internal to the room.
 *
 * A value is kept as hi + lo: hi is the rounded result and lo the rounding error. Sources: Knuth's two-sum
 * and Dekker's product with Veltkamp's split, which need round-to-nearest and no fused multiply-add. It is
 * exact unless something overflows or underflows: operands of a product stay below 1e300 (1e34 in float).
 */
#ifndef WH_MATH_EXACT_INTERNAL_H
#define WH_MATH_EXACT_INTERNAL_H

#include <string.h>

#include "config.h"

typedef struct {
    wh_real_t hi, lo;
} wh_exact_t;

/* 2^27 + 1 and 2^12 + 1: they split a significand into two halves. */
#if defined(WH_FLOAT)
#define WH_EXACT_SPLIT 4097.0F
#else
#define WH_EXACT_SPLIT 134217729.0
#endif

/* A number's bits, which tell zeros apart by their sign. */
#if defined(WH_FLOAT)
typedef uint32_t wh_bits_t;
#else
typedef uint64_t wh_bits_t;
#endif

static inline wh_bits_t wh_bits(wh_real_t x) {
    wh_bits_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* a + b; six sums, any order of magnitudes. */
static inline wh_exact_t wh_exact_sum(wh_real_t a, wh_real_t b) {
    wh_exact_t sum;
    sum.hi = a + b;
    const wh_real_t b_seen = sum.hi - a;
    sum.lo = (a - (sum.hi - b_seen)) + (b - b_seen);
    return sum;
}

/* a * b; 17 operations. */
static inline wh_exact_t wh_exact_product(wh_real_t a, wh_real_t b) {
    wh_exact_t product;
    const wh_real_t a_scaled = WH_EXACT_SPLIT * a;
    const wh_real_t b_scaled = WH_EXACT_SPLIT * b;
    const wh_real_t a_high = a_scaled - (a_scaled - a);
    const wh_real_t b_high = b_scaled - (b_scaled - b);
    const wh_real_t a_low = a - a_high;
    const wh_real_t b_low = b - b_high;
    product.hi = a * b;
    product.lo = ((a_high * b_high - product.hi) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return product;
}

/* The nearest whole number, halves away from zero, for |x| < 2^31, like libm's round. */
static inline int32_t wh_nearest_whole(wh_real_t x) {
    return (int32_t)(x < 0 ? x - WH_REAL(0.5) : x + WH_REAL(0.5));
}

#endif
