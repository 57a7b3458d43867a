/* Looks ahead: plays a command's segments on a copy of the cell before anything moves, and says what would collide.
 *
 * The copy begins where motion control last saw wafers and grippers, takes and lets go as the paper's rule has it, with vacuum
 * that is there at once, and knows nothing of faults to come.
 */
#ifndef WH_MCS_AHEAD_H
#define WH_MCS_AHEAD_H

#include "../layout/collision.h"
#include "rehearsal.h"

typedef struct {
    const wh_layout_t *layout;
    wh_simulator_t simulator;
    wh_collision_t collision;
    wh_wafer_t *wafers;
    wh_gripper_t grippers[WH_GRIPPERS];
    void *world_memory;
} wh_ahead_t;

/* Bytes that wh_ahead_init needs. */
size_t wh_ahead_bytes(const wh_layout_t *layout);

/* `memory`, aligned as malloc's, and the layout must outlive it. */
void wh_ahead_init(wh_ahead_t *ahead, const wh_layout_t *layout, void *memory);

/* A wh_look_ahead_t, its user a wh_ahead_t. */
bool wh_ahead_judge(void *user, const wh_track_t *track, const wh_state_t *state, bool first, char *reason);

#endif
