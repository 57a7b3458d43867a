/* Slices that could be left out are held against what leaving them out gives. */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "mcs/verify.h"

static wh_verify_t verify;
static wh_command_t command;
static wh_state_t state;

/* Slices 11 to 20, behind which two axes stand at 3 and 4. */
static void expect_stretch(void) {
    wh_command_t last = {.seq = 20, .axis_count = 2, .axes = {3, 4}};
    memset(&verify, 0, sizeof verify);
    memset(&command, 0, sizeof command);
    memset(&state, 0, sizeof state);
    command.axis_count = 2;
    wh_verify_expect(&verify, 11, &last, 77, 2);
    state.sensors = 2;
}

static const char *play(int64_t seq, uint64_t hash) {
    command.seq = seq;
    command.axes[0] = seq == 20 ? 3 : 1;
    command.axes[1] = seq == 20 ? 4 : 1;
    return wh_verify_slice(&verify, &command, &state, hash);
}

static void a_stretch_as_expected_differs_nowhere(void **unused) {
    (void)unused;
    expect_stretch();
    for (int64_t seq = 9; seq <= 20; ++seq) {
        assert_null(play(seq, seq == 20 ? 77 : 0));
    }
    state.event_count = 1;
    assert_null(play(21, 0));
}

static void assert_difference(const char *found, const char *expected) {
    assert_non_null(found);
    assert_string_equal(found, expected);
}

static void each_difference_has_its_words(void **unused) {
    (void)unused;
    expect_stretch();
    state.event_count = 1;
    assert_null(play(10, 0));
    assert_difference(play(11, 0), "there was an event");
    assert_null(play(12, 0)); /* it is told once */
    expect_stretch();
    state.sensors = 3;
    assert_difference(play(15, 0), "a sensor changed");
    expect_stretch();
    state.status = WH_STATUS_NOT_FINITE;
    assert_difference(play(15, 0), "a slice was refused");
    expect_stretch();
    assert_difference(play(20, 78), "the cell came into another state");
    expect_stretch();
    verify.axes[1] = nextafter(4, 5);
    assert_difference(play(20, 77), "the axes came to stand elsewhere");
}

/* The first N, and then about N for each doubling: by their numbers alone. */
static void stretches_are_taken_by_their_number(void **unused) {
    (void)unused;
    static bool taken[100000];
    verify = (wh_verify_t){.wanted = 50};
    for (size_t i = 0; i < 100000; ++i) {
        taken[i] = wh_verify_takes(&verify);
        assert_true(taken[i] || i >= 50);
    }
    const double expected = 50 * (1 + log(100000.0 / 50));
    assert_true(fabs((double)verify.verified - expected) < 5 * sqrt(expected));
    assert_int_equal(verify.stretches, 100000);
    size_t late = 0;
    for (size_t i = 50000; i < 100000; ++i) {
        late += taken[i] ? 1 : 0;
    }
    assert_true(late > 10 && late < 80);
    verify = (wh_verify_t){.wanted = 50};
    for (size_t i = 0; i < 100000; ++i) {
        assert_true(wh_verify_takes(&verify) == taken[i]);
    }
}

static void nothing_is_taken_unless_wanted(void **unused) {
    (void)unused;
    verify = (wh_verify_t){.wanted = 0};
    assert_false(wh_verify_takes(&verify));
    assert_int_equal(verify.stretches, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_stretch_as_expected_differs_nowhere),
                                       cmocka_unit_test(each_difference_has_its_words),
                                       cmocka_unit_test(stretches_are_taken_by_their_number),
                                       cmocka_unit_test(nothing_is_taken_unless_wanted)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
