/* Within the core: what the parts of a step share. A step runs through grasp_step.c, grasp_take.c and encounter.c; what
 * may fall between two slices is found by swept_pick.c and swept_encounter.c, by way of sweep.c.
 *
 * What only swept checking needs stands in files of its own, so that its memory is never on the stack of a sampled
 * step.
 */
#ifndef WH_GRASP_GRASP_INTERNAL_H
#define WH_GRASP_GRASP_INTERNAL_H

#include "grasp.h"

/* A blank event of the running step, appended to the list for the caller to fill in. There is room: the step
 * has looked. */
/*@ requires \valid_read(table) && list != \null && wh_list_ready(list, 1);
    assigns list->count, list->events[list->count] \from *table, kind;
    assigns \result \from list;
    ensures \result == list->events + \old(list->count) && list->count == \old(list->count) + 1; */
wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind);

/* Puts the wafer where a gripper carries it. */
/*@ requires \valid(wafer) && \valid_read(base_from_gripper) && \valid_read(gripper_from_wafer);
    requires \separated(wafer, base_from_gripper) && \separated(wafer, gripper_from_wafer);
    assigns wafer->base_from_wafer; */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer);

/* |dr_proj_z| */
/*@ requires \valid_read(wafer) && \valid_read(base_from_gripper); assigns \nothing; */
wh_real_t wh_grasp_distance(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper);

/* What an open gripper passes between the last slice and this one counts; its entry is still the last slice's. */
/*@ requires wh_table_memory(table) && wh_is_gripper(table, g); assigns \nothing; */
static inline bool wh_grasp_is_swept(const wh_grasp_t *table, size_t g) {
    return table->config.check == WH_CHECK_SWEPT && table->storage.grippers[g].valve == WH_VALVE_OPEN;
}

/* Of the ready wafers that nobody holds the one that gripper g would take at this pose: smallest |dr_proj_z|, then lowest
 * index; WH_NONE: none. Measures the gripper's horizon anew. */
/*@ requires wh_table_memory(table) && wh_is_gripper(table, g) && \valid_read(base_from_gripper);
    assigns table->storage.buckets[0 .. table->storage.bucket_count - 1];
    ensures \result == WH_NONE || wh_is_wafer(table, \result) && wh_holder(table, \result) == WH_NONE; */
int32_t wh_grasp_find_ready(wh_grasp_t *table, size_t g, const wh_pose_t *base_from_gripper);

/* Gives gripper g, at `then`, this wafer and reports it. Where the gripper moves on within the slice, or the wafer was
 * drawn onto its pads, the wafer still has to be carried there. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_is_wafer(table, wafer);
    requires wh_holder(table, wafer) == WH_NONE && wh_held(table, g) == WH_NONE;
    requires \valid_read(then) && \separated(then, table->storage.grippers + (0 .. table->storage.gripper_count - 1));
    assigns table->counters, table->storage.wafers[wafer].holder, table->storage.grippers[g].wafer,
            table->storage.grippers[g].gripper_from_wafer, list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, 1);
    ensures wh_same_size{Pre, Post}(table);
    ensures wh_took{Pre, Post}(table, g, wafer);
    ensures wh_other_holders{Pre, Post}(table, wafer);
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_other_poses{Pre, Post}(table, wafer);
    ensures wh_other_grips{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table); */
void wh_grasp_take(wh_grasp_t *table, size_t g, int32_t wafer, const wh_pose_t *then, wh_event_list_t *list);

/* A pick between the last slice and this one; false when there was none. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 1) && wh_list_apart(list, table);
    requires wh_is_gripper(table, g) && wh_held(table, g) == WH_NONE;
    requires \valid_read(input) && wh_apart_from_arrays(input, table);
    assigns table->counters, table->storage.wafers[0 .. table->storage.wafer_count - 1],
            table->storage.grippers[g].wafer, table->storage.grippers[g].gripper_from_wafer,
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures wh_list_grown{Pre, Post}(list, \result ? 1 : 0);
    ensures wh_same_size{Pre, Post}(table);
    ensures !\result ==> wh_same_holders{Pre, Post}(table) && wh_same_held{Pre, Post}(table);
    ensures !\result ==> wh_same_poses{Pre, Post}(table) && wh_same_grips{Pre, Post}(table);
    ensures \result ? wh_took{Pre, Post}(table, g, wh_held(table, g)) : wh_held(table, g) == WH_NONE;
    ensures wh_other_holders{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_held{Pre, Post}(table, g);
    ensures wh_other_poses{Pre, Post}(table, wh_held(table, g));
    ensures wh_other_grips{Pre, Post}(table, g);
    ensures wh_same_releases{Pre, Post}(table);
    ensures wh_same_watched{Pre, Post}(table); */
bool wh_grasp_pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list);

#endif
