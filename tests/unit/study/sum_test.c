/* Means, deviations and quantiles of a study, whoever adds them up. */
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_have_mean_deviation_and_quantiles),
        cmocka_unit_test(sums_do_not_depend_on_who_adds),
        cmocka_unit_test(sums_bear_extremes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
