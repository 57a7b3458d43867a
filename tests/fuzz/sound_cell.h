/* Properties of a cell that hold after any script and any line. */
#ifndef WH_TESTS_FUZZ_SOUND_CELL_H
#define WH_TESTS_FUZZ_SOUND_CELL_H

#include "fuzz.h"
#include "grasp/restore.h"
#include "mcs/mcs.h"

/* Another table may take over its state, its axes are within their travel, and none of its slices
 * is missing. */
static inline void fuzz_check_cell(const wh_mcs_t *mcs) {
    wh_wafer_t wafers[16];
    wh_gripper_t grippers[WH_GRIPPERS];
    const wh_grasp_t *const table = &mcs->local.simulator.table;
    wh_grasp_t copy = *table;
    REQUIRE(table->storage.wafer_count <= sizeof wafers / sizeof wafers[0]);
    copy.storage.wafers = wafers;
    copy.storage.grippers = grippers;
    REQUIRE(wh_grasp_restore(&copy, table->slice, table->storage.wafers, table->storage.grippers) == WH_OK);
    REQUIRE(wh_grasp_hash(&copy) == wh_grasp_hash(table));
    REQUIRE(wh_physics_state_validate(&mcs->local.simulator.physics, table->storage.gripper_count,
                                      table->storage.wafer_count) == WH_OK);
    REQUIRE(wh_machine_check_travel(&mcs->layout->machine, mcs->track.axes) == WH_OK);
    REQUIRE(mcs->track.slice == (int64_t)table->slice);
}

#endif
