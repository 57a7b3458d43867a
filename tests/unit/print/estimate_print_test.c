/* Estimates as tables, JSON and Lua, word for word, for invented figures. */
#include "print/estimate_print.h"

#include <locale.h>

#include "math/trig.h"
#include "support/support.h"

static const wh_style_t piped = {false, true, 0};
static char *text;

static int tear_down(void **state) {
    (void)state;
    free(text);
    text = NULL;
    return 0;
}

static double deg(double degrees) {
    return degrees * WH_PI / 180;
}

static wh_estimate_value_t value(double number, double sd) {
    return (wh_estimate_value_t){number, sd, true};
}

/* ------------------------------------------------------------------------------------------------ figures */

/* Three stations: one with a point set aside, one whose name needs quotes, one that is not determined. */
static const wh_point_table_t *make_points(void) {
    static wh_frame_point_t points[2][4];
    static size_t lines[] = {2, 3, 5, 7};
    static wh_station_points_t stations[3];
    static wh_point_table_t table;
    for (size_t i = 0; i < 4; ++i) {
        const wh_vec3_t known = {10.0 * (double)i, 5, 0}, touched = {700 + 10.0 * (double)i, 5.5, 900};
        points[0][i] = points[1][i] = (wh_frame_point_t){touched, known, false};
    }
    points[0][3].is_set_aside = true;
    wh_frame_estimate_t frame = {.status = WH_OK,
                                 .base_from_station = wh_pose_identity(),
                                 .rpy = {deg(0.5), deg(-0.25), deg(90)},
                                 .rpy_sd = {deg(0.01), deg(0.02), deg(0.004)},
                                 .at_sd = {0.01, 0.02, 0.5},
                                 .used = 3,
                                 .set_aside = 1,
                                 .rms = 0.05,
                                 .largest = 0.0625,
                                 .largest_index = 1};
    frame.base_from_station.r = wh_vec3(700.125, -0.001, 900);
    stations[0] = (wh_station_points_t){
        .name = "A", .points = points[0], .lines = lines, .count = 4, .estimate = frame};
    stations[1] = (wh_station_points_t){
        .name = "end", .points = points[1], .lines = lines, .count = 3, .estimate = frame};
    stations[1].estimate.set_aside = 0;
    stations[2] = (wh_station_points_t){.name = "B \"2\"", .points = points[1], .lines = lines, .count = 2};
    stations[2].estimate =
        (wh_frame_estimate_t){.status = WH_STATUS_BAD_CAPACITY, .reason = "2 points (expected 3 or more)"};
    table = (wh_point_table_t){.csv.path = "points.csv", .stations = stations, .count = 3};
    return &table;
}

/* Theta has all values, r has no jerk, and the chucks are not determined. */
static const wh_move_table_t *make_moves(void) {
    static wh_timed_move_t moves[] = {{90, 1, false}, {45, 0.75, false}, {10, 0.25, true}};
    static size_t lines[] = {2, 3, 4};
    static wh_move_table_t table;
    wh_limits_estimate_t limits = {
        .status = WH_OK,
        .values = {value(300, 0.5), value(1000, 12), value(10000, 300), value(0.05, 0.001)},
        .fitted = {300, 1000, 10000, 0.05},
        .used = 2,
        .set_aside = 1,
        .rms = 0.002,
        .shortest = 10,
        .longest = 90};
    table = (wh_move_table_t){.csv.path = "moves.csv"};
    table.axes[0] = (wh_axis_moves_t){.moves = moves, .lines = lines, .count = 3, .estimate = limits};
    limits.values[WH_LIMIT_JERK].is_determined = false;
    limits.values[WH_LIMIT_DELAY].is_determined = false;
    limits.at_least[WH_LIMIT_JERK] = 5000;
    limits.set_aside = 0;
    (void)snprintf(limits.reason, sizeof limits.reason, "short moves are missing");
    table.axes[1] = (wh_axis_moves_t){.moves = moves, .lines = lines, .count = 2, .estimate = limits};
    table.axes[WH_ROBOT_AXES] = (wh_axis_moves_t){.moves = moves, .lines = lines, .count = 1};
    table.axes[WH_ROBOT_AXES].estimate =
        (wh_limits_estimate_t){.status = WH_STATUS_BAD_CAPACITY, .reason = "1 move (expected 8 or more)"};
    return &table;
}

static wh_touch_table_t *make_touches(void) {
    static wh_touch_t touches[2];
    static size_t lines[] = {2, 4};
    static wh_touch_table_t table;
    wh_geometry_estimate_t found = {.status = WH_OK,
                                    .has_scales = true,
                                    .used = 1,
                                    .set_aside = 1,
                                    .headings = 1,
                                    .rms = 0.04,
                                    .largest = 0.05,
                                    .heading_rms = deg(0.01),
                                    .is_base_determined = true,
                                    .points_from_base = wh_pose_identity(),
                                    .base_rpy = {deg(0.1), deg(-0.2), deg(30)}};
    touches[0] = (wh_touch_t){.axes = {0, 400, 900, 0}, .touched = {1, 2, 3}, .heading = 0.75};
    touches[1] = (wh_touch_t){
        .axes = {0, 500, 950, 0}, .touched = {4, 5, 6}, .heading = (double)NAN, .is_set_aside = true};
    found.points_from_base.r = wh_vec3(12.5, -3, 100);
    for (int i = 0; i < WH_GEOMETRY_PARAMETERS; ++i) {
        found.values[i] = value(i < WH_GEOMETRY_SCALE ? 0.25 * (i + 1) : 1 + 0.001 * i,
                                i < WH_GEOMETRY_SCALE ? 0.01 : 0.0001);
        found.fitted[i] = found.values[i].value;
    }
    /* Angles of 0, whose sines are the same on every machine. */
    found.fitted[WH_GEOMETRY_TILT_X] = found.fitted[WH_GEOMETRY_TILT_Y] = 0;
    found.fitted[WH_GEOMETRY_ZERO + WH_AXIS_THETA] = found.fitted[WH_GEOMETRY_ZERO + WH_AXIS_YAW] = 0;
    found.values[WH_GEOMETRY_ZERO + WH_AXIS_R] = value(-0.75, 0.02);
    found.values[WH_GEOMETRY_SCALE + WH_AXIS_YAW].is_determined = false;
    table = (wh_touch_table_t){
        .csv.path = "touches.csv", .touches = touches, .lines = lines, .count = 2, .estimate = found};
    return &table;
}

/* ------------------------------------------------------------------------------------------------ printed */

enum { FRAMES, LIMITS, GEOMETRY };
enum { TABLE, JSON, LUA };

static int print_frames(int how, FILE *out) {
    const wh_point_table_t *table = make_points();
    if (how == LUA) {
        wh_frames_print_lua(table, out);
        return 0;
    }
    return how == TABLE ? wh_frames_print_table(table, out, &piped) : wh_frames_print_json(table, out);
}

static int print_limits(int how, FILE *out) {
    const wh_move_table_t *table = make_moves();
    if (how == LUA) {
        wh_limits_print_lua(table, out);
        return 0;
    }
    return how == TABLE ? wh_limits_print_table(table, out, &piped) : wh_limits_print_json(table, out);
}

static int print_geometry(const wh_touch_table_t *table, int how, FILE *out) {
    if (how == LUA) {
        wh_geometry_print_lua(table, out);
        return 0;
    }
    return how == TABLE ? wh_geometry_print_table(table, out, &piped) : wh_geometry_print_json(table, out);
}

static void print(int what, int how) {
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(what == FRAMES   ? print_frames(how, out)
                     : what == LIMITS ? print_limits(how, out)
                                      : print_geometry(make_touches(), how, out),
                     0);
    assert_int_equal(fclose(out), 0);
}

static void frames_as_lua(void **state) {
    (void)state;
    print(FRAMES, LUA);
    assert_string_equal(
        text, "stations = {\n"
              "  A = { at = { 700.125, -0.001, 900.00 }, rpy = { 0.500, -0.250, 90.0000 } },\n"
              "  [\"end\"] = { at = { 700.125, -0.001, 900.00 }, rpy = { 0.500, -0.250, 90.0000 } },\n"
              "  -- [\"B \\\"2\\\"\"] is not determined\n"
              "},\n");
}

static void frames_as_a_table(void **state) {
    (void)state;
    print(FRAMES, TABLE);
    assert_string_equal(
        text, "points.csv: 9 points\n"
              "\n"
              "Frames, in base\n"
              "station  value      estimate      sd\n"
              "A        x mm       700.1250  0.0100\n"
              "A        y mm        -0.0010  0.0200\n"
              "A        z mm       900.0000  0.5000\n"
              "A        roll deg     0.5000  0.0100\n"
              "A        pitch deg   -0.2500  0.0200\n"
              "A        yaw deg     90.0000  0.0040\n"
              "end      x mm       700.1250  0.0100\n"
              "end      y mm        -0.0010  0.0200\n"
              "end      z mm       900.0000  0.5000\n"
              "end      roll deg     0.5000  0.0100\n"
              "end      pitch deg   -0.2500  0.0200\n"
              "end      yaw deg     90.0000  0.0040\n"
              "\n"
              "Residuals\n"
              "station  points  set aside  rms mm  largest mm  in line\n"
              "A             4          1  0.0500      0.0625        3\n"
              "end           3          0  0.0500      0.0625        3\n"
              "B \"2\"         2\n"
              "\n"
              "Points touched, less where the frame has them\n"
              "line  station    dx mm   dy mm   dz mm\n"
              "   2  A        -0.1250  0.5010  0.0000\n"
              "   3  A        -0.1250  0.5010  0.0000\n"
              "   5  A        -0.1250  0.5010  0.0000\n"
              "   7  A        -0.1250  0.5010  0.0000\n"
              "   2  end      -0.1250  0.5010  0.0000\n"
              "   3  end      -0.1250  0.5010  0.0000\n"
              "   5  end      -0.1250  0.5010  0.0000\n"
              "\n"
              "A, set aside: lines 7\n"
              "✗ B \"2\": error 7 BAD_CAPACITY: an array that was handed in is too small or too large; 2 "
              "points (expected 3 or more)\n"
              "\n"
              "For a layout\n"
              "stations = {\n"
              "  A = { at = { 700.125, -0.001, 900.00 }, rpy = { 0.500, -0.250, 90.0000 } },\n"
              "  [\"end\"] = { at = { 700.125, -0.001, 900.00 }, rpy = { 0.500, -0.250, 90.0000 } },\n"
              "  -- [\"B \\\"2\\\"\"] is not determined\n"
              "},\n");
}

static void frames_as_json(void **state) {
    (void)state;
    print(FRAMES, JSON);
    assert_string_equal(
        text,
        "{\n"
        "  \"format\": 1,\n"
        "  \"file\": \"points.csv\",\n"
        "  \"ok\": false,\n"
        "  \"stations\": [\n"
        "    {\"name\": \"A\", \"error\": 0, \"status\": \"OK\", \"reason\": null, \"points\": 4, \"at\": "
        "[700.125, -0.001, 900.0], \"at_sd\": [0.01, 0.02, 0.5], \"rpy\": [0.5, -0.25, 90.0], \"rpy_sd\": "
        "[0.01, 0.02, 0.0040000000000000001], \"rms\": 0.050000000000000003, \"largest\": 0.0625, "
        "\"largest_line\": 3, \"set_aside_lines\": [7], \"residuals\": [{\"line\": 2, \"dx\": -0.125, "
        "\"dy\": 0.50100000000000033, \"dz\": 0.0}, {\"line\": 3, \"dx\": -0.125, \"dy\": "
        "0.50100000000000033, \"dz\": 0.0}, {\"line\": 5, \"dx\": -0.125, \"dy\": 0.50100000000000033, "
        "\"dz\": 0.0}, {\"line\": 7, \"dx\": -0.125, \"dy\": 0.50100000000000033, \"dz\": 0.0}]},\n"
        "    {\"name\": \"end\", \"error\": 0, \"status\": \"OK\", \"reason\": null, \"points\": 3, \"at\": "
        "[700.125, -0.001, 900.0], \"at_sd\": [0.01, 0.02, 0.5], \"rpy\": [0.5, -0.25, 90.0], \"rpy_sd\": "
        "[0.01, 0.02, 0.0040000000000000001], \"rms\": 0.050000000000000003, \"largest\": 0.0625, "
        "\"largest_line\": 3, \"set_aside_lines\": [], \"residuals\": [{\"line\": 2, \"dx\": -0.125, \"dy\": "
        "0.50100000000000033, \"dz\": 0.0}, {\"line\": 3, \"dx\": -0.125, \"dy\": 0.50100000000000033, "
        "\"dz\": 0.0}, {\"line\": 5, \"dx\": -0.125, \"dy\": 0.50100000000000033, \"dz\": 0.0}]},\n"
        "    {\"name\": \"B \\\"2\\\"\", \"error\": 7, \"status\": \"BAD_CAPACITY\", \"reason\": \"2 points "
        "(expected 3 or more)\", \"points\": 2}\n"
        "  ],\n"
        "  \"lua\": \"stations = {\\n  A = { at = { 700.125, -0.001, 900.00 }, rpy = { 0.500, -0.250, "
        "90.0000 } },\\n  [\\\"end\\\"] = { at = { 700.125, -0.001, 900.00 }, rpy = { 0.500, -0.250, 90.0000 "
        "} },\\n  -- [\\\"B \\\\\\\"2\\\\\\\"\\\"] is not determined\\n},\\n\"\n"
        "}\n");
}

static void limits_as_lua(void **state) {
    (void)state;
    print(LIMITS, LUA);
    assert_string_equal(text, "robot = {\n"
                              "  theta = { speed = 300.00, acceleration = 1000, jerk = 10000 },\n"
                              "  r = { speed = 300.00, acceleration = 1000 }, -- jerk is not determined\n"
                              "},\n"
                              "-- chuck is not determined\n");
}

static void limits_as_a_table(void **state) {
    (void)state;
    print(LIMITS, TABLE);
    assert_string_equal(text, "moves.csv: 6 moves\n"
                              "\n"
                              "Limits\n"
                              "axis   limit                  estimate       sd  at least\n"
                              "theta  speed deg/s             300.000    0.500\n"
                              "theta  acceleration deg/s^2   1000.000   12.000\n"
                              "theta  jerk deg/s^3          10000.000  300.000\n"
                              "theta  delay s                   0.050    0.001\n"
                              "r      speed mm/s              300.000    0.500\n"
                              "r      acceleration mm/s^2    1000.000   12.000\n"
                              "r      jerk mm/s^3                               5000.000\n"
                              "\n"
                              "Moves\n"
                              "axis   moves  set aside  shortest  longest  rms ms\n"
                              "theta      3          1        10       90   2.000\n"
                              "r          2          0        10       90   2.000\n"
                              "chuck      1          0\n"
                              "\n"
                              "theta, set aside: lines 4\n"
                              "! r: not determined, for want of these: short moves are missing\n"
                              "✗ chuck: error 7 BAD_CAPACITY: an array that was handed in is too small or "
                              "too large; 1 move (expected 8 or more)\n"
                              "\n"
                              "For a layout\n"
                              "robot = {\n"
                              "  theta = { speed = 300.00, acceleration = 1000, jerk = 10000 },\n"
                              "  r = { speed = 300.00, acceleration = 1000 }, -- jerk is not determined\n"
                              "},\n"
                              "-- chuck is not determined\n");
}

static void limits_as_json(void **state) {
    (void)state;
    print(LIMITS, JSON);
    assert_string_equal(
        text,
        "{\n"
        "  \"format\": 1,\n"
        "  \"file\": \"moves.csv\",\n"
        "  \"ok\": false,\n"
        "  \"axes\": [\n"
        "    {\"name\": \"theta\", \"error\": 0, \"status\": \"OK\", \"reason\": null, \"moves\": 3, "
        "\"set_aside_lines\": [4], \"speed\": {\"value\": 300.0, \"sd\": 0.5, \"at_least\": null}, "
        "\"acceleration\": {\"value\": 1000.0, \"sd\": 12.0, \"at_least\": null}, \"jerk\": {\"value\": "
        "10000.0, \"sd\": 300.0, \"at_least\": null}, \"delay\": {\"value\": 0.050000000000000003, \"sd\": "
        "0.001}, \"shortest\": 10.0, \"longest\": 90.0, \"rms_s\": 0.002, \"looks_simulated\": false},\n"
        "    {\"name\": \"r\", \"error\": 0, \"status\": \"OK\", \"reason\": \"short moves are missing\", "
        "\"moves\": 2, \"set_aside_lines\": [], \"speed\": {\"value\": 300.0, \"sd\": 0.5, \"at_least\": "
        "null}, \"acceleration\": {\"value\": 1000.0, \"sd\": 12.0, \"at_least\": null}, \"jerk\": "
        "{\"value\": null, \"sd\": null, \"at_least\": 5000.0}, \"delay\": {\"value\": null, \"sd\": null}, "
        "\"shortest\": 10.0, \"longest\": 90.0, \"rms_s\": 0.002, \"looks_simulated\": false},\n"
        "    {\"name\": \"chuck\", \"error\": 7, \"status\": \"BAD_CAPACITY\", \"reason\": \"1 move "
        "(expected 8 or more)\", \"moves\": 1, \"set_aside_lines\": []}\n"
        "  ],\n"
        "  \"lua\": \"robot = {\\n  theta = { speed = 300.00, acceleration = 1000, jerk = 10000 },\\n  r = { "
        "speed = 300.00, acceleration = 1000 }, -- jerk is not determined\\n},\\n-- chuck is not "
        "determined\\n\"\n"
        "}\n");
}

static void a_geometry_as_lua(void **state) {
    (void)state;
    print(GEOMETRY, LUA);
    assert_string_equal(
        text, "grippers = {\n"
              "  { at = { 2.250, 2.500, 0 }, rpy = { 0, 0, 114.59 } },\n"
              "},\n"
              "-- A layout's robot stands at the origin of base, level. From the touched points' frame:\n"
              "-- base = { at = { 12.500, -3.000, 100.000 }, rpy = { 0.10, -0.20, 30.00 } }\n"
              "-- Poses known in that frame go into base before they are a station's at and rpy.\n"
              "-- A layout's theta is the controller's * 1.01000\n"
              "-- A layout's r is the controller's * 1.01100 - 0.750\n"
              "-- A layout's z is the controller's * 1.01200\n");
}

static void expect_lua(const wh_touch_table_t *table, const char *begin) {
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    wh_geometry_print_lua(table, out);
    assert_int_equal(fclose(out), 0);
    text[strlen(begin) < size ? strlen(begin) : size] = '\0';
    assert_string_equal(text, begin);
}

static void what_is_not_determined_is_a_comment(void **state) {
    (void)state;
    wh_touch_table_t *table = make_touches();
    table->estimate.values[WH_GEOMETRY_TOOL_Y].is_determined = false;
    expect_lua(table, "grippers = {\n  { rpy = { 0, 0, 114.59 } }, -- at is not determined\n},\n");
    table->estimate.values[WH_GEOMETRY_ZERO + WH_AXIS_YAW].is_determined = false;
    table->estimate.is_base_determined = false;
    expect_lua(table,
               "grippers = {\n  { }, -- at is not determined, rpy neither\n},\n-- base is not determined\n");
    table->estimate.values[WH_GEOMETRY_TOOL_Y].is_determined = true;
    expect_lua(table, "grippers = {\n  { at = { 2.250, 2.500, 0 } }, -- rpy is not determined\n},\n");
    table->estimate.status = WH_STATUS_BAD_CAPACITY;
    expect_lua(table, "-- the robot's geometry is not determined\n");
}

static void a_geometry_as_a_table(void **state) {
    (void)state;
    print(GEOMETRY, TABLE);
    assert_string_equal(
        text, "touches.csv: 2 touches\n"
              "\n"
              "Robot, in the touched points' frame\n"
              "number                estimate        sd\n"
              "x mm                  0.250000  0.010000\n"
              "y mm                  0.500000  0.010000\n"
              "tilt_x deg           42.971835  0.572958\n"
              "tilt_y deg           57.295780  0.572958\n"
              "zero_theta deg       71.619724  0.572958\n"
              "zero_r mm            -0.750000  0.020000\n"
              "zero_z mm             1.750000  0.010000\n"
              "zero_yaw deg        114.591559  0.572958\n"
              "tool_x mm             2.250000  0.010000\n"
              "tool_y mm             2.500000  0.010000\n"
              "scale_theta           1.010000  0.000100\n"
              "scale_r               1.011000  0.000100\n"
              "scale_z               1.012000  0.000100\n"
              "scale_yaw       not determined\n"
              "\n"
              "Residuals\n"
              "touches  set aside  rms mm  largest mm  in line  headings  rms deg\n"
              "      1          1  0.0400      0.0500        2         1   0.0100\n"
              "\n"
              "Points touched, less where the robot has them; and where a layout has them\n"
              "line      dx mm    dy mm      dz mm  x in base mm  y in base mm  z in base mm\n"
              "   2  -407.4000  -1.0000  -909.5500       -11.500         5.000       -97.000\n"
              "   4  -505.5000   2.0000  -957.1500        -8.500         8.000       -94.000\n"
              "\n"
              "robot, set aside: lines 4\n"
              "\n"
              "For a layout\n"
              "grippers = {\n"
              "  { at = { 2.250, 2.500, 0 }, rpy = { 0, 0, 114.59 } },\n"
              "},\n"
              "-- A layout's robot stands at the origin of base, level. From the touched points' frame:\n"
              "-- base = { at = { 12.500, -3.000, 100.000 }, rpy = { 0.10, -0.20, 30.00 } }\n"
              "-- Poses known in that frame go into base before they are a station's at and rpy.\n"
              "-- A layout's theta is the controller's * 1.01000\n"
              "-- A layout's r is the controller's * 1.01100 - 0.750\n"
              "-- A layout's z is the controller's * 1.01200\n");
}

static void a_geometry_as_json(void **state) {
    (void)state;
    print(GEOMETRY, JSON);
    assert_string_equal(
        text, "{\n"
              "  \"format\": 1,\n"
              "  \"file\": \"touches.csv\",\n"
              "  \"ok\": true,\n"
              "  \"error\": 0,\n"
              "  \"status\": \"OK\",\n"
              "  \"reason\": null,\n"
              "  \"touches\": 2,\n"
              "  \"set_aside_lines\": [\n"
              "    4\n"
              "  ],\n"
              "  \"set_aside_headings\": [],\n"
              "  \"x\": {\"value\": 0.25, \"sd\": 0.01},\n"
              "  \"y\": {\"value\": 0.5, \"sd\": 0.01},\n"
              "  \"tilt_x\": {\"value\": 42.971834634811742, \"sd\": 0.57295779513082323},\n"
              "  \"tilt_y\": {\"value\": 57.295779513082323, \"sd\": 0.57295779513082323},\n"
              "  \"zero_theta\": {\"value\": 71.619724391352904, \"sd\": 0.57295779513082323},\n"
              "  \"zero_r\": {\"value\": -0.75, \"sd\": 0.02},\n"
              "  \"zero_z\": {\"value\": 1.75, \"sd\": 0.01},\n"
              "  \"zero_yaw\": {\"value\": 114.59155902616465, \"sd\": 0.57295779513082323},\n"
              "  \"tool_x\": {\"value\": 2.25, \"sd\": 0.01},\n"
              "  \"tool_y\": {\"value\": 2.5, \"sd\": 0.01},\n"
              "  \"scale_theta\": {\"value\": 1.01, \"sd\": 0.0001},\n"
              "  \"scale_r\": {\"value\": 1.0109999999999999, \"sd\": 0.0001},\n"
              "  \"scale_z\": {\"value\": 1.012, \"sd\": 0.0001},\n"
              "  \"scale_yaw\": {\"value\": null, \"sd\": null},\n"
              "  \"base\": {\"at\": [12.5, -3.0, 100.0], \"rpy\": [0.10000000000000001, "
              "-0.20000000000000001, 29.999999999999996]},\n"
              "  \"rms\": 0.040000000000000001,\n"
              "  \"largest\": 0.050000000000000003,\n"
              "  \"largest_line\": 2,\n"
              "  \"headings\": 1,\n"
              "  \"heading_rms\": 0.01,\n"
              "  \"residuals\": [\n"
              "    {\"line\": 2, \"dx\": -407.39999999999998, \"dy\": -1.0, \"dz\": -909.54999999999995, "
              "\"in_base\": [-11.5, 5.0, -97.0]},\n"
              "    {\"line\": 4, \"dx\": -505.49999999999994, \"dy\": 2.0, \"dz\": -957.14999999999998, "
              "\"in_base\": [-8.5, 8.0, -94.0]}\n"
              "  ],\n"
              "  \"lua\": \"grippers = {\\n  { at = { 2.250, 2.500, 0 }, rpy = { 0, 0, 114.59 } },\\n},\\n-- "
              "A layout's robot stands at the origin of base, level. From the touched points' frame:"
              "\\n-- base = { at = { 12.500, -3.000, 100.000 }, rpy = { 0.10, -0.20, 30.00 } }\\n-- "
              "Poses known in that frame go into base before they are a station's at and rpy.\\n-- A "
              "layout's theta is the controller's * 1.01000\\n-- A layout's r is the controller's * 1.01100 "
              "- 0.750\\n-- A layout's z is the controller's * 1.01200\\n\"\n"
              "}\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(frames_as_lua, tear_down),
        cmocka_unit_test_teardown(frames_as_a_table, tear_down),
        cmocka_unit_test_teardown(frames_as_json, tear_down),
        cmocka_unit_test_teardown(limits_as_lua, tear_down),
        cmocka_unit_test_teardown(limits_as_a_table, tear_down),
        cmocka_unit_test_teardown(limits_as_json, tear_down),
        cmocka_unit_test_teardown(a_geometry_as_lua, tear_down),
        cmocka_unit_test_teardown(what_is_not_determined_is_a_comment, tear_down),
        cmocka_unit_test_teardown(a_geometry_as_a_table, tear_down),
        cmocka_unit_test_teardown(a_geometry_as_json, tear_down),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
