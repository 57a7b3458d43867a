/* Options that a table binds to variables: each kind, defaults, shared tables.
 * tests/end_to_end/bad_input tests the refusals. The test covers the arrays of their lists, too:
 * without memory the program ends. It also covers the name that is nearest to a wrong word. */
#include "support/support.h"

#include <sys/wait.h>
#include <unistd.h>

#include "text/array.h"
#include "text/nearest.h"
#include "text/options.h"

typedef struct {
    const char *state;
    wh_option_list_t set;
} shared_t;

typedef struct {
    const char *script;
    bool json, trust;
    double rate;
    uint64_t trials, seed;
    shared_t shared;
} arguments_t;

static const wh_option_t options[] = {
    {"json", 'j', NULL, "Print JSON", WH_OPTION_FLAG, .variable = offsetof(arguments_t, json)},
    {"trust", 0, NULL, "Trust it", WH_OPTION_FLAG, .variable = offsetof(arguments_t, trust)},
    {"rate", 0, "FACTOR", "How fast", WH_OPTION_REAL, .variable = offsetof(arguments_t, rate), 1e-3, 1e3},
    {"trials", 0, "N", "How many", WH_OPTION_WHOLE, .variable = offsetof(arguments_t, trials), 1, 1e9},
    {"seed", 0, "S", "Which", WH_OPTION_COUNT, .variable = offsetof(arguments_t, seed), .least = 2},
    {0}};

static const wh_option_t others[] = {
    {"state", 0, "FILE", "Where", WH_OPTION_TEXT, .variable = offsetof(shared_t, state)},
    {"set", 0, "NAME=VALUE", "A parameter", WH_OPTION_LIST, .variable = offsetof(shared_t, set)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL}, {others, offsetof(arguments_t, shared), "Of others:", NULL}, {0}};

static const wh_command_line_t command_line = {.name = "test",
                                               .synopsis = "SCRIPT",
                                               .about = "Tests.",
                                               .tables = tables,
                                               .operand = "script",
                                               .operand_variable = offsetof(arguments_t, script)};

static arguments_t parse(const char *words[], int count) {
    arguments_t arguments = {.rate = 1, .trials = 1000};
    char *argv[20] = {NULL};
    for (int i = 0; i < count; ++i) {
        argv[i + 1] = (char *)(uintptr_t)words[i];
    }
    wh_options_parse(&command_line, count + 1, argv, &arguments);
    return arguments;
}

static void what_is_not_given_stays(void **state) {
    const char *words[] = {"a.lua"};
    (void)state;
    const arguments_t arguments = parse(words, 1);
    assert_string_equal(arguments.script, "a.lua");
    assert_false(arguments.json || arguments.trust);
    assert_true(arguments.rate == 1 && arguments.trials == 1000 && arguments.seed == 0);
    assert_null(arguments.shared.state);
    assert_int_equal(arguments.shared.set.count, 0);
}

static void each_kind_is_taken(void **state) {
    const char *words[] = {"-j",    "--rate=2.5", "--trials", "1e6",   "--seed",  "18446744073709551615",
                           "a.lua", "--state",    "x",        "--set", "one=two", "--set=three"};
    (void)state;
    arguments_t arguments = parse(words, 12);
    assert_true(arguments.json && !arguments.trust);
    assert_true(arguments.rate == 2.5 && arguments.trials == 1000000 && arguments.seed == UINT64_MAX);
    assert_string_equal(arguments.shared.state, "x");
    assert_int_equal(arguments.shared.set.count, 2);
    assert_string_equal(arguments.shared.set.items[0], "one=two");
    assert_string_equal(arguments.shared.set.items[1], "three");
    wh_option_list_free(&arguments.shared.set);
    assert_int_equal(arguments.shared.set.count, 0);
}

static void without_memory_the_program_ends(void **state) {
    int ends[2];
    int status = 0;
    char said[100] = "";
    (void)state;
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        (void)dup2(ends[1], STDERR_FILENO);
        (void)wh_memory_need(NULL);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 2);
    assert_true(read(ends[0], said, sizeof said - 1) > 0);
    assert_string_equal(said, "waferhand: out of memory\n");
    (void)close(ends[0]);
    (void)close(ends[1]);
}

static void assert_refused(const char *option, const char *text, const char *expected) {
    const char *words[] = {"a.lua", option, text};
    int ends[2];
    int status = 0;
    char said[500] = "";
    char wanted[300];
    (void)snprintf(wanted, sizeof wanted, "test: %s: %s (expected %s)\n", option, text[0] ? text : "nothing",
                   expected);
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        (void)dup2(ends[1], STDERR_FILENO);
        (void)parse(words, 3);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) != 0);
    assert_true(read(ends[0], said, sizeof said - 1) > 0);
    if (!strstr(said, wanted)) {
        fail_msg("%s%s", said, wanted);
    }
    (void)close(ends[0]);
    (void)close(ends[1]);
}

static void numbers_out_of_range_are_refused(void **state) {
    (void)state;
    assert_refused("--rate", "1001", "a number from 0.001 to 1000");
    assert_refused("--rate", "0.0009", "a number from 0.001 to 1000");
    assert_refused("--rate", "nan", "a number from 0.001 to 1000");
    assert_refused("--rate", "2x", "a number from 0.001 to 1000");
    assert_refused("--trials", "1.5", "a whole number from 1 to 1000000000");
    assert_refused("--trials", "0", "a whole number from 1 to 1000000000");
    assert_refused("--seed", "1", "a whole number from 2 to 18446744073709551615");
    assert_refused("--seed", "18446744073709551616", "a whole number from 2 to 18446744073709551615");
    assert_refused("--seed", "", "a whole number from 2 to 18446744073709551615");
    assert_refused("--state", "", "FILE");
}

static void assert_nearest(const char *word, const char *expected) {
    static const char *const names[] = {"collision", "look_ahead", "settle", "seat",
                                        "slice",     "true",       "dx",     "dy"};
    const char *const nearest = wh_text_nearest(word, names, sizeof names / sizeof *names);
    if (!expected) {
        assert_null(nearest);
        return;
    }
    assert_non_null(nearest);
    assert_string_equal(nearest, expected);
}

static void one_slip_of_the_keyboard_is_near(void **state) {
    static const char *const names[] = {"valve", "rotate", "expect_offset"};
    (void)state;
    for (size_t n = 0; n < 3; ++n) {
        const size_t length = strlen(names[n]);
        for (size_t i = 0; i < length; ++i) {
            char left_out[20] = "", put_in[20] = "", replaced[20] = "", swapped[20] = "";
            (void)sprintf(left_out, "%.*s%s", (int)i, names[n], names[n] + i + 1);
            (void)sprintf(put_in, "%.*sq%s", (int)i, names[n], names[n] + i);
            (void)sprintf(replaced, "%.*sq%s", (int)i, names[n], names[n] + i + 1);
            strcpy(swapped, names[n]);
            swapped[i] = names[n][i + 1 < length ? i + 1 : i];
            swapped[i + 1 < length ? i + 1 : i] = names[n][i];
            assert_ptr_equal(wh_text_nearest(left_out, names, 3), names[n]);
            assert_ptr_equal(wh_text_nearest(put_in, names, 3), names[n]);
            assert_ptr_equal(wh_text_nearest(replaced, names, 3), names[n]);
            assert_ptr_equal(wh_text_nearest(swapped, names, 3), names[n]);
        }
    }
}

static void longer_words_may_have_more_slips(void **state) {
    (void)state;
    assert_nearest("True", "true");
    assert_nearest("colision", "collision");
    assert_nearest("clolisoin", "collision");
    assert_nearest("colour", NULL);
    assert_nearest("lookahead", "look_ahead");
    assert_nearest("set", "seat");
    assert_nearest("sett", "seat");
    assert_nearest("dz", "dx");
    assert_nearest("z", NULL);
    assert_nearest("qq", NULL);
    assert_nearest("", NULL);
    assert_nearest("wafer", NULL);
    assert_null(wh_text_nearest("dx", NULL, 0));
}

static void words_without_end_are_near_to_nothing(void **state) {
    char long_name[WH_NEAREST_BYTES + 2], longest[WH_NEAREST_BYTES + 1], word[WH_NEAREST_BYTES + 1];
    const char *const names[] = {long_name, longest};
    (void)state;
    memset(long_name, 'a', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = '\0';
    strcpy(longest, long_name + 1);
    strcpy(word, longest);
    word[5] = 'b';
    assert_ptr_equal(wh_text_nearest(word, names, 2), longest);
    assert_null(wh_text_nearest(long_name, names, 2));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_not_given_stays),
                                       cmocka_unit_test(each_kind_is_taken),
                                       cmocka_unit_test(one_slip_of_the_keyboard_is_near),
                                       cmocka_unit_test(longer_words_may_have_more_slips),
                                       cmocka_unit_test(words_without_end_are_near_to_nothing),
                                       cmocka_unit_test(without_memory_the_program_ends),
                                       cmocka_unit_test(numbers_out_of_range_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
