#include "recording_internal.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

#define SYNC UINT32_C(0xeda1da01)
#define EVENT_HEADER 28
/* Longer names are no channels of LCM. */
#define CHANNEL_MOST 63

/* ------------------------------------------------------------------------------------------------- events */

static uint8_t *put_big_endian(uint8_t *out, uint64_t value, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        out[i] = (uint8_t)(value >> 8 * (size - 1 - i));
    }
    return out + size;
}

static int64_t wall_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

static bool open_file(wh_recording_t *recording);

/* Writes one event. What is longer than a datagram comes from nobody. */
void wh_recording_write_event(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    const size_t length = strnlen(channel, CHANNEL_MOST);
    uint8_t *out = recording->event;
    if (size > WH_LINK_DATAGRAM) {
        return;
    }
    out = put_big_endian(out, SYNC, 4);
    out = put_big_endian(out, (uint64_t)recording->events, 8);
    out = put_big_endian(out, (uint64_t)wall_us(), 8);
    out = put_big_endian(out, length, 4);
    out = put_big_endian(out, size, 4);
    memcpy(out, channel, length);
    memcpy(out + length, data, size);
    const size_t whole = EVENT_HEADER + length + size;
    if (!wh_record_file_put(&recording->file, recording->event, whole) && open_file(recording)) {
        (void)wh_record_file_put(&recording->file, recording->event, whole);
    }
    if (strncmp(channel, WH_LINK_OURS, strlen(WH_LINK_OURS)) == 0) {
        recording->digest = wh_link_digest(recording->digest, channel, data, size);
    }
    ++recording->events;
}

/* Says what the log is, and what is in it so far: at its beginning, behind a cell, and at its end. */
static void write_recording(wh_recording_t *recording, int8_t closed) {
    const wh_recording_place_t *last = &recording->last;
    const waferhand_recording message = {.utime = last->utime,
                                         .seq = last->seq,
                                         .run = last->run,
                                         .layout_hash = (int64_t)last->layout_hash,
                                         .version = WH_RECORDING_VERSION,
                                         .id = recording->id,
                                         .part = recording->part,
                                         .mode =
                                             recording->options.all ? WH_RECORDING_ALL : WH_RECORDING_SLICES,
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

void wh_recording_seal(wh_recording_t *recording) {
    write_recording(recording, WH_RECORDING_BEGINS);
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

static void begin_part(wh_recording_t *recording) {
    ++recording->part;
    recording->events = 0;
    recording->slices = 0;
    recording->digest = 0;
    write_recording(recording, WH_RECORDING_BEGINS);
}

static bool open_named(wh_recording_t *recording, const char *path) {
    return recording->options.replaces
               ? wh_record_file_replace(&recording->file, path, recording->options.inputs)
               : wh_record_file_create(&recording->file, path);
}

/* Opens the file of the running part, which may have waited for it. */
static bool open_file(wh_recording_t *recording) {
    char name[PATH_MAX];
    char tag[20];
    if (recording->part == 1) {
        return open_named(recording, recording->options.path);
    }
    snprintf(tag, sizeof tag, "part%d", (int)recording->part);
    if (!wh_record_file_name(recording->options.path, tag, name)) {
        wh_record_file_fail(&recording->file, recording->options.path, "the name is too long");
        return false;
    }
    return open_named(recording, name);
}

/* Ends a part that has become large enough, at a whole state, with which the next part begins. */
void wh_recording_split(wh_recording_t *recording, const void *state, size_t size) {
    const double bytes = recording->options.part_mb * 1e6;
    wh_record_file_t *file = &recording->file;
    if (bytes <= 0 || !file->is_plain_file || file->failed || (double)file->written < bytes) {
        return;
    }
    write_recording(recording, WH_RECORDING_GOES_ON);
    if (!wh_record_file_close(file)) {
        return;
    }
    begin_part(recording);
    if (open_file(recording)) {
        if (recording->cell_size > 0) {
            wh_recording_write_event(recording, WH_CHANNEL_CELL, recording->cell, recording->cell_size);
            wh_recording_seal(recording);
        }
        wh_recording_write_event(recording, WH_CHANNEL_STATE, state, size);
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

/* The first slice of anything: a file that waits for it is opened. */
void wh_recording_see_slice(wh_recording_t *recording) {
    if (recording->file.fd < 0 && !recording->file.failed) {
        (void)open_file(recording);
    }
    recording->slices += recording->options.all ? 0 : 1;
}

void wh_recording_note_place(wh_recording_t *recording, const waferhand_command *command, int64_t missed) {
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

static bool add_slice(wh_recording_t *recording, const waferhand_command *command, const int32_t told[],
                      uint64_t hash) {
    if (wh_slices_add(&recording->block, command, told, hash)) {
        return true;
    }
    wh_recording_flush_block(recording);
    return wh_slices_add(&recording->block, command, told, hash);
}

wh_recorded_t wh_recording_take_slice(wh_recording_t *recording, const waferhand_command *command,
                                      const int32_t told[], int64_t missed, uint64_t hash, bool has_events) {
    if (!follows(&recording->last, command, missed) || !add_slice(recording, command, told, hash)) {
        return WH_NOT_RECORDED;
    }
    wh_recording_see_slice(recording);
    wh_recording_note_place(recording, command, missed);
    ++recording->since_state;
    return has_events || recording->since_state >= WH_SLICES_MOST ? WH_RECORDED_STATE : WH_RECORDED;
}

void wh_recording_take_state(wh_recording_t *recording, const void *data, size_t size) {
    wh_recording_flush_block(recording);
    wh_recording_write_event(recording, WH_CHANNEL_STATE, data, size);
    recording->since_state = 0;
    wh_recording_split(recording, data, size);
}

/* ------------------------------------------------------------------------------------------------ calling */

/* True if nothing is recorded any more. */
static bool is_idle(const wh_recording_t *recording) {
    return !recording->is_open || recording->file.failed;
}

void wh_recording_message(wh_recording_t *recording, const char *channel, const void *data, size_t size) {
    (void)pthread_mutex_lock(&recording->lock);
    if (!is_idle(recording)) {
        wh_recording_take_message(recording, channel, data, size);
    }
    (void)pthread_mutex_unlock(&recording->lock);
}

wh_recorded_t wh_recording_slice(wh_recording_t *recording, const waferhand_command *command,
                                 const int32_t told[], int64_t missed, uint64_t hash, bool has_events) {
    wh_recorded_t recorded = WH_RECORDED;
    (void)pthread_mutex_lock(&recording->lock);
    if (!is_idle(recording)) {
        recorded = wh_recording_take_slice(recording, command, told, missed, hash, has_events);
    }
    (void)pthread_mutex_unlock(&recording->lock);
    return recorded;
}

void wh_recording_state(wh_recording_t *recording, const void *data, size_t size) {
    (void)pthread_mutex_lock(&recording->lock);
    if (!is_idle(recording)) {
        wh_recording_take_state(recording, data, size);
    }
    (void)pthread_mutex_unlock(&recording->lock);
}

/* Sees to it that nothing waits for long. */
static void *flush_now_and_then(void *user) {
    wh_recording_t *recording = user;
    (void)pthread_mutex_lock(&recording->lock);
    while (!recording->closes) {
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        /* Twice as often, so that a machine that is busy may be late. */
        until.tv_nsec += WH_RECORDING_WAIT_US * 1000L / 2;
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        (void)pthread_cond_timedwait(&recording->wake, &recording->lock, &until);
        if (recording->file.fd >= 0 && !recording->file.failed) {
            wh_recording_flush_block(recording);
            wh_record_file_flush(&recording->file);
        }
    }
    (void)pthread_mutex_unlock(&recording->lock);
    return NULL;
}

/* Signals are for the thread that waits for messages. */
static bool start_flusher(wh_recording_t *recording) {
    pthread_condattr_t attributes;
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    (void)pthread_mutex_init(&recording->lock, NULL);
    (void)pthread_condattr_init(&attributes);
    (void)pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    (void)pthread_cond_init(&recording->wake, &attributes);
    (void)pthread_condattr_destroy(&attributes);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    const int error = pthread_create(&recording->flusher, NULL, flush_now_and_then, recording);
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (error != 0) {
        wh_record_file_fail(&recording->file, recording->options.path, strerror(error));
    }
    return error == 0;
}

static int64_t draw_id(void) {
    uint64_t bits = 0;
    if (getrandom(&bits, sizeof bits, 0) != (ssize_t)sizeof bits) {
        bits = (uint64_t)wall_us();
    }
    return (int64_t)(bits >> 1);
}

bool wh_recording_open(wh_recording_t *recording) {
    recording->file.fd = -1;
    recording->file.speaker = recording->options.program;
    recording->id = draw_id();
    begin_part(recording);
    if (!recording->options.replaces && !open_file(recording)) {
        return false;
    }
    recording->is_open = start_flusher(recording);
    return recording->is_open;
}

static void stop_flusher(wh_recording_t *recording) {
    (void)pthread_mutex_lock(&recording->lock);
    recording->closes = true;
    (void)pthread_cond_signal(&recording->wake);
    (void)pthread_mutex_unlock(&recording->lock);
    (void)pthread_join(recording->flusher, NULL);
    (void)pthread_cond_destroy(&recording->wake);
    (void)pthread_mutex_destroy(&recording->lock);
}

bool wh_recording_close(wh_recording_t *recording) {
    wh_record_file_t *file = &recording->file;
    if (!recording->is_open) {
        return !file->failed;
    }
    stop_flusher(recording);
    recording->is_open = false;
    if (file->fd < 0) {
        if (!file->failed) {
            fprintf(stderr, "%s: %s: not written: no slice came\n", file->speaker, recording->options.path);
        }
        return !file->failed;
    }
    wh_recording_give_up(recording, recording->command_count);
    wh_recording_flush_block(recording);
    write_recording(recording, WH_RECORDING_ENDS);
    return wh_record_file_close(file);
}
