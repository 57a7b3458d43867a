/* Errors that are given by name: each has the place in the trial that a drawn error has, in every
 * trial, and wrong ones are refused. */
#include "trial/given.h"

#include "reading/layout_read.h"
#include "support/layout.h"

#define CELL                                                                                                 \
    "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { A = { at = { 700, 0, 900 }, "   \
    "slots = 2, beams = { { y = 60 }, { y = -110, late = 0.0009 } } }, "                                     \
    "['B=2.x'] = { at = { 0, 700, 900 } }, P = { kind = 'prealigner', at = { -600, 0, 950 }, sensor = {} } " \
    "}, "                                                                                                    \
    "wafers = { { name = 'W1', station = 'A', slot = 1 }, { name = 'W2', station = 'A', slot = 2 } }, "      \
    "study = { placement = { dx = 0.5 }, teaching = { z = 0.1 } }"

#define TWO                                                                                                  \
    "robots = { A = {}, ['V.x'] = { kind = 'TRZ', at = { 2000, 0, 0 } } }, grippers = { { name = 'a', on = " \
    "'A' }, { name = 'v', on = 'V.x' } }, stations = { S = { at = { 1000, 0, 900 }, by = { A = {}, "         \
    "['V.x'] = { rpy = { 0, 0, 180 } } } }, T = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 } } }"

static const char *cell_text = "return { " CELL " }";

typedef struct {
    const char *const *texts;
    size_t count;
    const wh_layout_t *layout;
} asked_t;

static int give(lua_State *L) {
    asked_t *asked = lua_touserdata(L, 1);
    wh_layout_t *layout = wh_layout_read(L, "cell.lua");
    wh_layout_give_errors(L, layout, asked->texts, asked->count);
    asked->layout = layout;
    return 0;
}

/* The cell with these errors; null: refused. */
static const wh_layout_t *give_errors(const char *const texts[], size_t count) {
    lua_State *L = wh_sandbox_state(sandbox);
    asked_t asked = {texts, count, NULL};
    lua_settop(L, 0);
    lua_pushcfunction(L, give);
    lua_pushlightuserdata(L, &asked);
    assert_true(wh_sandbox_evaluate_text(L, "cell.lua", cell_text, strlen(cell_text), &result));
    return wh_sandbox_call(L, 2, 0, &result) ? asked.layout : NULL;
}

static void expect_no(const char *text, const char *message) {
    if (give_errors(&text, 1)) {
        fail_msg("accepted: %s", text);
    }
    if (!strstr(result.message, message) || !strstr(result.message, text)) {
        fail_msg("\"%s\" is not in \"%s\"", message, result.message);
    }
}

static void expect_yes(const char *text) {
    if (!give_errors(&text, 1)) {
        fail_msg("%s", result.message);
    }
}

static void expect_displacement(const wh_displacement_t *found, const double wanted[6]) {
    const double values[] = {found->moved.x, found->moved.y, found->moved.z,
                             found->turn[0], found->turn[1], found->turn[2]};
    for (size_t i = 0; i < 6; ++i) {
        assert_near(values[i], wanted[i], 0);
    }
}

/* Name by name, all different; if a name comes twice, the last one counts. */
static void each_error_arrives_where_it_is_drawn(void **state) {
    (void)state;
    static const char *const texts[] = {"A.x=9",
                                        "A.x=1",
                                        "A.y=2",
                                        "A.z=3",
                                        "A.roll=4",
                                        "A.pitch=5",
                                        "A.yaw=-6",
                                        "B=2.x.z=0.5",
                                        "W2.dx=-1",
                                        "W2.dy=-2",
                                        "W2.dz=-3",
                                        "W2.tilt_x=-4",
                                        "W2.tilt_y=-5",
                                        "W2.turn=170",
                                        "PA.valve=0.25",
                                        "vacuum=0.5",
                                        "W1.notch_depth=0.01",
                                        "A.beam1.dx=0.2",
                                        "A.beam2.dy=-0.3",
                                        "A.beam2.late=0.0001"};
    static const double of_a[] = {1, 2, 3, 4, 5, -6}, of_b[] = {0, 0, 0.5},
                        of_w2[] = {-1, -2, -3, -4, -5, 170}, none[6] = {0};
    const wh_layout_t *layout = give_errors(texts, sizeof texts / sizeof texts[0]);
    if (!layout) {
        fail_msg("%s", result.message);
    }
    const double of_station[6] = {of_b[0], of_b[1], of_b[2], 0, 0, 0};
    for (uint64_t i = 0; i < 3; ++i) {
        const wh_trial_t trial = {3, i};
        const wh_errors_t *errors = layout->errors;
        double rim[WH_RIM_DRAWS];
        const wh_displacement_t found[] = {
            wh_errors_draw_station(errors, &trial, 0), wh_errors_draw_station(errors, &trial, 1),
            wh_errors_draw_station(errors, &trial, 2), wh_errors_draw_wafer(errors, &trial, 0),
            wh_errors_draw_wafer(errors, &trial, 1)};
        expect_displacement(&found[0], of_a);
        expect_displacement(&found[1], of_station);
        expect_displacement(&found[2], none);
        expect_displacement(&found[3], none);
        expect_displacement(&found[4], of_w2);
        assert_near(wh_errors_draw_valve(errors, &trial, 0), 0, 0);
        assert_near(wh_errors_draw_valve(errors, &trial, 1), 0.25, 0);
        assert_near(wh_errors_draw_vacuum(errors, &trial), 0.5, 0);
        wh_errors_draw_rim(errors, &trial, 0, layout->rims[0], rim);
        for (int draw = 0; draw < (int)WH_RIM_DRAWS; ++draw) {
            assert_near(rim[draw], draw == (int)WH_RIM_NOTCH_DEPTH ? 0.01 : 0, 0);
        }
        const double of_beams[2][WH_BEAM_DRAWS] = {{0.2, 0, 0}, {0, -0.3, 0.0001}};
        for (size_t b = 0; b < 2; ++b) {
            double beam[WH_BEAM_DRAWS];
            wh_errors_draw_beam(errors, &trial, b, beam);
            assert_memory_equal(beam, of_beams[b], sizeof beam);
        }
    }
}

/* With several robots, each may have been taught a station by itself; the station stands at its
 * nominal place. */
static void one_of_several_robots_was_taught_beside(void **state) {
    (void)state;
    static const char *const texts[] = {"S.A.x=1", "S.V.x.z=-2", "S.V.x.y=0.5", "T.yaw=3", "T.A.z=4"};
    static const wh_trial_t trial = {3, 9};
    cell_text = "return { " TWO " }";
    const wh_layout_t *layout = give_errors(texts, sizeof texts / sizeof texts[0]);
    if (!layout) {
        fail_msg("%s", result.message);
    }
    const double wanted[2][2][3] = {{{1, 0, 0}, {0, 0.5, -2}}, {{0, 0, 4}, {0, 0, 0}}};
    for (size_t s = 0; s < 2; ++s) {
        for (size_t r = 0; r < 2; ++r) {
            const wh_vec3_t found = wh_errors_draw_taught(layout->errors, &trial, s, r);
            assert_near(found.x, wanted[s][r][0], 0);
            assert_near(found.y, wanted[s][r][1], 0);
            assert_near(found.z, wanted[s][r][2], 0);
        }
        const wh_displacement_t stands = wh_errors_draw_station(layout->errors, &trial, s);
        assert_near(wh_vec3_norm(&stands.moved), 0, 0);
        assert_near(stands.turn[2], s == 1 ? 3 : 0, 0);
    }
    expect_no("S.A.yaw=1", "a station is turned for all of its robots (expected x, y or z)");
    expect_no("S.A.x=100.5", "out of range (expected -100 to 100 mm)");
    expect_no("T.V.x.x=1", "nothing of the layout has that name"); /* does not come there */
    expect_no("S.B.x=1", "nothing of the layout has that name");
    cell_text = "return { " CELL " }";
    expect_no("A.EE.x=1", "nothing of the layout has that name");
}

static void limits_are_kept(void **state) {
    (void)state;
    expect_yes("A.x=100");
    expect_yes("A.z=-100");
    expect_yes("A.yaw=45");
    expect_yes("W1.tilt_y=-45");
    expect_yes("W1.turn=180");
    expect_yes("vacuum=1");
    expect_yes("EE.valve=0");
    expect_no("A.x=100.5", "out of range (expected -100 to 100 mm)");
    expect_no("A.z=-100.5", "out of range (expected -100 to 100 mm)");
    expect_no("A.yaw=45.5", "out of range (expected -45 to 45 degrees)");
    expect_no("W1.tilt_x=-45.5", "out of range (expected -45 to 45 degrees)");
    expect_no("W1.turn=180.5", "out of range (expected -180 to 180 degrees)");
    expect_no("vacuum=1.5", "out of range (expected 0 to 1 s)");
    expect_no("vacuum=-0.5", "out of range (expected 0 to 1 s)");
    expect_no("EE.valve=1.5", "out of range (expected 0 to 1 s)");
    expect_no("EE.valve=-0.5", "out of range (expected 0 to 1 s)");
}

static void what_names_nothing_is_refused(void **state) {
    (void)state;
    expect_no("A.x", "no error (expected NAME.FIELD=VALUE");
    expect_no("A.x=", "no number");
    expect_no("A.x=1 mm", "no number");
    expect_no("A.x=nan", "no number");
    expect_no("A.x=inf", "no number");
    expect_no("C.x=1", "nothing of the layout has that name");
    expect_no("C.dx=1", "nothing of the layout has that name");
    expect_no("W1.x=1", "nothing of the layout has that name");
    expect_no("x=1", "nothing of the layout has that name");
    expect_no("A.valve=1", "no gripper of the layout has that name");
    expect_no("A.vacuum=0.1", "no such error");
    expect_no("A.height=1", "no such error");
    expect_no("0123456789012345678901234567890123456789012345678901234567890123456789"
              "0123456789012345678901234567890123456789012345678901234567890123456789.x=1",
              "no error");
    expect_no("A.notch_depth=0.1", "no wafer of the layout has that name");
    expect_no("W1.flat=0.1", "the wafer's rim has no such thing");
    expect_no("W1.notch_depth=-1", "what is given of the rim leaves none");
    expect_no("W1.saddle_at=10", "there is no saddle");
    expect_no("A.beam3.dx=1", "nothing of the layout has that name");
    expect_no("A.beam1.low=1", "no such error");
    expect_no("A.beam1.dx=5.1", "out of range (expected -5 to 5 mm)");
    expect_no("A.beam1.late=-0.0001", "out of range (expected 0 to 0.001 s)");
    expect_no("A.beam2.late=0.0002", "together with what the layout has of the beam that is out of range");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_error_arrives_where_it_is_drawn),
        cmocka_unit_test(one_of_several_robots_was_taught_beside),
        cmocka_unit_test(limits_are_kept),
        cmocka_unit_test(what_names_nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
