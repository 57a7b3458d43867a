#include "replay_report.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>

/* ------------------------------------------------------------------------------------------------ for people */

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

static void print_ending(const char *path, const wh_replay_ending_t *ending) {
    if (ending->result == WH_LOG_CUT) {
        printf("%s: cut off at byte %" PRIu64 ", within event %" PRIu64 ": replayed up to there\n", path,
               ending->offset, ending->events + 1);
    } else if (ending->result == WH_LOG_DAMAGED) {
        printf("%s: damaged at byte %" PRIu64 ", where event %" PRIu64
               " should begin: replayed up to there\n",
               path, ending->offset, ending->events + 1);
    }
}

void wh_replay_print_table(const char *path, const wh_replay_t *replay, const wh_replay_ending_t *ending,
                           bool ok) {
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

/* ---------------------------------------------------------------------------------------------- for programs */

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

void wh_replay_print_json(const char *path, const wh_replay_t *replay, const wh_replay_ending_t *ending,
                          bool ok) {
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
