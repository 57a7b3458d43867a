/* A grasp table with an index over many wafers, for tests of the index. */
#ifndef WH_TESTS_SUPPORT_INDEX_H
#define WH_TESTS_SUPPORT_INDEX_H

#include "grasp/horizon_internal.h"
#include "support/grasp.h"

enum { MANY = 64 };

typedef struct {
    cell_t cell;
    wh_wafer_t wafer[MANY];
    uint32_t buckets[WH_GRASP_BUCKETS(MANY, CELL_GRIPPERS)];
} indexed_t;

/* Wafers on a level grid, 1 m apart; grippers as cell_begin leaves them. */
static inline void indexed_begin(indexed_t *indexed, const wh_grasp_config_t *config) {
    cell_begin(&indexed->cell, config);
    memset(indexed->wafer, 0, sizeof indexed->wafer);
    for (int w = 0; w < MANY; ++w) {
        indexed->wafer[w].base_from_wafer = wh_test_at(1000.0 * (w % 8), 1000.0 * (w / 8), 0);
    }
    const wh_grasp_storage_t storage = {indexed->wafer,        MANY,
                                        indexed->cell.gripper, CELL_GRIPPERS,
                                        indexed->buckets,      wh_grasp_buckets(MANY, CELL_GRIPPERS)};
    assert_int_equal(wh_grasp_init(&indexed->cell.table, config, &storage), WH_OK);
}

static inline void indexed_begin_default(indexed_t *indexed) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    indexed_begin(indexed, &config);
}

/* The wafers that gripper 0 finds around a place. */
static inline wh_found_t indexed_look(indexed_t *indexed, double x, double y, double z, double margin) {
    const wh_pose_t pose = wh_test_at(x, y, z);
    return wh_index_near(&indexed->cell.table, 0, &pose.r, &pose.r, WH_REAL(margin));
}

#endif
