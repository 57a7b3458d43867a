#include "log_arguments.h"

#include <stdio.h>

#include "app.h"

const wh_option_t wh_log_options[] = {
    {"layout", 0, "FILE", "The layout's file, if it is not where the log says; another layout is refused",
     WH_OPTION_TEXT, .variable = offsetof(wh_log_arguments_t, layout)},
    {"run", 0, "N", "The log's N-th run that has slices (default: the last)", WH_OPTION_COUNT,
     .variable = offsetof(wh_log_arguments_t, number), .least = 1, .expected = "a whole number from 1"},
    {"set", 0, "NAME=VALUE",
     "Hand the log's layout, and the checks, a parameter, params.NAME: a number if VALUE is one, true, false "
     "or "
     "text",
     WH_OPTION_LIST, .variable = offsetof(wh_log_arguments_t, parameters)},
    {0}};

#define LATEST 1e9

const wh_option_t wh_log_window_options[] = {
    {"from", 0, "S", "From this time of the run on, in simulated seconds", WH_OPTION_REAL,
     .variable = offsetof(wh_log_window_t, from), 0, LATEST, "a number from 0 to 1e+09"},
    {"to", 0, "S", "Up to this time, which is still in it", WH_OPTION_REAL,
     .variable = offsetof(wh_log_window_t, to), 0, LATEST, "a number from 0 to 1e+09"},
    {0}};

void wh_log_window_check(const void *given, struct argp_state *state) {
    const wh_log_window_t *window = given;
    if (window->to < window->from) {
        argp_error(state, "--to: %g (expected a time that is not before --from, %g)", window->to,
                   window->from);
    }
}

bool wh_log_arguments_read(const wh_log_arguments_t *arguments, wh_log_run_listener_t *listener, void *user,
                           wh_log_run_t *run) {
    const wh_log_run_options_t wanted = {
        .path = arguments->path,
        .number = (size_t)arguments->number,
        .layout = {arguments->layout, arguments->parameters.items, arguments->parameters.count},
        .listener = listener,
        .user = user};
    const bool read = wh_log_run_read(run, &wanted);
    if (!read) {
        fprintf(stderr, "%s\n", run->message);
    }
    return read;
}

bool wh_log_arguments_are_set_read(const wh_log_run_t *run) {
    return run->options.layout.parameter_count > 0 && run->cell.is_whole &&
           wh_sandbox_reads_parameters(run->cell.sandbox);
}

bool wh_log_arguments_check_set(const wh_log_run_t *run) {
    char unread[WH_SANDBOX_MESSAGE_BYTES];
    const wh_log_run_options_t *given = &run->options;
    if (given->layout.parameter_count == 0 || wh_log_arguments_are_set_read(run)) {
        return true;
    }
    if (!run->cell.is_whole) {
        fprintf(stderr, "--set %s: %s (expected the log's layout, which --layout FILE names)\n",
                given->layout.parameters[0], run->cell.note);
        return false;
    }
    const bool is_unread = wh_sandbox_find_unread(run->cell.sandbox, unread);
    if (is_unread) {
        fprintf(stderr, "%s: %s\n", given->path, unread);
    }
    return !is_unread;
}

int wh_log_arguments_judge(const wh_log_arguments_t *arguments, const wh_log_run_t *run) {
    if (run->worth.reason[0] == '\0') {
        return WH_EXIT_MET;
    }
    fprintf(stderr, "%s: %s: %s\n", arguments->path, run->worth.verdict, run->worth.reason);
    return WH_EXIT_FAILED;
}
