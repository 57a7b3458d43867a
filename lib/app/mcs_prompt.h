/* The prompt of `waferhand mcs --layout`: an operator's lines from standard input, from WAFERHAND_REQUEST and
 * from a live page, one at a time. */
#ifndef WH_APP_MCS_PROMPT_H
#define WH_APP_MCS_PROMPT_H

#include "../mcs/session.h"
#include "connection.h"
#include "live.h"

/* Zero it to begin with. Must not be moved once it is open. */
typedef struct {
    wh_mcs_link_t *link;
    wh_live_t *live; /* its page; null: none */
    wh_session_t session;
} wh_mcs_prompt_t;

/* Opens the session, whose partners and listener are set here. False, with the reason in its message. */
bool wh_mcs_prompt_open(wh_mcs_prompt_t *prompt, wh_session_options_t *wanted);

/* Takes lines until the input ends. Returns the exit status. */
int wh_mcs_prompt_run(wh_mcs_prompt_t *prompt);

#endif
