/* The first steady cycle of a run: what a cell does over and over, found in the commands and never guessed.
 *
 * Cycles are those that the script marked by cycle(), as far as commands begin in them. Without marks, kinds
 * of commands are compared (what is done, and at which station; slots and angles may differ): the shortest
 * sequence of kinds, of at most 1,000, that comes at least three times in a row and so makes up at least half
 * of the run's commands is a cycle.
 *
 * A cycle is steady if the one right behind it repeats it: the same kinds of commands in the same order, none
 * of them with an error, as many wafers done, and as long to 1 % (WH_STEADY_SHARE). So the first cycle, which
 * begins at home, seldom is.
 */
#ifndef WH_RECORD_STEADY_H
#define WH_RECORD_STEADY_H

#include "throughput.h"

#define WH_STEADY_SHARE 0.01

/* If there is one; else the first reason, in this order. */
typedef enum {
    WH_STEADY_FOUND,
    WH_STEADY_NO_COMMANDS, /* a log of moves alone, a script that moves nothing, or no cell */
    WH_STEADY_NO_CYCLES, /* no sequence of commands makes up the run, and fewer than two cycles are marked */
    WH_STEADY_UNLIKE     /* of the cycles none is repeated by the next one */
} wh_steady_t;

typedef struct {
    wh_steady_t found;
    size_t first, count;    /* its commands: index from 0, and how many */
    int64_t begin, end;     /* slices: from the end of `begin` to the end of `end` */
    double seconds;         /* that it takes */
    size_t mark;            /* which of the marked cycles it is, from 1; 0: none is marked */
    size_t times;           /* how many cycles like it come in a row, itself included */
    wh_figure_t figure;     /* if there are wafers per hour */
    size_t wafers;          /* done in it, each once */
    double wafers_per_hour; /* 0 if there is no figure */
} wh_steady_cycle_t;

/* All zero but `found` and `figure` where none is found. There is no figure where the run has none
 * (record/throughput.h), but for a wafer that is put twice: it is one wafer of its cycle if the script marked
 * that, and else no figure if it is put twice in one cycle. Cost: linear in cycles and puts; without marks up
 * to 1,000 comparisons a command. */
wh_steady_cycle_t wh_steady_cycle(const wh_record_t *record);

/* Why there is none, in a few words; null for WH_STEADY_FOUND. */
const char *wh_steady_reason(wh_steady_t found);

/* How much of a command's text names its kind, what it does and where: GET A of GET A 1, WAIT of WAIT 2. A
 * name with blanks stands in quotes. */
size_t wh_steady_kind_length(const char *text);

#endif
