/* Stations that a host sets: by the axes with which a gripper stands in slot 1. */
#include "support/support.h"

#include "mcs/session.h"

/* Axes are printed as doubles of the library's reals. */
#if defined(WH_FLOAT)
#define NEAR 2e-3
#else
#define NEAR 1e-9
#endif

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

static const char *say(const char *line) {
    (void)wh_session_execute(&session, line, answer, sizeof answer);
    return answer;
}

static void open_cell(const char *layout) {
    const wh_session_options_t options = {.layout = layout, .limits = {.print_to = stderr}};
    assert_true(wh_session_open(&session, &options));
}

static void assert_begins(const char *line, const char *expected) {
    if (strncmp(say(line), expected, strlen(expected)) != 0) {
        fail_msg("%s: answered %s, expected %s", line, answer, expected);
    }
}

/* The number behind " NAME=" in the last answer; false: there is none. */
static bool number_of(const char *name, double *value) {
    char key[32];
    snprintf(key, sizeof key, " %s=", name);
    const char *at = strstr(answer, key);
    *value = at ? strtod(at + strlen(key), NULL) : 0;
    return at != NULL;
}

/* Theta and yaw are reported for the robot that comes from home; they may be a whole turn off. */
static void assert_number(const char *name, double expected) {
    const bool turns = strcmp(name, "theta") == 0 || strcmp(name, "yaw") == 0;
    double value;
    if (!number_of(name, &value) ||
        fabs(turns ? remainder(value - expected, 360) : value - expected) > NEAR) {
        fail_msg("%s=%.17g expected in %s", name, expected, answer);
    }
}

typedef struct {
    const char *layout, *station, *axes[5];
} robot_t;

/* Each kind of robot: axes that were set are reported again, whatever else stands beside the
 * station. Axes that were not named stay, and UNDO restores everything. */
static const robot_t robots[] = {
    {"lua/layouts/paper.lua", "A", {"theta", "r", "z", "yaw"}},
    {"lua/layouts/tilting.lua", "A", {"theta", "r", "z", "yaw"}},
    {"lua/layouts/flip.lua", "A", {"theta", "r", "z", "yaw"}},
    {"lua/layouts/folding.lua", "A", {"theta", "r", "z"}},
    {"lua/layouts/stage.lua", "P", {"theta", "r", "z", "yaw"}},
    {"lua/layouts/vacuum_tool.lua", "PM1", {"theta", "r", "z"}},
    {"lua/layouts/two_robots.lua", "PM", {"theta", "r", "z"}},
};

static void assert_axes(const robot_t *robot, const double expected[]) {
    for (size_t i = 0; i < 5 && robot->axes[i]; ++i) {
        assert_number(robot->axes[i], expected[i]);
    }
}

static void set_and_told(void **state) {
    (void)state;
    (void)wh_test_seed();
    for (size_t r = 0; r < sizeof robots / sizeof robots[0]; ++r) {
        const robot_t *robot = &robots[r];
        double before[5] = {0}, now[5];
        char line[128], query[64];
        open_cell(robot->layout);
        snprintf(query, sizeof query, "STATION %s", robot->station);
        assert_begins(query, "OK station=");
        for (size_t i = 0; i < 5 && robot->axes[i]; ++i) {
            assert_true(number_of(robot->axes[i], &before[i]));
        }
        memcpy(now, before, sizeof now);
        for (size_t i = 0; i < 5 && robot->axes[i]; ++i) {
            now[i] += wh_test_uniform(-0.2, 0.2);
            snprintf(line, sizeof line, "SET_STATION %s %s=%.17g", robot->station, robot->axes[i], now[i]);
            assert_begins(line, "OK station=");
            assert_axes(robot, now);
        }
        while (strncmp(say("UNDO"), "OK", 2) == 0) {
        }
        assert_begins(query, "OK station=");
        assert_axes(robot, before);
        wh_session_close(&session);
    }
}

/* Only motion control's belief changes: the wafer ends up as far aside as the station was set. */
static void a_wafer_goes_where_it_was_set(void **state) {
    (void)state;
    open_cell("lua/layouts/paper.lua");
    assert_begins("SET_STATION B r=700.25 z=899.9", "OK station=B");
    assert_begins("GET A 1", "OK wafer=\"Wafer 1\"");
    assert_begins("PUT B 2", "OK wafer=\"Wafer 1\"");
    assert_begins("OFFSET \"Wafer 1\" B 2", "OK dx=");
    assert_number("dy", 0);
    double dx;
    assert_true(number_of("dx", &dx));
    assert_near(dx, 0.25, NEAR);
    assert_begins("GET B 2", "OK wafer=\"Wafer 1\"");
    wh_session_close(&session);
    open_cell("lua/layouts/paper.lua");
    assert_begins("SET_STATION A z=905", "OK station=A");
    assert_begins(
        "GET A 1",
        "ERROR 42 WAFER_MISSING: there was no wafer to take; EE came closest to Wafer 1: |dr_proj_z|");
    wh_session_close(&session);
}

static void what_cannot_be_changes_nothing(void **state) {
    (void)state;
    static const char *const lines[][2] = {
        {"SET_STATION A r=4000", "ERROR 21 OUT_OF_REACH: "},
        {"SET_STATION A theta=5 z=-5000", "ERROR 22 LIMIT_EXCEEDED: "},
        {"SET_STATION A theta=1000",
         "ERROR 22 LIMIT_EXCEEDED: an axis would leave its travel; theta: 1000 (expected"},
        {"SET_STATION A theta=1e12", "ERROR 22 LIMIT_EXCEEDED: "},
        {"SET_STATION A theta=180 r=-700", "ERROR 21 OUT_OF_REACH: "},
        {"SET_STATION A", "ERROR 48 BAD_ARGUMENT: "},
        {"SET_STATION A flip=0", "ERROR 48 BAD_ARGUMENT: "},
        {"SET_STATION A dx=1", "ERROR 48 BAD_ARGUMENT: "},
        {"SET_STATION A r=nan", "ERROR 48 BAD_ARGUMENT: "},
        {"SET_STATION Q r=700", "ERROR 40 NO_SUCH_STATION: "},
        {"SET_STATION A r=700 gripper=PA", "ERROR 45 NO_SUCH_GRIPPER: "},
        {"STATION A gripper=XX", "ERROR 45 NO_SUCH_GRIPPER: "},
        {"STATION", "ERROR 48 BAD_ARGUMENT: "},
    };
    open_cell("lua/layouts/paper.lua");
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_begins(lines[i][0], lines[i][1]);
        assert_begins("STATION A", "OK station=A theta=0 r=700 z=900 yaw=0");
    }
    assert_begins("UNDO", "ERROR 68 NOTHING_TO_UNDO");
    wh_session_close(&session);
}

static void it_is_kept_and_forgotten(void **state) {
    (void)state;
    static const char *const lines[][2] = {
        {"SAVE before", "OK"},
        {"SET_STATION A z=905", "OK station=A theta=0 r=700 z=905 yaw=0"},
        {"SAVE after", "OK"},
        {"RESTORE before", "OK"},
        {"STATION A", "OK station=A theta=0 r=700 z=900 yaw=0"},
        {"RESTORE after", "OK"},
        {"STATION A", "OK station=A theta=0 r=700 z=905 yaw=0"},
        {"ALARM 21", "OK fault=17"},
        {"SET_STATION A z=906",
         "ERROR 21 OUT_OF_REACH: the arm does not reach this point; on purpose, by fault 17"},
        {"SET_STATION A z=906", "OK station=A theta=0 r=700 z=906 yaw=0"},
        {"ALARM 40", "OK fault=17"},
        {"STATION A", "ERROR 40 NO_SUCH_STATION: "},
        {"STATION A", "OK station=A theta=0 r=700 z=906 yaw=0"},
    };
    open_cell("lua/layouts/paper.lua");
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_begins(lines[i][0], lines[i][1]);
    }
    wh_session_close(&session);
}

/* Its place is unknown, so there is nothing that could stay. */
static void a_station_that_was_never_taught(void **state) {
    (void)state;
    static const char *const lines[][2] = {
        {"STATION A", "ERROR 55 NOT_TAUGHT"},
        {"GET A 1", "ERROR 55 NOT_TAUGHT"},
        {"SET_STATION A theta=0 r=700 z=900", "ERROR 48 BAD_ARGUMENT"},
        {"STATION A", "ERROR 55 NOT_TAUGHT"},
        {"SET_STATION A theta=0 r=700 z=900 yaw=0", "OK station=A theta=0 r=700 z=900 yaw=0"},
        {"GET A 1", "OK wafer=W"},
        {"PUT A 2", "OK wafer=W"},
        {"OFFSET W A 2", "OK dx=0 dy=0"},
    };
    const char *path = "build/stations_test.lua";
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(
        fputs("return { grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, "
              "slots = 25, taught = false } }, wafers = { { name = 'W', station = 'A', slot = 1 } } }",
              file) >= 0);
    assert_int_equal(fclose(file), 0);
    open_cell(path);
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_begins(lines[i][0], lines[i][1]);
    }
    wh_session_close(&session);
}

/* The result of TEACH does not depend on earlier settings, and setting it again changes nothing. */
static void teaching_goes_on_from_what_was_set(void **state) {
    (void)state;
    open_cell("lua/layouts/teach.lua");
    assert_begins("SET_STATION A r=700.15 yaw=0.12", "OK station=A");
    for (int i = 0; i < 3; ++i) {
        double r, yaw, theta;
        assert_begins("TEACH A keep=true", "OK x=");
        assert_begins("STATION A", "OK station=A");
        assert_true(number_of("r", &r));
        assert_true(number_of("yaw", &yaw));
        assert_true(number_of("theta", &theta));
        assert_near(r, 700, 0.005);
        assert_near(theta + yaw, 0, 0.005);
    }
    assert_begins("TEACH A keep=3", "ERROR 48 BAD_ARGUMENT");
    wh_session_close(&session);
}

/* The arm scans the place to which the station was set, and sees the wafers there. */
static void a_map_sees_what_is_where_it_sweeps(void **state) {
    (void)state;
    static const char *const lines[][2] = {
        {"MAP A", "OK codes=1000000000000000000000000 "},
        {"SET_STATION A z=890", "OK station=A"},
        {"MAP A", "OK codes=0100000000000000000000000 "},
        {"GET A 2", "ERROR 107 WRONG_SLOT"},
        {"PUT A 2", "OK wafer=\"Wafer 1\""},
        {"SET_STATION A z=910", "OK station=A"},
        {"MAP A", "OK codes=0000000000000000000000000 "},
        {"SET_STATION A theta=40 z=900", "OK station=A"},
        {"MAP A", "OK codes=0000000000000000000000000 "},
    };
    open_cell("lua/layouts/paper.lua");
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_begins(lines[i][0], lines[i][1]);
    }
    wh_session_close(&session);
}

/* At the port of a robot's own controller a question refers to that robot, and so does a command. */
static void a_robots_own_controller_knows_no_other(void **state) {
    (void)state;
    open_cell("lua/layouts/two_robots.lua");
    session.mcs.wanted.asker.robot = 1;
    assert_begins("STATION IN", "OK station=IN");
    assert_begins("STATION IN robot=VAC", "ERROR 92 NO_SUCH_ROBOT");
    assert_begins("STATION IN gripper=\"VAC blade\"", "ERROR 45 NO_SUCH_GRIPPER");
    assert_begins("STATION PM", "ERROR 48 BAD_ARGUMENT");
    session.mcs.wanted.asker.robot = 0;
    assert_begins("STATION PM", "OK station=PM");
    wh_session_close(&session);
}

/* Two robots that both serve a station are each taught it. */
static void each_robot_by_itself(void **state) {
    (void)state;
    char before[WH_SESSION_ANSWER_BYTES];
    open_cell("lua/layouts/two_robots.lua");
    snprintf(before, sizeof before, "%s", say("STATION IN robot=ATM"));
    assert_begins("STATION IN", "ERROR 91 AMBIGUOUS_ROBOT");
    assert_begins("SET_STATION IN z=901", "ERROR 91 AMBIGUOUS_ROBOT");
    assert_begins("SET_STATION IN robot=VAC z=901", "OK station=IN");
    assert_number("z", 901);
    assert_string_equal(say("STATION IN robot=ATM"), before);
    assert_begins("STATION PM robot=ATM", "ERROR 48 BAD_ARGUMENT");
    wh_session_close(&session);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(set_and_told),
        cmocka_unit_test(a_wafer_goes_where_it_was_set),
        cmocka_unit_test(what_cannot_be_changes_nothing),
        cmocka_unit_test(it_is_kept_and_forgotten),
        cmocka_unit_test(a_station_that_was_never_taught),
        cmocka_unit_test(teaching_goes_on_from_what_was_set),
        cmocka_unit_test(a_map_sees_what_is_where_it_sweeps),
        cmocka_unit_test(a_robots_own_controller_knows_no_other),
        cmocka_unit_test(each_robot_by_itself),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
