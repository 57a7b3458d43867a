/* Errors on purpose, at what can answer them and at nothing else. */
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
        if (strncmp(answer, dialogue[i].answer, strlen(dialogue[i].answer)) != 0) {
            fail_msg("%s: answered %s, expected %s", dialogue[i].line, answer, dialogue[i].answer);
        }
    }
    wh_session_close(&session);
}

#define ASSERT_DIALOGUE(layout, dialogue)                                                                    \
    assert_dialogue(layout, dialogue, sizeof(dialogue) / sizeof(dialogue)[0])

/* What beams cannot tell is answered by the PUT that asks them. One that does not leaves the error waiting. */
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_put_that_centres)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
