/* Checks datagrams and validates their bytes before LCM's generated code, which trusts counts and
 * lengths. */
#include <endian.h>
#include <string.h>

#include "../math/hash.h"
#include "slices.h"

/* Encoded sizes, which the generated *_encoded_size functions confirm in a test. */
#define FINGERPRINT 8
#define HEADER (4 * 8)
#define WAFER 101
#define GRIPPER 515
#define EVENT 157
#define FAULT 132
#define FAULT_SLOT 328
#define LATCHING_FIXED (4 + 1 + 2 * 4 + 8 + 3 * 4)
#define LATCH 24
#define CHECK 8
#define STATE_COUNTS (FINGERPRINT + HEADER + 4)
#define STATE_FIXED (STATE_COUNTS + 5 * 4 + 2 * 8 + 4 + 4 * 4 + 1 + 2 * 8)
#define MCS_FIXED (FINGERPRINT + HEADER + 4 + 8 + 5 * 4)
#define EDGE_SCAN_FIXED (FINGERPRINT + HEADER + 3 * 4 + 8 + 4 * 4 + 3 * 8 + 4 + 4 * 8 + 4 + 3 * 8 + 3 * 4)
#define SAMPLE (4 + 4 + 1)
#define CENTRING_FIXED (FINGERPRINT + HEADER + 5 * 4)
#define CROSSING (3 * 4 + 5 * 8)
#define CENTRE (6 * 8 + 4)
#define CELL_FIXED (8 + 9 * 8 + 3 + 1 + 8 + 10 * 8)
#define STATION_FIXED (12 * 8 + 4 + 8 + 4)
#define SENSOR_FIXED (4 + 8 + 4 * 8 + 2 * 4 + 6 * 8)
#define BEAM_FIXED (4 + 8 + 11 * 8 + 2 * 4 + 10 * 8)
#define DOOR_FIXED (4 + 3 * 8 + 8 + 1 + 3 * 8)
#define RIM_FIXED (4 + 14 * 8)
#define EDGE_GRIP 80
#define SLICES_FIXED (FINGERPRINT + HEADER + 8 + 2 * 4 + 1 + 2 * 4)
#define RECORDING_FIXED (FINGERPRINT + HEADER + 4 + 8 + 4 + 2)

uint64_t wh_link_word(const uint8_t *bytes, size_t size) {
    uint64_t word = 0;
    memcpy(&word, bytes, size < sizeof word ? size : sizeof word);
    return be64toh(word);
}

static uint64_t check_of(const uint8_t *bytes, size_t size) {
    uint64_t hash = WH_HASH_START;
    for (size_t at = 0; at < size; at += 8) {
        hash = wh_hash_word(hash, wh_link_word(bytes + at, size - at));
    }
    return hash != 0 ? hash : 1;
}

void wh_link_seal(uint8_t *bytes, size_t size) {
    if (size >= CHECK) {
        const uint64_t check = htobe64(check_of(bytes, size - CHECK));
        memcpy(bytes + size - CHECK, &check, sizeof check);
    }
}

/* True if the check at the datagram's end is right, or 0. */
static bool is_intact(const void *data, size_t size) {
    const uint8_t *bytes = data;
    if (size < 8) {
        return false;
    }
    const uint64_t told = wh_link_word(bytes + size - 8, 8);
    return told == 0 || told == check_of(bytes, size - 8);
}

/* True if the check is right and not 0, for messages that always have one. */
static bool is_sealed(const void *data, size_t size) {
    return is_intact(data, size) && wh_link_word((const uint8_t *)data + size - 8, 8) != 0;
}

/* A place in a datagram. `good` becomes false if something would lie beyond the end, and then stays
 * false. */
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
    uint32_t word;
    memcpy(&word, walk->bytes + at, sizeof word);
    return (int32_t)be32toh(word);
}

static size_t take_count(walk_t *walk, int32_t most) {
    const int32_t count = take_int(walk);
    walk->good = walk->good && count >= 0 && count <= most;
    return walk->good ? (size_t)count : 0;
}

/* Passes a text: its length with the terminator, then that many bytes. */
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

/* ----------------------------------------------------------------------------------------------- messages */

bool wh_link_decode_command(const void *data, size_t size, waferhand_command *message) {
    return size <= WH_LINK_DATAGRAM && is_intact(data, size) &&
           waferhand_command_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_state(const void *data, size_t size, waferhand_state *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, STATE_COUNTS);
    const size_t wafers = take_count(&walk, WH_LINK_WAFERS);
    const size_t grippers = take_count(&walk, WH_GRIPPERS);
    const size_t events = take_count(&walk, WH_LINK_EVENTS);
    const size_t faults = take_count(&walk, WH_FAULTS);
    const size_t samples = take_count(&walk, WH_SCAN_SLICE);
    skip(&walk, STATE_FIXED - STATE_COUNTS - 5 * 4);
    skip(&walk, wafers * WAFER + grippers * GRIPPER + events * EVENT + faults * FAULT_SLOT + samples * 4 + 1);
    skip(&walk, take_count(&walk, WH_DOORS) * 8);
    const size_t waiting = take_count(&walk, WH_LATCHES);
    const size_t latches = take_count(&walk, WH_LATCHES);
    skip(&walk, LATCHING_FIXED + (waiting + latches) * LATCH + CHECK);
    return ends(&walk) && is_intact(data, size) &&
           waferhand_state_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_mcs(const void *data, size_t size, waferhand_mcs *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, MCS_FIXED);
    skip_text(&walk);
    skip_text(&walk);
    return ends(&walk) && waferhand_mcs_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_request(const void *data, size_t size, waferhand_request *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, FINGERPRINT + HEADER);
    skip_text(&walk);
    return ends(&walk) && waferhand_request_decode(data, 0, (int)size, message) == (int)size;
}

int64_t wh_link_request_number(const void *data, size_t size) {
    const uint8_t *bytes = data;
    const bool is_one =
        size >= FINGERPRINT + HEADER && wh_link_word(bytes, 8) == (uint64_t)__waferhand_request_get_hash();
    return is_one ? (int64_t)wh_link_word(bytes + FINGERPRINT + 8, 8) : 0;
}

static void skip_texts(walk_t *walk, size_t count) {
    for (size_t i = 0; i < count && walk->good; ++i) {
        skip_text(walk);
    }
}

/* Passes `count` entries. Each has `fixed` bytes, then a count of up to `most`, then `doubles` doubles for
 * each counted one. */
static void skip_entries(walk_t *walk, size_t count, size_t fixed, int32_t most, size_t doubles) {
    for (size_t i = 0; i < count && walk->good; ++i) {
        skip(walk, fixed);
        skip(walk, take_count(walk, most) * doubles * 8);
    }
}

bool wh_link_decode_cell(const void *data, size_t size, waferhand_cell *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, FINGERPRINT + HEADER);
    skip_text(&walk);
    skip(&walk, CELL_FIXED);
    const size_t grippers = take_count(&walk, WH_GRIPPERS);
    const size_t stations = take_count(&walk, WH_LAYOUT_STATIONS);
    const size_t wafers = take_count(&walk, WH_LINK_WAFERS);
    const size_t faults = take_count(&walk, WH_FAULTS);
    const size_t sensors = take_count(&walk, WH_GRIPPERS);
    const size_t beams = take_count(&walk, WH_BEAMS);
    const size_t outlines = take_count(&walk, WH_GRIPPERS);
    const size_t rims = take_count(&walk, WH_LINK_RIMS);
    const size_t edges = take_count(&walk, WH_GRIPPERS);
    const size_t doors = take_count(&walk, WH_DOORS);
    skip(&walk, grippers);
    skip_texts(&walk, 2 * grippers);
    for (size_t i = 0; i < stations && walk.good; ++i) {
        skip_text(&walk);
        skip(&walk, STATION_FIXED);
    }
    skip_texts(&walk, wafers);
    skip(&walk, wafers * WAFER + faults * FAULT);
    skip_entries(&walk, sensors, SENSOR_FIXED, WH_SENSOR_ARCS, 2);
    skip(&walk, beams * BEAM_FIXED);
    skip_entries(&walk, outlines, 0, WH_OUTLINE_POINTS, 2);
    skip_entries(&walk, rims, RIM_FIXED, WH_RIM_CHIPS, 3);
    skip(&walk, edges * EDGE_GRIP);
    for (size_t i = 0; i < doors && walk.good; ++i) {
        skip_text(&walk);
        skip(&walk, DOOR_FIXED);
    }
    return ends(&walk) && waferhand_cell_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_edge_scan(const void *data, size_t size, waferhand_edge_scan *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, EDGE_SCAN_FIXED);
    skip(&walk, take_count(&walk, WH_LINK_SAMPLES) * SAMPLE);
    skip_texts(&walk, take_count(&walk, WH_LINK_LINES));
    return ends(&walk) && waferhand_edge_scan_decode(data, 0, (int)size, message) == (int)size;
}

bool wh_link_decode_centring(const void *data, size_t size, waferhand_centring *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, CENTRING_FIXED);
    const size_t crossings = take_count(&walk, WH_CROSSINGS);
    const size_t centres = take_count(&walk, 2);
    skip(&walk, crossings * CROSSING + centres * CENTRE);
    return ends(&walk) && waferhand_centring_decode(data, 0, (int)size, message) == (int)size;
}

/* --------------------------------------------------------------------------------------------- recordings */

uint64_t wh_link_digest(uint64_t before, const char *channel, const void *data, size_t size) {
    char name[WH_LINK_CHANNEL];
    const size_t length = strnlen(channel, sizeof name);
    memcpy(name, channel, length);
    return wh_hash_word(wh_hash_word(before, check_of((const uint8_t *)name, length)), check_of(data, size));
}

bool wh_link_is_slices(const void *data, size_t size) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, SLICES_FIXED);
    skip(&walk, take_count(&walk, WH_SLICES_BYTES));
    skip(&walk, CHECK);
    return ends(&walk) && is_sealed(data, size);
}

bool wh_link_decode_recording(const void *data, size_t size, waferhand_recording *message) {
    walk_t walk = {data, size, 0, true};
    skip(&walk, RECORDING_FIXED);
    skip_text(&walk);
    skip_text(&walk);
    skip(&walk, 3 * 8 + CHECK);
    return ends(&walk) && is_sealed(data, size) &&
           waferhand_recording_decode(data, 0, (int)size, message) == (int)size;
}
