/* Load ports at the prompt: STATUS, CARRIER, PORT, TAKE_AWAY, and states kept and put back. */
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
    const wh_session_options_t options = {.layout = "tests/end_to_end/data/ports_layout.lua",
                                          .limits = {.print_to = stderr}};
    return wh_session_open(&session, &options) ? 0 : -1;
}

static int close_session(void **state) {
    (void)state;
    wh_session_close(&session);
    return 0;
}

static void status_tells_the_step_and_the_carrier(void **state) {
    (void)state;
    assert_status("LP1.is=absent LP2.is=open LP2.carrier=LP2");
    assert_answer("CARRIER LP1 name=C1 wafers=1,3 at=2 slots=3:crossed", "OK carrier=C1 seconds=0");
    assert_status("LP1.is=absent LP2.is=open");
    assert_answer("WAIT 4", "OK");
    assert_status("LP1.is=absent LP1.left=9 LP1.does=TP3 LP1.carrier=C1");
    assert_answer("WAIT 12", "OK");
    assert_status("LP1.is=clamped LP1.left=2.5 LP1.does=dock LP1.carrier=C1");
    assert_answer("WAIT_FOR LP1", "OK seconds=11.5");
    assert_status("LP1.is=mapped LP1.carrier=C1");
    assert_answer("GET LP1 3", "ERROR 62 BAD_SLOT");
    assert_answer("TAKE_AWAY LP1", "OK seconds=21.5");
    assert_status("LP1.is=absent LP2.is=open");
    assert_answer("GET LP1 1", "ERROR 114 PORT_NOT_OPEN");
    assert_answer("HELP PORT", "OK PORT STATION PORT_STATE");
}

static void states_are_kept_and_put_back(void **state) {
    (void)state;
    assert_answer("CARRIER LP2 name=C2", "OK carrier=C2");
    assert_answer("UNDO", "OK undone=\"CARRIER LP2 name=C2\"");
    assert_answer("TAKE_AWAY LP2", "OK");
    assert_answer("CARRIER LP2 name=C2", "OK carrier=C2");
    assert_answer("WAIT 1", "OK");
    assert_status("LP2.is=absent LP2.left=1.001 LP2.does=place LP2.carrier=C2");
    assert_answer("SAVE half", "OK");
    assert_answer("WAIT_FOR LP2", "OK");
    assert_answer("GET LP2 1", "OK wafer=C2.1");
    assert_answer("RESTORE half", "OK");
    assert_status("LP2.is=absent LP2.left=1.001 LP2.does=place LP2.carrier=C2");
    assert_answer("GET LP2 1", "ERROR 114 PORT_NOT_OPEN");
    assert_answer("WAIT_FOR LP2", "OK");
    assert_answer("GET LP2 1", "OK wafer=C2.1");
    assert_answer("PUT A 3", "OK");
    assert_answer("PORT LP2 mapped", "OK seconds=1.5");
    assert_answer("GET LP2 1", "ERROR 42 WAFER_MISSING");
    assert_answer("UNDO", "OK undone=\"PORT LP2 mapped\"");
    assert_status("LP2.is=open");
    assert_answer("TAKE_AWAY LP2", "OK");
    assert_answer("UNDO", "OK undone=\"TAKE_AWAY LP2\"");
    assert_answer("GET LP2 3", "OK wafer=C2.3");
}

static void reset_begins_anew(void **state) {
    (void)state;
    assert_answer("CARRIER LP1 name=C1", "OK");
    assert_answer("WAIT_FOR LP1", "OK");
    assert_answer("GET LP1 1", "OK wafer=C1.1");
    assert_answer("TAKE_AWAY LP2", "OK");
    assert_answer("RESET", "OK");
    assert_status("LP1.is=absent LP2.is=open LP2.carrier=LP2");
    assert_answer("GET LP2 2", "OK wafer=W2");
    assert_answer("CARRIER LP1 name=C1", "OK");
    assert_answer("WAIT_FOR LP1", "OK");
}

/* An arm that a STOP has left inside, or that is held in a phase, keeps the carrier there. */
static void a_blade_inside_keeps_the_carrier(void **state) {
    (void)state;
    assert_answer("GET LP2 2 stop=extended", "OK");
    assert_answer("TAKE_AWAY LP2", "ERROR 65 IN_PHASE");
    assert_answer("STOP", "OK");
    assert_answer("TAKE_AWAY LP2", "ERROR 115 PORT_ENTERED");
    assert_answer("PORT LP2 docked", "ERROR 115 PORT_ENTERED");
    assert_answer("RECOVER", "OK");
    assert_answer("PORT LP2 docked", "OK seconds=2.5");
    assert_answer("READY LP2 1", "ERROR 114 PORT_NOT_OPEN");
    assert_answer("MAP LP2", "ERROR 114 PORT_NOT_OPEN");
    assert_answer("TEACH LP2", "ERROR ");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(status_tells_the_step_and_the_carrier, open_session, close_session),
        cmocka_unit_test_setup_teardown(states_are_kept_and_put_back, open_session, close_session),
        cmocka_unit_test_setup_teardown(reset_begins_anew, open_session, close_session),
        cmocka_unit_test_setup_teardown(a_blade_inside_keeps_the_carrier, open_session, close_session),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
