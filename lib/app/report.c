/* waferhand report RUN */
#include <argp.h>
#include <stdio.h>

#include "app/app.h"
#include "app/run.h"

static error_t parse(int key, char *argument, struct argp_state *state) {
    wh_run_arguments_t *arguments = state->input;
    (void)argument;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = arguments;
        return 0;
    case ARGP_KEY_END:
        if (!arguments->run.script) {
            argp_error(state, "of which run?");
        }
        if (!wh_report_files_wanted(&arguments->files)) {
            argp_error(state, "into which file? (-o FILE, --gltf FILE, --data FILE)");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

int wh_app_report(int argc, char **argv) {
    static const struct argp_child children[] = {{&wh_run_argp, 0, NULL, 0}, {0}};
    static const struct argp argp = {
        NULL,     parse, "RUN", "Makes a page of a run.\vExit status: 0 if it was written, 2 if not.",
        children, NULL,  NULL};
    static char name[] = "waferhand report";
    wh_run_arguments_t arguments = {.quiet = true};
    wh_run_arguments_init(&arguments, argc);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const int status = wh_run_and_report(&arguments);
    wh_run_arguments_free(&arguments);
    return status == WH_EXIT_USAGE ? WH_EXIT_USAGE : WH_EXIT_MET;
}
