/* The MCS's host against scripts that do what no operator would do. */
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
    /* The value's name is looked up before its command begins, and again within it for the error message. */
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

/* The script has caught the error of `cell`: without a link nothing may seem to move. */
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

/* Whenever a STOP comes, no wafer is dropped on the way out, and work continues after HOME. */
static void a_stop_may_come_at_any_time(void **state) {
    (void)state;
    static const char *const targets[] = {"to=A", "to=B", "to=P"};
    for (size_t t = 0; t < sizeof targets / sizeof targets[0]; ++t) {
        for (int step = 1; step <= 78; step += (WH_TEST_SHARE + 1) / 2) {
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

/* However long a vacuum holds, a support stops the wafer, the blade leaves it, and the next GET finds it. */
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
    for (unsigned bits = 0; bits<4 * 8; bits += WH_TEST_SHARE> 1 ? 7 : 1) {
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

/* Plays a script with one expectation, which is met. */
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

/* No gripper holds it when the run begins, and the blade rises to it with its valve closed. */
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

static void what_hangs_above_its_slot_does_not_lie_there(void **state) {
    static const char *const wanted[] = {
        "V in C slot 1 with dX 0, dY 0 to 1e-09 mm",
        "W in C slot 2 with dX 0, dY 0 to 1e-09 mm; found dX 0, dY 0, dZ 2 (expected within 0.5 mm of the "
        "slot's "
        "plane)",
        "V in C slot 1 with dX 0.5, dY 0 to 0.5 mm; found dX 0 (0.5 off, expected less than 0.5), dY 0"};
    char folder[WH_TEST_PATH], path[WH_TEST_PATH + 50];
    (void)state;
    assert_non_null(mkdtemp(wh_test_path(folder, "mcs")));
    write_text(
        folder, "cell.lua",
        "return { grippers = { { name = 'EE' } }, stations = { C = { at = { 700, 0, 900 }, slots = 2 } },\n"
        "  wafers = { { name = 'V', station = 'C', slot = 1, dz = 0.4 },\n"
        "    { name = 'W', station = 'C', slot = 2, dz = 2 } } }\n");
    write_text(
        folder, "script.lua",
        "cell 'cell.lua' wait(0.01) expect_offset('V', 'C', 1, 0, 0) expect_offset('W', 'C', 2, 0, 0)\n"
        "expect_offset('V', 'C', 1, 0.5, 0, 0.5)\n");
    (void)snprintf(path, sizeof path, "%s/script.lua", folder);
    assert_int_equal(play(path, NULL, 0), WH_RUN_FAILED);
    assert_int_equal(run.record.expectation_count, 3);
    for (size_t i = 0; i < 3; ++i) {
        assert_int_equal(run.record.expectations[i].ok, i == 0);
        assert_string_equal(run.record.expectations[i].text, wanted[i]);
    }
    remove_file(folder, "cell.lua");
    remove_file(folder, "script.lua");
    rmdir(folder);
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

/* Errors of 300 passes, each with latches of its own, in units of the stated deviations. */
static void centring_is_as_near_as_it_says(void **state) {
    (void)state;
    char script[1000];
    /* Under sanitizers, the transfers are too few for a standard deviation. */
    (void)snprintf(script, sizeof script,
                   "cell 'cell.lua' local sum, worst, n, near = { 0, 0 }, 0, %d, %g\n"
                   "for i = 1, n do\n"
                   "  get('A', 1) local c = put('B', 1, { centre = true })\n"
                   "  local x, y = offset('W', 'B', 1)\n"
                   "  sum[1], sum[2] = sum[1] + (x / c.sd_dx)^2, sum[2] + (y / c.sd_dy)^2\n"
                   "  worst = math.max(worst, x / c.sd_dx, y / c.sd_dy)\n"
                   "  get('B', 1) put('A', 1, { dx = i %% 3 - 1, dy = i %% 5 - 2 })\n"
                   "end\n"
                   "local x, y = math.sqrt(sum[1] / n), math.sqrt(sum[2] / n)\n"
                   "expect(math.abs(x - 1) < near and math.abs(y - 1) < near and worst < 5,\n"
                   "       x .. ' ' .. y .. ' ' .. worst)\n",
                   WH_TEST_SHARE > 1 ? 30 : 300, WH_TEST_SHARE > 1 ? 0.5 : 0.15);
    assert_texts(DOORS
                 "wafers = { { name = 'W', station = 'A', slot = 1, dx = 2, dy = -1.5, rpy = { 0, 0, 90 "
                 "} } } }\n",
                 script);
}

/* The notch passes one of the beams' crossings, 0.02 degrees further each time. */
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
        "get('B', 1) put('B', 1, { centre = true, stop = 'extended' }) local c = continue() check('in "
        "phases', 0, 0)\n"
        "if c ~= centring() or c.used ~= 4 or not c.sure then good = false end\n"
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

/* If an axis is too near to its end for the correction that centring may need, the PUT takes the
 * longer way round or is refused before the arm is inside. An obstacle in the way aside makes the
 * robot bring the wafer out again. */
static void a_put_that_centres_has_room_to_go_aside(void **state) {
    (void)state;
    static const char *const cells[] = {
        "robot = { r = { min = 200, max = 703 } },", "robot = { theta = { min = -271, max = 90.1 } },",
        ("collision = true, look_ahead = true, obstacles = { { at = { -149.5, 700, 904 }, box = { 1, 5, 4 }, "
         "name = 'post' } },")};
    static const char *const scripts[] = {
        "local ok, e = pcall(put, 'B', 1, { centre = true }) put('B', 1, { dx = -1 })\n"
        "expect(not ok and e.name == 'OUT_OF_REACH' and e.message:find('where `centre` may lead') ~= nil, "
        "tostring(e.message))\n",
        "put('B', 1, { centre = true }) local x, y = offset('W', 'B', 1)\n"
        "expect(math.abs(x) < 0.02 and math.abs(y) < 0.02, x .. ' ' .. y)\n",
        "local ok, e = pcall(put, 'B', 1, { centre = true }) put('A', 1)\n"
        "expect(not ok and e.name == 'COLLISION_AHEAD' and e.message:find('EE still holds the wafer') ~= "
        "nil, tostring(e.message))\n"};
    for (size_t i = 0; i < 3; ++i) {
        char layout[2000], script[1000];
        (void)snprintf(layout, sizeof layout,
                       DOORS "%s wafers = { { name = 'W', station = 'A', slot = 1, dx = -4, dy = %s, "
                             "rpy = { 0, 0, 90 } } } }\n",
                       cells[i], i == 2 ? "-4.5" : "3");
        (void)snprintf(script, sizeof script, "cell 'cell.lua' get('A', 1) %s", scripts[i]);
        assert_texts(layout, script);
        wh_script_run_close(&run);
    }
}

/* Tilted about the slot's x, wherever the notch points, and in the station in which the wafer now lies. */
static void a_crossed_wafer_lies_across_its_slots(void **state) {
    (void)state;
    assert_texts(
        "local wafers = {}\n"
        "for k = 1, 4 do wafers[k] = { name = 'W' .. k, station = 'A', slot = 3 * k, rpy = { 0, 0, 30 * (k - "
        "1) } } end\n"
        "return { grippers = { { name = 'EE' } }, wafers = wafers, stations = { A = { at = { 700, 0, 900 }, "
        "slots = 14 },\n"
        "B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 4 } },\n"
        "faults = { { kind = 'wafer_crossed', wafer = 'W1' }, { kind = 'wafer_crossed', wafer = 'W2' },\n"
        "{ kind = 'wafer_crossed', wafer = 'W3' } } }\n",
        "cell 'cell.lua' wait(0.1) local first = table.concat(map('A'))\n"
        "get('A', 12, { force = true }) put('B', 2, { turn = 5 }) fault { kind = 'wafer_crossed', wafer = "
        "'W4' } wait(0.1)\n"
        "local second = table.concat(map('B'))\n"
        "expect(first == '00440440440100' and second == '0440', first .. ' ' .. second)\n");
}

/* One edge higher than the other by 4 to 10 mm in slots of 10 mm: one wafer, or crossed; where it is single, it
 * is taken. */
static void a_leaning_wafer_is_never_two(void **state) {
    (void)state;
    static const struct {
        const char *mapping;
        double lean;
        const char *codes;
    } cases[] = {
        {"", 4, "00100"}, {"", 5.2, "00100"}, {"", 6.2, "00440"}, {"", 6.3, "00440"},
        {"", 7, "00440"}, {"", 8.3, "00440"}, {"", 10, "00440"},  {"mapping = { level = 2 },", 4, "00400"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char layout[600], script[500];
        (void)snprintf(
            layout, sizeof layout,
            "return { collision = true, grippers = { { name = 'EE' } }, %s wafers = { { name = 'W3', station "
            "= "
            "'F', slot = 3 } },\nstations = { F = { kind = 'foup', at = { 700, 0, 900 }, slots = 5 } } }\n",
            cases[i].mapping);
        (void)snprintf(
            script, sizeof script,
            "cell 'cell.lua' fault { kind = 'wafer_crossed', wafer = 'W3', value = %g } wait(0.01)\n"
            "local codes = table.concat(map('F')) local ok = pcall(get, 'F', 3)\n"
            "expect(codes == '%s' and ok == %s and (not ok or #hits() == 0), codes)",
            cases[i].lean, cases[i].codes, strcmp(cases[i].codes, "00100") == 0 ? "true" : "false");
        assert_texts(layout, script);
        wh_script_run_close(&run);
    }
}

/* Each is a code of its own, and no blade goes in there; beside a thick one it does not go in, either. */
static void protruded_thick_and_thin_wafers_are_told(void **state) {
    (void)state;
    assert_texts(
        "return { grippers = { { name = 'EE' } }, mapping = { protruded = 20, thickest = 1, thinnest = 0.7 "
        "},\n"
        "wafers = { { name = 'W1', station = 'A', slot = 1, dx = -21 }, { name = 'W2', station = 'A', slot = "
        "2, dx = -19 "
        "},\n{ name = 'W3', station = 'A', slot = 3, thickness = 0.6 }, { name = 'W5', station = 'A', slot = "
        "5, thickness "
        "= 1.1 },\n{ name = 'W6', station = 'A', slot = 6 } }, stations = { A = { at = { 700, 0, 900 }, "
        "slots = 6 } } }\n",
        "cell 'cell.lua' local all = table.concat(map('A')) == '316051'\n"
        "local words = { 'is protruded', false, 'is too thin', 'beside slot 4, is too thick', 'is too "
        "thick', "
        "'beside slot 6, is too thick' }\n"
        "for _, slot in ipairs { 1, 3, 4, 5, 6 } do local ok, problem = pcall(get, 'A', slot)\n"
        "all = all and not ok and problem.name == 'BAD_SLOT' and tostring(problem):find(words[slot], 1, "
        "true) ~= nil end\n"
        "get('A', 2) put('A', 2) expect(all)");
}

/* A tail call takes a line off the stack: at a script's end, and in a task. */
static void a_tail_call_has_a_line(void **state) {
    (void)state;
    static const char layout[] = "return { grippers = { { name = 'EE' } }, wafers = { { name = 'W1', station "
                                 "= 'A', slot = 1 } }, stations = { A = "
                                 "{ at = { 700, 0, 900 }, slots = 5 } } }\n";
    assert_texts(layout,
                 "cell 'cell.lua'\nlocal t = task(function() return get('A', 1) end)\njoin(t)\n"
                 "local u = task(function()\n  wait(0.1)\n  return put('A', 2)\nend)\njoin(u)\nexpect(true)\n"
                 "return home()");
    static const int lines[] = {2, 5, 6, 10};
    size_t found = 0;
    for (size_t c = 0; c < run.record.command_count; ++c) {
        const wh_command_record_t *command = &run.record.commands[c];
        if (strstr("GET A 1 WAIT 0.1 PUT A 2 HOME", command->text)) {
            assert_int_equal(command->line, lines[found]);
            ++found;
        }
    }
    assert_int_equal(found, 4);
}

/* Whichever error is detected first. */
static void a_crossed_slot_stays_crossed(void **state) {
    (void)state;
    for (int crossed = 1; crossed <= 2; ++crossed) {
        char layout[600];
        (void)snprintf(
            layout, sizeof layout,
            "return { grippers = { { name = 'EE' } }, wafers = { { name = 'W1', station = 'A', slot = 2 }, "
            "{ name = 'W2', station = 'A', slot = 3 } }, stations = { A = { at = { 700, 0, 900 }, slots = 5 "
            "} },\n"
            "faults = { { kind = 'wafer_crossed', wafer = 'W%d' } } }\n",
            crossed);
        assert_texts(layout, crossed == 1
                                 ? "cell 'cell.lua' wait(0.1) expect(table.concat(map('A')) == '04400')"
                                 : "cell 'cell.lua' wait(0.1) expect(table.concat(map('A')) == '01440')");
        wh_script_run_close(&run);
    }
}

/* Also in the slice in which the sensor is armed, and between the two scans of an ALIGN. */
static void a_scan_sees_a_sensor_that_goes_off(void **state) {
    (void)state;
    assert_texts(
        "return { grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { P = { kind = "
        "'prealigner', "
        "at = { 700, 0, 900 }, sensor = {} } }, wafers = { { name = 'W', station = 'P', slot = 1 } } }\n",
        "cell 'cell.lua' valve('PA', 0) wait(0.1) local good, all = true, align('P').seconds\n"
        "for _, name in ipairs { 'align', 'edge_scan' } do\n"
        "  local part = name == 'align' and 0.098 or 0.035\n"
        "  for k = 0, 10 do\n"
        "    local f = fault { kind = 'sensor_off', gripper = 'PA', after = k * part * all }\n"
        "    local ok, e = pcall(_G[name], 'P')\n"
        "    local lost = name == 'align' and 'WAFER_LOST' or 'WAFER_LOST_ON_WAY'\n"
        "    if ok or e.name ~= lost then good = false print(name, k, ok, e and e.name) end\n"
        "    wait(0.1) clear_fault(f) wait(0.1)\n"
        "  end\n"
        "end\n"
        "expect(good, 'each is lost')\n");
}

/* Whenever a STOP comes, in a scan or in a turn, the sensor is free for the next ALIGN, which gives
 * the same result. */
static void an_align_may_be_stopped_at_any_time(void **state) {
    (void)state;
    assert_texts("return { grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { P = { "
                 "kind = 'prealigner', "
                 "at = { 700, 0, 900 }, sensor = {} } }, wafers = { { name = 'W', station = 'P', slot = 1, "
                 "dx = 1.5, dy = -2 } } }\n",
                 "cell 'cell.lua' valve('PA', 0) wait(0.1) local good, all = true, align('P').seconds\n"
                 "for k = 0, 12 do\n"
                 "  stop_in(k * all / 13) local ok, e = pcall(align, 'P', { angle = 30 * k })\n"
                 "  if ok or e.name ~= 'STOPPED' then good = false print(k, ok, e and e.name) end\n"
                 "  home() local found = align('P')\n"
                 "  if math.abs(found.eccentricity - 2.5) > 0.001 or math.abs(found.after_notch) > 0.02 then "
                 "good = false print(k, found.eccentricity) end\n"
                 "end\n"
                 "get('P', 1) expect(good and holder('W') == 'EE', 'each is stopped')\n");
}

/* One beam gives no centre: nothing is put down. */
static void a_stuck_beam_is_found_out(void **state) {
    (void)state;
    assert_texts(
        "return { grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, centre = true,\n"
        "  beams = { { y = 60, stuck = 'dark' }, { y = -110 } } } }, wafers = { { name = 'W', station = 'A', "
        "slot = 1 } } }\n",
        "cell 'cell.lua' get('A', 1) local ok, problem = pcall(put, 'A', 1)\n"
        "expect(problem.name == 'TOO_FEW_SAMPLES' and holder('W') == 'EE', problem.message)\n");
}

/* If a beam is not at its assumed place, contradictory crossings show it, also with varying radii.
 * If the layout states how well the beams are known, the answer has deviations that hold. */
static void a_beam_that_stands_elsewhere_is_no_sure_centre(void **state) {
    (void)state;
    static const char *const fields[] = {"", "", "sd = 0.1,"};
    static const char *const spreads[] = {"", "wafer = { spread = 0.03 },", ""};
    static const double dx[] = {0.3, 0.3, 0.12};
    for (size_t i = 0; i < 3; ++i) {
        char layout[1000], script[600];
        (void)snprintf(layout, sizeof layout,
                       "return { %s grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, "
                       "beams = { { y = 60, %s },\n"
                       "{ y = -110, dx = %g, %s } } } }, wafers = { { name = 'W', station = 'A', slot = 1, "
                       "dx = 1, rpy = { 0, 0, 90 } } } }\n",
                       spreads[i], fields[i], dx[i], fields[i]);
        (void)snprintf(script, sizeof script,
                       "cell 'cell.lua' get('A', 1) local ok, e = pcall(put, 'A', 1, { centre = true }) "
                       "local c = centring()\n"
                       "local x, y = offset('W', 'A', 1) local off = math.sqrt(x * x + y * y)\n"
                       "expect(%s, ok and off or e.message)\n",
                       i == 2 ? "ok and off < 0.1 and c.sd > 0.05 and c.sd < 0.15"
                              : "not ok and e.name == 'CENTRE_NOT_SURE' and e.message:find('a beam may stand "
                                "elsewhere', 1, true) ~= nil");
        assert_texts(layout, script);
        wh_script_run_close(&run);
    }
}

/* Wafers of other diameters: centred if the layout gives a spread, refused if not. A blade that
 * reaches before its wafer hides one crossing. */
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

static void teach_stations(const char *script) {
    wh_rounds_t rounds = WH_ROUNDS(1, 40, 0.15);
    while (wh_round(&rounds)) {
        static const char *const fields[] = {"x", "y", "z", "yaw"};
        char texts[4][60];
        const char *errors[4];
        for (size_t i = 0; i < 4; ++i) {
            const double most = i == 3 ? 0.2 : 0.25;
            (void)snprintf(texts[i], sizeof texts[i], "A.%s=%.4f", fields[i], wh_test_uniform(-most, most));
            errors[i] = texts[i];
        }
        const wh_script_run_options_t options = {
            .script = script, .limits = {.print_to = stderr}, .errors = errors, .error_count = 4};
        if (wh_script_run(&run, &options) != WH_RUN_MET) {
            fail_msg("%s %s %s %s: %s", texts[0], texts[1], texts[2], texts[3],
                     run.record.failure ? run.record.failure : run.message);
        }
        wh_script_run_close(&run);
    }
}

/* Stations off by 0.25 mm and 0.2 degrees, a beam whose place is known only to 0.5 mm, latches that
 * are 10 us later or earlier than assumed. The script compares with the true values. */
static void stations_are_taught_by_a_beam(void **state) {
    (void)state;
    teach_stations("lua/examples/14_teach.lua");
}

/* By a probe whose switch closes 5 um early or late. */
static void stations_are_taught_by_touch(void **state) {
    (void)state;
    teach_stations("lua/examples/30_touch.lua");
}

/* A probe that is stuck, no probe at all, and a station farther from its place than the search range. */
static void what_is_not_touched_is_said(void **state) {
    static const char *const stuck[] = {"closed", "open"};
    static const char *const errors[] = {"A.x=3", "A.z=-3"};
    (void)state;
    for (size_t i = 0; i < 2; ++i) {
        char layout[500];
        (void)snprintf(
            layout, sizeof layout,
            "return { grippers = { { name = 'EE', probe = { stuck = '%s' } } }, stations = { A = { at = { "
            "700, 0, 900 }, block = {} }, B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 } } } }\n",
            stuck[i]);
        assert_texts(layout,
                     "cell 'cell.lua' local felt, e = pcall(teach, 'A') local ok, f = pcall(teach, 'B', { by "
                     "= 'touch' })\n"
                     "ready('B', 1) expect(not felt and e.name == 'NOT_TOUCHED' and not ok and f.name == "
                     "'BAD_ARGUMENT', tostring(e))\n"
                     "home()\n");
        wh_script_run_close(&run);
        const wh_script_run_options_t options = {
            .script = "lua/examples/30_touch.lua", .errors = &errors[i], .error_count = 1};
        assert_int_equal(wh_script_run(&run, &options), WH_RUN_FAILED);
        assert_non_null(strstr(run.record.failure, "NOT_TOUCHED"));
        wh_script_run_close(&run);
    }
}

/* Sensors with errors of at most 0.1 mm, 0.2 mm of zero, 0.1 % and 20 us: the first one has all of
 * them. Afterwards ALIGN finds middles up to 10 mm off to 2 um, and so it does with a layout that
 * contains the result. */
static void an_edge_sensor_is_calibrated(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, 41, 0.3);
    while (wh_round(&rounds)) {
        const int lesson = rounds.number;
        static const double most[] = {0.1, 0.2, 1e-3, 20e-6};
        const bool is_worst = lesson == 0;
        double off[4];
        char layout[900], script[2000];
        for (size_t i = 0; i < 4; ++i) {
            off[i] = is_worst ? most[i] : wh_test_uniform(-most[i], most[i]);
        }
        (void)snprintf(
            layout, sizeof layout,
            "return { grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, seat = true,\n"
            "corrections = { x = 11, y = 11 }, stations = { P = { kind = 'prealigner', at = { -620, 0, 950 "
            "}, rpy = { 0, 0, %.3f },\n"
            "sensor = { noise = 0.005, seed = %d, at = %.3f, encoder = %d, offset = %.9g, zero = %.9g, "
            "gain = %.9g, latency = %.9g } } },\n"
            "wafers = { { name = 'W', station = 'P', slot = 1, dx = %.4f, dy = %.4f, rpy = { 0, 0, %.3f } } "
            "} }\n",
            wh_test_uniform(170, 190), lesson, wh_test_uniform(-180, 180), lesson % 2 ? 1000000 : 0, off[0],
            off[1], off[2], off[3], wh_test_uniform(-2, 2), wh_test_uniform(-2, 2),
            wh_test_uniform(-180, 180));
        (void)snprintf(
            script, sizeof script,
            "cell 'cell.lua' valve('PA', 0) wait(0.5) local wrong = '' "
            "local function must(good, text) if not good then wrong = wrong .. ' ' .. text end end\n"
            "rotate('P', %.3f)\n"
            "local function off(dx, dy)\n"
            "  get('P', 1) put('P', 1, { dx = dx, dy = dy })\n"
            "  local a, x, y = align('P', { angle = %.3f }), offset('W', 'P', 1)\n"
            "  return math.sqrt((a.after_dx - x) ^ 2 + (a.after_dy - y) ^ 2)\n"
            "end\n"
            "align('P', { mark = 'none' })\n"
            "local before = off(6, -7.5)\n"
            "get('P', 1) put('P', 1)\n"
            "local c = calibrate('P')\n"
            "for _, at in ipairs { { 6, -7.5 }, { -8, 5 }, { 0, 9.5 }, { 1, 1 } } do\n"
            "  local after = off(at[1], at[2])\n"
            "  must(after <= 0.002, ('%%.5f mm before, %%.5f at %%g %%g'):format(before, after, at[1], "
            "at[2]))\n"
            "end\n"
            "must(%s or before > 0.005, before)\n"
            "local function near(name, true_one) local by = math.abs(c[name] - true_one) / c['sd_' .. name]\n"
            "  must(by < 6, name .. ' is off by deviations: ' .. by) end\n"
            "near('offset', %.9g) near('zero', %.9g) near('gain', %.9g) near('latency', %.9g)\n"
            "must(c.mismatch < 60, c.mismatch) expect(#wrong == 0, wrong)\n",
            wh_test_uniform(-170, 170), wh_test_uniform(-180, 180), is_worst ? "false" : "true", off[0],
            off[1], off[2], off[3]);
        assert_texts(layout, script);
        wh_script_run_close(&run);
    }
}

/* If `believed` has the true values, a sensor needs no calibration; with the wrong wafer there is
 * none, and nothing changes. */
static void what_a_layout_believes_of_a_sensor_counts(void **state) {
    (void)state;
    assert_texts(
        "return { grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, seat = true, corrections = { x "
        "= 11 },\n"
        "stations = { P = { kind = 'prealigner', at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = {\n"
        "  offset = 0.1, zero = -0.2, gain = 1e-3, latency = 20e-6,\n"
        "  believed = { offset = 0.1, zero = -0.2, gain = 1e-3, latency = 20e-6 } } } },\n"
        "wafers = { { name = 'W', station = 'P', slot = 1, dx = 9 } } }\n",
        "cell 'cell.lua' valve('PA', 0) wait(0.5) local good = true\n"
        "local function must(right) good = good and right end\n"
        "local a, x, y = align('P'), offset('W', 'P', 1)\n"
        "must(math.abs(a.after_dx - x) < 0.0005 and math.abs(a.after_dy - y) < 0.0005)\n"
        "must(math.abs(a.radius - 150) < 0.001)\n"
        "local ok, problem = pcall(calibrate, 'P', { diameter = 305 })\n"
        "must(not ok and problem.name == 'CENTRE_NOT_SURE')\n"
        "a, x, y = align('P'), offset('W', 'P', 1)\n"
        "must(math.abs(a.after_dx - x) < 0.0005 and math.abs(a.after_dy - y) < 0.0005)\n"
        "expect(good)\n");
    wh_script_run_close(&run);
}

/* True diameters at the ends of SEMI M1, in slots with ledges and walls, with collisions checked
 * before and during each command. Beams give them and the middles, and nothing touches. */
static void true_radii_go_with_ledges_and_collisions(void **state) {
    (void)state;
    static const double diameters[] = {299.8, 300, 300.2};
    for (size_t i = 0; i < sizeof diameters / sizeof *diameters; ++i) {
        char layout[1500];
        (void)snprintf(layout, sizeof layout,
                       "return { wafer = { spread = 0.1 }, collision = true, look_ahead = true, grippers = { "
                       "{ name = 'EE' } },\n"
                       "stations = { A = { kind = 'foup', at = { 700, 0, 900 } }, B = { kind = 'foup', at = "
                       "{ 0, 700, 900 }, rpy = { 0, 0, 90 },\n"
                       "  retract = 320, centre = true, beams = { { y = 60, x = -160, jitter = 1e-6 }, { y = "
                       "-110, x = -160, jitter = 1e-6 } } } },\n"
                       "wafers = { { name = 'W', station = 'A', slot = 3, dx = 1.2, dy = -0.7, rpy = { 0, 0, "
                       "90 }, rim = { diameter = "
                       "%.1f } }, { name = 'U', station = 'B', slot = 4 }, { name = 'D', station = 'B', slot "
                       "= 2 } } }\n",
                       diameters[i]);
        char script[600];
        (void)snprintf(
            script, sizeof script,
            "cell 'cell.lua' get('A', 3) put('B', 3) local x, y = offset('W', 'B', 3) local c = centring()\n"
            "expect(#hits() == 0 and math.abs(x) < 0.02 and math.abs(y) < 0.02 and math.abs(2 * c.radius - "
            "%.1f) < 0.02, x .. ' ' .. y .. ' ' .. c.radius)\n",
            diameters[i]);
        assert_texts(layout, script);
        wh_script_run_close(&run);
    }
}

/* Glass and 20 um of noise: with one turn some of 12 alignments are not sure, with three none, and
 * none is wrong. */
static void turns_make_glass_sure(void **state) {
    (void)state;
    assert_texts("return { grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { A = { at "
                 "= { 700, 0, 900 } },\n"
                 "P = { kind = 'prealigner', at = { -640, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = "
                 "0.02 } } },\n"
                 "wafers = { { name = 'W', station = 'P', slot = 1, dx = 1.2, dy = -0.5, rpy = { 0, 0, 37 }, "
                 "rim = { glass = 0.5 } } } }\n",
                 "cell 'cell.lua' valve('PA', 0) local sure, wrong = { [1] = 0, [3] = 0 }, 0\n"
                 "for i = 1, 12 do for _, turns in ipairs { 1, 3 } do\n"
                 "  local ok, a = pcall(align, 'P', { glass = 0.5, angle = i * 20, turns = turns })\n"
                 "  local x, y = offset('W', 'P', 1)\n"
                 "  sure[turns] = sure[turns] + (ok and 1 or 0)\n"
                 "  if ok and math.max(math.abs(a.after_dx - x), math.abs(a.after_dy - y)) > 0.01 then wrong "
                 "= wrong + 1 end\n"
                 "end end\n"
                 "local ok, e = pcall(align, 'P', { turns = 1.5 })\n"
                 "expect(sure[3] == 12 and sure[1] < 12 and wrong == 0 and not ok and e.name == "
                 "'BAD_ARGUMENT', sure[1] .. ' ' .. sure[3] .. ' ' .. wrong)\n");
    wh_script_run_close(&run);
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
        "put('A', 1) fault { kind = 'wafer_shifted', wafer = 'W', dz = 4 } fails('WAFER_MISSING', "
        "'A')\n"
        "expect(good, 'all of it')\n");
}

/* The notch is turned through the beam in its place, though the arm stands beyond `transit`. A
 * wafer without a notch cannot be used for teaching. If the sensor goes off on the way, the wafer
 * counts as lost. */
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
            "cell 'cell.lua' fault { kind = 'sensor_off', gripper = 'EE', after = 16 }\n"
            "local ok, e = pcall(teach, 'A') expect(not ok and e.name == 'WAFER_LOST_ON_WAY', "
            "tostring(e.name))\n",
        };
        assert_texts(layout, scripts[round]);
        wh_script_run_close(&run);
    }
}

/* A sensor that comes on by itself, for good or for a while, does not count as a wafer; the wafer
 * stays in its place. */
static void teaching_tells_a_stuck_sensor_from_a_wafer(void **state) {
    (void)state;
    static const char *const seats[] = {"", "seat = true, settle = true,"};
    for (size_t i = 0; i < 2; ++i) {
        char layout[1000];
        (void)snprintf(layout, sizeof layout,
                       "return { %s grippers = { { name = 'EE' } }, stations = { A = { at = { "
                       "700, 0, 900 }, beams = { { y = 60 } } } }, wafers = { { name = 'W', station = 'A', "
                       "slot = 1, dz = 0.1 } } }\n",
                       seats[i]);
        assert_texts(
            layout,
            "cell 'cell.lua' local good, caught = true, 0\n"
            "for k = 0, 14 do\n"
            "  for _, lasting in ipairs { 0.3, 1000 } do\n"
            "    local f = fault { kind = 'sensor_on', gripper = 'EE', after = 2 + 1.1 * k, lasting = "
            "lasting }\n"
            "    local _, _, z = offset('W', 'A', 1) local ok, t = pcall(teach, 'A')\n"
            "    local right = ok and math.abs(t.at[3] - 900 - z) < 0.02\n"
            "    caught = caught + (not ok and t.name == 'VACUUM_BEFORE_PICK' and 1 or 0)\n"
            "    if not right and (ok or t.name == 'BAD_ARGUMENT') then good = false print(k, lasting, ok, "
            "z, ok and t.at[3] or t.message) end\n"
            "    pcall(clear_fault, f) wait(0.5)\n"
            "    if holder('W') then put('A', 1, { release = 0.1 }) end recover()\n"
            "    local _, _, dz = offset('W', 'A', 1)\n"
            "    if math.abs(dz - 0.1) > 0.2 then good = false print(k, lasting, ok, 'left at', dz) end\n"
            "  end\n"
            "end\n"
            "expect(good and caught > 8, caught)\n");
        wh_script_run_close(&run);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(teaching_tells_a_stuck_sensor_from_a_wafer),
        cmocka_unit_test(teaching_looks_at_what_it_relies_on),
        cmocka_unit_test(a_put_that_centres_has_room_to_go_aside),
        cmocka_unit_test(a_beam_that_stands_elsewhere_is_no_sure_centre),
        cmocka_unit_test_teardown(a_crossed_wafer_lies_across_its_slots, close_run),
        cmocka_unit_test(a_leaning_wafer_is_never_two),
        cmocka_unit_test_teardown(protruded_thick_and_thin_wafers_are_told, close_run),
        cmocka_unit_test_teardown(a_tail_call_has_a_line, close_run),
        cmocka_unit_test(a_crossed_slot_stays_crossed),
        cmocka_unit_test_teardown(a_scan_sees_a_sensor_that_goes_off, close_run),
        cmocka_unit_test_teardown(an_align_may_be_stopped_at_any_time, close_run),
        cmocka_unit_test_teardown(a_command_within_a_command_is_refused, close_run),
        cmocka_unit_test_teardown(nothing_moves_without_a_link, close_run),
        cmocka_unit_test_teardown(errors_within_a_pattern_name_the_line, close_run),
        cmocka_unit_test_teardown(a_wrong_value_of_any_word_is_named_with_what_was_expected, close_run),
        cmocka_unit_test_teardown(frames_are_measured, close_run),
        cmocka_unit_test_teardown(a_script_may_use_the_names_of_functions, close_run),
        cmocka_unit_test(a_stop_may_come_at_any_time),
        cmocka_unit_test_teardown(a_blade_may_touch_the_wafer_on_a_tilted_chuck, close_run),
        cmocka_unit_test_teardown(theta_goes_the_longer_way_round_if_the_way_in_asks_for_it, close_run),
        cmocka_unit_test_teardown(what_hangs_above_its_slot_does_not_lie_there, close_run),
        cmocka_unit_test_teardown(centring_is_as_near_as_it_says, close_run),
        cmocka_unit_test_teardown(a_notch_in_a_beams_way_does_no_harm, close_run),
        cmocka_unit_test_teardown(centring_goes_with_what_else_a_put_does, close_run),
        cmocka_unit_test_teardown(a_stuck_beam_is_found_out, close_run),
        cmocka_unit_test(true_diameters_are_found_if_they_may_vary),
        cmocka_unit_test(stations_are_taught_by_a_beam),
        cmocka_unit_test(stations_are_taught_by_touch),
        cmocka_unit_test(what_is_not_touched_is_said),
        cmocka_unit_test(turns_make_glass_sure),
        cmocka_unit_test(true_radii_go_with_ledges_and_collisions),
        cmocka_unit_test(an_edge_sensor_is_calibrated),
        cmocka_unit_test(what_a_layout_believes_of_a_sensor_counts),
        cmocka_unit_test_teardown(what_cannot_be_taught_is_said, close_run),
        cmocka_unit_test_teardown(a_put_leaves_the_wafer_on_its_support, close_run),
        cmocka_unit_test_teardown(the_record_is_paid_for_from_the_budget, close_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
