#include "message_frames.h"

#include <string.h>

#include "fuzz.h"
#include "grasp/grasp.h"
#include "link/messages.h"

/* What to put right, or-ed. */
enum { FINGERPRINT = 1, IDENTITY = 2, SEQ = 4, HASH = 8, SEAL = 16, SLICE_LATER = 32 };

static const char *const channels[] = {WH_CHANNEL_COMMAND,   WH_CHANNEL_STATE,   WH_CHANNEL_RESTORE,
                                       WH_CHANNEL_MCS,       WH_CHANNEL_REQUEST, WH_CHANNEL_CELL,
                                       WH_CHANNEL_EDGE_SCAN, WH_CHANNEL_LATCH};

static int64_t fingerprint_of(const char *channel) {
    if (strcmp(channel, WH_CHANNEL_COMMAND) == 0) {
        return __waferhand_command_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_MCS) == 0) {
        return __waferhand_mcs_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_REQUEST) == 0) {
        return __waferhand_request_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_CELL) == 0) {
        return __waferhand_cell_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_EDGE_SCAN) == 0) {
        return __waferhand_edge_scan_get_hash();
    }
    if (strcmp(channel, WH_CHANNEL_LATCH) == 0) {
        return __waferhand_centring_get_hash();
    }
    return __waferhand_state_get_hash();
}

static void put_word(const fuzz_frame_t *frame, size_t at, int64_t value) {
    for (size_t i = 0; i < 8 && frame->size >= at + 8; ++i) {
        frame->bytes[at + i] = (uint8_t)((uint64_t)value >> (56 - 8 * i) & 0xffU);
    }
}

uint64_t fuzz_hash_of(const waferhand_state *message) {
    static wh_link_arrays_t arrays;
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    wh_state_t state;
    wh_grasp_t table;
    if (message->missed < 0 || message->seq < message->missed ||
        wh_link_state_from_message(message, &tolerance, &arrays, &state) != WH_OK) {
        return 0;
    }
    memset(&table, 0, sizeof table);
    table.slice = (uint64_t)(message->seq - message->missed);
    table.storage.wafers = arrays.wafers;
    table.storage.wafer_count = state.wafer_count;
    table.storage.grippers = arrays.grippers;
    table.storage.gripper_count = state.gripper_count;
    return wh_physics_state_hash(&arrays.physics, &table);
}

/* Where the hash stands: fingerprint, four words, status and five counts before it. */
#define HASH_AT (8 + 4 * 8 + 6 * 4)

static void put_hash(fuzz_frame_t *frame) {
    waferhand_state message;
    wh_link_seal(frame->bytes, frame->size);
    if (wh_link_decode_state(frame->bytes, frame->size, &message)) {
        put_word(frame, HASH_AT, (int64_t)fuzz_hash_of(&message));
        (void)waferhand_state_decode_cleanup(&message);
    }
}

static bool is_checked(const char *channel) {
    return strcmp(channel, WH_CHANNEL_COMMAND) == 0 || strcmp(channel, WH_CHANNEL_STATE) == 0 ||
           strcmp(channel, WH_CHANNEL_RESTORE) == 0;
}

static void put_right(const fuzz_frames_t *frames, fuzz_frame_t *frame, unsigned what) {
    if (what & FINGERPRINT) {
        put_word(frame, 0, fingerprint_of(frame->channel));
    }
    if (what & SEQ) {
        put_word(frame, 16, frames->next_seq + (what & SLICE_LATER ? 1 : 0));
    }
    if (what & IDENTITY) {
        put_word(frame, 24, frames->identity->run);
        put_word(frame, 32, (int64_t)frames->identity->layout_hash);
    }
    if (what & HASH && is_checked(frame->channel) && strcmp(frame->channel, WH_CHANNEL_COMMAND) != 0) {
        put_hash(frame);
    }
    if (what & SEAL && is_checked(frame->channel)) {
        wh_link_seal(frame->bytes, frame->size);
    }
}

bool fuzz_next_frame(fuzz_frames_t *frames, fuzz_frame_t *frame) {
    static uint8_t bytes[WH_LINK_DATAGRAM + 1];
    if (frames->left < 4) {
        return false;
    }
    const uint8_t *const head = frames->at;
    const size_t length = (size_t)head[2] << 8 | head[3];
    frames->at += 4;
    frames->left -= 4;
    frame->channel = channels[head[0] % (sizeof channels / sizeof channels[0])];
    frame->bytes = bytes;
    frame->size = length < frames->left ? length : frames->left;
    memcpy(bytes, frames->at, frame->size);
    frames->at += frame->size;
    frames->left -= frame->size;
    put_right(frames, frame, head[1]);
    return true;
}

/* ------------------------------------------------------------------------------------------------- decoding */

static uint8_t again[2 * WH_LINK_DATAGRAM];

#define DEFINE_CHECK(name)                                                                                   \
    static bool check_##name(const fuzz_frame_t *frame) {                                                    \
        waferhand_##name message;                                                                            \
        if (!wh_link_decode_##name(frame->bytes, frame->size, &message)) {                                   \
            return false;                                                                                    \
        }                                                                                                    \
        const int size = waferhand_##name##_encode(again, 0, (int)sizeof again, &message);                   \
        REQUIRE(size >= 0 && (size_t)size == frame->size);                                                   \
        REQUIRE(memcmp(again, frame->bytes, frame->size) == 0);                                              \
        REQUIRE(waferhand_##name##_decode_cleanup(&message) == 0);                                           \
        return true;                                                                                         \
    }

DEFINE_CHECK(command)
DEFINE_CHECK(state)
DEFINE_CHECK(mcs)
DEFINE_CHECK(request)
DEFINE_CHECK(cell)
DEFINE_CHECK(edge_scan)
DEFINE_CHECK(centring)

bool fuzz_check_decoding(const fuzz_frame_t *frame) {
    static bool (*const checks[])(const fuzz_frame_t *frame) = {check_command,   check_state,   check_state,
                                                                check_mcs,       check_request, check_cell,
                                                                check_edge_scan, check_centring};
    for (size_t i = 0; i < sizeof channels / sizeof channels[0]; ++i) {
        if (frame->channel == channels[i]) {
            return checks[i](frame);
        }
    }
    return false;
}
