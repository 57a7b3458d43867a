/* Frames, limits and robots from measurements with known answers; values that the measurements do
 * not give; tables that are refused. */
#include "support/support.h"

#include <unistd.h>

#include "estimate/tables.h"
#include "motion/profile.h"

/* ------------------------------------------------------------------------------------------------- frames */

static wh_frame_point_t at(double x, double y, double z, double known_x, double known_y, double known_z) {
    const wh_frame_point_t point = {.touched = {x, y, z}, .known = {known_x, known_y, known_z}};
    return point;
}

static void a_quarter_turn_is_found_exactly(void **state) {
    (void)state;
    wh_frame_point_t points[] = {at(700, 10, 900, 0, 0, 0), at(700, 110, 900, 100, 0, 0),
                                 at(500, 10, 900, 0, 200, 0), at(700, 10, 930, 0, 0, 30)};
    wh_frame_estimate_t frame;
    assert_int_equal(wh_frame_estimate(points, 4, &frame), WH_OK);
    assert_near(frame.base_from_station.r.x, 700, 1e-10);
    assert_near(frame.base_from_station.r.y, 10, 1e-10);
    assert_near(frame.base_from_station.r.z, 900, 1e-10);
    assert_near(frame.rpy[0], 0, 1e-12);
    assert_near(frame.rpy[1], 0, 1e-12);
    assert_near(frame.rpy[2], 1.5707963267948966, 1e-12);
    assert_true(frame.rms < 1e-10 && frame.at_sd[0] < 1e-9 && frame.rpy_sd[2] < 1e-11);
    assert_string_equal(frame.reason, "");
}

static void residuals_are_of_the_points_that_count(void **state) {
    (void)state;
    wh_frame_point_t points[9];
    for (int i = 0; i < 9; ++i) {
        const double x = 100 * (i % 3);
        const double y = 100 * (double)(i / 3);
        const double up = i == 4 ? 0.9 : i % 2 == 0 ? -0.3 : 0.2;
        points[i] = at(x + 5, y, 7 + up, x, y, 0);
    }
    wh_frame_estimate_t frame;
    assert_int_equal(wh_frame_estimate(points, 9, &frame), WH_OK);
    /* The errors are symmetric about the middle: the plane rises by their mean, and nothing turns. */
    const double mean = (0.9 - 4 * 0.3 + 4 * 0.2) / 9;
    assert_int_equal(frame.set_aside, 0);
    assert_near(frame.base_from_station.r.z, 7 + mean, 1e-9);
    assert_near(frame.largest, 0.9 - mean, 1e-9);
    assert_int_equal(frame.largest_index, 4);
    assert_near(frame.rms, sqrt((0.81 + 4 * 0.09 + 4 * 0.04) / 9 - mean * mean), 1e-9);
}

/* Among six points with errors of 0.02 mm, one is 20 mm off, in each place in turn. */
static void a_point_that_contradicts_the_others_is_set_aside(void **state) {
    (void)state;
    static const double off[6][3] = {{0.02, 0, -0.01}, {-0.02, 0.01, 0}, {0.01, -0.02, 0.02},
                                     {0, 0.02, 0.01},  {0.01, 0.01, 0},  {-0.01, -0.02, -0.02}};
    for (size_t wrong = 0; wrong < 6; ++wrong) {
        wh_frame_point_t points[6];
        wh_frame_estimate_t frame;
        for (size_t i = 0; i < 6; ++i) {
            const double x = 150 * cos((double)i);
            const double y = 150 * sin((double)i);
            const double z = i % 2 == 0 ? 0 : 240;
            points[i] = at(700 + x + off[i][0], y + off[i][1], 900 + z + off[i][2], x, y, z);
        }
        points[wrong].touched.y += 20;
        assert_int_equal(wh_frame_estimate(points, 6, &frame), WH_OK);
        assert_int_equal(frame.used, 5);
        assert_int_equal(frame.set_aside, 1);
        assert_near(frame.base_from_station.r.y, 0, 0.05);
        assert_true(frame.rms < 0.04 && frame.largest_index != wrong);
        for (size_t i = 0; i < 6; ++i) {
            assert_int_equal(points[i].is_set_aside, i == wrong);
        }
    }
}

static void frames_that_points_do_not_tell_are_refused(void **state) {
    (void)state;
    wh_frame_estimate_t frame;
    wh_frame_point_t points[] = {at(0, 0, 0, 0, 0, 0), at(100, 0, 0, 100, 0, 0), at(200, 0, 0, 200, 0, 0),
                                 at(0, 50, 0, 0, 50, 0)};
    assert_int_equal(wh_frame_estimate(NULL, 3, &frame), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_frame_estimate(points, 3, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_frame_estimate(points, 2, &frame), WH_STATUS_TOO_FEW_POINTS);
    assert_string_equal(frame.reason, "2 of at least 3 points");
    assert_int_equal(wh_frame_estimate(points, 3, &frame), WH_STATUS_NOT_DETERMINED);
    assert_non_null(strstr(frame.reason, "on a line"));
    assert_int_equal(wh_frame_estimate(points, 4, &frame), WH_OK);
    points[3].touched.y = -50; /* now x and y of the four are mirrored, or z is */
    assert_int_equal(wh_frame_estimate(points, 4, &frame), WH_OK);
    assert_near(frame.rpy[0], 3.141592653589793, 1e-9);
    points[3].touched.y = 500;
    assert_int_equal(wh_frame_estimate(points, 4, &frame), WH_STATUS_NO_FIT);
    points[3].touched.y = (double)NAN;
    assert_int_equal(wh_frame_estimate(points, 4, &frame), WH_STATUS_NO_FIT);
    for (int i = 0; i < 4; ++i) {
        points[i].known = wh_vec3(3, 4, 5);
    }
    points[3].touched.y = 50;
    assert_int_not_equal(wh_frame_estimate(points, 4, &frame), WH_OK);
}

/* ------------------------------------------------------------------------------------------------- limits */

static wh_timed_move_t moves[200];

/* Moves over 1 to 100 % of the travel, with errors of 1 ms that alternate. */
static void make_moves(const wh_limits_t *limits, double travel, double delay) {
    for (int i = 0; i < 200; ++i) {
        wh_profile_t profile;
        const double distance = travel * (0.01 + 0.99 * i / 199);
        assert_int_equal(wh_profile_plan(&profile, distance, limits), WH_OK);
        const double error = (double)((i * 7) % 13 - 6) / 6 * 1.6e-3;
        moves[i] = (wh_timed_move_t){distance, profile.duration + delay + error, false};
    }
}

/* The value that the reason offers for a layout gives the times of the fit, as every larger one does; the
 * bound does not. */
static void an_acceleration_that_is_never_reached_may_be_written_down(void **state) {
    (void)state;
    const wh_limits_t limits = {400, 1500, 4000};
    wh_limits_estimate_t found;
    make_moves(&limits, 420, 0);
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_OK);
    assert_false(found.values[WH_LIMIT_ACCELERATION].is_determined);
    const char *from = strstr(found.reason, "any from ");
    assert_non_null(from);
    wh_limits_t offered = {found.values[WH_LIMIT_SPEED].value, strtod(from + strlen("any from "), NULL),
                           found.values[WH_LIMIT_JERK].value};
    double squares = 0;
    for (int i = 0; i < 200; ++i) {
        wh_profile_t profile;
        wh_profile_t larger;
        wh_limits_t more = offered;
        more.acceleration *= 10;
        assert_int_equal(wh_profile_plan(&profile, moves[i].distance, &offered), WH_OK);
        assert_int_equal(wh_profile_plan(&larger, moves[i].distance, &more), WH_OK);
        assert_near(profile.duration, larger.duration, 1e-6);
        squares += (profile.duration - moves[i].seconds) * (profile.duration - moves[i].seconds);
    }
    assert_true(sqrt(squares / 200) <= 1.02 * found.rms);
    assert_true(offered.acceleration > found.at_least[WH_LIMIT_ACCELERATION]);
}

static void limits_are_found_and_pauses_are_set_aside(void **state) {
    (void)state;
    const wh_limits_t limits = {1000, 5000, 50000};
    wh_limits_estimate_t found;
    make_moves(&limits, 600, 0);
    moves[17].seconds += 0.4;
    moves[150].seconds += 3;
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_OK);
    assert_near(found.values[WH_LIMIT_SPEED].value, 1000, 10);
    assert_near(found.values[WH_LIMIT_ACCELERATION].value, 5000, 50);
    assert_near(found.values[WH_LIMIT_JERK].value, 50000, 500);
    assert_int_equal(found.set_aside, 2);
    assert_true(moves[17].is_set_aside && moves[150].is_set_aside && !moves[18].is_set_aside);
    assert_string_equal(found.reason, "");
    wh_profile_t profile;
    assert_int_equal(wh_profile_plan(&profile, 123.4, &limits), WH_OK);
    assert_near(wh_limits_seconds(&found, 123.4) / profile.duration, 1, 0.01);
}

static void short_moves_tell_no_speed_and_say_so(void **state) {
    (void)state;
    const wh_limits_t limits = {1000, 5000, 50000};
    wh_limits_estimate_t found;
    make_moves(&limits, 60, 0);
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_OK);
    assert_false(found.values[WH_LIMIT_SPEED].is_determined);
    assert_true(found.at_least[WH_LIMIT_SPEED] > 100 && found.at_least[WH_LIMIT_SPEED] < 1000);
    assert_non_null(strstr(found.reason, "speed: moves that reach it, longer than 60"));
    assert_true(found.values[WH_LIMIT_JERK].is_determined);
    assert_near(found.values[WH_LIMIT_JERK].value, 50000, 1500);
}

static void a_delay_is_refused_unless_it_is_asked_for(void **state) {
    (void)state;
    const wh_limits_t limits = {300, 1000, 10000};
    wh_limits_estimate_t found;
    make_moves(&limits, 180, 0.08);
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_STATUS_NO_FIT);
    assert_non_null(strstr(found.reason, "fit the delay as well"));
    assert_int_equal(wh_limits_estimate(moves, 200, true, &found), WH_OK);
    assert_true(found.values[WH_LIMIT_DELAY].is_determined);
    assert_near(found.values[WH_LIMIT_DELAY].value, 0.08, 0.002);
    assert_near(found.values[WH_LIMIT_SPEED].value, 300, 3);
}

static void limits_that_times_do_not_tell_are_refused(void **state) {
    (void)state;
    const wh_limits_t limits = {300, 1000, 10000};
    wh_limits_estimate_t found;
    make_moves(&limits, 180, 0);
    assert_int_equal(wh_limits_estimate(NULL, 9, false, &found), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_limits_estimate(moves, 9, false, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_limits_estimate(moves, WH_LIMITS_MOST_MOVES + 1, false, &found),
                     WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_limits_estimate(moves, 7, false, &found), WH_STATUS_TOO_FEW_POINTS);
    moves[0].seconds = 0;
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_STATUS_OUT_OF_RANGE);
    moves[0].seconds = (double)NAN;
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_STATUS_OUT_OF_RANGE);
    for (int i = 0; i < 200; ++i) { /* all have one length: they give one of the three numbers */
        moves[i] = (wh_timed_move_t){50, 0.4 + 1e-3 * (i % 3), false};
    }
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_STATUS_NOT_DETERMINED);
    for (int i = 0; i < 200; ++i) { /* longer moves are quicker */
        moves[i] = (wh_timed_move_t){1 + i, 3 - 0.01 * i, false};
    }
    assert_int_equal(wh_limits_estimate(moves, 200, false, &found), WH_STATUS_NO_FIT);
    assert_true(found.reason[0] != '\0');
}

/* ------------------------------------------------------------------------------------------------- robots */

#define DEG 0.017453292519943295

static wh_touch_t touches[WH_GEOMETRY_MOST_TOUCHES + 1];

/* A level robot at (800, -300), turned by 90 degrees. Its r reads 2 too little and its z 10 too
 * much; its tool is 20 ahead and 30 to the left of its wrist. It touches at quarter turns, so that
 * sines are 0 and 1. */
static void make_touches(size_t count) {
    static const double s[4] = {0, 1, 0, -1};
    for (size_t i = 0; i < count; ++i) {
        const size_t arm = i % 4;
        const size_t wrist = (arm + i / 4) % 4; /* yaw in quarter turns from the arm */
        const double r = 400 + 50 * (double)(i % 5);
        const double z = 900 + 7 * (double)(i % 3);
        const double ahead = s[(wrist + 1) % 4];
        const double side = s[wrist];
        wh_touch_t *touch = &touches[i];
        *touch = (wh_touch_t){.heading = (double)NAN};
        touch->axes[WH_AXIS_THETA] = (90 * (double)arm - 90) * DEG;
        touch->axes[WH_AXIS_R] = r;
        touch->axes[WH_AXIS_Z] = z;
        touch->axes[WH_AXIS_YAW] = 90 * (double)(i / 4 % 4) * DEG;
        touch->touched.x = 800 + (r + 2) * s[(arm + 1) % 4] + 20 * ahead - 30 * side;
        touch->touched.y = -300 + (r + 2) * s[arm] + 20 * side + 30 * ahead;
        touch->touched.z = z - 10;
    }
}

static void a_robot_is_found_exactly(void **state) {
    (void)state;
    static const double truth[WH_GEOMETRY_SCALE] = {800, -300, 0, 0, 90 * DEG, 2, -10, -5 * DEG, 20, 30};
    wh_geometry_estimate_t found;
    make_touches(24);
    for (size_t i = 0; i < 24; ++i) {
        touches[i].heading = touches[i].axes[WH_AXIS_THETA] + touches[i].axes[WH_AXIS_YAW] + 85 * DEG;
    }
    touches[5].axes[WH_AXIS_R] += 1.5; /* a wrong line, and a wrong heading */
    touches[9].heading += 3 * DEG;
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_OK);
    assert_string_equal(found.reason, "");
    for (int k = 0; k < WH_GEOMETRY_SCALE; ++k) {
        assert_true(found.values[k].is_determined);
        assert_near(found.values[k].value, truth[k], 1e-8);
        assert_true(found.values[k].sd < 1e-5);
    }
    assert_int_equal(found.set_aside, 1);
    assert_true(touches[5].is_set_aside && !touches[6].is_set_aside);
    assert_true(touches[9].is_heading_set_aside && !touches[10].is_heading_set_aside);
    assert_true(found.is_base_determined);
    assert_near(found.points_from_base.r.z, -10, 1e-8);
    assert_near(found.base_rpy[2], 90 * DEG, 1e-9);
    const wh_vec3_t there = wh_geometry_in_base(&found, &touches[0].touched);
    assert_near(there.x, touches[0].touched.y + 300, 1e-6);
    assert_near(there.y, 800 - touches[0].touched.x, 1e-6);
    assert_near(there.z, touches[0].touched.z + 10, 1e-6);
    assert_string_equal(wh_geometry_name(WH_GEOMETRY_ZERO + WH_AXIS_R), "zero_r");
}

/* A controller tells headings to 0.001 degrees: one in three is rounded the other way. */
static void the_last_digit_of_a_heading_is_no_contradiction(void **state) {
    (void)state;
    wh_geometry_estimate_t found;
    make_touches(24);
    for (size_t i = 0; i < 24; ++i) {
        const double rounding = i % 3 == 0 ? 0.001 * DEG : 0;
        touches[i].heading =
            touches[i].axes[WH_AXIS_THETA] + touches[i].axes[WH_AXIS_YAW] + 85 * DEG + rounding;
    }
    touches[9].heading += 0.01 * DEG;
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_OK);
    for (size_t i = 0; i < 24; ++i) {
        assert_int_equal(touches[i].is_heading_set_aside, i == 9);
    }
}

static void robots_that_touches_do_not_tell_say_what_is_missing(void **state) {
    (void)state;
    wh_geometry_estimate_t found;
    make_touches(24);
    for (size_t i = 0; i < 24; ++i) { /* not turned at the wrist */
        const double arm = touches[i].axes[WH_AXIS_THETA] + 90 * DEG;
        const double r = touches[i].axes[WH_AXIS_R] + 22;
        touches[i].axes[WH_AXIS_YAW] = 0;
        touches[i].touched.x = 800 + r * cos(arm) - 30 * sin(arm);
        touches[i].touched.y = -300 + r * sin(arm) + 30 * cos(arm);
    }
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_OK);
    assert_string_equal(found.reason, "zero_r, tool_x: touches with yaw turned; zero_yaw: the tool's "
                                      "heading, in 4 touches or more");
    assert_false(found.values[WH_GEOMETRY_ZERO + WH_AXIS_R].is_determined);
    assert_near(found.values[WH_GEOMETRY_TOOL_Y].value, 30, 1e-6);
    touches[3].axes[WH_AXIS_YAW] = 90 * DEG; /* except this one: it alone gives the value */
    const double arm = touches[3].axes[WH_AXIS_THETA] + 90 * DEG;
    const double r = touches[3].axes[WH_AXIS_R] + 2 - 30;
    touches[3].touched.x = 800 + r * cos(arm) - 20 * sin(arm);
    touches[3].touched.y = -300 + r * sin(arm) + 20 * cos(arm);
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_OK);
    assert_non_null(strstr(found.reason, "zero_r, tool_x: touches like number 4, which alone tells it"));
    for (size_t i = 0; i < 24; ++i) { /* the same touch again and again */
        touches[i] = touches[0];
    }
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_STATUS_NOT_DETERMINED);
    assert_non_null(strstr(found.reason, "theta turned"));
    assert_false(found.is_base_determined);
}

static void robots_are_refused_by_number(void **state) {
    (void)state;
    wh_geometry_estimate_t found;
    memset(touches, 0, sizeof touches);
    make_touches(24);
    assert_int_equal(wh_geometry_estimate(NULL, 24, false, &found), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_geometry_estimate(touches, 24, false, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_geometry_estimate(touches, WH_GEOMETRY_MOST_TOUCHES + 1, false, &found),
                     WH_STATUS_BAD_CAPACITY);
    assert_int_equal(wh_geometry_estimate(touches, 7, false, &found), WH_STATUS_TOO_FEW_POINTS);
    assert_string_equal(found.reason, "7 of at least 8 touches");
    touches[8].touched.z = (double)NAN;
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_STATUS_OUT_OF_RANGE);
    make_touches(24);
    touches[8].axes[WH_AXIS_R] = 1e300;
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_STATUS_OUT_OF_RANGE);
    make_touches(24);
    for (size_t i = 0; i < 24; ++i) { /* one part in a hundred too long */
        touches[i].axes[WH_AXIS_R] /= 1.002;
    }
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_STATUS_NO_FIT);
    assert_string_equal(found.reason, "the scale of r seems to be off by 0.2 %: fit the scales as well");
    assert_int_equal(wh_geometry_estimate(touches, 24, true, &found), WH_OK);
    assert_near(found.values[WH_GEOMETRY_SCALE + WH_AXIS_R].value, 1.002, 1e-7);
    make_touches(24);
    for (size_t i = 0; i < 24; ++i) {
        touches[i].heading = 0.1 * (double)(i * i % 17);
    }
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_STATUS_NO_FIT);
    assert_non_null(strstr(found.reason, "heading"));
    make_touches(24);
    for (size_t i = 0; i < 24; ++i) { /* heights in the place of the sides */
        const double z = touches[i].touched.z;
        touches[i].touched.z = touches[i].touched.y;
        touches[i].touched.y = z;
    }
    assert_int_equal(wh_geometry_estimate(touches, 24, false, &found), WH_STATUS_NO_FIT);
}

/* ------------------------------------------------------------------------------------------------- tables */

static char path[WH_TEST_PATH];

static void write_table(const char *text) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fputs(text, file) >= 0 && fclose(file) == 0, 1);
}

#define POINTS "station,touched_x,touched_y,touched_z,x,y,z\n"

static void assert_refused(const char *text, const char *says) {
    wh_point_table_t table = {.count = 0};
    char message[700];
    write_table(text);
    assert_int_equal(wh_point_table_open(&table, path), WH_STATUS_BAD_TABLE);
    (void)snprintf(message, sizeof message, "%s%s", path, says);
    assert_string_equal(table.csv.message, message);
    wh_point_table_close(&table);
}

static void tables_are_read_by_columns_quotes_and_lines(void **state) {
    (void)state;
    wh_point_table_t table = {.count = 0};
    write_table("\xef\xbb\xbfz, x,y,station,touched_x,touched_y,touched_z\r\n"
                "3,1,2,\"A \"\"1\"\", left\",+1.5e1, -.5 ,7\r\n\n \n"
                "3,1,2,B,1,2,3\r\n4,1,2,\"A \"\"1\"\", left\",1,2,3");
    assert_int_equal(wh_point_table_open(&table, path), WH_OK);
    assert_int_equal(table.count, 2);
    assert_string_equal(table.stations[0].name, "A \"1\", left");
    assert_int_equal(table.stations[0].count, 2);
    assert_int_equal(table.stations[0].lines[1], 6);
    assert_near(table.stations[0].points[0].touched.x, 15, 0);
    assert_near(table.stations[0].points[0].touched.y, -0.5, 0);
    assert_near(table.stations[0].points[1].known.z, 4, 0);
    assert_false(wh_point_table_estimate(&table));
    assert_int_equal(table.stations[1].estimate.status, WH_STATUS_TOO_FEW_POINTS);
    wh_point_table_close(&table);
}

static void tables_are_refused_by_line_column_and_value(void **state) {
    (void)state;
    assert_refused("", ": it is empty (expected a line that names the columns)");
    assert_refused(POINTS, ": it has no line of measurements");
    assert_refused("station,touched_x\n", ":1: no column is named touched_y");
    assert_refused("station,x,x\n", ":1: x: this column is there twice");
    assert_refused("station,touch_x\n",
                   ":1: touch_x: no such column (expected station, touched_x, touched_y, "
                   "touched_z, x, y, z; did you mean touched_x?)");
    assert_refused(POINTS "A,1,2,3,4,5,6\nA,1,2,3,4,nan,6\n",
                   ":3: y: nan (expected a number from -1000000 to 1000000)");
    assert_refused(POINTS "A,1,2,3,4,5,inf\n", ":2: z: inf (expected a number from -1000000 to 1000000)");
    assert_refused(POINTS "A,0x10,2,3,4,5,6\n",
                   ":2: touched_x: 0x10 (expected a number from -1000000 to 1000000)");
    assert_refused(POINTS "A,1,2,3,4,5,\n", ":2: z: nothing (expected a number from -1000000 to 1000000)");
    assert_refused(POINTS "A,1,2,3,4,5,6e9\n", ":2: z: 6e9 (expected a number from -1000000 to 1000000)");
    assert_refused(POINTS ",1,2,3,4,5,6\n",
                   ":2: station: nothing (expected a name of 1 to 63 bytes of UTF-8)");
    assert_refused(POINTS "A\x1b,1,2,3,4,5,6\n",
                   ":2: station: A\\x1B (expected a name of 1 to 63 bytes of UTF-8)");
    assert_refused(POINTS "A,1,2,3,4,5\n", ":2: 6 fields (expected 7, as in the first line)");
    assert_refused(POINTS "\"A,1,2,3,4,5,6\n", ":2: a quote is not closed (expected a \" on this line)");
    assert_refused(POINTS "\"A\"b,1,2,3,4,5,6\n",
                   ":2: something stands behind a quote (expected a comma or the line's end)");
}

static void moves_are_refused_by_axis_way_and_time(void **state) {
    (void)state;
    static const struct {
        const char *line, *says;
    } bad[] = {{"R,1,2,3", ":3: axis: R (expected theta, r, z, yaw or chuck)"},
               {"r,2,2,3", ":3: to: 2 (expected another place than `from`)"},
               {"r,1,2,0", ":3: seconds: 0 (expected a number from 1e-06 to 100000)"}};
    for (size_t i = 0; i < 3; ++i) {
        wh_move_table_t table = {.csv = {.path = NULL}};
        char text[100];
        char message[300];
        (void)snprintf(text, sizeof text, "axis,from,to,seconds\nchuck,1,2,3\n%s\n", bad[i].line);
        write_table(text);
        assert_int_equal(wh_move_table_open(&table, path), WH_STATUS_BAD_TABLE);
        (void)snprintf(message, sizeof message, "%s%s", path, bad[i].says);
        assert_string_equal(table.csv.message, message);
        wh_move_table_close(&table);
    }
}

static void a_move_table_keeps_axes_apart(void **state) {
    (void)state;
    wh_move_table_t table = {.csv = {.path = NULL}};
    write_table("seconds,axis,from,to\n0.5,r,300,900\n0.4,theta,10,-20\n0.3,r,900,899\n");
    assert_int_equal(wh_move_table_open(&table, path), WH_OK);
    assert_int_equal(table.axes[WH_AXIS_R].count, 2);
    assert_int_equal(table.axes[WH_AXIS_THETA].count, 1);
    assert_int_equal(table.axes[WH_AXIS_Z].count, 0);
    assert_near(table.axes[WH_AXIS_THETA].moves[0].distance, 30, 0);
    assert_int_equal(table.axes[WH_AXIS_R].lines[1], 4);
    assert_false(wh_move_table_estimate(&table, false));
    assert_int_equal(table.axes[WH_AXIS_R].estimate.status, WH_STATUS_TOO_FEW_POINTS);
    assert_string_equal(table.axes[WH_AXIS_Z].estimate.reason, "");
    wh_move_table_close(&table);
}

static void a_touch_table_may_lack_headings(void **state) {
    (void)state;
    wh_touch_table_t table = {.count = 0};
    write_table(
        "theta,r,z,yaw,touched_x,touched_y,touched_z,heading\n180,400,900,-90,1,2,3,\n0,1,2,3,4,5,6,90\n");
    assert_int_equal(wh_touch_table_open(&table, path), WH_OK);
    assert_int_equal(table.count, 2);
    assert_near(table.touches[0].axes[WH_AXIS_THETA], 180 * DEG, 1e-12);
    assert_near(table.touches[0].axes[WH_AXIS_R], 400, 0);
    assert_near(table.touches[0].axes[WH_AXIS_YAW], -90 * DEG, 1e-12);
    assert_true(isnan(table.touches[0].heading));
    assert_near(table.touches[1].heading, 90 * DEG, 1e-12);
    assert_near(table.touches[1].touched.z, 6, 0);
    assert_int_equal(table.lines[1], 3);
    assert_false(wh_touch_table_estimate(&table, false));
    assert_int_equal(table.estimate.status, WH_STATUS_TOO_FEW_POINTS);
    wh_touch_table_close(&table);
    write_table("theta,r,z,yaw,touched_x,touched_y,touched_z\n1,2,3,4,5,6,7\n");
    assert_int_equal(wh_touch_table_open(&table, path), WH_OK);
    assert_true(isnan(table.touches[0].heading));
    wh_touch_table_close(&table);
}

static int make_path(void **state) {
    (void)state;
    return close(mkstemp(wh_test_path(path, "estimate")));
}

static int remove_path(void **state) {
    (void)state;
    return remove(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quarter_turn_is_found_exactly),
        cmocka_unit_test(residuals_are_of_the_points_that_count),
        cmocka_unit_test(a_point_that_contradicts_the_others_is_set_aside),
        cmocka_unit_test(frames_that_points_do_not_tell_are_refused),
        cmocka_unit_test(an_acceleration_that_is_never_reached_may_be_written_down),
        cmocka_unit_test(limits_are_found_and_pauses_are_set_aside),
        cmocka_unit_test(short_moves_tell_no_speed_and_say_so),
        cmocka_unit_test(a_delay_is_refused_unless_it_is_asked_for),
        cmocka_unit_test(limits_that_times_do_not_tell_are_refused),
        cmocka_unit_test(a_robot_is_found_exactly),
        cmocka_unit_test(the_last_digit_of_a_heading_is_no_contradiction),
        cmocka_unit_test(robots_that_touches_do_not_tell_say_what_is_missing),
        cmocka_unit_test(robots_are_refused_by_number),
        cmocka_unit_test(tables_are_read_by_columns_quotes_and_lines),
        cmocka_unit_test(tables_are_refused_by_line_column_and_value),
        cmocka_unit_test(moves_are_refused_by_axis_way_and_time),
        cmocka_unit_test(a_move_table_keeps_axes_apart),
        cmocka_unit_test(a_touch_table_may_lack_headings),
    };
    return cmocka_run_group_tests(tests, make_path, remove_path);
}
