/* Internal to the room: near misses and contests, handled after the picks of a step. */
#ifndef WH_GRASP_ENCOUNTER_INTERNAL_H
#define WH_GRASP_ENCOUNTER_INTERNAL_H

#include "grasp.h"
#include "sweep_internal.h"

/* The data for one gripper's encounters in this step. */
typedef struct {
    wh_grasp_t *table;
    wh_gripper_t *gripper;
    const wh_pose_t *base_from_gripper; /* at the slice's end */
    const wh_sweep_t *sweep;            /* for wh_watch_sweep */
    wh_event_list_t *list;
    int32_t index;
} wh_watch_t;

/* The gripper's distance to a wafer and its time: 1 is the slice's end. */
typedef struct {
    wh_real_t t;
    wh_real_t z;  /* |dr_proj_z| */
    wh_real_t xy; /* |dr_proj_xy| */
} wh_closeness_t;

/* Updates one gripper's approach and contest and reports those that ended. `input` is this slice's, the
 * gripper still has the previous slice's pose and valve. */
void wh_encounter_update(wh_grasp_t *table, size_t gripper, const wh_gripper_input_t *input,
                         wh_event_list_t *list) WH_SYMBOL(wh_encounter_update);

/* The part of wh_encounter_update for a gripper that was and is open and empty. It works with or without
 * watch->sweep. */
void wh_encounter_track(const wh_watch_t *watch) WH_SYMBOL(wh_encounter_track);

/* True if a wafer is in the neighbourhood for near misses; it then fills in the two distances. */
bool wh_closeness_measure(const wh_grasp_config_t *config, const wh_pose_t *base_from_wafer,
                          const wh_pose_t *base_from_gripper, wh_closeness_t *reach)
    WH_SYMBOL(wh_closeness_measure);

/* The gripper's motion since the last slice; null with sampled checking. */
static inline const wh_sweep_t *wh_watch_sweep(const wh_watch_t *watch) {
    return WH_SWEEP_BUILT ? watch->sweep : NULL;
}

/* Makes the sweep since the last slice, then does the work of wh_encounter_track. */
void wh_encounter_track_swept(wh_watch_t *watch) WH_SYMBOL(wh_encounter_track_swept);

/* Measures how close a gripper with a sweep came to the wafer in this slice; false if it did not come
 * near. */
bool wh_closeness_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_closeness_t *closest)
    WH_SYMBOL(wh_closeness_swept);

/* Measures at an instant before the slice's end, and judges by the limits there. */
void wh_measure_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_real_t t,
                      wh_proximity_t *measured) WH_SYMBOL(wh_measure_swept);

#endif
