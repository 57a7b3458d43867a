/* Poses and faults in messages: the parts that several of them share. Nothing here allocates or checks. */
#ifndef WH_LINK_FAULT_MESSAGE_H
#define WH_LINK_FAULT_MESSAGE_H

#include <waferhand_fault.h>
#include <waferhand_fault_slot.h>

#include "../sim/faults.h"

void wh_link_put_pose(const wh_pose_t *pose, double position[3], double rotation[9]);
wh_pose_t wh_link_take_pose(const double position[3], const double rotation[9]);

void wh_link_put_fault(const wh_fault_t *fault, waferhand_fault *out);
wh_fault_t wh_link_take_fault(const waferhand_fault *in);

void wh_link_put_slot(const wh_fault_slot_t *slot, waferhand_fault_slot *out);
wh_fault_slot_t wh_link_take_slot(const waferhand_fault_slot *in);

#endif
