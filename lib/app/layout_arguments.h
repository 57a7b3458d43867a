/* A layout as subcommands take it: `layout LAYOUT` and `sim LAYOUT` name one and hand it parameters alike. */
#ifndef WH_APP_LAYOUT_ARGUMENTS_H
#define WH_APP_LAYOUT_ARGUMENTS_H

#include <argp.h>

#include "../layout/layout.h"

typedef struct {
    const char *path;
    const char **parameters; /* room for one for each argument */
    size_t parameter_count;
    wh_sandbox_t *sandbox; /* in which the layout is read, and which owns it */
} wh_layout_arguments_t;

/* LAYOUT and --set, as a child of a subcommand's parser; its input is a wh_layout_arguments_t that
 * wh_layout_arguments_init has seen. */
extern const struct argp wh_layout_argp;

/* Room for as many parameters as there are arguments; ends the program when there is no memory. */
void wh_layout_arguments_init(wh_layout_arguments_t *arguments, int argc);
void wh_layout_arguments_free(wh_layout_arguments_t *arguments);

/* Reads the layout. Null when it or a parameter is refused: standard error then says why. */
const wh_layout_t *wh_layout_arguments_load(const wh_layout_arguments_t *arguments);

#endif
