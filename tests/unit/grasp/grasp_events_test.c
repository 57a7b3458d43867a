/* Near misses and contests: when they are reported and when not, and with which values. */
#include "support/grasp.h"

/* Gripper 0 comes to 2 mm, 1 mm, 3 mm below wafer 0 in slices 1 to 3. */
static void approach(cell_t *cell) {
    cell_begin_default(cell);
    cell_move(cell, 0, 0, 0, -2, OPEN);
    cell_expect_nothing(cell);
    cell_move(cell, 0, 0, 0, -1, OPEN);
    cell_expect_nothing(cell);
    cell_move(cell, 0, 0, 0, -3, OPEN);
    cell_expect_nothing(cell);
}

static void expect_near_miss_of_slice_2(const cell_t *cell) {
    const wh_event_t *e = cell_expect(cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_int_equal(e->measured_slice, 2);
    assert_near(e->measured.dr_proj_z, 1, 0);
    assert_near(e->measured.margin_projz, -0.5, 0);
    assert_int_equal(e->measured.failed, WH_FAILED_PROJZ);
    assert_false(e->measured.ready);
    assert_int_equal(cell->table.counters.near_misses, 1);
}

static void leaving_is_a_near_miss(void **state) {
    (void)state;
    cell_t cell;
    approach(&cell);
    cell_move(&cell, 0, 0, 0, -4.5, OPEN);
    expect_near_miss_of_slice_2(&cell);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_expect_nothing(&cell);
    cell_move(&cell, 0, 0, 0, -5, CLOSED);
    cell_expect_nothing(&cell);
}

static void leaving_sideways_is_one_too(void **state) {
    (void)state;
    cell_t cell;
    approach(&cell);
    cell_move(&cell, 0, 60, 80, -3, OPEN);
    expect_near_miss_of_slice_2(&cell);
}

static void closing_is_a_near_miss(void **state) {
    (void)state;
    cell_t cell;
    approach(&cell);
    cell_move(&cell, 0, 0, 0, -0.25, CLOSED);
    expect_near_miss_of_slice_2(&cell);
    cell_move(&cell, 0, 0, 0, -3, CLOSED);
    cell_expect_nothing(&cell);
    /* It opens again in the neighbourhood: this is the next approach, with values of its own. */
    cell_move(&cell, 0, 0, 0, -3, OPEN);
    cell_move(&cell, 0, 0, 0, -3, CLOSED);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_near(e->measured.dr_proj_z, 3, 0);
    assert_int_equal(e->measured_slice, 6);
}

static void a_pick_is_none(void **state) {
    (void)state;
    cell_t cell;
    approach(&cell);
    cell_move(&cell, 0, 0, 0, -0.25, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    cell_move(&cell, 0, 0, 0, 300, OPEN);
    cell_expect_nothing(&cell);
    cell_move(&cell, 0, 0, 0, 300, CLOSED);
    cell_expect(&cell, WH_EVENT_RELEASED, 0, 0, WH_NONE);
    assert_int_equal(cell.table.counters.near_misses, 0);
}

static void a_pick_of_another_wafer_is_none(void **state) {
    (void)state;
    cell_t cell;
    approach(&cell);
    cell_place(&cell, 1, 0, 0, -3.25);
    cell_move(&cell, 0, 0, 0, -3, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 1, 0, WH_NONE);
    cell_move(&cell, 0, 0, 0, -50, OPEN);
    cell_expect_nothing(&cell);
}

static void taken_by_another_gripper_is_none(void **state) {
    (void)state;
    for (int other = 1; other <= 2; ++other) {
        cell_t cell;
        approach(&cell);
        cell_set(&cell, 0, 0, 0, -3, other == 1 ? CLOSED : OPEN);
        cell_move(&cell, other, 0, 0, 0, OPEN);
        cell_expect(&cell, WH_EVENT_PICKED, 0, other, WH_NONE);
        cell_move(&cell, 0, 0, 0, -50, OPEN);
        cell_expect_nothing(&cell);
    }
}

static void placing_forgets_the_approach(void **state) {
    (void)state;
    cell_t cell;
    approach(&cell);
    cell_place(&cell, 0, 0, 0, 500);
    cell_move(&cell, 0, 0, 0, -50, OPEN);
    cell_expect_nothing(&cell);
    approach(&cell);
    cell_place(&cell, 1, 0, 0, 500);
    cell_move(&cell, 0, 0, 0, -50, OPEN);
    expect_near_miss_of_slice_2(&cell);
}

static void the_neighbourhood_is_strict_and_configurable(void **state) {
    (void)state;
    cell_t cell;
    wh_grasp_config_t config = wh_grasp_config_default();
    cell_begin_default(&cell);
    cell_move(&cell, 0, 0, 0, -4.5, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    cell_move(&cell, 0, 60, 80, -4, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    cell_move(&cell, 0, 59, 80, 4.25, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, 0);
    config.near_projz = 1;
    config.near_projxy = 55;
    cell_begin(&cell, &config);
    cell_move(&cell, 0, 52, 0, -1, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    cell_move(&cell, 0, 55, 0, 0, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    cell_move(&cell, 0, 52, 0, -0.75, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, 0);
    cell_move(&cell, 0, 52, 0, -2, OPEN);
    assert_int_equal(cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE)->measured.failed,
                     WH_FAILED_PROJZ | WH_FAILED_PROJXY);
}

/* "Closest" weighs both distances in units of their limits: 20 mm beside is nearer than 2 mm below. */
static void closest_is_in_units_of_the_limits(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 0, 0, 0, -2, OPEN);
    cell_move(&cell, 0, 55, 0, -0.25, OPEN);
    cell_move(&cell, 0, 0, 0, -1, OPEN);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_int_equal(e->measured_slice, 2);
    assert_int_equal(e->measured.failed, WH_FAILED_PROJXY);
    assert_near(e->measured.dr_proj_xy_norm, 55, 0);
}

static void a_tilted_gripper_is_told_why(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell.input[0].base_from_gripper = wh_test_pose(wh_test_rotation(1, 0, 0, 0.2), 0, 0, 0);
    cell.input[0].valve = OPEN;
    cell_step(&cell);
    cell_move(&cell, 0, 0, 0, 0, CLOSED);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_int_equal(e->measured.failed, WH_FAILED_PLANAR);
    assert_near(e->measured.n1_proj_n2, cos(0.2), 4 * WH_TEST_ROUNDING);
}

static void of_several_the_nearest_in_z_is_followed(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_place(&cell, 1, 0, 0, -1);
    cell_place(&cell, 2, 0, 0, -4);
    cell_move(&cell, 0, 0, 0, -3, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, 2);
    cell_begin_default(&cell);
    cell_place(&cell, 3, 0, 0, -6);
    cell_move(&cell, 0, 0, 0, -3, OPEN);
    assert_int_equal(cell.gripper[0].approach.wafer, 0);
}

/* Gripper 1 holds wafer 0; gripper 0 comes and is ready on it from slice 2 on. */
static void contest(cell_t *cell) {
    cell_begin_default(cell);
    cell_move(cell, 1, 0, 0, 0, OPEN);
    cell_move(cell, 0, 5, 0, -0.25, OPEN);
    cell_expect_nothing(cell);
    cell_move(cell, 0, 0, 0, 0, OPEN);
    cell_expect_nothing(cell);
}

static void expect_contest_of_slice_2(const cell_t *cell, int holder) {
    const wh_event_t *e = cell_expect(cell, WH_EVENT_CONTESTED, 0, 0, holder);
    assert_int_equal(e->measured_slice, 2);
    assert_near(e->measured.dr_proj_z, 0.25, 0);
    assert_near(e->measured.dr_proj_xy_norm, 5, 0);
    assert_true(e->measured.ready);
    assert_int_equal(cell->table.counters.contested, 1);
}

static void a_contest_ends_when_the_gripper_goes(void **state) {
    (void)state;
    cell_t cell;
    contest(&cell);
    cell_move(&cell, 0, 0, 0, -0.5, OPEN);
    expect_contest_of_slice_2(&cell, 1);
    assert_int_equal(cell.gripper[0].contest.holder, WH_NONE);
    cell_move(&cell, 0, 0, 0, -1, OPEN);
    cell_expect_nothing(&cell);
}

static void a_contest_ends_when_its_valve_closes(void **state) {
    (void)state;
    cell_t cell;
    contest(&cell);
    cell_move(&cell, 0, 0, 0, 0, CLOSED);
    expect_contest_of_slice_2(&cell, 1);
    cell_move(&cell, 0, 0, 0, 0, CLOSED);
    cell_expect_nothing(&cell);
}

static void a_contest_ends_when_the_wafer_goes(void **state) {
    (void)state;
    cell_t cell;
    contest(&cell);
    cell_move(&cell, 1, 0, 0, 50, OPEN);
    expect_contest_of_slice_2(&cell, 1);
}

/* The wafer is released outside the contestant's reach: the contestant does not get it, and this is
 * reported. */
static void a_contest_ends_with_a_release_elsewhere(void **state) {
    (void)state;
    cell_t cell;
    contest(&cell);
    cell_move(&cell, 1, 0, 0, 50, CLOSED);
    assert_int_equal(cell.list.count, 2);
    assert_int_equal(cell.event[0].kind, WH_EVENT_RELEASED);
    assert_int_equal(cell.event[1].kind, WH_EVENT_CONTESTED);
    assert_int_equal(cell.event[1].other, 1);
}

static void a_contest_that_ends_in_a_hand_over_is_none(void **state) {
    (void)state;
    cell_t cell;
    contest(&cell);
    cell_move(&cell, 1, 0, 0, 0, CLOSED);
    cell_expect(&cell, WH_EVENT_HANDED_OVER, 0, 0, 1);
    /* Nor does it end for a third gripper that was also ready on it: that one contests the new
     * holder from now on. */
    contest(&cell);
    cell_move(&cell, 2, 0, 0, 0, OPEN);
    cell_move(&cell, 1, 0, 0, 0, CLOSED);
    cell_expect(&cell, WH_EVENT_HANDED_OVER, 0, 0, 1);
    assert_int_equal(cell.gripper[2].contest.holder, 0);
    cell_move(&cell, 2, 0, 0, 0, CLOSED);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_CONTESTED, 0, 2, 0);
    assert_int_equal(e->measured_slice, 5);
}

/* The contestant takes a free wafer instead. */
static void a_contest_ends_with_another_pick(void **state) {
    (void)state;
    cell_t cell;
    contest(&cell);
    cell_place(&cell, 1, 0, 0, 0.25);
    cell_step(&cell);
    assert_int_equal(cell.list.count, 2);
    assert_int_equal(cell.event[0].kind, WH_EVENT_PICKED);
    assert_int_equal(cell.event[1].kind, WH_EVENT_CONTESTED);
    cell_expect_held(&cell, 1, 0);
}

/* Two grippers each hold a wafer within a third one's reach, and pass each other in height. */
static void a_contest_lasts_while_another_comes_nearer(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 1, 0, 0, 0, OPEN);
    cell_move(&cell, 2, 1000, 0, 0, OPEN);
    cell_set(&cell, 2, 0, 0, 0.25, OPEN);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    assert_int_equal(cell.gripper[0].contest.wafer, 0);
    for (int i = 0; i < 4; ++i) {
        cell_set(&cell, 1, 0, 0, i % 2 ? 0.125 : 0.375, OPEN);
        cell_step(&cell);
        cell_expect_nothing(&cell);
    }
    cell_move(&cell, 1, 0, 0, 0.375, CLOSED);
    cell_expect(&cell, WH_EVENT_HANDED_OVER, 0, 0, 1);
    assert_int_equal(cell.table.counters.contested, 0);
    /* When the first contest does end, the other wafer's begins. */
    cell_begin_default(&cell);
    cell_move(&cell, 1, 0, 0, 0, OPEN);
    cell_move(&cell, 2, 1000, 0, 0, OPEN);
    cell_set(&cell, 2, 0, 0, 0.25, OPEN);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    cell_move(&cell, 1, 0, 0, 40, OPEN);
    cell_expect(&cell, WH_EVENT_CONTESTED, 0, 0, 1);
    assert_int_equal(cell.gripper[0].contest.wafer, 1);
    assert_int_equal(cell.gripper[0].contest.holder, 2);
}

/* An open, empty gripper on a wafer that a lower gripper takes in this very slice contests it at once. */
static void the_second_of_two_contests(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_set(&cell, 0, 0, 0, 0, OPEN);
    cell_move(&cell, 2, 0, 0, 0, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    cell_move(&cell, 2, 0, 0, -9, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_CONTESTED, 0, 2, 0);
    assert_int_equal(e->measured_slice, 1);
}

static void events_have_names(void **state) {
    (void)state;
    static const char *const names[] = {"picked",
                                        "released",
                                        "handed_over",
                                        "near_miss",
                                        "contested",
                                        "bad_input",
                                        "released_unsupported",
                                        "slot_occupied",
                                        "placed_off_centre",
                                        "placed_askew",
                                        "settled",
                                        "hit",
                                        "undecided",
                                        "too_close",
                                        "slipped",
                                        "vacuum_lost",
                                        "fault_armed",
                                        "fault_cleared",
                                        "pushed_through"};
    assert_int_equal(sizeof names / sizeof names[0], WH_EVENT_KINDS);
    for (int kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        assert_string_equal(wh_event_name((wh_event_kind_t)kind), names[kind]);
    }
    assert_string_equal(wh_event_name((wh_event_kind_t)WH_EVENT_KINDS), "unknown");
    assert_string_equal(wh_event_name((wh_event_kind_t)99), "unknown");
}

static void events_come_in_order(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_set(&cell, 2, 2000, 0, 0, OPEN);
    cell_move(&cell, 0, 0, 0, -2, OPEN);
    cell_set(&cell, 0, 0, 0, -2, CLOSED);
    cell_set(&cell, 2, 2000, 0, 0, CLOSED);
    cell_set(&cell, 1, 1000, 0, 0, OPEN);
    cell_step(&cell);
    assert_int_equal(cell.list.count, 3);
    assert_int_equal(cell.event[0].kind, WH_EVENT_PICKED);
    assert_int_equal(cell.event[1].kind, WH_EVENT_RELEASED);
    assert_int_equal(cell.event[2].kind, WH_EVENT_NEAR_MISS);
    assert_non_null(cell_event(&cell, WH_EVENT_RELEASED));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaving_is_a_near_miss),
        cmocka_unit_test(leaving_sideways_is_one_too),
        cmocka_unit_test(closing_is_a_near_miss),
        cmocka_unit_test(a_pick_is_none),
        cmocka_unit_test(a_pick_of_another_wafer_is_none),
        cmocka_unit_test(taken_by_another_gripper_is_none),
        cmocka_unit_test(placing_forgets_the_approach),
        cmocka_unit_test(the_neighbourhood_is_strict_and_configurable),
        cmocka_unit_test(closest_is_in_units_of_the_limits),
        cmocka_unit_test(a_tilted_gripper_is_told_why),
        cmocka_unit_test(of_several_the_nearest_in_z_is_followed),
        cmocka_unit_test(a_contest_ends_when_the_gripper_goes),
        cmocka_unit_test(a_contest_ends_when_its_valve_closes),
        cmocka_unit_test(a_contest_ends_when_the_wafer_goes),
        cmocka_unit_test(a_contest_ends_with_a_release_elsewhere),
        cmocka_unit_test(a_contest_that_ends_in_a_hand_over_is_none),
        cmocka_unit_test(a_contest_ends_with_another_pick),
        cmocka_unit_test(a_contest_lasts_while_another_comes_nearer),
        cmocka_unit_test(the_second_of_two_contests),
        cmocka_unit_test(events_have_names),
        cmocka_unit_test(events_come_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
