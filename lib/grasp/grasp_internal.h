/* Internal to the room: shared by the parts of a step. A step runs through grasp_step.c, grasp_take.c and
 * encounter.c; swept.c finds events between two slices, using sweep.c.
 *
 * Code that only swept checking needs is in a separate file, so that its memory is never on the stack of a
 * sampled step. If the library is built without it wh_grasp_is_swept is constant, and the file is not
 * linked.
 */
#ifndef WH_GRASP_GRASP_INTERNAL_H
#define WH_GRASP_GRASP_INTERNAL_H

#include "grasp.h"

/* Appends a blank event of the running step, for the caller to fill in. The step has made sure that there is
 * room. */
wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind)
    WH_SYMBOL(wh_event_append);

/* Puts the wafer at the place where a gripper carries it. */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer) WH_SYMBOL(wh_grasp_carry);

/* wh_proximity_measure without its checks, for arguments that have passed them. */
void wh_proximity_values(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                         const wh_tolerance_t *tolerance, wh_proximity_t *result)
    WH_SYMBOL(wh_proximity_values);

/* False if a table of this configuration and this number of buckets needs a part that the library was built
 * without. */
static inline bool wh_grasp_is_built(const wh_grasp_config_t *config, size_t bucket_count) {
    return (WH_SWEEP_BUILT || config->check != WH_CHECK_SWEPT) && (WH_INDEX_BUILT || bucket_count == 0);
}

/* wh_proximity_ready as one function of the room, because each inlined copy takes 250 bytes. */
bool wh_proximity_is_ready(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                           const wh_tolerance_t *tolerance) WH_SYMBOL(wh_proximity_is_ready);

/* The inlined version for the loops over all wafers, unless the compiler saves bytes. */
static inline bool wh_proximity_is_ready_fast(const wh_pose_t *base_from_wafer,
                                              const wh_pose_t *base_from_gripper,
                                              const wh_tolerance_t *tolerance) {
#if defined(__OPTIMIZE_SIZE__)
    return wh_proximity_is_ready(base_from_wafer, base_from_gripper, tolerance);
#else
    return wh_proximity_ready(base_from_wafer, base_from_gripper, tolerance);
#endif
}

/* |dr_proj_z| */
wh_real_t wh_grasp_distance(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper)
    WH_SYMBOL(wh_grasp_distance);

/* The wafer that gripper g would take at this pose: of the ready and free wafers the one with the smallest
 * |dr_proj_z|, then the lowest index; WH_NONE: none. Within the gripper's horizon there is none; beyond it
 * the horizon is measured again. It notes if no free wafer is near. */
int32_t wh_grasp_find_ready(wh_grasp_t *table, size_t g, const wh_pose_t *base_from_gripper)
    WH_SYMBOL(wh_grasp_find_ready);

/* Gives gripper g, which is at `then`, this wafer and reports it. If the gripper moves on within the slice,
 * or seats the wafer on its pads, the caller still has to carry the wafer. */
void wh_grasp_take(wh_grasp_t *table, size_t g, int32_t wafer, const wh_pose_t *then, wh_event_list_t *list)
    WH_SYMBOL(wh_grasp_take);

/* True if wafers that gripper g passes between the last slice and this one count. Its entry still has the
 * last slice's values. */
static inline bool wh_grasp_is_swept(const wh_grasp_t *table, size_t g) {
    return WH_SWEEP_BUILT && table->config.check == WH_CHECK_SWEPT &&
           table->storage.grippers[g].valve == WH_VALVE_OPEN;
}

/* Picks between the last slice and this one; false if there was no pick. */
bool wh_grasp_pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list)
    WH_SYMBOL(wh_grasp_pick_swept);

#endif
