/* The ways of a run's grippers, by stretches of slices. In most stretches a held wafer cannot go through a
 * slot or another wafer; their slices need no check one by one. */
#ifndef WH_TRIAL_DECISIONS_WAYS_H
#define WH_TRIAL_DECISIONS_WAYS_H

#include "decisions.h"

/* The slices in a stretch. */
#define WH_DECISIONS_STRETCH 64

/* True if both poses are equal, number by number. */
bool wh_decisions_is_still(const wh_pose_t *from, const wh_pose_t *to);

/* Adds a gripper's pose in slice `slice`, the last one kept, to its stretch. */
void wh_decisions_widen(wh_decisions_t *decisions, size_t gripper, int64_t slice);

/* False if a wafer that this gripper holds like this goes through no slot of the cell, neither in the
 * stretch that has the slice nor on the way to its first slice. `at` is the gripper's pose in the trial and
 * `run` its pose in the run, both in one slice. Cost: about 30 products for each station. */
bool wh_decisions_may_pass(const wh_decisions_t *decisions, const wh_cell_t *cell, size_t gripper,
                           int64_t slice, const wh_vec3_t *gripper_from_wafer, const wh_vec3_t *at,
                           const wh_vec3_t *run);

/* False if this gripper, with the wafer that it holds or with its empty blade, goes through no other wafer in
 * the stretch that has the slice: see wh_cell_meets. `state` is the trial's at its beginning. By gripper,
 * `slack` is how far its places in the trial are at most from those in the run. Cost: about 40 products for
 * each wafer. */
bool wh_decisions_may_meet(const wh_decisions_t *decisions, const wh_cell_t *cell, const wh_state_t *state,
                           size_t gripper, int64_t slice, const double slack[WH_GRIPPERS]);

#endif
