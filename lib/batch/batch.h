/* The proximity check for many at once: every gripper pose against every wafer, for layout studies.
 *
 * A batch holds the poses of up to INT32_MAX wafers, number by number (a structure of arrays), in the caller's memory. The
 * questions below give for each wafer the verdict of wh_proximity_ready, bit for bit: |dr_proj_z|, which needs 6 of a wafer's
 * 12 numbers, rejects most wafers, several at a time where the processor can, and the formulas decide on the rest. Nobody
 * holds a wafer here: who may take what is the caller's business, or the grasp table's (core/grasp.h). A study of many cells
 * makes a batch of each.
 *
 * Nothing is allocated, nothing is static. A batch may be copied or moved together with its memory. Questions only read: they
 * may overlap on one batch from several threads; wh_batch_init and wh_batch_place must not overlap with anything.
 *
 *     static wh_real_t numbers[WH_BATCH_NUMBERS(1000)];
 *     static uint32_t bits[WH_BATCH_WORDS(1000)];
 *     wh_batch_t batch;
 *     wh_batch_init(&batch, base_from_wafers, 1000, numbers, WH_BATCH_NUMBERS(1000));
 *     wh_batch_ready(&batch, &base_from_gripper, 1, &tolerance, bits);
 *     ready = (bits[wafer / 32] >> wafer % 32 & 1) != 0;
 */
#ifndef WH_BATCH_BATCH_H
#define WH_BATCH_BATCH_H

#include "core/proximity.h"

/* How many numbers a batch of so many wafers takes: 96 bytes a wafer (48 in float), rounded up to whole blocks of 8 wafers.
 * Layout: for each block 8 x of n1, 8 y, 8 z, 8 x of the position, 8 y, 8 z; after all of these, for each block likewise
 * e1 and e2, the other two columns of R. What no wafer fills is NaN. Any alignment of wh_real_t will do; to 64 bytes is the
 * fastest. */
#define WH_BATCH_BLOCK ((size_t)8)
#define WH_BATCH_NUMBERS(wafer_count) (((wafer_count) + (size_t)7) / 8 * 96)

/* How many words a set of wafers takes: wafer w is bit w % 32 of word w / 32; bits beyond the last wafer are 0. */
#define WH_BATCH_WORDS(wafer_count) (((wafer_count) + (size_t)31) / 32)

/* What the first of the two steps is done with: C as everywhere, or AVX2, 4 wafers (8 in float) at a time, in builds of gcc or
 * clang for x86-64 on processors that have it. The verdicts are the same. */
typedef enum { WH_BATCH_PORTABLE, WH_BATCH_AVX2 } wh_batch_code_t;

/* Read only. */
typedef struct {
    wh_real_t *numbers; /* the caller's */
    size_t wafer_count;
    wh_batch_code_t code;
} wh_batch_t;

/* Puts the wafers' poses into `numbers`, which has room for number_count, at least WH_BATCH_NUMBERS(wafer_count), lives as long
 * as the batch and belongs to it alone; with the fastest code that the processor has. Refuses null pointers (arrays may be null
 * when wafer_count is 0), more than INT32_MAX wafers (WH_STATUS_BAD_CAPACITY) and a number_count that is too small (likewise);
 * nothing has changed then. Poses are not checked: as with wh_proximity_ready, they must be valid, except that a wafer with a
 * NaN anywhere is never ready. Cost: linear in wafers. */
wh_status_t wh_batch_init(wh_batch_t *batch, const wh_pose_t *base_from_wafers, size_t wafer_count,
                          wh_real_t *numbers, size_t number_count);

/* Takes the code that is asked for, as for a test or a comparison. WH_STATUS_OUT_OF_RANGE where there is none such; nothing has
 * changed then. */
wh_status_t wh_batch_use(wh_batch_t *batch, wh_batch_code_t code);

/* Moves one wafer. The pose is not checked. WH_STATUS_OUT_OF_RANGE: no such wafer; nothing has changed then. */
wh_status_t wh_batch_place(wh_batch_t *batch, size_t wafer, const wh_pose_t *base_from_wafer);

/* Where a wafer is, the bits that were put in. WH_STATUS_OUT_OF_RANGE: no such wafer; `base_from_wafer` is unchanged then. */
wh_status_t wh_batch_wafer(const wh_batch_t *batch, size_t wafer, wh_pose_t *base_from_wafer);

/* The questions. No argument is checked: the batch must be one that wh_batch_init accepted, poses and tolerance must be valid,
 * except that a NaN anywhere gives no ready wafer. Cost: 3 products for each pair of a gripper and a wafer, 15 more and a square
 * root within the limit (6); grippers go in turns over 512 wafers at a time, so that these stay in the cache. */

/* Each gripper's ready wafers: `bits` receives WH_BATCH_WORDS(wafer_count) words for each gripper, one after the other. Returns
 * how many bits are set. */
size_t wh_batch_ready(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                      const wh_tolerance_t *tolerance, uint32_t *bits);

/* One gripper's ready wafers by index, ascending: how many there are, of which `wafers` receives the first `capacity`. */
size_t wh_batch_list(const wh_batch_t *batch, const wh_pose_t *base_from_gripper,
                     const wh_tolerance_t *tolerance, int32_t *wafers, size_t capacity);

/* The wafer that each gripper would take, if nobody holds one, by the grasp table's rule: of the ready ones the one with the
 * smallest |dr_proj_z|, of equal ones the lowest index; WH_NONE where none is ready. Returns how many grippers have one. */
size_t wh_batch_best(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                     const wh_tolerance_t *tolerance, int32_t *best);

#endif
