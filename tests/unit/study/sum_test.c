/* Means, deviations and quantiles of a study, whoever adds them up; intervals of a rate against closed forms. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/deviate.h"
#include "study/sum.h"
#include "support/support.h"

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

/* Wilson's limits are the roots p of (rate - p)^2 = z^2 p (1 - p) / n. */
static void wilsons_limits_solve_his_equation(void **state) {
    (void)state;
    static const uint64_t cases[][2] = {{0, 1},  {1, 1},      {0, 10},     {10, 10},
                                        {7, 10}, {999, 1000}, {500, 1000}, {123456, 1000000}};
    const double z = 1.959963984540054;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const double n = (double)cases[i][1];
        const wh_confidence_t found = wh_wilson_interval(cases[i][0], cases[i][1]);
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
        assert_true(fabs(wh_wilson_interval(n, n).low - (double)n / ((double)n + square)) < 1e-12);
        assert_true(fabs(wh_wilson_interval(0, n).high - square / ((double)n + square)) < 1e-12);
    }
    const wh_confidence_t unknown = wh_wilson_interval(0, 0);
    assert_true(unknown.low == 0 && unknown.high == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_have_mean_deviation_and_quantiles),
        cmocka_unit_test(sums_do_not_depend_on_who_adds),
        cmocka_unit_test(sums_bear_extremes),
        cmocka_unit_test(wilsons_limits_solve_his_equation),
        cmocka_unit_test(intervals_at_the_ends_have_closed_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
