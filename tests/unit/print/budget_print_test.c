/* A budget's table and JSON, word for word, for invented figures. */
#include "print/budget_print.h"

#include <locale.h>

#include "support/layout.h"

static const char cell[] = "grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 } }, ['B "
                           "2'] = { at = { 0, 700, 900 } }, "
                           "C = { at = { 0, -700, 900 } }, D = { at = { -700, 0, 900 } } }";
enum { STATIONS = 4, NUMBERS = WH_SPREADS * STATIONS };

static wh_study_t study;
static wh_budget_t budget;
static wh_budget_station_t stations[STATIONS];
static int32_t half[NUMBERS], inside[NUMBERS], outside[NUMBERS];
static char script[] = "my cell.lua";
static const char *parameters[] = {"v=1", "w=a b"};
static char *text;

static void set_side(wh_budget_side_t *side, int32_t most, bool fails, const wh_budget_why_t *why) {
    *side = (wh_budget_side_t){.inside = most, .outside = fails ? most + 1 : 0, .widest = 50, .trials = 23};
    if (fails) {
        side->why = *why;
    }
}

static void set_error(size_t station, size_t axis, int32_t down, int32_t up) {
    static const wh_budget_why_t missing = {"WAFER_MISSING", WH_STATUS_WAFER_MISSING, 3, "GET A 1",
                                            "|dr_proj_z| 0.501 is not below 0.5"};
    static const wh_budget_why_t hit = {"lost_hold", WH_OK, 0, "PUT B 2", ""};
    wh_budget_error_t *error = &stations[station].errors[axis];
    set_side(&error->sides[0], down, down < 8000, &missing);
    set_side(&error->sides[1], up, up < 8000, &hit);
    error->width = down < up ? down : up;
    error->has_effect = true;
}

/* A fails for all errors but its yaw, B 2 for z and, least of all, roll; C and D have no effect,
 * and D is not asked for. */
static int set_up(void **state) {
    (void)state;
    memset(&study, 0, sizeof study);
    memset(&budget, 0, sizeof budget);
    memset(stations, 0, sizeof stations);
    memset(half, 0, sizeof half);
    memset(inside, 0, sizeof inside);
    memset(outside, 0, sizeof outside);
    study.layout = read_sound(cell);
    study.run.script = script;
    study.run.parameters = parameters;
    study.run.parameter_count = 2;
    study.nominal.record = (wh_record_t){.script = script, .layout = study.layout, .ok = true};
    for (size_t i = 0; i < NUMBERS; ++i) {
        wh_budget_error_t *error = &stations[i / WH_SPREADS].errors[i % WH_SPREADS];
        set_error(i / WH_SPREADS, i % WH_SPREADS, 8000, 8000);
        error->known = true;
        error->has_effect = i < WH_SPREADS;
        stations[i / WH_SPREADS].wanted = i / WH_SPREADS < 3;
    }
    set_error(0, 0, 5000, 4999);
    set_error(0, 1, 5100, 5100);
    set_error(0, 2, 2499, 3500);
    set_error(0, 3, 8000, 1000);
    set_error(0, 4, 1200, 8000);
    set_error(1, 2, 8000, 2600);
    set_error(1, 3, 900, 950);
    stations[1].errors[3].sides[0].widest = 75;
    half[2] = 1249;
    half[9] = 450;
    inside[2] = -1249;
    outside[2] = -1250;
    inside[9] = outside[9] = 450;
    budget = (wh_budget_t){.study = &study,
                           .options = {.most = {8000, 8000}},
                           .stations = stations,
                           .box = {.share = 1,
                                   .whole = 2,
                                   .half = half,
                                   .inside = inside,
                                   .outside = outside,
                                   .tried = {64, 32, 16, 8, 4, 2}},
                           .trials = 1234,
                           .tightest = 1,
                           .next = 0};
    budget.box.why = (wh_budget_why_t){"expectation", WH_OK, 8, "", "W in B 2"};
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    free(text);
    text = NULL;
    return 0;
}

static void print_table(void) {
    static const wh_style_t piped = {false, true, 0};
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_budget_print_table(&budget, out, &piped), 0);
    assert_int_equal(fclose(out), 0);
}

static void print_json(void) {
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_budget_print_json(&budget, out), 0);
    assert_int_equal(fclose(out), 0);
}

static void assert_says(const char *wanted) {
    if (!strstr(text, wanted)) {
        print_error("not found: %s\nin:\n%s", wanted, text);
        fail();
    }
}

static void the_whole_table(void **state) {
    (void)state;
    print_table();
    assert_string_equal(
        text,
        "my cell.lua on cell.lua\n"
        "\n"
        "Each error alone: passes from -width to +width\n"
        "station  error                         width  fails at  with                         and at  with\n"
        "A        x mm                          4.999    -5.001  42 WAFER_MISSING in GET A 1  +5.000  lost "
        "hold in PUT B 2\n"
        "         y mm                          5.100    -5.101  42 WAFER_MISSING in GET A 1  +5.101  lost "
        "hold in PUT B 2\n"
        "         z mm                          2.499    -2.500  42 WAFER_MISSING in GET A 1  +3.501  lost "
        "hold in PUT B 2\n"
        "         roll deg                      1.000      none                               +1.001  lost "
        "hold in PUT B 2\n"
        "         pitch deg                     1.200    -1.201  42 WAFER_MISSING in GET A 1    none\n"
        "         yaw deg                  at least 8\n"
        "B 2      x mm                 no effect to 8\n"
        "         y mm                 no effect to 8\n"
        "         z mm                          2.600      none                               +2.601  lost "
        "hold in PUT B 2\n"
        "         roll deg                      0.900    -0.901  42 WAFER_MISSING in GET A 1  +0.951  lost "
        "hold in PUT B 2\n"
        "         pitch deg            no effect to 8\n"
        "         yaw deg              no effect to 8\n"
        "C        each       no effect to 8 mm, 8 deg\n"
        "\n"
        "tried from 0 outwards up to 8 mm and 8 deg, in steps of at most 0.05 mm and 0.075 deg,\n"
        "and where it first fails to 0.001; a failure between two steps would not be seen\n"
        "the first that fails, and any other, can be played by itself:\n"
        "  waferhand run 'my cell.lua' --set v=1 --set 'w=a b' --error 'B 2.roll=-0.901'\n"
        "\n"
        "All errors together: each up to 50.0 % of its own width, up or down\n"
        "station   x mm   y mm   z mm  roll deg  pitch deg  yaw deg\n"
        "A        0.000  0.000  1.249     0.000      0.000    0.000\n"
        "B 2      0.000  0.000  0.000     0.450      0.000    0.000\n"
        "C        0.000  0.000  0.000     0.000      0.000    0.000\n"
        "\n"
        "no counterexample among 126 trials of this box, which is no proof:\n"
        "64 corners alike at all stations, 32 opposite at every other one, 16 of one station alone,\n"
        "8 by chance, 4 points inside by chance, 2 corners beside the one that fails first\n"
        "just inside the box passes\n"
        "  waferhand run 'my cell.lua' --set v=1 --set 'w=a b' --error A.z=-1.249 --error 'B 2.roll=0.450'\n"
        "just outside fails, with line 8 is not met\n"
        "  waferhand run 'my cell.lua' --set v=1 --set 'w=a b' --error A.z=-1.250 --error 'B 2.roll=0.450'\n"
        "\n"
        "! collisions were not looked for: the layout has no collision = true\n"
        "\n"
        "The tightest error is roll of B 2: 0.900 deg of roll (2.356 mm at a wafer's rim). Beyond "
        "that the run fails: 42 WAFER_MISSING in GET A 1: |dr_proj_z| 0.501 is not below 0.5\n"
        "Teach B 2 best, up to 0.900 deg of roll (2.356 mm at a wafer's rim); the next is A with 2.499 mm of "
        "z\n");
}

/* All lines except five of C's, whose six errors are alike. */
static const char *const json_lines[] = {
    "  \"format\": 1,",
    "  \"ok\": true,",
    "  \"script\": \"my cell.lua\",",
    "  \"layout\": \"cell.lua\",",
    "  \"trials\": 1234,",
    "  \"interrupted\": false,",
    "  \"limit_mm\": 8.0,",
    "  \"limit_deg\": 8.0,",
    "  \"collision\": false,",
    "  \"caught_errors\": false,",
    "  \"noise\": false,",
    "  \"capped\": 0,",
    "  \"errors\": [",
    "    {\"station\": \"A\", \"error\": \"x\", \"unit\": \"mm\", \"width\": 4.9989999999999997, "
    "\"at_least\": false, \"has_effect\": true, \"rim_mm\": 4.9989999999999997, \"down\": {\"inside\": -5.0, "
    "\"outside\": -5.0010000000000003, \"trials\": 23, \"widest_step\": 0.050000000000000003, "
    "\"inside_error\": \"A.x=-5.000\", \"outside_error\": \"A.x=-5.001\", \"why\": {\"name\": "
    "\"WAFER_MISSING\", \"error\": 42, \"line\": 3, \"command\": \"GET A 1\", \"text\": \"|dr_proj_z| 0.501 "
    "is not below 0.5\"}}, \"up\": {\"inside\": 4.9989999999999997, \"outside\": 5.0, \"trials\": 23, "
    "\"widest_step\": 0.050000000000000003, \"inside_error\": \"A.x=4.999\", \"outside_error\": "
    "\"A.x=5.000\", \"why\": {\"name\": \"lost_hold\", \"error\": null, \"line\": null, \"command\": \"PUT B "
    "2\", \"text\": \"\"}}}",
    "    {\"station\": \"A\", \"error\": \"y\", \"unit\": \"mm\", \"width\": 5.0999999999999996, "
    "\"at_least\": false, \"has_effect\": true, \"rim_mm\": 5.0999999999999996, \"down\": {\"inside\": "
    "-5.0999999999999996, \"outside\": -5.101, \"trials\": 23, \"widest_step\": 0.050000000000000003, "
    "\"inside_error\": \"A.y=-5.100\", \"outside_error\": \"A.y=-5.101\", \"why\": {\"name\": "
    "\"WAFER_MISSING\", \"error\": 42, \"line\": 3, \"command\": \"GET A 1\", \"text\": \"|dr_proj_z| 0.501 "
    "is not below 0.5\"}}, \"up\": {\"inside\": 5.0999999999999996, \"outside\": 5.101, \"trials\": 23, "
    "\"widest_step\": 0.050000000000000003, \"inside_error\": \"A.y=5.100\", \"outside_error\": "
    "\"A.y=5.101\", \"why\": {\"name\": \"lost_hold\", \"error\": null, \"line\": null, \"command\": \"PUT B "
    "2\", \"text\": \"\"}}}",
    "    {\"station\": \"A\", \"error\": \"z\", \"unit\": \"mm\", \"width\": 2.4990000000000001, "
    "\"at_least\": false, \"has_effect\": true, \"rim_mm\": 2.4990000000000001, \"down\": {\"inside\": "
    "-2.4990000000000001, \"outside\": -2.5, \"trials\": 23, \"widest_step\": 0.050000000000000003, "
    "\"inside_error\": \"A.z=-2.499\", \"outside_error\": \"A.z=-2.500\", \"why\": {\"name\": "
    "\"WAFER_MISSING\", \"error\": 42, \"line\": 3, \"command\": \"GET A 1\", \"text\": \"|dr_proj_z| 0.501 "
    "is not below 0.5\"}}, \"up\": {\"inside\": 3.5, \"outside\": 3.5009999999999999, \"trials\": 23, "
    "\"widest_step\": 0.050000000000000003, \"inside_error\": \"A.z=3.500\", \"outside_error\": "
    "\"A.z=3.501\", \"why\": {\"name\": \"lost_hold\", \"error\": null, \"line\": null, \"command\": \"PUT B "
    "2\", \"text\": \"\"}}}",
    "    {\"station\": \"A\", \"error\": \"roll\", \"unit\": \"deg\", \"width\": 1.0, \"at_least\": false, "
    "\"has_effect\": true, \"rim_mm\": 2.6179938779914944, \"down\": {\"inside\": -8.0, \"outside\": null, "
    "\"trials\": 23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"A.roll=-8.000\", "
    "\"outside_error\": null, \"why\": null}, \"up\": {\"inside\": 1.0, \"outside\": 1.0009999999999999, "
    "\"trials\": 23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"A.roll=1.000\", "
    "\"outside_error\": \"A.roll=1.001\", \"why\": {\"name\": \"lost_hold\", \"error\": null, \"line\": "
    "null, \"command\": \"PUT B 2\", \"text\": \"\"}}}",
    "    {\"station\": \"A\", \"error\": \"pitch\", \"unit\": \"deg\", \"width\": 1.2, \"at_least\": false, "
    "\"has_effect\": true, \"rim_mm\": 3.1415926535897927, \"down\": {\"inside\": -1.2, \"outside\": "
    "-1.2010000000000001, \"trials\": 23, \"widest_step\": 0.050000000000000003, \"inside_error\": "
    "\"A.pitch=-1.200\", \"outside_error\": \"A.pitch=-1.201\", \"why\": {\"name\": \"WAFER_MISSING\", "
    "\"error\": 42, \"line\": 3, \"command\": \"GET A 1\", \"text\": \"|dr_proj_z| 0.501 is not below "
    "0.5\"}}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"A.pitch=8.000\", \"outside_error\": null, \"why\": null}}",
    "    {\"station\": \"A\", \"error\": \"yaw\", \"unit\": \"deg\", \"width\": 8.0, \"at_least\": true, "
    "\"has_effect\": true, \"rim_mm\": null, \"down\": {\"inside\": -8.0, \"outside\": null, \"trials\": 23, "
    "\"widest_step\": 0.050000000000000003, \"inside_error\": \"A.yaw=-8.000\", \"outside_error\": null, "
    "\"why\": null}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"A.yaw=8.000\", \"outside_error\": null, \"why\": null}}",
    "    {\"station\": \"B 2\", \"error\": \"x\", \"unit\": \"mm\", \"width\": 8.0, \"at_least\": true, "
    "\"has_effect\": false, \"rim_mm\": null, \"down\": {\"inside\": -8.0, \"outside\": null, \"trials\": "
    "23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B 2.x=-8.000\", \"outside_error\": null, "
    "\"why\": null}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"B 2.x=8.000\", \"outside_error\": null, \"why\": null}}",
    "    {\"station\": \"B 2\", \"error\": \"y\", \"unit\": \"mm\", \"width\": 8.0, \"at_least\": true, "
    "\"has_effect\": false, \"rim_mm\": null, \"down\": {\"inside\": -8.0, \"outside\": null, \"trials\": "
    "23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B 2.y=-8.000\", \"outside_error\": null, "
    "\"why\": null}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"B 2.y=8.000\", \"outside_error\": null, \"why\": null}}",
    "    {\"station\": \"B 2\", \"error\": \"z\", \"unit\": \"mm\", \"width\": 2.6000000000000001, "
    "\"at_least\": false, \"has_effect\": true, \"rim_mm\": 2.6000000000000001, \"down\": {\"inside\": -8.0, "
    "\"outside\": null, \"trials\": 23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B "
    "2.z=-8.000\", \"outside_error\": null, \"why\": null}, \"up\": {\"inside\": 2.6000000000000001, "
    "\"outside\": 2.601, \"trials\": 23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B "
    "2.z=2.600\", \"outside_error\": \"B 2.z=2.601\", \"why\": {\"name\": \"lost_hold\", \"error\": null, "
    "\"line\": null, \"command\": \"PUT B 2\", \"text\": \"\"}}}",
    "    {\"station\": \"B 2\", \"error\": \"roll\", \"unit\": \"deg\", \"width\": 0.90000000000000002, "
    "\"at_least\": false, \"has_effect\": true, \"rim_mm\": 2.3561944901923448, \"down\": {\"inside\": "
    "-0.90000000000000002, \"outside\": -0.90100000000000002, \"trials\": 23, \"widest_step\": "
    "0.074999999999999997, \"inside_error\": \"B 2.roll=-0.900\", \"outside_error\": \"B 2.roll=-0.901\", "
    "\"why\": {\"name\": \"WAFER_MISSING\", \"error\": 42, \"line\": 3, \"command\": \"GET A 1\", \"text\": "
    "\"|dr_proj_z| 0.501 is not below 0.5\"}}, \"up\": {\"inside\": 0.94999999999999996, \"outside\": "
    "0.95099999999999996, \"trials\": 23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B "
    "2.roll=0.950\", \"outside_error\": \"B 2.roll=0.951\", \"why\": {\"name\": \"lost_hold\", \"error\": "
    "null, \"line\": null, \"command\": \"PUT B 2\", \"text\": \"\"}}}",
    "    {\"station\": \"B 2\", \"error\": \"pitch\", \"unit\": \"deg\", \"width\": 8.0, \"at_least\": true, "
    "\"has_effect\": false, \"rim_mm\": null, \"down\": {\"inside\": -8.0, \"outside\": null, \"trials\": "
    "23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B 2.pitch=-8.000\", \"outside_error\": "
    "null, \"why\": null}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"B 2.pitch=8.000\", \"outside_error\": null, \"why\": null}}",
    "    {\"station\": \"B 2\", \"error\": \"yaw\", \"unit\": \"deg\", \"width\": 8.0, \"at_least\": true, "
    "\"has_effect\": false, \"rim_mm\": null, \"down\": {\"inside\": -8.0, \"outside\": null, \"trials\": "
    "23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"B 2.yaw=-8.000\", \"outside_error\": "
    "null, \"why\": null}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"B 2.yaw=8.000\", \"outside_error\": null, \"why\": null}}",
    "    {\"station\": \"C\", \"error\": \"x\", \"unit\": \"mm\", \"width\": 8.0, \"at_least\": true, "
    "\"has_effect\": false, \"rim_mm\": null, \"down\": {\"inside\": -8.0, \"outside\": null, \"trials\": "
    "23, \"widest_step\": 0.050000000000000003, \"inside_error\": \"C.x=-8.000\", \"outside_error\": null, "
    "\"why\": null}, \"up\": {\"inside\": 8.0, \"outside\": null, \"trials\": 23, \"widest_step\": "
    "0.050000000000000003, \"inside_error\": \"C.x=8.000\", \"outside_error\": null, \"why\": null}}",
    "  ],",
    "  \"all\": {\"share\": 0.5, \"proved\": false, \"half\": [{\"station\": \"A\", \"error\": \"x\", "
    "\"half\": 0.0}, {\"station\": \"A\", \"error\": \"y\", \"half\": 0.0}, {\"station\": \"A\", \"error\": "
    "\"z\", \"half\": 1.2490000000000001}, {\"station\": \"A\", \"error\": \"roll\", \"half\": 0.0}, "
    "{\"station\": \"A\", \"error\": \"pitch\", \"half\": 0.0}, {\"station\": \"A\", \"error\": \"yaw\", "
    "\"half\": 0.0}, {\"station\": \"B 2\", \"error\": \"x\", \"half\": 0.0}, {\"station\": \"B 2\", "
    "\"error\": \"y\", \"half\": 0.0}, {\"station\": \"B 2\", \"error\": \"z\", \"half\": 0.0}, "
    "{\"station\": \"B 2\", \"error\": \"roll\", \"half\": 0.45000000000000001}, {\"station\": \"B 2\", "
    "\"error\": \"pitch\", \"half\": 0.0}, {\"station\": \"B 2\", \"error\": \"yaw\", \"half\": 0.0}, "
    "{\"station\": \"C\", \"error\": \"x\", \"half\": 0.0}, {\"station\": \"C\", \"error\": \"y\", \"half\": "
    "0.0}, {\"station\": \"C\", \"error\": \"z\", \"half\": 0.0}, {\"station\": \"C\", \"error\": \"roll\", "
    "\"half\": 0.0}, {\"station\": \"C\", \"error\": \"pitch\", \"half\": 0.0}, {\"station\": \"C\", "
    "\"error\": \"yaw\", \"half\": 0.0}], \"tried\": {\"alike\": 64, \"opposite\": 32, \"alone\": 16, "
    "\"corner\": 8, \"inside\": 4, \"beside\": 2}, \"tried_without_collisions\": {\"alike\": 0, "
    "\"opposite\": 0, \"alone\": 0, \"corner\": 0, \"inside\": 0, \"beside\": 0}, \"inside_errors\": "
    "[\"A.z=-1.249\", \"B 2.roll=0.450\"], \"outside_errors\": [\"A.z=-1.250\", \"B 2.roll=0.450\"], "
    "\"why\": {\"name\": \"expectation\", \"error\": null, \"line\": 8, \"command\": \"\", \"text\": \"W in "
    "B 2\"}},",
    "  \"tightest\": {\"station\": \"B 2\", \"error\": \"roll\", \"width\": 0.90000000000000002, \"rim_mm\": "
    "2.3561944901923448},",
    "  \"next\": {\"station\": \"A\", \"error\": \"z\", \"width\": 2.4990000000000001, \"rim_mm\": "
    "2.4990000000000001}"};

static void the_json_of_two_stations(void **state) {
    (void)state;
    print_json();
    for (size_t i = 0; i < sizeof json_lines / sizeof json_lines[0]; ++i) {
        assert_says(json_lines[i]);
    }
}

static void nothing_failed(void **state) {
    (void)state;
    for (size_t i = 0; i < NUMBERS; ++i) {
        set_error(i / WH_SPREADS, i % WH_SPREADS, 8000, 8000);
    }
    budget.tightest = budget.next = WH_NONE;
    budget.box.outside = budget.box.inside = NULL;
    budget.caught = true;
    print_table();
    assert_says("\n! in trials that passed, the script caught errors: what it then does counts as passing\n");
    assert_says("\nNo station needs better teaching: nothing up to 8 mm and 8 deg makes the run fail\n");
    assert_null(strstr(text, "the first that fails"));
    assert_null(strstr(text, "just inside"));
    assert_null(strstr(text, "passed up to the limit"));
    print_json();
    assert_says("\"inside_errors\": null, \"outside_errors\": null, \"why\": null}");
    assert_says("\n  \"tightest\": null,\n  \"next\": null\n");
    assert_says("\n  \"caught_errors\": true,");
}

static void the_search_was_ended(void **state) {
    (void)state;
    budget.incomplete = true;
    stations[1].errors[5].known = stations[2].errors[0].known = false;
    stations[0].errors[0].width = 0;
    stations[1].errors[4].width = 0;
    print_table();
    assert_says("yaw deg         not known\n");
    assert_says(
        "\n! no width at all, for it fails 0.001 beside where it was taught: x of A, pitch of B 2\n"
        "\n! incomplete, for it was interrupted: 16 of 18 errors are known, and not how they go together\n");
    assert_null(strstr(text, "All errors together"));
    print_json();
    assert_says("\n  \"ok\": false,");
    assert_says("\n  \"interrupted\": true,");
    assert_says("\n  \"all\": null,\n  \"tightest\": null,\n  \"next\": null\n");
    assert_null(strstr(text, "\"station\": \"B 2\", \"error\": \"yaw\""));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_whole_table, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_json_of_two_stations, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_failed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_search_was_ended, set_up, tear_down),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
