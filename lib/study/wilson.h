/* How sure a rate is. */
#ifndef WH_STUDY_WILSON_H
#define WH_STUDY_WILSON_H

#include <stdint.h>

typedef struct {
    double rate;      /* hits / trials; 0 without trials */
    double low, high; /* 0 <= low <= rate <= high <= 1 */
} wh_confidence_t;

/* Wilson's score interval at 95 % (z = 1.959964): the rates p from which the one found is at most z standard
 * deviations sqrt(p (1 - p) / trials) away (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209). It holds for
 * few trials and for rates at 0 or 1, where it has a width. Without trials: 0 to 1. `hits` is at most
 * `trials`, that at most 2^53. */
wh_confidence_t wh_wilson_interval(uint64_t hits, uint64_t trials);

#endif
