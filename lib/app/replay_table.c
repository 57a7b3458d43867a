/* Tells people of a replay. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "../text/style.h"
#include "replayed.h"

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
static void print_files(const wh_replayed_t *result) {
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

void wh_replayed_print_table(const wh_replayed_t *result) {
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
}
