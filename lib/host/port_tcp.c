/* A port that listens for TCP. */
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "port_internal.h"

/* Connections that wait at a listener: those of a second at a thousand a second. */
#define BACKLOG 1024
/* The most second clients that are refused in one go. */
#define ACCEPTS 64

/* ---------------------------------------------------------------------------------------------- addresses */

/* An address with its port, IPv4 or IPv6. */
typedef struct {
    struct sockaddr_storage bytes;
    socklen_t size;
} address_t;

static bool read_number(const char *text, uint16_t *number) {
    char *end = NULL;
    const unsigned long value = strtoul(text, &end, 10);
    *number = (uint16_t)value;
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && value <= 65535;
}

/* The host in a text of `size` bytes, which has brackets if, and only if, there is a colon in it. */
static bool take_host(const char *text, size_t size, char host[INET6_ADDRSTRLEN]) {
    const bool has_brackets = size > 2 && text[0] == '[' && text[size - 1] == ']';
    text += has_brackets ? 1 : 0;
    size -= has_brackets ? 2 : 0;
    if (size == 0 || size >= INET6_ADDRSTRLEN || has_brackets != (memchr(text, ':', size) != NULL)) {
        return false;
    }
    (void)snprintf(host, INET6_ADDRSTRLEN, "%.*s", (int)size, text);
    return true;
}

/* Splits "HOST:PORT", "[HOST]:PORT" and "PORT"; no host is 127.0.0.1. */
static bool split_address(const char *text, char host[INET6_ADDRSTRLEN], uint16_t *number) {
    const char *colon = strrchr(text, ':');
    if (colon) {
        return take_host(text, (size_t)(colon - text), host) && read_number(colon + 1, number);
    }
    (void)snprintf(host, INET6_ADDRSTRLEN, "127.0.0.1");
    return read_number(text, number);
}

static bool read_address(const char *text, address_t *address) {
    char host[INET6_ADDRSTRLEN];
    uint16_t number = 0;
    memset(address, 0, sizeof *address);
    if (!split_address(text, host, &number)) {
        return false;
    }
    struct sockaddr_in four = {.sin_family = AF_INET, .sin_port = htons(number)};
    struct sockaddr_in6 six = {.sin6_family = AF_INET6, .sin6_port = htons(number)};
    if (inet_pton(AF_INET, host, &four.sin_addr) == 1) {
        memcpy(&address->bytes, &four, sizeof four);
        address->size = sizeof four;
    } else if (inet_pton(AF_INET6, host, &six.sin6_addr) == 1) {
        memcpy(&address->bytes, &six, sizeof six);
        address->size = sizeof six;
    }
    return address->size > 0;
}

/* Where the port listens, with the number that the system chose. */
static void note_place(wh_port_t *port) {
    address_t address = {.size = sizeof address.bytes};
    char host[INET6_ADDRSTRLEN] = "";
    struct sockaddr_in four = {0};
    struct sockaddr_in6 six = {0};
    (void)getsockname(port->listener, (struct sockaddr *)&address.bytes, &address.size);
    if (address.bytes.ss_family == AF_INET) {
        memcpy(&four, &address.bytes, sizeof four);
        (void)inet_ntop(AF_INET, &four.sin_addr, host, sizeof host);
        (void)snprintf(port->place, sizeof port->place, "%s:%u", host, (unsigned)ntohs(four.sin_port));
        port->is_local = ntohl(four.sin_addr.s_addr) >> 24 == 127;
    } else {
        memcpy(&six, &address.bytes, sizeof six);
        (void)inet_ntop(AF_INET6, &six.sin6_addr, host, sizeof host);
        (void)snprintf(port->place, sizeof port->place, "[%s]:%u", host, (unsigned)ntohs(six.sin6_port));
        port->is_local = memcmp(&six.sin6_addr, &in6addr_loopback, sizeof six.sin6_addr) == 0;
    }
}

/* ------------------------------------------------------------------------------------------------ clients */

/* The connection takes the place of the client that is there, if there is one. */
static unsigned welcome_client(wh_port_t *port, int fd) {
    const int on = 1;
    unsigned told = 0;
    if (port->is_there) {
        port->counters.taken += port->is_done ? 0 : 1;
        told |= wh_port_lose_client(port, port->is_done ? 0 : WH_PORT_TAKEN);
    }
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    port->client = fd;
    wh_port_welcome(port);
    return told;
}

/* Takes a client that waits at the listener, if there is one. Returns what happened to others. */
static unsigned take_waiting(wh_port_t *port) {
    address_t from = {.size = sizeof from.bytes};
    if (port->is_there && port->second == WH_PORT_SHARE) {
        return 0; /* the next one is for another port of this place */
    }
    const int fd =
        accept4(port->listener, (struct sockaddr *)&from.bytes, &from.size, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
        return 0;
    }
    if (port->allow && !wh_allow_has(port->allow, (const struct sockaddr *)&from.bytes)) {
        (void)close(fd);
        port->counters.refused += 1;
        return WH_PORT_REFUSED;
    }
    unsigned told = wh_port_hear_client(port); /* which may have gone before this one came */
    if (port->is_there && !port->is_done && port->second == WH_PORT_REFUSE) {
        (void)close(fd);
        port->counters.refused += 1;
        return told | WH_PORT_REFUSED;
    }
    return told | welcome_client(port, fd);
}
/* The client comes before the check of others, so that a client that hung up blocks nobody. */
static unsigned serve_tcp(wh_port_t *port) {
    unsigned told = wh_port_hear_client(port);
    unsigned taken = WH_PORT_REFUSED;
    for (int i = 0; i < ACCEPTS && (taken & WH_PORT_REFUSED) != 0; ++i) {
        taken = take_waiting(port);
        told |= taken;
    }
    return wh_port_finish_serving(port, told);
}

static ssize_t write_tcp(const wh_port_t *port, const uint8_t *bytes, size_t size) {
    return send(port->client, bytes, size, MSG_NOSIGNAL);
}

/* The system drops this setting by itself, so it is set again after each piece. */
static void acknowledge_at_once(const wh_port_t *port) {
    const int on = 1;
    (void)setsockopt(port->client, IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);
}

static void close_connection(wh_port_t *port) {
    wh_port_close_descriptor(&port->client);
}

static void close_tcp(wh_port_t *port) {
    wh_port_close_descriptor(&port->client);
    wh_port_close_descriptor(&port->listener);
}

static const wh_port_kind_t tcp = {.serve = serve_tcp,
                                   .send = wh_port_send_stream,
                                   .close = close_tcp,
                                   .is_connection = true,
                                   .write = write_tcp,
                                   .acknowledge = acknowledge_at_once,
                                   .drop_client = close_connection};

/* ------------------------------------------------------------------------------------------------ opening */

bool wh_port_open_tcp(wh_port_t *port, const char *address, wh_port_second_t second,
                      char problem[WH_PORT_PROBLEM_BYTES]) {
    address_t at;
    const int on = 1;
    wh_port_begin(port, &tcp, second);
    if (!read_address(address, &at)) {
        (void)snprintf(
            problem, WH_PORT_PROBLEM_BYTES,
            "%.200s: no address (expected ADDRESS:PORT in numbers, such as 127.0.0.1:5000, or PORT "
            "from 0 to 65535)",
            address);
        return false;
    }
    port->listener = socket(at.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (port->listener < 0 || setsockopt(port->listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
        bind(port->listener, (const struct sockaddr *)&at.bytes, at.size) != 0 ||
        listen(port->listener, BACKLOG) != 0) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES, "%.200s: %s", address, strerror(errno));
        wh_port_close(port);
        return false;
    }
    note_place(port);
    return true;
}

bool wh_port_open_beside(wh_port_t *port, const wh_port_t *first, char problem[WH_PORT_PROBLEM_BYTES]) {
    wh_port_begin(port, &tcp, first->second);
    port->listener = fcntl(first->listener, F_DUPFD_CLOEXEC, 0);
    if (port->listener < 0) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES, "%.200s: %s", first->place, strerror(errno));
        return false;
    }
    note_place(port);
    return true;
}
