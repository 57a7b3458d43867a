/* The proximity check at its limits: strict comparisons, reasons, margins, and one verdict from two
 * functions. */
#include "grasp/face.h"
#include "grasp/proximity.h"
#include "support/proximity.h"

#define PAIRS 1000000

static const unsigned every_reason = WH_FAILED_PROJZ | WH_FAILED_PROJXY | WH_FAILED_PLANAR;

/* Measures valid arguments, and checks that the function with the verdict alone agrees. */
static wh_proximity_t measure(const wh_pose_t *wafer, const wh_pose_t *gripper,
                              const wh_tolerance_t *tolerance) {
    wh_proximity_t p;
    assert_int_equal(wh_proximity_measure(wafer, gripper, tolerance, &p), WH_OK);
    assert_int_equal(wh_proximity_ready(wafer, gripper, tolerance), p.ready);
    assert_int_equal(p.ready, p.failed == 0);
    return p;
}

/* A wafer with the identity as rotation, and a gripper at base's origin whose n2 has exactly this
 * cosine to n1. */
static wh_proximity_t at(wh_real_t x, wh_real_t y, wh_real_t z, wh_real_t cosine,
                         const wh_tolerance_t *tolerance) {
    const wh_pose_t wafer = {wh_mat3_identity(), {x, y, z}};
    wh_pose_t gripper = wh_pose_identity();
    const wh_real_t sine = WH_REAL(sqrt(1 - (double)cosine * (double)cosine));
    gripper.R.m[1][1] = cosine;
    gripper.R.m[1][2] = -sine;
    gripper.R.m[2][1] = sine;
    gripper.R.m[2][2] = cosine;
    return measure(&wafer, &gripper, tolerance);
}

static void each_limit_itself_fails(void **state) {
    (void)state;
    const wh_tolerance_t some[] = {wh_tolerance_paper(), wh_tolerance_strict(), {WH_REAL(0.3), 10, 0}};
    for (size_t i = 0; i < 3; ++i) {
        const wh_tolerance_t *t = &some[i];
        const wh_real_t x = WH_REAL(0.6) * t->projxy;
        for (int sign = -1; sign <= 1; sign += 2) {
            assert_int_equal(at(0, 0, WH_REAL(sign) * t->projz, 1, t).failed, WH_FAILED_PROJZ);
            assert_int_equal(at(0, 0, WH_REAL(sign) * wh_test_ulps(t->projz, -1), 1, t).failed, 0);
            assert_int_equal(at(WH_REAL(sign) * t->projxy, 0, 0, 1, t).failed, WH_FAILED_PROJXY);
            assert_int_equal(at(0, WH_REAL(sign) * t->projxy, 0, 1, t).failed, WH_FAILED_PROJXY);
            assert_int_equal(at(WH_REAL(sign) * wh_test_ulps(t->projxy, -1), 0, 0, 1, t).failed, 0);
        }
        assert_int_equal(at(x, 0, 0, t->planar, t).failed, WH_FAILED_PLANAR);
        assert_int_equal(at(x, 0, 0, wh_test_neighbour(t->planar, 1), t).failed, 0);
    }
}

static void xy_is_a_circle_not_a_square(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    assert_int_equal(at(30, 40, 0, 1, &paper).failed, WH_FAILED_PROJXY);
    assert_int_equal(at(30, wh_test_ulps(40, -1), 0, 1, &paper).failed, 0);
    assert_int_equal(at(-48, 14, 0, 1, &paper).failed, WH_FAILED_PROJXY);
    assert_int_equal(at(36, -36, 0, 1, &paper).failed, WH_FAILED_PROJXY);
}

static void reasons_add_up(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    for (unsigned failed = 0; failed <= every_reason; ++failed) {
        const wh_real_t z = failed & WH_FAILED_PROJZ ? 1 : WH_REAL(0.25);
        const wh_real_t x = failed & WH_FAILED_PROJXY ? 60 : 20;
        const wh_real_t cosine = failed & WH_FAILED_PLANAR ? WH_REAL(0.5) : 1;
        const wh_proximity_t p = at(x, 0, -z, cosine, &paper);
        assert_int_equal(p.failed, failed);
        assert_near(p.margin_projz, 0.5 - (double)z, 0);
        assert_near(p.margin_projxy, 50 - (double)x, 0);
        assert_near(p.margin_planar, cosine - WH_REAL(0.99), 0);
        assert_near(p.dr_proj_z, -z, 0);
        assert_near(p.dr_proj_xy_norm, x, 0);
        assert_near(p.dr_proj_xy.x, x, 0);
        assert_near(p.dr_proj_xy.z, -z, 0);
        assert_near(p.dr.z, -z, 0);
        assert_near(p.n1_proj_n2, cosine, 0);
    }
}

/* dr is projected onto the wafer's axes, not the gripper's: tilt each in turn. */
static void projections_are_onto_the_wafer(void **state) {
    (void)state;
    const wh_tolerance_t wide = {10, 100, 0};
    const double angle = 0.1;
    const wh_pose_t tilted = wh_test_pose(wh_test_rotation(0, 1, 0, angle), 20, 0, 0);
    const wh_pose_t level = wh_test_at(20, 0, 0);
    const wh_pose_t turned = wh_test_pose(wh_test_rotation(0, 1, 0, angle), 0, 0, 0);
    const wh_pose_t origin = wh_pose_identity();
    const wh_proximity_t wafer_tilted = measure(&tilted, &origin, &wide);
    assert_near(wafer_tilted.dr_proj_z, 20 * sin(angle), 100 * WH_TEST_ROUNDING);
    assert_near(wafer_tilted.dr_proj_xy.x, 20 * cos(angle), 100 * WH_TEST_ROUNDING);
    assert_near(measure(&level, &turned, &wide).dr_proj_z, 0, 0);
    assert_near(measure(&level, &turned, &wide).dr_proj_xy.x, 20, 0);
    /* A wafer upside down has n1_proj_n2 = -1: never ready. */
    const wh_pose_t flipped = wh_test_pose(wh_test_rotation(1, 0, 0, WH_TEST_PI), 0, 0, 0);
    assert_int_equal(measure(&flipped, &origin, &wide).failed, WH_FAILED_PLANAR);
}

/* The formulas once more, written out with the same operations. */
static bool literal(const wh_pose_t *w, const wh_pose_t *g, const wh_tolerance_t *t) {
    const wh_real_t dx = w->r.x - g->r.x;
    const wh_real_t dy = w->r.y - g->r.y;
    const wh_real_t dz = w->r.z - g->r.z;
    const wh_real_t x = w->R.m[0][0] * dx + w->R.m[1][0] * dy + w->R.m[2][0] * dz;
    const wh_real_t y = w->R.m[0][1] * dx + w->R.m[1][1] * dy + w->R.m[2][1] * dz;
    const wh_real_t z = w->R.m[0][2] * dx + w->R.m[1][2] * dy + w->R.m[2][2] * dz;
    const wh_real_t n =
        w->R.m[0][2] * g->R.m[0][2] + w->R.m[1][2] * g->R.m[1][2] + w->R.m[2][2] * g->R.m[2][2];
    return z < t->projz && z > -t->projz && wh_real_sqrt(x * x + y * y) < t->projxy && n > t->planar;
}

static bool is_close(const wh_proximity_t *p, const wh_tolerance_t *t) {
    const double grain = 8 * WH_TEST_ROUNDING;
    return fabs((double)p->margin_projz) < grain * (double)t->projz ||
           fabs((double)p->margin_projxy) < grain * (double)t->projxy ||
           fabs((double)p->margin_planar) < grain;
}

static void verdict_equals_measurement(void **state) {
    (void)state;
    (void)wh_test_seed();
    int ready = 0;
    int close = 0;
    for (int pair = 0; pair < PAIRS; ++pair) {
        const wh_tolerance_t t = wh_test_tolerance(pair);
        wh_pose_t wafer;
        wh_pose_t gripper;
        wh_test_pair(&t, &wafer, &gripper);
        wh_proximity_t p;
        const wh_status_t status = wh_proximity_measure(&wafer, &gripper, &t, &p);
        if (status != WH_OK || p.ready != wh_proximity_ready(&wafer, &gripper, &t) ||
            p.ready != literal(&wafer, &gripper, &t) || p.ready != (p.failed == 0)) {
            fail_msg("pair %d: status %d, ready %d, failed %u", pair, status, p.ready, p.failed);
        }
        ready += p.ready;
        close += is_close(&p, &t);
    }
    printf("%d of %d ready, %d within a few units in the last place of a limit\n", ready, PAIRS, close);
    assert_true(ready > PAIRS / 50 && close > PAIRS / 4);
}

static void nan_is_never_ready(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_pose_t pose = wh_pose_identity();
    assert_true(wh_proximity_ready(&pose, &pose, &paper));
    for (size_t entry = 0; entry < 27; ++entry) {
        wh_pose_t both[2] = {pose, pose};
        wh_tolerance_t t = paper;
        wh_pose_t *p = &both[entry / 12 % 2];
        const size_t i = entry % 12;
        wh_real_t *const position[] = {&p->r.x, &p->r.y, &p->r.z};
        wh_real_t *const limit[] = {&t.projz, &t.projxy, &t.planar};
        wh_real_t *spoilt = entry >= 24 ? limit[entry - 24] : i < 9 ? &p->R.m[i / 3][i % 3] : position[i - 9];
        *spoilt = WH_REAL(NAN);
        wh_proximity_t result;
        memset(&result, 0x5a, sizeof result);
        const wh_proximity_t before = result;
        assert_false(wh_proximity_ready(&both[0], &both[1], &t));
        assert_int_equal(wh_proximity_measure(&both[0], &both[1], &t, &result),
                         entry < 24 ? WH_STATUS_NOT_FINITE : WH_STATUS_BAD_TOLERANCE);
        assert_memory_equal(&result, &before, sizeof result);
    }
}

/* The gripper's turn about its own axis has no effect, whichever of its numbers are zero. */
static void quarter_turns_are_all_the_same(void **state) {
    (void)state;
    static const wh_real_t cosines[] = {1, 0, -1, 0};
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_pose_t wafer = wh_test_at(0, 0, 0);
    for (size_t k = 0; k < 4; ++k) {
        const wh_real_t c = cosines[k];
        const wh_real_t s = cosines[(k + 3) % 4];
        const wh_mat3_t R = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
        const wh_pose_t gripper = wh_test_pose(R, 1, 2, 0.25);
        assert_true(wh_proximity_ready(&wafer, &gripper, &tolerance));
    }
}

static void measure_refuses_what_it_cannot_judge(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_pose_t pose = wh_pose_identity();
    wh_pose_t mirrored = pose;
    mirrored.R.m[0][0] = -1;
    wh_proximity_t result;
    memset(&result, 0x5a, sizeof result);
    const wh_proximity_t before = result;
    assert_int_equal(wh_proximity_measure(NULL, &pose, &paper, &result), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_proximity_measure(&pose, NULL, &paper, &result), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_proximity_measure(&pose, &pose, NULL, &result), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_proximity_measure(&pose, &pose, &paper, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_proximity_measure(&mirrored, &pose, &paper, &result), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_proximity_measure(&pose, &mirrored, &paper, &result), WH_STATUS_NOT_A_ROTATION);
    assert_memory_equal(&result, &before, sizeof result);
}

/* Poses are finite, but a value or its square is no number any more. */
static void values_beyond_all_numbers_are_refused(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const double large = (double)WH_TEST_LARGEST;
    const double places[] = {1.7 / 1.8 * large, -1.7 / 1.8 * large, large, sqrt(large)};
    wh_proximity_t result;
    memset(&result, 0x5a, sizeof result);
    const wh_proximity_t before = result;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        const double p = places[i];
        const wh_pose_t wafers[] = {wh_test_at(p, 0, 0), wh_test_at(0, -p, 0), wh_test_at(p, p, -p)};
        for (size_t k = 0; k < 3; ++k) {
            const wh_pose_t gripper = wh_test_pose(wh_test_random_turn(3), -p, -p, p);
            assert_int_equal(wh_proximity_measure(&wafers[k], &gripper, &paper, &result),
                             WH_STATUS_NOT_FINITE);
            assert_memory_equal(&result, &before, sizeof result);
        }
    }
}

/* At the largest distance at which two bodies can be told apart, and with both at the ends of the
 * range of numbers. */
static void far_values_are_numbers(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const double far = 0.5 * sqrt((double)WH_TEST_LARGEST);
    for (int i = 0; i < 1000; ++i) {
        const wh_pose_t wafer = wh_test_random_pose(far / 4);
        const wh_pose_t gripper = wh_test_random_pose(far / 4);
        wh_proximity_t p;
        assert_int_equal(wh_proximity_measure(&wafer, &gripper, &paper, &p), WH_OK);
        assert_true(wh_vec3_is_finite(&p.dr) && wh_vec3_is_finite(&p.dr_proj_xy));
        assert_true(wh_real_is_finite(p.dr_proj_z) && wh_real_is_finite(p.dr_proj_xy_norm));
        assert_true(wh_real_is_finite(p.margin_projz) && wh_real_is_finite(p.margin_projxy));
        assert_int_equal(p.ready, wh_proximity_ready(&wafer, &gripper, &paper));
    }
    const wh_pose_t edge = wh_test_at((double)WH_TEST_LARGEST, -(double)WH_TEST_LARGEST, 0);
    wh_proximity_t p;
    assert_int_equal(wh_proximity_measure(&edge, &edge, &paper, &p), WH_OK);
    assert_true(p.ready);
}

static wh_status_t validated(double projz, double projxy, double planar) {
    const wh_tolerance_t t = {WH_REAL(projz), WH_REAL(projxy), WH_REAL(planar)};
    return wh_tolerance_validate(&t);
}

static void tolerances_have_ranges(void **state) {
    (void)state;
    const double projz[] = {0, -0.5, 1.1e6, (double)NAN, (double)INFINITY};
    const double projxy[] = {0, 0.9e-6, -50, 1.1e6, (double)NAN, (double)INFINITY};
    const double planar[] = {-0.01, 1, 1.5, (double)NAN, -(double)INFINITY};
    for (size_t i = 0; i < sizeof projz / sizeof projz[0]; ++i) {
        assert_int_equal(validated(projz[i], 50, 0.99), WH_STATUS_BAD_TOLERANCE);
    }
    for (size_t i = 0; i < sizeof projxy / sizeof projxy[0]; ++i) {
        assert_int_equal(validated(0.5, projxy[i], 0.99), WH_STATUS_BAD_TOLERANCE);
    }
    for (size_t i = 0; i < sizeof planar / sizeof planar[0]; ++i) {
        assert_int_equal(validated(0.5, 50, planar[i]), WH_STATUS_BAD_TOLERANCE);
    }
    assert_int_equal(validated(1e-30, 1e-6, 0), WH_OK);
    assert_int_equal(validated(1e6, 1e6, 0.9999999), WH_OK);
}

static void presets_are_the_papers_and_a_stricter_one(void **state) {
    (void)state;
    const wh_tolerance_t paper = wh_tolerance_paper();
    const wh_tolerance_t strict = wh_tolerance_strict();
    assert_true(paper.projz == WH_REAL(0.5) && paper.projxy == 50 && paper.planar == WH_REAL(0.99));
    assert_true(strict.projz == WH_REAL(0.5) && strict.projxy == 5 && strict.planar == WH_REAL(0.99998));
    assert_int_equal(wh_tolerance_validate(&paper), WH_OK);
    assert_int_equal(wh_tolerance_validate(&strict), WH_OK);
}

static void presets_have_names(void **state) {
    (void)state;
    const wh_tolerance_t want[WH_TOLERANCE_PRESETS] = {wh_tolerance_paper(), wh_tolerance_strict()};
    static const char *const names[WH_TOLERANCE_PRESETS] = {"paper", "strict"};
    wh_tolerance_t got;
    for (size_t i = 0; i < WH_TOLERANCE_PRESETS; ++i) {
        assert_string_equal(wh_tolerance_preset(i, &got), names[i]);
        assert_memory_equal(&got, &want[i], sizeof got);
    }
    assert_null(wh_tolerance_preset(WH_TOLERANCE_PRESETS, &got));
    assert_null(wh_tolerance_preset(SIZE_MAX, &got));
    assert_memory_equal(&got, &want[WH_TOLERANCE_PRESETS - 1], sizeof got);
}

/* Compared with the rim itself, in small steps around it. */
static void rim_gap_is_the_farthest_point_of_the_rim(void **state) {
    (void)state;
    for (int run = 0; run < 200 / WH_TEST_SHARE; ++run) {
        const wh_mat3_t tip = wh_test_random_turn(0.2);
        const wh_pose_t gripper = wh_test_random_pose(10);
        const wh_pose_t above = {tip, {1, -2, WH_REAL(wh_test_uniform(-0.5, 0.5))}};
        const wh_pose_t wafer = wh_pose_compose(&gripper, &above);
        double most = 0;
        for (int k = 0; k < 3600; ++k) {
            const double a = k * WH_TEST_PI / 1800;
            const double z =
                (double)above.r.z + 150 * (cos(a) * (double)tip.m[2][0] + sin(a) * (double)tip.m[2][1]);
            most = fmax(most, fabs(z));
        }
        assert_near(wh_proximity_rim_gap(&wafer, &gripper, 150), most, 1e-4 + 3000 * WH_TEST_ROUNDING);
    }
}

/* 0.99 is 8.1 degrees, and that leaves the rim of a 300 mm wafer 21 mm out of plane. */
static void papers_limit_leaves_21_mm_at_the_rim(void **state) {
    (void)state;
    const wh_pose_t gripper = wh_pose_identity();
    const wh_pose_t wafer = wh_test_pose(wh_test_rotation(1, 2, 0, acos(0.99)), 0, 0, 0);
    const wh_pose_t raised = wh_test_pose(wafer.R, 0, 0, 0.25);
    const double gap = 150 * sqrt(1 - 0.99 * 0.99);
    assert_near(acos(0.99) * 180 / WH_TEST_PI, 8.1, 0.05);
    assert_near(gap, 21, 0.2);
    assert_near(wh_proximity_rim_gap(&wafer, &gripper, 150), gap, 1e4 * WH_TEST_ROUNDING);
    assert_near(wh_proximity_rim_gap(&raised, &gripper, 150), gap + 0.25, 1e4 * WH_TEST_ROUNDING);
    const wh_pose_t strict = wh_test_pose(wh_test_rotation(1, 2, 0, acos(0.99998)), 0, 0, 0);
    assert_true(wh_proximity_rim_gap(&strict, &gripper, 150) < 1);
    const wh_pose_t hardly = wh_test_pose(wh_test_rotation(0, 1, 0, 1e-7), 0, 0, 0);
    assert_near(wh_proximity_rim_gap(&hardly, &gripper, 150), 1.5e-5, 1e-7);
}

#define THICK WH_REAL(0.775)

/* A wafer that lies face down, its front face `z` mm over a level gripper at base's origin. */
static wh_pose_t face_down(double x, double y, double z) {
    return wh_test_pose(wh_test_rotation(1, 0, 0, WH_TEST_PI), x, y, z + (double)THICK);
}

static void the_face_that_looks_at_the_gripper_is_asked(void **state) {
    (void)state;
    const wh_tolerance_t t = wh_tolerance_paper();
    const wh_pose_t gripper = wh_pose_identity();
    const wh_pose_t wafer = face_down(3, -4, 0.25);
    const wh_pose_t upright = wh_test_at(3, -4, 0.25);
    wh_face_t face = WH_FACE_BACK;
    wh_proximity_t p;
    wh_proximity_t plain;
    assert_false(wh_proximity_ready(&wafer, &gripper, &t));
    assert_int_equal(wh_face_measure(&wafer, THICK, &gripper, &t, &face, &p), WH_OK);
    assert_true(p.ready && face == WH_FACE_FRONT);
    assert_near(p.dr_proj_z, 0.25, 16 * WH_TEST_ROUNDING);
    assert_near(p.dr_proj_xy.x, 3, 16 * WH_TEST_ROUNDING);
    assert_near(p.dr_proj_xy.y, -4, 16 * WH_TEST_ROUNDING);
    assert_int_equal(wh_face_measure(&wafer, 0, &gripper, &t, &face, &p), WH_OK);
    assert_int_equal(p.failed, WH_FAILED_PROJZ);
    assert_int_equal(wh_face_measure(&upright, THICK, &gripper, &t, &face, &p), WH_OK);
    assert_int_equal(wh_proximity_measure(&upright, &gripper, &t, &plain), WH_OK);
    assert_int_equal(face, WH_FACE_BACK);
    assert_memory_equal(&p.dr, &plain.dr, offsetof(wh_proximity_t, ready));
}

/* Random pairs compared with the rule's text, in a frame that is built in another way: by a product
 * of poses. */
static void the_fronts_frame_is_a_product_of_poses(void **state) {
    (void)state;
    const wh_tolerance_t t = wh_tolerance_paper();
    const double close = 1e5 * WH_TEST_ROUNDING;
    const int pairs = 20000 / WH_TEST_SHARE;
    int fronts = 0;
    for (int pair = 0; pair < pairs; ++pair) {
        const wh_pose_t wafer = wh_test_random_pose(300);
        const wh_pose_t gripper = wh_test_random_pose(300);
        const wh_real_t thickness = WH_REAL(wh_test_uniform(0, 2));
        const wh_pose_t front = wh_test_pose(wh_test_rotation(1, 0, 0, WH_TEST_PI), 0, 0, thickness);
        const wh_pose_t looked_at = wh_pose_compose(&wafer, &front);
        wh_face_t face = WH_FACE_BACK;
        wh_proximity_t p;
        wh_proximity_t expected;
        assert_int_equal(wh_face_measure(&wafer, thickness, &gripper, &t, &face, &p), WH_OK);
        const bool is_front = wh_face_towards(&wafer, &gripper) == WH_FACE_FRONT;
        assert_int_equal(wh_proximity_measure(is_front ? &looked_at : &wafer, &gripper, &t, &expected),
                         WH_OK);
        fronts += is_front;
        assert_int_equal(face, is_front);
        assert_true(p.n1_proj_n2 >= 0);
        assert_near(p.n1_proj_n2, expected.n1_proj_n2, close);
        assert_near(p.dr_proj_z, expected.dr_proj_z, close);
        assert_near(p.dr_proj_xy.x, expected.dr_proj_xy.x, close);
        assert_near(p.dr_proj_xy.y, expected.dr_proj_xy.y, close);
    }
    assert_in_range(fronts, pairs * 2 / 5, pairs * 3 / 5);
}

/* At e3 . n2 = 0, and a little to either side. */
static void on_edge_a_wafer_shows_its_back(void **state) {
    (void)state;
    const wh_pose_t gripper = wh_pose_identity();
    wh_pose_t wafer = {{{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}}, {0, 0, 0}};
    assert_int_equal(wh_face_towards(&wafer, &gripper), WH_FACE_BACK);
    wafer.R.m[2][2] = WH_REAL(-1e-30);
    assert_int_equal(wh_face_towards(&wafer, &gripper), WH_FACE_FRONT);
    wafer.R.m[2][2] = WH_REAL(1e-30);
    assert_int_equal(wh_face_towards(&wafer, &gripper), WH_FACE_BACK);
}

/* If a layout has no faces, wafers have no thickness. */
static void without_a_thickness_a_wafer_shows_its_back(void **state) {
    (void)state;
    const wh_pose_t gripper = wh_pose_identity();
    const wh_pose_t over = face_down(0, 0, 0);
    const wh_pose_t upright = wh_test_at(0, 0, 0);
    assert_int_equal(wh_face_seen(&over, 0, &gripper), WH_FACE_BACK);
    assert_int_equal(wh_face_seen(&over, THICK, &gripper), WH_FACE_FRONT);
    assert_int_equal(wh_face_seen(&upright, THICK, &gripper), WH_FACE_BACK);
}

static void measuring_a_face_refuses_what_it_cannot_judge(void **state) {
    (void)state;
    const wh_tolerance_t t = wh_tolerance_paper();
    const wh_pose_t gripper = wh_pose_identity();
    const wh_pose_t wafer = face_down(0, 0, 0);
    wh_pose_t bad = wafer;
    wh_face_t face = (wh_face_t)7;
    wh_proximity_t p;
    wh_proximity_t before;
    memset(&p, 1, sizeof p);
    memcpy(&before, &p, sizeof p);
    bad.R.m[0][0] = 2;
    assert_int_equal(wh_face_measure(NULL, THICK, &gripper, &t, &face, &p), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_face_measure(&wafer, THICK, NULL, &t, &face, &p), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_face_measure(&wafer, THICK, &gripper, NULL, &face, &p), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_face_measure(&wafer, THICK, &gripper, &t, NULL, &p), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_face_measure(&wafer, THICK, &gripper, &t, &face, NULL), WH_STATUS_NULL_ARGUMENT);
    assert_int_equal(wh_face_measure(&bad, THICK, &gripper, &t, &face, &p), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_face_measure(&wafer, THICK, &bad, &t, &face, &p), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_face_measure(&wafer, (wh_real_t)NAN, &gripper, &t, &face, &p), WH_STATUS_NOT_FINITE);
    assert_int_equal(wh_face_measure(&wafer, -THICK, &gripper, &t, &face, &p), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(wh_face_measure(&wafer, WH_REAL(100.001), &gripper, &t, &face, &p),
                     WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(face, 7);
    assert_memory_equal(&p, &before, sizeof p);
    assert_int_equal(wh_face_measure(&wafer, 100, &gripper, &t, &face, &p), WH_OK);
}

/* (dx, dy) becomes (dx, -dy), and a notch at a becomes -a; twice changes nothing. */
static void turned_over_twice_a_wafer_is_where_it_was(void **state) {
    (void)state;
    for (int i = 0; i < 20000 / WH_TEST_SHARE; ++i) {
        const wh_pose_t axis = wh_test_random_pose(1000);
        wh_pose_t start = wh_test_random_pose(150);
        start.r = wh_vec3_add(&start.r, &axis.r);
        wh_pose_t wafer = start;
        wh_face_turn_over(&axis, &wafer);
        const wh_pose_t before = wh_pose_relative(&axis, &start);
        const wh_pose_t after = wh_pose_relative(&axis, &wafer);
        const double close = 1e4 * WH_TEST_ROUNDING;
        assert_near(after.r.x, before.r.x, close);
        assert_near(after.r.y, -before.r.y, close);
        assert_near(after.r.z, -before.r.z, close);
        assert_near(atan2((double)after.R.m[1][0], (double)after.R.m[0][0]),
                    -atan2((double)before.R.m[1][0], (double)before.R.m[0][0]), 1e6 * WH_TEST_ROUNDING);
        assert_int_equal(wh_pose_validate(&wafer), WH_OK);
        wh_face_turn_over(&axis, &wafer);
        assert_true(wh_test_difference_r(&wafer, &start) <=
                    (sizeof(wh_real_t) == sizeof(double) ? 1e-12 : 1e-3));
        assert_true(wh_test_difference_R(&wafer, &start) <= 16 * WH_TEST_ROUNDING);
    }
}

/* A wafer lies with its back on a plane below. Turned over about a level axis, it shows its front
 * to that plane. */
static void a_flip_changes_the_face_and_moves_the_contact_plane(void **state) {
    (void)state;
    const wh_pose_t slot = wh_pose_identity();
    const wh_pose_t axis = wh_test_at(0, 0, 50);
    wh_pose_t wafer = wh_test_at(1, 2, 0);
    wh_pose_t front;
    assert_int_equal(wh_face_towards(&wafer, &slot), WH_FACE_BACK);
    wh_face_turn_over(&axis, &wafer);
    assert_int_equal(wh_face_towards(&wafer, &slot), WH_FACE_FRONT);
    wh_face_frame(&wafer, THICK, WH_FACE_FRONT, &front);
    assert_near(front.r.x, 1, 1e3 * WH_TEST_ROUNDING);
    assert_near(front.r.y, -2, 1e3 * WH_TEST_ROUNDING);
    assert_near(front.r.z, 100 - 0.775, 1e3 * WH_TEST_ROUNDING);
    assert_near(front.R.m[2][2], 1, 8 * WH_TEST_ROUNDING);
    wh_pose_t again;
    wh_face_frame(&front, THICK, WH_FACE_FRONT, &again);
    assert_true(wh_test_difference_r(&again, &wafer) <= 1e3 * WH_TEST_ROUNDING);
    assert_near(wh_face_swept_radius(150, THICK, 12), sqrt(150.0 * 150 + 12.3875 * 12.3875),
                1e3 * WH_TEST_ROUNDING);
    assert_near(wh_face_swept_radius(150, THICK, -12), wh_face_swept_radius(150, THICK, 12), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_limit_itself_fails),
        cmocka_unit_test(xy_is_a_circle_not_a_square),
        cmocka_unit_test(reasons_add_up),
        cmocka_unit_test(projections_are_onto_the_wafer),
        cmocka_unit_test(verdict_equals_measurement),
        cmocka_unit_test(nan_is_never_ready),
        cmocka_unit_test(quarter_turns_are_all_the_same),
        cmocka_unit_test(measure_refuses_what_it_cannot_judge),
        cmocka_unit_test(values_beyond_all_numbers_are_refused),
        cmocka_unit_test(far_values_are_numbers),
        cmocka_unit_test(tolerances_have_ranges),
        cmocka_unit_test(presets_are_the_papers_and_a_stricter_one),
        cmocka_unit_test(presets_have_names),
        cmocka_unit_test(rim_gap_is_the_farthest_point_of_the_rim),
        cmocka_unit_test(papers_limit_leaves_21_mm_at_the_rim),
        cmocka_unit_test(the_face_that_looks_at_the_gripper_is_asked),
        cmocka_unit_test(the_fronts_frame_is_a_product_of_poses),
        cmocka_unit_test(on_edge_a_wafer_shows_its_back),
        cmocka_unit_test(without_a_thickness_a_wafer_shows_its_back),
        cmocka_unit_test(measuring_a_face_refuses_what_it_cannot_judge),
        cmocka_unit_test(turned_over_twice_a_wafer_is_where_it_was),
        cmocka_unit_test(a_flip_changes_the_face_and_moves_the_contact_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
