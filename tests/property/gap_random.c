/* The gap of pairs that are put at a known gap. Take an axis n, a point of a farthest along n and
 * one of b farthest against it, and place b so that its point is the other's + g n. For g >= 0 the
 * distance is g, whatever the shapes: n proves it to be no less, and the two points no more. For g
 * < 0 n proves the depth to be at most -g. */
#include "collision/gap.h"
#include "support/convex.h"
#include "support/support.h"

static const wh_vec3_t none = {0, 0, 0};
static const double gaps[] = {0.002, 0.005, 0.01, 0.1, 1, 5};

static wh_gap_t measure(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                        const wh_pose_t *base_from_b) {
    wh_gap_t gap;
    wh_gap_measure(a, base_from_a, b, base_from_b, 1e9, none, &gap);
    return gap;
}

/* --------------------------------------------------------------------------------- a thin wafer and a blade */

/* Transforms of a point from the frame of a pose to base, and back. */
static wh_vec3_t to_base(const wh_pose_t *pose, double x, double y, double z) {
    const wh_vec3_t point = {x, y, z};
    const wh_vec3_t turned = wh_mat3_transform(&pose->R, &point);
    return wh_vec3_add(&turned, &pose->r);
}

static void assert_clear(const wh_gap_t *gap, double want) {
    assert_int_equal(gap->state, WH_GAP_CLEAR);
    assert_near(gap->gap, want, 1e-6);
    assert_true(gap->gap <= want + 1e-9);
}

/* Level above the blade, the blade in any pose in base; below 0 the wafer may be in the blade or
 * come out below it. */
static void a_level_wafer_is_judged_right(void **state) {
    (void)state;
    const wh_convex_t wafer = wh_test_wafer();
    const wh_convex_t blade = wh_test_blade();
    wh_rounds_t rounds = WH_ROUNDS(5, 2000, 0.08);
    while (wh_round(&rounds)) {
        for (size_t g = 0; g < 2 * sizeof gaps / sizeof gaps[0]; ++g) {
            const double want = g % 2 ? -gaps[g / 2] : gaps[g / 2];
            const wh_pose_t base_from_blade = wh_test_random_pose(1000);
            wh_pose_t base_from_wafer = base_from_blade;
            base_from_wafer.r = to_base(&base_from_blade, wh_test_uniform(-150, 150),
                                        wh_test_uniform(-150, 150), 1.5 + 0.3875 + want);
            const wh_gap_t gap = measure(&blade, &base_from_blade, &wafer, &base_from_wafer);
            const double below = -want - 3 - 0.775;
            if (want > 0 || below > 0) {
                assert_clear(&gap, want > 0 ? want : below);
            } else {
                assert_int_equal(gap.state, WH_GAP_HIT);
            }
        }
    }
}

/* Tilted by up to 15 degrees, its lowest point above or in the blade. */
static void a_tilted_wafer_is_judged_right(void **state) {
    (void)state;
    const wh_convex_t wafer = wh_test_wafer();
    const wh_convex_t blade = wh_test_blade();
    wh_rounds_t rounds = WH_ROUNDS(5, 2000, 0.08);
    while (wh_round(&rounds)) {
        for (size_t g = 0; g < 2 * sizeof gaps / sizeof gaps[0]; ++g) {
            const double want = g % 2 ? -gaps[g / 2] : gaps[g / 2];
            const wh_pose_t base_from_blade = wh_test_random_pose(1000);
            const double way = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
            /* At a depth of 5 mm the lowest point is below the blade. The wafer must be steep
             * enough to be in the blade nearby. */
            const double tilt = want < -3 ? wh_test_uniform(0.1, 0.26) : wh_test_decades(1e-4, 0.26);
            wh_pose_t blade_from_wafer = wh_test_at(0, 0, 0);
            blade_from_wafer.R = wh_test_rotation(-sin(way), cos(way), 0, tilt);
            const wh_vec3_t lowest = {150 * cos(way), 150 * sin(way), -0.3875};
            const wh_vec3_t turned = wh_mat3_transform(&blade_from_wafer.R, &lowest);
            blade_from_wafer.r.x = wh_test_uniform(-30, 30) - turned.x;
            blade_from_wafer.r.y = wh_test_uniform(-30, 30) - turned.y;
            blade_from_wafer.r.z = 1.5 + want - turned.z;
            const wh_pose_t base_from_wafer = wh_pose_compose(&base_from_blade, &blade_from_wafer);
            const wh_gap_t gap = measure(&wafer, &base_from_wafer, &blade, &base_from_blade);
            if (want > 0) {
                assert_clear(&gap, want);
            } else {
                assert_int_equal(gap.state, WH_GAP_HIT);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------ pairs of all kinds */

typedef struct {
    wh_convex_t a, b;
    wh_vec3_t points_a[WH_TEST_MESH_POINTS], points_b[WH_TEST_MESH_POINTS];
    wh_pose_t base_from_a, base_from_b;
    wh_vec3_t axis;
} pair_t;

/* A direction at right angles to a face or an edge of each, or any direction. */
static wh_vec3_t draw_axis(const pair_t *pair) {
    const wh_vec3_t of_a = wh_mat3_column(&pair->base_from_a.R, wh_test_below(3));
    const wh_vec3_t of_b = wh_mat3_column(&pair->base_from_b.R, wh_test_below(3));
    wh_vec3_t axis = wh_vec3_cross(&of_a, &of_b);
    const uint32_t choice = wh_test_below(4);
    if (choice == 0) {
        axis = of_a;
    } else if (choice == 1) {
        axis = of_b;
    }
    const wh_real_t length = wh_vec3_norm(&axis);
    return choice == 3 || length < 0.01 ? wh_test_direction() : wh_vec3_scale(1 / length, &axis);
}

static wh_vec3_t farthest(const wh_convex_t *shape, const wh_pose_t *pose, const wh_vec3_t *axis) {
    const wh_vec3_t d = wh_mat3_transform_back(&pose->R, axis);
    const wh_vec3_t point = wh_test_farthest(shape, &d, 1e-9);
    return wh_mat3_transform(&pose->R, &point);
}

/* Two shapes of some kinds, g apart along an axis; some are nearly parallel. */
static void draw(pair_t *pair, wh_convex_kind_t kind_a, wh_convex_kind_t kind_b, double g) {
    do {
        pair->a = wh_test_random_shape(kind_a, pair->points_a);
        pair->b = wh_test_random_shape(kind_b, pair->points_b);
    } while (wh_convex_validate(&pair->a) != WH_OK || wh_convex_validate(&pair->b) != WH_OK);
    pair->base_from_a = wh_test_random_pose(1000);
    pair->base_from_b = pair->base_from_a;
    const wh_mat3_t turn = wh_test_random_turn(wh_test_below(2) ? WH_TEST_PI : 0.01);
    pair->base_from_b.R = wh_mat3_multiply(&pair->base_from_a.R, &turn);
    pair->axis = draw_axis(pair);
    const wh_vec3_t back = wh_vec3_scale(-1, &pair->axis);
    const wh_vec3_t on_a = farthest(&pair->a, &pair->base_from_a, &pair->axis);
    const wh_vec3_t on_b = farthest(&pair->b, &pair->base_from_b, &back);
    const wh_vec3_t apart = wh_vec3_scale(g, &pair->axis);
    pair->base_from_b.r = wh_vec3_add(&pair->base_from_a.r, &on_a);
    pair->base_from_b.r = wh_vec3_subtract(&pair->base_from_b.r, &on_b);
    pair->base_from_b.r = wh_vec3_add(&pair->base_from_b.r, &apart);
}

static wh_gap_t measure_pair(const pair_t *pair) {
    return measure(&pair->a, &pair->base_from_a, &pair->b, &pair->base_from_b);
}

/* Returns how many rounds there were. */
static int for_all_kinds(int full, void (*check)(pair_t *, wh_convex_kind_t, wh_convex_kind_t)) {
    pair_t pair;
    wh_rounds_t rounds = WH_ROUNDS(5, full, 0.12);
    while (wh_round(&rounds)) {
        for (unsigned kinds = 0; kinds < 16; ++kinds) {
            check(&pair, (wh_convex_kind_t)(kinds / 4), (wh_convex_kind_t)(kinds % 4));
        }
    }
    return rounds.made;
}

static void check_gap(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    const double want = wh_test_decades(0.00101, 300);
    draw(pair, a, b, want);
    const wh_gap_t gap = measure_pair(pair);
    assert_clear(&gap, want);
    assert_near(wh_gap_along(&pair->a, &pair->base_from_a, &pair->b, &pair->base_from_b, gap.axis), gap.gap,
                1e-9);
    assert_near(wh_vec3_norm(&gap.axis), 1, 1e-12);
}

static void every_gap_is_found(void **state) {
    (void)state;
    (void)for_all_kinds(2000, check_gap);
}

static void check_touching(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    draw(pair, a, b, wh_test_uniform(-2 * WH_GAP_CORE, WH_GAP_TOUCH));
    const wh_gap_t gap = measure_pair(pair);
    assert_int_equal(gap.state, WH_GAP_TOUCHING);
}

static void what_touches_is_touching(void **state) {
    (void)state;
    (void)for_all_kinds(500, check_touching);
}

static int deeper_touching, deeper_hit;

static void check_deeper(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    draw(pair, a, b, wh_test_uniform(-WH_GAP_TOUCH, -2 * WH_GAP_CORE));
    const wh_gap_t gap = measure_pair(pair);
    deeper_touching += gap.state == WH_GAP_TOUCHING;
    deeper_hit += gap.state == WH_GAP_HIT;
}

/* Even without a proof, the axis of least depth is nearly always found. */
static void what_overlaps_less_than_it_may_is_touching(void **state) {
    (void)state;
    const int made = for_all_kinds(500, check_deeper);
    printf("touching %d, taken for hits %d\n", deeper_touching, deeper_hit);
    assert_int_equal(deeper_touching + deeper_hit, made * 16);
    assert_true(deeper_hit <= 4 + made * 16 / 100);
}

/* A point of each lies within the other by twice the touch: they hit, whatever the way. */
static void check_hit(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    draw(pair, a, b, 0);
    const wh_vec3_t depth = wh_vec3_scale(wh_test_decades(0.002, 0.25), &pair->axis);
    /* Both grow by `depth` on all sides if that is simple: boxes, cylinders and capsules. */
    const wh_real_t by = wh_vec3_norm(&depth);
    wh_convex_t *const shapes[2] = {&pair->a, &pair->b};
    for (size_t i = 0; i < 2; ++i) {
        shapes[i]->half.x += by;
        shapes[i]->half.y += by;
        shapes[i]->half.z += shapes[i]->kind == WH_CONVEX_CAPSULE ? 0 : by;
    }
    const wh_gap_t gap = measure_pair(pair);
    assert_int_equal(gap.state, a == WH_CONVEX_MESH && b == WH_CONVEX_MESH ? WH_GAP_TOUCHING : WH_GAP_HIT);
}

static void what_overlaps_is_a_hit(void **state) {
    (void)state;
    (void)for_all_kinds(500, check_hit);
}

static void check_swapped(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    draw(pair, a, b, wh_test_decades(0.00101, 300));
    const wh_gap_t one = measure_pair(pair);
    const wh_gap_t other = measure(&pair->b, &pair->base_from_b, &pair->a, &pair->base_from_a);
    assert_int_equal(one.state, other.state);
    assert_near(one.gap, other.gap, 1e-6);
    /* The axis is as well determined as the gap is tight: a turn by t costs at least gap t^2 / 2. */
    const wh_vec3_t sum = wh_vec3_add(&one.axis, &other.axis);
    assert_true(wh_vec3_norm(&sum) <= 2 * sqrt(2 * 1e-6 / one.gap));
}

static void swapped_shapes_have_the_same_gap(void **state) {
    (void)state;
    (void)for_all_kinds(300, check_swapped);
}

/* Any guess, good or bad, gives the same gap; a gap that is large enough stays large enough. */
static void check_guess(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    const double want = wh_test_decades(0.00101, 300);
    draw(pair, a, b, want);
    const wh_vec3_t guess = wh_test_below(2) ? wh_test_direction() : wh_vec3_scale(7, &pair->axis);
    wh_gap_t gap;
    wh_gap_measure(&pair->a, &pair->base_from_a, &pair->b, &pair->base_from_b, 1e9, guess, &gap);
    assert_clear(&gap, want);
    wh_gap_measure(&pair->a, &pair->base_from_a, &pair->b, &pair->base_from_b, want / 2, guess, &gap);
    assert_int_equal(gap.state, WH_GAP_CLEAR);
    assert_true(gap.gap > want / 2 && gap.gap <= want + 1e-9);
}

static void a_guess_changes_nothing(void **state) {
    (void)state;
    (void)for_all_kinds(300, check_guess);
}

/* A small step on, or now and then a place elsewhere. */
static void go_on(pair_t *pair) {
    const bool jumps = wh_test_below(8) == 0;
    const wh_vec3_t direction = wh_test_direction();
    const wh_vec3_t way = wh_vec3_scale(jumps ? wh_test_uniform(0, 100) : wh_test_uniform(0, 2), &direction);
    const wh_mat3_t turn = wh_test_random_turn(jumps ? WH_TEST_PI : 0.01);
    pair->base_from_b.r = wh_vec3_add(&pair->base_from_b.r, &way);
    pair->base_from_b.R = wh_mat3_multiply(&pair->base_from_b.R, &turn);
    wh_mat3_orthonormalise(&pair->base_from_b.R);
}

/* Only the depth found for a shallow overlap depends on where the search begins. */
static void assert_same_gap(const wh_gap_t *followed, const wh_gap_t *gap, const pair_t *pair) {
    const double depth = -wh_gap_along(&pair->a, &pair->base_from_a, &pair->b, &pair->base_from_b, gap->axis);
    if (followed->state == gap->state) {
        assert_near(followed->gap, gap->gap, 2 * WH_GAP_TIGHT);
    } else {
        assert_int_not_equal(followed->state, WH_GAP_UNDECIDED);
        assert_true(depth > -WH_GAP_TOUCH - 2 * WH_GAP_TIGHT && depth < 2 * WH_GAP_TOUCH);
    }
}

static void check_followed(pair_t *pair, wh_convex_kind_t a, wh_convex_kind_t b) {
    wh_gap_start_t start = {0};
    wh_vec3_t axis = {0, 0, 0};
    draw(pair, a, b, wh_test_decades(0.00101, 30));
    for (int step = 0; step < 20; ++step) {
        const double enough = wh_test_below(2) ? 1e9 : wh_test_uniform(0, 20);
        const wh_gap_t gap = measure_pair(pair);
        wh_gap_t followed;
        wh_gap_follow(&pair->a, &pair->base_from_a, &pair->b, &pair->base_from_b, enough, axis, &start,
                      &followed);
        if (gap.gap <= enough) {
            assert_same_gap(&followed, &gap, pair);
        } else {
            assert_int_equal(followed.state, WH_GAP_CLEAR);
            assert_true(followed.gap > enough && followed.gap <= gap.gap + 2 * WH_GAP_TIGHT);
        }
        axis = followed.axis;
        go_on(pair);
    }
}

/* The result does not depend on earlier places of the two, nor on earlier limits. */
static void what_is_followed_has_the_same_gap(void **state) {
    (void)state;
    (void)for_all_kinds(300, check_followed);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_level_wafer_is_judged_right),
        cmocka_unit_test(a_tilted_wafer_is_judged_right),
        cmocka_unit_test(every_gap_is_found),
        cmocka_unit_test(what_touches_is_touching),
        cmocka_unit_test(what_overlaps_less_than_it_may_is_touching),
        cmocka_unit_test(what_overlaps_is_a_hit),
        cmocka_unit_test(swapped_shapes_have_the_same_gap),
        cmocka_unit_test(a_guess_changes_nothing),
        cmocka_unit_test(what_is_followed_has_the_same_gap),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
