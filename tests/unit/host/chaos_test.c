/* The fate of frames and bytes is drawn by name; a line's baud rate sets its pace. */
#include "host/chaos.h"
#include "host/pace.h"
#include "support/support.h"

#define FRAMES 20000

static const wh_chaos_t lossy = {.seed = 7, .drop = 0.1, .twice = 0.2, .delay_us = 1000, .late_ack_us = 500};

static wh_chaos_place_t at(uint32_t port, bool is_to_host, uint64_t frame) {
    return (wh_chaos_place_t){port, is_to_host, frame};
}

static void fates(void **state) {
    (void)state;
    size_t copies[3] = {0};
    double later = 0;
    double late = 0;
    int64_t most = 0;
    for (uint64_t i = 0; i < FRAMES; ++i) {
        const wh_chaos_fate_t fate = wh_chaos_fate(&lossy, at(0, false, i), false);
        const wh_chaos_fate_t ack = wh_chaos_fate(&lossy, at(0, false, i), true);
        assert_in_range(fate.copies, 0, 2);
        assert_int_equal(ack.copies, fate.copies);
        copies[fate.copies] += 1;
        for (size_t k = 0; k < fate.copies; ++k) {
            assert_in_range(fate.later_us[k], 0, 1000);
            assert_in_range(ack.later_us[k], fate.later_us[k], fate.later_us[k] + 500);
            most = fate.later_us[k] > most ? fate.later_us[k] : most;
        }
        later += fate.copies > 0 ? (double)fate.later_us[0] : 0;
        late += fate.copies > 0 ? (double)(ack.later_us[0] - fate.later_us[0]) : 0;
    }
    /* Five standard deviations of 20,000 draws. */
    assert_near((double)copies[0] / FRAMES, 0.1, 5 * sqrt(0.09 / FRAMES));
    assert_near((double)copies[2] / FRAMES, 0.9 * 0.2, 5 * sqrt(0.18 * 0.82 / FRAMES));
    assert_near(later / (double)(FRAMES - copies[0]), 500, 15);
    assert_near(late / (double)(FRAMES - copies[0]), 250, 8);
    assert_int_equal(most, 1000);
}

/* Each of the names gives other draws, but the order of drawing does not. */
static void names(void **state) {
    (void)state;
    const wh_chaos_t other = {.seed = 8, .drop = 0.1, .twice = 0.2, .delay_us = 1000, .late_ack_us = 500};
    size_t same[4] = {0};
    for (uint64_t i = FRAMES; i-- > 0;) {
        const int64_t later = wh_chaos_fate(&lossy, at(1, false, i), false).later_us[0];
        same[0] += wh_chaos_fate(&other, at(1, false, i), false).later_us[0] == later;
        same[1] += wh_chaos_fate(&lossy, at(2, false, i), false).later_us[0] == later;
        same[2] += wh_chaos_fate(&lossy, at(1, true, i), false).later_us[0] == later;
        same[3] += wh_chaos_fate(&lossy, at(1, false, i + (UINT64_C(1) << 32)), false).later_us[0] == later;
        assert_int_equal(wh_chaos_fate(&lossy, at(1, false, i), false).later_us[0], later);
    }
    for (size_t i = 0; i < 4; ++i) {
        assert_in_range(same[i], 0, FRAMES / 20);
    }
}

static void bytes(void **state) {
    (void)state;
    static uint8_t sent[WH_FRAMING_LINE];
    static uint8_t came[WH_CHAOS_BYTES];
    static uint8_t again[WH_CHAOS_BYTES];
    const wh_chaos_t chaos = {.seed = 3, .garble = 0.25};
    const wh_chaos_t all = {.seed = 3, .garble = 1};
    memset(sent, 'a', sizeof sent);
    assert_int_equal(wh_chaos_garble(&lossy, at(0, true, 1), 0, sent, sizeof sent, came), sizeof sent);
    assert_memory_equal(sent, came, sizeof sent);
    size_t wrong = 0;
    const size_t size = wh_chaos_garble(&chaos, at(0, true, 1), 0, sent, sizeof sent, came);
    for (size_t i = 0; i < size; ++i) {
        wrong += came[i] != 'a';
    }
    /* On average as many are lost as come twice; half of the garbled ones have other bytes. */
    assert_near((double)size, WH_FRAMING_LINE, 5 * sqrt(WH_FRAMING_LINE * 0.125));
    assert_near((double)wrong, WH_FRAMING_LINE * 0.125, 5 * sqrt(WH_FRAMING_LINE * 0.125));
    assert_int_equal(wh_chaos_garble(&chaos, at(0, true, 1), 0, sent, sizeof sent, again), size);
    assert_memory_equal(came, again, size);
    (void)wh_chaos_garble(&chaos, at(0, true, 1), 1, sent, sizeof sent, again);
    assert_memory_not_equal(came, again, 1000);
    /* A frame that is cut short meets the same fate, as far as it goes. */
    const size_t part = wh_chaos_garble(&chaos, at(0, true, 1), 0, sent, 1000, again);
    assert_memory_equal(came, again, part);
    assert_in_range(wh_chaos_garble(&all, at(0, true, 1), 0, sent, sizeof sent, came), 1, WH_CHAOS_BYTES);
}

static void assert_refused(const wh_chaos_t *chaos, const char *expected) {
    char problem[WH_FRAMING_PROBLEM_BYTES] = "";
    assert_false(wh_chaos_validate(chaos, problem));
    assert_string_equal(problem, expected);
}

static void ranges(void **state) {
    (void)state;
    char problem[WH_FRAMING_PROBLEM_BYTES];
    assert_true(wh_chaos_validate(&lossy, problem));
    assert_true(wh_chaos_is_on(&lossy));
    assert_false(wh_chaos_is_on(&(wh_chaos_t){.seed = 5}));
    assert_refused(&(wh_chaos_t){.drop = -0.1}, "drop: -0.1 (expected 0 to 1)");
    assert_refused(&(wh_chaos_t){.twice = 1.5}, "double: 1.5 (expected 0 to 1)");
    assert_refused(&(wh_chaos_t){.garble = (double)NAN}, "garble: nan (expected 0 to 1)");
    assert_refused(&(wh_chaos_t){.delay_us = 3600000001}, "delay: 3600.000001 (expected 0 to 3600)");
    assert_refused(&(wh_chaos_t){.late_ack_us = -1}, "late_ack: -1e-06 (expected 0 to 3600)");
}

/* 9600 baud are 960 bytes a second, whatever the slices; nothing drifts in an hour. */
static void baud(void **state) {
    (void)state;
    wh_pace_t pace = {.baud = 9600};
    size_t through = 0;
    for (int64_t now = 5000; now <= 5000 + 3600000000; now += 1 + (int64_t)wh_test_below(20000)) {
        through += wh_pace_take(&pace, SIZE_MAX, now);
        assert_int_equal(through, (size_t)((now - 5000) * 96 / 100000));
    }
    assert_in_range(through, 960 * 3600 - 20, 960 * 3600);
    /* An idle line begins with the next byte that comes: a byte takes 1041.7 us. */
    pace = (wh_pace_t){.baud = 9600};
    assert_int_equal(wh_pace_take(&pace, 0, 1000000), 0);
    assert_int_equal(wh_pace_take(&pace, 2, 2000000), 0);
    assert_int_equal(wh_pace_take(&pace, 2, 2001041), 0);
    assert_int_equal(wh_pace_take(&pace, 2, 2001042), 1);
    assert_int_equal(wh_pace_take(&pace, 1, 2009000), 1);
    assert_int_equal(wh_pace_take(&pace, 1, 2010000), 0);
    assert_int_equal(wh_pace_take(&pace, 1, 2011042), 1);
    pace = (wh_pace_t){.baud = 0};
    assert_int_equal(wh_pace_take(&pace, 5000, 3), 5000);
    assert_true(wh_pace_validate(0) && wh_pace_validate(110) && wh_pace_validate(4000000));
    assert_false(wh_pace_validate(109) || wh_pace_validate(4000001) || wh_pace_validate(-1));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fates),  cmocka_unit_test(names), cmocka_unit_test(bytes),
        cmocka_unit_test(ranges), cmocka_unit_test(baud),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
