/* An example to copy: tests of an edge gripper's firmware, and of passive pads. grip_bench.h simulates the machine around it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define BENCH_FAIL(text) fail_msg("%s", text)
#include "grip_bench.h"

static void begin(double x, double y) {
    assert_int_equal(bench_set_up(x, y), 0);
    wait_ms(10);
    assert_true(registers.retracted && !registers.gripped && !registers.overtravel);
    move_to(EDGE, 0);
}

/* --------------------------------------------------------------------------------------------------- the edge grip */

static void a_wafer_is_centred_gripped_and_carried(void **unused) {
    (void)unused;
    begin(0.5, -1);
    assert_int_equal(close_it(), GRIPPER_READY);
    assert_int_equal(phase(), WH_GRIP_CLOSED);
    assert_held_by(EDGE, true);
    assert_lies_at(0, 0, 0, 0);
    move_to(EDGE, 5);
    assert_lies_at(0, 0, 0, 5);
    move_to(EDGE, 0);
    assert_int_equal(open_it(), GRIPPER_READY);
    assert_held_by(EDGE, false);
    assert_lies_at(0, 0, 0, 0);
}

/* Without a wafer the plunger passes the window: the switch is on for 39 ms. A firmware that believes it at once would carry
 * nothing. */
static void a_window_that_is_only_passed_is_no_wafer(void **unused) {
    (void)unused;
    int gripped_ms = 0;
    begin(20, 0);
    gripper_close(&gripper);
    while (gripper.answer == GRIPPER_BUSY) {
        tick();
        gripped_ms += registers.gripped ? 1 : 0;
    }
    assert_int_equal(gripper.answer, GRIPPER_MISSED);
    assert_in_range(gripped_ms, 35, 45);
    wait_ms(200);
    assert_int_equal(phase(), WH_GRIP_MISSED);
    assert_held_by(EDGE, false);
    assert_lies_at(0, 20, 0, 0);
}

/* The wafer lies 3 mm towards the plunger, half a millimetre more than the pocket takes. It stays where it is. */
static void a_wafer_beyond_the_pocket_jams_the_plunger(void **unused) {
    (void)unused;
    begin(-3, 0);
    assert_int_equal(close_it(), GRIPPER_JAMMED);
    assert_int_equal(phase(), WH_GRIP_JAMMED);
    assert_true(state.physics->grips[EDGE].excess > 0.499 && state.physics->grips[EDGE].excess < 0.501);
    assert_held_by(EDGE, false);
    assert_lies_at(0, -3, 0, 0);
    assert_int_equal(open_it(), GRIPPER_READY);
}

/* A jam beside the blade stops the plunger in the window. No switch tells it from a wafer that is gripped; the test sees it. */
static void a_jam_in_the_window_is_seen_from_outside(void **unused) {
    (void)unused;
    begin(0, 2.6);
    assert_int_equal(close_it(), GRIPPER_READY);
    assert_true(registers.gripped);
    assert_int_equal(phase(), WH_GRIP_JAMMED);
    assert_held_by(EDGE, false);
    move_to(EDGE, 5);
    assert_lies_at(0, 0, 2.6, 0); /* it was left behind */
}

static void a_plunger_that_sticks_ends_the_command(void **unused) {
    (void)unused;
    begin(0, 0);
    break_it(WH_FAULT_PLUNGER_STUCK, 0);
    assert_int_equal(close_it(), GRIPPER_JAMMED);
    assert_true(registers.retracted);
}

static void a_closed_plunger_that_sticks_does_not_let_go(void **unused) {
    (void)unused;
    begin(0, 0);
    assert_int_equal(close_it(), GRIPPER_READY);
    break_it(WH_FAULT_PLUNGER_STUCK, 0);
    assert_int_equal(open_it(), GRIPPER_NOT_OPEN);
    assert_held_by(EDGE, true);
}

static void a_slow_plunger_is_waited_for(void **unused) {
    (void)unused;
    begin(0, 1);
    break_it(WH_FAULT_PLUNGER_SLOW, 20);
    assert_int_equal(close_it(), GRIPPER_READY);
    assert_held_by(EDGE, true);
}

/* ---------------------------------------------------------------------------------------------------- passive pads */

static void passive_pads_take_a_wafer_and_leave_it(void **unused) {
    (void)unused;
    begin(0, 0);
    assert_held_by(PASSIVE, false);
    move_to(PASSIVE, 3);
    assert_held_by(PASSIVE, true);
    assert_true((state.sensors >> PASSIVE & 1U) != 0);
    assert_lies_at(1, 0, 0, 3);
    move_to(PASSIVE, -2);
    assert_held_by(PASSIVE, false);
    assert_true((state.sensors >> PASSIVE & 1U) == 0);
    assert_lies_at(1, 0, 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wafer_is_centred_gripped_and_carried),
        cmocka_unit_test(a_window_that_is_only_passed_is_no_wafer),
        cmocka_unit_test(a_wafer_beyond_the_pocket_jams_the_plunger),
        cmocka_unit_test(a_jam_in_the_window_is_seen_from_outside),
        cmocka_unit_test(a_plunger_that_sticks_ends_the_command),
        cmocka_unit_test(a_closed_plunger_that_sticks_does_not_let_go),
        cmocka_unit_test(a_slow_plunger_is_waited_for),
        cmocka_unit_test(passive_pads_take_a_wafer_and_leave_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
