/* Writes the events of a recording, and splits it into parts. */
#include "recording_internal.h"

#include <stdio.h>
#include <string.h>

#include "../text/clock.h"

#define SYNC UINT32_C(0xeda1da01)
#define EVENT_HEADER 28
/* The longest name of a channel in LCM. */
#define CHANNEL_MOST 63

/* ------------------------------------------------------------------------------------------------- events */

static uint8_t *put_big_endian(uint8_t *out, uint64_t value, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        out[i] = (uint8_t)(value >> 8 * (size - 1 - i));
    }
    return out + size;
}

void wh_recording_write_event(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    const size_t length = strnlen(channel, CHANNEL_MOST);
    uint8_t *out = recording->event;
    if (size > WH_LINK_DATAGRAM) {
        return;
    }
    out = put_big_endian(out, SYNC, 4);
    out = put_big_endian(out, (uint64_t)recording->events, 8);
    out = put_big_endian(out, (uint64_t)wh_clock_us(CLOCK_REALTIME), 8);
    out = put_big_endian(out, length, 4);
    out = put_big_endian(out, size, 4);
    memcpy(out, channel, length);
    memcpy(out + length, data, size);
    const size_t whole = EVENT_HEADER + length + size;
    if (!wh_record_file_put(&recording->file, recording->event, whole) && wh_recording_open_file(recording)) {
        (void)wh_record_file_put(&recording->file, recording->event, whole);
    }
    if (strncmp(channel, WH_LINK_OURS, strlen(WH_LINK_OURS)) == 0) {
        recording->digest = wh_link_digest(recording->digest, channel, data, size);
    }
    ++recording->events;
}

void wh_recording_write_note(wh_recording_t *recording, int8_t closed) {
    const wh_recording_place_t *last = &recording->last;
    const int8_t mode = recording->options.all ? WH_RECORDING_ALL : WH_RECORDING_SLICES;
    const waferhand_recording message = {.utime = last->utime,
                                         .seq = last->seq,
                                         .run = last->run,
                                         .layout_hash = (int64_t)last->layout_hash,
                                         .version = WH_RECORDING_VERSION,
                                         .id = recording->id,
                                         .part = recording->part,
                                         .mode = mode,
                                         .closed = closed,
                                         .program = wh_link_borrowed(recording->options.program),
                                         .program_version = wh_link_borrowed(wh_version()),
                                         .events = recording->events,
                                         .slices = recording->slices,
                                         .digest = (int64_t)recording->digest};
    const int size =
        waferhand_recording_encode(recording->encoded, 0, (int)sizeof recording->encoded, &message);
    wh_link_seal(recording->encoded, (size_t)size);
    wh_recording_write_event(recording, WH_CHANNEL_RECORDING, recording->encoded, (size_t)size);
}

void wh_recording_flush_block(wh_recording_t *recording) {
    wh_slices_t *block = &recording->block;
    for (size_t from = 0; from < block->count;) {
        const size_t size = wh_slices_encode(block, &from, recording->encoded);
        wh_recording_write_event(recording, WH_CHANNEL_SLICES, recording->encoded, size);
    }
    block->count = 0;
}

/* -------------------------------------------------------------------------------------------------- parts */

void wh_recording_begin_part(wh_recording_t *recording) {
    ++recording->part;
    recording->events = 0;
    recording->slices = 0;
    recording->digest = 0;
    wh_recording_write_note(recording, WH_RECORDING_BEGINS);
}

/* Opens the first file, which may have waited for this event. An old recording in parts is never mixed with
 * this one. */
static bool open_first(wh_recording_t *recording) {
    const wh_recording_options_t *options = &recording->options;
    const bool replaces = options->replaces && !wh_record_file_has_parts(options->path);
    const bool opened = replaces ? wh_record_file_replace(&recording->file, options->path)
                                 : wh_record_file_create(&recording->file, options->path);
    (void)snprintf(recording->path, sizeof recording->path, "%s", recording->file.path);
    return opened;
}

bool wh_recording_open_file(wh_recording_t *recording) {
    char name[PATH_MAX];
    char tag[20];
    if (recording->part == 1) {
        return open_first(recording);
    }
    snprintf(tag, sizeof tag, "part%d", (int)recording->part);
    if (!wh_record_file_name(recording->path, tag, name)) {
        wh_record_file_fail(&recording->file, recording->path, "the name is too long");
        return false;
    }
    return wh_record_file_create(&recording->file, name);
}

/* True if the cell of the last slice has come. In a message its hash stands after fingerprint, utime, seq
 * and run. */
static bool has_cell(const wh_recording_t *recording) {
    return recording->cell_size >= 40 &&
           wh_link_word(recording->cell + 32, 8) == (uint64_t)recording->last.layout_hash;
}

void wh_recording_split(wh_recording_t *recording, const void *state, size_t size) {
    const double bytes = recording->options.part_mb * 1e6;
    wh_record_file_t *file = &recording->file;
    if (bytes <= 0 || !file->is_plain_file || !has_cell(recording)) {
        return; /* without its cell the next part could not be read */
    }
    if ((double)file->written + (double)file->used >= bytes) {
        wh_record_file_flush(file);
    }
    if (file->failed || (double)file->written < bytes) {
        return;
    }
    wh_recording_write_note(recording, WH_RECORDING_GOES_ON);
    if (!wh_record_file_close(file)) {
        return;
    }
    wh_recording_begin_part(recording);
    if (wh_recording_open_file(recording)) {
        wh_recording_write_event(recording, WH_CHANNEL_CELL, recording->cell, recording->cell_size);
        wh_recording_write_note(recording, WH_RECORDING_BEGINS);
        wh_recording_write_event(recording, WH_CHANNEL_STATE, state, size);
    }
}
