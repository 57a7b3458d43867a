/* Makes the record and the signals of one run of a log, as motion control would have kept them. */
#include "log_run_internal.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* -------------------------------------------------------------------------------------------------- texts */

__attribute__((format(printf, 2, 3))) static void note(wh_log_run_t *run, const char *format, ...) {
    if (run->notes.count == WH_LOG_NOTES) {
        return;
    }
    char *text = run->notes.room[run->notes.count];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof run->notes.room[0], format, values);
    va_end(values);
    run->notes.texts[run->notes.count++] = text;
}

/* Writes why there is nothing to show: the file, then the reason. */
__attribute__((format(printf, 2, 3))) static bool refuse(wh_log_run_t *run, const char *format, ...) {
    const int length = snprintf(run->message, sizeof run->message, "%.300s: ", run->options.path);
    va_list values;
    va_start(values, format);
    (void)vsnprintf(run->message + length, sizeof run->message - (size_t)length, format, values);
    va_end(values);
    return false;
}

/* ------------------------------------------------------------------------------- what there is in the log */

static void add_run(wh_log_run_t *run, const wh_link_identity_t *identity) {
    bool is_known = identity->run == 0;
    for (size_t i = run->run_count; !is_known && i > 0; --i) {
        is_known = run->runs[i - 1].run == identity->run;
    }
    if (is_known) {
        return;
    }
    run->runs = wh_array_grow(run->runs, run->run_count, &run->run_capacity, sizeof *run->runs);
    run->runs[run->run_count++] = *identity;
}

/* True if this is a block of a run that is known: its slices need not be decoded. */
static bool is_of_known_run(const wh_log_run_t *run) {
    waferhand_slices message;
    bool is_known = false;
    if (!wh_link_is_slices(run->log.data, run->log.size) ||
        waferhand_slices_decode(run->log.data, 0, (int)run->log.size, &message) != (int)run->log.size) {
        return false;
    }
    for (size_t i = run->run_count; !is_known && i > 0; --i) {
        is_known = run->runs[i - 1].run == message.run;
    }
    (void)waferhand_slices_decode_cleanup(&message);
    return is_known;
}

static void look_at(wh_log_run_t *run) {
    static wh_slices_t slices;
    const wh_log_t *log = &run->log;
    waferhand_mcs told;
    waferhand_state state;
    if (strcmp(log->channel, WH_CHANNEL_MCS) == 0 && wh_link_decode_mcs(log->data, log->size, &told)) {
        wh_log_run_add_told(run, &told);
    } else if (strcmp(log->channel, WH_CHANNEL_SLICES) == 0 && !is_of_known_run(run) &&
               wh_slices_decode(log->data, log->size, &slices)) {
        add_run(run, &slices.identity);
    } else if (strcmp(log->channel, WH_CHANNEL_STATE) == 0 &&
               wh_link_decode_state(log->data, log->size, &state)) {
        if (state.status == WH_OK && state.seq > 0) {
            add_run(run, &(wh_link_identity_t){state.run, (uint64_t)state.layout_hash});
        }
        (void)waferhand_state_decode_cleanup(&state);
    }
}

/* Finds the cell of the wanted run. False if the log does not have it. */
static bool find_cell(wh_log_run_t *run, const wh_log_files_t *files) {
    waferhand_cell message;
    wh_log_files_begin(files, &run->log);
    while (!run->cell.layout && wh_log_next_event(&run->log)) {
        if (strcmp(run->log.channel, WH_CHANNEL_CELL) == 0 &&
            wh_link_decode_cell(run->log.data, run->log.size, &message)) {
            if ((uint64_t)message.layout_hash == run->wanted->layout_hash) {
                (void)wh_told_layout_make(&run->cell, &message, &run->options.layout);
            }
            (void)waferhand_cell_decode_cleanup(&message);
        }
    }
    return run->cell.layout != NULL;
}

/* ---------------------------------------------------------------------------------------------- the whole */

/* Judges everything in the log by a replay. */
static void judge_log(wh_log_run_t *run) {
    const wh_replay_recording_t *recording = &run->replay.recording;
    const wh_reading_verdict_t verdict = wh_reading_judge(&run->replay, &run->reading, false, run->reason);
    run->worth =
        (wh_record_log_t){.verdict = wh_reading_word(verdict),
                          .reason = run->reason,
                          .has_id = recording->version > 0,
                          .id = (uint64_t)recording->id,
                          .part = recording->first_part > 1 ? recording->first_part : recording->part,
                          .is_part = wh_log_run_is_part(run),
                          .notes = run->notes.texts};
    run->record.log = &run->worth;
    run->record.is_partial = verdict != WH_READING_SAME;
}

/* With several runs, all of them are replayed for that, and then the wanted one alone: a run may return after
 * another. */
static void replay_all(wh_log_run_t *run, const wh_log_files_t *files) {
    wh_reading_replay(files, &run->log, &run->replay, &run->reading);
    judge_log(run);
    wh_replay_close(&run->replay);
    memset(&run->replay, 0, sizeof run->replay);
}

/* Makes the second pass: the slices of the wanted run. */
static void follow(wh_log_run_t *run, const wh_log_files_t *files) {
    const wh_layout_t *layout = run->cell.layout;
    wh_recorder_open(&run->recorder, &run->record, run->options.path);
    run->recorder.layout = layout;
    run->recorder.cell = &layout->cell;
    if (run->cell.is_whole && layout->collision && !run->options.only_slices) {
        run->collision.memory = wh_array_new(wh_collision_bytes(layout), 1);
        run->collision.layout = layout;
        wh_links_home(&run->collision.links, layout);
    }
    run->replay.given.only_run = run->run_count > 1 ? run->wanted->run : 0;
    run->replay.given.listener = wh_log_run_on_state;
    run->replay.given.stepped = wh_log_run_on_stepped;
    run->replay.given.user = run;
    wh_reading_replay(files, &run->log, &run->replay, &run->reading);
    if (run->run_count == 1) {
        judge_log(run);
    }
    if (!run->options.only_slices) {
        wh_log_run_take_told_before(run, INT64_MAX);
    }
}

static bool is_sound_log(const wh_log_run_t *run) {
    return run->reason[0] == '\0';
}

static bool begins_late(const wh_log_run_t *run) {
    return run->replay.run && run->replay.run->first_slice > 1;
}

/* True if the rest is in the next part. */
static bool ends_early(const wh_log_run_t *run) {
    return run->replay.run && !run->replay.run->over.is_told &&
           run->replay.recording.closed == WH_RECORDING_GOES_ON;
}

/* A run is ok only if the log says so, and nothing of the log is missing. */
static void settle_verdict(wh_log_run_t *run) {
    if (run->told.outcome.verdict == WH_OUTCOME_FAILED) {
        run->record.ok = false;
    } else if ((run->told.outcome.verdict != WH_OUTCOME_PASSED || !is_sound_log(run) ||
                wh_log_run_is_part(run)) &&
               run->record.ok) {
        run->record.ok = false;
        run->record.is_untold = true;
    }
}

static void finish_run(wh_log_run_t *run) {
    const wh_recorder_end_t end = {run->state.wafers, run->taken.hash, run->taken.missed,
                                   run->collision.world};
    for (size_t i = 0; i < run->lane_count; ++i) {
        run->record.commands[run->lanes[i].running].end_s = wh_recorder_now(&run->recorder);
    }
    wh_log_run_judge(run);
    run->record.is_partial =
        run->record.is_partial || begins_late(run) || ends_early(run) || run->taken.gaps > 0;
    wh_recorder_finish(&run->recorder, &end);
    run->record.wall_s = (double)NAN;
    if (run->record.unlooked && run->cell.collision != WH_LINK_NO_COLLISION) {
        run->record.unlooked = NULL;
    }
    settle_verdict(run);
    wh_signals_finish(&run->signals);
}

static void note_lost(wh_log_run_t *run, const char *what, int64_t told, size_t there) {
    if (told > (int64_t)there) {
        note(run, "%" PRId64 " of %" PRId64 " %s are not in the log.", told - (int64_t)there, told, what);
    }
}

static void note_outcome(wh_log_run_t *run) {
    const wh_run_told_t *outcome = &run->told.outcome;
    if (outcome->verdict == WH_OUTCOME_UNTOLD) {
        note(run, "The log does not tell if the run passed.");
        return;
    }
    if (begins_late(run)) {
        return; /* the earlier slices are in another file */
    }
    note_lost(run, "commands", outcome->commands, run->record.command_count);
    note_lost(run, "expectations", outcome->expectations, run->record.expectation_count);
    note_lost(run, "cycles", outcome->cycles, run->record.cycle_count);
}

/* Notes the replay's verdict, and which part of the run this is. */
static void note_worth(wh_log_run_t *run) {
    const wh_replay_run_t *replayed = run->replay.run;
    if (!is_sound_log(run)) {
        note(run, "A replay says of the log: %s: %s.", run->worth.verdict, run->reason);
    }
    if (replayed && replayed->begins_in_part) {
        note(run, "The log is part %d of a recording: the run begins in an earlier part.",
             (int)run->worth.part);
    } else if (replayed && begins_late(run)) {
        note(run, "The log begins at slice %" PRId64 " of the run.", replayed->first_slice);
    }
    if (ends_early(run)) {
        note(run, "The log is part %d of a recording: the run goes on in the next part.",
             (int)run->worth.part);
    }
}

static void note_reading(wh_log_run_t *run) {
    const wh_reading_t *reading = &run->reading;
    const wh_replay_run_t *replayed = run->replay.run;
    if (replayed && replayed->slices.differing > 0) {
        note(run, "Not as a replay has it, first at slice %" PRId64 ": `waferhand replay` says more.",
             replayed->difference.slice);
    }
    if (reading->damage_count > 0) {
        note(run, "The log is damaged %" PRIu64 " %s, first at byte %" PRIu64 ": what is there is shown.",
             reading->damage_count, reading->damage_count == 1 ? "time" : "times", reading->damages[0].from);
    }
    if (reading->is_cut) {
        note(run, "The log is cut off at byte %" PRIu64 ": shown up to there.", reading->cut_at);
    }
}

static void note_files(wh_log_run_t *run) {
    const size_t unclosed = run->replay.files.open_files;
    if (run->options.then_count > 0) {
        note(run, "Read as one log: this file and %zu that %s it.", run->file_count - 1,
             run->file_count == 2 ? "follows" : "follow");
    }
    if (unclosed > 0) {
        note(run, "%zu of these files %s not closed: nothing vouches for the texts in %s.", unclosed,
             unclosed == 1 ? "was" : "were", unclosed == 1 ? "it" : "them");
    }
}

static void tell_worth(wh_log_run_t *run) {
    note_files(run);
    note_worth(run);
    note_outcome(run);
    if (!run->cell.is_whole) {
        note(run, "Shapes are the defaults of 300 mm wafers, and wafers per hour are not counted: %.140s.",
             run->cell.note);
    }
    if (run->taken.gaps > 0) {
        note(run, "%zu %s of slices %s not in the log: %" PRId64 " slices in all.", run->taken.gaps,
             run->taken.gaps == 1 ? "stretch" : "stretches", run->taken.gaps == 1 ? "is" : "are",
             run->replay.run->slices.skipped);
    }
    note_reading(run);
    run->worth.note_count = run->notes.count;
}

/* Makes the first pass over the log, for the runs with slices and the messages. Chooses the run; false if
 * there is none. */
static bool choose(wh_log_run_t *run, const wh_log_files_t *files) {
    wh_log_files_begin(files, &run->log);
    while (wh_log_next_event(&run->log)) {
        look_at(run);
    }
    const uint64_t events = run->log.count;
    if (events == 0 && run->log.source.broken > 0) {
        return refuse(run,
                      "damaged at byte %" PRIu64 ", within a compressed frame: nothing of it can be read",
                      run->log.source.first_broken);
    }
    if (events == 0) {
        return refuse(run, "no LCM event log (expected one)");
    }
    if (run->run_count == 0) {
        return refuse(run, "no slice of a run in it, in %" PRIu64 " events: nothing to show%s", events,
                      run->told.count > 0 ? "; `waferhand replay` tells what is there" : "");
    }
    if (run->options.number > run->run_count) {
        return refuse(run, "no run %zu in it (expected 1 to %zu)", run->options.number, run->run_count);
    }
    run->wanted = &run->runs[(run->options.number > 0 ? run->options.number : run->run_count) - 1];
    wh_log_run_choose_told(run);
    return true;
}

static bool choose_layout(wh_log_run_t *run, const wh_log_files_t *files) {
    if (!find_cell(run, files)) {
        return refuse(run, "no cell of this run in it (expected WAFERHAND_CELL, which a simulator tells once "
                           "a second)");
    }
    return !run->options.layout.path || run->cell.is_whole || refuse(run, "--layout: %s", run->cell.note);
}

static bool refuse_version(wh_log_run_t *run, int32_t version) {
    return refuse(run, "a recording of version %d (expected 1, %d or %d)", (int)version, WH_RECORDING_OLDEST,
                  WH_RECORDING_VERSION);
}

static bool read_runs(wh_log_run_t *run, const wh_log_files_t *files) {
    wh_log_files_begin(files, &run->log);
    const wh_log_head_t head = wh_log_head(&run->log);
    if (head.is_told && !wh_recording_is_known(head.version)) { /* its messages are unknown, too */
        return refuse_version(run, head.version);
    }
    if (!choose(run, files) || !choose_layout(run, files)) {
        return false;
    }
    if (run->run_count > 1) {
        replay_all(run, files);
    }
    follow(run, files);
    if (wh_reading_is_unknown(&run->replay)) {
        return refuse_version(run, run->replay.recording.version);
    }
    return run->taken.is_any ||
           refuse(run, "no sound slice of this run in it, in %" PRIu64 " events", run->reading.events);
}

bool wh_log_run_read(wh_log_run_t *run, const wh_log_run_options_t *options) {
    memset(run, 0, sizeof *run);
    run->options = *options;
    wh_log_files_t files;
    const wh_log_names_t names = {options->path, options->then, options->then_count, options->is_alone};
    const bool read = wh_log_files_open(&files, &names, run->message) && read_runs(run, &files);
    run->file_count = files.count;
    wh_log_files_close(&files);
    if (read && !options->only_slices) {
        finish_run(run);
        tell_worth(run);
    }
    return read;
}

void wh_log_run_close(wh_log_run_t *run) {
    wh_log_run_close_passes(run);
    wh_signals_close(&run->signals);
    wh_record_free(&run->record);
    free(run->collision.memory);
    wh_told_layout_free(&run->cell);
    wh_replay_close(&run->replay);
    wh_log_close(&run->log);
    for (size_t i = 0; i < run->told.count; ++i) {
        (void)waferhand_mcs_decode_cleanup(&run->told.items[i].message);
    }
    free(run->told.items);
    free(run->runs);
    run->told.items = NULL;
    run->runs = NULL;
    run->told.count = 0;
}
