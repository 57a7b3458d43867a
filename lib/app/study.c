/* waferhand study SCRIPT */
#include <errno.h>
#include <string.h>

#include "../print/study_print.h"
#include "../study/study_play.h"
#include "app.h"
#include "run_arguments.h"

#define MOST_TRIALS 1000000000

/* The trial if --trial is not given. */
#define NO_TRIAL UINT64_MAX

typedef struct {
    wh_run_arguments_t run; /* the script, its parameters and limits, and --json */
    uint64_t trials, seed, trial, threads, worst;
    const char *state;
    double require;
} arguments_t;

static const wh_option_t options[] = {
    {"trials", 0, "N", "How many trials (default 1000), numbered from 0", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, trials), 1, MOST_TRIALS, "a number from 1 to 1000000000"},
    {"seed", 0, "S", "Which errors are drawn (default 1): a trial is its number and this", WH_OPTION_COUNT,
     .variable = offsetof(arguments_t, seed), .expected = "a whole number from 0 to 18446744073709551615"},
    {"trial", 0, "T", "Play this one trial alone and print it as run does", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, trial), 0, MOST_TRIALS, "a number from 0 to 1000000000"},
    {"threads", 0, "N", "On so many threads (default: one for each processor)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, threads), 1, 1024, "a number from 1 to 1024"},
    {"state", 0, "FILE",
     "Keep what is done in FILE, and go on from there (default: a place of its own, until the study is done)",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, state)},
    {"require", 0, "RATE",
     "Exit with 1 unless the success rate is at least RATE, 0 to 1, with 95 % confidence", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, require), 0, 1, "a number from 0 to 1"},
    {"worst", 0, "K", "Tell the K worst trials (default 10)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, worst), 0, WH_STUDY_WORST, "a number from 0 to 100"},
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, run.json)},
    {"set", 0, "NAME=VALUE", "Hand script and layout a parameter: params.NAME", WH_OPTION_LIST,
     .variable = offsetof(arguments_t, run.parameters)},
    {"budget", 0, "N", "End a trial's script after N steps of Lua and simulated slices (default 1e9)",
     WH_OPTION_REAL, .variable = offsetof(arguments_t, run.budget), 1, 1e18, "a number from 1 to 1e+18"},
    {"memory", 0, "MIB", "Let a script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, run.memory_mib), 1, 1e6, "a number from 1 to 1000000"},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL},
    {wh_run_files_options, offsetof(arguments_t, run.files), "Of the one trial that --trial plays:"},
    {0}};

static void check(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (!arguments->run.run.script) {
        argp_error(state, "which script?");
    }
    if (wh_run_files_wanted(&arguments->run.files) && arguments->trial == NO_TRIAL) {
        argp_error(state, "a report of which trial? (expected --trial)");
    }
}

static const wh_command_line_t command_line = {
    .name = "study",
    .synopsis = "SCRIPT",
    .about = "Plays a script many times, each time with wafers, stations, valves and vacuum a little off as "
             "the layout's "
             "`study` says, and tells how often all goes well and where the wafers end up. Under mpirun the "
             "ranks share the "
             "trials.\v"
             "Exit status: 0 if the study was finished and what is required is kept, 1 if not, 2 for wrong "
             "usage or a bad "
             "input file; with --trial as for run.",
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script),
    .check = check};

/* ---------------------------------------------------------------------------------------------- the study */

static int print(const arguments_t *arguments, const wh_study_t *study, const wh_tally_t *tally) {
    const wh_study_result_t result = {study, tally, arguments->require, (size_t)arguments->worst};
    const wh_style_t style = wh_style_of(stdout);
    const int status = arguments->run.json ? wh_study_print_json(&result, stdout)
                                           : wh_study_print_table(&result, stdout, &style);
    if (!wh_app_is_printed(status)) {
        return WH_EXIT_USAGE;
    }
    return wh_study_is_kept(&result) ? WH_EXIT_MET : WH_EXIT_FAILED;
}

static int play(const arguments_t *arguments, const wh_study_t *study, wh_ranks_t *ranks) {
    const wh_study_options_t wanted = {(size_t)arguments->threads, arguments->state};
    wh_progress_t progress;
    switch (wh_study_play(study, &wanted, ranks, &progress)) {
    case WH_STUDY_DONE: {
        const int status = print(arguments, study, &progress.tally);
        wh_progress_free(&progress);
        return status;
    }
    case WH_STUDY_INTERRUPTED:
        return WH_EXIT_FAILED;
    case WH_STUDY_HELPED:
        return WH_EXIT_MET;
    case WH_STUDY_FAILED:
    default:
        return WH_EXIT_USAGE;
    }
}

/* Scripts print into /dev/null: the output of many trials would be mixed. */
static int study_with(const arguments_t *arguments, FILE *nowhere) {
    static wh_study_t study;
    wh_ranks_t ranks;
    int status = WH_EXIT_USAGE;
    memset(&study, 0, sizeof study);
    study.run = arguments->run.run;
    study.run.limits.print_to = nowhere;
    study.trials = arguments->trials;
    study.seed = arguments->seed;
    if (wh_study_open(&study) && wh_ranks_open(&ranks)) {
        status = play(arguments, &study, &ranks);
        wh_ranks_close(&ranks, status == WH_EXIT_USAGE ? status : 0);
    }
    wh_study_close(&study);
    return status;
}

static int study_all(const arguments_t *arguments) {
    FILE *nowhere = fopen("/dev/null", "w");
    if (!nowhere) {
        perror("/dev/null");
        return WH_EXIT_USAGE;
    }
    const int status = study_with(arguments, nowhere);
    fclose(nowhere);
    return status;
}

static int play_one(arguments_t *arguments) {
    const wh_trial_t trial = {arguments->seed, arguments->trial};
    char command[80];
    (void)snprintf(command, sizeof command, "study --seed %llu --trial %llu",
                   (unsigned long long)arguments->seed, (unsigned long long)arguments->trial);
    arguments->run.run.trial = &trial;
    arguments->run.command = command;
    return wh_run_and_print(&arguments->run);
}

int wh_app_study(int argc, char **argv) {
    arguments_t arguments = {.trials = 1000, .seed = 1, .trial = NO_TRIAL, .worst = 10};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    const int status = arguments.trial != NO_TRIAL ? play_one(&arguments) : study_all(&arguments);
    wh_run_arguments_free(&arguments.run);
    return status;
}
