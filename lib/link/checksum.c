#include "checksum.h"

#include "../math/hash.h"

static uint64_t word_at(const uint8_t *bytes, size_t size) {
    uint64_t word = 0;
    for (size_t i = 0; i < 8; ++i) {
        word = word << 8 | (i < size ? bytes[i] : 0U);
    }
    return word;
}

static uint64_t check_of(const uint8_t *bytes, size_t size) {
    uint64_t hash = WH_HASH_START;
    for (size_t at = 0; at < size; at += 8) {
        hash = wh_hash_word(hash, word_at(bytes + at, size - at));
    }
    return hash != 0 ? hash : 1;
}

void wh_link_seal(uint8_t *bytes, size_t size) {
    if (size < 8) {
        return;
    }
    uint64_t check = check_of(bytes, size - 8);
    for (size_t i = 1; i <= 8; ++i) {
        bytes[size - i] = (uint8_t)(check & 0xffU);
        check >>= 8;
    }
}

bool wh_link_is_intact(const void *data, size_t size) {
    const uint8_t *bytes = data;
    if (size < 8) {
        return false;
    }
    const uint64_t told = word_at(bytes + size - 8, 8);
    return told == 0 || told == check_of(bytes, size - 8);
}
