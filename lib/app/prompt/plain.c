/* Lines from a pipe or a file. */
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "../interrupt.h"
#include "line_source.h"

/* NONE: there was nothing to read after all. */
static wh_line_event_t read_bytes(wh_plain_t *plain) {
    const ssize_t bytes = read(STDIN_FILENO, plain->buffer, sizeof plain->buffer);
    plain->begin = 0;
    plain->end = bytes > 0 ? (size_t)bytes : 0;
    if (bytes > 0) {
        return WH_LINE_READ;
    }
    return bytes < 0 && (errno == EINTR || errno == EAGAIN) ? WH_LINE_NONE : WH_LINE_END;
}

/* Fills the empty buffer. */
static wh_line_event_t fill(wh_plain_t *plain) {
    wh_line_event_t line = WH_LINE_NONE;
    while (line == WH_LINE_NONE) {
        const wh_input_event_t event = wh_input_wait(plain->input);
        if (event == WH_INPUT_LEAVE || (event == WH_INPUT_SIGNAL && wh_interrupt_take() != 0)) {
            line = WH_LINE_LEAVING;
        } else if (event == WH_INPUT_BROKEN) {
            line = WH_LINE_END;
        } else if (event == WH_INPUT_READY) {
            line = read_bytes(plain);
        }
    }
    return line;
}

static wh_line_event_t finish(wh_plain_t *plain, size_t length) {
    if (length > 0 && length <= WH_SESSION_LINE_BYTES && plain->line[length - 1] == '\r') {
        --length;
    }
    plain->line[length] = '\0';
    return WH_LINE_READ;
}

wh_line_event_t wh_plain_read(wh_plain_t *plain) {
    size_t length = 0;
    for (bool any = false;; any = true) {
        if (plain->begin == plain->end) {
            const wh_line_event_t event = fill(plain);
            if (event != WH_LINE_READ) {
                return event == WH_LINE_END && any ? finish(plain, length) : event;
            }
        }
        const char byte = plain->buffer[plain->begin++];
        if (byte == '\n') {
            return finish(plain, length);
        }
        if (length <= WH_SESSION_LINE_BYTES) {
            plain->line[length++] = byte != '\0' ? byte : '\1';
        }
    }
}
