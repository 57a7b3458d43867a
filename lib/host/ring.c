#include "ring.h"

#include <string.h>

bool wh_ring_put(wh_ring_t *ring, const void *bytes, size_t size) {
    if (size > wh_ring_room(ring)) {
        return false;
    }
    const uint8_t *from = bytes;
    size_t piece = 0;
    for (uint8_t *to = wh_ring_back(ring, &piece); to && size > 0; to = wh_ring_back(ring, &piece)) {
        piece = piece < size ? piece : size;
        memcpy(to, from, piece);
        wh_ring_filled(ring, piece);
        from += piece;
        size -= piece;
    }
    return true;
}

const uint8_t *wh_ring_front(const wh_ring_t *ring, size_t *size) {
    const size_t to_end = WH_RING_BYTES - ring->first;
    *size = ring->count < to_end ? ring->count : to_end;
    return *size > 0 ? ring->bytes + ring->first : NULL;
}

uint8_t *wh_ring_back(wh_ring_t *ring, size_t *size) {
    const size_t at = (ring->first + ring->count) % WH_RING_BYTES;
    const size_t to_end = WH_RING_BYTES - at;
    *size = wh_ring_room(ring) < to_end ? wh_ring_room(ring) : to_end;
    return *size > 0 ? ring->bytes + at : NULL;
}

void wh_ring_filled(wh_ring_t *ring, size_t size) {
    ring->count += size;
}

void wh_ring_drop(wh_ring_t *ring, size_t size) {
    size = size < ring->count ? size : ring->count;
    ring->count -= size;
    /* An empty ring begins anew: most lines then lie in one piece. */
    ring->first = ring->count > 0 ? (ring->first + size) % WH_RING_BYTES : 0;
}

size_t wh_ring_take(wh_ring_t *ring, void *bytes, size_t most) {
    uint8_t *to = bytes;
    size_t taken = 0;
    size_t piece = 0;
    for (const uint8_t *from = wh_ring_front(ring, &piece); from && taken < most;
         from = wh_ring_front(ring, &piece)) {
        piece = piece < most - taken ? piece : most - taken;
        memcpy(to + taken, from, piece);
        wh_ring_drop(ring, piece);
        taken += piece;
    }
    return taken;
}
