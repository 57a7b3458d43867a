#include "apart.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../text/output.h"

/* The path of a file that is not there: its folder's, without links, and its name. False if the folder is not
 * there. */
static bool resolve(const char *path, char resolved[PATH_MAX]) {
    char folder[PATH_MAX];
    char whole[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) + 1 : 0;
    (void)snprintf(folder, sizeof folder, "%.*s.", length, path);
    if (!realpath(folder, whole)) {
        return false;
    }
    return snprintf(resolved, PATH_MAX, "%s/%s", whole, slash ? slash + 1 : path) < PATH_MAX;
}

static bool is_same_file(const char *a, const char *b) {
    struct stat one;
    char first[PATH_MAX];
    char second[PATH_MAX];
    if (stat(a, &one) == 0) {
        return !S_ISCHR(one.st_mode) && !S_ISFIFO(one.st_mode) && !S_ISSOCK(one.st_mode) &&
               wh_output_is_one_file(a, b);
    }
    return stat(b, &one) != 0 && resolve(a, first) && resolve(b, second) && strcmp(first, second) == 0;
}

static bool is_standard_output(const char *path) {
    struct stat one;
    struct stat two;
    return stat(path, &one) == 0 && fstat(STDOUT_FILENO, &two) == 0 && S_ISREG(one.st_mode) &&
           one.st_dev == two.st_dev && one.st_ino == two.st_ino;
}

static bool is_apart(const wh_named_file_t *file, const wh_named_file_t *other) {
    if (!file->path || !other->path || (!file->is_output && !other->is_output) ||
        !is_same_file(file->path, other->path)) {
        return true;
    }
    const wh_named_file_t *output = file->is_output ? file : other;
    const wh_named_file_t *rest = file->is_output ? other : file;
    fprintf(stderr, "%s: %s would overwrite %s (expected a file of its own)\n", output->path, output->option,
            rest->option);
    return false;
}

bool wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints) {
    for (size_t i = 0; i < count; ++i) {
        for (size_t other = i + 1; other < count; ++other) {
            if (!is_apart(&files[i], &files[other])) {
                return false;
            }
        }
        if (prints && files[i].path && is_standard_output(files[i].path)) {
            fprintf(stderr, "%s: %s and standard output are one file (expected two)\n", files[i].path,
                    files[i].option);
            return false;
        }
    }
    return true;
}
