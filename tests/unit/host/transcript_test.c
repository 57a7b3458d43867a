/* Transcripts: written ones are read back, lines that are not understood are refused, and the first
 * difference is reported. */
#include "host/transcript.h"
#include "support/support.h"

#define FIRST "waferhand transcript 1\n"

static wh_transcript_t transcript;

static bool parse(const char *text) {
    return wh_transcript_parse(&transcript, "a.txt", text, strlen(text));
}

static void assert_refused(const char *lines, const char *expected) {
    char text[600];
    (void)snprintf(text, sizeof text, FIRST "layout \"cell.lua\"\n\n10 0.010000 > r \"A\\r\"\n%s", lines);
    assert_false(parse(text));
    assert_string_equal(transcript.message, expected);
    wh_transcript_close(&transcript);
}

static void refusals(void **state) {
    (void)state;
    assert_refused("9 0.010000 > r \"\"\n",
                   "a.txt:5: slice: 9 (expected digits, not less than in the entry before)");
    assert_refused("1e3 0.01 > r \"\"\n",
                   "a.txt:5: slice: 1e3 (expected digits, not less than in the entry before)");
    assert_refused("10 0.01 > r \"\"\n", "a.txt:5: time: 0.01 (expected seconds with six decimals, not less "
                                         "than in the entry before)");
    assert_refused("10 0.009999 > r \"\"\n", "a.txt:5: time: 0.009999 (expected seconds with six decimals, "
                                             "not less than in the entry before)");
    assert_refused("10 0.010000 x r \"\"\n",
                   "a.txt:5: kind: x (expected one of > < ~ before a frame, or of + - = ! * . ?)");
    assert_refused("10 0.010000\n",
                   "a.txt:5: kind: nothing (expected one of > < ~ before a frame, or of + - = ! * . ?)");
    assert_refused("10 0.010000 > r/2 \"\"\n",
                   "a.txt:5: port: r/2 (expected 1 to 63 letters, digits and _ - .)");
    assert_refused("10 0.010000 + r \"\"\n", "a.txt:5: bytes: \"\" (expected nothing, for no frame came)");
    const char *const bad[] = {"A",         "\"A",      "\"",       "\"\\\"", "\"\\q\"", "\"\\x4\"",
                               "\"\\x4g\"", "\"a\tb\"", "\"a\"b\"", "\"\\x",  "\"\\x\"", "\"\xc3\xa9\""};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        char line[100];
        (void)snprintf(line, sizeof line, FIRST "10 0.010000 > r %s\n", bad[i]);
        assert_false(parse(line));
        assert_non_null(strstr(transcript.message, "a.txt:2: bytes: "));
        wh_transcript_close(&transcript);
    }
    assert_refused("port \"r\"\n", "a.txt:5: head: port (expected no head behind an entry)");
    assert_false(parse(FIRST "Layout \"a\"\n"));
    assert_string_equal(transcript.message,
                        "a.txt:2: head: Layout (expected a word of small letters, or an entry)");
    wh_transcript_close(&transcript);
    assert_false(parse(FIRST "layout \"a\\r\"\n"));
    assert_non_null(strstr(transcript.message, "a.txt:2: layout: "));
    wh_transcript_close(&transcript);
    assert_false(parse("waferhand transcript 2\n"));
    assert_string_equal(transcript.message,
                        "a.txt:1: first line: waferhand transcript 2 (expected waferhand transcript 1)");
    wh_transcript_close(&transcript);
    assert_false(parse(""));
    wh_transcript_close(&transcript);
    assert_false(wh_transcript_parse(&transcript, "a.txt", FIRST "#\0\n", sizeof FIRST + 2));
    assert_string_equal(transcript.message, "a.txt:2: line: a byte 0 (expected text)");
    wh_transcript_close(&transcript);
    assert_false(wh_transcript_open(&transcript, "/"));
    assert_string_equal(transcript.message, "/: it is no regular file");
    wh_transcript_close(&transcript);
    assert_false(wh_transcript_open(&transcript, "/none/there"));
    assert_string_equal(transcript.message, "/none/there: No such file or directory");
    wh_transcript_close(&transcript);
}

static void assert_json_refused(const char *line, const char *expected) {
    char text[600];
    (void)snprintf(text, sizeof text,
                   "{\"transcript\":1}\n{\"head\":\"layout\",\"text\":\"a\"}\n"
                   "{\"slice\":10,\"time\":0.01,\"kind\":\"came\",\"port\":\"r\"}\n\n%s\n",
                   line);
    assert_false(parse(text));
    if (!strstr(transcript.message, expected)) {
        fail_msg("%s", transcript.message);
    }
    wh_transcript_close(&transcript);
}

#define ENTRY(slice, time, kind, more)                                                                       \
    "{\"slice\":" slice ",\"time\":" time ",\"kind\":\"" kind "\"," more "}"

static void json_refusals(void **state) {
    (void)state;
    assert_json_refused("{", "a.txt:5: line: { (expected {\"head\":NAME,\"text\":TEXT} or {\"slice\":");
    assert_json_refused("[1]", "a.txt:5: line: [1] (expected ");
    assert_json_refused(ENTRY("10", "0.01", "came", "\"port\":\"r\",\"more\":1"), "a.txt:5: line: {");
    assert_json_refused(ENTRY("10", "0.01", "left", "\"port\":\"r\""),
                        "a.txt:5: kind: left (expected said, timed_out, heard, came, went, clock, stopped, "
                        "halted, ended or elapsed)");
    assert_json_refused(ENTRY("9", "0.01", "went", "\"port\":\"r\""),
                        "a.txt:5: slice: 9 (expected digits, not less than in the entry before)");
    assert_json_refused(ENTRY("10", "0.009", "went", "\"port\":\"r\""), "a.txt:5: time: 0.009000 (expected ");
    assert_json_refused(ENTRY("10", "-1", "clock", "\"port\":\"r\""), "a.txt:5: time: another (expected ");
    assert_json_refused(ENTRY("-1", "0", "clock", "\"port\":\"r\""), "a.txt:5: slice, time or port: r (");
    assert_json_refused(ENTRY("10", "0.01", "went", "\"port\":\"r/2\""),
                        "a.txt:5: slice, time or port: r/2 (");
    assert_json_refused(ENTRY("10", "0.01", "went", "\"port\":\"r\",\"bytes\":\"\""),
                        "a.txt:5: bytes: nothing (");
    assert_json_refused(ENTRY("10", "0.01", "said", "\"port\":\"r\""), "a.txt:5: bytes: nothing (");
    assert_json_refused(ENTRY("10", "0.01", "said", "\"port\":\"r\",\"bytes\":\"\\u0100\""),
                        "a.txt:5: bytes: ");
    assert_json_refused(ENTRY("10", "0.01", "said", "\"port\":\"r\\u0000\",\"bytes\":\"\""),
                        "a.txt:5: bytes: ");
    assert_json_refused("{\"head\":\"layout\",\"text\":\"a\"}",
                        "a.txt:5: head: layout (expected no head behind");
    assert_false(parse("{\"transcript\":2}\n"));
    assert_string_equal(transcript.message,
                        "a.txt:1: line: {\"transcript\":2} (expected {\"transcript\":1})");
    wh_transcript_close(&transcript);
    assert_false(parse("{\"transcript\":1}\n{\"head\":\"layout\",\"text\":\"a\\u0000\"}\n"));
    assert_non_null(strstr(transcript.message, "a.txt:2: layout: a (expected a text in quotes"));
    wh_transcript_close(&transcript);
    assert_false(parse("{\"transcript\":1}\n{\"head\":\"layout\",\"text\":\"\\u0100\"}\n"));
    assert_non_null(strstr(transcript.message, "a.txt:2: head: layout (expected characters up to U+00FF)"));
    wh_transcript_close(&transcript);
}

static const wh_transcript_kind_t all_kinds[] = {
    WH_TRANSCRIPT_CAME,  WH_TRANSCRIPT_SAID,   WH_TRANSCRIPT_TIMED_OUT, WH_TRANSCRIPT_HEARD,
    WH_TRANSCRIPT_WENT,  WH_TRANSCRIPT_CLOCK,  WH_TRANSCRIPT_STOPPED,   WH_TRANSCRIPT_HALTED,
    WH_TRANSCRIPT_ENDED, WH_TRANSCRIPT_ELAPSED};
enum { KINDS = sizeof all_kinds / sizeof all_kinds[0] };

/* One of each kind; the clock is set back before the last five. */
static wh_transcript_entry_t entry_of(size_t i, const uint8_t bytes[WH_TRANSCRIPT_BYTES]) {
    const int64_t slice = i < 5 ? (int64_t)i : (int64_t)i - 5;
    return (wh_transcript_entry_t){.slice = slice,
                                   .time_us = 1999999 + slice,
                                   .kind = all_kinds[i],
                                   .port = "robot-1.A",
                                   .bytes = bytes,
                                   .size = i >= 1 && i <= 3 ? WH_TRANSCRIPT_BYTES : 0};
}

static void write_all(FILE *file, const uint8_t bytes[WH_TRANSCRIPT_BYTES], bool is_json) {
    const wh_transcript_head_t heads[] = {
        {"layout", "a \"b\" \\ c", 0}, {"port", "r x", 0}, {"port", "p", 0}};
    assert_non_null(file);
    assert_true((is_json ? wh_transcript_write_json_heads : wh_transcript_write_heads)(file, heads, 3));
    for (size_t i = 0; i < KINDS; ++i) {
        const wh_transcript_entry_t entry = entry_of(i, bytes);
        assert_true((is_json ? wh_transcript_write_json : wh_transcript_write)(file, &entry));
    }
    assert_int_equal(fclose(file), 0);
}

/* Every possible byte comes back, and so do entries in any number, in either form. */
static void check_round_trip(bool is_json) {
    char path[WH_TEST_PATH];
    uint8_t bytes[WH_TRANSCRIPT_BYTES];
    for (size_t i = 0; i < sizeof bytes; ++i) {
        bytes[i] = (uint8_t)(i * 7 + i / 256);
    }
    const int descriptor = mkstemp(wh_test_path(path, "transcript"));
    write_all(fdopen(descriptor, "wb"), bytes, is_json);
    assert_true(wh_transcript_open(&transcript, path));
    assert_int_equal(remove(path), 0);
    assert_int_equal(transcript.head_count, 3);
    assert_string_equal(transcript.heads[0].name, "layout");
    assert_string_equal(transcript.heads[0].text, "a \"b\" \\ c");
    assert_int_equal(transcript.heads[2].line, 4);
    assert_int_equal(transcript.count, KINDS);
    for (size_t i = 0; i < KINDS; ++i) {
        const wh_transcript_entry_t wanted = entry_of(i, bytes);
        const wh_transcript_entry_t *found = &transcript.entries[i];
        assert_int_equal(found->slice, wanted.slice);
        assert_int_equal(found->time_us, wanted.time_us);
        assert_int_equal(found->kind, wanted.kind);
        assert_string_equal(found->port, wanted.port);
        assert_int_equal(found->size, wanted.size);
        assert_memory_equal(found->bytes, bytes, found->size);
    }
    assert_int_equal(wh_transcript_last(&transcript), KINDS - 6);
    wh_transcript_close(&transcript);
}

static void round_trip(void **state) {
    (void)state;
    check_round_trip(false);
    check_round_trip(true);
}

static void written_lines(void **state) {
    (void)state;
    char text[500] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    wh_transcript_entry_t entry = {.slice = 12,
                                   .time_us = 12000,
                                   .kind = WH_TRANSCRIPT_SAID,
                                   .port = "robot",
                                   .bytes = (const uint8_t *)"\"\\\r\n\t\x01\xe9~",
                                   .size = 8};
    assert_true(wh_transcript_write(out, &entry));
    assert_true(wh_transcript_write_json(out, &entry));
    entry.kind = WH_TRANSCRIPT_WENT;
    assert_false(wh_transcript_write(out, &entry));
    entry.size = 0;
    assert_true(wh_transcript_write_json(out, &entry));
    const char *const bad_ports[] = {"", "a b", "a\n"};
    for (size_t i = 0; i < 3; ++i) {
        entry.port = bad_ports[i];
        assert_false(wh_transcript_write(out, &entry));
        assert_false(wh_transcript_write_json(out, &entry));
    }
    assert_false(wh_transcript_write_heads(out, &(wh_transcript_head_t){"A", "b", 0}, 1));
    assert_int_equal(fclose(out), 0);
    assert_string_equal(text,
                        "12 0.012000 > robot \"\\\"\\\\\\r\\n\\t\\x01\\xE9~\"\n"
                        "{\"slice\":12,\"time\":0.012000,\"kind\":\"said\",\"port\":\"robot\","
                        "\"bytes\":\"\\\"\\\\\\r\\n\\t\\u0001\\u00e9~\"}\n"
                        "{\"slice\":12,\"time\":0.012000,\"kind\":\"went\",\"port\":\"robot\"}\n" FIRST);
    assert_int_equal(wh_transcript_escape(text, 6, (const uint8_t *)"a\x01z", 3), 2);
    assert_string_equal(text, "a\\x01");
    assert_int_equal(wh_transcript_escape(text, 5, (const uint8_t *)"a\x01z", 3), 1);
}

static const char dialogue[] = FIRST "# a remark\n\n0 0.000000 + r\r\n5 0.005000 > r \"A\"\n"
                                     "6 0.006000 < r \"a\"\n6 0.006000 > r \"B\"\n9 0.009000 < r \"b\"";

static void hosts_side(void **state) {
    (void)state;
    assert_true(parse(dialogue));
    assert_int_equal(wh_transcript_due(&transcript), 0);
    assert_int_equal(wh_transcript_next(&transcript, 0)->kind, WH_TRANSCRIPT_CAME);
    assert_null(wh_transcript_next(&transcript, 4));
    assert_int_equal(wh_transcript_due(&transcript), 5);
    assert_memory_equal(wh_transcript_next(&transcript, 100)->bytes, "A", 1);
    assert_memory_equal(wh_transcript_next(&transcript, 100)->bytes, "B", 1);
    assert_null(wh_transcript_next(&transcript, 100));
    assert_true(wh_transcript_due(&transcript) == INT64_MAX);
    wh_transcript_close(&transcript);
}

static bool hears(int64_t slice, const char *port, const char *bytes) {
    return wh_transcript_compare(&transcript, &(wh_transcript_entry_t){.slice = slice,
                                                                       .time_us = 1000 * slice,
                                                                       .kind = WH_TRANSCRIPT_HEARD,
                                                                       .port = port,
                                                                       .bytes = (const uint8_t *)bytes,
                                                                       .size = strlen(bytes)});
}

static void differences(void **state) {
    (void)state;
    assert_true(parse(dialogue));
    assert_true(wh_transcript_compare(&transcript, &transcript.entries[1]));
    assert_false(hears(7, "r", "a"));
    assert_string_equal(transcript.message,
                        "a.txt:6: heard: 7 0.007000 < r \"a\" (expected 6 0.006000 < r \"a\")");
    assert_false(hears(6, "q", "a"));
    assert_false(hears(6, "r", "aa"));
    assert_false(hears(6, "r", "\r"));
    assert_string_equal(transcript.message,
                        "a.txt:6: heard: 6 0.006000 < r \"\\r\" (expected 6 0.006000 < r \"a\")");
    assert_true(hears(6, "r", "a"));
    assert_false(wh_transcript_compare_end(&transcript));
    assert_string_equal(transcript.message, "a.txt:8: heard: nothing (expected 9 0.009000 < r \"b\")");
    assert_true(hears(9, "r", "b"));
    assert_true(wh_transcript_compare_end(&transcript));
    assert_false(hears(10, "r", "c"));
    assert_string_equal(transcript.message, "a.txt: heard: 10 0.010000 < r \"c\" (expected nothing)");
    wh_transcript_close(&transcript);
}

/* A server that was killed has left all that was said, and no end: that is what is told. */
static void a_transcript_that_is_cut(void **state) {
    (void)state;
    for (int ended = 0; ended < 2; ++ended) {
        char text[200];
        (void)snprintf(text, sizeof text, FIRST "0 0.000000 > r \"A\"\n1 0.001000 < r \"b\"\n%s",
                       ended ? "1 0.001000 ! r\n" : "");
        assert_true(parse(text));
        while (wh_transcript_next(&transcript, 1)) {
        }
        assert_true(hears(1, "r", "b"));
        assert_false(hears(2, "r", "c"));
        assert_true((strstr(transcript.message, "(expected nothing: the transcript is cut") != NULL) ==
                    !ended);
        wh_transcript_close(&transcript);
    }
}

/* A difference far behind the beginning of a frame is shown, not cut off. */
static void a_difference_far_behind(void **state) {
    (void)state;
    char heard[1001];
    char text[1200];
    memset(heard, 'x', 1000);
    heard[1000] = '\0';
    (void)snprintf(text, sizeof text,
                   "waferhand transcript 1\nlayout \"a\"\nport \"r d\"\n\n0 0.000000 < r \"%s\"\n", heard);
    heard[900] = 'y';
    assert_true(parse(text));
    assert_false(hears(0, "r", heard));
    assert_non_null(strstr(transcript.message, "heard: 0 0.000000 < r \"...xxxx"));
    assert_non_null(strstr(transcript.message, "xyx"));
    wh_transcript_close(&transcript);
}

/* Entries behind an entry = wait for it, and it is compared. */
static void clock_set_back(void **state) {
    (void)state;
    assert_true(parse(FIRST "9 0.009000 > r \"A\"\n2 0.002000 = r\n3 0.003000 ~ r \"B\"\n3 0.003000 ! r\n"));
    assert_memory_equal(wh_transcript_next(&transcript, 9)->bytes, "A", 1);
    assert_false(hears(2, "r", ""));
    assert_string_equal(transcript.message, "a.txt:3: heard: 2 0.002000 < r \"\" (expected 2 0.002000 = r)");
    wh_transcript_entry_t clock = {.slice = 2, .time_us = 2000, .kind = WH_TRANSCRIPT_CLOCK, .port = "r"};
    assert_true(wh_transcript_compare(&transcript, &clock));
    assert_null(wh_transcript_next(&transcript, 2));
    assert_int_equal(wh_transcript_next(&transcript, 3)->kind, WH_TRANSCRIPT_TIMED_OUT);
    assert_int_equal(wh_transcript_next(&transcript, 3)->kind, WH_TRANSCRIPT_STOPPED);
    assert_false(wh_transcript_compare(&transcript, &clock));
    assert_string_equal(transcript.message, "a.txt: heard: 2 0.002000 = r (expected nothing)");
    wh_transcript_close(&transcript);
    assert_refused("5 0.005000 = r\n4 0.005000 ! r\n",
                   "a.txt:6: slice: 4 (expected digits, not less than in the entry before)");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_refusals),
        cmocka_unit_test(clock_set_back),
        cmocka_unit_test(refusals),
        cmocka_unit_test(round_trip),
        cmocka_unit_test(written_lines),
        cmocka_unit_test(hosts_side),
        cmocka_unit_test(differences),
        cmocka_unit_test(a_transcript_that_is_cut),
        cmocka_unit_test(a_difference_far_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
