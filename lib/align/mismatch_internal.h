/* The common deviation from which measurements contradict each other; internal to the room. */
#ifndef WH_ALIGN_MISMATCH_INTERNAL_H
#define WH_ALIGN_MISMATCH_INTERNAL_H

#include <math.h>

/* A limit that the sum of `spare` squares of normal deviates, 1 or more, exceeds once in a million: Wilson
 * and Hilferty's form at 4.5 deviations. */
static inline double wh_mismatch_limit(double spare) {
    const double part = 2 / (9 * spare);
    const double root = 1 - part + 4.5 * sqrt(part);
    return spare * root * root * root;
}

#endif
