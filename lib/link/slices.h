/* Slices in blocks: commands and hashes of consecutive slices of one run, coded without loss of a bit.
 *
 * A recording holds such blocks (channel WAFERHAND_SLICES) in place of a command and a state for each slice.
 * lcm_types/README.md describes their bytes. A block stands by itself: decoding one needs no other. Nothing
 * here allocates but wh_slices_decode, which releases what it takes, and liblcm.
 */
#ifndef WH_LINK_SLICES_H
#define WH_LINK_SLICES_H

#include <waferhand_recording.h>
#include <waferhand_slices.h>

#include "messages.h"

/* In recordings only. */
#define WH_CHANNEL_SLICES "WAFERHAND_SLICES"
#define WH_CHANNEL_RECORDING "WAFERHAND_RECORDING"

/* The most slices of a block. */
#define WH_SLICES_MOST 1000
/* The longest message of a block, as long as others are. */
#define WH_SLICES_BYTES WH_LINK_DATAGRAM
/* Axes, and twelve numbers for each gripper's pose. */
#define WH_SLICES_COLUMNS (WH_AXES + 12 * WH_GRIPPERS)

/* waferhand_recording.version: what this program writes. Logs without that message are of version 1. */
#define WH_RECORDING_VERSION 7

/* waferhand_recording.mode. */
enum { WH_RECORDING_SLICES, WH_RECORDING_ALL };

/* waferhand_recording.closed. */
enum { WH_RECORDING_BEGINS, WH_RECORDING_ENDS, WH_RECORDING_GOES_ON };

/* Slices of a block, as they are collected and as they come out: 1.8 MB. Zero it to begin with: count 0. */
typedef struct {
    wh_link_identity_t identity;
    int64_t first;    /* number of the first slice */
    int64_t utime;    /* the first slice's, us */
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
 * state's hash. False, and nothing has changed, if the slice does not fit: the block is full; it is no
 * successor of the block's last slice, of the same run, layout, lockstep and counts, by the same step of
 * utime; the command has faults or an order to an edge sensor or to beams, a valve that is neither 0 nor 1,
 * or anything in an entry that does not count. Cost: 0.1 us. */
bool wh_slices_add(wh_slices_t *slices, const waferhand_command *command, const int32_t told[],
                   uint64_t hash);

/* Encodes the slices from `*from` (below count) on as a whole message, sealed, and moves `*from` behind them:
 * to the count, or less far if one message does not hold them all. Returns the message's size. Cost: 0.2 us
 * a slice. */
size_t wh_slices_encode(const wh_slices_t *slices, size_t *from, uint8_t bytes[WH_SLICES_BYTES]);

/* Back. Whatever the bytes are, nothing is read beyond them. False, and `slices` is then without a
 * meaning, if they are no such message, its check is wrong or missing, a member is out of range, or bytes are
 * missing or left over. Cost: 0.2 us a slice. */
bool wh_slices_decode(const void *data, size_t size, wh_slices_t *slices);

/* Slice i (from 0) as the command was, but for `check`, which is 0, with what wh_slices_add was given. `told`
 * has an entry for each gripper. */
void wh_slices_get(const wh_slices_t *slices, size_t i, waferhand_command *command, int32_t told[WH_GRIPPERS],
                   uint64_t *hash);

/* True if the bytes have the length that they say, and the right check: waferhand_slices_decode reads nothing
 * beyond them. */
bool wh_link_is_slices(const void *data, size_t size);

/* The longest name of a channel. */
#define WH_LINK_CHANNEL 63

/* waferhand_recording.digest: with one more event on one of our channels. Begin with 0. Cost: about 2 ns for
 * each eight bytes.
 *
 * d = wh_hash_word(wh_hash_word(d, c), m) with the checks (messages.h) of channel and data, over all of their
 * bytes. */
uint64_t wh_link_digest(uint64_t before, const char *channel, const void *data, size_t size);

/* Decodes what a log is; the check must be there and right. True for other versions, too, if they have the
 * same members. Release it with waferhand_recording_decode_cleanup. */
bool wh_link_decode_recording(const void *data, size_t size, waferhand_recording *message);

#endif
