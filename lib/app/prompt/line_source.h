/* Within the prompt: where its lines come from. Two kinds: a terminal, with libedit, and anything else. */
#ifndef WH_APP_PROMPT_LINE_SOURCE_H
#define WH_APP_PROMPT_LINE_SOURCE_H

#include "../input.h"

typedef enum {
    WH_LINE_READ,   /* a line */
    WH_LINE_NONE,   /* it was given up */
    WH_LINE_END,    /* the input has ended */
    WH_LINE_LEAVING /* a signal or a watch ended the prompt */
} wh_line_event_t;

/* ---- plain.c: bytes, whatever they are ---- */
typedef struct {
    wh_input_t *input;
    char buffer[4096];
    size_t begin, end;
    char line[WH_SESSION_LINE_BYTES + 2]; /* one more than a session takes: it then says so */
} wh_plain_t;

/* The next line, in plain->line: without its end, cut when too long, a byte 0 replaced by 1, which is refused too. */
wh_line_event_t wh_plain_read(wh_plain_t *plain);

/* ---- editor.c: libedit ---- */
typedef struct wh_editor wh_editor_t;

/* On standard input and output; null when libedit will not have them. */
wh_editor_t *wh_editor_open(wh_input_t *input, wh_session_t *session);

/* The next line, without its end; it lives until the next call. */
wh_line_event_t wh_editor_read(wh_editor_t *editor, const char **line);

/* Prints a text above the line that is being edited. */
void wh_editor_say(wh_editor_t *editor, const char *text);

void wh_editor_close(wh_editor_t *editor);

#endif
