/* Within the batch: verdicts for a tile, as many wafers as stay in the nearest cache while grippers go over them in turns. */
#ifndef WH_BATCH_BATCH_INTERNAL_H
#define WH_BATCH_BATCH_INTERNAL_H

#include "batch/batch.h"

/* Numbers of a block in one of the two halves of the memory; wafers of a tile; blocks of a word. */
enum { WH_BATCH_HALF = 6 * WH_BATCH_BLOCK, WH_BATCH_TILE = 512, WH_BATCH_WORD = 32 / WH_BATCH_BLOCK };

/* What a gripper asks, the same for each wafer. */
typedef struct {
    wh_vec3_t r;  /* the gripper's position */
    wh_vec3_t n2; /* with x NaN when there is one, or an infinity, in the gripper's other two axes */
    wh_tolerance_t limits;
} wh_batch_question_t;

/* Blocks that follow one another: where their numbers begin in either half. */
typedef struct {
    const wh_real_t *near;
    const wh_real_t *far;
    size_t block_count; /* 1 to WH_BATCH_TILE / WH_BATCH_BLOCK */
} wh_batch_tile_t;

/* Three numbers of a wafer's. */
static inline wh_vec3_t wh_batch_vector(const wh_real_t *numbers) {
    return wh_vec3(numbers[0], numbers[WH_BATCH_BLOCK], numbers[2 * WH_BATCH_BLOCK]);
}

/* The tile's ready wafers, from the first word's lowest bit on; the last word's bits of no block are 0. */
void wh_batch_answer_portable(const wh_batch_tile_t *tile, const wh_batch_question_t *question,
                              uint32_t *words);

#if defined(__GNUC__) && defined(__x86_64__)
#define WH_BATCH_HAS_AVX2 1
void wh_batch_answer_avx2(const wh_batch_tile_t *tile, const wh_batch_question_t *question, uint32_t *words);
#else
#define WH_BATCH_HAS_AVX2 0
#endif

#endif
