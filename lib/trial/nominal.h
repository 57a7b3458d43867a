/* A trial's cell as motion control believes it to be: the layout's own, without the drawn errors.
 *
 * A look ahead must not know a trial's errors, or a study would judge true wafers against taught stations. So
 * the layout's cell is stepped beside the real one, with the same commands and an immediate vacuum. A robot
 * can tell which gripper holds a wafer, in which slot it lies, and what an edge grip does. If the two cells
 * disagree on that, the real cell is right: the wafer then lies in the middle of the taught slot, or as it is
 * on its gripper.
 */
#ifndef WH_TRIAL_NOMINAL_H
#define WH_TRIAL_NOMINAL_H

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

/* The size of a wh_nominal_t and its arrays. */
size_t wh_nominal_bytes(const wh_layout_t *layout);

/* Begins a run in memory of wh_nominal_bytes, aligned as malloc's. The layouts must outlive it. Null if the
 * table cannot be set up; that never happens with a layout that was read. */
wh_nominal_t *wh_nominal_begin(void *memory, const wh_layout_t *layout, const wh_layout_t *real);

/* Steps the command of a slice, as motion control sent it. Cost: wh_simulator_step. */
void wh_nominal_slice(wh_nominal_t *nominal, const wh_command_t *command);

/* Corrects the believed cell by what a robot can tell of the true one. `wafers`, `grippers` and `physics` of
 * `believed` are then its own, the rest comes from `truth`. If no table can be in such a state, all comes
 * from `truth`. Cost: wafers times stations. */
void wh_nominal_believe(wh_nominal_t *nominal, const wh_state_t *truth, wh_state_t *believed);

#endif
