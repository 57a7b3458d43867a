/* A study: many trials of one script, each with errors of its own. */
#ifndef WH_STUDY_STUDY_H
#define WH_STUDY_STUDY_H

#include "../mcs/script_run.h"
#include "causes.h"
#include "flow_sums.h"

/* The number of wafers whose end is told: the first ones that the run without errors takes. */
#define WH_STUDY_WAFERS 100

/* The number of the worst trials that are kept. */
#define WH_STUDY_WORST 100

/* The number of trials whose lines are kept, from trial 0 on; with many wafers it is smaller. */
#define WH_STUDY_LINES 5000

/* The most wafers of all lines together, counting one more for each line: see `lines`. */
#define WH_STUDY_MOST_LINES 10000000

/* A wafer whose end is checked, and where the run without errors leaves it. */
typedef struct {
    int32_t wafer, holder;
    wh_place_t place;
} wh_study_wafer_t;

/* A file that the run tried to read: script, layout, a module of theirs, a mesh; hash is 0 if it is not
 * there. */
typedef struct {
    char *path;
    uint64_t hash;
} wh_study_input_t;

/* The data that all trials share. It does not change while they run, so any thread may read it. */
typedef struct {
    wh_script_run_options_t run; /* script, parameters, limits; without decisions and trial */
    uint64_t seed, trials;
    bool draws_nothing;       /* errors are given: the layout need not have a `study` */
    wh_script_run_t nominal;  /* the run without errors */
    wh_decisions_t decisions; /* of it */
    const wh_layout_t *layout;
    bool has_flow;                    /* the run without errors played a flow */
    double flow[WH_FLOW_SUM_FIGURES]; /* its figures */
    const char *whole; /* why each trial runs the script whole, or null: most replay the decisions */
    wh_study_wafer_t wafers[WH_STUDY_WAFERS];
    size_t wafer_count;
    wh_cause_t *drawn; /* each error that is drawn */
    size_t drawn_count;
    wh_cause_t *causes; /* those of them that the run without errors has to do with: see concerns.h */
    size_t cause_count;
    uint64_t lines;           /* each trial below this one keeps a line (study/lines.h) */
    wh_study_input_t *inputs; /* the files that the run without errors tried to read */
    size_t input_count, input_capacity;
} wh_study_t;

/* Plays the run without errors and gets ready for trials. Zero `study` except run, seed, trials and, if the
 * line of each trial is wanted, `lines`, which is then `trials`. Close it in any case. False, and the reason
 * on stderr, when script, layout or study are not usable, or when nothing is checked. */
bool wh_study_open(wh_study_t *study);
void wh_study_close(wh_study_t *study);

/* True if sensors with noise of their own are read. The study must be open. */
bool wh_study_has_noise(const wh_study_t *study);

/* True if no width is above 0, so that trials differ in the noise of sensors alone. The study must be
 * open. */
bool wh_study_is_of_noise(const wh_study_t *study);

#endif
