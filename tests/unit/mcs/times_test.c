/* Stations that take time at the prompt: STATUS, PUMP, WAIT_FOR, and states kept and put back. */
#include "support/support.h"

#include "mcs/session.h"

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

static void assert_answer(const char *line, const char *expected) {
    (void)wh_session_execute(&session, line, answer, sizeof answer);
    if (strncmp(answer, expected, strlen(expected)) != 0) {
        fail_msg("%s: answered %s, expected %s", line, answer, expected);
    }
}

static void assert_status(const char *expected) {
    assert_answer("STATUS", "OK phase=");
    if (!strstr(answer, expected)) {
        fail_msg("STATUS: %s, expected %s", answer, expected);
    }
}

static int open_session(void **state) {
    (void)state;
    const wh_session_options_t options = {.layout = "tests/end_to_end/data/chamber_layout.lua",
                                          .limits = {.print_to = stderr}};
    return wh_session_open(&session, &options) ? 0 : -1;
}

static int close_session(void **state) {
    (void)state;
    wh_session_close(&session);
    return 0;
}

static void bring(void) {
    assert_answer("GET A 1", "OK");
    assert_answer("OPEN SLIT", "OK");
    assert_answer("PUT PM 1", "OK");
    assert_answer("CLOSE SLIT", "OK");
}

static void status_tells_what_goes_on(void **state) {
    (void)state;
    assert_status("L.is=empty L.pressure=atmosphere PM.is=empty");
    bring();
    assert_status("PM.is=processing PM.left=4.9");
    assert_answer("WAIT_FOR PM", "OK seconds=4.9");
    assert_status("PM.is=done");
    assert_answer("PUMP L vacuum", "OK seconds=2");
    assert_status("L.pressure=vacuum");
    assert_answer("OPEN AIR", "ERROR 111 WRONG_PRESSURE");
    assert_answer("PUMP L air", "ERROR 48 BAD_ARGUMENT");
    assert_answer("WAIT_FOR A", "ERROR 48 BAD_ARGUMENT");
    assert_answer("HELP PUMP", "OK PUMP STATION SIDE");
}

static void states_are_kept_and_put_back(void **state) {
    (void)state;
    bring();
    assert_answer("WAIT 1", "OK");
    assert_answer("SAVE half", "OK");
    assert_status("PM.is=processing PM.left=3.9");
    assert_answer("WAIT_FOR PM", "OK seconds=3.9");
    assert_answer("PUMP L vacuum", "OK");
    assert_answer("UNDO", "OK undone=\"PUMP L vacuum\"");
    assert_status("L.pressure=atmosphere PM.is=done");
    assert_answer("RESTORE half", "OK");
    assert_status("L.pressure=atmosphere PM.is=processing PM.left=3.9");
    assert_answer("OPEN SLIT", "OK");
    assert_answer("GET PM 1", "ERROR 108 PROCESS_RUNNING");
    assert_answer("WAIT_FOR PM", "OK");
    assert_answer("GET PM 1", "OK");
    assert_status("PM.is=empty");
    assert_answer("RESTORE half", "OK");
    assert_answer("WAIT_FOR PM 1", "ERROR 110 STATION_TIMEOUT");
    assert_answer("WAIT_FOR PM 5", "OK");
}

static void reset_begins_anew(void **state) {
    (void)state;
    char message[WH_SESSION_ANSWER_BYTES];
    bring();
    assert_answer("PUMP L vacuum", "OK");
    (void)message;
    assert_answer("RESET", "OK");
    assert_status("L.is=empty L.pressure=atmosphere PM.is=empty");
}

/* An arm that a STOP has left in the chamber keeps the process from beginning. */
static void a_blade_inside_keeps_the_process_waiting(void **state) {
    (void)state;
    assert_answer("GET A 1", "OK");
    assert_answer("OPEN SLIT", "OK");
    assert_answer("PUT PM 1 stop=extended", "OK");
    assert_answer("STOP", "OK");
    assert_status("PM.is=empty");
    assert_answer("RECOVER", "OK");
    assert_answer("PUT PM 1", "OK");
    assert_status("PM.is=waiting");
    assert_answer("GET PM 1", "ERROR 108 PROCESS_RUNNING");
    assert_answer("CLOSE SLIT", "OK");
    assert_status("PM.is=processing");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(status_tells_what_goes_on, open_session, close_session),
        cmocka_unit_test_setup_teardown(states_are_kept_and_put_back, open_session, close_session),
        cmocka_unit_test_setup_teardown(reset_begins_anew, open_session, close_session),
        cmocka_unit_test_setup_teardown(a_blade_inside_keeps_the_process_waiting, open_session,
                                        close_session),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
