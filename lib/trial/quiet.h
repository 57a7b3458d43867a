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

/* Those of them that stand but for rounding, if the robot is a usual one: in a line straight up or down. */
uint32_t wh_quiet_still(const wh_track_t *track);

/* How many of the next slices an axis goes by at most so far, mm, from where it stands: what the caller knows
 * of its segment. */
typedef struct {
    const void *user;
    uint32_t still; /* of the axes that segments move: those of wh_quiet_still */
    int64_t (*within)(const void *user, size_t axis, wh_real_t way);
} wh_quiet_stroke_t;

/* The number of next slices in which nothing can happen but motion, if they have the valves of `last`, the
 * command of the last slice, and no orders, and segments move these axes alone. 0: something may happen in
 * the next one; INT64_MAX: nothing ever. `stroke` is asked where a gripper goes up or down; null: nobody
 * knows more than the axes' limits. Cost: about 10 products for each moving gripper and each station and
 * wafer. */
int64_t wh_quiet_slices(const wh_quiet_t *quiet, const wh_simulator_t *simulator, const wh_command_t *last,
                        uint32_t axes, const wh_quiet_stroke_t *stroke);

/* How far gripper g may go, mm, until something may happen between it and what stands; 0: that may be at
 * once, or other axes move it than one that lifts it and `still` ones. `axis` receives the one that lifts.
 * Cost: some 50 sums for each wafer, and, with a wafer, for each station. */
wh_real_t wh_quiet_room(const wh_quiet_t *quiet, const wh_simulator_t *simulator, uint32_t axes,
                        uint32_t still, size_t g, size_t *axis);

/* Leaves out this number of slices, in which nothing can happen by wh_quiet_slices: `command` is that of the
 * last of them. The simulator is then as if it had stepped them all. */
void wh_quiet_pass(wh_simulator_t *simulator, const wh_command_t *command, int64_t slices);

#endif
