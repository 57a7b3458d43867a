/* The core never asks for memory: functions that count replace malloc and its kin in the whole
 * program. */
#include "support/grasp.h"
#include "support/heap.h"

#if defined(WH_TEST_COUNTS_HEAP)

/* One example of everything, through each branch that a run can take. */
static void exercise(wh_check_t check) {
    static cell_t cell;
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    config.seat = check == WH_CHECK_SWEPT;
    cell_begin(&cell, &config);
    for (int i = 0; i < 2000; ++i) {
        for (int g = 0; g < CELL_GRIPPERS; ++g) {
            cell_set_randomly(&cell, g, 150, 8);
        }
        cell_step(&cell);
        if (i % 8 == 0 && cell.wafer[0].holder == WH_NONE) {
            cell_place(&cell, 0, 10, 0, 0);
        }
        wh_proximity_t p;
        assert_int_equal(wh_proximity_measure(&cell.wafer[0].base_from_wafer,
                                              &cell.gripper[0].base_from_gripper, &config.tolerance, &p),
                         WH_OK);
        (void)wh_proximity_rim_gap(&cell.wafer[0].base_from_wafer, &cell.gripper[0].base_from_gripper, 150);
        (void)wh_grasp_hash(&cell.table);
    }
    cell.input[1].valve = 5;
    assert_int_equal(wh_grasp_step(&cell.table, cell.input, &cell.list), WH_STATUS_BAD_VALVE);

    assert_true(cell.table.counters.picked > 5 && cell.table.counters.near_misses > 2);
}

static void nothing_is_allocated(void **state) {
    (void)state;
    (void)wh_test_seed();
    const unsigned long before = calls;
    exercise(WH_CHECK_SAMPLED);
    exercise(WH_CHECK_SWEPT);
    assert_int_equal(calls - before, 0);
}

#else

static void nothing_is_allocated(void **state) {
    (void)state;
    skip();
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(nothing_is_allocated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
