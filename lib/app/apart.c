#include "apart.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../text/output.h"

/* Output to the null device is lost in any case. */
static bool is_null_device(const struct stat *one) {
    struct stat null;
    return stat("/dev/null", &null) == 0 && S_ISCHR(one->st_mode) && one->st_rdev == null.st_rdev;
}

static bool is_same_file(const char *a, const char *b) {
    struct stat one;
    char first[PATH_MAX];
    char second[PATH_MAX];
    if (stat(a, &one) == 0) {
        return !is_null_device(&one) && wh_output_is_one_file(a, b);
    }
    return stat(b, &one) != 0 && wh_output_resolve(a, first) && wh_output_resolve(b, second) &&
           strcmp(first, second) == 0;
}

/* An input that is a pipe or a terminal is only the other end of it. */
static bool is_standard_output(const wh_named_file_t *file) {
    struct stat one;
    struct stat two;
    return stat(file->path, &one) == 0 && fstat(STDOUT_FILENO, &two) == 0 && !is_null_device(&one) &&
           (file->is_output || S_ISREG(one.st_mode)) && one.st_dev == two.st_dev && one.st_ino == two.st_ino;
}

static bool is_open(const struct stat *status, int fd) {
    struct stat there;
    return fstat(fd, &there) == 0 && there.st_dev == status->st_dev && there.st_ino == status->st_ino;
}

/* Opening a pipe waits for a reader. A pipe that a shell hands over as /dev/fd/N has no name in a folder, and
 * is open already, like standard output. */
static bool waits_for_reader(const char *path) {
    struct stat status;
    char whole[PATH_MAX];
    return stat(path, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode)) &&
           !is_open(&status, STDOUT_FILENO) && !is_open(&status, STDERR_FILENO) && realpath(path, whole);
}

static bool is_writable_kind(const wh_named_file_t *file) {
    const bool waits = file->path && file->is_output && waits_for_reader(file->path);
    if (waits) {
        fprintf(stderr, "%s %s: it is a pipe or a socket (expected a regular file)\n", file->option,
                file->path);
    }
    return !waits;
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
        if (!is_writable_kind(&files[i])) {
            return false;
        }
        if (prints && files[i].path && is_standard_output(&files[i])) {
            fprintf(stderr, "%s: %s and standard output are one file (expected two)\n", files[i].path,
                    files[i].option);
            return false;
        }
    }
    return true;
}

/* True if a recording goes into it, this process's or another's. */
static bool is_recorded(const char *path) {
    struct stat status;
    const bool plain = stat(path, &status) == 0 && S_ISREG(status.st_mode);
    const int fd = plain ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    const bool locked = fd >= 0 && flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0) {
        (void)close(fd);
    }
    return locked;
}

bool wh_file_is_free(const char *option, const char *path) {
    const bool kept = wh_output_is_kept(path);
    const bool is_free = !kept && !is_recorded(path);
    if (!is_free) {
        fprintf(stderr, "%s %s: not written: %s\n", option, path,
                kept ? WH_OUTPUT_KEPT : "a recording goes into it (expected a file of its own)");
    }
    return is_free;
}

bool wh_file_is_writable(const char *option, const char *path) {
    struct stat status;
    wh_output_t output = {0};
    const bool is_special = stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
    if (!wh_file_is_free(option, path)) {
        return false;
    }
    const bool opened = is_special || wh_output_open(&output, path);
    if (!opened) {
        wh_output_tell(option, path, errno);
    }
    wh_output_drop(&output);
    return opened;
}

bool wh_file_write(const char *option, const char *path, bool (*write)(void *user, FILE *out), void *user,
                   const char *message) {
    wh_output_t output = {0};
    if (!path || !wh_file_is_free(option, path)) {
        return !path;
    }
    const bool written =
        wh_output_open(&output, path) && write(user, output.file) && wh_output_commit(&output);
    const int reason = errno;
    wh_output_drop(&output);
    if (!written && message && message[0] != '\0') {
        fprintf(stderr, "%s %s: not written: %s\n", option, path, message);
    } else if (!written) {
        wh_output_tell(option, path, reason);
    }
    wh_output_keep(path);
    return written;
}
