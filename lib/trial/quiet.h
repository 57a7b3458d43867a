/* Slices of a simulator in which nothing can happen but motion: vacuum, plungers and doors stand, and nothing
 * that moves comes near to anything. Such slices may be left out, without a step.
 *
 * How far a gripper comes in a slice is bounded by the limits of its axes, whatever segment they go. So a few
 * distances tell for many slices at once that nobody takes, meets or passes anything.
 */
#ifndef WH_TRIAL_QUIET_H
#define WH_TRIAL_QUIET_H

#include "../sim/simulator.h"

/* The most that an axis does to a gripper in a slice. */
typedef struct {
    wh_real_t way;  /* of its origin, mm */
    wh_real_t turn; /* rad */
} wh_quiet_axis_t;

/* The bounds of a machine. Sets of axes have bit a for axis a. */
typedef struct {
    const wh_machine_t *machine;
    wh_quiet_axis_t by_axis[WH_GRIPPERS][WH_AXES];
    uint32_t movers[WH_GRIPPERS]; /* the axes that move the gripper */
    /* Those that may lift or tilt it: without them a level gripper keeps its height, to the last bit. */
    uint32_t lifters[WH_GRIPPERS];
    uint32_t doors; /* the doors' axes */
} wh_quiet_t;

/* `machine` must outlive it. Cost: linear in axes and grippers. */
void wh_quiet_begin(wh_quiet_t *quiet, const wh_machine_t *machine, wh_real_t slice_s);

/* The axes that the track's running segment moves. */
uint32_t wh_quiet_axes(const wh_track_t *track);

/* The number of next slices in which nothing can happen but motion, if they have the valves of `last`, the
 * command of the last slice, and no orders, and segments move these axes alone. 0: something may happen in
 * the next one; INT64_MAX: nothing ever. Cost: about 10 products for each moving gripper and each station and
 * wafer. */
int64_t wh_quiet_slices(const wh_quiet_t *quiet, const wh_simulator_t *simulator, const wh_command_t *last,
                        uint32_t axes);

/* Leaves out this number of slices, in which nothing can happen by wh_quiet_slices: `command` is that of the
 * last of them. The simulator is then as if it had stepped them all. */
void wh_quiet_pass(wh_simulator_t *simulator, const wh_command_t *command, int64_t slices);

#endif
