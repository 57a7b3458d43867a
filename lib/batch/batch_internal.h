/* Within the batch: which wafers may be ready, by a sieve that never holds back one that is. */
#ifndef WH_BATCH_BATCH_INTERNAL_H
#define WH_BATCH_BATCH_INTERNAL_H

#include "batch.h"

/* Numbers of a block of spheres, and of a block of wafers, as many for the origins as for n1; wafers of a tile, 32 blocks, which
 * stay in the nearest cache while grippers go over them in turns. */
enum { WH_BATCH_SPHERES = 4 * WH_BATCH_LANES, WH_BATCH_BLOCK = 3 * WH_BATCH_LANES, WH_BATCH_TILE = 1024 };

/* Blocks that follow one another: where their numbers begin. */
typedef struct {
    const float *spheres;
    const float *origins;
    const float *normals;
    size_t block_count; /* 1 to WH_BATCH_LANES */
} wh_batch_tile_t;

/* Holds back spheres whose centre is farther from (x, y, z) than radius + reach, and wafers whose origin is farther than reach, or
 * along n1 than the limit. Comparisons are such that a NaN anywhere holds nothing back. */
typedef struct {
    float x;
    float y;
    float z;
    float reach;
    float limit;
} wh_batch_sieve_t;

/* Whether a point is near enough to base's origin, in mm, that squares fit into float. NaN is not. */
static inline bool wh_batch_fits(const wh_vec3_t *r) {
    return wh_real_abs(r->x) + wh_real_abs(r->y) + wh_real_abs(r->z) < WH_REAL(1e15);
}

/* Where the wafers' origins begin, and where n1. */
static inline size_t wh_batch_origins(size_t wafer_count) {
    return (wafer_count + WH_BATCH_TILE - 1) / WH_BATCH_TILE * WH_BATCH_SPHERES;
}

static inline size_t wh_batch_normals(size_t wafer_count) {
    return wh_batch_origins(wafer_count) + WH_BATCH_WORDS(wafer_count) * WH_BATCH_BLOCK;
}

/* Where the lowest bit is that is set; one must be. */
static inline size_t wh_batch_lowest(uint32_t bits) {
#if defined(__GNUC__)
    return (size_t)__builtin_ctz(bits);
#else
    size_t i = 0;
    for (; (bits >> i & 1U) == 0; ++i) {
    }
    return i;
#endif
}

/* A word for each block, a bit for each wafer that passes. Returns a bit for each word that may have one set. */
uint32_t wh_batch_sieve_portable(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile, uint32_t *words);

#if defined(__GNUC__) && defined(__x86_64__)
#define WH_BATCH_HAS_AVX2 1
uint32_t wh_batch_sieve_avx2(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile, uint32_t *words);
#else
#define WH_BATCH_HAS_AVX2 0
#endif

#endif
