/* A blade's pass through the beams at a station's door. It collects the latches and the blade's places
 * slice by slice, and gives the points of the blade that were in the beams.
 *
 * A latch comes after its delay; the crossing was at the blade's place at that time. The caller knows the
 * blade's places: motion control as it commands them, a log's reader as the states tell them.
 */
#ifndef WH_RECORD_PASSES_H
#define WH_RECORD_PASSES_H

#include "../align/centring.h"
#include "../layout/layout.h"
#include "../sim/slice.h"

/* Read only, except the values at the beginning: order, station, gripper, believed, seq, number, before and
 * goes_on. */
typedef struct {
    wh_latch_order_t order; /* count 0: none was armed */
    int32_t station, gripper;
    wh_pose_t believed;      /* base_from_station at which the beams are assumed to stand */
    int64_t seq;             /* of the last state heard */
    uint32_t number, before; /* number of the last arming known, now and when this one was ordered */
    int64_t armed_seq;       /* the slice whose command carried the order; 0: none yet */
    bool goes_on;            /* the blade's way is remembered */
    wh_pose_t *places;       /* base_from_gripper, from the end of that slice on */
    size_t place_count, place_capacity;
    wh_latch_t latches[WH_CROSSINGS]; /* of these the first latch_count, as far as there is room */
    int64_t latch_count;
    int64_t missed; /* latches that no state has brought */
    bool skipped;   /* the simulator has not had all slices */
} wh_pass_t;

/* A latch as a point of the blade. */
typedef struct {
    wh_crossing_t crossing;
    double time; /* of the crossing, s of the run */
} wh_pass_crossing_t;

/* Takes a state that is later than all before. It must have `physics`. */
void wh_pass_hear(wh_pass_t *pass, const wh_state_t *state);

/* Takes the command of the next slice. */
void wh_pass_follow(wh_pass_t *pass, const wh_command_t *command);

/* Takes the gripper's place at the end of a slice. Places after a gap are not remembered. */
void wh_pass_stand(wh_pass_t *pass, int64_t seq, const wh_pose_t *base_from_gripper);

/* Forgets the places. */
void wh_pass_free(wh_pass_t *pass);

/* base_from_station at which this gripper's robot assumes the station's beams: the layout's pose, shifted
 * by that robot's teaching error. */
wh_pose_t wh_pass_station(const wh_layout_t *layout, int32_t station, int32_t gripper);

/* A beam of the layout, with its station assumed at that pose. */
wh_beam_t wh_pass_beam(const wh_layout_t *layout, int32_t beam, const wh_pose_t *base_from_station);

/* Gives each latch as a crossing, after subtracting the delays that motion control knows. Returns the
 * number of crossings; `missed` is the number of latches without one. */
size_t wh_pass_crossings(const wh_pass_t *pass, const wh_layout_t *layout,
                         wh_pass_crossing_t crossings[WH_CROSSINGS], int64_t *missed);

#endif
