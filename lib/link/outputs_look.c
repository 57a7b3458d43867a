/* One look at the file: what is there, and what it says. */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include "outputs_internal.h"

static wh_outputs_look_t failed(int error) {
    wh_outputs_look_t look = {.condition = WH_OUTPUTS_UNREADABLE, .error = error};
    if (error == ENOENT || error == ENOTDIR) {
        look.condition = WH_OUTPUTS_MISSING;
    }
    return look;
}

static wh_outputs_look_t no_file(mode_t mode) {
    wh_outputs_look_t look = {.condition = WH_OUTPUTS_NO_FILE, .folder = S_ISDIR(mode)};
    return look;
}

/* Linux lets a write change what a read is copying, so that one read can be of two moments: what it says counts when a second
 * read finds the same. Where a read returns less than there is, the file is short. */
static wh_outputs_look_t read_values(const wh_outputs_t *outputs, int fd, int32_t *valves) {
    const wh_outputs_look_t caught_in_the_act = {.condition = WH_OUTPUTS_EMPTY};
    char text[WH_OUTPUTS_BYTES + 1];
    char again[WH_OUTPUTS_BYTES + 1];
    const ssize_t size = pread(fd, text, sizeof text, 0);
    if (size < 0) {
        return failed(errno);
    }
    const bool same = pread(fd, again, sizeof again, 0) == size && memcmp(text, again, (size_t)size) == 0;
    return same ? wh_outputs_parse(text, (size_t)size, outputs->count, valves) : caught_in_the_act;
}

/* The path may have become a fifo since it was examined, hence O_NONBLOCK and another examination. */
static wh_outputs_look_t look_into(const wh_outputs_t *outputs, int32_t *valves, struct stat *status) {
    const int fd = open(outputs->path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0) {
        return failed(errno);
    }
    wh_outputs_look_t look;
    if (fstat(fd, status) != 0) {
        look = failed(errno);
    } else if (!S_ISREG(status->st_mode)) {
        look = no_file(status->st_mode);
    } else {
        look = read_values(outputs, fd, valves);
    }
    (void)close(fd);
    return look;
}

/* stat, noting whether the path itself is a symbolic link. */
static int examine(wh_outputs_t *outputs, struct stat *status) {
    int result = lstat(outputs->path, status);
    outputs->linked = result == 0 && S_ISLNK(status->st_mode);
    if (outputs->linked) {
        result = stat(outputs->path, status);
    }
    if (result != 0) {
        const int error = errno;
        memset(status, 0, sizeof *status);
        return error;
    }
    return 0;
}

wh_outputs_look_t wh_outputs_look(wh_outputs_t *outputs, int32_t *valves, struct stat *status) {
    const int error = examine(outputs, status);
    if (error != 0) {
        return failed(error);
    }
    if (!S_ISREG(status->st_mode)) {
        return no_file(status->st_mode);
    }
    return look_into(outputs, valves, status);
}
