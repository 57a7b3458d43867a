#include "logfile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include "../text/array.h"
#include "../text/output.h"

#define HEADER 28
#define SYNC UINT32_C(0xeda1da01)
#define SYNC_BYTES 4
/* The longest event of any program. */
#define LONGEST UINT64_C(0x10000000)
/* The longest name of a channel of any program. */
#define LONGEST_CHANNEL 1000
/* The first bytes of a compressed file, and of each of its frames. */
#define MAGIC_BYTES 4

static const uint8_t magic[MAGIC_BYTES] = {0x28, 0xB5, 0x2F, 0xFD};

/* Opening a pipe must not wait for its other end. */
FILE *wh_log_file(const char *path, const char **fault) {
    struct stat status;
    FILE *file = NULL;
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    *fault = NULL;
    if (fd < 0) {
        *fault = strerror(errno);
        return NULL;
    }
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        *fault = S_ISDIR(status.st_mode) ? "it is a directory" : "it is no regular file";
    } else {
        file = fdopen(fd, "rb");
    }
    if (!file) {
        *fault = *fault ? *fault : strerror(errno);
        (void)close(fd);
        return NULL;
    }
    wh_output_keep(path);
    return file;
}

bool wh_log_is_packed(const void *bytes, size_t size) {
    return size >= MAGIC_BYTES && memcmp(bytes, magic, MAGIC_BYTES) == 0;
}

static void open_source(wh_log_source_t *source, FILE *file) {
    rewind(file);
    source->file = file;
    source->packed = wh_array_new(WH_LOG_PACKED, 1);
    source->end = fread(source->packed, 1, MAGIC_BYTES, file);
    source->zstd = wh_log_is_packed(source->packed, source->end) ? wh_memory_need(ZSTD_createDCtx()) : NULL;
}

void wh_log_open(wh_log_t *log, FILE *file) {
    wh_log_close(log);
    memset(log, 0, offsetof(wh_log_t, window));
    log->begin = log->end = 0;
    open_source(&log->source, file);
}

void wh_log_close(wh_log_t *log) {
    (void)ZSTD_freeDCtx(log->source.zstd);
    free(log->source.packed);
    memset(&log->source, 0, sizeof log->source);
}

/* ------------------------------------------------------------------------------------------------- source */

/* Reads on after the kept bytes; the bytes from the frame's beginning stay, if there is room. */
static bool refill(wh_log_source_t *source) {
    const bool fits = source->end - source->frame < WH_LOG_PACKED / 2;
    const size_t from = fits ? source->frame : source->at;
    memmove(source->packed, source->packed + from, source->end - from);
    source->offset += from;
    source->end -= from;
    source->at -= from;
    source->frame = fits ? 0 : source->at;
    const size_t got = fread(source->packed + source->end, 1, WH_LOG_PACKED - source->end, source->file);
    source->end += got;
    return got > 0;
}

/* Finds the next frame after the beginning of the damaged one. False if there is none. */
static bool find_frame(wh_log_source_t *source) {
    source->at = source->frame + 1 < source->end ? source->frame + 1 : source->end;
    for (;;) {
        source->frame = source->at;
        if (source->end - source->at < MAGIC_BYTES && !refill(source)) {
            return false;
        }
        const uint8_t *from = source->packed + source->at;
        const uint8_t *found = memchr(from, magic[0], source->end - source->at);
        source->at = found ? (size_t)(found - source->packed) : source->end;
        source->frame = source->at;
        if (source->end - source->at >= MAGIC_BYTES) {
            if (wh_log_is_packed(found, MAGIC_BYTES)) {
                return true;
            }
            ++source->at;
        }
    }
}

static void note_broken(wh_log_source_t *source) {
    if (!source->is_broken && source->broken++ == 0) {
        source->first_broken = source->offset + source->frame;
    }
    source->is_broken = true;
    source->is_within = false;
    (void)ZSTD_DCtx_reset(source->zstd, ZSTD_reset_session_only);
}

/* Decompresses a piece of the kept bytes. False at the end. */
static bool unpack(wh_log_source_t *source, ZSTD_outBuffer *out) {
    if (source->at == source->end && !refill(source)) {
        return false;
    }
    ZSTD_inBuffer in = {source->packed, source->end, source->at};
    source->frame = source->is_within ? source->frame : source->at;
    const size_t left = ZSTD_decompressStream(source->zstd, out, &in);
    if (ZSTD_isError(left)) {
        note_broken(source);
        return find_frame(source);
    }
    source->at = in.pos;
    source->is_within = left > 0;
    source->is_broken = source->is_broken && left > 0;
    return true;
}

/* Reads up to `size` bytes; fewer only at the end. */
static size_t read_source(wh_log_source_t *source, uint8_t *bytes, size_t size) {
    if (!source->zstd) {
        const size_t kept = source->end - source->at < size ? source->end - source->at : size;
        memcpy(bytes, source->packed + source->at, kept);
        source->at += kept;
        return kept + fread(bytes + kept, 1, size - kept, source->file);
    }
    ZSTD_outBuffer out = {bytes, size, 0};
    while (out.pos < out.size && unpack(source, &out)) {
    }
    return out.pos;
}

/* ------------------------------------------------------------------------------------------------- window */

/* Brings `wanted` bytes from `next` on into the window, or all that there are. Returns their number. */
static size_t look(wh_log_t *log, size_t wanted) {
    if (log->end - log->begin < wanted) {
        memmove(log->window, log->window + log->begin, log->end - log->begin);
        log->end -= log->begin;
        log->begin = 0;
        log->end += read_source(&log->source, log->window + log->end, sizeof log->window - log->end);
    }
    return log->end - log->begin;
}

static void pass(wh_log_t *log, size_t size) {
    log->begin += size;
    log->next += size;
}

/* Passes over `size` bytes, more than the window has. False if the file ends before. */
static bool pass_over(wh_log_t *log, uint64_t size) {
    while (size > 0) {
        const size_t there = look(log, 1);
        const size_t part = size < there ? (size_t)size : there;
        if (part == 0) {
            return false;
        }
        pass(log, part);
        size -= part;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------ headers */

static uint64_t big_endian(const uint8_t *bytes, size_t count) {
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i) {
        value = value << 8 | bytes[i];
    }
    return value;
}

/* True if these bytes are a sync word, or as much of it as there is. */
static bool is_sync(const uint8_t *bytes, size_t there) {
    const size_t count = there < SYNC_BYTES ? there : SYNC_BYTES;
    return count == 0 || big_endian(bytes, count) == SYNC >> (8 * (SYNC_BYTES - count));
}

/* The event's whole length, 0 if no event has such a header. */
static uint64_t length_of(const uint8_t *header) {
    const uint64_t channel = big_endian(header + 20, 4);
    const uint64_t data = big_endian(header + 24, 4);
    const bool sound = channel > 0 && channel <= LONGEST_CHANNEL && data <= LONGEST;
    return sound ? HEADER + channel + data : 0;
}

/* True if an event begins at these bytes, the last ones in the window, and after it another one begins or
 * the file ends. `ends` tells whether the file ends with them. */
static bool is_linked(const uint8_t *bytes, size_t there, bool ends) {
    if (there < HEADER || !is_sync(bytes, there)) {
        return false;
    }
    const uint64_t length = length_of(bytes);
    if (length == 0 || length > there || (length == there && !ends)) {
        return false;
    }
    return length == there || (there - length >= SYNC_BYTES && is_sync(bytes + length, there - length));
}

/* The first place after the beginning of the window, and before `limit`, where events follow one another;
 * 0 if there is none. */
static size_t find_link(wh_log_t *log, size_t limit) {
    const size_t there = look(log, sizeof log->window);
    const bool ends = there < sizeof log->window;
    const uint8_t *bytes = log->window + log->begin;
    for (size_t at = 1; at < limit && at < there; ++at) {
        const uint8_t *found = memchr(bytes + at, (int)(SYNC >> 24), there - at);
        if (!found) {
            return 0;
        }
        at = (size_t)(found - bytes);
        if (at < limit && is_linked(found, there - at, ends)) {
            return at;
        }
    }
    return 0;
}

/* Passes over damage, up to where events follow one another again, or to the end. */
static wh_log_result_t skip_damage(wh_log_t *log) {
    for (;;) {
        const size_t there = look(log, sizeof log->window);
        const size_t found = find_link(log, there);
        if (found > 0 || there < sizeof log->window) {
            pass(log, found > 0 ? found : there);
            return WH_LOG_DAMAGED;
        }
        /* The next event may begin so near to the window's end that its own end is outside. */
        pass(log, sizeof log->window / 2);
    }
}

/* ------------------------------------------------------------------------------------------------- events */

static void take_header(wh_log_t *log, const uint8_t *bytes) {
    const size_t channel = (size_t)big_endian(bytes + 20, 4);
    const bool fits = channel < sizeof log->channel;
    log->number = big_endian(bytes + 4, 8);
    memcpy(log->channel, bytes + HEADER, fits ? channel : 0);
    log->channel[fits ? channel : 0] = '\0';
    log->data = bytes + HEADER + channel;
    log->size = (size_t)big_endian(bytes + 24, 4);
}

/* Passes over an event of another program that is longer than ours. */
static wh_log_result_t pass_event(wh_log_t *log, uint64_t length) {
    log->data = NULL;
    log->size = 0;
    if (!pass_over(log, length)) {
        return WH_LOG_CUT;
    }
    ++log->count;
    return WH_LOG_EVENT;
}

/* Takes the event at the window's beginning, whose header is there. If its length may be wrong, events
 * within it show that. */
static wh_log_result_t take_event(wh_log_t *log, uint64_t length) {
    const size_t most = HEADER + LONGEST_CHANNEL + WH_LOG_EVENT_BYTES;
    const size_t there = look(log, most + SYNC_BYTES);
    const uint8_t *bytes = log->window + log->begin;
    const bool fits = length <= most;
    const bool is_whole = fits && length <= there;
    const bool is_followed = is_whole && is_sync(bytes + length, there - (size_t)length);
    const size_t within = length < sizeof log->window ? (size_t)length : sizeof log->window;
    if (!is_followed && find_link(log, within) > 0) {
        return skip_damage(log);
    }
    if (fits && !is_whole) {
        return WH_LOG_CUT;
    }
    bytes = log->window + log->begin;
    take_header(log, bytes);
    if (!fits || log->size > WH_LOG_EVENT_BYTES) {
        return pass_event(log, length);
    }
    log->is_loose = !is_followed;
    pass(log, (size_t)length);
    ++log->count;
    return WH_LOG_EVENT;
}

/* The end of a file is that of the log, unless another one follows. */
static wh_log_result_t end_file(wh_log_t *log, wh_log_result_t result) {
    const uint64_t broken = log->source.broken;
    const uint64_t first_broken = log->source.first_broken;
    if (log->rest_count == 0) {
        return result;
    }
    log->is_cut = result == WH_LOG_CUT;
    log->passed += log->next;
    log->next = 0;
    log->begin = log->end = 0;
    ++log->file;
    --log->rest_count;
    wh_log_close(log);
    open_source(&log->source, *log->rest++);
    log->source.broken = broken;
    log->source.first_broken = first_broken;
    return WH_LOG_NEXT_FILE;
}

/* The next event or result in this file. */
static wh_log_result_t next_here(wh_log_t *log) {
    log->offset = log->next;
    const size_t there = look(log, HEADER);
    const uint8_t *bytes = log->window + log->begin;
    if (there == 0) {
        return log->source.is_within || log->source.is_broken ? WH_LOG_CUT : WH_LOG_END;
    }
    if (!is_sync(bytes, there)) {
        return skip_damage(log);
    }
    if (there < HEADER) {
        return WH_LOG_CUT;
    }
    const uint64_t length = length_of(bytes);
    return length > 0 ? take_event(log, length) : skip_damage(log);
}

wh_log_result_t wh_log_next(wh_log_t *log) {
    const wh_log_result_t result = next_here(log);
    return result == WH_LOG_END || result == WH_LOG_CUT ? end_file(log, result) : result;
}

bool wh_log_next_event(wh_log_t *log) {
    wh_log_result_t result = WH_LOG_DAMAGED;
    while (result == WH_LOG_DAMAGED || result == WH_LOG_NEXT_FILE) {
        result = wh_log_next(log);
    }
    return result == WH_LOG_EVENT;
}

/* ------------------------------------------------------------------------------------------------ numbers */

static void note_gap(wh_log_numbers_t *numbers, uint64_t from, uint64_t to) {
    if (numbers->gap_count < WH_LOG_GAPS) {
        numbers->gaps[numbers->gap_count].from = from;
        numbers->gaps[numbers->gap_count++].to = to;
    } else {
        numbers->beyond += to - from;
    }
}

/* Takes a number out of its gap, which leaves one gap, two, or none. False if it is in no gap. */
static bool fill_gap(wh_log_numbers_t *numbers, uint64_t number) {
    for (size_t i = 0; i < numbers->gap_count; ++i) {
        const uint64_t to = numbers->gaps[i].to;
        if (number < numbers->gaps[i].from || number >= to) {
            continue;
        }
        numbers->gaps[i].to = number;
        if (number == numbers->gaps[i].from) {
            numbers->gaps[i] = numbers->gaps[--numbers->gap_count];
        }
        if (number + 1 < to) {
            note_gap(numbers, number + 1, to);
        }
        return true;
    }
    return false;
}

static void note_first(wh_log_numbers_t *numbers, uint64_t at) {
    if (numbers->doubled + numbers->moved + numbers->misnumbered == 0) {
        numbers->first = at;
    }
}

static void insert(wh_log_numbers_t *numbers, uint64_t number, uint64_t at) {
    if (number >= numbers->next) {
        if (number > numbers->next) {
            note_gap(numbers, numbers->next, number);
        }
        numbers->next = number + 1;
        return;
    }
    note_first(numbers, at);
    if (fill_gap(numbers, number)) {
        ++numbers->moved;
    } else {
        ++numbers->doubled;
    }
}

void wh_log_numbers_take(wh_log_numbers_t *numbers, uint64_t number, uint64_t at) {
    if (numbers->waits) {
        numbers->waits = false;
        if (number == numbers->expected + 1) {
            note_first(numbers, numbers->odd_at);
            ++numbers->misnumbered;
            numbers->next = number;
        } else {
            insert(numbers, numbers->odd, numbers->odd_at);
        }
    }
    if (number == numbers->next) {
        ++numbers->next;
        return;
    }
    numbers->waits = true;
    numbers->odd = number;
    numbers->expected = numbers->next;
    numbers->odd_at = at;
}

void wh_log_numbers_finish(wh_log_numbers_t *numbers) {
    if (numbers->waits) {
        numbers->waits = false;
        insert(numbers, numbers->odd, numbers->odd_at);
    }
}

void wh_log_numbers_restart(wh_log_numbers_t *numbers) {
    wh_log_numbers_finish(numbers);
    numbers->beyond = wh_log_numbers_missing(numbers);
    numbers->gap_count = 0;
    numbers->next = 0;
}

uint64_t wh_log_numbers_missing(const wh_log_numbers_t *numbers) {
    uint64_t missing = numbers->beyond;
    for (size_t i = 0; i < numbers->gap_count; ++i) {
        missing += numbers->gaps[i].to - numbers->gaps[i].from;
    }
    return missing;
}
