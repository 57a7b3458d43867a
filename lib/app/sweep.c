/* waferhand sweep SCRIPT */
#include "../print/sweep_print.h"
#include "../report/sweep_plot.h"
#include "../study/study_play.h"
#include "apart.h"
#include "app.h"
#include "run_arguments.h"

typedef struct {
    wh_run_arguments_t run; /* the script, its parameters and limits, and --json */
    uint64_t threads;
    const char *svg;
    bool counted;
} arguments_t;

static const wh_option_t options[] = {
    {"set", 0, "NAME=START:STEP:END",
     "Run with params.NAME from START to END; several such make a grid; NAME=VALUE hands over one value",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, run.parameters)},
    {"svg", 0, "FILE", "Also draw what the runs measure over the first parameter", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, svg)},
    {"counted", 0, NULL, WH_RUN_COUNTED_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, counted)},
    {"threads", 0, "N", "On so many threads (default: one for each processor)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, threads), 1, 1024},
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, run.json)},
    {"budget", 0, "N", "End a run's script after N steps: 1 each of Lua, 20 a slice (default 1e9)",
     WH_OPTION_REAL, .variable = offsetof(arguments_t, run.budget), 1, 1e18},
    {"memory", 0, "MIB", "Let a script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, run.memory_mib), 1, 1e6},
    {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL, NULL}, {0}};

static const wh_command_line_t command_line = {
    .name = "sweep",
    .synopsis = "SCRIPT",
    .about =
        "Runs a script once for each value of a parameter, or each combination of several, and tells "
        "which runs are ok, how long they take, and how near the picks come to their limits.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script)};

static bool write_plot(void *user, FILE *out) {
    wh_sweep_plot(user, out);
    return true;
}

static int hand_on(const arguments_t *arguments, wh_script_sweep_t *sweep) {
    const size_t undone = wh_sweep_count(sweep, WH_SWEEP_UNDONE);
    if (undone > 0) {
        fprintf(stderr, "interrupted: %zu of %zu runs are done\n", sweep->point_count - undone,
                sweep->point_count);
    }
    if (wh_sweep_count(sweep, WH_SWEEP_BAD) == sweep->point_count) {
        fprintf(stderr, "%s\n", sweep->points[0].reason);
        return WH_EXIT_USAGE;
    }
    if (!wh_file_write("--svg", arguments->svg, write_plot, sweep, NULL)) {
        return WH_EXIT_USAGE;
    }
    const wh_style_t style = wh_style_of(stdout);
    const int status = arguments->run.json ? wh_sweep_print_json(sweep, stdout)
                                           : wh_sweep_print_table(sweep, stdout, &style);
    if (!wh_app_is_printed(status)) {
        return WH_EXIT_USAGE;
    }
    return wh_sweep_count(sweep, WH_SWEEP_OK) == sweep->point_count ? WH_EXIT_MET : WH_EXIT_FAILED;
}

/* Scripts print into /dev/null: the output of many runs would be mixed. */
static int sweep_all(const arguments_t *arguments) {
    wh_script_sweep_t sweep = {.run = arguments->run.run,
                               .parameters = arguments->run.parameters.items,
                               .parameter_count = arguments->run.parameters.count};
    int status = WH_EXIT_USAGE;
    FILE *nowhere = fopen("/dev/null", "w");
    if (!nowhere) {
        perror("/dev/null");
        return status;
    }
    sweep.run.limits.print_to = nowhere;
    if (wh_sweep_open(&sweep) && wh_sweep_play(&sweep, wh_study_threads((size_t)arguments->threads))) {
        status = hand_on(arguments, &sweep);
    }
    wh_sweep_close(&sweep);
    (void)fclose(nowhere);
    return status;
}

int wh_app_sweep(int argc, char **argv) {
    arguments_t arguments = {.threads = 0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    arguments.run.run.counts = arguments.counted ? WH_MCS_COUNT_BLIND : WH_MCS_COUNT_NONE;
    const wh_named_file_t named[] = {{"the script", arguments.run.run.script, false},
                                     {"--svg", arguments.svg, true}};
    const int status = wh_files_are_apart(named, 2, true) ? sweep_all(&arguments) : WH_EXIT_USAGE;
    wh_run_arguments_free(&arguments.run);
    return status;
}
