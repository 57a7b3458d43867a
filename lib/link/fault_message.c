#include "fault_message.h"

void wh_link_put_pose(const wh_pose_t *pose, double position[3], double rotation[9]) {
    position[0] = pose->r.x;
    position[1] = pose->r.y;
    position[2] = pose->r.z;
    for (size_t i = 0; i < 9; ++i) {
        rotation[i] = pose->R.m[i / 3][i % 3];
    }
}

wh_pose_t wh_link_take_pose(const double position[3], const double rotation[9]) {
    wh_pose_t pose;
    pose.r = wh_vec3(position[0], position[1], position[2]);
    for (size_t i = 0; i < 9; ++i) {
        pose.R.m[i / 3][i % 3] = rotation[i];
    }
    return pose;
}

void wh_link_put_fault(const wh_fault_t *fault, waferhand_fault *out) {
    out->kind = (int32_t)fault->kind;
    out->target = fault->target;
    out->other = fault->other;
    out->value = fault->value;
    wh_link_put_pose(&fault->offset, out->position, out->rotation);
    out->from_seq = fault->from;
    out->until_seq = fault->until;
}

wh_fault_t wh_link_take_fault(const waferhand_fault *in) {
    wh_fault_t fault;
    fault.kind = (wh_fault_kind_t)in->kind;
    fault.target = in->target;
    fault.other = in->other;
    fault.value = in->value;
    fault.offset = wh_link_take_pose(in->position, in->rotation);
    fault.from = in->from_seq;
    fault.until = in->until_seq;
    return fault;
}

void wh_link_put_slot(const wh_fault_slot_t *slot, waferhand_fault_slot *out) {
    out->phase = (int32_t)slot->phase;
    wh_link_put_fault(&slot->fault, &out->it);
    wh_link_put_pose(&slot->before, out->before_position, out->before_rotation);
    wh_link_put_pose(&slot->placed, out->placed_position, out->placed_rotation);
}

wh_fault_slot_t wh_link_take_slot(const waferhand_fault_slot *in) {
    wh_fault_slot_t slot;
    slot.phase = (wh_fault_phase_t)in->phase;
    slot.fault = wh_link_take_fault(&in->it);
    slot.before = wh_link_take_pose(in->before_position, in->before_rotation);
    slot.placed = wh_link_take_pose(in->placed_position, in->placed_rotation);
    return slot;
}
