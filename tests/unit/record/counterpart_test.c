/* The wafer against which a gripper is shown: always the one that it holds or could take. */
#include "support/support.h"

#include "cell/station.h"
#include "record/counterpart.h"

enum { WAFERS = 12 };

static wh_gripper_t gripper;
static wh_wafer_t wafers[WAFERS];
static wh_state_t state;

static int set_up(void **unused) {
    (void)unused;
    memset(&gripper, 0, sizeof gripper);
    gripper.base_from_gripper = wh_pose_identity();
    gripper.wafer = WH_NONE;
    memset(&state, 0, sizeof state);
    state.grippers = &gripper;
    state.gripper_count = 1;
    state.wafers = wafers;
    state.wafer_count = WAFERS;
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer = wh_pose_identity();
        wafers[w].holder = WH_NONE;
    }
    return 0;
}

/* A stack of slots at a pitch of 10 mm whose wafers lie up to 40 mm off centre. */
static void fill(void) {
    for (size_t w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer.r =
            wh_vec3(wh_test_uniform(-40, 40), wh_test_uniform(-40, 40), 10.0 * (double)w);
    }
}

static double largest_share(size_t w, const wh_tolerance_t *tolerance) {
    wh_proximity_t p;
    assert_int_equal(
        wh_proximity_measure(&wafers[w].base_from_wafer, &gripper.base_from_gripper, tolerance, &p), WH_OK);
    return fmax(fabs(p.dr_proj_z) / tolerance->projz,
                fmax(p.dr_proj_xy_norm / tolerance->projxy, (1 - p.n1_proj_n2) / (1 - tolerance->planar)));
}

static void a_wafer_that_is_ready_is_the_one_though_another_centre_is_nearer(void **unused) {
    (void)unused;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_cell_t cell = {.tolerance = paper};
    wafers[0].base_from_wafer.r = wh_vec3(30, 0, 0.4);
    wafers[1].base_from_wafer.r = wh_vec3(0, 0, 10);
    assert_int_equal(wh_counterpart(&state, 0, &cell, NULL, 2), 0);
}

static void what_is_held_is_the_one_wherever_it_is(void **unused) {
    (void)unused;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_cell_t cell = {.tolerance = paper};
    fill();
    gripper.wafer = 7;
    assert_int_equal(wh_counterpart(&state, 0, &cell, NULL, WAFERS), 7);
    assert_int_equal(wh_counterpart(&state, 0, &cell, NULL, 0), 7);
}

static void without_candidates_there_is_none(void **unused) {
    (void)unused;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_cell_t cell = {.tolerance = paper};
    const int32_t one[] = {3};
    assert_int_equal(wh_counterpart(&state, 0, &cell, NULL, 0), WH_NONE);
    assert_int_equal(wh_counterpart(&state, 0, &cell, one, 1), 3);
}

static void the_smallest_of_the_largest_shares_wins(void **unused) {
    (void)unused;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_cell_t cell = {.tolerance = paper};
    for (int trial = 0; trial < 2000 / WH_TEST_SHARE; ++trial) {
        fill();
        gripper.base_from_gripper.r =
            wh_vec3(wh_test_uniform(-60, 60), wh_test_uniform(-60, 60), wh_test_uniform(-15, 130));
        const int32_t found = wh_counterpart(&state, 0, &cell, NULL, WAFERS);
        assert_in_range(found, 0, WAFERS - 1);
        for (size_t w = 0; w < WAFERS; ++w) {
            assert_true(largest_share((size_t)found, &paper) <= largest_share(w, &paper) + 1e-12);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_wafer_that_is_ready_is_the_one_though_another_centre_is_nearer, set_up),
        cmocka_unit_test_setup(what_is_held_is_the_one_wherever_it_is, set_up),
        cmocka_unit_test_setup(without_candidates_there_is_none, set_up),
        cmocka_unit_test_setup(the_smallest_of_the_largest_shares_wins, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
