#include "layout_read.h"

#include <lauxlib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/along_arm.h"
#include "../layout/arms.h"
#include "../layout/grips.h"
#include "../math/trig.h"
#include "../text/nearest.h"
#include "layout_internal.h"
#include "layout_tool.h"

/* The registry's list of all memory of layouts. It is never cleared, because a record may outlive a second
 * `cell`. */
#define OWNED "waferhand.layouts"

void *wh_layout_memory(lua_State *L, size_t count, size_t size) {
    const size_t bytes = (count > 0 ? count : 1) * size;
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, OWNED);
    void *memory = lua_newuserdatauv(L, bytes, 0);
    memset(memory, 0, bytes);
    lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
    lua_pop(L, 1);
    return memory;
}

void wh_layout_path(char *path, size_t size, const char *beside, const char *name) {
    const char *slash = strrchr(beside, '/');
    const int folder = name[0] == '/' || !slash ? 0 : (int)(slash - beside) + 1;
    snprintf(path, size, "%.*s%s", folder, beside, name);
}

/* ------------------------------------------------------------------------------------ how a run is judged */

/* The usual sizes of wafers, all in mm. Others have no thickness and pitch of their own. */
static const struct wafer_size {
    double diameter, thickness, pitch; /* 0: ends the list */
} sizes[] = {{100, 0.525, 4.76}, {125, 0.625, 4.76}, {150, 0.675, 4.76},
             {200, 0.725, 6.35}, {300, 0.775, 10},   {0, 0, 0}};

/* A wafer's diameter may differ from its size by so much, mm. */
#define SIZE_SLACK 1

/* Wafers below this, mm, have flats in place of a notch. */
#define LEAST_NOTCHED 199

/* The size of a layout's wafers, or the end of the list. */
static const struct wafer_size *size_of(const wh_layout_t *layout) {
    const struct wafer_size *size = sizes;
    while (size->diameter > 0 && fabs(layout->wafer_diameter - size->diameter) > SIZE_SLACK) {
        ++size;
    }
    return size;
}

double wh_layout_sized(wh_reader_t *reader, const wh_layout_t *layout, const char *field, double fallback) {
    const wh_reader_field_t *row = wh_reader_row(reader, field);
    if (!(fallback > 0) && !wh_reader_has(reader, field)) {
        wh_reader_refuse(
            reader, field, NULL,
            "a number from %.12g to %.12g: wafers of %.12g mm have no default, those of 100, 125, "
            "150, 200 and 300 mm have",
            row->least, row->most, layout->wafer_diameter);
    }
    return wh_reader_apart_from(reader, field, fallback > 0 ? fallback : row->least);
}

double wh_layout_default_pitch(const wh_layout_t *layout) {
    return size_of(layout)->pitch;
}

/* Below the smallest wafers there are, and around the numbers of sizes in inches. */
static void refuse_inches(wh_reader_t *reader) {
    const double least = 25; /* below 1 it is rather metres, which the reader asks */
    const bool is_number = wh_reader_push(reader, "diameter") == LUA_TNUMBER;
    const double diameter = lua_tonumber(reader->L, -1);
    if (is_number && diameter >= 1 && diameter < least) {
        wh_reader_fail(reader, "diameter",
                       "mm, from %.12g to 1000; is that inches? 6 inches are 150 mm, 8 are 200, 12 are 300, "
                       "18 are 450",
                       least);
    }
    lua_pop(reader->L, 1);
}

/* The notch shows people and prealigners how the wafer is turned. For the checks the wafer stays a disc. */
static void read_notch(wh_reader_t *reader, wh_layout_t *layout) {
    layout->notch_depth = layout->wafer_diameter < LEAST_NOTCHED ? 0 : 1;
    if (wh_reader_open(reader, "notch", wh_layout_notch_fields)) {
        layout->notch = wh_rad_from_deg(wh_reader_apart(reader, "at"));
        layout->notch_depth = wh_reader_number(reader, "depth", 1, 0, layout->wafer_diameter / 4);
        wh_reader_leave(reader);
    }
}

static void read_wafer(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_open_section(reader, "wafer", wh_layout_wafer_size_fields);
    refuse_inches(reader);
    wh_reader_scalars(reader, layout);
    layout->wafer_thickness = wh_layout_sized(reader, layout, "thickness", size_of(layout)->thickness);
    read_notch(reader, layout);
    wh_reader_leave(reader);
}

/* Stations are tilted by less than 45 degrees, and blades by less than wafers bear: a limit below that would
 * have no effect. */
#define LEAST_PLANAR WH_REAL(0.7)

/* Refuses limits that a wafer which is not there would keep: a blade that is nowhere below it takes none. */
static void check_limits(wh_reader_t *reader, const wh_layout_t *layout) {
    const wh_tolerance_t *tolerance = &layout->grasp.tolerance;
    const double radius = layout->wafer_diameter / 2;
    if (tolerance->projxy > radius) {
        lua_pushnumber(reader->L, tolerance->projxy);
        wh_reader_fail(reader, "projxy",
                       "at most the wafer's radius, %.10g mm: farther out no pad is below it; \"strict\" "
                       "has 5",
                       radius);
    }
    if (tolerance->planar < LEAST_PLANAR) {
        lua_pushnumber(reader->L, tolerance->planar);
        wh_reader_fail(reader, "planar",
                       "%.10g or more, the cosine of 45 degrees: beyond that no wafer lies on pads; "
                       "\"paper\" has 0.99",
                       (double)LEAST_PLANAR);
    }
}

static void check_preset(wh_reader_t *reader, const wh_layout_t *layout) {
    const double radius = layout->wafer_diameter / 2;
    if (layout->grasp.tolerance.projxy > radius) {
        (void)wh_reader_push(reader, "tolerance");
        wh_reader_fail(reader, "tolerance",
                       "{ projxy = } of at most the wafer's radius, %.10g mm: farther out no pad is below it",
                       radius);
    }
}

static void read_limits(wh_reader_t *reader, wh_layout_t *layout) {
    static const char *const names[WH_TOLERANCE_LIMITS] = {"projz", "projxy", "planar"};
    (void)wh_reader_open(reader, "tolerance", wh_layout_tolerance_fields);
    for (size_t i = 0; i < WH_TOLERANCE_LIMITS; ++i) {
        layout->tolerance_default[i] = !wh_reader_has(reader, names[i]);
    }
    wh_reader_scalars(reader, &layout->grasp.tolerance);
    check_limits(reader, layout);
    wh_reader_leave(reader);
}

static void read_tolerance(wh_reader_t *reader, wh_layout_t *layout) {
    const char *presets[WH_TOLERANCE_PRESETS + 1] = {NULL};
    const char *name = "own";
    for (size_t i = 0; i < WH_TOLERANCE_PRESETS; ++i) {
        presets[i] = wh_tolerance_preset(i, &layout->grasp.tolerance);
    }
    layout->grasp.tolerance = wh_tolerance_paper();
    const int type = wh_reader_push(reader, "tolerance");
    if (type != LUA_TTABLE && type != LUA_TNIL && type != LUA_TSTRING) {
        wh_reader_fail(reader, "tolerance", "\"paper\", \"strict\" or { projz = , projxy = , planar = }");
    }
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        read_limits(reader, layout);
    } else {
        const int preset = wh_reader_choice(reader, "tolerance", 0, presets);
        name = wh_tolerance_preset((size_t)preset, &layout->grasp.tolerance);
        check_preset(reader, layout);
    }
    snprintf(layout->tolerance_name, sizeof layout->tolerance_name, "%s", name);
}

/* A wafer nearer than the tolerance is taken: with such a limit no miss would be told. */
static void check_near(wh_reader_t *reader, const char *field, wh_real_t near, wh_real_t tolerance) {
    if (wh_reader_has(reader, field) && near < tolerance) {
        lua_pushnumber(reader->L, near);
        wh_reader_fail(reader, field, "%.10g mm or more, tolerance.%s: a wafer that is nearer is no miss",
                       (double)tolerance, field);
    }
}

static void read_near(wh_reader_t *reader, wh_layout_t *layout) {
    const wh_real_t twice = 2 * layout->grasp.tolerance.projxy;
    layout->grasp.near_projxy = twice < WH_REAL(1e6) ? twice : WH_REAL(1e6);
    wh_reader_open_section(reader, "near", wh_layout_near_fields);
    wh_reader_scalars(reader, &layout->grasp);
    check_near(reader, "projz", layout->grasp.near_projz, layout->grasp.tolerance.projz);
    check_near(reader, "projxy", layout->grasp.near_projxy, layout->grasp.tolerance.projxy);
    wh_reader_leave(reader);
}

/* A slice is a whole number of microseconds, so that times of slices are exact. */
static void read_slice(wh_reader_t *reader, wh_layout_t *layout) {
    const double slice = wh_reader_apart(reader, "slice");
    const double exact = slice * 1e6;
    layout->slice_us = llround(exact);
    if (fabs(exact - (double)layout->slice_us) > 1e-6 * exact) {
        lua_pushnumber(reader->L, slice);
        wh_reader_fail(reader, "slice", "a whole number of microseconds, in s");
    }
}

/* A section all of whose fields are scalars. */
static void read_section(wh_reader_t *reader, const char *field, const wh_reader_field_t *fields,
                         void *into) {
    wh_reader_open_section(reader, field, fields);
    wh_reader_scalars(reader, into);
    wh_reader_leave(reader);
}

static void read_mapping(wh_reader_t *reader, wh_layout_t *layout) {
    wh_mapping_t *mapping = &layout->mapping;
    const double diameter = layout->wafer_diameter;
    const double thickness = layout->wafer_thickness;
    wh_reader_open_section(reader, "mapping", wh_layout_mapping_fields);
    wh_reader_scalars(reader, mapping);
    const double most = sqrt(0.95 - mapping->x * mapping->x); /* inside the rim */
    wh_reader_scalar_within(reader, "y", mapping, most < 0.6 ? most : 0.6, 0.1, most);
    wh_reader_scalar_within(reader, "level", mapping, 0, 0, diameter);
    wh_reader_scalar_within(reader, "protruded", mapping, diameter / 10, 0, diameter);
    wh_reader_scalar_within(reader, "thickest", mapping, 1.5 * thickness, thickness, 1000);
    wh_reader_scalar_within(reader, "thinnest", mapping, thickness / 2, 0, thickness);
    wh_reader_leave(reader);
}

static void read_stop(wh_reader_t *reader, wh_layout_t *layout) {
    if (wh_reader_has(reader, "stop")) {
        layout->stop = (int32_t)wh_reader_apart(reader, "stop") + (int32_t)WH_LAYOUT_STOP_RAMP;
    }
}

static void read_checks(wh_reader_t *reader, wh_layout_t *layout) {
    layout->grasp = wh_grasp_config_default();
    wh_reader_scalars(reader, layout);
    read_stop(reader, layout);
    read_wafer(reader, layout);
    read_tolerance(reader, layout);
    read_near(reader, layout);
    read_slice(reader, layout);
    read_section(reader, "placing", wh_layout_placing_fields, &layout->cell);
    read_section(reader, "corrections", wh_layout_corrections_fields, &layout->corrections);
    read_mapping(reader, layout);
}

/* ---------------------------------------------------------------------------------------------- all of it */

/* A cell of times alone has no places: what else a layout has is that of a table with neither stations nor
 * robots of its own. It is left on top of the stack. */
static void stand_in(wh_reader_t *reader, wh_layout_t *layout) {
    lua_State *L = reader->L;
    layout->tool = wh_layout_read_tool(reader);
    lua_createtable(L, 0, 3);
    lua_getfield(L, -2, "study");
    lua_setfield(L, -2, "study");
    lua_newtable(L);
    lua_setfield(L, -2, "stations");
    lua_createtable(L, 1, 0);
    lua_createtable(L, 0, 1);
    lua_pushliteral(L, "none");
    lua_setfield(L, -2, "name");
    lua_rawseti(L, -2, 1);
    lua_setfield(L, -2, "grippers");
}

/* A copy of the layout's table, left on top of the stack, whose `robots` are the timed ones alone, or the
 * others. */
static void copy_with(lua_State *L, int table, bool are_timed) {
    lua_newtable(L);
    for (lua_pushnil(L); lua_next(L, table) != 0;) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
    }
    lua_newtable(L);
    lua_getfield(L, table, "robots");
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const bool is_table = lua_istable(L, -1) && lua_getfield(L, -1, "kind") != LUA_TNONE;
        const bool is_timed = is_table && lua_isstring(L, -1) && strcmp(lua_tostring(L, -1), "timed") == 0;
        lua_pop(L, is_table ? 1 : 0);
        if (is_timed == are_timed) {
            lua_pushvalue(L, -2);
            lua_pushvalue(L, -2);
            lua_rawset(L, -6);
        }
    }
    lua_pop(L, 1);
    lua_setfield(L, -2, "robots");
}

/* Robots of both kinds: the timed ones are read behind all else. Leaves two tables on the stack, that with
 * the timed ones and, above it, that with the others. */
static void part_robots(wh_reader_t *reader, wh_layout_t *layout) {
    const int top = lua_gettop(reader->L);
    wh_layout_refuse_field(reader, "robot", "nothing: `robots` has them all");
    copy_with(reader->L, top, true);
    layout->timed = wh_timed_open_tool(reader);
    if (layout->timed->robot_count > WH_LAYOUT_TIMED) {
        lua_pushinteger(reader->L, (lua_Integer)layout->timed->robot_count);
        wh_reader_fail(reader, "robots", "at most %d of kind \"timed\" beside robots with axes",
                       WH_LAYOUT_TIMED);
    }
    copy_with(reader->L, top, false);
}

/* `from` is the stack index of their table. */
static void read_timed_robots(wh_reader_t *reader, wh_layout_t *layout, int from) {
    wh_flow_tool_t *tool = layout->timed;
    if (!tool) {
        return;
    }
    wh_vec3_t *at = wh_layout_memory(reader->L, tool->station_count, sizeof *at);
    for (size_t s = 0; s < tool->station_count; ++s) {
        tool->stations[s].slots = layout->places[s].slots;
        at[s] = layout->places[s].base_from_station.r;
    }
    wh_flow_tool_number(tool);
    lua_pushvalue(reader->L, from);
    (void)wh_reader_enter(reader, "robots");
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        (void)wh_reader_enter(reader, tool->robots[r].name);
        wh_timed_read_robot(reader, tool, r, at);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
    lua_pop(reader->L, 1);
}

/* The order matters: limits of later fields depend on earlier ones. Strokes are checked against the slice,
 * grippers name stations, wafers lie in them, and shapes follow the wafer's size. */
wh_layout_t *wh_layout_read(lua_State *L, const char *path) {
    wh_reader_t reader;
    wh_layout_t *layout = wh_layout_memory(L, 1, sizeof *layout);
    layout->path = memcpy(wh_layout_memory(L, strlen(path) + 1, 1), path, strlen(path) + 1);
    wh_reader_start(&reader, L, layout->path);
    if (!lua_istable(L, -1)) {
        wh_reader_fail(&reader, "what the file returns", "a table");
    }
    const int top = lua_gettop(L);
    if (wh_layout_is_timed(&reader)) {
        stand_in(&reader, layout);
    } else if (wh_layout_is_mixed(&reader)) {
        part_robots(&reader, layout);
    }
    wh_reader_refuse_unknown(&reader, wh_layout_top_fields);
    wh_layout_read_patterns(&reader, layout);
    read_checks(&reader, layout);
    wh_layout_read_physics(&reader, layout);
    wh_layout_read_robot(&reader, layout);
    wh_layout_read_stations(&reader, layout);
    wh_layout_read_grippers(&reader, layout);
    wh_layout_read_taught(&reader, layout);
    wh_layout_turn_along_arms(layout);
    wh_layout_move_chucks(layout);
    wh_layout_read_doors(&reader, layout);
    wh_layout_read_vias(&reader, layout);
    wh_layout_read_effectors(&reader, layout);
    wh_layout_read_times(&reader, layout);
    read_timed_robots(&reader, layout, top + 1);
    wh_layout_read_wafers(&reader, layout);
    wh_layout_find_faces(layout);
    wh_layout_read_sensing(&reader, layout);
    wh_layout_find_arms(layout);
    wh_layout_read_edge_wafers(&reader, layout);
    wh_layout_take_supports(layout, wh_layout_memory(L, wh_layout_count_supports(layout), sizeof(wh_pose_t)));
    wh_layout_read_shapes(&reader, layout);
    wh_layout_read_blades(&reader, layout);
    wh_layout_read_world(&reader, layout);
    wh_layout_read_faults(&reader, layout);
    wh_layout_read_study(&reader, layout);
    wh_layout_guess_units(&reader, layout);
    lua_settop(L, top);
    return layout;
}

void wh_layout_read_trial_world(lua_State *L, wh_layout_t *trial_cell) {
    wh_reader_t reader;
    wh_reader_start(&reader, L, trial_cell->path);
    wh_reader_refuse_unknown(&reader, wh_layout_top_fields);
    wh_layout_read_world(&reader, trial_cell);
}

void wh_layout_read_own_study(lua_State *L, const char *path, wh_layout_t *layout) {
    wh_reader_t reader;
    lua_createtable(L, 0, 1);
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, "study");
    wh_reader_start(&reader, L, path);
    wh_layout_read_study(&reader, layout);
    lua_pop(L, 1);
}

/* -------------------------------------------------------------------------------------------------- names */

/* The number of names among which the nearest one is searched. */
#define MOST_NAMES 1000

/* The name of thing `i` of those that `lookup` looks among; null behind the last one. */
static const char *name_at(const wh_layout_t *layout, wh_layout_find_t *lookup, size_t i) {
    if (lookup == wh_layout_find_station) {
        return i < layout->station_count ? layout->stations[i].name : NULL;
    }
    if (lookup == wh_layout_find_door) {
        return i < layout->machine.door_count ? layout->door_list[i].name : NULL;
    }
    if (lookup == wh_layout_find_gripper) {
        return i < layout->machine.gripper_count ? layout->grippers[i].name : NULL;
    }
    return i < layout->wafer_count ? layout->wafers[i].name : NULL;
}

static const char *nearest_name(const wh_layout_t *layout, wh_layout_find_t *lookup, const char *name) {
    const char *names[MOST_NAMES];
    size_t count = 0;
    while (count < MOST_NAMES && name_at(layout, lookup, count)) {
        names[count] = name_at(layout, lookup, count);
        ++count;
    }
    return wh_text_nearest(name, names, count);
}

int32_t wh_layout_read_name(wh_reader_t *reader, const wh_layout_t *layout, const char *field,
                            const char *fallback, wh_layout_find_t *lookup, const char *expected) {
    char name[WH_NAME_SIZE];
    wh_reader_text(reader, field, fallback, name, sizeof name);
    const int32_t found = lookup(layout, name);
    if (found == WH_NONE) {
        char meant[WH_NEAREST_TEXT];
        wh_reader_refuse(reader, field, name, "%s%s", expected,
                         wh_text_did_you_mean(meant, "; ", "", nearest_name(layout, lookup, name)));
    }
    return found;
}

int32_t wh_layout_read_gripper_name(wh_reader_t *reader, const wh_layout_t *layout, const char *field,
                                    const char *expected) {
    const wh_layout_gripper_t *first = layout->grippers;
    while (first->station != WH_NONE) {
        ++first;
    }
    return wh_layout_read_name(reader, layout, field, first->name, wh_layout_find_gripper, expected);
}

/* ------------------------------------------------------------------------------------------------- a file */

typedef struct {
    const char *path;
    bool is_timed;
    const wh_layout_t *layout;
} load_t;

/* Runs protected; the argument is a load_t. */
static int load(lua_State *L) {
    load_t *job = lua_touserdata(L, 1);
    wh_sandbox_result_t result;
    if (!wh_sandbox_evaluate(L, job->path, &result)) {
        lua_pushstring(L, result.message);
        return lua_error(L);
    }
    job->layout = wh_layout_read(L, job->path);
    if (job->layout->tool && !job->is_timed) {
        return luaL_error(
            L,
            "%s: robots that are times alone (expected robots with axes; a script with `flow` takes these)",
            job->path);
    }
    if (!job->layout->tool && job->is_timed) {
        return luaL_error(L,
                          "%s: robots with axes: a schedule is neither held against them nor played by them "
                          "(expected robots of kind \"timed\")",
                          job->path);
    }
    return 0;
}

const wh_layout_t *wh_layout_load(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result) {
    load_t job = {path, false, NULL};
    return wh_sandbox_protect(wh_sandbox_state(sandbox), load, &job, result) ? job.layout : NULL;
}

const wh_layout_t *wh_layout_load_timed(wh_sandbox_t *sandbox, const char *path,
                                        wh_sandbox_result_t *result) {
    load_t job = {path, true, NULL};
    return wh_sandbox_protect(wh_sandbox_state(sandbox), load, &job, result) ? job.layout : NULL;
}
