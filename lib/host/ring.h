/* A byte ring of fixed size: bytes that wait between a line and its reader. First in, first out.
 *
 * All memory is the caller's. Calls fail only if there is no room. Not for two threads at once. */
#ifndef WH_HOST_RING_H
#define WH_HOST_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How many bytes a ring holds. */
#define WH_RING_BYTES 65536

/* Zero it to begin with: empty. `first` is where the oldest byte stands. */
typedef struct {
    size_t first, count;
    uint8_t bytes[WH_RING_BYTES];
} wh_ring_t;

/* How many more bytes it takes. */
static inline size_t wh_ring_room(const wh_ring_t *ring) {
    return WH_RING_BYTES - ring->count;
}

/* Appends all of the bytes. False, and nothing has changed, if there is no room for all. Cost: a copy. */
bool wh_ring_put(wh_ring_t *ring, const void *bytes, size_t size);

/* The oldest bytes that stand in one piece: at most two pieces are all of them. Null if there are none. The
 * piece stays where it is until wh_ring_drop. */
const uint8_t *wh_ring_front(const wh_ring_t *ring, size_t *size);

/* Where the next bytes may be written, in one piece, for recv and similar calls. Null if the ring is full.
 * wh_ring_filled then says how many were written, at most `size`. */
uint8_t *wh_ring_back(wh_ring_t *ring, size_t *size);
void wh_ring_filled(wh_ring_t *ring, size_t size);

/* Forgets the `size` oldest bytes, or all if there are fewer. */
void wh_ring_drop(wh_ring_t *ring, size_t size);

/* Takes up to `most` of the oldest bytes. Returns how many. Cost: a copy. */
size_t wh_ring_take(wh_ring_t *ring, void *bytes, size_t most);

#endif
