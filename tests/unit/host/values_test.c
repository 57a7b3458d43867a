/* The prompt's answers taken apart, names as an operator types them, and the words that dialects use. */
#include "host/values.h"

#include <lauxlib.h>

#include "host/words.h"
#include "support/support.h"

/* The value of a name in an answer, as a text; nil: none. */
static void expect_field(const char *answer, const char *name, const char *wanted) {
    lua_State *L = luaL_newstate();
    wh_push_values(L, answer);
    lua_getfield(L, -1, name);
    assert_string_equal(luaL_tolstring(L, -1, NULL), wanted);
    lua_close(L);
}

static void numbers_texts_and_nobody_come_as_such(void **state) {
    (void)state;
    const char *answer = "OK wafer=\"Wafer \\\"1\\\"\" seconds=1.965 holder=none put=\"none\" "
                         "codes=0100000001 left=3; B=7 \"no pair\" x=-2e-3";
    expect_field(answer, "wafer", "Wafer \"1\"");
    expect_field(answer, "seconds", "1.965");
    expect_field(answer, "holder", "nil");
    expect_field(answer, "put", "none");
    expect_field(answer, "codes", "0100000001");
    expect_field(answer, "left", "3");
    expect_field(answer, "B", "7");
    expect_field(answer, "x", "-0.002");
    expect_field("OK \"EE 1\".holds=W1 r=3", "\"EE 1\".holds", "W1");
    expect_field("OK \"EE=1\".r=2 r=3", "r", "3");
    expect_field("OK", "seconds", "nil");
    expect_field("", "seconds", "nil");
}

static void a_value_is_found_by_its_whole_name(void **state) {
    (void)state;
    char text[8];
    wh_value_copy("phase=running command=\"WAIT seconds=3\" seconds=12 r=300", "seconds", text, sizeof text);
    assert_string_equal(text, "12");
    wh_value_copy("phase=running", "phas", text, sizeof text);
    assert_string_equal(text, "");
    wh_value_copy("phase=running", "phase", text, sizeof text);
    assert_string_equal(text, "running");
    assert_string_equal(wh_value_begin("r=300 z=900", "z"), "900");
}

static void expect_spelt(const char *name, const char *wanted) {
    char text[40];
    assert_true(wh_value_spell(name, text, sizeof text));
    assert_string_equal(text, wanted);
}

static void names_are_spelt_as_they_are_typed(void **state) {
    (void)state;
    char small[6] = "";
    expect_spelt("A", "A");
    expect_spelt("LP_1/x.y-z", "LP_1/x.y-z");
    expect_spelt("None", "\"None\"");
    expect_spelt("Wafer 1", "\"Wafer 1\"");
    expect_spelt("a\"b\\", "\"a\\\"b\\\\\"");
    /* Room for quotes, the end, and a backslash before each character. */
    assert_true(wh_value_spell("\"", small, 5));
    assert_string_equal(small, "\"\\\"\"");
    assert_false(wh_value_spell("\"", small, 4));
    assert_false(wh_value_spell("Wafer 1", small, sizeof small));
    assert_false(wh_value_spell("Prealigner", small, sizeof small));
}

static void words_are_found(void **state) {
    (void)state;
    assert_string_equal(wh_word_of("get A 1")->name, "GET");
    assert_string_equal(wh_word_of("\tSTATUS")->name, "STATUS");
    assert_null(wh_word_of("GETA 1"));
    assert_null(wh_word_of(""));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_texts_and_nobody_come_as_such),
        cmocka_unit_test(a_value_is_found_by_its_whole_name),
        cmocka_unit_test(names_are_spelt_as_they_are_typed),
        cmocka_unit_test(words_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
