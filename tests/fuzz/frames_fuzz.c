/* Any bytes on a line, and any bytes as a transcript.
 *
 * The first byte chooses: a description of frames, or a transcript. A framer's output does not
 * depend on how the bytes are cut. Every byte is reported, or counted as skipped. An encoded body
 * is a good frame with the same body. A transcript that is read, written in either form and read
 * again is the same. */
#include <string.h>

#include "fuzz.h"
#include "host/framing.h"
#include "host/transcript.h"

#define TOLD 65536

/* ------------------------------------------------------------------------------------------------- frames */

static wh_framing_t framing_of(uint8_t choice) {
    wh_framing_t framing = wh_framing_default();
    framing.start_count = choice % 3U;
    framing.starts[0] = (wh_framing_mark_t){"$", 1};
    framing.starts[1] = (wh_framing_mark_t){"!!", 2};
    framing.ends[0] = (wh_framing_mark_t){"\r", 1};
    framing.end_count = 1 + (choice >> 2 & 1U);
    framing.sum = (wh_sum_kind_t)(choice >> 3 & 3U);
    if (framing.sum != WH_SUM_NONE) {
        framing.separator = (wh_framing_mark_t){",", 1};
        framing.sums_separator = (choice & 0x20U) != 0;
    }
    framing.longest = 64;
    framing.timeout_us = (choice & 0x40U) != 0 ? 50 : 0;
    if (choice % 7U == 5U && framing.sum != WH_SUM_NONE) {
        framing.end_count = 1;
        framing.separator.size = 0;
        framing.sums_separator = false;
        framing.sum_is_behind = true;
        framing.sums_end = (choice & 0x20U) != 0;
        framing.sums_as_bytes = framing.sum == WH_SUM_XOR;
    }
    if (choice % 7U == 6U) {
        static const unsigned bases[] = {256, 10, 16};
        framing.length = (wh_framing_length_t){.size = 2,
                                               .base = bases[choice / 7U % 3U],
                                               .low_first = choice / 21U % 2U == 1,
                                               .counts = (wh_length_counts_t)(choice % 3U)};
        framing.end_count = choice >> 2 & 1U;
        framing.sums_length = framing.sum != WH_SUM_NONE;
        framing.sums_as_bytes = framing.sum == WH_SUM_ADD;
        framing.timeout_us = 50;
    }
    return framing;
}

/* Appends the framer's output to a text of numbers; the hash of its bytes stands for the rest. */
static void note(uint8_t told[TOLD], size_t *size, const wh_frame_t *frame) {
    REQUIRE(frame->size >= 1 && frame->size <= 64 && frame->body_size <= frame->size);
    REQUIRE(frame->body >= frame->bytes && frame->body + frame->body_size <= frame->bytes + frame->size);
    REQUIRE(frame->first_us <= frame->last_us);
    if (*size + frame->size + 3 <= TOLD) {
        told[(*size)++] = (uint8_t)frame->kind;
        told[(*size)++] = (uint8_t)frame->body_size;
        told[(*size)++] = (uint8_t)frame->start;
        memcpy(told + *size, frame->bytes, frame->size);
        *size += frame->size;
    }
}

/* The time of a byte is 10 us for each byte before it, plus a pause before each 0. */
static int64_t time_of(const uint8_t *data, size_t i) {
    static size_t pauses;
    pauses = i == 0 ? 0 : pauses;
    pauses += data[i] == 0;
    return (int64_t)(100 * pauses);
}

static wh_framer_t framer;

static void feed_piece(const uint8_t *data, size_t size, int64_t now, uint8_t told[TOLD], size_t *count) {
    wh_frame_t frame;
    size_t taken = 0;
    do {
        taken += wh_framer_feed(&framer, data + taken, size - taken, now, &frame);
        REQUIRE(taken <= size);
        if (frame.kind != WH_FRAME_NONE) {
            note(told, count, &frame);
        }
    } while (frame.kind != WH_FRAME_NONE || taken < size);
}

static size_t feed(const wh_framing_t *framing, const uint8_t *data, size_t size, size_t most,
                   uint8_t told[TOLD]) {
    wh_frame_t frame;
    size_t count = 0;
    REQUIRE(wh_framer_init(&framer, framing));
    for (size_t at = 0; at < size;) {
        const int64_t now = time_of(data, at);
        size_t piece = 1;
        while (piece < most && at + piece < size && data[at + piece] != 0) {
            (void)time_of(data, at + piece);
            ++piece;
        }
        if (most == 1 && wh_framer_wait(&framer, now, &frame)) {
            note(told, &count, &frame);
        }
        feed_piece(data + at, piece, now, told, &count);
        at += piece;
    }
    if (wh_framer_finish(&framer, &frame)) {
        note(told, &count, &frame);
    }
    REQUIRE(framer.counters.bytes == size);
    REQUIRE(wh_framer_due(&framer) == INT64_MAX);
    return count;
}

static void check_line(const wh_framing_t *framing, const uint8_t *data, size_t size) {
    static uint8_t whole[TOLD];
    static uint8_t cut[TOLD];
    const size_t count = feed(framing, data, size, SIZE_MAX, whole);
    REQUIRE(feed(framing, data, size, 1, cut) == count && memcmp(whole, cut, count) == 0);
    REQUIRE(feed(framing, data, size, 7, cut) == count && memcmp(whole, cut, count) == 0);
}

static void check_encoded(const wh_framing_t *framing, const uint8_t *data, size_t size) {
    uint8_t bytes[WH_FRAMING_LINE];
    wh_frame_t frame;
    const size_t start = framing->start_count > 1 ? size % framing->start_count : 0;
    const size_t whole = wh_framing_encode(framing, start, data, size, bytes);
    if (whole > 0) {
        REQUIRE(whole <= framing->longest && wh_framer_init(&framer, framing));
        (void)wh_framer_feed(&framer, bytes, whole, 0, &frame);
        REQUIRE(frame.kind == WH_FRAME_GOOD && frame.body_size == size &&
                memcmp(frame.body, data, size) == 0);
        REQUIRE(frame.start == start);
    }
}

/* -------------------------------------------------------------------------------------------- transcripts */

static char text[1 << 18];

static size_t write_again(const wh_transcript_t *transcript, bool is_json) {
    FILE *out = fmemopen(text, sizeof text, "w");
    REQUIRE(out && (is_json ? wh_transcript_write_json_heads
                            : wh_transcript_write_heads)(out, transcript->heads, transcript->head_count));
    for (size_t i = 0; i < transcript->count; ++i) {
        REQUIRE((is_json ? wh_transcript_write_json : wh_transcript_write)(out, &transcript->entries[i]));
    }
    const long written = ftell(out);
    REQUIRE(fclose(out) == 0 && written > 0 && written < (long)sizeof text);
    return (size_t)written;
}

static void check_same(const wh_transcript_t *first, wh_transcript_t *again) {
    REQUIRE(again->count == first->count && again->head_count == first->head_count);
    for (size_t i = 0; i < first->count; ++i) {
        const wh_transcript_entry_t *a = &first->entries[i];
        REQUIRE(again->entries[i].size == a->size && memcmp(again->entries[i].bytes, a->bytes, a->size) == 0);
        REQUIRE(wh_transcript_compare(again, a));
    }
    REQUIRE(wh_transcript_compare_end(again));
    while (wh_transcript_next(again, INT64_MAX)) {
    }
    REQUIRE(wh_transcript_due(again) == INT64_MAX);
}

static void check_transcript(const uint8_t *data, size_t size) {
    wh_transcript_t first;
    wh_transcript_t again;
    if (wh_transcript_parse(&first, "fuzz", data, size)) {
        /* In JSON times are doubles. */
        bool has_json = true;
        for (size_t i = 0; i < first.count; ++i) {
            has_json = has_json && first.entries[i].time_us < 9000000000000000;
        }
        for (int form = 0; form < (has_json ? 2 : 1); ++form) {
            REQUIRE(wh_transcript_parse(&again, "again", text, write_again(&first, form == 1)));
            check_same(&first, &again);
            wh_transcript_close(&again);
        }
    } else {
        REQUIRE(strncmp(first.message, "fuzz:", 5) == 0 && strstr(first.message, "(expected "));
    }
    wh_transcript_close(&first);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) {
        return 0;
    }
    if (data[0] >= 0x80) {
        check_transcript(data + 1, size - 1);
        return 0;
    }
    const wh_framing_t framing = framing_of(data[0]);
    check_line(&framing, data + 1, size - 1);
    check_encoded(&framing, data + 1, size - 1);
    return 0;
}
