/* Within the room: how far a gripper may move before any wafer that nobody holds can matter to it.
 *
 * For a wafer at rest |dr_proj_z| and |dr_proj_xy| change by no more than the gripper's origin moves. So a
 * gripper that stays within its horizon, the least over all free wafers of max(|dr_proj_z| - near_projz,
 * |dr_proj_xy| - near_projxy), need not look at any. While it follows a wafer's approach it looks for ready
 * wafers only, and the tolerance takes the neighbourhood's place. Rounding, and rotations that are
 * orthonormal to WH_ROTATION_TOLERANCE only, are taken off.
 *
 * Four words for each gripper: a place in base in units of 1/64 mm, as three signed numbers, and four times
 * the distance from there in the same unit, plus WH_HORIZON_* bits. A distance of 0: none is known.
 */
#ifndef WH_GRASP_HORIZON_INTERNAL_H
#define WH_GRASP_HORIZON_INTERNAL_H

#include "index_internal.h"

/* A horizon that is being measured while wafers are looked at. */
typedef struct {
    wh_near_limits_t limits;
    wh_real_t gap; /* the least so far, mm */
} wh_horizon_t;

/* Measured against the tolerance, not the neighbourhood. */
enum { WH_HORIZON_OF_TOLERANCE = 1 };

static inline uint32_t *wh_horizon_words(const wh_grasp_t *table, size_t g) {
    return &table->storage.buckets[WH_INDEX_HORIZONS + WH_HORIZON_WORDS * g];
}

/* The way from a place that a word keeps, along one axis, in units. The word is two's complement; what a cast
 * makes of large numbers depends on the compiler. */
static inline wh_real_t wh_horizon_way(uint32_t word, wh_real_t place) {
    const int32_t from = word > INT32_MAX ? -1 - (int32_t)(UINT32_MAX - word) : (int32_t)word;
    return WH_INDEX_UNITS * place - (wh_real_t)from;
}

/* True if no wafer that nobody holds matters to gripper g at `place`. */
static inline bool wh_horizon_is_clear_at(const wh_grasp_t *table, size_t g, const wh_vec3_t *place) {
    if (!wh_index_is_used(table)) {
        return false;
    }
    const uint32_t *words = wh_horizon_words(table, g);
    if ((words[3] & WH_HORIZON_OF_TOLERANCE) != 0 && table->storage.grippers[g].approach.wafer == WH_NONE) {
        return false;
    }
    const wh_real_t x = wh_horizon_way(words[0], place->x);
    const wh_real_t y = wh_horizon_way(words[1], place->y);
    const wh_real_t z = wh_horizon_way(words[2], place->z);
    const wh_real_t reach = (wh_real_t)(int32_t)(words[3] / 4);
    return x * x + y * y + z * z < reach * reach;
}

/* In a step: the pick found no free wafer near. It stands in the place of the approach's holder, which a
 * gripper that watches no wafer has no use for, until the step's end. */
#define WH_HORIZON_CLEAR (WH_NONE - 1)

/* True if this step's pick already found no free wafer near a gripper that watches none. */
static inline bool wh_horizon_is_clear(const wh_grasp_t *table, size_t g) {
    return table->storage.grippers[g].approach.holder == WH_HORIZON_CLEAR;
}

/* Notes what the pick found. */
static inline void wh_horizon_note(wh_grasp_t *table, size_t g, bool clear) {
    wh_encounter_t *approach = &table->storage.grippers[g].approach;
    approach->holder = clear && approach->wafer == WH_NONE ? WH_HORIZON_CLEAR : WH_NONE;
}

/* What matters to gripper g: the neighbourhood, or the tolerance while it follows a wafer's approach. */
static inline wh_near_limits_t wh_horizon_limits(const wh_grasp_t *table, size_t g) {
    const wh_tolerance_t *tolerance = &table->config.tolerance;
    const wh_near_limits_t limits = {tolerance->projz, tolerance->projxy};
    return table->storage.grippers[g].approach.wafer == WH_NONE ? wh_index_limits(table) : limits;
}

/* Takes a free wafer into account. True if the wafer is certainly not ready, as wh_proximity_ready would
 * say. */
static inline bool wh_horizon_measure(wh_horizon_t *horizon, const wh_pose_t *base_from_wafer,
                                      const wh_vec3_t *place) {
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, place);
    const wh_vec3_t p = wh_mat3_transform_back(&base_from_wafer->R, &dr);
    const wh_real_t z = wh_real_abs(p.z) - horizon->limits.projz;
    if (z >= horizon->gap) {
        return true;
    }
    const wh_real_t xy = wh_real_sqrt(p.x * p.x + p.y * p.y) - horizon->limits.projxy;
    const wh_real_t gap = z > xy ? z : xy;
    /* A NaN ends up in the gap as none. */
    horizon->gap = gap >= horizon->gap ? horizon->gap : gap > 0 ? gap : 0;
    return gap > 0;
}

/* How far around `place` a search should look: many times the way of this slice, or little if the gripper
 * jumps. */
wh_real_t wh_horizon_margin(const wh_grasp_t *table, size_t g, const wh_vec3_t *place)
    WH_SYMBOL(wh_horizon_margin);

/* Begins to measure a horizon over the wafers that wh_index_near found with this margin. */
wh_horizon_t wh_horizon_begin(const wh_grasp_t *table, size_t g, const wh_found_t *near, wh_real_t margin)
    WH_SYMBOL(wh_horizon_begin);

/* Stores the measured horizon for gripper g at `place`. These four are for tables with buckets. */
void wh_horizon_store(wh_grasp_t *table, size_t g, const wh_vec3_t *place, const wh_horizon_t *horizon)
    WH_SYMBOL(wh_horizon_store);

/* Takes every gripper's horizon away, until it searches again. */
void wh_horizon_reset(wh_grasp_t *table) WH_SYMBOL(wh_horizon_reset);

#endif
