/* The grammar of outputs.txt, against a second reading of it, and random contents against the whole reader.
 */
#include "link/outputs.h"
#include "support/outputs.h"
#include "support/support.h"

#define ROUNDS 10000

static wh_outputs_look_t parse(const char *text, size_t count, int32_t *valves) {
    return wh_outputs_parse(text, strlen(text), count, valves);
}

static void assert_good(const char *text, const char *valves) {
    int32_t values[WH_GRIPPERS];
    assert_int_equal(parse(text, strlen(valves), values).finding, WH_OUTPUTS_GOOD);
    for (size_t i = 0; valves[i] != '\0'; ++i) {
        assert_int_equal(values[i], valves[i] - '0');
    }
}

static void good_files(void **state) {
    (void)state;
    assert_good("0", "0");
    assert_good("1\n", "1");
    assert_good("0 1", "01");
    assert_good("0\n1\n", "01");
    assert_good("\r\n\t 1 \t\r\n0\r\n\r\n", "10");
    assert_good("0 1 1 0 1 0 0 1\n", "01101001");
}

static void assert_bad(const char *text, size_t count, wh_outputs_finding_t finding, size_t found) {
    int32_t values[WH_GRIPPERS] = {7, 7, 7, 7, 7, 7, 7, 7};
    const wh_outputs_look_t look = parse(text, count, values);
    assert_int_equal(look.finding, finding);
    assert_int_equal(look.found, found);
    for (size_t i = 0; i < WH_GRIPPERS; ++i) {
        assert_int_equal(values[i], 7);
    }
}

static void bad_files(void **state) {
    (void)state;
    static const char *const words[] = {
        "2",  "00",  "10", "-0", "+1", "0.", "0x0", "true", "O", "0,", "0;", "\"0\"", "\357\273\2770",
        "\v", "0\f", "#",  "1e0"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        char text[64];
        assert_bad(words[i], 1, WH_OUTPUTS_GARBLED, 0);
        snprintf(text, sizeof text, "0 1\n%s 1", words[i]);
        assert_bad(text, 2, WH_OUTPUTS_GARBLED, 2);
        assert_bad(text, 3, WH_OUTPUTS_GARBLED, 2);
        assert_bad(text, 8, WH_OUTPUTS_GARBLED, 2);
    }
    assert_bad("", 1, WH_OUTPUTS_EMPTY, 0);
    assert_bad("\n\n", 1, WH_OUTPUTS_EMPTY, 0);
    assert_bad("0", 2, WH_OUTPUTS_SHORT, 1);
    assert_bad("0 0 0 0 0 0 0", 8, WH_OUTPUTS_SHORT, 7);
    assert_bad("0 0", 1, WH_OUTPUTS_LONG, 2);
    assert_bad("0 0 0 0 0 0 0 0 0", 8, WH_OUTPUTS_LONG, 9);
    assert_bad("0 1", 0, WH_OUTPUTS_GARBLED, 0);
    assert_bad("0 1 0 1 0 1 0 1 0", WH_GRIPPERS + 1, WH_OUTPUTS_GARBLED, 0);
}

static void a_zero_byte_is_no_end(void **state) {
    (void)state;
    int32_t values[2] = {7, 7};
    assert_int_equal(wh_outputs_parse("0 1\0", 4, 2, values).finding, WH_OUTPUTS_GARBLED);
    assert_int_equal(wh_outputs_parse("0\0001", 3, 2, values).finding, WH_OUTPUTS_GARBLED);
    assert_int_equal(values[0], 7);
}

/* Why a missing line feed is no sign of a torn read. */
static void the_beginning_of_a_good_file_says_the_same_or_is_short(void **state) {
    (void)state;
    static const char text[] = " 1\r\n0\t\n1 \n\n";
    for (size_t size = 0; size < sizeof text; ++size) {
        int32_t values[3];
        const wh_outputs_finding_t finding = wh_outputs_parse(text, size, 3, values).finding;
        if (finding == WH_OUTPUTS_GOOD) {
            assert_true(values[0] == 1 && values[1] == 0 && values[2] == 1);
        } else {
            assert_true(finding == WH_OUTPUTS_EMPTY || finding == WH_OUTPUTS_SHORT);
        }
    }
}

/* The grammar once more, by strtok: the text has no zero byte. */
static bool is_good_by_strtok(const char *text, size_t count, int32_t *values) {
    char copy[WH_OUTPUTS_BYTES + 1];
    size_t found = 0;
    snprintf(copy, sizeof copy, "%s", text);
    for (const char *word = strtok(copy, " \t\r\n"); word != NULL; word = strtok(NULL, " \t\r\n")) {
        if ((strcmp(word, "0") != 0 && strcmp(word, "1") != 0) || found == count) {
            return false;
        }
        values[found++] = *word - '0';
    }
    return found == count;
}

/* Random files, nearly good as often as wild; no zero bytes. */
static size_t random_text(char *text, size_t most) {
    static const char usual[] = "01 \n\t\r01 \n2";
    const bool wild = wh_test_below(4) == 0;
    const size_t size = wh_test_below(wild ? (uint32_t)most : 8);
    for (size_t i = 0; i < size; ++i) {
        const uint32_t chance = wh_test_below(40);
        text[i] = usual[wh_test_below(wild || chance == 0 ? 11 : 10)];
        if (wild && chance < 20) {
            text[i] = (char)(1 + wh_test_below(255));
        }
    }
    text[size] = '\0';
    return size;
}

static void random_files_change_nothing_unless_they_are_good(void **state) {
    (void)state;
    (void)wh_test_seed();
    outputs_fixture_t f;
    outputs_begin(&f);
    int32_t wanted[2] = {0, 1};
    unsigned good = 0;
    for (int i = 0; i < ROUNDS; ++i) {
        char text[WH_OUTPUTS_BYTES];
        int32_t values[2];
        outputs_put_bytes(f.path, text, random_text(text, 300));
        if (is_good_by_strtok(text, 2, values)) {
            memcpy(wanted, values, sizeof wanted);
            ++good;
        }
        f.now_us += wh_test_below(WH_OUTPUTS_SETTLE_US * 2);
        (void)outputs_update(&f);
        assert_memory_equal(f.reader.valves, wanted, sizeof wanted);
    }
    assert_true(good > ROUNDS / 100);
    assert_int_equal(f.reader.counters.looks[WH_OUTPUTS_GOOD], good + 1);
    assert_int_equal(outputs_looks(&f.reader), ROUNDS + 1);
    outputs_teardown(&f);
}

/* Everything at the path that can be, in any order: the finding in force is the one that a person sees. */
static void random_things_at_the_path(void **state) {
    (void)state;
    (void)wh_test_seed();
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 2000; ++i) {
        static const char *const texts[] = {"", "1", "1 1 1", "x", "0 1", "1 0"};
        static const wh_outputs_finding_t findings[] = {
            WH_OUTPUTS_EMPTY, WH_OUTPUTS_SHORT,   WH_OUTPUTS_LONG,    WH_OUTPUTS_GARBLED,   WH_OUTPUTS_GOOD,
            WH_OUTPUTS_GOOD,  WH_OUTPUTS_NO_FILE, WH_OUTPUTS_MISSING, WH_OUTPUTS_UNREADABLE};
        const uint32_t what = wh_test_below(9);
        (void)remove(f.path);
        if (what < 6) {
            outputs_put(f.path, texts[what]);
        } else if (what == 6) {
            assert_int_equal(mkdir(f.path, 0777), 0);
        } else if (what == 8) {
            assert_int_equal(symlink("outputs.txt", f.path), 0);
        }
        (void)outputs_pass(&f, WH_OUTPUTS_POLL_US + WH_OUTPUTS_SETTLE_US);
        assert_int_equal(f.reader.finding, findings[what]);
    }
    outputs_teardown(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_files),
        cmocka_unit_test(bad_files),
        cmocka_unit_test(a_zero_byte_is_no_end),
        cmocka_unit_test(the_beginning_of_a_good_file_says_the_same_or_is_short),
        cmocka_unit_test(random_files_change_nothing_unless_they_are_good),
        cmocka_unit_test(random_things_at_the_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
