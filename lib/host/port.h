/* A port that host software reaches: a TCP listener, a pty with a link to it, or the host's side of a
 * transcript that is played again. One client at a time.
 *
 * Nothing here waits, and no client can make it wait. Bytes that a client does not read stay in `output`; if
 * that is full the client is closed. If `input` is full nothing more is read, and the system's own flow
 * control holds the client. No signal is raised (SIGPIPE). All memory is the caller's. Linux only.
 *
 * A client that has sent its last byte (shutdown, or netcat at the end of its input) is still written to,
 * until it is gone or another one comes. A pty has no connection: its client is the program that has it open.
 * Bytes that are sent while there is no client are lost, as on a serial line. A pty takes all settings of a
 * serial line but seven bits and parity: Linux refuses these.
 *
 * Each piece is acknowledged to the client's system at once. Otherwise a host that sends ACKN and its next
 * command without TCP_NODELAY would wait 40 ms until the second one leaves. */
#ifndef WH_HOST_PORT_H
#define WH_HOST_PORT_H

#include <poll.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "allow.h"
#include "ring.h"
#include "transcript.h"

#define WH_PORT_PATH 4096          /* the longest link of a pty, with its end */
#define WH_PORT_PROBLEM_BYTES 4400 /* room for the reason why a port cannot be opened */
#define WH_PORT_PLACE_BYTES 4200   /* room for its place */

/* The most descriptors of a port. */
#define WH_PORT_POLLS 2

/* A pty without a client does not tell when one comes: serve the port again after this time at the latest. */
#define WH_PORT_ASK_US 20000

/* The treatment of a second client. */
typedef enum {
    WH_PORT_REFUSE,   /* it is closed at once */
    WH_PORT_TAKEOVER, /* the first one is closed */
    WH_PORT_SHARE     /* it waits for another port that listens at the same place */
} wh_port_second_t;

/* The functions of a kind of port: see port_internal.h. */
typedef struct wh_port_kind wh_port_kind_t;

/* The or-ed results of wh_port_serve and wh_port_send: events, in the order of these lines. A client that we
 * closed went as well. Bytes that lay in `input` when a client went can still be read from the ring. Until
 * that ring is empty, CAME is not told, nothing is read from the next client, and nothing is sent to it. */
enum {
    WH_PORT_WENT = 1,     /* the client has sent its last byte, or is gone */
    WH_PORT_CLOSED = 2,   /* it was closed by us, since it did not read */
    WH_PORT_TAKEN = 4,    /* it was closed by us, since another one came */
    WH_PORT_CAME = 8,     /* a client came */
    WH_PORT_REFUSED = 16, /* a second one came and was closed */
    /* A port that tells all: */
    WH_PORT_TOLD = 32,     /* it has handed out something, and may have more for this slice */
    WH_PORT_FRAME = 64,    /* a frame, in `entry` */
    WH_PORT_ELAPSED = 128, /* the controller has waited for too long */
    WH_PORT_HALTED = 256,  /* a STOP has come that is no port's */
    WH_PORT_ENDED = 512    /* the operator has ended the run */
};

/* Since opening. */
typedef struct {
    uint64_t clients, refused, taken,
        closed;              /* that came; second ones closed; first ones closed; that did not read */
    uint64_t received, sent; /* bytes */
    uint64_t lost;           /* bytes sent to nobody */
    uint64_t idle;           /* clients that were closed since they were silent */
} wh_port_counters_t;

/* An open port. Read only the first group; the rest is private. */
typedef struct wh_port {
    char place[WH_PORT_PLACE_BYTES]; /* "127.0.0.1:40001", "[::1]:40001", or the link's path;
                                      * of a transcript the controller's name */
    bool is_local;                   /* nobody reaches it from another machine */
    wh_ring_t input;                 /* the bytes that came: the caller takes them off */
    /* A transcript: it gives whole frames in place of bytes, and its events say when a wait is over, in place
     * of a clock. */
    bool tells_all;
    const wh_transcript_entry_t *entry; /* the frame that it has handed out */
    int64_t slice;                      /* of the run: the caller sets it before it serves a transcript */
    wh_port_counters_t counters;
    const wh_allow_t *allow; /* the caller's, set once it is open: others are closed at once; null: all may */

    const wh_port_kind_t *kind;
    wh_ring_t output;
    wh_port_second_t second;
    const struct wh_port *before; /* shares the listener, and takes clients first; null: none */
    int listener;                 /* -1: none */
    int client;                   /* the connection, or the pty's own side; -1: none */
    bool is_there, is_done;       /* a client is there; it sends no more */
    bool has_news;                /* CAME is not told yet */
    char link[WH_PORT_PATH], slave[64];
    wh_transcript_t *transcript;
} wh_port_t;

/* Listens at "ADDRESS:PORT", "[ADDRESS]:PORT", or "PORT", which is at 127.0.0.1; port 0 is any free one,
 * which `place` tells. Addresses are numbers: no names are looked up. False, and `problem` says why. */
bool wh_port_open_tcp(wh_port_t *port, const char *address, wh_port_second_t second,
                      char problem[WH_PORT_PROBLEM_BYTES]);

/* Another port for clients at the place of one that shares it. A client comes to it only while the ports
 * before it have theirs: `before`, which must outlive it, and so on. False, and `problem` says why. */
bool wh_port_open_beside(wh_port_t *port, const wh_port_t *before, char problem[WH_PORT_PROBLEM_BYTES]);

/* Makes a pty, raw, and a symbolic link to it at `link`, where nothing may be but the
 * link to a pty that is no more, which a server that was killed has left. False, and `problem` says why:
 * nothing is left behind. */
bool wh_port_open_pty(wh_port_t *port, const char *link, char problem[WH_PORT_PROBLEM_BYTES]);

/* The host's side of a transcript, for the controller of this name. Entries are handed out in their order
 * among all its ports, each at its slice and once all answers before it have been compared. */
void wh_port_open_transcript(wh_port_t *port, wh_transcript_t *transcript, const char *name);

/* Closes the client and the port and removes the link, if it is still this port's. May be called twice; not
 * on a port that was never opened. */
void wh_port_close(wh_port_t *port);

/* Fills in what to poll for. Returns how many there are, perhaps none. */
size_t wh_port_polls(const wh_port_t *port, struct pollfd polls[WH_PORT_POLLS]);

/* True if the port has to be served each WH_PORT_ASK_US, for poll does not tell: a pty's client may have
 * come, or there is room again in `input`. */
bool wh_port_asks(const wh_port_t *port);

/* Accepts clients, reads and writes as far as possible without waiting, at most a full ring. Returns what
 * happened. Cost: four calls of the system if nothing happens. */
unsigned wh_port_serve(wh_port_t *port);

/* Sends bytes, whole or not at all: into the ring, and on to the client as far as possible. If the ring has
 * no room the client is closed. Returns what happened. */
unsigned wh_port_send(wh_port_t *port, const void *bytes, size_t size);

/* Closes the connection of a client that sends no more and whose bytes were all taken, once what was sent
 * to it is on its way: it sees the end. It leaves every other client, and a pty, open. */
void wh_port_end_done(wh_port_t *port);

/* True if somebody may read what is sent. */
bool wh_port_is_heard(const wh_port_t *port);

/* Closes a client over TCP once all that was sent to it is on its way; what it has sent is dropped. Does
 * nothing to a pty. Returns what happened. */
unsigned wh_port_hang_up(wh_port_t *port);

/* Closes a client over TCP that has been silent for too long, and counts it. Does nothing to a pty, which has
 * no connection. Returns what happened. */
unsigned wh_port_end_idle(wh_port_t *port);

#endif
