#include "horizon_internal.h"

#include <string.h>

/* The longest distance that a word holds, in units. */
#define LONGEST 536870912

#if defined(WH_FLOAT)
#define ROUNDING (16 * WH_REAL(FLT_EPSILON))
#else
#define ROUNDING (16 * WH_REAL(DBL_EPSILON))
#endif

/* Units that are subtracted: rounding a place to units moves it by less than 1.74 of them. The rest is much
 * more than the rounding error of a neighbourhood's distances. */
#define TAKEN_OFF WH_REAL(2)

/* The longest column of a rotation: no distance changes by more than this times the gripper's way. */
#define LONGEST_COLUMN (1 + 3 * WH_ROTATION_TOLERANCE)

wh_real_t wh_horizon_margin(const wh_grasp_t *table, size_t g, const wh_vec3_t *place) {
    const wh_near_limits_t limits = wh_index_limits(table);
    const wh_vec3_t way = wh_vec3_subtract(place, &table->storage.grippers[g].base_from_gripper.r);
    const wh_real_t moved = wh_real_abs(way.x) + wh_real_abs(way.y) + wh_real_abs(way.z);
    const wh_real_t half = (limits.projz + limits.projxy) / 2;
    const wh_real_t most = half > 8 ? half : 8;
    const wh_real_t least = most / 32;
    if (moved > most / 2 || moved < least / 32) {
        return least;
    }
    return 32 * moved < most ? 32 * moved : most;
}

wh_horizon_t wh_horizon_begin(const wh_grasp_t *table, size_t g, const wh_found_t *near, wh_real_t margin) {
    const wh_horizon_t horizon = {wh_horizon_limits(table, g), near->listed ? margin : (wh_real_t)LONGEST};
    return horizon;
}

/* The distance in units, rounded down, so that four times it fits into a word; 0 if nothing remains. */
static uint32_t reach_of(wh_real_t units) {
    const int32_t reach = wh_index_whole(units);
    if (reach < 0) {
        return 0;
    }
    return reach < LONGEST ? (uint32_t)reach : LONGEST;
}

/* True if it is too far from base for the grid: such a gripper gets no horizon. */
static bool is_far(int32_t units) {
    return units == WH_INDEX_FAR || units == -WH_INDEX_FAR;
}

void wh_horizon_store(wh_grasp_t *table, size_t g, const wh_vec3_t *place, const wh_horizon_t *horizon) {
    uint32_t *words = wh_horizon_words(table, g);
    const int32_t x = wh_index_whole(WH_INDEX_UNITS * place->x);
    const int32_t y = wh_index_whole(WH_INDEX_UNITS * place->y);
    const int32_t z = wh_index_whole(WH_INDEX_UNITS * place->z);
    words[3] = 0;
    if (is_far(x) || is_far(y) || is_far(z)) {
        return;
    }
    const wh_near_limits_t limits = wh_index_limits(table);
    const wh_real_t size =
        wh_real_abs(place->x) + wh_real_abs(place->y) + wh_real_abs(place->z) + limits.projz + limits.projxy;
    const wh_real_t sure = (horizon->gap - ROUNDING * size) / LONGEST_COLUMN;
    words[0] = (uint32_t)x;
    words[1] = (uint32_t)y;
    words[2] = (uint32_t)z;
    words[3] = 4 * reach_of(WH_INDEX_UNITS * sure - TAKEN_OFF);
    if (table->storage.grippers[g].approach.wafer != WH_NONE) {
        words[3] |= WH_HORIZON_OF_TOLERANCE;
    }
}

void wh_horizon_reset(wh_grasp_t *table) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        memset(wh_horizon_words(table, g), 0, WH_HORIZON_WORDS * sizeof(uint32_t));
    }
}
