/* The clockwork of a station, slice by slice. */
#include "flow/clock.h"
#include "support/support.h"

#define S INT64_C(1000000)
#define SLICE 1000

static wh_flow_station_t station;
static wh_clock_t clock_;
static wh_clock_place_t places[2];
static wh_clock_seen_t seen[2];
static bool is_closed;
static double rate;
static int64_t now_us;
static wh_clock_event_t told[20];
static size_t told_count;
static size_t rest_count;

static void take(void *user, const wh_clock_event_t *event) {
    (void)user;
    assert_true(told_count < sizeof told / sizeof told[0]);
    told[told_count++] = *event;
}

static const wh_clock_teller_t teller = {take, NULL};

/* A look at a station that rests changes nothing. */
static void look(void) {
    const bool rests = wh_clock_rests(&station, places, seen);
    const wh_clock_t clock_before = clock_;
    const size_t told_before = told_count;
    wh_clock_place_t places_before[2];
    memcpy(places_before, places, sizeof places);
    wh_clock_look(&station, &clock_, places, seen, is_closed, now_us, &teller);
    if (rests) {
        assert_memory_equal(&clock_, &clock_before, sizeof clock_);
        assert_memory_equal(places, places_before, sizeof places);
        assert_int_equal(told_count, told_before);
        ++rest_count;
    }
}

static void begin(int64_t process_us, int32_t clean_after, int64_t clean_us) {
    station = (wh_flow_station_t){.slots = 2,
                                  .process_us = process_us,
                                  .window_us = WH_FLOW_NEVER,
                                  .idle_us = WH_FLOW_NEVER,
                                  .clean_after = clean_after,
                                  .clean_us = clean_us};
    now_us = 0;
    told_count = 0;
    rate = 1;
    is_closed = true;
    seen[0] = seen[1] = (wh_clock_seen_t){.wafer = WH_FLOW_NONE};
    wh_clock_start(&station, &clock_, places);
    look();
}

/* Slices pass, of SLICE us each. */
static void pass(int64_t us) {
    for (const int64_t until_us = now_us + us; now_us < until_us;) {
        now_us += SLICE;
        wh_clock_pass(&station, &clock_, places, SLICE, rate, now_us, &teller);
        look();
    }
}

static void assert_told(size_t i, wh_clock_kind_t kind, int32_t wafer, int64_t at_us, int64_t us) {
    assert_true(i < told_count);
    assert_int_equal(told[i].kind, kind);
    assert_int_equal(told[i].wafer, wafer);
    assert_int_equal(told[i].at_us, at_us);
    assert_int_equal(told[i].us, us);
}

static void a_process_waits_until_it_is_closed_and_is_rounded_up(void **state) {
    (void)state;
    begin(2 * S + 1, 0, 0);
    is_closed = false;
    seen[1].wafer = 7;
    pass(S);
    assert_int_equal(places[1].phase, WH_CLOCK_WAITING);
    assert_true(wh_clock_left_us(&station, &places[1], now_us) == 2e6 + 1);
    is_closed = true;
    look();
    assert_int_equal(places[1].phase, WH_CLOCK_PROCESSING);
    pass(2 * S);
    assert_int_equal(places[1].phase, WH_CLOCK_PROCESSING);
    pass(SLICE);
    assert_int_equal(places[1].phase, WH_CLOCK_DONE);
    rest_count = 0;
    pass(S / 2);
    assert_int_equal(rest_count, S / 2 / SLICE);
    seen[1].wafer = WH_FLOW_NONE;
    look();
    assert_told(0, WH_CLOCK_PROCESS_BEGINS, 7, S, 2 * S + 1);
    assert_told(1, WH_CLOCK_PROCESS_ENDS, 7, 3 * S + SLICE, 2 * S + SLICE);
    assert_told(2, WH_CLOCK_TAKEN, 7, 3 * S + SLICE + S / 2, S / 2);
    assert_int_equal(told[0].slot, 1);
    assert_int_equal(told_count, 3);
}

static void a_door_that_opens_does_not_end_a_process_but_taking_its_wafer_does(void **state) {
    (void)state;
    begin(2 * S, 0, 0);
    seen[0].wafer = 1;
    look();
    is_closed = false;
    pass(S);
    assert_int_equal(places[0].phase, WH_CLOCK_PROCESSING);
    seen[0].wafer = 2;
    pass(SLICE);
    assert_told(1, WH_CLOCK_PROCESS_CUT, 1, S + SLICE, S + SLICE);
    assert_int_equal(places[0].phase, WH_CLOCK_WAITING);
    assert_int_equal(places[0].wafer, 2);
}

static void faults_make_it_slow_or_stop_it(void **state) {
    (void)state;
    begin(S, 0, 0);
    seen[0].wafer = 1;
    look();
    rate = 0;
    pass(S);
    rate = 0.25;
    pass(4 * S - SLICE);
    assert_int_equal(places[0].phase, WH_CLOCK_PROCESSING);
    pass(SLICE);
    assert_told(1, WH_CLOCK_PROCESS_ENDS, 1, 5 * S, 5 * S);
}

static void bring_and_take(int32_t wafer) {
    seen[0].wafer = wafer;
    pass(S);
    seen[0].wafer = WH_FLOW_NONE;
    look();
}

static void a_clean_comes_after_its_wafers(void **state) {
    (void)state;
    begin(S, 2, 3 * S);
    bring_and_take(1);
    assert_true(wh_clock_cleans_next(&station, &places[0]));
    assert_false(wh_clock_cleans_next(&station, &places[1]));
    is_closed = false;
    bring_and_take(2);
    assert_int_equal(places[0].phase, WH_CLOCK_FREE);
    is_closed = true;
    seen[0].wafer = WH_FLOW_NONE;
    bring_and_take(3);
    told_count = 0;
    assert_true(wh_clock_left_us(&station, &places[0], now_us) == 3e6);
    look();
    assert_int_equal(places[0].phase, WH_CLOCK_CLEANING);
    pass(3 * S);
    assert_int_equal(places[0].phase, WH_CLOCK_FREE);
    assert_false(wh_clock_cleans_next(&station, &places[0]));
}

static void a_clean_around_a_wafer_follows_its_process(void **state) {
    (void)state;
    begin(S, 1, 2 * S);
    station.cleans_full = true;
    seen[0].wafer = 1;
    look();
    assert_true(wh_clock_left_us(&station, &places[0], now_us) == 3e6);
    pass(S);
    assert_int_equal(places[0].phase, WH_CLOCK_CLEANING);
    pass(2 * S);
    assert_told(3, WH_CLOCK_CLEAN_ENDS, 1, 3 * S, 2 * S);
    assert_int_equal(places[0].phase, WH_CLOCK_DONE);
    seen[0].wafer = WH_FLOW_NONE;
    look();
    assert_int_equal(places[0].phase, WH_CLOCK_FREE);
    assert_int_equal(places[0].since_clean, 0);
    assert_false(places[0].is_clean_due);
}

static void a_clean_comes_without_wafers(void **state) {
    (void)state;
    begin(0, 0, S);
    station.idle_us = 4 * S;
    pass(4 * S);
    assert_int_equal(told_count, 2);
    assert_told(0, WH_CLOCK_CLEAN_BEGINS, WH_FLOW_NONE, 4 * S, S);
    seen[0].wafer = 5; /* by somebody who did not ask */
    pass(S);
    assert_int_equal(places[0].phase, WH_CLOCK_DONE);
}

/* Once, until the next wafer has left; also if the clean was one that wafers had brought about. */
static void a_place_that_was_cleaned_is_clean(void **state) {
    (void)state;
    begin(0, 0, S);
    station.idle_us = 4 * S;
    pass(5 * S);
    assert_int_equal(told_count, 4);
    assert_true(isinf(wh_clock_quiet_us(&station, &clock_, places, now_us)));
    pass(100 * S);
    assert_int_equal(told_count, 4);
    assert_false(wh_clock_is_clean_due(&station, &places[0], now_us));
    bring_and_take(1);
    told_count = 0;
    pass(5 * S);
    assert_told(0, WH_CLOCK_CLEAN_BEGINS, WH_FLOW_NONE, now_us - S, S);
    pass(100 * S);
    assert_int_equal(told_count, 2);
    begin(0, 1, S);
    station.idle_us = 4 * S;
    bring_and_take(1);
    pass(S);
    told_count = 0;
    pass(3 * S); /* the other place is cleaned for want of wafers */
    pass(100 * S);
    assert_int_equal(told_count, 2);
    assert_int_equal(told[0].slot, 1);
}

static void a_lock_pumps_with_and_without_a_wafer(void **state) {
    (void)state;
    begin(0, 0, 0);
    station.is_lock = true;
    station.pump_us[WH_FLOW_VACUUM] = 2 * S;
    station.pump_us[WH_FLOW_ATMOSPHERE] = 3 * S;
    station.empty_pump_us[WH_FLOW_VACUUM] = S;
    station.empty_pump_us[WH_FLOW_ATMOSPHERE] = S;
    assert_true(wh_clock_pump(&station, &clock_, places, WH_FLOW_ATMOSPHERE, now_us, &teller));
    assert_int_equal(told_count, 0);
    assert_true(wh_clock_pump(&station, &clock_, places, WH_FLOW_VACUUM, now_us, &teller));
    assert_true(wh_clock_pump(&station, &clock_, places, WH_FLOW_VACUUM, now_us, &teller));
    assert_false(wh_clock_pump(&station, &clock_, places, WH_FLOW_ATMOSPHERE, now_us, &teller));
    assert_int_equal(clock_.side, WH_FLOW_ATMOSPHERE);
    pass(S);
    assert_false(clock_.is_pumping);
    assert_int_equal(clock_.side, WH_FLOW_VACUUM);
    seen[1].wafer = 3;
    look();
    assert_true(wh_clock_pump(&station, &clock_, places, WH_FLOW_ATMOSPHERE, now_us, &teller));
    pass(3 * S - SLICE);
    assert_true(clock_.is_pumping);
    pass(SLICE);
    assert_told(3, WH_CLOCK_PUMP_ENDS, WH_FLOW_NONE, 4 * S, 3 * S);
    assert_string_equal(wh_flow_side_words[told[3].side], "atmosphere");
}

/* It is lifted and set down again, without leaving the station. */
static void lift_and_set_down(int32_t wafer, int64_t us) {
    seen[0] = (wh_clock_seen_t){.wafer = WH_FLOW_NONE, .keeps = true};
    pass(us);
    seen[0] = (wh_clock_seen_t){.wafer = wafer};
    look();
}

static void a_stay_goes_on_until_the_wafer_has_left(void **state) {
    (void)state;
    begin(S, 2, 3 * S);
    station.window_us = 2 * S;
    seen[0].wafer = 1;
    pass(S);
    lift_and_set_down(1, S);
    assert_int_equal(places[0].phase, WH_CLOCK_DONE);
    assert_int_equal(places[0].since_clean, 0);
    pass(S);
    seen[0] = (wh_clock_seen_t){.wafer = WH_FLOW_NONE, .keeps = true};
    pass(S);
    wh_clock_lift_anew(&places[0], now_us);
    pass(S);
    assert_int_equal(told_count, 2);
    seen[0].keeps = false;
    look();
    assert_told(2, WH_CLOCK_TAKEN, 1, 5 * S, 3 * S - SLICE);
    assert_told(3, WH_CLOCK_LATE, 1, 5 * S, S - SLICE);
    assert_int_equal(places[0].phase, WH_CLOCK_FREE);
    assert_int_equal(places[0].since_clean, 1);
}

static void a_process_that_never_began_is_told(void **state) {
    (void)state;
    begin(S, 0, 0);
    seen[0] = (wh_clock_seen_t){.wafer = 1, .is_bad = true};
    pass(2 * S);
    assert_int_equal(places[0].phase, WH_CLOCK_WAITING);
    seen[0] = (wh_clock_seen_t){.wafer = WH_FLOW_NONE};
    look();
    assert_told(0, WH_CLOCK_UNPROCESSED, 1, 2 * S, 2 * S - SLICE);
    seen[0].wafer = 2;
    pass(S / 2);
    seen[0].is_bad = true;
    look();
    assert_told(2, WH_CLOCK_PROCESS_CUT, 2, 2 * S + S / 2, S / 2 - SLICE);
    seen[0].wafer = WH_FLOW_NONE;
    look();
    assert_int_equal(told_count, 3);
}

static void a_wafer_that_comes_in_place_of_a_clean_is_told(void **state) {
    (void)state;
    begin(S, 1, 3 * S);
    is_closed = false;
    bring_and_take(1);
    told_count = 0;
    seen[0].wafer = 2;
    look();
    assert_told(0, WH_CLOCK_CLEAN_MISSED, 2, S, 3 * S);
    begin(0, 0, 3 * S);
    station.idle_us = S;
    is_closed = false;
    pass(2 * S);
    assert_true(wh_clock_is_clean_due(&station, &places[0], now_us));
    seen[0].is_awaited = true;
    is_closed = true;
    seen[0].wafer = 2;
    seen[1].wafer = 3;
    look();
    assert_told(0, WH_CLOCK_CLEAN_MISSED, 3, 2 * S, 3 * S);
    assert_int_equal(told_count, 1);
}

static void a_clean_around_a_wafer_belongs_to_its_stay(void **state) {
    (void)state;
    begin(S, 1, 2 * S);
    station.cleans_full = true;
    station.window_us = S;
    seen[0].wafer = 1;
    look();
    pass(2 * S);
    lift_and_set_down(1, SLICE);
    assert_told(3, WH_CLOCK_CLEAN_CUT, 1, 2 * S + SLICE, S + SLICE);
    assert_true(wh_clock_judge(&station, &places[0], 0, true, now_us, &teller) == S + SLICE);
    assert_told(4, WH_CLOCK_LATE, 1, 2 * S + SLICE, SLICE);
}

static void kinds_have_names(void **state) {
    (void)state;
    for (int kind = 0; kind < WH_CLOCK_KINDS; ++kind) {
        assert_string_not_equal(wh_clock_kind_name((wh_clock_kind_t)kind), "unknown");
    }
    assert_string_equal(wh_clock_kind_name((wh_clock_kind_t)WH_CLOCK_KINDS), "unknown");
    assert_string_equal(wh_clock_phase_name(WH_CLOCK_DONE), "done");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_process_waits_until_it_is_closed_and_is_rounded_up),
        cmocka_unit_test(a_door_that_opens_does_not_end_a_process_but_taking_its_wafer_does),
        cmocka_unit_test(faults_make_it_slow_or_stop_it),
        cmocka_unit_test(a_clean_comes_after_its_wafers),
        cmocka_unit_test(a_clean_around_a_wafer_follows_its_process),
        cmocka_unit_test(a_clean_comes_without_wafers),
        cmocka_unit_test(a_place_that_was_cleaned_is_clean),
        cmocka_unit_test(a_lock_pumps_with_and_without_a_wafer),
        cmocka_unit_test(a_stay_goes_on_until_the_wafer_has_left),
        cmocka_unit_test(a_process_that_never_began_is_told),
        cmocka_unit_test(a_wafer_that_comes_in_place_of_a_clean_is_told),
        cmocka_unit_test(a_clean_around_a_wafer_belongs_to_its_stay),
        cmocka_unit_test(kinds_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
