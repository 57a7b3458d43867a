/* Means, deviations, quantiles and histograms of a study, in any order of addition; intervals of a
 * rate compared with closed forms; correlations compared with the textbook's, and none if there is
 * nothing to report. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/deviate.h"
#include "study/relations.h"
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

/* However the values are shared out, the combined result is the same to the last bit. */
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

/* All n: the lower limit is n / (n + z^2). None: the upper one is z^2 / (n + z^2). */
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

static void histogram_counts_all(void **state) {
    (void)state;
    static wh_sum_t sum;
    static double values[VALUES];
    enum { BARS = 8 };
    double counts[BARS];
    double exact[BARS] = {0};
    double total = 0;
    memset(&sum, 0, sizeof sum);
    for (size_t i = 0; i < VALUES; ++i) {
        const wh_trial_t trial = {5, i};
        values[i] = wh_deviate_uniform(&trial, 0, 0) * 3;
        wh_sum_add(&sum, values[i]);
    }
    const double low = wh_sum_least(&sum);
    const double step = (wh_sum_most(&sum) - low) / BARS;
    wh_sum_histogram(&sum, low, wh_sum_most(&sum), counts, BARS);
    for (size_t i = 0; i < VALUES; ++i) {
        const size_t bar = (size_t)floor((values[i] - low) / step + 1e-7);
        ++exact[bar < BARS ? bar : BARS - 1];
    }
    for (size_t i = 0; i < BARS; ++i) {
        assert_near(counts[i], exact[i], 0.05 * VALUES / BARS);
        total += counts[i];
    }
    assert_near(total, VALUES, 1e-6);
}

/* ------------------------------------------------------------------------------------------- correlations */

enum { PAIRS = 400, CAUSES = 3 };

/* The wafer's dx follows the first cause, and failures follow its size; the second cause is
 * independent; the third never varies. */
static void draw(size_t trial, double drawn[CAUSES], double ends[WH_RELATION_ENDS], bool *failed) {
    const wh_trial_t name = {7, trial};
    const double noise = wh_deviate_normal(&name, 2, 0);
    drawn[0] = 0.3 * wh_deviate_normal(&name, 0, 0);
    drawn[1] = 2 * wh_deviate_normal(&name, 1, 0);
    drawn[2] = 0.5;
    ends[0] = drawn[0] + 0.3 * noise;
    ends[1] = noise;
    ends[2] = 0;
    ends[3] = fabs(drawn[0]);
    ends[4] = fabs(noise);
    *failed = fabs(drawn[0]) > 0.5;
}

static void add_pairs(wh_relations_t *relations, wh_sum_t sums[WH_RELATION_ENDS], size_t from, size_t step,
                      uint64_t *failed_trials) {
    wh_relations_need(relations, CAUSES, 1);
    for (size_t i = from; i < PAIRS; i += step) {
        double ends[WH_RELATION_ENDS];
        bool failed;
        draw(i, relations->drawn, ends, &failed);
        wh_relations_add(relations, failed);
        wh_relations_add_wafer(relations, 0, ends);
        *failed_trials += failed ? 1 : 0;
        for (size_t q = 0; q < WH_RELATION_ENDS; ++q) {
            wh_sum_add(&sums[q], ends[q]);
        }
    }
}

/* The textbook's correlation of the first cause, or its size, with dx, tilt or failing. */
static double plain_correlation(bool by_size, int with) {
    double x[PAIRS], y[PAIRS];
    double mean_x = 0, mean_y = 0, xy = 0, xx = 0, yy = 0;
    for (size_t i = 0; i < PAIRS; ++i) {
        double drawn[CAUSES];
        double ends[WH_RELATION_ENDS];
        bool failed;
        draw(i, drawn, ends, &failed);
        x[i] = by_size ? fabs(drawn[0]) : drawn[0];
        y[i] = with < 0 ? (failed ? 1 : 0) : ends[with];
        mean_x += x[i] / PAIRS;
        mean_y += y[i] / PAIRS;
    }
    for (size_t i = 0; i < PAIRS; ++i) {
        xy += (x[i] - mean_x) * (y[i] - mean_y);
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        yy += (y[i] - mean_y) * (y[i] - mean_y);
    }
    return xy / sqrt(xx * yy);
}

static void correlations_are_the_textbooks(void **state) {
    (void)state;
    static wh_sum_t sums[WH_RELATION_ENDS];
    wh_relations_t whole = {0};
    wh_relations_t parts[2] = {{0}, {0}};
    static wh_sum_t others[WH_RELATION_ENDS];
    uint64_t failed = 0;
    uint64_t again = 0;
    add_pairs(&whole, sums, 0, 1, &failed);
    add_pairs(&parts[0], others, 0, 2, &again);
    add_pairs(&parts[1], others, 1, 2, &again);
    wh_relations_merge(&parts[1], &parts[0]);
    for (size_t i = 0; i < wh_relations_size(&whole); ++i) {
        assert_true(*wh_relations_number(&whole, i) == *wh_relations_number(&parts[1], i));
    }
    assert_in_range(failed, 20, 80);
    const wh_correlation_t size = wh_relations_failing(&whole, 0, true, PAIRS, failed);
    const wh_correlation_t value = wh_relations_failing(&whole, 0, false, PAIRS, failed);
    const wh_correlation_t dx = wh_relations_end(&whole, 0, 0, 0, &sums[0]);
    const wh_correlation_t tilt = wh_relations_end(&whole, 0, 0, 3, &sums[3]);
    assert_near(size.r, plain_correlation(true, -1), 1e-6);
    assert_near(value.r, plain_correlation(false, -1), 1e-6);
    assert_near(dx.r, plain_correlation(false, 0), 1e-6);
    assert_near(tilt.r, 1, 1e-6);
    assert_true(size.low > 0.5 && size.high < 0.9 && value.low < 0 && value.high > 0);
    assert_true(dx.low > 0.5 && dx.low < dx.r && dx.r < dx.high && dx.high < 0.85);
    /* An independent cause is not reported. */
    const wh_correlation_t none = wh_relations_failing(&whole, 1, true, PAIRS, failed);
    assert_true(none.determined && none.low < 0 && none.high > 0);
    /* 21 intervals: erfc(z / sqrt 2) = 0.05 / 21, z = 3.038; atanh is linear near 0. */
    assert_near((none.high - none.low) / 2, 3.038 / sqrt(PAIRS - 3.0), 0.003);
    wh_relations_free(&whole);
    wh_relations_free(&parts[0]);
    wh_relations_free(&parts[1]);
}

static void not_determined(void **state) {
    (void)state;
    static wh_sum_t sums[WH_RELATION_ENDS];
    wh_relations_t relations = {0};
    uint64_t failed = 0;
    const wh_sum_t empty = {0};
    add_pairs(&relations, sums, 0, 1, &failed);
    assert_false(wh_relations_failing(&relations, 2, true, PAIRS, failed).determined);
    assert_false(wh_relations_end(&relations, 2, 0, 0, &sums[0]).determined);
    assert_false(wh_relations_end(&relations, 0, 0, 2, &sums[2]).determined);
    assert_false(wh_relations_end(&relations, 0, 0, 0, &empty).determined);
    assert_false(wh_relations_failing(&relations, 0, true, PAIRS, 4).determined);
    assert_false(wh_relations_failing(&relations, 0, true, PAIRS, PAIRS - 4).determined);
    assert_true(wh_relations_failing(&relations, 0, true, PAIRS, 5).determined);
    wh_relations_free(&relations);
    assert_int_equal(wh_relations_wafers(1000, 100), 2);
    assert_int_equal(wh_relations_wafers(0, 100), 0);
    assert_int_equal(wh_relations_wafers(13, 1), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(histogram_counts_all),
        cmocka_unit_test(correlations_are_the_textbooks),
        cmocka_unit_test(not_determined),
        cmocka_unit_test(sums_have_mean_deviation_and_quantiles),
        cmocka_unit_test(sums_do_not_depend_on_who_adds),
        cmocka_unit_test(sums_bear_extremes),
        cmocka_unit_test(wilsons_limits_solve_his_equation),
        cmocka_unit_test(intervals_at_the_ends_have_closed_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
