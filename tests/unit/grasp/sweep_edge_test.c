/* Swept checking on its edges: a pick at the very end, a pass that only touches, a gripper that stands still, and two
 * limits met at one instant. */
#include "support/grasp.h"

#include "grasp/sweep_internal.h"

static void begin(cell_t *cell, bool seat) {
    wh_grasp_config_t config = wh_grasp_config_default();
    config.check = WH_CHECK_SWEPT;
    config.seat = seat;
    cell_begin(cell, &config);
}

/* Gripper 0, turned by 50 degrees about z, rises from 1 mm below wafer 0 to the very limit of 0.499 mm. */
static void rise_to_the_limit(cell_t *cell, bool seat) {
    begin(cell, seat);
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

/* Along a tangent, from where it touches the circle: both limits are strict, so nothing ever comes within. */
static void a_tangent_is_outside(void **state) {
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        cell_t cell;
        begin(&cell, false);
        cell_move(&cell, 0, 50, 0, 0, OPEN);
        cell_move(&cell, 0, 50, sign * 10, 0, OPEN);
        cell_expect_held(&cell, 0, WH_NONE);
        begin(&cell, false);
        cell_move(&cell, 0, 100, 0, 0, OPEN);
        cell_move(&cell, 0, 100, sign * 10, 0, OPEN);
        cell_expect_nothing(&cell);
        assert_int_equal(cell.gripper[0].approach.wafer, WH_NONE);
    }
}

/* Whoever does not move has come closest by where it is. */
static void standing_still_is_measured_where_it_stands(void **state) {
    (void)state;
    cell_t cell;
    begin(&cell, false);
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

/* A way on which the gripper, tilted beyond the limit at first, becomes almost level. */
static void draw(wh_pose_t *from, wh_pose_t *to) {
    const double tilt = wh_test_uniform(0.15, 0.3);
    const double x = wh_test_uniform(-1, 1);
    const double y = wh_test_uniform(-1, 1);
    *from = wh_test_pose(wh_test_rotation(x, y, 0, tilt), wh_test_uniform(-9, 9), wh_test_uniform(-9, 9), 0);
    *to = wh_test_pose(wh_test_rotation(x, y, wh_test_uniform(-0.2, 0.2), -tilt * wh_test_uniform(-0.3, 0.3)),
                       wh_test_uniform(-9, 9), wh_test_uniform(-9, 9), 0);
}

/* The gripper turns into the planar limit just when it rises into the window: whichever of the two instants is the later
 * one by rounding, the wafer is taken there. */
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
        cmocka_unit_test(a_pick_at_the_end_moves_nothing),
        cmocka_unit_test(a_seated_wafer_is_drawn_down_at_the_end),
        cmocka_unit_test(a_tangent_is_outside),
        cmocka_unit_test(standing_still_is_measured_where_it_stands),
        cmocka_unit_test(two_limits_at_one_instant_lose_nothing),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
