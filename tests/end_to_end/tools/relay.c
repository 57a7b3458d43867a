/* relay URL-A URL-B SEED [SLICE PROCESS]: carries messages between motion control on A and the
 * simulator on B, but badly. It loses 30 of a hundred datagrams, doubles 10, and delivers 10 late,
 * by up to 20 ms and so out of order. With a slice it loses nothing, but kills the process instead
 * of passing on the state of that slice. SIGTERM ends it. */
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "link/node.h"
#include "wire/messages.h"

#define LOST 30
#define DOUBLED 10
#define LATE 10
#define LATEST_US 20000
#define HELD 4096

typedef struct {
    int64_t due_us;
    wh_node_t *to;
    const char *channel;
    size_t size;
    uint8_t *data;
} held_t;

typedef struct {
    wh_node_t *to;
    const char *channel;
} route_t;

static volatile sig_atomic_t stopped;
static uint64_t random_state;
static held_t held[HELD];
static int64_t next_due_us = INT64_MAX; /* the next due time of the held ones */
static uint64_t counts[4];              /* carried, lost, doubled, late */
static int64_t last_slice;              /* 0: no slice is the last */
static pid_t process;

static void stop(int signal_number) {
    (void)signal_number;
    stopped = 1;
}

/* splitmix64 */
static uint32_t below(uint32_t n) {
    uint64_t z = (random_state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)(((z ^ (z >> 31)) >> 32) * n >> 32);
}

static void hold(const route_t *route, const void *data, size_t size) {
    for (size_t i = 0; i < HELD; ++i) {
        if (!held[i].data) {
            held[i].data = malloc(size);
            if (held[i].data) {
                memcpy(held[i].data, data, size);
            }
            held[i].due_us = wh_node_clock_us() + below(LATEST_US);
            held[i].to = route->to;
            held[i].channel = route->channel;
            held[i].size = size;
            next_due_us = held[i].due_us < next_due_us ? held[i].due_us : next_due_us;
            return;
        }
    }
}

static void release_due(void) {
    const int64_t now = wh_node_clock_us();
    if (now < next_due_us) {
        return;
    }
    next_due_us = INT64_MAX;
    for (size_t i = 0; i < HELD; ++i) {
        if (held[i].data && held[i].due_us <= now) {
            (void)wh_node_publish(held[i].to, held[i].channel, held[i].data, held[i].size);
            free(held[i].data);
            held[i].data = NULL;
        } else if (held[i].data && held[i].due_us < next_due_us) {
            next_due_us = held[i].due_us;
        }
    }
}

/* The value is big-endian, behind the type's number and the time. */
static int64_t slice_of(const uint8_t *state) {
    uint64_t slice = 0;
    for (size_t i = 16; i < 24; ++i) {
        slice = slice << 8 | state[i];
    }
    return (int64_t)slice;
}

/* It happens once: the next simulator continues from there. */
static void carry_until_slice(const route_t *route, const void *data, size_t size) {
    if (process > 0 && strcmp(route->channel, WH_CHANNEL_STATE) == 0 && size >= 24 &&
        slice_of(data) >= last_slice) {
        (void)kill(process, SIGKILL);
        process = 0;
        return;
    }
    (void)wh_node_publish(route->to, route->channel, data, size);
}

static void carry(void *user, const void *data, size_t size) {
    const route_t *route = user;
    ++counts[0];
    if (last_slice > 0) {
        carry_until_slice(route, data, size);
        return;
    }
    if (below(100) < LOST) {
        ++counts[1];
        return;
    }
    if (below(100) < LATE) {
        ++counts[3];
        hold(route, data, size);
        return;
    }
    (void)wh_node_publish(route->to, route->channel, data, size);
    if (below(100) < DOUBLED) {
        ++counts[2];
        (void)wh_node_publish(route->to, route->channel, data, size);
    }
}

static bool connect(wh_node_t *from, wh_node_t *to, const char *const channels[], route_t routes[]) {
    for (size_t i = 0; channels[i]; ++i) {
        routes[i].to = to;
        routes[i].channel = channels[i];
        if (!wh_node_subscribe(from, channels[i], carry, &routes[i])) {
            return false;
        }
    }
    return true;
}

/* SEED [SLICE PROCESS] */
static void take_numbers(int argc, char **argv) {
    random_state = strtoull(argv[3], NULL, 0);
    last_slice = argc > 4 ? strtoll(argv[4], NULL, 10) : 0;
    process = argc > 4 ? (pid_t)strtol(argv[5], NULL, 10) : 0;
}

int main(int argc, char **argv) {
    static const char *const to_simulator[] = {WH_CHANNEL_COMMAND, WH_CHANNEL_RESTORE, WH_CHANNEL_MCS, NULL};
    static const char *const to_control[] = {WH_CHANNEL_STATE, WH_CHANNEL_PROXIMITY, WH_CHANNEL_CELL, NULL};
    static route_t routes[2][4];
    wh_node_t a;
    wh_node_t b;
    if ((argc != 4 && argc != 6) || !wh_node_open(&a, argv[1], NULL) || !wh_node_open(&b, argv[2], NULL)) {
        fprintf(stderr, "usage: relay URL-A URL-B SEED [SLICE PROCESS]\n");
        return 2;
    }
    take_numbers(argc, argv);
    signal(SIGTERM, stop);
    signal(SIGINT, stop);
    if (!connect(&a, &b, to_simulator, routes[0]) || !connect(&b, &a, to_control, routes[1])) {
        return 2;
    }
    struct pollfd ready[] = {{.fd = wh_node_descriptor(&a), .events = POLLIN},
                             {.fd = wh_node_descriptor(&b), .events = POLLIN}};
    while (!stopped) {
        (void)poll(ready, 2, next_due_us == INT64_MAX ? 20 : 1);
        (void)wh_node_drain(&a, 16);
        (void)wh_node_drain(&b, 16);
        release_due();
    }
    fprintf(stderr, "relay: %" PRIu64 " came, %" PRIu64 " lost, %" PRIu64 " doubled, %" PRIu64 " late\n",
            counts[0], counts[1], counts[2], counts[3]);
    wh_node_close(&a);
    wh_node_close(&b);
    return 0;
}
