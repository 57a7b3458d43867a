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

/* Looks through the log first. The cell is told once a second, so a recording may begin before it; and the
 * beginnings of runs must be known. */
static void look_ahead(const wh_log_files_t *files, wh_log_t *log, wh_replay_t *replay) {
    wh_log_files_begin(files, log);
    while (wh_log_next_event(log)) {
        wh_replay_look_ahead(replay, log->channel, log->data, log->size);
        if (replay->cell_count == 0 && strcmp(log->channel, WH_CHANNEL_CELL) == 0) {
            wh_replay_event(replay, log->channel, log->data, log->size);
        }
    }
    replay->heard.messages = replay->heard.events = replay->heard.digest = 0;
    memset(replay->heard.losses, 0, sizeof replay->heard.losses);
    for (size_t i = 0; i < replay->cell_count; ++i) {
        replay->cells[i].is_sure = false;
        replay->cells[i].times = 0;
    }
    replay->heard.unknown_run = 0;
}

/* Keeps the place if there is room for it, and counts it in any case. */
static void note_place(wh_reading_damage_t places[WH_READING_DAMAGES], uint64_t *count,
                       wh_reading_damage_t place) {
    if (*count < WH_READING_DAMAGES) {
        places[*count] = place;
    }
    ++*count;
}

/* One file has ended, the next one begins. */
static void pass_file(wh_reading_t *reading, const wh_log_t *log, wh_replay_t *replay) {
    if (log->is_cut) {
        note_place(reading->cuts, &reading->cut_count,
                   (wh_reading_damage_t){log->offset, log->offset, log->file - 1});
    }
    reading->is_compressed = reading->is_compressed || log->source.zstd != NULL;
    wh_log_numbers_restart(&reading->numbers);
    wh_replay_next_file(replay);
}

static bool is_of_slices(const char *channel) {
    return strcmp(channel, WH_CHANNEL_SLICES) == 0 || strcmp(channel, WH_CHANNEL_STATE) == 0 ||
           strcmp(channel, WH_CHANNEL_COMMAND) == 0;
}

/* Returns true if it is of slices, and sound. */
static bool take_event(wh_reading_t *reading, const wh_log_t *log, wh_replay_t *replay) {
    const uint64_t messages = replay->heard.messages;
    wh_log_numbers_take(&reading->numbers, log->number, log->offset);
    replay->place.at = log->offset;
    replay->place.file = log->file;
    replay->place.is_loose = log->is_loose;
    wh_replay_event(replay, log->channel, log->data, log->size);
    return replay->heard.messages > messages && is_of_slices(log->channel);
}

/* True if the file is a part of a recording whose next part is the next file. */
static bool goes_on(const wh_log_files_t *files, size_t file) {
    const wh_log_head_t *head = &files->heads[file];
    const wh_log_head_t *next = file + 1 < files->count ? &files->heads[file + 1] : NULL;
    return next && head->is_told && next->is_told && head->id == next->id;
}

/* Notes a file in which no slice is, unless it is a part of a recording that goes on in the next one. Returns
 * true if the next one need not have a slice. */
static bool end_file(wh_reading_t *reading, const wh_log_files_t *files, size_t file, bool has_slices,
                     bool is_cut) {
    const bool is_part = goes_on(files, file);
    if (files->count > 1 && !has_slices && !is_part) {
        reading->is_begun_and_cut = reading->is_begun_and_cut || is_cut;
        reading->barren = reading->barren || is_cut ? reading->barren : files->paths[file];
    }
    return has_slices && is_part;
}

void wh_reading_replay(const wh_log_files_t *files, wh_log_t *log, wh_replay_t *replay,
                       wh_reading_t *reading) {
    wh_log_result_t result;
    bool has_slices = false;
    memset(reading, 0, sizeof *reading);
    reading->is_alone = files->is_alone;
    look_ahead(files, log, replay);
    wh_log_files_begin(files, log);
    while ((result = wh_log_next(log)) != WH_LOG_END && result != WH_LOG_CUT) {
        if (result == WH_LOG_DAMAGED) {
            note_place(reading->damages, &reading->damage_count,
                       (wh_reading_damage_t){log->offset, log->next, log->file});
        } else if (result == WH_LOG_NEXT_FILE) {
            has_slices = end_file(reading, files, log->file - 1, has_slices, log->is_cut);
            pass_file(reading, log, replay);
        } else {
            has_slices = take_event(reading, log, replay) || has_slices;
        }
    }
    (void)end_file(reading, files, files->count - 1, has_slices, result == WH_LOG_CUT);
    wh_log_numbers_finish(&reading->numbers);
    wh_replay_end(replay);
    reading->events = log->count;
    reading->bytes = log->passed + log->next;
    reading->is_compressed = reading->is_compressed || log->source.zstd != NULL;
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
    return replay->recording.is_told && !wh_recording_is_known(replay->recording.version);
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
    return !run->over.is_told && run == last_begun(replay) && replay->recording.closed == WH_RECORDING_BEGINS;
}

int64_t wh_reading_lost_expectations(const wh_replay_run_t *run) {
    const wh_log_numbers_t *there = &run->expectations;
    uint64_t missing = wh_log_numbers_missing(there);
    if (run->over.outcome.verdict == WH_OUTCOME_UNTOLD) {
        return 0;
    }
    if (run->begins_in_part && there->next == 0) {
        return 0;
    }
    for (size_t i = 0; run->begins_in_part && i < there->gap_count; ++i) {
        missing -= there->gaps[i].from == 0 ? there->gaps[i].to : 0;
    }
    return run->over.outcome.expectations - (int64_t)(there->next - missing);
}

/* A command that was refused, for its layout or another reason, has no slice. */
int64_t wh_reading_lost_end(const wh_replay_run_t *run) {
    const int64_t reached = run->last_refused > run->reached ? run->last_refused : run->reached;
    const bool is_told = run->over.is_told && !run->homeless.is_other_layout && run->homeless.count == 0;
    return is_told && run->over.seq > reached ? run->over.seq - reached : 0;
}

/* ------------------------------------------------------------------------------------------------ judging */

/* Writes the reason, if it is wanted. Returns true. */
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
    const wh_replay_count_t *lost = &replay->heard.losses[loss];
    const wh_reading_loss_t *words = &wh_reading_losses[loss];
    return lost->count > 0 && because(reason, "%" PRIu64 " %s, the first at byte %" PRIu64, lost->count,
                                      lost->count == 1 ? words->one : words->many, lost->first);
}

/* True for messages that the network or the file may have spoilt. */
static bool has_strange_messages(const wh_replay_t *replay, char *reason) {
    return !wh_replay_is_vouched_for(replay) &&
           (is_lost(replay, WH_REPLAY_CONTRADICTS, reason) || is_lost(replay, WH_REPLAY_STRAY, reason));
}

static bool has_doubtful_slices(const wh_replay_t *replay, char *reason) {
    int64_t doubtful = 0;
    for (size_t i = 0; i < replay->run_count; ++i) {
        doubtful += replay->runs[i].slices.doubtful;
    }
    return count_because(reason, (uint64_t)doubtful, "slice is doubtful", "slices are doubtful");
}

/* True for damage that no network causes. */
static bool is_file_damaged(const wh_replay_t *replay, const wh_reading_t *reading, char *reason) {
    if (reading->barren) {
        return because(reason, "no slice is in %.150s", reading->barren);
    }
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
        run->slices.unanswered + (wh_reading_lacks_end(replay, run) ? 0 : run->slices.last_unanswered);
    if (lost < 0) {
        return !because(reason, "more expectations are in the log than the run had");
    }
    return !count_because(reason, (uint64_t)wh_reading_lost_end(run), "slice before the run's end is missing",
                          "slices before the run's end are missing") &&
           !count_because(reason, (uint64_t)run->slices.skipped, "slice was passed over",
                          "slices were passed over") &&
           !count_because(reason, (uint64_t)run->slices.taken_up, "state was taken over as recorded",
                          "states were taken over as recorded") &&
           !count_because(reason, (uint64_t)unanswered, "command has no state", "commands have no states") &&
           !count_because(reason, (uint64_t)lost, "expectation is not in the log",
                          "expectations are not in the log");
}

/* True for losses that a network may cause. */
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
    return count_because(reason, replay->heard.proximities, "proximity could not be compared",
                         "proximities could not be compared");
}

/* A part of the recording that should follow, and was not read; 0: none. */
static int32_t find_lost_part(const wh_replay_t *replay, const wh_reading_t *reading) {
    return replay->files.lost_part > 0 ? replay->files.lost_part
           : reading->is_alone         ? 0
                                       : replay->files.awaited_part;
}

static bool lacks_part(const wh_replay_t *replay, const wh_reading_t *reading, char *reason) {
    const int32_t lost = find_lost_part(replay, reading);
    return lost > 0 &&
           because(reason, "part %d of the recording is not there (--alone reads a part by itself)",
                   (int)lost);
}

/* A file ended within a run, and no later one has the run's end. */
static bool is_run_left(const wh_replay_t *replay, const wh_reading_t *reading, char *reason) {
    bool left = reading->is_begun_and_cut ||
                (reading->cut_count > 0 && replay->run_count > 0 && !replay->runs[0].is_left);
    for (size_t i = 0; i < replay->run_count; ++i) {
        left = left || (replay->runs[i].is_left && !replay->runs[i].over.is_told);
    }
    return left && because(reason, "a file before the last one ends early, and the end is not in the others");
}

static int64_t count_compared(const wh_replay_t *replay) {
    int64_t compared = 0;
    for (size_t i = 0; i < replay->run_count; ++i) {
        compared += replay->runs[i].slices.compared;
    }
    return compared;
}

/* The first run that is not as recorded: for sure, or in doubt. Null if there is none. */
static const wh_replay_run_t *find_difference(const wh_replay_t *replay, bool doubtful) {
    for (size_t i = 0; i < replay->run_count; ++i) {
        const wh_replay_run_t *run = &replay->runs[i];
        if (run->slices.differing > 0 && wh_reading_is_doubtful(replay, run) == doubtful) {
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
    if (is_run_left(replay, reading, reason)) {
        return true;
    }
    if (reading->is_cut) {
        return because(reason, "it ends within an event, at byte %" PRIu64, reading->cut_at);
    }
    if (replay->recording.version > 0) {
        return replay->recording.closed == WH_RECORDING_BEGINS &&
               because(reason, "the recording was not closed, so nothing vouches for its texts");
    }
    return (!last || !last->over.is_told) && because(reason, "the run's end is not in it");
}

/* Damage, or anything missing that the leniency does not excuse. */
static bool is_incomplete(const wh_replay_t *replay, const wh_reading_t *reading, bool lenient,
                          char *reason) {
    return is_file_damaged(replay, reading, reason) || lacks_part(replay, reading, reason) ||
           (!lenient && is_something_missing(replay, reason)) || shows_nothing(replay, reason);
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
    if (is_incomplete(replay, reading, lenient, reason)) {
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
