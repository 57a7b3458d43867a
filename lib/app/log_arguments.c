#include "log_arguments.h"

#include <stdio.h>
#include <string.h>

#include "app.h"

const wh_option_t wh_log_options[] = {
    {"layout", 0, "FILE", "The layout's file, if it is not where the log says; another layout is refused",
     WH_OPTION_TEXT, .variable = offsetof(wh_log_arguments_t, layout)},
    {"run", 0, "N", "The log's N-th run that has slices (default: the last)", WH_OPTION_COUNT,
     .variable = offsetof(wh_log_arguments_t, number), .least = 1},
    {"set", 0, "NAME=VALUE",
     "Hand the log's layout, and the checks, a parameter, params.NAME: a number if VALUE is one, true, false "
     "or "
     "text",
     WH_OPTION_LIST, .variable = offsetof(wh_log_arguments_t, parameters)},
    {0}};

const wh_option_t wh_log_more_options[] = {
    {"alone", 0, NULL, "Read only this file of a recording in parts, not the parts that follow it",
     WH_OPTION_FLAG, .variable = offsetof(wh_log_more_t, is_alone)},
    {"then", 0, "LOG",
     "Read this log behind it, as one with it: of a process that was started again; may be given again",
     WH_OPTION_LIST, .variable = offsetof(wh_log_more_t, then)},
    {0}};

#define LATEST 1e9

const wh_option_t wh_log_window_options[] = {
    {"from", 0, "S", "From this time of the run on, in simulated seconds", WH_OPTION_REAL,
     .variable = offsetof(wh_log_window_t, from), 0, LATEST},
    {"to", 0, "S", "Up to this time, which is still in it", WH_OPTION_REAL,
     .variable = offsetof(wh_log_window_t, to), 0, LATEST},
    {0}};

void wh_log_window_check(const void *given, struct argp_state *state) {
    const wh_log_window_t *window = given;
    if (window->to < window->from) {
        argp_error(state, "--to: %g (expected a time that is not before --from, %g)", window->to,
                   window->from);
    }
}

bool wh_log_window_begins_in(const wh_log_window_t *window, const wh_log_run_t *run) {
    const double end = wh_log_run_end(run);
    if (window->from > end) {
        fprintf(stderr, "--from: %g (expected a time of the run, which ends at %.6f s)\n", window->from, end);
    }
    return window->from <= end;
}

void wh_log_more_take(const wh_log_more_t *more, wh_log_run_options_t *options) {
    options->then = more->then.items;
    options->then_count = more->then.count;
    options->is_alone = more->is_alone;
}

bool wh_log_arguments_read(const wh_log_arguments_t *arguments, wh_log_run_listener_t *listener, void *user,
                           wh_log_run_t *run) {
    wh_log_run_options_t wanted = {
        .path = arguments->path,
        .number = (size_t)arguments->number,
        .layout = {arguments->layout, arguments->parameters.items, arguments->parameters.count},
        .only_slices = arguments->only_slices,
        .listener = listener,
        .user = user};
    wh_log_more_take(&arguments->more, &wanted);
    const bool read = wh_log_run_read(run, &wanted);
    if (!read) {
        fprintf(stderr, "%s\n", run->message);
    } else if (run->run_count > 1) {
        fprintf(stderr, "%s: run %zu of %zu (--run N takes another)\n", arguments->path,
                (size_t)(run->wanted - run->runs) + 1, run->run_count);
    }
    return read;
}

bool wh_log_arguments_check_set(const wh_log_run_t *run, wh_sandbox_t *checks) {
    const wh_log_run_options_t *given = &run->options;
    const wh_told_layout_t *cell = &run->cell;
    for (size_t i = 0; i < given->layout.parameter_count; ++i) {
        const char *assignment = given->layout.parameters[i];
        const int name = (int)strcspn(assignment, "=");
        const bool is_read = (cell->is_whole && !wh_sandbox_is_unread(cell->sandbox, assignment)) ||
                             (checks && !wh_sandbox_is_unread(checks, assignment));
        if (!is_read && !cell->is_whole) {
            const bool is_told = strstr(cell->note, "(expected ") != NULL;
            fprintf(stderr, "%s: --set %s: %s%s\n", given->path, assignment, cell->note,
                    is_told ? "" : " (expected the log's layout, which --layout FILE names)");
            return false;
        }
        if (!is_read) {
            fprintf(
                stderr, "%s: --set %.*s: nobody read params.%.*s (expected one that the log's layout%s)\n",
                given->path, name, assignment, name, assignment, checks ? " or the checks read" : " reads");
            return false;
        }
    }
    return true;
}

const char *wh_log_missing_parts(const wh_log_run_t *run) {
    return run->replay.recording.first_part > 1 ? "the parts before it are" : "the next part is";
}

int wh_log_arguments_judge(const wh_log_arguments_t *arguments, const wh_log_run_t *run) {
    if (run->worth.reason[0] != '\0') {
        fprintf(stderr, "%s: %s: %s\n", arguments->path, run->worth.verdict, run->worth.reason);
    }
    if (wh_log_run_is_part(run)) {
        fprintf(stderr, "%s: part %d of a recording: %s not read\n", arguments->path, (int)run->worth.part,
                wh_log_missing_parts(run));
    }
    return run->worth.reason[0] == '\0' && !wh_log_run_is_part(run) ? WH_EXIT_MET : WH_EXIT_FAILED;
}
