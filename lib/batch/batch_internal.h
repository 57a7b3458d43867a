/* Shared within the batch: a sieve for wafers that may be ready. It passes every wafer that is ready. */
#ifndef WH_BATCH_BATCH_INTERNAL_H
#define WH_BATCH_BATCH_INTERNAL_H

#include "batch.h"

/* Counts of numbers in a block of spheres, and in a block of wafers (once for the origins and once for n1),
 * and the wafers of a tile. A tile is 32 blocks: it stays in the nearest cache while grippers take
 * turns. */
enum { WH_BATCH_SPHERES = 4 * WH_BATCH_LANES, WH_BATCH_BLOCK = 3 * WH_BATCH_LANES, WH_BATCH_TILE = 1024 };

/* A run of blocks: the begins of their numbers. */
typedef struct {
    const float *spheres;
    const float *origins;
    const float *normals;
    size_t block_count; /* 1 to WH_BATCH_LANES */
} wh_batch_tile_t;

/* Rejects spheres whose centre is farther from (x, y, z) than radius + reach, and wafers whose origin is
 * farther than reach, or farther along n1 than limit. The comparisons let every NaN pass. */
typedef struct {
    float x;
    float y;
    float z;
    float reach;
    float limit;
} wh_batch_sieve_t;

/* True if a point, in mm, is so near to base's origin that its squares fit into float. Returns false for
 * NaN. */
static inline bool wh_batch_fits(const wh_vec3_t *r) {
    return wh_real_abs(r->x) + wh_real_abs(r->y) + wh_real_abs(r->z) < WH_REAL(1e15);
}

/* The begins of the wafers' origins and of their n1. */
static inline size_t wh_batch_origins(size_t wafer_count) {
    return (wafer_count + WH_BATCH_TILE - 1) / WH_BATCH_TILE * WH_BATCH_SPHERES;
}

static inline size_t wh_batch_normals(size_t wafer_count) {
    return wh_batch_origins(wafer_count) + WH_BATCH_WORDS(wafer_count) * WH_BATCH_BLOCK;
}

/* The index of the lowest bit that is set; there must be one. */
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

/* Writes a word for each block, with a bit for each wafer that passes. Returns a bit for each word that may
 * have one set. */
uint32_t wh_batch_sieve_portable(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile, uint32_t *words)
    WH_SYMBOL(wh_batch_sieve_portable);

#if defined(__GNUC__) && defined(__x86_64__)
#define WH_BATCH_HAS_AVX2 1
uint32_t wh_batch_sieve_avx2(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile, uint32_t *words)
    WH_SYMBOL(wh_batch_sieve_avx2);
#else
#define WH_BATCH_HAS_AVX2 0
#endif

#endif
