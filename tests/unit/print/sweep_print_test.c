/* A sweep's table and JSON, word for word. */
#include "print/sweep_print.h"

#include <locale.h>

#include "support/support.h"

enum { POINTS = 6 };

static const wh_style_t piped = {false, true, 0};
static const wh_style_t coloured = {true, true, 0};

static char names[2][8] = {"v", "gap"};
static char reasons[2][24] = {"line 3 missed", "v: too fast"};
static wh_sweep_axis_t axes[2];
static wh_sweep_point_t points[POINTS];
static wh_script_sweep_t sweep;
static char *text;

/* v = 100 and 150, gap = 1, 3 and 5 of 1:2:6. */
static int set_up(void **state) {
    (void)state;
    const wh_sweep_point_t none = {.simulated_s = (double)INFINITY,
                                   .wafers_per_hour = (double)INFINITY,
                                   .projz = (double)INFINITY,
                                   .projxy = (double)INFINITY,
                                   .gap = (double)INFINITY};
    axes[0] = (wh_sweep_axis_t){names[0], 100, 50, 150, 2};
    axes[1] = (wh_sweep_axis_t){names[1], 1, 2, 6, 3};
    for (size_t i = 0; i < POINTS; ++i) {
        points[i] = none;
        points[i].simulated_s = 10 - (double)i / 8;
        points[i].checked = true;
        points[i].hash = i;
    }
    points[1].verdict = WH_SWEEP_FAILED;
    points[1].reason = reasons[0];
    points[1].projz = 0.25;
    points[2] = none;
    points[2].verdict = WH_SWEEP_UNDONE;
    points[3] = none;
    points[3].verdict = WH_SWEEP_BAD;
    points[3].reason = reasons[1];
    points[4].wafers_per_hour = 360;
    points[4].projz = 0.4;
    points[5].simulated_s = 9.75;
    points[5].checked = false;
    points[5].caught = true;
    sweep = (wh_script_sweep_t){
        .run.script = "cell.lua", .axes = axes, .axis_count = 2, .points = points, .point_count = POINTS};
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    free(text);
    text = NULL;
    return 0;
}

static void print_table(const wh_style_t *style) {
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_sweep_print_table(&sweep, out, style), 0);
    assert_int_equal(fclose(out), 0);
}

static void a_table_has_what_any_run_has(void **state) {
    (void)state;
    print_table(&piped);
    assert_string_equal(text,
                        "cell.lua\n"
                        "\n"
                        "  v  gap  result  simulated s  wafers/h  |dr_proj_z|  why\n"
                        "100    1  ok           10.000\n"
                        "100    3  failed        9.875                 0.2500  line 3 missed\n"
                        "150    1  bad                                         v: too fast\n"
                        "150    3  ok            9.500     360.0       0.4000\n"
                        "150    5  ok            9.750\n"
                        "\n"
                        "3 of 6 runs ok\n"
                        "the fastest of them: --set v=150 --set gap=3, 9.500 s simulated\n"
                        "! collisions were not looked for in 1 run: the layout has no collision = true\n"
                        "! in 1 run that count as ok the script caught errors\n"
                        "! gap goes up to 5, for its steps do not lead to 6\n");
}

static void all_runs_are_ok(void **state) {
    (void)state;
    axes[1].end = 5;
    for (size_t i = 0; i < POINTS; ++i) {
        points[i] = (wh_sweep_point_t){
            .simulated_s = 1, .wafers_per_hour = i == 2 ? 20 : 10, .projz = 0.1, .projxy = -3, .gap = 2.5};
    }
    points[0].caught = points[3].caught = true;
    print_table(&coloured);
    assert_non_null(strstr(
        text,
        "\033[32m6 of 6 runs ok\033[0m\nthe fastest of them: --set v=100 --set gap=5, 1.000 s simulated\n"
        "! collisions were not looked for in 6 runs: the layout has no collision = true\n"
        "! in 2 runs that count as ok the script caught errors\n"));
    assert_null(strstr(text, "goes up to"));
    assert_null(strstr(text, "why"));
    assert_int_equal(wh_sweep_count(&sweep, WH_SWEEP_OK), 6);
    print_table(&piped);
    assert_non_null(strstr(text,
                           "  v  gap  result  simulated s  wafers/h  |dr_proj_z|  |dr_proj_xy|  gap mm\n"
                           "100    1  ok            1.000      10.0       0.1000       -3.0000   2.500\n"));
}

static void no_run_is_ok(void **state) {
    (void)state;
    for (size_t i = 0; i < POINTS; ++i) {
        points[i].verdict = WH_SWEEP_FAILED;
    }
    print_table(&coloured);
    assert_non_null(strstr(text, "\033[31m0 of 6 runs ok\033[0m\n! collisions"));
    assert_null(strstr(text, "fastest"));
}

static void the_same_as_json(void **state) {
    (void)state;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_sweep_print_json(&sweep, out), 0);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(
        text, "{\n"
              "  \"format\": 1,\n"
              "  \"ok\": false,\n"
              "  \"interrupted\": true,\n"
              "  \"script\": \"cell.lua\",\n"
              "  \"axes\": [\n"
              "    {\"name\": \"v\", \"start\": 100.0, \"step\": 50.0, \"count\": 2},\n"
              "    {\"name\": \"gap\", \"start\": 1.0, \"step\": 2.0, \"count\": 3}\n"
              "  ],\n"
              "  \"runs\": [\n"
              "    {\"values\": [100.0, 1.0], \"verdict\": \"ok\", \"reason\": null, \"simulated_s\": 10.0, "
              "\"wafers_per_hour\": null, \"dr_proj_z\": null, \"dr_proj_xy\": null, \"gap\": null, "
              "\"checked\": true, \"caught_errors\": false, \"hash\": \"0000000000000000\"},\n"
              "    {\"values\": [100.0, 3.0], \"verdict\": \"failed\", \"reason\": \"line 3 missed\", "
              "\"simulated_s\": 9.875, \"wafers_per_hour\": null, \"dr_proj_z\": 0.25, \"dr_proj_xy\": null, "
              "\"gap\": null, \"checked\": true, \"caught_errors\": false, \"hash\": \"0000000000000001\"},\n"
              "    {\"values\": [150.0, 1.0], \"verdict\": \"bad\", \"reason\": \"v: too fast\", "
              "\"simulated_s\": null, \"wafers_per_hour\": null, \"dr_proj_z\": null, \"dr_proj_xy\": null, "
              "\"gap\": null, \"checked\": false, \"caught_errors\": false, \"hash\": null},\n"
              "    {\"values\": [150.0, 3.0], \"verdict\": \"ok\", \"reason\": null, \"simulated_s\": 9.5, "
              "\"wafers_per_hour\": 360.0, \"dr_proj_z\": 0.40000000000000002, \"dr_proj_xy\": null, "
              "\"gap\": null, \"checked\": true, \"caught_errors\": false, \"hash\": \"0000000000000004\"},\n"
              "    {\"values\": [150.0, 5.0], \"verdict\": \"ok\", \"reason\": null, \"simulated_s\": 9.75, "
              "\"wafers_per_hour\": null, \"dr_proj_z\": null, \"dr_proj_xy\": null, \"gap\": null, "
              "\"checked\": false, \"caught_errors\": true, \"hash\": \"0000000000000005\"}\n"
              "  ]\n"
              "}\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_table_has_what_any_run_has, set_up, tear_down),
        cmocka_unit_test_setup_teardown(all_runs_are_ok, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_run_is_ok, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_same_as_json, set_up, tear_down),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
