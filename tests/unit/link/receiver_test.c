/* Datagrams as a hostile network sends them, over a pair of sockets, and URLs with typing errors. */
#include "support/support.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "link/receiver.h"

static wh_receiver_t receiver;
static wh_received_t message;
static int network;

static int open_pair(void **state) {
    (void)state;
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) != 0) {
        return -1;
    }
    receiver.socket = ends[0];
    network = ends[1];
    receiver.dropped = 0;
    return 0;
}

static int close_pair(void **state) {
    (void)state;
    wh_receiver_close(&receiver);
    return close(network);
}

static void arrives(const char *datagram, size_t size) {
    assert_int_equal(send(network, datagram, size, 0), size);
}

static void a_whole_message_is_handed_on(void **state) {
    (void)state;
    arrives("LC02\0\0\0\7CHANNEL\0data", 20);
    assert_true(wh_receiver_take(&receiver, &message));
    assert_string_equal(message.channel, "CHANNEL");
    assert_int_equal(message.size, 4);
    assert_memory_equal(message.data, "data", 4);
    assert_false(wh_receiver_take(&receiver, &message));
    assert_int_equal(receiver.dropped, 0);
}

static void a_message_may_be_empty_and_its_channel_63_bytes(void **state) {
    (void)state;
    char datagram[8 + 64] = "LC02";
    memset(datagram + 8, 'c', 63);
    arrives(datagram, sizeof datagram);
    assert_true(wh_receiver_take(&receiver, &message));
    assert_int_equal(strlen(message.channel), 63);
    assert_int_equal(message.size, 0);
}

static void what_is_no_whole_message_is_dropped(void **state) {
    (void)state;
    char long_name[8 + 65] = "LC02";
    memset(long_name + 8, 'c', 64);
    arrives("LC02\0\0\0\7CHANNEL", 15);
    arrives("LC02\0\0\0\7", 8);
    arrives("LC02", 4);
    arrives("LC03\0\0\0\1\0\1\206\240\377\377\377\360\0\1\0\3xxxx", 24);
    arrives("XXXX\0\0\0\7CHANNEL\0data", 20);
    arrives(long_name, sizeof long_name);
    arrives("LC02\0\0\0\7NEXT\0", 13);
    assert_true(wh_receiver_take(&receiver, &message));
    assert_string_equal(message.channel, "NEXT");
    assert_int_equal(receiver.dropped, 6);
}

static void a_flood_of_garbage_leaves_the_caller_its_turn(void **state) {
    (void)state;
    for (int sent = 0; sent < WH_RECEIVER_MOST; ++sent) {
        (void)send(network, "LC03", 4, MSG_DONTWAIT);
        if (sent % 8 == 7) {
            assert_false(wh_receiver_take(&receiver, &message));
        }
    }
    assert_int_equal(receiver.dropped, WH_RECEIVER_MOST);
}

static char problem[WH_MULTICAST_PROBLEM_BYTES];

static void an_url_tells_address_port_and_buffer(void **state) {
    (void)state;
    wh_multicast_t group;
    assert_true(wh_multicast_parse("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000", &group, problem));
    assert_int_equal(ntohl(group.address), 0xefff4c43);
    assert_int_equal(group.port, 7667);
    assert_int_equal(group.buffer_bytes, 1000);
    assert_true(wh_multicast_parse("udpm://239.255.76.67:7667", &group, problem));
    assert_true(wh_multicast_parse("udpm://239.255.76.67:7667?ttl=255", &group, problem));
    assert_true(wh_multicast_parse("udpm://239.255.76.67:1?recv_buf_size=0", &group, problem));
    assert_true(wh_multicast_is("udpm://"));
    assert_false(wh_multicast_is("memq://"));
}

static void a_wrong_part_of_an_url_is_named_with_its_value_and_what_was_expected(void **state) {
    (void)state;
    static const struct {
        const char *url, *said;
    } cases[] = {
        {"udpm://", "address: nothing (expected one of multicast"},
        {"udpm://:7667", "address: nothing ("},
        {"udpm://10.0.0.1:7667", "address: 10.0.0.1 ("},
        {"udpm://239.255.76:7667", "address: 239.255.76 ("},
        {"udpm://host:7667", "address: host ("},
        {"udpm://239.255.76.67", "port: nothing (expected 1 to 65535"},
        {"udpm://239.255.76.67:", "port: nothing ("},
        {"udpm://239.255.76.67?ttl=0", "port: nothing ("},
        {"udpm://239.1.1.1:0", "port: 0 ("},
        {"udpm://239.1.1.1:65536", "port: 65536 ("},
        {"udpm://239.1.1.1:99999999999999999999", "port: 99999999999999999999 ("},
        {"udpm://239.1.1.1:12x?ttl=0", "port: 12x ("},
        {"udpm://239.1.1.1:-1", "port: -1 ("},
        {"udpm://239.1.1.1:1?ttl=-1", "ttl: -1 (expected a whole number from 0 to 255)"},
        {"udpm://239.1.1.1:1?ttl=256", "ttl: 256 ("},
        {"udpm://239.1.1.1:1?ttl=abc", "ttl: abc ("},
        {"udpm://239.1.1.1:1?ttl=1x", "ttl: 1x ("},
        {"udpm://239.1.1.1:1?ttl=010", "ttl: 010 ("},
        {"udpm://239.1.1.1:1?ttl=", "ttl: nothing ("},
        {"udpm://239.1.1.1:1?ttl", "ttl: nothing ("},
        {"udpm://239.1.1.1:1?ttl=0&recv_buf_size=-5", "recv_buf_size: -5 (expected a whole number of bytes"},
        {"udpm://239.1.1.1:1?recv_buf_size=2147483648", "recv_buf_size: 2147483648 ("},
        {"udpm://239.1.1.1:1?tll=0", "tll: 0 (expected ttl=... or recv_buf_size=..."}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        wh_multicast_t group;
        if (wh_multicast_parse(cases[i].url, &group, problem)) {
            fail_msg("%s is taken", cases[i].url);
        }
        if (strncmp(problem, cases[i].said, strlen(cases[i].said)) != 0) {
            fail_msg("%s: %s", cases[i].url, problem);
        }
    }
}

/* The value has no meaning: only the difference counts. */
static void a_message_tells_which_socket_it_came_from(void **state) {
    (void)state;
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof place;
    uint64_t senders[2];
    int from[2];
    receiver.socket = socket(AF_INET, SOCK_DGRAM, 0);
    assert_int_equal(bind(receiver.socket, (const struct sockaddr *)&place, sizeof place), 0);
    assert_int_equal(getsockname(receiver.socket, (struct sockaddr *)&place, &size), 0);
    for (size_t i = 0; i < 2; ++i) {
        from[i] = socket(AF_INET, SOCK_DGRAM, 0);
        for (int sent = 0; sent < 2; ++sent) {
            assert_int_equal(sendto(from[i], "LC02\0\0\0\7C\0", 10, 0, (const struct sockaddr *)&place, size),
                             10);
            assert_true(wh_receiver_take(&receiver, &message));
            assert_true(sent == 0 || senders[i] == message.sender);
            senders[i] = message.sender;
        }
    }
    (void)close(from[0]);
    (void)close(from[1]);
    assert_true(senders[0] != 0 && senders[0] != senders[1]);
    wh_receiver_close(&receiver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_whole_message_is_handed_on, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(a_message_may_be_empty_and_its_channel_63_bytes, open_pair,
                                        close_pair),
        cmocka_unit_test_setup_teardown(what_is_no_whole_message_is_dropped, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(a_flood_of_garbage_leaves_the_caller_its_turn, open_pair, close_pair),
        cmocka_unit_test(an_url_tells_address_port_and_buffer),
        cmocka_unit_test(a_wrong_part_of_an_url_is_named_with_its_value_and_what_was_expected),
        cmocka_unit_test(a_message_tells_which_socket_it_came_from),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
