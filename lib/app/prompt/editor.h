/* Lines from a terminal, edited by libedit: history, completion of the word before the cursor. */
#ifndef WH_APP_PROMPT_EDITOR_H
#define WH_APP_PROMPT_EDITOR_H

#include "input.h"

typedef enum {
    WH_LINE_READ,   /* a line */
    WH_LINE_NONE,   /* it was given up */
    WH_LINE_END,    /* the input has ended */
    WH_LINE_LEAVING /* a signal or a watch ended the prompt */
} wh_line_event_t;

typedef struct wh_editor wh_editor_t;

/* On standard input and output; null if libedit refuses them. */
wh_editor_t *wh_editor_open(const wh_input_t *input);

/* The next line, without its end; it lives until the next call. */
wh_line_event_t wh_editor_read(wh_editor_t *editor, const char **line);

/* Prints a line on standard error. While a line is being typed and both are on the terminal, the line comes
 * in its place, and what is typed is drawn again below. */
void wh_editor_say(wh_editor_t *editor, const char *line);

void wh_editor_close(wh_editor_t *editor);

#endif
