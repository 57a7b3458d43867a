/* A layout's parts for the collision check: shapes by wafer size, and obstacles. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../bodies/hull.h"
#include "../bodies/parts.h"
#include "../bodies/shapes.h"
#include "../bodies/stl.h"
#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../layout/words.h"
#include "../math/trig.h"
#include "layout_internal.h"

/* ------------------------------------------------------------------------------------------------- shapes */

/* `cylinder` and `capsule` are { radius = , height = } about their middle. A capsule's height does not count
 * its caps. */
static void read_round(wh_reader_t *reader, const char *field, wh_convex_t *convex) {
    wh_reader_enter(reader, field);
    wh_reader_refuse_unknown(reader, wh_layout_round_fields);
    convex->half.x = wh_reader_apart(reader, "radius");
    convex->half.z = wh_reader_number(reader, "height", WH_REAL(NAN),
                                      convex->kind == WH_CONVEX_CAPSULE ? 0 : WH_CONVEX_THINNEST, 1e4) /
                     2;
    wh_reader_leave(reader);
}

static void read_mesh(wh_reader_t *reader, const wh_layout_t *layout, wh_convex_t *convex) {
    static const double mm_per_unit[] = {1, 10, 1000, 25.4};
    char name[512];
    char path[1024];
    char message[512];
    wh_vec3_t *points = NULL;
    wh_reader_text(reader, "mesh", NULL, name, sizeof name);
    const int unit = wh_reader_choice(reader, "unit", -1, wh_layout_unit_words);
    if (unit < 0) {
        wh_reader_refuse(reader, "unit", NULL, "the mesh's unit: \"mm\", \"cm\", \"m\" or \"inch\"");
    }
    wh_layout_path(path, sizeof path, layout->path, name);
    if (!wh_stl_read(path, mm_per_unit[unit], &points, &convex->point_count, message, sizeof message)) {
        wh_reader_refuse(reader, "mesh", name, "a convex mesh in an STL file: %s", message);
    }
    if (convex->point_count > WH_STL_FEW) { /* points on its faces need no check in each slice */
        (void)wh_hull_reduce(points, &convex->point_count, message, sizeof message);
    }
    wh_vec3_t *kept = wh_layout_memory(reader->L, convex->point_count, sizeof *kept);
    memcpy(kept, points, convex->point_count * sizeof *kept);
    free(points);
    convex->points = kept;
}

static void read_shape(wh_reader_t *reader, const wh_layout_t *layout, wh_convex_t *convex) {
    static const char *const kinds[] = {[WH_CONVEX_BOX] = "box",
                                        [WH_CONVEX_CYLINDER] = "cylinder",
                                        [WH_CONVEX_CAPSULE] = "capsule",
                                        [WH_CONVEX_MESH] = "mesh"};
    int given = -1;
    for (int i = 0; i < 4; ++i) {
        if (wh_reader_has(reader, kinds[i])) {
            if (given >= 0) {
                wh_reader_refuse(reader, kinds[i], kinds[i], "one shape; %s is given as well", kinds[given]);
            }
            given = i;
        }
    }
    if (given < 0) {
        wh_reader_refuse(reader, "box", NULL, "a shape: box = { x, y, z }, cylinder, capsule or mesh");
    }
    convex->kind = (wh_convex_kind_t)given;
    if (convex->kind == WH_CONVEX_BOX) {
        const wh_vec3_t size = wh_reader_vector(reader, "box", NULL);
        if (size.x < WH_CONVEX_THINNEST || size.y < WH_CONVEX_THINNEST || size.z < WH_CONVEX_THINNEST) {
            (void)wh_reader_push(reader, "box");
            wh_reader_fail(reader, "box", "three sizes of at least %g mm", (double)WH_CONVEX_THINNEST);
        }
        convex->half = wh_vec3_scale(WH_REAL(0.5), &size);
    } else if (convex->kind == WH_CONVEX_MESH) {
        read_mesh(reader, layout, convex);
    } else {
        read_round(reader, kinds[given], convex);
    }
}

/* -------------------------------------------------------------------------------------------------- place */

/* The body of an arm that has this name; WH_NONE: none. */
static int32_t find_body(const wh_layout_t *layout, const char *on) {
    for (size_t number = 0; number < wh_layout_arms(layout) * WH_ARM_BODIES; ++number) {
        char name[2 * WH_NAME_SIZE];
        wh_layout_name_body(layout, number, "column", name, sizeof name);
        if (wh_layout_has_body(layout, number) && strcmp(on, name) == 0) {
            return (int32_t)number;
        }
    }
    return WH_NONE;
}

/* Reads the mount of the obstacle: base, a body of an arm, or a gripper. */
static void read_mount(wh_reader_t *reader, const wh_layout_t *layout, wh_part_t *part) {
    char on[2 * WH_NAME_SIZE];
    wh_reader_text(reader, "on", "base", on, sizeof on);
    part->kind = WH_PART_FIXED;
    part->owner = WH_NONE;
    if (strcmp(on, "base") == 0) {
        return;
    }
    part->owner = find_body(layout, on);
    if (part->owner != WH_NONE) {
        part->kind = WH_PART_ARM;
        return;
    }
    part->owner = wh_layout_find_door(layout, on);
    if (part->owner != WH_NONE) {
        part->kind = WH_PART_DOOR;
        return;
    }
    part->owner = wh_layout_find_gripper(layout, on);
    if (part->owner == WH_NONE && layout->robot_count > 1) {
        wh_reader_refuse(reader, "on", on,
                         "\"base\", a gripper's name, or \"%s lift\", \"%s upper arm\", \"%s forearm\", \"%s "
                         "hand\" and so on",
                         layout->robots[0].name, layout->robots[0].name, layout->robots[0].name,
                         layout->robots[0].name);
    }
    if (part->owner == WH_NONE) {
        wh_reader_refuse(
            reader, "on", on,
            "\"base\", \"lift\", \"upper arm\", \"forearm\", \"hand\", a gripper's or a door's name");
    }
    part->kind = layout->grippers[part->owner].station == WH_NONE ? WH_PART_BLADE : WH_PART_CHUCK;
}

void wh_layout_read_shape(wh_reader_t *reader, const wh_layout_t *layout, const char *name,
                          wh_convex_t *convex) {
    static const wh_vec3_t level = {0, 0, 0};
    read_shape(reader, layout, convex);
    const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &level);
    convex->body_from_shape.R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
    convex->body_from_shape.r = wh_reader_vector(reader, "at", NULL);
    const wh_status_t status = wh_convex_validate(convex);
    if (status != WH_OK) {
        wh_reader_refuse(reader, NULL, name, "a shape of at least %g mm in each direction: %s",
                         (double)WH_CONVEX_THINNEST, wh_status_text(status));
    }
}

static void read_obstacle(wh_reader_t *reader, const wh_layout_t *layout, size_t index,
                          wh_obstacle_t *obstacle) {
    char fallback[WH_NAME_SIZE];
    wh_reader_refuse_unknown(reader, wh_layout_obstacle_fields);
    snprintf(fallback, sizeof fallback, "obstacle %zu", index + 1);
    wh_reader_text(reader, "name", fallback, obstacle->name, WH_NAME_SIZE);
    read_mount(reader, layout, &obstacle->part);
    wh_layout_read_shape(reader, layout, obstacle->name, &obstacle->part.convex);
}

/* Each door's wall, behind the obstacles that were read. */
static void read_walls(wh_reader_t *reader, const wh_layout_t *layout, wh_obstacles_t *obstacles) {
    if (!wh_reader_enter(reader, "doors")) {
        return;
    }
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        wh_obstacle_t *wall = &obstacles->items[obstacles->count++];
        (void)snprintf(wall->name, sizeof wall->name, "%s", layout->door_list[d].name);
        wall->part.kind = WH_PART_DOOR;
        wall->part.owner = (int32_t)d;
        wh_reader_enter(reader, wall->name);
        wh_layout_read_shape(reader, layout, wall->name, &wall->part.convex);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

/* How many obstacles there are; `items` then has room for them and for the doors' walls. */
static size_t open_obstacles(wh_reader_t *reader, const wh_layout_t *layout, bool is_given,
                             wh_obstacles_t *obstacles) {
    const size_t count = is_given ? wh_reader_list(reader) : 0;
    if (count > WH_LAYOUT_OBSTACLES) {
        lua_pushinteger(reader->L, (lua_Integer)count);
        wh_reader_fail(reader, NULL, "at most %d obstacles", WH_LAYOUT_OBSTACLES);
    }
    obstacles->items =
        wh_layout_memory(reader->L, count + layout->machine.door_count, sizeof *obstacles->items);
    return count;
}

static void read_obstacles(wh_reader_t *reader, const wh_layout_t *layout, wh_obstacles_t *obstacles) {
    memset(obstacles, 0, sizeof *obstacles);
    const bool is_given = wh_reader_enter(reader, "obstacles");
    const size_t count = open_obstacles(reader, layout, is_given, obstacles);
    for (; obstacles->count < count; ++obstacles->count) {
        wh_reader_enter_item(reader, (lua_Integer)obstacles->count + 1);
        read_obstacle(reader, layout, obstacles->count, &obstacles->items[obstacles->count]);
        wh_reader_leave(reader);
    }
    if (is_given) {
        wh_reader_leave(reader);
    }
    read_walls(reader, layout, obstacles);
}

static void read_blade(wh_reader_t *reader, wh_blade_t *blade) {
    wh_reader_open_section(reader, "blade", wh_layout_blade_fields);
    wh_reader_scalars(reader, blade);
    wh_reader_scalar_within(reader, "finger", blade,
                            blade->finger < blade->half_width ? blade->finger : blade->half_width / 2, 0.1,
                            0.99 * blade->half_width);
    wh_reader_scalar_within(reader, "palm", blade, blade->palm, blade->finger, 1000);
    wh_reader_leave(reader);
}

/* A SCARA's links are the robot's, and its wrist carries the end-effector's origin. */
static void take_scara(wh_reader_t *reader, const char *field, const wh_chain_t *chain, wh_arm_t *arm) {
    if (wh_reader_has(reader, field)) {
        (void)wh_reader_push(reader, field);
        wh_reader_fail(reader, field, "nothing: the links of a robot of kind \"SCARA\" are in its `links`");
    }
    arm->reach = 0;
    arm->link = chain->links[0];
}

static void read_one_arm(wh_reader_t *reader, wh_layout_t *layout) {
    wh_arm_t *arm = &layout->shapes.arm;
    if (wh_layout_is_scara(layout, 0)) {
        take_scara(reader, "arm", &layout->carrier.chain, arm);
    } else {
        wh_reader_open_section(reader, "arm", wh_layout_arm_fields);
        wh_reader_scalars(reader, arm);
        wh_reader_leave(reader);
    }
    wh_layout_refuse_field(reader, "arms", "nothing: it is for a layout with several robots; this has `arm`");
}

static void read_arm_of(wh_reader_t *reader, wh_layout_t *layout, size_t robot) {
    wh_layout_robot_t *of = &layout->robots[robot];
    wh_arm_t *arm = robot == 0 ? &layout->shapes.arm : &of->arm;
    const wh_chain_t *chain = &of->carrier.chain;
    if (wh_layout_is_scara(layout, robot)) {
        take_scara(reader, of->name, chain, arm);
    } else if (wh_reader_open(reader, of->name, wh_layout_arm_fields)) {
        wh_reader_scalars(reader, arm);
        wh_reader_leave(reader);
    }
}

static void refuse_other_arms(wh_reader_t *reader, const wh_layout_t *layout) {
    size_t count = 0;
    const wh_layout_robot_t *said =
        wh_layout_read_keys(reader, WH_LAYOUT_STATIONS, sizeof *said, "robots", &count);
    for (size_t i = 0; i < count; ++i) {
        if (wh_layout_find_robot(layout, said[i].name) == WH_NONE) {
            lua_pushstring(reader->L, said[i].name);
            wh_reader_fail(reader, NULL, "robots of this layout by name");
        }
    }
}

/* With several robots, `arms` has the fields of each robot by name. */
static void read_arms(wh_reader_t *reader, wh_layout_t *layout) {
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        wh_layout_robot_t *of = &layout->robots[robot];
        of->arm = layout->shapes.arm;
        of->arm.link = wh_shapes_link(wh_axis_reach(&layout->machine, robot).max);
        of->lowest = of->carrier.chain.travel[WH_CHAIN_Z].min;
    }
    wh_layout_refuse_field(reader, "arm", "nothing: with several robots `arms` has each one's by name");
    const bool is_said = wh_reader_enter(reader, "arms");
    if (is_said) {
        refuse_other_arms(reader, layout);
    }
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        if (is_said || wh_layout_is_scara(layout, robot)) {
            read_arm_of(reader, layout, robot);
        }
    }
    if (is_said) {
        wh_reader_leave(reader);
    }
}

static void read_ledge(wh_reader_t *reader, wh_ledge_t *ledge) {
    wh_reader_open_section(reader, "ledge", wh_layout_ledge_fields);
    wh_reader_scalars(reader, ledge);
    wh_reader_scalar_within(reader, "inner", ledge,
                            ledge->inner < ledge->outer ? ledge->inner : 0.9 * ledge->outer, 0,
                            0.999 * ledge->outer);
    wh_reader_leave(reader);
}

static void read_shell(wh_reader_t *reader, wh_shell_t *shell) {
    wh_reader_open_section(reader, "foup", wh_layout_foup_fields);
    wh_reader_scalars(reader, shell);
    wh_reader_leave(reader);
}

static void read_chuck(wh_reader_t *reader, wh_spindle_t *chuck) {
    wh_reader_open_section(reader, "chuck", wh_layout_spindle_fields);
    wh_reader_scalars(reader, chuck);
    wh_reader_leave(reader);
}

void wh_layout_read_shapes(wh_reader_t *reader, wh_layout_t *layout) {
    const wh_travel_t *travel = layout->machine.robot.travel;
    const wh_real_t farthest = wh_axis_reach(&layout->machine, 0).max;
    wh_shapes_t *shapes = &layout->shapes;
    *shapes =
        wh_shapes_default(layout->wafer_diameter, layout->wafer_thickness, farthest, travel[WH_AXIS_Z].min);
    wh_reader_open_section(reader, "shapes", wh_layout_shapes_fields);
    read_blade(reader, &shapes->blade);
    if (layout->robot_count > 1) {
        read_arms(reader, layout);
    } else {
        read_one_arm(reader, layout);
    }
    read_ledge(reader, &shapes->ledge);
    read_shell(reader, &shapes->shell);
    read_chuck(reader, &shapes->chuck);
    wh_reader_leave(reader);
    wh_layout_read_urdfs(reader, layout);
}

/* --------------------------------------------------------------------------------------------- clearances */

static void read_limits(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_open_section(reader, "clearance", wh_layout_clearance_fields);
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        layout->world.limits[kind] = wh_reader_apart(reader, wh_clearance_name((wh_clearance_kind_t)kind));
    }
    wh_reader_leave(reader);
}

/* -------------------------------------------------------------------------------------------------- world */

/* The carriers of parts: the grippers, then the arm and the doors. */
enum { ON_ARM = WH_GRIPPERS, ON_DOORS, CARRIERS };

/* Counts the parts that hang on each of them, a gripper's own included. */
static void count_hanging(const wh_world_config_t *world, int counts[CARRIERS]) {
    memset(counts, 0, CARRIERS * sizeof *counts);
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        if (part->kind == WH_PART_BLADE || part->kind == WH_PART_CHUCK) {
            ++counts[part->owner];
        } else if (part->kind == WH_PART_ARM) {
            ++counts[ON_ARM];
        } else if (part->kind == WH_PART_DOOR) {
            ++counts[ON_DOORS];
        }
    }
}

static const char *name_carrier(const wh_layout_t *layout, size_t carrier) {
    return carrier == ON_DOORS ? "doors" : carrier == ON_ARM ? "the arm" : layout->grippers[carrier].name;
}

/* Checks the world's limit; the error names the body that has most of the parts. */
static void check_hanging(const wh_reader_t *reader, const wh_layout_t *layout) {
    int counts[CARRIERS];
    size_t fullest = ON_ARM;
    int sum = 0;
    count_hanging(&layout->world, counts);
    for (size_t i = 0; i < CARRIERS; ++i) {
        sum += counts[i];
        fullest = counts[i] > counts[fullest] ? i : fullest;
    }
    if (sum > WH_WORLD_MOVING) {
        lua_pushinteger(reader->L, sum);
        wh_reader_fail(
            reader, "obstacles",
            "at most %d parts on robot, grippers and doors together, their own included; %s has %d of them: "
            "join obstacles on it into one convex shape or mesh, or leave some out",
            WH_WORLD_MOVING, name_carrier(layout, fullest), counts[fullest]);
    }
}

static void check_world(wh_reader_t *reader, const wh_layout_t *layout) {
    int32_t part = WH_NONE;
    check_hanging(reader, layout);
    const wh_status_t status = wh_world_validate(&layout->world, &part);
    if (status != WH_OK) {
        wh_reader_refuse(reader, "shapes", part == WH_NONE ? "all parts" : layout->part_names[part],
                         "parts that can be checked: %s", wh_status_text(status));
    }
}

void wh_layout_read_world(wh_reader_t *reader, wh_layout_t *layout) {
    wh_obstacles_t obstacles;
    read_obstacles(reader, layout, &obstacles);
    read_limits(reader, layout);
    const size_t capacity = wh_layout_count_parts(layout) + obstacles.count;
    layout->collision = wh_reader_apart(reader, "collision") > 0;
    layout->look_ahead = wh_reader_apart(reader, "look_ahead") > 0;
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
