/* The reason why a trial failed, in words. */
#include "support/support.h"

#include "study/lines.h"

#include "grasp/event.h"

static void assert_why(const wh_trial_line_t *trial, const char *expected) {
    char why[300];
    wh_trial_line_why(trial, why, sizeof why);
    assert_string_equal(why, expected);
}

static void all_that_went_wrong_is_named(void **state) {
    (void)state;
    assert_why(&(wh_trial_line_t){.errors = 1}, "1 command failed");
    assert_why(&(wh_trial_line_t){.errors = 2, .error = 42, .error_line = 5},
               "2 commands failed: 42 WAFER_MISSING in line 5");
    assert_why(&(wh_trial_line_t){.ended = true, .errors = 2, .error = 42, .error_line = 5},
               "ended by 42 WAFER_MISSING in line 5");
    assert_why(&(wh_trial_line_t){.errors = 2, .missed = 1, .missed_line = 7},
               "2 commands failed, line 7 missed");
    assert_why(&(wh_trial_line_t){.missed = 3, .missed_line = 7}, "line 7 missed, 2 more");
    assert_why(&(wh_trial_line_t){.ended = true, .errors = 1, .elsewhere = 1},
               "ended by an error, 1 wafer elsewhere");
    assert_why(&(wh_trial_line_t){.elsewhere = 12, .kinds = 1U << WH_EVENT_HIT | 1U << WH_EVENT_SLIPPED},
               "hit, slipped, 12 wafers elsewhere");
    assert_why(&(wh_trial_line_t){.met = true, .errors = 1}, "");
}

static void what_has_no_room_is_cut(void **state) {
    char why[12];
    (void)state;
    wh_trial_line_why(&(wh_trial_line_t){.errors = 1, .elsewhere = 1}, why, sizeof why);
    assert_string_equal(why, "1 command f");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_that_went_wrong_is_named),
        cmocka_unit_test(what_has_no_room_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
