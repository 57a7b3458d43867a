/* Files that are either complete or absent. */
#ifndef WH_TEXT_OUTPUT_H
#define WH_TEXT_OUTPUT_H

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

/* A new file in the folder of the file that it will replace. Zero it at the beginning. If the path is a
 * symbolic link, its target is replaced; a link without a target is itself replaced. An existing file keeps
 * its permissions; a new one gets 0666 minus the umask. The new file, ".waferhand-PID-N", remains only if
 * the process is killed. */
typedef struct {
    FILE *file;
    char target[PATH_MAX];
    char beside[PATH_MAX + 48]; /* empty: it is a pipe or a terminal and is written at once */
} wh_output_t;

/* The path of a file that may not exist: its folder's path, without links, and its name. Returns false if
 * the folder does not exist, or the path is too long. */
bool wh_output_resolve(const char *path, char resolved[PATH_MAX]);

/* Opens the file. Returns false and errno if it cannot be written. */
bool wh_output_open(wh_output_t *output, const char *path);

/* Closes it and puts it in place. Returns false and errno if not all of it could be written; the old file
 * then still exists. */
bool wh_output_commit(wh_output_t *output);

/* Gives it up; the old file still exists. It does nothing after wh_output_commit. */
void wh_output_drop(wh_output_t *output);

/* Says on standard error that an option's output could not be written, with the reason, an errno. */
void wh_output_tell(const char *option, const char *path, int error);

/* Writes a small file in this way: a reader sees either the complete old one or the complete new one.
 * Returns 0 or an errno: EISDIR for a directory, EINVAL for anything else that is not a plain file. In case
 * of an error nothing has changed. It does not sync to the disk. */
int wh_output_replace(const char *path, const void *bytes, size_t size);

/* True if both paths lead to one existing file, by links or in other spellings. */
bool wh_output_is_one_file(const char *a, const char *b);

/* After this call the file must not be overwritten, because it is an input, or an output that is ready.
 * Code that writes files by itself must first call wh_output_is_kept. It does nothing if there is no such
 * plain file. The list belongs to the process; any thread may call both. Cost: linear in the number of kept
 * files. */
void wh_output_keep(const char *path);
bool wh_output_is_kept(const char *path);

/* Says that a file is about to be read as an input, whether it exists or not; it calls the listener. */
void wh_output_note_input(const char *path);

/* Sets a listener, which is called with each path noted in this way, from any thread. Null: there is no
 * listener. */
void wh_output_hear_inputs(void (*listener)(void *user, const char *path), void *user);

/* The message for an output that would overwrite a kept file. */
#define WH_OUTPUT_KEPT "this is an input or another output (expected a file of its own)"

/* The path of a file that the program keeps for the next time: $XDG_STATE_HOME/waferhand/NAME, or
 * ~/.local/state/waferhand/NAME. It is empty if the environment gives no such place, or if `size` bytes are
 * too few. */
void wh_output_state_path(const char *name, char *path, size_t size);

/* Makes the folders of a file, accessible to their owner only. Returns false and errno if that was not
 * possible. */
bool wh_output_make_folders(const char *path);

/* Writes a word in a form that a shell reads back unchanged. */
void wh_output_word(FILE *out, const char *word);

#endif
