#include "batch/batch_internal.h"

/* As many wafers as grippers go over in turns. */
typedef struct {
    size_t first; /* the index of its first wafer */
    size_t word_count;
    wh_batch_tile_t numbers;
    const wh_batch_t *batch;
} tile_t;

static tile_t tile_at(const wh_batch_t *batch, size_t first) {
    const size_t rest = batch->wafer_count - first;
    const size_t wafers = rest < WH_BATCH_TILE ? rest : (size_t)WH_BATCH_TILE;
    const wh_real_t *near = &batch->numbers[first / WH_BATCH_BLOCK * WH_BATCH_HALF];
    tile_t tile;
    tile.first = first;
    tile.word_count = WH_BATCH_WORDS(wafers);
    tile.numbers.near = near;
    tile.numbers.far = &near[WH_BATCH_NUMBERS(batch->wafer_count) / 2];
    tile.numbers.block_count = (wafers + WH_BATCH_BLOCK - 1) / WH_BATCH_BLOCK;
    tile.batch = batch;
    return tile;
}

static void answer(const tile_t *tile, const wh_pose_t *gripper, const wh_tolerance_t *tolerance,
                   uint32_t *words) {
    wh_batch_question_t question;
    question.r = gripper->r;
    question.n2 = wh_mat3_column(&gripper->R, 2);
    question.limits = *tolerance;
    for (size_t i = 0; i < 2; ++i) {
        const wh_real_t unused = gripper->R.m[0][i] + gripper->R.m[1][i] + gripper->R.m[2][i];
        question.n2.x += unused - unused;
    }
#if WH_BATCH_HAS_AVX2
    if (tile->batch->code == WH_BATCH_AVX2) {
        wh_batch_answer_avx2(&tile->numbers, &question, words);
        return;
    }
#endif
    wh_batch_answer_portable(&tile->numbers, &question, words);
}

static size_t count_bits(const uint32_t *words, size_t word_count) {
    size_t count = 0;
    for (size_t i = 0; i < word_count; ++i) {
        for (uint32_t rest = words[i]; rest != 0; rest &= rest - 1) {
            ++count;
        }
    }
    return count;
}

size_t wh_batch_ready(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                      const wh_tolerance_t *tolerance, uint32_t *bits) {
    size_t ready = 0;
    for (size_t first = 0; first < batch->wafer_count; first += WH_BATCH_TILE) {
        const tile_t tile = tile_at(batch, first);
        for (size_t g = 0; g < gripper_count; ++g) {
            uint32_t *words = &bits[g * WH_BATCH_WORDS(batch->wafer_count) + first / 32];
            answer(&tile, &base_from_grippers[g], tolerance, words);
            ready += count_bits(words, tile.word_count);
        }
    }
    return ready;
}

/* The tile's first ready wafer that is not before `wafer`; the batch's number of wafers when there is none. */
static size_t next_ready(const tile_t *tile, const uint32_t *words, size_t wafer) {
    size_t i = wafer - tile->first;
    while (i < tile->word_count * 32 && words[i / 32] >> i % 32 == 0) {
        i = (i / 32 + 1) * 32;
    }
    if (i >= tile->word_count * 32) {
        return tile->batch->wafer_count;
    }
    while ((words[i / 32] >> i % 32 & 1U) == 0) {
        ++i;
    }
    return tile->first + i;
}

size_t wh_batch_list(const wh_batch_t *batch, const wh_pose_t *base_from_gripper,
                     const wh_tolerance_t *tolerance, int32_t *wafers, size_t capacity) {
    size_t ready = 0;
    for (size_t first = 0; first < batch->wafer_count; first += WH_BATCH_TILE) {
        uint32_t words[WH_BATCH_TILE / 32];
        const tile_t tile = tile_at(batch, first);
        answer(&tile, base_from_gripper, tolerance, words);
        for (size_t w = next_ready(&tile, words, first); w < batch->wafer_count;
             w = next_ready(&tile, words, w + 1)) {
            if (ready < capacity) {
                wafers[ready] = (int32_t)w;
            }
            ++ready;
        }
    }
    return ready;
}

static wh_real_t distance(const wh_batch_t *batch, size_t wafer, const wh_vec3_t *gripper) {
    const wh_real_t *near = &batch->numbers[wafer / WH_BATCH_BLOCK * WH_BATCH_HALF + wafer % WH_BATCH_BLOCK];
    const wh_vec3_t n1 = wh_batch_vector(near);
    const wh_vec3_t r = wh_batch_vector(&near[3 * WH_BATCH_BLOCK]);
    const wh_vec3_t dr = wh_vec3_subtract(&r, gripper);
    return wh_real_abs(wh_vec3_dot(&dr, &n1));
}

/* The best of `before`, from the tiles before, and of the tile's. */
static int32_t better(const tile_t *tile, const wh_pose_t *gripper, const wh_tolerance_t *tolerance,
                      int32_t before) {
    const wh_batch_t *batch = tile->batch;
    uint32_t words[WH_BATCH_TILE / 32];
    answer(tile, gripper, tolerance, words);
    int32_t best = before;
    wh_real_t least = best == WH_NONE ? tolerance->projz : distance(batch, (size_t)best, &gripper->r);
    for (size_t w = next_ready(tile, words, tile->first); w < batch->wafer_count;
         w = next_ready(tile, words, w + 1)) {
        const wh_real_t here = distance(batch, w, &gripper->r);
        if (here < least) {
            best = (int32_t)w;
            least = here;
        }
    }
    return best;
}

size_t wh_batch_best(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                     const wh_tolerance_t *tolerance, int32_t *best) {
    for (size_t g = 0; g < gripper_count; ++g) {
        best[g] = WH_NONE;
    }
    for (size_t first = 0; first < batch->wafer_count; first += WH_BATCH_TILE) {
        const tile_t tile = tile_at(batch, first);
        for (size_t g = 0; g < gripper_count; ++g) {
            best[g] = better(&tile, &base_from_grippers[g], tolerance, best[g]);
        }
    }
    size_t found = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        found += best[g] != WH_NONE ? 1U : 0U;
    }
    return found;
}
