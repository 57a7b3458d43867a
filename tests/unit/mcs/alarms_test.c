/* Errors on purpose: commands that can answer with them do so, and others do not. */
#include "support/support.h"

#include "mcs/session.h"

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

typedef struct {
    const char *line, *answer;
} exchange_t;

static void assert_dialogue(const char *layout, const exchange_t *dialogue, size_t count) {
    const wh_session_options_t options = {.layout = layout, .limits = {.print_to = stderr}};
    assert_true(wh_session_open(&session, &options));
    for (size_t i = 0; i < count; ++i) {
        (void)wh_session_execute(&session, dialogue[i].line, answer, sizeof answer);
        const char *expected = dialogue[i].answer; /* with a blank before it, it may stand anywhere */
        if (*expected == ' ' ? !strstr(answer, expected) : strncmp(answer, expected, strlen(expected)) != 0) {
            fail_msg("%s: answered %s, expected %s", dialogue[i].line, answer, dialogue[i].answer);
        }
    }
    wh_session_close(&session);
}

#define ASSERT_DIALOGUE(layout, dialogue)                                                                    \
    assert_dialogue(layout, dialogue, sizeof(dialogue) / sizeof(dialogue)[0])

/* A completion and STATUS tell one number, whatever way the error is raised. Questions are asked beside. */
static void status_tells_what_a_completion_told(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"GET A 1", "OK"},
        {"PUT P 1", "OK"},
        {"ALARM 77", "OK"},
        {"ALIGN P 90", "ERROR 77 BAD_SCAN: "},
        {"STATUS", " error=77 error_name=BAD_SCAN error_command=\"ALIGN P 90\""},
        {"ALARM 20", "OK"},
        {"HOME", "ERROR 20 BAD_LIMITS: "},
        {"STATUS", " error=20 error_name=BAD_LIMITS error_command=HOME"},
        {"ALARM 82", "OK"},
        {"MOVE theta=10", "ERROR 82 RUN_OVER: "},
        {"STATUS", " error=82 error_name=RUN_OVER"},
        {"ALARM 85", "OK"},
        {"GET P 1", "ERROR 85 NO_ANSWER: "},
        {"STATUS", " error=85 error_name=NO_ANSWER"},
        {"SAVE one", "OK"},
        {"ALARM 69", "OK"},
        {"RESTORE one", "ERROR 69 NOT_RESTORED: "},
        {"STATUS", " error=69 error_name=NOT_RESTORED"},
        {"HOME", "OK"},
        {"STATUS", " error=69 error_name=NOT_RESTORED"},
    };
    ASSERT_DIALOGUE("lua/layouts/lot.lua", dialogue);
}

/* If beams are to fail, the PUT that asks them answers with the error. A PUT that does not ask
 * leaves the error waiting. */
static void a_put_that_centres(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"ALARM 75", "OK fault=17"},
        {"ALARM 70", "OK fault=18"},
        {"GET A 1", "OK wafer=W1"},
        {"PUT LL 1 centre=false", "OK wafer=W1"},
        {"GET LL 1", "OK wafer=W1"},
        {"PUT LL 2", "ERROR 75 CENTRE_NOT_SURE: "},
        {"HOLDER W1", "OK holder=EE"},
        {"PUT LL 2", "ERROR 70 TOO_FEW_SAMPLES: "},
        {"PUT LL 2", "OK wafer=W1"},
        {"ALARM 75", "OK fault=17"},
        {"GET A 2", "OK wafer=W2"},
        {"PUT A 1", "OK wafer=W2"},
        {"CLEAR 17", "OK"},
    };
    ASSERT_DIALOGUE("lua/layouts/centring.lua", dialogue);
}

/* A STOP that comes too late for the command waits for the next one. */
static void a_stop_that_comes_too_late(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"ALARM 52", "OK fault=17"},
        {"HOME", "OK seconds=0"},
        {"MOVE theta=50", "ERROR 52 STOPPED: "},
        {"HOME", "OK seconds=0.175"},
        {"MOVE theta=50", "OK seconds="},
    };
    ASSERT_DIALOGUE("lua/layouts/paper.lua", dialogue);
}

/* A plunger that has to go back first is not slowed for an error of its closing. */
static void a_plunger_that_is_not_open(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"GET A 1", "OK wafer=W01"},
        {"ALARM 89", "OK fault=17"},
        {"PUT B 1", "ERROR 89 UNGRIP_TIMEOUT: "},
        {"ALARM 88", "OK fault=17"},
        {"GET A 2", "OK wafer=W02"},
        {"PUT A 2", "OK wafer=W02"},
        {"GET A 2", "ERROR 88 GRIP_TIMEOUT: "},
    };
    ASSERT_DIALOGUE("lua/layouts/edge.lua", dialogue);
}

/* LIFT and CALIBRATE move an axis, too. */
static void what_moves_at_an_aligner(void **state) {
    (void)state;
    static const exchange_t lifts[] = {
        {"ALARM 53", "OK fault=17"},  {"LIFT P UP", "ERROR 53 OUT_OF_BUDGET: "},
        {"ALARM 48", "OK fault=17"},  {"LIFT P UP", "ERROR 48 BAD_ARGUMENT: "},
        {"ALARM 40", "OK fault=17"},  {"LIFT P UP", "ERROR 40 NO_SUCH_STATION: "},
        {"LIFT P UP", "OK seconds="},
    };
    static const exchange_t calibrations[] = {
        {"ALARM 75", "OK fault=17"}, {"CALIBRATE P", "ERROR 75 CENTRE_NOT_SURE: "},
        {"ALARM 49", "OK fault=17"}, {"CALIBRATE P", "ERROR 49 NOT_A_PREALIGNER: "},
        {"ALARM 53", "OK fault=17"}, {"CALIBRATE P", "ERROR 53 OUT_OF_BUDGET: "},
    };
    ASSERT_DIALOGUE("lua/layouts/stage.lua", lifts);
    ASSERT_DIALOGUE("lua/layouts/calibrate.lua", calibrations);
}

/* RESTORE and UNDO bring back each armed error for the controller that armed it. */
static void a_restored_error_waits_for_its_own_controller(void **state) {
    (void)state;
    static const struct {
        int32_t controller;
        const char *line, *answer;
    } dialogue[] = {
        {1, "ALARM 20", "OK fault=17"},
        {0, "SAVE one", "OK"},
        {0, "CLEAR 17", "OK"},
        {2, "ALARM 20", "OK fault=17"},
        {0, "SAVE two", "OK"},
        {0, "RESTORE one", "OK"},
        {2, "HOME", "OK"},
        {1, "HOME", "ERROR 20 BAD_LIMITS: "},
        {0, "RESTORE two", "OK"},
        {1, "HOME", "OK"},
        {2, "HOME", "ERROR 20 BAD_LIMITS: "},
        {0, "UNDO", "OK"},
        {1, "HOME", "OK"},
        {2, "HOME", "ERROR 20 BAD_LIMITS: "},
    };
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua", .limits = {.print_to = stderr}};
    assert_true(wh_session_open(&session, &options));
    for (size_t i = 0; i < sizeof dialogue / sizeof dialogue[0]; ++i) {
        const wh_mcs_asker_t asker = {.controller = dialogue[i].controller};
        (void)wh_session_execute_for(&session, &asker, dialogue[i].line, answer, sizeof answer);
        if (strncmp(answer, dialogue[i].answer, strlen(dialogue[i].answer)) != 0) {
            fail_msg("%zu: %s: answered %s, expected %s", i, dialogue[i].line, answer, dialogue[i].answer);
        }
    }
    wh_session_close(&session);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(status_tells_what_a_completion_told),
        cmocka_unit_test(a_put_that_centres),
        cmocka_unit_test(a_stop_that_comes_too_late),
        cmocka_unit_test(a_plunger_that_is_not_open),
        cmocka_unit_test(what_moves_at_an_aligner),
        cmocka_unit_test(a_restored_error_waits_for_its_own_controller),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
