/* The writer of outputs.txt: a new file beside it, renamed. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "outputs_internal.h"

#define TEMPORARY ".waferhand-"
/* Names that are tried: others may be writing beside it, or have been killed. */
#define ATTEMPTS 100

/* Room for the longest folder and ".waferhand-PID-N". */
typedef struct {
    char target[PATH_MAX];
    char temporary[PATH_MAX + 48];
    int folder; /* length of its name in target */
} names_t;

/* What is to be replaced: the path, or what it points to when it is a link. */
static int name_target(names_t *names, const char *path) {
    if (realpath(path, names->target) == NULL) {
        if (errno != ENOENT || strlen(path) >= sizeof names->target) {
            return errno == ENOENT ? ENAMETOOLONG : errno;
        }
        memcpy(names->target, path, strlen(path) + 1);
    }
    const char *const slash = strrchr(names->target, '/');
    names->folder = slash == NULL ? 0 : (int)(slash - names->target) + 1;
    return 0;
}

/* The permissions of the file that is there, or 0 when there is none; a device is not to be replaced. */
static int target_mode(const names_t *names, mode_t *mode) {
    struct stat status;
    *mode = 0;
    if (stat(names->target, &status) != 0) {
        return errno == ENOENT ? 0 : errno;
    }
    if (!S_ISREG(status.st_mode)) {
        return S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
    }
    *mode = status.st_mode & 0777;
    return 0;
}

/* Returns a descriptor, or -1 and errno. */
static int create_temporary(names_t *names) {
    for (int attempt = 0; attempt < ATTEMPTS; ++attempt) {
        (void)snprintf(names->temporary, sizeof names->temporary, "%.*s" TEMPORARY "%ld-%d", names->folder,
                       names->target, (long)getpid(), attempt);
        const int fd = open(names->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST) {
            return fd;
        }
    }
    return -1;
}

static int write_values(int fd, const int32_t *valves, size_t count) {
    char text[2 * WH_GRIPPERS];
    for (size_t i = 0; i < count; ++i) {
        text[2 * i] = valves[i] == WH_VALVE_OPEN ? '0' : '1';
        text[2 * i + 1] = '\n';
    }
    const ssize_t written = write(fd, text, 2 * count);
    if (written < 0) {
        return errno;
    }
    return (size_t)written == 2 * count ? 0 : ENOSPC;
}

/* Closes the descriptor in any case: a full disk may show only then. */
static int fill(int fd, mode_t mode, const int32_t *valves, size_t count) {
    int error = write_values(fd, valves, count);
    if (error == 0 && mode != 0 && fchmod(fd, mode) != 0) {
        error = errno;
    }
    if (close(fd) != 0 && error == 0) {
        error = errno;
    }
    return error;
}

static int replace(names_t *names, mode_t mode, const int32_t *valves, size_t count) {
    const int fd = create_temporary(names);
    if (fd < 0) {
        return errno;
    }
    int error = fill(fd, mode, valves, count);
    if (error == 0 && rename(names->temporary, names->target) != 0) {
        error = errno;
    }
    if (error != 0) {
        (void)unlink(names->temporary);
    }
    return error;
}

int wh_outputs_write(const char *path, const int32_t *valves, size_t count) {
    names_t names;
    mode_t mode = 0;
    int error = wh_outputs_refuse(path, valves, count);
    if (error == 0) {
        error = name_target(&names, path);
    }
    if (error == 0) {
        error = target_mode(&names, &mode);
    }
    return error != 0 ? error : replace(&names, mode, valves, count);
}
