/* waferhand report RUN */
#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../log/log_run.h"
#include "../text/number.h"
#include "app.h"
#include "run_arguments.h"

enum { OPTION_LAYOUT = 5000, OPTION_RUN };

typedef struct {
    wh_run_arguments_t run; /* run.run.script is RUN, whatever it is */
    const char *layout;
    size_t number;
} arguments_t;

static const struct argp_option options[] = {
    {"layout", OPTION_LAYOUT, "FILE", 0, "Of a log: its layout's file, if it is not where the log says", 0},
    {"run", OPTION_RUN, "N", 0, "Of a log: its N-th run (default: the last)", 0},
    {0},
};

static size_t run_number(const struct argp_state *state, const char *text) {
    uint64_t number = 0;
    if (!wh_number_read_whole(text, &number) || number == 0) {
        argp_error(state, "--run: %s (expected a whole number from 1)", text);
    }
    return number;
}

static error_t parse(int key, char *argument, struct argp_state *state) {
    arguments_t *arguments = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &arguments->run;
        return 0;
    case OPTION_LAYOUT:
        arguments->layout = argument;
        return 0;
    case OPTION_RUN:
        arguments->number = run_number(state, argument);
        return 0;
    case ARGP_KEY_END:
        if (!arguments->run.run.script) {
            argp_error(state, "of which run?");
        }
        if (!wh_report_files_wanted(&arguments->run.files)) {
            argp_error(state, "into which file? (-o FILE, --gltf FILE, --data FILE or --svg DIR)");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static bool write_log(const arguments_t *arguments, wh_log_run_t *run) {
    const wh_script_run_options_t *given = &arguments->run.run;
    const wh_log_run_options_t wanted = {
        given->script, arguments->number, {arguments->layout, given->parameters, given->parameter_count}};
    if (!wh_log_run_read(run, &wanted)) {
        fprintf(stderr, "%s\n", run->message);
        return false;
    }
    char *command = wh_print_command("replay", given->script, NULL, 0);
    const wh_document_t document = {.title = given->script,
                                    .reproduce = command,
                                    .source = "log",
                                    .parameters = given->parameters,
                                    .parameter_count = given->parameter_count,
                                    .notes = run->notes,
                                    .note_count = run->note_count,
                                    .record = &run->record,
                                    .signals = &run->signals};
    const bool written = wh_report_files_write(&arguments->run.files, &document);
    free(command);
    return written;
}

static int report_log(const arguments_t *arguments) {
    static wh_log_run_t run;
    const bool written = write_log(arguments, &run);
    wh_log_run_close(&run);
    return written ? WH_EXIT_MET : WH_EXIT_USAGE;
}

/* A script is text. */
static bool is_text(const char *path) {
    char begin[512];
    FILE *file = fopen(path, "rb");
    const size_t size = file ? fread(begin, 1, sizeof begin, file) : 0;
    if (file) {
        (void)fclose(file);
    }
    return !memchr(begin, '\0', size);
}

static int report_script(arguments_t *arguments) {
    if (!is_text(arguments->run.run.script)) {
        fprintf(stderr, "%s: no LCM event log and no script (expected one of them)\n",
                arguments->run.run.script);
        return WH_EXIT_USAGE;
    }
    if (arguments->layout || arguments->number > 0) {
        fprintf(stderr, "%s: no LCM event log (expected one with %s)\n", arguments->run.run.script,
                arguments->layout ? "--layout" : "--run");
        return WH_EXIT_USAGE;
    }
    const int status = wh_run_and_print(&arguments->run);
    return status == WH_EXIT_USAGE ? WH_EXIT_USAGE : WH_EXIT_MET;
}

int wh_app_report(int argc, char **argv) {
    static const struct argp_child children[] = {{&wh_run_argp, 0, NULL, 0}, {0}};
    static const struct argp argp = {
        options,
        parse,
        "RUN",
        "Makes a page of a run, which is a script that is run again, or an LCM event log: the cell in "
        "motion, plots "
        "and tables, in one file that opens without a network; or its plots for print.\v"
        "Exit status: 0 if it was written, whatever came of the run; 2 for wrong usage or a bad input file.",
        children,
        NULL,
        NULL};
    static char name[] = "waferhand report";
    arguments_t arguments = {.run = {.quiet = true}};
    wh_run_arguments_init(&arguments.run, argc);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const bool is_log = wh_log_run_is_log(arguments.run.run.script);
    const int status = is_log ? report_log(&arguments) : report_script(&arguments);
    wh_run_arguments_free(&arguments.run);
    return status;
}
