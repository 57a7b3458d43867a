#include "deviate.h"

#include <math.h>
#include <string.h>

#include "philox.h"
#include "trig.h"

/* ln 2 in two parts; the first has so few bits that its products with exponents are exact. */
#define LN2_HIGH 0.69314718036912381649017333984375
#define LN2_LOW 1.9082149292705877e-10
#define SQRT_HALF 0.70710678118654752440

/* x = m 2^e with m from sqrt(1/2) to sqrt(2); ln m = 2 (s + s^3/3 + s^5/5 + ...) with s = (m - 1) / (m + 1),
 * |s| < 0.1716. */
double wh_ln(double x) {
    uint64_t bits;
    /* For an infinite x, x - x is NaN. */
    if (!(x >= 2.2250738585072014e-308) || x - x != 0) {
        return (double)NAN;
    }
    memcpy(&bits, &x, sizeof bits);
    int exponent = (int)(bits >> 52) - 1022;
    bits = (bits & UINT64_C(0x000FFFFFFFFFFFFF)) | UINT64_C(0x3FE0000000000000);
    double m;
    memcpy(&m, &bits, sizeof m);
    if (m < SQRT_HALF) {
        m *= 2;
        --exponent;
    }
    const double s = (m - 1) / (m + 1);
    const double square = s * s;
    double sum = 0;
    for (int power = 25; power >= 3; power -= 2) {
        sum = (sum + 1.0 / power) * square;
    }
    return exponent * LN2_HIGH + (2 * s + (2 * s * sum + exponent * LN2_LOW));
}

static wh_philox_t draw(const wh_trial_t *trial, uint32_t field, uint32_t index) {
    const uint32_t counter[4] = {field, index, (uint32_t)trial->trial, (uint32_t)(trial->trial >> 32)};
    const uint32_t key[2] = {(uint32_t)trial->seed, (uint32_t)(trial->seed >> 32)};
    return wh_philox(counter, key);
}

/* (2 k + 1) / 2^53 is exact. The 53 bits are put together from two halves, because a 32-bit machine does
 * not convert 64-bit integers. */
static double fraction(uint32_t high, uint32_t low) {
    const uint64_t k = ((uint64_t)high << 32 | low) >> 12;
    const double top = (double)(uint32_t)((2 * k + 1) >> 32);
    return (top * 4294967296.0 + (double)(uint32_t)(2 * k + 1)) * (1.0 / 9007199254740992.0);
}

double wh_deviate_uniform(const wh_trial_t *trial, uint32_t field, uint32_t index) {
    const wh_philox_t bits = draw(trial, field, index);
    return fraction(bits.words[0], bits.words[1]);
}

double wh_deviate_normal(const wh_trial_t *trial, uint32_t field, uint32_t index) {
    const wh_philox_t bits = draw(trial, field, index);
    const double radius = sqrt(-2 * wh_ln(fraction(bits.words[0], bits.words[1])));
    return radius * (double)wh_cos(2 * WH_PI * (wh_real_t)fraction(bits.words[2], bits.words[3]));
}
