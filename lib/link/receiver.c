#include "receiver.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define SCHEME "udpm://"
#define HEADER_BYTES 8
#define CHANNEL_BYTES 64
#define FULL_BUFFER_BYTES (8 << 20)

/* ---------------------------------------------------------------------------------------------------- URL */

bool wh_multicast_is(const char *url) {
    return strncmp(url, SCHEME, strlen(SCHEME)) == 0;
}

/* A part of a URL. */
typedef struct {
    const char *text;
    size_t length;
} part_t;

/* Up to one of these characters or the end. */
static part_t part_at(const char *text, const char *ends) {
    return (part_t){text, strcspn(text, ends)};
}

/* A whole number up to `most`, written as people do; -1 if there is none: not 07, which liblcm would take for
 * an octal one. */
static int64_t number(part_t part, int64_t most) {
    int64_t value = 0;
    for (size_t i = 0; i < part.length && value <= most; ++i) {
        const char digit = part.text[i];
        value = digit >= '0' && digit <= '9' ? 10 * value + (digit - '0') : INT64_MAX;
    }
    const bool led_by_zero = part.length > 1 && part.text[0] == '0';
    return part.length > 0 && !led_by_zero && value <= most ? value : -1;
}

/* At most so much of what a user typed is repeated. */
static int shown(part_t part) {
    return part.length < 40 ? (int)part.length : 40;
}

static bool refuse(char *problem, part_t name, part_t given, const char *expected) {
    const part_t value = given.length > 0 ? given : part_at("nothing", "");
    snprintf(problem, WH_MULTICAST_PROBLEM_BYTES, "%.*s: %.*s (expected %s)", shown(name), name.text,
             shown(value), value.text, expected);
    return false;
}

static bool is_named(part_t part, const char *name) {
    return part.length == strlen(name) && strncmp(part.text, name, part.length) == 0;
}

/* One of liblcm's options, up to the next `&`. */
static bool take_option(const char *text, wh_multicast_t *multicast, char *problem) {
    const part_t name = part_at(text, "=&");
    const part_t value = text[name.length] == '=' ? part_at(text + name.length + 1, "&") : (part_t){"", 0};
    if (is_named(name, "ttl")) {
        return number(value, 255) >= 0 || refuse(problem, name, value, "a whole number from 0 to 255");
    }
    if (is_named(name, "recv_buf_size")) {
        const int64_t bytes = number(value, INT32_MAX);
        multicast->buffer_bytes = bytes > 0 ? (int)bytes : 0;
        return bytes >= 0 || refuse(problem, name, value, "a whole number of bytes from 0 to 2147483647");
    }
    return refuse(problem, name, value, "ttl=... or recv_buf_size=..., with a & between them");
}

static bool take_options(const char *options, wh_multicast_t *multicast, char *problem) {
    const char *text = options;
    while (*text != '\0') {
        ++text; /* the `?`, or a `&` */
        if (!take_option(text, multicast, problem)) {
            return false;
        }
        text += strcspn(text, "&");
    }
    return true;
}

bool wh_multicast_parse(const char *url, wh_multicast_t *multicast,
                        char problem[WH_MULTICAST_PROBLEM_BYTES]) {
    char text[INET_ADDRSTRLEN];
    const part_t address = part_at(url + strlen(SCHEME), ":?");
    const char *behind = address.text + address.length;
    const part_t port = behind[0] == ':' ? part_at(behind + 1, "?") : (part_t){"", 0};
    memset(multicast, 0, sizeof *multicast);
    snprintf(text, sizeof text, "%.*s", (int)(address.length < sizeof text ? address.length : 0),
             address.text);
    if (inet_pton(AF_INET, text, &multicast->address) != 1 || !IN_MULTICAST(ntohl(multicast->address))) {
        return refuse(problem, part_at("address", ""), address,
                      "one of multicast, 224.0.0.0 to 239.255.255.255, as in udpm://239.255.76.67:7667");
    }
    if (number(port, 65535) < 1) {
        return refuse(problem, part_at("port", ""), port,
                      "1 to 65535 behind the address, as in udpm://239.255.76.67:7667");
    }
    multicast->port = (uint16_t)number(port, 65535);
    return take_options(url + strcspn(url, "?"), multicast, problem);
}

/* ------------------------------------------------------------------------------------------------- socket */

/* Many processes of one host share the port. The buffer is as large as the system allows: what does not fit
 * is lost, as on a network. */
static bool set_options(int socket, const wh_multicast_t *multicast) {
    const int on = 1;
    const int bytes = multicast->buffer_bytes > 0 ? multicast->buffer_bytes : FULL_BUFFER_BYTES;
    const struct ip_mreq group = {.imr_multiaddr.s_addr = multicast->address,
                                  .imr_interface.s_addr = htonl(INADDR_ANY)};
    const struct sockaddr_in place = {
        .sin_family = AF_INET, .sin_addr.s_addr = multicast->address, .sin_port = htons(multicast->port)};
    if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
        (void)setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    }
    return setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
           setsockopt(socket, SOL_SOCKET, SO_REUSEPORT, &on, sizeof on) == 0 &&
           bind(socket, (const struct sockaddr *)&place, sizeof place) == 0 &&
           setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) == 0;
}

bool wh_receiver_open(wh_receiver_t *receiver, const wh_multicast_t *multicast) {
    receiver->dropped = 0;
    receiver->socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (receiver->socket >= 0 && !set_options(receiver->socket, multicast)) {
        wh_receiver_close(receiver);
    }
    return receiver->socket >= 0;
}

void wh_receiver_close(wh_receiver_t *receiver) {
    if (receiver->socket >= 0) {
        (void)close(receiver->socket);
    }
    receiver->socket = -1;
}

/* ----------------------------------------------------------------------------------------------- messages */

static bool parse(const uint8_t *datagram, size_t size, wh_received_t *message) {
    static const uint8_t whole[4] = {'L', 'C', '0', '2'};
    if (size <= HEADER_BYTES || memcmp(datagram, whole, sizeof whole) != 0) {
        return false;
    }
    const uint8_t *channel = datagram + HEADER_BYTES;
    const size_t left = size - HEADER_BYTES;
    const uint8_t *end = memchr(channel, 0, left < CHANNEL_BYTES ? left : CHANNEL_BYTES);
    if (!end) {
        return false;
    }
    message->channel = (const char *)channel;
    message->data = end + 1;
    message->size = size - (size_t)(end + 1 - datagram);
    return true;
}

/* Address and port; of other sockets 0. */
static uint64_t sender_of(const struct sockaddr_in *from, socklen_t size) {
    if (size != sizeof *from || from->sin_family != AF_INET) {
        return 0;
    }
    return (uint64_t)ntohl(from->sin_addr.s_addr) << 16 | ntohs(from->sin_port);
}

bool wh_receiver_take(wh_receiver_t *receiver, wh_received_t *message) {
    for (int datagrams = 0; datagrams < WH_RECEIVER_MOST; ++datagrams) {
        struct sockaddr_in from = {.sin_family = AF_UNSPEC};
        socklen_t from_size = sizeof from;
        const ssize_t size = recvfrom(receiver->socket, receiver->datagram, sizeof receiver->datagram,
                                      MSG_DONTWAIT | MSG_TRUNC, (struct sockaddr *)&from, &from_size);
        if (size < 0) {
            return false;
        }
        if ((size_t)size <= sizeof receiver->datagram && parse(receiver->datagram, (size_t)size, message)) {
            message->sender = sender_of(&from, from_size);
            return true;
        }
        ++receiver->dropped;
    }
    return false;
}
