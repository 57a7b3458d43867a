/* waferhand mcs [SCRIPT] [--layout FILE] */
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/prompt.h"
#include "app/run.h"

enum { OPTION_LAYOUT = 2000 };

typedef struct {
    wh_run_arguments_t run;
    const char *layout;
} arguments_t;

static const struct argp_option options[] = {
    {"layout", OPTION_LAYOUT, "FILE", 0, "Take commands from a prompt, in the cell of this layout", 0},
    {0},
};

static void check(const arguments_t *arguments, struct argp_state *state) {
    if (!arguments->run.run.script && !arguments->layout) {
        argp_error(state, "which script, or which --layout?");
    }
    if (arguments->run.run.script && arguments->layout) {
        argp_error(state, "--layout: %s (a script names its layout itself)", arguments->layout);
    }
    if (arguments->layout && (arguments->run.json || arguments->run.segments_path)) {
        argp_error(state, "--json and --segments go with a script");
    }
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
    case ARGP_KEY_END:
        check(arguments, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static int take_commands(wh_session_t *session) {
    wh_prompt_t *prompt = wh_prompt_open(session);
    if (!prompt) {
        perror("waferhand");
        return WH_EXIT_USAGE;
    }
    const int status = wh_prompt_run(prompt);
    wh_prompt_close(prompt);
    return status;
}

static int run_prompt(const arguments_t *arguments) {
    static wh_session_t session;
    wh_session_options_t wanted = {
        .layout = arguments->layout,
        .limits = arguments->run.run.limits,
        .parameters = arguments->run.run.parameters,
        .parameter_count = arguments->run.run.parameter_count,
    };
    int status = WH_EXIT_USAGE;
    /* Standard output is for answers. */
    wanted.limits.print_to = stderr;
    if (wh_session_open(&session, &wanted)) {
        status = take_commands(&session);
    } else {
        fprintf(stderr, "%s\n", session.message);
    }
    wh_session_close(&session);
    return status;
}

int wh_app_mcs(int argc, char **argv) {
    static const struct argp_child children[] = {{&wh_run_argp, 0, NULL, 0}, {0}};
    static const struct argp argp = {
        options,
        parse,
        "SCRIPT\n--layout FILE",
        "Plays a motion script, or takes an operator's commands such as GET A 1 from standard input and "
        "answers "
        "each in one line.\v"
        "Exit status: 0 if all expectations were met or all commands succeeded, 1 if not or if the cell "
        "failed, "
        "2 for wrong usage or a bad input file. At a terminal commands may fail.",
        children,
        NULL,
        NULL};
    static char name[] = "waferhand mcs";
    arguments_t arguments = {0};
    wh_run_arguments_init(&arguments.run, argc);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const int status = arguments.layout ? run_prompt(&arguments) : wh_run_and_report(&arguments.run);
    wh_run_arguments_free(&arguments.run);
    return status;
}
