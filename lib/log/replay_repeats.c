/* States that come again, as datagrams do: they are not stepped again, but must be as before. */
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "replay_internal.h"

/* A run with more slices is not looked at beyond them: 8 bytes each are kept. */
#define MOST_SLICES 100000000

/* The hash of a message without its check at the end; never 0. */
static uint64_t hash_of(const uint8_t *bytes, size_t size) {
    uint64_t hash = WH_HASH_START;
    for (size_t at = 0; at + 8 < size; at += 8) {
        uint64_t word = 0;
        memcpy(&word, bytes + at, size - 8 - at < 8 ? size - 8 - at : 8);
        hash = wh_hash_word(hash, word);
    }
    return hash | 1;
}

void wh_replay_remember_state(wh_replay_t *replay, int64_t seq, const uint8_t *bytes, size_t size) {
    if (seq < 1 || seq > MOST_SLICES) {
        return;
    }
    const size_t before = replay->told_count;
    if ((size_t)seq > before) {
        replay->told =
            wh_array_reserve(replay->told, (size_t)seq, &replay->told_capacity, sizeof *replay->told);
        memset(replay->told + before, 0, ((size_t)seq - before) * sizeof *replay->told);
        replay->told_count = (size_t)seq;
    }
    replay->told[seq - 1] = hash_of(bytes, size);
}

void wh_replay_check_repeat(wh_replay_t *replay, const waferhand_state *message, const void *data,
                            size_t size) {
    const bool is_current = replay->run && replay->run->run == message->run;
    if (is_current && message->seq >= 1 && message->seq <= (int64_t)replay->told_count &&
        replay->told[message->seq - 1] != 0 && replay->told[message->seq - 1] != hash_of(data, size)) {
        wh_replay_lose(replay, WH_REPLAY_CONTRADICTS);
    }
}
