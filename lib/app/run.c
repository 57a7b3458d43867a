/* waferhand run SCRIPT */
#include <stdlib.h>

#include "../play/run_document.h"
#include "app.h"
#include "broadcast.h"
#include "connection.h"
#include "run_arguments.h"
#include "watch.h"

typedef struct {
    wh_run_arguments_t run;
    wh_record_arguments_t record;
    wh_live_arguments_t page;
    double rate; /* 0: not given */
    const char *url;
    bool lcm, watch;
} arguments_t;

static const wh_option_t options[] = {
    {"lcm", 0, NULL, "Publish over LCM what motion control and simulator would say to each other",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, lcm)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "); goes with --lcm", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, url)},
    {"history", 0, "FILE",
     "Write each wafer's history in a flow in the words of E90 and E116: JSON lines, or CSV if FILE ends in "
     ".csv",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, run.history_path)},
    {"schedule", 0, "FILE", "Write the schedule that a flow played, as waferhand schedule reads it",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, run.schedule_path)},
    {"brief", 0, NULL,
     "Print sums, complaints and the last lines alone, and keep no row of a command: memory stays flat "
     "however long the run",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, run.sections.brief)},
    {"rate", 0, "FACTOR",
     "With --page: let simulated time pass so much faster than the wall clock (default 1)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, rate), 1e-3, 1e3},
    {"until-steady", 0, NULL, WH_RUN_STEADY_HELP, WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, run.run.until_steady)},
    {"watch", 0, NULL, WH_WATCH_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, watch)},
    {0}};

/* The errors are in the simulator of this process. Nothing of them is published or recorded. */
static void check_errors(const arguments_t *arguments, struct argp_state *state) {
    const char *other = arguments->lcm             ? "--lcm"
                        : arguments->record.slices ? "--record"
                        : arguments->record.all    ? "--record-all"
                                                   : NULL;
    if (arguments->run.errors.count > 0 && other) {
        argp_error(state, WH_RUN_ERRORS_ALONE, other);
    }
}

/* The option that asks for each slice; null: none is given. */
static const char *option_of_slices(const arguments_t *arguments) {
    const struct {
        bool is_given;
        const char *option;
    } options_of_slices[] = {{arguments->lcm, "--lcm"},
                             {arguments->record.slices, "--record"},
                             {arguments->record.all, "--record-all"},
                             {arguments->page.address, "--page"}};
    for (size_t i = 0; i < sizeof options_of_slices / sizeof options_of_slices[0]; ++i) {
        if (options_of_slices[i].is_given) {
            return options_of_slices[i].option;
        }
    }
    return NULL;
}

static void check_counted(const arguments_t *arguments, struct argp_state *state) {
    const char *other = option_of_slices(arguments);
    if (arguments->run.counting.counted && other) {
        argp_error(state, "--counted does not go with %s, which asks for each slice", other);
    }
}

/* An option whose output has rows of commands; null: none is given. */
static const char *option_of_rows(const arguments_t *arguments) {
    const wh_run_arguments_t *run = &arguments->run;
    const struct {
        bool is_given;
        const char *option;
    } options_of_rows[] = {{run->json, "--json"},
                           {run->files.page, "--report"},
                           {run->files.scene, "--gltf"},
                           {run->files.document, "--data"},
                           {run->files.plots, "--svg"},
                           {run->sections.gantt, "--gantt"},
                           {run->sections.cycle, "--cycle"},
                           {run->segments_path, "--segments"},
                           {run->history_path, "--history"},
                           {run->schedule_path, "--schedule"},
                           {arguments->lcm, "--lcm"},
                           {arguments->record.slices, "--record"},
                           {arguments->record.all, "--record-all"},
                           {arguments->page.address, "--page"}};
    for (size_t i = 0; i < sizeof options_of_rows / sizeof options_of_rows[0]; ++i) {
        if (options_of_rows[i].is_given) {
            return options_of_rows[i].option;
        }
    }
    return NULL;
}

static void check_brief(const arguments_t *arguments, struct argp_state *state) {
    const char *other = option_of_rows(arguments);
    if (arguments->run.sections.brief && other) {
        argp_error(state, "--brief does not go with %s, which tells of each command", other);
    }
}

static void check_page(const arguments_t *arguments, struct argp_state *state) {
    if (arguments->rate > 0 && !arguments->page.address) {
        argp_error(state, "--rate: %g (goes with --page: without one nobody waits for the clock)",
                   arguments->rate);
    }
    if (arguments->watch && arguments->page.address) {
        argp_error(state, "--watch does not go with --page, which stays at one run");
    }
}

static void check_run_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->url && !arguments->lcm) {
        argp_error(state, "--lcm-url: %s (goes with --lcm)", arguments->url);
    }
    check_errors(arguments, state);
    check_counted(arguments, state);
    check_brief(arguments, state);
    check_page(arguments, state);
    if (arguments->watch && arguments->run.plays_again) {
        argp_error(state, "--watch does not go with --live: both listen for what is read");
    }
    if (arguments->watch && (arguments->lcm || arguments->record.slices || arguments->record.all)) {
        argp_error(state, "--watch goes neither with --lcm nor with a recording");
    }
}

static const wh_option_table_t tables[] = {
    {options, 0, NULL, check_run_arguments},
    {wh_record_options, offsetof(arguments_t, record), NULL, wh_record_arguments_check},
    {wh_run_options, offsetof(arguments_t, run), NULL, wh_run_arguments_check},
    {wh_run_counting_options, offsetof(arguments_t, run), NULL, wh_run_counting_check},
    {wh_run_error_options, offsetof(arguments_t, run), NULL, wh_run_errors_check},
    {wh_run_files_options, offsetof(arguments_t, run.files), NULL, NULL},
    {wh_run_again_options, offsetof(arguments_t, run), NULL, wh_run_again_check},
    {wh_live_options, offsetof(arguments_t, page), NULL, wh_live_check},
    {0}};

static const wh_command_line_t command_line = {
    .name = "run",
    .synopsis = "SCRIPT",
    .about = "Plays a motion script against the simulator and prints what came of it.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script)};

/* Runs with messages: over LCM, or within the process if only a record of them is wanted. */
static int run_published(arguments_t *arguments) {
    static wh_broadcast_t broadcast;
    if (!wh_broadcast_open(&broadcast, "run", &arguments->record, arguments->lcm, arguments->url)) {
        return WH_EXIT_USAGE;
    }
    arguments->run.recording = broadcast.record.options.path ? &broadcast.record : NULL;
    arguments->run.run.partners = wh_broadcast_partners(&broadcast);
    const int status = wh_run_and_print(&arguments->run);
    return wh_broadcast_close(&broadcast) ? status : WH_EXIT_USAGE;
}

static bool open_page(arguments_t *arguments, char **command) {
    const bool is_named = arguments->page.address && arguments->run.run.script;
    *command = is_named ? wh_run_command(wh_run_subcommand(&arguments->run), &arguments->run.run) : NULL;
    const wh_live_options_t wanted = {.speaker = "run",
                                      .title = arguments->run.run.script,
                                      .reproduce = *command,
                                      .rate = arguments->rate > 0 ? arguments->rate : 1,
                                      .controlled = WH_LIVE_RUN,
                                      .stays = true,
                                      .paces = true};
    return wh_live_open(&arguments->run.live, &arguments->page, &wanted);
}

static int play(void *user) {
    arguments_t *arguments = user;
    const bool published = arguments->lcm || arguments->run.record;
    if (!wh_run_files_are_apart(&arguments->run, NULL)) {
        return WH_EXIT_USAGE;
    }
    return published ? run_published(arguments) : wh_run_and_print(&arguments->run);
}

int wh_app_run(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    arguments.run.record = wh_record_arguments_path(&arguments.record, &arguments.run.record_option);
    char *command = NULL;
    int status = WH_EXIT_USAGE;
    if (open_page(&arguments, &command)) {
        status = arguments.watch ? wh_run_watch(&arguments.run, play, &arguments) : play(&arguments);
    }
    wh_live_close(arguments.run.live);
    free(command);
    wh_run_arguments_free(&arguments.run);
    return status;
}
