/* The simulator: a grasp table and the cell around it, stepped by commands. No heap; arrays are the
 * caller's. */
#ifndef WH_SIM_SIMULATOR_H
#define WH_SIM_SIMULATOR_H

#include "../cell/station.h"
#include "slice.h"

WH_HEADER_BEGIN

/* Looks at each accepted step after table and cell, and may append events. `inputs` are the step's own, after
 * faults and vacuum. It must not change anything that a step depends on. Null functions are not called. */
typedef struct {
    void (*look)(void *user, const wh_gripper_input_t inputs[], const wh_grasp_t *table,
                 wh_event_list_t *list);
    /* A fault moved a wafer that nobody holds. Not called for wafers that settle. */
    void (*placed)(void *user, const wh_grasp_t *table, int32_t wafer);
    void *user;
} wh_observer_t;

typedef struct {
    wh_link_t link; /* first: &simulator->link is the interface by a call */
    wh_grasp_t table;
    wh_cell_t cell;
    wh_real_t slice_s;
    wh_vacuum_config_t vacuum;
    wh_pads_t pads;
    wh_physics_state_t physics;
    wh_gripper_input_t inputs[WH_GRIPPERS]; /* of the running step, if faults and vacuum change them */
    wh_event_t events[WH_SLICE_EVENTS];
    size_t event_count;
    wh_observer_t observer; /* set by the caller after wh_simulator_init */
} wh_simulator_t;

/* Sets up a run: all wafers are free, at their places in storage->wafers. `cell->stations` and the arrays of
 * `storage` must outlive the simulator. Refuses what wh_grasp_init refuses, null stations unless there are
 * none, and more than WH_GRIPPERS grippers (WH_STATUS_BAD_CAPACITY); simulator and arrays are then unchanged.
 * Stations are not checked: see wh_station_t for what they must be. Do not move the simulator afterwards:
 * `link` and states point into it. */
wh_status_t wh_simulator_init(wh_simulator_t *simulator, const wh_grasp_config_t *config,
                              const wh_grasp_storage_t *storage, const wh_cell_t *cell)
    WH_SYMBOL(wh_simulator_init);

/* Replaces wh_physics_default, with which wh_simulator_init begins. Refuses what wh_physics_validate refuses,
 * and a run that has begun (WH_STATUS_OUT_OF_RANGE); the simulator is then unchanged. */
wh_status_t wh_simulator_set_physics(wh_simulator_t *simulator, const wh_physics_t *physics)
    WH_SYMBOL(wh_simulator_set_physics);

/* One slice: faults and vacuum turn the command into the grippers' inputs, the table steps, the cell judges
 * the releases, vacuum and holding follow, and `state` is filled in. Returns state->status.
 *
 * A refused command leaves everything as it was, but table.counters.refused counts it. Refused is what
 * wh_grasp_step refuses and, without an event, a gripper_count other than the table's and what
 * wh_faults_check refuses. With a null pointer (WH_STATUS_NULL_ARGUMENT) nothing is written or counted. `seq`
 * and `utime` are handed back; faults go by `seq`. Cost: wh_grasp_step and wh_cell_judge.
 */
wh_status_t wh_simulator_step(wh_simulator_t *simulator, const wh_command_t *command, wh_state_t *state)
    WH_SYMBOL(wh_simulator_step);

/* Fills in all of a state but utime, seq and status, without a step. Cost: linear in grippers. */
void wh_simulator_view(const wh_simulator_t *simulator, wh_state_t *state) WH_SYMBOL(wh_simulator_view);

/* wh_physics_state_hash of the simulator's state. */
uint64_t wh_simulator_hash(const wh_simulator_t *simulator) WH_SYMBOL(wh_simulator_hash);

WH_HEADER_END

#endif
