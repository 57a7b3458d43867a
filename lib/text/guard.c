#include "guard.h"

#include <errno.h>
#include <stdbool.h>
#include <unistd.h>

#include "utf8.h"

static FILE *terminal;

/* Writes all of it to standard error. Returns false if that fails. */
static bool write_all(const char *text, size_t size) {
    while (size > 0) {
        const ssize_t written = write(STDERR_FILENO, text, size);
        if (written <= 0 && errno != EINTR) {
            return false;
        }
        text += written > 0 ? written : 0;
        size -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

static ssize_t write_visible(void *cookie, const char *text, size_t size) {
    char piece[WH_UTF8_PIECE];
    size_t length = 0;
    (void)cookie;
    for (size_t done = 0; done < size;) {
        done += wh_utf8_piece(text + done, size - done, piece, &length);
        if (!write_all(piece, length)) {
            return 0;
        }
    }
    return (ssize_t)size;
}

void wh_guard_stderr(void) {
    FILE *guarded = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_visible});
    if (guarded) {
        (void)setvbuf(guarded, NULL, _IONBF, 0);
        terminal = stderr;
        stderr = guarded;
    }
}

FILE *wh_guard_terminal(void) {
    return terminal ? terminal : stderr;
}
