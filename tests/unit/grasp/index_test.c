/* The index over wafers and the horizons of grippers, in the caller's buckets: what they are told and what they save. That
 * they change no result is shown by tests/property/horizon_random.c. */
#include "grasp/restore.h"
#include "support/index.h"

static bool covers(const indexed_t *indexed, double x, double y, double z) {
    const wh_pose_t pose = wh_test_at(x, y, z);
    return wh_horizon_is_clear_at(&indexed->cell.table, 0, &pose.r);
}

static void buckets_are_counted(void **state) {
    (void)state;
    const size_t most = (size_t)INT32_MAX / 16;
    assert_int_equal(wh_grasp_buckets(0, 0), 8);
    assert_int_equal(wh_grasp_buckets(3, 2), 8 + 4 * 2 + 5 * 3);
    assert_int_equal(wh_grasp_buckets(3, 2), WH_GRASP_BUCKETS(3, 2));
    assert_int_equal(wh_grasp_buckets(most, most), WH_GRASP_BUCKETS(most, most));
    assert_true(wh_grasp_buckets(most, most) <= INT32_MAX);
    assert_int_equal(wh_grasp_buckets(most + 1, 0), 0);
    assert_int_equal(wh_grasp_buckets(0, most + 1), 0);
    assert_int_equal(wh_grasp_buckets(SIZE_MAX, SIZE_MAX), 0);
}

/* No table can have buckets for that many, however many are handed in. */
static void too_many_wafers_have_no_index(void **state) {
    (void)state;
    static uint32_t bucket;
    cell_t cell;
    cell_begin_default(&cell);
    const wh_grasp_storage_t storage = {
        cell.wafer, (size_t)INT32_MAX / 16 + 1, cell.gripper, CELL_GRIPPERS, &bucket, INT32_MAX};
    assert_int_equal(wh_grasp_init(&cell.table, &cell.table.config, &storage), WH_STATUS_BAD_CAPACITY);
}

static void units_are_whole(void **state) {
    (void)state;
    const double far = WH_INDEX_FAR;
    assert_int_equal(wh_index_whole(WH_REAL(1.9)), 1);
    assert_int_equal(wh_index_whole(WH_REAL(-1.9)), -1);
    assert_int_equal(wh_index_whole(WH_REAL(far / 2)), WH_INDEX_FAR / 2);
    assert_int_equal(wh_index_whole(WH_REAL(far)), WH_INDEX_FAR);
    assert_int_equal(wh_index_whole(WH_REAL(-far)), -WH_INDEX_FAR);
    assert_int_equal(wh_index_whole(WH_REAL(INFINITY)), WH_INDEX_FAR);
    assert_int_equal(wh_index_whole(WH_REAL(-INFINITY)), -WH_INDEX_FAR);
    assert_int_equal(wh_index_whole(WH_REAL(NAN)), -WH_INDEX_FAR);
}

/* Only what is around the gripper is looked at; all wafers where their number is no less work. */
static void search_finds_what_is_around(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    wh_found_t near = indexed_look(&indexed, 3000, 2000, 3, 0);
    assert_non_null(near.listed);
    assert_int_equal(near.count, 1);
    assert_int_equal(wh_index_wafer(&indexed.cell.table, &near, 0), 2 * 8 + 3);
    indexed.buckets[near.listed - indexed.buckets] = MANY;
    assert_int_equal(wh_index_wafer(&indexed.cell.table, &near, 0), 0);
    near = indexed_look(&indexed, 3500, 2500, 3, 0);
    assert_non_null(near.listed);
    assert_int_equal(near.count, 0);
    near = indexed_look(&indexed, 3500, 2500, 3, 1e5);
    assert_null(near.listed);
    assert_int_equal(near.count, MANY);
    assert_int_equal(wh_index_wafer(&indexed.cell.table, &near, 5), 5);
    near = indexed_look(&indexed, 3000, 2000, 3, 1e30);
    assert_null(near.listed);
}

/* As far as the next neighbourhood, and less than 0.1 mm short of it. */
static void horizon_ends_before_a_neighbourhood(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_move(&indexed.cell, 0, 3000, 2000, -37, OPEN);
    cell_move(&indexed.cell, 0, 3000, 2000, -34, OPEN);
    assert_true(covers(&indexed, 3000, 2000, -34));
    assert_true(covers(&indexed, 3000, 2000, -4.6));
    assert_true(covers(&indexed, 3000, 2000, -63.4));
    assert_false(covers(&indexed, 3000, 2000, -4.5));
}

/* Where nothing is around: many times the way of a slice, up to half of the neighbourhood; little after a jump. */
static void horizon_goes_with_the_pace(void **state) {
    (void)state;
    static const double cases[][3] = {
        {0, 1.5, 1.7}, {2, 51, 53}, {1.7, 51, 53}, {1.64, 51, 53}, {500, 1.5, 1.7}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        indexed_t indexed;
        indexed_begin_default(&indexed);
        cell_move(&indexed.cell, 0, 3500 - cases[i][0], 2500, 0, CLOSED);
        cell_move(&indexed.cell, 0, 3500, 2500, 0, OPEN);
        assert_true(covers(&indexed, 3500, 2500, cases[i][1]));
        assert_false(covers(&indexed, 3500, 2500, cases[i][2]));
    }
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_move(&indexed.cell, 0, 3499.5, 2500, 0, CLOSED);
    cell_move(&indexed.cell, 0, 3500, 2500, 0, OPEN);
    assert_true(covers(&indexed, 3500, 2500, 15.9));
    assert_false(covers(&indexed, 3500, 2500, 16));
}

/* After all have looked for a wafer to take, each watches what is around itself. */
static void each_gripper_watches_its_own(void **state) {
    (void)state;
    static const int wafers[CELL_GRIPPERS] = {19, 42, 7};
    for (int check = WH_CHECK_SAMPLED; check <= WH_CHECK_SWEPT; ++check) {
        indexed_t indexed;
        wh_grasp_config_t config = wh_grasp_config_default();
        config.check = (wh_check_t)check;
        indexed_begin(&indexed, &config);
        for (int z = -8; z <= -4; z += 4) {
            for (int g = 0; g < CELL_GRIPPERS; ++g) {
                cell_set(&indexed.cell, g, 1000 * (wafers[g] % 8), 1000 * (wafers[g] / 8), z, OPEN);
            }
            cell_step(&indexed.cell);
            for (int g = 0; g < CELL_GRIPPERS; ++g) {
                assert_int_equal(indexed.cell.gripper[g].approach.wafer, z == -4 ? wafers[g] : WH_NONE);
            }
        }
    }
}

/* Two that are put down elsewhere in the same slice are found there. */
static void released_wafers_are_found(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_set(&indexed.cell, 0, 3000, 2000, -0.25, OPEN);
    cell_move(&indexed.cell, 1, 5000, 1000, -0.25, OPEN);
    cell_set(&indexed.cell, 0, 3500, 2500, -0.25, CLOSED);
    cell_move(&indexed.cell, 1, 5500, 1500, -0.25, CLOSED);
    cell_expect_held(&indexed.cell, 19, WH_NONE);
    cell_expect_held(&indexed.cell, 13, WH_NONE);
    cell_move(&indexed.cell, 2, 3500, 2500, -0.25, OPEN);
    cell_expect_held(&indexed.cell, 19, 2);
    cell_move(&indexed.cell, 0, 5500, 1500, -0.25, OPEN);
    cell_expect_held(&indexed.cell, 13, 0);
}

/* In the neighbourhood it is followed, and the tolerance is what counts; that horizon is of no use afterwards. */
static void horizon_is_of_the_tolerance_while_it_follows(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_move(&indexed.cell, 0, 3000, 2000, -4.4, OPEN);
    assert_int_equal(indexed.cell.gripper[0].approach.wafer, 19);
    assert_false(covers(&indexed, 3000, 2000, -4.4));
    cell_move(&indexed.cell, 0, 3000, 2000, -4.3, OPEN);
    assert_true(covers(&indexed, 3000, 2000, -4.3));
    assert_true(covers(&indexed, 3000, 2000, -4.6));
    cell_move(&indexed.cell, 0, 3000, 2000, -4.6, OPEN);
    assert_int_equal(indexed.cell.table.counters.near_misses, 1);
    assert_false(covers(&indexed, 3000, 2000, -4.6));
}

static void horizon_ends_when_a_wafer_moves(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_move(&indexed.cell, 0, 3500, 2500, 0, OPEN);
    assert_true(covers(&indexed, 3500, 2500, 0));
    cell_place(&indexed.cell, 7, 3500, 2500, 1);
    assert_false(covers(&indexed, 3500, 2500, 0));
    cell_move(&indexed.cell, 0, 3500, 2500, 0, OPEN);
    assert_int_equal(indexed.cell.gripper[0].approach.wafer, 7);
    const wh_found_t near = indexed_look(&indexed, 7000, 0, 0, 0);
    assert_int_equal(near.count, 0);
}

/* What was kept here for another state is of no use: neither cells nor horizons. */
static void restoring_begins_anew(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_move(&indexed.cell, 0, 3500, 2500, 0, OPEN);
    wh_wafer_t wafers[MANY];
    wh_gripper_t grippers[CELL_GRIPPERS];
    memcpy(wafers, indexed.wafer, sizeof wafers);
    memcpy(grippers, indexed.cell.gripper, sizeof grippers);
    wafers[7].base_from_wafer = wh_test_at(3500, 2500, 1);
    assert_int_equal(wh_grasp_restore(&indexed.cell.table, 1, wafers, grippers), WH_OK);
    assert_false(covers(&indexed, 3500, 2500, 0));
    const wh_found_t near = indexed_look(&indexed, 3500, 2500, 0, 0);
    assert_int_equal(near.count, 1);
}

/* 33 km from base's origin and farther there are no horizons, and all wafers are in the same cells. */
static void far_away_everything_is_found(void **state) {
    (void)state;
    static const double places[][3] = {{1e9, 0, 0}, {0, -1e9, 0}, {0, 0, 1e9}};
    for (size_t i = 0; i < 3; ++i) {
        indexed_t indexed;
        indexed_begin_default(&indexed);
        const double *at = places[i];
        cell_move(&indexed.cell, 0, at[0], at[1], at[2], OPEN);
        assert_false(covers(&indexed, at[0], at[1], at[2]));
        cell_place(&indexed.cell, 7, at[0], at[1], at[2]);
        const wh_found_t near = indexed_look(&indexed, at[0], at[1], at[2], 0);
        assert_int_equal(near.count, 1);
        cell_step(&indexed.cell);
        assert_int_equal(indexed.cell.gripper[0].wafer, 7);
    }
}

/* A wafer that stands on edge is found by a gripper beside it, though all others lie level. */
static void tilt_widens_the_search(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    const wh_pose_t upright = wh_test_pose(wh_test_rotation(1, 0, 0, WH_TEST_PI / 2), 3500, 2500, 0);
    assert_int_equal(wh_grasp_place(&indexed.cell.table, 7, &upright), WH_OK);
    cell_move(&indexed.cell, 0, 3500, 2500, 95, OPEN);
    assert_int_equal(indexed.cell.gripper[0].approach.wafer, 7);
}

/* The widest neighbourhood that a table may have, and the narrowest. */
static void neighbourhoods_of_any_size(void **state) {
    (void)state;
    static const double sizes[] = {1e-9, 0.5, 1e3, 1e6};
    for (size_t i = 0; i < 4; ++i) {
        indexed_t indexed;
        wh_grasp_config_t config = wh_grasp_config_default();
        config.near_projz = WH_REAL(sizes[i]);
        config.near_projxy = WH_REAL(sizes[3 - i]);
        indexed_begin(&indexed, &config);
        cell_move(&indexed.cell, 0, 3000, 2000, 0.2, OPEN);
        assert_int_equal(indexed.cell.gripper[0].wafer, 19);
    }
}

/* The index's words: heads, then for each wafer the next and its key. */
static uint32_t *node(indexed_t *indexed, size_t w) {
    return indexed->buckets + 8 + 4 * CELL_GRIPPERS + 2 * (MANY + w);
}

/* Each list goes round and round: a search finds too many, and looks at all instead. */
static void endless_lists_end(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    cell_place(&indexed.cell, 20, 3400, 2000, 0);
    const wh_pose_t from = wh_test_at(3000, 2000, 3);
    const wh_pose_t to = wh_test_at(3400, 2000, 3);
    wh_found_t near = wh_index_near(&indexed.cell.table, 0, &from.r, &to.r, 0);
    assert_non_null(near.listed);
    assert_int_equal(near.count, 2);
    for (size_t w = 0; w < MANY; ++w) {
        node(&indexed, w)[0] = (uint32_t)w;
    }
    near = indexed_look(&indexed, 3000, 2000, 3, 0);
    assert_non_null(near.listed);
    assert_int_equal(near.count, MANY);
    near = wh_index_near(&indexed.cell.table, 0, &from.r, &to.r, 0);
    assert_null(near.listed);
    assert_int_equal(near.count, MANY);
    cell_place(&indexed.cell, 19, 3100, 2000, 0);
    cell_place(&indexed.cell, 5, 3100, 2000, 0);
}

/* Any words whatever: every call comes back, and who holds what stays sound. */
static void any_words_are_survived(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    for (int round = 0; round < 3000; ++round) {
        const uint32_t mask = UINT32_MAX >> wh_test_below(32);
        for (size_t i = 0; i < sizeof indexed.buckets / sizeof indexed.buckets[0]; ++i) {
            indexed.buckets[i] = (uint32_t)wh_test_random() & mask;
        }
        for (int g = 0; g < CELL_GRIPPERS; ++g) {
            cell_set_randomly(&indexed.cell, g, 300, 30);
        }
        cell_step(&indexed.cell);
        const wh_pose_t pose = wh_test_at(wh_test_uniform(-300, 300), 0, 0);
        (void)wh_grasp_place(&indexed.cell.table, wh_test_below(MANY), &pose);
        for (int g = 0; g < CELL_GRIPPERS; ++g) {
            const int32_t w = indexed.cell.gripper[g].wafer;
            assert_in_range(w + 1, 0, MANY);
            assert_true(w == WH_NONE || indexed.wafer[w].holder == g);
        }
    }
}

int main(void) {
    (void)wh_test_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buckets_are_counted),
        cmocka_unit_test(too_many_wafers_have_no_index),
        cmocka_unit_test(units_are_whole),
        cmocka_unit_test(search_finds_what_is_around),
        cmocka_unit_test(horizon_ends_before_a_neighbourhood),
        cmocka_unit_test(horizon_goes_with_the_pace),
        cmocka_unit_test(each_gripper_watches_its_own),
        cmocka_unit_test(released_wafers_are_found),
        cmocka_unit_test(horizon_is_of_the_tolerance_while_it_follows),
        cmocka_unit_test(horizon_ends_when_a_wafer_moves),
        cmocka_unit_test(restoring_begins_anew),
        cmocka_unit_test(far_away_everything_is_found),
        cmocka_unit_test(tilt_widens_the_search),
        cmocka_unit_test(neighbourhoods_of_any_size),
        cmocka_unit_test(endless_lists_end),
        cmocka_unit_test(any_words_are_survived),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
