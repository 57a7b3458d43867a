/* The cell of a layout as a message, and back. */
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "../text/array.h"
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
static bool checks_fit(const waferhand_cell *cell) {
    return is_within(cell->eps_projz, 1e-9, 1e6) && is_within(cell->near_projz, 1e-9, 1e6) &&
           is_within(cell->near_projxy, 1e-9, 1e6) && is_within(cell->off_centre, 0, 1e6) &&
           is_within(cell->askew, 0, 10) && is_within(cell->drop, 0, 1e6) &&
           is_within(cell->thickness, 0, WH_FACE_THICKEST) &&
           is_within(cell->collision, WH_LINK_NO_COLLISION, WH_LINK_GAPS) && cell->slice_us >= 1 &&
           cell->slice_us <= 1000000;
}

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
    layout->cell.drop = cell->drop;
    layout->cell.thickness = layout->wafer_thickness = cell->thickness;
    layout->has_faces = cell->thickness > 0;
    return wh_tolerance_validate(&grasp->tolerance) == WH_OK && checks_fit(cell);
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
        layout->grips[g].kind = (wh_grip_kind_t)cell->grips[g];
        sound = cell->grips[g] >= WH_GRIP_VACUUM && cell->grips[g] <= WH_GRIP_PASSIVE && sound;
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

/* One for each gripper that has an edge grip. */
static bool take_edges(const waferhand_cell *cell, wh_layout_t *layout) {
    int32_t taken = 0;
    bool sound = true;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (layout->grips[g].kind != WH_GRIP_EDGE) {
            continue;
        }
        if (taken == cell->edge_count) {
            return false;
        }
        const waferhand_edge_grip *in = &cell->edges[taken++];
        layout->grips[g].edge =
            (wh_edge_t){in->radius,    in->rest,         in->plunger,    in->alpha, in->clearance,
                        in->retracted, in->gripped_from, in->gripped_to, in->end,   in->speed};
        sound = sound && wh_edge_validate(&layout->grips[g].edge) == WH_OK;
    }
    return sound && taken == cell->edge_count;
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

static wh_scanner_t take_sensor(const waferhand_edge_sensor *in, const wh_layout_t *layout) {
    wh_scanner_t scanner = {.gripper = in->gripper,
                            .seed = (uint64_t)in->seed,
                            .sensor = {.direction = in->direction,
                                       .middle = in->middle,
                                       .length = in->length,
                                       .pixel = in->pixel,
                                       .samples = in->samples,
                                       .encoder = in->encoder,
                                       .noise = in->noise,
                                       .tilt = in->tilt,
                                       .error = {in->offset, in->zero, in->gain, in->latency},
                                       .hidden_count = in->hidden_count}};
    for (int32_t i = 0; i < in->hidden_count; ++i) {
        scanner.sensor.hidden[i] = (wh_arc_t){in->hidden_from[i], in->hidden_width[i]};
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->places[s].chuck == in->gripper) {
            scanner.base_from_station = layout->places[s].base_from_station;
        }
    }
    return scanner;
}

static void take_rim(const waferhand_rim *in, wh_rim_t *rim) {
    *rim = (wh_rim_t){.radius = in->radius,
                      .notch = {in->notch_direction, in->notch_depth, in->notch_opening, in->notch_bottom,
                                in->notch_corner},
                      .chip_count = in->chip_count,
                      .bow = in->bow,
                      .saddle = in->saddle,
                      .saddle_direction = in->saddle_direction,
                      .transmission = in->transmission};
    for (size_t i = 0; i < WH_RIM_FLATS; ++i) {
        rim->flats[i] = (wh_flat_shape_t){in->flat_direction[i], in->flat_length[i]};
    }
    for (int32_t i = 0; i < in->chip_count; ++i) {
        rim->chips[i] = (wh_chip_t){in->chip_direction[i], in->chip_width[i], in->chip_depth[i]};
    }
}

/* Each wafer's rim, as the message names it; false if it names another wafer than it may. */
static bool take_rims(const waferhand_cell *cell, wh_layout_t *layout, const wh_rim_t **by_wafer,
                      wh_rim_t *rims) {
    int32_t before = WH_NONE;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        by_wafer[w] = rims;
    }
    for (int32_t i = 0; i < cell->rim_count; ++i) {
        const int32_t wafer = cell->rims[i].wafer;
        take_rim(&cell->rims[i], &rims[i]);
        if (i == 0 ? wafer != WH_NONE : wafer <= before || wafer >= cell->wafer_count) {
            return false;
        }
        if (i > 0) {
            by_wafer[wafer] = &rims[i];
        }
        before = wafer;
    }
    return true;
}

static bool take_scanning(const waferhand_cell *cell, wh_layout_t *layout) {
    layout->scanner_count = (size_t)cell->sensor_count;
    for (int32_t i = 0; i < cell->sensor_count; ++i) {
        layout->scanners[i] = take_sensor(&cell->sensors[i], layout);
    }
    const wh_scanning_t scanning = wh_layout_scanning(layout);
    return wh_scanning_validate(&scanning, layout->machine.gripper_count, layout->wafer_count) == WH_OK;
}

static wh_door_beam_t take_touch(const waferhand_door_beam *in) {
    wh_door_beam_t door = {.seed = (uint64_t)in->seed,
                           .stuck = (wh_beam_stuck_t)in->stuck,
                           .kind = WH_DOOR_TOUCH,
                           .touch = {.along = in->reach[0], .aside = in->reach[1], .radius = in->ball_radius},
                           .gripper = in->gripper,
                           .noise = in->noise};
    memcpy(door.touch.middle, in->point, sizeof door.touch.middle);
    memcpy(door.touch.normal, in->direction, sizeof door.touch.normal);
    memcpy(door.touch.edge, in->edge, sizeof door.touch.edge);
    memcpy(door.touch.ball, in->ball, sizeof door.touch.ball);
    return door;
}

static wh_door_beam_t take_beam(const waferhand_door_beam *in) {
    if (in->gripper != WH_NONE) {
        return take_touch(in);
    }
    const wh_door_beam_t door = {.beam = {in->point[0], in->point[1], in->point[2], in->direction[0],
                                          in->direction[1], in->direction[2], in->low, in->high},
                                 .delay_on = in->delay_on,
                                 .delay_off = in->delay_off,
                                 .jitter = in->jitter,
                                 .seed = (uint64_t)in->seed,
                                 .stuck = (wh_beam_stuck_t)in->stuck};
    return door;
}

/* Beams come before faces, and either by station. */
static bool is_behind(const waferhand_door_beam *before, const waferhand_door_beam *beam) {
    const bool was_touch = before->gripper != WH_NONE;
    const bool is_touch = beam->gripper != WH_NONE;
    return was_touch == is_touch ? beam->station >= before->station : is_touch;
}

static bool take_beams(const waferhand_cell *cell, wh_layout_t *layout) {
    bool sound = cell->outline_count == (cell->beam_count > 0 ? cell->gripper_count : 0);
    layout->beam_count = (size_t)cell->beam_count;
    for (int32_t b = 0; b < cell->beam_count; ++b) {
        const int32_t station = cell->beams[b].station;
        layout->doors[b] = take_beam(&cell->beams[b]);
        layout->beams[b].station = station;
        sound = sound && wh_is_index(station, layout->station_count) &&
                (b == 0 || is_behind(&cell->beams[b - 1], &cell->beams[b]));
    }
    for (int32_t g = 0; sound && g < cell->outline_count; ++g) {
        const waferhand_outline *in = &cell->outlines[g];
        layout->blades[g].count = in->count;
        memcpy(layout->blades[g].x, in->x, (size_t)in->count * sizeof(double));
        memcpy(layout->blades[g].y, in->y, (size_t)in->count * sizeof(double));
    }
    const wh_latching_t latching = wh_layout_latching(layout);
    return sound &&
           wh_latching_validate(&latching, layout->machine.gripper_count, layout->wafer_count) == WH_OK;
}

/* The wafers as edge grips meet them. */
static bool take_edge_wafers(wh_layout_t *layout) {
    wh_edge_wafer_t *wafers = wh_array_new(layout->wafer_count, sizeof *wafers);
    bool sound = true;
    layout->edge_wafers = wafers;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w] = wh_layout_edge_wafer(layout->rims[w]);
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            sound = sound && (layout->grips[g].kind != WH_GRIP_EDGE ||
                              wh_edge_wafer_validate(&layout->grips[g].edge, &wafers[w]) == WH_OK);
        }
    }
    return sound;
}

static wh_door_t take_door(const waferhand_door *in) {
    return (wh_door_t){.way = wh_vec3(in->way[0], in->way[1], in->way[2]),
                       .travel = in->travel,
                       .is_open = in->open != 0,
                       .limits = {in->speed, in->acceleration, in->jerk}};
}

/* The axes of all doors follow one another, behind those of the robot. */
static bool take_doors(const waferhand_cell *cell, wh_layout_t *layout) {
    wh_door_t *doors = wh_array_new((size_t)cell->door_count + 1, sizeof *doors);
    wh_machine_t *machine = &layout->machine;
    bool sound = true;
    machine->doors = doors;
    machine->door_count = (size_t)cell->door_count;
    layout->door_list = wh_array_new((size_t)cell->door_count + 1, sizeof *layout->door_list);
    for (int32_t d = 0; sound && d < cell->door_count; ++d) {
        const waferhand_door *in = &cell->doors[d];
        doors[d] = take_door(in);
        sound = take_name(in->name, layout->door_list[d].name) && in->axis == cell->doors[0].axis + d &&
                in->axis >= WH_ROBOT_AXES && in->axis < WH_AXES && wh_door_validate(&doors[d]) == WH_OK;
        machine->axis_count = (size_t)in->axis + 1;
    }
    return sound;
}

/* What sees wafers' rims, and these. */
static bool take_sensing(const waferhand_cell *cell, wh_layout_t *layout) {
    if (cell->sensor_count + cell->beam_count + cell->edge_count == 0) {
        return cell->rim_count == 0 && cell->outline_count == 0;
    }
    wh_rim_t *rims = wh_array_new((size_t)cell->rim_count + 1, sizeof *rims);
    const wh_rim_t **by_wafer = wh_array_new(layout->wafer_count, sizeof *by_wafer);
    layout->nominal_rim = rims;
    layout->rims = by_wafer;
    return cell->rim_count > 0 && take_rims(cell, layout, by_wafer, rims) &&
           wh_rim_validate(rims, NULL) == WH_OK && take_edge_wafers(layout) && take_scanning(cell, layout) &&
           take_beams(cell, layout);
}

static wh_layout_t *make_layout(const waferhand_cell *cell) {
    wh_layout_t *layout = wh_array_new(1, sizeof *layout);
    layout->machine.gripper_count = (size_t)cell->gripper_count;
    layout->station_count = (size_t)cell->station_count;
    layout->wafer_count = (size_t)cell->wafer_count;
    layout->path = wh_text_copy(cell->layout);
    layout->axes_untold = true;
    layout->stations = wh_array_new(layout->station_count, sizeof *layout->stations);
    layout->places = wh_array_new(layout->station_count, sizeof *layout->places);
    layout->wafers = wh_array_new(layout->wafer_count, sizeof *layout->wafers);
    layout->start = wh_array_new(layout->wafer_count, sizeof *layout->start);
    return layout;
}

wh_layout_t *wh_link_layout_from_cell(const waferhand_cell *cell) {
    wh_layout_t *layout = make_layout(cell);
    if (cell->gripper_count < 1 || !take_checks(cell, layout) || !take_lists(cell, layout) ||
        !take_physics(cell, layout) || !take_edges(cell, layout) || !take_doors(cell, layout) ||
        !take_sensing(cell, layout)) {
        wh_link_layout_free(layout);
        return NULL;
    }
    wh_layout_place(layout);
    wh_layout_take_supports(layout, wh_array_new(wh_layout_count_supports(layout), sizeof(wh_pose_t)));
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
    free(layout->door_list);
    free(wh_link_borrowed((const char *)(const void *)layout->machine.doors));
    free(wh_link_borrowed((const char *)(const void *)layout->rims));
    free(wh_link_borrowed((const char *)layout->nominal_rim));
    free(wh_link_borrowed((const char *)layout->edge_wafers));
    free(wh_link_borrowed((const char *)layout->supports));
    free(layout);
}
