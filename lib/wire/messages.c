#include "messages.h"

#include <string.h>

#include "../layout/grips.h"
#include "../record/counterpart.h"

/* -------------------------------------------------------------------------------------------------- parts */

static void put_vec3(const wh_vec3_t *v, double out[3]) {
    out[0] = v->x;
    out[1] = v->y;
    out[2] = v->z;
}

static wh_vec3_t take_vec3(const double in[3]) {
    return wh_vec3(in[0], in[1], in[2]);
}

void wh_link_put_pose(const wh_pose_t *pose, double position[3], double rotation[9]) {
    put_vec3(&pose->r, position);
    memcpy(rotation, pose->R.m, sizeof pose->R.m);
}

wh_pose_t wh_link_take_pose(const double position[3], const double rotation[9]) {
    wh_pose_t pose = {.r = take_vec3(position)};
    memcpy(pose.R.m, rotation, sizeof pose.R.m);
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
    return (wh_fault_t){.kind = (wh_fault_kind_t)in->kind,
                        .target = in->target,
                        .other = in->other,
                        .value = in->value,
                        .offset = wh_link_take_pose(in->position, in->rotation),
                        .from = in->from_seq,
                        .until = in->until_seq};
}

static void put_measured(const wh_proximity_t *p, waferhand_measurement *out) {
    put_vec3(&p->dr, out->dr);
    out->n1_proj_n2 = p->n1_proj_n2;
    out->dr_proj_z = p->dr_proj_z;
    put_vec3(&p->dr_proj_xy, out->dr_proj_xy);
    out->dr_proj_xy_norm = p->dr_proj_xy_norm;
}

static void take_measured(const waferhand_measurement *in, const wh_tolerance_t *tolerance,
                          wh_proximity_t *p) {
    p->dr = take_vec3(in->dr);
    p->n1_proj_n2 = in->n1_proj_n2;
    p->dr_proj_z = in->dr_proj_z;
    p->dr_proj_xy = take_vec3(in->dr_proj_xy);
    p->dr_proj_xy_norm = in->dr_proj_xy_norm;
    wh_proximity_judge(tolerance, p);
}

static void put_encounter(const wh_encounter_t *encounter, waferhand_encounter *out) {
    *out = (waferhand_encounter){.wafer = WH_NONE, .holder = WH_NONE};
    if (encounter->wafer != WH_NONE) {
        out->wafer = encounter->wafer;
        out->holder = encounter->holder;
        out->slice = (int64_t)wh_encounter_stamp(encounter);
        put_measured(&encounter->measured, &out->measured);
    }
}

static void take_encounter(const waferhand_encounter *in, const wh_tolerance_t *tolerance,
                           wh_encounter_t *out) {
    out->wafer = in->wafer;
    out->holder = in->holder;
    wh_encounter_take_stamp(out, (uint64_t)in->slice);
    take_measured(&in->measured, tolerance, &out->measured);
}

/* ------------------------------------------------------------------------------------------------ command */

void wh_link_command_to_message(const wh_command_t *command, const wh_link_identity_t *identity,
                                bool lockstep, waferhand_command *message) {
    memset(message, 0, sizeof *message);
    message->utime = command->utime;
    message->seq = command->seq;
    message->run = identity->run;
    message->layout_hash = (int64_t)identity->layout_hash;
    message->lockstep = lockstep ? 1 : 0;
    message->gripper_count = (int32_t)command->gripper_count;
    message->axis_count = (int32_t)command->axis_count;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        wh_link_put_pose(&command->grippers[g].base_from_gripper, message->gripper_position[g],
                         message->gripper_rotation[g]);
        message->valve[g] = command->grippers[g].valve;
    }
    memcpy(message->axis_position, command->axes, sizeof message->axis_position);
    message->fault_count = (int32_t)command->fault_count;
    for (size_t i = 0; i < command->fault_count; ++i) {
        message->fault_index[i] = command->faults[i].index;
        wh_link_put_fault(&command->faults[i].fault, &message->faults[i]);
    }
    message->scan_order = (int32_t)command->scan.kind;
    message->scan_gripper = command->scan.gripper;
    message->scan_count = command->scan.count;
    message->scan_first = command->scan.first;
    message->latch_order = (int32_t)command->latch.kind;
    message->latch_first = command->latch.first;
    message->latch_beams = command->latch.count;
}

wh_status_t wh_link_command_from_message(const waferhand_command *message, wh_command_t *command) {
    if (message->gripper_count < 1 || message->gripper_count > WH_GRIPPERS || message->axis_count < 0 ||
        message->axis_count > WH_AXES || message->fault_count < 0 ||
        message->fault_count > WH_COMMAND_FAULTS) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    command->utime = message->utime;
    command->seq = message->seq;
    command->gripper_count = (size_t)message->gripper_count;
    command->axis_count = (size_t)message->axis_count;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        command->grippers[g].base_from_gripper =
            wh_link_take_pose(message->gripper_position[g], message->gripper_rotation[g]);
        command->grippers[g].valve = message->valve[g];
    }
    memcpy(command->axes, message->axis_position, sizeof command->axes);
    command->scan = (wh_scan_order_t){(wh_scan_order_kind_t)message->scan_order, message->scan_gripper,
                                      message->scan_count, message->scan_first};
    command->latch = (wh_latch_order_t){(wh_latch_order_kind_t)message->latch_order, message->latch_first,
                                        message->latch_beams};
    command->fault_count = (size_t)message->fault_count;
    for (size_t i = 0; i < command->fault_count; ++i) {
        command->faults[i].index = message->fault_index[i];
        command->faults[i].fault = wh_link_take_fault(&message->faults[i]);
    }
    return WH_OK;
}

/* -------------------------------------------------------------------------------------------------- state */

static void put_gripper(const wh_gripper_t *gripper, waferhand_gripper_state *out) {
    memset(out, 0, sizeof *out);
    wh_link_put_pose(&gripper->base_from_gripper, out->position, out->rotation);
    wh_link_put_pose(&gripper->gripper_from_wafer, out->wafer_position, out->wafer_rotation);
    out->wafer = gripper->wafer;
    out->valve = gripper->valve;
    put_encounter(&gripper->approach, &out->approach);
    put_encounter(&gripper->contest, &out->contest);
}

static void put_condition(const wh_physics_state_t *condition, size_t g, waferhand_gripper_state *out) {
    out->valve_command = condition->vacuum[g].command;
    out->valve_told = condition->told[g];
    out->vacuum_level = condition->vacuum[g].level;
    out->vacuum_on = condition->vacuum[g].on ? 1 : 0;
    out->grip_s = condition->vacuum[g].waits;
    out->slips = condition->carry[g].slips ? 1 : 0;
    out->positions_known = condition->carry[g].known;
    put_vec3(&condition->carry[g].before[0], out->wafer_before[0]);
    put_vec3(&condition->carry[g].before[1], out->wafer_before[1]);
}

static void put_grip(const wh_grip_state_t *grip, waferhand_gripper_state *out) {
    if (grip->phase == WH_GRIP_OPEN) {
        return;
    }
    out->grip_phase = (int8_t)grip->phase;
    out->grip_wafer = grip->wafer;
    out->grip_s = grip->s;
    out->grip_excess = grip->excess;
    if (grip->phase == WH_GRIP_CLOSING && grip->wafer != WH_NONE) {
        out->grip_begin[0] = grip->x;
        out->grip_begin[1] = grip->y;
        out->grip_lying[0] = grip->lying.x;
        out->grip_lying[1] = grip->lying.y;
        out->grip_notch[0] = grip->lying.notch_x;
        out->grip_notch[1] = grip->lying.notch_y;
    }
}

static void put_event(const wh_event_t *event, waferhand_event *out) {
    out->kind = (int32_t)event->kind;
    out->wafer = event->wafer;
    out->gripper = event->gripper;
    out->other = event->other;
    out->status = (int32_t)event->status;
    out->measured_slice = (int64_t)event->measured_slice;
    out->height = event->height;
    out->value = event->value;
    out->limit = event->limit;
    memcpy(out->parts, event->parts, sizeof out->parts);
    put_vec3(&event->at, out->at);
    put_measured(&event->measured, &out->measured);
    out->face = event->face == WH_FACE_FRONT ? 1 : 0;
    if (event->kind == WH_EVENT_NEAR_MISS) {
        out->limit = wh_real_abs(event->measured.dr_proj_z) + event->measured.margin_projz;
    }
}

static void put_arrays(const wh_state_t *state, wh_link_state_t *room) {
    for (size_t w = 0; w < state->wafer_count; ++w) {
        wh_link_put_pose(&state->wafers[w].base_from_wafer, room->wafers[w].position,
                         room->wafers[w].rotation);
        room->wafers[w].holder = state->wafers[w].holder;
        room->wafers[w].face = wh_layout_is_face_down(&state->wafers[w].base_from_wafer) ? 1 : 0;
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        put_gripper(&state->grippers[g], &room->grippers[g]);
        if (state->physics) {
            put_condition(state->physics, g, &room->grippers[g]);
            put_grip(&state->physics->grips[g], &room->grippers[g]);
        }
    }
    for (size_t e = 0; e < state->event_count; ++e) {
        put_event(&state->events[e], &room->events[e]);
    }
    for (size_t i = 0; state->physics && i < (size_t)room->message.fault_count; ++i) {
        const wh_fault_slot_t *slot = &state->physics->faults.slots[i];
        waferhand_fault_slot *out = &room->faults[i];
        out->phase = (int32_t)slot->phase;
        wh_link_put_fault(&slot->fault, &out->it);
        wh_link_put_pose(&slot->before, out->before_position, out->before_rotation);
        wh_link_put_pose(&slot->placed, out->placed_position, out->placed_rotation);
    }
}

static void put_scan(const wh_scan_t *scan, wh_link_state_t *room) {
    waferhand_state *message = &room->message;
    message->scan_number = (int32_t)scan->number;
    message->scan_armed = scan->armed ? 1 : 0;
    message->scan_gripper = scan->gripper;
    message->scan_count = scan->count;
    message->scan_first = scan->first;
    message->scan_taken = scan->taken;
    message->scan_turn = scan->turn;
    message->sample_count = scan->sample_count;
    memcpy(room->samples, scan->samples, sizeof room->samples);
}

static void put_doors(const wh_doors_t *doors, wh_link_state_t *room) {
    room->message.door_count = doors->count;
    room->message.doors = room->doors;
    memcpy(room->doors, doors->at, sizeof room->doors);
}

static void put_latch_list(const wh_latch_t latches[], int32_t count, waferhand_latch out[]) {
    for (int32_t i = 0; i < count; ++i) {
        out[i] =
            (waferhand_latch){latches[i].beam, (int32_t)latches[i].edge, latches[i].slice, latches[i].part};
    }
}

static void put_latches(const wh_latches_t *latches, wh_link_state_t *room) {
    room->message.latching = (waferhand_latching){.waiting_count = latches->waiting_count,
                                                  .latch_count = latches->latch_count,
                                                  .number = (int32_t)latches->number,
                                                  .armed = latches->armed ? 1 : 0,
                                                  .first = latches->first,
                                                  .beams = latches->count,
                                                  .slice = latches->slice,
                                                  .crossings = (int32_t)latches->crossings,
                                                  .lost = (int32_t)latches->lost,
                                                  .broken = (int32_t)latches->broken,
                                                  .waiting = room->waiting,
                                                  .latches = room->latches};
    put_latch_list(latches->waiting, latches->waiting_count, room->waiting);
    put_latch_list(latches->latches, latches->latch_count, room->latches);
}

void wh_link_state_to_message(const wh_state_t *state, const wh_link_identity_t *identity, uint64_t hash,
                              int64_t missed, wh_link_state_t *room) {
    static const wh_scan_t none;
    static const wh_latches_t unarmed;
    static const wh_doors_t no_doors;
    waferhand_state *message = &room->message;
    message->utime = state->utime;
    message->seq = state->seq;
    message->run = identity->run;
    message->layout_hash = (int64_t)identity->layout_hash;
    message->status = (int32_t)state->status;
    message->wafer_count = (int32_t)state->wafer_count;
    message->gripper_count = (int32_t)state->gripper_count;
    message->event_count = (int32_t)state->event_count;
    message->fault_count = state->physics ? (int32_t)state->physics->faults.count : 0;
    message->hash = (int64_t)hash;
    message->missed = missed;
    message->events_lost = state->has_lost_events ? 1 : 0;
    message->sensors = (int32_t)state->sensors;
    message->wafers = room->wafers;
    message->grippers = room->grippers;
    message->events = room->events;
    message->faults = room->faults;
    message->samples = room->samples;
    message->check = 0;
    put_scan(state->physics ? &state->physics->scan : &none, room);
    put_doors(state->physics ? &state->physics->doors : &no_doors, room);
    put_latches(state->physics ? &state->physics->latches : &unarmed, room);
    put_arrays(state, room);
}

static void take_gripper(const waferhand_gripper_state *in, const wh_tolerance_t *tolerance,
                         wh_gripper_t *out) {
    out->base_from_gripper = wh_link_take_pose(in->position, in->rotation);
    out->gripper_from_wafer = wh_link_take_pose(in->wafer_position, in->wafer_rotation);
    out->wafer = in->wafer;
    out->valve = in->valve;
    take_encounter(&in->approach, tolerance, &out->approach);
    take_encounter(&in->contest, tolerance, &out->contest);
}

/* True for a gripper whose plunger is at home, or that has none: its `grip_s` tells how long its vacuum
 * sensor waits. */
static bool tells_wait(const waferhand_gripper_state *in) {
    return in->grip_phase == (int8_t)WH_GRIP_OPEN;
}

static bool wait_fits(const waferhand_gripper_state *in) {
    const double slices = in->grip_s;
    return !tells_wait(in) ||
           (slices >= 0 && slices <= WH_VACUUM_DEBOUNCE && !(slices > (double)(uint16_t)slices));
}

static void take_condition(const waferhand_gripper_state *in, size_t g, wh_physics_state_t *condition) {
    condition->vacuum[g].command = in->valve_command;
    condition->told[g] = in->valve_told;
    condition->vacuum[g].level = in->vacuum_level;
    condition->vacuum[g].on = in->vacuum_on != 0;
    const double slices = tells_wait(in) && wait_fits(in) ? in->grip_s : 0;
    condition->vacuum[g].waits = (uint16_t)slices;
    condition->carry[g].slips = in->slips != 0;
    condition->carry[g].known = in->positions_known;
    condition->carry[g].before[0] = take_vec3(in->wafer_before[0]);
    condition->carry[g].before[1] = take_vec3(in->wafer_before[1]);
}

/* The layout fills in the rest: wh_layout_complete_grips. */
static void take_grip(const waferhand_gripper_state *in, wh_grip_state_t *grip) {
    memset(grip, 0, sizeof *grip);
    grip->phase = (wh_grip_phase_t)in->grip_phase;
    grip->wafer = in->grip_wafer;
    grip->s = tells_wait(in) ? 0 : in->grip_s;
    grip->excess = in->grip_excess;
    grip->x = in->grip_begin[0];
    grip->y = in->grip_begin[1];
    grip->lying.x = in->grip_lying[0];
    grip->lying.y = in->grip_lying[1];
    grip->lying.notch_x = in->grip_notch[0];
    grip->lying.notch_y = in->grip_notch[1];
}

/* A near miss between two slices was judged by a smaller window; its limit tells that. */
static void take_near_miss(double limit, const wh_tolerance_t *tolerance, wh_event_t *out) {
    wh_tolerance_t inside = *tolerance;
    inside.projz *= WH_SWEEP_INSIDE;
    out->limit = 0;
    if (limit > 0 && limit < (inside.projz + tolerance->projz) / 2) {
        wh_proximity_judge(&inside, &out->measured);
    }
}

static void take_event(const waferhand_event *in, int64_t seq, const wh_tolerance_t *tolerance,
                       wh_event_t *out) {
    out->kind = (wh_event_kind_t)in->kind;
    out->slice = (uint64_t)seq;
    out->measured_slice = (uint64_t)in->measured_slice;
    out->wafer = in->wafer;
    out->gripper = in->gripper;
    out->other = in->other;
    out->status = (wh_status_t)in->status;
    out->height = in->height;
    out->value = in->value;
    out->limit = in->limit;
    memcpy(out->parts, in->parts, sizeof out->parts);
    out->at = take_vec3(in->at);
    out->face = in->face == 1 ? WH_FACE_FRONT : WH_FACE_BACK;
    take_measured(&in->measured, tolerance, &out->measured);
    if (out->kind == WH_EVENT_NEAR_MISS) {
        take_near_miss(in->limit, tolerance, out);
    }
}

static void take_scan(const waferhand_state *message, wh_scan_t *scan) {
    memset(scan, 0, sizeof *scan);
    scan->number = (uint32_t)message->scan_number;
    scan->armed = message->scan_armed != 0;
    scan->gripper = message->scan_gripper;
    scan->count = message->scan_count;
    scan->first = message->scan_first;
    scan->taken = message->scan_taken;
    scan->turn = message->scan_turn;
    scan->sample_count = message->sample_count;
    for (int32_t i = 0; i < message->sample_count; ++i) {
        scan->samples[i] = message->samples[i];
    }
}

static void take_latch_list(const waferhand_latch in[], int32_t count, wh_latch_t latches[]) {
    for (int32_t i = 0; i < count; ++i) {
        latches[i] = (wh_latch_t){in[i].beam, (wh_crossing_edge_t)in[i].edge, in[i].slice, in[i].part};
    }
}

static void take_latches(const waferhand_latching *message, wh_latches_t *latches) {
    memset(latches, 0, sizeof *latches);
    latches->number = (uint32_t)message->number;
    latches->armed = message->armed != 0;
    latches->first = message->first;
    latches->count = message->beams;
    latches->slice = message->slice;
    latches->crossings = (uint32_t)message->crossings;
    latches->lost = (uint32_t)message->lost;
    latches->broken = (uint32_t)message->broken;
    latches->waiting_count = message->waiting_count;
    latches->latch_count = message->latch_count;
    take_latch_list(message->waiting, message->waiting_count, latches->waiting);
    take_latch_list(message->latches, message->latch_count, latches->latches);
}

/* True if `other` has a value that this kind of event allows. */
static bool other_fits(const waferhand_event *event, const waferhand_state *message) {
    if (event->kind == WH_EVENT_HANDED_OVER || event->kind == WH_EVENT_CONTESTED) {
        return wh_is_index(event->other, (size_t)message->gripper_count);
    }
    if (event->kind == WH_EVENT_SLOT_OCCUPIED) {
        return wh_is_index(event->other, (size_t)message->wafer_count);
    }
    if (event->kind == WH_EVENT_PUSHED_THROUGH) {
        return wh_is_index(event->other, (size_t)message->wafer_count) ||
               (event->other == WH_NONE && event->wafer != WH_NONE);
    }
    return event->other == WH_NONE;
}

/* True if wafer and gripper have values that this kind of event allows. The collision check and the faults
 * may name none. */
static bool names_fit(const waferhand_event *event, const waferhand_state *message) {
    static const uint32_t any = 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED | 1U << WH_EVENT_TOO_CLOSE |
                                1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    const bool may_lack = (any >> (uint32_t)event->kind & 1U) != 0;
    const bool no_wafer = event->wafer == WH_NONE && (may_lack || event->kind == WH_EVENT_BAD_INPUT ||
                                                      event->kind == WH_EVENT_PUSHED_THROUGH);
    const bool wafer_fits =
        event->kind != WH_EVENT_BAD_INPUT && wh_is_index(event->wafer, (size_t)message->wafer_count);
    const bool no_gripper = event->gripper == WH_NONE && may_lack;
    return (no_wafer || wafer_fits) &&
           (no_gripper || wh_is_index(event->gripper, (size_t)message->gripper_count));
}

static bool part_fits(int32_t part) {
    return part >= WH_NONE && part < WH_LINK_PARTS;
}

/* True if a step could have yielded the event. The event's readers trust its indices. */
static bool event_fits(const waferhand_event *event, const waferhand_state *message) {
    return event->kind >= 0 && event->kind < WH_EVENT_KINDS && names_fit(event, message) &&
           other_fits(event, message) && part_fits(event->parts[0]) && part_fits(event->parts[1]) &&
           event->measured_slice >= 0 && event->measured_slice <= message->seq &&
           (event->face == 0 || event->face == 1);
}

static bool take_arrays(const waferhand_state *message, const wh_tolerance_t *tolerance,
                        wh_link_arrays_t *arrays) {
    bool sound = true;
    for (int32_t w = 0; w < message->wafer_count; ++w) {
        arrays->wafers[w].base_from_wafer =
            wh_link_take_pose(message->wafers[w].position, message->wafers[w].rotation);
        arrays->wafers[w].holder = message->wafers[w].holder;
        arrays->wafers[w].released_by = WH_NONE;
    }
    for (int32_t g = 0; g < message->gripper_count; ++g) {
        take_gripper(&message->grippers[g], tolerance, &arrays->grippers[g]);
        take_condition(&message->grippers[g], (size_t)g, &arrays->physics);
        take_grip(&message->grippers[g], &arrays->physics.grips[g]);
        sound = wait_fits(&message->grippers[g]) && sound;
    }
    for (int32_t e = 0; e < message->event_count; ++e) {
        take_event(&message->events[e], message->seq, tolerance, &arrays->events[e]);
        sound = event_fits(&message->events[e], message) && sound;
    }
    take_scan(message, &arrays->physics.scan);
    take_latches(&message->latching, &arrays->physics.latches);
    memset(&arrays->physics.doors, 0, sizeof arrays->physics.doors);
    arrays->physics.doors.count = message->door_count;
    for (int32_t d = 0; d < message->door_count; ++d) {
        arrays->physics.doors.at[d] = message->doors[d];
    }
    wh_faults_clear(&arrays->physics.faults);
    arrays->physics.faults.count = (size_t)message->fault_count;
    for (int32_t i = 0; i < message->fault_count; ++i) {
        const waferhand_fault_slot *in = &message->faults[i];
        arrays->physics.faults.slots[i] =
            (wh_fault_slot_t){.phase = (wh_fault_phase_t)in->phase,
                              .fault = wh_link_take_fault(&in->it),
                              .before = wh_link_take_pose(in->before_position, in->before_rotation),
                              .placed = wh_link_take_pose(in->placed_position, in->placed_rotation)};
    }
    return sound;
}

wh_status_t wh_link_state_from_message(const waferhand_state *message, const wh_tolerance_t *tolerance,
                                       wh_link_arrays_t *arrays, wh_state_t *state) {
    if (!take_arrays(message, tolerance, arrays)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    state->utime = message->utime;
    state->seq = message->seq;
    state->status = (wh_status_t)message->status;
    state->wafers = arrays->wafers;
    state->wafer_count = (size_t)message->wafer_count;
    state->grippers = arrays->grippers;
    state->gripper_count = (size_t)message->gripper_count;
    state->events = arrays->events;
    state->event_count = (size_t)message->event_count;
    state->has_lost_events = message->events_lost != 0;
    state->sensors = (uint32_t)message->sensors;
    state->physics = &arrays->physics;
    return WH_OK;
}

wh_grasp_t wh_link_table(const waferhand_state *message, const wh_layout_t *layout,
                         wh_link_arrays_t *arrays) {
    return (wh_grasp_t){.config = layout->grasp,
                        .mark = WH_GRASP_MARK,
                        .grips = wh_layout_has_grips(layout) ? 1 : 0,
                        .slice = (uint64_t)(message->seq - message->missed),
                        .storage = {.wafers = arrays->wafers,
                                    .wafer_count = layout->wafer_count,
                                    .grippers = arrays->grippers,
                                    .gripper_count = layout->machine.gripper_count}};
}

bool wh_link_state_is_sound(const waferhand_state *message, const wh_layout_t *layout,
                            wh_link_arrays_t *arrays, wh_state_t *state) {
    if (wh_link_state_from_message(message, &layout->grasp.tolerance, arrays, state) != WH_OK ||
        state->wafer_count != layout->wafer_count || state->gripper_count != layout->machine.gripper_count ||
        (size_t)message->door_count != layout->machine.door_count || message->missed < 0 ||
        message->missed >= message->seq ||
        !wh_layout_complete_grips(layout, arrays->grippers, &arrays->physics)) {
        return false;
    }
    const wh_grasp_t table = wh_link_table(message, layout, arrays);
    return wh_physics_state_validate(state->physics, state->gripper_count, state->wafer_count) == WH_OK &&
           wh_physics_state_hash(state->physics, &table) == (uint64_t)message->hash;
}

/* ---------------------------------------------------------------------------------------------- proximity */

static void put_counterpart(const wh_state_t *state, size_t g, const wh_layout_t *layout,
                            waferhand_proximity *message) {
    const wh_gripper_t *gripper = &state->grippers[g];
    const int32_t wafer = wh_counterpart(state, g, &layout->cell, NULL, state->wafer_count);
    wh_proximity_t p;
    message->wafer[g] = wafer;
    message->valve[g] = (int8_t)gripper->valve;
    if (wafer == WH_NONE || wh_layout_measure(layout, &state->wafers[wafer].base_from_wafer,
                                              &gripper->base_from_gripper, &p) != WH_OK) {
        return;
    }
    message->dr_proj_z[g] = p.dr_proj_z;
    put_vec3(&p.dr_proj_xy, message->dr_proj_xy[g]);
    message->dr_proj_xy_norm[g] = p.dr_proj_xy_norm;
    message->n1_proj_n2[g] = p.n1_proj_n2;
    message->ready[g] = p.ready ? 1 : 0;
    message->holds[g] = gripper->wafer == wafer ? 1 : 0;
    message->face[g] = wh_layout_face_towards(layout, &state->wafers[wafer].base_from_wafer,
                                              &gripper->base_from_gripper) == WH_FACE_FRONT
                           ? 1
                           : 0;
}

void wh_link_proximity_to_message(const wh_state_t *state, const wh_link_identity_t *identity,
                                  const wh_layout_t *layout, waferhand_proximity *message) {
    const wh_tolerance_t *tolerance = &layout->grasp.tolerance;
    memset(message, 0, sizeof *message);
    message->utime = state->utime;
    message->seq = state->seq;
    message->run = identity->run;
    message->layout_hash = (int64_t)identity->layout_hash;
    message->eps_projz = tolerance->projz;
    message->eps_projxy = tolerance->projxy;
    message->eps_planar = tolerance->planar;
    message->gripper_count = (int32_t)state->gripper_count;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        put_counterpart(state, g, layout, message);
    }
}
