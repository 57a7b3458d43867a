/* Shared by subcommands that read one run of a log: which run, whose layout, and the report that the log is
 * not whole. */
#ifndef WH_APP_LOG_ARGUMENTS_H
#define WH_APP_LOG_ARGUMENTS_H

#include "../log/log_run.h"
#include "../text/options.h"

/* Which files are read beside the one that is named (log/log_files.h). Zero it to begin with. */
typedef struct {
    wh_option_list_t then; /* the logs that follow it; to be freed */
    bool is_alone;
} wh_log_more_t;

/* --alone and --then, into a wh_log_more_t. */
extern const wh_option_t wh_log_more_options[];

/* Sets the files of `options` that are read beside its path. */
void wh_log_more_take(const wh_log_more_t *more, wh_log_run_options_t *options);

/* Zero it to begin with. */
typedef struct {
    const char *path;
    wh_log_more_t more;
    const char *layout;
    uint64_t number;             /* 0: the last */
    wh_option_list_t parameters; /* for the layout's file; to be freed */
    bool only_slices;            /* the subcommand's wish: see wh_log_run_options_t */
} wh_log_arguments_t;

/* --layout, --run and --set, into a wh_log_arguments_t; the log is the subcommand's operand. */
extern const wh_option_t wh_log_options[];

/* Reads the run (wh_log_run_read), with a listener or null; of several runs standard error says which one
 * it is. False, and standard error says why, if there is nothing to show. To be closed in any case, and
 * freed. */
bool wh_log_arguments_read(const wh_log_arguments_t *arguments, wh_log_run_listener_t *listener, void *user,
                           wh_log_run_t *run);

/* True if each parameter that is given was read by the log's layout or by the checks' sandbox (null: there is
 * none). Else standard error names the first that was not. */
bool wh_log_arguments_check_set(const wh_log_run_t *run, wh_sandbox_t *checks);

/* WH_EXIT_MET if a replay calls the log the same, and it is no part of a recording of several; else
 * WH_EXIT_FAILED, and standard error says what a replay says, or which part it is. */
int wh_log_arguments_judge(const wh_log_arguments_t *arguments, const wh_log_run_t *run);

/* Which parts of a recording in parts were not read. */
const char *wh_log_missing_parts(const wh_log_run_t *run);

/* A stretch of time, s. Zero `from`, and `to` HUGE_VAL, to begin with. */
typedef struct {
    double from, to;
} wh_log_window_t;

/* --from and --to, into a wh_log_window_t; its check refuses one that ends before it begins. */
extern const wh_option_t wh_log_window_options[];
void wh_log_window_check(const void *window, struct argp_state *state);

/* False, and standard error says when the run ends, if it begins behind the run's end. */
bool wh_log_window_begins_in(const wh_log_window_t *window, const wh_log_run_t *run);

/* True if the moment is in it, its ends included. */
static inline bool wh_log_window_has(const wh_log_window_t *window, double time_s) {
    return time_s >= window->from && time_s <= window->to;
}

#endif
