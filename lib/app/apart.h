/* No output of a command is an input of it, or another output. */
#ifndef WH_APP_APART_H
#define WH_APP_APART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A file of a command. */
typedef struct {
    const char *option; /* as it was given: --data; or its role: the script */
    const char *path;   /* null: not given */
    bool is_output;
} wh_named_file_t;

/* True if each output is a file of its own, also apart from standard output if the command `prints`. Links to
 * one file and other spellings of its path count as the same file. Only /dev/null may be given twice. An
 * output must not be a pipe or a socket that has a name, unless it is standard output or error: there may
 * never be a reader. Else false, and standard error says which two are one file, or which is a pipe. */
bool wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints);

/* True if an output may be written there. It must not be a file that the process has read so far or has
 * written (wh_output_keep), even if only a script or a layout names it, and no recording may go into it. Else
 * false, and standard error reports the `option`'s file. */
bool wh_file_is_free(const char *option, const char *path);

/* Checks this, and that a file can be made there: for outputs of long work. It leaves no file behind. A pipe
 * or a terminal is not tried. */
bool wh_file_is_writable(const char *option, const char *path);

/* Writes the `option`'s output by `write`, to which it hands `user`, if it may be put there. The file is then
 * whole, or as it was before. After that it is kept (wh_output_keep). True if `path` is null: the output is
 * not wanted. False if it was not written, and standard error says why: `message`, which `write` may fill in,
 * or if that is null or empty the text of errno. */
bool wh_file_write(const char *option, const char *path, bool (*write)(void *user, FILE *out), void *user,
                   const char *message);

#endif
