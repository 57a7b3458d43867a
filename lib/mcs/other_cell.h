/* Motion control in another cell than that of its run: the room survey tries commands there before any run,
 * each in a cell of its own. */
#ifndef WH_MCS_OTHER_CELL_H
#define WH_MCS_OTHER_CELL_H

#include "mcs.h"

/* From now on it plays in this layout, against this simulator, with its track at the beginning. Both must
 * outlive that. Not WH_OK: the machine is not possible, and nothing has changed. */
wh_status_t wh_other_cell_enter(wh_mcs_t *mcs, const wh_layout_t *layout, wh_simulator_t *simulator);

/* From the next slice on the axes stand at `axes` (null: as they do), and the doors are open. The record
 * forgets its events. */
void wh_other_cell_place(wh_mcs_t *mcs, const wh_real_t axes[WH_AXES]);

/* The slices of the command that was planned last, and those that were played since it entered. */
int64_t wh_other_cell_planned(const wh_mcs_t *mcs);
int64_t wh_other_cell_slices(const wh_mcs_t *mcs);

/* A gripper, as the last slice left it. */
const wh_gripper_t *wh_other_cell_gripper(const wh_mcs_t *mcs, size_t gripper);

/* It is back in the cell of its run, with that layout, and stands at home. It has no link until it is
 * connected. */
void wh_other_cell_leave(wh_mcs_t *mcs, const wh_layout_t *layout);

#endif
