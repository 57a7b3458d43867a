/* The gap of simple pairs with answers known by hand; invalid poses; the result of a spent budget;
 * the heap. */
#include "collision/gap.h"

#include "collision/gap_internal.h"
#include "support/convex.h"
#include "support/heap.h"
#include "support/support.h"

static const wh_vec3_t none = {0, 0, 0};

static wh_gap_t measure(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                        const wh_pose_t *base_from_b) {
    wh_gap_t gap;
    wh_gap_measure(a, base_from_a, b, base_from_b, 1e9, none, &gap);
    return gap;
}

/* ----------------------------------------------------------------------------------------------- known by hand */

static void balls_are_as_far_as_their_centres(void **state) {
    (void)state;
    const wh_convex_t small = wh_test_shape(WH_CONVEX_CAPSULE, 1, 0, 0);
    const wh_convex_t large = wh_test_shape(WH_CONVEX_CAPSULE, 2, 0, 0);
    const wh_pose_t here = wh_test_at(10, 20, 30);
    const wh_pose_t there = wh_test_at(13, 24, 30);
    const wh_gap_t gap = measure(&small, &here, &large, &there);
    assert_int_equal(gap.state, WH_GAP_CLEAR);
    assert_near(gap.gap, 2, 1e-12);
    assert_near(gap.axis.x, 0.6, 1e-12);
    assert_near(gap.axis.y, 0.8, 1e-12);
    /* The nearest points are 1 mm and 3 mm along it. */
    assert_near(gap.at.x, 10 + 2 * 0.6, 1e-9);
    assert_near(gap.at.y, 20 + 2 * 0.8, 1e-9);
    assert_near(gap.at.z, 30, 1e-9);
}

static void a_box_above_another_is_between_them(void **state) {
    (void)state;
    const wh_convex_t box = wh_test_shape(WH_CONVEX_BOX, 10, 20, 1);
    const wh_pose_t here = wh_test_at(0, 0, 0);
    const wh_pose_t there = wh_test_at(15, 35, 2.5);
    const wh_gap_t gap = measure(&box, &here, &box, &there);
    assert_int_equal(gap.state, WH_GAP_CLEAR);
    assert_near(gap.gap, 0.5, 1e-9);
    assert_near(gap.axis.z, 1, 1e-9);
    assert_true(gap.at.x >= 5 && gap.at.x <= 10 && gap.at.y >= 15 && gap.at.y <= 20);
    assert_near(gap.at.z, 1.25, 1e-6);
}

static void what_touches_says_where(void **state) {
    (void)state;
    const wh_convex_t box = wh_test_shape(WH_CONVEX_BOX, 10, 20, 1);
    const wh_convex_t pin = wh_test_shape(WH_CONVEX_CAPSULE, 1, 0, 5);
    const wh_pose_t here = wh_test_at(0, 0, 0);
    for (int i = -9; i <= 9; ++i) {
        const wh_pose_t there = wh_test_at(3, -4, 7 + 1e-4 * i);
        const wh_gap_t gap = measure(&box, &here, &pin, &there);
        assert_int_equal(gap.state, WH_GAP_TOUCHING);
        assert_near(gap.gap, 0, 0);
        assert_near(gap.axis.z, 1, 1e-6);
        assert_near(gap.at.x, 3, 1e-5);
        assert_near(gap.at.y, -4, 1e-5);
        assert_near(gap.at.z, 1, 1e-3);
    }
}

static bool is_in_box(const wh_vec3_t *point, const wh_convex_t *box, const wh_pose_t *pose, double slack) {
    const wh_vec3_t from = wh_vec3_subtract(point, &pose->r);
    const wh_vec3_t p = wh_mat3_transform_back(&pose->R, &from);
    return fabs(p.x) <= box->half.x + slack && fabs(p.y) <= box->half.y + slack &&
           fabs(p.z) <= box->half.z + slack;
}

/* Boxes with a common point deep in both hit; the reported place is in both. */
static void where_boxes_hit_is_in_both(void **state) {
    (void)state;
    for (int i = 0; i < 5000 / WH_TEST_SHARE; ++i) {
        wh_convex_t boxes[2];
        wh_pose_t poses[2];
        for (size_t k = 0; k < 2; ++k) {
            boxes[k] = wh_test_random_shape(WH_CONVEX_BOX, NULL);
            poses[k] = wh_test_random_pose(0);
            const wh_vec3_t *half = &boxes[k].half;
            const double x = wh_test_uniform(-0.9, 0.9) * half->x;
            const double y = wh_test_uniform(-0.9, 0.9) * half->y;
            const wh_vec3_t shared = {x, y, wh_test_uniform(-0.9, 0.9) * half->z};
            const wh_vec3_t turned = wh_mat3_transform(&poses[k].R, &shared);
            poses[k].r = wh_vec3_subtract(&(wh_vec3_t){700, -300, 900}, &turned);
        }
        const wh_gap_t gap = measure(&boxes[0], &poses[0], &boxes[1], &poses[1]);
        assert_int_equal(gap.state, WH_GAP_HIT);
        assert_near(gap.gap, 0, 0);
        assert_true(is_in_box(&gap.at, &boxes[0], &poses[0], 1e-6));
        assert_true(is_in_box(&gap.at, &boxes[1], &poses[1], 1e-6));
    }
}

static void bodies_at_the_same_place_hit(void **state) {
    (void)state;
    const wh_pose_t here = wh_test_at(1, 2, 3);
    for (unsigned kinds = 0; kinds < 9; ++kinds) {
        const wh_convex_t a = wh_test_shape((wh_convex_kind_t)(kinds / 3), 3, 4, 5);
        const wh_convex_t b = wh_test_shape((wh_convex_kind_t)(kinds % 3), 2, 4, 7);
        const wh_gap_t gap = measure(&a, &here, &b, &here);
        assert_int_equal(gap.state, WH_GAP_HIT);
        assert_near(gap.at.x, 1, 2);
        assert_near(gap.at.y, 2, 3);
        assert_near(gap.at.z, 3, 5);
    }
}

/* The larger of two distances along an axis, with its sign. */
static void along_an_axis_it_is_the_difference_of_ends(void **state) {
    (void)state;
    const wh_convex_t wafer = wh_test_wafer();
    const wh_convex_t blade = wh_test_blade();
    const wh_pose_t here = wh_test_at(0, 0, 0);
    const wh_pose_t there = wh_test_at(300, 0, 2);
    assert_near(wh_gap_along(&blade, &here, &wafer, &there, wh_vec3(0, 0, 1)), 2 - 1.5 - 0.3875, 1e-12);
    assert_near(wh_gap_along(&blade, &here, &wafer, &there, wh_vec3(1, 0, 0)), 300 - 80 - 150, 1e-12);
    assert_near(wh_gap_along(&blade, &here, &wafer, &there, wh_vec3(0, 1, 0)), -75 - 150, 1e-12);
    assert_near(wh_gap_along(&blade, &here, &wafer, &there, wh_vec3(0, 0, -1)), -2 - 1.5 - 0.3875, 1e-12);
}

/* ------------------------------------------------------------------------------------------ guess and budget */

/* A guess whose proof is enough is accepted, though another axis would prove more. */
static void a_guess_that_is_enough_ends_it(void **state) {
    (void)state;
    const wh_convex_t ball = wh_test_shape(WH_CONVEX_CAPSULE, 1, 0, 0);
    const wh_pose_t here = wh_test_at(0, 0, 0);
    const wh_pose_t there = wh_test_at(30, 40, 0);
    wh_gap_t gap;
    wh_gap_measure(&ball, &here, &ball, &there, 20, wh_vec3(5, 0, 0), &gap);
    assert_int_equal(gap.state, WH_GAP_CLEAR);
    assert_near(gap.gap, 28, 1e-12);
    assert_near(gap.axis.x, 1, 0);
    wh_gap_measure(&ball, &here, &ball, &there, 28, wh_vec3(5, 0, 0), &gap);
    assert_near(gap.gap, 48, 1e-12);
    /* Shapes that may touch are never clear, however small a gap is enough. */
    const wh_pose_t near = wh_test_at(2.0009, 0, 0);
    wh_gap_measure(&ball, &here, &ball, &near, 0, wh_vec3(5, 0, 0), &gap);
    assert_int_equal(gap.state, WH_GAP_TOUCHING);
    wh_gap_measure(&ball, &here, &ball, &near, -1, wh_vec3(5, 0, 0), &gap);
    assert_int_equal(gap.state, WH_GAP_TOUCHING);
    wh_gap_measure(&ball, &here, &ball, &there, (double)NAN, wh_vec3((double)NAN, 0, (double)INFINITY), &gap);
    assert_int_equal(gap.state, WH_GAP_CLEAR);
    assert_true(gap.gap > 0 && gap.gap <= 48);
}

static wh_gap_state_t within(double z, int steps, int supports) {
    const wh_convex_t wafer = wh_test_wafer();
    const wh_convex_t blade = wh_test_blade();
    const wh_pose_t here = wh_test_pose(wh_test_rotation(1, 2, 0, 0.02), 0, 0, 0);
    const wh_pose_t there = wh_test_at(40, 30, z);
    const wh_gap_pair_t pair = {&blade, &wafer, &here, &there, {0, 0, 0}, NULL};
    const wh_gap_budget_t budget = {steps, supports};
    wh_gap_t gap;
    wh_gap_measure_within(&pair, 1e9, none, &budget, &gap);
    return gap.state;
}

/* However small the budget is, no answer is wrong; if it is too small, there is no answer. */
static void a_spent_budget_is_undecided(void **state) {
    (void)state;
    assert_int_equal(within(0.5, 500, 2000), WH_GAP_HIT);
    assert_int_equal(within(0.5, 500, 0), WH_GAP_UNDECIDED);
    assert_int_equal(within(0.5, 500, 1), WH_GAP_UNDECIDED);
    assert_int_equal(within(0.5, 0, 0), WH_GAP_UNDECIDED);
    int undecided = 0;
    for (int supports = 0; supports < 60; ++supports) {
        for (int steps = 0; steps < 20; ++steps) {
            const wh_gap_state_t hit = within(0.5, steps, supports);
            const wh_gap_state_t clear = within(4, steps, supports);
            assert_true(hit == WH_GAP_HIT || hit == WH_GAP_UNDECIDED);
            assert_true(clear == WH_GAP_CLEAR || clear == WH_GAP_UNDECIDED);
            undecided += (hit == WH_GAP_UNDECIDED) + (clear == WH_GAP_UNDECIDED);
        }
    }
    assert_true(undecided > 10 && undecided < 1000);
}

/* If the steps do not suffice to make a gap tight, it is still clear, and the proved part of it is
 * returned. */
static void what_is_proven_is_never_too_much(void **state) {
    (void)state;
    const wh_convex_t wafer = wh_test_wafer();
    const wh_pose_t here = wh_test_pose(wh_test_rotation(1, 2, 0, 0.3), 0, 0, 0);
    const wh_pose_t there = wh_test_at(200, 200, 200);
    const double want = (double)measure(&wafer, &here, &wafer, &there).gap;
    const wh_gap_pair_t pair = {&wafer, &wafer, &here, &there, {0, 0, 0}, NULL};
    double before = 0;
    for (int steps = 0; steps < 40; ++steps) {
        const wh_gap_budget_t budget = {steps, 0};
        wh_gap_t gap;
        wh_gap_measure_within(&pair, 1e9, none, &budget, &gap);
        assert_int_equal(gap.state, WH_GAP_CLEAR);
        assert_true(gap.gap >= before && gap.gap <= want + 1e-6);
        before = (double)gap.gap;
    }
    assert_near(before, want, 1e-6);
}

/* ------------------------------------------------------------------------------------------------- no poses */

static void what_is_no_pose_is_undecided(void **state) {
    (void)state;
    const wh_convex_t wafer = wh_test_wafer();
    const wh_pose_t good = wh_test_at(0, 0, 1);
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1e300};
    for (size_t i = 0; i < 4; ++i) {
        for (size_t entry = 0; entry < 12; ++entry) {
            wh_pose_t pose = wh_test_at(0, 0, 0);
            wh_real_t *const number = entry < 9
                                          ? &pose.R.m[entry / 3][entry % 3]
                                          : (wh_real_t *const[]){&pose.r.x, &pose.r.y, &pose.r.z}[entry - 9];
            *number = bad[i];
            for (int guessed = 0; guessed < 2; ++guessed) {
                wh_gap_t gap;
                const wh_vec3_t guess = guessed ? wh_vec3(0, 0, 1) : none;
                wh_gap_measure(&wafer, &pose, &wafer, &good, 1e9, guess, &gap);
                assert_int_equal(gap.state, WH_GAP_UNDECIDED);
                assert_near(gap.gap, 0, 0);
                wh_gap_measure(&wafer, &good, &wafer, &pose, 1e9, guess, &gap);
                assert_int_equal(gap.state, WH_GAP_UNDECIDED);
                assert_near(gap.axis.z, 0, 0);
            }
        }
    }
}

/* ----------------------------------------------------------------------------------------------------- heap */

static void nothing_is_allocated(void **state) {
    (void)state;
#if defined(WH_TEST_COUNTS_HEAP)
    static wh_vec3_t points[2][WH_TEST_MESH_POINTS];
    int states[4] = {0, 0, 0, 0};
    const unsigned long before = calls;
    for (int i = 0; i < 4000; ++i) {
        const wh_convex_t a = wh_test_random_shape((wh_convex_kind_t)(i % 4), points[0]);
        const wh_convex_t b = wh_test_random_shape((wh_convex_kind_t)(i / 4 % 4), points[1]);
        const wh_pose_t here = wh_test_random_pose(60);
        const wh_pose_t there = wh_test_random_pose(60);
        ++states[measure(&a, &here, &b, &there).state];
    }
    assert_int_equal(calls - before, 0);
    assert_true(states[WH_GAP_CLEAR] > 300 && states[WH_GAP_HIT] > 300);
    assert_int_equal(states[WH_GAP_UNDECIDED], 0);
#else
    skip();
#endif
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(balls_are_as_far_as_their_centres),
        cmocka_unit_test(a_box_above_another_is_between_them),
        cmocka_unit_test(what_touches_says_where),
        cmocka_unit_test(where_boxes_hit_is_in_both),
        cmocka_unit_test(bodies_at_the_same_place_hit),
        cmocka_unit_test(along_an_axis_it_is_the_difference_of_ends),
        cmocka_unit_test(a_guess_that_is_enough_ends_it),
        cmocka_unit_test(a_spent_budget_is_undecided),
        cmocka_unit_test(what_is_proven_is_never_too_much),
        cmocka_unit_test(what_is_no_pose_is_undecided),
        cmocka_unit_test(nothing_is_allocated),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
