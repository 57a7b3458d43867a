/* Options that a table binds to variables: each kind, defaults, shared tables. Refusals are tests/end_to_end/bad_input's.
 * And the arrays that their lists are: without memory the program ends. */
#include "support/support.h"

#include <sys/wait.h>
#include <unistd.h>

#include "text/array.h"
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
    {"rate", 0, "FACTOR", "How fast", WH_OPTION_REAL, .variable = offsetof(arguments_t, rate), 1e-3, 1e3,
     "a number"},
    {"trials", 0, "N", "How many", WH_OPTION_WHOLE, .variable = offsetof(arguments_t, trials), 1, 1e9,
     "a number"},
    {"seed", 0, "S", "Which", WH_OPTION_COUNT, .variable = offsetof(arguments_t, seed),
     .expected = "a whole number"},
    {0}};

static const wh_option_t others[] = {
    {"state", 0, "FILE", "Where", WH_OPTION_TEXT, .variable = offsetof(shared_t, state)},
    {"set", 0, "NAME=VALUE", "A parameter", WH_OPTION_LIST, .variable = offsetof(shared_t, set)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL}, {others, offsetof(arguments_t, shared), "Of others:"}, {0}};

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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_not_given_stays),
                                       cmocka_unit_test(each_kind_is_taken),
                                       cmocka_unit_test(without_memory_the_program_ends)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
