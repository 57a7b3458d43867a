/* The clockwork of a load port, slice by slice, and against a list of steps that is worked out in advance. */
#include <math.h>

#include "flow/load_port.h"
#include "support/pose.h"

#define S INT64_C(1000000)
#define SLICE 1000

static wh_load_port_of_t of;
static wh_load_port_t port;
static double rate, late_us;
static int64_t now_us;
static wh_load_port_event_t told[200];
static size_t told_count;

static void take(void *user, const wh_load_port_event_t *event) {
    (void)user;
    assert_true(told_count < sizeof told / sizeof told[0]);
    told[told_count++] = *event;
}

static const wh_load_port_teller_t teller = {take, NULL};

static void begin(bool is_e84, wh_load_port_state_t begins) {
    of = (wh_load_port_of_t){.is_e84 = is_e84, .goes_to = WH_LOAD_PORT_MAPPED, .begins = begins};
    for (int step = 1; step < WH_LOAD_PORT_STEPS; ++step) {
        of.us[step] = step * S;
    }
    for (int i = 1; i <= WH_LOAD_PORT_TIMERS; ++i) {
        of.limit_us[i] = 10 * S;
    }
    now_us = 0;
    told_count = 0;
    rate = 1;
    late_us = 0;
    wh_load_port_start(&of, &port);
}

static void pass(int64_t us) {
    for (const int64_t until_us = now_us + us; now_us < until_us;) {
        now_us += SLICE;
        const wh_load_port_time_t time = {SLICE, rate, late_us, now_us};
        wh_load_port_pass(&of, &port, &time, &teller);
    }
}

/* Nothing but this step has ended since then. */
static void assert_ended(wh_load_port_step_t step, int64_t at_us) {
    size_t found = 0;
    for (size_t i = 0; i < told_count; ++i) {
        if (told[i].kind == WH_LOAD_PORT_ENDS) {
            assert_int_equal(told[i].step, step);
            assert_int_equal(told[i].at_us, at_us);
            ++found;
        }
    }
    assert_int_equal(found, 1);
    told_count = 0;
}

static void a_carrier_goes_through_all_states(void **state) {
    (void)state;
    static const wh_load_port_step_t steps[] = {WH_LOAD_PORT_PLACE, WH_LOAD_PORT_CLAMP, WH_LOAD_PORT_DOCK,
                                                WH_LOAD_PORT_OPENS, WH_LOAD_PORT_MAP};
    static const wh_load_port_step_t back[] = {WH_LOAD_PORT_CLOSE, WH_LOAD_PORT_UNDOCK, WH_LOAD_PORT_UNCLAMP,
                                               WH_LOAD_PORT_REMOVE};
    begin(false, WH_LOAD_PORT_ABSENT);
    wh_load_port_bring(&of, &port, now_us, &teller);
    for (size_t i = 0; i < 5; ++i) {
        assert_int_equal(port.is, i);
        assert_false(wh_load_port_is_open(&port));
        pass(of.us[steps[i]]);
        assert_ended(steps[i], now_us);
    }
    assert_int_equal(port.is, WH_LOAD_PORT_MAPPED);
    assert_true(wh_load_port_is_open(&port));
    assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_ABSENT, now_us, &teller));
    for (size_t i = 0; i < 4; ++i) {
        assert_false(wh_load_port_is_open(&port));
        pass(of.us[back[i]]);
        assert_ended(back[i], now_us);
    }
    assert_int_equal(port.is, WH_LOAD_PORT_ABSENT);
    assert_false(wh_load_port_go(&of, &port, WH_LOAD_PORT_OPEN, now_us, &teller));
}

/* A time that is no whole number of slices ends with the slice behind it; the next step begins there. */
static void ends_are_rounded_up_to_slices(void **state) {
    (void)state;
    begin(false, WH_LOAD_PORT_ABSENT);
    of.us[WH_LOAD_PORT_PLACE] = 1;
    of.us[WH_LOAD_PORT_CLAMP] = 2 * SLICE - 1;
    of.us[WH_LOAD_PORT_DOCK] = SLICE;
    wh_load_port_bring(&of, &port, now_us, &teller);
    pass(SLICE);
    assert_ended(WH_LOAD_PORT_PLACE, SLICE);
    pass(2 * SLICE);
    assert_ended(WH_LOAD_PORT_CLAMP, 3 * SLICE);
    pass(SLICE);
    assert_ended(WH_LOAD_PORT_DOCK, 4 * SLICE);
}

/* Told otherwise during a step, it ends that step first. */
static void a_step_that_runs_is_ended(void **state) {
    (void)state;
    begin(false, WH_LOAD_PORT_CLAMPED);
    assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_OPEN, now_us, &teller));
    pass(S);
    assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_PLACED, now_us, &teller));
    pass(of.us[WH_LOAD_PORT_DOCK] - S);
    assert_ended(WH_LOAD_PORT_DOCK, now_us);
    pass(of.us[WH_LOAD_PORT_UNDOCK]);
    assert_ended(WH_LOAD_PORT_UNDOCK, now_us);
    pass(of.us[WH_LOAD_PORT_UNCLAMP]);
    assert_int_equal(port.is, WH_LOAD_PORT_PLACED);
    assert_int_equal(port.step, WH_LOAD_PORT_STANDS);
    /* A mapped one that is to be open stands; an open one that is to be mapped is mapped. */
    begin(false, WH_LOAD_PORT_MAPPED);
    assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_OPEN, now_us, &teller));
    assert_int_equal(port.step, WH_LOAD_PORT_STANDS);
    begin(false, WH_LOAD_PORT_OPEN);
    assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_MAPPED, now_us, &teller));
    assert_int_equal(port.step, WH_LOAD_PORT_MAP);
    assert_false(wh_load_port_is_open(&port));
}

/* By step of the handshake, coming and going: where the carrier is when its timer runs out. */
static void a_timer_that_runs_out_ends_the_handshake(void **state) {
    (void)state;
    for (int leaves = 0; leaves < 2; ++leaves) {
        for (int step = WH_LOAD_PORT_TP1; step <= WH_LOAD_PORT_TP5; ++step) {
            begin(true, leaves ? WH_LOAD_PORT_PLACED : WH_LOAD_PORT_ABSENT);
            if (leaves) {
                assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_ABSENT, now_us, &teller));
            } else {
                wh_load_port_bring(&of, &port, now_us, &teller);
            }
            while (port.step != (wh_load_port_step_t)step) {
                pass(SLICE);
            }
            const int64_t begun_us = now_us;
            const bool is_moved = step > WH_LOAD_PORT_TP3;
            rate = 0;
            pass(20 * S);
            assert_int_equal(port.step, WH_LOAD_PORT_STANDS);
            assert_int_equal(port.failed, step);
            assert_int_equal(port.is, is_moved == (leaves == 1) ? WH_LOAD_PORT_ABSENT : WH_LOAD_PORT_PLACED);
            const wh_load_port_event_t *last = &told[told_count - 1];
            assert_int_equal(last->kind, WH_LOAD_PORT_TIMEOUT);
            assert_int_equal(last->at_us - begun_us, 10 * S);
            /* The next order goes on from there. */
            rate = 1;
            if (port.is == WH_LOAD_PORT_PLACED) {
                assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_CLAMPED, now_us, &teller));
                pass(of.us[WH_LOAD_PORT_CLAMP]);
                assert_int_equal(port.is, WH_LOAD_PORT_CLAMPED);
                assert_int_equal(port.failed, WH_LOAD_PORT_STANDS);
            }
        }
    }
}

/* A step that is late by so much is late once, and runs out if that is too much. */
static void a_step_may_be_late(void **state) {
    (void)state;
    begin(true, WH_LOAD_PORT_ABSENT);
    wh_load_port_bring(&of, &port, now_us, &teller);
    late_us = 5e6;
    pass(6 * S);
    assert_ended(WH_LOAD_PORT_TP1, 6 * S);
    late_us = 9e6;
    pass(10 * S);
    assert_int_equal(port.failed, WH_LOAD_PORT_TP2);
}

/* ------------------------------------------------------------------------------------------------- random */

static int64_t up(int64_t us) {
    return us < SLICE ? SLICE : (us + SLICE - 1) / SLICE * SLICE;
}

static size_t list_hand_over(bool leaves, wh_load_port_step_t steps[]) {
    for (int i = 1; of.is_e84 && i <= WH_LOAD_PORT_TIMERS; ++i) {
        steps[i - 1] = (wh_load_port_step_t)i;
    }
    if (!of.is_e84) {
        steps[0] = leaves ? WH_LOAD_PORT_REMOVE : WH_LOAD_PORT_PLACE;
    }
    return of.is_e84 ? WH_LOAD_PORT_TIMERS : 1;
}

/* The steps of a whole visit, in order; by hand or by a vehicle. */
static size_t list_steps(wh_load_port_state_t highest, wh_load_port_step_t steps[30]) {
    static const wh_load_port_step_t ups[] = {WH_LOAD_PORT_CLAMP, WH_LOAD_PORT_DOCK, WH_LOAD_PORT_OPENS,
                                              WH_LOAD_PORT_MAP};
    static const wh_load_port_step_t downs[] = {WH_LOAD_PORT_UNCLAMP, WH_LOAD_PORT_UNDOCK,
                                                WH_LOAD_PORT_CLOSE};
    const int levels = (int)highest - (int)WH_LOAD_PORT_PLACED;
    size_t count = list_hand_over(false, steps);
    for (int i = 0; i < levels; ++i) {
        steps[count++] = ups[i];
    }
    for (int i = (levels < 3 ? levels : 3) - 1; i >= 0; --i) {
        steps[count++] = downs[i];
    }
    return count + list_hand_over(true, &steps[count]);
}

static void draw_times(void) {
    for (int step = 1; step < WH_LOAD_PORT_STEPS; ++step) {
        of.us[step] = wh_test_below(4) == 0 ? 0 : wh_test_below(20 * SLICE);
    }
    for (int i = 1; i <= WH_LOAD_PORT_TIMERS; ++i) {
        of.limit_us[i] = of.us[i] + SLICE;
    }
}

/* Slices that are left out while nothing ends change nothing. */
static void pass_or_leave_out(void) {
    const double quiet = wh_load_port_quiet_us(&of, &port);
    const int64_t slices = isinf(quiet) ? 5 : (int64_t)ceil(quiet / SLICE) - 1;
    if (slices > 0 && wh_test_below(2) == 0) {
        const int64_t us = (1 + wh_test_below((unsigned)slices)) * SLICE;
        const wh_load_port_time_t time = {(double)us, 1, 0, now_us + us};
        const size_t before = told_count;
        wh_load_port_pass(&of, &port, &time, &teller);
        assert_int_equal(told_count, before);
        now_us += us;
    } else {
        pass(SLICE);
    }
}

/* Counts, and ends where the list says. */
static void assert_as_listed(const wh_load_port_step_t steps[], size_t count, const int64_t begins_us[]) {
    size_t ended = 0;
    for (size_t i = 0; i < told_count; ++i) {
        if (told[i].kind == WH_LOAD_PORT_ENDS) {
            assert_true(ended < count);
            assert_int_equal(told[i].step, steps[ended]);
            assert_int_equal(told[i].at_us, begins_us[ended] + up(of.us[steps[ended]]));
            ++ended;
        }
    }
    assert_int_equal(ended, count);
}

static void a_visit_is_as_listed(void **state) {
    (void)state;
    for (int round = 0; round < 200; ++round) {
        wh_load_port_step_t steps[30];
        int64_t begins_us[30];
        begin(wh_test_below(2) == 0, WH_LOAD_PORT_ABSENT);
        draw_times();
        of.goes_to = (wh_load_port_state_t)(WH_LOAD_PORT_PLACED + wh_test_below(5));
        const size_t count = list_steps(of.goes_to, steps);
        const size_t half = (of.is_e84 ? 5 : 1) + (size_t)of.goes_to - WH_LOAD_PORT_PLACED;
        now_us = wh_test_below(50) * SLICE;
        wh_load_port_bring(&of, &port, now_us, &teller);
        int64_t at_us = now_us;
        for (size_t i = 0; i < count; ++i) {
            if (i == half) {
                while (port.step != WH_LOAD_PORT_STANDS) {
                    assert_true(wh_load_port_left_us(&of, &port) >= 0);
                    pass_or_leave_out();
                }
                assert_int_equal(port.is, of.goes_to);
                at_us = now_us += wh_test_below(20) * SLICE;
                assert_true(wh_load_port_go(&of, &port, WH_LOAD_PORT_ABSENT, now_us, &teller));
            }
            begins_us[i] = at_us;
            at_us += up(of.us[steps[i]]);
        }
        while (port.step != WH_LOAD_PORT_STANDS) {
            pass_or_leave_out();
        }
        assert_int_equal(port.is, WH_LOAD_PORT_ABSENT);
        assert_as_listed(steps, count, begins_us);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_carrier_goes_through_all_states),
        cmocka_unit_test(ends_are_rounded_up_to_slices),
        cmocka_unit_test(a_step_that_runs_is_ended),
        cmocka_unit_test(a_timer_that_runs_out_ends_the_handshake),
        cmocka_unit_test(a_step_may_be_late),
        cmocka_unit_test(a_visit_is_as_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
