/* How `run`, `sim` and `mcs` are recorded, how the last two are ended by signals, and how `mcs` is linked to
 * LCM. */
#ifndef WH_APP_CONNECTION_H
#define WH_APP_CONNECTION_H

#include <signal.h>

#include "../link/mcs_process.h"
#include "../log/recording.h"
#include "../text/options.h"

/* The ending of the noun behind a count. */
#define WH_PLURAL(count) ((count) == 1 ? "" : "s")

/* Set by SIGINT and SIGTERM once wh_catch_signals was called. */
extern volatile sig_atomic_t wh_stop_requested;

/* From now on SIGINT and SIGTERM set wh_stop_requested and interrupt waits. They no longer end the
 * process. */
void wh_catch_signals(void);

/* --------------------------------------------------------------------------------------------- recordings */

typedef struct {
    const char *slices, *all; /* files */
    double part_mb;
} wh_record_arguments_t;

/* The options of `run`, `sim` and `mcs` about a recording. */
extern const wh_option_t wh_record_options[];

/* The check of their table: refuses options that do not go together. */
void wh_record_arguments_check(const void *arguments, struct argp_state *state);

/* The recording's file, null if none was given, and the `option` that gives it. */
const char *wh_record_arguments_path(const wh_record_arguments_t *arguments, const char **option);

/* Sets the options of a recording, by `program`, which must outlive it; it replaces an old file or does
 * not. */
void wh_record_arguments_apply(const wh_record_arguments_t *arguments, const char *program, bool replaces,
                               wh_recording_t *recording);

/* --------------------------------------------------------------------------------------- motion control's */

typedef struct {
    const char *url;     /* null: the default */
    const char *program; /* who speaks and records; null: mcs */
    wh_record_arguments_t record;
    bool log_time;
    wh_protocol_client_options_t client;
} wh_mcs_link_options_t;

/* Must not be moved once opened. */
typedef struct {
    wh_node_t node;
    wh_recording_t record;
    wh_mcs_process_t control;
} wh_mcs_link_t;

/* Catches signals and opens LCM; says on standard error what is wrong. */
bool wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options);

/* Tells all listeners that the run is over, prints which messages were lost, and closes. False if the
 * record or the file of the valves could not be written: standard error has said so. */
bool wh_mcs_link_close(wh_mcs_link_t *link);

#endif
