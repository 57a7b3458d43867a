/* A host without a port while its session is being opened, and one whose clients follow each other at once. */
#include "host/host.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

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

/* -------------------------------------------------------------------------------------------- clients */

static int connect_to_port(const wh_host_t *host) {
    const char *place = host->controllers[0]->line.port.place;
    const struct sockaddr_in at = {.sin_family = AF_INET,
                                   .sin_port = htons((uint16_t)atoi(strrchr(place, ':') + 1)),
                                   .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    assert_int_equal(connect(fd, (const struct sockaddr *)&at, sizeof at), 0);
    return fd;
}

/* Serves until this number of clients has come, for at most ten seconds. */
static void serve_until(wh_host_t *host, uint64_t clients) {
    for (int i = 0; i < 10000 && host->controllers[0]->line.port.counters.clients < clients; ++i) {
        wh_host_wait(host);
        (void)usleep(1000);
    }
    assert_int_equal(host->controllers[0]->line.port.counters.clients, clients);
}

/* The part of a frame that a client sent last is told, before its departure, also where the next client has
 * come in the meantime. */
static void it_tells_the_rest_of_a_client_that_left(void **state) {
    (void)state;
    static wh_session_t session;
    static char said[4096];
    volatile sig_atomic_t stop = 0;
    FILE *transcript = fmemopen(said, sizeof said, "w");
    wh_host_t host = {.session = &session, .stop = &stop, .transcript = transcript};
    const wh_host_port_t port = {.dialect = "lua/dialects/prompt.lua", .address = "0"};
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua",
                                          .limits = {.print_to = stderr},
                                          .listener = wh_host_listener(&host)};
    assert_true(wh_session_open(&session, &options));
    assert_true(wh_host_add(&host, &port));
    const int first = connect_to_port(&host);
    serve_until(&host, 1);
    assert_int_equal(write(first, "VERS", 4), 4);
    for (int i = 0; i < 10000 && host.controllers[0]->line.port.counters.received < 4; ++i) {
        wh_host_wait(&host);
    }
    assert_int_equal(close(first), 0);
    const int second = connect_to_port(&host);
    serve_until(&host, 2);
    assert_int_equal(fclose(transcript), 0);
    host.transcript = NULL;
    assert_string_equal(said, "0 0.000000 + cell\n0 0.000000 > cell \"VERS\"\n"
                              "0 0.000000 < cell \"ERROR 48 BAD_ARGUMENT: no line: no end\\n\"\n"
                              "0 0.000000 - cell\n0 0.000000 + cell\n");
    assert_int_equal(close(second), 0);
    wh_host_close(&host);
    wh_session_close(&session);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_stops_before_its_first_port),
                                       cmocka_unit_test(it_tells_the_rest_of_a_client_that_left)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
