/* A layout's shapes for the collision check: defaults by wafer size, changed where the layout says so. */
#include <stdio.h>
#include <string.h>

#include "layout_internal.h"

static void read_blade(wh_reader_t *reader, wh_blade_t *blade) {
    if (!wh_reader_enter(reader, "blade")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "thickness half_width finger length palm");
    blade->thickness = wh_reader_number(reader, "thickness", blade->thickness, 0.1, 50);
    blade->half_width = wh_reader_number(reader, "half_width", blade->half_width, 1, 500);
    blade->finger = wh_reader_number(
        reader, "finger", blade->finger < blade->half_width ? blade->finger : blade->half_width / 2, 0.1,
        0.99 * blade->half_width);
    blade->length = wh_reader_number(reader, "length", blade->length, 1, 1000);
    blade->palm = wh_reader_number(reader, "palm", blade->palm, blade->finger, 1000);
    wh_reader_leave(reader);
}

static void read_arm(wh_reader_t *reader, wh_arm_t *arm) {
    if (!wh_reader_enter(reader, "arm")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "reach link right_handed");
    arm->reach = wh_reader_number(reader, "reach", arm->reach, 0, 2000);
    arm->link = wh_reader_number(reader, "link", arm->link, 10, 5000);
    arm->right_handed = wh_reader_boolean(reader, "right_handed", arm->right_handed);
    wh_reader_leave(reader);
}

static void read_ledge(wh_reader_t *reader, wh_ledge_t *ledge) {
    if (!wh_reader_enter(reader, "ledge")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "inner outer thickness length");
    ledge->outer = wh_reader_number(reader, "outer", ledge->outer, 1, 2000);
    ledge->inner =
        wh_reader_number(reader, "inner", ledge->inner < ledge->outer ? ledge->inner : 0.9 * ledge->outer, 0,
                         0.999 * ledge->outer);
    ledge->thickness = wh_reader_number(reader, "thickness", ledge->thickness, 0.05, 100);
    ledge->length = wh_reader_number(reader, "length", ledge->length, 0.1, 2000);
    wh_reader_leave(reader);
}

static void read_shell(wh_reader_t *reader, wh_shell_t *shell) {
    if (!wh_reader_enter(reader, "foup")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "room wall floor roof");
    shell->room = wh_reader_number(reader, "room", shell->room, 0.1, 500);
    shell->wall = wh_reader_number(reader, "wall", shell->wall, 0.1, 100);
    shell->floor = wh_reader_number(reader, "floor", shell->floor, 1, 500);
    shell->roof = wh_reader_number(reader, "roof", shell->roof, 1, 500);
    wh_reader_leave(reader);
}

static void read_chuck(wh_reader_t *reader, wh_spindle_t *chuck) {
    if (!wh_reader_enter(reader, "chuck")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "radius height body");
    chuck->radius = wh_reader_number(reader, "radius", chuck->radius, 1, 500);
    chuck->height = wh_reader_number(reader, "height", chuck->height, 1, 200);
    chuck->body = wh_reader_number(reader, "body", chuck->body, 1, 1000);
    wh_reader_leave(reader);
}

void wh_layout_read_shapes(wh_reader_t *reader, wh_layout_t *layout) {
    const wh_travel_t *travel = layout->machine.robot.travel;
    wh_shapes_t *shapes = &layout->shapes;
    *shapes = wh_shapes_default(layout->wafer_diameter, layout->wafer_thickness, travel[WH_AXIS_R].max,
                                travel[WH_AXIS_Z].min);
    if (wh_reader_enter(reader, "shapes")) {
        wh_reader_refuse_unknown(reader, "blade arm ledge foup chuck");
        read_blade(reader, &shapes->blade);
        read_arm(reader, &shapes->arm);
        read_ledge(reader, &shapes->ledge);
        read_shell(reader, &shapes->shell);
        read_chuck(reader, &shapes->chuck);
        wh_reader_leave(reader);
    }
}

/* ------------------------------------------------------------------------------------------------- clearances */

static void read_limits(wh_reader_t *reader, wh_layout_t *layout) {
    char known[256] = "";
    size_t length = 0;
    for (int kind = 0; kind < WH_CLEARANCES && length < sizeof known; ++kind) {
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s", kind > 0 ? " " : "",
                                   wh_clearance_name((wh_clearance_kind_t)kind));
    }
    if (!wh_reader_enter(reader, "clearance")) {
        return;
    }
    wh_reader_refuse_unknown(reader, known);
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        const char *name = wh_clearance_name((wh_clearance_kind_t)kind);
        layout->world.limits[kind] = wh_reader_number(reader, name, 0, 0, WH_CLEARANCE_RANGE);
    }
    wh_reader_leave(reader);
}

/* ------------------------------------------------------------------------------------------------------- parts */

static wh_stand_t stand_of(const wh_layout_station_t *station) {
    if (station->prealigner) {
        return WH_STAND_CHUCK;
    }
    return station->foup ? WH_STAND_FOUP : WH_STAND_LEDGES;
}

size_t wh_layout_count_parts(const wh_layout_t *layout) {
    size_t count = WH_SHAPES_ROBOT + WH_SHAPES_GRIPPER * layout->machine.gripper_count;
    for (size_t s = 0; s < layout->station_count; ++s) {
        count += wh_shapes_count_station(stand_of(&layout->stations[s]), layout->places[s].slots);
    }
    return count;
}

/* Fixed parts come first, then those that hang on something. */
static void add_parts(wh_layout_t *layout, wh_part_list_t *list, const wh_obstacles_t *obstacles) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_shapes_add_station(list, &layout->shapes, &layout->places[s], (int32_t)s,
                              stand_of(&layout->stations[s]), layout->stations[s].name);
    }
    wh_obstacles_add(list, obstacles, true);
    wh_shapes_add_robot(list, &layout->shapes);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        wh_shapes_add_gripper(list, &layout->shapes, (int32_t)g, layout->grippers[g].station == WH_NONE,
                              layout->grippers[g].name);
    }
    layout->hung_count = list->count;
    wh_obstacles_add(list, obstacles, false);
    layout->hung_count = list->count - layout->hung_count;
}

void wh_layout_set_parts(wh_layout_t *layout, wh_part_list_t *list, const wh_obstacles_t *obstacles) {
    wh_world_config_t *world = &layout->world;
    add_parts(layout, list, obstacles);
    layout->part_names = (const char(*)[WH_PART_NAME_SIZE])list->names;
    world->parts = list->parts;
    world->part_count = list->count;
    world->wafer = wh_shapes_wafer(&layout->shapes);
    world->arm = layout->shapes.arm;
    world->gripper_count = layout->machine.gripper_count;
    world->wafer_count = layout->wafer_count;
    world->cell = &layout->cell;
    world->grasp = &layout->grasp;
}

static void check_world(wh_reader_t *reader, const wh_layout_t *layout) {
    int32_t part = WH_NONE;
    const wh_status_t status = wh_world_validate(&layout->world, &part);
    if (status != WH_OK) {
        lua_pushstring(reader->L, part == WH_NONE ? "all parts" : layout->part_names[part]);
        wh_reader_fail(reader, "shapes", "parts that can be checked: %s", wh_status_text(status));
    }
}

void wh_layout_read_world(wh_reader_t *reader, wh_layout_t *layout) {
    wh_obstacles_t obstacles;
    wh_layout_read_obstacles(reader, layout, &obstacles);
    read_limits(reader, layout);
    const size_t capacity = wh_layout_count_parts(layout) + obstacles.count;
    layout->collision = wh_reader_boolean(reader, "collision", false);
    layout->look_ahead = wh_reader_boolean(reader, "look_ahead", false);
    if (capacity > WH_LAYOUT_PARTS) {
        lua_pushinteger(reader->L, (lua_Integer)capacity);
        if (layout->collision || layout->look_ahead) {
            wh_reader_fail(reader, layout->collision ? "collision" : "look_ahead",
                           "false with more than %d parts, ledges included", WH_LAYOUT_PARTS);
        }
        lua_pop(reader->L, 1);
        return;
    }
    wh_part_list_t list = {.capacity = capacity};
    list.parts = wh_layout_memory(reader->L, capacity, sizeof *list.parts);
    list.names = wh_layout_memory(reader->L, capacity, sizeof *list.names);
    wh_layout_set_parts(layout, &list, &obstacles);
    check_world(reader, layout);
}

const char *wh_layout_part_name(const wh_layout_t *layout, int32_t part) {
    if (part < 0 || !layout->part_names) {
        return NULL;
    }
    if ((size_t)part < layout->world.part_count) {
        return layout->part_names[part];
    }
    const size_t wafer = (size_t)part - layout->world.part_count;
    return wafer < layout->wafer_count ? layout->wafers[wafer].name : NULL;
}
