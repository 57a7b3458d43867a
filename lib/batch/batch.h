/* The proximity check for many at once: every gripper pose against every wafer, for layout studies.
 *
 * The verdicts are those of wh_proximity_ready, bit for bit, but few wafers are put to it. A batch keeps, in the caller's memory
 * and in float whatever the library's number is, each wafer's origin and n1, its third axis, number by number (a structure of
 * arrays), and a sphere around each 32 origins. A wafer that is farther from the gripper than the limits (6) and (7) together,
 * or along n1 farther than (6), by more than all roundings could make up, is not ready; that is found out of several at a time
 * where the processor can, of 32 by one sphere where wafers that are near each other follow one another. Nobody holds a wafer
 * here: who may take what is the caller's business, or the grasp table's (grasp/grasp.h). A study of many cells makes a batch
 * of each.
 *
 * Nothing is allocated, nothing is static. A batch may be copied or moved together with its memory. Questions only read: they
 * may overlap on one batch from several threads; wh_batch_init and wh_batch_place must not overlap with anything.
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

/* How many numbers a batch of so many wafers takes, and in how many lines of 64: 24.5 bytes a wafer, rounded up to whole blocks
 * of 32 wafers and of 32 spheres. Layout: for each 32 spheres 32 x of the centre, 32 y, 32 z, 32 radii; after all of these, for
 * each block 32 x of the origin, 32 y, 32 z; after all of these, for each block 32 x of n1, 32 y, 32 z. A wafer whose pose does
 * not pass wh_pose_validate, or is beyond 1e15 mm, has NaN there, and so has its sphere: the check decides on it. What no
 * wafer fills is infinite. Any alignment of float will do; to 64 bytes is the fastest. */
#define WH_BATCH_LANES ((size_t)32)
#define WH_BATCH_NUMBERS(wafer_count) (WH_BATCH_LINES(wafer_count) * 64)
#define WH_BATCH_LINES(wafer_count)                                                                          \
    (((wafer_count) + (size_t)1023) / 1024 * 2 + ((wafer_count) + (size_t)31) / 32 * 3)

/* How many words a set of wafers takes: wafer w is bit w % 32 of word w / 32; bits beyond the last wafer are 0. */
#define WH_BATCH_WORDS(wafer_count) (((wafer_count) + (size_t)31) / 32)

/* What wafers are sieved with: C as everywhere, or AVX2, 8 at a time, in builds of gcc or clang for x86-64 on processors
 * that have it. The verdicts are the same. */
typedef enum { WH_BATCH_PORTABLE, WH_BATCH_AVX2 } wh_batch_code_t;

/* Read only. */
typedef struct {
    wh_pose_t *base_from_wafers; /* the caller's, as are the numbers */
    float *numbers;
    size_t wafer_count;
    wh_batch_code_t code;
} wh_batch_t;

/* A batch of these wafers with the fastest code that the processor has; `numbers` has room for number_count, at least
 * WH_BATCH_NUMBERS(wafer_count). The poses stay where they are: they and the numbers live as long as the batch, and nobody else
 * writes to them. Refuses null pointers (arrays may be null when wafer_count is 0), more than INT32_MAX wafers
 * (WH_STATUS_BAD_CAPACITY) and a number_count that is too small (likewise); nothing has changed then. Poses are not checked: a
 * wafer with a NaN anywhere is never ready. Cost: linear in wafers. */
wh_status_t wh_batch_init(wh_batch_t *batch, wh_pose_t *base_from_wafers, size_t wafer_count, float *numbers,
                          size_t number_count);

/* Takes the code that is asked for, as for a test or a comparison. WH_STATUS_OUT_OF_RANGE where there is none such; nothing has
 * changed then. */
wh_status_t wh_batch_use(wh_batch_t *batch, wh_batch_code_t code);

/* Moves one wafer. The pose is not checked. WH_STATUS_OUT_OF_RANGE: no such wafer; nothing has changed then. Cost: that of
 * wh_batch_init for 32 wafers. */
wh_status_t wh_batch_place(wh_batch_t *batch, size_t wafer, const wh_pose_t *base_from_wafer);

/* The questions. No argument is checked: the batch must be one that wh_batch_init accepted, and the tolerance valid. Cost, for
 * each gripper: 4 products in float a sphere, 3 for each wafer of one that it is near, 3 more for each 32 of which one is near,
 * and the check where |dr_proj_z| of a wafer that is near is within the limit, or beyond it by less than a millionth of how
 * far the gripper is from base's origin. Grippers go in turns over 1,024 wafers at a time, so that these stay in the nearest
 * cache. */

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
