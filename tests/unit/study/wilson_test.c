/* Intervals of a rate against closed forms. */
#include <math.h>

#include "study/wilson.h"
#include "support/support.h"

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
        cmocka_unit_test(wilsons_limits_solve_his_equation),
        cmocka_unit_test(intervals_at_the_ends_have_closed_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
