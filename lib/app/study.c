/* waferhand study SCRIPT */
#include <stdlib.h>

#include "../play/run_document.h"
#include "../print/study_print.h"
#include "../report/page.h"
#include "../report/study_document.h"
#include "../study/study_play.h"
#include "../text/array.h"
#include "apart.h"
#include "app.h"
#include "run_arguments.h"

#define MOST_TRIALS 1000000000

/* The trial if --trial is not given. */
#define NO_TRIAL UINT64_MAX

/* --worst and --require if they are not given. */
#define NO_WORST UINT64_MAX
#define NO_RATE (-1)

typedef struct {
    wh_run_arguments_t run; /* the script, its parameters and limits, and --json */
    uint64_t trials, seed, trial, threads, worst;
    const char *state, *csv;
    double require;
    bool counted;
} arguments_t;

static const wh_option_t options[] = {
    {"trials", 0, "N", "How many trials (default 1000), numbered from 0", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, trials), 1, MOST_TRIALS},
    {"seed", 0, "S", "Which errors are drawn (default 1): a trial is its number and this", WH_OPTION_COUNT,
     .variable = offsetof(arguments_t, seed)},
    {"trial", 0, "T", "Play this one trial alone and print it as run does", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, trial), 0, MOST_TRIALS - 1},
    {"threads", 0, "N", "On so many threads (default: one for each processor)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, threads), 1, 1024},
    {"state", 0, "FILE",
     "Keep what is done in FILE, and go on from there (default: a place of its own, until the study is done)",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, state)},
    {"require", 0, "RATE",
     "Exit with 1 unless the success rate is at least RATE, up to 1, with 95 % confidence", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, require), 0, 1},
    {"worst", 0, "K", "Tell the K worst trials (default 10)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, worst), 0, WH_STUDY_WORST},
    {"csv", 0, "FILE",
     "Write a line for each trial into FILE: if it was ok, where the wafers end up, and what was drawn",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, csv)},
    {"counted", 0, NULL, WH_RUN_COUNTED_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, counted)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_run_trials_options, offsetof(arguments_t, run), NULL, NULL},
    {wh_run_files_options, offsetof(arguments_t, run.files),
     "For the one trial that --trial plays, and --report of a whole study:", NULL},
    {0}};

/* Refuses options that only many trials can have. */
static void check_one(const arguments_t *arguments, struct argp_state *state) {
    const char *option = arguments->trials > 0          ? "--trials"
                         : arguments->state             ? "--state"
                         : arguments->require >= 0      ? "--require"
                         : arguments->worst != NO_WORST ? "--worst"
                         : arguments->csv               ? "--csv"
                         : arguments->threads > 0       ? "--threads"
                                                        : NULL;
    if (option) {
        argp_error(state, "%s does not go with --trial, which plays one trial alone", option);
    }
}

static void check_study_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->trial != NO_TRIAL) {
        check_one(arguments, state);
    }
    if (arguments->require >= 0 && !(arguments->require > 0)) {
        argp_error(state, "--require: 0 (expected above 0, up to 1: whatever happens keeps 0)");
    }
    const wh_run_files_t *files = &arguments->run.files;
    if ((files->scene || files->document || files->plots) && arguments->trial == NO_TRIAL) {
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
             "trials.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script),
    .check = check_study_arguments};

/* ---------------------------------------------------------------------------------------------- the study */

static bool write_csv(void *user, FILE *out) {
    return wh_study_print_csv(user, out) == 0;
}

typedef struct {
    const arguments_t *arguments;
    const wh_study_result_t *result;
    char message[WH_PAGE_MESSAGE_BYTES];
} page_t;

static bool write_page(void *user, FILE *out) {
    page_t *page = user;
    wh_study_result_t result = *page->result;
    wh_run_arguments_t run = page->arguments->run;
    char command[60];
    char *text = NULL;
    size_t size = 0;
    result.worst = WH_STUDY_WORST;
    (void)snprintf(command, sizeof command, "study --seed %llu", (unsigned long long)result.study->seed);
    run.command = command;
    char *again = wh_run_command(wh_run_subcommand(&run), &run.run);
    const wh_study_document_t document = {result.study, result.tally, wh_study_to_json(&result), again};
    FILE *memory = wh_memory_need(open_memstream(&text, &size));
    const bool made = wh_study_document_write(&document, memory) == 0;
    if (fclose(memory) != 0 || !made) {
        wh_memory_out();
    }
    const bool written = wh_page_write(out, WH_PAGE_STUDY, run.run.script, text, size, page->message);
    free(again);
    json_decref(document.result);
    free(text);
    return written;
}

/* If one output cannot be written, the others still are: the trials may have taken long. */
static int hand_on(const arguments_t *arguments, const wh_study_t *study, const wh_tally_t *tally) {
    wh_study_result_t result = {study, tally, arguments->require, (size_t)arguments->worst};
    const wh_style_t style = wh_style_of(stdout);
    page_t page = {.arguments = arguments, .result = &result};
    const bool drawn = wh_file_write("--report", arguments->run.files.page, write_page, &page, page.message);
    const bool written = wh_file_write("--csv", arguments->csv, write_csv, &result, NULL) && drawn;
    const int status = arguments->run.json ? wh_study_print_json(&result, stdout)
                                           : wh_study_print_table(&result, stdout, &style);
    if (!wh_app_is_printed(status) || !written) {
        return WH_EXIT_USAGE;
    }
    return wh_study_is_kept(&result) ? WH_EXIT_MET : WH_EXIT_FAILED;
}

static int play(const arguments_t *arguments, const wh_study_t *study, wh_ranks_t *ranks) {
    static const int statuses[] = {[WH_STUDY_INTERRUPTED] = WH_EXIT_FAILED,
                                   [WH_STUDY_FAILED] = WH_EXIT_USAGE,
                                   [WH_STUDY_HELPED] = WH_EXIT_MET};
    const wh_study_options_t wanted = {(size_t)arguments->threads, arguments->state};
    wh_progress_t progress;
    const wh_study_end_t end = wh_study_play(study, &wanted, ranks, &progress);
    int status = statuses[end];
    if (end == WH_STUDY_DONE) {
        status = hand_on(arguments, study, &progress.tally);
        wh_progress_free(&progress);
    }
    return status;
}

/* Checks before the trials are played that no output is the script, the layout, or a file that they read. */
static bool are_free(const arguments_t *arguments) {
    return (!arguments->state || wh_file_is_free("--state", arguments->state)) &&
           (!arguments->csv || wh_file_is_writable("--csv", arguments->csv)) &&
           (!arguments->run.files.page || wh_file_is_writable("--report", arguments->run.files.page));
}

/* Scripts print into /dev/null: the output of many trials would be mixed. */
static int study_all(const arguments_t *arguments) {
    static wh_study_t study;
    wh_ranks_t ranks;
    int status = WH_EXIT_USAGE;
    FILE *nowhere = fopen("/dev/null", "w");
    if (!nowhere) {
        perror("/dev/null");
        return status;
    }
    study = (wh_study_t){.run = arguments->run.run,
                         .trials = arguments->trials,
                         .seed = arguments->seed,
                         .lines = arguments->csv ? arguments->trials : 0};
    study.run.limits.print_to = nowhere;
    if (wh_study_open(&study) && are_free(arguments) && wh_ranks_open(&ranks)) {
        status = play(arguments, &study, &ranks);
        wh_ranks_close(&ranks, status == WH_EXIT_USAGE ? status : 0);
    }
    wh_study_close(&study);
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

static void fill_in(arguments_t *arguments) {
    arguments->trials = arguments->trials > 0 ? arguments->trials : 1000;
    arguments->worst = arguments->worst != NO_WORST ? arguments->worst : 10;
    arguments->require = arguments->require >= 0 ? arguments->require : 0;
}

int wh_app_study(int argc, char **argv) {
    arguments_t arguments = {.seed = 1, .trial = NO_TRIAL, .worst = NO_WORST, .require = NO_RATE};
    wh_options_parse(&command_line, argc, argv, &arguments);
    fill_in(&arguments);
    wh_run_arguments_take(&arguments.run);
    arguments.run.run.counts = arguments.counted ? WH_MCS_COUNT_BLIND : WH_MCS_COUNT_NONE;
    const bool all = arguments.trial == NO_TRIAL;
    const wh_named_file_t named[] = {{"the script", arguments.run.run.script, false},
                                     {"--state", arguments.state, true},
                                     {"--csv", arguments.csv, true},
                                     {"--report", all ? arguments.run.files.page : NULL, true}};
    int status = WH_EXIT_USAGE;
    if (wh_files_are_apart(named, 4, true)) {
        status = all ? study_all(&arguments) : play_one(&arguments);
    }
    wh_run_arguments_free(&arguments.run);
    return status;
}
