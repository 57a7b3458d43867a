/* Within the core: near misses and contests, looked at after the picks of a step. */
#ifndef WH_GRASP_ENCOUNTER_INTERNAL_H
#define WH_GRASP_ENCOUNTER_INTERNAL_H

#include "grasp.h"
#include "sweep_internal.h"

/* What one gripper's encounters are judged by in this step. */
typedef struct {
    wh_grasp_t *table;
    wh_gripper_t *gripper;
    const wh_pose_t *base_from_gripper; /* at the slice's end */
    const wh_sweep_t *sweep;            /* since the last slice; null where checking is sampled */
    wh_event_list_t *list;
    int32_t index;
} wh_watch_t;

/* How near the gripper is to a wafer, and when: 1 is the slice's end. */
typedef struct {
    wh_real_t t;
    wh_real_t z;  /* |dr_proj_z| */
    wh_real_t xy; /* |dr_proj_xy| */
} wh_closeness_t;

/*@
  predicate wh_watch_memory{L}(wh_watch_t *w) =
    \valid(w) && wh_table_memory(w->table) && wh_is_gripper(w->table, w->index) &&
    w->gripper == w->table->storage.grippers + w->index && \valid_read(w->base_from_gripper) &&
    (w->sweep == \null || wh_sweep_memory(w->sweep)) && wh_list_apart(w->list, w->table) &&
    \separated(w, w->list, w->table, w->table->storage.wafers + (0 .. w->table->storage.wafer_count - 1),
               w->table->storage.grippers + (0 .. w->table->storage.gripper_count - 1)) &&
    (w->list != \null ==> \separated(w, w->list->events + (0 .. w->list->capacity - 1)));

  predicate wh_watched{L}(wh_watch_t *w, integer i) = i == WH_NONE || wh_is_wafer(w->table, i);
  predicate wh_both_watched{L}(wh_watch_t *w) =
    wh_watched(w, w->gripper->approach.wafer) && wh_watched(w, w->gripper->contest.wafer);

  predicate wh_same_approach{K, L}(wh_watch_t *w) =
    \at(w->gripper->approach.wafer, K) == \at(w->gripper->approach.wafer, L);
  predicate wh_same_contest{K, L}(wh_watch_t *w) =
    \at(w->gripper->contest.wafer, K) == \at(w->gripper->contest.wafer, L);
*/
/* Updates one gripper's approach and contest and reports those that ended. `input` is this slice's, the
 * gripper still has the previous slice's pose and valve. */
/*@ requires wh_table_memory(table) && wh_list_ready(list, 2) && wh_list_apart(list, table);
    requires wh_is_gripper(table, gripper) && \valid_read(input);
    requires WH_NONE <= table->storage.grippers[gripper].approach.wafer < table->storage.wafer_count;
    requires WH_NONE <= table->storage.grippers[gripper].contest.wafer < table->storage.wafer_count;
    assigns table->storage.grippers[gripper].approach, table->storage.grippers[gripper].contest, table->counters,
            table->storage.buckets[0 .. table->storage.bucket_count - 1],
            list->count, list->events[0 .. wh_room(list) - 1];
    ensures WH_NONE <= table->storage.grippers[gripper].approach.wafer < table->storage.wafer_count;
    ensures WH_NONE <= table->storage.grippers[gripper].contest.wafer < table->storage.wafer_count;
    ensures wh_list_grown{Pre, Post}(list, 2) && wh_same_size{Pre, Post}(table);
    ensures wh_same_held{Pre, Post}(table);
    ensures wh_same_grips{Pre, Post}(table);
    ensures wh_other_watched{Pre, Post}(table, gripper); */
void wh_encounter_update(wh_grasp_t *table, size_t gripper, const wh_gripper_input_t *input,
                         wh_event_list_t *list);

/* Its part for a gripper that was and is open and empty, with or without watch->sweep. */
/*@ requires wh_watch_memory(watch) && wh_list_ready(watch->list, 2);
    requires wh_watched(watch, watch->gripper->approach.wafer) && wh_watched(watch, watch->gripper->contest.wafer);
    assigns watch->gripper->approach, watch->gripper->contest, watch->table->counters,
            watch->table->storage.buckets[0 .. watch->table->storage.bucket_count - 1],
            watch->list->count, watch->list->events[0 .. wh_room(watch->list) - 1];
    ensures wh_watched(watch, watch->gripper->approach.wafer) && wh_watched(watch, watch->gripper->contest.wafer);
    ensures wh_list_grown{Pre, Post}(watch->list, 2) && wh_same_size{Pre, Post}(watch->table); */
void wh_encounter_track(const wh_watch_t *watch);

/* The same with a sweep since the last slice, which it makes. */
/*@ requires wh_watch_memory(watch) && wh_list_ready(watch->list, 2);
    requires wh_watched(watch, watch->gripper->approach.wafer) && wh_watched(watch, watch->gripper->contest.wafer);
    assigns watch->sweep, watch->gripper->approach, watch->gripper->contest, watch->table->counters,
            watch->table->storage.buckets[0 .. watch->table->storage.bucket_count - 1],
            watch->list->count, watch->list->events[0 .. wh_room(watch->list) - 1];
    ensures wh_watched(watch, watch->gripper->approach.wafer) && wh_watched(watch, watch->gripper->contest.wafer);
    ensures wh_list_grown{Pre, Post}(watch->list, 2) && wh_same_size{Pre, Post}(watch->table); */
void wh_encounter_track_swept(wh_watch_t *watch);

/* Whether a wafer is in the neighbourhood for near misses; if so, fills in the two distances. */
/*@ requires \valid_read(config) && \valid_read(base_from_wafer) && \valid_read(base_from_gripper) && \valid(reach);
    assigns reach->z, reach->xy; */
bool wh_closeness_measure(const wh_grasp_config_t *config, const wh_pose_t *base_from_wafer,
                          const wh_pose_t *base_from_gripper, wh_closeness_t *reach);

/* The closest that a gripper with a sweep came to the wafer in this slice; false when it did not come near. */
/*@ requires wh_watch_memory(watch) && watch->sweep != \null && \valid_read(base_from_wafer) && \valid(closest);
    assigns *closest; */
bool wh_closeness_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_closeness_t *closest);

/* The values at an instant before the slice's end, judged by the limits that hold there. */
/*@ requires wh_watch_memory(watch) && watch->sweep != \null && \valid_read(base_from_wafer) && \valid(measured);
    assigns *measured; */
void wh_measure_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_real_t t,
                      wh_proximity_t *measured);

#endif
