/* waferhand replay FILE */
#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "../log/replay.h"
#include "../text/options.h"
#include "app.h"

typedef struct {
    const char *path;
    bool json;
} arguments_t;

static const wh_option_t options[] = {{"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
                                       .variable = offsetof(arguments_t, json)},
                                      {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL}, {0}};

static const wh_command_line_t command_line = {
    .name = "replay",
    .synopsis = "FILE",
    .about =
        "Steps the library through the commands of an LCM event log and compares the hash of each slice.\v"
        "Exit status: 0 if every slice is as recorded and the log is whole, 1 if one differs, 2 if the log "
        "is "
        "unreadable, damaged or has no run in it.",
    .tables = tables,
    .operand = "file",
    .operand_variable = offsetof(arguments_t, path)};

/* How the file ended. */
typedef struct {
    wh_log_result_t result;
    uint64_t offset, events;
    uint64_t first_garbage; /* byte; valid if there is garbage */
} ending_t;

/* --------------------------------------------------------------------------------------------- for people */

static void print_run(const wh_replay_run_t *run) {
    printf("run %016" PRIx64 ": slices %" PRId64 " to %" PRId64 ", %" PRId64 " compared, hash %016" PRIx64
           "%s\n",
           (uint64_t)run->run, run->first_slice, run->last_slice, run->compared, run->hash,
           run->over ? "" : "; cut off: its end is not in the log");
    if (run->unanswered > 0) {
        printf("  %" PRId64 " slices whose state is not in the log\n", run->unanswered);
    }
    if (run->outside_valves > 0) {
        printf("  %" PRId64 " slices with valves from outside\n", run->outside_valves);
    }
    if (run->missed > 0) {
        printf("  %" PRId64 " slices that never reached the simulator\n", run->missed);
    }
    if (run->taken_up > 0) {
        printf("  taken up %" PRId64 " times from a recorded state, where commands are not in the log\n",
               run->taken_up);
    }
    if (run->differs) {
        printf("  DIFFERS at slice %" PRId64 ": %s: recorded %.17g, replayed %.17g\n", run->difference.slice,
               run->difference.what, run->difference.recorded, run->difference.replayed);
    }
}

static void print_ending(const char *path, const ending_t *ending) {
    if (ending->result == WH_LOG_CUT) {
        printf("%s: cut off at byte %" PRIu64 ", within event %" PRIu64 ": replayed up to there\n", path,
               ending->offset, ending->events + 1);
    } else if (ending->result == WH_LOG_DAMAGED) {
        printf("%s: damaged at byte %" PRIu64 ", where event %" PRIu64
               " should begin: replayed up to there\n",
               path, ending->offset, ending->events + 1);
    }
}

static void print_table(const char *path, const wh_replay_t *replay, const ending_t *ending, bool ok) {
    for (size_t i = 0; i < replay->run_count; ++i) {
        print_run(&replay->runs[i]);
    }
    if (replay->runs_left_out > 0) {
        printf("more than %d runs: the rest is left out\n", WH_REPLAY_RUNS);
    }
    if (replay->garbage > 0) {
        printf("%" PRIu64 " events on our channels are no sound messages, the first at byte %" PRIu64 "\n",
               replay->garbage, ending->first_garbage);
    }
    if (replay->homeless > 0) {
        printf("%" PRIu64 " messages come before the cell is told, and were passed over\n", replay->homeless);
    }
    print_ending(path, ending);
    puts(ok ? "every slice that was compared is as recorded" : "not shown to be as recorded");
}

/* ------------------------------------------------------------------------------------------- for programs */

static json_t *run_to_json(const wh_replay_run_t *run) {
    char id[17];
    char hash[17];
    snprintf(id, sizeof id, "%016" PRIx64, (uint64_t)run->run);
    snprintf(hash, sizeof hash, "%016" PRIx64, run->hash);
    json_t *difference = run->differs
                             ? json_pack("{s:I, s:s, s:f, s:f}", "slice", (json_int_t)run->difference.slice,
                                         "what", run->difference.what, "recorded", run->difference.recorded,
                                         "replayed", run->difference.replayed)
                             : json_null();
    return json_pack("{s:s, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:b, s:s, s:o}", "run", id, "first_slice",
                     (json_int_t)run->first_slice, "last_slice", (json_int_t)run->last_slice, "compared",
                     (json_int_t)run->compared, "unanswered", (json_int_t)run->unanswered, "outside_valves",
                     (json_int_t)run->outside_valves, "taken_up", (json_int_t)run->taken_up, "missed",
                     (json_int_t)run->missed, "over", run->over ? 1 : 0, "hash", hash, "first_difference",
                     difference);
}

static void print_json(const char *path, const wh_replay_t *replay, const ending_t *ending, bool ok) {
    json_t *runs = json_array();
    for (size_t i = 0; i < replay->run_count; ++i) {
        json_array_append_new(runs, run_to_json(&replay->runs[i]));
    }
    json_t *damage =
        ending->result == WH_LOG_END
            ? json_null()
            : json_pack("{s:s, s:I}", "kind", ending->result == WH_LOG_CUT ? "cut off" : "damaged", "byte",
                        (json_int_t)ending->offset);
    json_t *root = json_pack("{s:i, s:b, s:s, s:I, s:I, s:o, s:o}", "format", 1, "ok", ok ? 1 : 0, "file",
                             path, "events", (json_int_t)ending->events, "garbage",
                             (json_int_t)replay->garbage, "runs", runs, "damage", damage);
    json_dumpf(root, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    putchar('\n');
    json_decref(root);
}

/* ------------------------------------------------------------------------------------------------ reading */

static wh_log_t record;

/* Finds the first message that describes the cell. It is sent once a second, so a recording may begin before
 * it. */
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

static ending_t read_all(FILE *file, wh_replay_t *replay) {
    ending_t ending = {.first_garbage = 0};
    find_cell(file, replay);
    wh_log_open(&record, file);
    while ((ending.result = wh_log_next(&record)) == WH_LOG_EVENT) {
        const bool sound = replay->garbage == 0;
        if (record.size > 0) {
            wh_replay_event(replay, record.channel, record.data, record.size);
        }
        if (sound && replay->garbage > 0) {
            ending.first_garbage = record.offset;
        }
    }
    wh_replay_finish(replay);
    ending.offset = record.offset;
    ending.events = record.count;
    return ending;
}

static int judge(const wh_replay_t *replay, const ending_t *ending) {
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
    FILE *file = wh_log_file(arguments->path);
    if (!file) {
        fprintf(stderr, "%s: %s (expected an LCM event record)\n", arguments->path, strerror(errno));
        return WH_EXIT_USAGE;
    }
    const ending_t ending = read_all(file, &replay);
    const int status = judge(&replay, &ending);
    fclose(file);
    if (replay.run_count == 0) {
        fprintf(stderr,
                "%s: no run in it, in %" PRIu64 " events up to byte %" PRIu64
                " (expected an LCM event log of Waferhand's channels)\n",
                arguments->path, ending.events, ending.offset);
    } else {
        (arguments->json ? print_json : print_table)(arguments->path, &replay, &ending,
                                                     status == WH_EXIT_MET);
    }
    wh_replay_close(&replay);
    return status;
}

int wh_app_replay(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    return replay_file(&arguments);
}
