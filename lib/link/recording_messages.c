/* What becomes of a recording's messages: slices where command and state say no more, else themselves. */
#include <string.h>

#include "recording_internal.h"

/* A cell's fingerprint; then utime, seq and run, which tell when it was sent; then what it says. */
#define CELL_FINGERPRINT 8
#define CELL_CONTENT (8 + 3 * 8)

static wh_recording_command_t *waiting(wh_recording_t *recording, size_t i) {
    return &recording->commands[(recording->first_command + i) % WH_RECORDING_COMMANDS];
}

/* The oldest commands, so many, were not answered, or will be later: they stand by themselves. */
void wh_recording_give_up(wh_recording_t *recording, size_t count) {
    if (count > 0) {
        wh_recording_flush_block(recording);
    }
    for (size_t i = 0; i < count; ++i) {
        const wh_recording_command_t *command = waiting(recording, i);
        wh_recording_write_event(recording, WH_CHANNEL_COMMAND, command->bytes, command->size);
    }
    recording->first_command = (recording->first_command + count) % WH_RECORDING_COMMANDS;
    recording->command_count -= count;
}

/* Which of the waiting commands this slice's is; their count if it is none of them. */
static size_t find_waiting(wh_recording_t *recording, int64_t run, int64_t seq) {
    size_t i = 0;
    /* A new command, as most are: without a search. */
    if (recording->command_count > 0) {
        const wh_recording_command_t *newest = waiting(recording, recording->command_count - 1);
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

/* True if the command is recorded, or waits, as it is. */
static bool is_repeated(wh_recording_t *recording, const waferhand_command *message, const void *data,
                        size_t size) {
    const wh_recording_place_t *last = &recording->last;
    const size_t i = find_waiting(recording, message->run, message->seq);
    if (i < recording->command_count) {
        const wh_recording_command_t *same = waiting(recording, i);
        return same->size == size && memcmp(same->bytes, data, size) == 0;
    }
    return message->run == last->run && message->seq == last->seq && message->check == last->command_check;
}

static void on_command(wh_recording_t *recording, const void *data, size_t size) {
    waferhand_command message;
    if (size > WH_RECORDING_COMMAND_BYTES || !wh_link_decode_command(data, size, &message) ||
        message.check == 0) {
        write_whole(recording, WH_CHANNEL_COMMAND, data, size);
        return;
    }
    if (is_repeated(recording, &message, data, size)) {
        return;
    }
    if (recording->command_count == WH_RECORDING_COMMANDS) {
        wh_recording_give_up(recording, 1);
    }
    wh_recording_command_t *command = waiting(recording, recording->command_count++);
    command->run = message.run;
    command->seq = message.seq;
    command->size = size;
    memcpy(command->bytes, data, size);
}

/* True if the state is what its command, replayed, can yield. */
static bool answers(const waferhand_state *state, const waferhand_command *command) {
    return state->utime == command->utime && state->layout_hash == command->layout_hash &&
           state->gripper_count == command->gripper_count;
}

/* The command and the state that answers it. */
static void take_pair(wh_recording_t *recording, const wh_recording_command_t *waited,
                      const waferhand_state *state, const void *data, size_t size) {
    waferhand_command command;
    int32_t told[WH_GRIPPERS];
    wh_recorded_t recorded = WH_NOT_RECORDED;
    (void)wh_link_decode_command(waited->bytes, waited->size, &command);
    for (int32_t g = 0; g < state->gripper_count; ++g) {
        told[g] = state->grippers[g].valve_told;
    }
    if (answers(state, &command)) {
        recorded = wh_recording_take_slice(recording, &command, told, state->missed, (uint64_t)state->hash,
                                           state->event_count > 0);
    }
    if (recorded == WH_NOT_RECORDED) {
        write_whole(recording, WH_CHANNEL_COMMAND, waited->bytes, waited->size);
        wh_recording_see_slice(recording);
        wh_recording_note_place(recording, &command, state->missed);
    }
    recording->last.command_check = command.check;
    recording->last.state_check = state->check;
    if (recorded != WH_RECORDED) {
        wh_recording_take_state(recording, data, size);
    }
}

/* A state that no waiting command asked for: of a simulator that was given a state, say. */
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
        wh_recording_give_up(recording, i + 1);
        write_whole(recording, WH_CHANNEL_STATE, data, size);
    } else {
        wh_recording_give_up(recording, i);
        const wh_recording_command_t *command = waiting(recording, 0);
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

/* True if the cell says what the last one said, but for when it was sent, and in which run. */
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
            wh_recording_seal(recording);
        }
        (void)waferhand_cell_decode_cleanup(&message);
    }
}

/* Progress, and that nothing moves: who replays the slices knows that. */
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

static void see_command(wh_recording_t *recording, const void *data, size_t size) {
    waferhand_command message;
    if (wh_link_decode_command(data, size, &message)) {
        wh_recording_see_slice(recording);
        wh_recording_note_place(recording, &message, 0);
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

/* Every message. */
static void take_any(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    wh_recording_write_event(recording, channel, data, size);
    if (strcmp(channel, WH_CHANNEL_CELL) == 0) {
        keep_cell(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_COMMAND) == 0) {
        see_command(recording, data, size);
    } else if (strcmp(channel, WH_CHANNEL_STATE) == 0 && recording->options.part_mb > 0) {
        see_state(recording, data, size);
    }
}

void wh_recording_take_message(wh_recording_t *recording, const char *channel, const void *data,
                               size_t size) {
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
    } else if (strcmp(channel, WH_CHANNEL_REQUEST) == 0 || strcmp(channel, WH_CHANNEL_RESTORE) == 0) {
        write_whole(recording, channel, data, size);
    }
}
