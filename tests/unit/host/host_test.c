/* A host that has no port yet: a stop, the end and a wait come while the session is still being opened. */
#include "host/host.h"

#include "support/support.h"

#include "mcs/session.h"

static void it_stops_before_its_first_port(void **state) {
    (void)state;
    static wh_session_t session;
    volatile sig_atomic_t stop = 0;
    wh_host_t host = {.session = &session, .stop = &stop};
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua",
                                          .limits = {.print_to = stderr},
                                          .listener = wh_host_listener(&host)};
    assert_true(wh_session_open(&session, &options));
    wh_host_wait(&host);
    wh_host_stop(&host);
    assert_false(host.is_ended);
    wh_host_end(&host);
    assert_true(host.is_ended);
    wh_host_close(&host);
    wh_session_close(&session);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_stops_before_its_first_port)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
