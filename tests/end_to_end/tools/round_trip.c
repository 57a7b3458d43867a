/* round_trip URL answer SIZE: answers every datagram on PING with one of SIZE bytes on PONG, until
 * SIGTERM.
 * round_trip URL ask SIZE COUNT: sends COUNT datagrams of SIZE bytes, each after the last one's
 * answer, and prints the mean us of a round trip. LCM alone, for comparison with a slice in
 * lockstep. */
#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "link/node.h"

typedef struct {
    lcm_t *lcm;
    unsigned size;
    long answers;
} peer_t;

static unsigned char bytes[65000];

static void answer(const lcm_recv_buf_t *message, const char *channel, void *user) {
    const peer_t *peer = user;
    (void)message;
    (void)channel;
    lcm_publish(peer->lcm, "PONG", bytes, peer->size);
}

static void count(const lcm_recv_buf_t *message, const char *channel, void *user) {
    peer_t *peer = user;
    (void)message;
    (void)channel;
    ++peer->answers;
}

static int ask(peer_t *peer, long rounds) {
    lcm_subscribe(peer->lcm, "PONG", count, peer);
    const int64_t begin = wh_node_clock_us();
    for (long round = 0; round < rounds; ++round) {
        lcm_publish(peer->lcm, "PING", bytes, peer->size);
        while (peer->answers <= round) {
            if (lcm_handle_timeout(peer->lcm, 1000) <= 0) {
                fprintf(stderr, "round_trip: no answer\n");
                return 1;
            }
        }
    }
    printf("%.2f\n", (double)(wh_node_clock_us() - begin) / (double)rounds);
    return 0;
}

int main(int argc, char **argv) {
    peer_t peer = {NULL, 0, 0};
    if (argc >= 4) {
        peer.lcm = lcm_create(argv[1]);
        peer.size = (unsigned)strtoul(argv[3], NULL, 0) % sizeof bytes;
    }
    if (!peer.lcm) {
        fprintf(stderr, "usage: round_trip URL answer SIZE | ask SIZE COUNT\n");
        return 2;
    }
    if (argc == 5 && strcmp(argv[2], "ask") == 0) {
        return ask(&peer, strtol(argv[4], NULL, 0));
    }
    lcm_subscribe(peer.lcm, "PING", answer, &peer);
    while (lcm_handle(peer.lcm) == 0) {
    }
    return 1;
}
