/* waferhand replay FILE */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "../text/options.h"
#include "apart.h"
#include "app.h"
#include "log_arguments.h"
#include "replay_field.h"
#include "replayed.h"

typedef struct {
    const char *path;
    wh_log_more_t more;
    bool json, lenient;
    wh_replay_field_arguments_t field;
} arguments_t;

static const wh_option_t options[] = {
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, json)},
    {"lenient", 0, NULL,
     "For a log from a lossy network: missing, late and damaged messages are named and do not fail it",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, lenient)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_log_more_options, offsetof(arguments_t, more), NULL, NULL},
    {wh_replay_field_options, offsetof(arguments_t, field), "A field log:", wh_replay_field_check},
    {wh_record_options, offsetof(arguments_t, field.record), NULL, wh_record_arguments_check},
    {wh_layout_options, offsetof(arguments_t, field.layout), NULL, NULL},
    {0}};

/* A field log is one file, and has no messages that could be lost. */
static void check(const void *filled, struct argp_state *state) {
    const arguments_t *arguments = filled;
    const char *other = arguments->lenient               ? "lenient"
                        : arguments->more.is_alone       ? "alone"
                        : arguments->more.then.count > 0 ? "then"
                                                         : NULL;
    if (arguments->field.field && other) {
        argp_error(state, "--%s: goes with an LCM event log (expected no --field)", other);
    }
}

static const wh_command_line_t command_line = {
    .name = "replay",
    .synopsis = "FILE\nLAYOUT --field FILE.csv",
    .about =
        "Steps the library through the commands of an LCM event log and compares each slice's state, body "
        "and hash; or plays a controller's log from the field against a layout's cell.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "file",
    .operand_variable = offsetof(arguments_t, path),
    .check = check};

/* ------------------------------------------------------------------------------------------------ reading */

static void print_unusable(const wh_replayed_t *result) {
    const char *path = result->path;
    if (wh_reading_is_unknown(result->replay)) {
        fprintf(stderr, "%s: a recording of version %d (expected 1, %d or %d)\n", path,
                (int)result->replay->recording.version, WH_RECORDING_OLDEST, WH_RECORDING_VERSION);
        return;
    }
    fprintf(stderr,
            "%s: no run in it, in %" PRIu64 " events up to byte %" PRIu64
            " (expected an LCM event log of Waferhand's channels)\n",
            path, result->reading->events, result->reading->bytes);
}

static int print(const wh_replayed_t *result, bool json) {
    if (result->verdict == WH_READING_UNUSABLE) {
        print_unusable(result);
        return WH_EXIT_USAGE;
    }
    int printed = 0;
    if (json) {
        printed = wh_replayed_print_json(result);
    } else {
        wh_replayed_print_table(result);
    }
    return wh_app_is_printed(printed) ? (int)result->verdict : WH_EXIT_USAGE;
}

static int replay_files(const arguments_t *arguments, const wh_log_files_t *files) {
    static wh_replay_t replay;
    static wh_log_t log;
    wh_reading_t reading;
    memset(&replay, 0, sizeof replay);
    wh_reading_replay(files, &log, &replay, &reading);
    wh_log_close(&log);
    wh_replayed_t result = {.path = arguments->path,
                            .is_lenient = arguments->lenient,
                            .files = files,
                            .replay = &replay,
                            .reading = &reading};
    result.verdict = wh_reading_judge(&replay, &reading, arguments->lenient, result.reason);
    const int status = print(&result, arguments->json);
    wh_replay_close(&replay);
    return status;
}

static int replay_log(const arguments_t *arguments) {
    wh_log_files_t files;
    char message[WH_LOG_FILES_MESSAGE];
    int status = WH_EXIT_USAGE;
    const wh_named_file_t named = {"the log", arguments->path, false};
    const wh_log_names_t names = {arguments->path, arguments->more.then.items, arguments->more.then.count,
                                  arguments->more.is_alone};
    if (wh_files_are_apart(&named, 1, true)) {
        if (wh_log_files_open(&files, &names, message)) {
            status = replay_files(arguments, &files);
        } else {
            fprintf(stderr, "%s\n", message);
        }
        wh_log_files_close(&files);
    }
    return status;
}

int wh_app_replay(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    arguments.field.layout.path = arguments.path;
    const int status =
        arguments.field.field ? wh_replay_field(&arguments.field, arguments.json) : replay_log(&arguments);
    wh_option_list_free(&arguments.more.then);
    return status;
}
