/* The words of the prompt that a dialect may use, and what a host must know about each.
 *
 * Constant tables: any thread may use them, and calls cost almost nothing.
 */
#ifndef WH_HOST_WORDS_H
#define WH_HOST_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* The mechanism that a controller stands for: see mechanism.h. */
typedef enum {
    WH_MECHANISM_CELL,
    WH_MECHANISM_ROBOT,
    WH_MECHANISM_ALIGNER,
    WH_MECHANISM_LOAD_PORT,
    WH_MECHANISMS
} wh_mechanism_t;

/* Their names in a dialect: cell, robot, aligner, load_port; a null ends them. */
extern const char *const wh_mechanism_names[WH_MECHANISMS + 1];

/* The treatment of a command. */
typedef enum {
    WH_WORD_ACTION,     /* takes simulated time or changes the cell: begun when it comes, ended later */
    WH_WORD_QUERY,      /* changes nothing; refused as busy while something runs */
    WH_WORD_ALWAYS,     /* STATUS and VERSION: answered at any time */
    WH_WORD_STOP,       /* ends what runs */
    WH_WORD_HOLD,       /* the running command stands still after the present slice: time does not pass */
    WH_WORD_RESUME,     /* and goes on */
    WH_WORD_CONTROLLER, /* a robot's own controller: changed and told at any time */
    WH_WORD_RATE,       /* the pace of simulated time */
    WH_WORD_TELL,       /* a tester tells the other controllers something */
    WH_WORD_ACKN,       /* the host has had the completion */
    WH_WORD_LOCAL       /* the dialect answers by itself */
} wh_word_kind_t;

typedef struct {
    const char *name; /* in capitals */
    wh_word_kind_t kind;
    unsigned mechanisms;   /* the mechanisms that have it: one bit for each, 1 << WH_MECHANISM_ROBOT */
    bool is_of_simulation; /* tells something that no controller knows, or how a line is typed */
} wh_word_t;

/* All of them. Behind the prompt's own words come those that only a port has: HOLD, RESUME, RATE,
 * TELL, ACKN and LOCAL. */
extern const wh_word_t wh_words[];
extern const size_t wh_word_count;

/* The word with that name; the text may go on behind a blank: "GET A 1". Null: none. Upper and lower case are
 * the same. */
const wh_word_t *wh_word_of(const char *line);

#endif
