/* The index over wafers and the horizons of grippers, in the caller's buckets: their contents, and
 * the work that they save. tests/property/horizon_random.c shows that they change no result. */
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

/* No table can have buckets for so many wafers, however many are passed in. */
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

/* Only the surroundings of the gripper are searched, or all wafers if their number means no more work. */
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

/* The horizon reaches to the next neighbourhood, and less than 0.1 mm short of it. */
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

/* If nothing is near: many times the way of a slice, up to half of the neighbourhood; only a little
 * after a jump. */
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

/* After all grippers have looked for a wafer to take, each watches its own surroundings. */
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

/* In the neighbourhood the wafer is followed, and the tolerance counts; the earlier horizon is void
 * afterwards. */
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

/* Data kept here for another state are void: neither cells nor horizons are used. */
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

/* Each list is circular: a search finds too many, and looks at all instead. */
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

/* Any words at all: every call returns, and the relation of holders and wafers stays sound. */
static void any_words_are_survived(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    for (int round = 0; round < 3000 / WH_TEST_SHARE; ++round) {
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

/* ---------------------------------------------------------------------------------------------------- cells */

/* The layout of the index in the caller's buckets: extents, cells, lists, and the cells that a
 * search looks at. index_test.c tests its use. */

/* The definition of the first three words, for wafers that all lie like this. */
static void expect_extents(const indexed_t *indexed, const wh_mat3_t *R, double projz, double projxy) {
    for (size_t axis = 0; axis < 3; ++axis) {
        const double row[3] = {(double)R->m[axis][0], (double)R->m[axis][1], (double)R->m[axis][2]};
        const double reach = fabs(row[2]) * projz + sqrt(row[0] * row[0] + row[1] * row[1]) * projxy;
        const double extent = 64 * (reach + 8 * (double)WH_ROTATION_TOLERANCE * (projz + projxy));
        /* Up to the next unit. */
        const double slack = 16 * WH_TEST_ROUNDING * extent;
        assert_near(indexed->buckets[axis], extent + 0.5, 0.5 + slack);
    }
}

static void extents_are_those_of_the_neighbourhood(void **state) {
    (void)state;
    static const double sizes[][2] = {{4.5, 100}, {4.4, 60.3}, {0.7, 50}, {1e6, 0.3}, {1e6, 1e6}, {200, 300}};
    for (size_t i = 0; i < 6 * 10; ++i) {
        const double projz = sizes[i / 10][0];
        const double projxy = sizes[i / 10][1];
        wh_grasp_config_t config = wh_grasp_config_default();
        config.tolerance.projz = WH_REAL(0.6);
        config.tolerance.projxy = WH_REAL(55);
        config.near_projz = WH_REAL(projz);
        config.near_projxy = WH_REAL(projxy);
        indexed_t indexed;
        indexed_begin(&indexed, &config);
        const wh_mat3_t R = i % 10 == 0 ? wh_mat3_identity() : wh_test_random_turn(WH_TEST_PI);
        for (size_t w = 0; w < MANY; ++w) {
            indexed.wafer[w].base_from_wafer.R = R;
        }
        wh_index_build(&indexed.cell.table);
        expect_extents(&indexed, &R, projz, fmax(projxy, 55));
    }
}

/* The widest along each axis counts, wherever it stands among them, and still counts when it is gone. */
static void the_widest_counts(void **state) {
    (void)state;
    const wh_mat3_t level = wh_mat3_identity();
    const wh_pose_t upright = wh_test_pose(wh_test_rotation(1, 0, 0, WH_TEST_PI / 2), 3500, 2500, 0);
    const wh_pose_t flat = wh_test_at(3500, 2500, 0);
    static const size_t which[] = {0, 7, MANY - 1};
    for (size_t i = 0; i < 3; ++i) {
        indexed_t indexed;
        indexed_begin_default(&indexed);
        expect_extents(&indexed, &level, 4.5, 100);
        const uint32_t shifts[3] = {indexed.buckets[3], indexed.buckets[4], indexed.buckets[5]};
        assert_int_equal(wh_grasp_place(&indexed.cell.table, which[i], &upright), WH_OK);
        const uint32_t wide = indexed.buckets[0];
        assert_int_equal(indexed.buckets[1], wide);
        assert_int_equal(indexed.buckets[2], wide);
        assert_int_equal(wh_grasp_place(&indexed.cell.table, which[i], &flat), WH_OK);
        assert_int_equal(indexed.buckets[2], wide);
        assert_memory_equal(shifts, &indexed.buckets[3], sizeof shifts);
        indexed.wafer[which[i]].base_from_wafer = upright;
        wh_index_build(&indexed.cell.table);
        assert_int_equal(indexed.buckets[2], wide);
        assert_true(indexed.buckets[5] > shifts[2]);
        indexed.wafer[which[i]].base_from_wafer = flat;
        wh_index_build(&indexed.cell.table);
        expect_extents(&indexed, &level, 4.5, 100);
    }
}

/* The shortest power of two, from 16 mm on, that is at least twice the extent and an eighth of the
 * whole neighbourhood. */
static void cells_are_as_long_as_needed(void **state) {
    (void)state;
    /* Among them one has an extent of 8192 units, and for another an eighth is as much. */
    static const double sizes[] = {1e-9, 0.5,     3.99, 7.9,     8.1,  20,     127.988,
                                   256,  1023.94, 1e3,  262.5e3, 70e3, 262143, 1e6};
    for (size_t i = 0; i < 14 * 14; ++i) {
        wh_grasp_config_t config = wh_grasp_config_default();
        config.tolerance.projz = WH_REAL(1e-6);
        config.tolerance.projxy = WH_REAL(1e-6);
        config.near_projz = WH_REAL(sizes[i % 14]);
        config.near_projxy = WH_REAL(sizes[i / 14]);
        indexed_t indexed;
        indexed_begin(&indexed, &config);
        const double eighth =
            floor(64 * fmax(sizes[i % 14], 1e-6) / 8 + 64 * fmax(sizes[i / 14], 1e-6) / 8 + 1);
        for (size_t axis = 0; axis < 3; ++axis) {
            uint32_t shift = 10;
            while ((double)(UINT64_C(1) << shift) < fmax(2.0 * indexed.buckets[axis], eighth)) {
                ++shift;
            }
            assert_int_equal(indexed.buckets[3 + axis], shift);
        }
    }
}

static void limits_are_the_larger_ones(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    wh_grasp_config_t *config = &indexed.cell.table.config;
    const wh_real_t sizes[] = {3, 5};
    for (int i = 0; i < 16; ++i) {
        config->near_projz = sizes[i & 1];
        config->tolerance.projz = sizes[i >> 1 & 1];
        config->near_projxy = sizes[i >> 2 & 1];
        config->tolerance.projxy = sizes[i >> 3];
        const wh_near_limits_t limits = wh_index_limits(&indexed.cell.table);
        assert_near(limits.projz, i & 3 ? 5 : 3, 0);
        assert_near(limits.projxy, i >> 2 ? 5 : 3, 0);
    }
}

/* Each wafer stands in one list, that of its key's head; the lists contain nothing else. Returns
 * the longest list. */
static size_t expect_lists(const indexed_t *indexed) {
    const uint32_t *heads = indexed->buckets + 8 + 4 * CELL_GRIPPERS;
    const uint32_t *nodes = heads + 2 * MANY;
    size_t found = 0;
    size_t longest = 0;
    bool seen[MANY] = {false};
    for (uint64_t h = 0; h < 2 * MANY; ++h) {
        size_t length = 0;
        for (uint32_t w = heads[h]; w != UINT32_MAX; w = nodes[2 * w]) {
            assert_in_range(w, 0, MANY - 1);
            assert_false(seen[w]);
            assert_true((uint64_t)nodes[2 * w + 1] * (2 * MANY) >> 32 == h);
            seen[w] = true;
            ++length;
        }
        longest = length > longest ? length : longest;
        found += length;
    }
    assert_int_equal(found, MANY);
    return longest;
}

static void lists_hold_every_wafer_once(void **state) {
    (void)state;
    static const uint32_t words[] = {0, 1, MANY - 1, UINT32_MAX, 0x12345678};
    for (size_t i = 0; i < 5; ++i) {
        indexed_t indexed;
        indexed_begin_default(&indexed);
        for (size_t k = 0; k < sizeof indexed.buckets / sizeof indexed.buckets[0]; ++k) {
            indexed.buckets[k] = words[i];
        }
        wh_index_build(&indexed.cell.table);
        (void)expect_lists(&indexed);
        assert_int_equal(indexed.buckets[WH_INDEX_FOUND], UINT32_MAX);
        for (int run = 0; run < 500 / WH_TEST_SHARE; ++run) {
            const double reach = run % 3 ? 100 : 1e5;
            const double x = wh_test_uniform(-reach, reach);
            const double y = wh_test_uniform(-reach, reach);
            cell_place(&indexed.cell, wh_test_below(MANY), x, y, wh_test_uniform(-reach, reach));
            (void)expect_lists(&indexed);
        }
    }
}

/* Wafers in a row, a field, a rack: a look at one cell passes few others. */
static void lists_are_short(void **state) {
    (void)state;
    static const int shapes[][3] = {{64, 1, 1}, {1, 64, 1}, {1, 1, 64}, {8, 8, 1},
                                    {8, 1, 8},  {1, 8, 8},  {4, 4, 4}};
    static const double pitches[][3] = {
        {300, 300, 20}, {256, 256, 16}, {1000, 1000, 1000}, {2048, 2048, 2048}};
    size_t sum = 0;
    for (size_t i = 0; i < 7 * 4; ++i) {
        const int *shape = shapes[i / 4];
        const double *pitch = pitches[i % 4];
        indexed_t indexed;
        indexed_begin_default(&indexed);
        for (int w = 0; w < MANY; ++w) {
            const int x = w % shape[0];
            const int y = w / shape[0] % shape[1];
            cell_place(&indexed.cell, (size_t)w, x * pitch[0], y * pitch[1],
                       w / (shape[0] * shape[1]) * pitch[2]);
        }
        const size_t longest = expect_lists(&indexed);
        assert_in_range(longest, 1, 6);
        sum += longest;
    }
    assert_in_range(sum, 0, 4 * 28);
}

/* A box of cells: from the first unit of one to the last unit of another. */
typedef struct {
    int64_t first[3], last[3];
} units_t;

static double place_of(int64_t unit) {
    return (double)unit / 64;
}

/* Looks at all wafers less than a unit from this box. The box lies between two places at the
 * distance of the neighbourhood, the margin and two units. */
static wh_found_t look_at(indexed_t *indexed, const units_t *units, uint32_t margin, bool back) {
    double from[3];
    double to[3];
    for (size_t axis = 0; axis < 3; ++axis) {
        const int64_t half = (int64_t)indexed->buckets[axis] + (margin + 1) + 2;
        from[axis] = place_of(units->first[axis] + half);
        to[axis] = place_of(units->last[axis] - half);
    }
    const wh_pose_t a = wh_test_at(from[0], from[1], from[2]);
    const wh_pose_t b = wh_test_at(to[0], to[1], to[2]);
    return wh_index_near(&indexed->cell.table, 0, back ? &b.r : &a.r, back ? &a.r : &b.r,
                         WH_REAL(place_of((int64_t)margin)));
}

static bool is_listed(const wh_found_t *near, uint32_t wafer) {
    for (size_t i = 0; i < near->count; ++i) {
        if (near->listed[i] == wafer) {
            return true;
        }
    }
    return false;
}

/* The wafer is found at the box's first or last place along each axis; one unit outside it is not. */
static void expect_found_inside(indexed_t *indexed, const units_t *units, uint32_t margin) {
    for (size_t corner = 0; corner < 8; ++corner) {
        for (size_t outside = 0; outside < 8; ++outside) {
            double at[3];
            for (size_t axis = 0; axis < 3; ++axis) {
                const int64_t beyond = outside >> axis & 1;
                at[axis] =
                    place_of(corner >> axis & 1 ? units->last[axis] + beyond : units->first[axis] - beyond);
            }
            cell_place(&indexed->cell, 5, at[0], at[1], at[2]);
            const wh_found_t near = look_at(indexed, units, margin, corner % 2);
            assert_non_null(near.listed);
            assert_true(is_listed(&near, 5) == (outside == 0));
        }
    }
    cell_place(&indexed->cell, 5, 9e5, 9e5, 9e5);
}

/* This number of cells along each axis, on both sides of base's origin or on one. */
static units_t units_of(const indexed_t *indexed, const int64_t count[3]) {
    static const int64_t first[] = {-3, -20, -3};
    units_t units;
    for (size_t axis = 0; axis < 3; ++axis) {
        const int64_t edge = INT64_C(1) << indexed->buckets[3 + axis];
        units.first[axis] = first[axis] * edge;
        units.last[axis] = (first[axis] + count[axis]) * edge - 1;
    }
    return units;
}

/* It looks at as many cells as there are wafers, and not at one more. */
static void cells_are_counted(void **state) {
    (void)state;
    static const int64_t counts[][3] = {
        {1, 1, 1},  {64, 1, 1}, {65, 1, 1},  {1, 64, 1},  {1, 65, 1},  {1, 1, 64},  {1, 1, 65},
        {8, 8, 1},  {8, 9, 1},  {8, 1, 8},   {9, 1, 8},   {1, 8, 8},   {1, 8, 9},   {4, 4, 4},
        {4, 4, 5},  {5, 4, 4},  {4, 5, 4},   {2, 2, 16},  {2, 2, 17},  {16, 2, 2},  {17, 2, 2},
        {2, 16, 2}, {2, 17, 2}, {64, 64, 1}, {64, 1, 64}, {1, 64, 64}, {60, 60, 60}};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0] * 8; ++i) {
        const uint32_t margin = i & 1 ? 64 : 0;
        indexed_t indexed;
        indexed_begin_default(&indexed);
        const units_t units = units_of(&indexed, counts[i / 8]);
        const uint64_t cells = (uint64_t)(counts[i / 8][0] * counts[i / 8][1] * counts[i / 8][2]);
        for (size_t w = 0; w < MANY; ++w) {
            cell_place(&indexed.cell, w, 9e5, 9e5, 9e5);
        }
        assert_true((look_at(&indexed, &units, margin, i & 2).listed != NULL) == (cells <= MANY));
        if (cells <= MANY && i % 8 < 2) {
            expect_found_inside(&indexed, &units, margin);
        }
        /* One unit more along an axis is one cell more. */
        for (size_t axis = 0; axis < 3; ++axis) {
            const uint64_t more = cells / (uint64_t)counts[i / 8][axis] * (uint64_t)(counts[i / 8][axis] + 1);
            units_t wider = units;
            *(i & 4 ? &wider.first[axis] : &wider.last[axis]) += i & 4 ? -1 : 1;
            assert_true((look_at(&indexed, &wider, margin, i & 2).listed != NULL) == (more <= MANY));
        }
    }
}

/* Wafers that stand on edge, so that the cells are longer or shorter along each axis of base. */
static void begin_upright(indexed_t *indexed, size_t thin) {
    static const double axes[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    const wh_mat3_t R = wh_test_rotation(axes[thin][0], axes[thin][1], axes[thin][2], WH_TEST_PI / 2);
    wh_grasp_config_t config = wh_grasp_config_default();
    config.near_projz = WH_REAL(9);
    indexed_begin(indexed, &config);
    for (size_t w = 0; w < MANY; ++w) {
        indexed->wafer[w].base_from_wafer.R = R;
    }
    wh_index_build(&indexed->cell.table);
    for (size_t axis = 0; axis < 3; ++axis) {
        assert_int_equal(indexed->buckets[3 + axis], axis == thin ? 11 : 14);
    }
}

/* A gripper at the edge of a wafer's neighbourhood finds it, on either side, for each direction of
 * the wafer's axis. */
static void each_axis_has_cells_of_its_own(void **state) {
    (void)state;
    for (size_t i = 0; i < 3 * 2000; ++i) {
        static indexed_t indexed;
        const size_t thin = i / 2000;
        if (i % 2000 == 0) {
            begin_upright(&indexed, thin);
        }
        double r[3];
        double at[3];
        for (size_t axis = 0; axis < 3; ++axis) {
            r[axis] = wh_test_uniform(-9e3, 9e3);
            at[axis] = r[axis] + (wh_test_below(2) ? 1 : -1) * (axis == thin ? 8.99 : 70);
        }
        wh_pose_t pose = indexed.wafer[5].base_from_wafer;
        pose.r = (wh_vec3_t){WH_REAL(r[0]), WH_REAL(r[1]), WH_REAL(r[2])};
        assert_int_equal(wh_grasp_place(&indexed.cell.table, 5, &pose), WH_OK);
        const wh_found_t near = indexed_look(&indexed, at[0], at[1], at[2], 0);
        assert_non_null(near.listed);
        assert_true(is_listed(&near, 5));
    }
}

/* In 64 bits: the library computes this modulo 2^32. */
static uint32_t key_of(uint64_t x, uint64_t y, uint64_t z) {
    const uint64_t word = UINT64_C(1) << 32;
    const uint64_t sum = (x * 2654435761U + (y * 2246822519U % word) + z * 3266489917U) % word;
    const uint64_t product = (sum ^ sum / 32768) * 739982445U % word;
    return (uint32_t)(product ^ product / 8192);
}

/* The keys are the same on every machine and in every version, so that speeds can be compared. */
static void keys_stay_the_same(void **state) {
    (void)state;
    assert_int_equal(key_of(0, 0, 0), 0);
    for (size_t thin = 0; thin < 3; ++thin) {
        indexed_t indexed;
        begin_upright(&indexed, thin);
        for (int run = 0; run < 1000 / WH_TEST_SHARE; ++run) {
            wh_pose_t pose = indexed.wafer[5].base_from_wafer;
            uint64_t cell[3];
            wh_real_t r[3];
            for (size_t axis = 0; axis < 3; ++axis) {
                const int32_t unit = (int32_t)wh_test_below(1 << 24) - (1 << 23);
                r[axis] = WH_REAL(unit) / 64;
                cell[axis] = (uint64_t)(INT64_C(2147483648) + unit) >> indexed.buckets[3 + axis];
            }
            pose.r = (wh_vec3_t){r[0], r[1], r[2]};
            assert_int_equal(wh_grasp_place(&indexed.cell.table, 5, &pose), WH_OK);
            const uint32_t *node = indexed.buckets + 8 + 4 * CELL_GRIPPERS + 2 * MANY + 2 * 5;
            assert_int_equal(node[1], key_of(cell[0], cell[1], cell[2]));
        }
    }
}

/* A wafer found for one gripper is not a result for another. */
static void what_was_found_is_the_same_grippers(void **state) {
    (void)state;
    indexed_t indexed;
    indexed_begin_default(&indexed);
    wh_grasp_t *table = &indexed.cell.table;
    const wh_pose_t here = wh_test_at(3000, 2000, 0);
    const wh_pose_t there = wh_test_at(5000, 1000, 0);
    wh_found_t near = wh_index_again(table, 0, &here.r, &here.r);
    assert_int_equal(near.count, 1);
    assert_int_equal(near.listed[0], 19);
    assert_int_equal(indexed.buckets[WH_INDEX_FOUND], 0);
    assert_int_equal(indexed.buckets[WH_INDEX_FOUND + 1], 1);
    near = wh_index_again(table, 0, &there.r, &there.r);
    assert_int_equal(near.count, 1);
    assert_int_equal(near.listed[0], 19);
    near = wh_index_again(table, 2, &there.r, &there.r);
    assert_int_equal(near.count, 1);
    assert_int_equal(near.listed[0], 13);
    assert_int_equal(indexed.buckets[WH_INDEX_FOUND], 2);
    near = wh_index_again(table, 0, &here.r, &here.r);
    assert_int_equal(near.listed[0], 19);
    /* A search that looks at all wafers is kept as well. */
    near = indexed_look(&indexed, 3000, 2000, 0, 1e6);
    assert_null(near.listed);
    near = wh_index_again(table, 0, &here.r, &here.r);
    assert_null(near.listed);
    assert_int_equal(near.count, MANY);
    wh_index_build(table);
    near = wh_index_again(table, 0, &here.r, &here.r);
    assert_int_equal(near.count, 1);
    /* The wafers of one cell: all of them are listed. */
    for (size_t w = 0; w < MANY; ++w) {
        cell_place(&indexed.cell, w, 3000, 2000, 0);
    }
    near = indexed_look(&indexed, 3000, 2000, 0, 0);
    assert_non_null(near.listed);
    assert_int_equal(near.count, MANY);
    for (uint32_t w = 0; w < MANY; ++w) {
        assert_true(is_listed(&near, w));
    }
}

/* At the ends of the range, and beyond, a box goes no further. */
static void boxes_end_with_the_range(void **state) {
    (void)state;
    static const double fars[] = {33554430, 33554200, 33554000, 1e12};
    for (size_t i = 0; i < 4 * 6; ++i) {
        const double far = i % 2 ? fars[i / 6] : -fars[i / 6];
        const size_t axis = i / 2 % 3;
        indexed_t indexed;
        indexed_begin_default(&indexed);
        const wh_pose_t at = wh_test_at(axis == 0 ? far : 0, axis == 1 ? far : 0, axis == 2 ? far : 0);
        assert_int_equal(wh_grasp_place(&indexed.cell.table, 5, &at), WH_OK);
        wh_found_t near = wh_index_near(&indexed.cell.table, 0, &at.r, &at.r, 0);
        assert_non_null(near.listed);
        assert_int_equal(near.count, 1);
        assert_int_equal(near.listed[0], 5);
        /* From there to base's origin: this way has more cells than there are wafers. */
        near = wh_index_near(&indexed.cell.table, 0, &at.r, &indexed.wafer[0].base_from_wafer.r, 0);
        assert_null(near.listed);
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
        cmocka_unit_test(extents_are_those_of_the_neighbourhood),
        cmocka_unit_test(the_widest_counts),
        cmocka_unit_test(cells_are_as_long_as_needed),
        cmocka_unit_test(limits_are_the_larger_ones),
        cmocka_unit_test(lists_hold_every_wafer_once),
        cmocka_unit_test(lists_are_short),
        cmocka_unit_test(cells_are_counted),
        cmocka_unit_test(each_axis_has_cells_of_its_own),
        cmocka_unit_test(keys_stay_the_same),
        cmocka_unit_test(what_was_found_is_the_same_grippers),
        cmocka_unit_test(boxes_end_with_the_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
