/* Lines of a live page on their way to the thread that executes them.
 *
 * The page's thread puts them in, and the other takes them out, the oldest first. Neither waits for the
 * other. It ends the program if out of memory.
 */
#ifndef WH_APP_LIVE_LINES_H
#define WH_APP_LIVE_LINES_H

#include <stdbool.h>
#include <stdint.h>

/* The longest line, and the most that may wait. */
#define WH_LIVE_LINE_BYTES 1000
#define WH_LIVE_LINES 16

typedef struct wh_live_line {
    struct wh_live_line *next;
    int64_t number;
    bool completes; /* the text up to the cursor: it is to be completed, not executed */
    char text[WH_LIVE_LINE_BYTES + 1];
} wh_live_line_t;

typedef struct {
    wh_live_line_t *newest; /* atomic */
    wh_live_line_t *taken;  /* the taking side's, the oldest first */
    unsigned waiting;       /* atomic */
    int wake;               /* can be read when a line has come */
} wh_live_lines_t;

/* False, with the reason in errno: the system has no descriptor left. */
bool wh_live_lines_open(wh_live_lines_t *lines);

/* The page's thread: false if too many wait. `text` has at most WH_LIVE_LINE_BYTES. */
bool wh_live_lines_put(wh_live_lines_t *lines, int64_t number, bool completes, const char *text);

/* The other thread: true if a line waits; and takes one, false: there is none. */
bool wh_live_lines_wait(const wh_live_lines_t *lines);
bool wh_live_lines_take(wh_live_lines_t *lines, wh_live_line_t *line);

/* Neither side may be at work. */
void wh_live_lines_close(wh_live_lines_t *lines);

#endif
