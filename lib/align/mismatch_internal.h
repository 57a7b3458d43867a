/* How far measurements may be off together before they contradict each other: within the room. */
#ifndef WH_ALIGN_MISMATCH_INTERNAL_H
#define WH_ALIGN_MISMATCH_INTERNAL_H

#include <math.h>

/* Deviations for what is not to happen by chance: three in a million. */
#define WH_MISMATCH_NEVER 4.5

/* The sum of `spare` squares of normal deviates, 1 or more, that is exceeded as seldom as one deviate exceeds
 * `deviations`, by Wilson and Hilferty's form. */
static inline double wh_mismatch_limit(double spare, double deviations) {
    const double part = 2 / (9 * spare);
    const double root = 1 - part + deviations * sqrt(part);
    return spare * root * root * root;
}

#endif
