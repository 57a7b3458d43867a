#include "listen.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* The most clients whose connections wait for us to take them. */
#define BACKLOG 32

static int listen_at(const wh_address_t *address) {
    const int on = 1;
    const int fd = socket(address->bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0 || setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
        bind(fd, (const struct sockaddr *)&address->bytes, address->size) != 0 || listen(fd, BACKLOG) != 0) {
        const int problem = errno;
        if (fd >= 0) {
            (void)close(fd);
        }
        errno = problem;
        return -1;
    }
    return fd;
}

/* Listens at the usual port, or at any if another server is there. */
static int listen_anywhere(wh_address_t *address) {
    char usual[WH_HTTP_PLACE_BYTES];
    (void)snprintf(usual, sizeof usual, "%d", WH_HTTP_PORT);
    (void)wh_address_read(usual, address);
    const int fd = listen_at(address);
    if (fd >= 0 || errno != EADDRINUSE) {
        return fd;
    }
    (void)wh_address_read("0", address);
    return listen_at(address);
}

int wh_listen_open(const char *text, wh_address_t *address, char problem[WH_HTTP_PROBLEM_BYTES]) {
    if (text[0] != '\0' && !wh_address_read(text, address)) {
        (void)snprintf(problem, WH_HTTP_PROBLEM_BYTES,
                       "%.200s: no address (expected " WH_ADDRESS_EXPECTED ")", text);
        return -1;
    }
    const int fd = text[0] != '\0' ? listen_at(address) : listen_anywhere(address);
    if (fd < 0) {
        (void)snprintf(problem, WH_HTTP_PROBLEM_BYTES, "%.200s: %s", text[0] != '\0' ? text : "127.0.0.1",
                       strerror(errno));
        return -1;
    }
    address->size = sizeof address->bytes;
    (void)getsockname(fd, (struct sockaddr *)&address->bytes, &address->size);
    return fd;
}

void wh_listen_name(const wh_address_t *place, char text[WH_HTTP_PLACE_BYTES]) {
    char all[WH_HTTP_PLACE_BYTES];
    wh_address_write(place, all, sizeof all);
    const char *port = strrchr(all, ':');
    if (wh_address_is_any(place)) {
        (void)snprintf(text, WH_HTTP_PLACE_BYTES, "%s%.8s",
                       place->bytes.ss_family == AF_INET ? "127.0.0.1" : "[::1]", port);
    } else {
        (void)snprintf(text, WH_HTTP_PLACE_BYTES, "%s", all);
    }
}
