#include "allow.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

/* An IPv4 address among those of IPv6: ::ffff:a.b.c.d. */
static void map_four(const struct in_addr *four, uint8_t bytes[16]) {
    memset(bytes, 0, 10);
    bytes[10] = bytes[11] = 0xFF;
    memcpy(bytes + 12, four, 4);
}

static bool read_bits(const char *text, unsigned most, unsigned *bits) {
    char *end = NULL;
    const unsigned long value = strtoul(text, &end, 10);
    *bits = (unsigned)value;
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && value <= most;
}

bool wh_allow_add(wh_allow_t *allow, const char *text) {
    char address[INET6_ADDRSTRLEN];
    struct in_addr four;
    const char *slash = strchr(text, '/');
    const size_t length = slash ? (size_t)(slash - text) : strlen(text);
    if (allow->count == WH_ALLOW_MOST || length >= sizeof address) {
        return false;
    }
    memcpy(address, text, length);
    address[length] = '\0';
    wh_allowed_t *to = &allow->of[allow->count];
    const bool is_four = inet_pton(AF_INET, address, &four) == 1;
    if (is_four) {
        map_four(&four, to->bytes);
    } else if (inet_pton(AF_INET6, address, to->bytes) != 1) {
        return false;
    }
    const unsigned most = is_four ? 32 : 128;
    unsigned bits = most;
    if (slash && !read_bits(slash + 1, most, &bits)) {
        return false;
    }
    to->bits = 128 - most + bits;
    ++allow->count;
    return true;
}

static bool has_bits(const wh_allowed_t *allowed, const uint8_t bytes[16]) {
    const unsigned whole = allowed->bits / 8;
    const unsigned rest = allowed->bits % 8;
    return memcmp(allowed->bytes, bytes, whole) == 0 &&
           (rest == 0 || ((allowed->bytes[whole] ^ bytes[whole]) >> (8 - rest)) == 0);
}

bool wh_allow_has(const wh_allow_t *allow, const struct sockaddr *from) {
    static const uint8_t loopback[16] = {[15] = 1};
    static const uint8_t four_local[13] = {[10] = 0xFF, [11] = 0xFF, [12] = 127};
    uint8_t bytes[16] = {0};
    if (from->sa_family == AF_INET) {
        struct sockaddr_in four;
        memcpy(&four, from, sizeof four);
        map_four(&four.sin_addr, bytes);
    } else {
        struct sockaddr_in6 six;
        memcpy(&six, from, sizeof six);
        memcpy(bytes, &six.sin6_addr, sizeof bytes);
    }
    bool has = memcmp(bytes, loopback, sizeof bytes) == 0 || memcmp(bytes, four_local, 13) == 0;
    for (size_t i = 0; i < allow->count && !has; ++i) {
        has = has_bits(&allow->of[i], bytes);
    }
    return has;
}
