/* Sets a grasp table to the state of another one: after a restart, or in the middle of a recording. */
#ifndef WH_GRASP_RESTORE_H
#define WH_GRASP_RESTORE_H

#include "grasp.h"

WH_HEADER_BEGIN

/* Sets an initialised table to the state of another table of the same counts after `slice` steps: `wafers`
 * and `grippers` are copies of that table's arrays, made between two steps. Equal steps then yield the bits
 * that they would have yielded there; counters continue. `released_by` of the wafers is ignored. It refuses
 * some arguments; the table is then unchanged except counters.refused. Refused are null pointers, except
 * for an array whose count is 0; poses that do not pass wh_pose_validate; valves other than 0 and 1
 * (WH_STATUS_BAD_VALVE); and measured values that are not finite. WH_STATUS_OUT_OF_RANGE is for these:
 * indices out of range; a holder that does not hold the wafer, holds it with a closed valve (but in a
 * table with grips, where wh_grips_complete looks at it: grips.h), or holds it further away than twice
 * projz + projxy (and WH_FACE_THICKEST if it shows its front); a held wafer that is not where its gripper
 * carries it (by more than the effect of 16 WH_ROTATION_TOLERANCE on its rotation and its coordinates); an
 * approached wafer with a holder or a contested one without; slices beyond `slice`; a `slice` above
 * INT64_MAX. WH_STATUS_NOT_BUILT is for a table that wh_grasp_init of this build would
 * refuse. Cost: linear in wafers and grippers; a held wafer adds 36 products. */
wh_status_t wh_grasp_restore(wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                             const wh_gripper_t grippers[]) WH_SYMBOL(wh_grasp_restore);

WH_HEADER_END

#endif
