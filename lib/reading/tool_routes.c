#include "tool_routes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "layout_internal.h"

#define END                                                                                                  \
    { NULL, NULL, NULL, false }

/* The most routes of a layout. */
#define MOST_ROUTES 64

const wh_reader_field_t wh_flow_step_fields[] = {
    {"process", "number", "s, in place of the station's", false},
    {"recipe", "string", "by which the step processes all wafers, in place of theirs", false},
    {"hot", "boolean", "true: the second arm alone takes from it", false},
    {"align", "number", "degrees: a prealigner turns the wafer's notch there; robots with axes alone", false},
    {"flip", "boolean", "true: a flipper turns the wafer over; robots with axes alone", false},
    {"centre", "boolean", "true: beams centre the wafer on its way in; robots with axes alone", false},
    {"map", "boolean", "true: the robot that brought the wafer maps the station; robots with axes alone",
     false},
    END};

const wh_reader_field_t wh_flow_route_fields[] = {
    {"partial", "table<integer, integer>", "by step: places that stay empty", false}, END};

/* ------------------------------------------------------------------------------------------------ entries */

size_t wh_timed_count_entries(wh_reader_t *reader, const wh_reader_field_t *known) {
    lua_State *L = reader->L;
    const size_t count = lua_rawlen(L, -1);
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        bool is_good =
            lua_isinteger(L, -2) && lua_tointeger(L, -2) >= 1 && (size_t)lua_tointeger(L, -2) <= count;
        char field[80] = "an entry", names[200] = "";
        for (size_t i = 0; known[i].name; ++i) {
            const size_t used = strlen(names);
            (void)snprintf(names + used, sizeof names - used, " %s", known[i].name);
            is_good = is_good ||
                      (lua_type(L, -2) == LUA_TSTRING && strcmp(lua_tostring(L, -2), known[i].name) == 0);
        }
        if (!is_good) {
            if (lua_type(L, -2) == LUA_TSTRING) {
                (void)snprintf(field, sizeof field, "%.60s", lua_tostring(L, -2));
            }
            wh_reader_fail(reader, field, "entries 1, 2, ... and the fields%s", names);
        }
    }
    return count;
}

const char *wh_timed_read_entry(wh_reader_t *reader, size_t index, char text[WH_NAME_SIZE]) {
    char field[32];
    size_t length = 0;
    (void)snprintf(field, sizeof field, "[%zu]", index);
    const int type = lua_rawgeti(reader->L, -1, (lua_Integer)index);
    const char *name = type == LUA_TSTRING ? lua_tolstring(reader->L, -1, &length) : "";
    if (type != LUA_TNIL && (length == 0 || length >= WH_NAME_SIZE || !wh_reader_is_plain(name, length))) {
        wh_reader_fail(reader, field, "a name of 1 to %d bytes", WH_NAME_SIZE - 1);
    }
    (void)snprintf(text, WH_NAME_SIZE, "%s", name);
    lua_pop(reader->L, 1);
    return text;
}

/* ------------------------------------------------------------------------------------------------- routes */

int64_t wh_flow_read_us(wh_reader_t *reader, const char *field, double fallback) {
    return wh_layout_us(wh_reader_number(reader, field, fallback, 0, WH_FLOW_LONGEST_S));
}

static void add_station(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_step_t *step,
                        const char *field, const char *name) {
    const int32_t station = wh_timed_find_station(reader, tool, field, name);
    for (size_t i = 0; i < step->station_count; ++i) {
        if (step->stations[i] == station) {
            wh_reader_refuse(reader, field, name, "each station once in a step");
        }
    }
    step->stations = realloc(step->stations, (step->station_count + 1) * sizeof *step->stations);
    step->stations = wh_memory_need(step->stations);
    step->stations[step->station_count++] = station;
}

void wh_flow_refuse_timed(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t station, const char *field,
                          bool is_wanted) {
    int32_t robot = WH_FLOW_NONE;
    if (!is_wanted) {
        return;
    } else if (!wh_flow_has_real(tool)) {
        wh_reader_refuse(reader, field, NULL, "nothing: the robots are times alone");
    } else if (wh_flow_is_timed_at(tool, station, &robot)) {
        wh_reader_refuse(reader, field, NULL, "nothing: %s, which serves %s, is times alone",
                         tool->robots[robot].name, tool->stations[station].name);
    }
}

/* Each station of the step must be one that can do it. */
static void check_work(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_flow_step_t *step,
                       const char *field, const char *expected) {
    for (size_t i = 0; i < step->station_count; ++i) {
        const wh_flow_station_t *station = &tool->stations[step->stations[i]];
        if (station->works != step->work) {
            wh_reader_refuse(reader, field, station->name, "%s", expected);
        }
    }
}

/* Wafers are aligned, turned over, centred and mapped where something stands. */
static void read_work(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_step_t *step) {
    static const char *const fields[] = {"align", "flip", "centre", "map"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0] && !wh_flow_has_real(tool); ++i) {
        wh_layout_refuse_field(reader, fields[i], "nothing: the robots are times alone");
    }
    if (wh_reader_has(reader, "align")) {
        step->work = WH_FLOW_WORK_ALIGN;
        step->align_deg = (double)wh_reader_number(reader, "align", 0, -360, 360);
        check_work(reader, tool, step, "align",
                   "prealigners with an edge sensor alone in a step with `align`");
    } else if (wh_reader_boolean(reader, "flip", false)) {
        step->work = WH_FLOW_WORK_FLIP;
        check_work(reader, tool, step, "flip", "flippers alone in a step with `flip`");
    }
    step->centres = wh_reader_boolean(reader, "centre", false);
    step->maps = wh_reader_boolean(reader, "map", false);
    for (size_t i = 0; i < step->station_count; ++i) {
        wh_flow_refuse_timed(reader, tool, step->stations[i], "centre", step->centres);
        wh_flow_refuse_timed(reader, tool, step->stations[i], "map", step->maps);
    }
}

/* Its clock lets a process begin behind shut doors, and refuses a GET before the end. */
static void check_clocks(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_flow_step_t *step) {
    for (size_t i = 0; i < step->station_count && wh_flow_has_real(tool) && step->process_us > 0; ++i) {
        if (!tool->stations[step->stations[i]].is_real) {
            wh_reader_refuse(reader, "process", tool->stations[step->stations[i]].name,
                             "a station that takes time: one with `process` in the layout");
        }
    }
}

/* A recipe by which no station of the step takes another time would be read by nobody. */
static void check_recipes(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_flow_step_t *step) {
    bool is_any = step->recipe == 0;
    for (size_t i = 0; i < step->station_count; ++i) {
        is_any = is_any || tool->stations[step->stations[i]].has_recipes;
    }
    if (!is_any) {
        wh_reader_refuse(reader, "recipe", tool->recipes.names[step->recipe - 1],
                         "a step with a station that has times by recipe");
    }
}

static void read_step(wh_reader_t *reader, const wh_flow_tool_t *tool, size_t index, wh_flow_step_t *step) {
    char name[WH_NAME_SIZE], field[32];
    (void)snprintf(field, sizeof field, "[%zu]", index);
    step->process_us = WH_FLOW_NONE;
    const int type = lua_rawgeti(reader->L, -1, (lua_Integer)index);
    lua_pop(reader->L, 1);
    if (type == LUA_TSTRING) {
        add_station(reader, tool, step, field, wh_timed_read_entry(reader, index, name));
        return;
    }
    if (!wh_reader_enter_item(reader, (lua_Integer)index)) {
        wh_reader_fail(reader, field, "a station's name, or { STATION, STATION, process = }");
    }
    const size_t count = wh_timed_count_entries(reader, wh_flow_step_fields);
    for (size_t i = 1; i <= count; ++i) {
        (void)snprintf(field, sizeof field, "[%zu]", i);
        add_station(reader, tool, step, field, wh_timed_read_entry(reader, i, name));
    }
    if (count == 0) {
        wh_reader_fail(reader, NULL, "at least one station");
    }
    step->process_us =
        wh_reader_has(reader, "process") ? wh_flow_read_us(reader, "process", 0) : WH_FLOW_NONE;
    step->recipe = wh_layout_read_recipe(reader, &tool->recipes);
    if (step->recipe > 0 && step->process_us != WH_FLOW_NONE) {
        wh_reader_refuse(reader, "recipe", NULL, "nothing beside `process`");
    }
    check_recipes(reader, tool, step);
    step->second_arm = wh_reader_boolean(reader, "hot", false);
    check_clocks(reader, tool, step);
    read_work(reader, tool, step);
    wh_reader_leave(reader);
}

/* partial = { [2] = 1 }: step 2 keeps one place empty. */
static void read_partial(wh_reader_t *reader, wh_flow_route_t *route) {
    if (!wh_reader_enter(reader, "partial")) {
        return;
    }
    lua_State *L = reader->L;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        int is_step = 0, is_count = 0;
        const lua_Integer step = lua_tointegerx(L, -2, &is_step), count = lua_tointegerx(L, -1, &is_count);
        if (!is_step || step < 1 || (size_t)step >= route->step_count || !is_count || count < 0 ||
            count > 1000) {
            wh_reader_fail(reader, NULL, "[STEP] = PLACES, with steps from 1 to %d",
                           (int)route->step_count - 1);
        }
        route->steps[step].kept_empty = (int32_t)count;
    }
    wh_reader_leave(reader);
}

void wh_timed_read_route(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *name,
                         wh_flow_route_t *route) {
    *route = (wh_flow_route_t){.name = wh_text_copy(name)};
    if (!wh_reader_enter(reader, name)) {
        wh_reader_refuse(reader, name, NULL, "a route: { STATION, STATION, ... }");
    }
    const size_t count = wh_timed_count_entries(reader, wh_flow_route_fields);
    if (count == 0) {
        wh_reader_fail(reader, NULL, "at least one step");
    }
    route->steps = wh_array_new(count + 2, sizeof *route->steps);
    route->step_count = 1;
    for (size_t i = 1; i <= count; ++i) {
        read_step(reader, tool, i, &route->steps[route->step_count++]);
    }
    read_partial(reader, route);
    wh_reader_leave(reader);
}

void wh_timed_read_routes(wh_reader_t *reader, wh_flow_tool_t *tool) {
    size_t count = 0;
    if (!wh_reader_has(reader, "routes")) {
        return;
    }
    (void)wh_reader_enter(reader, "routes");
    const wh_timed_name_t *names = wh_layout_read_keys(reader, MOST_ROUTES, sizeof *names, "routes", &count);
    tool->routes = wh_array_new(count + 1, sizeof *tool->routes);
    for (size_t i = 0; i < count; ++i) {
        wh_timed_read_route(reader, tool, names[i].name, &tool->routes[tool->route_count++]);
    }
    wh_reader_leave(reader);
}
