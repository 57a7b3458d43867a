/* A script that is run once as it is, and once for each mechanism and each station of its cell, which takes
 * less time then: how much each would bring. The parallel stations of a flow's step are one more, all of
 * them together: one alone often brings nothing, for the others set the pace. */
#ifndef WH_STUDY_PACES_H
#define WH_STUDY_PACES_H

#include "../layout/faster.h"
#include "sweep.h"

/* A run in which one, or the parallel ones of a step, take less time. */
typedef struct {
    char *name;    /* "PM1", or "PM1 + PM2" */
    size_t *which; /* numbers: see wh_layout_hasten */
    size_t which_count;
    wh_sweep_point_t point;
    double gain; /* of the rate, if both runs have one, else of the time: 0.02 is 2 % more wafers in a time;
                  * infinite: one of them is not ok */
} wh_paced_run_t;

typedef struct {
    wh_script_run_options_t run; /* of each */
    double share;                /* of time that is saved, above 0 and below 1 */
    wh_sweep_point_t base;       /* the run as it is */
    wh_paced_run_t *paces;       /* the greatest gain first; those that are not ok at the end */
    size_t count, capacity;
} wh_paces_t;

/* Runs them all on this number of threads, until wh_interrupt_came: what was not begun is undone. Zero
 * `paces` except run and share, and close it in any case. False, and the reason on stderr, if the script
 * cannot be used as it is, or nothing of its cell could be faster. */
bool wh_paces_play(wh_paces_t *paces, size_t threads);
void wh_paces_close(wh_paces_t *paces);

#endif
