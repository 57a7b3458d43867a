/* Completion at the prompt, as libedit wants it. */
#ifndef WH_APP_PROMPT_COMPLETE_H
#define WH_APP_PROMPT_COMPLETE_H

#include <stdio.h>

#include <histedit.h>

#include "../../mcs/session.h"

/* Completes the word before the cursor as far as all candidates agree, the only one with a blank behind it; where they
 * agree no further, lists them below the line. Returns what an editor function returns to libedit. */
unsigned char wh_prompt_complete(EditLine *edit, wh_session_t *session);

#endif
