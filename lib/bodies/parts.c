/* The parts of a whole layout, in the order of wh_world_validate. */
#include "parts.h"

#include <stdio.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/axes.h"

static wh_stand_t stand_of(const wh_layout_station_t *station) {
    if (station->prealigner) {
        return WH_STAND_CHUCK;
    }
    if (station->flipper) {
        return WH_STAND_NOTHING;
    }
    return station->foup ? WH_STAND_FOUP : WH_STAND_LEDGES;
}

/* The robot of an arm, also in a layout that knows of no robot; and its data from a URDF, or null. */
static size_t robot_of(const wh_layout_t *layout, size_t arm) {
    return arm == 0 ? 0 : (size_t)layout->arms[arm].robot;
}

static const wh_part_list_t *urdf_of(const wh_layout_t *layout, size_t robot) {
    return robot < layout->robot_count ? layout->robots[robot].urdf : NULL;
}

size_t wh_layout_count_parts(const wh_layout_t *layout) {
    size_t count = WH_SHAPES_GRIPPER * layout->machine.gripper_count;
    for (size_t arm = 0; arm < wh_layout_arms(layout); ++arm) {
        count += urdf_of(layout, robot_of(layout, arm)) ? 0 : WH_SHAPES_ROBOT;
    }
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        const wh_part_list_t *urdf = urdf_of(layout, robot);
        count += urdf ? urdf->count : 0;
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        count += layout->grips[g].kind == WH_GRIP_EDGE ? WH_SHAPES_EDGE : 0;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        count += wh_shapes_count_station(stand_of(&layout->stations[s]), layout->places[s].slots);
    }
    return count;
}

static void add_stations(const wh_layout_t *layout, wh_part_list_t *list) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_shapes_add_station(list, &layout->shapes, &layout->places[s], (int32_t)s,
                              stand_of(&layout->stations[s]), layout->stations[s].name);
    }
}

/* Adds the fixed obstacles, or those that hang on something. */
static void add_obstacles(wh_part_list_t *list, const wh_obstacles_t *obstacles, bool fixed) {
    for (size_t i = 0; obstacles && i < obstacles->count; ++i) {
        const wh_part_t *part = &obstacles->items[i].part;
        if ((part->kind == WH_PART_FIXED) == fixed) {
            wh_shapes_add(list, part, "%s", obstacles->items[i].name);
        }
    }
}

/* The links of one arm by their usual shapes. */
static void add_arm(const wh_layout_t *layout, wh_part_list_t *list, size_t arm) {
    const size_t robot = robot_of(layout, arm);
    const wh_carrier_t *carrier = wh_layout_arm(layout, arm, NULL);
    const wh_arm_t *lengths = wh_layout_arm_lengths(layout, robot);
    char name[WH_NAME_SIZE + 1] = "";
    wh_shapes_arm_t shape = {.links = {lengths->link, lengths->link},
                             .reach = lengths->reach,
                             .lowest = wh_layout_lowest(layout, robot),
                             .first = arm * WH_ARM_BODIES,
                             .robot = name,
                             .number = "",
                             .own = arm == 0 ? WH_ARM_BASE : layout->arms[arm].own};
    if (wh_layout_is_scara(layout, robot)) {
        memcpy(shape.links, carrier->chain.links, sizeof shape.links);
    }
    if (layout->robot_count > 1) {
        (void)snprintf(name, sizeof name, "%s ", layout->robots[robot].name);
    }
    if (shape.own != WH_ARM_BASE) {
        shape.number = " 2";
    }
    wh_shapes_add_arm(list, &layout->shapes, &shape);
}

/* A robot's URDF, with all of its arms, stands where its first arm would. */
static void add_robots(const wh_layout_t *layout, wh_part_list_t *list) {
    for (size_t arm = 0; arm < wh_layout_arms(layout); ++arm) {
        const wh_part_list_t *urdf = urdf_of(layout, robot_of(layout, arm));
        const bool is_first = arm == 0 || layout->arms[arm].own == WH_ARM_BASE;
        for (size_t i = 0; urdf && is_first && i < urdf->count; ++i) {
            wh_shapes_add(list, &urdf->parts[i], "%s", urdf->names[i]);
        }
        if (!urdf) {
            add_arm(layout, list, arm);
        }
    }
}

static void add_gripper(wh_layout_t *layout, wh_part_list_t *list, size_t g) {
    const wh_mount_t *mount = &layout->machine.mounts[g];
    const bool on_robot = layout->grippers[g].station == WH_NONE;
    /* Pins and clamps have none, unless obstacles give them one. */
    if (wh_layout_is_pins(layout, g) || wh_layout_is_flipper(layout, g)) {
        return;
    }
    wh_shapes_add_gripper(list, &layout->shapes, (int32_t)g,
                          wh_layout_arm_lengths(layout, mount->robot)->reach,
                          on_robot ? &mount->effector_from_gripper : NULL, layout->grippers[g].name);
    if (layout->grips[g].kind == WH_GRIP_EDGE) {
        layout->world.edges |= UINT32_C(1) << g;
        wh_shapes_add_edge(list, &layout->shapes, (int32_t)g, &layout->grips[g].edge,
                           layout->grippers[g].name);
    }
}

/* Fixed parts come first, then those that hang on something: wh_world_validate asks for that order. */
static void add_parts(wh_layout_t *layout, wh_part_list_t *list, const wh_obstacles_t *obstacles) {
    add_stations(layout, list);
    add_obstacles(list, obstacles, true);
    add_robots(layout, list);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        add_gripper(layout, list, g);
    }
    layout->hung_count = list->count;
    add_obstacles(list, obstacles, false);
    layout->hung_count = list->count - layout->hung_count;
}

static void take_list(wh_layout_t *layout, const wh_part_list_t *list) {
    wh_world_config_t *world = &layout->world;
    layout->part_names = (const char(*)[WH_PART_NAME_SIZE])list->names;
    world->parts = list->parts;
    world->part_count = list->count;
    world->cell = &layout->cell;
    world->grasp = &layout->grasp;
}

void wh_layout_move_world(wh_layout_t *copy, wh_part_t *parts, char (*names)[WH_PART_NAME_SIZE]) {
    const wh_world_config_t *world = &copy->world;
    wh_part_list_t list = {
        .parts = parts, .names = names, .capacity = world->part_count + copy->station_count};
    add_stations(copy, &list);
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        const bool is_fixed = part->kind == WH_PART_FIXED || part->kind == WH_PART_LEDGE;
        if (!is_fixed || part->owner == WH_NONE) { /* not of a station */
            wh_shapes_add(&list, part, "%s", copy->part_names[i]);
        }
    }
    take_list(copy, &list);
}

void wh_layout_set_parts(wh_layout_t *layout, wh_part_list_t *list, const wh_obstacles_t *obstacles) {
    wh_world_config_t *world = &layout->world;
    add_parts(layout, list, obstacles);
    take_list(layout, list);
    world->wafer = wh_shapes_wafer(&layout->shapes);
    world->gripper_count = layout->machine.gripper_count;
    world->door_count = layout->machine.door_count;
    world->wafer_count = layout->wafer_count;
}
