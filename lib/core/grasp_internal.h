/* Within the core: what the parts of a step share. A step runs through grasp_step.c, grasp_take.c and encounter.c; what
 * may fall between two slices is found by swept_pick.c and swept_encounter.c, by way of sweep.c.
 *
 * What only swept checking needs stands in files of its own, so that its memory is never on the stack of a sampled
 * step.
 */
#ifndef WH_CORE_GRASP_INTERNAL_H
#define WH_CORE_GRASP_INTERNAL_H

#include "core/grasp.h"

/* A blank event of the running step, appended to the list for the caller to fill in. There is room: the step
 * has looked. */
wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind);

/* Puts the wafer where a gripper carries it. */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer);

/* |dr_proj_z| */
wh_real_t wh_grasp_distance(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper);

/* Of the wafers that are ready and held (or free) the one that this gripper would take: smallest |dr_proj_z|, then
 * lowest index; WH_NONE: none. */
int32_t wh_grasp_find_ready(const wh_grasp_t *table, const wh_pose_t *base_from_gripper, bool held);

/* Gives gripper g, at `then`, this wafer and reports it. Where the gripper moves on within the slice, or the wafer was
 * drawn onto its pads, the wafer still has to be carried there. */
void wh_grasp_take(wh_grasp_t *table, size_t g, int32_t wafer, const wh_pose_t *then, wh_event_list_t *list);

/* A pick between the last slice and this one; false when there was none. */
bool wh_grasp_pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list);

#endif
