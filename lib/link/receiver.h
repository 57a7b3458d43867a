/* Receives LCM's datagrams on a socket of our own.
 *
 * liblcm 1.3.1 writes beyond its memory when a hostile fragment gives an offset near 2^32, and passes on a
 * channel's name without an end. All messages of ours fit one datagram, so this receiver takes whole
 * messages ("LC02") alone and drops fragments ("LC03"). liblcm still sends.
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

/* After this number of datagrams that are no messages the caller gets its turn. */
#define WH_RECEIVER_MOST 64

/* Room for a message about a URL. */
#define WH_MULTICAST_PROBLEM_BYTES 200

/* A multicast group, from a URL. */
typedef struct {
    uint32_t address; /* in network order */
    uint16_t port;
    int buffer_bytes; /* recv_buf_size of the URL; 0: as large as possible */
} wh_multicast_t;

typedef struct {
    int socket;       /* -1: not open */
    uint64_t dropped; /* fragments, and datagrams that are no message of LCM */
    uint8_t datagram[WH_RECEIVER_DATAGRAM];
} wh_receiver_t;

/* It points into the receiver and is valid until the next call. */
typedef struct {
    const char *channel;
    const void *data;
    size_t size;
    uint64_t sender; /* the socket that it came from; each process has another one; 0: unknown */
} wh_received_t;

/* Reads `udpm://ADDRESS:PORT`, with or without liblcm's options behind a `?`: `ttl` and `recv_buf_size`,
 * with a `&` between them. Returns false, and `problem` gives the wrong part, its value and the expected
 * form; `multicast` must then not be used. */
bool wh_multicast_parse(const char *url, wh_multicast_t *multicast, char problem[WH_MULTICAST_PROBLEM_BYTES]);

/* True if liblcm would take this URL for multicast. */
bool wh_multicast_is(const char *url);

/* Joins the group. False, with errno, if the system refuses. */
bool wh_receiver_open(wh_receiver_t *receiver, const wh_multicast_t *multicast);

/* Takes the next whole message, without waiting. Returns false if none is there, or if WH_RECEIVER_MOST
 * datagrams were dropped. Cost: one system call for each datagram, and no copy. */
bool wh_receiver_take(wh_receiver_t *receiver, wh_received_t *message);

void wh_receiver_close(wh_receiver_t *receiver);

#endif
