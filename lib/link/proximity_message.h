/* The values of the paper's Fig. 9 as a message. */
#ifndef WH_LINK_PROXIMITY_MESSAGE_H
#define WH_LINK_PROXIMITY_MESSAGE_H

#include "messages.h"

/* Each gripper of the state against the wafer whose origin is nearest to its own; held ones count too. Cost: linear in
 * grippers times wafers. */
void wh_link_proximity_to_message(const wh_state_t *state, const wh_link_identity_t *identity,
                                  const wh_tolerance_t *tolerance, waferhand_proximity *message);

#endif
