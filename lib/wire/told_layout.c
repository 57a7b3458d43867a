#include "told_layout.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../bodies/parts.h"
#include "../bodies/shapes.h"
#include "../layout/grips.h"
#include "../reading/layout_read.h"
#include "../text/array.h"
#include "messages.h"

/* The defaults of a layout. */
#define DIAMETER 300
#define THICKNESS 0.775

/* --------------------------------------------------------------------------------------------------- file */

static const wh_layout_t *load(wh_told_layout_t *made, const char *path,
                               const wh_told_layout_options_t *options) {
    const wh_sandbox_limits_t limits = {.print_to = stderr};
    wh_sandbox_result_t result;
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) {
        (void)snprintf(made->note, sizeof made->note, "%.200s%s is not there", path,
                       options->path ? "" : ", the layout that the log names,");
        return NULL;
    }
    made->sandbox = wh_sandbox_new_with(&limits, options->parameters, options->parameter_count, &result);
    const wh_layout_t *layout = made->sandbox ? wh_layout_load(made->sandbox, path, &result) : NULL;
    if (!layout) {
        (void)snprintf(made->note, sizeof made->note, "%.200s is no layout: %.300s", path, result.message);
    } else if (wh_layout_hash(layout) != made->hash) {
        (void)snprintf(made->note, sizeof made->note,
                       "%.200s is not the layout of the log, or has other parameters: its hash is %016" PRIx64
                       " (expected %.200s, hash %016" PRIx64 ")",
                       path, wh_layout_hash(layout), made->told->path, made->hash);
        layout = NULL;
    } else if (wh_layout_world_hash(layout) != made->world_hash) {
        (void)snprintf(made->note, sizeof made->note,
                       "%.200s is not as it was, or has other parameters: its shapes, or what collisions are "
                       "looked for, were other ones when the log was recorded",
                       path);
        layout = NULL;
    }
    return layout;
}

/* ------------------------------------------------------------------------------------------------- shapes */

static void fill_machine(wh_layout_t *layout) {
    wh_machine_t *machine = &layout->machine;
    const size_t end = machine->axis_count; /* of the doors, if it has some */
    machine->axis_count = WH_ROBOT_AXES;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        machine->mounts[g].axis = WH_NONE;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        const int32_t chuck = layout->places[s].chuck;
        layout->stations[s].prealigner = chuck != WH_NONE;
        if (chuck != WH_NONE && machine->mounts[chuck].axis == WH_NONE && machine->axis_count < WH_AXES) {
            machine->mounts[chuck].axis = (int32_t)machine->axis_count++;
            machine->mounts[chuck].base_from_station = layout->places[s].base_from_station;
            layout->grippers[chuck].station = (int32_t)s;
        }
    }
    machine->axis_count = machine->door_count > 0 ? end : machine->axis_count;
}

static void fill_shapes(wh_told_layout_t *made) {
    wh_layout_t *layout = made->told;
    wh_robot_t robot;
    wh_robot_default(&robot);
    layout->wafer_diameter = DIAMETER;
    layout->wafer_thickness = layout->has_faces ? layout->cell.thickness : THICKNESS;
    layout->notch_depth = 0; /* a log does not tell a notch */
    layout->shapes =
        wh_shapes_default(DIAMETER, THICKNESS, robot.travel[WH_AXIS_R].max, robot.travel[WH_AXIS_Z].min);
    const size_t count = wh_layout_count_parts(layout);
    made->parts = wh_array_new(count, sizeof *made->parts);
    made->names = wh_array_new(count, sizeof *made->names);
    wh_part_list_t list = {made->parts, made->names, 0, count};
    wh_layout_set_parts(layout, &list, NULL);
}

/* ---------------------------------------------------------------------------------------------- the whole */

bool wh_told_layout_make(wh_told_layout_t *made, const waferhand_cell *cell,
                         const wh_told_layout_options_t *options) {
    wh_layout_t *told = wh_link_layout_from_cell(cell);
    if (!told) {
        return false;
    }
    memset(made, 0, sizeof *made);
    made->told = told;
    made->hash = (uint64_t)cell->layout_hash;
    made->collision = cell->collision;
    made->world_hash = (uint64_t)cell->world_hash;
    made->layout = load(made, options->path ? options->path : told->path, options);
    made->is_whole = made->layout != NULL;
    if (!made->is_whole) {
        fill_machine(told);
        fill_shapes(made);
        made->layout = told;
    }
    return true;
}

static const char *lacks_placing(const wh_layout_t *layout, wh_event_kind_t kind) {
    if (kind == WH_EVENT_PLACED_OFF_CENTRE && !(layout->cell.off_centre > 0)) {
        return "the cell tells of no wafer beside its place (expected a layout with placing.off_centre)";
    }
    if (kind == WH_EVENT_PLACED_ASKEW && !(layout->cell.askew > 0)) {
        return "the cell tells of no wafer that lies askew (expected a layout with placing.askew)";
    }
    return NULL;
}

static const char *lacks_contact(int8_t collision, wh_event_kind_t kind) {
    if (collision == WH_LINK_NO_COLLISION) {
        return "collisions were not looked at (expected a layout with collision = true)";
    }
    return kind == WH_EVENT_TOO_CLOSE && collision != WH_LINK_GAPS
               ? "no gap has a limit (expected a layout with clearance)"
               : NULL;
}

const char *wh_told_layout_lacks(const wh_told_layout_t *made, wh_event_kind_t kind) {
    if (kind == WH_EVENT_HIT || kind == WH_EVENT_UNDECIDED || kind == WH_EVENT_TOO_CLOSE) {
        return lacks_contact(made->collision, kind);
    }
    if (kind == WH_EVENT_SLIPPED && !(made->layout->physics.pads.mass > 0) &&
        !wh_layout_has_passive(made->layout)) {
        return "slips were not looked for (expected a layout with pads)";
    }
    return lacks_placing(made->layout, kind);
}

void wh_told_layout_free(wh_told_layout_t *made) {
    wh_link_layout_free(made->told);
    wh_sandbox_free(made->sandbox);
    free(made->parts);
    free(made->names);
    memset(made, 0, sizeof *made);
}
