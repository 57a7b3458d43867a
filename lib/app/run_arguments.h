/* A script's run as subcommands offer it: `run SCRIPT` and `mcs SCRIPT` have the same options and report alike. */
#ifndef WH_APP_RUN_ARGUMENTS_H
#define WH_APP_RUN_ARGUMENTS_H

#include <argp.h>

#include "../mcs/script_run.h"
#include "report_files.h"

/* Zero it to begin with; wh_run_arguments_free frees what parsing took. */
typedef struct {
    wh_script_run_options_t run; /* run.script is null when none was named */
    const char **parameters;
    const char *segments_path;
    bool json;
    unsigned sections;   /* WH_TABLE_* */
    bool quiet;          /* print neither tables nor, without `json`, anything else */
    const char *command; /* of the program, that plays it again; null: run */
    wh_report_files_t files;
} wh_run_arguments_t;

/* The options and the script, as a child of a subcommand's parser; its input is a wh_run_arguments_t that
 * wh_run_arguments_init has seen. */
extern const struct argp wh_run_argp;

/* Room for as many parameters as there are arguments; ends the program when there is no memory. */
void wh_run_arguments_init(wh_run_arguments_t *arguments, int argc);
void wh_run_arguments_free(wh_run_arguments_t *arguments);

/* Runs the script and prints what came of it. Returns the exit status. */
int wh_run_and_print(wh_run_arguments_t *arguments);

#endif
