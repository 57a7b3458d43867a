/* waferhand run SCRIPT */
#include <stdio.h>

#include "../link/broadcast.h"
#include "app.h"
#include "link_options.h"
#include "run_arguments.h"

enum { OPTION_LCM = 2000, OPTION_URL, OPTION_RECORD };

typedef struct {
    wh_run_arguments_t run;
    const char *url, *record;
    bool lcm;
} arguments_t;

static const struct argp_option options[] = {
    {"lcm", OPTION_LCM, NULL, 0, "Publish over LCM what motion control and simulator would say to each other",
     0},
    {"lcm-url", OPTION_URL, "URL", 0, "Where LCM is (default " WH_NODE_URL "); goes with --lcm", 0},
    {"record", OPTION_RECORD, "FILE", 0,
     "Write these messages into an LCM event log; without --lcm no network is needed", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state) {
    arguments_t *arguments = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &arguments->run;
        return 0;
    case OPTION_LCM:
        arguments->lcm = true;
        return 0;
    case OPTION_URL:
        arguments->url = argument;
        return 0;
    case OPTION_RECORD:
        arguments->record = argument;
        return 0;
    case ARGP_KEY_END:
        if (!arguments->run.run.script) {
            argp_error(state, "which script?");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

/* With messages: published where LCM is, or within the process for the record's sake. */
static int run_published(arguments_t *arguments) {
    static wh_broadcast_t broadcast;
    wh_node_t node;
    const char *url = arguments->lcm ? arguments->url : "memq://";
    if (!wh_open_node(&node, url, arguments->record)) {
        return WH_EXIT_USAGE;
    }
    int status = WH_EXIT_USAGE;
    if (wh_broadcast_open(&broadcast, &node, NULL, NULL)) {
        arguments->run.run.partners = wh_broadcast_partners(&broadcast);
        status = wh_run_and_print(&arguments->run);
        wh_broadcast_close(&broadcast);
    }
    wh_node_close(&node);
    return status;
}

int wh_app_run(int argc, char **argv) {
    static const struct argp_child children[] = {{&wh_run_argp, 0, NULL, 0}, {0}};
    static const struct argp argp = {
        options,
        parse,
        "SCRIPT",
        "Plays a motion script against the simulator and prints what came of it.\v"
        "Exit status: 0 if all expectations were met, 1 if the script's expectations or the cell failed, "
        "2 for wrong usage or a bad input file.",
        children,
        NULL,
        NULL};
    static char name[] = "waferhand run";
    arguments_t arguments = {0};
    wh_run_arguments_init(&arguments.run, argc);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const bool published = arguments.lcm || arguments.record;
    const int status = published ? run_published(&arguments) : wh_run_and_print(&arguments.run);
    wh_run_arguments_free(&arguments.run);
    return status;
}
