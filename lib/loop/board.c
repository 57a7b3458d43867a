#include "board.h"

#include <string.h>

/* An axis is eight bytes of a double. */
typedef char wh_board_needs_doubles_of_64_bits[sizeof(double) == 8 ? 1 : -1];

void wh_board_put(uint8_t bytes[], size_t size, uint64_t value) {
    for (size_t i = 0; i < size; ++i) {
        bytes[i] = (uint8_t)(value >> (8 * i));
    }
}

uint64_t wh_board_get(const uint8_t bytes[], size_t size) {
    uint64_t value = 0;
    for (size_t i = 0; i < size; ++i) {
        value |= (uint64_t)bytes[i] << (8 * i);
    }
    return value;
}

uint32_t wh_board_sum(const uint8_t bytes[], size_t size) {
    uint32_t sum = 0xFFFFFFFFU;
    for (size_t i = 0; i < size; ++i) {
        sum ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) {
            sum = (sum & 1U) != 0 ? (sum >> 1) ^ 0xEDB88320U : sum >> 1;
        }
    }
    return ~sum;
}

void wh_board_open(uint8_t bytes[], uint8_t kind, uint8_t axes, uint32_t number) {
    bytes[0] = WH_BOARD_BEGIN;
    bytes[1] = kind;
    bytes[2] = WH_BOARD_VERSION;
    bytes[3] = axes;
    wh_board_put(bytes + 4, 4, number);
}

void wh_board_seal(uint8_t bytes[], size_t size) {
    wh_board_put(bytes + size - 4, 4, wh_board_sum(bytes, size - 4));
}

/* ---------------------------------------------------------------------------------------------- gathering */

/* True if the bytes so far can begin a frame of this kind. */
static int may_begin(const wh_board_gathered_t *in, uint8_t kind) {
    const uint8_t head[3] = {WH_BOARD_BEGIN, kind, WH_BOARD_VERSION};
    return memcmp(in->bytes, head, in->count < 3 ? in->count : 3) == 0 &&
           (in->count < 4 || kind == WH_BOARD_KIND_STATE || in->bytes[3] <= WH_BOARD_AXES);
}

static void drop(wh_board_gathered_t *in, size_t size) {
    in->count -= size;
    memmove(in->bytes, in->bytes + size, in->count);
}

/* Leaves out bytes until the rest can begin a frame. */
static void skip(wh_board_gathered_t *in, uint8_t kind) {
    while (!may_begin(in, kind)) {
        drop(in, 1);
        ++in->skipped;
    }
}

/* The frame's size if it is whole; 0 if bytes are missing. */
static size_t whole(const wh_board_gathered_t *in, uint8_t kind) {
    const size_t size =
        kind == WH_BOARD_KIND_STATE ? WH_BOARD_STATE_BYTES : WH_BOARD_COMMAND_BYTES(in->bytes[3]);
    return in->count >= 4 && in->count >= size ? size : 0;
}

/* A frame that lost a byte ends within the next one: behind a wrong sum others may be whole already. */
size_t wh_board_gather(wh_board_gathered_t *in, uint8_t kind, uint8_t byte) {
    drop(in, in->taken);
    in->taken = 0;
    in->bytes[in->count++] = byte;
    skip(in, kind);
    for (size_t size = whole(in, kind); size > 0; size = whole(in, kind)) {
        if (wh_board_get(in->bytes + size - 4, 4) == wh_board_sum(in->bytes, size - 4)) {
            in->taken = size;
            return size;
        }
        ++in->damaged;
        ++in->skipped;
        drop(in, 1);
        skip(in, kind);
    }
    return 0;
}

/* ---------------------------------------------------------------------------------------------- the board */

static void write_command(wh_board_t *board, uint32_t number, const double axes[], uint32_t valves) {
    board->out_size = WH_BOARD_COMMAND_BYTES(board->axes);
    wh_board_open(board->out, WH_BOARD_KIND_COMMAND, board->axes, number);
    wh_board_put(board->out + 8, 4, board->sent);
    wh_board_put(board->out + 12, 4, valves);
    for (size_t axis = 0; axis < board->axes; ++axis) {
        uint64_t bits = 0;
        if (axes) {
            memcpy(&bits, &axes[axis], sizeof bits);
        }
        wh_board_put(board->out + WH_BOARD_HEAD + 8 * axis, 8, bits);
    }
    wh_board_seal(board->out, board->out_size);
}

void wh_board_init(wh_board_t *board, size_t axes) {
    memset(board, 0, sizeof *board);
    board->axes = (uint8_t)(axes < WH_BOARD_AXES ? axes : WH_BOARD_AXES);
    write_command(board, WH_BOARD_HELLO, NULL, 0);
}

wh_board_news_t wh_board_take(wh_board_t *board, uint8_t byte) {
    const uint8_t *frame = board->in.bytes;
    if (wh_board_gather(&board->in, WH_BOARD_KIND_STATE, byte) == 0) {
        return WH_BOARD_NOTHING;
    }
    if (frame[3] != board->axes) {
        ++board->others;
        return WH_BOARD_NOTHING;
    }
    const uint32_t number = (uint32_t)wh_board_get(frame + 4, 4);
    const int is_same = board->has_state && number == board->state.number;
    board->state.number = number;
    board->state.sensors = (uint32_t)wh_board_get(frame + 8, 4);
    board->state.status = (uint16_t)wh_board_get(frame + 12, 2);
    board->state.held = (uint16_t)wh_board_get(frame + 14, 2);
    board->state.hash = wh_board_get(frame + 16, 8);
    board->has_state = 1;
    return is_same && board->sent > 0 ? WH_BOARD_REPEATED : WH_BOARD_STATE;
}

void wh_board_answer(wh_board_t *board, const double axes[], uint32_t valves) {
    ++board->sent;
    write_command(board, board->state.number, axes, valves);
}
