/* waferhand replay FILE */
#include <argp.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "app.h"
#include "replay_report.h"

enum { OPTION_JSON = 1000 };

typedef struct {
    const char *path;
    bool json;
} arguments_t;

static const struct argp_option options[] = {
    {"json", OPTION_JSON, NULL, 0, "Print the result as one JSON object", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state) {
    arguments_t *arguments = state->input;
    switch (key) {
    case OPTION_JSON:
        arguments->json = true;
        return 0;
    case ARGP_KEY_ARG:
        if (arguments->path) {
            argp_error(state, "%s: one file is enough", argument);
        }
        arguments->path = argument;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "which file?");
        return EINVAL;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static FILE *open_log(const char *path) {
    struct stat status;
    FILE *file = fopen(path, "rb");
    const bool opened = file && fstat(fileno(file), &status) == 0;
    if (!opened || S_ISDIR(status.st_mode)) {
        fprintf(stderr, "%s: %s (expected an LCM event record)\n", path,
                opened ? strerror(EISDIR) : strerror(errno));
        if (file) {
            fclose(file);
        }
        return NULL;
    }
    return file;
}

static wh_log_t record;

/* The cell is told once a second: a recording may begin before it, and goes with the first one then. */
static void find_cell(FILE *file, wh_replay_t *replay) {
    wh_log_open(&record, file);
    while (!replay->layout && wh_log_next(&record) == WH_LOG_EVENT) {
        if (strcmp(record.channel, WH_CHANNEL_CELL) == 0) {
            wh_replay_event(replay, record.channel, record.data, record.size);
        }
    }
    rewind(file);
    replay->messages = 0;
    replay->garbage = 0;
}

static wh_replay_ending_t read_all(FILE *file, wh_replay_t *replay) {
    wh_replay_ending_t ending = {.first_garbage = 0};
    find_cell(file, replay);
    wh_log_open(&record, file);
    do {
        ending.result = wh_log_next(&record);
        if (ending.result == WH_LOG_EVENT && record.size > 0) {
            const uint64_t garbage = replay->garbage;
            wh_replay_event(replay, record.channel, record.data, record.size);
            if (garbage == 0 && replay->garbage > 0) {
                ending.first_garbage = record.offset;
            }
        }
    } while (ending.result == WH_LOG_EVENT);
    wh_replay_finish(replay);
    ending.offset = record.offset;
    ending.events = record.count;
    return ending;
}

static int judge(const wh_replay_t *replay, const wh_replay_ending_t *ending) {
    bool same = true;
    int64_t compared = 0;
    for (size_t i = 0; i < replay->run_count; ++i) {
        same = same && !replay->runs[i].differs;
        compared += replay->runs[i].compared;
    }
    if (!same) {
        return WH_EXIT_FAILED;
    }
    return ending->result == WH_LOG_END && compared > 0 ? WH_EXIT_MET : WH_EXIT_USAGE;
}

static int replay_file(const arguments_t *arguments) {
    static wh_replay_t replay;
    FILE *file = open_log(arguments->path);
    if (!file) {
        return WH_EXIT_USAGE;
    }
    wh_replay_open(&replay);
    const wh_replay_ending_t ending = read_all(file, &replay);
    const int status = judge(&replay, &ending);
    fclose(file);
    if (replay.run_count == 0) {
        fprintf(stderr,
                "%s: no run in it, in %" PRIu64 " events up to byte %" PRIu64
                " (expected an LCM event log of Waferhand's channels)\n",
                arguments->path, ending.events, ending.offset);
    } else {
        (arguments->json ? wh_replay_print_json : wh_replay_print_table)(arguments->path, &replay, &ending,
                                                                         status == WH_EXIT_MET);
    }
    wh_replay_close(&replay);
    return status;
}

int wh_app_replay(int argc, char **argv) {
    static const struct argp argp = {
        options,
        parse,
        "FILE",
        "Steps the library through the commands of an LCM event log and compares the hash of each slice.\v"
        "Exit status: 0 if every slice is as recorded and the log is whole, 1 if one differs, 2 if the log "
        "is "
        "unreadable, damaged or has no run in it.",
        NULL,
        NULL,
        NULL};
    static char name[] = "waferhand replay";
    arguments_t arguments = {0};
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &arguments);
    return replay_file(&arguments);
}
