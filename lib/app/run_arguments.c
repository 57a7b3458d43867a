/* A script's run, for `run` and `mcs`. */
#include "run_arguments.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../print/record_print.h"
#include "../text/style.h"
#include "app.h"
#include "segments.h"

const wh_option_t wh_run_options[] = {
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, json)},
    {"gantt", 0, NULL, "Also print who was busy when, and what each command's time went into", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, gantt)},
    {"margins", 0, NULL, "Also print how near the axes come to the ends of their travel at each station",
     WH_OPTION_FLAG, .variable = offsetof(wh_run_arguments_t, margins)},
    {"segments", 0, "FILE", "Write the run as C source that a firmware test plays", WH_OPTION_TEXT,
     .variable = offsetof(wh_run_arguments_t, segments_path)},
    {"set", 0, "NAME=VALUE", "Hand the script a parameter: params.NAME", WH_OPTION_LIST,
     .variable = offsetof(wh_run_arguments_t, parameters)},
    {"trust", 0, NULL, "Let the script use all of Lua, files and native modules too", WH_OPTION_FLAG,
     .variable = offsetof(wh_run_arguments_t, run.limits.trust)},
    {"budget", 0, "N", "End the script after N steps of Lua and simulated slices (default 1e9)",
     WH_OPTION_REAL, .variable = offsetof(wh_run_arguments_t, budget), 1, 1e18, "a number from 1 to 1e+18"},
    {"memory", 0, "MIB", "Let the script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(wh_run_arguments_t, memory_mib), 1, 1e6, "a number from 1 to 1e+06"},
    {0}};

static int print_result(const wh_run_arguments_t *arguments, const wh_script_run_t *run) {
    if (arguments->json) {
        return wh_record_print_json(&run->record, stdout);
    }
    if (arguments->quiet) {
        return 0;
    }
    const wh_style_t style = wh_style_of(stdout);
    const unsigned sections =
        (arguments->gantt ? WH_TABLE_GANTT : 0U) | (arguments->margins ? WH_TABLE_MARGINS : 0U);
    return wh_record_print_table(&run->record, stdout, &style, sections);
}

static bool write_segments(const wh_run_arguments_t *arguments, const wh_script_run_t *run) {
    if (arguments->segments_path && wh_segments_write(&run->mcs, arguments->segments_path) != 0) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", arguments->segments_path,
                strerror(errno));
        return false;
    }
    return true;
}

static bool write_report(const wh_run_arguments_t *arguments, const wh_script_run_t *run,
                         wh_signals_t *signals) {
    const wh_script_run_options_t *script = &arguments->run;
    if (!wh_run_files_wanted(&arguments->files)) {
        return true;
    }
    if (!run->record.layout) {
        fprintf(stderr, "%s: no cell (expected a script that names a layout: there is nothing to show)\n",
                script->script);
        return false;
    }
    if (!signals->layout) {
        wh_signals_begin(signals, run->record.layout, true);
    }
    wh_signals_finish(signals);
    char *command = wh_run_files_command(arguments->command ? arguments->command : "run", script->script,
                                         script->parameters, script->parameter_count);
    const wh_document_t document = {.title = script->script,
                                    .reproduce = command,
                                    .source = "run",
                                    .parameters = script->parameters,
                                    .parameter_count = script->parameter_count,
                                    .record = &run->record,
                                    .signals = signals};
    const bool written = wh_run_files_write(&arguments->files, &document);
    free(command);
    return written;
}

static int hand_on(const wh_run_arguments_t *arguments, const wh_script_run_t *run, wh_signals_t *signals,
                   wh_script_run_outcome_t outcome) {
    if (outcome == WH_RUN_BAD_INPUT) {
        fprintf(stderr, "%s\n", run->message);
        return WH_EXIT_USAGE;
    }
    if (!write_segments(arguments, run) || !write_report(arguments, run, signals)) {
        return WH_EXIT_USAGE;
    }
    if (!wh_app_is_printed(print_result(arguments, run))) {
        return WH_EXIT_USAGE;
    }
    /* The table ends with the failure. Without a terminal nobody sees the table, so it goes to standard
     * error, too. */
    if (run->record.failure && (arguments->json || !isatty(STDOUT_FILENO))) {
        fprintf(stderr, "%s\n", run->record.failure);
    }
    return outcome == WH_RUN_MET ? WH_EXIT_MET : WH_EXIT_FAILED;
}

void wh_run_arguments_take(wh_run_arguments_t *arguments) {
    arguments->run.parameters = arguments->parameters.items;
    arguments->run.parameter_count = arguments->parameters.count;
    arguments->run.limits.instructions = (uint64_t)arguments->budget;
    arguments->run.limits.memory_bytes = (size_t)(arguments->memory_mib * 1048576);
}

void wh_run_arguments_free(wh_run_arguments_t *arguments) {
    wh_option_list_free(&arguments->parameters);
}

int wh_run_and_print(wh_run_arguments_t *arguments) {
    wh_script_run_t run;
    wh_signals_t signals = {0};
    if (wh_run_files_wanted(&arguments->files)) {
        arguments->run.listener = wh_run_files_listener(&signals);
    }
    arguments->run.keep_segments = arguments->segments_path != NULL;
    arguments->run.limits.print_to = arguments->json ? stderr : stdout;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &arguments->run);
    const int status = hand_on(arguments, &run, &signals, outcome);
    wh_signals_close(&signals);
    wh_script_run_close(&run);
    return status;
}
