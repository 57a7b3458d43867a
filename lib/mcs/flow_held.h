/* HOLD and CONTINUE of robots by requests, while a flow carries wafers. The flow's side is flow/held.h; here
 * are the segments, which are held back before they begin. */
#ifndef WH_MCS_FLOW_HELD_H
#define WH_MCS_FLOW_HELD_H

#include "state.h"

/* Room for the reason of a refusal. */
#define WH_MCS_HOLD_BYTES 400

/* From within a slice: this robot of the flow is held after the segment that runs, or goes on. Null: all of
 * them. Refused with a reason, and nothing changes: no flow is played, it has no such robot, or all that were
 * meant are held already, or none is. */
wh_status_t wh_mcs_hold_robot(wh_mcs_t *mcs, const char *name, bool is_held, char reason[WH_MCS_HOLD_BYTES]);

/* True if a request holds this robot of the flow, timed ones behind the layout's. */
bool wh_mcs_is_robot_held(const wh_mcs_t *mcs, const char *name);

/* The names of the robots that are held, with commas between them; empty: none is. */
void wh_mcs_name_held(const wh_mcs_t *mcs, char text[WH_MCS_HOLD_BYTES]);

/* True if the lane's segment has not begun, for its robot is held. */
bool wh_mcs_is_held_back(const wh_mcs_t *mcs, const wh_lane_t *lane);

/* The lane's segment was begun: the flow hears of one that is held back. */
void wh_mcs_note_held_back(const wh_mcs_t *mcs, const wh_lane_t *lane);

/* A STOP of these axes, bits, has come, or the flow is over: their robots are held no more. */
void wh_mcs_release_stopped(wh_mcs_t *mcs, uint32_t axes);

#endif
