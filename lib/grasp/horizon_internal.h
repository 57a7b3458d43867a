/* Internal to the room: the distance that a gripper may move before any free wafer can matter to it.
 *
 * For a wafer at rest |dr_proj_z| and |dr_proj_xy| change by no more than the gripper's origin moves. So a
 * gripper that stays within its horizon needs no check of any wafer. The horizon is the least over all free
 * wafers of max(|dr_proj_z| - near_projz, |dr_proj_xy| - near_projxy). While it follows a wafer's approach
 * it looks only for ready wafers, and the tolerance replaces the neighbourhood. Rounding is subtracted, and
 * the effect of rotations that are orthonormal only to WH_ROTATION_TOLERANCE.
 *
 * There are four words for each gripper: a place in base in units of 1/64 mm, as three signed numbers, and
 * four times the distance from there in that unit, plus WH_HORIZON_* bits. A distance of 0 means that none
 * is known.
 */
#ifndef WH_GRASP_HORIZON_INTERNAL_H
#define WH_GRASP_HORIZON_INTERNAL_H

#include "index_internal.h"

/* A horizon that is being measured while wafers are checked. */
typedef struct {
    wh_near_limits_t limits;
    wh_real_t gap; /* the least so far, mm */
} wh_horizon_t;

/* The horizon was measured against the tolerance, not the neighbourhood. */
enum { WH_HORIZON_OF_TOLERANCE = 1 };

static inline uint32_t *wh_horizon_words(const wh_grasp_t *table, size_t g) {
    return &table->storage.buckets[WH_INDEX_HORIZONS + WH_HORIZON_WORDS * g];
}

/* The distance from a place that a word keeps, along one axis, in units. The word is two's complement; a
 * cast of large numbers would depend on the compiler. */
static inline wh_real_t wh_horizon_way(uint32_t word, wh_real_t place) {
    const int32_t from = word > INT32_MAX ? -1 - (int32_t)(UINT32_MAX - word) : (int32_t)word;
    return WH_INDEX_UNITS * place - (wh_real_t)from;
}

/* True if no free wafer matters to gripper g at `place`. */
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

/* In a step it means that the pick found no free wafer near. It is stored in place of the approach's holder
 * until the step's end; a gripper that watches no wafer does not use that member. */
#define WH_HORIZON_CLEAR (WH_NONE - 1)

/* True if this step's pick has already found that no free wafer is near a gripper that watches none. */
static inline bool wh_horizon_is_clear(const wh_grasp_t *table, size_t g) {
    return table->storage.grippers[g].approach.holder == WH_HORIZON_CLEAR;
}

/* Notes the result of the pick. */
static inline void wh_horizon_note(wh_grasp_t *table, size_t g, bool clear) {
    wh_encounter_t *approach = &table->storage.grippers[g].approach;
    approach->holder = clear && approach->wafer == WH_NONE ? WH_HORIZON_CLEAR : WH_NONE;
}

/* The limits that matter to gripper g: the neighbourhood, or the tolerance while it follows a wafer's
 * approach. */
static inline wh_near_limits_t wh_horizon_limits(const wh_grasp_t *table, size_t g) {
    const wh_tolerance_t *tolerance = &table->config.tolerance;
    const wh_near_limits_t limits = {tolerance->projz, tolerance->projxy};
    return table->storage.grippers[g].approach.wafer == WH_NONE ? wh_index_limits(table) : limits;
}

/* Takes a free wafer into account. Returns true if the wafer is certainly not ready by
 * wh_proximity_ready. */
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
    /* A NaN makes the gap 0. */
    horizon->gap = gap >= horizon->gap ? horizon->gap : gap > 0 ? gap : 0;
    return gap > 0;
}

/* The distance around `place` that a search should cover: many times the way of this slice, or little if
 * the gripper jumps. */
wh_real_t wh_horizon_margin(const wh_grasp_t *table, size_t g, const wh_vec3_t *place)
    WH_SYMBOL(wh_horizon_margin);

/* Begins to measure a horizon over the wafers that wh_index_near found with this margin. */
wh_horizon_t wh_horizon_begin(const wh_grasp_t *table, size_t g, const wh_found_t *near, wh_real_t margin)
    WH_SYMBOL(wh_horizon_begin);

/* Stores the measured horizon for gripper g at `place`. These four functions are for tables with
 * buckets. */
void wh_horizon_store(wh_grasp_t *table, size_t g, const wh_vec3_t *place, const wh_horizon_t *horizon)
    WH_SYMBOL(wh_horizon_store);

/* Removes every gripper's horizon, until it searches again. */
void wh_horizon_reset(wh_grasp_t *table) WH_SYMBOL(wh_horizon_reset);

#endif
