/* The files that a report is written to, and their options: those of `report`, `run` and `mcs` alike. */
#ifndef WH_APP_REPORT_FILES_H
#define WH_APP_REPORT_FILES_H

#include <argp.h>

#include "../mcs/mcs.h"
#include "../report/document.h"

/* Zero it to begin with: null paths are not wanted. */
typedef struct {
    const char *page, *scene, *document;
    const char *plots; /* a folder */
} wh_report_files_t;

/* --report, --gltf, --data and --svg; its input is a wh_report_files_t. */
extern const struct argp wh_report_files_argp;

bool wh_report_files_wanted(const wh_report_files_t *files);

/* What collects a run for them. `trace` is zeroed before the run and must outlive it. */
wh_mcs_listener_t wh_print_listener(wh_signals_t *signals);

/* The command that makes the run again, to be freed: "waferhand run SCRIPT --set NAME=VALUE", or "replay" and a log. */
char *wh_print_command(const char *command, const char *file, const char *const parameters[], size_t count);

/* Writes those that are wanted, from a document that lacks only `run`, which it makes of the record. Each is there whole or as it was;
 * false, with a line on standard error, when one cannot be written. */
bool wh_report_files_write(const wh_report_files_t *files, const wh_document_t *document);

#endif
