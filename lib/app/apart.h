/* No output of a command is an input of it, or another output. */
#ifndef WH_APP_APART_H
#define WH_APP_APART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A file of a command. */
typedef struct {
    const char *option; /* as it was given: --data, or what it is: the script */
    const char *path;   /* null: not given */
    bool is_output;
} wh_named_file_t;

/* True if each output is a file of its own: links to one file and other spellings of its path are found out,
 * and standard output if the command `prints`. /dev/null alone may be given twice. Nor is an output a pipe or
 * a socket that has a name, unless it is standard output or error: nobody may ever read there. Else false,
 * and standard error says which two are one, or which is a pipe. */
bool wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints);

/* True if an output may be put there: it is none of the files that the process has read so far or has written
 * (wh_output_keep), be it one that only a script or a layout names, and no recording goes into it. Else
 * false, and standard error says so of the `option`'s file. */
bool wh_file_is_free(const char *option, const char *path);

/* The same, and a file can be made there: for outputs of what takes long. Nothing is left behind. A pipe or a
 * terminal is not tried. */
bool wh_file_is_writable(const char *option, const char *path);

/* Writes the `option`'s output by `write`, to which it hands `user`, if it may be put there: whole, or it is
 * as it was. Then it is kept (wh_output_keep). True if `path` is null: it is not wanted. False if it was not
 * written, and standard error says why: `message`, which `write` may fill in, or if that is null or empty
 * what errno says. */
bool wh_file_write(const char *option, const char *path, bool (*write)(void *user, FILE *out), void *user,
                   const char *message);

#endif
