/* Kinds of ports, and the streams of bytes that TCP and a pty are. */
#ifndef WH_HOST_PORT_INTERNAL_H
#define WH_HOST_PORT_INTERNAL_H

#include <sys/types.h>

#include "port.h"

struct wh_port_kind {
    /* Takes what has come. Returns what happened. */
    unsigned (*serve)(wh_port_t *port);
    /* Sends the bytes, whole or not at all. Returns what happened. */
    unsigned (*send)(wh_port_t *port, const void *bytes, size_t size);
    void (*close)(wh_port_t *port);

    /* For a stream; the others have none of these. */
    bool is_connection; /* reading nothing is a client's end, and it can be closed alone */
    ssize_t (*write)(const wh_port_t *port, const uint8_t *bytes, size_t size);
    void (*acknowledge)(const wh_port_t *port); /* a piece was read; null: nothing is to be done */
    void (*drop_client)(wh_port_t *port);       /* its bytes, too */
    void (*renew)(wh_port_t *port); /* a client that did not read was dropped; null: nothing is to be done */
};

/* Zeroes a port, without a descriptor. */
void wh_port_begin(wh_port_t *port, const wh_port_kind_t *kind, wh_port_second_t second);

void wh_port_close_descriptor(int *descriptor);

/* A stream has another client. */
void wh_port_welcome(wh_port_t *port);

/* The client is gone, or must go. Returns `why`, and WENT if that was not told yet. A client whose CAME was
 * never told gets no WENT. */
unsigned wh_port_lose_client(wh_port_t *port, unsigned why);

/* Reads, and sees if the client is gone. Without a client it does nothing. */
unsigned wh_port_hear_client(wh_port_t *port);

/* The end of serving a stream, in which `told` has happened: tells CAME, or writes. */
unsigned wh_port_finish_serving(wh_port_t *port, unsigned told);

/* Sends over a stream. */
unsigned wh_port_send_stream(wh_port_t *port, const void *bytes, size_t size);

/* The events that poll reports for the client now. */
short wh_port_look(const wh_port_t *port);

#endif
