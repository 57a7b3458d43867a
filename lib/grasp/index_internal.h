/* Internal to the room: a grid over the wafers in the caller's buckets, so that a step checks only those
 * around a gripper.
 *
 * All of it is in wh_grasp_storage_t.buckets, in this order:
 *   3 words   how far along base's x, y and z any wafer's neighbourhood reaches from its origin, in units of
 *             1/64 mm;
 *   3 words   the edges of a cell along them, as powers of two of the unit;
 *   2 words   the gripper that searched last, and how many wafers it found, more than there are for all;
 *   4 words   for each gripper: its horizon (horizon_internal.h);
 *   2 words   for each wafer: the heads of the cells' lists, found by hashing the cell's place;
 *   2 words   for each wafer: the next in its list, and its cell's key;
 *   1 word    for each wafer: the result of the last search.
 * A wafer keeps its cell while a gripper holds it. For any content of the words, no search leaves the
 * arrays or runs for ever.
 */
#ifndef WH_GRASP_INDEX_INTERNAL_H
#define WH_GRASP_INDEX_INTERNAL_H

#include "grasp.h"

#define WH_INDEX_EXTENTS ((size_t)0)
#define WH_INDEX_SHIFTS ((size_t)3)
#define WH_INDEX_FOUND ((size_t)6)
#define WH_INDEX_HORIZONS ((size_t)8)
#define WH_HORIZON_WORDS ((size_t)4)

/* Units of the index per mm. */
#define WH_INDEX_UNITS WH_REAL(64)

/* Beyond this, 33 km, all places count as one. */
#define WH_INDEX_FAR 2147483520

/* Rounds towards zero, to at most WH_INDEX_FAR from it. A NaN becomes -WH_INDEX_FAR. */
static inline int32_t wh_index_whole(wh_real_t units) {
    if (units == units && units > -(wh_real_t)WH_INDEX_FAR && units < (wh_real_t)WH_INDEX_FAR) {
        return (int32_t)units;
    }
    return units > 0 ? WH_INDEX_FAR : -WH_INDEX_FAR;
}

/* Limits of |dr_proj_z| and |dr_proj_xy| within which a wafer may be taken or watched. */
typedef struct {
    wh_real_t projz, projxy;
} wh_near_limits_t;

/* The result of a search: wafers' indices in no order, or all wafers if `listed` is null. */
typedef struct {
    const uint32_t *listed;
    size_t count;
} wh_found_t;

/* All wafers. */
static inline wh_found_t wh_index_all(const wh_grasp_t *table) {
    const wh_found_t near = {NULL, table->storage.wafer_count};
    return near;
}

/* True if the table has buckets. If the library is built without an index this is constant, and nothing
 * below is linked. */
static inline bool wh_index_is_used(const wh_grasp_t *table) {
    return WH_INDEX_BUILT && table->storage.bucket_count > 0;
}

/* The work of wh_index_build and wh_index_move if the table has buckets. */
void wh_index_fill(wh_grasp_t *table) WH_SYMBOL(wh_index_fill);
void wh_index_reinsert(wh_grasp_t *table, size_t wafer) WH_SYMBOL(wh_index_reinsert);

/* Builds the index again for all wafers, if the table has buckets. Afterwards no gripper has a horizon. */
static inline void wh_index_build(wh_grasp_t *table) {
    if (wh_index_is_used(table)) {
        wh_index_fill(table);
    }
}

/* Tells the index that this wafer now lies at another place. Afterwards no gripper has a horizon. */
static inline void wh_index_move(wh_grasp_t *table, size_t wafer) {
    if (wh_index_is_used(table)) {
        wh_index_reinsert(table, wafer);
    }
}

/* The work of wh_index_near if the table has buckets. */
wh_found_t wh_index_search(wh_grasp_t *table, size_t g, const wh_vec3_t *from, const wh_vec3_t *to,
                           wh_real_t margin) WH_SYMBOL(wh_index_search);

/* The result of the last search, by any gripper. */
wh_found_t wh_index_found(const wh_grasp_t *table) WH_SYMBOL(wh_index_found);

/* The wafers whose neighbourhood gripper g enters between `from` and `to`, or may enter by moving less than
 * `margin` from there along one of base's axes; there may be others among them. It gives all wafers if the
 * table has no buckets or as many cells would have to be checked. A step without buckets never has the
 * search's memory on its stack. */
static inline wh_found_t wh_index_near(wh_grasp_t *table, size_t g, const wh_vec3_t *from,
                                       const wh_vec3_t *to, wh_real_t margin) {
    return wh_index_is_used(table) ? wh_index_search(table, g, from, to, margin) : wh_index_all(table);
}

/* wh_index_near without a margin, for a gripper that has already searched there in this step. Returns the
 * result of that search, unless another gripper has searched since. */
static inline wh_found_t wh_index_again(wh_grasp_t *table, size_t g, const wh_vec3_t *from,
                                        const wh_vec3_t *to) {
    if (wh_index_is_used(table) && table->storage.buckets[WH_INDEX_FOUND] == g) {
        return wh_index_found(table);
    }
    return wh_index_near(table, g, from, to, 0);
}

/* The i-th wafer of the result. */
static inline size_t wh_index_wafer(const wh_grasp_t *table, const wh_found_t *near, size_t i) {
    const size_t wafer = near->listed ? near->listed[i] : i;
    return wafer < table->storage.wafer_count ? wafer : 0;
}

/* The neighbourhood, which contains every ready wafer. */
static inline wh_near_limits_t wh_index_limits(const wh_grasp_t *table) {
    const wh_grasp_config_t *config = &table->config;
    const wh_near_limits_t limits = {
        config->near_projz > config->tolerance.projz ? config->near_projz : config->tolerance.projz,
        config->near_projxy > config->tolerance.projxy ? config->near_projxy : config->tolerance.projxy};
    return limits;
}

#endif
