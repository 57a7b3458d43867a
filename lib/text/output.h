/* Files that are there whole or not at all. */
#ifndef WH_TEXT_OUTPUT_H
#define WH_TEXT_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

/* A file being written beside the one that it will replace. Zero it to begin with. */
typedef struct {
    FILE *file;
    const char *path;  /* borrowed */
    char beside[4096]; /* empty: `path` is no plain file (a pipe, a terminal) and is written to at once */
} wh_output_t;

/* Opens it. False and errno if it cannot be written. */
bool wh_output_open(wh_output_t *output, const char *path);

/* Closes it and puts it in its place. False and errno if not all of it could be written: the old file is then
 * still there. */
bool wh_output_commit(wh_output_t *output);

/* Gives it up: the old file is still there. Does nothing after wh_output_commit. */
void wh_output_drop(wh_output_t *output);

/* Where the program keeps a file for the next time: $XDG_STATE_HOME/waferhand/NAME, or
 * ~/.local/state/waferhand/NAME. Empty if the environment names no such place, or if `size` bytes do not hold
 * it. */
void wh_output_state_path(const char *name, char *path, size_t size);

/* Makes the folders that a file is to be in, for their owner alone. False and errno if that was not
 * possible. */
bool wh_output_make_folders(const char *path);

#endif
