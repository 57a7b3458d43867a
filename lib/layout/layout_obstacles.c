#include "layout_obstacles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "layout_internal.h"
#include "stl.h"

void wh_obstacles_add(wh_part_list_t *list, const wh_obstacles_t *obstacles, bool fixed) {
    for (size_t i = 0; i < obstacles->count; ++i) {
        const wh_part_t *part = &obstacles->items[i].part;
        if ((part->kind == WH_PART_FIXED) == fixed) {
            wh_shapes_add(list, part, "%s", obstacles->items[i].name);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ shapes */

static void read_box(wh_reader_t *reader, wh_convex_t *convex) {
    const wh_vec3_t size = wh_reader_vector(reader, "box", NULL);
    convex->kind = WH_CONVEX_BOX;
    convex->half = wh_vec3_scale(WH_REAL(0.5), &size);
}

/* `cylinder` and `capsule` are { radius = , height = } about their middle; a capsule's height is without its caps. */
static void read_round(wh_reader_t *reader, const char *field, wh_convex_kind_t kind, wh_convex_t *convex) {
    wh_reader_enter(reader, field);
    wh_reader_refuse_unknown(reader, "radius height");
    convex->kind = kind;
    convex->half.x = wh_reader_number(reader, "radius", WH_REAL(NAN), WH_CONVEX_THINNEST, 1e4);
    convex->half.z = wh_reader_number(reader, "height", WH_REAL(NAN),
                                      kind == WH_CONVEX_CAPSULE ? 0 : WH_CONVEX_THINNEST, 1e4) /
                     2;
    wh_reader_leave(reader);
}

/* A path relative to the layout's own folder. */
static void path_of(char *path, size_t size, const wh_layout_t *layout, const char *name) {
    const char *slash = strrchr(layout->path, '/');
    const int folder = name[0] == '/' || !slash ? 0 : (int)(slash - layout->path) + 1;
    snprintf(path, size, "%.*s%s", folder, layout->path, name);
}

static void read_mesh(wh_reader_t *reader, const wh_layout_t *layout, wh_convex_t *convex) {
    static const char *const units[] = {"mm", "cm", "m", "inch", NULL};
    static const double mm_per_unit[] = {1, 10, 1000, 25.4};
    char name[512];
    char path[1024];
    char message[512];
    wh_vec3_t *points = NULL;
    wh_reader_text(reader, "mesh", NULL, name, sizeof name);
    const int unit = wh_reader_choice(reader, "unit", -1, units);
    if (unit < 0) {
        lua_pushnil(reader->L);
        wh_reader_fail(reader, "unit", "the mesh's unit: \"mm\", \"cm\", \"m\" or \"inch\"");
    }
    path_of(path, sizeof path, layout, name);
    if (!wh_stl_read(path, mm_per_unit[unit], &points, &convex->point_count, message, sizeof message)) {
        lua_pushstring(reader->L, name);
        wh_reader_fail(reader, "mesh", "a convex mesh in an STL file: %s", message);
    }
    wh_vec3_t *kept = wh_layout_memory(reader->L, convex->point_count, sizeof *kept);
    memcpy(kept, points, convex->point_count * sizeof *kept);
    free(points);
    convex->kind = WH_CONVEX_MESH;
    convex->points = kept;
}

static bool has(const wh_reader_t *reader, const char *field) {
    lua_pushstring(reader->L, field);
    const bool there = lua_rawget(reader->L, -2) != LUA_TNIL;
    lua_pop(reader->L, 1);
    return there;
}

static void read_shape(wh_reader_t *reader, const wh_layout_t *layout, wh_convex_t *convex) {
    static const char *const kinds[] = {"box", "cylinder", "capsule", "mesh"};
    int given = -1;
    for (int i = 0; i < 4; ++i) {
        if (has(reader, kinds[i])) {
            if (given >= 0) {
                lua_pushstring(reader->L, kinds[i]);
                wh_reader_fail(reader, kinds[i], "one shape; %s is given as well", kinds[given]);
            }
            given = i;
        }
    }
    switch (given) {
    case 0:
        read_box(reader, convex);
        break;
    case 1:
        read_round(reader, "cylinder", WH_CONVEX_CYLINDER, convex);
        break;
    case 2:
        read_round(reader, "capsule", WH_CONVEX_CAPSULE, convex);
        break;
    case 3:
        read_mesh(reader, layout, convex);
        break;
    default:
        lua_pushnil(reader->L);
        wh_reader_fail(reader, "box", "a shape: box = { x, y, z }, cylinder, capsule or mesh");
    }
}

/* ------------------------------------------------------------------------------------------------------- place */

/* What it hangs on: base, a body of the arm, or a gripper. */
static void read_mount(wh_reader_t *reader, const wh_layout_t *layout, wh_part_t *part) {
    static const char *const bodies[WH_ARM_BODIES] = {"column", "lift", "upper arm", "forearm", "hand"};
    char on[WH_NAME_SIZE];
    wh_reader_text(reader, "on", "base", on, sizeof on);
    part->kind = WH_PART_FIXED;
    part->owner = WH_NONE;
    if (strcmp(on, "base") == 0) {
        return;
    }
    for (int32_t body = 0; body < (int32_t)WH_ARM_BODIES; ++body) {
        if (strcmp(on, bodies[body]) == 0) {
            part->kind = WH_PART_ARM;
            part->owner = body;
            return;
        }
    }
    part->owner = wh_layout_find_gripper(layout, on);
    if (part->owner == WH_NONE) {
        lua_pushstring(reader->L, on);
        wh_reader_fail(reader, "on",
                       "\"base\", \"lift\", \"upper arm\", \"forearm\", \"hand\" or a gripper's name");
    }
    part->kind = layout->grippers[part->owner].station == WH_NONE ? WH_PART_BLADE : WH_PART_CHUCK;
}

static void read_obstacle(wh_reader_t *reader, const wh_layout_t *layout, size_t index,
                          wh_obstacle_t *obstacle) {
    static const wh_vec3_t level = {0, 0, 0};
    char fallback[WH_NAME_SIZE];
    wh_convex_t *convex = &obstacle->part.convex;
    wh_reader_refuse_unknown(reader, "name on at rpy box cylinder capsule mesh unit");
    snprintf(fallback, sizeof fallback, "obstacle %zu", index + 1);
    wh_reader_text(reader, "name", fallback, obstacle->name, WH_NAME_SIZE);
    read_mount(reader, layout, &obstacle->part);
    read_shape(reader, layout, convex);
    const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &level);
    convex->body_from_shape.R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
    convex->body_from_shape.r = wh_reader_vector(reader, "at", NULL);
    const wh_status_t status = wh_convex_validate(convex);
    if (status != WH_OK) {
        lua_pushstring(reader->L, obstacle->name);
        wh_reader_fail(reader, NULL, "a shape of at least %g mm in each direction: %s",
                       (double)WH_CONVEX_THINNEST, wh_status_text(status));
    }
}

void wh_layout_read_obstacles(wh_reader_t *reader, const wh_layout_t *layout, wh_obstacles_t *obstacles) {
    memset(obstacles, 0, sizeof *obstacles);
    if (!wh_reader_enter(reader, "obstacles")) {
        return;
    }
    obstacles->count = wh_reader_list(reader);
    if (obstacles->count > WH_LAYOUT_OBSTACLES) {
        lua_pushinteger(reader->L, (lua_Integer)obstacles->count);
        wh_reader_fail(reader, NULL, "at most %d obstacles", WH_LAYOUT_OBSTACLES);
    }
    obstacles->items = wh_layout_memory(reader->L, obstacles->count, sizeof *obstacles->items);
    for (size_t i = 0; i < obstacles->count; ++i) {
        wh_reader_enter_item(reader, (lua_Integer)i + 1);
        read_obstacle(reader, layout, i, &obstacles->items[i]);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}
