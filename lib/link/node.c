#include "node.h"

#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define NO_ROUTE                                                                                             \
    "LCM is not to be had at this URL (expected a multicast route, as by "                                   \
    "`ip route add 224.0.0.0/4 dev lo`, or another URL)"

static int64_t now_us(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

int64_t wh_node_wall_us(void) {
    return now_us(CLOCK_REALTIME);
}

int64_t wh_node_clock_us(void) {
    return now_us(CLOCK_MONOTONIC);
}

/* What is wrong, or null. */
static const char *open_multicast(wh_receiver_t *receiver, const char *url) {
    wh_multicast_t multicast;
    const char *expected = wh_multicast_parse(url, &multicast);
    if (expected) {
        return expected;
    }
    if (!wh_receiver_open(receiver, &multicast)) {
        return errno == ENODEV ? NO_ROUTE : strerror(errno);
    }
    return NULL;
}

static bool connect_to(wh_node_t *node, const char *url) {
    const char *problem = wh_multicast_is(url) ? open_multicast(&node->receiver, url) : NULL;
    if (!problem) {
        node->lcm = lcm_create(url);
        problem = node->lcm ? NULL : NO_ROUTE;
    }
    if (problem) {
        fprintf(stderr, "%s: %s\n", url, problem);
    }
    return problem == NULL;
}

bool wh_node_open(wh_node_t *node, const char *url, wh_recording_t *record) {
    const char *from_environment = getenv("LCM_DEFAULT_URL");
    const char *fallback = from_environment && from_environment[0] ? from_environment : WH_NODE_URL;
    memset(node, 0, sizeof *node);
    node->receiver.socket = -1;
    node->record = record && record->options.path ? record : NULL;
    const bool sound =
        connect_to(node, url ? url : fallback) && (!node->record || wh_recording_open(node->record));
    if (!sound) {
        wh_node_close(node);
    }
    return sound;
}

static void keep(wh_node_t *node, const char *channel, const void *data, size_t size) {
    if (node->record) {
        wh_recording_message(node->record, channel, data, size);
    }
}

/* Recorded before it is handled: the log has each message before what follows from it. */
static void hand_over(const wh_node_subscriber_t *subscriber, const void *data, size_t size) {
    ++subscriber->node->received;
    keep(subscriber->node, subscriber->channel, data, size);
    subscriber->handler(subscriber->user, data, size);
}

static void receive(const lcm_recv_buf_t *message, const char *channel, void *user) {
    (void)channel;
    hand_over(user, message->data, message->data_size);
}

bool wh_node_subscribe(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user) {
    if (node->subscriber_count == WH_NODE_SUBSCRIPTIONS) {
        return false;
    }
    wh_node_subscriber_t *subscriber = &node->subscribers[node->subscriber_count++];
    *subscriber = (wh_node_subscriber_t){node, channel, handler, user};
    if (node->receiver.socket >= 0) {
        return true;
    }
    lcm_subscription_t *subscription = lcm_subscribe(node->lcm, channel, receive, subscriber);
    /* No limit: a queue that drops would look like a network that loses. */
    return subscription && lcm_subscription_set_queue_capacity(subscription, 0) == 0;
}

bool wh_node_publish(wh_node_t *node, const char *channel, const void *data, size_t size) {
    ++node->published;
    keep(node, channel, data, size);
    return lcm_publish(node->lcm, channel, data, (unsigned)size) == 0;
}

/* Messages of channels without a subscriber are other programs'. */
static int take(wh_node_t *node) {
    wh_received_t message;
    if (!wh_receiver_take(&node->receiver, &message)) {
        return 0;
    }
    for (size_t i = 0; i < node->subscriber_count; ++i) {
        if (strcmp(node->subscribers[i].channel, message.channel) == 0) {
            hand_over(&node->subscribers[i], message.data, message.size);
        }
    }
    return 1;
}

int wh_node_wait(wh_node_t *node, int64_t timeout_us) {
    struct pollfd ready = {.fd = wh_node_descriptor(node), .events = POLLIN};
    /* LCM's own wait counts in ms, which may be longer than a slice. */
    const int64_t us = timeout_us > 0 ? timeout_us : 0;
    const struct timespec timeout = {.tv_sec = us / 1000000, .tv_nsec = us % 1000000 * 1000};
    const int count = ppoll(&ready, 1, &timeout, NULL);
    if (count <= 0) {
        node->interrupted = node->interrupted || count < 0;
        return 0;
    }
    if (node->receiver.socket >= 0) {
        return take(node);
    }
    return lcm_handle_timeout(node->lcm, 0) < 0 ? -1 : 1;
}

int wh_node_drain(wh_node_t *node, int most) {
    int handled = 0;
    while (handled < most && wh_node_wait(node, 0) > 0) {
        ++handled;
    }
    return handled;
}

int wh_node_descriptor(const wh_node_t *node) {
    return node->receiver.socket >= 0 ? node->receiver.socket : lcm_get_fileno(node->lcm);
}

void wh_node_close(wh_node_t *node) {
    wh_receiver_close(&node->receiver);
    if (node->lcm) {
        lcm_destroy(node->lcm);
        node->lcm = NULL;
    }
}

void wh_node_say(const wh_node_t *node, const char *format, ...) {
    char text[200];
    va_list arguments;
    if (node->speaker) {
        va_start(arguments, format);
        (void)vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        fprintf(stderr, "%s: %s\n", node->speaker, text);
    }
}
