/* A process on LCM: publishing, subscriptions that drop nothing, a wait with a short time limit, and
 * recording.
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

/* Nothing leaves the host unless the user asks for another URL. */
#define WH_NODE_URL "udpm://239.255.76.67:7667?ttl=0"

#define WH_NODE_SUBSCRIPTIONS 16

typedef struct wh_node wh_node_t;

/* A function that takes a datagram: its bytes are valid until the call returns. */
typedef void wh_node_handler_t(void *user, const void *data, size_t size);

typedef struct {
    wh_node_t *node;
    const char *channel; /* the caller's */
    wh_node_handler_t *handler;
    void *user;
    bool overhears; /* the messages that it hears are not recorded */
} wh_node_subscriber_t;

/* A function that takes a line for people; without its end. */
typedef void wh_node_listener_t(void *user, const char *line);

/* The senders on a channel that should have only one. It is all zero at the beginning. */
typedef struct {
    uint64_t last, other; /* the last one, and the other one before it; 0: unknown */
    bool shared;          /* both of them send */
} wh_senders_t;

/* Hears a message of this sender; 0: unknown. True, once, if two send in turns. A process that was started
 * again sends from another socket, and never again from the old one. */
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

/* Records all messages that a node hears and sends: see log/recording.h. `open` is called once LCM is
 * open; if it returns false, it has told why. */
typedef struct {
    bool (*open)(void *user);
    void (*message)(void *user, const char *channel, const void *data, size_t size);
    void *user;
} wh_node_recorder_t;

struct wh_node {
    const char *speaker; /* who speaks in wh_node_say's lines, such as "sim"; null, as at first: nobody */
    bool log_time;       /* lines begin with the time and a level */
    wh_node_listener_t *listener; /* takes the lines in place of standard error; null: there is none */
    void *listener_user;
    lcm_t *lcm;                  /* sends; receives if the URL is not multicast */
    wh_receiver_t receiver;      /* receives multicast */
    wh_node_recorder_t recorder; /* without functions: not recording */
    bool interrupted;            /* a signal ended a wait since this was last cleared */
    uint64_t sender;             /* of the message that is being handled: see wh_received_t */
    wh_node_subscriber_t subscribers[WH_NODE_SUBSCRIPTIONS];
    size_t subscriber_count;
};

/* False, and standard error says why, if the URL (null: as in wh_node_open) reaches nobody outside of this
 * process. Such a URL is of memory or of a file. */
bool wh_node_reaches_others(const char *url);

/* Opens LCM at a URL (null: LCM_DEFAULT_URL of the environment, or WH_NODE_URL), and then the recorder, if
 * there is one: it may be null. The recorder's user stays the caller's, who closes it after the node. The
 * node must not be moved afterwards. Returns false, and standard error says why, when LCM cannot open it
 * or the recorder cannot begin; nothing is then open. The reason may be a missing multicast route or a bad
 * URL, and names its origin: --lcm-url or the environment. */
bool wh_node_open(wh_node_t *node, const char *url, const wh_node_recorder_t *recorder);

/* Subscribes one channel, whose name must outlive the node. Returns false if there is no room. */
bool wh_node_subscribe(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user);

/* Subscribes without recording. It is for a channel on which the node itself publishes: over multicast all
 * its messages come back. */
bool wh_node_overhear(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user);

/* Sends one datagram and keeps nothing of it. Returns false when the network refused it. */
bool wh_node_publish(wh_node_t *node, const char *channel, const void *data, size_t size);

/* Handles at most one message, waiting up to `timeout_us` microseconds. Returns 1 when one was handled, 0
 * when none came, -1 when LCM failed. Signals end the wait early. Cost besides the message's: one system
 * call for a message that is there, two more for one that comes later. */
int wh_node_wait(wh_node_t *node, int64_t timeout_us);

/* Handles at most `most` messages that are there, without waiting; returns their number. */
int wh_node_drain(wh_node_t *node, int most);

/* A descriptor that is readable when a message is there. */
int wh_node_descriptor(const wh_node_t *node);

/* Closes LCM. */
void wh_node_close(wh_node_t *node);

/* Tells people a line, cut at 599 bytes: on standard error, or to the listener. The speaker stands before
 * it; with `log_time` also the time (UTC) and the level: "2026-11-22T21:55:03.123Z info sim: ...". */
void wh_node_say(const wh_node_t *node, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Tells a problem likewise, with the level "warning". */
void wh_node_warn(const wh_node_t *node, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Returns the time in us of a clock that never jumps. */
int64_t wh_node_clock_us(void);

#endif
