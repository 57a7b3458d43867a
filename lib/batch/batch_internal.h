/* Shared within the batch: a sieve for wafers that may be ready. It never holds back one that is. */
#ifndef WH_BATCH_BATCH_INTERNAL_H
#define WH_BATCH_BATCH_INTERNAL_H

#include "batch.h"

/* Numbers of a block of spheres, and of a block of wafers (as many for the origins as for n1), and the wafers
 * of a tile. A tile is 32 blocks: it stays in the nearest cache while grippers take turns. */
enum { WH_BATCH_SPHERES = 4 * WH_BATCH_LANES, WH_BATCH_BLOCK = 3 * WH_BATCH_LANES, WH_BATCH_TILE = 1024 };

/* A run of blocks: where their numbers begin. */
typedef struct {
    const float *spheres;
    const float *origins;
    const float *normals;
    size_t block_count; /* 1 to WH_BATCH_LANES */
} wh_batch_tile_t;

/* Holds back spheres whose centre is farther from (x, y, z) than radius + reach, and wafers whose origin is
 * farther than reach, or farther along n1 than limit. The comparisons let every NaN pass. */
typedef struct {
    float x;
    float y;
    float z;
    float reach;
    float limit;
} wh_batch_sieve_t;

/* True if a point, in mm, is so near to base's origin that squares fit into float. False for NaN. */
static inline bool wh_batch_fits(const wh_vec3_t *r) {
    return wh_real_abs(r->x) + wh_real_abs(r->y) + wh_real_abs(r->z) < WH_REAL(1e15);
}

/* Where the wafers' origins begin, and where their n1 begin. */
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
