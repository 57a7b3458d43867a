/* Addresses that may connect. */
#include "host/allow.h"

#include <arpa/inet.h>
#include <string.h>
#include <sys/socket.h>

#include "support/support.h"

static bool has(const wh_allow_t *allow, const char *text) {
    struct sockaddr_in four = {.sin_family = AF_INET};
    struct sockaddr_in6 six = {.sin6_family = AF_INET6};
    if (inet_pton(AF_INET, text, &four.sin_addr) == 1) {
        return wh_allow_has(allow, (const struct sockaddr *)&four);
    }
    assert_int_equal(inet_pton(AF_INET6, text, &six.sin6_addr), 1);
    return wh_allow_has(allow, (const struct sockaddr *)&six);
}

static void this_machine_always_may(void **state) {
    (void)state;
    const wh_allow_t none = {.count = 0};
    assert_true(has(&none, "127.0.0.1"));
    assert_true(has(&none, "127.9.8.7"));
    assert_true(has(&none, "::1"));
    assert_true(has(&none, "::ffff:127.0.0.1"));
    assert_false(has(&none, "126.0.0.1"));
    assert_false(has(&none, "::2"));
}

static void addresses_and_nets(void **state) {
    (void)state;
    wh_allow_t allow = {.count = 0};
    assert_true(wh_allow_add(&allow, "192.168.0.7"));
    assert_true(wh_allow_add(&allow, "10.1.0.0/15"));
    assert_true(wh_allow_add(&allow, "fe80::/10"));
    assert_true(has(&allow, "192.168.0.7"));
    assert_true(has(&allow, "::ffff:192.168.0.7"));
    assert_false(has(&allow, "192.168.0.6"));
    assert_true(has(&allow, "10.0.255.255"));
    assert_true(has(&allow, "10.1.2.3"));
    assert_false(has(&allow, "10.2.0.0"));
    assert_true(has(&allow, "febf::1"));
    assert_false(has(&allow, "fec0::1"));
}

static void texts_that_are_no_address(void **state) {
    (void)state;
    static const char *const bad[] = {"",           "a",         "1.2.3",   "1.2.3.4/33",
                                      "1.2.3.4/",   "1.2.3.4/x", "::1/129", "1.2.3.4/-1",
                                      "1.2.3.4/ 8", "1.2.3.4 ",  "/8",      "::1/8x"};
    wh_allow_t allow = {.count = 0};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_false(wh_allow_add(&allow, bad[i]));
    }
    assert_int_equal(allow.count, 0);
    for (size_t i = 0; i < WH_ALLOW_MOST; ++i) {
        assert_true(wh_allow_add(&allow, "1.2.3.4"));
    }
    assert_false(wh_allow_add(&allow, "1.2.3.4"));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(this_machine_always_may),
                                       cmocka_unit_test(addresses_and_nets),
                                       cmocka_unit_test(texts_that_are_no_address)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
