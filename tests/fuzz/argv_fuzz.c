/* Any words as the program's arguments, one on each line, the subcommand first. They are refused,
 * or the options that the subcommand would use are in their ranges. Nothing is run, opened or
 * written.
 *
 * The linker replaces functions that end the process or begin the work by __wrap_...: see
 * tests/fuzz/fuzz.mk. */
#include <argp.h>
#include <math.h>
#include <setjmp.h>
#include <string.h>

#include "app/apart.h"
#include "app/app.h"
#include "app/connection.h"
#include "app/new_cell.h"
#include "app/run_arguments.h"
#include "app/test_find.h"
#include "app/watch.h"
#include "fuzz.h"
#include "host/host.h"
#include "layout/layout.h"
#include "mcs/definitions.h"
#include "study/study.h"
#include "study/sweep.h"
#include "text/csv.h"

#define WORDS 24

static bool refused;  /* by the parser */
static bool finished; /* parsing */
static bool reached;  /* the work */
static int word_count;

/* ------------------------------------------------------------------------------------------------- parsing */

/* argp_error ends the process; here it ends the parser's call, which then fails. The first call
 * alone does not end it: argp would keep its memory. */
static jmp_buf parser_call;
static argp_parser_t own_parser;

static error_t parse_own(int key, char *argument, struct argp_state *state) {
    if (setjmp(parser_call) != 0) {
        return key == ARGP_KEY_INIT ? 0 : EINVAL;
    }
    return own_parser(key, argument, state);
}

void __wrap_argp_error(const struct argp_state *state, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
error_t __real_argp_parse(const struct argp *argp, int argc, char **argv, unsigned flags, int *end,
                          void *input);
error_t __wrap_argp_parse(const struct argp *argp, int argc, char **argv, unsigned flags, int *end,
                          void *input);

void __wrap_argp_error(const struct argp_state *state, const char *format, ...) {
    char text[400];
    va_list arguments;
    (void)state;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    REQUIRE(!finished);
    refused = true;
    longjmp(parser_call, 1);
}

error_t __wrap_argp_parse(const struct argp *argp, int argc, char **argv, unsigned flags, int *end,
                          void *input) {
    struct argp own = *argp;
    own_parser = argp->parser;
    own.parser = parse_own;
    REQUIRE(!argp->children);
    const error_t error =
        __real_argp_parse(&own, argc, argv, flags | ARGP_NO_EXIT | ARGP_NO_ERRS, end, input);
    refused = refused || error != 0;
    finished = true;
    return error;
}

/* ------------------------------------------------------------------------------------- where the work begins */

int __wrap_wh_run_and_print(wh_run_arguments_t *arguments);
bool __wrap_wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options);
bool __wrap_wh_live_open(wh_live_t **live, const wh_live_arguments_t *arguments,
                         const wh_live_options_t *options);
bool __real_wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints);
bool __wrap_wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints);
FILE *__wrap_wh_log_file(const char *path, const char **fault);
bool __wrap_wh_study_open(wh_study_t *study);
bool __real_wh_sweep_open(wh_script_sweep_t *sweep);
bool __wrap_wh_sweep_open(wh_script_sweep_t *sweep);
bool __wrap_wh_sweep_play(wh_script_sweep_t *sweep, size_t threads);
int __wrap_wh_watch(const wh_watch_options_t *options);
bool __wrap_wh_new_cell_is_free(const char *folder);
bool __wrap_wh_new_cell_make(const wh_new_cell_t *cell, const char *folder);
char *__wrap_wh_definitions_make(wh_sandbox_result_t *result);
bool __wrap_wh_test_play(const wh_test_job_t jobs[], size_t count, const wh_test_options_t *options,
                         wh_test_result_t results[]);
bool __wrap_wh_test_find(const wh_option_list_t *paths, wh_test_found_t *found);
bool __wrap_wh_csv_open(wh_csv_t *csv, const char *path, const wh_csv_column_t *columns, size_t count);
bool __wrap_wh_session_open(wh_session_t *session, const wh_session_options_t *options);
bool __wrap_wh_dialect_open(wh_dialect_t *dialect, const char *path, const char *unit);
bool __wrap_wh_transcript_open(wh_transcript_t *transcript, const char *path);
bool __wrap_wh_node_open(wh_node_t *node, const char *url, const wh_node_recorder_t *recorder);
bool __wrap_wh_node_reaches_others(const char *url);
wh_sandbox_t *__wrap_wh_sandbox_new_with(const wh_sandbox_limits_t *limits, const char *const assignments[],
                                         size_t count, wh_sandbox_result_t *result);
void __wrap_wh_sandbox_free(wh_sandbox_t *sandbox);
const wh_layout_t *__wrap_wh_layout_load(wh_sandbox_t *sandbox, const char *path,
                                         wh_sandbox_result_t *result);
FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);

static void check_parameters(const char *const *parameters, size_t count) {
    REQUIRE(count <= (size_t)word_count);
    for (size_t i = 0; i < count; ++i) {
        REQUIRE(parameters[i] != NULL);
    }
}

static void check_run(const wh_script_run_options_t *run) {
    check_parameters(run->parameters, run->parameter_count);
    check_parameters(run->errors, run->error_count);
    REQUIRE(run->limits.instructions <= UINT64_C(1000000000000000000));
    REQUIRE(run->limits.memory_bytes == 0 || run->limits.memory_bytes >= (size_t)1 << 20);
    REQUIRE(run->limits.memory_bytes <= (size_t)1000000 << 20);
}

int __wrap_wh_run_and_print(wh_run_arguments_t *arguments) {
    reached = true;
    if (!refused) {
        REQUIRE(arguments->run.script != NULL);
        check_run(&arguments->run);
    }
    return WH_EXIT_USAGE;
}

/* Two of the files are the same one. */
/* No page is served. */
bool __wrap_wh_live_open(wh_live_t **live, const wh_live_arguments_t *arguments,
                         const wh_live_options_t *options) {
    REQUIRE(refused || options->speaker != NULL);
    REQUIRE(refused || arguments->address || !(arguments->opens || arguments->controls));
    *live = NULL;
    return true;
}

bool __wrap_wh_files_are_apart(const wh_named_file_t files[], size_t count, bool prints) {
    const bool apart = __real_wh_files_are_apart(files, count, prints);
    refused = refused || !apart;
    return apart;
}

FILE *__wrap_wh_log_file(const char *path, const char **fault) {
    reached = true;
    REQUIRE(refused || path != NULL);
    *fault = "not opened";
    return NULL;
}

bool __wrap_wh_study_open(wh_study_t *study) {
    reached = true;
    if (!refused) {
        REQUIRE(study->run.script != NULL);
        check_run(&study->run);
        REQUIRE(study->trials >= 1 && study->trials <= 1000000000);
    }
    return false;
}

/* Ranges are read as they are; an invalid one is refused. */
bool __wrap_wh_sweep_open(wh_script_sweep_t *sweep) {
    refused = refused || !__real_wh_sweep_open(sweep);
    return !refused;
}

bool __wrap_wh_sweep_play(wh_script_sweep_t *sweep, size_t threads) {
    reached = true;
    REQUIRE(sweep->run.script != NULL && threads >= 1);
    REQUIRE(sweep->axis_count >= 1 && sweep->axis_count <= WH_SWEEP_AXES);
    REQUIRE(sweep->point_count >= 1 && sweep->point_count <= WH_SWEEP_MOST);
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        REQUIRE(isfinite(wh_sweep_value(sweep, sweep->point_count - 1, axis)));
    }
    check_parameters(sweep->parameters, sweep->parameter_count);
    return false;
}

bool __wrap_wh_test_play(const wh_test_job_t jobs[], size_t count, const wh_test_options_t *options,
                         wh_test_result_t results[]) {
    (void)results;
    reached = true;
    if (!refused) {
        for (size_t i = 0; i < count; ++i) {
            REQUIRE(jobs[i].path != NULL);
        }
        check_run(&options->run);
        REQUIRE(options->processes >= 1 && options->processes <= 1024);
        REQUIRE(options->timeout_s >= 1e-3 && options->timeout_s <= 1e6);
    }
    return false;
}

/* It would wait until somebody saves a file. */
int __wrap_wh_watch(const wh_watch_options_t *options) {
    reached = true;
    REQUIRE(options->act != NULL);
    return options->act(options->user);
}

bool __wrap_wh_new_cell_is_free(const char *folder) {
    REQUIRE(refused || folder != NULL);
    return true;
}

bool __wrap_wh_new_cell_make(const wh_new_cell_t *cell, const char *folder) {
    reached = true;
    REQUIRE(refused || folder != NULL);
    REQUIRE(refused || (cell->wafer >= 100 && cell->wafer <= 300));
    REQUIRE(refused || cell->foups - 1 < WH_NEW_FOUPS);
    REQUIRE(refused || cell->blades - 1 < WH_NEW_BLADES);
    REQUIRE(refused || cell->modules - 1 < WH_NEW_MODULES);
    REQUIRE(refused || cell->locks <= WH_NEW_LOCKS);
    return false;
}

char *__wrap_wh_definitions_make(wh_sandbox_result_t *result) {
    reached = true;
    snprintf(result->message, sizeof result->message, "not made");
    return NULL;
}

/* The machine's folders are not searched. */
bool __wrap_wh_test_find(const wh_option_list_t *paths, wh_test_found_t *found) {
    reached = true;
    for (size_t i = 0; i < paths->count; ++i) {
        REQUIRE(paths->items[i] != NULL);
        wh_test_found_add(found, paths->items[i], true);
    }
    return true;
}

bool __wrap_wh_csv_open(wh_csv_t *csv, const char *path, const wh_csv_column_t *columns, size_t count) {
    reached = true;
    REQUIRE(columns != NULL && count > 0 && (refused || path != NULL));
    snprintf(csv->message, sizeof csv->message, "not read");
    return false;
}

bool __wrap_wh_mcs_link_open(wh_mcs_link_t *link, const wh_mcs_link_options_t *options) {
    (void)link;
    reached = true;
    REQUIRE(refused || options->client.rate == 0 ||
            (options->client.rate >= 1e-3 && options->client.rate <= 1e3));
    REQUIRE(refused || (options->client.timeout_us >= 0 && options->client.timeout_us <= 1000000000000));
    return false;
}

/* `serve`, with ports at which nothing listens. */
bool __wrap_wh_session_open(wh_session_t *session, const wh_session_options_t *options) {
    reached = true;
    if (!refused) {
        REQUIRE(options->layout != NULL);
        check_parameters(options->parameters, options->parameter_count);
        REQUIRE(options->limits.memory_bytes == 0 || options->limits.memory_bytes >= (size_t)1 << 20);
        REQUIRE(options->limits.memory_bytes <= (size_t)1000000 << 20);
    }
    memset(session, 0, sizeof *session);
    snprintf(session->message, sizeof session->message, "not opened");
    return false;
}

bool __wrap_wh_dialect_open(wh_dialect_t *dialect, const char *path, const char *unit) {
    (void)unit;
    reached = true;
    REQUIRE(refused || path != NULL);
    memset(dialect, 0, sizeof *dialect);
    return false;
}

bool __wrap_wh_transcript_open(wh_transcript_t *transcript, const char *path) {
    reached = true;
    REQUIRE(refused || path != NULL);
    memset(transcript, 0, sizeof *transcript);
    return false;
}

bool __wrap_wh_node_reaches_others(const char *url) {
    (void)url;
    return true;
}

bool __wrap_wh_node_open(wh_node_t *node, const char *url, const wh_node_recorder_t *recorder) {
    (void)node;
    (void)url;
    (void)recorder;
    reached = true;
    return false;
}

/* `sim` hands its parameters to a sandbox before it reads the layout: one sandbox serves a thousand
 * inputs. */
static wh_sandbox_t *shared;
static unsigned uses;

void __real_wh_sandbox_free(wh_sandbox_t *sandbox);

/* The real function sets each parameter; it explains a refusal in one line. */
wh_sandbox_t *__wrap_wh_sandbox_new_with(const wh_sandbox_limits_t *limits, const char *const assignments[],
                                         size_t count, wh_sandbox_result_t *result) {
    bool set = true;
    if (++uses % 1000 == 0) {
        __real_wh_sandbox_free(shared);
        shared = NULL;
    }
    if (!shared) {
        shared = wh_sandbox_new(limits);
    }
    reached = true;
    check_parameters(assignments, count);
    for (size_t i = 0; set && i < count; ++i) {
        set = wh_sandbox_set_parameter(shared, assignments[i], result);
        REQUIRE(set == (result->message[0] == '\0') && fuzz_is_one_line(result->message));
    }
    return set ? shared : NULL;
}

void __wrap_wh_sandbox_free(wh_sandbox_t *sandbox) {
    REQUIRE(!sandbox || sandbox == shared);
}

const wh_layout_t *__wrap_wh_layout_load(wh_sandbox_t *sandbox, const char *path,
                                         wh_sandbox_result_t *result) {
    (void)sandbox;
    reached = true;
    REQUIRE(refused || path != NULL);
    snprintf(result->message, sizeof result->message, "not read");
    return NULL;
}

/* The fuzzer opens files, too: it saves its findings. */
FILE *__wrap_fopen(const char *path, const char *mode) {
    if (mode[0] == 'w') {
        return __real_fopen(path, mode);
    }
    reached = true;
    REQUIRE(refused || path != NULL);
    errno = ENOENT;
    return NULL;
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    fuzz_silence();
    return 0;
}

/* ------------------------------------------------------------------------------------------------- the words */

/* argp's own hidden option, which sleeps for an hour; its abbreviations by the first letters count, too. */
static bool sleeps(const char *word) {
    return strncmp(word, "--H", 3) == 0;
}

static char *split(const uint8_t *data, size_t size, char **argv) {
    char *const text = malloc(size + 1);
    REQUIRE(text != NULL);
    for (size_t i = 0; i < size; ++i) {
        text[i] = (char)(unsigned char)data[i];
    }
    text[size] = '\0';
    char *at = text;
    for (word_count = 0; word_count < WORDS && at; ++word_count) {
        argv[word_count] = at;
        at = strchr(at, '\n');
        if (at) {
            *at++ = '\0';
        }
    }
    argv[word_count] = NULL;
    return text;
}

static int act(int argc, char **argv) {
    static int (*const subcommands[])(int argc, char **argv) = {
        wh_app_run,     wh_app_mcs,      wh_app_sim,     wh_app_replay,      wh_app_report, wh_app_layout,
        wh_app_study,   wh_app_estimate, wh_app_test,    wh_app_diff,        wh_app_events, wh_app_csv,
        wh_app_check,   wh_app_sweep,    wh_app_new,     wh_app_definitions, wh_app_budget, wh_app_serve,
        wh_app_dialect, wh_app_converse, wh_app_schedule};
    static const char *const names[] = {"run",     "mcs",      "sim",     "replay",      "report", "layout",
                                        "study",   "estimate", "test",    "diff",        "events", "csv",
                                        "check",   "sweep",    "new",     "definitions", "budget", "serve",
                                        "dialect", "converse", "schedule"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (strcmp(argv[0], names[i]) == 0) {
            return subcommands[i](argc, argv);
        }
    }
    finished = refused = true;
    return WH_EXIT_USAGE;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *argv[WORDS + 1];
    char *const text = split(data, size, argv);
    refused = finished = reached = false;
    bool slow = false;
    for (int i = 0; i < word_count; ++i) {
        slow = slow || sleeps(argv[i]);
    }
    if (!slow) {
        REQUIRE(act(word_count, argv) == WH_EXIT_USAGE);
        REQUIRE(finished && (refused || reached));
    }
    free(text);
    return 0;
}
