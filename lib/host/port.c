/* Ports of any kind, and streams of bytes to one client. */
#include <errno.h>
#include <poll.h>
#include <string.h>
#include <unistd.h>

#include "port_internal.h"

void wh_port_begin(wh_port_t *port, const wh_port_kind_t *kind, wh_port_second_t second) {
    memset(port, 0, sizeof *port);
    port->kind = kind;
    port->second = second;
    port->listener = port->client = -1;
}

void wh_port_close_descriptor(int *descriptor) {
    if (*descriptor >= 0) {
        (void)close(*descriptor);
        *descriptor = -1;
    }
}

unsigned wh_port_serve(wh_port_t *port) {
    return port->kind->serve(port);
}

unsigned wh_port_send(wh_port_t *port, const void *bytes, size_t size) {
    return port->kind->send(port, bytes, size);
}

void wh_port_close(wh_port_t *port) {
    port->kind->close(port);
    port->is_there = port->is_done = port->has_news = false;
}

/* ------------------------------------------------------------------------------------------------ clients */

static void forget_output(wh_port_t *port) {
    port->counters.lost += port->output.count;
    wh_ring_drop(&port->output, port->output.count);
}

unsigned wh_port_lose_client(wh_port_t *port, unsigned why) {
    const unsigned went = port->is_done ? 0 : WH_PORT_WENT;
    const bool was_told = !port->has_news;
    forget_output(port);
    port->kind->drop_client(port);
    port->is_there = port->is_done = port->has_news = false;
    return was_told ? why | went : 0;
}

/* Closes a client that does not read. */
static unsigned close_deaf(wh_port_t *port) {
    port->counters.closed += 1;
    const unsigned told = wh_port_lose_client(port, WH_PORT_CLOSED);
    if (port->kind->renew) {
        port->kind->renew(port);
    }
    return told;
}

void wh_port_welcome(wh_port_t *port) {
    port->counters.clients += 1;
    port->is_there = port->has_news = true;
    port->is_done = false;
}

short wh_port_look(const wh_port_t *port) {
    struct pollfd polled = {.fd = port->client, .events = POLLIN};
    (void)poll(&polled, 1, 0);
    return polled.revents;
}

bool wh_port_is_heard(const wh_port_t *port) {
    return port->is_there && !port->has_news;
}

/* ------------------------------------------------------------------------------------------------- bytes */

static void take_piece(wh_port_t *port, size_t size) {
    wh_ring_filled(&port->input, size);
    port->counters.received += (uint64_t)size;
    if (port->kind->acknowledge) {
        port->kind->acknowledge(port);
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
            take_piece(port, (size_t)got);
        } else if (got == 0 && port->kind->is_connection) {
            port->is_done = true;
            return WH_PORT_WENT;
        } else if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
            return wh_port_lose_client(port, 0);
        } else if (errno == EAGAIN) {
            return 0;
        }
    }
}

static unsigned write_client(wh_port_t *port) {
    size_t size = 0;
    const uint8_t *from = wh_ring_front(&port->output, &size);
    while (from) {
        const ssize_t put = port->kind->write(port, from, size);
        if (put > 0) {
            wh_ring_drop(&port->output, (size_t)put);
            port->counters.sent += (uint64_t)put;
        } else if (put == 0 || errno == EAGAIN) {
            return 0;
        } else if (errno != EINTR) {
            return wh_port_lose_client(port, 0);
        }
        from = wh_ring_front(&port->output, &size);
    }
    return 0;
}

unsigned wh_port_hear_client(wh_port_t *port) {
    if (!wh_port_is_heard(port)) {
        return 0;
    }
    if (!port->is_done) {
        return read_client(port);
    }
    return (wh_port_look(port) & (POLLERR | POLLHUP)) != 0 ? wh_port_lose_client(port, 0) : 0;
}

unsigned wh_port_finish_serving(wh_port_t *port, unsigned told) {
    if (port->has_news && port->input.count == 0) {
        port->has_news = false;
        return told | WH_PORT_CAME;
    }
    return wh_port_is_heard(port) ? told | write_client(port) : told;
}

unsigned wh_port_send_stream(wh_port_t *port, const void *bytes, size_t size) {
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

void wh_port_end_done(wh_port_t *port) {
    if (port->kind->is_connection && wh_port_is_heard(port) && port->is_done && port->input.count == 0 &&
        port->output.count == 0) {
        (void)wh_port_lose_client(port, 0);
    }
}

unsigned wh_port_hang_up(wh_port_t *port) {
    if (!port->kind->is_connection || !wh_port_is_heard(port) || port->output.count > 0) {
        return 0;
    }
    wh_ring_drop(&port->input, port->input.count);
    return wh_port_lose_client(port, 0);
}

unsigned wh_port_end_idle(wh_port_t *port) {
    if (!port->kind->is_connection || !wh_port_is_heard(port)) {
        return 0;
    }
    port->counters.idle += 1;
    return wh_port_lose_client(port, WH_PORT_CLOSED);
}

/* -------------------------------------------------------------------------------------------------- poll */

/* A pty without a client, and a transcript, have nothing to poll. */
bool wh_port_asks(const wh_port_t *port) {
    const bool has_no_poll = !port->kind->is_connection && !port->is_there;
    return has_no_poll || wh_ring_room(&port->input) == 0 || port->has_news;
}

size_t wh_port_polls(const wh_port_t *port, struct pollfd polls[WH_PORT_POLLS]) {
    size_t count = 0;
    if (port->listener >= 0 && (port->second != WH_PORT_SHARE || !port->is_there)) {
        polls[count++] = (struct pollfd){.fd = port->listener, .events = POLLIN};
    }
    /* A client that hung up would wake poll again and again if nothing could be read from it. */
    if (port->is_there && !wh_port_asks(port)) {
        const int events = (port->is_done ? 0 : POLLIN) | (port->output.count > 0 ? POLLOUT : 0);
        polls[count++] = (struct pollfd){.fd = port->client, .events = (short)events};
    }
    return count;
}
