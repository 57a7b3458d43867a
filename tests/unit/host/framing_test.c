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

/* SOH, two bytes of length that count all up to the sum, a body, a sum of two digits, ETX. */
static wh_framing_t counted(void) {
    wh_framing_t framing = wh_framing_default();
    framing.starts[0] = (wh_framing_mark_t){"\x01", 1};
    framing.start_count = 1;
    framing.ends[0] = (wh_framing_mark_t){"\x03", 1};
    framing.end_count = 1;
    framing.length = (wh_framing_length_t){.size = 2, .base = 256, .counts = WH_LENGTH_REST};
    framing.sum = WH_SUM_ADD;
    framing.sums_length = true;
    framing.longest = 64;
    framing.timeout_us = 5000;
    return framing;
}

static void feed_bytes(const void *bytes, size_t size, int64_t time_us) {
    wh_frame_t frame;
    for (size_t at = 0;;) {
        at += wh_framer_feed(&framer, (const uint8_t *)bytes + at, size - at, time_us, &frame);
        if (frame.kind == WH_FRAME_NONE) {
            assert_int_equal(at, size);
            return;
        }
        note(&frame);
    }
}

/* 00 + 06 + '0' + '0' + 'A' + ';' = 6 + 0x30 + 0x30 + 0x41 + 0x3B = 0xE2. */
static void lengths(void **state) {
    (void)state;
    const wh_framing_t framing = counted();
    uint8_t frame[WH_FRAMING_LINE];
    static const uint8_t good[] = "\x01\x00\x06"
                                  "00A;E2\x03";
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"00A;", 4, frame), sizeof good - 1);
    assert_memory_equal(frame, good, sizeof good - 1);
    begin(&framing);
    feed_bytes(good, 5, 0);
    feed_bytes(good + 5, sizeof good - 6, 4999);
    assert_string_equal(heard, "good:00A;;");
    /* A body may have any bytes, those of marks as well. */
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"\x01\x03\x03\x01", 4, frame), 10);
    begin(&framing);
    feed_bytes(frame, 10, 0);
    assert_string_equal(heard, "good:\x01\x03\x03\x01;");
    assert_int_equal(wh_framing_encode(&framing, 0, frame, 59, frame), 0);
    /* An empty one is a frame: its sum is that of the length. */
    assert_int_equal(wh_framing_encode(&framing, 0, frame, 0, frame), 6);
    assert_memory_equal(frame,
                        "\x01\x00\x02"
                        "02\x03",
                        6);
}

static void bad_lengths(void **state) {
    (void)state;
    const wh_framing_t framing = counted();
    wh_frame_t frame;
    static const uint8_t good[] = "\x01\x00\x06"
                                  "00A;E2\x03";
    begin(&framing);
    feed_bytes("\x01\x00\x06"
               "00A;E3\x03"
               "\x01\x00\x06"
               "00A;E2\x04"
               "xy",
               22, 0);
    feed_bytes(good, sizeof good - 1, 0);
    assert_string_equal(heard, "bad sum:\x01;no end:\x01;garbage:xy;good:00A;;"); /* up to a byte 0 */
    assert_int_equal(framer.counters.frames[WH_FRAME_BAD_SUM], 1);
    assert_int_equal(framer.counters.frames[WH_FRAME_NO_END], 1);
    assert_int_equal(framer.counters.frames[WH_FRAME_GARBAGE], 1);
    assert_int_equal(framer.counters.frames[WH_FRAME_GOOD], 1);
    /* Less than a sum, and more than `longest`: told with the length; a start brings it back. */
    begin(&framing);
    assert_int_equal(wh_framer_feed(&framer, (const uint8_t *)"\x01\x00\x01zz", 5, 0, &frame), 3);
    assert_int_equal(frame.kind, WH_FRAME_BAD_LENGTH);
    assert_true(frame.is_over && frame.size == 2);
    feed_bytes("zzzzzzzzzzzz", 12, 0);
    feed_bytes(good, sizeof good - 1, 0);
    assert_int_equal(framer.counters.passed, 13);
    assert_int_equal(wh_framer_feed(&framer, (const uint8_t *)"\x01\x10\x00zz", 5, 0, &frame), 3);
    assert_int_equal(frame.kind, WH_FRAME_TOO_LONG);
    feed_bytes(good, sizeof good - 1, 5000);
    assert_string_equal(heard, "good:00A;;good:00A;;");
    feed_bytes(good, 7, 5000);
    assert_true(wh_framer_wait(&framer, 10000, &frame));
    assert_int_equal(frame.kind, WH_FRAME_TIMEOUT);
}

/* Digits, a length of the whole frame, the low byte first, a sum as bytes, neither start nor end. */
static void forms_of_lengths(void **state) {
    (void)state;
    wh_framing_t framing = counted();
    uint8_t frame[WH_FRAMING_LINE];
    framing.length = (wh_framing_length_t){.size = 3, .base = 10, .counts = WH_LENGTH_FRAME};
    framing.sum = WH_SUM_NONE;
    framing.sums_length = false;
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"HOME", 4, frame), 9);
    assert_memory_equal(frame,
                        "\x01"
                        "009HOME\x03",
                        9);
    begin(&framing);
    feed("\x01"
         "009HOME\x03\x01"
         "0x9HOME\x03\x01"
         "00A\x01"
         "004\x01"
         "099\x01"
         "005\x03",
         0);
    assert_string_equal(heard, "good:HOME;bad length:\x01"
                               "0x;bad length:\x01"
                               "00;bad length:\x01"
                               "00;too long:\x01"
                               "09;good:;");
    framing.length = (wh_framing_length_t){.size = 2, .base = 16, .counts = WH_LENGTH_BODY};
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"0123456789", 10, frame), 14);
    assert_memory_equal(frame,
                        "\x01"
                        "0A0123456789\x03",
                        14);
    framing.length.size = 1;
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"0123456789abcdef", 16, frame), 0);
    framing.length =
        (wh_framing_length_t){.size = 2, .base = 256, .counts = WH_LENGTH_BODY, .low_first = true};
    framing.start_count = framing.end_count = 0;
    framing.sum = WH_SUM_CRC16;
    framing.sums_as_bytes = true;
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"123456789", 9, frame), 13);
    assert_memory_equal(frame,
                        "\x09\x00"
                        "123456789\x4B\x37",
                        13);
    begin(&framing);
    feed_bytes(frame, 13, 0);
    feed_bytes(frame, 13, 0);
    frame[12] = 0x36;
    feed_bytes(frame, 13, 0);
    assert_int_equal(framer.counters.frames[WH_FRAME_GOOD], 2);
    assert_int_equal(framer.counters.frames[WH_FRAME_BAD_SUM], 1);
}

static wh_framing_t with_lrc(void) {
    wh_framing_t framing = wh_framing_default();
    framing.starts[0] = (wh_framing_mark_t){"\x02", 1};
    framing.start_count = 1;
    framing.ends[0] = (wh_framing_mark_t){"\x03", 1};
    framing.end_count = 1;
    framing.has_escape = true;
    framing.escape = 0x10;
    framing.sum = WH_SUM_XOR;
    framing.sum_is_behind = framing.sums_end = framing.sums_as_bytes = true;
    framing.timeout_us = 5000;
    return framing;
}

/* With its sum a frame would be too long: this is told at its end. */
static void longest_with_sum_behind(void **state) {
    (void)state;
    const wh_framing_t framing = with_lrc();
    uint8_t frame[WH_FRAMING_LINE];
    begin(&framing);
    uint8_t longest[WH_FRAMING_LINE];
    memset(longest, 'a', sizeof longest);
    assert_int_equal(wh_framing_encode(&framing, 0, longest, WH_FRAMING_LINE - 3, frame), WH_FRAMING_LINE);
    feed_bytes(frame, WH_FRAMING_LINE, 12000);
    assert_int_equal(wh_framing_encode(&framing, 0, longest, WH_FRAMING_LINE - 2, frame), 0);
    longest[0] = 2;
    longest[WH_FRAMING_LINE - 1] = 3;
    feed_bytes(longest, WH_FRAMING_LINE, 12000);
    assert_int_equal(framer.counters.frames[WH_FRAME_TOO_LONG], 1);
    feed_bytes("\x02"
               "ab\x03\x00",
               5, 12000);
    assert_string_equal(heard + strlen(heard) - 8, "good:ab;");
}

/* STX, a body with escapes, ETX, and behind it the exclusive or of body and ETX, whatever byte that is. */
static void sums_behind(void **state) {
    (void)state;
    wh_framing_t framing = with_lrc();
    uint8_t frame[WH_FRAMING_LINE];
    /* 'a' ^ 'b' ^ 3 = 0, a byte 0; 'c' ^ 'b' ^ 3 = 2, a start. */
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"ab", 2, frame), 5);
    assert_memory_equal(frame,
                        "\x02"
                        "ab\x03\x00",
                        5);
    begin(&framing);
    feed_bytes(frame, 4, 0);
    feed_bytes(frame + 4, 1, 4999);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"cb", 2, frame), 5);
    assert_int_equal(frame[4], 2);
    feed_bytes(frame, 5, 5000);
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"\x03\x02", 2, frame), 7);
    feed_bytes(frame, 7, 5000);
    frame[6] ^= 1;
    feed_bytes(frame, 7, 5000);
    assert_string_equal(heard, "good:ab;good:cb;good:\x03\x02;bad sum:\x02\x10\x03\x10\x02\x03\x03;");
    /* One whose sum does not come is given up, and the next one is whole. */
    wh_frame_t late;
    heard[0] = '\0';
    feed_bytes(frame, 6, 6000);
    assert_true(wh_framer_wait(&framer, 11000, &late));
    assert_int_equal(late.kind, WH_FRAME_TIMEOUT);
    frame[6] ^= 1;
    feed_bytes(frame, 7, 12000);
    feed_bytes("xy\x03", 3, 12000);
    assert_string_equal(heard, "good:\x03\x02;garbage:xy\x03;");
    framing.sums_as_bytes = false;
    framing.sum = WH_SUM_ADD;
    assert_int_equal(wh_framing_encode(&framing, 0, (const uint8_t *)"ab", 2, frame), 6);
    assert_memory_equal(frame,
                        "\x02"
                        "ab\x03"
                        "C6",
                        6);
    begin(&framing);
    feed_bytes(frame, 6, 0);
    assert_string_equal(heard, "good:ab;");
}

/* No single wrong byte passes, and behind a pause the next frame is read whatever was wrong before. */
static void damaged_lengths(void **state) {
    (void)state;
    wh_framing_t framing = counted();
    uint8_t whole[WH_FRAMING_LINE];
    framing.sum = WH_SUM_CRC16;
    const size_t size = wh_framing_encode(&framing, 0, (const uint8_t *)"00MOV:ORGSH;", 12, whole);
    assert_int_equal(size, 20);
    int64_t now = 0;
    begin(&framing);
    for (size_t at = 0; at < size; ++at) {
        for (unsigned value = 1; value < 256; ++value) {
            uint8_t frame[WH_FRAMING_LINE];
            memcpy(frame, whole, size);
            frame[at] = (uint8_t)(frame[at] ^ value);
            const bool is_other_case = value == 0x20 && at >= 15 && at < 19 && whole[at] >= 'A';
            heard[0] = '\0';
            feed_bytes(frame, size, now);
            assert_int_equal(framer.counters.frames[WH_FRAME_GOOD], is_other_case ? 1 : 0);
            now += 5000;
            feed_bytes(whole, size, now);
            assert_int_equal(framer.counters.frames[WH_FRAME_GOOD], is_other_case ? 2 : 1);
            framer.counters.frames[WH_FRAME_GOOD] = 0;
        }
    }
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
    REFUSE(sums_as_bytes, true, "sum: one of bytes (expected it beside a length, or behind the end)");
    REFUSE(sums_length, true, "sums_length: expected a length");
    REFUSE(sums_end, true, "sums_end: expected a sum behind the end");
    REFUSE(sum_is_behind, true, "sum: one behind the end (expected no length, one end, no separator)");
    REFUSE(length.size, 5, "ends: 2 (expected 0 to 1)");
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
    framing = counted();
    assert_true(wh_framing_validate(&framing, problem));
    framing.length.size = 5;
    assert_refused(&framing, "length.size: 5 (expected 0 to 4)");
    framing = counted();
    framing.length.base = 8;
    assert_refused(&framing, "length: a base of its digits (expected 10, 16 or 256)");
    framing = counted();
    framing.timeout_us = 0;
    assert_refused(&framing, "timeout: 0 (expected above 0 beside a length)");
    framing = counted();
    framing.has_escape = true;
    framing.escape = 0x10;
    assert_refused(&framing, "escape: expected none beside a length");
    framing = counted();
    framing.sum = WH_SUM_NONE;
    assert_refused(&framing, "sum: none (expected another one, for something says more of it)");
    assert_string_equal(wh_frame_kind_name(WH_FRAME_KINDS), "unknown");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines),
        cmocka_unit_test(sums),
        cmocka_unit_test(a_crc),
        cmocka_unit_test(escapes),
        cmocka_unit_test(lost_bytes),
        cmocka_unit_test(pauses),
        cmocka_unit_test(too_long),
        cmocka_unit_test(writing),
        cmocka_unit_test(descriptions),
        cmocka_unit_test(lengths),
        cmocka_unit_test(bad_lengths),
        cmocka_unit_test(forms_of_lengths),
        cmocka_unit_test(damaged_lengths),
        cmocka_unit_test(sums_behind),
        cmocka_unit_test(longest_with_sum_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
