/* A script's run, for `run` and `mcs`. */
#include "run_arguments.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../print/record_json.h"
#include "../print/record_table.h"
#include "../text/number.h"
#include "../text/style.h"
#include "app.h"
#include "segments.h"

enum {
    OPTION_JSON = 1000,
    OPTION_SEGMENTS,
    OPTION_SET,
    OPTION_TRUST,
    OPTION_BUDGET,
    OPTION_MEMORY,
    OPTION_GANTT,
    OPTION_MARGINS
};

static const struct argp_option options[] = {
    {"json", OPTION_JSON, NULL, 0, "Print the result as one JSON object", 0},
    {"gantt", OPTION_GANTT, NULL, 0, "Also print who was busy when, and what each command's time went into",
     0},
    {"margins", OPTION_MARGINS, NULL, 0,
     "Also print how near the axes come to the ends of their travel at each station", 0},
    {"segments", OPTION_SEGMENTS, "FILE", 0,
     "Write the motion that was played as C source for a firmware test", 0},
    {"set", OPTION_SET, "NAME=VALUE", 0, "Hand the script a parameter: params.NAME", 0},
    {"trust", OPTION_TRUST, NULL, 0, "Let the script use all of Lua, files and native modules too", 0},
    {"budget", OPTION_BUDGET, "N", 0,
     "End the script after N steps of Lua and simulated slices (default 1e9)", 0},
    {"memory", OPTION_MEMORY, "MIB", 0, "Let the script use so many MiB of memory (default 256)", 0},
    {0},
};

/* A whole number in a range, given as 1000000 or 1e6. */
static double whole_number(const struct argp_state *state, const char *name, const char *text, double max) {
    double value = 0;
    if (!wh_number_read(text, 1, max, &value)) {
        argp_error(state, "--%s: %s (expected a number from 1 to %g)", name, text, max);
    }
    return value;
}

/* An option without an argument; false when it is none. */
static bool take_flag(wh_run_arguments_t *arguments, int key) {
    switch (key) {
    case OPTION_JSON:
        arguments->json = true;
        return true;
    case OPTION_GANTT:
        arguments->sections |= WH_TABLE_GANTT;
        return true;
    case OPTION_MARGINS:
        arguments->sections |= WH_TABLE_MARGINS;
        return true;
    case OPTION_TRUST:
        arguments->run.limits.trust = true;
        return true;
    default:
        return false;
    }
}

static error_t parse(int key, char *argument, struct argp_state *state) {
    wh_run_arguments_t *arguments = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &arguments->files;
        return 0;
    case OPTION_SEGMENTS:
        arguments->segments_path = argument;
        return 0;
    case OPTION_SET:
        arguments->parameters[arguments->run.parameter_count++] = argument;
        return 0;
    case OPTION_BUDGET:
        arguments->run.limits.instructions = (uint64_t)whole_number(state, "budget", argument, 1e18);
        return 0;
    case OPTION_MEMORY:
        arguments->run.limits.memory_bytes = (size_t)(whole_number(state, "memory", argument, 1e6) * 1048576);
        return 0;
    case ARGP_KEY_ARG:
        if (arguments->run.script) {
            argp_error(state, "%s: one script is enough", argument);
        }
        arguments->run.script = argument;
        return 0;
    default:
        return take_flag(arguments, key) ? 0 : ARGP_ERR_UNKNOWN;
    }
}

static int print_result(const wh_run_arguments_t *arguments, const wh_script_run_t *run) {
    if (arguments->json) {
        return wh_record_print_json(&run->record, stdout);
    }
    if (arguments->quiet) {
        return 0;
    }
    const wh_style_t style = wh_style_of(stdout);
    return wh_record_print_table_with(&run->record, stdout, &style, arguments->sections);
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
    if (!wh_report_files_wanted(&arguments->files)) {
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
    char *command = wh_print_command(arguments->command ? arguments->command : "run", script->script,
                                     script->parameters, script->parameter_count);
    const wh_document_t document = {.title = script->script,
                                    .reproduce = command,
                                    .source = "run",
                                    .parameters = script->parameters,
                                    .parameter_count = script->parameter_count,
                                    .record = &run->record,
                                    .signals = signals};
    const bool written = wh_report_files_write(&arguments->files, &document);
    free(command);
    return written;
}

static int report(const wh_run_arguments_t *arguments, const wh_script_run_t *run, wh_signals_t *signals,
                  wh_script_run_outcome_t outcome) {
    if (outcome == WH_RUN_BAD_INPUT) {
        fprintf(stderr, "%s\n", run->message);
        return WH_EXIT_USAGE;
    }
    if (!write_segments(arguments, run) || !write_report(arguments, run, signals)) {
        return WH_EXIT_USAGE;
    }
    if (print_result(arguments, run) != 0 || fflush(stdout) != 0) {
        fprintf(stderr, "standard output: %s\n", strerror(errno));
        return WH_EXIT_USAGE;
    }
    /* The table ends with it; where that is not on the same screen it would be missed. */
    if (run->record.failure && (arguments->json || !isatty(STDOUT_FILENO))) {
        fprintf(stderr, "%s\n", run->record.failure);
    }
    return outcome == WH_RUN_MET ? WH_EXIT_MET : WH_EXIT_FAILED;
}

void wh_run_arguments_init(wh_run_arguments_t *arguments, int argc) {
    arguments->parameters = calloc((size_t)argc + 1, sizeof *arguments->parameters);
    if (!arguments->parameters) {
        perror("waferhand");
        exit(WH_EXIT_USAGE);
    }
    arguments->run.parameters = arguments->parameters;
}

void wh_run_arguments_free(wh_run_arguments_t *arguments) {
    free(arguments->parameters);
    arguments->parameters = NULL;
}

int wh_run_and_print(wh_run_arguments_t *arguments) {
    wh_script_run_t run;
    wh_signals_t signals = {0};
    if (wh_report_files_wanted(&arguments->files)) {
        arguments->run.listener = wh_print_listener(&signals);
    }
    arguments->run.keep_segments = arguments->segments_path != NULL;
    arguments->run.limits.print_to = arguments->json ? stderr : stdout;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &arguments->run);
    const int status = report(arguments, &run, &signals, outcome);
    wh_signals_close(&signals);
    wh_script_run_close(&run);
    return status;
}

static const struct argp_child children[] = {{&wh_report_files_argp, 0, NULL, 0}, {0}};
const struct argp wh_run_argp = {options, parse, NULL, NULL, children, NULL, NULL};
