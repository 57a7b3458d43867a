/* Within the replay: how a recorded state is compared with the replayed one. */
#ifndef WH_LOG_REPLAY_INTERNAL_H
#define WH_LOG_REPLAY_INTERNAL_H

#include "replay.h"

/* True if an event is the collision check's, which a replay has not. */
bool wh_replay_is_collision(int32_t kind);

/* True if the states are not the same, bit for bit, but for their checks and events of the collision check.
 * `difference` then says where; else it is unchanged. */
bool wh_replay_differs(const wh_layout_t *layout, const waferhand_state *recorded,
                       const waferhand_state *replayed, wh_replay_difference_t *difference);

#endif
