#include "replace.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Names that are tried: others may be writing beside it, or have been killed. */
#define ATTEMPTS 100

/* The file to replace: the path, or what it points to. Its permissions go to `mode`, 0 if there is none. */
static int find_target(const char *path, char target[PATH_MAX], mode_t *mode) {
    struct stat status;
    *mode = 0;
    if (realpath(path, target) == NULL) {
        (void)snprintf(target, PATH_MAX, "%s", path);
        return errno == ENOENT ? 0 : errno;
    }
    if (stat(target, &status) != 0) {
        return errno;
    }
    *mode = status.st_mode & 0777;
    if (S_ISDIR(status.st_mode)) {
        return EISDIR;
    }
    return S_ISREG(status.st_mode) ? 0 : EINVAL;
}

/* Returns a descriptor, or -1 and errno. */
static int create_beside(const char *target, char *beside, size_t size) {
    const char *const slash = strrchr(target, '/');
    const int folder = slash == NULL ? 0 : (int)(slash - target) + 1;
    int fd = -1;
    for (int i = 0; fd < 0 && i < ATTEMPTS && (i == 0 || errno == EEXIST); ++i) {
        (void)snprintf(beside, size, "%.*s.waferhand-%ld-%d", folder, target, (long)getpid(), i);
        fd = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    return fd;
}

/* True, or errno says why not: of a disk that is full it may be close that fails. */
static bool fill(int fd, mode_t mode, const void *bytes, size_t size) {
    errno = ENOSPC;
    const bool filled = write(fd, bytes, size) == (ssize_t)size && (mode == 0 || fchmod(fd, mode) == 0);
    const int error = errno;
    const bool closed = close(fd) == 0;
    errno = filled ? errno : error;
    return filled && closed;
}

int wh_replace(const char *path, const void *bytes, size_t size) {
    char target[PATH_MAX], beside[PATH_MAX + 48];
    mode_t mode;
    int error = find_target(path, target, &mode);
    if (error != 0) {
        return error;
    }
    const int fd = create_beside(target, beside, sizeof beside);
    if (fd < 0) {
        return errno;
    }
    if (fill(fd, mode, bytes, size) && rename(beside, target) == 0) {
        return 0;
    }
    error = errno;
    (void)unlink(beside);
    return error;
}
