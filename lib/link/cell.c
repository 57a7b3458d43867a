/* Converts the cell of a layout to a message. */
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "messages.h"

static void put_lists(const wh_layout_t *layout, wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    message->grips = room->grips;
    message->gripper_names = room->gripper_names;
    message->valve_names = room->valve_names;
    message->stations = room->stations;
    message->wafer_names = room->wafer_names;
    message->wafers = room->wafers;
    message->faults = room->faults;
    message->grips = room->grips;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        room->grips[g] = (int8_t)layout->grips[g].kind;
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
        message->wafers[w].face = wh_layout_is_face_down(&layout->start[w].base_from_wafer) ? 1 : 0;
    }
    for (size_t i = 0; i < layout->physics.fault_count; ++i) {
        wh_link_put_fault(&layout->physics.faults[i], &message->faults[i]);
    }
}

static void put_sensor(const wh_scanner_t *scanner, double hidden[2][WH_SENSOR_ARCS],
                       waferhand_edge_sensor *out) {
    const wh_sensor_t *sensor = &scanner->sensor;
    *out = (waferhand_edge_sensor){.gripper = scanner->gripper,
                                   .seed = (int64_t)scanner->seed,
                                   .direction = sensor->direction,
                                   .middle = sensor->middle,
                                   .length = sensor->length,
                                   .pixel = sensor->pixel,
                                   .samples = sensor->samples,
                                   .encoder = sensor->encoder,
                                   .noise = sensor->noise,
                                   .tilt = sensor->tilt,
                                   .offset = sensor->error.offset,
                                   .zero = sensor->error.zero,
                                   .gain = sensor->error.gain,
                                   .latency = sensor->error.latency,
                                   .hidden_count = sensor->hidden_count,
                                   .hidden_from = hidden[0],
                                   .hidden_width = hidden[1]};
    for (int32_t i = 0; i < sensor->hidden_count; ++i) {
        hidden[0][i] = sensor->hidden[i].from;
        hidden[1][i] = sensor->hidden[i].width;
    }
}

static void put_rim(const wh_rim_t *rim, int32_t wafer, double chips[3][WH_RIM_CHIPS], waferhand_rim *out) {
    *out = (waferhand_rim){.wafer = wafer,
                           .radius = rim->radius,
                           .notch_direction = rim->notch.direction,
                           .notch_depth = rim->notch.depth,
                           .notch_opening = rim->notch.opening,
                           .notch_bottom = rim->notch.bottom,
                           .notch_corner = rim->notch.corner,
                           .bow = rim->bow,
                           .saddle = rim->saddle,
                           .saddle_direction = rim->saddle_direction,
                           .transmission = rim->transmission,
                           .chip_count = rim->chip_count,
                           .chip_direction = chips[0],
                           .chip_width = chips[1],
                           .chip_depth = chips[2]};
    for (size_t i = 0; i < WH_RIM_FLATS; ++i) {
        out->flat_direction[i] = rim->flats[i].direction;
        out->flat_length[i] = rim->flats[i].length;
    }
    for (int32_t i = 0; i < rim->chip_count; ++i) {
        chips[0][i] = rim->chips[i].direction;
        chips[1][i] = rim->chips[i].width;
        chips[2][i] = rim->chips[i].depth;
    }
}

static void put_vector(double x, double y, double z, double out[3]) {
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static void put_touch(const wh_door_beam_t *door, waferhand_door_beam *out) {
    const wh_touch_face_t *touch = &door->touch;
    out->gripper = door->gripper;
    out->low = 0;
    out->high = 0;
    out->reach[0] = touch->along;
    out->reach[1] = touch->aside;
    out->ball_radius = touch->radius;
    out->noise = door->noise;
    memcpy(out->ball, touch->ball, sizeof out->ball);
    memcpy(out->point, touch->middle, sizeof out->point);
    memcpy(out->direction, touch->normal, sizeof out->direction);
    memcpy(out->edge, touch->edge, sizeof out->edge);
}

static void put_beam(const wh_layout_t *layout, size_t b, waferhand_door_beam *out) {
    const wh_door_beam_t *door = &layout->doors[b];
    const wh_beam_t *beam = &door->beam;
    *out = (waferhand_door_beam){.station = layout->beams[b].station,
                                 .seed = (int64_t)door->seed,
                                 .low = beam->low,
                                 .high = beam->high,
                                 .delay_on = door->delay_on,
                                 .delay_off = door->delay_off,
                                 .jitter = door->jitter,
                                 .stuck = (int32_t)door->stuck,
                                 .gripper = WH_NONE};
    put_vector(beam->x, beam->y, beam->z, out->point);
    put_vector(beam->ex, beam->ey, beam->ez, out->direction);
    if (door->kind == WH_DOOR_TOUCH) {
        put_touch(door, out);
    }
}

static void put_beams(const wh_layout_t *layout, wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    message->beams = room->beams;
    message->outlines = room->outlines;
    for (size_t b = 0; b < layout->beam_count; ++b) {
        put_beam(layout, b, &room->beams[b]);
    }
    message->beam_count = (int32_t)layout->beam_count;
    message->outline_count = layout->beam_count > 0 ? (int32_t)layout->machine.gripper_count : 0;
    for (int32_t g = 0; g < message->outline_count; ++g) {
        const wh_blade_outline_t *blade = &layout->blades[g];
        memcpy(room->corners[g][0], blade->x, sizeof blade->x);
        memcpy(room->corners[g][1], blade->y, sizeof blade->y);
        room->outlines[g] = (waferhand_outline){blade->count, room->corners[g][0], room->corners[g][1]};
    }
}

static void put_rims(const wh_layout_t *layout, wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    message->rims = room->rims;
    if (!wh_layout_has_rims(layout)) {
        return;
    }
    put_rim(layout->nominal_rim, WH_NONE, room->chips[0], &room->rims[0]);
    message->rim_count = 1;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        if (layout->rims[w] != layout->nominal_rim) {
            const int32_t i = message->rim_count++;
            put_rim(layout->rims[w], (int32_t)w, room->chips[i], &room->rims[i]);
        }
    }
}

static void put_edges(const wh_layout_t *layout, wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    message->edges = room->edges;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_edge_t *edge = &layout->grips[g].edge;
        if (layout->grips[g].kind == WH_GRIP_EDGE) {
            room->edges[message->edge_count++] = (waferhand_edge_grip){
                edge->radius,    edge->rest,         edge->plunger,    edge->alpha, edge->clearance,
                edge->retracted, edge->gripped_from, edge->gripped_to, edge->end,   edge->speed};
        }
    }
}

static void put_scanning(const wh_layout_t *layout, wh_link_cell_t *room) {
    waferhand_cell *message = &room->message;
    message->sensors = room->sensors;
    for (size_t i = 0; i < layout->scanner_count; ++i) {
        put_sensor(&layout->scanners[i], room->hidden[i], &room->sensors[i]);
    }
    message->sensor_count = (int32_t)layout->scanner_count;
}

static void put_doors(const wh_layout_t *layout, wh_link_cell_t *room) {
    const wh_machine_t *machine = &layout->machine;
    room->message.door_count = (int32_t)machine->door_count;
    room->message.doors = room->doors;
    for (size_t d = 0; d < machine->door_count; ++d) {
        const wh_door_t *door = &machine->doors[d];
        waferhand_door *out = &room->doors[d];
        *out = (waferhand_door){.name = wh_link_borrowed(layout->door_list[d].name),
                                .axis = (int32_t)wh_machine_door_axis(machine, d),
                                .travel = door->travel,
                                .open = door->is_open ? 1 : 0,
                                .speed = door->limits.speed,
                                .acceleration = door->limits.acceleration,
                                .jerk = door->limits.jerk};
        put_vector(door->way.x, door->way.y, door->way.z, out->way);
    }
}

static void put_physics(const wh_physics_t *physics, waferhand_cell *message) {
    message->slice_us += (int64_t)physics->vacuum.debounce << WH_LINK_DEBOUNCE_SHIFT;
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

static int8_t collision_of(const wh_layout_t *layout) {
    bool has_limit = false;
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        has_limit = has_limit || layout->world.limits[kind] > 0;
    }
    return (int8_t)(!layout->collision ? WH_LINK_NO_COLLISION : has_limit ? WH_LINK_GAPS : WH_LINK_CONTACT);
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
    message->drop = layout->cell.drop;
    message->thickness = layout->cell.thickness;
    message->collision = collision_of(layout);
    message->world_hash = (int64_t)wh_layout_world_hash(layout);
    message->gripper_count = (int32_t)layout->machine.gripper_count;
    message->station_count = (int32_t)layout->station_count;
    message->wafer_count = (int32_t)layout->wafer_count;
    put_physics(&layout->physics, message);
    put_lists(layout, room);
    put_doors(layout, room);
    put_scanning(layout, room);
    put_beams(layout, room);
    put_rims(layout, room);
    put_edges(layout, room);
    return true;
}
