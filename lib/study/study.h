/* A study: many trials of one script, each with errors of its own. */
#ifndef WH_STUDY_STUDY_H
#define WH_STUDY_STUDY_H

#include "../mcs/script_run.h"

/* Trials are shared out by so many, and kept by so many. */
#define WH_STUDY_BLOCK 256

/* The end is told of so many wafers: the first ones that the run without errors takes. */
#define WH_STUDY_WAFERS 100

/* So many of the worst trials are known. */
#define WH_STUDY_WORST 100

/* A wafer whose end is looked at, and where the run without errors leaves it. */
typedef struct {
    int32_t wafer, holder;
    wh_place_t place;
} wh_study_wafer_t;

/* What all trials share; nothing of it changes while they run, so any thread may read it. */
typedef struct {
    wh_script_run_options_t run; /* script, parameters, limits; without decisions and trial */
    uint64_t seed, trials;
    bool draws_nothing;       /* errors are given: the layout need not say what is drawn */
    wh_script_run_t nominal;  /* the run without errors */
    wh_decisions_t decisions; /* of it */
    const wh_layout_t *layout;
    const char *whole; /* why each trial runs the script whole, or null: most replay the decisions */
    wh_study_wafer_t wafers[WH_STUDY_WAFERS];
    size_t wafer_count;
    uint64_t script_hash, layout_hash; /* of the files' text */
} wh_study_t;

/* Plays the run without errors and gets ready for trials. Zero `study` but for run, seed and trials, and
 * close it either way. False, and the reason on stderr, when script, layout or study are not usable. */
bool wh_study_open(wh_study_t *study);
void wh_study_close(wh_study_t *study);

/* How many blocks the study has, and how many trials are in one. */
uint64_t wh_study_blocks(const wh_study_t *study);
uint64_t wh_study_block_trials(const wh_study_t *study, uint64_t block);

#endif
