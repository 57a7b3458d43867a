/* Ranges of a sweep: their values, the order in which they are combined, and the refusals. */
#include "study/sweep.h"

#include "support/support.h"

static wh_script_sweep_t sweep;

static int tear_down(void **state) {
    (void)state;
    wh_sweep_close(&sweep);
    return 0;
}

static bool open_sweep(const char *const parameters[], size_t count) {
    sweep = (wh_script_sweep_t){.parameters = parameters, .parameter_count = count};
    return wh_sweep_open(&sweep);
}

static void expect_refused(const char *parameter) {
    const char *parameters[] = {parameter};
    assert_false(open_sweep(parameters, 1));
    wh_sweep_close(&sweep);
}

static void expect_values(const char *parameter, const double values[], size_t count) {
    const char *parameters[] = {parameter};
    assert_true(open_sweep(parameters, 1));
    assert_int_equal(sweep.point_count, count);
    for (size_t i = 0; i < count; ++i) {
        assert_true(wh_sweep_value(&sweep, i, 0) == values[i]);
    }
    wh_sweep_close(&sweep);
}

static void ranges_have_their_values(void **state) {
    (void)state;
    expect_values("v=0:0.1:0.3", (const double[]){0, 0.1, 0.2, 0.3}, 4);
    expect_values("v=200:-50:90", (const double[]){200, 150, 100}, 3);
    expect_values("v=7:1:7", (const double[]){7}, 1);
    expect_values("v=-1e3:1e3:1.5e3", (const double[]){-1000, 0, 1000}, 3);
}

/* The last parameter varies first; one without colons stays as it is. */
static void ranges_are_combined(void **state) {
    (void)state;
    static const char *const parameters[] = {"a=1:1:2", "fixed=3", "b=10:10:30", "text=1:x", "c=5:1:6"};
    static const double a[] = {1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2};
    static const double b[] = {10, 10, 20, 20, 30, 30, 10, 10, 20, 20, 30, 30};
    assert_true(open_sweep(parameters, 5));
    assert_int_equal(sweep.axis_count, 3);
    assert_int_equal(sweep.point_count, 12);
    assert_string_equal(sweep.axes[1].name, "b");
    assert_true(sweep.axes[1].start == 10 && sweep.axes[1].step == 10 && sweep.axes[1].end == 30);
    for (size_t i = 0; i < 12; ++i) {
        assert_true(wh_sweep_value(&sweep, i, 0) == a[i]);
        assert_true(wh_sweep_value(&sweep, i, 1) == b[i]);
        assert_true(wh_sweep_value(&sweep, i, 2) == 5 + (double)(i % 2));
        assert_int_equal(sweep.points[i].verdict, WH_SWEEP_OK);
        assert_null(sweep.points[i].reason);
    }
}

static void what_is_no_range_is_refused(void **state) {
    (void)state;
    expect_refused("v=1");
    expect_refused("v");
    expect_refused("v=1:2");
    expect_refused("v=1:2:x");
    expect_refused("v=1:2:3:4");
    expect_refused("v=1:2:3 ");
    expect_refused("v=1::3");
    expect_refused("v=1:nan:3");
    expect_refused("v=1:inf:3");
    expect_refused("v=1:0:3");
    expect_refused("v=1:-1:3");
}

static void there_are_at_most_10000_runs_and_4_ranges(void **state) {
    (void)state;
    static const char *const most[] = {"a=1:1:100", "b=1:1:100"};
    static const char *const many[] = {"a=1:1:100", "b=1:1:101"};
    static const char *const ranges[] = {"a=1:1:1", "b=1:1:1", "c=1:1:1", "d=1:1:1", "e=1:1:1"};
    assert_true(open_sweep(most, 2));
    assert_int_equal(sweep.point_count, 10000);
    wh_sweep_close(&sweep);
    assert_false(open_sweep(many, 2));
    wh_sweep_close(&sweep);
    expect_refused("v=1:1:10001");
    assert_true(open_sweep(&most[1], 1));
    wh_sweep_close(&sweep);
    assert_true(open_sweep(ranges, 4));
    wh_sweep_close(&sweep);
    assert_false(open_sweep(ranges, 5));
}

static void values_are_texts_that_read_back(void **state) {
    (void)state;
    char text[WH_SWEEP_VALUE];
    wh_sweep_text(0.1 + 0.2, text);
    assert_string_equal(text, "0.3");
    wh_sweep_text(-0.0, text);
    assert_string_equal(text, "0");
    wh_sweep_text(-1234567.5, text);
    assert_string_equal(text, "-1234567.5");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_have_their_values),
        cmocka_unit_test_teardown(ranges_are_combined, tear_down),
        cmocka_unit_test(what_is_no_range_is_refused),
        cmocka_unit_test_teardown(there_are_at_most_10000_runs_and_4_ranges, tear_down),
        cmocka_unit_test(values_are_texts_that_read_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
