/* A port that is a pty, with a link to it. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "port_internal.h"

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
    wh_port_close_descriptor(&port->client);
    errno = error;
    return false;
}

/* True if the link is there and leads to this port's pty. */
static bool owns_link(const wh_port_t *port) {
    char target[sizeof port->slave];
    const ssize_t size = readlink(port->link, target, sizeof target);
    return size > 0 && (size_t)size == strlen(port->slave) && memcmp(target, port->slave, (size_t)size) == 0;
}

/* A link to a terminal that is no more: a server that was killed has left it. */
static bool is_left_over(const char *link) {
    static const char terminals[] = "/dev/pts/";
    char target[sizeof((wh_port_t *)NULL)->slave];
    struct stat status;
    const ssize_t size = readlink(link, target, sizeof target);
    return size > (ssize_t)strlen(terminals) && memcmp(target, terminals, strlen(terminals)) == 0 &&
           stat(link, &status) != 0 && errno == ENOENT;
}

/* ------------------------------------------------------------------------------------------------- client */

/* A pty's client is there while it has the pty open, or has left something to read. */
static void look_for_client(wh_port_t *port) {
    if (port->client < 0) {
        (void)make_pty(port);
    }
    if (!port->is_there && port->client >= 0) {
        const short seen = wh_port_look(port);
        if ((seen & POLLHUP) == 0 || (seen & POLLIN) != 0) {
            wh_port_welcome(port);
        }
    }
}

static unsigned serve_pty(wh_port_t *port) {
    look_for_client(port);
    return wh_port_finish_serving(port, wh_port_hear_client(port));
}

static ssize_t write_pty(const wh_port_t *port, const uint8_t *bytes, size_t size) {
    return write(port->client, bytes, size);
}

/* Bytes that nobody has read must not reach the next client. */
static void flush_pty(wh_port_t *port) {
    const int fd = open(port->slave, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0) {
        (void)tcflush(fd, TCIFLUSH);
        (void)close(fd);
    }
}

/* A pty has nothing to close but itself: it is made anew. */
static void renew_pty(wh_port_t *port) {
    if (owns_link(port)) {
        wh_port_close_descriptor(&port->client);
        (void)unlink(port->link);
        (void)make_pty(port);
    }
}

static void close_pty(wh_port_t *port) {
    if (port->link[0] != '\0' && owns_link(port)) {
        (void)unlink(port->link);
    }
    port->link[0] = '\0';
    wh_port_close_descriptor(&port->client);
}

static const wh_port_kind_t pty = {.serve = serve_pty,
                                   .send = wh_port_send_stream,
                                   .close = close_pty,
                                   .write = write_pty,
                                   .drop_client = flush_pty,
                                   .renew = renew_pty};

/* ------------------------------------------------------------------------------------------------ opening */

bool wh_port_open_pty(wh_port_t *port, const char *link, char problem[WH_PORT_PROBLEM_BYTES]) {
    struct stat status;
    wh_port_begin(port, &pty, WH_PORT_REFUSE);
    int error = 0;
    if (strlen(link) >= sizeof port->link) {
        error = ENAMETOOLONG;
    } else if (lstat(link, &status) == 0 && (!is_left_over(link) || unlink(link) != 0)) {
        error = EEXIST;
    } else {
        (void)snprintf(port->link, sizeof port->link, "%s", link);
        error = make_pty(port) ? 0 : errno;
    }
    if (error != 0) {
        (void)snprintf(problem, WH_PORT_PROBLEM_BYTES, "%.4096s: %s%s", link, strerror(error),
                       error == EEXIST ? " (expected a place for a new link)" : "");
        /* A file at the link's place is not ours. */
        port->link[0] = '\0';
        wh_port_close(port);
        return false;
    }
    (void)snprintf(port->place, sizeof port->place, "%s", link);
    port->is_local = true;
    return true;
}
