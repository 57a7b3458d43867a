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

/* An entry as it stands in the file, as far as it is shown. */
static void show(char shown[SHOWN_FRAME + 200], const wh_transcript_entry_t *entry) {
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
    const bool is_whole = wh_transcript_escape(bytes, sizeof bytes, entry->bytes, entry->size) == entry->size;
    (void)snprintf(shown, SHOWN_FRAME + 200, "%lld %lld.%06lld %c %s \"%s%s", (long long)entry->slice,
                   (long long)entry->time_us / 1000000, (long long)entry->time_us % 1000000, entry->kind,
                   entry->port, bytes, is_whole ? "\"" : "...");
}

/* Says what was heard, or not, in place of the entry in the file, or of nothing. */
static bool differ(wh_transcript_t *transcript, const wh_transcript_entry_t *heard,
                   const wh_transcript_entry_t *expected) {
    char shown[SHOWN_FRAME + 200];
    char wanted[SHOWN_FRAME + 200];
    char line[32] = "";
    show(shown, heard);
    show(wanted, expected);
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
