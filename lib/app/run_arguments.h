/* A script's run as subcommands offer it: `run SCRIPT` and `mcs SCRIPT` have the same options and print
 * alike. And the files that a run is written to: those of `report`, `run`, `mcs` and `study --trial`. */
#ifndef WH_APP_RUN_ARGUMENTS_H
#define WH_APP_RUN_ARGUMENTS_H

#include "../log/recording.h"
#include "../mcs/script_run.h"
#include "../play/reel.h"
#include "../print/record_print.h"
#include "../report/document.h"
#include "../text/options.h"
#include "live.h"

/* Zero it to begin with: null paths are not wanted. */
typedef struct {
    const char *page, *scene, *document;
    const char *plots; /* a folder */
} wh_run_files_t;

/* --report, --gltf, --data and --svg, into a wh_run_files_t. */
extern const wh_option_t wh_run_files_options[];

/* True if any is wanted. */
bool wh_run_files_wanted(const wh_run_files_t *files);

/* Counted time; zero it to begin with. */
typedef struct {
    bool counted, strict;
    uint64_t verify;
} wh_run_counting_t;

/* Zero it to begin with. */
typedef struct {
    wh_script_run_options_t run; /* run.script is null when none was named */
    wh_option_list_t parameters;
    wh_option_list_t errors;   /* that the cell has: of wh_run_error_options */
    double budget, memory_mib; /* 0: the defaults */
    const char *segments_path;
    const char *history_path;     /* null: not wanted */
    const char *schedule_path;    /* likewise */
    const char *record, *outputs; /* files that others write; null: none */
    const char *record_option;    /* that gave `record` */
    wh_recording_t *recording; /* that goes into `record`: if it does not keep the run, the run has failed; or
                                * null */
    const uint64_t *unwritten; /* how often `outputs` was not written: then likewise; null: nobody counts */
    const char *disturbance;   /* why the run is not the requested one: then likewise; null, or empty: it
                                * is */
    bool json;
    wh_record_sections_t sections; /* of the tables */
    bool quiet;                    /* print no tables, and nothing at all without `json` */
    const char *command;           /* the subcommand that plays it again; null: run */
    wh_run_files_t files;
    wh_run_counting_t counting;
    wh_live_t *live;  /* its page; null: none */
    bool plays_again; /* the page of `files` does, by the engine of `make playground` */
    wh_reel_t reel;   /* what that page takes along */
} wh_run_arguments_t;

/* All options except those of files, into a wh_run_arguments_t; the script is the subcommand's operand. */
extern const wh_option_t wh_run_options[];

/* Those of subcommands that play a script many times: --json, parameters and limits; likewise. */
extern const wh_option_t wh_run_trials_options[];

/* --counted, --strict and --verify, for a run in this process: also into a wh_run_arguments_t, with their
 * check. */
extern const wh_option_t wh_run_counting_options[];
void wh_run_counting_check(const void *filled, struct argp_state *state);

/* --live, for a run in this process: also into a wh_run_arguments_t, with its check. */
extern const wh_option_t wh_run_again_options[];
void wh_run_again_check(const void *filled, struct argp_state *state);

/* The help of --counted of subcommands that play many runs, for WH_MCS_COUNT_BLIND. */
#define WH_RUN_COUNTED_HELP                                                                                  \
    "Leave out slices in which nothing can be decided; a cell with collision = true is played in full"

/* The help of --until-steady. */
#define WH_RUN_STEADY_HELP                                                                                   \
    "End a flow by times alone as soon as all in it repeats but for the time: its cycle is that of a lot "   \
    "without end"

/* The reason why errors do not go with options that describe the cell. */
#define WH_RUN_ERRORS_ALONE "--error does not go with %s, which tells of the cell as its layout says"

/* Options for given errors, for a run in this process: also into a wh_run_arguments_t. The check refuses one
 * that is given twice, and those beside --segments. */
extern const wh_option_t wh_run_error_options[];
void wh_run_errors_check(const void *filled, struct argp_state *state);

/* A wh_option_table_t's check of them. */
void wh_run_arguments_check(const void *filled, struct argp_state *state);

/* The option of a wanted table; null: none is wanted. */
const char *wh_run_table_wanted(const wh_run_arguments_t *arguments);

/* Hands what was parsed on to `run`. */
void wh_run_arguments_take(wh_run_arguments_t *arguments);
void wh_run_arguments_free(wh_run_arguments_t *arguments);

/* True if no output is the script, `input` (null: none), a file that describes the cell, or another output;
 * else standard error says which. A recording that has failed has reported that itself, and is left out. */
bool wh_run_files_are_apart(const wh_run_arguments_t *arguments, const char *input);

/* Prints a record as the arguments want it: as JSON, as tables, or not at all. 0, or -1 if standard output
 * does not take it. */
int wh_run_print(const wh_run_arguments_t *arguments, const wh_record_t *record);

/* The subcommand that plays it again. */
const char *wh_run_subcommand(const wh_run_arguments_t *arguments);

/* Runs the script and prints its result. Returns the exit status. */
int wh_run_and_print(wh_run_arguments_t *arguments);

/* Calls wh_watch for a run that `act` makes with `user`. */
int wh_run_watch(const wh_run_arguments_t *arguments, int (*act)(void *user), void *user);

/* Writes the wanted files, if any, from a document that has source, record, signals and notes; the arguments
 * give the rest. Each file is then whole, or as it was before. False, with a line on standard error, if one
 * cannot be written. */
bool wh_run_files_write(const wh_run_arguments_t *arguments, const wh_document_t *document);

#endif
