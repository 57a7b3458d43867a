/* The MCS's host against scripts that do what no operator would. */
#include "support/support.h"

#include <unistd.h>

#include "mcs/script_run.h"

static wh_script_run_t run;

static int close_run(void **state) {
    (void)state;
    wh_script_run_close(&run);
    return 0;
}

#define ODD_SCRIPTS "tests/end_to_end/data/odd_scripts.lua"

/* `parameter`: which of the script's cases, or null. */
static wh_script_run_outcome_t play(const char *script, const char *parameter, uint64_t instructions) {
    const wh_script_run_options_t options = {.script = script,
                                             .limits = {.print_to = stderr, .instructions = instructions},
                                             .parameters = &parameter,
                                             .parameter_count = parameter ? 1 : 0};
    return wh_script_run(&run, &options);
}

static void a_command_within_a_command_is_refused(void **state) {
    (void)state;
    assert_int_equal(play(ODD_SCRIPTS, "case=nested_command", 0), WH_RUN_MET);
    assert_int_equal(run.record.command_count, 3);
    /* The value's name is asked for before its command begins, and again within it to say what is wrong. */
    assert_string_equal(run.record.commands[0].text, "WAIT 0.1");
    assert_string_equal(run.record.commands[1].text, "VALVE EE evil");
    assert_int_equal(run.record.commands[1].error, WH_STATUS_BAD_VALVE);
    assert_string_equal(run.record.commands[2].text, "WAIT 0.1");
    assert_int_equal(run.record.commands[2].error, WH_OK);
    assert_true(run.record.slices == 200);
}

static wh_link_t *connect_nowhere(void *user, wh_mcs_t *mcs) {
    (void)user;
    (void)mcs;
    return NULL;
}

/* The script has kept the error of `cell` to itself: without a link nothing may seem to move. */
static void nothing_moves_without_a_link(void **state) {
    (void)state;
    char script[WH_TEST_PATH], folder[1000];
    FILE *file = fdopen(mkstemp(wh_test_path(script, "mcs")), "w");
    assert_non_null(file);
    assert_non_null(getcwd(folder, sizeof folder));
    fprintf(file, "pcall(cell, '%s/lua/layouts/paper.lua')\npcall(wait, 0.1)\nwait(0.1)\n", folder);
    fclose(file);
    const wh_script_run_options_t options = {
        .script = script, .limits = {.print_to = stderr}, .partners = {.connect = connect_nowhere}};
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_FAILED);
    remove(script);
    assert_int_equal(run.record.command_count, 2);
    for (size_t i = 0; i < run.record.command_count; ++i) {
        assert_int_equal(run.record.commands[i].error, WH_STATUS_NO_LAYOUT);
        assert_non_null(strstr(run.record.commands[i].message, "cell was refused"));
    }
    assert_true(run.record.slices == 0);
}

static void assert_expected(const char *script, const char *parameter, size_t expectations) {
    const wh_script_run_outcome_t outcome = play(script, parameter, 0);
    for (size_t i = 0; i < run.record.expectation_count; ++i) {
        if (!run.record.expectations[i].ok) {
            print_error("%s\n", run.record.expectations[i].text);
        }
    }
    if (outcome != WH_RUN_MET) {
        print_error("%s\n", run.record.failure ? run.record.failure : run.message);
    }
    assert_int_equal(outcome, WH_RUN_MET);
    assert_int_equal(run.record.expectation_count, expectations);
}

static void errors_within_a_pattern_name_the_line(void **state) {
    (void)state;
    assert_expected(ODD_SCRIPTS, "case=error_lines", 2);
}

static void a_wrong_value_of_any_word_is_named_with_what_was_expected(void **state) {
    (void)state;
    assert_expected(ODD_SCRIPTS, "case=wrong_values", 7);
}

static void frames_are_measured(void **state) {
    (void)state;
    assert_expected("tests/end_to_end/data/measure.lua", NULL, 77);
}

static void a_script_may_use_the_names_of_functions(void **state) {
    (void)state;
    assert_int_equal(play(ODD_SCRIPTS, "case=globals", 0), WH_RUN_MET);
}

/* Whenever a STOP comes, no wafer is dropped on the way out, and work goes on after HOME. */
static void a_stop_may_come_at_any_time(void **state) {
    (void)state;
    static const char *const targets[] = {"to=A", "to=B", "to=P"};
    for (size_t t = 0; t < sizeof targets / sizeof targets[0]; ++t) {
        for (int step = 1; step <= 78; ++step) {
            char at[30];
            snprintf(at, sizeof at, "at=%.3f", 0.05 * step);
            const char *const parameters[] = {"case=stop_anywhere", at, targets[t]};
            const wh_script_run_options_t options = {.script = ODD_SCRIPTS,
                                                     .limits = {.print_to = stderr},
                                                     .parameters = parameters,
                                                     .parameter_count = 3};
            if (wh_script_run(&run, &options) != WH_RUN_MET) {
                fail_msg("%s %s: %s", at, targets[t], run.record.failure ? run.record.failure : run.message);
            }
            wh_script_run_close(&run);
        }
    }
}

static void write_text(const char *folder, const char *name, const char *text) {
    char path[WH_TEST_PATH + 50];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void remove_file(const char *folder, const char *name) {
    char path[WH_TEST_PATH + 50];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    remove(path);
}

/* Whatever holds on for however long: a support stops the wafer, the blade leaves it, and the next GET finds it. */
static void a_put_leaves_the_wafer_on_its_support(void **state) {
    (void)state;
    static const char layout[] =
        "return { seat = params.seat == 'yes', settle = params.settle == 'yes', collision = true, \n"
        "look_ahead = params.ahead == 'yes', check = params.check, wafer = { diameter = params.diameter },\n"
        "vacuum = params.vent > 0 and { build = 0.02, vent = params.vent } or nil,\n"
        "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = {\n"
        "  A = { kind = 'foup', at = { 800, 0, 900 } }, B = { at = { 0, 800, 900 }, rpy = { 0, 0, 90 }, "
        "slots = 5 },\n"
        "  P = { kind = 'prealigner', at = { -600, 0, 950 }, rpy = { 0, 0, 180 } } },\n"
        "wafers = { { name = 'W', station = 'A', slot = 1 }, { name = 'V', station = 'A', slot = 2 } } }\n";
    static const char script[] =
        "cell 'cell.lua' local from\n"
        "for _, to in ipairs { { 'B', 2 }, { 'A', 1 }, { 'P', 1 }, { 'B', 3 }, { 'B', 4 } } do\n"
        "  get(from and from[1] or 'A', from and from[2] or 1) put(to[1], to[2]) from = to\n"
        "  local _, _, dz = offset('W', to[1], to[2])\n"
        "  expect(dz > -1.001e-3 and dz < 0.51, to[1] .. ': ' .. dz)\n"
        "end\n"
        "expect(#hits() == 0, 'no hit')\n";
    char folder[WH_TEST_PATH], path[WH_TEST_PATH + 50];
    assert_non_null(mkdtemp(wh_test_path(folder, "mcs")));
    write_text(folder, "cell.lua", layout);
    write_text(folder, "script.lua", script);
    (void)snprintf(path, sizeof path, "%s/script.lua", folder);
    for (unsigned bits = 0; bits < 4 * 8; ++bits) {
        static const char *const vents[] = {"vent=0", "vent=0.015", "vent=0.1", "vent=0.4"};
        static const char *const diameters[] = {"diameter=300", "diameter=200", "diameter=150"};
        const char *const parameters[] = {diameters[bits % 3],
                                          vents[bits / 8 % 4],
                                          bits & 1 ? "seat=yes" : "seat=no",
                                          bits & 2 ? "settle=yes" : "settle=no",
                                          bits & 4 ? "ahead=yes" : "ahead=no",
                                          bits & 1 ? "check=sampled" : "check=swept"};
        const wh_script_run_options_t options = {
            .script = path, .limits = {.print_to = stderr}, .parameters = parameters, .parameter_count = 6};
        if (wh_script_run(&run, &options) != WH_RUN_MET) {
            const wh_record_t *record = &run.record;
            fail_msg("%s %s %s %s %s %s: %s", parameters[0], parameters[1], parameters[2], parameters[3],
                     parameters[4], parameters[5], record->failure ? record->failure : run.message);
        }
        wh_script_run_close(&run);
    }
    remove_file(folder, "cell.lua");
    remove_file(folder, "script.lua");
    rmdir(folder);
}

static void the_record_is_paid_for_from_the_budget(void **state) {
    (void)state;
    assert_int_equal(play(ODD_SCRIPTS, "case=endless_record", 50000000), WH_RUN_BAD_INPUT);
    assert_non_null(strstr(run.message, "instruction budget of 50000000 spent"));
    assert_in_range(run.record.expectation_count, 1, 13);
}

/* Plays a script of one expectation, which is met. */
static void assert_texts(const char *layout, const char *script) {
    char folder[WH_TEST_PATH], path[WH_TEST_PATH + 50];
    assert_non_null(mkdtemp(wh_test_path(folder, "mcs")));
    write_text(folder, "cell.lua", layout);
    write_text(folder, "script.lua", script);
    (void)snprintf(path, sizeof path, "%s/script.lua", folder);
    assert_expected(path, NULL, 1);
    remove_file(folder, "cell.lua");
    remove_file(folder, "script.lua");
    rmdir(folder);
}

/* Nobody holds it when the run begins, and the blade comes up to it with its valve closed. */
static void a_blade_may_touch_the_wafer_on_a_tilted_chuck(void **state) {
    (void)state;
    assert_texts("return { wafer = { diameter = 150 }, collision = true, look_ahead = true,\n"
                 "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } },\n"
                 "stations = { P = { kind = 'prealigner', at = { 700, 0, 900 }, rpy = { 0.1, 0.1, 0 } } },\n"
                 "wafers = { { name = 'W', station = 'P', slot = 1 } } }\n",
                 "cell 'cell.lua' get('P', 1) expect(#hits() == 0, 'no hit')\n");
}

/* The shorter way round ends within theta's travel, and the way in from there leaves it. */
static void theta_goes_the_longer_way_round_if_the_way_in_asks_for_it(void **state) {
    (void)state;
    static const char layout[] = "return { robot = { theta = { min = -200, max = 200 } }, grippers = { { "
                                 "name = 'EE' } }, stations = {\n"
                                 "  A = { at = { -121.554, 689.365, 900 }, rpy = { 0, 0, 100 } },\n"
                                 "  C = { at = { -655.2, -246.3, 900 }, rpy = { 0, 0, -158.5 } } },\n"
                                 "wafers = { { name = 'W', station = 'A', slot = 1 } } }\n";
    static const char script[] = "cell 'cell.lua' get('A', 1) put('C', 1) expect_offset('W', 'C', 1, 0, 0)\n";
    assert_texts(layout, script);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(a_command_within_a_command_is_refused, close_run),
        cmocka_unit_test_teardown(nothing_moves_without_a_link, close_run),
        cmocka_unit_test_teardown(errors_within_a_pattern_name_the_line, close_run),
        cmocka_unit_test_teardown(a_wrong_value_of_any_word_is_named_with_what_was_expected, close_run),
        cmocka_unit_test_teardown(frames_are_measured, close_run),
        cmocka_unit_test_teardown(a_script_may_use_the_names_of_functions, close_run),
        cmocka_unit_test(a_stop_may_come_at_any_time),
        cmocka_unit_test_teardown(a_blade_may_touch_the_wafer_on_a_tilted_chuck, close_run),
        cmocka_unit_test_teardown(theta_goes_the_longer_way_round_if_the_way_in_asks_for_it, close_run),
        cmocka_unit_test_teardown(a_put_leaves_the_wafer_on_its_support, close_run),
        cmocka_unit_test_teardown(the_record_is_paid_for_from_the_budget, close_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
