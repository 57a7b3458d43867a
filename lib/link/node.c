#include "node.h"

#include <errno.h>
#include <netdb.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "../text/clock.h"

#define NO_ROUTE                                                                                             \
    "LCM is not to be had at this URL (expected a multicast route, as by "                                   \
    "`ip route add 224.0.0.0/4 dev lo`, or another URL)"
#define NO_SCHEME                                                                                            \
    "scheme (expected a URL that begins with udpm://, as in udpm://239.255.76.67:7667, or with another "     \
    "scheme of LCM's)"

int64_t wh_node_clock_us(void) {
    return wh_clock_us(CLOCK_MONOTONIC);
}

/* ---------------------------------------------------------------------------------------------------- URL */

/* A URL, and who gave it; null: nobody, because it is the default. */
typedef struct {
    const char *text, *giver;
} url_t;

static url_t url_of(const char *given) {
    const char *from_environment = getenv("LCM_DEFAULT_URL");
    if (given) {
        return (url_t){given, "--lcm-url"};
    }
    if (from_environment && from_environment[0]) {
        return (url_t){from_environment, "LCM_DEFAULT_URL"};
    }
    return (url_t){WH_NODE_URL, NULL};
}

static void refuse_url(const url_t *url, const char *problem) {
    fprintf(stderr, "%s%s%s: %s\n", url->giver ? url->giver : "", url->giver ? ": " : "", url->text, problem);
}

static bool begins_with(const char *text, const char *const beginnings[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        if (strncmp(text, beginnings[i], strlen(beginnings[i])) == 0) {
            return true;
        }
    }
    return false;
}

bool wh_node_reaches_others(const char *url) {
    static const char *const alone[] = {"memq:", "file:"};
    const url_t asked = url_of(url);
    const bool is_alone = begins_with(asked.text, alone, sizeof alone / sizeof alone[0]);
    if (is_alone) {
        refuse_url(&asked, "scheme (expected one that reaches another process, as udpm:// does: this one "
                           "stays within the process or a file)");
    }
    return !is_alone;
}

static bool open_multicast(wh_receiver_t *receiver, const url_t *url) {
    wh_multicast_t multicast;
    char problem[WH_MULTICAST_PROBLEM_BYTES];
    const bool sound = wh_multicast_parse(url->text, &multicast, problem);
    if (sound && wh_receiver_open(receiver, &multicast)) {
        return true;
    }
    const char *reason = errno == ENODEV ? NO_ROUTE : strerror(errno);
    refuse_url(url, sound ? reason : problem);
    return false;
}

/* True if a server listens where LCM's tcpq:// would look for one; LCM would try for ever without a
 * message. */
static bool is_answered(const char *text) {
    char host[256];
    const struct addrinfo wanted = {.ai_family = AF_INET, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    (void)snprintf(host, sizeof host, "%.*s", (int)strcspn(text, "?"), text);
    char *port = strrchr(host, ':');
    if (port) {
        *port = '\0';
    }
    bool answered = false;
    if (getaddrinfo(host[0] ? host : "127.0.0.1", port && port[1] ? port + 1 : "7700", &wanted, &found) ==
        0) {
        const int fd = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        answered = fd >= 0 && connect(fd, found->ai_addr, found->ai_addrlen) == 0;
        if (fd >= 0) {
            (void)close(fd);
        }
        freeaddrinfo(found);
    }
    return answered;
}

static bool connect_to(wh_node_t *node, const url_t *url) {
    static const char *const schemes[] = {"udpm://", "mpudpm://", "tcpq://", "memq://", "file://"};
    if (!begins_with(url->text, schemes, sizeof schemes / sizeof schemes[0])) {
        refuse_url(url, NO_SCHEME);
        return false;
    }
    if (wh_multicast_is(url->text) && !open_multicast(&node->receiver, url)) {
        return false;
    }
    if (begins_with(url->text, &schemes[2], 1) && !is_answered(url->text + strlen(schemes[2]))) {
        refuse_url(url, "nobody answers there (expected a running server, such as lcm-tcpq-server)");
        return false;
    }
    node->lcm = lcm_create(url->text);
    if (!node->lcm) {
        refuse_url(url, strstr(url->text, "udpm://") == NULL
                            ? "LCM does not open this URL (expected one where a server or a file is)"
                            : NO_ROUTE);
    }
    return node->lcm != NULL;
}

bool wh_node_open(wh_node_t *node, const char *url, const wh_node_recorder_t *recorder) {
    const url_t asked = url_of(url);
    memset(node, 0, sizeof *node);
    node->receiver.socket = -1;
    if (recorder) {
        node->recorder = *recorder;
    }
    const bool sound =
        connect_to(node, &asked) && (!node->recorder.open || node->recorder.open(node->recorder.user));
    if (!sound) {
        wh_node_close(node);
    }
    return sound;
}

static void keep(wh_node_t *node, const char *channel, const void *data, size_t size) {
    if (node->recorder.message) {
        node->recorder.message(node->recorder.user, channel, data, size);
    }
}

/* A message is recorded before it is handled, so the log has each message before its consequences. */
static void hand_over(const wh_node_subscriber_t *subscriber, const void *data, size_t size) {
    if (!subscriber->overhears) {
        keep(subscriber->node, subscriber->channel, data, size);
    }
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
    *subscriber = (wh_node_subscriber_t){node, channel, handler, user, false};
    if (node->receiver.socket >= 0) {
        return true;
    }
    lcm_subscription_t *subscription = lcm_subscribe(node->lcm, channel, receive, subscriber);
    /* There is no limit: a queue that drops would look like a network that loses. */
    return subscription && lcm_subscription_set_queue_capacity(subscription, 0) == 0;
}

bool wh_node_overhear(wh_node_t *node, const char *channel, wh_node_handler_t *handler, void *user) {
    const bool subscribed = wh_node_subscribe(node, channel, handler, user);
    if (subscribed) {
        node->subscribers[node->subscriber_count - 1].overhears = true;
    }
    return subscribed;
}

bool wh_node_publish(wh_node_t *node, const char *channel, const void *data, size_t size) {
    keep(node, channel, data, size);
    return lcm_publish(node->lcm, channel, data, (unsigned)size) == 0;
}

/* Messages on channels without a subscriber belong to other programs. */
static int take(wh_node_t *node) {
    wh_received_t message;
    if (!wh_receiver_take(&node->receiver, &message)) {
        return 0;
    }
    node->sender = message.sender;
    for (size_t i = 0; i < node->subscriber_count; ++i) {
        if (strcmp(node->subscribers[i].channel, message.channel) == 0) {
            hand_over(&node->subscribers[i], message.data, message.size);
        }
    }
    return 1;
}

/* True if something can be read within `us` microseconds. LCM's own wait counts in ms, which may exceed a
 * slice. */
static bool is_readable(wh_node_t *node, int64_t us) {
    struct pollfd ready = {.fd = wh_node_descriptor(node), .events = POLLIN};
    const struct timespec timeout = {.tv_sec = us / 1000000, .tv_nsec = us % 1000000 * 1000};
    const int count = ppoll(&ready, 1, &timeout, NULL);
    node->interrupted = node->interrupted || count < 0;
    return count > 0;
}

/* It receives first: a process gets back what it has published at once, and often more has come. */
int wh_node_wait(wh_node_t *node, int64_t timeout_us) {
    const int64_t us = timeout_us > 0 ? timeout_us : 0;
    if (node->receiver.socket >= 0) {
        return take(node) == 1 || (us > 0 && is_readable(node, us) && take(node) == 1) ? 1 : 0;
    }
    if (!is_readable(node, us)) {
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
    return node->receiver.socket >= 0 ? node->receiver.socket : lcm_get_fileno(node->lcm);
}

void wh_node_close(wh_node_t *node) {
    wh_receiver_close(&node->receiver);
    if (node->lcm) {
        lcm_destroy(node->lcm);
        node->lcm = NULL;
    }
}

/* ------------------------------------------------------------------------------------------------- saying */

/* Writes the time in ISO 8601 format, in UTC and ms, and the level. */
static void put_time(char *text, size_t size, const char *level) {
    const int64_t us = wh_clock_us(CLOCK_REALTIME);
    const time_t seconds = (time_t)(us / 1000000);
    struct tm parts;
    char date[32];
    (void)gmtime_r(&seconds, &parts);
    (void)strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
    snprintf(text, size, "%s.%03dZ %s ", date, (int)(us % 1000000 / 1000), level);
}

__attribute__((format(printf, 3, 0))) static void say(const wh_node_t *node, const char *level,
                                                      const char *format, va_list arguments) {
    char text[600];
    char begin[64] = "";
    char line[sizeof begin + 40 + sizeof text];
    if (!node->speaker) {
        return;
    }
    (void)vsnprintf(text, sizeof text, format, arguments);
    if (node->log_time) {
        put_time(begin, sizeof begin, level);
    }
    snprintf(line, sizeof line, "%s%.30s: %s", begin, node->speaker, text);
    if (node->listener) {
        node->listener(node->listener_user, line);
    } else {
        fprintf(stderr, "%s\n", line);
    }
}

void wh_node_say(const wh_node_t *node, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(node, "info", format, arguments);
    va_end(arguments);
}

void wh_node_warn(const wh_node_t *node, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(node, "warning", format, arguments);
    va_end(arguments);
}
