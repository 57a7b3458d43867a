/* A robot's doing at an instant, or the reason why it waits. */
#ifndef WH_FLOW_WAITING_H
#define WH_FLOW_WAITING_H

#include "state.h"

/* A robot's time. */
typedef enum {
    WH_FLOW_ROBOT_EMPTY_WAY,
    WH_FLOW_ROBOT_LOADED_WAY,
    WH_FLOW_ROBOT_PICK,
    WH_FLOW_ROBOT_PLACE,
    WH_FLOW_ROBOT_SWAP,
    WH_FLOW_ROBOT_DOOR,
    WH_FLOW_ROBOT_WAITS_WAFER, /* for one to be done */
    WH_FLOW_ROBOT_WAITS_PLACE, /* for one to be empty */
    WH_FLOW_ROBOT_WAITS_CLEAN,
    WH_FLOW_ROBOT_WAITS_PUMP,
    WH_FLOW_ROBOT_WAITS_DOWN,
    WH_FLOW_ROBOT_WAITS_ROBOT, /* for another blade to come out, or a door to shut behind it */
    WH_FLOW_ROBOT_IDLE,        /* nothing to do */
    WH_FLOW_ROBOT_CLASSES
} wh_flow_robot_class_t;

/* The class of the time from now on until something ends. */
wh_flow_robot_class_t wh_flow_robot_class(const wh_flow_state_t *state, int32_t robot);

#endif
