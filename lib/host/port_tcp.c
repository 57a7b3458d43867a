/* A port that listens for TCP. */
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "address.h"
#include "port_internal.h"

/* Connections that wait at a listener: those of a second at a thousand a second. */
#define BACKLOG 1024
/* The most second clients that are refused in one go. */
#define ACCEPTS 64

/* Where the port listens, with the number that the system chose. */
static void note_place(wh_port_t *port) {
    wh_address_t address = {.size = sizeof address.bytes};
    (void)getsockname(port->listener, (struct sockaddr *)&address.bytes, &address.size);
    port->is_local = wh_address_is_local(&address);
    wh_address_write(&address, port->place, sizeof port->place);
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

/* True if a port before it has room for the next client. */
static bool is_before_free(const wh_port_t *port) {
    bool is_free = false;
    for (const wh_port_t *at = port->before; at; at = at->before) {
        is_free = is_free || !at->is_there;
    }
    return is_free;
}

/* Takes a client that waits at the listener, if there is one. Returns what happened to others. */
static unsigned take_waiting(wh_port_t *port) {
    wh_address_t from = {.size = sizeof from.bytes};
    if ((port->is_there && port->second == WH_PORT_SHARE) || is_before_free(port)) {
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
    wh_address_t at;
    const int on = 1;
    wh_port_begin(port, &tcp, second);
    if (!wh_address_read(address, &at)) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES,
                       "%.200s: no address (expected " WH_ADDRESS_EXPECTED ")", address);
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

bool wh_port_open_beside(wh_port_t *port, const wh_port_t *before, char problem[WH_PORT_PROBLEM_BYTES]) {
    wh_port_begin(port, &tcp, before->second);
    port->before = before;
    port->listener = fcntl(before->listener, F_DUPFD_CLOEXEC, 0);
    if (port->listener < 0) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES, "%.200s: %s", before->place, strerror(errno));
        return false;
    }
    note_place(port);
    return true;
}
