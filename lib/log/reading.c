#include "reading.h"

#include <string.h>

const char *wh_reading_word(wh_reading_verdict_t verdict) {
    static const char *const words[] = {"same", "differs", "unusable", "incomplete", "cut"};
    return words[verdict];
}

/* ------------------------------------------------------------------------------------------------ reading */

static bool is_over(wh_log_result_t result) {
    return result == WH_LOG_END || result == WH_LOG_CUT;
}

/* The cell is told once a second, so a recording may begin before it. */
static void find_first_cell(FILE *file, wh_log_t *log, wh_replay_t *replay) {
    wh_log_result_t result;
    wh_log_open(log, file);
    while (replay->cell_count == 0 && !is_over(result = wh_log_next(log))) {
        if (result == WH_LOG_EVENT && strcmp(log->channel, WH_CHANNEL_CELL) == 0) {
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

static void note_damage(wh_reading_t *reading, const wh_log_t *log) {
    if (reading->damage_count < WH_READING_DAMAGES) {
        reading->damages[reading->damage_count] = (wh_reading_damage_t){log->offset, log->next};
    }
    ++reading->damage_count;
}

void wh_reading_replay(FILE *file, wh_log_t *log, wh_replay_t *replay, wh_reading_t *reading) {
    wh_log_result_t result;
    memset(reading, 0, sizeof *reading);
    find_first_cell(file, log, replay);
    wh_log_open(log, file);
    while (!is_over(result = wh_log_next(log))) {
        if (result == WH_LOG_DAMAGED) {
            note_damage(reading, log);
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

/* ------------------------------------------------------------------------------------------------ judging */

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

/* Messages that a network may have made so, as well as the file. */
static bool has_strange_messages(const wh_replay_t *replay) {
    return replay->losses[WH_REPLAY_CONTRADICTS].count + replay->losses[WH_REPLAY_STRAY].count > 0 &&
           !wh_replay_is_vouched_for(replay);
}

static bool are_numbers_odd(const wh_log_numbers_t *numbers) {
    return numbers->doubled + numbers->moved + numbers->misnumbered + wh_log_numbers_missing(numbers) > 0;
}

/* What no network does. */
static bool is_file_damaged(const wh_replay_t *replay, const wh_reading_t *reading) {
    bool damaged = reading->damage_count > 0 || reading->broken > 0 || are_numbers_odd(&reading->numbers) ||
                   has_strange_messages(replay) || replay->runs_left_out > 0 || replay->recording.is_changed;
    for (size_t i = 0; i < replay->run_count; ++i) {
        damaged = damaged || replay->runs[i].doubtful > 0;
    }
    return damaged;
}

static bool is_run_whole(const wh_replay_t *replay, const wh_replay_run_t *run) {
    const bool ends = run->last_unanswered == 0 || wh_reading_lacks_end(replay, run);
    const bool told = run->told.verdict == WH_OUTCOME_UNTOLD ||
                      (run->expectations.next == (uint64_t)run->told.expectations &&
                       wh_log_numbers_missing(&run->expectations) == 0);
    return run->unanswered == 0 && ends && run->taken_up == 0 && run->skipped == 0 && told;
}

/* What a network may do. */
static bool is_something_missing(const wh_replay_t *replay) {
    bool missing = replay->proximities > 0;
    for (size_t i = 0; i < WH_REPLAY_LOSSES; ++i) {
        missing = missing || replay->losses[i].count > 0;
    }
    for (size_t i = 0; i < replay->run_count; ++i) {
        missing = missing || !is_run_whole(replay, &replay->runs[i]);
    }
    return missing;
}

typedef struct {
    int64_t compared;
    bool differs, is_doubtful;
} found_t;

static found_t look_at_runs(const wh_replay_t *replay) {
    found_t found = {0, false, false};
    for (size_t i = 0; i < replay->run_count; ++i) {
        const wh_replay_run_t *run = &replay->runs[i];
        const bool doubtful = wh_reading_is_doubtful(replay, run);
        found.compared += run->compared;
        found.differs = found.differs || (run->differing > 0 && !doubtful);
        found.is_doubtful = found.is_doubtful || (run->differing > 0 && doubtful);
    }
    return found;
}

static bool has_end(const wh_replay_t *replay, const wh_reading_t *reading) {
    const wh_replay_run_t *last = last_begun(replay);
    const bool ends =
        replay->recording.version > 0 ? replay->recording.closed != WH_RECORDING_BEGINS : last && last->over;
    return ends && !reading->is_cut;
}

wh_reading_verdict_t wh_reading_judge(const wh_replay_t *replay, const wh_reading_t *reading, bool lenient) {
    const found_t found = look_at_runs(replay);
    if (!last_begun(replay) || wh_reading_is_unknown(replay)) {
        return WH_READING_UNUSABLE;
    }
    if (found.differs) {
        return WH_READING_DIFFERS;
    }
    if (found.is_doubtful || found.compared == 0 || is_file_damaged(replay, reading) ||
        (!lenient && is_something_missing(replay))) {
        return WH_READING_INCOMPLETE;
    }
    return has_end(replay, reading) ? WH_READING_SAME : WH_READING_CUT;
}
