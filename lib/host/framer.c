#include <string.h>

#include "framing.h"
#include "framing_internal.h"

/* ---------------------------------------------------------------------------------------- what a line is */

const char *wh_frame_kind_name(wh_frame_kind_t kind) {
    static const char *const names[WH_FRAME_KINDS] = {"none",  "good",    "too long", "no end",    "timeout",
                                                      "short", "bad sum", "garbage",  "bad length"};
    return (unsigned)kind < WH_FRAME_KINDS ? names[kind] : "unknown";
}

/* The longest of the marks that the line ends with, behind its first `from` bytes; `count`: none. */
static size_t mark_at_end(const wh_framer_t *framer, const wh_framing_mark_t *marks, size_t count,
                          size_t from) {
    size_t found = count;
    for (size_t i = 0; i < count; ++i) {
        const size_t size = marks[i].size;
        if (size + from <= framer->size && (found == count || size > marks[found].size) &&
            memcmp(framer->line + framer->size - size, marks[i].bytes, size) == 0) {
            found = i;
        }
    }
    return found;
}

static bool is_garbage(const wh_framer_t *framer) {
    return framer->framing.start_count > 0 && framer->start == framer->framing.start_count;
}

static size_t start_size(const wh_framer_t *framer) {
    return framer->start < framer->framing.start_count ? framer->framing.starts[framer->start].size : 0;
}

/* Fills in the frame. The next call removes the line, except its last `keeps` bytes, which are start
 * `next`. */
static void tell_frame(wh_framer_t *framer, wh_frame_kind_t kind, size_t size, size_t keeps, size_t next,
                       wh_frame_t *frame) {
    *frame = (wh_frame_t){
        .kind = kind,
        .first_us = framer->first_us,
        .last_us = framer->last_us,
        .bytes = framer->line,
        .size = size,
        .body = framer->line,
        .body_size = size,
        .start = is_garbage(framer) ? 0 : framer->start,
    };
    framer->counters.frames[kind] += 1;
    framer->told = true;
    framer->keeps = keeps;
    framer->next = next;
}

/* Removes the part of the line that was already told. */
static void settle_line(wh_framer_t *framer) {
    if (framer->told) {
        memmove(framer->line, framer->line + framer->size - framer->keeps, framer->keeps);
        framer->size = framer->keeps;
        framer->start = framer->next;
        framer->first_us = framer->last_us;
        framer->told = false;
    }
}

/* Judges the bytes behind a body, which should be its sum; `plain` is the body without its escapes. */
static wh_frame_kind_t judge_sum(const wh_framer_t *framer, const uint8_t *sum, const uint8_t *plain,
                                 size_t size) {
    const wh_framing_t *framing = &framer->framing;
    const unsigned base = framing->sums_as_bytes ? 256 : 16;
    bool is_good = memcmp(sum, framing->separator.bytes, framing->separator.size) == 0;
    unsigned told = 0;
    for (size_t i = 0; i < wh_framing_sum_size(framing); ++i) {
        const uint8_t byte = sum[framing->separator.size + i];
        const unsigned digit = framing->sums_as_bytes ? byte : wh_framing_digit(byte);
        is_good = is_good && digit < base;
        told = base * told + digit;
    }
    const uint16_t sum_of_all =
        wh_framing_sum_over(framing, framer->start, framer->line + start_size(framer), plain, size);
    return is_good && told == sum_of_all ? WH_FRAME_GOOD : WH_FRAME_BAD_SUM;
}

/* Finds a body without its escapes. Returns its size. */
static size_t find_plain(wh_framer_t *framer, const uint8_t *body, size_t size, const uint8_t **plain) {
    size_t count = 0;
    *plain = body;
    if (!framer->framing.has_escape) {
        return size;
    }
    for (size_t i = 0; i < size; ++i) {
        i += body[i] == framer->framing.escape && i + 1 < size ? 1 : 0;
        framer->plain[count++] = body[i];
    }
    *plain = framer->plain;
    return count;
}

/* The line has come to that end, if there are ends, or to the sum behind it. */
static void judge_line(wh_framer_t *framer, size_t end, wh_frame_t *frame) {
    const wh_framing_t *framing = &framer->framing;
    const size_t end_size = framing->end_count > 0 ? framing->ends[end].size : 0;
    const size_t from = start_size(framer) + framing->length.size;
    const size_t digits = wh_framing_sum_size(framing);
    const size_t around = digits > 0 ? framing->separator.size + digits : 0;
    const size_t content = framer->size - from - end_size;
    const size_t room = content < around ? 0 : content - around;
    const size_t sum = from + room + (framing->sum_is_behind ? end_size : 0);
    const uint8_t *plain = NULL;
    const size_t size = find_plain(framer, framer->line + from, room, &plain);
    wh_frame_kind_t kind = WH_FRAME_GOOD;
    if (is_garbage(framer)) {
        kind = WH_FRAME_GARBAGE;
    } else if (content < around || size < framing->shortest) {
        kind = WH_FRAME_SHORT;
    } else if (around > 0) {
        kind = judge_sum(framer, framer->line + sum, plain, size);
    }
    tell_frame(framer, kind, framer->size, 0, framing->start_count, frame);
    if (kind == WH_FRAME_GOOD) {
        frame->body = plain;
        frame->body_size = size;
        frame->end = end;
    }
}

/* -------------------------------------------------------------------------------------------- the framer */

static void note_last_bytes(wh_framer_t *framer, const wh_framing_mark_t *marks, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        framer->may_mark[marks[i].bytes[marks[i].size - 1]] = true;
    }
}

bool wh_framer_init(wh_framer_t *framer, const wh_framing_t *framing) {
    char problem[WH_FRAMING_PROBLEM_BYTES];
    if (!wh_framing_validate(framing, problem)) {
        return false;
    }
    memset(framer, 0, sizeof *framer);
    framer->framing = *framing;
    framer->start = framing->start_count;
    framer->passes = -1;
    note_last_bytes(framer, framing->starts, framing->start_count);
    note_last_bytes(framer, framing->ends, framing->end_count);
    return true;
}

/* Ends what was passed over behind a line that was too long. The last `keeps` bytes begin a line. */
static void end_drop(wh_framer_t *framer, size_t keeps, size_t start) {
    framer->counters.passed += framer->dropped > keeps ? framer->dropped - keeps : 0;
    framer->dropped = 0;
    memmove(framer->line, framer->line + framer->size - keeps, keeps);
    framer->size = keeps;
    framer->start = start;
    framer->first_us = framer->last_us;
}

/* A start has come: the line before it, if there is one, is without its end. */
static void begin_line(wh_framer_t *framer, size_t start, wh_frame_t *frame) {
    const size_t mark = framer->framing.starts[start].size;
    if (framer->dropped > 0) {
        end_drop(framer, mark, start);
    } else if (framer->size == mark) {
        framer->start = start;
    } else {
        tell_frame(framer, is_garbage(framer) ? WH_FRAME_GARBAGE : WH_FRAME_NO_END, framer->size - mark, mark,
                   start, frame);
    }
}

/* The frame cannot be so long, or so short: this is told at once. */
static void refuse_length(wh_framer_t *framer, wh_frame_kind_t kind, wh_frame_t *frame) {
    tell_frame(framer, kind, framer->size - 1, 0, framer->framing.start_count, frame);
    frame->is_over = true;
    framer->dropped = 1;
}

/* An end has come. */
static void take_end(wh_framer_t *framer, size_t end, wh_frame_t *frame) {
    const wh_framing_t *framing = &framer->framing;
    const size_t size = framing->ends[end].size;
    if (framer->dropped > 0) {
        end_drop(framer, 0, framing->start_count);
    } else if (framing->skips_empty && framer->size == size) {
        framer->counters.passed += size;
        framer->size = 0;
    } else if (framing->sum_is_behind && !is_garbage(framer)) {
        framer->whole = framer->size + wh_framing_sum_size(framing);
        if (framer->whole > framing->longest) {
            framer->whole = 0;
            refuse_length(framer, WH_FRAME_TOO_LONG, frame);
        }
    } else {
        judge_line(framer, end, frame);
    }
}

/* The line is one byte too long: this is told at once. The last bytes stay, because a mark may lie across the
 * limit. */
static void tell_overflow(wh_framer_t *framer, size_t end, wh_frame_t *frame) {
    const size_t keeps = WH_FRAMING_MARK - 1;
    tell_frame(framer, is_garbage(framer) ? WH_FRAME_GARBAGE : WH_FRAME_TOO_LONG, framer->framing.longest,
               keeps, framer->framing.start_count, frame);
    frame->is_over = true;
    framer->dropped = 1;
    if (end < framer->framing.end_count) {
        framer->keeps = 0;
        framer->dropped = 0;
        framer->counters.passed += 1;
    }
}

/* All bytes of a frame are there that its length counts. */
static void judge_counted(wh_framer_t *framer, wh_frame_t *frame) {
    const wh_framing_t *framing = &framer->framing;
    const size_t size = framing->end_count > 0 ? framing->ends[0].size : 0;
    if (size > 0 && memcmp(framer->line + framer->size - size, framing->ends[0].bytes, size) != 0) {
        tell_frame(framer, WH_FRAME_NO_END, framer->size, 0, framing->start_count, frame);
    } else {
        judge_line(framer, 0, frame);
    }
}

/* A byte was added behind the end of a line. */
static void await_sum(wh_framer_t *framer, wh_frame_t *frame) {
    if (framer->size == framer->whole) {
        framer->whole = 0;
        judge_line(framer, 0, frame);
    }
}

/* A byte was added to what is no frame: a start may begin one. */
static void seek_start(wh_framer_t *framer, wh_frame_t *frame) {
    const wh_framing_t *framing = &framer->framing;
    const size_t start = mark_at_end(framer, framing->starts, framing->start_count, 0);
    if (start < framing->start_count) {
        begin_line(framer, start, frame);
    } else if (framer->size > framing->longest) {
        tell_overflow(framer, framing->end_count, frame);
    }
}

/* The start and the length are there. False: it is none that can be, which is told. */
static bool read_length(wh_framer_t *framer, wh_frame_t *frame) {
    const size_t start = start_size(framer);
    framer->whole = wh_framing_whole(&framer->framing, start, framer->line + start);
    const bool is_good = framer->whole > 0 && framer->whole <= framer->framing.longest;
    if (!is_good) {
        refuse_length(framer, framer->whole == 0 ? WH_FRAME_BAD_LENGTH : WH_FRAME_TOO_LONG, frame);
    }
    return is_good;
}

/* A byte was added to a line whose frames tell their length. */
static void count_byte(wh_framer_t *framer, wh_frame_t *frame) {
    const size_t head = start_size(framer) + framer->framing.length.size;
    if (framer->dropped > 0 || is_garbage(framer)) {
        seek_start(framer, frame);
    } else if (framer->size >= head && (framer->size > head || read_length(framer, frame)) &&
               framer->size == framer->whole) {
        judge_counted(framer, frame);
    }
}

/* True if a byte may be a mark's last one: it is, and no escape stands before it. */
static bool may_be_mark(wh_framer_t *framer, uint8_t byte) {
    const bool is_plain = framer->is_escaped;
    framer->is_escaped = framer->framing.has_escape && !is_plain && byte == framer->framing.escape;
    return !is_plain && framer->may_mark[byte];
}

/* A byte was added to a line whose frames end by marks. */
static void seek_marks(wh_framer_t *framer, uint8_t byte, wh_frame_t *frame) {
    const wh_framing_t *framing = &framer->framing;
    size_t start = framing->start_count;
    size_t end = framing->end_count;
    if (may_be_mark(framer, byte)) {
        start = mark_at_end(framer, framing->starts, framing->start_count, start_size(framer));
        end = mark_at_end(framer, framing->ends, framing->end_count, start_size(framer));
    }
    for (size_t i = 0; end < framing->end_count && i < framing->end_count && framer->passes < 0; ++i) {
        framer->passes = wh_framing_byte_behind(&framing->ends[i], &framing->ends[end]);
    }
    if (start < framing->start_count) {
        begin_line(framer, start, frame);
    } else if (framer->size > framing->longest) {
        tell_overflow(framer, end, frame);
    } else if (end < framing->end_count) {
        take_end(framer, end, frame);
    }
}

/* Adds a byte to the line. */
static void take_byte(wh_framer_t *framer, uint8_t byte, wh_frame_t *frame) {
    if (framer->dropped > 0) {
        framer->dropped += 1;
        if (framer->size == WH_FRAMING_MARK) {
            memmove(framer->line, framer->line + 1, --framer->size);
        }
    }
    framer->line[framer->size++] = byte;
    if (framer->framing.length.size > 0) {
        count_byte(framer, frame);
    } else if (framer->whole > 0) {
        await_sum(framer, frame);
    } else {
        seek_marks(framer, byte, frame);
    }
}

/* True if the last byte was so long ago that the line is given up. */
static bool is_late(const wh_framer_t *framer, int64_t time_us) {
    return framer->framing.timeout_us > 0 && framer->size > 0 &&
           time_us - framer->last_us >= framer->framing.timeout_us;
}

/* Gives up the line that was begun, if there is one. */
static void give_up_line(wh_framer_t *framer, wh_frame_kind_t kind, wh_frame_t *frame) {
    framer->is_escaped = false;
    framer->whole = 0;
    if (framer->dropped > 0) {
        end_drop(framer, 0, framer->framing.start_count);
    } else if (framer->size > 0) {
        tell_frame(framer, is_garbage(framer) ? WH_FRAME_GARBAGE : kind, framer->size, 0,
                   framer->framing.start_count, frame);
    }
}

size_t wh_framer_feed(wh_framer_t *framer, const uint8_t *bytes, size_t size, int64_t time_us,
                      wh_frame_t *frame) {
    *frame = (wh_frame_t){.kind = WH_FRAME_NONE};
    settle_line(framer);
    size_t taken = 0;
    if (size > 0 && is_late(framer, time_us)) {
        give_up_line(framer, WH_FRAME_TIMEOUT, frame);
    }
    for (; taken < size && frame->kind == WH_FRAME_NONE; ++taken) {
        framer->counters.bytes += 1;
        framer->last_us = time_us;
        const bool passes = framer->passes == bytes[taken];
        framer->passes = -1;
        if (passes) {
            framer->counters.passed += 1;
            continue;
        }
        framer->first_us = framer->size == 0 ? time_us : framer->first_us;
        take_byte(framer, bytes[taken], frame);
    }
    return taken;
}

bool wh_framer_wait(wh_framer_t *framer, int64_t time_us, wh_frame_t *frame) {
    *frame = (wh_frame_t){.kind = WH_FRAME_NONE};
    settle_line(framer);
    if (is_late(framer, time_us)) {
        give_up_line(framer, WH_FRAME_TIMEOUT, frame);
    }
    return frame->kind != WH_FRAME_NONE;
}

int64_t wh_framer_due(const wh_framer_t *framer) {
    const size_t size = framer->told ? framer->keeps : framer->size;
    const bool is_open = framer->framing.timeout_us > 0 && size > 0 && framer->dropped == 0;
    return is_open ? framer->last_us + framer->framing.timeout_us : INT64_MAX;
}

bool wh_framer_finish(wh_framer_t *framer, wh_frame_t *frame) {
    *frame = (wh_frame_t){.kind = WH_FRAME_NONE};
    settle_line(framer);
    give_up_line(framer, WH_FRAME_NO_END, frame);
    framer->passes = -1;
    return frame->kind != WH_FRAME_NONE;
}
