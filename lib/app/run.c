/* waferhand run SCRIPT */
#include <stdio.h>

#include "../link/broadcast.h"
#include "app.h"
#include "connection.h"
#include "run_arguments.h"

typedef struct {
    wh_run_arguments_t run;
    const char *url, *record;
    bool lcm;
} arguments_t;

static const wh_option_t options[] = {
    {"lcm", 0, NULL, "Publish over LCM what motion control and simulator would say to each other",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, lcm)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "); goes with --lcm", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, url)},
    {"record", 0, "FILE", "Write these messages into an LCM event log; without --lcm no network is needed",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, record)},
    {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL},
                                           {wh_run_options, offsetof(arguments_t, run), NULL},
                                           {wh_run_files_options, offsetof(arguments_t, run.files), NULL},
                                           {0}};

static const wh_command_line_t command_line = {
    .name = "run",
    .synopsis = "SCRIPT",
    .about =
        "Plays a motion script against the simulator and prints what came of it.\v"
        "Exit status: 0 if all expectations were met, 1 if the script's expectations or the cell failed, "
        "2 for wrong usage or a bad input file.",
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script)};

/* Runs with messages: over LCM, or within the process if only a record of them is wanted. */
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
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    const bool published = arguments.lcm || arguments.record;
    const int status = published ? run_published(&arguments) : wh_run_and_print(&arguments.run);
    wh_run_arguments_free(&arguments.run);
    return status;
}
