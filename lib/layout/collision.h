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

/* Makes the check the simulator's observer. From where the first step that it sees has brought everything, it
 * judges the others: also after a restore, when it is to be attached anew. `memory` is aligned as malloc's;
 * layout, simulator and memory must outlive the check. */
void wh_collision_attach(wh_collision_t *collision, const wh_layout_t *layout, wh_simulator_t *simulator,
                         void *memory);

/* For who is not the simulator, and hears of each step by its state alone: judges the same, and keeps
 * clearances and curves; what it finds is reported by the simulator. `layout` and `memory` as above. */
void wh_collision_observe(wh_collision_t *collision, const wh_state_t *state);

/* The end-effector is where a gripper on it says: a fault may keep it from where the axes should have brought
 * it. False, and nothing written, when no gripper is on the robot. */
bool wh_collision_effector(const wh_machine_t *machine, const wh_pose_t base_from_grippers[],
                           wh_pose_t *base_from_effector);

#endif
