/* The results of many scripts, word for word: lines, the sum, TAP, and JUnit's XML. */
#include "print/tests_print.h"

#include <locale.h>

#include "support/support.h"

static char reasons[3][80] = {"b.lua: line 7: <missed> & \"lost\"", "12", "a layout"};
static char outputs[3][40] = {"first\n\nthird\x1b", "told\n", "\x01|\xff|\xef\xbf\xbf|\tx"};

static const wh_test_result_t results[] = {
    {.path = "a #1.lua", .verdict = WH_TEST_OK, .expectations = 1, .simulated_s = 8.2829, .wall_s = 0.25},
    {.path = "b.lua",
     .verdict = WH_TEST_FAILED,
     .reason = reasons[0],
     .output = outputs[0],
     .errors = 3,
     .wall_s = 0.5},
    {.path = "c.lua",
     .verdict = WH_TEST_OK,
     .expectations = 2,
     .errors = 1,
     .output = outputs[1],
     .wall_s = 1},
    {.path = "d.lua", .verdict = WH_TEST_BAD, .reason = reasons[1], .output = outputs[2]},
    {.path = "e.lua", .verdict = WH_TEST_ENDLESS, .reason = reasons[1], .wall_s = 2},
    {.path = "f.lua", .verdict = WH_TEST_KILLED, .reason = reasons[1]},
    {.path = "g.lua", .verdict = WH_TEST_PASSED_OVER, .reason = reasons[2]},
    {.path = "h.lua", .verdict = WH_TEST_OK, .errors = 2},
};
enum { RESULTS = sizeof results / sizeof results[0] };

static const wh_style_t piped = {false, true, 0};
static const wh_style_t coloured = {true, true, 0};

typedef struct {
    FILE *out;
    char *text;
    size_t size;
} paper_t;

static FILE *take_paper(paper_t *paper) {
    paper->out = open_memstream(&paper->text, &paper->size);
    assert_non_null(paper->out);
    return paper->out;
}

static void expect_written(paper_t *paper, const char *wanted) {
    assert_int_equal(fclose(paper->out), 0);
    assert_string_equal(paper->text, wanted);
    free(paper->text);
}

static void lines_for_people(void **state) {
    (void)state;
    paper_t paper;
    FILE *out = take_paper(&paper);
    for (size_t i = 0; i < RESULTS; ++i) {
        wh_test_print(&results[i], out, &piped);
    }
    expect_written(&paper, "ok           a #1.lua: 1 expectation, 8.283 s simulated\n"
                           "failed       b.lua: line 7: <missed> & \"lost\"\n"
                           "    first\n"
                           "    \n"
                           "    third\\x1b\n"
                           "ok           c.lua: 2 expectations, nothing moved, 1 error caught\n"
                           "bad          d.lua: 12\n"
                           "    \\x01|\\xff|\\xef\\xbf\\xbf|\\x09x\n"
                           "no end       e.lua: 12\n"
                           "killed       f.lua: 12\n"
                           "passed over  g.lua: a layout\n"
                           "ok           h.lua: 0 expectations, nothing moved, 2 errors caught\n");
}

static void verdicts_have_their_inks(void **state) {
    (void)state;
    paper_t paper;
    FILE *out = take_paper(&paper);
    wh_test_print(&results[2], out, &coloured);
    wh_test_print(&results[4], out, &coloured);
    wh_test_print(&results[6], out, &coloured);
    wh_test_print_sum(results, 1, out, &coloured);
    wh_test_print_sum(results, 2, out, &coloured);
    expect_written(&paper,
                   "\033[32mok         \033[0m  c.lua: 2 expectations, nothing moved, 1 error caught\n"
                   "\033[31mno end     \033[0m  e.lua: 12\n"
                   "\033[33mpassed over\033[0m  g.lua: a layout\n"
                   "1 script: \033[32m1 ok\033[0m\n"
                   "2 scripts: \033[31m1 ok\033[0m, 1 failed\n");
}

static void sums_count_each_verdict(void **state) {
    (void)state;
    paper_t paper;
    FILE *out = take_paper(&paper);
    wh_test_print_sum(results, RESULTS, out, &piped);
    wh_test_print_sum(&results[6], 1, out, &piped);
    const wh_test_result_t over[] = {results[6], results[0], results[6]};
    wh_test_print_sum(over, 3, out, &piped);
    wh_test_print_sum(results, 0, out, &coloured);
    expect_written(&paper, "7 scripts: 3 ok, 1 failed, 1 bad, 1 no end, 1 killed; 1 file passed over\n"
                           "0 scripts: 0 ok; 1 file passed over\n"
                           "1 script: 1 ok; 2 files passed over\n"
                           "0 scripts: \033[31m0 ok\033[0m\n");
}

static void the_same_as_tap(void **state) {
    (void)state;
    paper_t paper;
    FILE *out = take_paper(&paper);
    for (size_t i = 0; i < 4; ++i) {
        wh_test_print_tap(&results[i], i + 1, out);
    }
    wh_test_print_tap(&results[6], 0, out);
    wh_test_print_plan(NULL, 0, 4, out);
    wh_test_print_plan(NULL, 0, 0, out);
    expect_written(&paper, "ok 1 - a \\#1.lua\n"
                           "not ok 2 - b.lua\n"
                           "# failed: line 7: <missed> & \"lost\"\n"
                           "#   first\n"
                           "#   \n"
                           "#   third\\x1b\n"
                           "ok 3 - c.lua\n"
                           "# 1 error caught\n"
                           "not ok 4 - d.lua\n"
                           "# bad: 12\n"
                           "#   \\x01|\\xff|\\xef\\xbf\\xbf|\\x09x\n"
                           "# passed over: g.lua: a layout\n"
                           "1..4\n"
                           "1..0 # no scripts found\n");
}

static void the_same_as_xml(void **state) {
    (void)state;
    paper_t paper;
    assert_true(wh_test_print_junit(results, RESULTS, take_paper(&paper)));
    expect_written(
        &paper, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                "<testsuites>\n"
                "  <testsuite name=\"waferhand\" tests=\"8\" failures=\"1\" errors=\"3\" skipped=\"1\" "
                "time=\"3.750\">\n"
                "    <testcase classname=\"waferhand\" name=\"a #1.lua\" time=\"0.250\">\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"b.lua\" time=\"0.500\">\n"
                "      <failure message=\"line 7: &lt;missed&gt; &amp; &quot;lost&quot;\" type=\"failed\"/>\n"
                "      <system-out>first&#10;&#10;third\xef\xbf\xbd</system-out>\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"c.lua\" time=\"1.000\">\n"
                "      <system-out>1 error caught\ntold&#10;</system-out>\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"d.lua\" time=\"0.000\">\n"
                "      <error message=\"12\" type=\"bad\"/>\n"
                "      <system-out>\xef\xbf\xbd|\xef\xbf\xbd|\xef\xbf\xbd|&#9;x</system-out>\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"e.lua\" time=\"2.000\">\n"
                "      <error message=\"12\" type=\"no end\"/>\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"f.lua\" time=\"0.000\">\n"
                "      <error message=\"12\" type=\"killed\"/>\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"g.lua\" time=\"0.000\">\n"
                "      <skipped message=\"a layout\"/>\n"
                "    </testcase>\n"
                "    <testcase classname=\"waferhand\" name=\"h.lua\" time=\"0.000\">\n"
                "      <system-out>2 errors caught\n</system-out>\n"
                "    </testcase>\n"
                "  </testsuite>\n"
                "</testsuites>\n");
    FILE *full = fopen("/dev/full", "w");
    assert_non_null(full);
    assert_false(wh_test_print_junit(results, RESULTS, full));
    (void)fclose(full);
}

/* A reason that begins with another path keeps it. */
static void only_the_own_path_is_left_out(void **state) {
    (void)state;
    paper_t paper;
    char other[] = "b.lua.txt: lost", alone[] = "b.lua";
    FILE *out = take_paper(&paper);
    wh_test_print(&(wh_test_result_t){.path = "b.lua", .verdict = WH_TEST_BAD, .reason = other}, out, &piped);
    wh_test_print(&(wh_test_result_t){.path = "b.lua", .verdict = WH_TEST_BAD, .reason = alone}, out, &piped);
    expect_written(&paper, "bad          b.lua: b.lua.txt: lost\nbad          b.lua: b.lua\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_for_people),        cmocka_unit_test(verdicts_have_their_inks),
        cmocka_unit_test(sums_count_each_verdict), cmocka_unit_test(the_same_as_tap),
        cmocka_unit_test(the_same_as_xml),         cmocka_unit_test(only_the_own_path_is_left_out),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
