/* The cell of a layout as a message, and back. */
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "messages.h"

static void put_lists(const wh_layout_t *layout, wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    message->gripper_names = room->gripper_names;
    message->valve_names = room->valve_names;
    message->stations = room->stations;
    message->wafer_names = room->wafer_names;
    message->wafers = room->wafers;
    message->faults = room->faults;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        message->gripper_names[g] = wh_link_borrowed(layout->grippers[g].name);
        message->valve_names[g] = wh_link_borrowed(layout->grippers[g].valve);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_station_t *place = &layout->places[s];
        waferhand_station *out = &message->stations[s];
        out->name = wh_link_borrowed(layout->stations[s].name);
        wh_link_put_pose(&place->base_from_station, out->position, out->rotation);
        out->slots = place->slots;
        out->pitch = place->pitch;
        out->chuck = place->chuck;
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
                              wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    memset(room, 0, sizeof *room);
    if (layout->wafer_count > WH_LINK_WAFERS) {
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
    put_lists(layout, room);
    return true;
}

/* ----------------------------------------------------------------------------------------------- and back */

static bool take_name(const char *from, char to[WH_NAME_SIZE]) {
    const size_t length = strlen(from);
    if (length == 0 || length >= WH_NAME_SIZE) {
        return false;
    }
    memcpy(to, from, length + 1);
    return true;
}

static bool take_pose(const double position[3], const double rotation[9], wh_pose_t *pose) {
    *pose = wh_link_take_pose(position, rotation);
    return wh_pose_validate(pose) == WH_OK;
}

static bool is_within(double value, double least, double most) {
    return value >= least && value <= most;
}

/* What a layout's file may say of checks and places. */
static bool take_checks(const waferhand_cell *cell, wh_layout_t *layout) {
    wh_grasp_config_t *grasp = &layout->grasp;
    grasp->tolerance.projz = cell->eps_projz;
    grasp->tolerance.projxy = cell->eps_projxy;
    grasp->tolerance.planar = cell->eps_planar;
    grasp->near_projz = cell->near_projz;
    grasp->near_projxy = cell->near_projxy;
    grasp->check = cell->check != 0 ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
    grasp->seat = cell->seat != 0;
    layout->slice_us = cell->slice_us;
    layout->cell.settle = cell->settle != 0;
    layout->cell.off_centre = cell->off_centre;
    layout->cell.askew = cell->askew;
    return wh_tolerance_validate(&grasp->tolerance) == WH_OK && is_within(cell->eps_projz, 1e-9, 1e6) &&
           is_within(cell->near_projz, 1e-9, 1e6) && is_within(cell->near_projxy, 1e-9, 1e6) &&
           is_within(cell->off_centre, 0, 1e6) && is_within(cell->askew, 0, 10) && cell->slice_us >= 1 &&
           cell->slice_us <= 1000000;
}

static bool take_station(const waferhand_station *from, size_t grippers, wh_layout_station_t *station,
                         wh_station_t *place) {
    place->slots = from->slots;
    place->pitch = from->pitch;
    place->chuck = from->chuck;
    return take_name(from->name, station->name) &&
           take_pose(from->position, from->rotation, &place->base_from_station) &&
           is_within(from->slots, 1, WH_LAYOUT_SLOTS) && from->pitch > 0 && from->pitch <= 1e6 &&
           from->chuck >= WH_NONE && from->chuck < (int32_t)grippers;
}

static bool take_lists(const waferhand_cell *cell, wh_layout_t *layout) {
    bool sound = true;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        sound = take_name(cell->gripper_names[g], layout->grippers[g].name) && sound;
        layout->grippers[g].station = WH_NONE;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        sound = take_station(&cell->stations[s], layout->machine.gripper_count, &layout->stations[s],
                             &layout->places[s]) &&
                sound;
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const waferhand_wafer_state *from = &cell->wafers[w];
        sound = take_name(cell->wafer_names[w], layout->wafers[w].name) &&
                take_pose(from->position, from->rotation, &layout->start[w].base_from_wafer) && sound;
    }
    return sound;
}

/* The layout has times in s, the message has slices in us; lib/layout/layout_physics.c converts them the same
 * way. */
static bool take_physics(const waferhand_cell *cell, wh_layout_t *layout) {
    wh_physics_t *physics = &layout->physics;
    physics->slice_s = (wh_real_t)cell->slice_us / 1e6;
    physics->vacuum =
        (wh_vacuum_config_t){cell->vacuum_build,     cell->vacuum_vent,       cell->vacuum_idle,
                             cell->vacuum_sensor_on, cell->vacuum_sensor_off, cell->vacuum_release};
    physics->pads = (wh_pads_t){cell->pads_friction, cell->pads_force, cell->pads_mass, cell->pads_gravity};
    physics->fault_count = (size_t)cell->fault_count;
    for (size_t i = 0; i < physics->fault_count; ++i) {
        physics->faults[i] = wh_link_take_fault(&cell->faults[i]);
    }
    return wh_physics_validate(physics, layout->machine.gripper_count, layout->wafer_count) == WH_OK;
}

static wh_layout_t *make_layout(const waferhand_cell *cell) {
    wh_layout_t *layout = wh_array_new(1, sizeof *layout);
    layout->machine.gripper_count = (size_t)cell->gripper_count;
    layout->station_count = (size_t)cell->station_count;
    layout->wafer_count = (size_t)cell->wafer_count;
    layout->path = wh_text_copy(cell->layout);
    layout->stations = wh_array_new(layout->station_count, sizeof *layout->stations);
    layout->places = wh_array_new(layout->station_count, sizeof *layout->places);
    layout->wafers = wh_array_new(layout->wafer_count, sizeof *layout->wafers);
    layout->start = wh_array_new(layout->wafer_count, sizeof *layout->start);
    return layout;
}

wh_layout_t *wh_link_layout_from_cell(const waferhand_cell *cell) {
    wh_layout_t *layout = make_layout(cell);
    if (cell->gripper_count < 1 || !take_checks(cell, layout) || !take_lists(cell, layout) ||
        !take_physics(cell, layout)) {
        wh_link_layout_free(layout);
        return NULL;
    }
    wh_layout_place(layout);
    return layout;
}

void wh_link_layout_free(wh_layout_t *layout) {
    if (!layout) {
        return;
    }
    free(wh_link_borrowed(layout->path));
    free(layout->stations);
    free(layout->places);
    free(layout->wafers);
    free(layout->start);
    free(layout);
}
