/* The first steady cycle of a run: the sequence that a cell repeats, found in the commands and never
 * guessed.
 *
 * Cycles are those that the script marked by cycle(), if commands begin in them. Without marks, kinds of
 * commands are compared: the action and the station; slots and angles may differ. A cycle is the shortest
 * sequence of kinds, of at most 1,000, that comes at least three times in a row. These repetitions must
 * make up at least half of the run's commands.
 *
 * A cycle is steady if the next one repeats it: equal kinds of commands in equal order, none of them with
 * an error, as many wafers done, and equal duration to 1 % (WH_STEADY_SHARE). So the first cycle, which
 * begins at home, seldom is steady.
 */
#ifndef WH_RECORD_STEADY_H
#define WH_RECORD_STEADY_H

#include "throughput.h"

#define WH_STEADY_SHARE 0.01

/* Found, or the first reason against it, in this order. */
typedef enum {
    WH_STEADY_FOUND,
    WH_STEADY_NO_COMMANDS, /* a log of moves only, a script that moves nothing, or no cell */
    WH_STEADY_NO_ROWS,     /* rows were dropped, see dropped.h */
    WH_STEADY_NO_CYCLES,   /* no sequence makes up the run, and fewer than two cycles are marked */
    WH_STEADY_UNLIKE       /* no cycle is repeated by the next one */
} wh_steady_t;

typedef struct {
    wh_steady_t found;
    size_t first, count;    /* its commands: index from 0, and number */
    int64_t begin, end;     /* slices: from the end of `begin` to the end of `end` */
    double seconds;         /* its duration */
    size_t mark;            /* the number of the marked cycle, from 1; 0: none is marked */
    size_t times;           /* the number of cycles like it in a row, itself included */
    wh_figure_t figure;     /* whether there are wafers per hour */
    size_t wafers;          /* wafers done in it; each counts once */
    double wafers_per_hour; /* 0 if there is no figure */
} wh_steady_cycle_t;

/* If none is found, everything but `found` and `figure` is zero. There is no figure where the run has none
 * (record/throughput.h). An exception is a wafer that is put twice. It is one wafer of its cycle if the
 * script marked that cycle; without marks there is no figure if it is put twice in one cycle. Cost: linear
 * in cycles and puts; without marks up to 1,000 comparisons a command. */
wh_steady_cycle_t wh_steady_cycle(const wh_record_t *record);

/* The reason why there is none, in a few words; null for WH_STEADY_FOUND. */
const char *wh_steady_reason(wh_steady_t found);

/* The length of the part of a command's text that names its kind, the action and the place: GET A of GET A
 * 1, WAIT of WAIT 2. A name with blanks stands in quotes. */
size_t wh_steady_kind_length(const char *text);

#endif
