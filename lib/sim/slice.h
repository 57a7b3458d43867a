/* The interface between motion control and the simulator: for each slice a command goes in and a state comes
 * out.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_command_from_track           408    536     248    336
 *     size of wh_command_t                    1544            872
 *     size of wh_state_t                        56             56
 */
#ifndef WH_SIM_SLICE_H
#define WH_SIM_SLICE_H

#include "../motion/track.h"
#include "physics.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(slice);

/* The most events in one slice: those of the grasp table, then those of the cell, the vacuum, the faults
 * and the collision check. It is 128, and 64 with the counts of a bare target. More events are not
 * reported, and the state says so. */
#define WH_SLICE_EVENTS (WH_CAST(size_t, 8) * WH_GRIPPERS)

/* The most faults in one command. */
#define WH_COMMAND_FAULTS 4

/* The motion of the machine in slice `seq`. Entries beyond gripper_count, axis_count and fault_count
 * are ignored; a simulator refuses counts beyond the arrays. */
typedef struct {
    int64_t utime; /* simulated time, us: seq times the slice's length */
    int64_t seq;   /* 1 for the first slice */
    size_t gripper_count, axis_count;
    wh_gripper_input_t grippers[WH_GRIPPERS];
    wh_real_t axes[WH_AXES]; /* rad or mm, as in motion/machine.h */
    size_t fault_count;
    wh_fault_request_t faults[WH_COMMAND_FAULTS]; /* faults that begin or get a new end */
    wh_scan_order_t scan;                         /* order to the edge sensors */
    wh_latch_order_t latch;                       /* order to the beams at doors */
} wh_command_t;

/* Fills in poses, valves and axes of the track's current slice; leaves faults, edge sensors and beams alone.
 * Pass the same command and cache each time, zeroed before the first: it computes only what changed. If the
 * track was never initialised, nothing is read, and the command is unchanged. Cost: wh_machine_update. */
void wh_command_from_track(wh_command_t *command, wh_machine_cache_t *cache, const wh_track_t *track)
    WH_SYMBOL(wh_command_from_track);

/* The result of a command: a view of the simulator's own memory, valid until the next exchange. */
typedef struct {
    int64_t utime, seq; /* the command's, refused or not */
    wh_status_t status; /* not WH_OK: the command was refused; wafers and grippers are as before */
    const wh_wafer_t *wafers;
    size_t wafer_count;
    const wh_gripper_t *grippers;
    size_t gripper_count;
    const wh_event_t *events; /* of this slice, or of the refusal */
    size_t event_count;
    bool has_lost_events; /* the slice had more events than fit */
    uint32_t sensors;     /* bit g: gripper g's vacuum sensor is on */
    const wh_physics_state_t *physics;
} wh_state_t;

/* The link from one side to the other: by a call within the process, or by messages. */
typedef struct wh_link wh_link_t;
struct wh_link {
    /* Steps one slice. Returns state->status, or the reason why no answer came. */
    wh_status_t (*exchange)(wh_link_t *link, const wh_command_t *command, wh_state_t *state);
    /* wh_physics_state_hash of the state after the last exchange. */
    uint64_t (*hash)(wh_link_t *link);
    /* Slices of the run that never reached the simulator: 0 except in a free-running run. */
    int64_t (*missed)(wh_link_t *link);
};

WH_HEADER_END

#endif
