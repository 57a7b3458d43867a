/* The numbers of a study: the generator's known answers, deviates, intervals against closed forms, sums and quantiles. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/deviate.h"
#include "study/interval.h"
#include "study/philox.h"
#include "study/sum.h"
#include "support.h"

/* ---------------------------------------------------------------------------------------------------- generator */

/* The vectors that were published with the generator. */
static void philox_has_its_known_answers(void **state) {
    (void)state;
    static const struct {
        uint32_t counter[4], key[2], answer[4];
    } known[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
         {0xffffffff, 0xffffffff},
         {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
         {0xa4093822, 0x299f31d0},
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        const wh_philox_t bits = wh_philox(known[i].counter, known[i].key);
        assert_memory_equal(bits.words, known[i].answer, sizeof bits.words);
    }
}

static void the_logarithm_is_libms_to_the_last_digits(void **state) {
    (void)state;
    for (int exponent = -1021; exponent < 1023; ++exponent) {
        for (int i = 0; i < 40; ++i) {
            const double x = ldexp(1 + i / 40.0, exponent);
            assert_true(fabs(wh_study_log(x) - log(x)) <= 1e-15 * fabs(log(x)) + 1e-17);
        }
    }
    for (double u = 1 - 0x1p-20; u < 1; u += 0x1p-27) {
        assert_true(fabs(wh_study_log(u) - log(u)) <= 1e-15 * fabs(log(u)) + 1e-17);
    }
    assert_true(wh_study_log(1) == 0);
    assert_true(isnan(wh_study_log(0)) && isnan(wh_study_log(-1)) && isnan(wh_study_log((double)INFINITY)));
}

/* A number is its name's alone: neighbours in any of the four differ, and nothing remembers. */
static void a_deviate_depends_on_its_name(void **state) {
    (void)state;
    const wh_trial_t trial = {7, 11};
    const wh_trial_t others[] = {
        {8, 11}, {7, 12}, {7 + (UINT64_C(1) << 32), 11}, {7, 11 + (UINT64_C(1) << 32)}};
    const double u = wh_deviate_uniform(&trial, 3, 5);
    const double n = wh_deviate_normal(&trial, 3, 5);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        assert_true(wh_deviate_uniform(&others[i], 3, 5) != u);
        assert_true(wh_deviate_normal(&others[i], 3, 5) != n);
    }
    assert_true(wh_deviate_uniform(&trial, 4, 5) != u && wh_deviate_uniform(&trial, 3, 6) != u);
    assert_true(wh_deviate_uniform(&trial, 3, 5) == u && wh_deviate_normal(&trial, 3, 5) == n);
}

/* Moments of n values are off by their standard errors; six of them are never seen. */
static void deviates_have_their_moments(void **state) {
    (void)state;
    enum { N = 200000 };
    double uniform[2] = {0, 0};
    double normal[4] = {0, 0, 0, 0};
    for (uint64_t i = 0; i < N; ++i) {
        const wh_trial_t trial = {1, i};
        const double u = wh_deviate_uniform(&trial, 0, 0);
        const double x = wh_deviate_normal(&trial, 0, 0);
        assert_true(u > 0 && u < 1 && fabs(x) < 8.6);
        uniform[0] += u;
        uniform[1] += u * u;
        normal[0] += x;
        normal[1] += x * x;
        normal[2] += x * x * x;
        normal[3] += x * x * x * x;
    }
    const double root = sqrt((double)N);
    assert_true(fabs(uniform[0] / N - 0.5) < 6 * sqrt(1 / 12.0) / root);
    assert_true(fabs(uniform[1] / N - 1 / 3.0) < 6 * sqrt(4 / 45.0) / root);
    assert_true(fabs(normal[0] / N) < 6 / root);
    assert_true(fabs(normal[1] / N - 1) < 6 * sqrt(2.0) / root);
    assert_true(fabs(normal[2] / N) < 6 * sqrt(15.0) / root);
    assert_true(fabs(normal[3] / N - 3) < 6 * sqrt(96.0) / root);
}

/* The same bits on every machine: these are of x86-64. */
static void deviates_keep_their_bits(void **state) {
    (void)state;
    uint64_t hash = 0;
    for (uint64_t i = 0; i < 10000; ++i) {
        const wh_trial_t trial = {42, i};
        const double x = wh_deviate_normal(&trial, 1, 2);
        uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
    }
    assert_int_equal(hash, UINT64_C(0xc9c8a8cb81354ca7));
}

/* --------------------------------------------------------------------------------------------------- intervals */

/* Wilson's limits are the roots p of (rate - p)^2 = z^2 p (1 - p) / n. */
static void wilsons_limits_solve_his_equation(void **state) {
    (void)state;
    static const uint64_t cases[][2] = {{0, 1},  {1, 1},      {0, 10},     {10, 10},
                                        {7, 10}, {999, 1000}, {500, 1000}, {123456, 1000000}};
    const double z = 1.959963984540054;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double n = (double)cases[i][1];
        const wh_confidence_t found = wh_interval_wilson(cases[i][0], cases[i][1]);
        const double limits[] = {found.low, found.high};
        assert_true(found.rate == (double)cases[i][0] / n);
        assert_true(0 <= found.low && found.low <= found.rate && found.rate <= found.high && found.high <= 1);
        for (int side = 0; side < 2; ++side) {
            const double p = limits[side];
            assert_true(fabs((found.rate - p) * (found.rate - p) - z * z * p * (1 - p) / n) < 1e-12);
        }
    }
}

/* All of n: the lower limit is n / (n + z^2). None: the upper one is z^2 / (n + z^2). */
static void intervals_at_the_ends_have_closed_forms(void **state) {
    (void)state;
    const double square = 1.959963984540054 * 1.959963984540054;
    for (uint64_t n = 1; n < 1000000; n *= 3) {
        assert_true(fabs(wh_interval_wilson(n, n).low - (double)n / ((double)n + square)) < 1e-12);
        assert_true(fabs(wh_interval_wilson(0, n).high - square / ((double)n + square)) < 1e-12);
    }
    const wh_confidence_t unknown = wh_interval_wilson(0, 0);
    assert_true(unknown.low == 0 && unknown.high == 1);
}

/* -------------------------------------------------------------------------------------------------------- sums */

static int compare(const void *a, const void *b) {
    const double one = *(const double *)a;
    const double other = *(const double *)b;
    return one < other ? -1 : one > other ? 1 : 0;
}

static void check_quantiles(const wh_sum_t *sum, const double sorted[], size_t count) {
    static const uint32_t permille[] = {1, 10, 50, 250, 500, 750, 950, 990, 999, 1000};
    for (size_t i = 0; i < sizeof permille / sizeof permille[0]; ++i) {
        const size_t rank = (count * permille[i] + 999) / 1000;
        const double exact = sorted[rank > 0 ? rank - 1 : 0];
        assert_true(fabs(wh_sum_quantile(sum, permille[i]) - exact) <= fabs(exact) / 128 + 1e-8);
    }
}

enum { VALUES = 10000 };

static void fill(double values[]) {
    for (uint64_t i = 0; i < VALUES; ++i) {
        const wh_trial_t trial = {3, i};
        values[i] = 0.25 + 0.01 * wh_deviate_normal(&trial, 0, 0) - (i % 7 == 0 ? 0.5 : 0);
    }
}

static void sums_have_mean_deviation_and_quantiles(void **state) {
    (void)state;
    static wh_sum_t sum;
    static double values[VALUES];
    double mean = 0;
    double squares = 0;
    memset(&sum, 0, sizeof sum);
    fill(values);
    for (size_t i = 0; i < VALUES; ++i) {
        wh_sum_add(&sum, values[i]);
        mean += values[i] / VALUES;
    }
    for (size_t i = 0; i < VALUES; ++i) {
        squares += (values[i] - mean) * (values[i] - mean);
    }
    qsort(values, VALUES, sizeof values[0], compare);
    assert_true(fabs(wh_sum_mean(&sum) - mean) < 1e-9);
    assert_true(fabs(wh_sum_deviation(&sum) - sqrt(squares / (VALUES - 1))) < 1e-9);
    assert_true(fabs(wh_sum_least(&sum) - values[0]) < 1e-9 &&
                fabs(wh_sum_most(&sum) - values[VALUES - 1]) < 1e-9);
    check_quantiles(&sum, values, VALUES);
}

/* However the values are shared out, what comes together is the same to the last bit. */
static void sums_do_not_depend_on_who_adds(void **state) {
    (void)state;
    static wh_sum_t all;
    static wh_sum_t parts[3];
    static wh_sum_t together;
    static double values[VALUES];
    memset(&all, 0, sizeof all);
    memset(parts, 0, sizeof parts);
    memset(&together, 0, sizeof together);
    fill(values);
    for (size_t i = 0; i < VALUES; ++i) {
        wh_sum_add(&all, values[i]);
        wh_sum_add(&parts[i * i % 3], values[VALUES - 1 - i]);
    }
    for (size_t i = 3; i > 0; --i) {
        wh_sum_merge(&together, &parts[i - 1]);
    }
    assert_memory_equal(&all, &together, sizeof all);
}

static void sums_bear_extremes(void **state) {
    (void)state;
    static wh_sum_t sum;
    memset(&sum, 0, sizeof sum);
    assert_true(wh_sum_mean(&sum) == 0 && wh_sum_deviation(&sum) == 0 && wh_sum_quantile(&sum, 500) == 0);
    wh_sum_add(&sum, 1e300);
    wh_sum_add(&sum, -1e300);
    wh_sum_add(&sum, 0);
    assert_true(wh_sum_mean(&sum) == 0 && wh_sum_most(&sum) == 8192 && wh_sum_least(&sum) == -8192);
    assert_true(fabs(wh_sum_deviation(&sum) - 8192) < 1e-9);
    assert_true(wh_sum_quantile(&sum, 500) == 0 && wh_sum_quantile(&sum, 1) == -8192 &&
                wh_sum_quantile(&sum, 1000) == 8192);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(philox_has_its_known_answers),
        cmocka_unit_test(the_logarithm_is_libms_to_the_last_digits),
        cmocka_unit_test(a_deviate_depends_on_its_name),
        cmocka_unit_test(deviates_have_their_moments),
        cmocka_unit_test(deviates_keep_their_bits),
        cmocka_unit_test(wilsons_limits_solve_his_equation),
        cmocka_unit_test(intervals_at_the_ends_have_closed_forms),
        cmocka_unit_test(sums_have_mean_deviation_and_quantiles),
        cmocka_unit_test(sums_do_not_depend_on_who_adds),
        cmocka_unit_test(sums_bear_extremes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
