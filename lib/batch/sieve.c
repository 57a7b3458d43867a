#include <string.h>

#include "batch_internal.h"

/* The distance of each of 32 beyond the sieve: it passes if that is not above 0. */
typedef struct {
    float by[WH_BATCH_LANES];
} beyond_t;

/* Usually all 32 are rejected. A first loop detects this; compilers turn it into code for several at a
 * time. */
static uint32_t passed(const beyond_t *beyond) {
    uint32_t held_back = 0;
    for (size_t i = 0; i < WH_BATCH_LANES; ++i) {
        held_back += beyond->by[i] > 0 ? 1U : 0U;
    }
    uint32_t bits = 0;
    for (size_t i = 0; i < WH_BATCH_LANES && held_back < WH_BATCH_LANES; ++i) {
        bits |= (beyond->by[i] > 0 ? 0U : 1U) << i;
    }
    return bits;
}

static uint32_t near_spheres(const wh_batch_sieve_t *sieve, const float *spheres) {
    beyond_t beyond;
    for (size_t i = 0; i < WH_BATCH_LANES; ++i) {
        const float x = spheres[i] - sieve->x;
        const float y = spheres[i + WH_BATCH_LANES] - sieve->y;
        const float z = spheres[i + 2 * WH_BATCH_LANES] - sieve->z;
        const float reach = spheres[i + 3 * WH_BATCH_LANES] + sieve->reach;
        beyond.by[i] = x * x + y * y + z * z - reach * reach;
    }
    return passed(&beyond);
}

static uint32_t near_origins(const wh_batch_sieve_t *sieve, const float *origins) {
    beyond_t beyond;
    for (size_t i = 0; i < WH_BATCH_LANES; ++i) {
        const float x = origins[i] - sieve->x;
        const float y = origins[i + WH_BATCH_LANES] - sieve->y;
        const float z = origins[i + 2 * WH_BATCH_LANES] - sieve->z;
        beyond.by[i] = x * x + y * y + z * z - sieve->reach * sieve->reach;
    }
    return passed(&beyond);
}

static uint32_t near_planes(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile, size_t block) {
    const float *origins = &tile->origins[block * WH_BATCH_BLOCK];
    const float *normals = &tile->normals[block * WH_BATCH_BLOCK];
    beyond_t beyond;
    for (size_t i = 0; i < WH_BATCH_LANES; ++i) {
        const float x = origins[i] - sieve->x;
        const float y = origins[i + WH_BATCH_LANES] - sieve->y;
        const float z = origins[i + 2 * WH_BATCH_LANES] - sieve->z;
        const float along =
            normals[i] * x + normals[i + WH_BATCH_LANES] * y + normals[i + 2 * WH_BATCH_LANES] * z;
        beyond.by[i] = fabsf(along) - sieve->limit;
    }
    return passed(&beyond);
}

uint32_t wh_batch_sieve_portable(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile,
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
