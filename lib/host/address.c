#include "address.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool read_number(const char *text, uint16_t *number) {
    char *end = NULL;
    const unsigned long value = strtoul(text, &end, 10);
    *number = (uint16_t)value;
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && value <= 65535;
}

/* The host in a text of `size` bytes, which has brackets if, and only if, there is a colon in it. */
static bool take_host(const char *text, size_t size, char host[INET6_ADDRSTRLEN]) {
    const bool has_brackets = size > 2 && text[0] == '[' && text[size - 1] == ']';
    text += has_brackets ? 1 : 0;
    size -= has_brackets ? 2 : 0;
    if (size == 0 || size >= INET6_ADDRSTRLEN || has_brackets != (memchr(text, ':', size) != NULL)) {
        return false;
    }
    (void)snprintf(host, INET6_ADDRSTRLEN, "%.*s", (int)size, text);
    return true;
}

/* Splits "HOST:PORT", "[HOST]:PORT" and "PORT"; no host is 127.0.0.1. */
static bool split_address(const char *text, char host[INET6_ADDRSTRLEN], uint16_t *number) {
    const char *colon = strrchr(text, ':');
    if (colon) {
        return take_host(text, (size_t)(colon - text), host) && read_number(colon + 1, number);
    }
    (void)snprintf(host, INET6_ADDRSTRLEN, "127.0.0.1");
    return read_number(text, number);
}

bool wh_address_read(const char *text, wh_address_t *address) {
    char host[INET6_ADDRSTRLEN];
    uint16_t number = 0;
    memset(address, 0, sizeof *address);
    if (!split_address(text, host, &number)) {
        return false;
    }
    struct sockaddr_in four = {.sin_family = AF_INET, .sin_port = htons(number)};
    struct sockaddr_in6 six = {.sin6_family = AF_INET6, .sin6_port = htons(number)};
    if (inet_pton(AF_INET, host, &four.sin_addr) == 1) {
        memcpy(&address->bytes, &four, sizeof four);
        address->size = sizeof four;
    } else if (inet_pton(AF_INET6, host, &six.sin6_addr) == 1) {
        memcpy(&address->bytes, &six, sizeof six);
        address->size = sizeof six;
    }
    return address->size > 0;
}

/* The family's own form of the address. */
static struct sockaddr_in four_of(const wh_address_t *address) {
    struct sockaddr_in four;
    memcpy(&four, &address->bytes, sizeof four);
    return four;
}

static struct sockaddr_in6 six_of(const wh_address_t *address) {
    struct sockaddr_in6 six;
    memcpy(&six, &address->bytes, sizeof six);
    return six;
}

void wh_address_write(const wh_address_t *address, char *text, size_t size) {
    char host[INET6_ADDRSTRLEN] = "";
    const struct sockaddr_in four = four_of(address);
    const struct sockaddr_in6 six = six_of(address);
    if (address->bytes.ss_family == AF_INET) {
        (void)inet_ntop(AF_INET, &four.sin_addr, host, sizeof host);
        (void)snprintf(text, size, "%s:%u", host, (unsigned)ntohs(four.sin_port));
    } else {
        (void)inet_ntop(AF_INET6, &six.sin6_addr, host, sizeof host);
        (void)snprintf(text, size, "[%s]:%u", host, (unsigned)ntohs(six.sin6_port));
    }
}

bool wh_address_is_local(const wh_address_t *address) {
    const struct sockaddr_in four = four_of(address);
    const struct sockaddr_in6 six = six_of(address);
    return address->bytes.ss_family == AF_INET
               ? ntohl(four.sin_addr.s_addr) >> 24 == 127
               : memcmp(&six.sin6_addr, &in6addr_loopback, sizeof six.sin6_addr) == 0;
}

bool wh_address_is_any(const wh_address_t *address) {
    const struct sockaddr_in four = four_of(address);
    const struct sockaddr_in6 six = six_of(address);
    return address->bytes.ss_family == AF_INET
               ? four.sin_addr.s_addr == htonl(INADDR_ANY)
               : memcmp(&six.sin6_addr, &in6addr_any, sizeof six.sin6_addr) == 0;
}
