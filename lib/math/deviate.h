/* Random numbers of a study: named by seed, trial, field and index, with the same bits on every machine.
 *
 * A number depends on its own name only, never on which others are drawn or in what order. One block of
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

/* The natural logarithm of x > 0, finite and normal: error below 1e-15 of its value or 1e-17, whichever is
 * more. Only + - * /, so that libm has no say. NaN for anything else. Cost: about 15 ns. */
double wh_ln(double x) WH_SYMBOL(wh_ln);

/* Uniform in (0, 1): odd multiples of 2^-53, so never an end. */
double wh_deviate_uniform(const wh_trial_t *trial, uint32_t field, uint32_t index)
    WH_SYMBOL(wh_deviate_uniform);

/* Of mean 0 and standard deviation 1, by Box and Muller's transform sqrt(-2 ln u) cos(2 pi v), which is
 * exact: no tail is cut but that u >= 2^-53 bounds it by 8.58. Cost: about 70 ns. */
double wh_deviate_normal(const wh_trial_t *trial, uint32_t field, uint32_t index)
    WH_SYMBOL(wh_deviate_normal);

WH_HEADER_END

#endif
