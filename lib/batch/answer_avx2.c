#include "batch/batch_internal.h"

#if WH_BATCH_HAS_AVX2
#include <string.h>

/* Vectors and their operators are the compiler's: in each lane the operations of answer.c, each rounded on its own. */
#define AVX2 __attribute__((target("avx2")))
#define VECTOR __attribute__((vector_size(32)))

typedef wh_real_t lanes_t VECTOR;
#if defined(WH_FLOAT)
typedef int32_t masks_t VECTOR;
#define WITHOUT_SIGN INT32_MAX
#define SIGNS(lanes) __builtin_ia32_movmskps256(lanes)
#else
typedef int64_t masks_t VECTOR;
#define WITHOUT_SIGN INT64_MAX
#define SIGNS(lanes) __builtin_ia32_movmskpd256(lanes)
#endif
enum { LANES = sizeof(lanes_t) / sizeof(wh_real_t) };

typedef struct {
    lanes_t x, y, z;
} vectors_t;

AVX2 static inline lanes_t load(const wh_real_t *numbers) {
    lanes_t lanes;
    memcpy(&lanes, numbers, sizeof lanes);
    return lanes;
}

AVX2 static inline vectors_t vectors_at(const wh_real_t *numbers) {
    const vectors_t v = {load(numbers), load(&numbers[WH_BATCH_BLOCK]), load(&numbers[2 * WH_BATCH_BLOCK])};
    return v;
}

AVX2 static inline lanes_t dot(const vectors_t *a, const vectors_t *b) {
    return a->x * b->x + a->y * b->y + a->z * b->z;
}

AVX2 static inline uint32_t bits_of(masks_t masks) {
    return (uint32_t)SIGNS((lanes_t)masks);
}

/* (6), one bit for each lane; of the wafer as seen from the gripper or the other way round, which is the same number. */
AVX2 static inline uint32_t near_of_lanes(const wh_real_t *near, const wh_batch_question_t *question) {
    const vectors_t n1 = vectors_at(near);
    const vectors_t r = vectors_at(&near[3 * WH_BATCH_BLOCK]);
    const vectors_t dr = {question->r.x - r.x, question->r.y - r.y, question->r.z - r.z};
    const lanes_t distance = (lanes_t)((masks_t)dot(&n1, &dr) & WITHOUT_SIGN);
    return bits_of(distance < question->limits.projz);
}

/* (7) and (8). */
AVX2 static uint32_t ready_of_lanes(const wh_real_t *near, const wh_real_t *far,
                                    const wh_batch_question_t *question) {
    const vectors_t n1 = vectors_at(near);
    const vectors_t r = vectors_at(&near[3 * WH_BATCH_BLOCK]);
    const vectors_t dr = {r.x - question->r.x, r.y - question->r.y, r.z - question->r.z};
    const vectors_t e1 = vectors_at(far);
    const vectors_t e2 = vectors_at(&far[3 * WH_BATCH_BLOCK]);
    const lanes_t x = dot(&e1, &dr);
    const lanes_t y = dot(&e2, &dr);
    const lanes_t square = x * x + y * y;
    const wh_vec3_t *n2 = &question->n2;
    const lanes_t n1_proj_n2 = n1.x * n2->x + n1.y * n2->y + n1.z * n2->z;
    uint32_t bits = 0;
    for (size_t lane = 0; lane < LANES; ++lane) {
        bits |= (uint32_t)(wh_real_sqrt(square[lane]) < question->limits.projxy) << lane;
    }
    return bits & bits_of(n1_proj_n2 > question->limits.planar);
}

/* One bit for each wafer of as many blocks as a word has bits for, or fewer. */
AVX2 static inline uint32_t near_of_word(const wh_real_t *near, size_t block_count,
                                         const wh_batch_question_t *question) {
    uint32_t bits = 0;
    for (size_t b = 0; b < block_count; ++b) {
        const wh_real_t *block = &near[b * WH_BATCH_HALF];
        bits |= near_of_lanes(block, question) << b * WH_BATCH_BLOCK;
        if (LANES < WH_BATCH_BLOCK) {
            bits |= near_of_lanes(&block[LANES % WH_BATCH_BLOCK], question) << (b * WH_BATCH_BLOCK + LANES);
        }
    }
    return bits;
}

/* Of these wafers, the ready ones. */
AVX2 static uint32_t ready_of_word(const wh_real_t *near, const wh_real_t *far, uint32_t bits,
                                   const wh_batch_question_t *question) {
    uint32_t ready = 0;
    for (size_t lane = 0; lane < 32; lane += LANES) {
        const size_t at = lane / WH_BATCH_BLOCK * WH_BATCH_HALF + lane % WH_BATCH_BLOCK;
        const uint32_t asked = bits >> lane & ((1U << LANES) - 1);
        if (asked != 0) {
            ready |= (asked & ready_of_lanes(&near[at], &far[at], question)) << lane;
        }
    }
    return ready;
}

AVX2 void wh_batch_answer_avx2(const wh_batch_tile_t *tile, const wh_batch_question_t *question,
                               uint32_t *words) {
    for (size_t b = 0; b < tile->block_count; b += WH_BATCH_WORD) {
        const wh_real_t *near = &tile->near[b * WH_BATCH_HALF];
        const size_t rest = tile->block_count - b;
        const uint32_t bits =
            near_of_word(near, rest < WH_BATCH_WORD ? rest : (size_t)WH_BATCH_WORD, question);
        words[b / WH_BATCH_WORD] =
            bits == 0 ? 0 : ready_of_word(near, &tile->far[b * WH_BATCH_HALF], bits, question);
    }
}
#endif
