/* The collision check of a run: a world made from a layout, looking at each step of a simulator. */
#ifndef WH_LAYOUT_COLLISION_H
#define WH_LAYOUT_COLLISION_H

#include "../sim/simulator.h"
#include "links.h"

/* Must not be moved once attached. All zero: no check. */
typedef struct {
    const wh_layout_t *layout;
    void *memory;
    wh_world_t *world; /* null before the first step */
    wh_links_t links;
    const wh_physics_state_t *physics; /* of the observed simulator */
    /* wh_command_from_track makes all its commands, with the layout's machine: their poses are those of
     * their axes. False after wh_collision_attach. */
    bool is_told;
} wh_collision_t;

/* Bytes that wh_collision_attach needs. */
size_t wh_collision_bytes(const wh_layout_t *layout);

/* Makes the check the simulator's observer. The first step that it sees only tells where everything is; each
 * later step is judged. After a restore, attach it anew. `memory` is aligned as malloc's; layout, simulator
 * and memory must outlive the check. */
void wh_collision_attach(wh_collision_t *collision, const wh_layout_t *layout, wh_simulator_t *simulator,
                         void *memory);

/* Slices up to this one were left out, with these axes at its end: nobody judges the way there. */
void wh_collision_jump(wh_collision_t *collision, uint64_t slice, const wh_real_t axes[],
                       const wh_state_t *state);

/* The check for a simulator in another process. It takes the states that the simulator sends, and the
 * command's axes of the machine, or null if they are not known. It keeps clearances and curves; the simulator
 * itself reports hits. Set `layout` and `memory` before, as above, and `links` by wh_links_home. */
void wh_collision_observe(wh_collision_t *collision, const wh_real_t axes[], const wh_state_t *state);

#endif
