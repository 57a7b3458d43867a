/* garbage URL COUNT SEED: sends COUNT datagrams that are no messages on all channels that the two
 * processes receive. They are random bytes, and real messages that it has overheard: cut short,
 * with flipped bits, wrong fingerprints, huge counts, NaN, or on the wrong channel. Some are
 * fragments with impossible places, and channels whose names have no end, which liblcm 1.3.1 does
 * not survive. It prints how many of each kind it sent. */
#include <arpa/inet.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

#include "link/node.h"
#include "wire/messages.h"

#define CHANNELS 6
#define KINDS 7
/* After this number of others come the two kinds that bypass liblcm, which would not send them. */
#define RAW_EVERY 64

static const char *const channels[CHANNELS] = {WH_CHANNEL_COMMAND, WH_CHANNEL_STATE,   WH_CHANNEL_RESTORE,
                                               WH_CHANNEL_MCS,     WH_CHANNEL_REQUEST, WH_CHANNEL_CELL};

/* The last sound message of each channel. */
static struct {
    uint8_t bytes[WH_LINK_DATAGRAM];
    size_t size;
} overheard[CHANNELS];

static uint64_t random_state;

/* splitmix64 */
static uint32_t below(size_t n) {
    uint64_t z = (random_state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)((uint64_t)((z ^ (z >> 31)) >> 32) * n >> 32);
}

static void overhear(void *user, const void *data, size_t size) {
    const size_t channel = (size_t)((const char *const *)user - channels);
    /* Our own garbage comes back, too: only a datagram with the fingerprint is a message. */
    if (size >= 8 && overheard[channel].size == 0) {
        memcpy(overheard[channel].bytes, data, size);
        overheard[channel].size = size;
    }
}

static size_t random_bytes(uint8_t *bytes) {
    const size_t size = below(2000);
    for (size_t i = 0; i < size; ++i) {
        bytes[i] = (uint8_t)below(256);
    }
    return size;
}

static void flip_bits(uint8_t *bytes, size_t size) {
    for (uint32_t flips = 1 + below(8); flips > 0; --flips) {
        bytes[below(size)] ^= (uint8_t)(1U << below(8));
    }
}

/* An invalid number somewhere, at a place at which a double may stand. */
static void put_nan(uint8_t *bytes, size_t size) {
    static const uint8_t nan_bytes[8] = {0x7f, 0xf8};
    if (size > 120) {
        memcpy(bytes + 56 + 8 * below((size - 64) / 8), nan_bytes, sizeof nan_bytes);
    }
}

/* A huge or negative number at a place at which a count or a length may stand. */
static void put_count(uint8_t *bytes, size_t size) {
    static const uint8_t counts[][4] = {
        {0x7f, 0xff, 0xff, 0xff}, {0xff, 0xff, 0xff, 0xff}, {0, 1, 0, 0}, {0, 0, 1, 1}};
    if (size > 64) {
        memcpy(bytes + 40 + 4 * below(6), counts[below(4)], 4);
    }
}

/* Makes one datagram of a kind; returns the channel that it goes to. */
static size_t make(uint32_t kind, uint8_t *bytes, size_t *size) {
    const size_t source = below(CHANNELS);
    *size = overheard[source].size;
    memcpy(bytes, overheard[source].bytes, *size);
    switch (*size == 0 ? 0 : kind) {
    case 0:
        *size = random_bytes(bytes);
        return below(CHANNELS);
    case 1:
        *size = below(*size);
        return source;
    case 2:
        flip_bits(bytes, *size);
        return source;
    case 3:
        bytes[below(8)] ^= (uint8_t)(1 + below(255));
        return source;
    case 4:
        put_count(bytes, *size);
        return source;
    case 5:
        put_nan(bytes, *size);
        return source;
    default:
        return (source + 1 + below(CHANNELS - 1)) % CHANNELS;
    }
}

static uint8_t *put_big_endian(uint8_t *bytes, uint64_t value, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        bytes[i] = (uint8_t)(value >> 8 * (size - 1 - i));
    }
    return bytes + size;
}

/* One of three parts of a message of 100,000 bytes: the first has the channel's name. */
static size_t make_fragment(uint8_t *datagram, uint32_t part, uint32_t offset) {
    const char *channel = channels[below(CHANNELS)];
    uint8_t *end = put_big_endian(datagram, 0x4c433033, 4);
    end = put_big_endian(end, 1, 4);
    end = put_big_endian(end, 100000, 4);
    end = put_big_endian(end, offset, 4);
    end = put_big_endian(end, part, 2);
    end = put_big_endian(end, 3, 2);
    memset(end, 'x', 1000);
    if (part == 0) {
        memcpy(end, channel, strlen(channel) + 1);
    }
    return (size_t)(end - datagram) + 1000;
}

/* A channel's name up to the datagram's end, sometimes a known one. */
static size_t make_endless_name(uint8_t *datagram) {
    const char *channel = channels[below(CHANNELS)];
    uint8_t *end = put_big_endian(put_big_endian(datagram, 0x4c433032, 4), below(1000), 4);
    const size_t size = below(2) == 0 ? strlen(channel) : below(100);
    memset(end, 'x', size);
    memcpy(end, channel, size < strlen(channel) ? size : strlen(channel));
    return (size_t)(end - datagram) + size;
}

static bool open_raw(const char *url, int *raw) {
    wh_multicast_t multicast;
    char problem[WH_MULTICAST_PROBLEM_BYTES];
    if (!wh_multicast_parse(url, &multicast, problem)) {
        return false;
    }
    const struct sockaddr_in to = {
        .sin_family = AF_INET, .sin_addr.s_addr = multicast.address, .sin_port = htons(multicast.port)};
    *raw = socket(AF_INET, SOCK_DGRAM, 0);
    return *raw >= 0 && connect(*raw, (const struct sockaddr *)&to, sizeof to) == 0;
}

static void send_raw(int raw) {
    uint8_t datagram[2000];
    (void)send(raw, datagram, make_fragment(datagram, 0, 0), 0);
    (void)send(raw, datagram,
               make_fragment(datagram, 1 + below(3), 0xfffffff0 - below(2) * below(0x7fffffff)), 0);
    (void)send(raw, datagram, make_endless_name(datagram), 0);
}

static void listen_a_while(wh_node_t *node) {
    const int64_t end = wh_node_clock_us() + 300000;
    while (wh_node_clock_us() < end) {
        (void)wh_node_wait(node, 10000);
    }
}

int main(int argc, char **argv) {
    static uint8_t bytes[WH_LINK_DATAGRAM];
    unsigned long long sent[KINDS] = {0};
    wh_node_t ears;
    wh_node_t node;
    int raw = -1;
    if (argc != 4 || !wh_node_open(&ears, argv[1], NULL) || !wh_node_open(&node, argv[1], NULL) ||
        !open_raw(argv[1], &raw)) {
        fprintf(stderr, "usage: garbage URL COUNT SEED\n");
        return 2;
    }
    random_state = strtoull(argv[3], NULL, 0);
    for (size_t i = 0; i < CHANNELS; ++i) {
        union {
            const char *const *constant;
            void *plain;
        } user = {&channels[i]};
        if (!wh_node_subscribe(&ears, channels[i], overhear, user.plain)) {
            return 2;
        }
    }
    listen_a_while(&ears);
    wh_node_close(&ears);
    for (unsigned long long left = strtoull(argv[2], NULL, 0); left > 0; --left) {
        size_t size = 0;
        const uint32_t kind = below(KINDS);
        const size_t channel = make(kind, bytes, &size);
        (void)wh_node_publish(&node, channels[channel], bytes, size);
        ++sent[kind];
        if (left % RAW_EVERY == 0) {
            send_raw(raw);
        }
    }
    printf("random %llu, cut %llu, flipped %llu, fingerprint %llu, counts %llu, NaN %llu, channel %llu\n",
           sent[0], sent[1], sent[2], sent[3], sent[4], sent[5], sent[6]);
    wh_node_close(&node);
    return 0;
}
