/* Plays a transcript again: inputs of a run are handed out at their slices, outputs are compared. */
#include <string.h>

#include "transcript_internal.h"

/* The most bytes of a frame that a message shows. */
#define SHOWN_FRAME 300

/* True for an output of a run, which is compared; the other kinds are inputs. */
static bool is_output(wh_transcript_kind_t kind) {
    return kind == WH_TRANSCRIPT_HEARD || kind == WH_TRANSCRIPT_CLOCK || kind == WH_TRANSCRIPT_ENDED;
}

/* The number of the next output, or input, of a run from `at` on; the count: none is left. */
static size_t seek_side(const wh_transcript_t *transcript, size_t at, bool told) {
    while (at < transcript->count && is_output(transcript->entries[at].kind) != told) {
        ++at;
    }
    return at;
}

void wh_transcript_rewind(wh_transcript_t *transcript) {
    transcript->said = seek_side(transcript, 0, false);
    transcript->heard = seek_side(transcript, 0, true);
}

const wh_transcript_entry_t *wh_transcript_next(wh_transcript_t *transcript, int64_t slice) {
    if (wh_transcript_due(transcript) > slice || transcript->said == transcript->count) {
        return NULL;
    }
    const wh_transcript_entry_t *next = &transcript->entries[transcript->said];
    transcript->said = seek_side(transcript, transcript->said + 1, false);
    return next;
}

const wh_transcript_entry_t *wh_transcript_next_at(wh_transcript_t *transcript, int64_t slice,
                                                   const char *port) {
    const bool is_next = !transcript->is_different && transcript->heard >= transcript->said &&
                         transcript->said < transcript->count &&
                         strcmp(transcript->entries[transcript->said].port, port) == 0;
    return is_next ? wh_transcript_next(transcript, slice) : NULL;
}

int64_t wh_transcript_due(const wh_transcript_t *transcript) {
    return transcript->said < transcript->count ? transcript->entries[transcript->said].slice : INT64_MAX;
}

/* The next entry that must be heard, or null. */
static const wh_transcript_entry_t *expected_next(const wh_transcript_t *transcript) {
    return transcript->heard < transcript->count ? &transcript->entries[transcript->heard] : NULL;
}

int64_t wh_transcript_last(const wh_transcript_t *transcript) {
    return transcript->count > 0 ? transcript->entries[transcript->count - 1].slice : 0;
}

/* How many bytes are shown before the first one that differs. */
#define SHOWN_BEFORE ((size_t)40)

/* The first byte shown of two frames: a difference far behind would be cut off. */
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
static void show_entry(char shown[SHOWN_FRAME + 200], const wh_transcript_entry_t *entry, size_t from) {
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

/* True if all that the file has was played and found the same, and no operator has ended it: who wrote it was
 * killed, or the file is not whole. */
static bool is_cut(const wh_transcript_t *transcript) {
    const size_t count = transcript->count;
    return count > 0 && transcript->heard == count && transcript->said == count &&
           transcript->entries[count - 1].kind != WH_TRANSCRIPT_STOPPED;
}

/* Says what was heard, or not, in place of the entry in the file, or of nothing. */
static bool tell_difference(wh_transcript_t *transcript, const wh_transcript_entry_t *heard,
                            const wh_transcript_entry_t *expected) {
    char shown[SHOWN_FRAME + 200];
    char wanted[SHOWN_FRAME + 200];
    char line[32] = "";
    const size_t from = find_shown(heard, expected);
    show_entry(shown, heard, from);
    show_entry(wanted, expected, from);
    if (!expected && is_cut(transcript)) {
        (void)snprintf(
            wanted, sizeof wanted,
            "nothing: the transcript is cut, no operator has ended it; all that it has is the same");
    }
    if (expected) {
        (void)snprintf(line, sizeof line, ":%zu", expected->line);
    }
    (void)snprintf(transcript->message, sizeof transcript->message,
                   "%.300s%s: heard: %.320s (expected %.320s)", transcript->path, line, shown, wanted);
    return false;
}

bool wh_transcript_compare(wh_transcript_t *transcript, const wh_transcript_entry_t *entry) {
    if (!is_output(entry->kind)) {
        return true;
    }
    const wh_transcript_entry_t *expected = expected_next(transcript);
    if (!expected || entry->kind != expected->kind || entry->slice != expected->slice ||
        entry->time_us != expected->time_us || strcmp(entry->port, expected->port) != 0 ||
        entry->size != expected->size ||
        (entry->size > 0 && memcmp(entry->bytes, expected->bytes, entry->size) != 0)) {
        transcript->is_different = true;
        return tell_difference(transcript, entry, expected);
    }
    transcript->heard = seek_side(transcript, transcript->heard + 1, true);
    return true;
}

bool wh_transcript_compare_end(wh_transcript_t *transcript) {
    const wh_transcript_entry_t *expected = expected_next(transcript);
    return !expected || tell_difference(transcript, NULL, expected);
}

bool wh_transcript_is_over(wh_transcript_t *transcript, int64_t slice) {
    if (transcript->is_different || !wh_transcript_compare_end(transcript)) {
        return false;
    }
    if (transcript->said < transcript->count) {
        const wh_transcript_entry_t *next = &transcript->entries[transcript->said];
        (void)snprintf(transcript->message, sizeof transcript->message,
                       "%.300s:%zu: slice %lld is not reached: the run ends at slice %lld", transcript->path,
                       next->line, (long long)next->slice, (long long)slice);
    }
    return transcript->said >= transcript->count;
}
