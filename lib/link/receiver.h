/* LCM's datagrams, received on a socket of our own.
 *
 * liblcm 1.3.1 writes beyond its memory when a hostile fragment tells an offset near 2^32, and hands on a
 * channel's name without an end. All messages of ours fit one datagram, so this receiver takes whole
 * messages ("LC02") alone and drops fragments ("LC03"). Sending stays liblcm's.
 *
 * The format, big-endian: a word "LC02", the sender's count (4 bytes), the channel's name with its NUL (at
 * most 64 bytes), the data. Source: liblcm's documentation, "LCM UDP Multicast Protocol".
 */
#ifndef WH_LINK_RECEIVER_H
#define WH_LINK_RECEIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WH_RECEIVER_DATAGRAM 65536

/* After so many datagrams that are no messages the caller's other work gets its turn. */
#define WH_RECEIVER_MOST 64

/* Room for what is wrong with a URL. */
#define WH_MULTICAST_PROBLEM_BYTES 200

/* A multicast group, as an URL tells it. */
typedef struct {
    uint32_t address; /* in network order */
    uint16_t port;
    int buffer_bytes; /* recv_buf_size of the URL; 0: as many as there may be */
} wh_multicast_t;

typedef struct {
    int socket;       /* -1: not open */
    uint64_t dropped; /* fragments, and what is no message of LCM */
    uint8_t datagram[WH_RECEIVER_DATAGRAM];
} wh_receiver_t;

/* Points into the receiver, true until the next call. */
typedef struct {
    const char *channel;
    const void *data;
    size_t size;
    uint64_t sender; /* the socket that it came from: each process has another one; 0: unknown */
} wh_received_t;

/* Reads `udpm://ADDRESS:PORT`, with or without liblcm's options behind a `?`: `ttl` and `recv_buf_size`, with
 * a `&` between them. False, and `problem` tells which part is wrong, its value and what was expected;
 * `multicast` is then not for use. */
bool wh_multicast_parse(const char *url, wh_multicast_t *multicast, char problem[WH_MULTICAST_PROBLEM_BYTES]);

/* True if liblcm would take this URL for multicast. */
bool wh_multicast_is(const char *url);

/* Joins the group. False, with errno, if the system refuses. */
bool wh_receiver_open(wh_receiver_t *receiver, const wh_multicast_t *multicast);

/* The next whole message, without waiting. False if none is there, or if WH_RECEIVER_MOST datagrams were
 * dropped. Cost: one call of the system for each datagram, and no copy. */
bool wh_receiver_take(wh_receiver_t *receiver, wh_received_t *message);

void wh_receiver_close(wh_receiver_t *receiver);

#endif
