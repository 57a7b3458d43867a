/* No output of a command is an input of it, or another output. */
#ifndef WH_APP_APART_H
#define WH_APP_APART_H

#include <stdbool.h>
#include <stddef.h>

/* A file of a command. */
typedef struct {
    const char *option; /* as it was given: --data, or what it is: the script */
    const char *path;   /* null: not given */
    bool is_output;
} wh_named_file_t;

/* True if each output is a file of its own: links to one file and other spellings of its path are found out,
 * and standard output if it goes into a file and `prints`. What is no plain file, such as /dev/null, may be
 * given twice. Else false, and standard error says which two are one. */
bool wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints);

#endif
