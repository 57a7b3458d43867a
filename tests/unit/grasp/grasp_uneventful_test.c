/* The slices that count as uneventful: in them no gripper looks for wafers, though one is open and
 * empty. tests/property/horizon_random.c shows that such a slice changes no result. */
#include "grasp/horizon_internal.h"
#include "grasp/restore.h"
#include "support/grasp.h"

typedef struct {
    cell_t cell;
    uint32_t buckets[WH_GRASP_BUCKETS(CELL_WAFERS, CELL_GRIPPERS)];
} fixture_t;

/* Gripper 1 is open and empty at (1000, 500, -500), far from all wafers, and has found that out. */
static void begin(fixture_t *fixture, wh_check_t check) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    cell_begin(&fixture->cell, &config);
    wh_grasp_storage_t storage = fixture->cell.table.storage;
    storage.buckets = fixture->buckets;
    storage.bucket_count = wh_grasp_buckets(CELL_WAFERS, CELL_GRIPPERS);
    assert_int_equal(wh_grasp_init(&fixture->cell.table, &config, &storage), WH_OK);
    cell_move(&fixture->cell, 1, 1000, 499.5, -500, OPEN);
    cell_move(&fixture->cell, 1, 1000, 500, -500, OPEN);
    assert_true(
        wh_horizon_is_clear_at(&fixture->cell.table, 1, &fixture->cell.gripper[1].base_from_gripper.r));
}

/* True if gripper 1 does not look in the next slice, not even whether it is within its horizon. A
 * slice's note is void at the slice's end, and such a slice writes no note. */
static bool looks_at_nothing(fixture_t *fixture) {
    wh_grasp_t *table = &fixture->cell.table;
    const uint64_t slice = table->slice;
    table->storage.grippers[1].approach.holder = WH_HORIZON_CLEAR;
    cell_step(&fixture->cell);
    assert_int_equal(table->slice, slice + 1);
    const bool untouched = wh_horizon_is_clear(table, 1);
    table->storage.grippers[1].approach.holder = WH_NONE;
    return untouched;
}

static void within_the_horizon_nothing_is_looked_at(void **state) {
    (void)state;
    for (int check = WH_CHECK_SAMPLED; check <= WH_CHECK_SWEPT; ++check) {
        fixture_t fixture;
        begin(&fixture, (wh_check_t)check);
        assert_true(looks_at_nothing(&fixture));
        cell_set(&fixture.cell, 1, 1000, 501, -500, OPEN);
        assert_true(looks_at_nothing(&fixture));
        assert_near(fixture.cell.gripper[1].base_from_gripper.r.y, 501, 0);
        cell_set(&fixture.cell, 1, 1000, 500, -500, CLOSED);
        assert_true(looks_at_nothing(&fixture));
        assert_int_equal(fixture.cell.gripper[1].valve, CLOSED);
        cell_set(&fixture.cell, 1, 1000, 501, -500, OPEN);
        assert_true(looks_at_nothing(&fixture));
        assert_int_equal(fixture.cell.gripper[1].valve, OPEN);
        cell_set(&fixture.cell, 1, 1000, 9000, -500, OPEN);
        assert_false(looks_at_nothing(&fixture));
    }
}

/* To half a unit, on every side of a horizon of 10 mm, whatever the signs of its place. */
static void the_horizon_is_a_ball(void **state) {
    (void)state;
    fixture_t fixture;
    begin(&fixture, WH_CHECK_SAMPLED);
    for (int i = 0; i < 8 * 6 * 2; ++i) {
        const int32_t centre[3] = {i & 1 ? 5000 : -5000, i & 2 ? 3000 : -3000, i & 4 ? 700 : -700};
        double at[3] = {centre[0], centre[1], centre[2]};
        const double way = i >= 48 ? 10 + 0.5 / 64 : 10 - 0.5 / 64;
        at[i / 8 % 3] += i / 24 % 2 ? way : -way;
        uint32_t *words = wh_horizon_words(&fixture.cell.table, 1);
        for (int axis = 0; axis < 3; ++axis) {
            words[axis] = (uint32_t)(64 * centre[axis]);
        }
        words[3] = 4 * 640;
        cell_set(&fixture.cell, 1, at[0], at[1], at[2], OPEN);
        assert_true(looks_at_nothing(&fixture) == (i < 48));
    }
}

/* The way of a slice counts only if it is checked, and only if the gripper was open all the time. */
static void outside_at_the_begin(void **state) {
    (void)state;
    for (int i = 0; i < 4; ++i) {
        const bool swept = i & 1;
        const bool was_open = i & 2;
        fixture_t fixture;
        begin(&fixture, swept ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED);
        fixture.cell.gripper[1].base_from_gripper.r.y = 9000;
        fixture.cell.gripper[1].valve = was_open ? OPEN : CLOSED;
        assert_true(looks_at_nothing(&fixture) == !(swept && was_open));
    }
}

/* A closed gripper looks for nothing, wherever it is. */
static void closed_grippers_may_be_anywhere(void **state) {
    (void)state;
    fixture_t fixture;
    begin(&fixture, WH_CHECK_SAMPLED);
    cell_set(&fixture.cell, 0, 0, 0, 0, CLOSED);
    cell_set(&fixture.cell, 2, 2000, 0, 0, CLOSED);
    assert_true(looks_at_nothing(&fixture));
    cell_expect_held(&fixture.cell, 0, WH_NONE);
}

/* Actions of another gripper that may have to be reported, before and after gripper 1 in their order. */
static void others_may_have_something_to_tell(void **state) {
    (void)state;
    for (int g = 0; g <= 2; g += 2) {
        fixture_t fixture;
        /* It is outside its horizon. */
        begin(&fixture, WH_CHECK_SAMPLED);
        cell_set(&fixture.cell, g, 1000 * g, 9000, -500, OPEN);
        assert_false(looks_at_nothing(&fixture));
        /* It holds a wafer, while another looks. */
        begin(&fixture, WH_CHECK_SAMPLED);
        cell_move(&fixture.cell, g, 1000 * g, 0, -0.25, OPEN);
        cell_expect_held(&fixture.cell, g, g);
        assert_false(looks_at_nothing(&fixture));
        /* It releases the wafer. */
        cell_set(&fixture.cell, g, 1000 * g, 0, -0.25, CLOSED);
        assert_false(looks_at_nothing(&fixture));
        cell_expect_held(&fixture.cell, g, WH_NONE);
        /* It follows a wafer: within its horizon, from the tolerance. */
        begin(&fixture, WH_CHECK_SAMPLED);
        cell_move(&fixture.cell, g, 1000 * g, 0, -4, OPEN);
        cell_move(&fixture.cell, g, 1000 * g, 0, -4, OPEN);
        assert_int_equal(fixture.cell.gripper[g].approach.wafer, g);
        const wh_vec3_t *place = &fixture.cell.input[g].base_from_gripper.r;
        assert_true(wh_horizon_is_clear_at(&fixture.cell.table, (size_t)g, place));
        assert_false(looks_at_nothing(&fixture));
        /* Near another's wafer. */
        begin(&fixture, WH_CHECK_SAMPLED);
        fixture.cell.gripper[g].contest.wafer = g;
        assert_false(looks_at_nothing(&fixture));
    }
}

/* The pick has found that no wafer matters; the watch does not look again, and nothing is searched. */
static void one_look_is_enough(void **state) {
    (void)state;
    for (int check = WH_CHECK_SAMPLED; check <= WH_CHECK_SWEPT; ++check) {
        fixture_t fixture;
        begin(&fixture, (wh_check_t)check);
        cell_move(&fixture.cell, 0, 0, 0, -0.25, OPEN);
        fixture.buckets[WH_INDEX_FOUND] = UINT32_MAX;
        assert_false(looks_at_nothing(&fixture));
        assert_int_equal(fixture.buckets[WH_INDEX_FOUND], UINT32_MAX);
        cell_move(&fixture.cell, 1, 1000, 9000, -500, OPEN);
        assert_int_equal(fixture.buckets[WH_INDEX_FOUND], 1);
    }
}

static void without_buckets_every_slice_is_looked_at(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 1, 1000, 500, -500, OPEN);
    cell_place(&cell, 1, 1000, 500, -500);
    cell_step(&cell);
    cell_expect_held(&cell, 1, 1);
}

/* According to a restored table gripper 1 contests wafer 0, which nothing holds. The gripper is far
 * away from all wafers, and finds that out. All the same, the end of its contest is reported. */
static void a_contest_ends_though_nothing_rests_near(void **state) {
    (void)state;
    fixture_t fixture;
    cell_t *cell = &fixture.cell;
    begin(&fixture, WH_CHECK_SAMPLED);
    cell_move(cell, 0, 0, 0, 0, OPEN);
    cell_move(cell, 1, 0, 0, 0, OPEN);
    assert_int_equal(cell->gripper[1].contest.wafer, 0);
    wh_wafer_t wafers[CELL_WAFERS];
    wh_gripper_t grippers[CELL_GRIPPERS];
    memcpy(wafers, cell->wafer, sizeof wafers);
    memcpy(grippers, cell->gripper, sizeof grippers);
    wafers[0].holder = grippers[0].wafer = WH_NONE;
    assert_int_equal(wh_grasp_restore(&cell->table, cell->table.slice, wafers, grippers), WH_OK);
    cell_set(cell, 0, 0, 0, -500, CLOSED);
    cell_move(cell, 1, 1000, 500, -500, OPEN);
    assert_true(wh_horizon_is_clear_at(&cell->table, 1, &cell->gripper[1].base_from_gripper.r));
    cell_expect(cell, WH_EVENT_CONTESTED, 0, 1, 0);
    assert_int_equal(cell->gripper[1].contest.wafer, WH_NONE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(within_the_horizon_nothing_is_looked_at),
        cmocka_unit_test(the_horizon_is_a_ball),
        cmocka_unit_test(outside_at_the_begin),
        cmocka_unit_test(closed_grippers_may_be_anywhere),
        cmocka_unit_test(others_may_have_something_to_tell),
        cmocka_unit_test(one_look_is_enough),
        cmocka_unit_test(without_buckets_every_slice_is_looked_at),
        cmocka_unit_test(a_contest_ends_though_nothing_rests_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
