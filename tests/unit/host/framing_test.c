/* Frames as the industry uses them, and each kind of bad frame. */
#include "host/framing.h"
#include "support/support.h"

/* "$" to CR, with a sum of two hex digits behind a comma. */
static wh_framing_t dollar(void) {
    wh_framing_t framing = wh_framing_default();
    framing.starts[0] = (wh_framing_mark_t){"$", 1};
    framing.start_count = 1;
    framing.ends[0] = (wh_framing_mark_t){"\r", 1};
    framing.end_count = 2;
    framing.ends[1] = (wh_framing_mark_t){"\r\n", 2};
    framing.sum = WH_SUM_ADD;
    framing.separator = (wh_framing_mark_t){",", 1};
    framing.sums_separator = true;
    framing.shortest = 2;
    framing.longest = 64;
    framing.timeout_us = 5000;
    return framing;
}

static wh_framer_t framer;
static char heard[4000];

/* Adds "kind:bytes;" to the output; for a good frame its body. */
static void note(const wh_frame_t *frame) {
    const size_t at = strlen(heard);
    (void)snprintf(heard + at, sizeof heard - at, "%s:%.*s;", wh_frame_kind_name(frame->kind),
                   (int)(frame->body_size < 40 ? frame->body_size : 40), (const char *)frame->body);
}

static void feed(const char *bytes, int64_t time_us) {
    wh_frame_t frame;
    const size_t size = strlen(bytes);
    for (size_t at = 0;;) {
        at += wh_framer_feed(&framer, (const uint8_t *)bytes + at, size - at, time_us, &frame);
        if (frame.kind == WH_FRAME_NONE) {
            assert_int_equal(at, size);
            return;
        }
        note(&frame);
    }
}

static void begin(const wh_framing_t *framing) {
    heard[0] = '\0';
    assert_true(wh_framer_init(&framer, framing));
}

static void lines(void **state) {
    (void)state;
    const wh_framing_t framing = wh_framing_default();
    begin(&framing);
    feed("HOME\r\n\r\n\nGET LP1 1\nPU", 0);
    feed("T LP1 1\r", 1);
    feed("\nX\rY\n", 2);
    assert_string_equal(heard, "good:HOME;good:GET LP1 1;good:PUT LP1 1;good:X\rY;");
    assert_int_equal(framer.counters.frames[WH_FRAME_GOOD], 4);
    assert_int_equal(framer.counters.passed, 3);
}

static void sums(void **state) {
    (void)state;
    wh_framing_t framing = dollar();
    /* '1' + ',' + 'I' + ',' = 0x31 + 0x2C + 0x49 + 0x2C = 0xD2. */
    begin(&framing);
    feed("$1,I,D2\r\n$1,I,d2\r$1,I,D3\r$1,I,G2\r$1,I;D2\r$1,D2\r$D2\r$\r", 0);
    assert_string_equal(heard, "good:1,I;good:1,I;bad sum:$1,I,D3\r;bad sum:$1,I,G2\r;bad sum:$1,I;D2\r;"
                               "short:$1,D2\r;short:$D2\r;short:$\r;");
    framing.sums_start = true;
    assert_int_equal(wh_framing_sum(&framing, 0, (const uint8_t *)"1,I", 3), 0xF6);
    framing.sum = WH_SUM_COMPLEMENT;
    assert_int_equal(wh_framing_sum(&framing, 0, (const uint8_t *)"1,I", 3), 0x0A);
    framing.sum = WH_SUM_XOR;
    assert_int_equal(wh_framing_sum(&framing, 0, (const uint8_t *)"1,I", 3), 0x31 ^ 0x49 ^ 0x24);
}

/* 123456789 has the CRC 4B37, as tables of checks have it. */
static void a_crc(void **state) {
    (void)state;
    wh_framing_t framing = dollar();
    uint8_t frame[WH_FRAMING_LINE];
    framing.sum = WH_SUM_CRC16;
    framing.sums_separator = false;
    assert_int_equal(wh_framing_sum(&framing, 0, (const uint8_t *)"123456789", 9), 0x4B37);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"123456789", 9, frame), 16);
    assert_memory_equal(frame, "$123456789,4B37\r", 16);
    begin(&framing);
    feed("$123456789,4b37\r$123456789,4B38\r$123456789,37\r$12,4B3\r$1,\r", 0);
    assert_string_equal(heard,
                        "good:123456789;bad sum:$123456789,4B38\r;bad sum:$123456789,37\r;short:$12,4B3\r;"
                        "short:$1,\r;");
}

/* STX, ETX and DLE: any byte may be in a body. */
static void escapes(void **state) {
    (void)state;
    wh_framing_t framing = wh_framing_default();
    uint8_t frame[WH_FRAMING_LINE];
    framing.starts[0] = (wh_framing_mark_t){"\x02", 1};
    framing.start_count = 1;
    framing.ends[0] = (wh_framing_mark_t){"\x03", 1};
    framing.end_count = 1;
    framing.has_escape = true;
    framing.escape = 0x10;
    framing.sum = WH_SUM_XOR;
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"a\x03\x10\x02", 4, frame), 11);
    assert_memory_equal(frame,
                        "\x02"
                        "a\x10\x03\x10\x10\x10\x02"
                        "70\x03",
                        11);
    begin(&framing);
    feed("\x02"
         "a\x10\x03\x10\x10\x10\x02"
         "70\x03"
         "\x02"
         "b62\x03"
         "\x02"
         "c\x10\x03"
         "\x02"
         "d64\x03",
         0);
    assert_string_equal(heard, "good:a\x03\x10\x02;good:b;no end:\x02"
                               "c\x10\x03;good:d;");
    char problem[WH_FRAMING_PROBLEM_BYTES];
    framing.escape = 3;
    assert_false(wh_framing_validate(&framing, problem));
    assert_string_equal(problem,
                        "escape: expected no start, end or separator, and no hex digit beside a sum");
    framing.escape = 0x10;
    framing.ends[0] = (wh_framing_mark_t){"\r\n", 2};
    assert_false(wh_framing_validate(&framing, problem));
    assert_string_equal(problem, "escape: expected starts and ends of one byte");
}

static void lost_bytes(void **state) {
    (void)state;
    const wh_framing_t framing = dollar();
    wh_frame_t frame;
    begin(&framing);
    feed("xy$1,I,D2\r$1,I$1,I,D2\rHELLO\r\n$1,I", 0);
    assert_true(wh_framer_finish(&framer, &frame));
    note(&frame);
    feed("z", 1);
    assert_true(wh_framer_finish(&framer, &frame));
    note(&frame);
    assert_false(wh_framer_finish(&framer, &frame));
    assert_string_equal(heard, "garbage:xy;good:1,I;no end:$1,I;good:1,I;garbage:HELLO\r;no end:$1,I;"
                               "garbage:z;");
}

static void pauses(void **state) {
    (void)state;
    const wh_framing_t framing = dollar();
    wh_frame_t frame;
    begin(&framing);
    assert_true(wh_framer_due(&framer) == INT64_MAX);
    feed("$1,", 1000);
    assert_int_equal(wh_framer_due(&framer), 6000);
    feed("I,D2\r", 5999);
    assert_true(wh_framer_due(&framer) == INT64_MAX);
    assert_false(wh_framer_wait(&framer, 1000000, &frame));
    feed("$1,", 2000000);
    assert_false(wh_framer_wait(&framer, 2004999, &frame));
    assert_true(wh_framer_wait(&framer, 2005000, &frame));
    assert_int_equal(frame.first_us, 2000000);
    assert_int_equal(frame.last_us, 2000000);
    note(&frame);
    feed("$2,", 2005000);
    feed("$1,I,D2\r", 2010000);
    feed("??", 3000000);
    assert_true(wh_framer_wait(&framer, 3005000, &frame));
    note(&frame);
    assert_string_equal(heard, "good:1,I;timeout:$1,;timeout:$2,;good:1,I;garbage:??;");
}

static void too_long(void **state) {
    (void)state;
    const wh_framing_t framing = dollar();
    char line[200];
    wh_frame_t frame;
    begin(&framing);
    /* 64 bytes are whole, 65 are not, and the bytes behind are skipped. */
    memset(line, 'a', sizeof line);
    line[0] = '$';
    (void)snprintf(line + 60, sizeof line - 60, ",%02X\r",
                   (unsigned)wh_framing_sum(&framing, 0, (const uint8_t *)line + 1, 59));
    assert_int_equal(strlen(line), 64);
    feed(line, 0);
    assert_int_equal(framer.counters.frames[WH_FRAME_GOOD], 1);
    memset(line, 'a', sizeof line);
    line[0] = '$';
    assert_int_equal(wh_framer_feed(&framer, (const uint8_t *)line, sizeof line, 1, &frame), 65);
    assert_int_equal(frame.kind, WH_FRAME_TOO_LONG);
    assert_int_equal(frame.size, 64);
    for (int i = 0; i < 20000; ++i) {
        assert_int_equal(wh_framer_feed(&framer, (const uint8_t *)line + 1, 50, 2, &frame), 50);
        assert_int_equal(frame.kind, WH_FRAME_NONE);
    }
    heard[0] = '\0';
    feed("\r\n$1,I,D2\r", 3);
    assert_string_equal(heard, "good:1,I;");
    assert_int_equal(framer.counters.passed, 1000001 + 2);
    assert_int_equal(framer.counters.frames[WH_FRAME_TOO_LONG], 1);
    /* A start, or a pause, ends it as well. */
    heard[0] = '\0';
    (void)wh_framer_feed(&framer, (const uint8_t *)line, 65, 4, &frame);
    feed("aaa$1,I,D2\r", 4);
    (void)wh_framer_feed(&framer, (const uint8_t *)line, 65, 4, &frame);
    assert_true(wh_framer_due(&framer) == INT64_MAX);
    feed("$1,I,D2\r", 5004);
    assert_string_equal(heard, "good:1,I;good:1,I;");
}

static void writing(void **state) {
    (void)state;
    wh_framing_t framing = dollar();
    uint8_t frame[WH_FRAMING_LINE];
    const uint8_t *body = (const uint8_t *)"1,I";
    assert_int_equal(wh_framing_encode(&framing, 0, body, 3, frame), 8);
    assert_memory_equal(frame, "$1,I,D2\r", 8);
    assert_int_equal(wh_framing_encode(&framing, 1, body, 3, frame), 0);
    assert_int_equal(wh_framing_encode(&framing, 0, body, 1, frame), 0);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"1$I", 3, frame), 0);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"1\rI", 3, frame), 0);
    char longest[70];
    memset(longest, 'a', sizeof longest);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)longest, 59, frame), 64);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)longest, 60, frame), 0);
    framing = wh_framing_default();
    assert_int_equal(wh_framing_encode(&framing, 0, body, 0, frame), 0);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"ab\r", 3, frame), 0);
    framing.skips_empty = false;
    assert_int_equal(wh_framing_encode(&framing, 0, body, 0, frame), 1);
    framing.ends[0] = (wh_framing_mark_t){"\r\n", 2};
    framing.ends[1] = (wh_framing_mark_t){"\r", 1};
    assert_int_equal(wh_framing_encode(&framing, 0, body, 3, frame), 5);
}

static void assert_refused(const wh_framing_t *framing, const char *expected) {
    char problem[WH_FRAMING_PROBLEM_BYTES] = "";
    wh_framer_t before;
    memcpy(&before, &framer, sizeof before);
    assert_false(wh_framing_validate(framing, problem));
    assert_string_equal(problem, expected);
    assert_false(wh_framer_init(&framer, framing));
    assert_memory_equal(&framer, &before, sizeof before);
}

#define REFUSE(member, value, expected)                                                                      \
    do {                                                                                                     \
        wh_framing_t changed = dollar();                                                                     \
        changed.member = value;                                                                              \
        assert_refused(&changed, expected);                                                                  \
    } while (0)

#define MARK(text)                                                                                           \
    (wh_framing_mark_t) {                                                                                    \
        text, sizeof text - 1                                                                                \
    }

static void descriptions(void **state) {
    (void)state;
    char problem[WH_FRAMING_PROBLEM_BYTES];
    wh_framing_t framing = dollar();
    assert_true(wh_framing_validate(&framing, problem));
    framing = wh_framing_default();
    assert_true(wh_framing_validate(&framing, problem));
    REFUSE(start_count, 5, "starts: 5 (expected 0 to 4)");
    REFUSE(end_count, 0, "ends: 0 (expected 1 to 4)");
    REFUSE(sum, (wh_sum_kind_t)5, "sum: 5 (expected 0 to 4)");
    REFUSE(longest, 4097, "longest: 4097 (expected 32 to 4096)");
    REFUSE(longest, 31, "longest: 31 (expected 32 to 4096)");
    REFUSE(shortest, 59, "shortest: 59 (expected 0 to 58)");
    REFUSE(timeout_us, -1, "timeout: -1 (expected 0 to 3600000000)");
    REFUSE(starts[0].size, 0, "start 1: expected 1 to 8 bytes");
    REFUSE(starts[0], MARK("$A"), "start 1: expected no hex digit beside a sum");
    REFUSE(ends[0], MARK("F"), "end 1: expected no hex digit beside a sum");
    REFUSE(ends[0], MARK("$"), "end 1: expected no byte of a start");
    REFUSE(ends[1], MARK("\r"), "end 2: expected one byte more than the end that begins as it does");
    REFUSE(ends[1], MARK("\rxy"), "end 2: expected one byte more than the end that begins as it does");
    REFUSE(ends[1].size, 9, "end 2: expected 1 to 8 bytes");
    REFUSE(separator, MARK("\r"), "separator: expected no byte of a start or an end");
    REFUSE(separator.size, 9, "bytes of the separator: 9 (expected 0 to 8)");
    REFUSE(sum, WH_SUM_NONE,
           "sum: none (expected another one, for there is a separator, or what counts into it)");
    framing = dollar();
    framing.starts[1] = MARK("$$");
    framing.start_count = 2;
    assert_refused(&framing, "start 2: expected that it does not begin as another start");
    assert_string_equal(wh_frame_kind_name(WH_FRAME_KINDS), "unknown");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines),    cmocka_unit_test(sums),       cmocka_unit_test(a_crc),
        cmocka_unit_test(escapes),  cmocka_unit_test(lost_bytes), cmocka_unit_test(pauses),
        cmocka_unit_test(too_long), cmocka_unit_test(writing),    cmocka_unit_test(descriptions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
