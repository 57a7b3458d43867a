/* The document of a script's run, and the command that makes the run again. */
#ifndef WH_PLAY_RUN_DOCUMENT_H
#define WH_PLAY_RUN_DOCUMENT_H

#include "../mcs/script_run.h"
#include "../report/document.h"

/* Fills the signals with each slice that motion control has played, and marks where a run begins anew. */
wh_mcs_listener_t wh_run_listener(wh_signals_t *signals);

/* Makes the document of a run that has ended: its source, record and signals. `signals` are those of
 * wh_run_listener, and are finished. A flow by times alone has a document without signals. False, and the
 * reason in `message`, if there is nothing to show. */
bool wh_run_document(const wh_script_run_t *run, const char *script, wh_signals_t *signals,
                     wh_document_t *document, char message[WH_SANDBOX_MESSAGE_BYTES]);

/* The command that makes the run again, to be freed: "waferhand run SCRIPT --set NAME=VALUE" with this
 * subcommand. Ends the program if out of memory. */
char *wh_run_command(const char *subcommand, const wh_script_run_options_t *run);

#endif
