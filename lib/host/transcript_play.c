/* A transcript is played again: what befalls a run is handed out at its slice, what it tells is compared. */
#include <string.h>

#include "transcript_internal.h"

/* Of a frame in a message. */
#define SHOWN_FRAME 300

/* True of what a run tells, which is compared; the rest befalls it. */
static bool is_told(wh_transcript_kind_t kind) {
    return kind == WH_TRANSCRIPT_HEARD || kind == WH_TRANSCRIPT_CLOCK || kind == WH_TRANSCRIPT_ENDED;
}

/* The number of the next entry from `at` on that a run tells, or that befalls it; the count: none is left. */
static size_t seek(const wh_transcript_t *transcript, size_t at, bool told) {
    while (at < transcript->count && is_told(transcript->entries[at].kind) != told) {
        ++at;
    }
    return at;
}

void wh_transcript_rewind(wh_transcript_t *transcript) {
    transcript->said = seek(transcript, 0, false);
    transcript->heard = seek(transcript, 0, true);
}

const wh_transcript_entry_t *wh_transcript_next(wh_transcript_t *transcript, int64_t slice) {
    if (wh_transcript_due(transcript) > slice || transcript->said == transcript->count) {
        return NULL;
    }
    const wh_transcript_entry_t *next = &transcript->entries[transcript->said];
    transcript->said = seek(transcript, transcript->said + 1, false);
    return next;
}

int64_t wh_transcript_due(const wh_transcript_t *transcript) {
    return transcript->said < transcript->count ? transcript->entries[transcript->said].slice : INT64_MAX;
}

/* What is to be heard next, or null. */
static const wh_transcript_entry_t *expected_next(const wh_transcript_t *transcript) {
    return transcript->heard < transcript->count ? &transcript->entries[transcript->heard] : NULL;
}

int64_t wh_transcript_last(const wh_transcript_t *transcript) {
    return transcript->count > 0 ? transcript->entries[transcript->count - 1].slice : 0;
}

/* Before the first byte that differs so many are shown. */
#define SHOWN_BEFORE ((size_t)40)

/* From where on two frames are shown: a difference far behind would be cut off. */
static size_t find_shown(const wh_transcript_entry_t *one, const wh_transcript_entry_t *other) {
    const bool are_frames =
        one && other && wh_transcript_has_bytes(one->kind) && wh_transcript_has_bytes(other->kind);
    const size_t size = !are_frames ? 0 : one->size < other->size ? one->size : other->size;
    size_t same = 0;
    while (same < size && one->bytes[same] == other->bytes[same]) {
        ++same;
    }
    return same > 2 * SHOWN_BEFORE && are_frames ? same - SHOWN_BEFORE : 0;
}

/* An entry as it stands in the file, its bytes from this one on, as far as they are shown. */
static void show(char shown[SHOWN_FRAME + 200], const wh_transcript_entry_t *entry, size_t from) {
    char bytes[SHOWN_FRAME];
    if (!entry) {
        (void)snprintf(shown, SHOWN_FRAME + 200, "nothing");
        return;
    }
    if (!wh_transcript_has_bytes(entry->kind)) {
        (void)snprintf(shown, SHOWN_FRAME + 200, "%lld %lld.%06lld %c %s", (long long)entry->slice,
                       (long long)entry->time_us / 1000000, (long long)entry->time_us % 1000000, entry->kind,
                       entry->port);
        return;
    }
    const size_t size = entry->size - from;
    const bool is_whole = wh_transcript_escape(bytes, sizeof bytes, entry->bytes + from, size) == size;
    (void)snprintf(shown, SHOWN_FRAME + 200, "%lld %lld.%06lld %c %s \"%s%s%s", (long long)entry->slice,
                   (long long)entry->time_us / 1000000, (long long)entry->time_us % 1000000, entry->kind,
                   entry->port, from > 0 ? "..." : "", bytes, is_whole ? "\"" : "...");
}

/* Says what was heard, or not, in place of the entry in the file, or of nothing. */
static bool differ(wh_transcript_t *transcript, const wh_transcript_entry_t *heard,
                   const wh_transcript_entry_t *expected) {
    char shown[SHOWN_FRAME + 200];
    char wanted[SHOWN_FRAME + 200];
    char line[32] = "";
    const size_t from = find_shown(heard, expected);
    show(shown, heard, from);
    show(wanted, expected, from);
    if (expected) {
        (void)snprintf(line, sizeof line, ":%zu", expected->line);
    }
    (void)snprintf(transcript->message, sizeof transcript->message,
                   "%.300s%s: heard: %.320s (expected %.320s)", transcript->path, line, shown, wanted);
    return false;
}

bool wh_transcript_compare(wh_transcript_t *transcript, const wh_transcript_entry_t *entry) {
    if (!is_told(entry->kind)) {
        return true;
    }
    const wh_transcript_entry_t *expected = expected_next(transcript);
    if (!expected || entry->kind != expected->kind || entry->slice != expected->slice ||
        entry->time_us != expected->time_us || strcmp(entry->port, expected->port) != 0 ||
        entry->size != expected->size ||
        (entry->size > 0 && memcmp(entry->bytes, expected->bytes, entry->size) != 0)) {
        return differ(transcript, entry, expected);
    }
    transcript->heard = seek(transcript, transcript->heard + 1, true);
    return true;
}

bool wh_transcript_compare_end(wh_transcript_t *transcript) {
    const wh_transcript_entry_t *expected = expected_next(transcript);
    return !expected || differ(transcript, NULL, expected);
}
