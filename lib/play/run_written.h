/* The files of a run: its document as text, and the page and the scene that are made of it. */
#ifndef WH_PLAY_RUN_WRITTEN_H
#define WH_PLAY_RUN_WRITTEN_H

#include "../mcs/script_run.h"
#include "../report/document.h"
#include "../report/page.h"

typedef struct {
    wh_document_t document;
    char *text; /* the document's */
    size_t size;
    char *command;                       /* that makes the run again */
    const char *cell, *engine;           /* what its page plays again by (reel.h); null: it does not */
    char message[WH_PAGE_MESSAGE_BYTES]; /* why a page was not written; empty: errno says it */
} wh_run_written_t;

/* Makes the text of a document that has source, record, signals and notes; they must outlive it. `run` gives
 * script, parameters and errors, `subcommand` plays it again. Ends the program if out of memory. */
void wh_run_written_open(wh_run_written_t *written, const wh_document_t *document,
                         const wh_script_run_options_t *run, const char *subcommand);
void wh_run_written_close(wh_run_written_t *written);

/* Each writes one file; `user` is a wh_run_written_t. False if `out` did not take it, or for the reason in
 * `message`: the page of a report or of a flow; the scene in motion as glTF; the document. */
bool wh_run_written_page(void *user, FILE *out);
bool wh_run_written_scene(void *user, FILE *out);
bool wh_run_written_document(void *user, FILE *out);

#endif
