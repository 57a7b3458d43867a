/* A study: many trials of one script, each with errors of its own. */
#ifndef WH_STUDY_STUDY_H
#define WH_STUDY_STUDY_H

#include "../mcs/script_run.h"
#include "causes.h"

/* The end is told of so many wafers: the first ones that the run without errors takes. */
#define WH_STUDY_WAFERS 100

/* So many of the worst trials are known. */
#define WH_STUDY_WORST 100

/* The lines of so many trials are kept, from trial 0 on; of many wafers fewer. */
#define WH_STUDY_LINES 5000

/* A line for each trial has at most so many wafers in all, and one more each: see `lines`. */
#define WH_STUDY_MOST_LINES 10000000

/* A wafer whose end is looked at, and where the run without errors leaves it. */
typedef struct {
    int32_t wafer, holder;
    wh_place_t place;
} wh_study_wafer_t;

/* A file that was looked for: script, layout, a module of theirs, a mesh; hash is 0 if it is not there. */
typedef struct {
    char *path;
    uint64_t hash;
} wh_study_input_t;

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
    wh_cause_t *causes; /* what is drawn */
    size_t cause_count;
    uint64_t lines;           /* a line is kept of each trial below this (study/lines.h) */
    wh_study_input_t *inputs; /* the files that the run without errors looked for */
    size_t input_count, input_capacity;
} wh_study_t;

/* Plays the run without errors and gets ready for trials. Zero `study` but for run, seed, trials and, if the
 * line of each trial is wanted, `lines`, which is then `trials`; and close it either way. False, and the
 * reason on stderr, when script, layout or study are not usable, or when nothing is checked. */
bool wh_study_open(wh_study_t *study);
void wh_study_close(wh_study_t *study);

/* True if sensors with noise of their own are asked. Of an open study. */
bool wh_study_has_noise(const wh_study_t *study);

/* True if no width is above 0, so that trials differ in the noise of sensors alone. Of an open study. */
bool wh_study_is_of_noise(const wh_study_t *study);

#endif
