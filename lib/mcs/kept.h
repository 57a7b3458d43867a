/* The inputs of the simulator, as `--segments` writes them: motions, valves, faults, and orders to edge
 * sensors and beams, each with its slice. Waiting is not kept: the slices tell it. A motion that a STOP slows
 * down is no segment any more: each slice of that is kept as a place. */
#ifndef WH_MCS_KEPT_H
#define WH_MCS_KEPT_H

#include "../motion/slow.h"
#include "../sim/played.h"
#include "partners.h"
#include "rehearsal.h"

/* A motion, and the command of the record that asked for it (or WH_NONE). */
typedef struct {
    wh_segment_t segment; /* its points are in `points` */
    wh_via_point_t points[WH_VIA_POINTS];
    wh_slowness_t slowness;
    uint32_t axes;  /* bits: the axes that it moves */
    int64_t after;  /* the slices before it */
    int64_t slices; /* so far */
    int64_t planned;
    int32_t command;
} wh_kept_motion_t;

/* From slice `seq` on these grippers' valves are open. */
typedef struct {
    int64_t seq;
    uint32_t open;
    int32_t command;
} wh_kept_valves_t;

/* A slice of a motion that slows down: where its axes stand. */
typedef struct {
    int64_t seq;
    uint32_t axes; /* bits */
    int32_t command;
    wh_real_t at[WH_AXES];
} wh_kept_place_t;

typedef struct {
    wh_kept_motion_t *motions;
    size_t motion_count, motion_capacity;
    wh_kept_valves_t *valves;
    size_t valves_count, valves_capacity;
    wh_played_fault_t *faults;
    size_t fault_count, fault_capacity;
    wh_played_order_t *orders;
    size_t order_count, order_capacity;
    wh_kept_place_t *places;
    size_t place_count, place_capacity;
} wh_mcs_kept_t;

/* Keeps the segment that `begun` has just begun, if it moves anything: of the axes in `axes` alone. Returns
 * its number, from 1; 0: none is kept, or nothing moves. */
size_t wh_mcs_keep_segment(wh_mcs_t *mcs, const wh_track_t *begun, const wh_planned_t *planned,
                           uint32_t axes);

/* Keeps the slice that goes out with mcs->command. */
void wh_mcs_keep_slice(wh_mcs_t *mcs);

/* The slice that was kept last has not taken place. */
void wh_mcs_drop_slice(wh_mcs_t *mcs);

/* This number of slices of the running segments was left out. */
void wh_mcs_keep_left_out(wh_mcs_t *mcs, int64_t slices);

void wh_mcs_free_kept(wh_mcs_kept_t *kept);

#endif
