/* waferhand sweep SCRIPT */
#include <stdlib.h>
#include <string.h>

#include "../print/sweep_print.h"
#include "../report/sweep_plot.h"
#include "../study/study_play.h"
#include "apart.h"
#include "app.h"
#include "run_arguments.h"
#include "sweep_best.h"

typedef struct {
    wh_run_arguments_t run; /* the script, its parameters and limits, and --json */
    uint64_t threads, best;
    const char *svg, *by;
    bool counted;
    wh_option_list_t each;
} arguments_t;

static const wh_option_t options[] = {
    {"set", 0, "NAME=START:STEP:END",
     "Run with params.NAME from START to END; several such make a grid; NAME=VALUE hands over one value",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, run.parameters)},
    {"each", 0, "NAME=A,B,C",
     "Run with params.NAME as each of these words or numbers, such as rule=backward,swap; goes with ranges",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, each)},
    {"by", 0, "PERCENT",
     "Run once as it is, and once for each mechanism and station of the cell, and for the parallel stations "
     "of a "
     "flow's step together, which take PERCENT less time; tell what each gains, the greatest first",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, by)},
    {"until-steady", 0, NULL, WH_RUN_STEADY_HELP, WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, run.run.until_steady)},
    {"best", 0, "N",
     "Search for the shortest schedule of the script's flow, a small one of timed robots, with at most N "
     "nodes a "
     "level, such as 1000; tell it as lists, and a bound that no schedule is below",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, best), 1, 1000000},
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

/* A number up to 90, with or without a percent sign behind it. */
static double read_percent(const char *text) {
    char *end = NULL;
    const double percent = strtod(text, &end);
    end += strspn(end, " ");
    end += *end == '%' ? 1 : 0;
    return end != text && *end == '\0' && percent >= 0.01 && percent <= 90 ? percent : -1;
}

/* --by and --best do not vary parameters. */
static void check_alone(const arguments_t *arguments, struct argp_state *state, const char *option) {
    const char *other = arguments->svg ? "--svg" : arguments->each.count > 0 ? "--each" : NULL;
    if (other) {
        argp_error(state, "%s does not go with %s, which varies parameters", option, other);
    }
    if (arguments->by && arguments->best > 0) {
        argp_error(state, "--by does not go with --best");
    }
}

static void check_sweep_arguments(const void *filled, struct argp_state *state) {
    const arguments_t *arguments = filled;
    if (arguments->by && read_percent(arguments->by) < 0) {
        argp_error(state, "--by: %s (expected percent, 0.01 to 90)", arguments->by);
    }
    if (arguments->by || arguments->best > 0) {
        check_alone(arguments, state, arguments->by ? "--by" : "--best");
    }
}

static const wh_option_table_t tables[] = {{options, 0, NULL, check_sweep_arguments}, {0}};

static const wh_command_line_t command_line = {
    .name = "sweep",
    .synopsis = "SCRIPT",
    .about = "Runs a script once for each value of a parameter, or each combination of several, and tells "
             "which runs are ok, how long they take, how near the picks come to their limits, and of flows "
             "what limits them.\v" WH_HELP_EXIT,
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

/* A drawing goes over numbers. */
static bool can_be_drawn(const arguments_t *arguments, const wh_script_sweep_t *sweep) {
    const bool can = !arguments->svg || !sweep->axes[0].words;
    if (!can) {
        fprintf(stderr, "--svg: over which numbers? (expected --set NAME=START:STEP:END)\n");
    }
    return can;
}

static int sweep_all(const arguments_t *arguments, FILE *nowhere) {
    wh_script_sweep_t sweep = {.run = arguments->run.run,
                               .parameters = arguments->run.parameters.items,
                               .parameter_count = arguments->run.parameters.count,
                               .each = arguments->each.items,
                               .each_count = arguments->each.count};
    int status = WH_EXIT_USAGE;
    sweep.run.limits.print_to = nowhere;
    if (wh_sweep_open(&sweep) && can_be_drawn(arguments, &sweep) &&
        wh_sweep_play(&sweep, wh_study_threads((size_t)arguments->threads))) {
        status = hand_on(arguments, &sweep);
    }
    wh_sweep_close(&sweep);
    return status;
}

static int hand_on_paces(const arguments_t *arguments, const wh_paces_t *paces) {
    const wh_style_t style = wh_style_of(stdout);
    size_t ok = paces->base.verdict == WH_SWEEP_OK ? 1 : 0;
    for (size_t i = 0; i < paces->count; ++i) {
        ok += paces->paces[i].point.verdict == WH_SWEEP_OK ? 1 : 0;
    }
    const int status = arguments->run.json ? wh_paces_print_json(paces, stdout)
                                           : wh_paces_print_table(paces, stdout, &style);
    return !wh_app_is_printed(status) ? WH_EXIT_USAGE : ok == paces->count + 1 ? WH_EXIT_MET : WH_EXIT_FAILED;
}

/* Each run differs in the time of one mechanism alone. */
static bool has_range(const arguments_t *arguments) {
    for (size_t i = 0; i < arguments->run.parameters.count; ++i) {
        if (wh_sweep_is_range(arguments->run.parameters.items[i])) {
            fprintf(stderr, "--set %s: a range does not go with %s (expected one value)\n",
                    arguments->run.parameters.items[i], arguments->by ? "--by" : "--best");
            return true;
        }
    }
    return false;
}

static int hasten_all(const arguments_t *arguments, FILE *nowhere) {
    wh_paces_t paces = {.run = arguments->run.run, .share = read_percent(arguments->by) / 100};
    int status = WH_EXIT_USAGE;
    paces.run.limits.print_to = nowhere;
    if (wh_paces_play(&paces, wh_study_threads((size_t)arguments->threads))) {
        status = hand_on_paces(arguments, &paces);
    }
    wh_paces_close(&paces);
    return status;
}

/* Scripts print into /dev/null: the output of many runs would be mixed. */
static int play(const arguments_t *arguments) {
    FILE *nowhere = fopen("/dev/null", "w");
    if (!nowhere) {
        perror("/dev/null");
        return WH_EXIT_USAGE;
    }
    int status = WH_EXIT_USAGE;
    if (!arguments->by && arguments->best == 0) {
        status = sweep_all(arguments, nowhere);
    } else if (!has_range(arguments)) {
        status = arguments->by ? hasten_all(arguments, nowhere)
                               : wh_app_sweep_best(&arguments->run, (size_t)arguments->best, nowhere);
    }
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
    const int status = wh_files_are_apart(named, 2, true) ? play(&arguments) : WH_EXIT_USAGE;
    wh_option_list_free(&arguments.each);
    wh_run_arguments_free(&arguments.run);
    return status;
}
