/* Results of trials, as counts: the sums do not depend on which process counted which trial. */
#ifndef WH_STUDY_TALLY_H
#define WH_STUDY_TALLY_H

#include "flow_sums.h"
#include "lines.h"
#include "relations.h"
#include "study.h"
#include "sum.h"

/* How far a wafer ends from where the run without errors leaves it: along x, y, z of its slot (mm), its tilt
 * (deg), and in the slot's plane (mm). */
typedef enum { WH_TALLY_DX, WH_TALLY_DY, WH_TALLY_DZ, WH_TALLY_TILT, WH_TALLY_OFF } wh_tally_quantity_t;
#define WH_TALLY_QUANTITIES 5

typedef struct {
    uint64_t
        /* trials that leave it in another slot, in none, or with another holder: not in the sums */
        elsewhere;
    wh_sum_t of[WH_TALLY_QUANTITIES];
} wh_tally_wafer_t;

typedef struct {
    uint64_t trials, total; /* in how many trials, and how often */
} wh_tally_event_t;

#define WH_TALLY_NO_TRIAL UINT64_MAX

/* An expectation or a command's error, by its place in the script. */
typedef struct {
    int line;
    bool is_implied; /* an expectation that nobody wrote down: those of a line have places of their own */
    int place;       /* the place of an expectation among those of its line, from 0; or an error's number */
    char *text;      /* the text of trial `named` */
    uint64_t named;  /* the lowest trial that has it */
    uint64_t seen;   /* trials that came to it */
    uint64_t bad;    /* trials in which it was not met, or happened */
    uint64_t first;  /* the lowest of those, or WH_TALLY_NO_TRIAL */
    uint64_t last;   /* while counting: the trial that was counted last */
} wh_tally_row_t;

typedef struct {
    wh_tally_row_t *rows;
    size_t count, capacity;
    size_t next;  /* where the next search begins */
    bool by_text; /* a different text makes a different row */
} wh_tally_rows_t;

/* One of the worst trials. */
typedef wh_trial_line_t wh_tally_trial_t;

/* To be zeroed, then given its wafers. */
typedef struct {
    uint64_t trials, met;
    uint64_t ended; /* by an error that the script did not catch */
    uint64_t whole; /* ran the script whole: Lua and all */
    wh_tally_event_t events[WH_EVENT_KINDS];
    wh_tally_rows_t expectations, errors;
    size_t wafer_count;
    wh_tally_wafer_t *wafers;
    wh_flow_sums_t *flow;                   /* null: no trial had a flow */
    wh_tally_trial_t worst[WH_STUDY_WORST]; /* the worst first */
    size_t worst_count;
    wh_relations_t relations; /* between the draws and the results */
    size_t flow_at;           /* of a flow, behind the wafers of relations; SIZE_MAX: nowhere */
    wh_trial_lines_t lines;   /* of the trials below study->lines */
} wh_tally_t;

/* The result of one trial. */
typedef struct {
    uint64_t trial;
    bool met, whole;
    bool complained; /* while decisions are replayed: an event was a complaint */
    /* Only its commands, expectations and failure are read, not its events and wafers. */
    const wh_record_t *record;
    uint32_t events[WH_EVENT_KINDS];
    wh_study_wafer_t wafers[WH_STUDY_WAFERS];
} wh_outcome_t;

/* Room for a study's wafers. Memory that runs out ends the program, here and below. */
void wh_tally_init(wh_tally_t *tally, size_t wafer_count);
void wh_tally_free(wh_tally_t *tally);

void wh_tally_add(wh_tally_t *tally, const wh_study_t *study, const wh_outcome_t *outcome);

/* Adds all counts of another tally. The result does not depend on order, to the last bit. */
void wh_tally_merge(wh_tally_t *tally, const wh_tally_t *other);

/* Room for relations between the study's draws and its wafers' ends, and of a flow its figures. */
void wh_tally_need_relations(wh_tally_t *tally, const wh_study_t *study);

/* How a drawn error correlates with a figure of the flow. */
wh_correlation_t wh_tally_relate(const wh_tally_t *tally, size_t cause, wh_flow_sum_t figure);

/* The sums of flows, made if there are none. */
wh_flow_sums_t *wh_tally_need_flow(wh_tally_t *tally);

/* Puts expectations and errors in the order of line, place and text, and lines in that of trials, to be
 * printed. */
void wh_tally_sort(wh_tally_t *tally);

/* True if the row is to be printed: an implied expectation is told once a trial did not meet it. */
bool wh_tally_is_told(const wh_tally_row_t *row);

/* The row of the key's line, place and kind, made if there is none; `text` is kept if this trial is the
 * lowest that has it. Errors of other commands in the same line, as a loop makes them, have rows of their
 * own. */
wh_tally_row_t *wh_tally_row(wh_tally_rows_t *rows, const wh_tally_row_t *key, const char *text,
                             uint64_t named);

/* Puts a trial among the worst, if it is one of them: failed ones before others, then by `off`, then the
 * lower number. */
void wh_tally_note_worst(wh_tally_t *tally, const wh_tally_trial_t *trial);

#endif
