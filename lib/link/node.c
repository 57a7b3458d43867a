#include "node.h"

#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

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

bool wh_node_open(wh_node_t *node, const char *url, const char *record) {
    const char *from_environment = getenv("LCM_DEFAULT_URL");
    const char *fallback = from_environment && from_environment[0] ? from_environment : WH_NODE_URL;
    memset(node, 0, sizeof *node);
    node->lcm = lcm_create(url ? url : fallback);
    if (!node->lcm) {
        fprintf(stderr,
                "%s: LCM is not to be had at this URL (expected a multicast route, as by `ip route add "
                "224.0.0.0/4 dev lo`, or another URL)\n",
                url ? url : WH_NODE_URL);
        return false;
    }
    node->log = record ? lcm_eventlog_create(record, "w") : NULL;
    if (record && !node->log) {
        fprintf(stderr, "%s: %s (expected a file that can be written)\n", record, strerror(errno));
        wh_node_close(node);
        return false;
    }
    return true;
}

static void fail_record(wh_node_t *node) {
    node->log_failed = true;
    fprintf(stderr, "record: writing failed; what was written so far stays\n");
}

void wh_node_flush_record(wh_node_t *node) {
    if (node->log && !node->log_failed && fflush(node->log->f) != 0) {
        fail_record(node);
    }
}

/* Writes what lcm-logger would. LCM's type has plain pointers, though it only reads what they point to. */
static void keep(wh_node_t *node, const char *channel, const void *data, size_t size) {
    union {
        const void *constant;
        void *plain;
    } bytes = {data};
    char name[LCM_MAX_CHANNEL_NAME_LENGTH + 1];
    if (!node->log || node->log_failed) {
        return;
    }
    snprintf(name, sizeof name, "%s", channel);
    lcm_eventlog_event_t event = {.timestamp = wh_node_wall_us(),
                                  .channellen = (int32_t)strlen(name),
                                  .datalen = (int32_t)size,
                                  .channel = name,
                                  .data = bytes.plain};
    if (lcm_eventlog_write_event(node->log, &event) != 0) {
        fail_record(node);
    }
}

static void receive(const lcm_recv_buf_t *message, const char *channel, void *user) {
    const wh_node_subscriber_t *subscriber = user;
    ++subscriber->node->received;
    /* Recorded before it is handled: the log has each message before what follows from it. */
    keep(subscriber->node, channel, message->data, message->data_size);
    subscriber->handler(subscriber->user, message->data, message->data_size);
}

bool wh_node_subscribe(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user) {
    if (node->subscriber_count == WH_NODE_SUBSCRIPTIONS) {
        return false;
    }
    wh_node_subscriber_t *subscriber = &node->subscribers[node->subscriber_count++];
    subscriber->node = node;
    subscriber->handler = handler;
    subscriber->user = user;
    lcm_subscription_t *subscription = lcm_subscribe(node->lcm, channel, receive, subscriber);
    /* No limit: a queue that drops would look like a network that loses. */
    return subscription && lcm_subscription_set_queue_capacity(subscription, 0) == 0;
}

bool wh_node_publish(wh_node_t *node, const char *channel, const void *data, size_t size) {
    ++node->published;
    keep(node, channel, data, size);
    return lcm_publish(node->lcm, channel, data, (unsigned)size) == 0;
}

int wh_node_wait(wh_node_t *node, int64_t timeout_us) {
    struct pollfd ready = {.fd = lcm_get_fileno(node->lcm), .events = POLLIN};
    /* LCM's own wait counts in ms, which may be longer than a slice. */
    const int64_t us = timeout_us > 0 ? timeout_us : 0;
    const struct timespec timeout = {.tv_sec = us / 1000000, .tv_nsec = us % 1000000 * 1000};
    const int count = ppoll(&ready, 1, &timeout, NULL);
    if (count <= 0) {
        node->interrupted = node->interrupted || count < 0;
        return 0;
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
    return lcm_get_fileno(node->lcm);
}

void wh_node_close(wh_node_t *node) {
    if (node->log) {
        lcm_eventlog_destroy(node->log);
        node->log = NULL;
    }
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
