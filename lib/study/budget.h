/* The budget of a script: how far each station may stand from where it was taught before the script fails.
 *
 * Trials find the widths: the script is played with an error, and passes if `run` would end with 0. First
 * comes one error at a time. It grows from 0 in steps, downwards and upwards separately, until a trial fails;
 * then bisection narrows the last step down. So no trial within a width has failed, although passing may not
 * be monotone. Between two trials nothing is known, and `widest` says how far apart they are. Then come all
 * errors together: a box, in which each is within plus and minus an equal share of its own width. The box
 * shrinks until none of its trials fails. They are corners and points inside it, which are counted by kind.
 * This is a search for counterexamples, not a proof.
 *
 * Lengths in thousandths of a mm, angles in thousandths of a degree: each value has three decimals, and
 * reads back from them to the bit.
 */
#ifndef WH_STUDY_BUDGET_H
#define WH_STUDY_BUDGET_H

#include "study.h"

/* Thousandths of a mm or of a degree. */
#define WH_BUDGET_UNIT 1000

typedef struct {
    size_t threads;     /* at least 1 */
    int32_t most[2];    /* the largest errors to try: mm and degrees, in thousandths, at least 1 */
    uint64_t steps;     /* the least number of steps up to there; 0: 100, or with collisions a number by their
                         * cost */
    uint64_t samples;   /* of the box, of each random kind */
    uint64_t seed;      /* of these */
    const bool *wanted; /* of each station: its errors are searched; null: all stations' */
    /* Called during the search, from one thread at a time: `done` of `total` of the work called `what`. Null:
     * no call. */
    void (*tell)(void *user, const char *what, size_t done, size_t total);
    void *user;
    /* Asked before each piece of work, from any thread: true ends the search, and `incomplete` is then set.
     * Null: it goes on to its end. */
    bool (*is_enough)(void);
} wh_budget_options_t;

/* Why a run fails. */
typedef struct {
    char name[64];     /* of the error, WAFER_MISSING, or of the event, hit; "expectation"; "script" */
    wh_status_t error; /* its number; WH_OK: it is not an error */
    int line;          /* in the script; 0: unknown */
    char command[300]; /* during which; "": none */
    char text[400];    /* the event in words, the limit that a pick missed, what was expected, the message */
} wh_budget_why_t;

/* An error in one direction, as its magnitude. */
typedef struct {
    int32_t inside;  /* passes, and so did every trial below it */
    int32_t outside; /* fails: inside + 1. 0: nothing failed up to the most */
    int32_t widest;  /* the largest step between two trials from 0 to `inside` */
    uint32_t trials;
    wh_budget_why_t why; /* `outside` fails */
} wh_budget_side_t;

typedef struct {
    wh_budget_side_t sides[2]; /* downwards, upwards */
    int32_t width;             /* the smaller `inside` */
    /* In a trial, something that is judged or told differed: an event, or the place where a wafer ended. */
    bool has_effect;
    bool known; /* it was looked for, up to the end */
} wh_budget_error_t;

/* In wh_errors_teaching_name's order. */
typedef struct {
    bool wanted;
    wh_budget_error_t errors[WH_SPREADS];
} wh_budget_station_t;

/* The kinds of points of the box that are tried: corners that are alike at all stations; corners that are
 * opposite at every other station; corners of one station alone; random corners of all; random points inside;
 * and corners next to the one beyond which it fails: one error turned over, or two if collisions are not
 * checked. */
typedef enum {
    WH_BOX_ALIKE,
    WH_BOX_OPPOSITE,
    WH_BOX_ALONE,
    WH_BOX_CORNER,
    WH_BOX_INSIDE,
    WH_BOX_BESIDE
} wh_box_kind_t;
#define WH_BOX_KINDS 6

/* A point has a number for each error of each station, in a row: WH_SPREADS * station_count. */
typedef struct {
    int64_t share, whole;         /* each error may have share/whole of its width */
    int32_t *half;                /* the half-widths up and down, rounded down */
    int32_t *inside, *outside;    /* passes in the box; fails, one thousandth beyond it. Null: none fails */
    wh_budget_why_t why;          /* `outside` fails */
    uint64_t tried[WH_BOX_KINDS]; /* points of the box that were tried in the end */
    uint64_t tried_without[WH_BOX_KINDS]; /* and before, collisions aside, where these take long */
} wh_budget_box_t;

typedef struct {
    const wh_study_t *study;
    wh_budget_options_t options;
    wh_budget_station_t *stations; /* the layout's */
    wh_budget_box_t box;
    bool incomplete;  /* it was ended: unknown errors have no numbers, and neither has the box */
    bool two_ways;    /* trials without collisions first, then with them */
    bool caught;      /* in a trial that passed, the script caught an error that it otherwise does not have */
    uint64_t trials;  /* all in all */
    int32_t tightest; /* the station that allows least: see wh_budget_tightness; WH_NONE: nothing failed */
    int32_t next;     /* the station that allows least, apart from that one and those like it; or WH_NONE */
} wh_budget_t;

/* Finds the budget of an opened study whose run without errors is ok. To be freed. False, with the reason on
 * stderr, if there are no threads or if a witness does not behave as found. False without a reason if it was
 * ended, see `incomplete`. Deterministic: equal options give an equal result, with any number of threads.
 * Cost: some 500 trials a station, and some thousand of the box. */
bool wh_budget_find(wh_budget_t *budget, const wh_study_t *study, const wh_budget_options_t *options);
void wh_budget_free(wh_budget_t *budget);

/* How far an error moves the rim of a wafer when it first fails, mm: for lengths the width, for angles the
 * width times the wafer's radius. Infinite if it does not fail. This makes lengths and angles comparable. */
double wh_budget_rim(const wh_budget_t *budget, size_t station, size_t axis);

/* How many errors passed up to the limit, which moves the rim less than the tightest error's width: they may
 * allow less than that. 0 if nothing failed. */
size_t wh_budget_capped(const wh_budget_t *budget);

/* The error of a station with the smallest such movement, and that movement. */
size_t wh_budget_tightest_axis(const wh_budget_t *budget, size_t station);
double wh_budget_tightness(const wh_budget_t *budget, size_t station);

/* True if two stations allow the same, within 5 %. */
bool wh_budget_is_alike(const wh_budget_t *budget, size_t one, size_t other);

/* Room for the longest "STATION.AXIS=VALUE", which run --error takes. */
#define WH_BUDGET_TEXT 96
void wh_budget_text(char text[WH_BUDGET_TEXT], const wh_layout_t *layout, size_t station, size_t axis,
                    int32_t value);

#endif
