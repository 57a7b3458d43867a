/* Reading a script or layout file: regular files only, and never more than a script can be. */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sandbox_internal.h"

static const char *kind_fault(const struct stat *status) {
    if (S_ISDIR(status->st_mode)) {
        return "cannot be read: it is a directory";
    }
    if (!S_ISREG(status->st_mode)) {
        return "cannot be read: it is no regular file";
    }
    if (status->st_size > (off_t)WH_SANDBOX_FILE_BYTES) {
        return "cannot be read: it is larger than 16 MiB";
    }
    return NULL;
}

static const char *errno_fault(void) {
    static __thread char text[128];
    snprintf(text, sizeof text, "cannot be read: %s", strerror(errno));
    return text;
}

/* A file may grow while it is read, and those under /proc have no size: reads until the end or one byte too
 * many. */
static const char *read_all(int file, char *text, size_t capacity, size_t *size) {
    *size = 0;
    while (*size < capacity) {
        const ssize_t got = read(file, text + *size, capacity - *size);
        if (got == 0) {
            return NULL;
        }
        if (got < 0 && errno != EINTR) {
            return errno_fault();
        }
        *size += got > 0 ? (size_t)got : 0;
    }
    return "cannot be read: it is larger than 16 MiB";
}

static const char *read_open(int file, char **text, size_t *size) {
    struct stat status;
    if (fstat(file, &status) != 0) {
        return errno_fault();
    }
    const char *fault = kind_fault(&status);
    if (fault != NULL) {
        return fault;
    }
    const size_t capacity = WH_SANDBOX_FILE_BYTES + 1;
    char *const whole = malloc(capacity);
    if (whole == NULL) {
        return "cannot be read: no memory";
    }
    fault = read_all(file, whole, capacity, size);
    if (fault != NULL) {
        free(whole);
        return fault;
    }
    *text = realloc(whole, *size + 1);
    if (*text == NULL) {
        *text = whole;
    }
    return NULL;
}

const char *wh_source_read(const char *path, char **text, size_t *size) {
    struct stat status;
    /* Looked at before it is opened: opening a device may move it. */
    if (stat(path, &status) != 0) {
        return errno_fault();
    }
    const char *fault = kind_fault(&status);
    if (fault != NULL) {
        return fault;
    }
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (file < 0) {
        return errno_fault();
    }
    fault = read_open(file, text, size);
    close(file);
    return fault;
}

const char *wh_source_begin(const char *text, size_t *size) {
    if (*size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
        text += 3;
        *size -= 3;
    }
    if (*size > 0 && text[0] == '#') {
        const char *const line_break = memchr(text, '\n', *size);
        const size_t skipped = line_break != NULL ? (size_t)(line_break - text) : *size;
        text += skipped;
        *size -= skipped;
    }
    return text;
}
