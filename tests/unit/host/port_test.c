/* A port's clients over TCP and pty: late, gone, back again, a second one, stalling, deaf, and with
 * more bytes than the ring takes; and the host of a transcript in their place. */
#include "host/port.h"
#include "support/support.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

static wh_port_t port;
static char problem[WH_PORT_PROBLEM_BYTES];

static int connect_to_port(void) {
    const struct sockaddr_in at = {.sin_family = AF_INET,
                                   .sin_port = htons((uint16_t)atoi(strrchr(port.place, ':') + 1)),
                                   .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    assert_int_equal(connect(fd, (const struct sockaddr *)&at, sizeof at), 0);
    return fd;
}

/* Serves until something happens, for at most a second. */
static unsigned serve(void) {
    unsigned told = 0;
    for (int i = 0; i < 1000 && told == 0; ++i) {
        struct pollfd polls[WH_PORT_POLLS];
        (void)poll(polls, wh_port_polls(&port, polls), 1);
        told = wh_port_serve(&port);
    }
    return told;
}

static void assert_idle(void) {
    for (int i = 0; i < 20; ++i) {
        assert_int_equal(wh_port_serve(&port), 0);
    }
}

/* Serves until this number of bytes is there, and takes them. */
static void assert_input(const char *expected) {
    char bytes[200] = "";
    for (int i = 0; i < 1000 && port.input.count < strlen(expected); ++i) {
        struct pollfd polls[WH_PORT_POLLS];
        (void)poll(polls, wh_port_polls(&port, polls), 1);
        (void)wh_port_serve(&port);
    }
    (void)wh_ring_take(&port.input, bytes, sizeof bytes - 1);
    assert_string_equal(bytes, expected);
}

static void assert_hears(int fd, const char *expected) {
    char bytes[200] = "";
    size_t size = 0;
    while (size < strlen(expected)) {
        const ssize_t got = read(fd, bytes + size, sizeof bytes - 1 - size);
        assert_true(got > 0);
        size += (size_t)got;
    }
    assert_string_equal(bytes, expected);
}

static void send_text(int fd, const char *text) {
    assert_int_equal(write(fd, text, strlen(text)), strlen(text));
}

/* ---------------------------------------------------------------------------------------------------- rings */

static void rings(void **state) {
    (void)state;
    static wh_ring_t ring;
    static uint8_t bytes[WH_RING_BYTES];
    size_t size = 0;
    uint64_t put = 0;
    uint64_t taken = 0;
    assert_null(wh_ring_front(&ring, &size));
    for (int round = 0; round < 20000 / WH_TEST_SHARE; ++round) {
        const size_t count = wh_test_below(round % 50 == 0 ? WH_RING_BYTES : 3000);
        for (size_t i = 0; i < count; ++i) {
            bytes[i] = (uint8_t)((put + i) * 31 >> 3);
        }
        const size_t before = ring.count;
        const bool has_room = count <= WH_RING_BYTES - before;
        assert_int_equal(wh_ring_put(&ring, bytes, count), has_room);
        assert_int_equal(ring.count, before + (has_room ? count : 0));
        put += has_room ? count : 0;
        const size_t most = wh_test_below(3100);
        const size_t got = wh_ring_take(&ring, bytes, most);
        assert_int_equal(got, most < put - taken ? most : put - taken);
        for (size_t i = 0; i < got; ++i) {
            assert_int_equal(bytes[i], (uint8_t)((taken + i) * 31 >> 3));
        }
        taken += got;
    }
    wh_ring_drop(&ring, SIZE_MAX);
    assert_true(wh_ring_put(&ring, bytes, sizeof bytes));
    assert_null(wh_ring_back(&ring, &size));
    assert_false(wh_ring_put(&ring, bytes, 1));
}

/* ------------------------------------------------------------------------------------------------------ TCP */

static void dialogue(void **state) {
    (void)state;
    assert_true(wh_port_open_tcp(&port, "0", WH_PORT_REFUSE, problem));
    assert_true(port.is_local);
    assert_memory_equal(port.place, "127.0.0.1:", 10);
    assert_int_equal(wh_port_send(&port, "lost", 4), 0);
    assert_int_equal(port.counters.lost, 4);
    assert_idle();
    for (int round = 0; round < 3; ++round) {
        const int client = connect_to_port();
        assert_int_equal(serve(), WH_PORT_CAME);
        send_text(client, "HO");
        assert_input("HO");
        send_text(client, "ME\r\n");
        assert_input("ME\r\n");
        assert_int_equal(wh_port_send(&port, "ok\r\n", 4), 0);
        assert_hears(client, "ok\r\n");
        send_text(client, "half");
        assert_int_equal(close(client), 0);
        assert_int_equal(serve(), WH_PORT_WENT);
        assert_input("half");
        assert_idle();
    }
    assert_int_equal(port.counters.clients, 3);
    assert_int_equal(port.counters.received, 3 * 10);
    assert_int_equal(port.counters.sent, 3 * 4);
    wh_port_close(&port);
    wh_port_close(&port);
}

/* A client that has sent its last byte still gets the answer, until another client comes or it is gone. */
static void half_closed(void **state) {
    (void)state;
    assert_true(wh_port_open_tcp(&port, "127.0.0.1:0", WH_PORT_REFUSE, problem));
    const int client = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    send_text(client, "STATUS\n");
    assert_int_equal(shutdown(client, SHUT_WR), 0);
    assert_int_equal(serve(), WH_PORT_WENT);
    assert_input("STATUS\n");
    assert_true(wh_port_is_heard(&port));
    assert_int_equal(wh_port_send(&port, "idle\n", 5), 0);
    assert_hears(client, "idle\n");
    const int next = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    char byte = 0;
    assert_int_equal(read(client, &byte, 1), 0);
    assert_int_equal(close(client), 0);
    assert_int_equal(port.counters.taken, 0);
    /* A reset after the end is detected too, and not reported a second time. */
    assert_int_equal(shutdown(next, SHUT_WR), 0);
    assert_int_equal(serve(), WH_PORT_WENT);
    const struct linger reset = {.l_onoff = 1};
    assert_int_equal(setsockopt(next, SOL_SOCKET, SO_LINGER, &reset, sizeof reset), 0);
    assert_int_equal(close(next), 0);
    assert_idle();
    assert_false(wh_port_is_heard(&port));
    wh_port_close(&port);
}

/* `printf ... | nc -N` wants the end only once its bytes were taken and it was answered. */
static void who_sends_no_more_sees_the_end(void **state) {
    (void)state;
    assert_true(wh_port_open_tcp(&port, "127.0.0.1:0", WH_PORT_REFUSE, problem));
    const int client = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    wh_port_end_done(&port);
    assert_true(wh_port_is_heard(&port));
    send_text(client, "STATUS\n");
    assert_int_equal(shutdown(client, SHUT_WR), 0);
    assert_int_equal(serve(), WH_PORT_WENT);
    wh_port_end_done(&port);
    assert_true(wh_port_is_heard(&port));
    assert_input("STATUS\n");
    assert_int_equal(wh_port_send(&port, "idle\n", 5), 0);
    wh_port_end_done(&port);
    assert_false(wh_port_is_heard(&port));
    assert_hears(client, "idle\n");
    char byte = 0;
    assert_int_equal(read(client, &byte, 1), 0);
    assert_int_equal(close(client), 0);
    wh_port_close(&port);
}

static void second_client(void **state) {
    (void)state;
    char byte = 0;
    assert_true(wh_port_open_tcp(&port, "0", WH_PORT_REFUSE, problem));
    int first = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    /* A client that hung up just before is not the first one. */
    assert_int_equal(close(first), 0);
    first = connect_to_port();
    assert_int_equal(serve(), WH_PORT_WENT | WH_PORT_CAME);
    int second = connect_to_port();
    assert_int_equal(serve(), WH_PORT_REFUSED);
    assert_int_equal(read(second, &byte, 1), 0);
    send_text(first, "A");
    assert_input("A");
    assert_int_equal(close(second), 0);
    assert_int_equal(close(first), 0);
    wh_port_close(&port);

    assert_true(wh_port_open_tcp(&port, "0", WH_PORT_TAKEOVER, problem));
    first = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    send_text(first, "A");
    while (port.input.count == 0) {
        assert_int_equal(wh_port_serve(&port), 0);
    }
    second = connect_to_port();
    send_text(second, "B");
    assert_int_equal(serve(), WH_PORT_WENT | WH_PORT_TAKEN);
    assert_int_equal(read(first, &byte, 1), 0);
    /* Not before the first client's bytes are read. Bytes sent in the meantime reach nobody. */
    assert_idle();
    assert_int_equal(wh_port_send(&port, "a", 1), 0);
    assert_true(wh_port_asks(&port));
    assert_input("A");
    assert_int_equal(serve(), WH_PORT_CAME);
    assert_input("B");
    assert_int_equal(wh_port_send(&port, "b", 1), 0);
    assert_hears(second, "b");
    assert_int_equal(close(second), 0);
    assert_int_equal(close(first), 0);
    wh_port_close(&port);
}

/* A megabyte that nobody reads: the ring holds 64 kB, the rest waits in the system or with the client. */
/* A place that two clients may share: the first one comes to the first port, whichever is served before. */
static void clients_that_share(void **state) {
    (void)state;
    static wh_port_t other;
    assert_true(wh_port_open_tcp(&port, "0", WH_PORT_SHARE, problem));
    assert_true(wh_port_open_beside(&other, &port, problem));
    const int first = connect_to_port();
    const int second = connect_to_port();
    for (int i = 0; i < 20; ++i) {
        assert_int_equal(wh_port_serve(&other), 0);
    }
    assert_int_equal(serve(), WH_PORT_CAME);
    assert_int_equal(wh_port_serve(&other), WH_PORT_CAME);
    assert_int_equal(wh_port_send(&port, "1", 1) | wh_port_send(&other, "2", 1), 0);
    assert_hears(first, "1");
    assert_hears(second, "2");
    (void)close(first);
    (void)close(second);
    wh_port_close(&other);
    wh_port_close(&port);
}

static void full_input(void **state) {
    (void)state;
    static char bytes[1 << 20];
    assert_true(wh_port_open_tcp(&port, "0", WH_PORT_REFUSE, problem));
    const int client = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    assert_int_equal(fcntl(client, F_SETFL, O_NONBLOCK), 0);
    size_t sent = 0;
    size_t got = 0;
    memset(bytes, 'x', sizeof bytes);
    for (int i = 0; i < 100000 && got < sizeof bytes; ++i) {
        const ssize_t size = write(client, bytes + sent, sizeof bytes - sent);
        sent += size > 0 ? (size_t)size : 0;
        assert_int_equal(wh_port_serve(&port), 0);
        if (i == 50) {
            struct pollfd polls[WH_PORT_POLLS];
            assert_int_equal(port.input.count, WH_RING_BYTES);
            assert_true(wh_port_asks(&port));
            assert_int_equal(wh_port_polls(&port, polls), 1);
        }
        if (i > 50) {
            got += wh_ring_take(&port.input, bytes, 1000 + WH_RING_BYTES * (size_t)(i % 2));
        }
    }
    assert_int_equal(got, sizeof bytes);
    assert_int_equal(close(client), 0);
    wh_port_close(&port);
}

/* A client that reads nothing is closed when its ring is full; the port goes on. */
static void deaf_client(void **state) {
    (void)state;
    static char bytes[4096];
    assert_true(wh_port_open_tcp(&port, "0", WH_PORT_REFUSE, problem));
    const int deaf = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    unsigned told = 0;
    for (int i = 0; i < 100000 && told == 0; ++i) {
        told = wh_port_send(&port, bytes, sizeof bytes);
    }
    assert_int_equal(told, WH_PORT_WENT | WH_PORT_CLOSED);
    assert_int_equal(port.counters.closed, 1);
    assert_false(wh_port_is_heard(&port));
    assert_int_equal(close(deaf), 0);
    const int next = connect_to_port();
    assert_int_equal(serve(), WH_PORT_CAME);
    assert_int_equal(wh_port_send(&port, "ok", 2), 0);
    assert_hears(next, "ok");
    /* A client that resets the connection is gone, and no signal comes. */
    const struct linger reset = {.l_onoff = 1};
    assert_int_equal(setsockopt(next, SOL_SOCKET, SO_LINGER, &reset, sizeof reset), 0);
    assert_int_equal(close(next), 0);
    assert_int_equal(serve(), WH_PORT_WENT);
    assert_int_equal(wh_port_send(&port, "ok", 2), 0);
    wh_port_close(&port);
}

static void addresses(void **state) {
    (void)state;
    static const char *const bad[] = {
        "",        ":5000",        "127.0.0.1:",  "127.0.0.1:65536", "localhost:5000",
        "x",       "-1",           "1.2.3:5000",  "::1:5000",        "[::1:5000",
        "[]:5000", "127.0.0.1:5x", "[1.2.3.4]:5", "127.0.0.1: 5"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        char expected[300];
        (void)snprintf(
            expected, sizeof expected,
            "%s: no address (expected ADDRESS:PORT in numbers, such as 127.0.0.1:5000, or PORT from 0 "
            "to 65535)",
            bad[i]);
        assert_false(wh_port_open_tcp(&port, bad[i], WH_PORT_REFUSE, problem));
        assert_string_equal(problem, expected);
    }
    assert_true(wh_port_open_tcp(&port, "0.0.0.0:0", WH_PORT_REFUSE, problem));
    assert_false(port.is_local);
    static wh_port_t second;
    char place[WH_PORT_PLACE_BYTES];
    (void)snprintf(place, sizeof place, "%s", port.place);
    assert_false(wh_port_open_tcp(&second, place, WH_PORT_REFUSE, problem));
    assert_non_null(strstr(problem, "Address already in use"));
    wh_port_close(&port);
    if (wh_port_open_tcp(&port, "[::1]:0", WH_PORT_REFUSE, problem)) {
        assert_true(port.is_local);
        assert_memory_equal(port.place, "[::1]:", 6);
        wh_port_close(&port);
    }
}

/* ------------------------------------------------------------------------------------------------------ pty */

static char folder[WH_TEST_PATH];
static char link_path[WH_TEST_PATH + 10];

static int open_pty(void **state) {
    (void)state;
    assert_non_null(mkdtemp(wh_test_path(folder, "port")));
    (void)snprintf(link_path, sizeof link_path, "%s/tty", folder);
    assert_true(wh_port_open_pty(&port, link_path, problem));
    return 0;
}

static int close_pty(void **state) {
    (void)state;
    wh_port_close(&port);
    assert_int_equal(access(link_path, F_OK), -1);
    return rmdir(folder);
}

static void pty_dialogue(void **state) {
    (void)state;
    assert_string_equal(port.place, link_path);
    assert_true(wh_port_asks(&port));
    assert_idle();
    for (int round = 0; round < 3; ++round) {
        const int client = open(link_path, O_RDWR | O_NOCTTY | O_CLOEXEC);
        assert_true(client >= 0);
        assert_int_equal(serve(), WH_PORT_CAME);
        assert_false(wh_port_asks(&port));
        /* Raw: no echo, no line discipline, every byte. */
        send_text(client, "A\r\n\x03\x11\x13\x04\x7f\xff");
        assert_input("A\r\n\x03\x11\x13\x04\x7f\xff");
        assert_int_equal(wh_port_send(&port, "\r\n\x1a\xff", 4), 0);
        assert_hears(client, "\r\n\x1a\xff");
        assert_int_equal(wh_port_send(&port, "never read", 10), 0);
        assert_int_equal(close(client), 0);
        assert_int_equal(serve(), WH_PORT_WENT);
        assert_idle();
    }
    /* If a client comes and goes between two looks, its bytes can be read; answers that nobody read
     * are gone. */
    int client = open(link_path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    send_text(client, "B\n");
    assert_int_equal(close(client), 0);
    assert_int_equal(serve(), WH_PORT_CAME);
    assert_int_equal(serve(), WH_PORT_WENT);
    assert_input("B\n");
    client = open(link_path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    char byte = 0;
    assert_int_equal(read(client, &byte, 1), -1);
    assert_int_equal(errno, EAGAIN);
    assert_int_equal(close(client), 0);
}

/* A pty is closed by making it anew: a client that had it open reads no more, and the link leads to
 * the new one. */
static void pty_deaf(void **state) {
    (void)state;
    static char bytes[4096];
    const int deaf = open(link_path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_int_equal(serve(), WH_PORT_CAME);
    unsigned told = 0;
    for (int i = 0; i < 100000 && told == 0; ++i) {
        told = wh_port_send(&port, bytes, sizeof bytes);
    }
    assert_int_equal(told, WH_PORT_WENT | WH_PORT_CLOSED);
    assert_int_equal(write(deaf, "x", 1), -1);
    const int next = open(link_path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_int_equal(serve(), WH_PORT_CAME);
    send_text(next, "HOME\n");
    assert_input("HOME\n");
    assert_int_equal(close(next), 0);
    assert_int_equal(close(deaf), 0);
}

static void pty_places(void **state) {
    (void)state;
    static wh_port_t second;
    char expected[400];
    (void)snprintf(expected, sizeof expected, "%s: File exists (expected a place for a new link)", link_path);
    assert_false(wh_port_open_pty(&second, link_path, problem));
    assert_string_equal(problem, expected);
    assert_int_equal(access(link_path, F_OK), 0);
    assert_false(wh_port_open_pty(&second, "/none/there", problem));
    assert_string_equal(problem, "/none/there: No such file or directory");
    static char longest[WH_PORT_PATH + 2];
    memset(longest, 'x', WH_PORT_PATH);
    assert_false(wh_port_open_pty(&second, longest, problem));
    assert_non_null(strstr(problem, "File name too long"));
    /* Another program's file in the link's place stays. */
    assert_int_equal(unlink(link_path), 0);
    assert_int_equal(symlink("/dev/null", link_path), 0);
    wh_port_close(&port);
    assert_int_equal(access(link_path, F_OK), 0);
    assert_int_equal(unlink(link_path), 0);
    /* A link that a killed server has left is no one's; a link to nowhere else stays. */
    assert_int_equal(symlink("/dev/pts/nobody", link_path), 0);
    assert_true(wh_port_open_pty(&second, link_path, problem));
    assert_int_equal(access(link_path, F_OK), 0);
    wh_port_close(&second);
    assert_int_equal(symlink("/nowhere/else", link_path), 0);
    assert_false(wh_port_open_pty(&second, link_path, problem));
    assert_string_equal(problem, expected);
    assert_int_equal(unlink(link_path), 0);
}

/* Entries come in their order among all ports, at their slices, and behind the answers before them. */
static void transcript_is_a_port(void **state) {
    (void)state;
    static const char text[] = "waferhand transcript 1\n\n0 0.000000 + a\n3 0.003000 > b \"GET\\n\"\n"
                               "5 0.005000 < b \"OK\\n\"\n5 0.005000 ? a\n6 0.006000 - a\n7 0.007000 ! a\n";
    static wh_transcript_t transcript;
    static wh_port_t other;
    assert_true(wh_transcript_parse(&transcript, "a.txt", text, sizeof text - 1));
    wh_port_open_transcript(&port, &transcript, "a");
    wh_port_open_transcript(&other, &transcript, "b");
    assert_true(port.tells_all);
    assert_int_equal(wh_port_serve(&other), 0);
    assert_int_equal(wh_port_serve(&port), WH_PORT_TOLD | WH_PORT_CAME);
    other.slice = 2;
    assert_int_equal(wh_port_serve(&other), 0);
    other.slice = port.slice = 9;
    assert_int_equal(wh_port_serve(&port), 0);
    assert_int_equal(wh_port_serve(&other), WH_PORT_TOLD | WH_PORT_FRAME);
    assert_memory_equal(other.entry->bytes, "GET\n", 4);
    assert_int_equal(wh_port_send(&other, "OK\n", 3), 0);
    assert_int_equal(wh_port_serve(&port), 0); /* the answer is not compared yet */
    const wh_transcript_entry_t heard = {5, 5000, WH_TRANSCRIPT_HEARD, "b", (const uint8_t *)"OK\n", 3, 0};
    assert_true(wh_transcript_compare(&transcript, &heard));
    assert_int_equal(wh_port_serve(&port), WH_PORT_TOLD | WH_PORT_ELAPSED);
    assert_int_equal(wh_port_serve(&port), WH_PORT_TOLD | WH_PORT_WENT);
    assert_false(wh_transcript_is_over(&transcript, 6));
    assert_string_equal(transcript.message, "a.txt:8: slice 7 is not reached: the run ends at slice 6");
    assert_int_equal(wh_port_serve(&port), WH_PORT_TOLD | WH_PORT_ENDED);
    assert_int_equal(wh_port_serve(&port) | wh_port_serve(&other), 0);
    assert_true(wh_transcript_is_over(&transcript, 9));
    struct pollfd polls[WH_PORT_POLLS];
    assert_int_equal(wh_port_polls(&port, polls), 0);
    wh_port_close(&port);
    wh_transcript_close(&transcript);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings),
        cmocka_unit_test(dialogue),
        cmocka_unit_test(half_closed),
        cmocka_unit_test(who_sends_no_more_sees_the_end),
        cmocka_unit_test(second_client),
        cmocka_unit_test(clients_that_share),
        cmocka_unit_test(full_input),
        cmocka_unit_test(deaf_client),
        cmocka_unit_test(addresses),
        cmocka_unit_test_setup_teardown(pty_dialogue, open_pty, close_pty),
        cmocka_unit_test_setup_teardown(pty_deaf, open_pty, close_pty),
        cmocka_unit_test_setup_teardown(pty_places, open_pty, close_pty),
        cmocka_unit_test(transcript_is_a_port),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
