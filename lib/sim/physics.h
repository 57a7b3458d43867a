/* The values that a step of the simulator depends on in addition to the grasp table: vacuum, motion of held
 * wafers, faults.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_physics_default             2384   2384    1384   1408
 *     stack of wh_physics_validate              96    216      56    128
 *     stack of wh_physics_state_start          248    240     192    184
 *     stack of wh_physics_state_validate       128    264      88    168
 *     stack of wh_physics_state_sensors         16     20       8     24
 *     stack of wh_physics_state_hash           152    176     144    176
 *     size of wh_physics_t                    2280           1336
 *     size of wh_physics_state_t              8016           5264
 */
#ifndef WH_SIM_PHYSICS_H
#define WH_SIM_PHYSICS_H

#include "../grasp/grips.h"
#include "../grasp/hold.h"
#include "doors.h"
#include "faults.h"
#include "latching.h"
#include "scanning.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(physics);

/* The default length of a slice, s. */
#define WH_SLICE_S WH_REAL(0.001)

/* The fixed values of a run. */
typedef struct {
    wh_real_t slice_s; /* length of a slice, s, above 0, up to 1 */
    wh_vacuum_config_t vacuum;
    wh_pads_t pads;
    wh_fault_t faults[WH_FAULTS]; /* at the start of the run */
    size_t fault_count;
} wh_physics_t;

/* The state of the physics after the last slice. Entries after the gripper count are ignored. */
typedef struct {
    wh_vacuum_t vacuum[WH_GRIPPERS];
    wh_carry_t carry[WH_GRIPPERS]; /* all zero without pads */
    int32_t told[WH_GRIPPERS];     /* valves of the last command, before faults; no step depends on them */
    wh_faults_t faults;
    wh_scan_t scan;                     /* scan of an edge sensor */
    wh_latches_t latches;               /* latches of the beams at doors */
    wh_grip_state_t grips[WH_GRIPPERS]; /* plungers; OPEN for grippers that have none */
    wh_doors_t doors;                   /* the doors themselves */
} wh_physics_state_t;

/* Slices of WH_SLICE_S, ideal vacuum, no pads, no faults. */
wh_physics_t wh_physics_default(void) WH_SYMBOL(wh_physics_default);

/* Returns WH_OK, or the error for a cell with these counts: WH_STATUS_NULL_ARGUMENT; WH_STATUS_BAD_CAPACITY
 * for more than WH_GRIPPERS grippers; WH_STATUS_OUT_OF_RANGE for `slice_s` or `fault_count`; or the status
 * of wh_vacuum_validate, wh_pads_validate or wh_fault_validate. Cost: that of wh_fault_validate for each
 * fault. */
wh_status_t wh_physics_validate(const wh_physics_t *physics, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_physics_validate);

/* The state before the first slice: the `faults` of the physics, which wh_physics_validate has accepted, wait
 * in the first slots. Null: no faults. Cost: the struct's
 * size in bytes written, and a copy of each fault. */
void wh_physics_state_start(wh_physics_state_t *state, const wh_physics_t *physics)
    WH_SYMBOL(wh_physics_state_start);

/* Checks that a simulator can have such a state: WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_BAD_CAPACITY for
 * more than WH_GRIPPERS grippers, WH_STATUS_NOT_FINITE, WH_STATUS_BAD_VALVE or WH_STATUS_OUT_OF_RANGE.
 * Cost: linear in grippers, and wh_faults_validate. */
wh_status_t wh_physics_state_validate(const wh_physics_state_t *state, size_t gripper_count,
                                      size_t wafer_count) WH_SYMBOL(wh_physics_state_validate);

/* The vacuum sensors' signals: bit g for gripper g; 0 for grippers from WH_GRIPPERS on. Cost: linear in
 * grippers and slots. */
uint32_t wh_physics_state_sensors(const wh_physics_state_t *state, size_t gripper_count)
    WH_SYMBOL(wh_physics_state_sensors);

/* 64 bits over everything that the next step depends on. It is wh_grasp_hash(table), continued by
 * wh_hash_word (math/hash.h) with these words:
 *   - for each gripper whose vacuum is not plain: 1, its index, level, command and on. Vacuum is plain if its
 *     command is the table's valve, and it is at level 1 with the sensor on while the gripper holds a wafer,
 *     or at level 0 with the sensor off while it holds none. While the sensor's debounce waits, also 8, its
 *     index and waits;
 *   - for each gripper with positions known: 2, its index, known, before[0], before[1] and slips;
 *   - for each slot in use: 3, its index, phase, kind, target, other, value, offset, from, until, before,
 *     placed;
 *   - once a scan has begun: 4, number, armed, gripper, count, first, taken, the turn's bits, sample_count
 *     and so many samples;
 *   - once beams have been armed: 5, number, armed, first, count, crossings, lost, broken, waiting_count,
 *     latch_count, slice, and of so many latches twice the beam plus the edge, slice and the part's bits;
 *   - for each gripper whose plunger is not OPEN: 6, its index, phase, wafer, and the bits of s and excess;
 *     and while it closes on a wafer x, y and the eight numbers of `lying`, in the order of their structs;
 *   - for each door that is not shut: 7, its index, where its axis is.
 * For a gripper with another grip than vacuum, level, command and on are 0, the valve and the sensor. So a
 * run with ideal vacuum, without pads, faults, scans, beams, edge grips and doors, has the table's hash.
 * Nothing is checked; grippers from WH_GRIPPERS on have no vacuum. Cost: wh_grasp_hash, 5 to 8 words for each
 * gripper with vacuum, 10 for each with positions, 45 for each slot in use, up to 73 for a scan, 11 for
 * beams with three for each latch, up to 16 for each plunger, and 3 for each door.
 */
uint64_t wh_physics_state_hash(const wh_physics_state_t *state, const wh_grasp_t *table)
    WH_SYMBOL(wh_physics_state_hash);

/* The table's hash and the words 1 to 3: all state of a simulator without further parts. */
uint64_t wh_physics_state_hash_plain(const wh_physics_state_t *state, const wh_grasp_t *table)
    WH_SYMBOL(wh_physics_state_hash_plain);

/* Continues wh_physics_state_hash_plain with the words from 4 on; the result is wh_physics_state_hash. */
uint64_t wh_physics_state_hash_given(const wh_physics_state_t *state, size_t gripper_count, uint64_t hash)
    WH_SYMBOL(wh_physics_state_hash_given);

WH_HEADER_END

#endif
