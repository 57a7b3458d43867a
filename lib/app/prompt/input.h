/* The prompt's waits: for standard input, for signals, and for the watch.
 *
 * While a prompt is open, signals arrive only where it waits and while a command runs, so that none is missed
 * between a look and a wait. It holds SIGINT, SIGTERM, SIGHUP, and for a terminal SIGTSTP and SIGWINCH. A
 * signal that was ignored when the program began stays ignored; one that its caller had blocked (for a
 * signalfd) stays blocked. During a command the first three stop it, the others wait. One thread, one prompt:
 * signals are held for the whole process.
 */
#ifndef WH_APP_PROMPT_INPUT_H
#define WH_APP_PROMPT_INPUT_H

#include "prompt.h"

typedef struct {
    wh_prompt_watch_t watch;
    wh_session_t *session; /* whose commands the watch may execute, and signals then stop */
} wh_input_t;

typedef enum {
    WH_INPUT_READY,  /* a read will not block: bytes, the end, or an error */
    WH_INPUT_SIGNAL, /* a held signal has arrived: take it */
    WH_INPUT_BROKEN  /* waiting is not possible: errno says why */
} wh_input_event_t;

/* Waits, and serves the watch each time that it wakes. */
wh_input_event_t wh_input_wait(const wh_input_t *input);

/* ------------------------------------------------------------------------------------------------ signals */

/* Holds signals until wh_interrupt_release. */
void wh_interrupt_hold(bool terminal);

/* Restores handlers and mask. */
void wh_interrupt_release(void);

/* Takes one of the signals that have arrived. Returns 0 if there is none. */
int wh_interrupt_take(void);

/* Tells the watch if such a signal has arrived. */
void wh_input_tell_stop(const wh_input_t *input);

/* True if SIGINT, SIGTERM or SIGHUP has arrived and was not taken yet. */
bool wh_interrupt_is_due(void);

/* Lets SIGINT, SIGTERM and SIGHUP in, to stop the session's command if one runs; null: holds them again. */
void wh_interrupt_stop_session(wh_session_t *session);

#endif
