/* The part of a layout's listing about what has a shape, and the gaps that must be kept. */
#include <stdio.h>

#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../layout/words.h"
#include "layout_print.h"
#include "print_internal.h"

/* Prints the arms of each robot. */
static void print_arms(const wh_layout_t *layout, wh_grid_t *grid) {
    for (size_t robot = 0; robot < wh_machine_robots(&layout->machine); ++robot) {
        const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, NULL);
        const wh_arm_t *arm = wh_layout_arm_lengths(layout, robot);
        char name[WH_NAME_SIZE + 8];
        (void)snprintf(name, sizeof name, "%s%sarm",
                       layout->robot_count > 1 ? layout->robots[robot].name : "",
                       layout->robot_count > 1 ? " " : "");
        wh_grid_named_row(grid, name);
        if (carrier && carrier->chain.kind == WH_CHAIN_SCARA) {
            const wh_real_t *links = carrier->chain.links;
            wh_grid_text(grid, 1, WH_INK_PLAIN, "links of %g and %g, the wrist at the end-effector's origin",
                         links[0], links[1]);
        } else {
            wh_grid_text(grid, 1, WH_INK_PLAIN, "two links of %g, wrist %g behind the end-effector, elbow %s",
                         arm->link, arm->reach, wh_layout_side_words[arm->right_handed]);
        }
    }
}

static void print_shapes(const wh_printer_t *frame, const wh_layout_t *layout) {
    const wh_shapes_t *s = &layout->shapes;
    wh_grid_t *grid = wh_grid_new(frame->style, 1, "shape;size");
    wh_grid_named_row(grid, "blade");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%g thick, %g wide, fingers of %g, %g before its origin, %g behind",
                 s->blade.thickness, 2 * s->blade.half_width, s->blade.finger, s->blade.length,
                 s->blade.palm);
    wh_grid_named_row(grid, "ledges");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%g thick, %g long, from %g to %g beside the middle",
                 s->ledge.thickness, s->ledge.length, s->ledge.inner, s->ledge.outer);
    print_arms(layout, grid);
    wh_grid_named_row(grid, "FOUP");
    wh_grid_text(grid, 1, WH_INK_PLAIN,
                 "walls of %g, %g from the wafer; floor %g below, roof %g above the slots", s->shell.wall,
                 s->shell.room, s->shell.floor, s->shell.roof);
    wh_grid_named_row(grid, "chuck");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "radius %g, %g high; a body of radius %g below it", s->chuck.radius,
                 s->chuck.height, s->chuck.body);
    wh_print_titled(frame, "Shapes, mm", grid);
}

static void describe_mesh(wh_grid_t *grid, size_t column, const char *what, const char *points,
                          const wh_convex_t *mesh) {
    const wh_vec3_t edges = wh_feasibility_extent(mesh);
    wh_grid_text(grid, column, WH_INK_PLAIN, "%s, %zu %s, %g by %g by %g", what, mesh->point_count, points,
                 edges.x, edges.y, edges.z);
}

static void describe_size(wh_grid_t *grid, size_t column, const wh_convex_t *convex) {
    const double x = 2 * convex->half.x;
    const double z = 2 * convex->half.z;
    switch (convex->kind) {
    case WH_CONVEX_BOX:
        wh_grid_text(grid, column, WH_INK_PLAIN, "box, %g by %g by %g", x, 2 * convex->half.y, z);
        break;
    case WH_CONVEX_CYLINDER:
        wh_grid_text(grid, column, WH_INK_PLAIN, "cylinder, %g wide, %g high", x, z);
        break;
    case WH_CONVEX_CAPSULE:
        wh_grid_text(grid, column, WH_INK_PLAIN, "capsule, %g wide, %g high and its caps", x, z);
        break;
    case WH_CONVEX_MESH:
        describe_mesh(grid, column, "mesh", "points", convex);
        break;
    }
}

static const char *carrier_of(const wh_layout_t *layout, const wh_part_t *part, char *name, size_t size) {
    if (part->kind == WH_PART_FIXED) {
        return "base";
    }
    if (part->kind == WH_PART_ARM) {
        wh_layout_name_body(layout, (size_t)part->owner, "column", name, size);
        return name;
    }
    if (part->kind == WH_PART_DOOR) {
        return layout->door_list[part->owner].name;
    }
    return layout->grippers[part->owner].name;
}

static void add_link(const wh_layout_t *layout, wh_grid_t *grid, const char *part_name,
                     const wh_part_t *part) {
    const wh_vec3_t *at = &part->convex.body_from_shape.r;
    char name[2 * WH_NAME_SIZE];
    wh_grid_named_row(grid, part_name);
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", carrier_of(layout, part, name, sizeof name));
    if (part->convex.kind == WH_CONVEX_MESH) {
        describe_mesh(grid, 2, "convex hull of a mesh", "corners", &part->convex);
    } else {
        describe_size(grid, 2, &part->convex);
    }
    wh_grid_numbers(grid, 3, (const double[]){at->x, at->y, at->z}, 3);
}

/* Prints the data of the arms from the robots' URDFs. */
static void print_urdfs(const wh_printer_t *frame, const wh_layout_t *layout) {
    wh_grid_t *grid = wh_grid_new(frame->style, 1, "link;moves with;shape;x{0,6};y{0,6};z{0,6}");
    size_t files = 0;
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const wh_part_list_t *list = layout->robots[r].urdf;
        files += list ? 1 : 0;
        for (size_t i = 0; list && i < list->count; ++i) {
            add_link(layout, grid, list->names[i], &list->parts[i]);
        }
    }
    wh_print_titled(frame, files > 1 ? "Links of the URDFs, mm" : "Links of the URDF, mm", grid);
}

static void print_obstacles(const wh_printer_t *frame, const wh_layout_t *layout) {
    const wh_world_config_t *world = &layout->world;
    wh_grid_t *grid = wh_grid_new(frame->style, 1, "obstacle;on;shape;x{0,6};y{0,6};z{0,6}");
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        const bool hung = i + layout->hung_count >= world->part_count;
        char name[2 * WH_NAME_SIZE];
        if (hung || (part->kind == WH_PART_FIXED && part->owner == WH_NONE)) {
            wh_grid_named_row(grid, layout->part_names[i]);
            wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", carrier_of(layout, part, name, sizeof name));
            describe_size(grid, 2, &part->convex);
            const wh_vec3_t *at = &part->convex.body_from_shape.r;
            wh_grid_numbers(grid, 3, (const double[]){at->x, at->y, at->z}, 3);
        }
    }
    wh_print_titled(frame, "Obstacles, mm", grid);
}

static void print_limits(const wh_printer_t *frame, const wh_layout_t *layout) {
    wh_grid_t *grid = wh_grid_new(frame->style, 1, "clearance;at least mm{0,6}");
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        if (layout->world.limits[kind] > 0) {
            wh_grid_named_row(grid, wh_clearance_name((wh_clearance_kind_t)kind));
            wh_grid_number(grid, 1, WH_INK_PLAIN, layout->world.limits[kind]);
        }
    }
    wh_print_titled(frame, "Clearances", grid);
}

void wh_layout_print_bodies(const wh_printer_t *frame, const wh_layout_t *layout) {
    print_shapes(frame, layout);
    print_urdfs(frame, layout);
    print_obstacles(frame, layout);
    print_limits(frame, layout);
}
