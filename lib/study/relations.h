/* Finds which drawn error costs most: how strongly each one correlates with a trial's failing, and with where
 * wafers end.
 *
 * The result is Pearson's correlation r, from -1 to 1, with an interval. An error that must be small in both
 * directions, such as a station's height, fails by its size. So its size (the value without its sign) is
 * correlated with failing. Its value is correlated too, which shows if one direction is worse. dx, dy and dz
 * of a wafer's end are correlated with the value; tilt and off, which have no sign, with the size.
 *
 * Sums are exact whole numbers, like those of study/sum.h: the result does not depend on who played which
 * trial.
 */
#ifndef WH_STUDY_RELATIONS_H
#define WH_STUDY_RELATIONS_H

#include <stdbool.h>

#include "sum.h"

/* Sums of a drawn error over some trials, in units of 2^-30. */
typedef struct {
    wh_int128_t values, sizes;
    wh_uint128_t squares;
} wh_relation_sums_t;

/* The sums of each cause. Zero it to begin with: it then has no causes. */
typedef struct {
    size_t cause_count, wafer_count;
    double *drawn;              /* room for a trial's draw of each cause */
    wh_relation_sums_t *all;    /* over all trials */
    wh_relation_sums_t *failed; /* over those that failed */
    wh_relation_sums_t *there;  /* wafer_count times: over those that leave the wafer where it should be */
    wh_int128_t *products; /* wafer_count times: WH_RELATION_ENDS times: with the quantities of tally.h */
} wh_relations_t;

/* dx, dy, dz, tilt, off. */
#define WH_RELATION_ENDS 5

/* The most numbers that are kept: in a large layout only the first wafers are related. */
#define WH_RELATION_MOST 20000
size_t wh_relations_wafers(size_t cause_count, size_t wafer_count);

/* Room for them, unless there is some; then the counts are as they were. Memory that runs out ends the
 * program. */
void wh_relations_need(wh_relations_t *relations, size_t cause_count, size_t wafer_count);
void wh_relations_free(wh_relations_t *relations);

/* Adds a trial with the draws of `drawn`. Then adds how each wafer lies that is where it should be. */
void wh_relations_add(wh_relations_t *relations, bool failed);
void wh_relations_add_wafer(wh_relations_t *relations, size_t wafer, const double ends[WH_RELATION_ENDS]);

/* Adds all numbers of another one; one of both may be empty. */
void wh_relations_merge(wh_relations_t *relations, const wh_relations_t *other);

/* All the numbers in one row, to be kept and read back. */
size_t wh_relations_size(const wh_relations_t *relations);
wh_int128_t *wh_relations_number(const wh_relations_t *relations, size_t i);

typedef struct {
    bool determined;     /* false: too few trials, or nothing varies; then the rest is 0 */
    double r, low, high; /* -1 <= low <= r <= high <= 1 */
} wh_correlation_t;

/* Failing is not determined by fewer failed or other trials than this; nothing by fewer than twice as
 * many. */
#define WH_RELATION_FEWEST 5

/* The interval is Fisher's (R. A. Fisher, Metron 1 (1921) 3): atanh(r) plus and minus z / sqrt(n - 3). z is
 * such that all intervals of the study together hold with 95 % (Bonferroni). Otherwise some of many errors
 * would look guilty by chance. */
wh_correlation_t wh_relations_failing(const wh_relations_t *relations, size_t cause, bool by_size,
                                      uint64_t trials, uint64_t failed);
wh_correlation_t wh_relations_end(const wh_relations_t *relations, size_t cause, size_t wafer,
                                  size_t quantity, const wh_sum_t *end);

#endif
