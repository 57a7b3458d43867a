#include "reading.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *wh_reading_word(wh_reading_verdict_t verdict) {
    static const char *const words[] = {"same", "differs", "unusable", "incomplete", "cut"};
    return words[verdict];
}

const wh_reading_loss_t wh_reading_losses[WH_REPLAY_LOSSES] = {
    [WH_REPLAY_GARBAGE] = {"garbage", "event on our channels is no sound message",
                           "events on our channels are no sound messages"},
    [WH_REPLAY_UNCHECKED] = {"unchecked", "command or state has no check",
                             "commands and states have no check"},
    [WH_REPLAY_STRAY] = {"stray", "message of ours is on another channel",
                         "messages of ours are on other channels"},
    [WH_REPLAY_CONTRADICTS] = {"contradicting", "message does not fit what the log tells elsewhere",
                               "messages do not fit what the log tells elsewhere"},
    [WH_REPLAY_HOMELESS] = {"homeless", "message is of a layout whose cell is not in the log",
                            "messages are of layouts whose cells are not in the log"},
    [WH_REPLAY_LATE] = {"late", "message of a run comes when another one goes on",
                        "messages of a run come when another one goes on"}};

/* ------------------------------------------------------------------------------------------------ reading */

/* The cell is told once a second, so a recording may begin before it. And how runs begin must be known. */
static void look_ahead(FILE *file, wh_log_t *log, wh_replay_t *replay) {
    wh_log_open(log, file);
    while (wh_log_next_event(log)) {
        wh_replay_look_ahead(replay, log->channel, log->data, log->size);
        if (replay->cell_count == 0 && strcmp(log->channel, WH_CHANNEL_CELL) == 0) {
            wh_replay_event(replay, log->channel, log->data, log->size);
        }
    }
    replay->messages = replay->events = replay->digest = 0;
    memset(replay->losses, 0, sizeof replay->losses);
    for (size_t i = 0; i < replay->cell_count; ++i) {
        replay->cells[i].is_sure = false;
        replay->cells[i].times = 0;
    }
    replay->unknown_run = 0;
}

void wh_reading_replay(FILE *file, wh_log_t *log, wh_replay_t *replay, wh_reading_t *reading) {
    wh_log_result_t result;
    memset(reading, 0, sizeof *reading);
    look_ahead(file, log, replay);
    wh_log_open(log, file);
    while ((result = wh_log_next(log)) == WH_LOG_EVENT || result == WH_LOG_DAMAGED) {
        if (result == WH_LOG_DAMAGED) {
            if (reading->damage_count < WH_READING_DAMAGES) {
                reading->damages[reading->damage_count] = (wh_reading_damage_t){log->offset, log->next};
            }
            ++reading->damage_count;
            continue;
        }
        wh_log_numbers_take(&reading->numbers, log->number, log->offset);
        replay->at = log->offset;
        replay->is_loose = log->is_loose;
        wh_replay_event(replay, log->channel, log->data, log->size);
    }
    wh_log_numbers_finish(&reading->numbers);
    wh_replay_end(replay);
    reading->events = log->count;
    reading->bytes = log->next;
    reading->is_compressed = log->source.zstd != NULL;
    reading->broken = log->source.broken;
    reading->first_broken = log->source.first_broken;
    reading->is_cut = result == WH_LOG_CUT;
    reading->cut_at = log->offset;
}

/* --------------------------------------------------------------------------------------------------- runs */

static const wh_replay_run_t *last_begun(const wh_replay_t *replay) {
    const wh_replay_run_t *last = NULL;
    for (size_t i = 0; i < replay->run_count; ++i) {
        last = replay->runs[i].is_begun ? &replay->runs[i] : last;
    }
    return last;
}

bool wh_reading_is_unknown(const wh_replay_t *replay) {
    return replay->recording.version != 0 && replay->recording.version != WH_RECORDING_VERSION;
}

bool wh_reading_is_doubtful(const wh_replay_t *replay, const wh_replay_run_t *run) {
    for (size_t i = 0; i < replay->cell_count; ++i) {
        const wh_replay_cell_t *cell = &replay->cells[i];
        if (cell->hash == run->layout_hash &&
            (cell->is_contradicted || (replay->recording.version > 0 && !cell->is_sure))) {
            return true;
        }
    }
    return false;
}

bool wh_reading_lacks_end(const wh_replay_t *replay, const wh_replay_run_t *run) {
    return !run->over && run == last_begun(replay) && replay->recording.closed == WH_RECORDING_BEGINS;
}

int64_t wh_reading_lost_expectations(const wh_replay_run_t *run) {
    const wh_log_numbers_t *there = &run->expectations;
    uint64_t missing = wh_log_numbers_missing(there);
    if (run->told.verdict == WH_OUTCOME_UNTOLD) {
        return 0;
    }
    if (run->begins_in_part && there->next == 0) {
        return 0;
    }
    for (size_t i = 0; run->begins_in_part && i < there->gap_count; ++i) {
        missing -= there->gaps[i].from == 0 ? there->gaps[i].to : 0;
    }
    return run->told.expectations - (int64_t)(there->next - missing);
}

/* ------------------------------------------------------------------------------------------------ judging */

/* Writes why, unless nobody asks. True. */
__attribute__((format(printf, 2, 3))) static bool because(char *reason, const char *format, ...) {
    va_list values;
    if (reason) {
        va_start(values, format);
        (void)vsnprintf(reason, WH_READING_REASON, format, values);
        va_end(values);
    }
    return true;
}

static bool count_because(char *reason, uint64_t count, const char *one, const char *many) {
    return count > 0 && because(reason, "%" PRIu64 " %s", count, count == 1 ? one : many);
}

static bool are_numbers_odd(const wh_log_numbers_t *numbers, char *reason) {
    const uint64_t odd = numbers->doubled + numbers->moved + numbers->misnumbered;
    return count_because(reason, wh_log_numbers_missing(numbers), "event is missing", "events are missing") ||
           count_because(reason, odd, "event is doubled, out of order or misnumbered",
                         "events are doubled, out of order or misnumbered");
}

static bool is_lost(const wh_replay_t *replay, wh_replay_loss_t loss, char *reason) {
    const wh_replay_count_t *lost = &replay->losses[loss];
    const wh_reading_loss_t *words = &wh_reading_losses[loss];
    return lost->count > 0 && because(reason, "%" PRIu64 " %s, the first at byte %" PRIu64, lost->count,
                                      lost->count == 1 ? words->one : words->many, lost->first);
}

/* Messages that a network may have made so, as well as the file. */
static bool has_strange_messages(const wh_replay_t *replay, char *reason) {
    return !wh_replay_is_vouched_for(replay) &&
           (is_lost(replay, WH_REPLAY_CONTRADICTS, reason) || is_lost(replay, WH_REPLAY_STRAY, reason));
}

static bool has_doubtful_slices(const wh_replay_t *replay, char *reason) {
    int64_t doubtful = 0;
    for (size_t i = 0; i < replay->run_count; ++i) {
        doubtful += replay->runs[i].doubtful;
    }
    return count_because(reason, (uint64_t)doubtful, "slice is doubtful", "slices are doubtful");
}

/* What no network does. */
static bool is_file_damaged(const wh_replay_t *replay, const wh_reading_t *reading, char *reason) {
    if (reading->damage_count > 0) {
        return because(reason, "bytes from %" PRIu64 " on are no event", reading->damages[0].from);
    }
    if (reading->broken > 0) {
        return because(reason, "a compressed frame is damaged at byte %" PRIu64, reading->first_broken);
    }
    if (are_numbers_odd(&reading->numbers, reason) || has_strange_messages(replay, reason)) {
        return true;
    }
    if (replay->recording.is_changed) {
        return because(reason, WH_READING_CHANGED);
    }
    return count_because(reason, replay->runs_left_out, "message of one run more than fit",
                         "messages of more runs than fit") ||
           has_doubtful_slices(replay, reason);
}

static bool is_run_whole(const wh_replay_t *replay, const wh_replay_run_t *run, char *reason) {
    const int64_t lost = wh_reading_lost_expectations(run);
    const int64_t unanswered =
        run->unanswered + (wh_reading_lacks_end(replay, run) ? 0 : run->last_unanswered);
    if (lost < 0) {
        return !because(reason, "more expectations are in the log than the run had");
    }
    return !count_because(reason, (uint64_t)run->skipped, "slice was passed over",
                          "slices were passed over") &&
           !count_because(reason, (uint64_t)run->taken_up, "state was taken over as recorded",
                          "states were taken over as recorded") &&
           !count_because(reason, (uint64_t)unanswered, "command has no state", "commands have no states") &&
           !count_because(reason, (uint64_t)lost, "expectation is not in the log",
                          "expectations are not in the log");
}

/* What a network may do. */
static bool is_something_missing(const wh_replay_t *replay, char *reason) {
    for (size_t i = 0; i < replay->run_count; ++i) {
        if (!is_run_whole(replay, &replay->runs[i], reason)) {
            return true;
        }
    }
    for (size_t i = 0; i < WH_REPLAY_LOSSES; ++i) {
        if (is_lost(replay, (wh_replay_loss_t)i, reason)) {
            return true;
        }
    }
    return count_because(reason, replay->proximities, "proximity could not be compared",
                         "proximities could not be compared");
}

static int64_t count_compared(const wh_replay_t *replay) {
    int64_t compared = 0;
    for (size_t i = 0; i < replay->run_count; ++i) {
        compared += replay->runs[i].compared;
    }
    return compared;
}

/* The first run that is not as recorded: for sure, or in doubt. Null if there is none. */
static const wh_replay_run_t *find_difference(const wh_replay_t *replay, bool doubtful) {
    for (size_t i = 0; i < replay->run_count; ++i) {
        const wh_replay_run_t *run = &replay->runs[i];
        if (run->differing > 0 && wh_reading_is_doubtful(replay, run) == doubtful) {
            return run;
        }
    }
    return NULL;
}

static bool shows_nothing(const wh_replay_t *replay, char *reason) {
    if (find_difference(replay, true)) {
        return because(reason, "a slice or its cell is another one, and nothing vouches for the cell");
    }
    return count_compared(replay) == 0 && because(reason, "no slice is in it that could be compared");
}

static bool lacks_end(const wh_replay_t *replay, const wh_reading_t *reading, char *reason) {
    const wh_replay_run_t *last = last_begun(replay);
    if (reading->is_cut) {
        return because(reason, "it ends within an event, at byte %" PRIu64, reading->cut_at);
    }
    if (replay->recording.version > 0) {
        return replay->recording.closed == WH_RECORDING_BEGINS &&
               because(reason, "the recording was not closed, so nothing vouches for its texts");
    }
    return (!last || !last->over) && because(reason, "the run's end is not in it");
}

wh_reading_verdict_t wh_reading_judge(const wh_replay_t *replay, const wh_reading_t *reading, bool lenient,
                                      char *reason) {
    const wh_replay_run_t *differs = find_difference(replay, false);
    if (replay->run_count == 0 || wh_reading_is_unknown(replay)) {
        (void)because(reason, "no run is in it, or its version is unknown");
        return WH_READING_UNUSABLE;
    }
    if (differs) {
        (void)because(reason, "slice %" PRId64 " is another one: %s", differs->difference.slice,
                      differs->difference.what);
        return WH_READING_DIFFERS;
    }
    if (is_file_damaged(replay, reading, reason) || (!lenient && is_something_missing(replay, reason)) ||
        shows_nothing(replay, reason)) {
        return WH_READING_INCOMPLETE;
    }
    if (lacks_end(replay, reading, reason)) {
        return WH_READING_CUT;
    }
    if (reason) {
        reason[0] = '\0';
    }
    return WH_READING_SAME;
}
