/* Setting a table up and placing wafers by hand: which inputs are accepted, which are refused, and
 * what the table forgets. */
#include "grasp/restore.h"
#include "support/grasp.h"

/* A cell in the middle of a run. */
static void begin_busy(cell_t *cell) {
    cell_begin_default(cell);
    cell_move(cell, 0, 0, 0, -0.25, OPEN);
    cell_set(cell, 0, 0, 0, 30, CLOSED);
}

static void spoil_storage(wh_grasp_storage_t *storage, int what) {
    static uint32_t buckets[WH_GRASP_BUCKETS(CELL_WAFERS, CELL_GRIPPERS)];
    const size_t too_many = (size_t)INT32_MAX + 1;
    storage->wafers = what == 22 ? NULL : storage->wafers;
    storage->grippers = what == 23 ? NULL : storage->grippers;
    storage->bucket_count = what == 24 ? 1 : 0;
    storage->wafer_count = what == 25 ? too_many : storage->wafer_count;
    storage->gripper_count = what == 26 ? too_many : storage->gripper_count;
    if (what >= 27) {
        storage->buckets = buckets;
        storage->bucket_count = what == 27 ? too_many : sizeof buckets / sizeof buckets[0] - 1;
    }
}

/* Inputs that init must refuse, one at a time. */
static wh_status_t init_with(cell_t *cell, int what) {
    wh_grasp_config_t config = wh_grasp_config_default();
    wh_grasp_storage_t storage = {cell->wafer, CELL_WAFERS, cell->gripper, CELL_GRIPPERS, NULL, 0};
    const wh_real_t bad[] = {0, -1, WH_REAL(1.1e6), WH_REAL(NAN), WH_REAL(INFINITY)};
    wh_real_t *const limit[] = {&config.near_projz, &config.near_projxy, &config.tolerance.projz,
                                &config.tolerance.projxy};
    if (what < 20) {
        *limit[what / 5] = bad[what % 5];
    } else if (what < 22) {
        config.tolerance.planar = what == 20 ? 1 : config.tolerance.planar;
        config.check = what == 21 ? (wh_check_t)2 : config.check;
    } else {
        spoil_storage(&storage, what);
    }
    return wh_grasp_init(&cell->table, &config, &storage);
}

static void init_refuses(void **state) {
    (void)state;
    cell_t cell;
    cell_t before;
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    for (int what = 0; what <= 28; ++what) {
        const wh_status_t status = init_with(&cell, what);
        const bool has_buckets = what == 24 || what >= 27;
        assert_int_equal(status, what < 21                        ? WH_STATUS_BAD_TOLERANCE
                                 : what < 22                      ? WH_STATUS_OUT_OF_RANGE
                                 : has_buckets && !WH_INDEX_BUILT ? WH_STATUS_NOT_BUILT
                                 : what < 25                      ? WH_STATUS_NULL_ARGUMENT
                                                                  : WH_STATUS_BAD_CAPACITY);
        assert_memory_equal(&cell, &before, sizeof cell);
    }
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {cell.wafer, CELL_WAFERS, cell.gripper, CELL_GRIPPERS, NULL, 0};
    assert_int_equal(wh_grasp_init(NULL, &config, &storage), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_init(&cell.table, NULL, &storage), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_grasp_init(&cell.table, &config, NULL), WH_STATUS_NULL_ARGUMENT);
    before.wafer[3].base_from_wafer.R.m[0][0] = WH_REAL(NAN);
    memcpy(&cell, &before, sizeof cell);
    assert_int_equal(wh_grasp_init(&cell.table, &config, &storage), WH_STATUS_NOT_FINITE);
    assert_memory_equal(&cell, &before, sizeof cell);
}

/* Up to INT32_MAX of each: it is refused for the first wafer's pose, and not for the count. */
static void init_takes_the_greatest_counts(void **state) {
    (void)state;
    cell_t cell;
    uint32_t buckets[WH_GRASP_BUCKETS(CELL_WAFERS, CELL_GRIPPERS)];
    begin_busy(&cell);
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t most[] = {
        {cell.wafer, INT32_MAX, cell.gripper, CELL_GRIPPERS, NULL, 0},
        {cell.wafer, CELL_WAFERS, cell.gripper, INT32_MAX, NULL, 0},
        {cell.wafer, CELL_WAFERS, cell.gripper, CELL_GRIPPERS, buckets, INT32_MAX},
        {cell.wafer, 1, NULL, 0, NULL, 0},
    };
    const wh_pose_t good = cell.wafer[0].base_from_wafer;
    cell.wafer[0].base_from_wafer.r.x = WH_REAL(NAN);
    for (size_t i = 0; i < 4; ++i) {
        const bool built = WH_INDEX_BUILT || i != 2;
        assert_int_equal(wh_grasp_init(&cell.table, &config, &most[i]),
                         built ? WH_STATUS_NOT_FINITE : WH_STATUS_NOT_BUILT);
    }
    cell.wafer[0].base_from_wafer = good;
    assert_int_equal(wh_grasp_init(&cell.table, &config, &most[2]),
                     WH_INDEX_BUILT ? WH_OK : WH_STATUS_NOT_BUILT);
    assert_int_equal(wh_grasp_init(&cell.table, &config, &most[3]), WH_OK);
}

/* A library without swept checking or without the index reports this, and the table stays
 * unchanged. A table that such a library cannot have set up is refused, too, when it is to be
 * restored. */
static void what_is_not_built_is_refused(void **state) {
    (void)state;
    cell_t cell;
    cell_t before;
    uint32_t buckets[WH_GRASP_BUCKETS(CELL_WAFERS, CELL_GRIPPERS)];
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    wh_grasp_config_t config = wh_grasp_config_default();
    wh_grasp_storage_t storage = {cell.wafer, CELL_WAFERS, cell.gripper, CELL_GRIPPERS, NULL, 0};
    config.check = WH_CHECK_SWEPT;
    assert_int_equal(wh_grasp_init(&cell.table, &config, &storage),
                     WH_SWEEP_BUILT ? WH_OK : WH_STATUS_NOT_BUILT);
    assert_true(WH_SWEEP_BUILT || memcmp(&cell, &before, sizeof cell) == 0);
    cell.table.config.check = WH_CHECK_SWEPT;
    assert_int_equal(wh_grasp_restore(&cell.table, 9, cell.wafer, cell.gripper),
                     WH_SWEEP_BUILT ? WH_OK : WH_STATUS_NOT_BUILT);
    begin_busy(&cell);
    memcpy(&before, &cell, sizeof before);
    config.check = WH_CHECK_SAMPLED;
    storage.buckets = buckets;
    storage.bucket_count = sizeof buckets / sizeof buckets[0];
    assert_int_equal(wh_grasp_buckets(CELL_WAFERS, CELL_GRIPPERS), WH_INDEX_BUILT ? storage.bucket_count : 0);
    assert_int_equal(wh_grasp_init(&cell.table, &config, &storage),
                     WH_INDEX_BUILT ? WH_OK : WH_STATUS_NOT_BUILT);
    assert_true(WH_INDEX_BUILT || memcmp(&cell, &before, sizeof cell) == 0);
    cell.table.storage.buckets = buckets;
    cell.table.storage.bucket_count = storage.bucket_count;
    assert_int_equal(wh_grasp_restore(&cell.table, 9, cell.wafer, cell.gripper),
                     WH_INDEX_BUILT ? WH_OK : WH_STATUS_NOT_BUILT);
}

/* The ends of the ranges are valid. */
static void init_takes_the_ranges_ends(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    const wh_grasp_storage_t storage = {cell.wafer, CELL_WAFERS, cell.gripper, CELL_GRIPPERS, NULL, 0};
    static const double good[] = {1e-9, 0.5, 1e5, 1e6};
    for (size_t i = 0; i < 16; ++i) {
        wh_grasp_config_t config = wh_grasp_config_default();
        config.near_projz = WH_REAL(good[i / 4]);
        config.near_projxy = WH_REAL(good[i % 4]);
        assert_int_equal(wh_grasp_init(&cell.table, &config, &storage), WH_OK);
    }
}

static void one_of_nothing_is_refused(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t bad[] = {{NULL, 1, cell.gripper, 1, NULL, 0}, {cell.wafer, 1, NULL, 1, NULL, 0}};
    for (size_t i = 0; i < 2; ++i) {
        assert_int_equal(wh_grasp_init(&cell.table, &config, &bad[i]), WH_STATUS_NULL_ARGUMENT);
    }
}

/* A used table begins anew: nothing is held, nothing is counted, grippers stand at base's origin. */
static void init_begins_anew(void **state) {
    (void)state;
    cell_t cell;
    begin_busy(&cell);
    const wh_grasp_storage_t storage = cell.table.storage;
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_pose_t identity = wh_pose_identity();
    memset(cell.gripper, 0x5a, sizeof cell.gripper);
    assert_int_equal(wh_grasp_init(&cell.table, &config, &storage), WH_OK);
    static const wh_grasp_counters_t none = {0};
    assert_memory_equal(&cell.table.counters, &none, sizeof none);
    assert_int_equal(cell.table.slice, 0);
    for (int w = 0; w < CELL_WAFERS; ++w) {
        assert_int_equal(cell.wafer[w].holder, WH_NONE);
        assert_int_equal(cell.wafer[w].released_by, WH_NONE);
    }
    for (int g = 0; g < CELL_GRIPPERS; ++g) {
        const wh_gripper_t *gripper = &cell.gripper[g];
        assert_memory_equal(&gripper->base_from_gripper, &identity, sizeof identity);
        assert_memory_equal(&gripper->gripper_from_wafer, &identity, sizeof identity);
        assert_int_equal(gripper->valve, CLOSED);
        assert_int_equal(gripper->wafer, WH_NONE);
        assert_int_equal(gripper->approach.wafer, WH_NONE);
        assert_int_equal(gripper->approach.holder, WH_NONE);
        assert_int_equal(gripper->contest.wafer, WH_NONE);
        assert_int_equal(gripper->contest.holder, WH_NONE);
    }
}

static void placing_moves_a_free_wafer(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    const wh_pose_t pose = wh_test_random_pose(1000);
    assert_int_equal(wh_grasp_place(&cell.table, 3, &pose), WH_OK);
    wh_pose_t read;
    int32_t holder;
    assert_int_equal(wh_grasp_wafer(&cell.table, 3, &read, &holder), WH_OK);
    assert_memory_equal(&read, &pose, sizeof read);
    assert_int_equal(holder, WH_NONE);
    assert_int_equal(cell.table.slice, 0);
}

/* A gripper that follows the placed wafer has lost it; no other gripper has. */
static void placing_is_forgotten_by_whom_it_concerns(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_set(&cell, 0, 1000, 0, -2, OPEN);
    cell_set(&cell, 1, 2000, 0, -2, OPEN);
    cell_move(&cell, 2, 1000, 0, 3, OPEN);
    cell_place(&cell, 1, 1000, 0, 500);
    assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    assert_int_equal(cell.gripper[1].approach.wafer, 2);
    assert_int_equal(cell.gripper[2].approach.wafer, WH_NONE);
}

/* Entries beside the arrays are not read: a free wafer there is neither taken nor released. */
static void play_beside_neighbours(wh_check_t check) {
    wh_wafer_t wafers[3];
    wh_gripper_t grippers[3];
    wh_event_t events[WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list = {events, WH_EVENTS_PER_GRIPPER, 0};
    wh_grasp_t table;
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    memset(grippers, 0, sizeof grippers);
    for (int i = 0; i < 3; ++i) {
        wafers[i].base_from_wafer = wh_test_at(1000 * i, 0, 0);
        wafers[i].holder = wafers[i].released_by = WH_NONE;
    }
    const wh_gripper_t beside = grippers[2];
    const wh_grasp_storage_t storage = {wafers + 1, 1, grippers + 1, 1, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &config, &storage), WH_OK);
    static const double places[] = {0, 2000, 1000};
    for (int i = 0; i < 12; ++i) {
        const wh_gripper_input_t input = {wh_test_at(places[i / 4], 0, -0.25), i % 4 < 2 ? CLOSED : OPEN};
        assert_int_equal(wh_grasp_step(&table, &input, &list), WH_OK);
        assert_int_equal(list.count, i == 10);
    }
    assert_int_equal(wafers[0].holder, WH_NONE);
    assert_int_equal(wafers[2].holder, WH_NONE);
    assert_memory_equal(&grippers[2], &beside, sizeof beside);
}

static void neighbours_of_the_arrays_are_left_alone(void **state) {
    (void)state;
    play_beside_neighbours(WH_CHECK_SAMPLED);
    play_beside_neighbours(SWEPT_IF_BUILT);
}

static void indices_far_out_are_refused(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    static const size_t far[] = {CELL_WAFERS, CELL_WAFERS + 1, SIZE_MAX};
    for (size_t i = 0; i < 3; ++i) {
        wh_pose_t pose = wh_pose_identity();
        int32_t index;
        assert_int_equal(wh_grasp_place(&cell.table, far[i], &pose), WH_STATUS_OUT_OF_RANGE);
        assert_int_equal(wh_grasp_wafer(&cell.table, far[i], &pose, &index), WH_STATUS_OUT_OF_RANGE);
        assert_int_equal(wh_grasp_held(&cell.table, far[i], &index), WH_STATUS_OUT_OF_RANGE);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_refuses),
        cmocka_unit_test(init_takes_the_greatest_counts),
        cmocka_unit_test(what_is_not_built_is_refused),
        cmocka_unit_test(init_takes_the_ranges_ends),
        cmocka_unit_test(one_of_nothing_is_refused),
        cmocka_unit_test(init_begins_anew),
        cmocka_unit_test(placing_moves_a_free_wafer),
        cmocka_unit_test(placing_is_forgotten_by_whom_it_concerns),
        cmocka_unit_test(neighbours_of_the_arrays_are_left_alone),
        cmocka_unit_test(indices_far_out_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
