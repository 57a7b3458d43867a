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

size_t wh_framing_sum_size(const wh_framing_t *framing) {
    if (framing->sum == WH_SUM_NONE) {
        return 0;
    }
    return (framing->sum == WH_SUM_CRC16 ? 4U : 2U) / (framing->sums_as_bytes ? 2U : 1U);
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
    return start + framing->length.size + framing->separator.size + wh_framing_sum_size(framing) + end;
}

static bool check_numbers(const wh_framing_t *framing, char *problem) {
    const struct {
        const char *name;
        long long value, least, most;
    } numbers[] = {
        {"starts", (long long)framing->start_count, 0, WH_FRAMING_MARKS},
        {"ends", (long long)framing->end_count, framing->length.size > 0 ? 0 : 1,
         framing->length.size > 0 ? 1 : WH_FRAMING_MARKS},
        {"length.size", (long long)framing->length.size, 0, WH_FRAMING_LENGTH},
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

/* With a length only a pause brings a reader back that has lost its place. */
static const char *find_wrong_length(const wh_framing_t *framing) {
    const wh_framing_length_t *length = &framing->length;
    if (length->size == 0) {
        return framing->sums_length ? "sums_length: expected a length" : NULL;
    }
    if (length->base != 10 && length->base != 16 && length->base != 256) {
        return "length: a base of its digits (expected 10, 16 or 256)";
    }
    if (framing->timeout_us == 0) {
        return "timeout: 0 (expected above 0 beside a length)";
    }
    return framing->has_escape ? "escape: expected none beside a length" : NULL;
}

static const char *find_wrong_place(const wh_framing_t *framing) {
    const bool is_apart =
        framing->length.size == 0 && framing->end_count == 1 && framing->separator.size == 0;
    return is_apart ? NULL : "sum: one behind the end (expected no length, one end, no separator)";
}

static const char *find_wrong_sum(const wh_framing_t *framing) {
    if (framing->sum == WH_SUM_NONE) {
        const bool is_told = framing->sums_as_bytes || framing->sums_length || framing->sum_is_behind;
        return is_told ? "sum: none (expected another one, for something says more of it)" : NULL;
    }
    if (framing->sum_is_behind) {
        return find_wrong_place(framing);
    }
    if (framing->sums_end) {
        return "sums_end: expected a sum behind the end";
    }
    const bool is_lost = framing->sums_as_bytes && framing->length.size == 0;
    return is_lost ? "sum: one of bytes (expected it beside a length, or behind the end)" : NULL;
}

static bool check_length(const wh_framing_t *framing, char *problem) {
    const char *wrong = find_wrong_length(framing);
    wrong = wrong ? wrong : find_wrong_sum(framing);
    (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES, "%s", wrong ? wrong : "");
    return !wrong;
}

bool wh_framing_validate(const wh_framing_t *framing, char problem[WH_FRAMING_PROBLEM_BYTES]) {
    if (!check_numbers(framing, problem) ||
        !check_marks(framing, framing->starts, framing->start_count, "start", problem) ||
        !check_marks(framing, framing->ends, framing->end_count, "end", problem) ||
        !check_starts(framing, problem) || !check_ends(framing, problem) ||
        !check_separator(framing, problem) || !check_escape(framing, problem) ||
        !check_length(framing, problem)) {
        return false;
    }
    const size_t room = framing->longest - most_around(framing);
    return framing->shortest <= room ||
           refuse_number(problem, "shortest", (long long)framing->shortest, 0, (long long)room);
}

/* -------------------------------------------------------------------------------------------- the length */

/* Bytes of a frame behind its body. */
static size_t bytes_behind(const wh_framing_t *framing) {
    return framing->separator.size + wh_framing_sum_size(framing) +
           (framing->end_count > 0 ? framing->ends[0].size : 0);
}

/* The bytes of a frame that its length does not count. */
static size_t uncounted(const wh_framing_t *framing, size_t start_size) {
    const size_t end = framing->end_count > 0 ? framing->ends[0].size : 0;
    const size_t head = start_size + framing->length.size;
    if (framing->length.counts == WH_LENGTH_FRAME) {
        return 0;
    }
    return head + (framing->length.counts == WH_LENGTH_REST ? end : bytes_behind(framing));
}

/* The digit of a byte; the base itself: it is none. */
static unsigned digit_of(const wh_framing_length_t *length, uint8_t byte) {
    if (length->base == 256) {
        return byte;
    }
    const unsigned digit = wh_framing_digit(byte);
    return digit < length->base ? digit : length->base;
}

size_t wh_framing_whole(const wh_framing_t *framing, size_t start_size, const uint8_t *bytes) {
    const wh_framing_length_t *length = &framing->length;
    size_t value = 0;
    for (size_t i = 0; i < length->size; ++i) {
        const unsigned digit = digit_of(length, bytes[length->low_first ? length->size - 1 - i : i]);
        if (digit == length->base) {
            return 0;
        }
        value = value * length->base + digit;
    }
    value += uncounted(framing, start_size);
    return value < start_size + length->size + bytes_behind(framing) ? 0 : value;
}

/* Writes the length of a frame around a body of `size` bytes. False if it has too few digits for that. */
static bool write_length(const wh_framing_t *framing, size_t start, size_t size, uint8_t *bytes) {
    static const char digits[] = "0123456789ABCDEF";
    const wh_framing_length_t *length = &framing->length;
    const size_t start_size = start < framing->start_count ? framing->starts[start].size : 0;
    size_t value = start_size + length->size + size + bytes_behind(framing) - uncounted(framing, start_size);
    for (size_t i = 0; i < length->size; ++i, value /= length->base) {
        const size_t digit = value % length->base;
        bytes[length->low_first ? i : length->size - 1 - i] =
            length->base == 256 ? (uint8_t)digit : (uint8_t)digits[digit];
    }
    return length->size == 0 || value == 0;
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

uint16_t wh_framing_sum_over(const wh_framing_t *framing, size_t start, const uint8_t *length,
                             const uint8_t *body, size_t size) {
    unsigned sum = framing->sum == WH_SUM_CRC16 ? 0xFFFFU : 0;
    if (framing->sums_start && start < framing->start_count) {
        sum = sum_bytes(framing->sum, sum, framing->starts[start].bytes, framing->starts[start].size);
    }
    if (framing->sums_length) {
        sum = sum_bytes(framing->sum, sum, length, framing->length.size);
    }
    sum = sum_bytes(framing->sum, sum, body, size);
    if (framing->sums_separator) {
        sum = sum_bytes(framing->sum, sum, framing->separator.bytes, framing->separator.size);
    }
    if (framing->sums_end) {
        sum = sum_bytes(framing->sum, sum, framing->ends[0].bytes, framing->ends[0].size);
    }
    if (framing->sum == WH_SUM_CRC16) {
        return (uint16_t)sum;
    }
    return (uint16_t)((framing->sum == WH_SUM_COMPLEMENT ? 0U - sum : sum) & 0xFFU);
}

uint16_t wh_framing_sum(const wh_framing_t *framing, size_t start, const uint8_t *body, size_t size) {
    uint8_t length[WH_FRAMING_LENGTH] = {0};
    (void)write_length(framing, start, size, length);
    return wh_framing_sum_over(framing, start, length, body, size);
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

/* Appends the sum, with the separator before it. */
static size_t append_sum(const wh_framing_t *framing, uint8_t *to, size_t at, uint16_t sum) {
    const size_t size = wh_framing_sum_size(framing);
    const uint8_t bytes[2] = {(uint8_t)(sum >> 8), (uint8_t)sum};
    char digits[8];
    (void)snprintf(digits, sizeof digits, "%0*X", (int)size, sum);
    at = append_bytes(to, at, framing->separator.bytes, framing->separator.size);
    return framing->sums_as_bytes ? append_bytes(to, at, bytes + 2 - size, size)
                                  : append_bytes(to, at, digits, size);
}

/* Writes a frame around a body. Returns its size; it has room for more than the longest one. */
static size_t write_frame(const wh_framing_t *framing, size_t start, const uint8_t *told, const uint8_t *body,
                          size_t size, uint8_t *bytes) {
    size_t length = 0;
    if (framing->start_count > 0) {
        length = append_bytes(bytes, length, framing->starts[start].bytes, framing->starts[start].size);
    }
    length = append_bytes(bytes, length, told, framing->length.size);
    length = append_body(framing, bytes, length, body, size);
    const uint16_t sum = wh_framing_sum_over(framing, start, told, body, size);
    if (framing->sum != WH_SUM_NONE && !framing->sum_is_behind) {
        length = append_sum(framing, bytes, length, sum);
    }
    if (framing->end_count > 0) {
        length = append_bytes(bytes, length, framing->ends[0].bytes, framing->ends[0].size);
    }
    return framing->sum_is_behind ? append_sum(framing, bytes, length, sum) : length;
}

size_t wh_framing_encode(const wh_framing_t *framing, size_t start, const uint8_t *body, size_t size,
                         uint8_t frame[WH_FRAMING_LINE]) {
    uint8_t told[WH_FRAMING_LENGTH];
    if (size > framing->longest || (framing->start_count > 0 && start >= framing->start_count) ||
        !write_length(framing, start, size, told)) {
        return 0;
    }
    uint8_t bytes[WH_FRAMING_LINE + 4 * WH_FRAMING_MARK];
    const size_t length = write_frame(framing, start, told, body, size, bytes);
    if (length > framing->longest || !reads_back(framing, bytes, length, body, size)) {
        return 0;
    }
    memcpy(frame, bytes, length);
    return length;
}
