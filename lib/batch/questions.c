#include "batch_internal.h"

/* The wafers over which grippers take turns. */
typedef struct {
    const wh_batch_t *batch;
    size_t first; /* the index of its first wafer */
    wh_batch_tile_t numbers;
} tile_t;

static tile_t tile_at(const wh_batch_t *batch, size_t first) {
    const size_t block = first / WH_BATCH_LANES;
    const size_t rest = WH_BATCH_WORDS(batch->wafer_count) - block;
    tile_t tile;
    tile.batch = batch;
    tile.first = first;
    tile.numbers.spheres = &batch->numbers[block / WH_BATCH_LANES * WH_BATCH_SPHERES];
    tile.numbers.origins = &batch->numbers[wh_batch_origins(batch->wafer_count) + block * WH_BATCH_BLOCK];
    tile.numbers.normals = &batch->numbers[wh_batch_normals(batch->wafer_count) + block * WH_BATCH_BLOCK];
    tile.numbers.block_count = rest < WH_BATCH_LANES ? rest : WH_BATCH_LANES;
    return tile;
}

/* The region in which a ready wafer can be. The pose of a ready wafer is valid, so its distance is at most
 * both limits together, plus a thousandth. Rounding adds, in units of float's last place, at most 3 of the
 * gripper's distance from base's origin and 14 of the limits; the code uses 4 and 16. */
static wh_batch_sieve_t sieve_around(const wh_vec3_t *r, const wh_tolerance_t *tolerance) {
    const wh_real_t limits = tolerance->projz + tolerance->projxy;
    const wh_real_t origin = wh_real_abs(r->x) + wh_real_abs(r->y) + wh_real_abs(r->z);
    const wh_real_t slack = (origin + 4 * limits) / 4194304;
    wh_batch_sieve_t sieve = {(float)NAN, 0, 0, 0, 0};
    if (wh_batch_fits(r)) {
        sieve.x = (float)r->x;
        sieve.y = (float)r->y;
        sieve.z = (float)r->z;
        sieve.reach = (float)(limits * WH_REAL(1.001) + slack);
        sieve.limit = (float)(tolerance->projz + slack);
    }
    return sieve;
}

static uint32_t sieve_tile(const tile_t *tile, const wh_batch_sieve_t *sieve, uint32_t *words) {
#if WH_BATCH_HAS_AVX2
    if (tile->batch->code == WH_BATCH_AVX2) {
        return wh_batch_sieve_avx2(sieve, &tile->numbers, words);
    }
#endif
    return wh_batch_sieve_portable(sieve, &tile->numbers, words);
}

/* Checks those of a block's 32 wafers, from `first` on, that passed the sieve. A lane without a wafer may
 * pass. */
static uint32_t check(const wh_batch_t *batch, size_t first, uint32_t passed, const wh_pose_t *gripper,
                      const wh_tolerance_t *tolerance) {
    uint32_t ready = 0;
    for (uint32_t rest = passed; rest != 0; rest &= rest - 1) {
        const size_t lane = wh_batch_lowest(rest);
        const bool is_ready = first + lane < batch->wafer_count &&
                              wh_proximity_ready(&batch->base_from_wafers[first + lane], gripper, tolerance);
        ready |= (uint32_t)is_ready << lane;
    }
    return ready;
}

static size_t count_bits(uint32_t bits) {
    size_t count = 0;
    for (uint32_t rest = bits; rest != 0; rest &= rest - 1) {
        ++count;
    }
    return count;
}

/* Finds the tile's ready wafers, one bit each; returns their number. */
static size_t answer(const tile_t *tile, const wh_pose_t *gripper, const wh_tolerance_t *tolerance,
                     uint32_t *words) {
    const wh_batch_sieve_t sieve = sieve_around(&gripper->r, tolerance);
    size_t ready = 0;
    for (uint32_t rest = sieve_tile(tile, &sieve, words); rest != 0; rest &= rest - 1) {
        const size_t i = wh_batch_lowest(rest);
        if (words[i] != 0) {
            words[i] = check(tile->batch, tile->first + i * WH_BATCH_LANES, words[i], gripper, tolerance);
            ready += count_bits(words[i]);
        }
    }
    return ready;
}

size_t wh_batch_ready(const wh_batch_t *batch, const wh_pose_t *base_from_grippers, size_t gripper_count,
                      const wh_tolerance_t *tolerance, uint32_t *bits) {
    size_t ready = 0;
    for (size_t first = 0; first < batch->wafer_count; first += WH_BATCH_TILE) {
        const tile_t tile = tile_at(batch, first);
        for (size_t g = 0; g < gripper_count; ++g) {
            uint32_t *words = &bits[g * WH_BATCH_WORDS(batch->wafer_count) + first / 32];
            ready += answer(&tile, &base_from_grippers[g], tolerance, words);
        }
    }
    return ready;
}

/* Lists the first `capacity` ready wafers of the tile; returns their number. */
static size_t list_tile(const tile_t *tile, const wh_pose_t *gripper, const wh_tolerance_t *tolerance,
                        int32_t *wafers, size_t capacity) {
    uint32_t words[WH_BATCH_LANES];
    const size_t ready = answer(tile, gripper, tolerance, words);
    size_t listed = 0;
    for (size_t i = 0; i < tile->numbers.block_count; ++i) {
        for (uint32_t rest = words[i]; rest != 0 && listed < capacity; rest &= rest - 1) {
            wafers[listed++] = (int32_t)(tile->first + 32 * i + wh_batch_lowest(rest));
        }
    }
    return ready;
}

size_t wh_batch_list(const wh_batch_t *batch, const wh_pose_t *base_from_gripper,
                     const wh_tolerance_t *tolerance, int32_t *wafers, size_t capacity) {
    size_t ready = 0;
    for (size_t first = 0; first < batch->wafer_count; first += WH_BATCH_TILE) {
        const tile_t tile = tile_at(batch, first);
        const size_t listed = ready < capacity ? ready : capacity;
        ready += list_tile(&tile, base_from_gripper, tolerance, &wafers[listed], capacity - listed);
    }
    return ready;
}

static wh_real_t distance(const wh_pose_t *wafer, const wh_pose_t *gripper) {
    const wh_vec3_t n1 = wh_mat3_column(&wafer->R, 2);
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->r, &gripper->r);
    return wh_real_abs(wh_vec3_dot(&dr, &n1));
}

/* The best wafer of the tile and of `before`, which is the best of the earlier tiles. */
static int32_t better(const tile_t *tile, const wh_pose_t *gripper, const wh_tolerance_t *tolerance,
                      int32_t before) {
    const wh_pose_t *wafers = tile->batch->base_from_wafers;
    uint32_t words[WH_BATCH_LANES];
    int32_t best = before;
    wh_real_t least = best == WH_NONE ? tolerance->projz : distance(&wafers[best], gripper);
    (void)answer(tile, gripper, tolerance, words);
    for (size_t i = 0; i < tile->numbers.block_count; ++i) {
        for (uint32_t rest = words[i]; rest != 0; rest &= rest - 1) {
            const size_t w = tile->first + 32 * i + wh_batch_lowest(rest);
            const wh_real_t here = distance(&wafers[w], gripper);
            if (here < least) {
                best = (int32_t)w;
                least = here;
            }
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
