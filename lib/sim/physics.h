/* What a step of the simulator depends on beside the grasp table: vacuum, motion of held wafers, faults. */
#ifndef WH_SIM_PHYSICS_H
#define WH_SIM_PHYSICS_H

#include "../grasp/hold.h"
#include "faults.h"

WH_HEADER_BEGIN

/* What does not change during a run. */
typedef struct {
    wh_real_t slice_s; /* length of a slice, s, above 0, up to 1 */
    wh_vacuum_config_t vacuum;
    wh_pads_t pads;
    wh_fault_t faults[WH_FAULTS]; /* at the start of the run */
    size_t fault_count;
} wh_physics_t;

/* The state of the physics after the last slice. Entries beyond the gripper count are ignored. */
typedef struct {
    wh_vacuum_t vacuum[WH_GRIPPERS];
    wh_carry_t carry[WH_GRIPPERS]; /* all zero without pads */
    int32_t told[WH_GRIPPERS];     /* valves of the last command, before faults; no step depends on them */
    wh_faults_t faults;
} wh_physics_state_t;

/* Slices of 1 ms, ideal vacuum, no pads, no faults. */
wh_physics_t wh_physics_default(void) WH_SYMBOL(wh_physics_default);

/* WH_OK, or what is wrong with it for a cell with these counts. */
wh_status_t wh_physics_validate(const wh_physics_t *physics, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_physics_validate);

/* The state before the first slice: the `faults` of the physics wait in the first slots. */
void wh_physics_state_start(wh_physics_state_t *state, const wh_physics_t *physics)
    WH_SYMBOL(wh_physics_state_start);

/* Checks that a simulator can have such a state: WH_OK, WH_STATUS_NOT_FINITE, WH_STATUS_BAD_VALVE or
 * WH_STATUS_OUT_OF_RANGE. */
wh_status_t wh_physics_state_validate(const wh_physics_state_t *state, size_t gripper_count,
                                      size_t wafer_count) WH_SYMBOL(wh_physics_state_validate);

/* What the vacuum sensors say: bit g for gripper g. */
uint32_t wh_physics_state_sensors(const wh_physics_state_t *state, size_t gripper_count)
    WH_SYMBOL(wh_physics_state_sensors);

/* 64 bits over all that the next step depends on. It is wh_grasp_hash(table), continued by wh_hash_word
 * (math/hash.h) with these words:
 *   - for each gripper whose vacuum is not plain: 1, its index, level, command and on. Vacuum is plain if its
 *     command is the table's valve, and it is at level 1 with the sensor on while the gripper holds a wafer,
 *     or at level 0 with the sensor off while it holds none;
 *   - for each gripper with positions known: 2, its index, known, before[0], before[1] and slips;
 *   - for each slot in use: 3, its index, phase, kind, target, other, value, offset, from, until, before,
 *     placed.
 * So a run with ideal vacuum, without pads and faults, has the table's hash.
 */
uint64_t wh_physics_state_hash(const wh_physics_state_t *state, const wh_grasp_t *table)
    WH_SYMBOL(wh_physics_state_hash);

WH_HEADER_END

#endif
