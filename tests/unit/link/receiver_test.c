/* Datagrams as a hostile network sends them, over a pair of sockets, and URLs as people mistype them. */
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

static void an_url_tells_address_port_and_buffer(void **state) {
    (void)state;
    wh_multicast_t group;
    assert_null(wh_multicast_parse("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000", &group));
    assert_int_equal(ntohl(group.address), 0xefff4c43);
    assert_int_equal(group.port, 7667);
    assert_int_equal(group.buffer_bytes, 1000);
    assert_true(wh_multicast_is("udpm://"));
    assert_false(wh_multicast_is("memq://"));
}

static void an_url_without_address_or_port_is_refused(void **state) {
    (void)state;
    static const char *const urls[] = {"udpm://",
                                       "udpm://:7667",
                                       "udpm://10.0.0.1:7667",
                                       "udpm://239.255.76:7667",
                                       "udpm://host:7667",
                                       "udpm://239.255.76.67",
                                       "udpm://239.255.76.67:",
                                       "udpm://239.255.76.67?ttl=0",
                                       "udpm://239.1.1.1:0",
                                       "udpm://239.1.1.1:65536",
                                       "udpm://239.1.1.1:12x?ttl=0",
                                       "udpm://239.1.1.1:-1"};
    for (size_t i = 0; i < sizeof urls / sizeof urls[0]; ++i) {
        wh_multicast_t group;
        const char *expected = wh_multicast_parse(urls[i], &group);
        if (!expected) {
            fail_msg("%s is taken", urls[i]);
        }
        assert_ptr_equal(strstr(expected, "expected"), expected);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_whole_message_is_handed_on, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(a_message_may_be_empty_and_its_channel_63_bytes, open_pair,
                                        close_pair),
        cmocka_unit_test_setup_teardown(what_is_no_whole_message_is_dropped, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(a_flood_of_garbage_leaves_the_caller_its_turn, open_pair, close_pair),
        cmocka_unit_test(an_url_tells_address_port_and_buffer),
        cmocka_unit_test(an_url_without_address_or_port_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
