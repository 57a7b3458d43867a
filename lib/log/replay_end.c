/* The ends of a log's files, and of the whole replay: what must have come by then. */
#include <stdlib.h>

#include "replay_internal.h"

bool wh_replay_is_vouched_for(const wh_replay_t *replay) {
    const wh_replay_recording_t *recording = &replay->recording;
    return recording->version > 0 && recording->closed != WH_RECORDING_BEGINS && !recording->is_changed &&
           replay->files.open_files == 0;
}

/* A file has ended: if its recording goes on, its next part must come. A file without a recording's
 * description does not stand in for that part. */
static void await_part(wh_replay_t *replay) {
    const wh_replay_recording_t *recording = &replay->recording;
    if (recording->version > 0 && recording->closed == WH_RECORDING_GOES_ON) {
        replay->files.awaited_part = recording->part + 1;
    }
}

void wh_replay_next_file(wh_replay_t *replay) {
    wh_replay_recording_t *recording = &replay->recording;
    const bool is_open = recording->version == 0 || recording->closed == WH_RECORDING_BEGINS;
    wh_replay_tell_last(replay);
    replay->files.open_files += is_open ? 1 : 0;
    await_part(replay);
    if (replay->run && !replay->run->over.is_told) {
        replay->run->is_left = true;
    }
    recording->closed = WH_RECORDING_BEGINS;
    replay->heard.events = replay->heard.digest = 0;
    replay->files.file_begins = true;
}

/* True if all expectations of the run are in the log, each once. */
static bool has_expectations(const wh_replay_run_t *run) {
    const wh_log_numbers_t *there = &run->expectations;
    return there->next == (uint64_t)run->over.outcome.expectations && there->doubled == 0 &&
           wh_log_numbers_missing(there) == 0;
}

/* Completes a run when no more messages come. */
static void finish_run(wh_replay_t *replay, wh_replay_run_t *run) {
    const wh_run_told_t *told = &run->over.outcome;
    const bool passed = told->verdict == WH_OUTCOME_PASSED;
    const bool counts = told->verdict != WH_OUTCOME_UNTOLD && has_expectations(run);
    if ((passed && run->unmet > 0) || (counts && run->unmet != told->expectations - told->met)) {
        run->over.is_wrong = true;
        replay->place.at = run->over.at;
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    }
    if (run->homeless.count > 0 && !run->homeless.is_other_layout) {
        replay->place.at = run->homeless.at;
        wh_replay_lose(replay, WH_REPLAY_HOMELESS);
        replay->heard.losses[WH_REPLAY_HOMELESS].count += (uint64_t)run->homeless.count - 1;
    }
}

void wh_replay_end(wh_replay_t *replay) {
    wh_replay_finish(replay);
    await_part(replay);
    for (size_t i = 0; i < replay->run_count; ++i) {
        wh_log_numbers_finish(&replay->runs[i].expectations);
        finish_run(replay, &replay->runs[i]);
    }
    /* A network may bring the cell of an earlier run late: no loss, if that is certain. */
    if (replay->heard.unknown_run != 0 && !wh_replay_find_run(replay, replay->heard.unknown_run) &&
        !wh_replay_is_vouched_for(replay)) {
        replay->place.at = replay->heard.unknown_at;
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    }
}

void wh_replay_close(wh_replay_t *replay) {
    for (size_t i = 0; i < WH_REPLAY_WINDOW; ++i) {
        free(replay->slots[i].state);
        replay->slots[i] = (wh_replay_slot_t){0};
    }
    for (size_t i = 0; i < replay->cell_count; ++i) {
        wh_link_layout_free(replay->cells[i].layout);
        free(replay->cells[i].told);
    }
    replay->cell_count = 0;
    free(replay->told);
    replay->told = NULL;
    replay->told_count = replay->told_capacity = 0;
    for (size_t i = 0; i < replay->run_count; ++i) {
        free(replay->runs[i].over.reason);
    }
    replay->run_count = 0;
    if (replay->cell) {
        wh_protocol_server_close(&replay->server);
        replay->cell = NULL;
    }
}
