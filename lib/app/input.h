/* Where the prompt waits: for standard input, for signals, and for the descriptors of others. */
#ifndef WH_APP_INPUT_H
#define WH_APP_INPUT_H

#include <stdbool.h>
#include <stddef.h>

#include "prompt/prompt.h"

/* Zero it to begin with. */
typedef struct {
    wh_prompt_watch_t watches[WH_PROMPT_WATCHES];
    size_t watch_count;
    wh_session_t *session; /* whose commands the watches may execute, and signals then stop */
    bool leaving;          /* set by a watch: the wait is to end */
} wh_input_t;

typedef enum {
    WH_INPUT_READY,  /* a read will not block: bytes, the end, or an error */
    WH_INPUT_SIGNAL, /* a held signal has arrived: take it */
    WH_INPUT_LEAVE,  /* `leaving` was set */
    WH_INPUT_BROKEN  /* waiting is not possible: errno says why */
} wh_input_event_t;

/* Waits, and meanwhile calls the watches whose descriptors are ready. */
wh_input_event_t wh_input_wait(wh_input_t *input);

#endif
