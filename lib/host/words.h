/* The words of the prompt that a dialect may speak, and what a host has to know of each.
 *
 * Constant tables: any thread, no cost worth a word.
 */
#ifndef WH_HOST_WORDS_H
#define WH_HOST_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* What a controller stands for: see mechanism.h. */
typedef enum {
    WH_MECHANISM_CELL,
    WH_MECHANISM_ROBOT,
    WH_MECHANISM_ALIGNER,
    WH_MECHANISM_LOAD_PORT,
    WH_MECHANISMS
} wh_mechanism_t;

/* Their names in a dialect: cell, robot, aligner, load_port; a null ends them. */
extern const char *const wh_mechanism_names[WH_MECHANISMS + 1];

/* What becomes of a command. */
typedef enum {
    WH_WORD_ACTION, /* takes simulated time or changes the cell: begun when it comes, ended later */
    WH_WORD_QUERY,  /* changes nothing; refused as busy while something runs */
    WH_WORD_ALWAYS, /* STATUS and VERSION: answered at any time */
    WH_WORD_STOP,   /* ends what runs */
    WH_WORD_HOLD,   /* what runs stands still after the present slice: time does not pass */
    WH_WORD_RESUME, /* and goes on */
    WH_WORD_ACKN,   /* the host has had the completion */
    WH_WORD_LOCAL   /* the dialect answers by itself */
} wh_word_kind_t;

typedef struct {
    const char *name; /* in capitals */
    wh_word_kind_t kind;
    unsigned mechanisms;   /* of whom: one bit for each, 1 << WH_MECHANISM_ROBOT */
    bool is_of_simulation; /* tells what no controller knows, or how a line is typed */
} wh_word_t;

/* All of them. Behind the prompt's own words come those of a port alone: HOLD, RESUME, ACKN and LOCAL. */
extern const wh_word_t wh_words[];
extern const size_t wh_word_count;

/* The word of that name, which may go on behind a blank: "GET A 1". Null: none. Upper and lower case
 * are the same. */
const wh_word_t *wh_word_of(const char *line);

#endif
