/* A layout as subcommands take it: `layout LAYOUT` and `sim LAYOUT` name one and hand it parameters alike. */
#ifndef WH_APP_LAYOUT_ARGUMENTS_H
#define WH_APP_LAYOUT_ARGUMENTS_H

#include "../layout/layout.h"
#include "../text/options.h"

/* Zero it to begin with. */
typedef struct {
    const char *path;
    wh_option_list_t parameters;
    double memory_mib;     /* that the layout may use; 0: the sandbox's default */
    wh_sandbox_t *sandbox; /* in which the layout is read, and which owns it */
    bool is_timed;         /* its robots must be times alone; else they must not */
    bool refuses_unread; /* a parameter that nobody read is refused, not noted: the layout judges something */
} wh_layout_arguments_t;

/* --set and --memory, into a wh_layout_arguments_t; the path is the subcommand's operand. */
extern const wh_option_t wh_layout_options[];

/* Reads the layout. Null if it or a parameter is refused: standard error then says why. It notes or
 * refuses a parameter that nobody read, unless the layout names a file of patterns: those read theirs as
 * they are played. */
const wh_layout_t *wh_layout_arguments_load(wh_layout_arguments_t *arguments);

/* Notes a parameter that nobody has read until now. */
void wh_layout_arguments_note(const wh_layout_arguments_t *arguments);

void wh_layout_arguments_free(wh_layout_arguments_t *arguments);

#endif
