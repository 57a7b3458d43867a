/* The grasp table's step: which gripper takes which wafer, which wafers stay in place, and that
 * poses keep their bits. */
#include "support/grasp.h"

static void same_bits(const wh_pose_t *a, const wh_pose_t *b) {
    assert_memory_equal(a, b, sizeof *a);
}

static void starts_free_and_closed(void **state) {
    (void)state;
    cell_t cell;
    memset(&cell, 0xff, sizeof cell);
    cell_begin_default(&cell);
    assert_int_equal(cell.table.slice, 0);
    for (int i = 0; i < CELL_WAFERS; ++i) {
        cell_expect_held(&cell, i, WH_NONE);
    }
    for (int g = 0; g < CELL_GRIPPERS; ++g) {
        cell_expect_held(&cell, WH_NONE, g);
        assert_int_equal(cell.gripper[g].valve, CLOSED);
    }
    const wh_grasp_config_t config = wh_grasp_config_default();
    assert_int_equal(config.check, WH_CHECK_SAMPLED);
    assert_false(config.seat);
    assert_true(config.near_projz == WH_REAL(4.5) && config.near_projxy == 100);
}

static void a_pick_moves_nothing(void **state) {
    (void)state;
    for (int run = 0; run < 200; ++run) {
        cell_t cell;
        cell_begin_default(&cell);
        const wh_pose_t base_from_wafer = wh_test_random_pose(1000);
        const wh_pose_t wafer_from_gripper = wh_test_pose(wh_test_random_turn(0.1), 3, -20, -0.3);
        assert_int_equal(wh_grasp_place(&cell.table, 2, &base_from_wafer), WH_OK);
        cell.input[1].base_from_gripper = wh_pose_compose(&base_from_wafer, &wafer_from_gripper);
        cell.input[1].valve = OPEN;
        cell_step(&cell);
        cell_expect_held(&cell, 2, 1);
        same_bits(&cell.wafer[2].base_from_wafer, &base_from_wafer);
        const wh_event_t *e = cell_expect(&cell, WH_EVENT_PICKED, 2, 1, WH_NONE);
        assert_near(e->measured.dr_proj_z, 0.3, 1e4 * WH_TEST_ROUNDING);
        assert_int_equal(e->measured_slice, 1);
        assert_true(e->measured.ready);
        /* If it stands still, the pose stays: within rounding at first, then to the bit. */
        cell_step(&cell);
        assert_near(wh_test_difference_r(&cell.wafer[2].base_from_wafer, &base_from_wafer), 0,
                    1e4 * WH_TEST_ROUNDING);
        const wh_pose_t then = cell.wafer[2].base_from_wafer;
        cell_step(&cell);
        same_bits(&cell.wafer[2].base_from_wafer, &then);
    }
}

/* An entry before the wafers in memory, here one that looks free, is no wafer. */
static void closing_empty_handed_lets_go_of_nothing(void **state) {
    (void)state;
    wh_grasp_t table;
    wh_wafer_t wafer[2] = {{.holder = WH_NONE}};
    wh_gripper_t gripper;
    wh_gripper_input_t input = {wh_test_at(0, 0, -2), OPEN};
    wh_event_t event[WH_EVENTS_PER_GRIPPER];
    wh_event_list_t list = {event, WH_EVENTS_PER_GRIPPER, 0};
    wafer[1].base_from_wafer = wh_test_at(0, 0, 0);
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {&wafer[1], 1, &gripper, 1, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &config, &storage), WH_OK);
    assert_int_equal(wh_grasp_step(&table, &input, &list), WH_OK);
    assert_int_equal(gripper.approach.wafer, 0);
    input.valve = CLOSED;
    assert_int_equal(wh_grasp_step(&table, &input, &list), WH_OK);
    assert_int_equal(list.count, 1);
    assert_int_equal(event[0].kind, WH_EVENT_NEAR_MISS);
    assert_int_equal(table.counters.released, 0);
}

/* An entry behind the grippers and inputs, here one that could take a wafer, has no effect. */
static void there_are_no_more_grippers_than_that(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell.table.storage.gripper_count = CELL_GRIPPERS - 1;
    const wh_gripper_t before = cell.gripper[CELL_GRIPPERS - 1];
    cell_move(&cell, CELL_GRIPPERS - 1, 2000, 0, -0.25, OPEN);
    cell_move(&cell, 0, 0, 0, -2, OPEN);
    cell_expect_held(&cell, 2, WH_NONE);
    assert_memory_equal(&before, &cell.gripper[CELL_GRIPPERS - 1], sizeof before);
}

static void a_held_wafer_moves_with_its_gripper(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 0, 10, -5, -0.25, OPEN);
    const wh_pose_t gripper_from_wafer = cell.gripper[0].gripper_from_wafer;
    same_bits(&gripper_from_wafer, &(wh_pose_t){wh_mat3_identity(), {-10, 5, WH_REAL(0.25)}});
    for (int run = 0; run < 1000; ++run) {
        cell.input[0].base_from_gripper = wh_test_random_pose(1000);
        cell_step(&cell);
        cell_expect_nothing(&cell);
        const wh_pose_t there = wh_pose_compose(&cell.input[0].base_from_gripper, &gripper_from_wafer);
        same_bits(&cell.wafer[0].base_from_wafer, &there);
        same_bits(&cell.gripper[0].gripper_from_wafer, &gripper_from_wafer);
    }
    /* It stays where the gripper carries it in the slice whose valve is closed, not where it was before. */
    cell.input[0].base_from_gripper = wh_test_random_pose(1000);
    cell.input[0].valve = CLOSED;
    cell_step(&cell);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_RELEASED, 0, 0, WH_NONE);
    assert_near(e->measured.dr_proj_xy_norm, sqrt(125), 1e4 * WH_TEST_ROUNDING);
    const wh_pose_t left = wh_pose_compose(&cell.input[0].base_from_gripper, &gripper_from_wafer);
    same_bits(&cell.wafer[0].base_from_wafer, &left);
    cell_expect_held(&cell, 0, WH_NONE);
    cell_expect_held(&cell, WH_NONE, 0);
    cell_move(&cell, 0, 0, 0, 300, CLOSED);
    same_bits(&cell.wafer[0].base_from_wafer, &left);
}

/* Closed in one slice, opened in the next: released and taken again, by the next slice's pose. */
static void a_gripper_takes_again_only_in_the_next_slice(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 0, 0, 0, -0.25, OPEN);
    cell_move(&cell, 0, 0, 0, -0.25, CLOSED);
    cell_expect(&cell, WH_EVENT_RELEASED, 0, 0, WH_NONE);
    cell_move(&cell, 0, 0, 0, -0.125, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    assert_near(cell.gripper[0].gripper_from_wafer.r.z, 0.125, 0);
}

/* A passes the wafer to B in the slice in which A closes, whichever of the two has the lower index. */
static void hands_over_in_one_step(int from, int to) {
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, from, 0, 0, -0.25, OPEN);
    cell_set(&cell, to, 0, 0, -0.125, OPEN);
    cell_set(&cell, from, 0, 0, -0.375, CLOSED);
    cell_step(&cell);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_HANDED_OVER, 0, to, from);
    cell_expect_held(&cell, 0, to);
    cell_expect_held(&cell, WH_NONE, from);
    /* First `from` carries it to this place in this slice; there `to` takes it. */
    assert_near(cell.wafer[0].base_from_wafer.r.z, -0.125, 0);
    assert_near(e->measured.dr_proj_z, 0, 0);
    assert_int_equal(cell.wafer[0].released_by, WH_NONE);
    assert_int_equal(cell.table.counters.handed_over, 1);
    assert_int_equal(cell.table.counters.released, 0);
    assert_int_equal(cell.table.counters.picked, 1);
}

/* The case above, but B is open beforehand: the contest ends in a hand-over, and is not reported. */
static void hands_over_to_one_that_waits(int from, int to) {
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, from, 0, 0, -0.25, OPEN);
    cell_move(&cell, to, 0, 0, 0, OPEN);
    cell_expect_nothing(&cell);
    cell_expect_held(&cell, 0, from);
    assert_int_equal(cell.gripper[to].contest.wafer, 0);
    cell_move(&cell, from, 0, 0, -0.25, CLOSED);
    cell_expect(&cell, WH_EVENT_HANDED_OVER, 0, to, from);
    cell_move(&cell, from, 0, 0, -50, CLOSED);
    cell_expect_nothing(&cell);
    assert_int_equal(cell.table.counters.contested, 0);
    assert_int_equal(cell.gripper[to].contest.wafer, WH_NONE);
}

static void hand_overs_go_both_ways(void **state) {
    (void)state;
    hands_over_in_one_step(0, 1);
    hands_over_in_one_step(1, 0);
    hands_over_to_one_that_waits(0, 2);
    hands_over_to_one_that_waits(2, 0);
}

/* Two grippers cannot swap their wafers at one place in one slice: a closed valve takes nothing. */
static void two_hand_overs_need_an_open_valve(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    cell_move(&cell, 1, 1000, 0, 0, OPEN);
    cell_set(&cell, 1, 0, 0, 0, CLOSED);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    cell_expect(&cell, WH_EVENT_RELEASED, 1, 1, WH_NONE);
    cell_expect_held(&cell, 0, 0);
}

static void lower_gripper_wins(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_set(&cell, 2, 0, 0, 0, OPEN);
    cell_set(&cell, 1, 0, 0, -0.375, OPEN);
    cell_step(&cell);
    cell_expect(&cell, WH_EVENT_PICKED, 0, 1, WH_NONE);
    cell_expect_held(&cell, WH_NONE, 2);
}

static void nearest_in_z_wins_then_lowest_index(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_place(&cell, 1, 0, 0, 0.375);
    cell_place(&cell, 2, 30, 0, -0.125);
    cell_place(&cell, 3, 0, 0, 0.25);
    cell_place(&cell, 0, 0, 0, 3);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 2, 0, WH_NONE);
    cell_move(&cell, 1, 0, 0, 0, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 3, 1, WH_NONE);
    cell_begin_default(&cell);
    cell_place(&cell, 3, 0, 0, 0.25);
    cell_place(&cell, 2, 10, 0, -0.25);
    cell_place(&cell, 0, 0, 0, 100);
    cell_move(&cell, 0, 0, 0, 0, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 2, 0, WH_NONE);
}

static void one_gripper_holds_one_wafer(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 0, 0, 0, -0.25, OPEN);
    cell_place(&cell, 1, 0, 0, 0);
    cell_move(&cell, 0, 0, 0, -0.25, OPEN);
    cell_expect_nothing(&cell);
    cell_expect_held(&cell, 1, WH_NONE);
    /* After it has put its wafer down, another gripper at the same place takes the nearer of the two. */
    cell_set(&cell, 0, 0, 0, -0.25, CLOSED);
    cell_move(&cell, 1, 0, 0, 0.125, OPEN);
    cell_expect_held(&cell, 0, 1);
}

/* Release, carry, pick: a wafer is taken over at the pose to which it is carried in this slice. */
static void the_order_is_release_carry_pick(void **state) {
    (void)state;
    cell_t cell;
    cell_begin_default(&cell);
    cell_move(&cell, 1, 0, 0, 0, OPEN);
    cell_set(&cell, 1, 500, 0, 0, CLOSED);
    cell_set(&cell, 0, 0, 0, 0, OPEN);
    cell_step(&cell);
    cell_expect(&cell, WH_EVENT_RELEASED, 0, 1, WH_NONE);
    assert_near(cell.wafer[0].base_from_wafer.r.x, 500, 0);
    cell_set(&cell, 0, 500, 0, 0, OPEN);
    cell_step(&cell);
    cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
}

/* An independent check: n1 on n2, and no rotation achieves it with a smaller angle than theirs. */
static void a_seated_wafer_lies_on_the_pads(void **state) {
    (void)state;
    wh_grasp_config_t config = wh_grasp_config_default();
    config.seat = true;
    config.check = SWEPT_IF_BUILT;
    for (int run = 0; run < 2000; ++run) {
        cell_t cell;
        cell_begin(&cell, &config);
        const wh_pose_t before = wh_test_random_pose(1000);
        wh_pose_t wafer_from_gripper = wh_test_pose(wh_test_random_turn(0.14), 5, 7, 0);
        wafer_from_gripper.r.z = WH_REAL(wh_test_uniform(-0.4, 0.4));
        assert_int_equal(wh_grasp_place(&cell.table, 0, &before), WH_OK);
        cell.input[0].base_from_gripper = wh_pose_compose(&before, &wafer_from_gripper);
        cell.input[0].valve = OPEN;
        cell_step(&cell);
        const wh_event_t *e = cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
        const wh_pose_t *g = &cell.gripper[0].gripper_from_wafer;
        const wh_pose_t *after = &cell.wafer[0].base_from_wafer;
        assert_true(g->r.z == 0);
        assert_near(g->R.m[2][2], 1, 8 * WH_TEST_ROUNDING);
        assert_near(fabs((double)g->R.m[0][2]) + fabs((double)g->R.m[1][2]), 0, 16 * WH_TEST_ROUNDING);
        const wh_pose_t there = wh_pose_compose(&cell.input[0].base_from_gripper, g);
        same_bits(after, &there);
        /* The measured values are those before it was drawn down. */
        assert_near(e->measured.dr_proj_z, -(double)wafer_from_gripper.r.z, 2e4 * WH_TEST_ROUNDING);
        /* trace = 1 + 2 cos of the turn made; n1_proj_n2 = cos of the turn needed */
        const wh_mat3_t turn = wh_mat3_multiply_back(&before.R, &after->R);
        const double signals = (double)turn.m[0][0] + (double)turn.m[1][1] + (double)turn.m[2][2];
        assert_near((signals - 1) / 2, e->measured.n1_proj_n2, 64 * WH_TEST_ROUNDING);
        /* In the gripper's plane the centre keeps its place. */
        const wh_pose_t unseated = wh_pose_relative(&cell.input[0].base_from_gripper, &before);
        assert_near(g->r.x, unseated.r.x, 0);
        assert_near(g->r.y, unseated.r.y, 0);
    }
}

/* The errors of a gripper's rotation are at the limit. It carries a wafer to a pose that the
 * library still accepts, whatever direction the errors have. */
/* The largest entry of |R^T R - I|. */
static double wear(const wh_mat3_t *R) {
    const wh_mat3_t square = wh_mat3_multiply_back(R, R);
    double most = 0;
    for (int i = 0; i < 9; ++i) {
        most = fmax(most, fabs((double)square.m[i / 3][i % 3] - (i % 4 == 0)));
    }
    return most;
}

static void worn_rotations_do_not_add_up(void **state) {
    (void)state;
    wh_grasp_config_t config = wh_grasp_config_default();
    wh_mat3_t worn = wh_mat3_identity();
    for (int i = 0; i < 9; ++i) {
        worn.m[i / 3][i % 3] += WH_REAL(0.49) * WH_ROTATION_TOLERANCE;
    }
    for (int degree = 0; degree < 360; ++degree) {
        cell_t cell;
        config.seat = degree % 2 == 0;
        cell_begin(&cell, &config);
        const wh_pose_t pose = {wh_test_rotation(0, 0, 1, degree * WH_TEST_PI / 180), {0, 0, 0}};
        assert_int_equal(wh_grasp_place(&cell.table, 0, &pose), WH_OK);
        cell.input[0].base_from_gripper.R = worn;
        cell.input[0].base_from_gripper.r = pose.r;
        cell.input[0].valve = OPEN;
        cell_step(&cell);
        cell_expect_held(&cell, 0, 0);
        /* One step of mending squares the error; a seated wafer has had two. */
        const double square = pow(6 * (double)WH_ROTATION_TOLERANCE, 2);
        assert_near(wear(&cell.gripper[0].gripper_from_wafer.R), 0,
                    (config.seat ? 0 : square) + 64 * WH_TEST_ROUNDING);
        cell_step(&cell);
        assert_int_equal(wh_pose_validate(&cell.wafer[0].base_from_wafer), WH_OK);
        assert_near(wh_test_difference_R(&cell.wafer[0].base_from_wafer, &pose), 0,
                    2 * (double)WH_ROTATION_TOLERANCE);
    }
}

static void equal_histories_have_equal_hashes(void **state) {
    (void)state;
    cell_t a;
    cell_t b;
    cell_begin_default(&a);
    cell_begin_default(&b);
    assert_true(wh_grasp_hash(&a.table) == wh_grasp_hash(&b.table));
    cell_move(&a, 0, 0, 0, -0.25, OPEN);
    assert_true(wh_grasp_hash(&a.table) != wh_grasp_hash(&b.table));
    cell_move(&b, 0, 0, 0, -0.25, OPEN);
    assert_true(wh_grasp_hash(&a.table) == wh_grasp_hash(&b.table));
    /* Counters are left out of the hash; a single bit of a number is not. */
    a.table.counters.refused = 77;
    assert_true(wh_grasp_hash(&a.table) == wh_grasp_hash(&b.table));
    a.wafer[3].base_from_wafer.r.y = -a.wafer[3].base_from_wafer.r.y;
    assert_true(wh_grasp_hash(&a.table) != wh_grasp_hash(&b.table));
}

/* ------------------------------------------------------------------------------------ whether it is consistent */

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

/* Writes `value` over a good index of a busy table: the table is no longer consistent, and with the
 * old value it is again. */
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
        cmocka_unit_test(starts_free_and_closed),
        cmocka_unit_test(a_pick_moves_nothing),
        cmocka_unit_test(closing_empty_handed_lets_go_of_nothing),
        cmocka_unit_test(there_are_no_more_grippers_than_that),
        cmocka_unit_test(a_held_wafer_moves_with_its_gripper),
        cmocka_unit_test(a_gripper_takes_again_only_in_the_next_slice),
        cmocka_unit_test(hand_overs_go_both_ways),
        cmocka_unit_test(two_hand_overs_need_an_open_valve),
        cmocka_unit_test(lower_gripper_wins),
        cmocka_unit_test(nearest_in_z_wins_then_lowest_index),
        cmocka_unit_test(one_gripper_holds_one_wafer),
        cmocka_unit_test(the_order_is_release_carry_pick),
        cmocka_unit_test(a_seated_wafer_lies_on_the_pads),
        cmocka_unit_test(worn_rotations_do_not_add_up),
        cmocka_unit_test(equal_histories_have_equal_hashes),
        cmocka_unit_test(a_holder_names_its_wafer),
        cmocka_unit_test(no_wafer_has_two_holders),
        cmocka_unit_test(no_gripper_has_two_wafers),
        cmocka_unit_test(what_is_watched_is_a_wafer),
        cmocka_unit_test(releases_are_over_between_steps),
        cmocka_unit_test(an_empty_table_is_consistent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
