#include "batch/batch_internal.h"

/* wh_proximity_ready, from numbers that stand WH_BATCH_BLOCK apart. */
static bool is_ready(const wh_real_t *near, const wh_real_t *far, const wh_batch_question_t *question) {
    const wh_vec3_t n1 = wh_batch_vector(near);
    const wh_vec3_t r = wh_batch_vector(&near[3 * WH_BATCH_BLOCK]);
    const wh_vec3_t dr = wh_vec3_subtract(&r, &question->r);
    if (!(wh_real_abs(wh_vec3_dot(&n1, &dr)) < question->limits.projz)) {
        return false;
    }
    const wh_vec3_t e1 = wh_batch_vector(far);
    const wh_vec3_t e2 = wh_batch_vector(&far[3 * WH_BATCH_BLOCK]);
    const wh_real_t x = wh_vec3_dot(&e1, &dr);
    const wh_real_t y = wh_vec3_dot(&e2, &dr);
    return wh_real_root_below(x * x + y * y, question->limits.projxy) &&
           wh_vec3_dot(&n1, &question->n2) > question->limits.planar;
}

void wh_batch_answer_portable(const wh_batch_tile_t *tile, const wh_batch_question_t *question,
                              uint32_t *words) {
    for (size_t b = 0; b < tile->block_count; ++b) {
        const wh_real_t *near = &tile->near[b * WH_BATCH_HALF];
        const wh_real_t *far = &tile->far[b * WH_BATCH_HALF];
        uint32_t bits = 0;
        for (size_t lane = 0; lane < WH_BATCH_BLOCK; ++lane) {
            bits |= (uint32_t)is_ready(&near[lane], &far[lane], question) << lane;
        }
        const size_t place = b % WH_BATCH_WORD;
        words[b / WH_BATCH_WORD] =
            (place == 0 ? 0U : words[b / WH_BATCH_WORD]) | bits << place * WH_BATCH_BLOCK;
    }
}
