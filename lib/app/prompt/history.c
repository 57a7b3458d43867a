#include "history.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../../mcs/session.h"
#include "../../text/array.h"
#include "../../text/output.h"

/* ------------------------------------------------------------------------------------------------ reading */

/* The file's text, to be freed, or null. */
static char *read_text(const char *path) {
    struct stat about;
    char *text = NULL;
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd >= 0 && fstat(fd, &about) == 0 && S_ISREG(about.st_mode)) {
        /* Only the end of a long file is read. */
        const off_t skipped = about.st_size > WH_HISTORY_BYTES ? about.st_size - WH_HISTORY_BYTES : 0;
        text = wh_array_new(WH_HISTORY_BYTES + 1, 1);
        const ssize_t bytes = pread(fd, text, WH_HISTORY_BYTES, skipped);
        text[bytes > 0 ? bytes : 0] = '\0';
    }
    if (fd >= 0) {
        close(fd);
    }
    return text;
}

static bool is_typed_line(const char *line) {
    const size_t length = strlen(line);
    for (size_t i = 0; i < length; ++i) {
        const unsigned char byte = (unsigned char)line[i];
        if (byte < 0x20 || byte == 0x7F) {
            return false;
        }
    }
    return length > 0 && length <= WH_SESSION_LINE_BYTES;
}

/* Puts the last lines of the text into a ring; returns how many there were. */
static size_t gather(char *text, const char *lines[WH_HISTORY_LINES]) {
    size_t count = 0;
    char *rest = text;
    for (char *line = strsep(&rest, "\n"); line; line = strsep(&rest, "\n")) {
        if (is_typed_line(line)) {
            lines[count++ % WH_HISTORY_LINES] = line;
        }
    }
    return count;
}

/* ------------------------------------------------------------------------------------------------ writing */

/* Replaces the file by these lines, as a whole. */
static void rewrite(const char *path, const char *const lines[], size_t first, size_t count) {
    wh_output_t output = {0};
    if (!wh_output_open(&output, path)) {
        return;
    }
    for (size_t i = first; i < count; ++i) {
        fprintf(output.file, "%s\n", lines[i % WH_HISTORY_LINES]);
    }
    (void)wh_output_commit(&output);
}

void wh_history_load(const char *path, void (*line)(void *user, const char *text), void *user) {
    const char *lines[WH_HISTORY_LINES];
    char *text = path[0] ? read_text(path) : NULL;
    if (!text) {
        return;
    }
    const bool is_long = strlen(text) == WH_HISTORY_BYTES;
    const size_t count = gather(text, lines);
    const size_t first = count > WH_HISTORY_LINES ? count - WH_HISTORY_LINES : 0;
    for (size_t i = first; i < count; ++i) {
        line(user, lines[i % WH_HISTORY_LINES]);
    }
    if (count >= (size_t)2 * WH_HISTORY_LINES || is_long) {
        rewrite(path, lines, first, count);
    }
    free(text);
}

void wh_history_append(const char *path, const char *line) {
    static const int how = O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK;
    char text[WH_SESSION_LINE_BYTES + 2];
    if (!path[0] || !is_typed_line(line)) {
        return;
    }
    int fd = open(path, how, 0600);
    if (fd < 0 && wh_output_make_folders(path)) {
        fd = open(path, how, 0600);
    }
    if (fd >= 0) {
        const int length = snprintf(text, sizeof text, "%s\n", line);
        const ssize_t written = write(fd, text, (size_t)length);
        (void)written;
        close(fd);
    }
}
