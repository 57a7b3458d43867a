#include "record_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include "../text/clock.h"
#include "../text/output.h"

/* The number of names that are tried. */
#define ATTEMPTS 10000

void wh_record_file_fail(wh_record_file_t *file, const char *path, const char *reason) {
    if (!file->failed) {
        fprintf(stderr, "%s: %s%s%s: %s%s\n", file->speaker, file->option ? file->option : "",
                file->option ? " " : "", path, reason, file->fd >= 0 ? " (the recording ends here)" : "");
    }
    file->failed = true;
}

/* -------------------------------------------------------------------------------------------------- names */

/* The place where the ending begins: ".log.zst" of "run.log.zst", ".log" of "run.log", the end of "run" or
 * ".run". */
static size_t find_ending(const char *path) {
    const char *slash = strrchr(path, '/');
    const size_t begin = slash ? (size_t)(slash - path) + 1 : 0;
    size_t end = strlen(path);
    if (end - begin > 4 && strcmp(path + end - 4, ".zst") == 0) {
        end -= 4;
    }
    for (size_t at = end; at > begin + 1; --at) {
        if (path[at - 1] == '.') {
            return at - 1;
        }
    }
    return end;
}

bool wh_record_file_name(const char *path, const char *tag, char name[PATH_MAX]) {
    const size_t ending = find_ending(path);
    const int length = snprintf(name, PATH_MAX, "%.*s.%s%s", (int)ending, path, tag, path + ending);
    return length > 0 && length < PATH_MAX;
}

/* ------------------------------------------------------------------------------------------------ opening */

/* Begins with an open file. */
static bool begin_file(wh_record_file_t *file, const char *path, int fd) {
    struct stat status;
    const size_t length = strlen(path);
    file->fd = fd;
    file->written = 0;
    file->frame_bytes = 0;
    file->is_plain_file = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
    (void)snprintf(file->path, sizeof file->path, "%s", path);
    if (file->is_plain_file) {
        /* No other process has it yet. */
        (void)flock(fd, LOCK_EX | LOCK_NB);
    }
    if (length > 4 && strcmp(path + length - 4, ".zst") == 0) {
        file->zstd = ZSTD_createCCtx();
        if (!file->zstd) {
            wh_record_file_fail(file, path, strerror(ENOMEM));
            return false;
        }
        (void)ZSTD_CCtx_setParameter(file->zstd, ZSTD_c_checksumFlag, 1);
    }
    return true;
}

static bool refuse_file(wh_record_file_t *file, const char *path, int error) {
    char text[200];
    snprintf(text, sizeof text, "%s (expected a file that can be written)", strerror(error));
    wh_record_file_fail(file, path, text);
    return false;
}

bool wh_record_file_has_parts(const char *path) {
    char second[PATH_MAX];
    struct stat status;
    return wh_record_file_name(path, "part2", second) && lstat(second, &status) == 0;
}

/* Returns a descriptor, or -1 and errno: EEXIST for a plain file that is there, or that has parts. */
static int open_new(const char *path) {
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        return open(path, O_WRONLY | O_APPEND | O_CLOEXEC);
    }
    if (wh_record_file_has_parts(path)) {
        errno = EEXIST;
        return -1;
    }
    return open(path, O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

bool wh_record_file_create(wh_record_file_t *file, const char *path) {
    char name[PATH_MAX];
    char tag[20];
    bool named = snprintf(name, sizeof name, "%s", path) < PATH_MAX;
    int fd = open_new(path);
    for (int i = 1; named && fd < 0 && errno == EEXIST && i < ATTEMPTS; ++i) {
        snprintf(tag, sizeof tag, "%d", i);
        named = wh_record_file_name(path, tag, name);
        fd = open_new(name);
    }
    if (!named || fd < 0) {
        return refuse_file(file, path, named ? errno : ENAMETOOLONG);
    }
    if (strcmp(name, path) != 0) {
        fprintf(stderr, "%s: %s%s is there already: recording into %s\n", file->speaker,
                wh_record_file_has_parts(path) ? "a part of " : "", path, name);
    }
    return begin_file(file, name, fd);
}

/* True if another recording writes this file. */
static bool is_locked(const char *path) {
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const bool locked = fd >= 0 && flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0) {
        (void)close(fd);
    }
    return locked;
}

/* Says in words what must not be replaced at this path; otherwise null. */
static const char *find_owner(const char *path) {
    struct stat old;
    if (stat(path, &old) != 0 || !S_ISREG(old.st_mode)) {
        return NULL;
    }
    if (wh_output_is_kept(path)) {
        return WH_OUTPUT_KEPT;
    }
    return is_locked(path) ? "another process records into it (expected another name)" : NULL;
}

bool wh_record_file_can_replace(wh_record_file_t *file, const char *path) {
    struct stat status;
    wh_output_t output = {0};
    const char *owner = find_owner(path);
    if (owner) {
        wh_record_file_fail(file, path, owner);
        return false;
    }
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        return true;
    }
    if (!wh_output_open(&output, path)) {
        return refuse_file(file, path, errno);
    }
    wh_output_drop(&output);
    return true;
}

bool wh_record_file_replace(wh_record_file_t *file, const char *path) {
    wh_output_t output = {0};
    const char *owner = find_owner(path);
    if (owner) {
        wh_record_file_fail(file, path, owner);
        return false;
    }
    if (!wh_output_open(&output, path)) {
        return refuse_file(file, path, errno);
    }
    /* The new file takes the place at once, so that the record is there also if this process is killed. */
    const int fd = fcntl(fileno(output.file), F_DUPFD_CLOEXEC, 0);
    const bool placed = fd >= 0 && fcntl(fd, F_SETFL, O_APPEND) == 0 && wh_output_commit(&output);
    if (!placed) {
        const int error = errno;
        wh_output_drop(&output);
        if (fd >= 0) {
            (void)close(fd);
        }
        return refuse_file(file, path, error);
    }
    return begin_file(file, path, fd);
}

/* ------------------------------------------------------------------------------------------------ writing */

/* Finds out whether other processes have removed or changed the file. */
static bool is_ours(wh_record_file_t *file) {
    struct stat status;
    if (!file->is_plain_file) {
        return true;
    }
    if (fstat(file->fd, &status) != 0) {
        wh_record_file_fail(file, file->path, strerror(errno));
    } else if (status.st_nlink == 0) {
        wh_record_file_fail(file, file->path, "No such file or directory: it was removed");
    } else if (status.st_size < file->written) {
        wh_record_file_fail(file, file->path, "Input/output error: it was truncated by another program");
    }
    return !file->failed;
}

static void write_all(wh_record_file_t *file, const uint8_t *bytes, size_t size) {
    while (size > 0 && !file->failed) {
        const ssize_t count = write(file->fd, bytes, size);
        if (count < 0 && errno != EINTR) {
            wh_record_file_fail(file, file->path, strerror(errno));
        } else if (count > 0) {
            bytes += count;
            size -= (size_t)count;
            file->written += count;
        }
    }
}

static void write_packed(wh_record_file_t *file, ZSTD_EndDirective directive) {
    ZSTD_inBuffer in = {file->buffer, file->used, 0};
    size_t left = 1;
    while (left > 0 && !file->failed) {
        ZSTD_outBuffer out = {file->packed, sizeof file->packed, 0};
        left = ZSTD_compressStream2(file->zstd, &out, &in, directive);
        if (ZSTD_isError(left)) {
            wh_record_file_fail(file, file->path, ZSTD_getErrorName(left));
        } else {
            write_all(file, file->packed, out.pos);
        }
    }
}

/* Packs the bytes that wait. With `ends`, or if it is large or old enough, the frame ends. */
static void pack(wh_record_file_t *file, bool ends) {
    const int64_t now = wh_clock_us(CLOCK_MONOTONIC);
    file->frame_us = file->frame_bytes == 0 ? now : file->frame_us;
    file->frame_bytes += file->used;
    const bool over =
        ends || file->frame_bytes >= WH_RECORD_FRAME_BYTES || now - file->frame_us >= WH_RECORD_FRAME_US;
    if (file->used > 0 || (over && file->frame_bytes > 0)) {
        write_packed(file, over ? ZSTD_e_end : ZSTD_e_flush);
        file->frame_bytes = over ? 0 : file->frame_bytes;
    }
}

/* Writes the bytes that wait into the file; with `ends` the frame ends. */
static void hand_over(wh_record_file_t *file, bool ends) {
    if (file->fd < 0) {
        return;
    }
    if (file->failed || !is_ours(file)) {
        file->used = 0;
        return;
    }
    if (file->zstd) {
        pack(file, ends);
    } else {
        write_all(file, file->buffer, file->used);
    }
    file->used = 0;
}

void wh_record_file_flush(wh_record_file_t *file) {
    hand_over(file, false);
}

bool wh_record_file_put(wh_record_file_t *file, const void *bytes, size_t size) {
    if (file->failed) {
        return true;
    }
    if (size > sizeof file->buffer - file->used) {
        if (file->fd < 0) {
            return false;
        }
        hand_over(file, false);
    }
    memcpy(file->buffer + file->used, bytes, size);
    file->used += size;
    return true;
}

bool wh_record_file_close(wh_record_file_t *file) {
    if (file->fd < 0) {
        return !file->failed;
    }
    hand_over(file, true);
    if (close(file->fd) != 0) {
        wh_record_file_fail(file, file->path, strerror(errno));
    }
    (void)ZSTD_freeCCtx(file->zstd);
    file->zstd = NULL;
    file->fd = -1;
    wh_output_keep(file->path);
    file->used = 0;
    return !file->failed;
}
