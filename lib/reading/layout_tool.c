#include "layout_tool.h"

#include <lauxlib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../text/array.h"
#include "../text/nearest.h"
#include "layout_internal.h"
#include "tool_routes.h"

/* -------------------------------------------------------------------------------------------------- kinds */

static bool is_kind_timed(const wh_reader_t *reader) {
    const bool is_text = wh_reader_push(reader, "kind") == LUA_TSTRING;
    const bool is_timed = is_text && strcmp(lua_tostring(reader->L, -1), "timed") == 0;
    lua_pop(reader->L, 1);
    return is_timed;
}

/* How many of `robots` are timed, and how many there are. */
static size_t count_timed(const wh_reader_t *reader, size_t *count) {
    size_t timed = 0;
    *count = 0;
    if (wh_reader_push(reader, "robots") == LUA_TTABLE) {
        for (lua_pushnil(reader->L); lua_next(reader->L, -2) != 0; lua_pop(reader->L, 1), ++*count) {
            if (lua_istable(reader->L, -1)) {
                lua_getfield(reader->L, -1, "kind");
                timed += lua_isstring(reader->L, -1) && strcmp(lua_tostring(reader->L, -1), "timed") == 0;
                lua_pop(reader->L, 1);
            }
        }
    }
    lua_pop(reader->L, 1);
    return timed;
}

bool wh_layout_is_timed(wh_reader_t *reader) {
    size_t count = 0;
    if (wh_reader_push(reader, "robot") == LUA_TTABLE) {
        lua_pop(reader->L, 1);
        (void)wh_reader_enter(reader, "robot");
        const bool is_timed = is_kind_timed(reader);
        wh_reader_leave(reader);
        return is_timed;
    }
    lua_pop(reader->L, 1);
    const size_t timed = count_timed(reader, &count);
    return timed > 0 && timed == count;
}

bool wh_layout_is_mixed(const wh_reader_t *reader) {
    size_t count = 0;
    const size_t timed = count_timed(reader, &count);
    return timed > 0 && timed < count;
}

/* -------------------------------------------------------------------------------------------------- names */

const wh_timed_name_t *wh_timed_read_names(wh_reader_t *reader, const char *what, size_t *count) {
    return wh_layout_read_keys(reader, WH_LAYOUT_STATIONS, sizeof(wh_timed_name_t), what, count);
}

int32_t wh_timed_find_station(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *field,
                              const char *name) {
    const int32_t found = wh_flow_station_named(tool, name);
    if (found == WH_FLOW_NONE) {
        const char **names = wh_layout_memory(reader->L, tool->station_count, sizeof *names);
        for (size_t i = 0; i < tool->station_count; ++i) {
            names[i] = tool->stations[i].name;
        }
        char meant[WH_NEAREST_TEXT];
        const char *nearest = wh_text_nearest(name, names, tool->station_count);
        wh_reader_refuse(reader, field, name, "a station of the layout%s",
                         wh_text_did_you_mean(meant, "; ", "", nearest));
    }
    return found;
}

/* ----------------------------------------------------------------------------------------------- stations */

/* A door's two times; `field` is a number or a table. */
static void read_door(wh_reader_t *reader, wh_flow_door_t *door) {
    const int type = wh_reader_push(reader, "door");
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        (void)wh_reader_open(reader, "door", wh_layout_timed_door_fields);
        door->open_us = wh_layout_read_us(reader, "open");
        door->close_us = wh_layout_read_us(reader, "close");
        wh_reader_leave(reader);
    } else if (type != LUA_TNIL) {
        door->open_us = door->close_us = wh_timed_read_us(reader, "door", (double)NAN);
    }
}

static int64_t sum_us(const wh_load_port_of_t *of, const wh_load_port_step_t steps[], size_t count) {
    int64_t us = 0;
    for (size_t i = 0; i < count; ++i) {
        us += of->us[steps[i]];
    }
    for (size_t step = WH_LOAD_PORT_TP1; of->is_e84 && step <= WH_LOAD_PORT_TP5; ++step) {
        us += of->us[step];
    }
    return us;
}

/* A port's steps are sums of times here, from the vehicle to the map and back. */
static void read_port(wh_reader_t *reader, wh_flow_station_t *station) {
    static const wh_load_port_step_t up[] = {WH_LOAD_PORT_CLAMP, WH_LOAD_PORT_DOCK, WH_LOAD_PORT_OPENS,
                                             WH_LOAD_PORT_MAP};
    static const wh_load_port_step_t down[] = {WH_LOAD_PORT_CLOSE, WH_LOAD_PORT_UNDOCK, WH_LOAD_PORT_UNCLAMP};
    wh_load_port_of_t of = {0};
    if (!wh_reader_has(reader, "port")) {
        return;
    }
    if (!station->is_load_port) {
        wh_reader_refuse(reader, "port", NULL, "nothing: its `kind` is not \"load_port\"");
    }
    (void)wh_reader_open(reader, "port", wh_layout_port_fields);
    wh_layout_refuse_field(reader, "goes", "nothing: the robots are times alone");
    wh_layout_refuse_field(reader, "mapper", "nothing: the robots are times alone");
    wh_layout_read_port_steps(reader, &of);
    const bool is_between = of.begins >= WH_LOAD_PORT_PLACED && of.begins <= WH_LOAD_PORT_DOCKED;
    if ((int)of.begins != WH_NONE && is_between) {
        wh_reader_refuse(reader, "state", wh_load_port_state_name(of.begins),
                         "\"absent\", or \"open\" or \"mapped\", which are one: the robots are times alone");
    }
    station->has_carriers = true;
    station->is_absent = of.begins == WH_LOAD_PORT_ABSENT;
    station->comes_us =
        sum_us(&of, up, sizeof up / sizeof up[0]) + (of.is_e84 ? 0 : of.us[WH_LOAD_PORT_PLACE]);
    station->goes_us =
        sum_us(&of, down, sizeof down / sizeof down[0]) + (of.is_e84 ? 0 : of.us[WH_LOAD_PORT_REMOVE]);
    wh_reader_leave(reader);
}

static void read_station(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes) {
    wh_reader_refuse_unknown(reader, wh_layout_timed_station_fields);
    station->is_load_port = wh_reader_apart(reader, "kind") > 0;
    station->slots = (int32_t)wh_reader_apart_from(reader, "slots", station->is_load_port ? 25 : 1);
    wh_layout_read_clockwork(reader, station, recipes, wh_layout_pump_fields);
    read_port(reader, station);
}

/* Marks the slots that one side alone fills. */
static void read_slots(wh_reader_t *reader, wh_flow_tool_t *tool, const wh_flow_station_t *station,
                       const char *field, wh_flow_side_t side) {
    if (!wh_reader_has(reader, field)) {
        return;
    }
    if (!station->is_lock) {
        wh_reader_refuse(reader, field, NULL, "nothing: it has no `pump`");
    }
    if (!wh_reader_enter(reader, field)) {
        return;
    }
    const size_t count = wh_reader_list(reader);
    for (size_t i = 1; i <= count; ++i) {
        int whole = 0;
        lua_rawgeti(reader->L, -1, (lua_Integer)i);
        const lua_Integer slot = lua_tointegerx(reader->L, -1, &whole);
        if (!whole || slot < 1 || slot > station->slots) {
            wh_reader_fail(reader, NULL, "slots from 1 to %d", (int)station->slots);
        }
        if (tool->slot_sides[station->first_place + slot - 1] != WH_FLOW_BOTH) {
            wh_reader_fail(reader, NULL, "each slot once, in `into` or in `out`");
        }
        lua_pop(reader->L, 1);
        tool->slot_sides[station->first_place + slot - 1] = side;
    }
    wh_reader_leave(reader);
}

static int32_t find_robot(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *name) {
    const int32_t robot = wh_flow_robot_named(tool, name);
    if (robot == WH_FLOW_NONE) {
        wh_reader_refuse(reader, "by", name, "robots of this layout by name");
    }
    return robot;
}

/* The robot serves the station. Its own fields are in the table at which the reader is, if `is_table`. */
static void read_server(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, int32_t station,
                        const wh_flow_door_t *door, bool is_table) {
    const size_t of = wh_flow_of(tool, robot, station);
    tool->serves[of] = true;
    tool->doors[of] = *door;
    if (is_table) {
        wh_reader_refuse_unknown(reader, wh_layout_timed_by_fields);
        read_door(reader, &tool->doors[of]);
        if (wh_reader_has(reader, "side")) {
            tool->sides[of] = (wh_flow_side_t)wh_reader_apart(reader, "side");
        }
    }
    if (tool->stations[station].is_lock && tool->sides[of] == WH_FLOW_BOTH) {
        wh_reader_refuse(
            reader, is_table ? "side" : "by", NULL,
            "{ %s = { side = \"vacuum\" } } or \"atmosphere\": the side of a load lock where it comes",
            tool->robots[robot].name);
    }
}

static void read_list_of_servers(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t station,
                                 const wh_flow_door_t *door) {
    const size_t count = wh_reader_list(reader);
    for (size_t i = 1; i <= count; ++i) {
        lua_rawgeti(reader->L, -1, (lua_Integer)i);
        const char *name = lua_type(reader->L, -1) == LUA_TSTRING ? lua_tostring(reader->L, -1) : NULL;
        if (!name) {
            wh_reader_fail(reader, NULL, "robots of this layout by name");
        }
        const int32_t robot = find_robot(reader, tool, name);
        lua_pop(reader->L, 1);
        read_server(reader, tool, robot, station, door, false);
    }
}

static void read_by(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t station) {
    wh_flow_door_t door = {0, 0};
    read_door(reader, &door);
    const int type = wh_reader_push(reader, "by");
    if (type == LUA_TSTRING) {
        const int32_t robot = find_robot(reader, tool, lua_tostring(reader->L, -1));
        lua_pop(reader->L, 1);
        read_server(reader, tool, robot, station, &door, false);
        return;
    }
    lua_pop(reader->L, 1);
    if (type == LUA_TNIL) {
        for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
            read_server(reader, tool, r, station, &door, false);
        }
        return;
    }
    if (!wh_reader_enter(reader, "by")) {
        wh_reader_fail(reader, "by", "robots of this layout by name");
    }
    if (lua_rawlen(reader->L, -1) > 0) {
        read_list_of_servers(reader, tool, station, &door);
        wh_reader_leave(reader);
        return;
    }
    size_t count = 0;
    const wh_timed_name_t *names = wh_timed_read_names(reader, "robots", &count);
    if (count == 0) {
        wh_reader_fail(reader, NULL, "at least one robot by name");
    }
    for (size_t i = 0; i < count; ++i) {
        const int32_t robot = find_robot(reader, tool, names[i].name);
        if (wh_reader_enter(reader, names[i].name)) {
            read_server(reader, tool, robot, station, &door, true);
            wh_reader_leave(reader);
        }
    }
    wh_reader_leave(reader);
}

/* ---------------------------------------------------------------------------------------------- the whole */

static int close_tool(lua_State *L) {
    wh_flow_tool_close(lua_touserdata(L, 1));
    return 0;
}

/* The tool is the Lua state's; it is closed with it. */
static wh_flow_tool_t *new_tool(lua_State *L) {
    wh_flow_tool_t *tool = lua_newuserdatauv(L, sizeof *tool, 0);
    memset(tool, 0, sizeof *tool);
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, close_tool);
    lua_setfield(L, -2, "__gc");
    lua_setmetatable(L, -2);
    lua_rawsetp(L, LUA_REGISTRYINDEX, tool);
    return tool;
}

static void open_named(wh_reader_t *reader, wh_flow_tool_t *tool, bool is_one) {
    static const wh_timed_name_t one = {"robot"};
    size_t robots = 1, stations = 0;
    const wh_timed_name_t *robot_names = &one;
    if (!is_one) {
        (void)wh_reader_enter(reader, "robots");
        robot_names = wh_timed_read_names(reader, "robots", &robots);
        wh_reader_leave(reader);
    }
    if (!wh_reader_enter(reader, "stations")) {
        wh_reader_refuse(reader, "stations", NULL, "a table of stations by name");
    }
    const wh_timed_name_t *station_names = wh_timed_read_names(reader, "stations", &stations);
    if (stations == 0) {
        wh_reader_fail(reader, NULL, "at least one station by name");
    }
    wh_reader_leave(reader);
    wh_flow_tool_open(tool, robots, stations);
    for (size_t i = 0; i < robots; ++i) {
        tool->robots[i].name = wh_text_copy(robot_names[i].name);
    }
    for (size_t i = 0; i < stations; ++i) {
        tool->stations[i].name = wh_text_copy(station_names[i].name);
    }
}

static void read_stations(wh_reader_t *reader, wh_flow_tool_t *tool) {
    (void)wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < tool->station_count; ++s) {
        if (!wh_reader_enter(reader, tool->stations[s].name)) {
            wh_reader_refuse(reader, tool->stations[s].name, NULL, "a station's table; {} will do");
        }
        read_station(reader, &tool->stations[s], &tool->recipes);
        wh_reader_leave(reader);
    }
    wh_flow_tool_number(tool);
    for (size_t s = 0; s < tool->station_count; ++s) {
        (void)wh_reader_enter(reader, tool->stations[s].name);
        read_by(reader, tool, (int32_t)s);
        read_slots(reader, tool, &tool->stations[s], "into", WH_FLOW_ATMOSPHERE);
        read_slots(reader, tool, &tool->stations[s], "out", WH_FLOW_VACUUM);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

/* The stations' places, which only robots with a speed need. */
static void read_places(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_vec3_t at[], bool are_needed) {
    static const wh_vec3_t nowhere = {0, 0, 0};
    (void)wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < tool->station_count; ++s) {
        (void)wh_reader_enter(reader, tool->stations[s].name);
        at[s] = wh_reader_vector(reader, "at", are_needed ? NULL : &nowhere);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

static bool is_any_flying(wh_reader_t *reader, const wh_flow_tool_t *tool, bool is_one) {
    bool is_any = false;
    for (size_t r = 0; r < tool->robot_count; ++r) {
        (void)wh_reader_enter(reader, is_one ? "robot" : "robots");
        if (!is_one) {
            (void)wh_reader_enter(reader, tool->robots[r].name);
        }
        is_any = is_any || wh_reader_has(reader, "speed");
        if (!is_one) {
            wh_reader_leave(reader);
        }
        wh_reader_leave(reader);
    }
    return is_any;
}

wh_flow_tool_t *wh_timed_open_tool(wh_reader_t *reader) {
    wh_flow_tool_t *tool = new_tool(reader->L);
    open_named(reader, tool, false);
    return tool;
}

const wh_flow_tool_t *wh_layout_read_tool(wh_reader_t *reader) {
    wh_flow_tool_t *tool = new_tool(reader->L);
    wh_reader_refuse_unknown(reader, wh_layout_timed_fields);
    const bool is_one = wh_reader_has(reader, "robot");
    if (is_one && wh_reader_has(reader, "robots")) {
        wh_reader_refuse(reader, "robot", NULL, "nothing: `robots` has them all");
    }
    open_named(reader, tool, is_one);
    read_stations(reader, tool);
    wh_timed_read_routes(reader, tool);
    wh_vec3_t *at = lua_newuserdatauv(reader->L, tool->station_count * sizeof *at, 0);
    lua_insert(reader->L, -2); /* below the table being read */
    read_places(reader, tool, at, is_any_flying(reader, tool, is_one));
    (void)wh_reader_enter(reader, is_one ? "robot" : "robots");
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        if (!is_one) {
            (void)wh_reader_enter(reader, tool->robots[r].name);
        }
        wh_timed_read_robot(reader, tool, r, at);
        if (!is_one) {
            wh_reader_leave(reader);
        }
    }
    wh_reader_leave(reader);
    lua_remove(reader->L, -2);
    return tool;
}
