/* The prompt: lines of an operator from standard input, executed in a session, answered on standard output.
 *
 * Where both are terminals, lines are edited: history, completion by TAB, Ctrl-C gives up a line or stops a
 * command, Ctrl-D or QUIT leaves. Else it is plain: one answer for each line, written at once, without a
 * prompt; blank lines and those that begin with # are passed over. Either way other descriptors are looked
 * after while it waits.
 *
 *     wh_prompt_t *prompt = wh_prompt_open(&session);
 *     wh_prompt_watch(prompt, &lcm);
 *     status = wh_prompt_run(prompt);
 *     wh_prompt_close(prompt);
 */
#ifndef WH_APP_PROMPT_PROMPT_H
#define WH_APP_PROMPT_PROMPT_H

#include <stdbool.h>

#include "../../mcs/session.h"

#define WH_PROMPT_WATCHES 8

/* A descriptor that is none of the prompt's: LCM's, a timer's, a signalfd. `ready` is called when it can be
 * read or has failed, while the prompt waits for input and never during a command; it must read it, or it is
 * called again at once. It may execute commands of the session, which signals stop like those of the
 * prompt. */
typedef struct {
    int fd;
    void (*ready)(void *user);
    void *user;
} wh_prompt_watch_t;

typedef struct wh_prompt wh_prompt_t;

/* For a session that outlives it; null when there is no memory. One at a time in a process. */
wh_prompt_t *wh_prompt_open(wh_session_t *session);

/* Looks after one more descriptor; false when there are WH_PROMPT_WATCHES already. */
bool wh_prompt_watch(wh_prompt_t *prompt, const wh_prompt_watch_t *watch);

/* Until the input ends or is left. Returns the exit status: 0, or in plain mode 1 when a command failed or
 * the cell complained, 1 when a signal ended it, 2 when the answers could not be written. */
int wh_prompt_run(wh_prompt_t *prompt);

/* Prints a line of text above the line that is being edited; in plain mode on standard error. For watches. */
void wh_prompt_say(wh_prompt_t *prompt, const char *text);

/* Ends wh_prompt_run as a signal does, at the latest when the running command has ended. For watches. */
void wh_prompt_leave(wh_prompt_t *prompt);

/* Leaves the terminal and the signals as they were. Null is allowed. */
void wh_prompt_close(wh_prompt_t *prompt);

#endif
