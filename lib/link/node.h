/* A process on LCM: publishing, subscriptions that drop nothing, a wait with a short time limit, and what
 * becomes a record.
 *
 * Nothing here allocates while messages are published; receiving allocates in liblcm. One thread per node.
 */
#ifndef WH_LINK_NODE_H
#define WH_LINK_NODE_H

#include <lcm/lcm.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "receiver.h"
#include "recording.h"

/* Nothing leaves the host unless another URL is asked for. */
#define WH_NODE_URL "udpm://239.255.76.67:7667?ttl=0"

#define WH_NODE_SUBSCRIPTIONS 12

typedef struct wh_node wh_node_t;

/* What a datagram is handed to: its bytes, true until the call returns. */
typedef void wh_node_handler_t(void *user, const void *data, size_t size);

typedef struct {
    wh_node_t *node;
    const char *channel; /* the caller's */
    wh_node_handler_t *handler;
    void *user;
    bool overhears; /* what it hears is no part of the record */
} wh_node_subscriber_t;

/* Where a line for people goes; without its end. */
typedef void wh_node_listener_t(void *user, const char *line);

/* Who sends on a channel, for one on which there should be one sender. All zero to begin with. */
typedef struct {
    uint64_t last, other; /* the last one, and the other one before it; 0: unknown */
    bool shared;          /* both send */
} wh_senders_t;

/* Hears a message of this sender; 0: unknown. True, once, if two send in turns: one that was started anew
 * sends from another socket, and the one before it never again. */
static inline bool wh_senders_hear(wh_senders_t *senders, uint64_t sender) {
    if (sender == 0 || sender == senders->last) {
        return false;
    }
    const bool is_new = sender == senders->other && !senders->shared;
    senders->shared = senders->shared || is_new;
    senders->other = senders->last;
    senders->last = sender;
    return is_new;
}

struct wh_node {
    const char *speaker; /* who says what wh_node_say prints, such as "sim"; null, as at first: nobody */
    bool log_time;       /* lines begin with the time and a level */
    wh_node_listener_t *listener; /* takes the lines in place of standard error; null: nobody does */
    void *listener_user;
    lcm_t *lcm;             /* sends; receives if the URL is not multicast */
    wh_receiver_t receiver; /* receives multicast */
    wh_recording_t *record; /* the caller's; null: not recording */
    bool interrupted;       /* a signal ended a wait since this was last cleared */
    uint64_t sender;        /* of the message that is being handled: see wh_received_t */
    wh_node_subscriber_t subscribers[WH_NODE_SUBSCRIPTIONS];
    size_t subscriber_count;
};

/* False, and standard error says why, if nobody outside of this process can be reached at the URL (null:
 * as in wh_node_open): it is one of memory or of a file. */
bool wh_node_reaches_others(const char *url);

/* Opens LCM at a URL (null: LCM_DEFAULT_URL of the environment, or WH_NODE_URL). If `record` is not null
 * and its options have a path, it is opened then, and gets all that is published and received. It stays
 * the caller's, who closes it after the node. The node must not be moved afterwards. False, and standard
 * error says why, when LCM cannot (no multicast route, a bad URL, and whose it is: --lcm-url's or the
 * environment's) or the file cannot be made: nothing is then open. */
bool wh_node_open(wh_node_t *node, const char *url, wh_recording_t *record);

/* Subscribes one channel, whose name must outlive the node. False if there is no room. */
bool wh_node_subscribe(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user);

/* The same, but what comes is not recorded: of a channel on which the node itself publishes, for over
 * multicast all that comes back. */
bool wh_node_overhear(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user);

/* Sends one datagram, of which nothing is kept. False when the network refused it. */
bool wh_node_publish(wh_node_t *node, const char *channel, const void *data, size_t size);

/* Handles at most one message, waiting up to so many microseconds. Returns 1 when one was handled, 0 when
 * none came, -1 when LCM failed. Signals end the wait early. Cost besides the message's: one call of the
 * system for a message that is there, two more for one that is waited for. */
int wh_node_wait(wh_node_t *node, int64_t timeout_us);

/* Handles what is there, without waiting, at most `most` messages; returns how many. */
int wh_node_drain(wh_node_t *node, int most);

/* A descriptor that is readable when a message is there. */
int wh_node_descriptor(const wh_node_t *node);

/* Closes LCM. */
void wh_node_close(wh_node_t *node);

/* Tells people a line, cut at 599 bytes: on standard error, or to the listener. The speaker stands before it;
 * with `log_time` the time (UTC) and the level, too: "2026-11-22T21:55:03.123Z info sim: ...". */
void wh_node_say(const wh_node_t *node, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same, of something that is not as it should be: its level is "warning". */
void wh_node_warn(const wh_node_t *node, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* us of a clock that never jumps. */
int64_t wh_node_clock_us(void);

#endif
