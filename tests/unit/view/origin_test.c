/* Only the page itself may ask its server. */
#include "support/support.h"

#include "view/origin.h"

static bool accepts(const char *place, const wh_origin_headers_t *headers, bool is_page) {
    wh_address_t address;
    assert_true(wh_address_read(place, &address));
    return !wh_origin_refusal(&address, headers, is_page);
}

static bool accepts_host(const char *place, const char *host) {
    const wh_origin_headers_t headers = {.host = host};
    return accepts(place, &headers, true);
}

static void hosts_of_a_place_here_alone(void **state) {
    static const char *const good[] = {"127.0.0.1:8765", "localhost:8765", "LocalHost:8765", "[::1]:8765",
                                       "127.9.9.9:8765"};
    static const char *const bad[] = {"",
                                      "127.0.0.1",
                                      "127.0.0.1:8766",
                                      "evil:8765",
                                      "localhost",
                                      "localhost.:8765",
                                      "localhost.evil:8765",
                                      "127.0.0.1.evil:8765",
                                      "10.0.0.1:8765",
                                      "[::2]:8765",
                                      "[::1:8765",
                                      "::1:8765",
                                      "127.0.0.1:08765",
                                      "127.0.0.1:8765x",
                                      "0x7f.1:8765",
                                      "127.1:8765",
                                      "2130706433:8765",
                                      "127.0.0.1:8765,evil",
                                      " 127.0.0.1:8765",
                                      "@127.0.0.1:8765"};
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; ++i) {
        assert_true(accepts_host("127.0.0.1:8765", good[i]));
        assert_true(accepts_host("[::1]:8765", good[i]));
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_false(accepts_host("127.0.0.1:8765", bad[i]));
        assert_false(accepts_host("[::1]:8765", bad[i]));
    }
    assert_false(accepts_host("127.0.0.1:8765", NULL));
}

static void hosts_of_other_places(void **state) {
    (void)state;
    assert_true(accepts_host("10.0.0.7:80", "10.0.0.7"));
    assert_true(accepts_host("10.0.0.7:80", "10.0.0.7:80"));
    assert_true(accepts_host("[fe80::1]:80", "[fe80::1]"));
    assert_false(accepts_host("10.0.0.7:80", "localhost"));
    assert_false(accepts_host("10.0.0.7:80", "10.0.0.8"));
    assert_false(accepts_host("10.0.0.7:80", "127.0.0.1"));
    assert_true(accepts_host("0.0.0.0:8000", "10.0.0.7:8000"));
    assert_true(accepts_host("[::]:8000", "[fe80::1]:8000"));
    assert_true(accepts_host("[::]:8000", "localhost:8000"));
    assert_false(accepts_host("0.0.0.0:8000", "robot.example:8000"));
    assert_false(accepts_host("0.0.0.0:8000", "10.0.0.7"));
}

static void origins(void **state) {
    static const char *const bad[] = {"null",
                                      "",
                                      "http://",
                                      "http://evil",
                                      "https://127.0.0.1:1",
                                      "127.0.0.1:1",
                                      "http://127.0.0.1:1/",
                                      "http://127.0.0.1:1.evil",
                                      "http://127.0.0.1:2"};
    (void)state;
    wh_origin_headers_t headers = {.host = "127.0.0.1:1", .origin = "http://127.0.0.1:1"};
    assert_true(accepts("127.0.0.1:1", &headers, false));
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        headers.origin = bad[i];
        assert_false(accepts("127.0.0.1:1", &headers, false));
        assert_false(accepts("127.0.0.1:1", &headers, true));
    }
}

/* Another site may link to the page, and do nothing else. */
static void other_sites(void **state) {
    (void)state;
    wh_origin_headers_t headers = {.host = "127.0.0.1:1", .site = "same-origin", .mode = "cors"};
    assert_true(accepts("127.0.0.1:1", &headers, false));
    headers.site = "none";
    assert_true(accepts("127.0.0.1:1", &headers, false));
    headers.site = "cross-site";
    assert_false(accepts("127.0.0.1:1", &headers, true));
    headers.mode = "navigate";
    assert_true(accepts("127.0.0.1:1", &headers, true));
    assert_false(accepts("127.0.0.1:1", &headers, false));
    headers.mode = NULL;
    assert_false(accepts("127.0.0.1:1", &headers, true));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hosts_of_a_place_here_alone),
        cmocka_unit_test(hosts_of_other_places),
        cmocka_unit_test(origins),
        cmocka_unit_test(other_sites),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
