/* The line to a board: a serial device, or UDP. Nothing here waits.
 *
 * Host code, Linux. A UDP board is known once it has sent a sound frame. Datagrams of others are told apart
 * by `is_stranger`; whoever reads them decides.
 */
#ifndef WH_LOOP_CABLE_H
#define WH_LOOP_CABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../host/address.h"
#include "../host/allow.h"

/* The largest datagram that can be a frame or more; the room of a place, of a problem. */
#define WH_CABLE_BYTES 2048
#define WH_CABLE_TEXT 300

typedef struct {
    int fd; /* -1: not open */
    bool is_udp;
    bool is_local;             /* nobody reaches it from another machine */
    char place[WH_CABLE_TEXT]; /* the device, or where it listens */
    const wh_allow_t *allow;   /* the caller's; null: all may */
    bool has_peer;             /* the board over UDP is known */
    wh_address_t peer, from;   /* it; and the sender of the last datagram */
    bool is_stranger;          /* the last datagram is not of the peer */
    uint64_t refused;          /* datagrams of senders that are not allowed */
    uint64_t unsent;           /* frames that the system did not take whole */
} wh_cable_t;

/* True for a speed that a serial line has, such as 115200. */
bool wh_cable_has_speed(uint64_t baud);

/* Opens a serial device or a pty: raw, eight bits, no flow control, alone. It is readable once `frame`
 * bytes are there, at most 255: read it at a slice's end as well. False, and `problem` says why. */
bool wh_cable_open_serial(wh_cable_t *line, const char *device, uint64_t baud, size_t frame,
                          char problem[WH_CABLE_TEXT]);

/* Listens at "ADDRESS:PORT", or "PORT", which is at 127.0.0.1; port 0 is any free one, which `place`
 * tells. */
bool wh_cable_open_udp(wh_cable_t *line, const char *address, char problem[WH_CABLE_TEXT]);

/* Reads what is there: of UDP one datagram. Returns its bytes; 0: nothing is there; -1: the line is gone. */
int wh_cable_read(wh_cable_t *line, uint8_t bytes[WH_CABLE_BYTES]);

/* The sender of the last datagram is the board from now on. */
void wh_cable_take_peer(wh_cable_t *line);

/* True if the last datagram's sender has the peer's address, whatever its port. */
bool wh_cable_is_same_host(const wh_cable_t *line);

/* Sends a frame. To a UDP board that is not known yet nothing is sent. */
void wh_cable_write(wh_cable_t *line, const uint8_t bytes[], size_t size);

void wh_cable_close(wh_cable_t *line);

#endif
