/* Cells with several robots, with two arms or wrists: each axis has a name of its own and moves by itself. */
#include "support/support.h"

#include "mcs/session.h"

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

static void assert_says(const char *line, const char *begins, const char *has) {
    (void)wh_session_execute(&session, line, answer, sizeof answer);
    if (strncmp(answer, begins, strlen(begins)) != 0 || !strstr(answer, has)) {
        fail_msg("%s: answered %s, expected %s ... %s", line, answer, begins, has);
    }
}

static void the_second_arm_has_its_own_name(void **state) {
    (void)state;
    const wh_session_options_t options = {.layout = "lua/layouts/tool.lua", .limits = {.print_to = stderr}};
    assert_true(wh_session_open(&session, &options));
    assert_says("AXES", "OK ", " VAC.r=300 ");
    assert_says("AXES", "OK ", " VAC.r2=300");
    assert_says("MOVE r2=400 robot=VAC", "OK seconds=", "");
    assert_says("AXES", "OK ", " VAC.r=300 ");
    assert_says("AXES", "OK ", " VAC.r2=400");
    assert_says("MOVE r=420 robot=VAC", "OK seconds=", "");
    assert_says("AXES", "OK ", " VAC.r=420 ");
    assert_says("AXES", "OK ", " VAC.r2=400");
    wh_session_close(&session);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_second_arm_has_its_own_name)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
