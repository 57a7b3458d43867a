#include "fake_node.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "fuzz.h"

int64_t fuzz_clock_us;
bool (*fuzz_next_message)(wh_node_t *node);
void (*fuzz_on_publish)(const char *channel, const void *data, size_t size);

#define SUBSCRIPTIONS 32

static struct {
    const wh_node_t *node;
    const char *channel;
    wh_node_handler_t *handler;
    void *user;
} subscriptions[SUBSCRIPTIONS];
static size_t subscription_count;

bool wh_node_open(wh_node_t *node, const char *url, const wh_node_recorder_t *recorder) {
    (void)url;
    (void)recorder;
    memset(node, 0, sizeof *node);
    size_t kept = 0;
    for (size_t i = 0; i < subscription_count; ++i) {
        if (subscriptions[i].node != node) {
            subscriptions[kept++] = subscriptions[i];
        }
    }
    subscription_count = kept;
    return true;
}

bool wh_node_subscribe(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user) {
    REQUIRE(subscription_count < SUBSCRIPTIONS);
    subscriptions[subscription_count].node = node;
    subscriptions[subscription_count].channel = channel;
    subscriptions[subscription_count].handler = handler;
    subscriptions[subscription_count++].user = user;
    return true;
}

bool wh_node_overhear(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user) {
    return wh_node_subscribe(node, channel, handler, user);
}

void fuzz_deliver(wh_node_t *node, const char *channel, const void *data, size_t size) {
    uint8_t *const exact = malloc(size > 0 ? size : 1);
    REQUIRE(exact != NULL);
    if (size > 0) {
        memcpy(exact, data, size);
    }
    for (size_t i = 0; i < subscription_count; ++i) {
        if (subscriptions[i].node == node && strcmp(subscriptions[i].channel, channel) == 0) {
            subscriptions[i].handler(subscriptions[i].user, exact, size);
        }
    }
    free(exact);
}

bool wh_node_publish(wh_node_t *node, const char *channel, const void *data, size_t size) {
    (void)node;
    if (fuzz_on_publish) {
        fuzz_on_publish(channel, data, size);
    }
    return true;
}

int wh_node_wait(wh_node_t *node, int64_t timeout_us) {
    if (fuzz_next_message(node)) {
        fuzz_clock_us += 10;
        return 1;
    }
    fuzz_clock_us += timeout_us > 0 ? timeout_us : 0;
    return 0;
}

int wh_node_drain(wh_node_t *node, int most) {
    int handled = 0;
    while (handled < most && wh_node_wait(node, 0) > 0) {
        ++handled;
    }
    return handled;
}

int wh_node_descriptor(const wh_node_t *node) {
    (void)node;
    return -1;
}

void wh_node_close(wh_node_t *node) {
    (void)node;
}

int64_t wh_node_clock_us(void) {
    /* The number is never 0 and never repeats, as with a real node. */
    return ++fuzz_clock_us;
}

/* A complaint must be one line. Nobody reads it. */
__attribute__((format(printf, 1, 0))) static void check_line(const char *format, va_list arguments) {
    char text[600];
    REQUIRE(vsnprintf(text, sizeof text, format, arguments) > 0);
    REQUIRE(fuzz_is_one_line(text));
}

void wh_node_say(const wh_node_t *node, const char *format, ...) {
    va_list arguments;
    (void)node;
    va_start(arguments, format);
    check_line(format, arguments);
    va_end(arguments);
}

void wh_node_warn(const wh_node_t *node, const char *format, ...) {
    va_list arguments;
    (void)node;
    va_start(arguments, format);
    check_line(format, arguments);
    va_end(arguments);
}
