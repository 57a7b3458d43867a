/* Poses: products compared with long double, the limits of a rotation, and the mending of a worn one. */
#include "support/support.h"

#include "math/pose.h"
#include "math/relation.h"
#include "math/rotation.h"
#include "support/pose.h"

#define RUNS 20000

/* An oracle in long double: the largest entry of |R^T R - I|. */
static long double off_orthonormal(const wh_mat3_t *R) {
    long double most = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            long double sum = i == j ? -1 : 0;
            for (int k = 0; k < 3; ++k) {
                sum += (long double)R->m[k][i] * (long double)R->m[k][j];
            }
            most = fmaxl(most, fabsl(sum));
        }
    }
    return most;
}

static wh_pose_t with_R(wh_mat3_t R) {
    return wh_test_pose(R, 1, 2, 3);
}

static void accepts(wh_mat3_t R) {
    const wh_pose_t pose = with_R(R);
    assert_int_equal(wh_pose_validate(&pose), WH_OK);
}

static void refuses(wh_mat3_t R) {
    const wh_pose_t pose = with_R(R);
    assert_int_equal(wh_pose_validate(&pose), WH_STATUS_NOT_A_ROTATION);
}

static void compose_is_the_matrix_product(void **state) {
    (void)state;
    for (int run = 0; run < RUNS; ++run) {
        const wh_pose_t a = wh_test_random_pose(1000);
        const wh_pose_t b = wh_test_random_pose(1000);
        const wh_pose_t c = wh_pose_compose(&a, &b);
        const wh_real_t ar[3] = {a.r.x, a.r.y, a.r.z};
        const wh_real_t br[3] = {b.r.x, b.r.y, b.r.z};
        const wh_real_t cr[3] = {c.r.x, c.r.y, c.r.z};
        for (int i = 0; i < 3; ++i) {
            long double r = (long double)ar[i];
            for (int j = 0; j < 3; ++j) {
                long double sum = 0;
                for (int k = 0; k < 3; ++k) {
                    sum += (long double)a.R.m[i][k] * (long double)b.R.m[k][j];
                }
                assert_near(c.R.m[i][j], sum, 6 * WH_TEST_ROUNDING);
                r += (long double)a.R.m[i][j] * (long double)br[j];
            }
            assert_near(cr[i], r, 6 * 3000 * WH_TEST_ROUNDING);
        }
    }
}

static void relative_undoes_compose(void **state) {
    (void)state;
    for (int run = 0; run < RUNS; ++run) {
        const wh_pose_t base_from_g = wh_test_random_pose(1000);
        const wh_pose_t g_from_w = wh_test_random_pose(50);
        const wh_pose_t base_from_w = wh_pose_compose(&base_from_g, &g_from_w);
        const wh_pose_t again = wh_pose_relative(&base_from_g, &base_from_w);
        assert_near(wh_test_difference_R(&again, &g_from_w), 0, 16 * WH_TEST_ROUNDING);
        assert_near(wh_test_difference_r(&again, &g_from_w), 0, 8 * 1100 * WH_TEST_ROUNDING);
        const wh_pose_t there = wh_pose_compose(&base_from_g, &again);
        assert_near(wh_test_difference_r(&there, &base_from_w), 0, 8 * 1100 * WH_TEST_ROUNDING);
    }
}

static void identity_changes_no_bit(void **state) {
    (void)state;
    const wh_pose_t one = wh_pose_identity();
    for (int run = 0; run < 100; ++run) {
        const wh_pose_t a = wh_test_random_pose(1000);
        const wh_pose_t left = wh_pose_compose(&one, &a);
        const wh_pose_t right = wh_pose_compose(&a, &one);
        const wh_pose_t from_base = wh_pose_relative(&one, &a);
        assert_true(wh_test_difference_R(&left, &a) == 0 && wh_test_difference_r(&left, &a) == 0);
        assert_true(wh_test_difference_R(&right, &a) == 0 && wh_test_difference_r(&right, &a) == 0);
        assert_true(wh_test_difference_R(&from_base, &a) == 0 && wh_test_difference_r(&from_base, &a) == 0);
        assert_int_equal(wh_pose_validate(&a), WH_OK);
    }
}

static void numbers_that_are_none_are_refused(void **state) {
    (void)state;
    const wh_real_t bad[] = {WH_REAL(NAN), WH_REAL(INFINITY), WH_REAL(-INFINITY)};
    for (size_t b = 0; b < 3; ++b) {
        for (size_t entry = 0; entry < 12; ++entry) {
            wh_pose_t pose = wh_test_random_pose(1000);
            if (entry < 9) {
                pose.R.m[entry / 3][entry % 3] = bad[b];
            } else {
                *(entry == 9 ? &pose.r.x : entry == 10 ? &pose.r.y : &pose.r.z) = bad[b];
            }
            assert_int_equal(wh_pose_validate(&pose), WH_STATUS_NOT_FINITE);
        }
    }
}

static void huge_positions_are_poses(void **state) {
    (void)state;
    wh_pose_t pose = wh_test_random_pose(1);
#if defined(WH_FLOAT)
    const wh_real_t largest = FLT_MAX;
#else
    const wh_real_t largest = DBL_MAX;
#endif
    pose.r = wh_vec3(largest, -largest, largest);
    assert_int_equal(wh_pose_validate(&pose), WH_OK);
    pose.R.m[1][1] = largest;
    assert_int_equal(wh_pose_validate(&pose), WH_STATUS_NOT_A_ROTATION);
}

static void mirrored_matrices_are_refused(void **state) {
    (void)state;
    for (int run = 0; run < 100; ++run) {
        wh_mat3_t R = wh_test_random_turn(WH_TEST_PI);
        const int column = run % 3;
        for (int i = 0; i < 3; ++i) {
            R.m[i][column] = -R.m[i][column];
        }
        refuses(R);
        for (int i = 0; i < 3; ++i) {
            const wh_real_t swapped = R.m[i][0];
            R.m[i][0] = R.m[i][2];
            R.m[i][2] = swapped;
        }
        accepts(R);
    }
    const wh_mat3_t zero = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    refuses(zero);
}

static void shear_is_limited_exactly(void **state) {
    (void)state;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            for (int sign = -1; sign <= 1 && i != j; sign += 2) {
                wh_mat3_t R = wh_mat3_identity();
                R.m[i][j] = WH_REAL(sign) * WH_ROTATION_TOLERANCE;
                accepts(R);
                R.m[i][j] = wh_test_ulps(R.m[i][j], 1);
                refuses(R);
            }
        }
    }
}

static void scale_is_limited(void **state) {
    (void)state;
    for (int i = 0; i < 3; ++i) {
        for (int sign = -1; sign <= 1; sign += 2) {
            wh_mat3_t R = wh_mat3_identity();
            R.m[i][i] = WH_REAL(sqrt(1 + sign * 0.98 * (double)WH_ROTATION_TOLERANCE));
            accepts(R);
            R.m[i][i] = WH_REAL(sqrt(1 + sign * 1.02 * (double)WH_ROTATION_TOLERANCE));
            refuses(R);
        }
    }
}

/* Rotations with an error in every entry: the verdict is that of the definition, in long double. */
static void random_errors_are_judged_by_the_definition(void **state) {
    (void)state;
    const double limit = (double)WH_ROTATION_TOLERANCE;
    int good = 0;
    int bad = 0;
    for (int run = 0; run < RUNS; ++run) {
        wh_mat3_t R = wh_test_random_turn(WH_TEST_PI);
        for (int k = 0; k < 9; ++k) {
            R.m[k / 3][k % 3] += WH_REAL(wh_test_uniform(-0.5 * limit, 0.5 * limit));
        }
        const double off = (double)off_orthonormal(&R);
        if (fabs(off - limit) > 16 * WH_TEST_ROUNDING) {
            (off < limit ? accepts : refuses)(R);
            ++*(off < limit ? &good : &bad);
        }
    }
    assert_true(good > RUNS / 10 && bad > RUNS / 10);
}

static void orthonormalise_squares_the_error(void **state) {
    (void)state;
    const double limit = (double)WH_ROTATION_TOLERANCE;
    for (int run = 0; run < RUNS; ++run) {
        const wh_mat3_t exact = wh_test_random_turn(WH_TEST_PI);
        wh_mat3_t worn = exact;
        for (int k = 0; k < 9; ++k) {
            worn.m[k / 3][k % 3] += WH_REAL(wh_test_uniform(-0.3 * limit, 0.3 * limit));
        }
        const wh_pose_t before = with_R(worn);
        wh_pose_t mended = before;
        wh_mat3_orthonormalise(&mended.R);
        assert_near(off_orthonormal(&mended.R), 0, 9 * limit * limit + 16 * WH_TEST_ROUNDING);
        assert_near(wh_test_difference_R(&mended, &before), 0, 1.5 * limit);
    }
}

/* ------------------------------------------------------------------------------------------- the way in */

/* A matrix with each entry rounded to a multiple of 1/32768 that fits 16 bits, as Q15 stores it. */
static wh_mat3_t in_q15(const wh_mat3_t *R) {
    wh_mat3_t rounded;
    for (int k = 0; k < 9; ++k) {
        const long q15 = lround((double)R->m[k / 3][k % 3] * 32768);
        rounded.m[k / 3][k % 3] = WH_REAL(q15 > 32767 ? 32767 : q15) / 32768;
    }
    return rounded;
}

/* The angle of the turn from one rotation to another, rad, if it is small. */
static double turn_between(const wh_mat3_t *a, const wh_mat3_t *b) {
    double sum = 0;
    for (int k = 0; k < 9; ++k) {
        const double difference = (double)a->m[k / 3][k % 3] - (double)b->m[k / 3][k % 3];
        sum += difference * difference;
    }
    return sqrt(sum / 2);
}

/* The nearest rotation differs from the matrix by a symmetric factor: R^T A = (R^T A)^T. */
static double asymmetry(const wh_mat3_t *R, const wh_mat3_t *A) {
    const wh_mat3_t factor = wh_mat3_multiply_back(R, A);
    return fmax(fabs((double)(factor.m[0][1] - factor.m[1][0])),
                fmax(fabs((double)(factor.m[0][2] - factor.m[2][0])),
                     fabs((double)(factor.m[1][2] - factor.m[2][1]))));
}

static void fixed_point_rotations_are_refused_as_they_are_and_good_once_mended(void **state) {
    (void)state;
    int refused = 0;
    for (int run = 0; run < RUNS; ++run) {
        const wh_mat3_t exact = wh_test_random_turn(WH_TEST_PI);
        const wh_mat3_t q15 = in_q15(&exact);
        wh_pose_t pose = with_R(q15);
        refused += wh_pose_validate(&pose) == WH_STATUS_NOT_A_ROTATION ? 1 : 0;
        assert_int_equal(wh_rotation_mend(&pose.R), WH_OK);
        assert_int_equal(wh_pose_validate(&pose), WH_OK);
        assert_true(turn_between(&pose.R, &exact) < 2.2 / 32768 + 16 * WH_TEST_ROUNDING);
    }
    assert_true(refused > RUNS * 9 / 10);
}

/* Up to the limit it is mended to the nearest rotation; beyond it is refused, and not a bit is changed. */
static void mending_ends_where_its_header_says(void **state) {
    (void)state;
    int mended = 0;
    int refused = 0;
    for (int run = 0; run < RUNS; ++run) {
        wh_mat3_t worn = wh_test_random_turn(WH_TEST_PI);
        const double error = wh_test_decades(1e-6, 0.2);
        for (int k = 0; k < 9; ++k) {
            worn.m[k / 3][k % 3] += WH_REAL(wh_test_uniform(-error, error));
        }
        wh_mat3_t R = worn;
        const double off = (double)(off_orthonormal(&worn) - (long double)WH_ROTATION_MENDABLE);
        const wh_status_t status = wh_rotation_mend(&R);
        if (off < -1e-6) {
            assert_int_equal(status, WH_OK);
            assert_near(off_orthonormal(&R), 0, sizeof(wh_real_t) == sizeof(double) ? 1e-14 : 5e-6);
            assert_near(asymmetry(&R, &worn), 0, 32 * WH_TEST_ROUNDING);
            ++mended;
        } else if (off > 1e-6) {
            assert_int_equal(status, WH_STATUS_NOT_A_ROTATION);
            assert_memory_equal(&R, &worn, sizeof R);
            ++refused;
        }
    }
    assert_true(mended > RUNS / 10 && refused > RUNS / 10);
}

static void mirrors_and_numbers_that_are_none_are_not_mended(void **state) {
    (void)state;
    wh_mat3_t R = wh_mat3_identity();
    R.m[2][2] = -1;
    assert_int_equal(wh_rotation_mend(&R), WH_STATUS_NOT_A_ROTATION);
    for (int k = 0; k < 9; ++k) {
        R = wh_mat3_identity();
        R.m[k / 3][k % 3] = WH_REAL(k % 2 == 0 ? NAN : INFINITY);
        assert_int_equal(wh_rotation_mend(&R), WH_STATUS_NOT_FINITE);
    }
    assert_int_equal(wh_rotation_mend(NULL), WH_STATUS_NULL_ARGUMENT);
}

/* Compared with Rodrigues' formula, which shares nothing with it; any length within the limit, and
 * either sign. */
static void quaternions_are_turns_about_their_axes(void **state) {
    (void)state;
    for (int run = 0; run < RUNS; ++run) {
        const double a[3] = {wh_test_uniform(-1, 1), wh_test_uniform(-1, 1), wh_test_uniform(0.1, 1)};
        const double angle = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
        const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        const double size = (run % 2 == 0 ? 1 : -1) * wh_test_uniform(0.976, 1.024);
        const double s = size * sin(angle / 2) / length;
        const wh_mat3_t wanted = wh_test_rotation(a[0], a[1], a[2], angle);
        wh_pose_t pose = wh_pose_identity();
        assert_int_equal(wh_rotation_from_quaternion(&pose.R, WH_REAL(size * cos(angle / 2)),
                                                     WH_REAL(s * a[0]), WH_REAL(s * a[1]), WH_REAL(s * a[2])),
                         WH_OK);
        assert_near(turn_between(&pose.R, &wanted), 0, 16 * WH_TEST_ROUNDING);
        assert_int_equal(wh_pose_validate(&pose), WH_OK);
    }
}

static void quaternions_that_are_none_change_nothing(void **state) {
    (void)state;
    const wh_mat3_t before = wh_test_random_turn(1);
    wh_mat3_t R = before;
    const wh_real_t bad[] = {WH_REAL(NAN), WH_REAL(INFINITY)};
    for (size_t b = 0; b < 2; ++b) {
        assert_int_equal(wh_rotation_from_quaternion(&R, bad[b], 0, 0, 0), WH_STATUS_NOT_FINITE);
        assert_int_equal(wh_rotation_from_quaternion(&R, 1, 0, bad[b], 0), WH_STATUS_NOT_FINITE);
    }
    assert_int_equal(wh_rotation_from_quaternion(&R, 0, 0, 0, 0), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_rotation_from_quaternion(&R, WH_REAL(1.03), 0, 0, 0), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_rotation_from_quaternion(&R, 0, WH_REAL(0.97), 0, 0), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_rotation_from_quaternion(&R, WH_TEST_LARGEST, 0, 0, 0), WH_STATUS_NOT_A_ROTATION);
    assert_int_equal(wh_rotation_from_quaternion(NULL, 1, 0, 0, 0), WH_STATUS_NULL_ARGUMENT);
    assert_memory_equal(&R, &before, sizeof R);
}

/* ------------------------------------------------------------------------------------------------ relations */

/* The pose of one frame in another, compared with closed forms and with rules that hold for any two. */

/* Tolerances are written for double. */
#define NUMBERS (WH_TEST_ROUNDING * 9007199254740992.0)

static wh_pose_t turned(double x, double y, double z, double angle) {
    return wh_test_pose(wh_test_rotation(1, 0, 0, angle), x, y, z);
}

static wh_pose_t rolled(double x, double y, double z, double angle) {
    return wh_test_pose(wh_test_rotation(0, 0, 1, angle), x, y, z);
}

static void axes_are_the_first_frame_s(void **state) {
    (void)state;
    const wh_pose_t first = rolled(100, 200, 300, WH_TEST_PI / 2);
    const wh_pose_t second = rolled(103, 204, 312, WH_TEST_PI / 2);
    const wh_relation_t relation = wh_relate(&first, &second);
    assert_near(relation.distance, 13, 1e-13 * NUMBERS);
    assert_near(relation.r.x, 4, 1e-13 * NUMBERS);
    assert_near(relation.r.y, -3, 1e-13 * NUMBERS);
    assert_near(relation.r.z, 12, 1e-13 * NUMBERS);
    assert_near(relation.angle, 0, 0);
    assert_near(relation.turn, 0, 1e-16 * NUMBERS);
}

/* About z the z axes stay parallel; about x they part by the whole turn. */
static void angles_small_and_large(void **state) {
    (void)state;
    static const double angles[] = {0, 1e-12, 1e-8, 1e-3, 0.5, 1.5, 3, WH_TEST_PI - 1e-8, WH_TEST_PI};
    const wh_pose_t base = wh_pose_identity();
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; ++i) {
        const wh_pose_t about_x = turned(0, 0, 0, -angles[i]);
        const wh_pose_t about_z = rolled(0, 0, 0, angles[i]);
        assert_near(wh_relate(&base, &about_x).angle, angles[i], 4e-16 * NUMBERS);
        assert_near(wh_relate(&base, &about_x).turn, angles[i], 4e-16 * NUMBERS);
        assert_near(wh_relate(&base, &about_z).angle, 0, 0);
        assert_near(wh_relate(&base, &about_z).turn, angles[i], 4e-16 * NUMBERS);
    }
}

/* A tilt after a turn: cos t/2 is the product of the two halves' cosines. */
static void a_whole_turn_is_more_than_the_tilt(void **state) {
    (void)state;
    const wh_pose_t tilt = turned(0, 0, 0, 0.3);
    const wh_pose_t turn = rolled(0, 0, 0, 1.1);
    const wh_pose_t both = wh_pose_compose(&turn, &tilt);
    const wh_pose_t base = wh_pose_identity();
    const wh_relation_t relation = wh_relate(&base, &both);
    assert_near(relation.angle, 0.3, 1e-15 * NUMBERS);
    assert_near(cos(relation.turn / 2), cos(0.15) * cos(0.55), 1e-15 * NUMBERS);
}

/* In both directions distance and angle are equal, and both ways lead back. */
static void both_ways(void **state) {
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        const wh_pose_t a = wh_test_random_pose(1000);
        const wh_pose_t b = wh_test_random_pose(1000);
        const wh_relation_t there = wh_relate(&a, &b);
        const wh_relation_t back = wh_relate(&b, &a);
        const wh_vec3_t way = wh_mat3_transform(&a.R, &there.r);
        assert_near(there.distance, back.distance, 0);
        assert_near(there.distance, wh_vec3_norm(&there.r), 1e-11 * NUMBERS);
        assert_near(there.angle, back.angle, 1e-14 * NUMBERS);
        assert_near(there.turn, back.turn, 1e-14 * NUMBERS);
        assert_true(there.turn >= there.angle - 1e-14 * NUMBERS);
        assert_near(a.r.x + way.x, b.r.x, 1e-11 * NUMBERS);
        assert_near(a.r.y + way.y, b.r.y, 1e-11 * NUMBERS);
        assert_near(a.r.z + way.z, b.r.z, 1e-11 * NUMBERS);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compose_is_the_matrix_product),
        cmocka_unit_test(relative_undoes_compose),
        cmocka_unit_test(identity_changes_no_bit),
        cmocka_unit_test(numbers_that_are_none_are_refused),
        cmocka_unit_test(huge_positions_are_poses),
        cmocka_unit_test(mirrored_matrices_are_refused),
        cmocka_unit_test(shear_is_limited_exactly),
        cmocka_unit_test(scale_is_limited),
        cmocka_unit_test(random_errors_are_judged_by_the_definition),
        cmocka_unit_test(orthonormalise_squares_the_error),
        cmocka_unit_test(fixed_point_rotations_are_refused_as_they_are_and_good_once_mended),
        cmocka_unit_test(mending_ends_where_its_header_says),
        cmocka_unit_test(mirrors_and_numbers_that_are_none_are_not_mended),
        cmocka_unit_test(quaternions_are_turns_about_their_axes),
        cmocka_unit_test(quaternions_that_are_none_change_nothing),
        cmocka_unit_test(axes_are_the_first_frame_s),
        cmocka_unit_test(angles_small_and_large),
        cmocka_unit_test(a_whole_turn_is_more_than_the_tilt),
        cmocka_unit_test(both_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
