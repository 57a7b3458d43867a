/* A grasp table taken up where another one left it: after a restart, or in the middle of a recording. */
#ifndef WH_GRASP_RESTORE_H
#define WH_GRASP_RESTORE_H

#include "grasp.h"

WH_HEADER_BEGIN

/* Sets an initialised table to the state that another table of the same counts was in after `slice` steps:
 * `wafers` and `grippers` are copies of that table's arrays, made between two steps. The same steps then
 * yield the same bits as they would have there; counters keep counting. `released_by` of the wafers is not
 * looked at. Refused, the table unchanged but for counters.refused: null pointers, but an array may be
 * null when its count is 0; poses that do not pass wh_pose_validate; valves other than 0 and 1
 * (WH_STATUS_BAD_VALVE); measured values that are not finite; indices out of range, a holder that does not
 * hold what it is said to hold or holds it with a closed valve or further off than twice projz + projxy
 * (and WH_FACE_THICKEST if it shows its front), a held wafer that is not where its gripper carries it (by
 * more than what 16 WH_ROTATION_TOLERANCE make of its rotation and of its coordinates), an approached
 * wafer with a holder or a contested one without, slices beyond `slice`, a `slice` above INT64_MAX
 * (WH_STATUS_OUT_OF_RANGE); a table that wh_grasp_init of this build would refuse (WH_STATUS_NOT_BUILT).
 * Cost: linear in wafers and grippers; a held wafer adds 36 products. */
wh_status_t wh_grasp_restore(wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) WH_SYMBOL(wh_grasp_restore);

WH_HEADER_END

#endif
