/* Statistics of a measured quantity over many trials: mean, standard deviation, extremes, quantiles; and how
 * sure a rate is.
 *
 * Values are kept as whole multiples of 2^-30 (about 1e-9 mm or degrees) in exact integer sums, and counted
 * in bins that are the same for every study. So adding is commutative and associative to the last bit. The
 * result does not depend on which threads and machines shared the trials, or on the order in which their sums
 * came together.
 */
#ifndef WH_STUDY_SUM_H
#define WH_STUDY_SUM_H

#include <stddef.h>
#include <stdint.h>

__extension__ typedef __int128 wh_int128_t;
__extension__ typedef unsigned __int128 wh_uint128_t;

/* Values beyond this limit count as the limit, in units of 2^-30. */
#define WH_SUM_MOST (INT64_C(1) << 43)

/* Per sign one bin for each whole number below 128, then 64 for each doubling up to 2^44. */
#define WH_SUM_SIDE (128 + 37 * 64)
#define WH_SUM_BINS ((size_t)2 * WH_SUM_SIDE)

/* To be zeroed. */
typedef struct {
    uint64_t count;
    wh_int128_t sum;
    wh_uint128_t squares;
    int64_t least, most; /* meaningful when count > 0 */
    uint64_t bins[WH_SUM_BINS];
} wh_sum_t;

/* A value as a whole multiple of 2^-30, rounded, and limited to WH_SUM_MOST. */
int64_t wh_sum_whole(double value);

/* Adds a value; it must be finite. At most 2^40 values. Cost: about 5 ns. */
void wh_sum_add(wh_sum_t *sum, double value);

/* Adds all values of another sum. */
void wh_sum_merge(wh_sum_t *sum, const wh_sum_t *other);

/* 0 when nothing was counted; the deviation (n - 1 under the root) 0 below two. */
double wh_sum_mean(const wh_sum_t *sum);
double wh_sum_deviation(const wh_sum_t *sum);
double wh_sum_least(const wh_sum_t *sum);
double wh_sum_most(const wh_sum_t *sum);

/* The value that a share of `permille` / 1000 of the values does not exceed: the smallest whose rank is at
 * least that, as the middle of its bin, which is within 1/128 of the value, and within least and most. 0 when
 * nothing was counted. */
double wh_sum_quantile(const wh_sum_t *sum, uint32_t permille);

/* How many values lie in each of `count` stretches of the same length from `low` up to `high`, which are not
 * equal and between which all values are: `counts` add up to sum->count. Off by the width of a bin of the
 * sum at each end of a stretch. */
void wh_sum_histogram(const wh_sum_t *sum, double low, double high, double counts[], size_t count);

/* A rate, and how sure it is. */
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
