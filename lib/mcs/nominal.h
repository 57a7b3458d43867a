/* A trial's cell as motion control believes it to be: the layout's own, without what the trial has drawn.
 *
 * A look ahead must not know a trial's errors, or a study would judge true wafers against taught stations. So
 * the layout's cell is stepped beside the real one, with the same commands and a vacuum that is there at
 * once. Where the two disagree on what a robot can tell, that is who holds a wafer, in which slot it lies,
 * and what an edge grip does, the real cell is right: the wafer then lies in the middle of that slot as it
 * was taught, or as it is on its gripper.
 */
#ifndef WH_MCS_NOMINAL_H
#define WH_MCS_NOMINAL_H

#include "../layout/grips.h"
#include "../sim/simulator.h"

typedef struct {
    const wh_layout_t *layout; /* as taught */
    const wh_layout_t *real;   /* with the trial's errors */
    wh_simulator_t simulator;
    wh_machine_cache_t cache;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_gripper_t next_grippers[WH_GRIPPERS];
    wh_grips_room_t grips;
    wh_wafer_t *next; /* as many as `wafers` */
    wh_wafer_t wafers[];
} wh_nominal_t;

/* What a wh_nominal_t takes. */
size_t wh_nominal_bytes(const wh_layout_t *layout);

/* Begins a run in memory of wh_nominal_bytes, aligned as malloc's. The layouts must outlive it. Null if the
 * table cannot be set up, which a layout that was read never causes. */
wh_nominal_t *wh_nominal_begin(void *memory, const wh_layout_t *layout, const wh_layout_t *real);

/* Steps the command of a slice, as motion control sent it. Cost: wh_simulator_step. */
void wh_nominal_slice(wh_nominal_t *nominal, const wh_command_t *command);

/* Brings the believed cell in line with what a robot can tell of the true one; `wafers`, `grippers` and
 * `physics` of `believed` then are its own, the rest is the truth's. If no table can be in such a state, all
 * is the truth's. Cost: wafers times stations. */
void wh_nominal_believe(wh_nominal_t *nominal, const wh_state_t *truth, wh_state_t *believed);

#endif
