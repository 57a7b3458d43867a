/* The prompt: lines of an operator from standard input, executed in a session, answered on standard output.
 *
 * Where both are terminals, lines are edited: history, completion by TAB, Ctrl-C gives up a line or stops a
 * command, Ctrl-D or QUIT leaves. Else it is plain: one answer for each line, written at once, without a
 * prompt; blank lines and those that begin with # are passed over. Either way it serves a watch while it
 * waits.
 *
 *     wh_prompt_t *prompt = wh_prompt_open(&session, &lcm);
 *     status = wh_prompt_run(prompt);
 *     wh_prompt_close(prompt);
 */
#ifndef WH_APP_PROMPT_PROMPT_H
#define WH_APP_PROMPT_PROMPT_H

#include <stdbool.h>

#include "../../mcs/session.h"

/* A watch that the prompt serves besides the input, such as LCM. While the prompt waits for input, and never
 * during a command, it calls `look` whenever it wakes: when `fd` or `other` (-1: none) can be read or has
 * failed, when there is input, and at least every 100 ms. `look` must read them, or it is called again at
 * once. It may execute commands of the session; signals stop them like those of the prompt. `stop` is called
 * when a signal has come during a command or a look: waiting work must then not begin. */
typedef struct {
    int fd, other;
    void (*look)(void *user);
    void (*stop)(void *user);
    void *user;
} wh_prompt_watch_t;

typedef struct wh_prompt wh_prompt_t;

/* For a session that outlives it. One at a time in a process. */
wh_prompt_t *wh_prompt_open(wh_session_t *session, const wh_prompt_watch_t *watch);

/* Runs until the input ends or the operator leaves it. Returns the exit status: 0, or in plain mode 1 when a
 * command failed or is left held, or the cell complained, 1 when a signal ended it, 2 when the answers could
 * not be written. */
int wh_prompt_run(wh_prompt_t *prompt);

/* Prints a line from elsewhere on standard error: at a terminal above the line that is being typed, which is
 * drawn again. */
void wh_prompt_say(wh_prompt_t *prompt, const char *line);

/* Leaves the terminal and the signals as they were. Null is allowed. */
void wh_prompt_close(wh_prompt_t *prompt);

#endif
