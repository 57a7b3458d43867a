/* Tells on standard error how far long work has come: on a terminal in one line that changes, once the work
 * has taken a second; else, as to a file or a pipe, in a line every ten seconds. Short work prints
 * nothing. */
#ifndef WH_APP_TELLER_H
#define WH_APP_TELLER_H

#include <stddef.h>
#include <stdio.h>

typedef struct {
    const char *name; /* of the subcommand */
    FILE *terminal;   /* null: standard error is not a terminal */
    const char *what; /* the name that was told last; when it began, and the count at which it began */
    double since;
    size_t first;
    double told; /* s; when it was told last */
    double begun;
} wh_teller_t;

/* `name` must outlive it. */
void wh_teller_begin(wh_teller_t *teller, const char *name);

/* Tells `done` of `total` (0: unknown) of the work that is called `what`, a constant. Where it helps, it adds
 * how long the rest will take at the pace so far. Call it from one thread at a time. */
void wh_teller_tell(wh_teller_t *teller, const char *what, size_t done, size_t total);

/* Removes the line from the terminal. */
void wh_teller_end(wh_teller_t *teller);

#endif
