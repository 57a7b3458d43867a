/* The mechanism behind a port: it is found by its name in a layout, with its grippers, and the test
 * checks when two exclude each other. */
#include "host/mechanism.h"

#include <string.h>

#include "support/support.h"

/* Robots ATM and VAC, prealigners P and Q with a gripper each, a station A. */
enum { ROBOTS = 2, STATIONS = 3, GRIPPERS = 4 };

static wh_layout_t layout;

static int set_up(void **state) {
    (void)state;
    static wh_layout_robot_t robots[ROBOTS] = {{.name = "ATM"}, {.name = "VAC"}};
    static wh_layout_station_t stations[STATIONS] = {{.name = "A"}, {.name = "P"}, {.name = "Q"}};
    static wh_station_t places[STATIONS] = {{.chuck = WH_NONE}, {.chuck = 2}, {.chuck = 3}};
    static const int32_t at[GRIPPERS] = {WH_NONE, WH_NONE, 1, 2};
    memset(&layout, 0, sizeof layout);
    layout.robots = robots;
    layout.robot_count = ROBOTS;
    layout.stations = stations;
    layout.station_count = STATIONS;
    layout.places = places;
    layout.machine.gripper_count = GRIPPERS;
    for (size_t g = 0; g < GRIPPERS; ++g) {
        layout.grippers[g].station = at[g];
        layout.machine.mounts[g].robot = g == 1 ? 1 : 0;
    }
    return 0;
}

static wh_port_mechanism_t find(wh_mechanism_t kind, const char *name) {
    wh_port_mechanism_t found = {.kind = WH_MECHANISM_CELL};
    char problem[WH_MECHANISM_PROBLEM];
    assert_true(wh_mechanism_find(kind, name, &layout, &found, problem));
    assert_string_equal(found.name, name);
    return found;
}

static void expect(wh_port_mechanism_t found, wh_mechanism_t kind, int32_t index, uint32_t grippers) {
    assert_int_equal(found.kind, kind);
    assert_int_equal(found.index, index);
    assert_int_equal(found.grippers, grippers);
}

static void a_name_tells_the_kind_and_its_grippers(void **state) {
    (void)state;
    expect(find(WH_MECHANISM_CELL, "ATM"), WH_MECHANISM_ROBOT, 0, 1);
    expect(find(WH_MECHANISM_CELL, "VAC"), WH_MECHANISM_ROBOT, 1, 2);
    expect(find(WH_MECHANISM_CELL, "P"), WH_MECHANISM_ALIGNER, 1, 4);
    expect(find(WH_MECHANISM_ALIGNER, "Q"), WH_MECHANISM_ALIGNER, 2, 8);
    expect(find(WH_MECHANISM_CELL, "A"), WH_MECHANISM_LOAD_PORT, 0, 0);
}

static void without_a_name_it_is_all_of_a_kind(void **state) {
    (void)state;
    expect(wh_mechanism_all(WH_MECHANISM_CELL, &layout), WH_MECHANISM_CELL, WH_NONE, 15);
    expect(wh_mechanism_all(WH_MECHANISM_ROBOT, &layout), WH_MECHANISM_ROBOT, WH_NONE, 3);
    expect(wh_mechanism_all(WH_MECHANISM_ALIGNER, &layout), WH_MECHANISM_ALIGNER, WH_NONE, 12);
    expect(wh_mechanism_all(WH_MECHANISM_LOAD_PORT, &layout), WH_MECHANISM_LOAD_PORT, WH_NONE, 0);
    expect(wh_mechanism_all(WH_MECHANISM_CELL, NULL), WH_MECHANISM_CELL, WH_NONE, 0);
}

static void expect_none(wh_mechanism_t kind, const char *name, const char *wanted) {
    wh_port_mechanism_t found = {.kind = WH_MECHANISM_CELL, .index = 7};
    char problem[WH_MECHANISM_PROBLEM];
    assert_false(wh_mechanism_find(kind, name, &layout, &found, problem));
    assert_string_equal(problem, wanted);
    assert_int_equal(found.index, 7);
}

static void a_name_that_is_none_is_told_with_those_that_are(void **state) {
    (void)state;
    expect_none(WH_MECHANISM_CELL, "X", "X (expected a robot or a station of the layout: ATM, VAC, P, Q, A)");
    expect_none(WH_MECHANISM_ROBOT, "P", "P (expected a robot of the layout: ATM, VAC)");
    expect_none(WH_MECHANISM_ALIGNER, "A", "A (expected a prealigner of the layout: P, Q)");
    expect_none(WH_MECHANISM_LOAD_PORT, "P", "P (expected a station that is no prealigner of the layout: A)");
    expect_none(WH_MECHANISM_LOAD_PORT, "", " (expected a station that is no prealigner of the layout: A)");
}

static bool clash(wh_port_mechanism_t a, wh_port_mechanism_t b) {
    assert_int_equal(wh_mechanisms_clash(&a, &b), wh_mechanisms_clash(&b, &a));
    return wh_mechanisms_clash(&a, &b);
}

static void two_stand_for_different_things(void **state) {
    (void)state;
    const wh_port_mechanism_t cell = wh_mechanism_all(WH_MECHANISM_CELL, &layout);
    const wh_port_mechanism_t robots = wh_mechanism_all(WH_MECHANISM_ROBOT, &layout);
    const wh_port_mechanism_t atm = find(WH_MECHANISM_CELL, "ATM");
    const wh_port_mechanism_t vac = find(WH_MECHANISM_CELL, "VAC");
    const wh_port_mechanism_t p = find(WH_MECHANISM_CELL, "P");
    const wh_port_mechanism_t q = find(WH_MECHANISM_CELL, "Q");
    assert_true(clash(cell, q) && clash(cell, cell) && clash(robots, atm) && clash(atm, atm));
    assert_false(clash(atm, vac) || clash(robots, q) || clash(p, q) || clash(vac, q));
}

static void a_kind_knows_its_words(void **state) {
    (void)state;
    assert_true(wh_mechanism_does(WH_MECHANISM_ROBOT, wh_word_of("GET")));
    assert_false(wh_mechanism_does(WH_MECHANISM_ALIGNER, wh_word_of("GET")));
    assert_false(wh_mechanism_does(WH_MECHANISM_ROBOT, wh_word_of("RESET")));
    assert_true(wh_mechanism_does(WH_MECHANISM_CELL, wh_word_of("RESET")));
    assert_true(wh_mechanism_does(WH_MECHANISM_LOAD_PORT, wh_word_of("OPEN")));
    assert_false(wh_mechanism_does(WH_MECHANISM_ROBOT, wh_word_of("OPEN")));
    assert_true(wh_mechanism_does(WH_MECHANISM_ALIGNER, wh_word_of("FLIP")));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_tells_the_kind_and_its_grippers),
        cmocka_unit_test(without_a_name_it_is_all_of_a_kind),
        cmocka_unit_test(a_name_that_is_none_is_told_with_those_that_are),
        cmocka_unit_test(two_stand_for_different_things),
        cmocka_unit_test(a_kind_knows_its_words),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
