/* link/node.h without LCM. Published messages go to a function of the target, awaited messages come
 * from another function, and waiting moves the clock. It is linked instead of lib/link/node.c. */
#ifndef WH_TESTS_FUZZ_FAKE_NODE_H
#define WH_TESTS_FUZZ_FAKE_NODE_H

#include "link/node.h"

extern int64_t fuzz_clock_us;

/* Called when a node waits: delivers a message and returns true, or returns false if there is none now. */
extern bool (*fuzz_next_message)(wh_node_t *node);

/* May be null. */
extern void (*fuzz_on_publish)(const char *channel, const void *data, size_t size);

/* Hands a datagram, in memory of exactly its size, to each subscriber of the channel. */
void fuzz_deliver(wh_node_t *node, const char *channel, const void *data, size_t size);

#endif
