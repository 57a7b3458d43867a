/* The simulator: a grasp table and the cell around it, stepped by commands. It uses no heap; arrays belong
 * to the caller.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint; "sampled" is a step without swept checking; the need of an observer is added to
 * these):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_simulator_init               404    320     268    240
 *     stack of wh_simulator_set_physics        352    344     280    264
 *     stack of wh_simulator_step              1608   1544    1104   1112
 *     stack of wh_simulator_step:sampled      1608   1544    1104   1112
 *     stack of wh_simulator_view                32     36      24     40
 *     stack of wh_simulator_hash               136    176     144    176
 *     size of wh_simulator_t                 22352          14408
 */
#ifndef WH_SIM_SIMULATOR_H
#define WH_SIM_SIMULATOR_H

#include "../cell/station.h"
#include "gripping.h"
#include "slice.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(simulator);

/* Sees each accepted step after table and cell, and may append events. `command` is the step's, and
 * `inputs` are the inputs after faults and vacuum. It must not change any value that a step depends on.
 * Null functions are not called. */
typedef struct {
    void (*look)(void *user, const wh_command_t *command, const wh_gripper_input_t inputs[],
                 const wh_grasp_t *table, wh_event_list_t *list);
    /* A fault moved a wafer that nobody holds. It is not called for wafers that settle. */
    void (*placed)(void *user, const wh_grasp_t *table, int32_t wafer);
    void *user;
} wh_observer_t;

/* The parts of a simulator besides vacuum: all zero until one of the calls below sets them. A firmware that
 * calls none of them links no code for them. */
typedef struct {
    wh_scanning_t scanning;           /* the edge sensors */
    const wh_scanning_calls_t *scans; /* null: there are none */
    wh_latching_t latching;           /* the beams at doors */
    const wh_latching_calls_t *beams; /* null: there are none */
    wh_door_set_t doors;
    const wh_doors_calls_t *moving;      /* null: there are no doors */
    wh_grips_t grips;                    /* other grips than vacuum, and front faces */
    const wh_gripping_calls_t *gripping; /* null: there are none, and wh_grasp_step is the table's step */
    uint32_t no_vacuum;                  /* bit g: gripper g has another grip */
    /* wh_physics_state_hash_given once there is any of these; null before */
    uint64_t (*hash)(const wh_physics_state_t *state, size_t gripper_count, uint64_t hash);
} wh_simulator_given_t;

typedef struct {
    wh_link_t link; /* first: &simulator->link is the interface by a call */
    wh_grasp_t table;
    wh_cell_t cell;
    wh_real_t slice_s;
    wh_vacuum_config_t vacuum;
    wh_pads_t pads;
    wh_physics_state_t physics;
    wh_gripper_input_t inputs[WH_GRIPPERS]; /* of the running step, if faults and vacuum change them */
    wh_event_t events[WH_SLICE_EVENTS + 1]; /* one more entry shows that they did not fit */
    size_t event_count;
    wh_observer_t observer; /* the caller sets it after wh_simulator_init */
    wh_simulator_given_t given;
    bool is_strict, has_last;     /* see wh_simulator_set_strict; the following are known */
    int64_t last_seq, last_utime; /* of the last slice */
    uint32_t mark;                /* WH_SIMULATOR_MARK once wh_simulator_init has set it up */
} wh_simulator_t;

/* A simulator without this mark is refused (WH_STATUS_NOT_INITIALISED), like a table; WH_GRASP_MARK
 * explains the mark's limits. */
#define WH_SIMULATOR_MARK UINT32_C(0x51a07e5d)

/* Sets up a run: all wafers are free, at their places in storage->wafers. `cell->stations` and the arrays
 * of `storage` must outlive the simulator. It refuses what wh_grasp_init and wh_cell_validate refuse, and
 * more than WH_GRIPPERS grippers (WH_STATUS_BAD_CAPACITY); simulator and arrays are then unchanged.
 * Stations may overlap: each wafer then lies in the nearest of all slots, and WH_EVENT_SLOT_OCCUPIED comes
 * only for two wafers in one slot. Cost: that of these two, and the simulator's size in bytes written. Do
 * not move the simulator afterwards: `link` and states point into it. */
wh_status_t wh_simulator_init(wh_simulator_t *simulator, const wh_grasp_config_t *config,
                              const wh_grasp_storage_t *storage, const wh_cell_t *cell)
    WH_SYMBOL(wh_simulator_init);

/* Replaces wh_physics_default, which wh_simulator_init sets. It refuses what wh_physics_validate refuses, a
 * run that has begun (WH_STATUS_OUT_OF_RANGE), null pointers and a simulator that is not initialised; the
 * simulator is then unchanged. Cost: wh_physics_validate. */
wh_status_t wh_simulator_set_physics(wh_simulator_t *simulator, const wh_physics_t *physics)
    WH_SYMBOL(wh_simulator_set_physics);

/* Gives the simulator edge sensors (scanning.h) in place of its earlier ones; at first it has none. The
 * arrays must outlive the simulator and its copies. It refuses what wh_scanning_validate refuses, a run
 * that has begun (WH_STATUS_OUT_OF_RANGE), null pointers and a simulator that is not initialised; the
 * simulator is then unchanged. Cost: wh_scanning_validate. */
wh_status_t wh_simulator_set_scanning(wh_simulator_t *simulator, const wh_scanning_t *scanning)
    WH_SYMBOL(wh_simulator_set_scanning);

/* Gives the simulator beams at doors (latching.h) in place of its earlier ones; at first it has none. The
 * arrays must outlive the simulator and its copies. It refuses what wh_latching_validate refuses, and the
 * other cases of wh_simulator_set_scanning; the simulator is then unchanged. Cost: wh_latching_validate. */
wh_status_t wh_simulator_set_latching(wh_simulator_t *simulator, const wh_latching_t *latching)
    WH_SYMBOL(wh_simulator_set_latching);

/* Gives the simulator doors (doors.h), each at home, in place of its earlier ones; at first it has none.
 * The array must outlive the simulator and its copies. It refuses more than WH_DOORS, no array
 * (WH_STATUS_OUT_OF_RANGE), and the other cases of wh_simulator_set_scanning; the simulator is then
 * unchanged. Cost: linear in doors. */
wh_status_t wh_simulator_set_doors(wh_simulator_t *simulator, const wh_door_set_t *set)
    WH_SYMBOL(wh_simulator_set_doors);

/* Gives the simulator grips other than vacuum, and wafers face down (grasp/grips.h). From then on
 * wh_grips_step is its table's step. `thickness` of the parts must be the cell's. Their `states` and
 * `speeds` are ignored: states are in the simulator's physics, and faults slow plungers down. The other
 * arrays must outlive the simulator and its copies, and only one of them may step at a time. It refuses
 * what wh_grips_init refuses, a thickness other than the cell's or a dt other than the physics' slice_s
 * (WH_STATUS_OUT_OF_RANGE; wh_simulator_set_physics refuses such a slice_s afterwards), and the other
 * cases of wh_simulator_set_scanning; the simulator is then unchanged. Cost: wh_grips_init. */
wh_status_t wh_simulator_set_grips(wh_simulator_t *simulator, const wh_grips_parts_t *parts)
    WH_SYMBOL(wh_simulator_set_grips);

/* From now on commands whose `seq` or `utime` is not above that of the last slice are refused
 * (WH_STATUS_OUT_OF_RANGE), or no longer: at first, nothing is asked of them. After wh_simulator_load
 * the first command may have any. Refuses null and a simulator that is not initialised. Cost: none. */
wh_status_t wh_simulator_set_strict(wh_simulator_t *simulator, bool is_strict)
    WH_SYMBOL(wh_simulator_set_strict);

/* One slice: faults and vacuum turn the command into the grippers' inputs, the table steps, the cell
 * judges the releases, vacuum, holding, edge sensors, doors and beams follow, and `state` is filled in.
 * Returns state->status.
 *
 * While a valve is closed and its vacuum still holds the wafer, a support stops the wafer. The gripper then
 * releases it in the slice that would carry the wafer to the plane of its slot or below (wh_cell_stops).
 *
 * A gripper with another grip than vacuum has no lag: its valve acts at once. Its level is 0, and its
 * sensor is on while the plunger stands in the window gripped, or while passive pads have a wafer. Nothing
 * slips in an edge grip; passive pads hold by friction alone.
 *
 * With grips (wh_simulator_set_grips) and pads, consider a gripper with vacuum whose e3 points down by n.
 * Where force < mass * gravity * n its valve counts as closed: it takes no wafer, and drops the one that it
 * holds. While a wafer below such a gripper is not above the plane of its slot, holding is not checked.
 *
 * A refused command leaves everything as it was, but table.counters.refused counts it. Refused is what
 * wh_grasp_step refuses and, without an event, a gripper_count other than the table's, an axis_count above
 * WH_AXES, with wh_simulator_set_strict a seq or utime that does not go on, and what wh_faults_check,
 * wh_scanning_check and wh_latching_check refuse; any order to sensors or beams that are not there. With a
 * null pointer (WH_STATUS_NULL_ARGUMENT) nothing is written or counted. If the simulator is not initialised,
 * nothing is read or written, and `state` shows no wafer and no gripper. `seq` and `utime` are handed back;
 * faults go by `seq`. Cost: wh_grasp_step, wh_cell_judge, wh_cell_passes for each wafer that is held,
 * wh_scanning_step and wh_latching_step.
 */
wh_status_t wh_simulator_step(wh_simulator_t *simulator, const wh_command_t *command, wh_state_t *state)
    WH_SYMBOL(wh_simulator_step);

/* Fills in everything of a state except utime, seq and status, without a step. For a simulator that is not
 * initialised it shows no wafer and no gripper. No argument may be null. Cost: linear in grippers. */
void wh_simulator_view(const wh_simulator_t *simulator, wh_state_t *state) WH_SYMBOL(wh_simulator_view);

/* wh_physics_state_hash of the simulator's state; 0 if it is not initialised. */
uint64_t wh_simulator_hash(const wh_simulator_t *simulator) WH_SYMBOL(wh_simulator_hash);

WH_HEADER_END

#endif
