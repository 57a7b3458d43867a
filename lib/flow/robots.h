/* Robots carry out orders: the beginnings and ends of their actions. */
#ifndef WH_FLOW_ROBOTS_H
#define WH_FLOW_ROBOTS_H

#include "state.h"

/* Begins what the order asks of an idle robot: the way to where it must stand, or the pick, placing or
 * swap. False if nothing can begin at this instant. */
bool wh_flow_robot_begin(wh_flow_state_t *state, int32_t robot, const wh_flow_order_t *order);

/* Begins the placing for which a robot waits in front of a place. False if it cannot begin yet. */
bool wh_flow_robot_place(wh_flow_state_t *state, int32_t robot);

/* Ends the robot's action, whose time is over. */
void wh_flow_robot_end(wh_flow_state_t *state, int32_t robot);

#endif
