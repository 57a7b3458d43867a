/* waferhand replay FILE */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../log/reading.h"
#include "../text/json.h"
#include "../text/options.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "log_arguments.h"
#include "replay_field.h"

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

/* The replay that was read. */
typedef struct {
    const arguments_t *arguments;
    const wh_log_files_t *files;
    const wh_replay_t *replay;
    const wh_reading_t *reading;
    wh_reading_verdict_t verdict;
    char reason[WH_READING_REASON];
} result_t;

/* --------------------------------------------------------------------------------------------- for people */

/* Prints "  1 slice ..." or "  2 slices ..." unless the count is 0. */
static void print_counted(int64_t count, const char *one, const char *many) {
    if (count > 0) {
        printf("  %" PRId64 " %s\n", count, count == 1 ? one : many);
    }
}

static void print_counts(const wh_replay_run_t *run, bool lacks_end) {
    print_counted(run->slices.unanswered, "command whose state is not in the log",
                  "commands whose states are not in the log");
    if (lacks_end) {
        print_counted(run->slices.last_unanswered, "command at the end: the log ends before its state",
                      "commands at the end: the log ends before their states");
    } else {
        print_counted(run->slices.last_unanswered, "command at the run's end whose state is not in the log",
                      "commands at the run's end whose states are not in the log");
    }
    print_counted(run->slices.outside_valves, "slice with valves from outside",
                  "slices with valves from outside");
    print_counted(run->slices.missed, "slice that never reached the simulator",
                  "slices that never reached the simulator");
    print_counted(run->refused, "command that the simulator refused, and so does the replay",
                  "commands that the simulator refused, and so does the replay");
    print_counted(run->collisions, "event of the collision check: not compared",
                  "events of the collision check: not compared");
    if (run->slices.taken_up > 0) {
        printf("  taken up from a recorded state %" PRId64 " %s, where commands are not in the log\n",
               run->slices.taken_up, run->slices.taken_up == 1 ? "time" : "times");
    }
    print_counted(run->slices.skipped, "slice was passed over", "slices were passed over");
    print_counted(
        run->slices.doubtful,
        "slice that is not as recorded behind commands without states: their valves are not known",
        "slices that are not as recorded behind commands without states: their valves are not known");
}

static void print_difference(const wh_replay_t *replay, const wh_replay_run_t *run) {
    if (run->slices.differing == 0) {
        return;
    }
    const wh_replay_difference_t *difference = &run->difference;
    const bool doubtful = wh_reading_is_doubtful(replay, run);
    printf("  %s at slice %" PRId64 ": %s: recorded %.17g, replayed %.17g; %" PRId64 " of %" PRId64
           " slices differ%s\n",
           doubtful ? "not the same" : "DIFFERS", difference->slice, difference->what, difference->recorded,
           difference->replayed, run->slices.differing, run->slices.compared,
           doubtful ? ", or the cell does: nothing vouches for it" : "");
}

/* Says why the run failed: the reason that motion control told, or the one that remains by its counts. */
static void print_reason(const wh_replay_run_t *run) {
    if (run->over.reason) {
        char *reason = wh_style_printable(run->over.reason);
        printf("; %s", reason);
        free(reason);
    } else if (run->over.outcome.verdict == WH_OUTCOME_FAILED &&
               run->over.outcome.met == run->over.outcome.expectations) {
        fputs("; the cell complained", stdout);
    }
}

static void print_outcome(const wh_replay_run_t *run) {
    const wh_outcome_verdict_t verdict = run->over.outcome.verdict;
    if (run->over.is_wrong) {
        puts("  what the log tells of the run's result contradicts itself");
    } else if (verdict == WH_OUTCOME_PASSED || verdict == WH_OUTCOME_FAILED) {
        printf("  the run %s: %" PRId64 " of %" PRId64 " expectations met", wh_outcome_word(verdict),
               run->over.outcome.met, run->over.outcome.expectations);
        print_reason(run);
        putchar('\n');
    } else if (verdict == WH_OUTCOME_ENDED) {
        puts("  the session ended");
    } else {
        puts(run->unmet > 0 ? "  the run failed: an expectation was not met; the log does not tell its end"
                            : "  the log does not tell if the run passed");
    }
    print_counted(wh_reading_lost_end(run), "slice before the run's end is not in the log",
                  "slices before the run's end are not in the log");
    print_counted(wh_reading_lost_expectations(run), "expectation is not in the log",
                  "expectations are not in the log");
}

static void print_other_layout(const wh_replay_run_t *run) {
    if (run->homeless.is_other_layout) {
        print_counted(run->homeless.count, "command of another layout, which the simulator refused",
                      "commands of another layout, which the simulator refused");
    }
}

static void print_run(const wh_replay_t *replay, const wh_replay_run_t *run) {
    if (!run->is_begun) {
        printf("run %016" PRIx64 ": no slices\n", (uint64_t)run->run);
        print_outcome(run);
        print_other_layout(run);
        return;
    }
    printf("run %016" PRIx64 ": slices %" PRId64 " to %" PRId64 ", %" PRId64 " compared, hash %016" PRIx64
           "%s\n",
           (uint64_t)run->run, run->first_slice, run->last_slice, run->slices.compared, run->hash,
           run->over.is_told ? "" : "; its end is not in the log");
    if (run->begins_in_part) {
        printf("  begins in the part before this one of its recording\n");
    }
    if (run->goes_on_from != 0) {
        printf("  goes on from slice %" PRId64 " of run %016" PRIx64 "\n", run->first_slice,
               (uint64_t)run->goes_on_from);
    }
    print_outcome(run);
    print_counts(run, wh_reading_lacks_end(replay, run));
    print_difference(replay, run);
}

static void print_path(const wh_log_files_t *files, size_t file) {
    char *path = wh_style_printable(files->paths[file]);
    fputs(path, stdout);
    free(path);
}

/* The place of a byte, and with several files the file that holds it. */
static void print_place(const wh_log_files_t *files, size_t file, uint64_t at) {
    printf("byte %" PRIu64, at);
    if (files->count > 1) {
        fputs(" of ", stdout);
        print_path(files, file);
    }
}

static void print_losses(const wh_replay_t *replay, const wh_log_files_t *files) {
    for (size_t i = 0; i < WH_REPLAY_LOSSES; ++i) {
        const wh_replay_count_t *loss = &replay->heard.losses[i];
        if (loss->count > 0) {
            printf("%" PRIu64 " %s, the first at ", loss->count,
                   loss->count == 1 ? wh_reading_losses[i].one : wh_reading_losses[i].many);
            print_place(files, loss->file, loss->first);
            putchar('\n');
        }
    }
    if (replay->heard.proximities > 0) {
        printf("%" PRIu64 " proximities could not be compared\n", replay->heard.proximities);
    }
    if (replay->runs_left_out > 0) {
        printf("more than %d runs: the rest is left out\n", WH_REPLAY_RUNS);
    }
}

static void print_numbers(const wh_log_numbers_t *numbers) {
    const uint64_t odd = numbers->doubled + numbers->moved + numbers->misnumbered;
    for (size_t i = 0; i < numbers->gap_count; ++i) {
        const uint64_t from = numbers->gaps[i].from;
        const uint64_t count = numbers->gaps[i].to - from;
        printf("%" PRIu64 " %s missing ", count, count == 1 ? "event is" : "events are");
        if (from == 0) {
            puts("at the beginning");
        } else {
            printf("after event %" PRIu64 "\n", from - 1);
        }
    }
    if (numbers->beyond > 0) {
        printf("%" PRIu64 " more events are missing\n", numbers->beyond);
    }
    if (odd > 0) {
        printf("events: %" PRIu64 " doubled, %" PRIu64 " out of order, %" PRIu64
               " with a wrong number; the first at byte %" PRIu64 "\n",
               numbers->doubled, numbers->moved, numbers->misnumbered, numbers->first);
    }
}

/* Prints the recording's own description. */
static void print_recording(const wh_replay_recording_t *recording) {
    if (recording->part > 1 || recording->closed == WH_RECORDING_GOES_ON) {
        const bool several = recording->first_part < recording->part;
        printf("part%s %d", several ? "s" : "", (int)recording->first_part);
        if (several) {
            printf(" to %d", (int)recording->part);
        }
        printf(" of recording %016" PRIx64 "%s\n", (uint64_t)recording->id,
               recording->closed == WH_RECORDING_GOES_ON ? ", which goes on in the next part" : "");
    }
    if (recording->is_changed) {
        puts(WH_READING_CHANGED);
    }
}

static void print_damages(const wh_log_files_t *files, const wh_reading_t *reading, const char *where) {
    for (size_t i = 0; i < reading->damage_count && i < WH_READING_DAMAGES; ++i) {
        const wh_reading_damage_t *damage = &reading->damages[i];
        print_path(files, damage->file);
        printf(": damaged at byte %" PRIu64 "%s: %" PRIu64 " bytes are no event\n", damage->from, where,
               damage->to - damage->from);
    }
    if (reading->damage_count > WH_READING_DAMAGES) {
        print_path(files, 0);
        printf(": and %" PRIu64 " more times\n", reading->damage_count - WH_READING_DAMAGES);
    }
}

static void print_cuts(const wh_log_files_t *files, const wh_reading_t *reading, const char *where) {
    for (size_t i = 0; i < reading->cut_count && i < WH_READING_DAMAGES; ++i) {
        print_path(files, reading->cuts[i].file);
        printf(": cut off at byte %" PRIu64 "%s; the next log goes on\n", reading->cuts[i].from, where);
    }
    if (reading->is_cut) {
        print_path(files, files->count - 1);
        printf(": cut off at byte %" PRIu64 "%s\n", reading->cut_at, where);
    }
}

static void print_damage(const wh_log_files_t *files, const wh_reading_t *reading) {
    const char *where = reading->is_compressed ? " of what was decompressed" : "";
    if (reading->broken > 0) {
        print_path(files, 0);
        printf(": damaged at byte %" PRIu64 ", within a compressed frame; %" PRIu64 " such %s\n",
               reading->first_broken, reading->broken, reading->broken == 1 ? "place" : "places");
    }
    print_damages(files, reading, where);
    print_cuts(files, reading, where);
}

/* Prints the facts about several files that a reader needs. */
static void print_files(const result_t *result) {
    const size_t unclosed = result->replay->files.open_files;
    if (result->files->count > 1) {
        printf("%zu files, read as one log\n", result->files->count);
    }
    if (unclosed > 0) {
        printf("%zu of them %s not closed: nothing vouches for the texts in %s\n", unclosed,
               unclosed == 1 ? "was" : "were", unclosed == 1 ? "it" : "them");
    }
}

static bool has_collisions(const wh_replay_t *replay) {
    bool has = false;
    for (size_t i = 0; i < replay->run_count; ++i) {
        has = has || replay->runs[i].collisions > 0;
    }
    return has;
}

static int print_table(const result_t *result) {
    static const char *const verdicts[] = {[WH_READING_SAME] = "every slice is as recorded",
                                           [WH_READING_DIFFERS] = "not as recorded",
                                           [WH_READING_UNUSABLE] = "",
                                           [WH_READING_INCOMPLETE] =
                                               "damaged or incomplete, not shown to be as recorded",
                                           [WH_READING_CUT] = "cut off, every slice before is as recorded"};
    for (size_t i = 0; i < result->replay->run_count; ++i) {
        print_run(result->replay, &result->replay->runs[i]);
    }
    print_recording(&result->replay->recording);
    print_files(result);
    print_losses(result->replay, result->files);
    print_numbers(&result->reading->numbers);
    print_damage(result->files, result->reading);
    printf("%s%s%s%s\n", verdicts[result->verdict], result->reason[0] ? ": " : "", result->reason,
           result->verdict == WH_READING_SAME && has_collisions(result->replay)
               ? ", but for what the collision check found, which was not compared"
               : "");
    return 0;
}

/* ------------------------------------------------------------------------------------------- for programs */

static json_t *difference_to_json(const wh_replay_run_t *run) {
    if (run->slices.differing == 0) {
        return json_null();
    }
    const wh_replay_difference_t *from = &run->difference;
    return wh_json_add(json_object(), "slice what recorded replayed", json_integer(from->slice),
                       wh_json_text(from->what), wh_json_real(from->recorded), wh_json_real(from->replayed),
                       NULL);
}

static json_t *outcome_to_json(const wh_replay_run_t *run) {
    const wh_run_told_t *told = &run->over.outcome;
    if (told->verdict == WH_OUTCOME_UNTOLD && !run->over.is_wrong) {
        return json_null();
    }
    return wh_json_add(json_object(),
                       "verdict reason contradicts commands expectations met cycles expectations_lost",
                       wh_json_text(wh_outcome_word(told->verdict)), wh_json_text(run->over.reason),
                       json_boolean(run->over.is_wrong), json_integer(told->commands),
                       json_integer(told->expectations), json_integer(told->met), json_integer(told->cycles),
                       json_integer(wh_reading_lost_expectations(run)), NULL);
}

static json_t *run_to_json(const void *subject, size_t i) {
    const wh_replay_run_t *run = &((const wh_replay_t *)subject)->runs[i];
    json_t *object = wh_json_add(
        json_object(), "run first_slice last_slice compared differing unanswered last_unanswered",
        wh_json_hash((uint64_t)run->run), json_integer(run->first_slice), json_integer(run->last_slice),
        json_integer(run->slices.compared), json_integer(run->slices.differing),
        json_integer(run->slices.unanswered), json_integer(run->slices.last_unanswered), NULL);
    return wh_json_add(object,
                       "outside_valves taken_up skipped lost_end missed refused other_layout doubtful "
                       "collisions_not_compared begins_in_part goes_on_from over hash outcome "
                       "first_difference",
                       json_integer(run->slices.outside_valves), json_integer(run->slices.taken_up),
                       json_integer(run->slices.skipped), json_integer(wh_reading_lost_end(run)),
                       json_integer(run->slices.missed), json_integer(run->refused),
                       json_integer(run->homeless.is_other_layout ? run->homeless.count : 0),
                       json_integer(run->slices.doubtful), json_integer(run->collisions),
                       json_boolean(run->begins_in_part),
                       run->goes_on_from != 0 ? wh_json_hash((uint64_t)run->goes_on_from) : json_null(),
                       json_boolean(run->over.is_told), wh_json_hash(run->hash), outcome_to_json(run),
                       difference_to_json(run), NULL);
}

static json_t *gap_to_json(const void *subject, size_t i) {
    const wh_log_numbers_t *numbers = subject;
    return wh_json_add(json_object(), "from to", json_integer((json_int_t)numbers->gaps[i].from),
                       json_integer((json_int_t)numbers->gaps[i].to), NULL);
}

static json_t *damage_to_json(const void *subject, size_t i) {
    const wh_reading_t *reading = subject;
    return wh_json_add(json_object(), "from to", json_integer((json_int_t)reading->damages[i].from),
                       json_integer((json_int_t)reading->damages[i].to), NULL);
}

static void put_recording(const wh_replay_recording_t *recording, json_t *root) {
    const bool tells = recording->version > 0;
    (void)wh_json_add(root, "version id first_part part closed goes_on program changed",
                      json_integer(tells ? recording->version : 1),
                      tells ? wh_json_hash((uint64_t)recording->id) : json_null(),
                      tells ? json_integer(recording->first_part) : json_null(),
                      tells ? json_integer(recording->part) : json_null(),
                      tells ? json_boolean(recording->closed != WH_RECORDING_BEGINS) : json_null(),
                      tells ? json_boolean(recording->closed == WH_RECORDING_GOES_ON) : json_null(),
                      tells ? wh_json_text(recording->program) : json_null(),
                      json_boolean(recording->is_changed), NULL);
}

static void put_losses(const wh_replay_t *replay, json_t *root) {
    json_t *first = json_object();
    for (size_t i = 0; i < WH_REPLAY_LOSSES; ++i) {
        wh_json_put(root, wh_reading_losses[i].key, json_integer((json_int_t)replay->heard.losses[i].count));
        if (replay->heard.losses[i].count > 0) {
            wh_json_put(first, wh_reading_losses[i].key,
                        json_integer((json_int_t)replay->heard.losses[i].first));
        }
    }
    wh_json_put(root, "first_bytes", first);
    wh_json_put(root, "proximities_not_compared", json_integer((json_int_t)replay->heard.proximities));
    wh_json_put(root, "runs_left_out", json_integer((json_int_t)replay->runs_left_out));
}

static void put_file(const wh_reading_t *reading, json_t *root) {
    const wh_log_numbers_t *numbers = &reading->numbers;
    const size_t named =
        reading->damage_count < WH_READING_DAMAGES ? (size_t)reading->damage_count : WH_READING_DAMAGES;
    (void)wh_json_add(root, "events_missing events_doubled events_out_of_order events_misnumbered",
                      json_integer((json_int_t)wh_log_numbers_missing(numbers)),
                      json_integer((json_int_t)numbers->doubled), json_integer((json_int_t)numbers->moved),
                      json_integer((json_int_t)numbers->misnumbered), NULL);
    wh_json_put(root, "gaps", wh_json_list(gap_to_json, numbers, numbers->gap_count));
    wh_json_put(root, "damaged", json_integer((json_int_t)reading->damage_count));
    wh_json_put(root, "damage", wh_json_list(damage_to_json, reading, named));
    wh_json_put(root, "frames_damaged", json_integer((json_int_t)reading->broken));
    wh_json_put(root, "cut_at", reading->is_cut ? json_integer((json_int_t)reading->cut_at) : json_null());
}

static json_t *path_to_json(const void *subject, size_t i) {
    return wh_json_text(((const wh_log_files_t *)subject)->paths[i]);
}

static int print_json(const result_t *result) {
    json_t *root = wh_json_add(
        json_object(), "format ok verdict reason lenient file events", json_integer(2),
        json_boolean(result->verdict == WH_READING_SAME), wh_json_text(wh_reading_word(result->verdict)),
        wh_json_text(result->reason[0] ? result->reason : NULL), json_boolean(result->arguments->lenient),
        wh_json_text(result->arguments->path), json_integer((json_int_t)result->reading->events), NULL);
    wh_json_put(root, "files", wh_json_list(path_to_json, result->files, result->files->count));
    wh_json_put(root, "files_not_closed", json_integer((json_int_t)result->replay->files.open_files));
    put_recording(&result->replay->recording, root);
    put_losses(result->replay, root);
    put_file(result->reading, root);
    wh_json_put(root, "runs", wh_json_list(run_to_json, result->replay, result->replay->run_count));
    const int status = wh_json_print(root, stdout);
    json_decref(root);
    return status;
}

/* ------------------------------------------------------------------------------------------------ reading */

static void print_unusable(const result_t *result) {
    const char *path = result->arguments->path;
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

static int print(const result_t *result) {
    if (result->verdict == WH_READING_UNUSABLE) {
        print_unusable(result);
        return WH_EXIT_USAGE;
    }
    const int printed = result->arguments->json ? print_json(result) : print_table(result);
    return wh_app_is_printed(printed) ? (int)result->verdict : WH_EXIT_USAGE;
}

static int replay_files(const arguments_t *arguments, const wh_log_files_t *files) {
    static wh_replay_t replay;
    static wh_log_t log;
    wh_reading_t reading;
    memset(&replay, 0, sizeof replay);
    wh_reading_replay(files, &log, &replay, &reading);
    wh_log_close(&log);
    result_t result = {.arguments = arguments, .files = files, .replay = &replay, .reading = &reading};
    result.verdict = wh_reading_judge(&replay, &reading, arguments->lenient, result.reason);
    const int status = print(&result);
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
