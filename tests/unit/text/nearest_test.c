/* The name that somebody may have meant: compared with counting slips by trying all of them. */
#include "text/nearest.h"

#include <stdbool.h>

#include "support/support.h"

#define ALPHABET "abC"

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

static bool is_same(char a, char b) {
    return (a | 0x20) == (b | 0x20);
}

/* The fewest slips from one text to the other, letter by letter from the front: the header's
 * definition, computed slowly. */
static size_t count_slips(const char *from, const char *to) {
    if (*from == '\0' || *to == '\0') {
        return strlen(from) + strlen(to);
    }
    size_t count = count_slips(from + 1, to + 1) + (is_same(*from, *to) ? 0 : 1);
    count = least(count, 1 + count_slips(from + 1, to));
    count = least(count, 1 + count_slips(from, to + 1));
    if (from[1] != '\0' && to[1] != '\0' && is_same(from[0], to[1]) && is_same(from[1], to[0])) {
        count = least(count, 1 + count_slips(from + 2, to + 2));
    }
    return count;
}

static const char *find_nearest(const char *word, const char *const names[], size_t count) {
    const char *nearest = NULL;
    size_t fewest = SIZE_MAX;
    for (size_t i = 0; i < count; ++i) {
        const size_t longer = strlen(word) > strlen(names[i]) ? strlen(word) : strlen(names[i]);
        const size_t slips = count_slips(word, names[i]);
        const size_t most = longer < 3 ? 1 : longer / 3;
        if (slips <= most && (slips < longer || slips == 0) && slips < fewest) {
            nearest = names[i];
            fewest = slips;
        }
    }
    return nearest;
}

enum { NAMES = 4, LONGEST = 7 };

static void make_word(char word[LONGEST + 1]) {
    const size_t length = wh_test_below(LONGEST + 1);
    for (size_t i = 0; i < length; ++i) {
        word[i] = ALPHABET[wh_test_below(3)];
    }
    word[length] = '\0';
}

static void the_nearest_is_what_trying_all_slips_finds(void **state) {
    (void)state;
    size_t near = 0;
    enum { ROUNDS = 3000 };
    for (int round = 0; round < ROUNDS; ++round) {
        char word[LONGEST + 1], texts[NAMES][LONGEST + 1];
        const char *names[NAMES];
        make_word(word);
        for (size_t i = 0; i < NAMES; ++i) {
            make_word(texts[i]);
            names[i] = texts[i];
        }
        const char *wanted = find_nearest(word, names, NAMES);
        assert_ptr_equal(wh_text_nearest(word, names, NAMES), wanted);
        near += wanted ? 1 : 0;
    }
    assert_in_range(near, ROUNDS / 10, ROUNDS - ROUNDS / 10);
}

static void expect_nearest(const char *word, const char *name, bool is_near) {
    assert_ptr_equal(wh_text_nearest(word, &name, 1), is_near ? name : NULL);
}

static void words_have_their_longest(void **state) {
    (void)state;
    char word[WH_NEAREST_BYTES + 2], name[WH_NEAREST_BYTES + 2];
    memset(word, 'a', sizeof word);
    memset(name, 'a', sizeof name);
    word[WH_NEAREST_BYTES + 1] = name[WH_NEAREST_BYTES + 1] = '\0';
    expect_nearest(word, name, false);
    expect_nearest(word, name + 1, false);
    expect_nearest(word + 1, name, false);
    expect_nearest(word + 1, name + 1, true);
    /* 21 slips for 63 bytes, not 22. */
    memset(name + 1, 'b', 21);
    expect_nearest(word + 1, name + 1, true);
    name[22] = 'b';
    expect_nearest(word + 1, name + 1, false);
}

static void nothing_is_near_to_nothing(void **state) {
    (void)state;
    static const char *const names[] = {"b", "a"};
    assert_null(wh_text_nearest("", names, 2));
    assert_null(wh_text_nearest("x", names, 2));
    assert_null(wh_text_nearest("a", names, 0));
}

static void the_question_is_asked_where_something_is_near(void **state) {
    (void)state;
    char text[WH_NEAREST_TEXT], name[WH_NEAREST_BYTES + 1];
    assert_ptr_equal(wh_text_did_you_mean(text, "; ", "--", "run"), text);
    assert_string_equal(text, "; did you mean --run?");
    assert_string_equal(wh_text_did_you_mean(text, "; ", "--", NULL), "");
    memset(name, 'a', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(strlen(wh_text_did_you_mean(text, "; ", "--", name)),
                     strlen("; did you mean --?") + WH_NEAREST_BYTES);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_is_what_trying_all_slips_finds),
        cmocka_unit_test(words_have_their_longest),
        cmocka_unit_test(nothing_is_near_to_nothing),
        cmocka_unit_test(the_question_is_asked_where_something_is_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
