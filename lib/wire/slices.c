#include "slices.h"

#include <string.h>

#include "../math/hash.h"

#define SIGN (UINT64_C(1) << 63)
/* All times of a run are far below what 64 bits hold. */
#define FARTHEST (INT64_C(1) << 62)
#define SLICE_US_MOST 1000000
/* The number of polynomials that predict. */
#define ORDERS 7

/* The coding of a column. */
enum { CONSTANT, SAME, NEGATIVE, PREDICTED };

/* ------------------------------------------------------------------------------------------------- coding */

/* Bytes that are written or read. `good` becomes false if there are too few, and then stays false. */
typedef struct {
    uint8_t *out;
    const uint8_t *in;
    size_t at, size;
    bool good;
} bytes_t;

static void put_byte(bytes_t *bytes, uint8_t byte) {
    bytes->good = bytes->good && bytes->at < bytes->size;
    if (bytes->good) {
        bytes->out[bytes->at++] = byte;
    }
}

static uint8_t take_byte(bytes_t *bytes) {
    bytes->good = bytes->good && bytes->at < bytes->size;
    return bytes->good ? bytes->in[bytes->at++] : 0;
}

static void put_word(bytes_t *bytes, uint64_t word) {
    for (int shift = 56; shift >= 0; shift -= 8) {
        put_byte(bytes, (uint8_t)(word >> shift & 0xffU));
    }
}

static uint64_t take_word(bytes_t *bytes) {
    uint64_t word = 0;
    for (int i = 0; i < 8; ++i) {
        word = word << 8 | take_byte(bytes);
    }
    return word;
}

/* Writes seven bits in each byte, the lowest first; the highest bit says that more follow. */
static void put_number(bytes_t *bytes, uint64_t number) {
    while (number >= 0x80) {
        put_byte(bytes, (uint8_t)(number & 0x7fU) | 0x80U);
        number >>= 7;
    }
    put_byte(bytes, (uint8_t)number);
}

static uint64_t take_number(bytes_t *bytes) {
    uint64_t number = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
        const uint64_t byte = take_byte(bytes);
        number |= (byte & 0x7fU) << shift;
        if (byte < 0x80) {
            bytes->good = bytes->good && (shift < 63 || byte <= 1);
            return number;
        }
    }
    bytes->good = false;
    return 0;
}

/* Takes the length of a run, which must fit the rest. Returns 0 if it does not. */
static size_t take_run(bytes_t *bytes, size_t left) {
    const uint64_t run = take_number(bytes);
    bytes->good = bytes->good && run >= 1 && run <= left;
    return bytes->good ? (size_t)run : 0;
}

static void put_valves(bytes_t *bytes, const wh_slices_t *slices, size_t from, size_t end) {
    for (size_t i = from, next = from; i < end; i = next) {
        while (next < end && slices->valves[next] == slices->valves[i] &&
               slices->told[next] == slices->told[i]) {
            ++next;
        }
        put_number(bytes, next - i);
        put_number(bytes, slices->valves[i]);
        put_number(bytes, slices->told[i]);
    }
}

static void take_valves(bytes_t *bytes, wh_slices_t *slices) {
    const uint64_t none = ~((UINT64_C(1) << slices->grippers) - 1);
    for (size_t i = 0; bytes->good && i < slices->count;) {
        const size_t run = take_run(bytes, slices->count - i);
        const uint64_t valves = take_number(bytes);
        const uint64_t told = take_number(bytes);
        bytes->good = bytes->good && ((valves | told) & none) == 0;
        for (const size_t end = i + run; i < end; ++i) {
            slices->valves[i] = (uint16_t)valves;
            slices->told[i] = (uint16_t)told;
        }
    }
}

/* --------------------------------------------------------------------------------------------- prediction */

/* Predicts a number that changes from slice to slice. Coder and decoder predict it in an equal way, so only
 * the error is written. lcm_types/format.md has the rule.
 *
 * Polynomials of degree 0 to 6 through the last values give one guess each; axes are cubic in time, poses
 * are smooth. It takes the polynomial that was best recently. Doubles go in and out as their bits. */
typedef struct {
    size_t seen;
    uint64_t last;
    double differences[ORDERS]; /* of order 0, which is the last value, to 6 */
    uint64_t guesses[ORDERS];   /* bits, one for each order */
    uint32_t scores[ORDERS];    /* the recent errors of each order */
} prediction_t;

/* The bits as a number that grows with the value, so that neighbouring values differ by little. Applied
 * twice, it gives the bits again. */
static uint64_t rank_of(uint64_t bits) {
    return (bits & SIGN) != 0 ? bits ^ (SIGN - 1) : bits;
}

/* Maps a signed difference to a number that is small if the difference is. */
static uint64_t fold(uint64_t difference) {
    return difference << 1 ^ ((difference & SIGN) != 0 ? UINT64_MAX : 0);
}

static uint64_t unfold(uint64_t folded) {
    return folded >> 1 ^ ((folded & 1) != 0 ? UINT64_MAX : 0);
}

/* The likely rank of the next value, by the order that was best recently. */
static uint64_t predict(prediction_t *prediction) {
    double sum = 0;
    size_t best = 0;
    prediction->guesses[0] = prediction->last;
    for (size_t order = 1; order < ORDERS; ++order) {
        sum += prediction->differences[order];
        const double guess = prediction->differences[0] + sum;
        prediction->guesses[order] = prediction->last;
        /* A NaN has different bits on different machines. */
        if (guess == guess) {
            prediction->guesses[order] = wh_double_bits(guess);
        }
        if (order < prediction->seen && prediction->scores[order] < prediction->scores[best]) {
            best = order;
        }
    }
    return rank_of(prediction->guesses[best]);
}

static void learn(prediction_t *prediction, uint64_t bits) {
    double difference;
    memcpy(&difference, &bits, sizeof difference);
    for (size_t order = 0; prediction->seen > 0 && order < ORDERS; ++order) {
        const uint64_t miss = fold(rank_of(bits) - rank_of(prediction->guesses[order]));
        const uint32_t bits_of_miss = 64U - (uint32_t)__builtin_clzll(miss | 1);
        prediction->scores[order] = prediction->scores[order] / 2 + 8 * bits_of_miss;
    }
    for (size_t order = 0; order < ORDERS; ++order) {
        const double next = difference - prediction->differences[order];
        prediction->differences[order] = difference;
        difference = next;
    }
    prediction->last = bits;
    ++prediction->seen;
}

/* ------------------------------------------------------------------------------------------------ columns */

/* True if the bits differ by the mask everywhere. */
static bool is_like(const uint64_t *column, const uint64_t *other, uint64_t mask, size_t from, size_t end) {
    bool same = (column[end - 1] ^ other[end - 1]) == mask;
    for (size_t i = from; same && i < end; ++i) {
        same = (column[i] ^ other[i]) == mask;
    }
    return same;
}

/* Writes that the column repeats or mirrors an earlier one; entries of rotations do. */
static bool put_like(bytes_t *bytes, const wh_slices_t *slices, size_t c, size_t from, size_t end) {
    for (size_t other = 0; other < c; ++other) {
        const bool same = is_like(slices->column[c], slices->column[other], 0, from, end);
        if (same || is_like(slices->column[c], slices->column[other], SIGN, from, end)) {
            put_byte(bytes, same ? SAME : NEGATIVE);
            put_byte(bytes, (uint8_t)other);
            return true;
        }
    }
    return false;
}

static void put_zeros(bytes_t *bytes, size_t *zeros) {
    if (*zeros > 0) {
        put_byte(bytes, 0);
        put_number(bytes, *zeros);
        *zeros = 0;
    }
}

static void put_predicted(bytes_t *bytes, const uint64_t *column, size_t from, size_t end) {
    prediction_t prediction = {0};
    size_t zeros = 0;
    for (size_t i = from; bytes->good && i < end; ++i) {
        /* The miss is 0 or a small number if the prediction was nearly right, and has 64 bits at worst. */
        const uint64_t miss = fold(rank_of(column[i]) - predict(&prediction));
        learn(&prediction, column[i]);
        if (miss == 0) {
            ++zeros;
        } else {
            put_zeros(bytes, &zeros);
            put_number(bytes, miss);
        }
    }
    put_zeros(bytes, &zeros);
}

static void take_predicted(bytes_t *bytes, uint64_t *column, size_t count) {
    prediction_t prediction = {0};
    size_t zeros = 0;
    for (size_t i = 0; bytes->good && i < count; ++i) {
        const uint64_t miss = zeros > 0 ? 0 : take_number(bytes);
        if (zeros > 0) {
            --zeros;
        } else if (miss == 0) {
            zeros = take_run(bytes, count - i) - 1;
        }
        column[i] = rank_of(predict(&prediction) + unfold(miss));
        learn(&prediction, column[i]);
    }
}

static size_t column_count(const wh_slices_t *slices) {
    return slices->axes + 12 * slices->grippers;
}

static void put_columns(bytes_t *bytes, const wh_slices_t *slices, size_t from, size_t end) {
    for (size_t c = 0; bytes->good && c < column_count(slices); ++c) {
        const uint64_t *column = slices->column[c];
        const bool is_constant =
            memcmp(column + from, column + from + 1, (end - from - 1) * sizeof *column) == 0;
        if (is_constant) {
            put_byte(bytes, CONSTANT);
            put_word(bytes, column[from]);
        } else if (!put_like(bytes, slices, c, from, end)) {
            put_byte(bytes, PREDICTED);
            put_predicted(bytes, column, from, end);
        }
    }
}

static void take_like(bytes_t *bytes, wh_slices_t *slices, size_t c, uint64_t mask) {
    const size_t other = take_byte(bytes);
    bytes->good = bytes->good && other < c;
    for (size_t i = 0; bytes->good && i < slices->count; ++i) {
        slices->column[c][i] = slices->column[other][i] ^ mask;
    }
}

static void take_column(bytes_t *bytes, wh_slices_t *slices, size_t c) {
    const uint8_t mode = take_byte(bytes);
    bytes->good = bytes->good && mode <= PREDICTED;
    if (mode == CONSTANT) {
        const uint64_t bits = take_word(bytes);
        for (size_t i = 0; i < slices->count; ++i) {
            slices->column[c][i] = bits;
        }
    } else if (mode == PREDICTED) {
        take_predicted(bytes, slices->column[c], slices->count);
    } else {
        take_like(bytes, slices, c, mode == NEGATIVE ? SIGN : 0);
    }
}

/* ------------------------------------------------------------------------------------------------- adding */

/* The size is at most that of all rotations of a command. */
static bool is_zero(const void *bytes, size_t size) {
    static const uint8_t zeros[9 * sizeof(double) * WH_GRIPPERS];
    return memcmp(bytes, zeros, size) == 0;
}

static bool is_no_fault(const waferhand_fault *fault) {
    return (fault->kind | fault->target | fault->other) == 0 && (fault->from_seq | fault->until_seq) == 0 &&
           is_zero(&fault->value, sizeof fault->value) && is_zero(fault->position, sizeof fault->position) &&
           is_zero(fault->rotation, sizeof fault->rotation);
}

/* True if there are no orders to sensors and beams. */
static bool is_without_orders(const waferhand_command *command) {
    return (command->scan_order | command->scan_gripper | command->scan_count) == 0 &&
           command->scan_first == 0 &&
           (command->latch_order | command->latch_first | command->latch_beams) == 0;
}

/* True if the unused entries of arrays are all zero, as wh_link_command_to_message leaves them. */
static bool is_plain(const waferhand_command *command) {
    const size_t grippers = WH_GRIPPERS - (size_t)command->gripper_count;
    const size_t axes = WH_AXES - (size_t)command->axis_count;
    bool plain = is_zero(command->gripper_position + command->gripper_count,
                         grippers * sizeof *command->gripper_position) &&
                 is_zero(command->gripper_rotation + command->gripper_count,
                         grippers * sizeof *command->gripper_rotation) &&
                 is_zero(command->valve + command->gripper_count, grippers * sizeof *command->valve) &&
                 is_zero(command->axis_position + command->axis_count, axes * sizeof(double)) &&
                 is_without_orders(command) && command->fault_count == 0 &&
                 is_zero(command->fault_index, sizeof command->fault_index);
    for (size_t i = 0; plain && i < WH_COMMAND_FAULTS; ++i) {
        plain = is_no_fault(&command->faults[i]);
    }
    return plain;
}

/* True if the values are allowed for slices of a block and for the block. */
static bool is_in_range(int64_t seq, int64_t utime, int32_t grippers, int32_t axes, int8_t lockstep) {
    return seq >= 1 && seq <= WH_LINK_SLICES && utime > -FARTHEST && utime < FARTHEST && grippers >= 1 &&
           grippers <= WH_GRIPPERS && axes >= 0 && axes <= WH_AXES && (lockstep == 0 || lockstep == 1);
}

/* True if the command may follow in the block. */
static bool follows(const wh_slices_t *slices, const waferhand_command *command) {
    const int64_t last_utime = slices->utime + (int64_t)(slices->count - 1) * slices->slice_us;
    const int64_t step = command->utime - last_utime;
    return command->run == slices->identity.run &&
           (uint64_t)command->layout_hash == slices->identity.layout_hash &&
           command->lockstep == slices->lockstep && (size_t)command->gripper_count == slices->grippers &&
           (size_t)command->axis_count == slices->axes &&
           command->seq == slices->first + (int64_t)slices->count &&
           (slices->count == 1 ? step >= 0 && step <= SLICE_US_MOST : step == slices->slice_us);
}

/* False if a valve is neither 0 nor 1. */
static bool gather(const int32_t valves[], int32_t count, uint16_t *mask) {
    int32_t any = 0;
    *mask = 0;
    for (int32_t g = 0; g < count; ++g) {
        any |= valves[g];
        *mask = (uint16_t)(*mask | (valves[g] & 1) << g);
    }
    return (any & ~1) == 0;
}

/* The place of a column's double in a command. */
static size_t place_of(const wh_slices_t *slices, size_t column) {
    if (column < slices->axes) {
        return offsetof(waferhand_command, axis_position) + column * sizeof(double);
    }
    const size_t g = (column - slices->axes) / 12;
    const size_t k = (column - slices->axes) % 12;
    return k < 3 ? offsetof(waferhand_command, gripper_position) + (3 * g + k) * sizeof(double)
                 : offsetof(waferhand_command, gripper_rotation) + (9 * g + k - 3) * sizeof(double);
}

static void put_doubles(wh_slices_t *slices, const waferhand_command *command) {
    for (size_t c = 0; c < column_count(slices); ++c) {
        memcpy(&slices->column[c][slices->count], (const char *)command + place_of(slices, c),
               sizeof(double));
    }
}

bool wh_slices_add(wh_slices_t *slices, const waferhand_command *command, const int32_t told[],
                   uint64_t hash) {
    uint16_t valves;
    uint16_t in_force;
    if (slices->count == WH_SLICES_MOST ||
        !is_in_range(command->seq, command->utime, command->gripper_count, command->axis_count,
                     command->lockstep) ||
        !is_plain(command) || (slices->count > 0 && !follows(slices, command)) ||
        !gather(command->valve, command->gripper_count, &valves) ||
        !gather(told, command->gripper_count, &in_force)) {
        return false;
    }
    if (slices->count == 0) {
        slices->identity = (wh_link_identity_t){command->run, (uint64_t)command->layout_hash};
        slices->first = command->seq;
        slices->utime = command->utime;
        slices->slice_us = 0;
        slices->lockstep = command->lockstep;
        slices->grippers = (size_t)command->gripper_count;
        slices->axes = (size_t)command->axis_count;
    } else if (slices->count == 1) {
        slices->slice_us = command->utime - slices->utime;
    }
    put_doubles(slices, command);
    slices->valves[slices->count] = valves;
    slices->told[slices->count] = in_force;
    slices->hash[slices->count++] = hash;
    return true;
}

void wh_slices_get(const wh_slices_t *slices, size_t i, waferhand_command *command, int32_t told[WH_GRIPPERS],
                   uint64_t *hash) {
    memset(command, 0, sizeof *command);
    command->utime = slices->utime + (int64_t)i * slices->slice_us;
    command->seq = slices->first + (int64_t)i;
    command->run = slices->identity.run;
    command->layout_hash = (int64_t)slices->identity.layout_hash;
    command->lockstep = slices->lockstep;
    command->gripper_count = (int32_t)slices->grippers;
    command->axis_count = (int32_t)slices->axes;
    for (size_t c = 0; c < column_count(slices); ++c) {
        memcpy((char *)command + place_of(slices, c), &slices->column[c][i], sizeof(double));
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        command->valve[g] = slices->valves[i] >> g & 1;
        told[g] = slices->told[i] >> g & 1;
    }
    *hash = slices->hash[i];
}

/* ----------------------------------------------------------------------------------------------- messages */

/* The content of a message; its size, or 0 if it does not fit. */
static size_t put_content(const wh_slices_t *slices, size_t from, size_t end, uint8_t *out, size_t size) {
    bytes_t bytes = {.out = out, .size = size, .good = true};
    for (size_t i = from; i < end; ++i) {
        put_word(&bytes, slices->hash[i]);
    }
    put_valves(&bytes, slices, from, end);
    put_columns(&bytes, slices, from, end);
    return bytes.good ? bytes.at : 0;
}

static bool take_content(const waferhand_slices *message, wh_slices_t *slices) {
    bytes_t bytes = {.in = message->data, .size = (size_t)message->size, .good = true};
    for (size_t i = 0; i < slices->count; ++i) {
        slices->hash[i] = take_word(&bytes);
    }
    take_valves(&bytes, slices);
    for (size_t c = 0; bytes.good && c < column_count(slices); ++c) {
        take_column(&bytes, slices, c);
    }
    return bytes.good && bytes.at == bytes.size;
}

size_t wh_slices_encode(const wh_slices_t *slices, size_t *from, uint8_t bytes[WH_SLICES_BYTES]) {
    uint8_t data[WH_SLICES_BYTES];
    waferhand_slices message = {.run = slices->identity.run,
                                .layout_hash = (int64_t)slices->identity.layout_hash,
                                .first = slices->first + (int64_t)*from,
                                .lockstep = slices->lockstep,
                                .gripper_count = (int32_t)slices->grippers,
                                .axis_count = (int32_t)slices->axes,
                                .data = data};
    const size_t room = WH_SLICES_BYTES - (size_t)waferhand_slices_encoded_size(&message);
    size_t count = slices->count - *from;
    size_t content = put_content(slices, *from, *from + count, data, room);
    /* A single slice always fits: 224 numbers. */
    while (content == 0) {
        count /= 2;
        content = put_content(slices, *from, *from + count, data, room);
    }
    *from += count;
    message.seq = slices->first + (int64_t)*from - 1;
    message.utime = slices->utime + (int64_t)(*from - 1) * slices->slice_us;
    message.count = (int32_t)count;
    message.slice_us = count > 1 ? (int32_t)slices->slice_us : 0;
    message.size = (int32_t)content;
    const int size = waferhand_slices_encode(bytes, 0, WH_SLICES_BYTES, &message);
    wh_link_seal(bytes, (size_t)size);
    return (size_t)size;
}

/* True if the numbers of slices agree. */
static bool is_counted(const waferhand_slices *message) {
    return message->count >= 1 && message->count <= WH_SLICES_MOST && message->first >= 1 &&
           message->first <= WH_LINK_SLICES && message->seq <= WH_LINK_SLICES &&
           message->seq == message->first + message->count - 1;
}

static bool take_message(const waferhand_slices *message, wh_slices_t *slices) {
    slices->count = 0;
    if (!is_counted(message) || message->slice_us < 0 || message->slice_us > SLICE_US_MOST ||
        (message->count == 1 && message->slice_us != 0) ||
        !is_in_range(message->first, message->utime, message->gripper_count, message->axis_count,
                     message->lockstep)) {
        return false;
    }
    slices->identity = (wh_link_identity_t){message->run, (uint64_t)message->layout_hash};
    slices->first = message->first;
    slices->slice_us = message->slice_us;
    slices->utime = message->utime - (int64_t)(message->count - 1) * message->slice_us;
    slices->lockstep = message->lockstep;
    slices->grippers = (size_t)message->gripper_count;
    slices->axes = (size_t)message->axis_count;
    slices->count = (size_t)message->count;
    return take_content(message, slices);
}

bool wh_slices_decode(const void *data, size_t size, wh_slices_t *slices) {
    waferhand_slices message;
    if (!wh_link_is_slices(data, size) ||
        waferhand_slices_decode(data, 0, (int)size, &message) != (int)size) {
        return false;
    }
    const bool sound = take_message(&message, slices);
    (void)waferhand_slices_decode_cleanup(&message);
    return sound;
}
