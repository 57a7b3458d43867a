#include "receiver.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../text/array.h"

#define SCHEME "udpm://"
#define HEADER_BYTES 8
#define CHANNEL_BYTES 64
#define FULL_BUFFER_BYTES (8 << 20)

/* ---------------------------------------------------------------------------------------------------- URL */

bool wh_multicast_is(const char *url) {
    return strncmp(url, SCHEME, strlen(SCHEME)) == 0;
}

/* A whole number up to `most`, in plain decimal notation; -1 if there is none. 07 is refused, because
 * liblcm would take it for octal. */
static int64_t number(const char *text, int64_t most) {
    const size_t length = strlen(text);
    const bool led_by_zero = length > 1 && text[0] == '0';
    if (length == 0 || led_by_zero || strspn(text, "0123456789") != length) {
        return -1;
    }
    const int64_t value = strtoll(text, NULL, 10); /* the largest number there is, if it is too large */
    return value <= most ? value : -1;
}

/* The message repeats at most 40 bytes of the user's text. */
static bool refuse_option(char *problem, const char *name, const char *value, const char *expected) {
    snprintf(problem, WH_MULTICAST_PROBLEM_BYTES, "%.40s: %.40s (expected %s)", name,
             value[0] != '\0' ? value : "nothing", expected);
    return false;
}

static bool take_place(const char *address, const char *port, wh_multicast_t *multicast, char *problem) {
    if (inet_pton(AF_INET, address, &multicast->address) != 1 || !IN_MULTICAST(ntohl(multicast->address))) {
        return refuse_option(
            problem, "address", address,
            "one of multicast, 224.0.0.0 to 239.255.255.255, as in udpm://239.255.76.67:7667");
    }
    multicast->port = (uint16_t)number(port, 65535);
    return number(port, 65535) >= 1 ||
           refuse_option(problem, "port", port,
                         "1 to 65535 behind the address, as in udpm://239.255.76.67:7667");
}

/* Takes one of liblcm's options. */
static bool take_option(const char *name, const char *value, wh_multicast_t *multicast, char *problem) {
    if (strcmp(name, "ttl") == 0) {
        return number(value, 255) >= 0 || refuse_option(problem, name, value, "a whole number from 0 to 255");
    }
    if (strcmp(name, "recv_buf_size") == 0) {
        const int64_t bytes = number(value, INT32_MAX);
        multicast->buffer_bytes = bytes > 0 ? (int)bytes : 0;
        return bytes >= 0 ||
               refuse_option(problem, name, value, "a whole number of bytes from 0 to 2147483647");
    }
    return refuse_option(problem, name, value, "ttl=... or recv_buf_size=..., with a & between them");
}

bool wh_multicast_parse(const char *url, wh_multicast_t *multicast,
                        char problem[WH_MULTICAST_PROBLEM_BYTES]) {
    char *const copy = wh_text_copy(url + strlen(SCHEME));
    char *options = copy;
    char *port = strsep(&options, "?");
    const char *address = strsep(&port, ":");
    memset(multicast, 0, sizeof *multicast);
    bool sound = take_place(address, port ? port : "", multicast, problem);
    while (sound && options) {
        char *value = strsep(&options, "&");
        const char *name = strsep(&value, "=");
        sound = take_option(name, value ? value : "", multicast, problem);
    }
    free(copy);
    return sound;
}

/* ------------------------------------------------------------------------------------------------- socket */

/* Many processes of one host share the port. The buffer is as large as the system allows; excess messages
 * are lost, as on a network. */
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

/* Address and port as one number; 0 for other sockets. */
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
