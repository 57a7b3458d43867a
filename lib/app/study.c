/* waferhand study SCRIPT */
#include <argp.h>
#include <errno.h>
#include <string.h>

#include "../print/study_print.h"
#include "../study/study_play.h"
#include "../text/number.h"
#include "app.h"
#include "run_arguments.h"

enum {
    OPTION_TRIALS = 1000,
    OPTION_SEED,
    OPTION_TRIAL,
    OPTION_THREADS,
    OPTION_STATE,
    OPTION_REQUIRE,
    OPTION_WORST,
    OPTION_JSON,
    OPTION_SET,
    OPTION_BUDGET,
    OPTION_MEMORY
};

#define MOST_TRIALS 1000000000

typedef struct {
    wh_run_arguments_t run; /* the script, its parameters and limits, and --json */
    wh_study_options_t study;
    uint64_t trials, seed, trial;
    double require;
    size_t worst;
    bool one; /* trial alone */
} arguments_t;

static const struct argp_option options[] = {
    {"trials", OPTION_TRIALS, "N", 0, "How many trials (default 1000), numbered from 0", 0},
    {"seed", OPTION_SEED, "S", 0, "Which errors are drawn (default 1): a trial is its number and this", 0},
    {"trial", OPTION_TRIAL, "T", 0, "Play this one trial alone and print it as run does", 0},
    {"threads", OPTION_THREADS, "N", 0, "On so many threads (default: one for each processor)", 0},
    {"state", OPTION_STATE, "FILE", 0,
     "Keep what is done in FILE, and go on from there (default: a place of its own, until the study is done)",
     0},
    {"require", OPTION_REQUIRE, "RATE", 0,
     "Exit with 1 unless the success rate is at least RATE, 0 to 1, with 95 % confidence", 0},
    {"worst", OPTION_WORST, "K", 0, "Tell the K worst trials (default 10)", 0},
    {"json", OPTION_JSON, NULL, 0, "Print the result as one JSON object", 0},
    {"set", OPTION_SET, "NAME=VALUE", 0, "Hand script and layout a parameter: params.NAME", 0},
    {"budget", OPTION_BUDGET, "N", 0,
     "End a trial's script after N steps of Lua and simulated slices (default 1e9)", 0},
    {"memory", OPTION_MEMORY, "MIB", 0, "Let a script use so many MiB of memory (default 256)", 0},
    {0},
};

/* A number as it must be, 1000000 or 1e6. */
static double number(const struct argp_state *state, const char *name, const char *text, double min,
                     double max) {
    double value = 0;
    if (!wh_number_read(text, min, max, &value)) {
        argp_error(state, "--%s: %s (expected a number from %.12g to %.12g)", name, text, min, max);
    }
    return value;
}

static uint64_t whole(const struct argp_state *state, const char *name, const char *text, double min,
                      double max) {
    const double value = number(state, name, text, min, max);
    if ((double)(uint64_t)value < value) {
        argp_error(state, "--%s: %s (expected a whole number)", name, text);
    }
    return (uint64_t)value;
}

static uint64_t seed(const struct argp_state *state, const char *text) {
    uint64_t value = 0;
    if (!wh_number_read_whole(text, &value)) {
        argp_error(state, "--seed: %s (expected a whole number from 0 to 18446744073709551615)", text);
    }
    return value;
}

/* What the study is; false for other options. */
static bool take_study(arguments_t *arguments, const struct argp_state *state, int key, char *argument) {
    switch (key) {
    case OPTION_TRIALS:
        arguments->trials = whole(state, "trials", argument, 1, MOST_TRIALS);
        return true;
    case OPTION_SEED:
        arguments->seed = seed(state, argument);
        return true;
    case OPTION_TRIAL:
        arguments->trial = whole(state, "trial", argument, 0, MOST_TRIALS);
        arguments->one = true;
        return true;
    case OPTION_THREADS:
        arguments->study.threads = (size_t)whole(state, "threads", argument, 1, 1024);
        return true;
    case OPTION_STATE:
        arguments->study.state = argument;
        return true;
    case OPTION_REQUIRE:
        arguments->require = number(state, "require", argument, 0, 1);
        return true;
    case OPTION_WORST:
        arguments->worst = (size_t)whole(state, "worst", argument, 0, WH_STUDY_WORST);
        return true;
    default:
        return false;
    }
}

/* How a script is run, as `run` takes it; false for other options. */
static bool take_run(arguments_t *arguments, const struct argp_state *state, int key, char *argument) {
    wh_script_run_options_t *run = &arguments->run.run;
    switch (key) {
    case OPTION_JSON:
        arguments->run.json = true;
        return true;
    case OPTION_SET:
        arguments->run.parameters[run->parameter_count++] = argument;
        return true;
    case OPTION_BUDGET:
        run->limits.instructions = (uint64_t)number(state, "budget", argument, 1, 1e18);
        return true;
    case OPTION_MEMORY:
        run->limits.memory_bytes = (size_t)(number(state, "memory", argument, 1, 1e6) * 1048576);
        return true;
    default:
        return false;
    }
}

static error_t parse(int key, char *argument, struct argp_state *state) {
    arguments_t *arguments = state->input;
    wh_script_run_options_t *run = &arguments->run.run;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &arguments->run.files;
        return 0;
    case ARGP_KEY_ARG:
        if (run->script) {
            argp_error(state, "%s: one script is enough", argument);
        }
        run->script = argument;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "which script?");
        return EINVAL;
    case ARGP_KEY_END:
        if (wh_report_files_wanted(&arguments->run.files) && !arguments->one) {
            argp_error(state, "a report of which trial? (expected --trial)");
        }
        return 0;
    default:
        return take_study(arguments, state, key, argument) || take_run(arguments, state, key, argument)
                   ? 0
                   : ARGP_ERR_UNKNOWN;
    }
}

/* ---------------------------------------------------------------------------------------------------- the study */

static int print(const arguments_t *arguments, const wh_study_t *study, const wh_tally_t *tally) {
    const wh_study_result_t result = {study, tally, arguments->require, arguments->worst};
    const wh_style_t style = wh_style_of(stdout);
    const int status = arguments->run.json ? wh_study_print_json(&result, stdout)
                                           : wh_study_print_table(&result, stdout, &style);
    if (status != 0 || fflush(stdout) != 0) {
        fprintf(stderr, "standard output: %s\n", strerror(errno));
        return WH_EXIT_USAGE;
    }
    return wh_study_is_kept(&result) ? WH_EXIT_MET : WH_EXIT_FAILED;
}

static int play(const arguments_t *arguments, const wh_study_t *study, wh_ranks_t *ranks) {
    wh_progress_t progress;
    switch (wh_study_play(study, &arguments->study, ranks, &progress)) {
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

/* What a script prints would stand among what others print. */
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
    static const struct argp_child children[] = {
        {&wh_report_files_argp, 0, "Of the one trial that --trial plays:", 2}, {0}};
    static const struct argp argp = {options,
                                     parse,
                                     "SCRIPT",
                                     "Plays a script many times, each time with wafers, stations, valves and "
                                     "vacuum a little off as the layout's `study` "
                                     "says, and tells how often all goes well and where the wafers end up. "
                                     "Under mpirun the ranks share the trials.\v"
                                     "Exit status: 0 if the study was finished and what is required is kept, "
                                     "1 if not, 2 for wrong usage or a bad "
                                     "input file; with --trial as for run.",
                                     children,
                                     NULL,
                                     NULL};
    static char name[] = "waferhand study";
    arguments_t arguments = {.trials = 1000, .seed = 1, .worst = 10};
    wh_run_arguments_init(&arguments.run, argc);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    const int status = arguments.one ? play_one(&arguments) : study_all(&arguments);
    wh_run_arguments_free(&arguments.run);
    return status;
}
