/* The files that a run is written to, and their options: those of `report`, `run`, `mcs` and `study --trial`
 * alike. */
#ifndef WH_APP_RUN_FILES_H
#define WH_APP_RUN_FILES_H

#include "../mcs/mcs.h"
#include "../report/document.h"
#include "../text/options.h"

/* Zero it to begin with: null paths are not wanted. */
typedef struct {
    const char *page, *scene, *document;
    const char *plots; /* a folder */
} wh_run_files_t;

/* --report, --gltf, --data and --svg, into a wh_run_files_t. */
extern const wh_option_t wh_run_files_options[];

/* True if any is wanted. */
bool wh_run_files_wanted(const wh_run_files_t *files);

/* Returns the listener that collects a run for them. `signals` are zero before the run and must outlive
 * it. */
wh_mcs_listener_t wh_run_files_listener(wh_signals_t *signals);

/* The command that makes the run again, to be freed: "waferhand run SCRIPT --set NAME=VALUE", or "replay" and
 * a log. */
char *wh_run_files_command(const char *command, const char *file, const char *const parameters[],
                           size_t count);

/* Writes those that are wanted, from a document that lacks only `run`, which is made of the record. Each file
 * is there whole or as it was. False, with a line on standard error, if one cannot be written. */
bool wh_run_files_write(const wh_run_files_t *files, const wh_document_t *document);

#endif
