#include "recording_internal.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/clock.h"

/* The bytes of a cell's message: a fingerprint; then utime, seq and run, which tell when it was sent; then
 * its content. */
#define CELL_FINGERPRINT 8
#define CELL_CONTENT (8 + 3 * 8)

/* ------------------------------------------------------------------------------------------------- slices */

/* The command's slice becomes the last one. A file that waits for the first slice is opened. */
static void note_slice(wh_recording_t *recording, const waferhand_command *command, int64_t missed) {
    if (recording->file.fd < 0 && !recording->file.failed) {
        (void)wh_recording_open_file(recording);
    }
    recording->slices += recording->options.all ? 0 : 1;
    recording->last = (wh_recording_place_t){.run = command->run,
                                             .seq = command->seq,
                                             .utime = command->utime,
                                             .missed = missed,
                                             .layout_hash = (uint64_t)command->layout_hash};
}

/* True if a reader that knows the last slice can step this one. */
static bool follows(const wh_recording_place_t *last, const waferhand_command *command, int64_t missed) {
    if (command->run == last->run) {
        return command->seq == last->seq + 1 && missed == last->missed;
    }
    return command->seq == 1 && missed == 0;
}

/* Implements wh_recording_slice. A slice that does not fit the block begins another block. */
static wh_recorded_t take_slice(wh_recording_t *recording, const waferhand_command *command,
                                const int32_t told[], int64_t missed, uint64_t hash, bool has_events) {
    if (recording->is_interrupted || !follows(&recording->last, command, missed)) {
        return WH_NOT_RECORDED;
    }
    if (!wh_slices_add(&recording->block, command, told, hash)) {
        wh_recording_flush_block(recording);
        if (!wh_slices_add(&recording->block, command, told, hash)) {
            return WH_NOT_RECORDED;
        }
    }
    note_slice(recording, command, missed);
    ++recording->since_state;
    return has_events || recording->since_state >= WH_SLICES_MOST ? WH_RECORDED_STATE : WH_RECORDED;
}

/* Implements wh_recording_state. */
static void take_state(wh_recording_t *recording, const void *data, size_t size) {
    wh_recording_flush_block(recording);
    wh_recording_write_event(recording, WH_CHANNEL_STATE, data, size);
    recording->since_state = 0;
    wh_recording_split(recording, data, size);
}

/* ----------------------------------------------------------------------------------------------- messages */

static waferhand_command *waiting(wh_recording_t *recording, size_t i) {
    return &recording->commands[(recording->first_command + i) % WH_RECORDING_COMMANDS];
}

/* A sealed message always has exactly these bytes. */
static void write_command(wh_recording_t *recording, const waferhand_command *command) {
    const int size = waferhand_command_encode(recording->encoded, 0, (int)sizeof recording->encoded, command);
    wh_recording_write_event(recording, WH_CHANNEL_COMMAND, recording->encoded, (size_t)size);
}

/* The `count` oldest commands were not answered, or will be later; they stand by themselves. */
static void give_up(wh_recording_t *recording, size_t count) {
    if (count > 0) {
        wh_recording_flush_block(recording);
    }
    for (size_t i = 0; i < count; ++i) {
        const waferhand_command *command = waiting(recording, i);
        write_command(recording, command);
        /* A command of an earlier slice came late, and changes nothing. */
        recording->is_interrupted = recording->is_interrupted || command->run != recording->last.run ||
                                    command->seq > recording->last.seq;
    }
    recording->first_command = (recording->first_command + count) % WH_RECORDING_COMMANDS;
    recording->command_count -= count;
}

/* Finds the waiting command of this slice; their count if there is none. */
static size_t find_waiting(wh_recording_t *recording, int64_t run, int64_t seq) {
    size_t i = 0;
    /* Most commands are new; this needs no search. */
    if (recording->command_count > 0) {
        const waferhand_command *newest = waiting(recording, recording->command_count - 1);
        i = newest->run == run && newest->seq < seq ? recording->command_count : 0;
    }
    while (i < recording->command_count &&
           (waiting(recording, i)->run != run || waiting(recording, i)->seq != seq)) {
        ++i;
    }
    return i;
}

static void write_whole(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    wh_recording_flush_block(recording);
    wh_recording_write_event(recording, channel, data, size);
}

/* True if this very command is recorded or waits. */
static bool is_repeated(wh_recording_t *recording, const waferhand_command *message) {
    const wh_recording_place_t *last = &recording->last;
    const size_t i = find_waiting(recording, message->run, message->seq);
    if (i < recording->command_count) {
        return waiting(recording, i)->check == message->check;
    }
    return message->run == last->run && message->seq == last->seq && message->check == last->command_check;
}

static void on_command(wh_recording_t *recording, const void *data, size_t size) {
    waferhand_command message;
    if (!wh_link_decode_command(data, size, &message) || message.check == 0) {
        write_whole(recording, WH_CHANNEL_COMMAND, data, size);
        return;
    }
    if (is_repeated(recording, &message)) {
        return;
    }
    if (recording->command_count == WH_RECORDING_COMMANDS) {
        give_up(recording, 1);
    }
    *waiting(recording, recording->command_count++) = message;
}

/* Takes a command and its state as a slice, if replaying the command can yield the state. */
static void take_pair(wh_recording_t *recording, const waferhand_command *command,
                      const waferhand_state *state, const void *data, size_t size) {
    int32_t told[WH_GRIPPERS];
    wh_recorded_t recorded = WH_NOT_RECORDED;
    for (int32_t g = 0; g < state->gripper_count; ++g) {
        told[g] = state->grippers[g].valve_told;
    }
    if (state->utime == command->utime && state->layout_hash == command->layout_hash &&
        state->gripper_count == command->gripper_count) {
        recorded = take_slice(recording, command, told, state->missed, (uint64_t)state->hash,
                              state->event_count > 0);
    }
    if (recorded == WH_NOT_RECORDED) {
        wh_recording_flush_block(recording);
        write_command(recording, command);
        note_slice(recording, command, state->missed);
        recording->is_interrupted = false;
    }
    recording->last.command_check = command->check;
    recording->last.state_check = state->check;
    if (recorded != WH_RECORDED) {
        take_state(recording, data, size);
    }
}

/* Takes a state that no waiting command asked for, for example of a simulator that was given a state. */
static void take_lone_state(wh_recording_t *recording, const waferhand_state *state, const void *data,
                            size_t size) {
    wh_recording_place_t *last = &recording->last;
    write_whole(recording, WH_CHANNEL_STATE, data, size);
    if (state->status == WH_OK && state->check != 0 && (state->run != last->run || state->seq > last->seq)) {
        *last = (wh_recording_place_t){.run = state->run,
                                       .seq = state->seq,
                                       .utime = state->utime,
                                       .missed = state->missed,
                                       .layout_hash = (uint64_t)state->layout_hash,
                                       .state_check = state->check};
        recording->since_state = 0;
    }
}

static void on_sound_state(wh_recording_t *recording, const waferhand_state *state, const void *data,
                           size_t size) {
    const wh_recording_place_t *last = &recording->last;
    const size_t i = find_waiting(recording, state->run, state->seq);
    const bool is_answer = i < recording->command_count && state->check != 0;
    if (state->run == last->run && state->seq == last->seq && state->check != 0 &&
        state->check == last->state_check) {
        return;
    }
    if (!is_answer) {
        take_lone_state(recording, state, data, size);
    } else if (state->status != WH_OK) {
        give_up(recording, i + 1);
        write_whole(recording, WH_CHANNEL_STATE, data, size);
    } else {
        give_up(recording, i);
        const waferhand_command *command = waiting(recording, 0);
        recording->first_command = (recording->first_command + 1) % WH_RECORDING_COMMANDS;
        --recording->command_count;
        take_pair(recording, command, state, data, size);
    }
}

static void on_state(wh_recording_t *recording, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        write_whole(recording, WH_CHANNEL_STATE, data, size);
        return;
    }
    on_sound_state(recording, &message, data, size);
    (void)waferhand_state_decode_cleanup(&message);
}

/* True if the cell has the content of the last one, apart from the time and the run of sending. */
static bool is_known_cell(const wh_recording_t *recording, const void *data, size_t size) {
    const uint8_t *bytes = data;
    return size == recording->cell_size && size > CELL_CONTENT &&
           memcmp(bytes, recording->cell, CELL_FINGERPRINT) == 0 &&
           memcmp(bytes + CELL_CONTENT, recording->cell + CELL_CONTENT, size - CELL_CONTENT) == 0;
}

static void keep_cell(wh_recording_t *recording, const void *data, size_t size) {
    if (size <= sizeof recording->cell) {
        memcpy(recording->cell, data, size);
        recording->cell_size = size;
    }
}

static void on_cell(wh_recording_t *recording, const void *data, size_t size) {
    waferhand_cell message;
    const bool known = is_known_cell(recording, data, size);
    if (!known) {
        write_whole(recording, WH_CHANNEL_CELL, data, size);
    }
    if (wh_link_decode_cell(data, size, &message)) {
        keep_cell(recording, data, size);
        if (!known) {
            wh_recording_write_note(recording, WH_RECORDING_BEGINS);
        }
        (void)waferhand_cell_decode_cleanup(&message);
    }
}

/* Leaves out progress and messages that nothing moves; replaying the slices gives both. */
static void on_mcs(wh_recording_t *recording, const void *data, size_t size) {
    waferhand_mcs message;
    bool wanted = true;
    if (wh_link_decode_mcs(data, size, &message)) {
        wanted = message.phase != WH_LINK_PHASE_IDLE && message.phase != WH_LINK_PHASE_GOES_ON;
        (void)waferhand_mcs_decode_cleanup(&message);
    }
    if (wanted) {
        write_whole(recording, WH_CHANNEL_MCS, data, size);
    }
}

/* A part ends at a state that answers the last command. */
static void see_state(wh_recording_t *recording, const void *data, size_t size) {
    const wh_recording_place_t *last = &recording->last;
    waferhand_state message;
    if (wh_link_decode_state(data, size, &message)) {
        if (message.run == last->run && message.seq == last->seq && message.status == WH_OK) {
            wh_recording_split(recording, data, size);
        }
        (void)waferhand_state_decode_cleanup(&message);
    }
}

/* Takes every message. */
static void take_any(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    waferhand_command command;
    wh_recording_write_event(recording, channel, data, size);
    if (strcmp(channel, WH_CHANNEL_CELL) == 0) {
        keep_cell(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_COMMAND) == 0 && wh_link_decode_command(data, size, &command)) {
        note_slice(recording, &command, 0);
    } else if (strcmp(channel, WH_CHANNEL_STATE) == 0 && recording->options.part_mb > 0) {
        see_state(recording, data, size);
    }
}

static void take_message(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    if (recording->options.all) {
        take_any(recording, channel, data, size);
    } else if (strcmp(channel, WH_CHANNEL_COMMAND) == 0) {
        on_command(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_STATE) == 0) {
        on_state(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_CELL) == 0) {
        on_cell(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_MCS) == 0) {
        on_mcs(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_RESTORE) == 0) {
        write_whole(recording, channel, data, size);
        recording->is_interrupted = true;
    } else if (strcmp(channel, WH_CHANNEL_REQUEST) == 0) {
        write_whole(recording, channel, data, size);
    }
}

/* ------------------------------------------------------------------------------------------------ calling */

/* Locks the recording. Returns false if nothing is recorded any more. */
static bool enter(wh_recording_t *recording) {
    (void)pthread_mutex_lock(&recording->lock);
    return recording->is_open && !recording->file.failed;
}

void wh_recording_message(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    if (enter(recording)) {
        take_message(recording, channel, data, size);
    }
    (void)pthread_mutex_unlock(&recording->lock);
}

wh_recorded_t wh_recording_slice(wh_recording_t *recording, const waferhand_command *command,
                                 const int32_t told[], int64_t missed, uint64_t hash, bool has_events) {
    wh_recorded_t recorded = WH_RECORDED;
    if (enter(recording)) {
        recorded = take_slice(recording, command, told, missed, hash, has_events);
    }
    (void)pthread_mutex_unlock(&recording->lock);
    return recorded;
}

void wh_recording_state(wh_recording_t *recording, const void *data, size_t size) {
    if (enter(recording)) {
        take_state(recording, data, size);
    }
    (void)pthread_mutex_unlock(&recording->lock);
}

/* Ensures that nothing waits for long. */
static void *flush_now_and_then(void *user) {
    wh_recording_t *recording = user;
    (void)pthread_mutex_lock(&recording->lock);
    while (!recording->closes) {
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        /* It runs twice as often, so that a busy machine may be late. */
        until.tv_nsec += WH_RECORDING_WAIT_US * 1000L / 2;
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        (void)pthread_cond_clockwait(&recording->wake, &recording->lock, CLOCK_MONOTONIC, &until);
        if (recording->file.fd >= 0 && !recording->file.failed) {
            wh_recording_flush_block(recording);
            wh_record_file_flush(&recording->file);
        }
    }
    (void)pthread_mutex_unlock(&recording->lock);
    return NULL;
}

/* The thread that waits for messages handles the signals. */
static bool start_flusher(wh_recording_t *recording) {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    (void)pthread_mutex_init(&recording->lock, NULL);
    (void)pthread_cond_init(&recording->wake, NULL);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    const int error = pthread_create(&recording->flusher, NULL, flush_now_and_then, recording);
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (error != 0) {
        wh_record_file_fail(&recording->file, recording->options.path, strerror(error));
    }
    return error == 0;
}

bool wh_recording_open(wh_recording_t *recording) {
    recording->file.fd = -1;
    recording->file.speaker = recording->options.program;
    recording->file.option = recording->options.all ? "--record-all" : "--record";
    arc4random_buf(&recording->id, sizeof recording->id);
    recording->id &= INT64_MAX;
    wh_recording_begin_part(recording);
    if (recording->options.replaces ? !wh_record_file_can_replace(&recording->file, recording->options.path)
                                    : !wh_recording_open_file(recording)) {
        return false;
    }
    recording->is_open = start_flusher(recording);
    return recording->is_open;
}

bool wh_recording_is_sound(wh_recording_t *recording) {
    if (enter(recording) && recording->file.fd >= 0) {
        wh_record_file_flush(&recording->file);
    }
    const bool failed = recording->file.failed;
    (void)pthread_mutex_unlock(&recording->lock);
    return !failed;
}

bool wh_recording_close(wh_recording_t *recording) {
    wh_record_file_t *file = &recording->file;
    if (!recording->is_open) {
        return !file->failed;
    }
    (void)pthread_mutex_lock(&recording->lock);
    recording->closes = true;
    (void)pthread_cond_signal(&recording->wake);
    (void)pthread_mutex_unlock(&recording->lock);
    (void)pthread_join(recording->flusher, NULL);
    (void)pthread_cond_destroy(&recording->wake);
    (void)pthread_mutex_destroy(&recording->lock);
    recording->is_open = false;
    if (file->fd < 0) {
        if (!file->failed) {
            fprintf(stderr, "%s: %s: not written: no slice came\n", file->speaker, recording->options.path);
        }
        return false;
    }
    give_up(recording, recording->command_count);
    wh_recording_flush_block(recording);
    wh_recording_write_note(recording, WH_RECORDING_ENDS);
    return wh_record_file_close(file);
}

static bool open_for_node(void *user) {
    return wh_recording_open(user);
}

static void record_for_node(void *user, const char *channel, const void *data, size_t size) {
    wh_recording_message(user, channel, data, size);
}

bool wh_recording_open_node(wh_recording_t *recording, wh_node_t *node, const char *url) {
    const wh_node_recorder_t recorder = {open_for_node, record_for_node, recording};
    return wh_node_open(node, url, recording->options.path ? &recorder : NULL);
}
