/* Datagrams: their check, and a look at them before LCM's generated code, which trusts counts and lengths. */
#include <string.h>

#include "../math/hash.h"
#include "slices.h"

/* Encoded sizes, which the generated *_encoded_size functions confirm in a test. */
#define FINGERPRINT 8
#define HEADER (4 * 8)
#define WAFER 100
#define GRIPPER 446
#define EVENT 156
#define FAULT 132
#define FAULT_SLOT 328
#define CHECK 8
#define STATE_COUNTS (FINGERPRINT + HEADER + 4)
#define STATE_FIXED (STATE_COUNTS + 4 * 4 + 2 * 8 + 4)
#define MCS_FIXED (FINGERPRINT + HEADER + 4 + 8 + 2 * 4)
#define CELL_FIXED (8 + 7 * 8 + 3 + 10 * 8)
#define STATION_FIXED (12 * 8 + 4 + 8 + 4)
#define SLICES_FIXED (FINGERPRINT + HEADER + 8 + 2 * 4 + 1 + 2 * 4)
#define RECORDING_FIXED (FINGERPRINT + HEADER + 4 + 8 + 4 + 2)

static uint64_t word_at(const uint8_t *bytes, size_t size) {
    uint64_t word = 0;
    for (size_t i = 0; i < 8; ++i) {
        word = word << 8 | (i < size ? bytes[i] : 0U);
    }
    return word;
}

/* The same of a whole word, which compilers make one instruction or two of. */
static uint64_t whole_word_at(const uint8_t *b) {
    return (uint64_t)b[0] << 56 | (uint64_t)b[1] << 48 | (uint64_t)b[2] << 40 | (uint64_t)b[3] << 32 |
           (uint64_t)b[4] << 24 | (uint64_t)b[5] << 16 | (uint64_t)b[6] << 8 | (uint64_t)b[7];
}

static uint64_t check_of(const uint8_t *bytes, size_t size) {
    uint64_t hash = WH_HASH_START;
    size_t at = 0;
    for (; at + 8 <= size; at += 8) {
        hash = wh_hash_word(hash, whole_word_at(bytes + at));
    }
    if (at < size) {
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

/* True if the check at its end is right, or 0. */
static bool is_intact(const void *data, size_t size) {
    const uint8_t *bytes = data;
    if (size < 8) {
        return false;
    }
    const uint64_t told = word_at(bytes + size - 8, 8);
    return told == 0 || told == check_of(bytes, size - 8);
}

/* The same for what is written with a check only. */
static bool is_sealed(const void *data, size_t size) {
    return is_intact(data, size) && word_at((const uint8_t *)data + size - 8, 8) != 0;
}

/* A place in a datagram. `good` becomes false if something would lie beyond the end, and stays so. */
typedef struct {
    const uint8_t *bytes;
    size_t size, at;
    bool good;
} walk_t;

static void skip(walk_t *walk, size_t bytes) {
    walk->good = walk->good && bytes <= walk->size - walk->at;
    walk->at += walk->good ? bytes : 0;
}

static int32_t take_int(walk_t *walk) {
    const size_t at = walk->at;
    skip(walk, 4);
    if (!walk->good) {
        return -1;
    }
    const uint8_t *b = walk->bytes + at;
    return (int32_t)((uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | (uint32_t)b[3]);
}

static size_t take_count(walk_t *walk, int32_t most) {
    const int32_t count = take_int(walk);
    walk->good = walk->good && count >= 0 && count <= most;
    return walk->good ? (size_t)count : 0;
}

/* Passes a text: its length with the terminator, then so many bytes. */
static void skip_text(walk_t *walk) {
    const size_t length = take_count(walk, WH_LINK_DATAGRAM);
    const size_t end = walk->at + length;
    walk->good = walk->good && length > 0;
    skip(walk, length);
    walk->good = walk->good && walk->bytes[end - 1] == '\0' &&
                 memchr(walk->bytes + end - length, '\0', length) == walk->bytes + end - 1;
}

static bool ends(const walk_t *walk) {
    return walk->good && walk->at == walk->size;
}

static walk_t walk_over(const void *data, size_t size) {
    return (walk_t){data, size, 0, true};
}

/* ----------------------------------------------------------------------------------------------- messages */

bool wh_link_decode_command(const void *data, size_t size, waferhand_command *message) {
    return size <= WH_LINK_DATAGRAM && is_intact(data, size) &&
           waferhand_command_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_state(const void *data, size_t size, waferhand_state *message) {
    walk_t walk = walk_over(data, size);
    skip(&walk, STATE_COUNTS);
    const size_t wafers = take_count(&walk, WH_LINK_WAFERS);
    const size_t grippers = take_count(&walk, WH_GRIPPERS);
    const size_t events = take_count(&walk, WH_LINK_EVENTS);
    const size_t faults = take_count(&walk, WH_FAULTS);
    skip(&walk, STATE_FIXED - STATE_COUNTS - 4 * 4);
    skip(&walk, wafers * WAFER + grippers * GRIPPER + events * EVENT + faults * FAULT_SLOT + CHECK);
    return ends(&walk) && is_intact(data, size) &&
           waferhand_state_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_mcs(const void *data, size_t size, waferhand_mcs *message) {
    walk_t walk = walk_over(data, size);
    skip(&walk, MCS_FIXED);
    skip_text(&walk);
    skip_text(&walk);
    return ends(&walk) && waferhand_mcs_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_request(const void *data, size_t size, waferhand_request *message) {
    walk_t walk = walk_over(data, size);
    skip(&walk, FINGERPRINT + HEADER);
    skip_text(&walk);
    return ends(&walk) && waferhand_request_decode(data, 0, (int)size, message) == (int)size;
}

static void skip_texts(walk_t *walk, size_t count) {
    for (size_t i = 0; i < count && walk->good; ++i) {
        skip_text(walk);
    }
}

static void skip_cell(walk_t *walk) {
    skip(walk, FINGERPRINT + HEADER);
    skip_text(walk);
    skip(walk, CELL_FIXED);
    const size_t grippers = take_count(walk, WH_GRIPPERS);
    const size_t stations = take_count(walk, WH_LAYOUT_STATIONS);
    const size_t wafers = take_count(walk, WH_LINK_WAFERS);
    const size_t faults = take_count(walk, WH_FAULTS);
    skip_texts(walk, 2 * grippers);
    for (size_t i = 0; i < stations && walk->good; ++i) {
        skip_text(walk);
        skip(walk, STATION_FIXED);
    }
    skip_texts(walk, wafers);
    skip(walk, wafers * WAFER + faults * FAULT);
}

bool wh_link_decode_cell(const void *data, size_t size, waferhand_cell *message) {
    walk_t walk = walk_over(data, size);
    skip_cell(&walk);
    return ends(&walk) && waferhand_cell_decode(data, 0, (int)size, message) == (int)size;
}

/* --------------------------------------------------------------------------------------------- recordings */

uint64_t wh_link_digest(uint64_t before, const char *channel, const void *data, size_t size) {
    char name[WH_LINK_CHANNEL];
    const size_t length = strnlen(channel, sizeof name);
    memcpy(name, channel, length);
    return wh_hash_word(wh_hash_word(before, check_of((const uint8_t *)name, length)), check_of(data, size));
}

bool wh_link_is_slices(const void *data, size_t size) {
    walk_t walk = walk_over(data, size);
    skip(&walk, SLICES_FIXED);
    skip(&walk, take_count(&walk, WH_SLICES_BYTES));
    skip(&walk, CHECK);
    return ends(&walk) && is_sealed(data, size);
}

bool wh_link_decode_recording(const void *data, size_t size, waferhand_recording *message) {
    walk_t walk = walk_over(data, size);
    skip(&walk, RECORDING_FIXED);
    skip_text(&walk);
    skip_text(&walk);
    skip(&walk, 3 * 8 + CHECK);
    return ends(&walk) && is_sealed(data, size) &&
           waferhand_recording_decode(data, 0, (int)size, message) == (int)size;
}
