/* wh_grasp_is_consistent: true of every table that the library leaves, false as soon as one clause is broken on purpose. */
#include "support/grasp.h"

/* Gripper 0 holds wafer 0; gripper 1 waits where it contests it; gripper 2 comes near wafer 2. */
static void begin_busy(cell_t *cell) {
    cell_begin_default(cell);
    cell_move(cell, 0, 0, 0, -0.25, OPEN);
    cell_set(cell, 1, 0, 0, 0, OPEN);
    cell_set(cell, 2, 2000, 0, -2, OPEN);
    cell_step(cell);
    assert_int_equal(cell->wafer[0].holder, 0);
    assert_int_equal(cell->gripper[1].contest.wafer, 0);
    assert_int_equal(cell->gripper[2].approach.wafer, 2);
}

/* Writes `value` over a good index of a busy table: it is no longer consistent, and with the old one it is again. */
static void breaks(cell_t *cell, int32_t *index, int32_t value) {
    const int32_t good = *index;
    assert_true(wh_grasp_is_consistent(&cell->table));
    *index = value;
    assert_false(wh_grasp_is_consistent(&cell->table));
    *index = good;
    assert_true(wh_grasp_is_consistent(&cell->table));
}

static void a_holder_names_its_wafer(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    breaks(&cell, &cell.wafer[0].holder, WH_NONE);
    breaks(&cell, &cell.wafer[0].holder, 1);
    breaks(&cell, &cell.wafer[0].holder, CELL_GRIPPERS);
    breaks(&cell, &cell.wafer[0].holder, -2);
    breaks(&cell, &cell.gripper[0].wafer, WH_NONE);
    breaks(&cell, &cell.gripper[0].wafer, 1);
    breaks(&cell, &cell.gripper[0].wafer, CELL_WAFERS);
    breaks(&cell, &cell.gripper[0].wafer, -2);
    breaks(&cell, &cell.gripper[1].wafer, CELL_WAFERS);
    breaks(&cell, &cell.gripper[1].wafer, -2);
}

static void no_wafer_has_two_holders(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    breaks(&cell, &cell.gripper[1].wafer, 0);
}

static void no_gripper_has_two_wafers(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    breaks(&cell, &cell.wafer[3].holder, 0);
}

static void what_is_watched_is_a_wafer(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    breaks(&cell, &cell.gripper[2].approach.wafer, CELL_WAFERS);
    breaks(&cell, &cell.gripper[2].approach.wafer, -2);
    breaks(&cell, &cell.gripper[1].contest.wafer, CELL_WAFERS);
    breaks(&cell, &cell.gripper[1].contest.wafer, -2);
}

static void releases_are_over_between_steps(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    breaks(&cell, &cell.wafer[3].released_by, 1);
}

static void an_empty_table_is_consistent(void **state) {
    (void)state;
    wh_grasp_t table;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {NULL, 0, NULL, 0, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &config, &storage), WH_OK);
    assert_true(wh_grasp_is_consistent(&table));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_holder_names_its_wafer),        cmocka_unit_test(no_wafer_has_two_holders),
        cmocka_unit_test(no_gripper_has_two_wafers),       cmocka_unit_test(what_is_watched_is_a_wafer),
        cmocka_unit_test(releases_are_over_between_steps), cmocka_unit_test(an_empty_table_is_consistent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
