/* Swept checking: fast passes, several wafers, and the two ends of a slice. Its edge cases: a pick
 * at the very end, a pass that only touches, a gripper that stands still, and two limits met at one
 * instant. */
#include "support/grasp.h"

#include "grasp/sweep_internal.h"

/* 1e-6 mm, or the resolution of float. */
#if defined(WH_FLOAT)
#define SAME_PLACE 1e-3
#else
#define SAME_PLACE 1e-6
#endif

static void begin(cell_t *cell, wh_check_t check) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = check;
    cell_begin(cell, &config);
}

/* Up past wafer 0 at 500 mm/s, from 5 mm below to 5 mm above it. */
static void rise(cell_t *cell, wh_check_t check, int slices) {
    begin(cell, check);
    cell_move(cell, 0, 7, -3, -5, OPEN);
    for (int i = 1; i <= slices; ++i) {
        cell_move(cell, 0, 7, -3, -5 + 10.0 * i / slices, OPEN);
    }
}

static void a_coarse_clock_picks_as_a_fine_one(void **state) {
    (void)state;
    cell_t coarse;
    cell_t fine;
    rise(&coarse, WH_CHECK_SWEPT, 1);
    rise(&fine, WH_CHECK_SWEPT, 200);
    cell_expect_held(&coarse, 0, 0);
    cell_expect_held(&fine, 0, 0);
    const wh_pose_t *a = &coarse.gripper[0].gripper_from_wafer;
    const wh_pose_t *b = &fine.gripper[0].gripper_from_wafer;
    assert_near(wh_test_difference_r(a, b), 0, SAME_PLACE);
    assert_near(wh_test_difference_R(a, b), 0, SAME_PLACE);
    assert_near(a->r.z, 0.998 * 0.5, SAME_PLACE);
    const wh_pose_t end = wh_pose_compose(&coarse.input[0].base_from_gripper, a);
    assert_memory_equal(&coarse.wafer[0].base_from_wafer, &end, sizeof end);
    const wh_event_t *e = cell_expect(&coarse, WH_EVENT_PICKED, 0, 0, WH_NONE);
    assert_near(e->measured.dr_proj_z, 0.499, SAME_PLACE);
    assert_int_equal(e->measured_slice, 2);
    assert_true(e->measured.ready);
}

static void sampled_misses_and_says_so(void **state) {
    (void)state;
    cell_t cell;
    rise(&cell, WH_CHECK_SAMPLED, 1);
    cell_expect_held(&cell, 0, WH_NONE);
    begin(&cell, WH_CHECK_SAMPLED);
    cell_move(&cell, 0, 0, 0, -4, OPEN);
    cell_move(&cell, 0, 0, 0, 6, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_near(e->measured.dr_proj_z, 4, 0);
    assert_int_equal(e->measured.failed, WH_FAILED_PROJZ);
    /* A wider neighbourhood sees the pass, though both of its slices are 5 mm away. */
    wh_grasp_config_t config = wh_grasp_config_default();
    config.near_projz = 6;
    cell_begin(&cell, &config);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_move(&cell, 0, 0, 0, 5, OPEN);
    cell_move(&cell, 0, 0, 0, 15, OPEN);
    assert_near(cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE)->measured.dr_proj_z, 5, 0);
}

static void a_lateral_pass_picks_at_the_circle(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, -100, 30, -0.25, OPEN);
    cell_move(&cell, 0, 300, 30, -0.25, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    assert_near(e->measured.dr.x, 40, 1e-3);
    assert_true(e->measured.ready);
    assert_near(cell.wafer[0].base_from_wafer.r.x, 300 + 40, 1e-3);
}

static void a_turn_picks_at_the_planar_limit(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell.input[0].base_from_gripper = wh_test_pose(wh_test_rotation(0, 1, 0, 0.3), 0, 0, 0);
    cell.input[0].valve = OPEN;
    cell_step(&cell);
    cell.input[0].base_from_gripper = wh_test_pose(wh_test_rotation(0, 1, 0, -0.3), 0, 0, 0);
    cell_step(&cell);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    assert_near(e->measured.n1_proj_n2, 0.99, 1e-5);
    assert_true(e->measured.ready);
    /* A wafer held at that angle turns with the gripper. */
    assert_near(cell.gripper[0].gripper_from_wafer.R.m[2][2], 0.99, 1e-5);
    assert_near(cell.wafer[0].base_from_wafer.R.m[2][2], cos(0.3 + acos(0.99)), 1e-4);
}

/* n2 turns about a tilted axis: first away from n1, past its farthest point, and then within the limit. */
static void a_turn_may_lead_away_before_it_leads_in(void **state) {
    (void)state;
    cell_t cell;
    const wh_mat3_t tilt = wh_test_rotation(0, 1, 0, 0.12);
    begin(&cell, WH_CHECK_SWEPT);
    for (int end = 0; end < 2; ++end) {
        const wh_mat3_t spin = wh_test_rotation(0, 0, 1, end ? 1.9 : -1.2);
        const wh_mat3_t spun = wh_mat3_multiply(&tilt, &spin);
        cell.input[0].base_from_gripper.R = wh_mat3_multiply(&spun, &tilt);
        cell.input[0].base_from_gripper.r = wh_vec3(0, 0, 0);
        cell.input[0].valve = OPEN;
        cell_step(&cell);
        assert_int_equal(cell.list.count, end);
    }
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    assert_near(e->measured.n1_proj_n2, 0.99, 1e-5);
    assert_int_equal(e->measured_slice, 2);
}

static void the_first_wafer_on_the_way_is_taken(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_place(&cell, 3, 0, 0, -3);
    cell_place(&cell, 1, 0, 0, 3);
    cell_move(&cell, 0, 0, 0, -8, OPEN);
    cell_move(&cell, 0, 0, 0, 8, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 3, 0, WH_NONE);
    begin(&cell, WH_CHECK_SWEPT);
    cell_place(&cell, 1, 0, 0, 3);
    cell_move(&cell, 0, 0, 0, 8, OPEN);
    cell_move(&cell, 0, 0, 0, -8, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 1, 0, WH_NONE);
}

/* Both are entered sideways at the same instant: the nearer in z counts, and among equal ones the
 * lower index. */
static void ties_go_to_the_nearer_then_the_lower(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_place(&cell, 1, 0, 0, 0.375);
    cell_place(&cell, 2, 0, 0, -0.125);
    cell_place(&cell, 3, 0, 0, 0.125);
    cell_place(&cell, 0, 0, 0, 5);
    cell_move(&cell, 0, -100, 0, 0, OPEN);
    cell_move(&cell, 0, 100, 0, 0, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 2, 0, WH_NONE);
}

static void both_ends_must_be_open(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, 0, 0, -5, CLOSED);
    cell_move(&cell, 0, 0, 0, 5, OPEN);
    cell_expect_nothing(&cell);
    cell_move(&cell, 0, 0, 0, -5, CLOSED);
    cell_expect_nothing(&cell);
    /* The first step has no earlier pose, whatever the gripper's struct contains. */
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, 0, 0, 5, OPEN);
    cell_expect_nothing(&cell);
    /* A gripper that held a wafer at the slice's beginning is not empty: it releases the wafer and
     * takes nothing. */
    cell_move(&cell, 0, 0, 0, 0.25, OPEN);
    cell_expect_held(&cell, 0, 0);
}

/* The literal check at the end takes a wafer between 0.998 and 1 times the limit. */
static void the_end_is_checked_by_the_formulas(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_move(&cell, 0, 0, 0, -0.4995, OPEN);
    cell_expect_held(&cell, 0, 0);
    assert_near(cell.gripper[0].gripper_from_wafer.r.z, 0.4995, SAME_PLACE);
    assert_true(cell.wafer[0].base_from_wafer.r.z == 0);
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_move(&cell, 0, 0, 0, -0.5, OPEN);
    cell_expect_held(&cell, 0, WH_NONE);
}

/* Gripper 1 releases in this slice: its place during the slice does not matter. */
static void a_released_wafer_is_checked_at_the_end_only(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 1, 0, 0, 0, OPEN);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_set(&cell, 1, 0, 0, 0, CLOSED);
    cell_move(&cell, 0, 0, 0, 5, OPEN);
    cell_expect(&cell, WH_EVENT_RELEASED, 0, 1, WH_NONE);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_expect(&cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 1, 0, 0, 0, OPEN);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_set(&cell, 1, 0, 0, 0, CLOSED);
    cell_move(&cell, 0, 0, 0, 0.25, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_HANDED_OVER, 0, 0, 1);
    assert_near(e->measured.dr_proj_z, -0.25, 0);
}

static void a_seated_wafer_is_drawn_down_in_flight(void **state) {
    (void)state;
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = WH_CHECK_SWEPT;
    config.seat = true;
    cell_t cell;
    cell_begin(&cell, &config);
    cell_move(&cell, 0, 0, 0, -5, OPEN);
    cell_move(&cell, 0, 0, 0, 5, OPEN);
    cell_expect_held(&cell, 0, 0);
    assert_true(cell.gripper[0].gripper_from_wafer.r.z == 0);
    assert_near(cell.wafer[0].base_from_wafer.r.z, 5, 0);
}

/* A pass beside the wafer, in at one side of the neighbourhood and out at the other within one slice. */
static void a_pass_beside_is_a_near_miss_at_its_closest(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, -300, 20, -2, OPEN);
    cell_move(&cell, 0, 500, 20, -2, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_near(e->measured.dr_proj_xy_norm, 20, 1e-3);
    assert_near(e->measured.dr_proj_z, 2, SAME_PLACE);
    assert_int_equal(e->measured.failed, WH_FAILED_PROJZ);
    assert_int_equal(e->measured_slice, 2);
    cell_move(&cell, 0, 600, 20, -2, OPEN);
    cell_expect_nothing(&cell);
}

/* Between 0.998 and 1 times the limit a pass takes nothing, and its near miss names the limit that
 * it failed. */
static void a_graze_is_told_why(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_move(&cell, 0, -300, 0, -0.4995, OPEN);
    cell_move(&cell, 0, 300, 0, -0.4995, OPEN);
    const wh_event_t *e = cell_expect(&cell, WH_EVENT_NEAR_MISS, 0, 0, WH_NONE);
    assert_false(e->measured.ready);
    assert_int_equal(e->measured.failed, WH_FAILED_PROJZ);
    assert_near(e->measured.margin_projz, -0.0005, SAME_PLACE);
}

/* The closest pose, if it is at the slice's end, has that pose's bits, not those of a sum that
 * comes near it. */
static void the_end_is_the_pose_that_was_given(void **state) {
    (void)state;
    for (int run = 0; run < 100; ++run) {
        cell_t cell;
        begin(&cell, WH_CHECK_SWEPT);
        cell_move(&cell, 0, wh_test_uniform(-300, -200), -7, -9, OPEN);
        const double x = wh_test_uniform(-20, -10);
        cell_move(&cell, 0, x, 5, wh_test_uniform(-4, -1), OPEN);
        const wh_encounter_t *approach = &cell.gripper[0].approach;
        const wh_vec3_t dr =
            wh_vec3_subtract(&cell.wafer[0].base_from_wafer.r, &cell.input[0].base_from_gripper.r);
        assert_int_equal(approach->wafer, 0);
        assert_memory_equal(&approach->measured.dr, &dr, sizeof dr);
    }
}

static void lower_gripper_wins_even_if_later(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, WH_CHECK_SWEPT);
    cell_set(&cell, 0, 0, 0, -9, OPEN);
    cell_move(&cell, 1, 0, 0, -1, OPEN);
    cell_set(&cell, 0, 0, 0, 0.25, OPEN);
    cell_move(&cell, 1, 0, 0, 9, OPEN);
    cell_expect_held(&cell, 0, 0);
}

/* ------------------------------------------------------------------------------------------------ on its edges */

static void begin_swept(cell_t *cell, bool seat) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = WH_CHECK_SWEPT;
    config.seat = seat;
    cell_begin(cell, &config);
}

/* Gripper 0, turned by 50 degrees about z, rises from 1 mm below wafer 0 to the very limit of 0.499 mm. */
static void rise_to_the_limit(cell_t *cell, bool seat) {
    begin_swept(cell, seat);
    const wh_mat3_t turned = wh_test_rotation(0, 0, 1, 0.87);
    cell->input[0].base_from_gripper = wh_test_pose(turned, 5, -3, -1);
    cell->input[0].valve = OPEN;
    cell_step(cell);
    cell_expect_nothing(cell);
    cell->input[0].base_from_gripper.r.z = -(WH_SWEEP_INSIDE * cell->table.config.tolerance.projz);
    cell_step(cell);
    cell_expect(cell, WH_EVENT_PICKED, 0, 0, WH_NONE);
}

static void a_pick_at_the_end_moves_nothing(void **state) {
    (void)state;
    cell_t cell;
    const wh_pose_t before = wh_test_at(0, 0, 0);
    rise_to_the_limit(&cell, false);
    assert_memory_equal(&cell.wafer[0].base_from_wafer, &before, sizeof before);
    assert_near(cell.gripper[0].gripper_from_wafer.r.z, 0.499, 1e-6);
}

static void a_seated_wafer_is_drawn_down_at_the_end(void **state) {
    (void)state;
    cell_t cell;
    rise_to_the_limit(&cell, true);
    assert_true(cell.gripper[0].gripper_from_wafer.r.z == 0);
    assert_near(cell.wafer[0].base_from_wafer.r.z, -0.499, 1e-6);
}

/* Along a tangent, from the point where it touches the circle: both limits are strict, so nothing
 * ever comes within. */
static void a_tangent_is_outside(void **state) {
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        cell_t cell;
        begin_swept(&cell, false);
        cell_move(&cell, 0, 50, 0, 0, OPEN);
        cell_move(&cell, 0, 50, sign * 10, 0, OPEN);
        cell_expect_held(&cell, 0, WH_NONE);
        begin_swept(&cell, false);
        cell_move(&cell, 0, 100, 0, 0, OPEN);
        cell_move(&cell, 0, 100, sign * 10, 0, OPEN);
        cell_expect_nothing(&cell);
        assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    }
}

/* A gripper that does not move is closest at its place. */
static void standing_still_is_measured_where_it_stands(void **state) {
    (void)state;
    cell_t cell;
    begin_swept(&cell, false);
    cell_move(&cell, 0, 3, 4, -2, OPEN);
    cell_place(&cell, 0, 3000, 0, 0);
    cell_place(&cell, 1, 0, 0, 0);
    cell_step(&cell);
    const wh_encounter_t *approach = &cell.gripper[0].approach;
    assert_int_equal(approach->wafer, 1);
    assert_int_equal(approach->slice, 2);
    assert_near(approach->measured.dr_proj_z, 2, 0);
    assert_near(approach->measured.dr_proj_xy_norm, 5, 1e-6);
    cell_step(&cell);
    assert_int_equal(approach->slice, 2);
}

/* A way on which the gripper is tilted beyond the limit at first, and becomes almost level. */
static void draw(wh_pose_t *from, wh_pose_t *to) {
    const double tilt = wh_test_uniform(0.15, 0.3);
    const double x = wh_test_uniform(-1, 1);
    const double y = wh_test_uniform(-1, 1);
    *from = wh_test_pose(wh_test_rotation(x, y, 0, tilt), wh_test_uniform(-9, 9), wh_test_uniform(-9, 9), 0);
    *to = wh_test_pose(wh_test_rotation(x, y, wh_test_uniform(-0.2, 0.2), -tilt * wh_test_uniform(-0.3, 0.3)),
                       wh_test_uniform(-9, 9), wh_test_uniform(-9, 9), 0);
}

/* The gripper turns into the planar limit just when it rises into the window. The wafer is taken at
 * the instant that rounding makes the later one. */
static void two_limits_at_one_instant_lose_nothing(void **state) {
    (void)state;
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_pose_t wafer = wh_test_at(0, 0, 0);
    const wh_real_t window = WH_SWEEP_INSIDE * tolerance.projz;
    for (int i = 0; i < 2000; ++i) {
        wh_pose_t from;
        wh_pose_t to;
        wh_sweep_t sweep;
        wh_real_t planar;
        draw(&from, &to);
        wh_sweep_between(&from, &to, &sweep);
        assert_true(wh_sweep_first_ready(&sweep, &wafer, &tolerance, &planar));
        const wh_real_t rise = WH_REAL(wh_test_uniform(0.1, 3));
        from.r.z = -window - rise * planar;
        to.r.z = from.r.z + rise;
        for (int step = -3; step <= 3; ++step) {
            wh_pose_t lower = from;
            wh_real_t t;
            lower.r.z = wh_test_ulps(from.r.z, step);
            wh_sweep_between(&lower, &to, &sweep);
            assert_true(wh_sweep_first_ready(&sweep, &wafer, &tolerance, &t));
            assert_near(t, planar, 2e-3);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_coarse_clock_picks_as_a_fine_one),
        cmocka_unit_test(sampled_misses_and_says_so),
        cmocka_unit_test(a_lateral_pass_picks_at_the_circle),
        cmocka_unit_test(a_turn_picks_at_the_planar_limit),
        cmocka_unit_test(a_turn_may_lead_away_before_it_leads_in),
        cmocka_unit_test(the_first_wafer_on_the_way_is_taken),
        cmocka_unit_test(ties_go_to_the_nearer_then_the_lower),
        cmocka_unit_test(both_ends_must_be_open),
        cmocka_unit_test(the_end_is_checked_by_the_formulas),
        cmocka_unit_test(a_released_wafer_is_checked_at_the_end_only),
        cmocka_unit_test(a_seated_wafer_is_drawn_down_in_flight),
        cmocka_unit_test(a_pass_beside_is_a_near_miss_at_its_closest),
        cmocka_unit_test(a_graze_is_told_why),
        cmocka_unit_test(the_end_is_the_pose_that_was_given),
        cmocka_unit_test(lower_gripper_wins_even_if_later),
        cmocka_unit_test(a_pick_at_the_end_moves_nothing),
        cmocka_unit_test(a_seated_wafer_is_drawn_down_at_the_end),
        cmocka_unit_test(a_tangent_is_outside),
        cmocka_unit_test(standing_still_is_measured_where_it_stands),
        cmocka_unit_test(two_limits_at_one_instant_lose_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
