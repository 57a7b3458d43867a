#include "port.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

static void start(wh_port_t *port, wh_port_second_t second) {
    memset(port, 0, sizeof *port);
    port->second = second;
    port->listener = port->client = -1;
}

static bool is_pty(const wh_port_t *port) {
    return port->listener < 0;
}

/* ----------------------------------------------------------------------------------------------- opening */

static void close_descriptor(int *descriptor) {
    if (*descriptor >= 0) {
        (void)close(*descriptor);
        *descriptor = -1;
    }
}

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

bool wh_port_open_tcp(wh_port_t *port, const char *address, wh_port_second_t second,
                      char problem[WH_PORT_PROBLEM_BYTES]) {
    address_t at;
    const int on = 1;
    start(port, second);
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
        listen(port->listener, 8) != 0) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES, "%.200s: %s", address, strerror(errno));
        wh_port_close(port);
        return false;
    }
    note_place(port);
    return true;
}

/* No echo, no line discipline, eight bits: bytes as they are. */
static bool make_raw(const char *slave) {
    struct termios settings;
    const int fd = open(slave, O_RDWR | O_NOCTTY | O_CLOEXEC);
    bool good = fd >= 0 && tcgetattr(fd, &settings) == 0;
    if (good) {
        cfmakeraw(&settings);
        good = tcsetattr(fd, TCSANOW, &settings) == 0;
    }
    if (fd >= 0) {
        (void)close(fd);
    }
    return good;
}

/* Once the slave was open and is closed again, poll tells whether somebody has it open. */
static bool make_pty(wh_port_t *port) {
    port->client = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (port->client >= 0 && grantpt(port->client) == 0 && unlockpt(port->client) == 0 &&
        ptsname_r(port->client, port->slave, sizeof port->slave) == 0 && make_raw(port->slave) &&
        symlink(port->slave, port->link) == 0) {
        return true;
    }
    const int error = errno;
    close_descriptor(&port->client);
    errno = error;
    return false;
}

/* True if the link is there and leads to this port's pty. */
static bool owns_link(const wh_port_t *port) {
    char target[sizeof port->slave];
    const ssize_t size = readlink(port->link, target, sizeof target);
    return size > 0 && (size_t)size == strlen(port->slave) && memcmp(target, port->slave, (size_t)size) == 0;
}

bool wh_port_open_pty(wh_port_t *port, const char *link, char problem[WH_PORT_PROBLEM_BYTES]) {
    struct stat status;
    start(port, WH_PORT_REFUSE);
    int error = 0;
    if (strlen(link) >= sizeof port->link) {
        error = ENAMETOOLONG;
    } else if (lstat(link, &status) == 0) {
        error = EEXIST;
    } else {
        (void)snprintf(port->link, sizeof port->link, "%s", link);
        error = make_pty(port) ? 0 : errno;
    }
    if (error != 0) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES, "%.4096s: %s%s", link, strerror(error),
                       error == EEXIST ? " (expected a place for a new link)" : "");
        /* Whatever is at the link's place is not ours. */
        port->link[0] = '\0';
        wh_port_close(port);
        return false;
    }
    (void)snprintf(port->place, sizeof port->place, "%s", link);
    port->is_local = true;
    return true;
}

void wh_port_close(wh_port_t *port) {
    if (port->link[0] != '\0' && owns_link(port)) {
        (void)unlink(port->link);
    }
    port->link[0] = '\0';
    close_descriptor(&port->client);
    close_descriptor(&port->listener);
    port->is_there = port->is_done = port->has_news = false;
}

/* ----------------------------------------------------------------------------------------------- clients */

static void forget_output(wh_port_t *port) {
    port->counters.lost += port->output.count;
    wh_ring_drop(&port->output, port->output.count);
}

/* The client is gone, or is to go. Returns `why`, and that it went if it had not said so. What was never said
 * to have come does not go. */
static unsigned lose_client(wh_port_t *port, unsigned why) {
    const unsigned went = port->is_done ? 0 : WH_PORT_WENT;
    const bool was_told = !port->has_news;
    forget_output(port);
    if (is_pty(port)) {
        /* What nobody has read must not be there for the next one. */
        const int fd = open(port->slave, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
        if (fd >= 0) {
            (void)tcflush(fd, TCIFLUSH);
            (void)close(fd);
        }
    } else {
        close_descriptor(&port->client);
    }
    port->is_there = port->is_done = port->has_news = false;
    return was_told ? why | went : 0;
}

/* Closes a client that does not read. A pty has nothing to close but itself: it is made anew. */
static unsigned close_deaf(wh_port_t *port) {
    port->counters.closed += 1;
    const unsigned told = lose_client(port, WH_PORT_CLOSED);
    if (is_pty(port) && owns_link(port)) {
        close_descriptor(&port->client);
        (void)unlink(port->link);
        (void)make_pty(port);
    }
    return told;
}

static void welcome(wh_port_t *port) {
    port->counters.clients += 1;
    port->is_there = port->has_news = true;
    port->is_done = false;
}

/* One who waits at the listener, if anybody does. Returns what happened to others. */
static unsigned take_waiting(wh_port_t *port) {
    const int on = 1;
    address_t from = {.size = sizeof from.bytes};
    const int fd =
        accept4(port->listener, (struct sockaddr *)&from.bytes, &from.size, SOCK_NONBLOCK | SOCK_CLOEXEC);
    unsigned told = 0;
    if (fd < 0) {
        return 0;
    }
    if (port->is_there && !port->is_done && port->second == WH_PORT_REFUSE) {
        (void)close(fd);
        port->counters.refused += 1;
        return WH_PORT_REFUSED;
    }
    if (port->is_there) {
        port->counters.taken += port->is_done ? 0 : 1;
        told = lose_client(port, port->is_done ? 0 : WH_PORT_TAKEN);
    }
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    port->client = fd;
    welcome(port);
    return told;
}

/* What poll says of the client now. */
static short look(const wh_port_t *port) {
    struct pollfd polled = {.fd = port->client, .events = POLLIN};
    (void)poll(&polled, 1, 0);
    return polled.revents;
}

/* A pty's client is there while it has the pty open, or has left something to read. */
static void look_for_client(wh_port_t *port) {
    if (port->client < 0) {
        (void)make_pty(port);
    }
    if (!port->is_there && port->client >= 0) {
        const short seen = look(port);
        if ((seen & POLLHUP) == 0 || (seen & POLLIN) != 0) {
            welcome(port);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- bytes */

/* The system forgets this setting by itself, so it is made anew behind each piece. */
static void acknowledge_at_once(const wh_port_t *port) {
    const int on = 1;
    if (!is_pty(port)) {
        (void)setsockopt(port->client, IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);
    }
}

static unsigned read_client(wh_port_t *port) {
    for (;;) {
        size_t room = 0;
        uint8_t *to = wh_ring_back(&port->input, &room);
        if (!to) {
            return 0;
        }
        const ssize_t got = read(port->client, to, room);
        if (got > 0) {
            wh_ring_filled(&port->input, (size_t)got);
            port->counters.received += (uint64_t)got;
            acknowledge_at_once(port);
        } else if (got == 0 && !is_pty(port)) {
            port->is_done = true;
            return WH_PORT_WENT;
        } else if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
            return lose_client(port, 0);
        } else if (errno == EAGAIN) {
            return 0;
        }
    }
}

static unsigned write_client(wh_port_t *port) {
    size_t size = 0;
    const uint8_t *from = wh_ring_front(&port->output, &size);
    while (from) {
        const ssize_t put =
            is_pty(port) ? write(port->client, from, size) : send(port->client, from, size, MSG_NOSIGNAL);
        if (put > 0) {
            wh_ring_drop(&port->output, (size_t)put);
            port->counters.sent += (uint64_t)put;
        } else if (put == 0 || errno == EAGAIN) {
            return 0;
        } else if (errno != EINTR) {
            return lose_client(port, 0);
        }
        from = wh_ring_front(&port->output, &size);
    }
    return 0;
}

/* Reads, and sees if the client is gone. */
static unsigned hear_client(wh_port_t *port) {
    if (!port->is_done) {
        return read_client(port);
    }
    return (look(port) & (POLLERR | POLLHUP)) != 0 ? lose_client(port, 0) : 0;
}

unsigned wh_port_serve(wh_port_t *port) {
    unsigned told = 0;
    if (is_pty(port)) {
        look_for_client(port);
    }
    /* Before others are looked at: one that hung up is in nobody's way. */
    if (wh_port_is_heard(port)) {
        told = hear_client(port);
    }
    if (!is_pty(port)) {
        told |= take_waiting(port);
    }
    if (port->has_news && port->input.count == 0) {
        port->has_news = false;
        return told | WH_PORT_CAME;
    }
    return wh_port_is_heard(port) ? told | write_client(port) : told;
}

unsigned wh_port_send(wh_port_t *port, const void *bytes, size_t size) {
    unsigned told = 0;
    if (wh_port_is_heard(port) && wh_ring_room(&port->output) < size) {
        told = write_client(port);
    }
    if (wh_port_is_heard(port) && !wh_ring_put(&port->output, bytes, size)) {
        told |= close_deaf(port);
    }
    if (!wh_port_is_heard(port)) {
        port->counters.lost += size;
        return told;
    }
    return told | write_client(port);
}

bool wh_port_is_heard(const wh_port_t *port) {
    return port->is_there && !port->has_news;
}

/* -------------------------------------------------------------------------------------------------- poll */

bool wh_port_asks(const wh_port_t *port) {
    return (is_pty(port) && !port->is_there) || wh_ring_room(&port->input) == 0 || port->has_news;
}

size_t wh_port_polls(const wh_port_t *port, struct pollfd polls[WH_PORT_POLLS]) {
    size_t count = 0;
    if (!is_pty(port)) {
        polls[count++] = (struct pollfd){.fd = port->listener, .events = POLLIN};
    }
    /* A client that hung up would wake poll for ever if nothing could be read from it. */
    if (port->is_there && !wh_port_asks(port)) {
        const int events = (port->is_done ? 0 : POLLIN) | (port->output.count > 0 ? POLLOUT : 0);
        polls[count++] = (struct pollfd){.fd = port->client, .events = (short)events};
    }
    return count;
}
