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

/* Two doors with beams, and a wafer that is carried to and fro between them. */
#define DOORS                                                                                                \
    "local function door(at, yaw)\n"                                                                         \
    "  return { at = at, rpy = { 0, 0, yaw }, beams = { { y = 60, delay_on = 5e-5, delay_off = 8e-5, "       \
    "jitter "                                                                                                \
    "= 3e-6 },\n"                                                                                            \
    "    { y = -110, delay_on = 5e-5, delay_off = 8e-5, jitter = 3e-6 } } }\n"                               \
    "end\n"                                                                                                  \
    "return { grippers = { { name = 'EE' }, { name = 'E2', at = { 0, 0, 30 } } },\n"                         \
    "stations = { A = door({ 700, 0, 900 }, 0), B = door({ 0, 700, 900 }, 90), C = { at = { -700, 0, 900 "   \
    "}, "                                                                                                    \
    "rpy = { 0, 0, 180 }, slots = 2 } },\n"

/* Errors of 300 passes, each with latches of its own, in the deviations that are stated with them. */
static void centring_is_as_near_as_it_says(void **state) {
    (void)state;
    assert_texts(
        DOORS "wafers = { { name = 'W', station = 'A', slot = 1, dx = 2, dy = -1.5, rpy = { 0, 0, 90 "
              "} } } }\n",
        "cell 'cell.lua' local sum, worst, n = { 0, 0 }, 0, 300\n"
        "for i = 1, n do\n"
        "  get('A', 1) local c = put('B', 1, { centre = true })\n"
        "  local x, y = offset('W', 'B', 1)\n"
        "  sum[1], sum[2] = sum[1] + (x / c.sd_dx)^2, sum[2] + (y / c.sd_dy)^2\n"
        "  worst = math.max(worst, x / c.sd_dx, y / c.sd_dy)\n"
        "  get('B', 1) put('A', 1, { dx = i % 3 - 1, dy = i % 5 - 2 })\n"
        "end\n"
        "local x, y = math.sqrt(sum[1] / n), math.sqrt(sum[2] / n)\n"
        "expect(math.abs(x - 1) < 0.15 and math.abs(y - 1) < 0.15 and worst < 5, x .. ' ' .. y .. ' ' "
        ".. worst)\n");
}

/* The notch goes by one of the beams' crossings, by 0.02 degrees each time. */
static void a_notch_in_a_beams_way_does_no_harm(void **state) {
    (void)state;
    assert_texts(DOORS "wafers = { { name = 'W', station = 'A', slot = 1, rpy = { 0, 0, 22.5 } } } }\n",
                 "cell 'cell.lua' local hits, near, worst, unsure = 0, 0, 0, 0\n"
                 "get('A', 1)\n"
                 "for i = 1, 110 do\n"
                 "  local ok, c = pcall(put, 'B', 1, { centre = true })\n"
                 "  if ok then\n"
                 "    local e = distance('W', 'B')\n"
                 "    local x, y = offset('W', 'B', 1) e = math.sqrt(x * x + y * y)\n"
                 "    worst, near = math.max(worst, e), near + (e <= 0.02 and 1 or 0)\n"
                 "    hits = hits + (c.used < 4 and 1 or 0)\n"
                 "    get('B', 1)\n"
                 "  else unsure = unsure + 1 end\n"
                 "  put('A', 1, { turn = 0.02 }) get('A', 1)\n"
                 "end\n"
                 "expect(hits > 40 and unsure <= 1 and near >= 109 - unsure and worst <= 0.1, hits .. ' ' .. "
                 "near .. ' ' .. worst .. ' ' .. unsure)\n");
}

static void centring_goes_with_what_else_a_put_does(void **state) {
    (void)state;
    assert_texts(
        DOORS "wafers = { { name = 'W', station = 'A', slot = 1, dx = 2, dy = -1, rpy = { 0, 0, 90 } },\n"
              "{ name = 'V', station = 'C', slot = 1, dx = -1 } } }\n",
        "cell 'cell.lua' local good = true\n"
        "local function check(what, x, y)\n"
        "  local dx, dy = offset('W', 'B', 1)\n"
        "  if not (math.abs(dx - x) < 0.02 and math.abs(dy - y) < 0.02) then good = false print(what, dx, "
        "dy) "
        "end\n"
        "end\n"
        "local function fails(name, word, ...)\n"
        "  local ok, problem = pcall(word, ...)\n"
        "  if ok or problem.name ~= name then good = false print(name, ok, problem and problem.message) end\n"
        "end\n"
        "local centred = { centre = true }\n"
        /* corrections by hand move the place */
        "get('A', 1) put('B', 1, { centre = true, dx = 1, dy = -0.5 }) check('by hand', 1, -0.5)\n"
        /* in phases */
        "get('B', 1) put('B', 1, { centre = true, stop = 'extended' }) continue() check('in phases', 0, 0)\n"
        "if centring().used ~= 4 or not centring().sure then good = false end\n"
        /* turned, and beside the frame's axes */
        "get('B', 1) put('B', 1, { centre = true, turn = 4, dx = 1 }) check('turned', 1, 0)\n"
        "get('B', 1) put('B', 1, { dx = 3 }) get('C', 1, { gripper = 'E2' })\n"
        /* too far off: out again, still held */
        "get('B', 1, { dx = 5, dy = -5 })\n"
        "fails('CORRECTION_TOO_LARGE', put, 'B', 1, centred)\n"
        "if holder('W') ~= 'EE' then good = false print 'not held' end\n"
        "put('B', 1, { dx = 3 }) get('B', 1, { dx = 3 })\n"
        /* too short a way: not all of the wafer passes */
        "fails('TOO_FEW_SAMPLES', put, 'B', 1, { centre = true, retract = 160 })\n"
        "put('B', 1)\n"
        /* refused before anything moves */
        "fails('BAD_ARGUMENT', swap, 'B', 1, { put_centre = true }) put('C', 1, { gripper = 'E2' }) get('B', "
        "1)\n"
        "fails('BAD_ARGUMENT', put, 'C', 2, centred) fails('BAD_ARGUMENT', get, 'B', 1, centred)\n"
        "fails('BAD_ARGUMENT', put, 'B', 1, { centre = 1 })\n"
        "expect(good, 'all of it')\n");
}

/* No centre from one beam: nothing is put down. */
static void a_stuck_beam_is_found_out(void **state) {
    (void)state;
    assert_texts(
        "return { grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, centre = true,\n"
        "  beams = { { y = 60, stuck = 'dark' }, { y = -110 } } } }, wafers = { { name = 'W', station = 'A', "
        "slot = 1 } } }\n",
        "cell 'cell.lua' get('A', 1) local ok, problem = pcall(put, 'A', 1)\n"
        "expect(problem.name == 'TOO_FEW_SAMPLES' and holder('W') == 'EE', problem.message)\n");
}

/* Wafers of other diameters: told with a spread, refused without. A blade that reaches before its wafer hides one crossing. */
static void true_diameters_are_found_if_they_may_vary(void **state) {
    (void)state;
    static const char *const spreads[] = {"wafer = { spread = 0.1 },", ""};
    static const char *const shapes[] = {"", "shapes = { blade = { length = 170 } },"};
    for (unsigned bits = 0; bits < 4; ++bits) {
        char layout[2000], script[1000];
        (void)snprintf(layout, sizeof layout,
                       DOORS "%s %s wafers = { { name = 'W', station = 'A', slot = 1, dx = 1.5, "
                             "dy = -0.8, rpy = { 0, 0, 90 }, rim = { diameter = 300.2 } } } }\n",
                       spreads[bits % 2], shapes[bits / 2]);
        (void)snprintf(
            script, sizeof script,
            "cell 'cell.lua' get('A', 1) local ok, problem = pcall(put, 'B', 1, { centre = true })\n"
            "local c, good = centring(), not ok and problem.name == 'CENTRE_NOT_SURE'\n"
            "if ok then local x, y = offset('W', 'B', 1)\n"
            "  good = math.abs(x) < 0.02 and math.abs(y) < 0.02 and math.abs(c.radius - 150.1) < 0.005 and "
            "c.used == %d end\n"
            "expect(good and ok == %s, tostring(ok) .. ' ' .. c.used)\n",
            bits / 2 ? 3 : 4, bits % 2 ? "false" : "true");
        assert_texts(layout, script);
        wh_script_run_close(&run);
    }
}

/* Stations off by 0.25 mm and 0.2 degrees, a beam that nobody knows the place of to 0.5 mm, latches that are late by 10 us more or
 * less than believed. The script compares with what is true. */
static void stations_are_taught_by_a_beam(void **state) {
    (void)state;
    (void)wh_test_seed();
    for (int lesson = 0; lesson < 40 / WH_TEST_SHARE; ++lesson) {
        static const char *const fields[] = {"x", "y", "z", "yaw"};
        char texts[4][60];
        const char *errors[4];
        for (size_t i = 0; i < 4; ++i) {
            const double most = i == 3 ? 0.2 : 0.25;
            (void)snprintf(texts[i], sizeof texts[i], "A.%s=%.4f", fields[i], wh_test_uniform(-most, most));
            errors[i] = texts[i];
        }
        const wh_script_run_options_t options = {.script = "lua/examples/14_teach.lua",
                                                 .limits = {.print_to = stderr},
                                                 .errors = errors,
                                                 .error_count = 4};
        if (wh_script_run(&run, &options) != WH_RUN_MET) {
            fail_msg("%s %s %s %s: %s", texts[0], texts[1], texts[2], texts[3],
                     run.record.failure ? run.record.failure : run.message);
        }
        wh_script_run_close(&run);
    }
}

static void what_cannot_be_taught_is_said(void **state) {
    (void)state;
    assert_texts(
        DOORS "wafers = { { name = 'W', station = 'A', slot = 1 } } }\n",
        "cell 'cell.lua' local good = true\n"
        "local function fails(name, ...)\n"
        "  local ok, problem = pcall(teach, ...)\n"
        "  if ok or problem.name ~= name then good = false print(name, ok, problem and problem.message) "
        "end\n"
        "end\n"
        "fails('BAD_ARGUMENT', 'C') fails('BAD_ARGUMENT', 'A', { by = 'touch' })\n"
        "fails('NO_SUCH_STATION', 'Z') fails('BAD_ARGUMENT', 'A', { with = 'beam' })\n"
        "fails('WAFER_MISSING', 'B') get('A', 1) fails('WAFER_ON_GRIPPER', 'A')\n"
        "put('A', 1) fault { kind = 'wafer_shifted', wafer = 'W', dz = -2 } fails('WAFER_MISSING', "
        "'A')\n"
        "expect(good, 'all of it')\n");
}

/* The notch is turned through the beam where it is, though the arm stands beyond `transit`; a wafer without one is not taught by; and
 * what goes off on the way is no wafer that was carried. */
static void teaching_looks_at_what_it_relies_on(void **state) {
    (void)state;
    static const char *const rims[] = {"", ", rim = { notch = { depth = 0 } }"};
    for (int round = 0; round < 3; ++round) {
        char layout[1000];
        (void)snprintf(
            layout, sizeof layout,
            "return { robot = { transit = 480 }, grippers = { { name = 'EE' } }, stations = { A = { at = { "
            "700, 0, 900 }, beams = { { y = 60 } } } },\n"
            "wafers = { { name = 'W', station = 'A', slot = 1%s } } }\n",
            rims[round == 1 ? 1 : 0]);
        static const char *const scripts[] = {
            "cell 'cell.lua' local t = teach('A') expect(math.abs(t.rpy[3]) < 0.02, tostring(t.rpy[3]))\n",
            "cell 'cell.lua' local ok, e = pcall(teach, 'A') expect(not ok and e.name == 'NO_NOTCH', "
            "tostring(e.name))\n",
            "cell 'cell.lua' fault { kind = 'sensor_off', gripper = 'EE', after = 14 }\n"
            "local ok, e = pcall(teach, 'A') expect(not ok and e.name == 'WAFER_LOST_ON_WAY', "
            "tostring(e.name))\n",
        };
        assert_texts(layout, scripts[round]);
        wh_script_run_close(&run);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(teaching_looks_at_what_it_relies_on),
        cmocka_unit_test_teardown(a_command_within_a_command_is_refused, close_run),
        cmocka_unit_test_teardown(nothing_moves_without_a_link, close_run),
        cmocka_unit_test_teardown(errors_within_a_pattern_name_the_line, close_run),
        cmocka_unit_test_teardown(a_wrong_value_of_any_word_is_named_with_what_was_expected, close_run),
        cmocka_unit_test_teardown(frames_are_measured, close_run),
        cmocka_unit_test_teardown(a_script_may_use_the_names_of_functions, close_run),
        cmocka_unit_test(a_stop_may_come_at_any_time),
        cmocka_unit_test_teardown(a_blade_may_touch_the_wafer_on_a_tilted_chuck, close_run),
        cmocka_unit_test_teardown(theta_goes_the_longer_way_round_if_the_way_in_asks_for_it, close_run),
        cmocka_unit_test_teardown(centring_is_as_near_as_it_says, close_run),
        cmocka_unit_test_teardown(a_notch_in_a_beams_way_does_no_harm, close_run),
        cmocka_unit_test_teardown(centring_goes_with_what_else_a_put_does, close_run),
        cmocka_unit_test_teardown(a_stuck_beam_is_found_out, close_run),
        cmocka_unit_test(true_diameters_are_found_if_they_may_vary),
        cmocka_unit_test(stations_are_taught_by_a_beam),
        cmocka_unit_test_teardown(what_cannot_be_taught_is_said, close_run),
        cmocka_unit_test_teardown(a_put_leaves_the_wafer_on_its_support, close_run),
        cmocka_unit_test_teardown(the_record_is_paid_for_from_the_budget, close_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
