/* A framer compared with a plain reading of the whole line, byte by byte with all of it at hand.
 * The frames are the same however the bytes are cut into pieces, with waits between them. Encoded
 * bodies come back. */
#include "support/support.h"

#include "host/framing.h"

#define ROUNDS 20000
#define BYTES 400

/* A line: bytes, each with its time. */
static uint8_t line[BYTES];
static int64_t times[BYTES];
static size_t count;

/* The framer's output as a text: easy to compare and to print. */
typedef struct {
    char text[40 * BYTES];
    size_t size;
} told_t;

static void tell(told_t *told, wh_frame_kind_t kind, const uint8_t *bytes, size_t size, const uint8_t *body,
                 size_t body_size) {
    told->size += (size_t)snprintf(told->text + told->size, sizeof told->text - told->size, "%s",
                                   wh_frame_kind_name(kind));
    for (size_t i = 0; i < size; ++i) {
        told->size +=
            (size_t)snprintf(told->text + told->size, sizeof told->text - told->size, " %02x", bytes[i]);
    }
    told->size += (size_t)snprintf(told->text + told->size, sizeof told->text - told->size, " body");
    for (size_t i = 0; i < body_size; ++i) {
        told->size +=
            (size_t)snprintf(told->text + told->size, sizeof told->text - told->size, " %02x", body[i]);
    }
    told->size += (size_t)snprintf(told->text + told->size, sizeof told->text - told->size, "\n");
}

/* ------------------------------------------------------------------------------------------- descriptions */

/* The plain reading knows marks of one byte each, or an end of two bytes that begins like another mark. */
static wh_framing_t draw_framing(void) {
    wh_framing_t framing = {.longest = WH_FRAMING_LEAST + wh_test_below(20), .end_count = 1};
    framing.ends[0] = (wh_framing_mark_t){"\r", 1};
    if (wh_test_below(2) == 0) {
        framing.ends[framing.end_count++] = (wh_framing_mark_t){"\r\n", 2};
    }
    framing.start_count = wh_test_below(3);
    framing.starts[0] = (wh_framing_mark_t){"$", 1};
    framing.starts[1] = (wh_framing_mark_t){"!", 1};
    framing.sum = (wh_sum_kind_t)wh_test_below(5);
    if (framing.sum != WH_SUM_NONE) {
        framing.sums_start = wh_test_below(2) == 0;
        framing.sums_separator = wh_test_below(2) == 0;
        framing.separator = (wh_framing_mark_t){",", wh_test_below(2)};
    }
    framing.skips_empty = wh_test_below(2) == 0;
    framing.shortest = wh_test_below(4);
    framing.timeout_us = wh_test_below(2) == 0 ? 0 : 1000;
    return framing;
}

static void append(const uint8_t *bytes, size_t size) {
    for (size_t i = 0; i < size && count < BYTES; ++i) {
        line[count++] = bytes[i];
    }
}

/* A good frame, a damaged one, or bytes alone. */
static void draw_frame(const wh_framing_t *framing) {
    static const uint8_t letters[] = "$!\r\n,a0F\xff";
    uint8_t body[60];
    uint8_t frame[WH_FRAMING_LINE];
    const size_t size = wh_test_below(wh_test_below(8) == 0 ? 60 : 8);
    const bool is_good = wh_test_below(2) == 0;
    for (size_t i = 0; i < size; ++i) {
        body[i] = is_good ? 'a' : letters[wh_test_below(sizeof letters - 1)];
    }
    const size_t whole = wh_framing_encode(framing, 0, body, size, frame);
    if (whole > 0 && wh_test_below(4) == 0) {
        frame[wh_test_below((uint32_t)whole)] = letters[wh_test_below(sizeof letters - 1)];
    }
    append(whole > 0 ? frame : body, whole > 0 ? whole : size);
}

static void draw_line(const wh_framing_t *framing) {
    int64_t now = 0;
    for (count = 0; count < BYTES - 60;) {
        draw_frame(framing);
    }
    for (size_t i = 0; i < count; ++i) {
        now += wh_test_below(10) == 0 ? wh_test_below(1200) : 0;
        times[i] = now;
    }
}

/* ------------------------------------------------------------------------------------------- a plain reading */

static bool is_start(const wh_framing_t *framing, uint8_t byte) {
    return (framing->start_count > 0 && byte == '$') || (framing->start_count > 1 && byte == '!');
}

/* True if the bytes behind a body of `size` bytes are its sum. */
static bool is_sum(const wh_framing_t *framing, const uint8_t *body, size_t size, bool is_second) {
    const char *sum = (const char *)body + size;
    const bool is_separated = framing->separator.size == 0 || sum[0] == ',';
    const size_t wanted = framing->sum == WH_SUM_CRC16 ? 4 : 2;
    char digits[5];
    (void)snprintf(digits, sizeof digits, "%.*s", (int)wanted, sum + framing->separator.size);
    return is_separated && strspn(digits, "0123456789abcdefABCDEF") == wanted &&
           strtoul(digits, NULL, 16) == wh_framing_sum(framing, is_second ? 1 : 0, body, size);
}

/* The bytes behind a body: its sum. */
static size_t around_body(const wh_framing_t *framing) {
    const size_t digits = framing->sum == WH_SUM_CRC16 ? 4 : 2;
    return framing->sum == WH_SUM_NONE ? 0 : digits + framing->separator.size;
}

/* The bytes from `from` to before `to`; the last of them is the end. */
static void tell_ended(const wh_framing_t *framing, size_t from, size_t to, told_t *told) {
    const size_t start = framing->start_count > 0 ? 1 : 0;
    const size_t around = around_body(framing);
    const uint8_t *bytes = line + from;
    const size_t size = to - from;
    const size_t body = size - start - 1 - around;
    wh_frame_kind_t kind = WH_FRAME_GOOD;
    if (start > 0 && !is_start(framing, bytes[0])) {
        kind = WH_FRAME_GARBAGE;
    } else if (size - start - 1 < around + framing->shortest) {
        kind = WH_FRAME_SHORT;
    } else if (around > 0 && !is_sum(framing, bytes + start, body, bytes[0] == '!')) {
        kind = WH_FRAME_BAD_SUM;
    }
    const bool is_good = kind == WH_FRAME_GOOD;
    tell(told, kind, bytes, size, is_good ? bytes + start : bytes, is_good ? body : size);
}

/* Where the line from `from` on is over, and why: an end, a pause, or a start or nothing. */
static size_t find_end(const wh_framing_t *framing, size_t from, wh_frame_kind_t *kind) {
    size_t i = from;
    *kind = WH_FRAME_NO_END;
    do {
        if (line[i++] == '\r') {
            *kind = WH_FRAME_GOOD;
            return i;
        }
        if (i < count && framing->timeout_us > 0 && times[i] - times[i - 1] >= framing->timeout_us) {
            *kind = WH_FRAME_TIMEOUT;
            return i;
        }
    } while (i < count && !is_start(framing, line[i]));
    return i;
}

/* A line that is too long or has lost its end; `kind` was its mark. */
static void tell_lost(const wh_framing_t *framing, size_t from, size_t end, wh_frame_kind_t kind,
                      told_t *told) {
    const bool is_long = end - from > framing->longest;
    const size_t size = is_long ? framing->longest : end - from;
    kind = is_long ? WH_FRAME_TOO_LONG : kind;
    if (framing->start_count > 0 && !is_start(framing, line[from])) {
        kind = WH_FRAME_GARBAGE;
    }
    tell(told, kind, line + from, size, line + from, size);
}

/* Reads the line from `from` on to its end. Returns where the next line begins. */
static size_t read_plainly(const wh_framing_t *framing, size_t from, told_t *told) {
    wh_frame_kind_t kind = WH_FRAME_NONE;
    const size_t end = find_end(framing, from, &kind);
    if (kind != WH_FRAME_GOOD || end - from > framing->longest) {
        tell_lost(framing, from, end, kind, told);
    } else if (!framing->skips_empty || end - from > 1) {
        tell_ended(framing, from, end, told);
    }
    const bool passes = framing->end_count == 2 && kind == WH_FRAME_GOOD && end < count && line[end] == '\n';
    return end + (passes ? 1 : 0);
}

/* ------------------------------------------------------------------------------------------------ the framer */

static void note(const wh_frame_t *frame, told_t *told) {
    tell(told, frame->kind, frame->bytes, frame->size, frame->body, frame->body_size);
}

static wh_framer_t framer;

/* Feeds a piece whole. Returns how many bytes were in frames. */
static size_t feed_piece(const uint8_t *bytes, size_t size, int64_t now, told_t *told) {
    size_t in_frames = 0;
    size_t taken = 0;
    wh_frame_t frame;
    do {
        taken += wh_framer_feed(&framer, bytes + taken, size - taken, now, &frame);
        if (frame.kind != WH_FRAME_NONE) {
            in_frames += frame.size;
            note(&frame, told);
        }
    } while (frame.kind != WH_FRAME_NONE || taken < size);
    return in_frames;
}

/* Feeds the line in pieces of one time each, cut at random, with waits in between. */
static void read_in_pieces(const wh_framing_t *framing, uint32_t most, told_t *told) {
    wh_frame_t frame;
    uint64_t in_frames = 0;
    assert_true(wh_framer_init(&framer, framing));
    for (size_t at = 0; at < count;) {
        size_t size = 1;
        const size_t piece = 1 + wh_test_below(most);
        while (size < piece && at + size < count && times[at + size] == times[at]) {
            ++size;
        }
        if (wh_test_below(2) == 0 && wh_framer_wait(&framer, times[at], &frame)) {
            in_frames += frame.size;
            note(&frame, told);
        }
        in_frames += feed_piece(line + at, size, times[at], told);
        at += size;
    }
    if (wh_framer_finish(&framer, &frame)) {
        in_frames += frame.size;
        note(&frame, told);
    }
    /* No byte is lost. */
    assert_int_equal(framer.counters.bytes, count);
    assert_int_equal(in_frames + framer.counters.passed, count);
}

static void same_in_pieces(void **state) {
    (void)state;
    static told_t plain;
    static told_t cut;
    size_t kinds = 0;
    wh_rounds_t rounds = WH_ROUNDS(400, ROUNDS, 0.4);
    while (wh_round(&rounds)) {
        const wh_framing_t framing = draw_framing();
        draw_line(&framing);
        plain.size = 0;
        plain.text[0] = '\0';
        for (size_t at = 0; at < count;) {
            at = read_plainly(&framing, at, &plain);
        }
        for (uint32_t most = 1; most <= 100; most *= 10) {
            cut.size = 0;
            cut.text[0] = '\0';
            read_in_pieces(&framing, most, &cut);
            if (strcmp(plain.text, cut.text) != 0) {
                print_error("round %d, pieces up to %u\n", rounds.number, most);
            }
            assert_string_equal(cut.text, plain.text);
        }
        for (wh_frame_kind_t kind = WH_FRAME_GOOD; kind < WH_FRAME_KINDS; ++kind) {
            kinds |= strstr(plain.text, wh_frame_kind_name(kind)) ? (size_t)1 << kind : 0;
        }
    }
    const size_t all = ((size_t)1 << WH_FRAME_KINDS) - ((size_t)1 << WH_FRAME_GOOD);
    assert_int_equal(kinds, all - ((size_t)1 << WH_FRAME_BAD_LENGTH));
}

/* ------------------------------------------------------------------------------------------------- lengths */

static wh_framing_t draw_counted(void) {
    static const unsigned bases[] = {10, 16, 256};
    wh_framing_t framing = {.longest = WH_FRAMING_LEAST + wh_test_below(90), .timeout_us = 1000};
    framing.start_count = wh_test_below(3);
    framing.starts[0] = (wh_framing_mark_t){"$", 1};
    framing.starts[1] = (wh_framing_mark_t){"!!", 2};
    framing.end_count = wh_test_below(2);
    framing.ends[0] = (wh_framing_mark_t){"\r\n", 1 + wh_test_below(2)};
    framing.length = (wh_framing_length_t){.size = 3,
                                           .base = bases[wh_test_below(3)],
                                           .low_first = wh_test_below(2) == 0,
                                           .counts = (wh_length_counts_t)wh_test_below(3)};
    framing.sum = (wh_sum_kind_t)wh_test_below(5);
    if (framing.sum != WH_SUM_NONE) {
        framing.sums_start = wh_test_below(2) == 0;
        framing.sums_length = wh_test_below(2) == 0;
        framing.sums_as_bytes = wh_test_below(2) == 0;
        framing.separator = (wh_framing_mark_t){",", wh_test_below(2)};
    }
    framing.shortest = wh_test_below(4);
    return framing;
}

/* Appends a frame around a body of any bytes and, to `told`, what a framer has to say of it. False: it makes
 * none. */
static bool draw_counted_frame(const wh_framing_t *framing, told_t *told) {
    uint8_t body[60];
    uint8_t frame[WH_FRAMING_LINE];
    const size_t size = wh_test_below(60);
    const size_t start = framing->start_count > 0 ? wh_test_below((uint32_t)framing->start_count) : 0;
    for (size_t i = 0; i < size; ++i) {
        body[i] = (uint8_t)wh_test_below(256);
    }
    const size_t whole = wh_framing_encode(framing, start, body, size, frame);
    const size_t begin = framing->start_count > 0 ? framing->starts[start].size : 0;
    const size_t least = begin + 3 + size;
    assert_true(whole == 0 || (whole >= least && memcmp(frame + begin + 3, body, size) == 0));
    if (whole == 0 || count + whole > BYTES) {
        return false;
    }
    append(frame, whole);
    tell(told, WH_FRAME_GOOD, frame, whole, body, size);
    return true;
}

/* Bodies of any bytes come back, however the line is cut. */
static void counted(void **state) {
    (void)state;
    static told_t plain;
    static told_t cut;
    uint64_t drawn = 0;
    wh_rounds_t rounds = WH_ROUNDS(400, ROUNDS, 0.4);
    while (wh_round(&rounds)) {
        const wh_framing_t framing = draw_counted();
        plain.size = count = 0;
        plain.text[0] = '\0';
        for (int i = 0; i < 6; ++i) {
            drawn += draw_counted_frame(&framing, &plain) ? 1 : 0;
        }
        memset(times, 0, sizeof times);
        for (uint32_t most = 1; most <= 100; most *= 10) {
            cut.size = 0;
            cut.text[0] = '\0';
            read_in_pieces(&framing, most, &cut);
            assert_string_equal(cut.text, plain.text);
        }
    }
    assert_true(drawn > 2U * (uint64_t)rounds.number);
}

/* Marks of any length; where all are of one byte, perhaps with an escape. */
static void draw_marks(wh_framing_t *framing) {
    framing->start_count = wh_test_below(3);
    framing->starts[0] = (wh_framing_mark_t){"#$", 2};
    framing->starts[1] = (wh_framing_mark_t){"$", 1};
    framing->ends[0] = (wh_framing_mark_t){"\x03\r\n;", 1 + wh_test_below(4)};
    framing->end_count = 1;
    framing->sum = (wh_sum_kind_t)wh_test_below(5);
    framing->has_escape = framing->start_count < 2 && framing->ends[0].size == 1 && wh_test_below(2) == 0;
    framing->escape = 0x10;
    if (framing->has_escape) {
        framing->starts[0] = (wh_framing_mark_t){"\x02", 1};
    }
}

static size_t draw_body(const wh_framing_t *framing, uint8_t body[WH_FRAMING_LINE]) {
    static const uint8_t marks[] = {0x02, 0x03, 0x10};
    const size_t size = wh_test_below(wh_test_below(4) == 0 ? WH_FRAMING_LINE : 30);
    for (size_t i = 0; i < size; ++i) {
        body[i] = wh_test_below(10) == 0 ? (uint8_t)wh_test_below(256) : 'x';
        if (framing->has_escape && wh_test_below(5) == 0) {
            body[i] = marks[wh_test_below(3)];
        }
    }
    return size;
}

/* Marks of any length: an encoded body is read back, also behind any other frame, however it is cut. */
static void encoded_comes_back(void **state) {
    (void)state;
    size_t encoded = 0;
    wh_rounds_t rounds = WH_ROUNDS(400, ROUNDS, 0.3);
    while (wh_round(&rounds)) {
        wh_framing_t framing = wh_framing_default();
        uint8_t body[WH_FRAMING_LINE];
        uint8_t frame[WH_FRAMING_LINE];
        wh_frame_t found = {.kind = WH_FRAME_NONE};
        draw_marks(&framing);
        const size_t size = draw_body(&framing, body);
        const size_t start = framing.start_count > 0 ? wh_test_below((uint32_t)framing.start_count) : 0;
        const size_t whole = wh_framing_encode(&framing, start, body, size, frame);
        assert_true(wh_framer_init(&framer, &framing));
        for (size_t at = 0; at < 2 * whole && found.kind <= WH_FRAME_GOOD; ++at) {
            (void)wh_framer_feed(&framer, &frame[at % whole], 1, 0, &found);
            assert_int_equal(found.kind, (at + 1) % whole == 0 ? WH_FRAME_GOOD : WH_FRAME_NONE);
        }
        if (whole > 0) {
            encoded += 1;
            assert_int_equal(found.body_size, size);
            assert_memory_equal(found.body, body, size);
            assert_int_equal(found.start, start);
        }
    }
    assert_in_range(encoded, rounds.made / 4, rounds.made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_in_pieces),
        cmocka_unit_test(encoded_comes_back),
        cmocka_unit_test(counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
