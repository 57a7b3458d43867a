/* Several robots in a study: each was taught a station by itself, and moves there. The places of
 * the wafers follow from that alone. */
#include "study/study.h"
#include "support/support.h"

#include <math.h>
#include <stdio.h>

static wh_script_run_t run;

/* ----------------------------------------------------------------------------------------------- the draws */

/* One for each station, robot and axis, all different; the station itself only turns. */
static void each_robot_draws_by_itself(void **state) {
    (void)state;
    enum { STATIONS = 3, ROBOTS = 8 };
    wh_spreads_t spreads[STATIONS];
    double seen[STATIONS * ROBOTS * 3 + STATIONS];
    size_t count = 0;
    for (size_t s = 0; s < STATIONS; ++s) {
        for (size_t i = 0; i < WH_SPREADS; ++i) {
            spreads[s].of[i] = (wh_spread_t){1, WH_SHAPE_NORMAL};
        }
    }
    const wh_trial_t trial = {5, 6};
    wh_errors_t errors = {.robot_count = ROBOTS, .stations = spreads};
    for (size_t s = 0; s < STATIONS; ++s) {
        const wh_displacement_t stands = wh_errors_draw_station(&errors, &trial, s);
        assert_near(wh_vec3_norm(&stands.moved), 0, 0);
        seen[count++] = stands.turn[0];
        for (size_t r = 0; r < ROBOTS; ++r) {
            const wh_vec3_t taught = wh_errors_draw_taught(&errors, &trial, s, r);
            seen[count++] = taught.x;
            seen[count++] = taught.y;
            seen[count++] = taught.z;
        }
    }
    for (size_t i = 0; i < count; ++i) {
        assert_true(fabs(seen[i]) > 0);
        for (size_t j = 0; j < i; ++j) {
            assert_true(fabs(seen[i] - seen[j]) > 0);
        }
    }
    errors.robot_count = 1; /* then the station itself stands elsewhere, as before */
    const wh_vec3_t taught = wh_errors_draw_taught(&errors, &trial, 0, 0);
    const wh_displacement_t stands = wh_errors_draw_station(&errors, &trial, 0);
    assert_near(wh_vec3_norm(&taught), 0, 0);
    assert_true(fabs(stands.moved.x) > 0);
}

/* ------------------------------------------------------------------------------------------ where they end */

static const double pi = 3.14159265358979323846;

/* A way of the wafer in tests/end_to_end/data/taught.lua: by robot 0 or 1, from one station to another. */
typedef struct {
    int robot, from, to;
} leg_t;

/* FROM, IN, OUT, PM, TO as in lua/layouts/two_robots.lua, and the ways in of both robots. */
enum { FROM, IN, OUT, PM, TO, PLACES };
static const char *const names[PLACES] = {"FROM", "IN", "OUT", "PM", "TO"};
static const double places[PLACES][2] = {{-1500, -400}, {-130, -250}, {-130, 250}, {1300, 0}, {-1500, 400}};
static const double headings[PLACES] = {180, 0, 0, 0, 180};
static const leg_t legs[] = {{0, FROM, IN}, {1, IN, PM}, {1, PM, OUT}, {0, OUT, TO}};
static const char *const robots[2] = {"ATM", "VAC"};

/* The place of the blade, and its heading: for the arm without a wrist, which stands at x = 600,
 * along the arm. */
static void blade_at(double taught[PLACES][2][2], int robot, int place, double at[3]) {
    at[0] = places[place][0] - taught[place][robot][0];
    at[1] = places[place][1] - taught[place][robot][1];
    at[2] = robot == 0 ? headings[place] * pi / 180 : atan2(at[1], at[0] - 600);
}

/* The wafer is carried rigidly, and is put down at the place that the blade was taught for the
 * other station. */
static void carry(double taught[PLACES][2][2], double wafer[2]) {
    for (size_t i = 0; i < sizeof legs / sizeof legs[0]; ++i) {
        double from[3];
        double to[3];
        blade_at(taught, legs[i].robot, legs[i].from, from);
        blade_at(taught, legs[i].robot, legs[i].to, to);
        const double c = cos(to[2] - from[2]);
        const double s = sin(to[2] - from[2]);
        const double x = wafer[0] - from[0];
        const double y = wafer[1] - from[1];
        wafer[0] = to[0] + c * x - s * y;
        wafer[1] = to[1] + s * x + c * y;
    }
}

static void a_wafer_ends_where_its_robots_were_taught(void **state) {
    (void)state;
    (void)wh_test_seed();
    for (int round = 0; round < 4; ++round) {
        char texts[4 * PLACES][40];
        const char *errors[4 * PLACES];
        double taught[PLACES][2][2] = {{{0}}};
        size_t count = 0;
        for (size_t i = 0; i < sizeof legs / sizeof legs[0]; ++i) {
            for (int end = 0; end < 2; ++end) {
                const int place = end == 0 ? legs[i].from : legs[i].to;
                for (int axis = 0; axis < 2; ++axis) {
                    const double value = (double)((int)(wh_test_random() % 4001) - 2000) / 1000;
                    taught[place][legs[i].robot][axis] = value;
                    (void)snprintf(texts[count], sizeof texts[count], "%s.%s.%c=%.3f", names[place],
                                   robots[legs[i].robot], axis == 0 ? 'x' : 'y', value);
                    errors[count] = texts[count];
                    ++count;
                }
            }
        }
        const wh_script_run_options_t options = {.script = "tests/end_to_end/data/taught.lua",
                                                 .limits = {.print_to = stderr},
                                                 .unread_parameters = true,
                                                 .errors = errors,
                                                 .error_count = count};
        assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
        double wafer[2] = {places[FROM][0], places[FROM][1]};
        carry(taught, wafer);
        const wh_pose_t *found = &run.record.wafers[0].base_from_wafer;
        assert_near(found->r.x, wafer[0], 1e-9);
        assert_near(found->r.y, wafer[1], 1e-9);
        wh_script_run_close(&run);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_robot_draws_by_itself),
        cmocka_unit_test(a_wafer_ends_where_its_robots_were_taught),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
