#include "log_source.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

#include "../text/array.h"

#define MAGIC_BYTES 4

static const uint8_t magic[MAGIC_BYTES] = {0x28, 0xB5, 0x2F, 0xFD};

bool wh_log_source_is_packed(const void *bytes, size_t size) {
    return size >= MAGIC_BYTES && memcmp(bytes, magic, MAGIC_BYTES) == 0;
}

/* Reads on, behind what is kept: from the frame's beginning, if there is room. */
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

void wh_log_source_open(wh_log_source_t *source, FILE *file) {
    uint8_t begin[MAGIC_BYTES];
    wh_log_source_close(source);
    source->file = file;
    const size_t got = fread(begin, 1, sizeof begin, file);
    const bool is_packed = wh_log_source_is_packed(begin, got);
    source->packed = wh_array_new(is_packed ? WH_LOG_PACKED : sizeof begin, 1);
    memcpy(source->packed, begin, got);
    source->end = got;
    source->zstd = is_packed ? wh_memory_need(ZSTD_createDCtx()) : NULL;
}

/* Finds where the next frame begins, behind the beginning of the damaged one. False if none does. */
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
            if (wh_log_source_is_packed(found, MAGIC_BYTES)) {
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

/* Decompresses a piece of what is kept. False at the end. */
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

static size_t read_plain(wh_log_source_t *source, uint8_t *bytes, size_t size) {
    const size_t kept = source->end - source->at < size ? source->end - source->at : size;
    memcpy(bytes, source->packed + source->at, kept);
    source->at += kept;
    return kept + fread(bytes + kept, 1, size - kept, source->file);
}

size_t wh_log_source_read(wh_log_source_t *source, uint8_t *bytes, size_t size) {
    if (!source->zstd) {
        return read_plain(source, bytes, size);
    }
    ZSTD_outBuffer out = {bytes, size, 0};
    while (out.pos < out.size && unpack(source, &out)) {
    }
    return out.pos;
}

bool wh_log_source_is_cut(const wh_log_source_t *source) {
    return source->is_within || source->is_broken;
}

void wh_log_source_close(wh_log_source_t *source) {
    (void)ZSTD_freeDCtx(source->zstd);
    free(source->packed);
    memset(source, 0, sizeof *source);
}
