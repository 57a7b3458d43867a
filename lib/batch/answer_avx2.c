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
    const vectors_t v = {load(numbers), load(numbers + WH_BATCH_BLOCK), load(numbers + 2 * WH_BATCH_BLOCK)};
    return v;
}

AVX2 static inline lanes_t dot(const vectors_t *a, const vectors_t *b) {
    return a->x * b->x + a->y * b->y + a->z * b->z;
}

AVX2 static inline uint32_t bits_of(masks_t masks) {
    return (uint32_t)SIGNS((lanes_t)masks);
}

/* (7) and (8), where (6) has left some. */
AVX2 static uint32_t decide(const vectors_t *n1, const vectors_t *dr, const wh_real_t *far,
                            const wh_batch_question_t *question) {
    const vectors_t e1 = vectors_at(far);
    const vectors_t e2 = vectors_at(far + 3 * WH_BATCH_BLOCK);
    const lanes_t x = dot(&e1, dr);
    const lanes_t y = dot(&e2, dr);
    const lanes_t square = x * x + y * y;
    const wh_vec3_t *n2 = &question->n2;
    const lanes_t n1_proj_n2 = n1->x * n2->x + n1->y * n2->y + n1->z * n2->z;
    uint32_t bits = 0;
    for (size_t lane = 0; lane < LANES; ++lane) {
        bits |= (uint32_t)(wh_real_sqrt(square[lane]) < question->limits.projxy) << lane;
    }
    return bits & bits_of(n1_proj_n2 > question->limits.planar);
}

/* One bit for each wafer of as many as there are lanes. */
AVX2 static inline uint32_t ready_of_lanes(const wh_real_t *near, const wh_real_t *far,
                                           const wh_batch_question_t *question) {
    const vectors_t n1 = vectors_at(near);
    const vectors_t r = vectors_at(near + 3 * WH_BATCH_BLOCK);
    const vectors_t dr = {r.x - question->r.x, r.y - question->r.y, r.z - question->r.z};
    const lanes_t distance = (lanes_t)((masks_t)dot(&n1, &dr) & WITHOUT_SIGN);
    const uint32_t close = bits_of(distance < question->limits.projz);
    return close == 0 ? 0 : close & decide(&n1, &dr, far, question);
}

AVX2 void wh_batch_answer_avx2(const wh_batch_tile_t *tile, const wh_batch_question_t *question,
                               uint32_t *words) {
    for (size_t b = 0; b < tile->block_count; ++b) {
        const wh_real_t *near = tile->near + b * WH_BATCH_HALF;
        const wh_real_t *far = tile->far + b * WH_BATCH_HALF;
        uint32_t bits = 0;
        for (size_t lane = 0; lane < WH_BATCH_BLOCK; lane += LANES) {
            bits |= ready_of_lanes(near + lane, far + lane, question) << lane;
        }
        const size_t place = b % WH_BATCH_WORD;
        words[b / WH_BATCH_WORD] =
            (place == 0 ? 0 : words[b / WH_BATCH_WORD]) | bits << place * WH_BATCH_BLOCK;
    }
}
#endif
