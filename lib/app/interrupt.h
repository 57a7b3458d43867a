/* Signals while a prompt is open: they arrive only where it waits and while a command runs, so none is missed
 * between a look and a wait.
 *
 * Held are SIGINT, SIGTERM, SIGHUP, and for a terminal SIGTSTP and SIGWINCH; one that was ignored when the
 * program began stays ignored, one that its caller had blocked (for a signalfd) stays blocked. During a
 * command the first three stop it, the others wait. One thread, one prompt: the state is the process's.
 */
#ifndef WH_APP_INTERRUPT_H
#define WH_APP_INTERRUPT_H

#include <signal.h>
#include <stdbool.h>

#include "../mcs/session.h"

/* From here on signals are held; until wh_interrupt_release. */
void wh_interrupt_hold(bool terminal);

/* Handlers and mask as they were before. */
void wh_interrupt_release(void);

/* The mask to wait with: ppoll then returns with EINTR when a held signal arrives. */
const sigset_t *wh_interrupt_waiting(void);

/* Whether a signal has arrived and was not yet taken. */
bool wh_interrupt_pending(void);

/* A signal that has arrived and was not yet taken, 0 if there is none. */
int wh_interrupt_take(void);

/* Lets SIGINT, SIGTERM and SIGHUP in, to stop the session's command if one runs; null: holds them again. */
void wh_interrupt_stop_session(wh_session_t *session);

#endif
