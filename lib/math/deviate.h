/* Random numbers of a study, named by seed, trial, field and index, with equal bits on every machine.
 *
 * A number depends only on its own name, never on which others are drawn or in what order. One block of
 * Philox4x32-10 makes it: key (seed low, seed high), counter (field, index, trial low, trial high).
 */
#ifndef WH_MATH_DEVIATE_H
#define WH_MATH_DEVIATE_H

#include "config.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(deviate);

typedef struct {
    uint64_t seed, trial;
} wh_trial_t;

/* The natural logarithm of x > 0, finite and normal; the error is below 1e-15 of its value or 1e-17,
 * whichever is larger. It uses only + - * /, so libm has no influence. It is NaN for anything else. Cost:
 * about 15 ns. */
double wh_ln(double x) WH_SYMBOL(wh_ln);

/* Uniform in (0, 1): odd multiples of 2^-53, so never 0 or 1. */
double wh_deviate_uniform(const wh_trial_t *trial, uint32_t field, uint32_t index)
    WH_SYMBOL(wh_deviate_uniform);

/* Normal with mean 0 and standard deviation 1, by Box and Muller's transform sqrt(-2 ln u) cos(2 pi v),
 * which is exact. No tail is cut, except that u >= 2^-53 bounds the magnitude by 8.58. Cost: about 70
 * ns. */
double wh_deviate_normal(const wh_trial_t *trial, uint32_t field, uint32_t index)
    WH_SYMBOL(wh_deviate_normal);

WH_HEADER_END

#endif
