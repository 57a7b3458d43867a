/* Converts the cell of a layout to a message. */
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "members.h"
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
    wh_members_put(wh_sensor_members, scanner, out);
    out->hidden_from = hidden[0];
    out->hidden_width = hidden[1];
    for (int32_t i = 0; i < scanner->sensor.hidden_count; ++i) {
        hidden[0][i] = scanner->sensor.hidden[i].from;
        hidden[1][i] = scanner->sensor.hidden[i].width;
    }
}

static void put_rim(const wh_rim_t *rim, int32_t wafer, double chips[3][WH_RIM_CHIPS], waferhand_rim *out) {
    wh_members_put(wh_rim_members, rim, out);
    out->wafer = wafer;
    out->chip_direction = chips[0];
    out->chip_width = chips[1];
    out->chip_depth = chips[2];
    for (int32_t i = 0; i < rim->chip_count; ++i) {
        chips[0][i] = rim->chips[i].direction;
        chips[1][i] = rim->chips[i].width;
        chips[2][i] = rim->chips[i].depth;
    }
}

static void put_beam(const wh_layout_t *layout, size_t b, waferhand_door_beam *out) {
    const wh_door_beam_t *door = &layout->doors[b];
    out->station = layout->beams[b].station;
    out->gripper = WH_NONE;
    wh_members_put(door->kind == WH_DOOR_TOUCH ? wh_touch_members : wh_light_members, door, out);
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
        if (layout->grips[g].kind == WH_GRIP_EDGE) {
            wh_members_put(wh_edge_members, &layout->grips[g].edge, &room->edges[message->edge_count++]);
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
        waferhand_door *out = &room->doors[d];
        wh_members_put(wh_door_members, &machine->doors[d], out);
        out->name = wh_link_borrowed(layout->door_list[d].name);
        out->axis = (int32_t)wh_machine_door_axis(machine, d);
    }
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
    wh_members_put(wh_cell_members, layout, message);
    message->slice_us += (int64_t)layout->physics.vacuum.debounce << WH_LINK_DEBOUNCE_SHIFT;
    message->collision = collision_of(layout);
    message->world_hash = (int64_t)wh_layout_world_hash(layout);
    message->gripper_count = (int32_t)layout->machine.gripper_count;
    message->station_count = (int32_t)layout->station_count;
    message->wafer_count = (int32_t)layout->wafer_count;
    message->fault_count = (int32_t)layout->physics.fault_count;
    put_lists(layout, room);
    put_doors(layout, room);
    put_scanning(layout, room);
    put_beams(layout, room);
    put_rims(layout, room);
    put_edges(layout, room);
    return true;
}
