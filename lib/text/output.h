/* Files that are there whole or not at all. */
#ifndef WH_TEXT_OUTPUT_H
#define WH_TEXT_OUTPUT_H

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

/* A new file in the same folder as the one that it will replace. Zero it to begin with. What a symbolic link
 * points to is replaced; a link that points nowhere is itself replaced. An existing file keeps its
 * permissions, a new one gets 0666 less the umask. Only a kill leaves the new file, ".waferhand-PID-N". */
typedef struct {
    FILE *file;
    char target[PATH_MAX];
    char
        beside[PATH_MAX + 48]; /* empty: it is no plain file (a pipe, a terminal) and is written to at once */
} wh_output_t;

/* Opens it. False and errno if it cannot be written. */
bool wh_output_open(wh_output_t *output, const char *path);

/* Closes it and puts it in its place. False and errno if not all of it could be written: the old file is then
 * still there. */
bool wh_output_commit(wh_output_t *output);

/* Gives it up: the old file is still there. Does nothing after wh_output_commit. */
void wh_output_drop(wh_output_t *output);

/* Says on standard error that an option's output could not be written, and why, an errno. */
void wh_output_tell(const char *option, const char *path, int error);

/* Writes a small file so, whole: whoever reads it meanwhile sees the old one or the new one. Returns 0 or an
 * errno: EISDIR for a directory, EINVAL for what else is no plain file. Then nothing has changed. Nothing is
 * synced to the disk. */
int wh_output_replace(const char *path, const void *bytes, size_t size);

/* True if both paths lead to one file, which is there: by links, or in other spellings. */
bool wh_output_is_one_file(const char *a, const char *b);

/* From now on nothing is to be written over this file: it is an input, or an output that is ready. Whoever
 * writes files of its own asks wh_output_is_kept first. Does nothing if there is no such plain file. The list
 * is the process's own; any thread may call both. Cost: linear in the files that are kept. */
void wh_output_keep(const char *path);
bool wh_output_is_kept(const char *path);

/* Says that a file is about to be read as an input, be it there or not: who listens hears of it. */
void wh_output_note_input(const char *path);

/* From now on this is called with each path that is noted so, from any thread. Null: nobody listens. */
void wh_output_hear_inputs(void (*listener)(void *user, const char *path), void *user);

/* What is said of an output that would be written over a kept file. */
#define WH_OUTPUT_KEPT "this is an input or another output (expected a file of its own)"

/* Where the program keeps a file for the next time: $XDG_STATE_HOME/waferhand/NAME, or
 * ~/.local/state/waferhand/NAME. Empty if the environment names no such place, or if `size` bytes do not hold
 * it. */
void wh_output_state_path(const char *name, char *path, size_t size);

/* Makes the folders that a file is to be in, for their owner alone. False and errno if that was not
 * possible. */
bool wh_output_make_folders(const char *path);

/* Writes a word so that a shell reads it back unchanged. */
void wh_output_word(FILE *out, const char *word);

#endif
