#include "framing.h"

#include <stdio.h>
#include <string.h>

#include "framing_internal.h"

/* --------------------------------------------------------------------------------------- the description */

wh_framing_t wh_framing_default(void) {
    return (wh_framing_t){
        .ends = {{"\n", 1}, {"\r\n", 2}},
        .end_count = 2,
        .skips_empty = true,
        .longest = WH_FRAMING_LINE,
    };
}

bool wh_framing_begins_with(const wh_framing_mark_t *mark, const wh_framing_mark_t *with) {
    return with->size <= mark->size && memcmp(mark->bytes, with->bytes, with->size) == 0;
}

int wh_framing_byte_behind(const wh_framing_mark_t *longer, const wh_framing_mark_t *end) {
    return longer->size == end->size + 1 && wh_framing_begins_with(longer, end) ? longer->bytes[end->size]
                                                                                : -1;
}

unsigned wh_framing_digit(uint8_t byte) {
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *found = memchr(digits, byte, sizeof digits - 1);
    return found ? (unsigned)(found - digits) % 16U : 16U;
}

size_t wh_framing_digits(const wh_framing_t *framing) {
    if (framing->sum == WH_SUM_NONE) {
        return 0;
    }
    return framing->sum == WH_SUM_CRC16 ? 4 : 2;
}

/* A byte that may stand in one of several places alone. */
static bool shares_byte(const wh_framing_mark_t *a, const wh_framing_mark_t *b) {
    for (size_t i = 0; i < a->size; ++i) {
        if (memchr(b->bytes, a->bytes[i], b->size)) {
            return true;
        }
    }
    return false;
}

static bool has_digit(const wh_framing_mark_t *mark) {
    size_t i = 0;
    while (i < mark->size && wh_framing_digit(mark->bytes[i]) == 16) {
        ++i;
    }
    return i < mark->size;
}

static bool refuse_mark(char *problem, const char *name, size_t i, const char *expected) {
    (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES, "%s %zu: expected %s", name, i + 1, expected);
    return false;
}

static bool refuse_number(char *problem, const char *name, long long value, long long least, long long most) {
    (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES, "%s: %lld (expected %lld to %lld)", name, value, least,
                   most);
    return false;
}

/* Checks each mark by itself. */
static bool check_marks(const wh_framing_t *framing, const wh_framing_mark_t *marks, size_t count,
                        const char *name, char *problem) {
    for (size_t i = 0; i < count; ++i) {
        if (marks[i].size < 1 || marks[i].size > WH_FRAMING_MARK) {
            return refuse_mark(problem, name, i, "1 to 8 bytes");
        }
        if (framing->sum != WH_SUM_NONE && has_digit(&marks[i])) {
            return refuse_mark(problem, name, i, "no hex digit beside a sum");
        }
    }
    return true;
}

static bool check_starts(const wh_framing_t *framing, char *problem) {
    for (size_t i = 0; i < framing->start_count; ++i) {
        const wh_framing_mark_t *start = &framing->starts[i];
        for (size_t k = 0; k < framing->start_count; ++k) {
            if (k != i && wh_framing_begins_with(&framing->starts[k], start)) {
                return refuse_mark(problem, "start", k, "that it does not begin as another start");
            }
        }
    }
    return true;
}

/* Compares an end with the other ends: no end occurs twice, and an end that begins with another one is one
 * byte longer. */
static bool check_beginnings(const wh_framing_t *framing, size_t i, char *problem) {
    size_t longer = 0;
    for (size_t k = 0; k < framing->end_count; ++k) {
        if (k == i || !wh_framing_begins_with(&framing->ends[k], &framing->ends[i])) {
            continue;
        }
        if (wh_framing_byte_behind(&framing->ends[k], &framing->ends[i]) < 0 || ++longer > 1) {
            return refuse_mark(problem, "end", k, "one byte more than the end that begins as it does");
        }
    }
    return true;
}

static bool check_ends(const wh_framing_t *framing, char *problem) {
    for (size_t i = 0; i < framing->end_count; ++i) {
        const wh_framing_mark_t *end = &framing->ends[i];
        for (size_t k = 0; k < framing->start_count; ++k) {
            if (shares_byte(end, &framing->starts[k])) {
                return refuse_mark(problem, "end", i, "no byte of a start");
            }
        }
        if (!check_beginnings(framing, i, problem)) {
            return false;
        }
    }
    return true;
}

static bool shares_any(const wh_framing_mark_t *mark, const wh_framing_mark_t *marks, size_t count) {
    size_t i = 0;
    while (i < count && !shares_byte(mark, &marks[i])) {
        ++i;
    }
    return i < count;
}

static bool check_separator(const wh_framing_t *framing, char *problem) {
    const wh_framing_mark_t *separator = &framing->separator;
    if (separator->size > WH_FRAMING_MARK) {
        return refuse_number(problem, "bytes of the separator", (long long)separator->size, 0,
                             WH_FRAMING_MARK);
    }
    if (framing->sum == WH_SUM_NONE &&
        (separator->size > 0 || framing->sums_start || framing->sums_separator)) {
        (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES,
                       "sum: none (expected another one, for there is a separator, or what counts into it)");
        return false;
    }
    if (shares_any(separator, framing->starts, framing->start_count) ||
        shares_any(separator, framing->ends, framing->end_count)) {
        (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES, "separator: expected no byte of a start or an end");
        return false;
    }
    return true;
}

static bool are_single(const wh_framing_mark_t *marks, size_t count) {
    size_t i = 0;
    while (i < count && marks[i].size == 1) {
        ++i;
    }
    return i == count;
}

static bool check_escape(const wh_framing_t *framing, char *problem) {
    const wh_framing_mark_t escape = {{framing->escape}, 1};
    if (!framing->has_escape) {
        return true;
    }
    if (!are_single(framing->starts, framing->start_count) ||
        !are_single(framing->ends, framing->end_count)) {
        (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES, "escape: expected starts and ends of one byte");
        return false;
    }
    const bool is_mark = shares_any(&escape, framing->starts, framing->start_count) ||
                         shares_any(&escape, framing->ends, framing->end_count) ||
                         shares_byte(&escape, &framing->separator);
    if (is_mark || (framing->sum != WH_SUM_NONE && has_digit(&escape))) {
        (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES,
                       "escape: expected no start, end or separator, and no hex digit beside a sum");
        return false;
    }
    return true;
}

/* Bytes of a frame without its body, at the most. */
static size_t most_around(const wh_framing_t *framing) {
    size_t start = 0;
    size_t end = 0;
    for (size_t i = 0; i < framing->start_count; ++i) {
        start = framing->starts[i].size > start ? framing->starts[i].size : start;
    }
    for (size_t i = 0; i < framing->end_count; ++i) {
        end = framing->ends[i].size > end ? framing->ends[i].size : end;
    }
    return start + framing->separator.size + wh_framing_digits(framing) + end;
}

static bool check_numbers(const wh_framing_t *framing, char *problem) {
    const struct {
        const char *name;
        long long value, least, most;
    } numbers[] = {
        {"starts", (long long)framing->start_count, 0, WH_FRAMING_MARKS},
        {"ends", (long long)framing->end_count, 1, WH_FRAMING_MARKS},
        {"sum", (long long)framing->sum, 0, WH_SUM_CRC16},
        {"longest", (long long)framing->longest, WH_FRAMING_LEAST, WH_FRAMING_LINE},
        {"timeout", framing->timeout_us, 0, WH_FRAMING_TIMEOUT_US},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
        if (numbers[i].value < numbers[i].least || numbers[i].value > numbers[i].most) {
            return refuse_number(problem, numbers[i].name, numbers[i].value, numbers[i].least,
                                 numbers[i].most);
        }
    }
    return true;
}

bool wh_framing_validate(const wh_framing_t *framing, char problem[WH_FRAMING_PROBLEM_BYTES]) {
    if (!check_numbers(framing, problem) ||
        !check_marks(framing, framing->starts, framing->start_count, "start", problem) ||
        !check_marks(framing, framing->ends, framing->end_count, "end", problem) ||
        !check_starts(framing, problem) || !check_ends(framing, problem) ||
        !check_separator(framing, problem) || !check_escape(framing, problem)) {
        return false;
    }
    const size_t room = framing->longest - most_around(framing);
    return framing->shortest <= room ||
           refuse_number(problem, "shortest", (long long)framing->shortest, 0, (long long)room);
}

/* ----------------------------------------------------------------------------------------------- the sum */

static unsigned add_to_crc(unsigned crc, uint8_t byte) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
        crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xA001U : crc >> 1;
    }
    return crc;
}

static unsigned sum_bytes(wh_sum_kind_t kind, unsigned sum, const uint8_t *bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        if (kind == WH_SUM_CRC16) {
            sum = add_to_crc(sum, bytes[i]);
        } else {
            sum = kind == WH_SUM_XOR ? sum ^ bytes[i] : sum + bytes[i];
        }
    }
    return sum;
}

uint16_t wh_framing_sum(const wh_framing_t *framing, size_t start, const uint8_t *body, size_t size) {
    unsigned sum = framing->sum == WH_SUM_CRC16 ? 0xFFFFU : 0;
    if (framing->sums_start && start < framing->start_count) {
        sum = sum_bytes(framing->sum, sum, framing->starts[start].bytes, framing->starts[start].size);
    }
    sum = sum_bytes(framing->sum, sum, body, size);
    if (framing->sums_separator) {
        sum = sum_bytes(framing->sum, sum, framing->separator.bytes, framing->separator.size);
    }
    if (framing->sum == WH_SUM_CRC16) {
        return (uint16_t)sum;
    }
    return (uint16_t)((framing->sum == WH_SUM_COMPLEMENT ? 0U - sum : sum) & 0xFFU);
}

/* ----------------------------------------------------------------------------------------------- writing */

static size_t append_bytes(uint8_t *to, size_t at, const void *bytes, size_t size) {
    memcpy(to + at, bytes, size);
    return at + size;
}

static bool is_mark(const wh_framing_t *framing, uint8_t byte) {
    const wh_framing_mark_t one = {{byte}, 1};
    return byte == framing->escape || shares_any(&one, framing->starts, framing->start_count) ||
           shares_any(&one, framing->ends, framing->end_count);
}

/* Appends a body with its escapes, as far as a line has room. */
static size_t append_body(const wh_framing_t *framing, uint8_t *to, size_t at, const uint8_t *body,
                          size_t size) {
    for (size_t i = 0; i < size && at + 2 <= WH_FRAMING_LINE; ++i) {
        if (framing->has_escape && is_mark(framing, body[i])) {
            to[at++] = framing->escape;
        }
        to[at++] = body[i];
    }
    return at;
}

/* True if a framer reads this body back from the frame, and nothing else. */
static bool reads_back(const wh_framing_t *framing, const uint8_t *bytes, size_t size, const uint8_t *body,
                       size_t body_size) {
    wh_framer_t framer;
    wh_frame_t frame;
    if (!wh_framer_init(&framer, framing)) {
        return false;
    }
    const size_t taken = wh_framer_feed(&framer, bytes, size, 0, &frame);
    if (frame.kind != WH_FRAME_GOOD || frame.body_size != body_size ||
        memcmp(frame.body, body, body_size) != 0) {
        return false;
    }
    (void)wh_framer_feed(&framer, bytes + taken, size - taken, 0, &frame);
    return frame.kind == WH_FRAME_NONE && framer.size == 0;
}

size_t wh_framing_encode(const wh_framing_t *framing, size_t start, const uint8_t *body, size_t size,
                         uint8_t frame[WH_FRAMING_LINE]) {
    if (size > framing->longest || (framing->start_count > 0 && start >= framing->start_count)) {
        return 0;
    }
    uint8_t bytes[WH_FRAMING_LINE + 4 * WH_FRAMING_MARK];
    size_t length = 0;
    if (framing->start_count > 0) {
        length = append_bytes(bytes, length, framing->starts[start].bytes, framing->starts[start].size);
    }
    length = append_body(framing, bytes, length, body, size);
    if (framing->sum != WH_SUM_NONE) {
        char digits[8];
        const size_t count = wh_framing_digits(framing);
        (void)snprintf(digits, sizeof digits, "%0*X", (int)count, wh_framing_sum(framing, start, body, size));
        length = append_bytes(bytes, length, framing->separator.bytes, framing->separator.size);
        length = append_bytes(bytes, length, digits, count);
    }
    length = append_bytes(bytes, length, framing->ends[0].bytes, framing->ends[0].size);
    if (length > framing->longest || !reads_back(framing, bytes, length, body, size)) {
        return 0;
    }
    memcpy(frame, bytes, length);
    return length;
}
