/* The cell of a layout as a message. */
#include <stdlib.h>
#include <string.h>

#include "fault_message.h"
#include "messages.h"

static bool make_room(const wh_layout_t *layout, waferhand_cell *message) {
    message->gripper_names = calloc(WH_GRIPPERS, sizeof *message->gripper_names);
    message->valve_names = calloc(WH_GRIPPERS, sizeof *message->valve_names);
    message->stations = calloc(layout->station_count + 1, sizeof *message->stations);
    message->wafer_names = calloc(layout->wafer_count + 1, sizeof *message->wafer_names);
    message->wafers = calloc(layout->wafer_count + 1, sizeof *message->wafers);
    message->faults = calloc(WH_FAULTS, sizeof *message->faults);
    return message->gripper_names && message->valve_names && message->stations && message->wafer_names &&
           message->wafers && message->faults;
}

static void put_station(const wh_layout_t *layout, size_t s, waferhand_station *out) {
    const wh_station_t *place = &layout->places[s];
    out->name = wh_link_borrowed(layout->stations[s].name);
    wh_link_put_pose(&place->base_from_station, out->position, out->rotation);
    out->slots = place->slots;
    out->pitch = place->pitch;
    out->chuck = place->chuck;
}

static void put_lists(const wh_layout_t *layout, waferhand_cell *message) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        message->gripper_names[g] = wh_link_borrowed(layout->grippers[g].name);
        message->valve_names[g] = wh_link_borrowed(layout->grippers[g].valve);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        put_station(layout, s, &message->stations[s]);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        message->wafer_names[w] = wh_link_borrowed(layout->wafers[w].name);
        wh_link_put_pose(&layout->start[w].base_from_wafer, message->wafers[w].position,
                         message->wafers[w].rotation);
        message->wafers[w].holder = WH_NONE;
    }
    for (size_t i = 0; i < layout->physics.fault_count; ++i) {
        wh_link_put_fault(&layout->physics.faults[i], &message->faults[i]);
    }
}

static void put_physics(const wh_physics_t *physics, waferhand_cell *message) {
    message->vacuum_build = physics->vacuum.build;
    message->vacuum_vent = physics->vacuum.vent;
    message->vacuum_idle = physics->vacuum.idle;
    message->vacuum_sensor_on = physics->vacuum.on;
    message->vacuum_sensor_off = physics->vacuum.off;
    message->vacuum_release = physics->vacuum.release;
    message->pads_friction = physics->pads.friction;
    message->pads_force = physics->pads.force;
    message->pads_mass = physics->pads.mass;
    message->pads_gravity = physics->pads.gravity;
    message->fault_count = (int32_t)physics->fault_count;
}

bool wh_link_cell_from_layout(const wh_layout_t *layout, const wh_link_identity_t *identity,
                              waferhand_cell *message) {
    memset(message, 0, sizeof *message);
    if (layout->wafer_count > WH_LINK_WAFERS || !make_room(layout, message)) {
        wh_link_cell_free(message);
        return false;
    }
    message->run = identity->run;
    message->layout_hash = (int64_t)identity->layout_hash;
    message->layout = wh_link_borrowed(layout->path);
    message->slice_us = layout->slice_us;
    message->eps_projz = layout->grasp.tolerance.projz;
    message->eps_projxy = layout->grasp.tolerance.projxy;
    message->eps_planar = layout->grasp.tolerance.planar;
    message->near_projz = layout->grasp.near_projz;
    message->near_projxy = layout->grasp.near_projxy;
    message->check = layout->grasp.check == WH_CHECK_SWEPT ? 1 : 0;
    message->seat = layout->grasp.seat ? 1 : 0;
    message->settle = layout->cell.settle ? 1 : 0;
    message->off_centre = layout->cell.off_centre;
    message->askew = layout->cell.askew;
    message->gripper_count = (int32_t)layout->machine.gripper_count;
    message->station_count = (int32_t)layout->station_count;
    message->wafer_count = (int32_t)layout->wafer_count;
    put_physics(&layout->physics, message);
    put_lists(layout, message);
    return true;
}

void wh_link_cell_free(waferhand_cell *message) {
    free(message->gripper_names);
    free(message->valve_names);
    free(message->stations);
    free(message->wafer_names);
    free(message->wafers);
    free(message->faults);
    memset(message, 0, sizeof *message);
}
