/* A played run, as `waferhand run SCRIPT --segments FILE` writes it in C, or `waferhand replay LAYOUT --field
 * FILE.csv --segments FILE` from a controller's log, and its player.
 *
 * The file has everything that the run needs: machine, stations, wafers, vacuum, grips, sensors and faults
 * as constants, and its motions as rows, under the lines of the script that asked for them. Each row says in
 * which slice it begins, so the player waits for no sensor, door or station: it repeats what went into the
 * simulator, slice by slice. In motion.h all names begin with motion_, so one program can have several; if
 * two have one set of names, the second is an #error:
 *
 *     static motion_player_t motion;
 *     wh_status_t status = motion_begin(&motion);
 *     while (status == WH_OK && wh_player_next(&motion.player)) {
 *         ... motion.player.command, motion.player.state ...
 *     }
 *     same = wh_player_is_as_recorded(&motion.player);
 *
 * A program links only the parts that its run uses: ways, via points, slow motions, robots of other kinds,
 * edge sensors, beams, doors and grips come in by pointers of the file. The numbers have all their digits,
 * for double; float plays the run to hashes of its own, and ends each motion in the slice of the double's.
 *
 * It looks for no collisions. It uses no heap and no static data.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint; the stack is without that of the parts that come in by pointers):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_player_init                  544    536     400    392
 *     stack of wh_player_next                 3488   3448    1892   1900
 *     size of wh_played_row_t                   80             56
 *     size of wh_played_motion_t              1952           1048
 *     size of wh_player_t                    26144          16528
 */
#ifndef WH_SIM_PLAYED_H
#define WH_SIM_PLAYED_H

#include "../motion/slow.h"
#include "simulator.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(played);

/* The kinds of rows. A motion is a row of its kind, the rows that go on with its values, one that slows
 * it, and its via points. A PLACE is a row, and those that go on with its values. Targets are in the order
 * of the axes in `bits`, rad and mm. */
typedef enum WH_FOUR_BYTES {
    WH_PLAYED_AXES,   /* a target for each axis: WH_SEGMENT_AXES */
    WH_PLAYED_LINE,   /* travel x, y, z, speed, acceleration: WH_SEGMENT_LINE */
    WH_PLAYED_WAY,    /* reach, reach2, a target for each axis: WH_SEGMENT_WAY */
    WH_PLAYED_VIA,    /* a target for each axis: WH_SEGMENT_VIA */
    WH_PLAYED_VALVES, /* no motion: from the next slice on the valves in `bits` are open, all others closed */
    WH_PLAYED_MORE,   /* the values of the row before go on */
    WH_PLAYED_SLOW,   /* of the motion: shares of speed and acceleration, pace (motion/slow.h) */
    WH_PLAYED_POINT,  /* of the VIA: blend, reach of both arms, the place of each axis (motion/via.h) */
    WH_PLAYED_PLACE   /* no motion: from the next slice on each axis stands at its target */
} wh_played_kind_t;

/* The values of a row. */
#define WH_PLAYED_VALUES 6

/* In MORE, SLOW and POINT only `kind` and `values` count. */
typedef struct {
    int64_t after;  /* it begins with the slice after this one, 0 or more */
    int64_t slices; /* of the motion, 1 or more */
    wh_played_kind_t kind;
    bool is_cut;     /* something stopped the motion before its end */
    int32_t gripper; /* LINE, WAY, VIA: as in wh_segment_t */
    uint32_t bits;   /* bit a: it moves or places axis a; VALVES: bit g: gripper g's is open */
    wh_real_t values[WH_PLAYED_VALUES];
} wh_played_row_t;

/* A fault that the script brought, or gave a new end, with the command of slice `seq`. */
typedef struct {
    int64_t seq;
    wh_fault_request_t request;
} wh_played_fault_t;

/* Orders to edge sensors and beams, with the command of slice `seq`. */
typedef struct {
    int64_t seq;
    wh_scan_order_t scan;
    wh_latch_order_t latch;
} wh_played_order_t;

/* The parts that not every run has: each function is the library's own of that name, or null where the run
 * does not need it. */
typedef struct {
    void (*take_ways)(wh_track_t *track); /* wh_track_take_ways: it has a WAY */
    void (*take_vias)(wh_track_t *track);
    /* wh_track_begin_slowly: it has a SLOW */
    wh_status_t (*begin_slowly)(wh_track_t *track, const wh_segment_t *segment, const wh_slowness_t *slowness,
                                wh_slow_t *room);
    wh_status_t (*set_scanning)(wh_simulator_t *simulator, const wh_scanning_t *scanning);
    wh_status_t (*set_latching)(wh_simulator_t *simulator, const wh_latching_t *latching);
    wh_status_t (*set_doors)(wh_simulator_t *simulator, const wh_door_set_t *set); /* the machine's */
    wh_status_t (*set_grips)(wh_simulator_t *simulator, const wh_grips_parts_t *parts);
    wh_scanning_t scanning;
    wh_latching_t latching;
    wh_grips_parts_t grips; /* without `states` and `seen` */
} wh_played_parts_t;

/* A description: it does not change, and points to constants. */
typedef struct {
    const wh_machine_t *machine;
    const wh_played_row_t *rows; /* motions and valves in order of `after` */
    size_t row_count;
    size_t motion_count;             /* the most motions that run at once */
    const wh_played_fault_t *faults; /* in order of seq, from 1; at most WH_COMMAND_FAULTS in each */
    size_t fault_count;
    const wh_played_order_t *orders; /* in order of seq, one in each */
    size_t order_count;
    const wh_pose_t *wafers; /* base_from_wafer at the start */
    size_t wafer_count;
    int64_t slice_us;
    wh_grasp_config_t config;
    wh_physics_t physics; /* with the faults at the start; slice_s equals slice_us, to a millionth */
    wh_cell_t cell;
    wh_played_parts_t parts;
    int64_t slices;  /* of the whole run */
    uint64_t hash;   /* wh_simulator_hash at its end, in double */
    uint64_t inputs; /* the player's at its end, in double */
} wh_played_t;

/* A motion that runs. */
typedef struct {
    wh_track_t track;
    int64_t left; /* its slices that are still to come; 0: none runs here */
    uint32_t bits;
    bool is_cut;
} wh_played_motion_t;

/* The caller's memory. Its content does not matter; it must live as long as the player, and serve only it. */
typedef struct {
    wh_wafer_t *wafers; /* as many as the run has */
    size_t wafer_count;
    wh_gripper_t *grippers; /* likewise */
    size_t gripper_count;
    wh_played_motion_t *motions; /* at least the run's motion_count */
    size_t motion_count;
    wh_wafer_t *seen; /* as many as wafers, where the run has grips; else it may be null */
    wh_slow_t *slow;  /* where it has slow motions; else it may be null */
} wh_played_room_t;

/* Callers read it; the player writes it. Do not move it once it is initialised. */
typedef struct {
    const wh_played_t *run;
    wh_played_room_t room;
    wh_simulator_t simulator;
    wh_track_t track; /* where all axes and valves are in the last slice, and its number */
    wh_machine_cache_t cache;
    wh_command_t command;     /* of the last slice */
    wh_state_t state;         /* the answer to it */
    wh_status_t status;       /* not WH_OK: the reason why the player stopped */
    size_t row, fault, order; /* the next ones */
    uint64_t inputs;          /* a hash over the description, the rows so far, and the axes of each slice */
} wh_player_t;

/* Sets up the run before its first slice: machine, simulator, and room->wafers with the run's initial
 * wafers. `run` and the arrays must outlive the player; `room` itself is copied. Returns player->status. It
 * refuses what wh_track_init and the simulator's functions refuse. WH_STATUS_BAD_CAPACITY is for other counts
 * than the run's, or too little room; WH_STATUS_OUT_OF_RANGE for rows, faults, orders or a physics.slice_s
 * that are not as described in wh_played_t; WH_STATUS_NULL_ARGUMENT also for an array of the run that is null
 * though its count is not 0. Cost: that of these, linear in rows and faults. */
wh_status_t wh_player_init(wh_player_t *player, const wh_played_t *run, const wh_played_room_t *room)
    WH_SYMBOL(wh_player_init);

/* Plays one slice. Returns false if there was none: the run is over, or player->status gives the reason of
 * a refusal: that of a row (wh_track_begin's, wh_machine_check_travel's, or WH_STATUS_OUT_OF_RANGE for one
 * that is not as described above), or of the slice. If a player was never initialised or was refused
 * (WH_STATUS_NOT_INITIALISED, if it is zeroed), only its simulator's mark is read; see WH_SIMULATOR_MARK. An
 * observer may be set in player->simulator before the first call. Cost: wh_track_next for each motion,
 * wh_simulator_step, and 2 ns for each axis. */
bool wh_player_next(wh_player_t *player) WH_SYMBOL(wh_player_next);

/* True if all slices were played, none was refused, and both hashes are those of the run. In float they are
 * others than the file's: compare them with those of an earlier float run. Cost: wh_simulator_hash. */
bool wh_player_is_as_recorded(const wh_player_t *player) WH_SYMBOL(wh_player_is_as_recorded);

WH_HEADER_END

#endif
