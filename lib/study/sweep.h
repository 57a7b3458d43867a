/* A script that is run once for each value of a parameter, or for each combination of several. */
#ifndef WH_STUDY_SWEEP_H
#define WH_STUDY_SWEEP_H

#include "../mcs/script_run.h"

/* The most runs. */
#define WH_SWEEP_MOST 10000

/* The most parameters that vary. */
#define WH_SWEEP_AXES 4

/* A parameter that takes the values start, start + step, ... up to end; or these words. */
typedef struct {
    char *name;
    double start, step, end; /* the last value is below the end if the step does not lead to it */
    size_t count;
    char **words; /* null: numbers */
} wh_sweep_axis_t;

typedef enum {
    WH_SWEEP_OK,
    WH_SWEEP_FAILED, /* like a run; or it moves nothing and expects nothing */
    WH_SWEEP_UNDONE, /* interrupted before it */
    WH_SWEEP_BAD     /* script, layout or parameter cannot be used with these values */
} wh_sweep_verdict_t;

/* The result of a run. A figure that the run does not have is infinite. */
typedef struct {
    wh_sweep_verdict_t verdict;
    char *reason; /* why it is not ok; else null */
    double simulated_s, wafers_per_hour;
    double projz, projxy; /* mm, the largest at picks */
    double gap;           /* mm, the smallest of all, if collisions are looked for */
    bool checked;         /* for collisions */
    bool is_timed;        /* its robots are times alone: nobody looked at places and ways either */
    bool has_timed;       /* some of them are, beside robots with axes */
    bool is_cut;          /* its flow was cut with wafers not at their ends */
    bool caught;          /* it is ok, and its script caught an error */
    size_t late, lost;    /* stays beyond windows, and wafers lost in a flow, whether or not they fail it */
    char *never_came;     /* the faults and errors on purpose that did not come; null: none */
    char *busiest;        /* of a flow: the robot or station that limits it, and its share; null: none */
    uint64_t hash;
} wh_sweep_point_t;

typedef struct {
    wh_script_run_options_t run;   /* of each; its parameters are set here */
    const char *const *parameters; /* NAME=START:STEP:END, and NAME=VALUE, which stays */
    size_t parameter_count;
    const char *const *each; /* NAME=A,B,C: values as they stand, behind the ranges */
    size_t each_count;
    wh_sweep_axis_t *axes; /* the last one varies first */
    size_t axis_count;
    wh_sweep_point_t *points;
    size_t point_count;
} wh_script_sweep_t;

/* True if the text is meant as a range: two colons behind the '=', the first after a number. */
bool wh_sweep_is_range(const char *parameter);

/* Reads the parameters. Zero `sweep` except run, parameters, each and their counts, and close it in any case.
 * False, and the reason on stderr, if a range is invalid, if none is given, or if there are too many runs.
 * Memory that runs out ends the program. */
bool wh_sweep_open(wh_script_sweep_t *sweep);
void wh_sweep_close(wh_script_sweep_t *sweep);

/* Runs them all on this number of threads, until wh_interrupt_came: runs that are not begun then stay undone.
 * False, and the reason on stderr, if there is no thread. */
bool wh_sweep_play(wh_script_sweep_t *sweep, size_t threads);

/* True if the run may be called the fastest: it is ok, no wafer stayed beyond a window, and none was lost. A
 * cut one may be by its rate alone. */
bool wh_sweep_may_lead(const wh_sweep_point_t *point);

/* Plays one run, and judges it; the caller closes the run and frees the point. */
void wh_sweep_point_play(const wh_script_run_options_t *options, wh_script_run_t *run,
                         wh_sweep_point_t *point);
void wh_sweep_point_free(wh_sweep_point_t *point);

/* The value that a run has on an axis; of words their number, from 1. */
double wh_sweep_value(const wh_script_sweep_t *sweep, size_t point, size_t axis);

/* The text with which an axis' value is handed over. */
#define WH_SWEEP_VALUE 32
void wh_sweep_text(double value, char text[WH_SWEEP_VALUE]);

/* A run's value as that text, in `text`, or its word, which the sweep keeps. */
const char *wh_sweep_word(const wh_script_sweep_t *sweep, size_t point, size_t axis,
                          char text[WH_SWEEP_VALUE]);

#endif
