/* waferhand test PATH... */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../text/array.h"
#include "apart.h"
#include "app.h"
#include "run_arguments.h"
#include "test_find.h"

typedef struct {
    wh_run_arguments_t run; /* parameters and limits */
    wh_option_list_t paths;
    uint64_t jobs;
    double timeout;
    const char *junit, *hashes, *shard;
    bool tap, needs_expectations, counted;
} arguments_t;

static const wh_option_t options[] = {
    {"jobs", 'j', "N", "Play so many scripts at a time (default: one for each processor)", WH_OPTION_WHOLE,
     .variable = offsetof(arguments_t, jobs), 1, 1024},
    {"timeout", 0, "S", "End a script that has not ended after S seconds (default 600): it has failed",
     WH_OPTION_REAL, .variable = offsetof(arguments_t, timeout), 1e-3, 1e6},
    {"tap", 0, NULL, "Print the results as TAP, the Test Anything Protocol", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, tap)},
    {"junit", 0, "FILE", "Also write the results as JUnit's XML", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, junit)},
    {"hashes", 0, "FILE",
     "Also write each script's hash, as run tells it, and its path, one a line: what diff compares",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, hashes)},
    {"shard", 0, "I/N", "Play every Nth script alone, from the Ith on: N machines play all of them",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, shard)},
    {"require-expectations", 0, NULL, "A script that expects nothing has failed", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, needs_expectations)},
    {"counted", 0, NULL, WH_RUN_COUNTED_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, counted)},
    {"set", 0, "NAME=VALUE", "Hand each script a parameter, which each must read, as with run",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, run.parameters)},
    {"budget", 0, "N", "End a script after N steps: 1 each of Lua, 20 a slice (default 1e9)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, run.budget), 1, 1e18},
    {"memory", 0, "MIB", "Let a script use so many MiB of memory (default 256)", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, run.memory_mib), 1, 1e6},
    {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL, NULL}, {0}};

/* Reads I/N, or 1/1 if nothing is given; false if it is not a valid share. */
static bool read_shard(const char *text, size_t *part, size_t *parts) {
    char *end = NULL;
    *part = *parts = 1;
    if (!text) {
        return true;
    }
    *part = strtoul(text, &end, 10);
    const char *slash = end;
    *parts = *slash == '/' ? strtoul(slash + 1, &end, 10) : 0;
    return text[strspn(text, "0123456789/")] == '\0' && *end == '\0' && *part >= 1 && *part <= *parts &&
           *parts <= 9999;
}

static void check_test_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    size_t part;
    size_t parts;
    if (!read_shard(arguments->shard, &part, &parts)) {
        argp_error(state, "--shard: %s (expected I/N, such as 2/8, with 1 <= I <= N)", arguments->shard);
    }
}

static const wh_command_line_t command_line = {
    .name = "test",
    .synopsis = "PATH...",
    .about = "Plays many scripts, some at a time, and tells of each if it ended well. In folders, and in "
             "theirs, *.lua are played; layouts and modules among them are passed over.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script or folder",
    .operand_variable = offsetof(arguments_t, paths),
    .operands = SIZE_MAX,
    .check = check_test_arguments};

/* ------------------------------------------------------------------------------------------------ results */

typedef struct {
    bool tap;
    size_t scripts;
    wh_style_t style;
} printer_t;

static void on_result(void *user, const wh_test_result_t *result) {
    printer_t *printer = user;
    printer->scripts += result->verdict != WH_TEST_PASSED_OVER ? 1 : 0;
    if (printer->tap) {
        wh_test_print_tap(result, printer->scripts, stdout);
    } else {
        wh_test_print(result, stdout, &printer->style);
    }
    (void)fflush(stdout);
}

typedef struct {
    wh_test_result_t *results;
    size_t count;
} suite_t;

static bool write_junit(void *user, FILE *out) {
    const suite_t *suite = user;
    return wh_test_print_junit(suite->results, suite->count, out);
}

/* Writes a line for each script that played to its end. */
static bool write_hashes(void *user, FILE *out) {
    const suite_t *suite = user;
    for (size_t i = 0; i < suite->count; ++i) {
        const wh_test_result_t *result = &suite->results[i];
        if (result->verdict == WH_TEST_OK || result->verdict == WH_TEST_FAILED) {
            fprintf(out, "%016" PRIx64 "  ", result->hash);
            wh_style_put(out, result->path);
            fputc('\n', out);
        }
    }
    return fflush(out) == 0 && !ferror(out);
}

static int judge_results(const wh_test_result_t results[], size_t count, size_t scripts) {
    int status = WH_EXIT_MET;
    for (size_t i = 0; i < count; ++i) {
        if (results[i].verdict == WH_TEST_BAD) {
            return WH_EXIT_USAGE;
        }
        status = wh_test_is_bad(results[i].verdict) ? WH_EXIT_FAILED : status;
    }
    if (scripts == 0) {
        fputs("waferhand test: no scripts found (expected *.lua that set up a cell)\n", stderr);
        return WH_EXIT_USAGE;
    }
    return status;
}

static int play(const arguments_t *arguments, const wh_test_found_t *found) {
    printer_t printer = {arguments->tap, 0, wh_style_of(stdout)};
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    const wh_test_options_t wanted = {.run = arguments->run.run,
                                      .processes = arguments->jobs > 0 ? (size_t)arguments->jobs
                                                   : processors > 0    ? (size_t)processors
                                                                       : 1,
                                      .timeout_s = arguments->timeout > 0 ? arguments->timeout : 600,
                                      .outputs = {arguments->junit, arguments->hashes},
                                      .needs_expectations = arguments->needs_expectations,
                                      .listener = on_result,
                                      .user = &printer};
    suite_t suite = {wh_array_new(found->count + 1, sizeof(wh_test_result_t)), found->count};
    int status = WH_EXIT_USAGE;
    if (arguments->tap) {
        puts("TAP version 13");
    }
    if (wh_test_play(found->jobs, found->count, &wanted, suite.results)) {
        if (arguments->tap) {
            wh_test_print_plan(suite.results, suite.count, printer.scripts, stdout);
        } else {
            wh_test_print_sum(suite.results, suite.count, stdout, &printer.style);
        }
        status = judge_results(suite.results, suite.count, printer.scripts);
        if (!wh_file_write("--junit", arguments->junit, write_junit, &suite, NULL) ||
            !wh_file_write("--hashes", arguments->hashes, write_hashes, &suite, NULL) ||
            !wh_app_is_printed(0)) {
            status = WH_EXIT_USAGE;
        }
    }
    wh_test_results_free(suite.results, suite.count);
    free(suite.results);
    return status;
}

/* No output is one of the scripts. */
static bool are_apart(const arguments_t *arguments, const wh_test_found_t *found) {
    bool apart = true;
    for (size_t i = 0; apart && i < found->count; ++i) {
        const wh_named_file_t named[] = {{"the script", found->paths[i], false},
                                         {"--junit", arguments->junit, true},
                                         {"--hashes", arguments->hashes, true}};
        apart = wh_files_are_apart(named, 3, true);
    }
    return apart;
}

/* Keeps only this machine's share of the scripts: every Nth of all that were found, in their order. False
 * if that is none. */
static bool take_share(const arguments_t *arguments, wh_test_found_t *found) {
    size_t part;
    size_t parts;
    size_t kept = 0;
    (void)read_shard(arguments->shard, &part, &parts); /* which was checked with the arguments */
    for (size_t i = part - 1; i < found->count; i += parts) {
        found->jobs[kept++] = found->jobs[i];
    }
    if (kept == 0) {
        fprintf(stderr, "--shard: %s: no script is left for it (expected one of at most %zu shards)\n",
                arguments->shard, found->count);
    }
    found->count = kept;
    return kept > 0;
}

int wh_app_test(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_test_found_t found = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    arguments.run.run.counts = arguments.counted ? WH_MCS_COUNT_BLIND : WH_MCS_COUNT_NONE;
    int status = WH_EXIT_USAGE;
    if (wh_test_find(&arguments.paths, &found) && are_apart(&arguments, &found) &&
        take_share(&arguments, &found)) {
        status = play(&arguments, &found);
    }
    wh_test_found_free(&found);
    wh_option_list_free(&arguments.paths);
    wh_run_arguments_free(&arguments.run);
    return status;
}
