#include "receiver.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
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

/* A whole number that ends where `end` says; -1 if there is none. */
static long number(const char *text, const char *end) {
    char *stop;
    const long value = *text >= '0' && *text <= '9' ? strtol(text, &stop, 10) : -1;
    return value >= 0 && stop == end ? value : -1;
}

const char *wh_multicast_parse(const char *url, wh_multicast_t *multicast) {
    char address[INET_ADDRSTRLEN];
    const char *begin = url + strlen(SCHEME);
    const size_t length = strcspn(begin, ":?");
    const char *options = begin + strcspn(begin, "?");
    const char *buffer = strstr(options, "recv_buf_size=");
    memset(multicast, 0, sizeof *multicast);
    snprintf(address, sizeof address, "%.*s", (int)(length < sizeof address ? length : 0), begin);
    if (inet_pton(AF_INET, address, &multicast->address) != 1 || !IN_MULTICAST(ntohl(multicast->address))) {
        return "expected an address of multicast, 224.0.0.0 to 239.255.255.255, as in "
               "udpm://239.255.76.67:7667";
    }
    const long port = begin[length] == ':' ? number(begin + length + 1, options) : -1;
    if (port < 1 || port > 65535) {
        return "expected a port from 1 to 65535 behind the address, as in udpm://239.255.76.67:7667";
    }
    multicast->port = (uint16_t)port;
    multicast->buffer_bytes = buffer ? (int)strtol(buffer + strlen("recv_buf_size="), NULL, 10) : 0;
    return NULL;
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

bool wh_receiver_take(wh_receiver_t *receiver, wh_received_t *message) {
    for (int datagrams = 0; datagrams < WH_RECEIVER_MOST; ++datagrams) {
        const ssize_t size =
            recv(receiver->socket, receiver->datagram, sizeof receiver->datagram, MSG_DONTWAIT | MSG_TRUNC);
        if (size < 0) {
            return false;
        }
        if ((size_t)size <= sizeof receiver->datagram && parse(receiver->datagram, (size_t)size, message)) {
            return true;
        }
        ++receiver->dropped;
    }
    return false;
}
