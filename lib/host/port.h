/* A port that host software reaches: a TCP listener, or a pty with a link to it. One client at a time.
 *
 * Nothing here waits, and no client can make it: what a client does not read stays in `output`, and if that
 * is full the client is closed. If `input` is full nothing more is read, and the system's own flow control
 * holds the client. No signal is raised (SIGPIPE). All memory is the caller's. Linux only.
 *
 * A client that has sent its last byte (shutdown, or netcat at the end of its input) is still written to,
 * until it is gone or another one comes. A pty has no connection: a client is whoever has it open. What is
 * sent while there is no client is lost, as on a serial line. Of a serial line's settings a pty takes all but
 * seven bits and parity: Linux refuses these.
 *
 * Each piece is acknowledged to the client's system at once. Else a host that sends ACKN and its next command
 * without TCP_NODELAY, would wait 40 ms for the second of them to leave. */
#ifndef WH_HOST_PORT_H
#define WH_HOST_PORT_H

#include <poll.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ring.h"

#define WH_PORT_PATH 4096          /* the longest link of a pty, with its end */
#define WH_PORT_PROBLEM_BYTES 4400 /* room for why a port cannot be opened */
#define WH_PORT_PLACE_BYTES 4200   /* room for where it is */

/* The most descriptors of a port. */
#define WH_PORT_POLLS 2

/* A pty whose client is not there tells nobody that one comes: then the port is to be served again after so
 * long at the latest. */
#define WH_PORT_ASK_US 20000

/* What happens to a second client. */
typedef enum {
    WH_PORT_REFUSE,  /* it is closed at once */
    WH_PORT_TAKEOVER /* the first one is closed */
} wh_port_second_t;

/* What wh_port_serve and wh_port_send return, or-ed: what has happened, in the order of these lines. Where a
 * client was closed by us, it went as well. What lay in `input` when a client went is still there for whoever
 * reads the ring. CAME is not told, nothing is read from the next client, and nothing sent to it, before that
 * ring is empty. */
enum {
    WH_PORT_WENT = 1,    /* the client has sent its last byte, or is gone */
    WH_PORT_CLOSED = 2,  /* it was closed by us, since it did not read */
    WH_PORT_TAKEN = 4,   /* it was closed by us, since another one came */
    WH_PORT_CAME = 8,    /* a client came */
    WH_PORT_REFUSED = 16 /* a second one came and was closed */
};

/* Since opening. */
typedef struct {
    uint64_t clients, refused, taken,
        closed;              /* that came; second ones closed; first ones closed; that did not read */
    uint64_t received, sent; /* bytes */
    uint64_t lost;           /* bytes sent to nobody */
} wh_port_counters_t;

/* An open port. The first group is to be read; the rest is its own. */
typedef struct {
    char place[WH_PORT_PLACE_BYTES]; /* "127.0.0.1:40001", "[::1]:40001", or the link's path */
    bool is_local;                   /* nobody reaches it from another machine */
    wh_ring_t input;                 /* what came: the caller takes it off */
    wh_port_counters_t counters;

    wh_ring_t output;
    wh_port_second_t second;
    int listener;           /* -1: a pty */
    int client;             /* the connection, or the pty's own side; -1: none */
    bool is_there, is_done; /* a client is; it sends no more */
    bool has_news;          /* CAME is to be told */
    char link[WH_PORT_PATH], slave[64];
} wh_port_t;

/* Listens at "ADDRESS:PORT", "[ADDRESS]:PORT", or "PORT", which is at 127.0.0.1; port 0 is any free one,
 * which `place` tells. Addresses are numbers: no names are looked up. False, and `problem` says why. */
bool wh_port_open_tcp(wh_port_t *port, const char *address, wh_port_second_t second,
                      char problem[WH_PORT_PROBLEM_BYTES]);

/* Makes a pty, raw, and a symbolic link to it at `link`, where nothing may be. False, and `problem` says why:
 * nothing is left behind. */
bool wh_port_open_pty(wh_port_t *port, const char *link, char problem[WH_PORT_PROBLEM_BYTES]);

/* Closes the client and the port and removes the link, if it is still this port's. May be called twice; not
 * on a port that was never opened. */
void wh_port_close(wh_port_t *port);

/* Fills in what to poll for. Returns how many there are, perhaps none. */
size_t wh_port_polls(const wh_port_t *port, struct pollfd polls[WH_PORT_POLLS]);

/* True if the port has to be served each WH_PORT_ASK_US, for poll does not tell: a pty's client may have
 * come, or there is room again in `input`. */
bool wh_port_asks(const wh_port_t *port);

/* Takes clients, reads and writes, as far as it goes without waiting, at most a ring full. Returns what
 * happened. Cost: four calls of the system if nothing happens. */
unsigned wh_port_serve(wh_port_t *port);

/* Sends bytes, whole or not at all: into the ring, and on as far as it goes. If the ring has no room the
 * client is closed. Returns what happened. */
unsigned wh_port_send(wh_port_t *port, const void *bytes, size_t size);

/* True if somebody may read what is sent. */
bool wh_port_is_heard(const wh_port_t *port);

#endif
