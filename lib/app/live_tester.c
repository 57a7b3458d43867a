#include "live_tester.h"

#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "../host/address.h"

static bool connect_to(wh_live_tester_t *tester) {
    wh_address_t address;
    if (tester->is_connected) {
        return true;
    }
    if (!wh_address_read(tester->address, &address)) {
        return false;
    }
    tester->fd = socket(address.bytes.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    tester->is_connected =
        tester->fd >= 0 && connect(tester->fd, (const struct sockaddr *)&address.bytes, address.size) == 0;
    if (!tester->is_connected && tester->fd >= 0) {
        (void)close(tester->fd);
    }
    return tester->is_connected;
}

void wh_live_tester_leave(wh_live_tester_t *tester) {
    if (tester->is_connected) {
        (void)close(tester->fd);
        tester->is_connected = false;
    }
}

void wh_live_tester_drain(wh_live_tester_t *tester) {
    char bytes[4096];
    ssize_t got = 1;
    while (tester->is_connected && got > 0) {
        got = recv(tester->fd, bytes, sizeof bytes, MSG_DONTWAIT);
        if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) {
            wh_live_tester_leave(tester);
        }
    }
}

/* Once more if the connection was lost since. */
bool wh_live_tester_send(wh_live_tester_t *tester, const char *line) {
    const size_t size = strlen(line);
    for (int attempt = 0; attempt < 2; ++attempt) {
        wh_live_tester_drain(tester);
        if (!connect_to(tester)) {
            return false;
        }
        if (send(tester->fd, line, size, MSG_NOSIGNAL | MSG_DONTWAIT) == (ssize_t)size) {
            return true;
        }
        wh_live_tester_leave(tester);
    }
    return false;
}
