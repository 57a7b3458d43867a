/* Makes a layout of the cell that a message tells. */
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "../text/array.h"
#include "members.h"
#include "messages.h"

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

static int64_t slice_us_of(const waferhand_cell *cell) {
    return cell->slice_us & ((INT64_C(1) << WH_LINK_DEBOUNCE_SHIFT) - 1);
}

/* True if checks and places have values that a layout's file may give. */
static bool checks_fit(const waferhand_cell *cell) {
    return is_within(cell->eps_projz, 1e-9, 1e6) && is_within(cell->near_projz, 1e-9, 1e6) &&
           is_within(cell->near_projxy, 1e-9, 1e6) && is_within(cell->off_centre, 0, 1e6) &&
           is_within(cell->askew, 0, 10) && is_within(cell->drop, 0, 1e6) &&
           is_within(cell->thickness, 0, WH_FACE_THICKEST) &&
           is_within(cell->collision, WH_LINK_NO_COLLISION, WH_LINK_GAPS) && cell->slice_us >= 1 &&
           is_within((double)slice_us_of(cell), 1, 1000000);
}

/* The layout has times in s, the message has slices in us; lib/reading/layout_physics.c converts them the
 * same way. */
static bool take_checks(const waferhand_cell *cell, wh_layout_t *layout) {
    wh_members_take(wh_cell_members, cell, layout);
    layout->wafer_thickness = cell->thickness;
    layout->has_faces = cell->thickness > 0;
    layout->slice_us = slice_us_of(cell);
    layout->physics.slice_s = (wh_real_t)layout->slice_us / 1e6;
    layout->physics.vacuum.debounce = (int32_t)(cell->slice_us >> WH_LINK_DEBOUNCE_SHIFT);
    return wh_tolerance_validate(&layout->grasp.tolerance) == WH_OK && checks_fit(cell);
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

/* Takes one edge grip for each gripper that has one. */
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
        wh_members_take(wh_edge_members, &cell->edges[taken++], &layout->grips[g].edge);
        sound = sound && wh_edge_validate(&layout->grips[g].edge) == WH_OK;
    }
    return sound && taken == cell->edge_count;
}

static bool take_physics(const waferhand_cell *cell, wh_layout_t *layout) {
    wh_physics_t *physics = &layout->physics;
    physics->fault_count = (size_t)cell->fault_count;
    for (size_t i = 0; i < physics->fault_count; ++i) {
        physics->faults[i] = wh_link_take_fault(&cell->faults[i]);
    }
    return wh_physics_validate(physics, layout->machine.gripper_count, layout->wafer_count) == WH_OK;
}

static void take_sensor(const waferhand_edge_sensor *in, const wh_layout_t *layout, wh_scanner_t *scanner) {
    wh_members_take(wh_sensor_members, in, scanner);
    for (int32_t i = 0; i < in->hidden_count; ++i) {
        scanner->sensor.hidden[i] = (wh_arc_t){in->hidden_from[i], in->hidden_width[i]};
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->places[s].chuck == in->gripper) {
            scanner->base_from_station = layout->places[s].base_from_station;
        }
    }
}

static void take_rim(const waferhand_rim *in, wh_rim_t *rim) {
    wh_members_take(wh_rim_members, in, rim);
    for (int32_t i = 0; i < in->chip_count; ++i) {
        rim->chips[i] = (wh_chip_t){in->chip_direction[i], in->chip_width[i], in->chip_depth[i]};
    }
}

/* Takes each wafer's rim, as the message names it; false if it names another wafer than it may. */
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
        take_sensor(&cell->sensors[i], layout, &layout->scanners[i]);
    }
    const wh_scanning_t scanning = wh_layout_scanning(layout);
    return wh_scanning_validate(&scanning, layout->machine.gripper_count, layout->wafer_count) == WH_OK;
}

static void take_beam(const waferhand_door_beam *in, wh_door_beam_t *door) {
    door->kind = in->gripper != WH_NONE ? WH_DOOR_TOUCH : WH_DOOR_LIGHT;
    wh_members_take(door->kind == WH_DOOR_TOUCH ? wh_touch_members : wh_light_members, in, door);
}

/* Beams come before faces, and both are sorted by station. */
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
        take_beam(&cell->beams[b], &layout->doors[b]);
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

/* Takes the wafers as edge grips meet them. */
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

/* Takes the doors; their axes follow one another, behind those of the robot. */
static bool take_doors(const waferhand_cell *cell, wh_layout_t *layout) {
    wh_door_t *doors = wh_array_new((size_t)cell->door_count + 1, sizeof *doors);
    wh_machine_t *machine = &layout->machine;
    bool sound = true;
    machine->doors = doors;
    machine->door_count = (size_t)cell->door_count;
    layout->door_list = wh_array_new((size_t)cell->door_count + 1, sizeof *layout->door_list);
    for (int32_t d = 0; sound && d < cell->door_count; ++d) {
        const waferhand_door *in = &cell->doors[d];
        wh_members_take(wh_door_members, in, &doors[d]);
        sound = take_name(in->name, layout->door_list[d].name) && in->axis == cell->doors[0].axis + d &&
                in->axis >= WH_ROBOT_AXES && in->axis < WH_AXES && wh_door_validate(&doors[d]) == WH_OK;
        machine->axis_count = (size_t)in->axis + 1;
    }
    return sound;
}

/* Takes the sensors that see wafers' rims, and the rims. */
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
