/* When slices are due, on a clock that a test sets. */
#include "support/support.h"

#include "loop/pacing.h"

static void slices_on_time_stay_on_the_clock(void **state) {
    (void)state;
    wh_pacing_t pacing;
    wh_pacing_begin(&pacing, 1000, 5000000);
    for (int64_t slice = 1; slice <= 100000; ++slice) {
        assert_true(wh_pacing_due(&pacing) == 5000000 + 1000 * slice);
        wh_pacing_pass(&pacing, 5000000 + 1000 * slice + slice % 125);
    }
    assert_true(pacing.late == 0 && pacing.moved_us == 0 && pacing.latest_us == 124);
}

/* Slices after a late one have all their time. */
static void a_late_slice_moves_those_behind_it(void **state) {
    (void)state;
    wh_pacing_t pacing;
    wh_pacing_begin(&pacing, 1000, 0);
    wh_pacing_pass(&pacing, 1000);
    wh_pacing_pass(&pacing, 2400);
    assert_true(wh_pacing_due(&pacing) == 3400 && pacing.late == 0 && pacing.moved_us == 400);
    wh_pacing_pass(&pacing, 9000);
    assert_true(wh_pacing_due(&pacing) == 10000 && pacing.late == 1 && pacing.moved_us == 6000);
    assert_true(pacing.latest_us == 5600 && pacing.passed == 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_on_time_stay_on_the_clock),
        cmocka_unit_test(a_late_slice_moves_those_behind_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
