/* The progress of a study: the trials that are done, and their results. */
#ifndef WH_STUDY_PROGRESS_H
#define WH_STUDY_PROGRESS_H

#include "tally.h"

/* Trials in a row, `count` of them from `first` on. */
typedef struct {
    uint64_t first, count;
} wh_stretch_t;

/* Stretches in order; none touches another. To be zeroed, and freed. */
typedef struct {
    wh_stretch_t *items;
    size_t count, capacity;
    uint64_t trials; /* in all of them */
} wh_stretches_t;

/* Memory that runs out ends the program, here and below. */
void wh_stretches_free(wh_stretches_t *stretches);

/* Adds trials, none of which is there yet. Cost: linear in the stretches; little when it goes on where the
 * last one ends. False, and nothing is added, if one of them is there already or `count` is 0. */
bool wh_stretches_add(wh_stretches_t *stretches, wh_stretch_t stretch);

/* Takes up to `most` trials in a row off the front; none if nothing is left. */
wh_stretch_t wh_stretches_take(wh_stretches_t *stretches, uint64_t most);

/* How many of them are below this. */
uint64_t wh_stretches_below(const wh_stretches_t *stretches, uint64_t trial);

/* Fills in, from empty, the trials from 0 up to `trials` that are not in `done`. */
void wh_stretches_rest(wh_stretches_t *rest, const wh_stretches_t *done, uint64_t trials);

typedef struct {
    wh_stretches_t done;
    wh_tally_t tally; /* of these */
} wh_progress_t;

void wh_progress_init(wh_progress_t *progress, const wh_study_t *study);
void wh_progress_free(wh_progress_t *progress);

/* Adds another progress; no trial may be done twice. The result does not depend on order, to the last bit. */
void wh_progress_merge(wh_progress_t *progress, const wh_progress_t *other);

#endif
