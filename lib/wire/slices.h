/* Slices in blocks: commands and hashes of consecutive slices of one run, coded without loss.
 *
 * A recording holds such blocks (channel WAFERHAND_SLICES) in place of a command and a state for each
 * slice. lcm_types/format.md describes their bytes. A block stands by itself: decoding one needs no other.
 * Nothing here allocates except wh_slices_decode, which releases its memory again, and liblcm.
 */
#ifndef WH_WIRE_SLICES_H
#define WH_WIRE_SLICES_H

#include <waferhand_recording.h>
#include <waferhand_slices.h>

#include "messages.h"

/* This channel is in recordings only. */
#define WH_CHANNEL_SLICES "WAFERHAND_SLICES"
#define WH_CHANNEL_RECORDING "WAFERHAND_RECORDING"

/* The most slices of a block. */
#define WH_SLICES_MOST 1000
/* The longest message of a block, equal to that of others. */
#define WH_SLICES_BYTES WH_LINK_DATAGRAM
/* Axes, and twelve numbers for each gripper's pose. */
#define WH_SLICES_COLUMNS (WH_AXES + 12 * WH_GRIPPERS)

/* waferhand_recording.version: what this program writes. Logs without that message are of version 1. */
#define WH_RECORDING_VERSION 8
/* The oldest one that is read: it does not tell which face an encounter is with. */
#define WH_RECORDING_OLDEST 7

static inline bool wh_recording_is_known(int32_t version) {
    return version >= WH_RECORDING_OLDEST && version <= WH_RECORDING_VERSION;
}

/* waferhand_recording.mode. */
enum { WH_RECORDING_SLICES, WH_RECORDING_ALL };

/* waferhand_recording.closed. */
enum { WH_RECORDING_BEGINS, WH_RECORDING_ENDS, WH_RECORDING_GOES_ON };

/* The slices of a block, while they are collected and after decoding: 1.8 MB. Zero it at the beginning:
 * count 0. */
typedef struct {
    wh_link_identity_t identity;
    int64_t first;    /* number of the first slice */
    int64_t utime;    /* utime of the first slice, us */
    int64_t slice_us; /* from one utime to the next */
    int8_t lockstep;
    size_t grippers, axes;
    size_t count;
    uint16_t valves[WH_SLICES_MOST]; /* bit g: the command's valve of gripper g is 1 */
    uint16_t told[WH_SLICES_MOST];   /* bit g: the valve in force before faults is 1 */
    uint64_t hash[WH_SLICES_MOST];
    uint64_t column[WH_SLICES_COLUMNS][WH_SLICES_MOST]; /* bits of axes and poses */
} wh_slices_t;

/* Adds a slice: its command, the `valve_told` of its state for each of the command's grippers, and its
 * state's hash. Returns false and changes nothing if the slice does not fit. The block may be full. The
 * slice may not be the successor of the block's last slice, of the same run, layout, lockstep and counts,
 * by the same step of utime. The command may have faults, an order to an edge sensor or to beams, a valve
 * that is neither 0 nor 1, or a value in an unused entry. Cost: 0.1 us. */
bool wh_slices_add(wh_slices_t *slices, const waferhand_command *command, const int32_t told[],
                   uint64_t hash);

/* Encodes the slices from `*from` (below count) on as a whole message, sealed. It moves `*from` behind
 * them: to the count, or less far if one message does not hold them all. Returns the message's size. Cost:
 * 0.2 us a slice. */
size_t wh_slices_encode(const wh_slices_t *slices, size_t *from, uint8_t bytes[WH_SLICES_BYTES]);

/* Decodes a block. For any bytes, nothing beyond them is read. Returns false, and `slices` then has no
 * meaning, if they are no such message, its check is wrong or missing, a member is out of range, or bytes
 * are missing or left over. Cost: 0.2 us a slice. */
bool wh_slices_decode(const void *data, size_t size, wh_slices_t *slices);

/* Gives slice i (from 0): the command as it was, except `check`, which is 0, with the other arguments of
 * wh_slices_add. `told` has an entry for each gripper. */
void wh_slices_get(const wh_slices_t *slices, size_t i, waferhand_command *command, int32_t told[WH_GRIPPERS],
                   uint64_t *hash);

/* True if the bytes have the length that they state, and the right check: waferhand_slices_decode reads
 * nothing beyond them. */
bool wh_link_is_slices(const void *data, size_t size);

/* The longest name of a channel. */
#define WH_LINK_CHANNEL 63

/* waferhand_recording.digest: adds one more event on one of our channels. Begin with 0. Cost: about 2 ns
 * for each eight bytes.
 *
 * d = wh_hash_word(wh_hash_word(d, c), m) with the checks (messages.h) of channel and data, over all of
 * their bytes. */
uint64_t wh_link_digest(uint64_t before, const char *channel, const void *data, size_t size);

/* Decodes the description of a log; the check must be there and right. Returns true for other versions,
 * too, if they have the same members. Release it with waferhand_recording_decode_cleanup. */
bool wh_link_decode_recording(const void *data, size_t size, waferhand_recording *message);

#endif
