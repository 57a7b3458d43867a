/* The messages of each channel of a log, and their handling. */
#include <endian.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "replay_internal.h"

static bool is_wanted(const wh_replay_t *replay, int64_t run) {
    return replay->given.only_run == 0 || replay->given.only_run == run;
}

/* ------------------------------------------------------------------------------------ commands and states */

static bool is_slice(int64_t run, int64_t seq) {
    return run != 0 && seq >= 1 && seq <= WH_LINK_SLICES;
}

/* A message without a check may come from a sender that makes none; false if it may also be a torn one. */
static bool is_to_be_had(wh_replay_t *replay, int64_t check) {
    if (check == 0) {
        wh_replay_lose(replay, replay->place.is_loose ? WH_REPLAY_GARBAGE : WH_REPLAY_UNCHECKED);
        return !replay->place.is_loose;
    }
    ++replay->heard.messages;
    return true;
}

static void on_command(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_command message;
    if (!wh_link_decode_command(data, size, &message) || !is_slice(message.run, message.seq)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
    } else if (is_wanted(replay, message.run) && is_to_be_had(replay, message.check)) {
        wh_replay_take_command(replay, &message);
    }
}

static void note_other_layout(wh_replay_t *replay, int64_t id) {
    wh_replay_run_t *run = wh_replay_entry(replay, id);
    if (run) {
        run->homeless.is_other_layout = true;
    }
}

static void on_state(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (!is_slice(message.run, message.seq)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
    } else if (is_wanted(replay, message.run) && is_to_be_had(replay, message.check)) {
        if (message.status == WH_OK) {
            wh_replay_take_state(replay, &message, data, size);
        } else if (message.status == WH_STATUS_OTHER_LAYOUT) {
            note_other_layout(replay, message.run);
        } else if (message.status != WH_STATUS_UNKNOWN_RUN && message.status != WH_STATUS_RUN_OVER) {
            wh_replay_take_refusal(replay, &message, data, size); /* else it is the knowledge of another
                                                                   * simulator */
        }
    }
    (void)waferhand_state_decode_cleanup(&message);
}

/* ----------------------------------------------------------------------------------------- other messages */

static void add_cell(wh_replay_t *replay, waferhand_cell *message) {
    static uint8_t bytes[WH_LINK_DATAGRAM];
    const uint64_t hash = (uint64_t)message->layout_hash;
    wh_replay_cell_t *known = wh_replay_find_cell(replay, hash);
    /* Compare the content of each message: without its time and its run. */
    message->utime = message->seq = message->run = 0;
    const int encoded = waferhand_cell_encode(bytes, 0, WH_LINK_DATAGRAM, message);
    const size_t size = encoded > 0 ? (size_t)encoded : 0;
    if (known) {
        known->is_sure = known->is_sure || known->times > 0;
        ++known->times;
        if (known->size != size || memcmp(known->told, bytes, size) != 0) {
            known->is_contradicted = true;
            wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
        }
        return;
    }
    wh_layout_t *layout = replay->cell_count < WH_REPLAY_CELLS ? wh_link_layout_from_cell(message) : NULL;
    if (!layout) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    wh_replay_cell_t *cell = &replay->cells[replay->cell_count++];
    *cell = (wh_replay_cell_t){
        .times = 1, .hash = hash, .layout = layout, .told = wh_array_new(size, 1), .size = size};
    memcpy(cell->told, bytes, size);
}

/* True if time and number of a slice fit each other, and the layout the run. */
static bool is_placed(wh_replay_t *replay, int64_t utime, int64_t seq, int64_t run, int64_t layout_hash) {
    const wh_replay_run_t *known = wh_replay_find_run(replay, run);
    const wh_replay_cell_t *cell = wh_replay_find_cell(replay, (uint64_t)layout_hash);
    const bool fits = !known || !known->is_begun || known->layout_hash == (uint64_t)layout_hash;
    return fits && (!cell || (seq >= 0 && seq <= WH_LINK_SLICES && utime == seq * cell->layout->slice_us));
}

static void on_cell(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_cell message;
    if (!wh_link_decode_cell(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->heard.messages;
    if (!is_placed(replay, message.utime, message.seq, message.run, message.layout_hash)) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    } else if (message.run != 0 && !wh_replay_find_run(replay, message.run) &&
               replay->heard.unknown_run == 0) {
        replay->heard.unknown_run = message.run;
        replay->heard.unknown_at = replay->place.at;
    }
    add_cell(replay, &message);
    (void)waferhand_cell_decode_cleanup(&message);
}

/* Notes the expectations in the log. */
static void take_expectation(wh_replay_t *replay, wh_replay_run_t *run, const waferhand_mcs *message) {
    if (message->error < 1) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
        return;
    }
    wh_log_numbers_take(&run->expectations, (uint64_t)message->error - 1, replay->place.at);
    run->unmet += message->phase == WH_LINK_PHASE_UNMET ? 1 : 0;
}

/* Takes the end of the run. Programs before version 2 of recordings told no verdict. */
static void take_over(wh_replay_t *replay, wh_replay_run_t *run, int64_t seq, const char *text) {
    const char *reason = wh_outcome_read(text, &run->over.outcome);
    run->over.is_told = true;
    run->over.at = replay->place.at;
    run->over.seq = seq;
    if (!reason && text[0] != '\0') {
        run->over.is_wrong = true;
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    }
    free(run->over.reason);
    run->over.reason = reason && reason[0] != '\0' ? wh_text_copy(reason) : NULL;
}

static void take_mcs(wh_replay_t *replay, const waferhand_mcs *message) {
    const bool tells = message->run != 0 && message->phase != WH_LINK_PHASE_IDLE &&
                       message->phase != WH_LINK_PHASE_GOES_ON && is_wanted(replay, message->run);
    wh_replay_run_t *run = tells ? wh_replay_entry(replay, message->run) : NULL;
    if (run && message->phase == WH_LINK_PHASE_OVER) {
        take_over(replay, run, message->seq, message->text);
    } else if (run && (message->phase == WH_LINK_PHASE_MET || message->phase == WH_LINK_PHASE_UNMET)) {
        take_expectation(replay, run, message);
    }
}

static void on_mcs(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_mcs message;
    if (!wh_link_decode_mcs(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->heard.messages;
    if (message.phase < 0 || message.phase >= WH_LINK_PHASES) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
    } else if (!is_placed(replay, message.utime, message.seq, message.run, message.layout_hash)) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    } else {
        take_mcs(replay, &message);
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

static void on_slices(wh_replay_t *replay, const void *data, size_t size) {
    static wh_slices_t slices;
    if (!wh_slices_decode(data, size, &slices) ||
        !is_slice(slices.identity.run, slices.first + (int64_t)slices.count - 1)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
    } else if (is_wanted(replay, slices.identity.run)) {
        ++replay->heard.messages;
        wh_replay_take_slices(replay, &slices);
    }
}

/* Compares the announced content of the log up to here with the real one. */
static void check_recording(wh_replay_t *replay, const waferhand_recording *message) {
    if (message->events != (int64_t)replay->heard.events - 1 ||
        (uint64_t)message->digest != replay->heard.digest) {
        replay->recording.is_changed = true;
        return;
    }
    for (size_t i = 0; i < replay->cell_count; ++i) {
        replay->cells[i].is_sure = replay->cells[i].is_sure || replay->cells[i].times > 0;
    }
}

static void take_recording(wh_replay_t *replay, const waferhand_recording *message) {
    wh_replay_recording_t *recording = &replay->recording;
    const bool is_known = !recording->is_told || wh_recording_is_known(recording->version);
    recording->version = is_known ? message->version : recording->version;
    recording->is_told = true;
    if (!wh_recording_is_known(recording->version)) {
        return;
    }
    check_recording(replay, message);
    if (replay->files.awaited_part != 0 &&
        (recording->id != message->id || recording->part + 1 != message->part) &&
        replay->files.lost_part == 0) {
        replay->files.lost_part = replay->files.awaited_part;
    }
    replay->files.awaited_part = 0;
    if (replay->heard.events == 1 && !replay->files.file_begins) {
        replay->files.part_begins = message->part > 1;
        recording->first_part = message->part;
    }
    recording->id = message->id;
    recording->part = message->part;
    recording->mode = message->mode;
    recording->closed = message->closed;
    (void)snprintf(recording->program, sizeof recording->program, "%s %s", message->program,
                   message->program_version);
}

static void on_recording(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_recording message;
    if (!wh_link_decode_recording(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->heard.messages;
    take_recording(replay, &message);
    (void)waferhand_recording_decode_cleanup(&message);
}

/* A state that was sent again to a restarted simulator adds nothing to the simulator's own state. */
static void on_restore(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_state message;
    if (!wh_link_decode_state(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    (void)is_to_be_had(replay, message.check);
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_request(wh_replay_t *replay, const void *data, size_t size) {
    waferhand_request message;
    if (!wh_link_decode_request(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    ++replay->heard.messages;
    (void)waferhand_request_decode_cleanup(&message);
}

/* A proximity message follows from its slice's state. */
static void on_proximity(wh_replay_t *replay, const void *data, size_t size) {
    const wh_protocol_server_t *server = &replay->server;
    waferhand_proximity message;
    waferhand_proximity made;
    uint8_t bytes[1024];
    if (size > sizeof bytes || waferhand_proximity_decode(data, 0, (int)size, &message) != (int)size) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (!is_wanted(replay, message.run)) {
        return;
    }
    ++replay->heard.messages;
    if (!replay->is_synchronous || server->identity.run != message.run || server->seq != message.seq) {
        ++replay->heard.proximities;
        return;
    }
    wh_link_proximity_to_message(&server->state, &server->identity, server->layout, &made);
    if (waferhand_proximity_encode(bytes, 0, (int)sizeof bytes, &made) != (int)size ||
        memcmp(bytes, data, size) != 0) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    }
}

/* True if the message is the scan in its last slice's state, including the samples of that slice. */
static bool is_scan_of(const waferhand_edge_scan *message, const wh_scan_t *scan) {
    const int32_t end = message->begin + message->sample_count;
    bool same = message->number == (int32_t)scan->number && message->gripper == scan->gripper &&
                message->count == scan->count && message->first == scan->first &&
                message->taken == scan->taken && end <= message->taken;
    for (int32_t i = 0; same && end == message->taken && i < scan->sample_count && i < message->sample_count;
         ++i) {
        same = message->samples[message->sample_count - 1 - i] == scan->samples[scan->sample_count - 1 - i];
    }
    return same;
}

/* It follows from its slices' states. */
static void on_edge_scan(wh_replay_t *replay, const void *data, size_t size) {
    const wh_protocol_server_t *server = &replay->server;
    waferhand_edge_scan message;
    if (!wh_link_decode_edge_scan(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (is_wanted(replay, message.run)) {
        ++replay->heard.messages;
        if (replay->is_synchronous && server->identity.run == message.run && server->seq == message.seq &&
            message.missed == 0 && !is_scan_of(&message, &server->simulator.physics.scan)) {
            wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
        }
    }
    (void)waferhand_edge_scan_decode_cleanup(&message);
}

/* It follows from its slices' states, and from what motion control believes of the beams. */
static void on_latch(wh_replay_t *replay, const void *data, size_t size) {
    const wh_protocol_server_t *server = &replay->server;
    waferhand_centring message;
    if (!wh_link_decode_centring(data, size, &message)) {
        wh_replay_lose(replay, WH_REPLAY_GARBAGE);
        return;
    }
    if (is_wanted(replay, message.run)) {
        const wh_latches_t *latches = &server->simulator.physics.latches;
        ++replay->heard.messages;
        if (replay->is_synchronous && server->identity.run == message.run && server->seq == message.seq &&
            (message.number != (int32_t)latches->number ||
             (int64_t)message.crossing_count + message.missed < (int64_t)latches->crossings)) {
            wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
        }
    }
    (void)waferhand_centring_decode_cleanup(&message);
}

/* ---------------------------------------------------------------------------------------------- the whole */

/* True if a datagram begins with the fingerprint of one of our messages. */
static bool is_ours(const void *data, size_t size) {
    const int64_t fingerprints[] = {__waferhand_command_get_hash(),   __waferhand_state_get_hash(),
                                    __waferhand_cell_get_hash(),      __waferhand_proximity_get_hash(),
                                    __waferhand_mcs_get_hash(),       __waferhand_request_get_hash(),
                                    __waferhand_slices_get_hash(),    __waferhand_recording_get_hash(),
                                    __waferhand_edge_scan_get_hash(), __waferhand_centring_get_hash()};
    uint64_t first = 0;
    bool ours = false;
    memcpy(&first, data, size < sizeof first ? 0 : sizeof first);
    for (size_t i = 0; i < sizeof fingerprints / sizeof fingerprints[0]; ++i) {
        ours = ours || (uint64_t)fingerprints[i] == be64toh(first);
    }
    return ours;
}

void wh_replay_event(wh_replay_t *replay, const char *channel, const void *data, size_t size) {
    static const struct {
        const char *channel;
        void (*handle)(wh_replay_t *replay, const void *data, size_t size);
    } handlers[] = {{WH_CHANNEL_CELL, on_cell},           {WH_CHANNEL_COMMAND, on_command},
                    {WH_CHANNEL_STATE, on_state},         {WH_CHANNEL_MCS, on_mcs},
                    {WH_CHANNEL_RESTORE, on_restore},     {WH_CHANNEL_REQUEST, on_request},
                    {WH_CHANNEL_PROXIMITY, on_proximity}, {WH_CHANNEL_SLICES, on_slices},
                    {WH_CHANNEL_RECORDING, on_recording}, {WH_CHANNEL_EDGE_SCAN, on_edge_scan},
                    {WH_CHANNEL_LATCH, on_latch}};
    const bool ours = strncmp(channel, WH_LINK_OURS, strlen(WH_LINK_OURS)) == 0;
    ++replay->heard.events;
    if (ours && replay->recording.closed != WH_RECORDING_BEGINS) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS); /* the log goes on behind its end */
    }

    bool is_known = false;
    for (size_t i = 0; i < sizeof handlers / sizeof handlers[0]; ++i) {
        if (strcmp(handlers[i].channel, channel) == 0) {
            is_known = true;
            handlers[i].handle(replay, data, size);
        }
    }
    if (ours) {
        replay->heard.digest = wh_link_digest(replay->heard.digest, channel, data, size);
    }
    if (!is_known && (ours || is_ours(data, size))) {
        wh_replay_lose(replay, WH_REPLAY_STRAY);
    }
}
