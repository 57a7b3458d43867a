/* A played run, as `waferhand run SCRIPT --segments FILE` writes it in C, and its player.
 *
 * The file has everything that the run needs: machine, vacuum, pads, faults, stations, wafers, and the
 * segments of its motion. The segments stand under the lines of the script that asked for them. In motion.h
 * all names begin with motion_, so one program can have several; if two have one set of names, the second
 * is an #error:
 *
 *     static wh_wafer_t wafers[MOTION_WAFERS];
 *     static wh_gripper_t grippers[MOTION_GRIPPERS];
 *     static wh_player_t player;
 *     const wh_grasp_storage_t storage = {wafers, MOTION_WAFERS, grippers, MOTION_GRIPPERS, NULL, 0};
 *     status = wh_player_init(&player, &motion_run, &storage);
 *     while (status == WH_OK && wh_player_next(&player)) {
 *         ... player.command, player.state ...
 *     }
 *     same = player.status == WH_OK && wh_simulator_hash(&player.simulator) == motion_run.hash;
 *
 * The numbers have all their digits, for double; float plays this run to a hash of its own. */
#ifndef WH_SIM_PLAYED_H
#define WH_SIM_PLAYED_H

#include "simulator.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(played);

/* A segment as it was played: to its end, or (if `slices` is not 0) cut off by a STOP after that number of
 * slices. */
typedef struct {
    wh_segment_t segment;
    int64_t slices;
} wh_played_segment_t;

/* A fault that the script brought, or gave a new end, with the command of slice `seq`. */
typedef struct {
    int64_t seq;
    wh_fault_request_t request;
} wh_played_fault_t;

/* A description: it does not change, and points to constants. */
typedef struct {
    const wh_machine_t *machine;
    const wh_played_segment_t *segments;
    size_t segment_count;
    const wh_played_fault_t *faults; /* in order of seq, from 1; at most WH_COMMAND_FAULTS in each */
    size_t fault_count;
    const wh_pose_t *wafers; /* base_from_wafer at the start */
    size_t wafer_count;
    int64_t slice_us;
    wh_grasp_config_t config;
    wh_physics_t physics; /* with the faults at the start; slice_s equals slice_us, to a millionth */
    wh_cell_t cell;
    int64_t slices;                       /* of the whole run */
    uint64_t hash;                        /* wh_simulator_hash at its end, in double */
    void (*take_ways)(wh_track_t *track); /* wh_track_take_ways if a segment is a WAY; else it may be NULL */
} wh_played_t;

/* Callers read it; the player writes it. Do not move it once it is initialised. */
typedef struct {
    const wh_played_t *run;
    wh_simulator_t simulator;
    wh_track_t track;
    wh_machine_cache_t cache;
    wh_command_t command;  /* of the last slice */
    wh_state_t state;      /* the answer to it */
    wh_status_t status;    /* not WH_OK: the reason why the player stopped */
    size_t segment, fault; /* the next ones */
    int64_t left;          /* slices until the running segment is cut off; 0: it is not cut off */
    bool is_moving;        /* a segment is running */
} wh_player_t;

/* Sets up the run before its first slice: machine, simulator, and storage->wafers with the run's initial
 * wafers. `run` and the arrays must outlive the player. Returns player->status. It refuses what
 * wh_track_init, wh_simulator_init and wh_simulator_set_physics refuse. WH_STATUS_BAD_CAPACITY is for other
 * counts than the run's; WH_STATUS_OUT_OF_RANGE for faults or a physics.slice_s that are not as described
 * in wh_played_t; WH_STATUS_NULL_ARGUMENT also for an array of the run that is null though its count is not
 * 0. Cost: that of these three, linear in faults. */
wh_status_t wh_player_init(wh_player_t *player, const wh_played_t *run, const wh_grasp_storage_t *storage)
    WH_SYMBOL(wh_player_init);

/* Plays one slice. Returns false if there was none: the run is over, or player->status gives the reason of
 * a refusal. If a player was never initialised or was refused (WH_STATUS_NOT_INITIALISED, if it is zeroed),
 * only its simulator's mark is read; see WH_SIMULATOR_MARK. An observer may be set in player->simulator
 * before the first call. Cost: wh_track_next and wh_simulator_step. */
bool wh_player_next(wh_player_t *player) WH_SYMBOL(wh_player_next);

WH_HEADER_END

#endif
