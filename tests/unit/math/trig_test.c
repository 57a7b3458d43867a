/* Oracle: the C library in long double (in double for the float build). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "math/trig.h"
#include "support/support.h"

#define SAMPLES 100000
#define PI 3.14159265358979323846264338327950288L

#if defined(WH_FLOAT)
typedef uint32_t bits_t;
#define DIGITS 24
#define SMALLEST (-149)
#define HASH UINT64_C(0x3fbbdc04a7c2a93f)
#define EIGHTHS_HASH UINT64_C(0x71fe958f08c04564)
#else
typedef uint64_t bits_t;
#define DIGITS 53
#define SMALLEST (-1074)
#define HASH UINT64_C(0x87de8f2510d7902a)
#define EIGHTHS_HASH UINT64_C(0x6bb34f7a3fc583a5)
#endif

/* If long double is no longer than the number under test, the oracle's own error is added. */
#define ORACLE_ULP (LDBL_MANT_DIG > DIGITS ? 0.001 : 1.0)

static double ulps_off(wh_real_t got, long double want) {
    int exponent;
    (void)frexp((double)(want < 0 ? -want : want), &exponent);
    const int last = exponent - DIGITS > SMALLEST ? exponent - DIGITS : SMALLEST;
    const long double off = (long double)got - want;
    return (double)(off < 0 ? -off : off) / ldexp(1, last);
}

#define assert_ulps(got, want, limit) assert_near(ulps_off(got, want), 0, (limit) + ORACLE_ULP)

static bits_t bits_of(wh_real_t x) {
    bits_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void assert_same_bits(wh_real_t a, wh_real_t b) {
    assert_near(a, b, 0);
    assert_true(bits_of(a) == bits_of(b));
}

static wh_real_t random_real(double lo, double hi) {
    return (wh_real_t)wh_test_uniform(lo, hi);
}

static void sin_and_cos_are_near_the_oracle(void **state) {
    (void)state;
    static const double spans[] = {1e-3, 0.8, 4, 100, 1e5};
    for (int i = 0; i < SAMPLES; ++i) {
        const double span = spans[i % 5];
        const wh_real_t x = random_real(-span, span);
        wh_real_t s;
        wh_real_t c;
        wh_sin_cos(x, &s, &c);
        assert_ulps(s, sinl((long double)x), 0.85);
        assert_ulps(c, cosl((long double)x), 0.85);
        assert_same_bits(s, wh_sin(x));
        assert_same_bits(c, wh_cos(x));
    }
}

/* Next to n pi/2 nearly all digits of x cancel: the reduction's hardest arguments. */
static void reduction_holds_next_to_every_quarter_turn(void **state) {
    (void)state;
    for (int n = 1; n<63662; n += WH_TEST_SHARE> 1 ? 21 : 1) {
        const long double turn = (long double)n * (PI / 2);
        const wh_real_t x = (wh_real_t)turn;
        const long double rest = sinl((long double)x - turn);
        /* The oracle knows n pi/2 only to its own last digit. */
        const double blur = (double)(turn * LDBL_EPSILON) + fabs((double)rest) * 1e-6;
        const wh_real_t small = n % 2 == 0 ? wh_sin(x) : wh_cos(x);
        assert_near(small, n % 4 < 1 || n % 4 > 2 ? rest : -rest, blur);
    }
}

static void out_of_range_is_nan(void **state) {
    (void)state;
    static const double bad[] = {100001, -100001, 1e30, (double)INFINITY, -(double)INFINITY, (double)NAN};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        wh_real_t s = 0;
        wh_real_t c = 0;
        wh_sin_cos((wh_real_t)bad[i], &s, &c);
        assert_true(s != s && c != c);
        assert_true(wh_sin((wh_real_t)bad[i]) != wh_sin((wh_real_t)bad[i]));
        assert_true(wh_cos((wh_real_t)bad[i]) != wh_cos((wh_real_t)bad[i]));
        wh_sin_cos_deg((wh_real_t)(bad[i] * 100), &s, &c);
        assert_true(s != s && c != c);
    }
    assert_near(wh_sin(WH_TRIG_MAX_RAD), sin(1e5), 1e-6);
    assert_near(wh_sin(-WH_TRIG_MAX_RAD), -sin(1e5), 1e-6);
    assert_near(wh_cos(WH_TRIG_MAX_RAD), cos(1e5), 1e-6);
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(-WH_TRIG_MAX_RAD, &s, &c);
    assert_near(c, cos(1e5), 1e-6);
    wh_sin_cos_deg(WH_TRIG_MAX_DEG, &s, &c); /* 5e6 = 13888 * 360 + 320 */
    assert_near(c, cos(40 * (double)(PI / 180)), 1e-6);
}

static void symmetries_are_exact(void **state) {
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        const wh_real_t x = random_real(0, 1000);
        assert_same_bits(wh_sin(-x), -wh_sin(x));
        assert_same_bits(wh_cos(-x), wh_cos(x));
    }
    assert_same_bits(wh_sin(WH_REAL(-0.0)), WH_REAL(-0.0));
    assert_same_bits(wh_sin(WH_REAL(0)), WH_REAL(0));
    assert_same_bits(wh_cos(WH_REAL(-0.0)), WH_REAL(1));
}

static void whole_quarters_in_degrees_are_exact(void **state) {
    (void)state;
    static const wh_real_t cycle[] = {0, 1, 0, -1};
    for (int n = -1000; n <= 1000; ++n) {
        wh_real_t s;
        wh_real_t c;
        wh_sin_cos_deg((wh_real_t)(90 * n), &s, &c);
        assert_same_bits(s, cycle[(n + 1000) % 4]);
        assert_same_bits(c, cycle[(n + 1001) % 4]);
    }
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos_deg(30, &s, &c);
    assert_near(s, 0.5, 0);
    wh_sin_cos_deg(-60, &s, &c);
    assert_near(c, 0.5, 0);
}

static void degrees_are_near_the_oracle(void **state) {
    (void)state;
    /* If long double is double, the oracle's own roundings count: of the factor, the angle and the sine. */
    const double own = sizeof(wh_real_t) < sizeof(double) || LDBL_MANT_DIG > DBL_MANT_DIG ? 0 : 2;
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_real_t deg = i % 2 == 0 ? random_real(-400, 400) : random_real(-5e6, 5e6);
        const double quarters = floor((double)deg / 90 + 0.5);
        const long double rest = ((long double)deg - 90 * (long double)quarters) * (PI / 180);
        const int quarter = (int)(quarters - 4 * floor(quarters / 4));
        const long double cycle[] = {sinl(rest), cosl(rest), -sinl(rest), -cosl(rest)};
        wh_real_t s;
        wh_real_t c;
        wh_sin_cos_deg(deg, &s, &c);
        assert_ulps(s, cycle[quarter], own + 0.85);
        assert_ulps(c, cycle[(quarter + 1) % 4], own + 0.85);
        assert_ulps(wh_rad_from_deg(deg), (long double)deg * (PI / 180), own + 0.51);
        assert_ulps(wh_deg_from_rad(deg), (long double)deg * (180 / PI), own + 0.51);
    }
    assert_same_bits(wh_rad_from_deg(180), WH_PI);
    assert_same_bits(wh_rad_from_deg(-90), -WH_PI / 2);
    assert_same_bits(wh_deg_from_rad(WH_PI), 180);
}

static void a_turn_more_gives_the_same_bits(void **state) {
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        const wh_real_t deg = (wh_real_t)(int)wh_test_uniform(-720, 720) / 4;
        wh_real_t s[2];
        wh_real_t c[2];
        wh_sin_cos_deg(deg, &s[0], &c[0]);
        wh_sin_cos_deg(deg + (wh_real_t)(360 * (i % 100)), &s[1], &c[1]);
        assert_same_bits(s[0], s[1]);
        assert_same_bits(c[0], c[1]);
    }
}

static void atan2_is_near_the_oracle(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLES; ++i) {
        const double span = wh_test_decades(1e-12, 1e12);
        const wh_real_t y = random_real(-span, span);
        const wh_real_t x = i % 3 == 0 ? y * random_real(-2, 2) : random_real(-1, 1);
        assert_ulps(wh_atan2(y, x), atan2l((long double)y, (long double)x), 0.6);
    }
}

static void atan2_takes_every_magnitude(void **state) {
    (void)state;
    static const wh_real_t sizes[] = {SMALLEST == -149 ? WH_REAL(1e-45) : WH_REAL(5e-324),
                                      WH_REAL(1e-37),
                                      WH_REAL(1e-20),
                                      1,
                                      WH_REAL(1e20),
                                      WH_REAL(3e38)};
    for (size_t i = 0; i < 6; ++i) {
        for (size_t k = 0; k < 6; ++k) {
            for (int sign = 0; sign < 4; ++sign) {
                const wh_real_t y = sign % 2 == 0 ? sizes[i] : -sizes[i];
                const wh_real_t x = sign < 2 ? sizes[k] : -sizes[k];
                assert_ulps(wh_atan2(y, x), atan2l((long double)y, (long double)x), 0.6);
            }
        }
    }
}

/* Squares and products of the arguments are no numbers any more here, or have lost digits. */
static void atan2_is_near_the_oracle_far_out(void **state) {
    (void)state;
    const double most = DIGITS == 24 ? 1e38 : 1e308;
    const double least = DIGITS == 24 ? 1e-44 : 1e-318;
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_real_t x = (wh_real_t)wh_test_decades(least, most);
        const wh_real_t y = i % 2 == 0 ? (wh_real_t)wh_test_decades(least, most) : x * random_real(0, 1);
        assert_ulps(wh_atan2(y, -x), atan2l((long double)y, -(long double)x), 0.6);
        assert_ulps(wh_atan2(-x, y), atan2l(-(long double)x, (long double)y), 0.6);
    }
}

#if !defined(WH_FLOAT)
/* Angles so close to the middle between two numbers that the last digits of the constants decide
 * which is nearer: about the centres 1/4 to 1, and beside the axes. The right one of the two was
 * found with 120 digits. */
static void atan2_rounds_the_right_way_at_its_hardest(void **state) {
    (void)state;
    static const struct {
        double y, x, angle;
    } rows[] = {
        {0x1.71fabcd27282cp-2, 0x1.86f5dc893bde4p+0, 0x1.dbc68747e64bap-3},
        {0x1.cfd380730acc6p-2, 0x1.e9fa9ab93147cp+0, 0x1.dbea837f7e7c5p-3},
        {0x1.f6e7c225ac9ap-1, 0x1.f6e7c225ac9d1p+0, 0x1.dac670561bb28p-2},
        {0x1.9b1914041034fp-1, 0x1.9b19140410368p+0, 0x1.dac670561bb37p-2},
        {0x1.fc7346a6f0c99p+0, 0x1.fc7346a6f0ce8p+0, 0x1.921fb54442cf1p-1},
        {0x1.cf65d236eee51p+0, 0x1.cf65d236eee99p+0, 0x1.921fb54442cf1p-1},
        {1, 0x1.8d313198a224cp-53, 0x1.921fb54442d18p+0},
        {1, 0x1.8d313198a2e01p-53, 0x1.921fb54442d18p+0},
        {1, -0x1.cb3b399d747e3p-55, 0x1.921fb54442d18p+0},
        {0x1.8d313198a224cp-52, -1, 0x1.921fb54442d18p+1},
        {0x1.8d313198a2e01p-52, -1, 0x1.921fb54442d18p+1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        assert_same_bits(wh_atan2(rows[i].y, rows[i].x), rows[i].angle);
        assert_same_bits(wh_atan2(-rows[i].y, rows[i].x), -rows[i].angle);
    }
}
#endif

/* C99, F.9.1.4: the C library returns exactly these. */
static void atan2_has_the_special_values_of_c99(void **state) {
    (void)state;
    const wh_real_t inf = (wh_real_t)INFINITY;
    const wh_real_t values[] = {0, WH_REAL(-0.0), 1, -1, inf, -inf, 700, -700};
    for (size_t i = 0; i < 8; ++i) {
        for (size_t k = 0; k < 8; ++k) {
            const wh_real_t got = wh_atan2(values[i], values[k]);
            const wh_real_t want = (wh_real_t)atan2((double)values[i], (double)values[k]);
            assert_near(got, want, fabs((double)want) * (SMALLEST == -149 ? 1.2e-7 : 2.3e-16));
            assert_int_equal(signbit(got) != 0, signbit(want) != 0);
        }
    }
    assert_same_bits(wh_atan2(0, -1), WH_PI);
    assert_same_bits(wh_atan2(700, 0), WH_PI / 2);
    assert_same_bits(wh_atan2(-5, 5), -WH_PI / 4);
    const wh_real_t nan = (wh_real_t)NAN;
    assert_true(wh_atan2(nan, 1) != wh_atan2(nan, 1));
    assert_true(wh_atan2(1, nan) != wh_atan2(1, nan));
    assert_true(wh_atan2(inf, nan) != wh_atan2(inf, nan));
}

static void cbrt_is_near_the_oracle(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLES; ++i) {
        const wh_real_t x = (wh_real_t)(i % 2 == 0 ? wh_test_decades(1e-30, 1e30) : wh_test_uniform(-10, 10));
        assert_ulps(wh_cbrt(x), cbrtl((long double)x), 0.51);
        const wh_real_t any =
            (wh_real_t)(DIGITS == 24 ? wh_test_decades(1e-44, 3e38) : wh_test_decades(1e-322, 1e308));
        assert_ulps(wh_cbrt(any), cbrtl((long double)any), 0.51);
    }
    static const wh_real_t rim[] = {(wh_real_t)FLT_MAX,
                                    (wh_real_t)FLT_MIN,
                                    8,
                                    1,
                                    WH_REAL(0.125),
                                    WH_REAL(7.9999995),
                                    SMALLEST == -149 ? WH_REAL(1e-45) : WH_REAL(5e-324)};
    for (size_t i = 0; i < sizeof rim / sizeof rim[0]; ++i) {
        assert_ulps(wh_cbrt(-rim[i]), cbrtl(-(long double)rim[i]), 0.51);
    }
}

static void cbrt_of_cubes_and_special_values(void **state) {
    (void)state;
    for (int i = 1; i <= 200; ++i) {
        const wh_real_t x = (wh_real_t)i;
        assert_same_bits(wh_cbrt(x * x * x), x);
        assert_same_bits(wh_cbrt(-x * x * x), -x);
    }
    const wh_real_t nan = (wh_real_t)NAN;
    assert_same_bits(wh_cbrt(0), 0);
    assert_same_bits(wh_cbrt(WH_REAL(-0.0)), WH_REAL(-0.0));
    assert_true(wh_cbrt((wh_real_t)INFINITY) > WH_REAL(1e38));
    assert_true(wh_cbrt(-(wh_real_t)INFINITY) < -WH_REAL(1e38));
    assert_true(wh_cbrt(nan) != wh_cbrt(nan));
}

static void rotations_turn_the_right_way(void **state) {
    (void)state;
    const wh_mat3_t quarter = wh_mat3_from_rpy_deg(0, 0, 90);
    const wh_mat3_t want = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    assert_memory_equal(&quarter, &want, sizeof want);
    for (int i = 0; i < 1000; ++i) {
        const wh_real_t roll = random_real(-200, 200);
        const wh_real_t pitch = random_real(-200, 200);
        const wh_real_t yaw = random_real(-200, 200);
        const wh_mat3_t rx = wh_mat3_from_rpy_deg(roll, 0, 0);
        const wh_mat3_t ry = wh_mat3_from_rpy_deg(0, pitch, 0);
        const wh_mat3_t rz = wh_mat3_about_z(wh_rad_from_deg(yaw));
        const wh_mat3_t rzy = wh_mat3_multiply(&rz, &ry);
        const wh_mat3_t product = wh_mat3_multiply(&rzy, &rx);
        const wh_mat3_t got = wh_mat3_from_rpy_deg(roll, pitch, yaw);
        for (size_t row = 0; row < 3; ++row) {
            for (size_t column = 0; column < 3; ++column) {
                assert_near(got.m[row][column], product.m[row][column], DIGITS == 24 ? 1e-6 : 1e-15);
            }
        }
        assert_near(rx.m[2][1], sin((double)roll * (double)(PI / 180)), 1e-6);
        assert_near(ry.m[0][2], sin((double)pitch * (double)(PI / 180)), 1e-6);
        assert_near(rz.m[1][0], sin((double)yaw * (double)(PI / 180)), 1e-6);
    }
}

static void times(long double a[3][3], const long double b[3][3]) {
    long double c[3][3];
    for (int i = 0; i < 9; ++i) {
        c[i / 3][i % 3] = a[i / 3][0] * b[0][i % 3] + a[i / 3][1] * b[1][i % 3] + a[i / 3][2] * b[2][i % 3];
    }
    memcpy(a, c, sizeof c);
}

/* Rz(yaw) Ry(pitch) Rx(roll), each written as in a textbook. */
static void roll_pitch_and_yaw_are_about_fixed_axes(void **state) {
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        const wh_real_t deg[3] = {random_real(-200, 200), random_real(-200, 200), random_real(-200, 200)};
        long double s[3];
        long double c[3];
        for (int k = 0; k < 3; ++k) {
            s[k] = sinl((long double)deg[k] * PI / 180);
            c[k] = cosl((long double)deg[k] * PI / 180);
        }
        long double R[3][3] = {{c[2], -s[2], 0}, {s[2], c[2], 0}, {0, 0, 1}};
        const long double Ry[3][3] = {{c[1], 0, s[1]}, {0, 1, 0}, {-s[1], 0, c[1]}};
        const long double Rx[3][3] = {{1, 0, 0}, {0, c[0], -s[0]}, {0, s[0], c[0]}};
        times(R, Ry);
        times(R, Rx);
        const wh_mat3_t got = wh_mat3_from_rpy_deg(deg[0], deg[1], deg[2]);
        for (int k = 0; k < 9; ++k) {
            assert_near(got.m[k / 3][k % 3], (double)R[k / 3][k % 3], DIGITS == 24 ? 1e-6 : 1e-15);
        }
    }
}

/* One number for all results: it detects a machine or a compiler that rounds differently. */
static void bits_are_the_same_on_every_machine(void **state) {
    (void)state;
    uint64_t seed = 1;
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (int i = 0; i < 20000; ++i) {
        const wh_real_t x = (wh_real_t)((double)(int32_t)(wh_test_splitmix(&seed) >> 32) / 16777216.0);
        const wh_real_t y = (wh_real_t)((double)(int32_t)(wh_test_splitmix(&seed) >> 32) / 67108864.0);
        const wh_real_t results[] = {wh_sin(x), wh_cos(y), wh_atan2(y, x), wh_cbrt(x), wh_rad_from_deg(y)};
        for (size_t k = 0; k < 5; ++k) {
            hash = (hash ^ bits_of(results[k])) * UINT64_C(0x100000001B3);
        }
    }
    printf("hash of 100000 results %016llx\n", (unsigned long long)hash);
    assert_true(hash == HASH);
}

/* At the odd eighths of a turn the last digits of x decide which quarter turn is nearer, and so how
 * it is computed. */
static void bits_are_the_same_between_two_quarters(void **state) {
    (void)state;
    const wh_real_t eighth = WH_PI / 4;
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (int n = 1; n < 20000; n += 2) {
        wh_real_t results[2];
        wh_sin_cos((wh_real_t)n * eighth, &results[0], &results[1]);
        for (size_t k = 0; k < 2; ++k) {
            hash = (hash ^ bits_of(results[k])) * UINT64_C(0x100000001B3);
        }
    }
    printf("hash of 20000 results %016llx\n", (unsigned long long)hash);
    assert_true(hash == EIGHTHS_HASH);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sin_and_cos_are_near_the_oracle),
        cmocka_unit_test(reduction_holds_next_to_every_quarter_turn),
        cmocka_unit_test(out_of_range_is_nan),
        cmocka_unit_test(symmetries_are_exact),
        cmocka_unit_test(whole_quarters_in_degrees_are_exact),
        cmocka_unit_test(degrees_are_near_the_oracle),
        cmocka_unit_test(a_turn_more_gives_the_same_bits),
        cmocka_unit_test(atan2_is_near_the_oracle),
        cmocka_unit_test(atan2_takes_every_magnitude),
        cmocka_unit_test(atan2_is_near_the_oracle_far_out),
#if !defined(WH_FLOAT)
        cmocka_unit_test(atan2_rounds_the_right_way_at_its_hardest),
#endif
        cmocka_unit_test(atan2_has_the_special_values_of_c99),
        cmocka_unit_test(cbrt_is_near_the_oracle),
        cmocka_unit_test(cbrt_of_cubes_and_special_values),
        cmocka_unit_test(rotations_turn_the_right_way),
        cmocka_unit_test(roll_pitch_and_yaw_are_about_fixed_axes),
        cmocka_unit_test(bits_are_the_same_on_every_machine),
        cmocka_unit_test(bits_are_the_same_between_two_quarters),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
