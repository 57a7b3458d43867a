#include "batch_internal.h"

#if WH_BATCH_HAS_AVX2
#include <string.h>

/* gcc and clang know vector types and their operators. */
#define AVX2 __attribute__((target("avx2")))
#define VECTOR __attribute__((vector_size(32)))

typedef float lanes_t VECTOR;
typedef int32_t masks_t VECTOR;
enum { LANES = sizeof(lanes_t) / sizeof(float) };

typedef struct {
    lanes_t x, y, z;
} vectors_t;

AVX2 static inline lanes_t load(const float *numbers) {
    lanes_t lanes;
    memcpy(&lanes, numbers, sizeof lanes);
    return lanes;
}

AVX2 static inline vectors_t vectors_at(const float *numbers) {
    const vectors_t v = {load(numbers), load(&numbers[WH_BATCH_LANES]), load(&numbers[2 * WH_BATCH_LANES])};
    return v;
}

AVX2 static inline vectors_t from_gripper(const wh_batch_sieve_t *sieve, const float *numbers) {
    const vectors_t v = vectors_at(numbers);
    const vectors_t d = {v.x - sieve->x, v.y - sieve->y, v.z - sieve->z};
    return d;
}

AVX2 static inline lanes_t dot(const vectors_t *a, const vectors_t *b) {
    return a->x * b->x + a->y * b->y + a->z * b->z;
}

AVX2 static inline uint32_t bits_of(masks_t masks) {
    return (uint32_t)__builtin_ia32_movmskps256((lanes_t)masks);
}

AVX2 static inline uint32_t near_spheres(const wh_batch_sieve_t *sieve, const float *spheres) {
    uint32_t beyond = 0;
    for (size_t i = 0; i < WH_BATCH_LANES; i += LANES) {
        const vectors_t d = from_gripper(sieve, &spheres[i]);
        const lanes_t reach = load(&spheres[i + 3 * WH_BATCH_LANES]) + sieve->reach;
        beyond |= bits_of(dot(&d, &d) > reach * reach) << i;
    }
    return ~beyond;
}

AVX2 static inline uint32_t beyond_reach(const wh_batch_sieve_t *sieve, const float *origins) {
    const vectors_t d = from_gripper(sieve, origins);
    return bits_of(dot(&d, &d) > sieve->reach * sieve->reach);
}

/* The inner loop if neighbours are not near each other. It is written out, because compilers at -O2 do not
 * unroll it. */
AVX2 static inline uint32_t near_origins(const wh_batch_sieve_t *sieve, const float *origins) {
    const uint32_t beyond = beyond_reach(sieve, origins) | beyond_reach(sieve, &origins[8]) << 8 |
                            beyond_reach(sieve, &origins[16]) << 16 | beyond_reach(sieve, &origins[24]) << 24;
    return ~beyond;
}

AVX2 static inline uint32_t near_planes(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile,
                                        size_t block) {
    const float *origins = &tile->origins[block * WH_BATCH_BLOCK];
    const float *normals = &tile->normals[block * WH_BATCH_BLOCK];
    uint32_t beyond = 0;
    for (size_t i = 0; i < WH_BATCH_LANES; i += LANES) {
        const vectors_t d = from_gripper(sieve, &origins[i]);
        const vectors_t n1 = vectors_at(&normals[i]);
        const masks_t distance = (masks_t)dot(&n1, &d) & INT32_MAX;
        beyond |= bits_of((lanes_t)distance > sieve->limit) << i;
    }
    return ~beyond;
}

AVX2 uint32_t wh_batch_sieve_avx2(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile,
                                  uint32_t *words) {
    const uint32_t near =
        near_spheres(sieve, tile->spheres) & UINT32_MAX >> (WH_BATCH_LANES - tile->block_count);
    (void)memset(words, 0, tile->block_count * sizeof *words);
    for (uint32_t rest = near; rest != 0; rest &= rest - 1) {
        const size_t b = wh_batch_lowest(rest);
        words[b] = near_origins(sieve, &tile->origins[b * WH_BATCH_BLOCK]);
        if (words[b] != 0) {
            words[b] &= near_planes(sieve, tile, b);
        }
    }
    return near;
}
#endif
