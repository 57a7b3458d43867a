/* The collision check of a run: a world made from a layout, looking at each step of a simulator. */
#ifndef WH_LAYOUT_COLLISION_H
#define WH_LAYOUT_COLLISION_H

#include "../sim/simulator.h"
#include "layout.h"

/* Must not be moved once attached. All zero: no check. */
typedef struct {
    const wh_layout_t *layout;
    void *memory;
    wh_world_t *world; /* null before the first step */
    wh_pose_t base_from_effector;
} wh_collision_t;

/* Bytes that wh_collision_attach needs. */
size_t wh_collision_bytes(const wh_layout_t *layout);

/* Makes the check the simulator's observer. The first step that it sees only tells where everything is; each
 * later step is judged. After a restore it is to be attached anew. `memory` is aligned as malloc's; layout,
 * simulator and memory must outlive the check. */
void wh_collision_attach(wh_collision_t *collision, const wh_layout_t *layout, wh_simulator_t *simulator,
                         void *memory);

/* For a simulator in another process: the same check, fed with the states that it sends. It keeps clearances
 * and curves; what is hit, the simulator reports. Set `layout` and `memory` before, as above. */
void wh_collision_observe(wh_collision_t *collision, const wh_state_t *state);

/* Finds the end-effector by the first gripper on it, for a fault may keep both from where the axes should
 * have brought them. False, and nothing written, if no gripper is on the robot. */
bool wh_collision_effector(const wh_machine_t *machine, const wh_pose_t base_from_grippers[],
                           wh_pose_t *base_from_effector);

#endif
