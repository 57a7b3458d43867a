/* The proximity check for many at once: every gripper pose against every wafer, for layout studies.
 *
 * The verdicts are those of wh_proximity_ready, bit for bit, but few wafers need the full check. A batch
 * keeps in the caller's memory, always in float, each wafer's origin and n1 (its third axis) as a structure
 * of arrays, and a sphere around each 32 origins. A wafer cannot be ready if it is too far from the
 * gripper: farther than the limits (6) and (7) together, or along n1 farther than (6), with a reserve for
 * all roundings. The sieve finds this for several wafers at a time if the processor can, and for 32 by one
 * sphere if neighbours in the array are near each other in space. No wafer is held here: the caller or the
 * grasp table (grasp/grasp.h) decides who may take it. A study of many cells makes a batch for each.
 *
 * Nothing is allocated, nothing is static. A batch may be copied or moved together with its memory.
 * Questions only read: several threads may ask one batch at the same time. wh_batch_init and wh_batch_place
 * must not overlap with anything.
 *
 *     static wh_pose_t base_from_wafers[1000];
 *     static float numbers[WH_BATCH_NUMBERS(1000)];
 *     static uint32_t bits[WH_BATCH_WORDS(1000)];
 *     wh_batch_t batch;
 *     wh_batch_init(&batch, base_from_wafers, 1000, numbers, WH_BATCH_NUMBERS(1000));
 *     wh_batch_ready(&batch, &base_from_gripper, 1, &tolerance, bits);
 *     ready = (bits[wafer / 32] >> wafer % 32 & 1) != 0;
 */
#ifndef WH_BATCH_BATCH_H
#define WH_BATCH_BATCH_H

#include "../grasp/proximity.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(batch);

/* The count of numbers for a batch of this size, and of lines of 64 of them: 24.5 bytes for each wafer,
 * rounded up to whole blocks of 32 wafers and of 32 spheres. Layout: for each 32 spheres 32 x of the
 * centre, 32 y, 32 z, 32 radii; after all of these, for each block 32 x of the origin, 32 y, 32 z; after
 * all of these, for each block 32 x of n1, 32 y, 32 z. A wafer whose pose fails wh_pose_validate, or is
 * beyond 1e15 mm, has NaN there, and so has its sphere: the full check decides on it. Unused entries are
 * infinite. Any alignment of float works; 64 bytes is the fastest. */
#define WH_BATCH_LANES WH_CAST(size_t, 32)
#define WH_BATCH_NUMBERS(wafer_count) (WH_BATCH_LINES(wafer_count) * 64)
#define WH_BATCH_LINES(wafer_count)                                                                          \
    (((wafer_count) + (size_t)1023) / 1024 * 2 + ((wafer_count) + (size_t)31) / 32 * 3)

/* The number of words of a set of wafers. Wafer w is bit w % 32 of word w / 32; bits beyond the last wafer
 * are 0. */
#define WH_BATCH_WORDS(wafer_count) (((wafer_count) + WH_CAST(size_t, 31)) / 32)

/* The code of the sieve: portable C, or AVX2 for 8 wafers at a time. AVX2 is in builds of gcc or clang for
 * x86-64, on processors that have it. The verdicts are equal. */
typedef enum WH_FOUR_BYTES { WH_BATCH_PORTABLE, WH_BATCH_AVX2 } wh_batch_code_t;

/* The caller may only read it. */
typedef struct {
    wh_pose_t *base_from_wafers; /* they belong to the caller, like the numbers */
    float *numbers;
    size_t wafer_count;
    wh_batch_code_t code;
} wh_batch_t;

/* Makes a batch of these wafers with the fastest code that the processor has. `numbers` has room for
 * number_count, at least WH_BATCH_NUMBERS(wafer_count). Poses and numbers stay where they are: they live as
 * long as the batch, and nobody else writes to them. Refuses null pointers (arrays may be null if wafer_count
 * is 0), more than INT32_MAX wafers and a number_count that is too small (both WH_STATUS_BAD_CAPACITY), and
 * numbers among the poses (WH_STATUS_OVERLAP); nothing has changed then. Poses are not checked: a wafer
 * with a NaN anywhere is never ready. Cost: linear in wafers. */
wh_status_t wh_batch_init(wh_batch_t *batch, wh_pose_t *base_from_wafers, size_t wafer_count, float *numbers,
                          size_t number_count) WH_SYMBOL(wh_batch_init);

/* Chooses a code, for a test or a comparison. Returns WH_STATUS_OUT_OF_RANGE if this build or processor
 * does not have it; nothing changes then. */
wh_status_t wh_batch_use(wh_batch_t *batch, wh_batch_code_t code) WH_SYMBOL(wh_batch_use);

/* Moves one wafer. The pose is not checked. Returns WH_STATUS_OUT_OF_RANGE if there is no such wafer;
 * nothing changes then. Cost: that of wh_batch_init for 32 wafers. */
wh_status_t wh_batch_place(wh_batch_t *batch, size_t wafer, const wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_batch_place);

/* The questions. No argument is checked: the batch must be one that wh_batch_init accepted, and the
 * tolerance valid.
 *
 * Cost for each gripper: 4 products in float for each sphere, 3 for each wafer of a near sphere, and 3 more
 * for each 32 wafers that include a near one. The full check is needed for a near wafer whose |dr_proj_z|
 * is within the limit, or exceeds it by less than a millionth of the gripper's distance from base's origin.
 * Grippers take turns over 1,024 wafers at a time, so that these stay in the nearest cache.
 */

/* Each gripper's ready wafers: `bits` receives WH_BATCH_WORDS(wafer_count) words for each gripper, one after
 * the other. Returns how many bits are set. */
size_t wh_batch_ready(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                      const wh_tolerance_t *tolerance, uint32_t *bits) WH_SYMBOL(wh_batch_ready);

/* One gripper's ready wafers by index, ascending. Returns their number; `wafers` receives the first
 * `capacity`. */
size_t wh_batch_list(const wh_batch_t *batch, const wh_pose_t *base_from_gripper,
                     const wh_tolerance_t *tolerance, int32_t *wafers, size_t capacity)
    WH_SYMBOL(wh_batch_list);

/* The wafer that each gripper would take if all were free, by the grasp table's rule: of the ready wafers
 * the one with the smallest |dr_proj_z|, of equal ones the lowest index; WH_NONE if none is ready. Returns
 * the number of grippers that have one. */
size_t wh_batch_best(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                     const wh_tolerance_t *tolerance, int32_t *best) WH_SYMBOL(wh_batch_best);

WH_HEADER_END

#endif
