#include "layout_tool.h"

#include <lauxlib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../text/array.h"
#include "../text/nearest.h"
#include "layout_internal.h"

/* The longest time of a station or a robot, s: a week. */
#define LONGEST 604800.0

int64_t wh_layout_us(double seconds) {
    return (int64_t)llround(seconds * 1e6);
}

static int64_t read_us(wh_reader_t *reader, const char *field, double fallback) {
    return wh_layout_us(wh_reader_number(reader, field, fallback, 0, LONGEST));
}

/* --------------------------------------------------------------------------------------------------- kinds */

static bool is_kind_timed(const wh_reader_t *reader) {
    const bool is_text = wh_reader_push(reader, "kind") == LUA_TSTRING;
    const bool is_timed = is_text && strcmp(lua_tostring(reader->L, -1), "timed") == 0;
    lua_pop(reader->L, 1);
    return is_timed;
}

bool wh_layout_is_timed(wh_reader_t *reader) {
    size_t timed = 0, count = 0;
    if (wh_reader_push(reader, "robot") == LUA_TTABLE) {
        lua_pop(reader->L, 1);
        (void)wh_reader_enter(reader, "robot");
        const bool is_timed = is_kind_timed(reader);
        wh_reader_leave(reader);
        return is_timed;
    }
    lua_pop(reader->L, 1);
    if (wh_reader_push(reader, "robots") == LUA_TTABLE) {
        for (lua_pushnil(reader->L); lua_next(reader->L, -2) != 0; lua_pop(reader->L, 1), ++count) {
            if (lua_istable(reader->L, -1)) {
                lua_getfield(reader->L, -1, "kind");
                timed += lua_isstring(reader->L, -1) && strcmp(lua_tostring(reader->L, -1), "timed") == 0;
                lua_pop(reader->L, 1);
            }
        }
    }
    lua_pop(reader->L, 1);
    if (timed > 0 && timed < count) {
        wh_reader_refuse(reader, "robots", NULL, "robots that are all of kind \"timed\", or none of them");
    }
    return timed > 0;
}

/* --------------------------------------------------------------------------------------------------- names */

/* A name, as wh_layout_read_keys reads them. */
typedef struct {
    char name[WH_NAME_SIZE];
} name_t;

static const name_t *read_keys(wh_reader_t *reader, const char *what, size_t *count) {
    return wh_layout_read_keys(reader, WH_LAYOUT_STATIONS, sizeof(name_t), what, count);
}

static int32_t find_station(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *field,
                            const char *name) {
    const int32_t found = wh_flow_station_named(tool, name);
    if (found == WH_FLOW_NONE) {
        const char **names = wh_layout_memory(reader->L, tool->station_count, sizeof *names);
        for (size_t i = 0; i < tool->station_count; ++i) {
            names[i] = tool->stations[i].name;
        }
        char meant[WH_NEAREST_TEXT];
        const char *nearest = wh_text_nearest(name, names, tool->station_count);
        wh_reader_refuse(reader, field, name, "a station of this layout%s",
                         wh_text_did_you_mean(meant, "; ", "", nearest));
    }
    return found;
}

/* ------------------------------------------------------------------------------------------------- stations */

/* A door's two times; `field` is a number or a table. */
static void read_door(wh_reader_t *reader, wh_flow_door_t *door) {
    const int type = wh_reader_push(reader, "door");
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        (void)wh_reader_open(reader, "door", wh_layout_timed_door_fields);
        door->open_us = read_us(reader, "open", NAN);
        door->close_us = read_us(reader, "close", NAN);
        wh_reader_leave(reader);
    } else if (type != LUA_TNIL) {
        door->open_us = door->close_us = read_us(reader, "door", NAN);
    }
}

static void read_clean(wh_reader_t *reader, wh_flow_station_t *station) {
    if (!wh_reader_open(reader, "clean", wh_layout_clean_fields)) {
        return;
    }
    if (!wh_reader_has(reader, "after") && !wh_reader_has(reader, "idle")) {
        wh_reader_fail(reader, NULL, "when it comes: `after` wafers, or `idle` seconds");
    }
    station->clean_after = wh_reader_whole(reader, "after", 0, 0, 1000000);
    station->clean_us = read_us(reader, "seconds", NAN);
    station->cleans_full = !wh_reader_boolean(reader, "empty", true);
    if (wh_reader_has(reader, "idle")) {
        station->idle_us = wh_layout_us(wh_reader_number(reader, "idle", 1, 1e-6, LONGEST));
    }
    wh_reader_leave(reader);
}

static void read_pump(wh_reader_t *reader, wh_flow_station_t *station) {
    static const char *const states[] = {"atmosphere", "vacuum", NULL};
    station->is_lock = wh_reader_open(reader, "pump", wh_layout_pump_fields);
    if (station->is_lock) {
        station->pump_us[WH_FLOW_VACUUM] = read_us(reader, "down", NAN);
        station->pump_us[WH_FLOW_ATMOSPHERE] = read_us(reader, "up", NAN);
        station->empty_pump_us[WH_FLOW_VACUUM] =
            read_us(reader, "empty_down", (double)station->pump_us[WH_FLOW_VACUUM] / 1e6);
        station->empty_pump_us[WH_FLOW_ATMOSPHERE] =
            read_us(reader, "empty_up", (double)station->pump_us[WH_FLOW_ATMOSPHERE] / 1e6);
        wh_reader_leave(reader);
    } else if (wh_reader_has(reader, "state")) {
        wh_reader_refuse(reader, "state", NULL, "nothing: it has no `pump`");
    }
    station->side = wh_reader_choice(reader, "state", 0, states) == 0 ? WH_FLOW_ATMOSPHERE : WH_FLOW_VACUUM;
}

static void read_station(wh_reader_t *reader, wh_flow_station_t *station) {
    static const char *const kinds[] = {"slots", "load_port", NULL};
    wh_reader_refuse_unknown(reader, wh_layout_timed_station_fields);
    station->is_load_port = wh_reader_choice(reader, "kind", 0, kinds) == 1;
    station->slots = wh_reader_whole(reader, "slots", station->is_load_port ? 25 : 1, 1, 100000);
    station->process_us = read_us(reader, "process", 0);
    if (wh_reader_has(reader, "window")) {
        station->window_us = read_us(reader, "window", 0);
    }
    read_clean(reader, station);
    read_pump(reader, station);
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
    static const char *const sides[] = {"atmosphere", "vacuum", NULL};
    const size_t of = wh_flow_of(tool, robot, station);
    tool->serves[of] = true;
    tool->doors[of] = *door;
    if (is_table) {
        wh_reader_refuse_unknown(reader, wh_layout_timed_by_fields);
        read_door(reader, &tool->doors[of]);
        if (wh_reader_has(reader, "side")) {
            tool->sides[of] =
                wh_reader_choice(reader, "side", 0, sides) == 0 ? WH_FLOW_ATMOSPHERE : WH_FLOW_VACUUM;
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
    const name_t *names = read_keys(reader, "robots", &count);
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

/* --------------------------------------------------------------------------------------------------- robots */

/* A time for each station: a number, or a table with some of them and `default`. */
static void read_times(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const char *field,
                       double fallback, int64_t times_us[]) {
    int64_t *own = &times_us[wh_flow_of(tool, robot, 0)];
    const int type = wh_reader_push(reader, field);
    lua_pop(reader->L, 1);
    const bool is_table = type == LUA_TTABLE && wh_reader_enter(reader, field);
    const double usual = is_table
                             ? wh_reader_number(reader, "default", isnan(fallback) ? 0 : fallback, 0, LONGEST)
                             : wh_reader_number(reader, field, fallback, 0, LONGEST);
    for (size_t s = 0; s < tool->station_count; ++s) {
        own[s] = wh_layout_us(usual);
    }
    if (!is_table) {
        return;
    }
    const bool has_usual = wh_reader_has(reader, "default") || !isnan(fallback);
    for (size_t s = 0; s < tool->station_count; ++s) {
        const bool is_needed = !has_usual && tool->serves[wh_flow_of(tool, robot, (int32_t)s)];
        if (is_needed || wh_reader_has(reader, tool->stations[s].name)) {
            own[s] = read_us(reader, tool->stations[s].name, NAN);
        }
    }
    size_t count = 0;
    const name_t *names = read_keys(reader, "stations", &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(names[i].name, "default") != 0) {
            (void)find_station(reader, tool, names[i].name, names[i].name);
        }
    }
    wh_reader_leave(reader);
}

/* One pair of `move`, named "A>B"; and the way back, unless that is named as well. */
static void read_pair(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const char *pair) {
    char from[WH_NAME_SIZE], to[WH_NAME_SIZE], back[2 * WH_NAME_SIZE];
    if (sscanf(pair, "%63[^>]>%63[^\n]", from, to) != 2) {
        wh_reader_refuse(reader, NULL, pair, "a pair of stations, as in [\"A>B\"]");
    }
    const size_t a = (size_t)find_station(reader, tool, pair, from),
                 b = (size_t)find_station(reader, tool, pair, to);
    const int64_t us = read_us(reader, pair, NAN);
    tool->move_us[wh_flow_of(tool, robot, (int32_t)a) * tool->station_count + b] = us;
    (void)snprintf(back, sizeof back, "%s>%s", to, from);
    if (!wh_reader_has(reader, back)) {
        tool->move_us[wh_flow_of(tool, robot, (int32_t)b) * tool->station_count + a] = us;
    }
}

static void fill_moves(wh_flow_tool_t *tool, int32_t robot, int64_t us) {
    for (size_t i = 0; i < tool->station_count * tool->station_count; ++i) {
        tool->move_us[wh_flow_of(tool, robot, 0) * tool->station_count + i] = us;
    }
}

static void read_moves(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot) {
    if (wh_reader_push(reader, "move") != LUA_TTABLE) {
        lua_pop(reader->L, 1);
        fill_moves(tool, robot, read_us(reader, "move", NAN));
        return;
    }
    lua_pop(reader->L, 1);
    (void)wh_reader_enter(reader, "move");
    fill_moves(tool, robot, read_us(reader, "default", NAN));
    size_t count = 0;
    const name_t *pairs = read_keys(reader, "pairs of stations", &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(pairs[i].name, "default") != 0) {
            read_pair(reader, tool, robot, pairs[i].name);
        }
    }
    wh_reader_leave(reader);
}

/* The straight way between the stations' places at the robot's speed. */
static void fly(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const wh_vec3_t at[]) {
    const double speed = wh_reader_number(reader, "speed", NAN, 1e-3, 1e6);
    for (size_t a = 0; a < tool->station_count; ++a) {
        for (size_t b = 0; b < tool->station_count; ++b) {
            const wh_vec3_t way = {at[a].x - at[b].x, at[a].y - at[b].y, at[a].z - at[b].z};
            const double length = sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
            tool->move_us[wh_flow_of(tool, robot, (int32_t)a) * tool->station_count + b] =
                wh_layout_us(length / speed);
        }
    }
}

static void read_stand(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot) {
    char name[64];
    int32_t first = 0;
    while ((size_t)first < tool->station_count && !tool->serves[wh_flow_of(tool, robot, first)]) {
        ++first;
    }
    if ((size_t)first == tool->station_count) {
        wh_reader_fail(reader, NULL, "a robot that serves a station");
    }
    wh_reader_text(reader, "at", tool->stations[first].name, name, sizeof name);
    tool->robots[robot].at = find_station(reader, tool, "at", name);
}

static void read_robot(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const wh_vec3_t at[]) {
    wh_reader_refuse_unknown(reader, wh_layout_timed_robot_fields);
    tool->robots[robot].arms = wh_reader_whole(reader, "arms", 1, 1, 2);
    read_stand(reader, tool, robot);
    read_times(reader, tool, robot, "pick", NAN, tool->pick_us);
    read_times(reader, tool, robot, "place", NAN, tool->place_us);
    if (wh_reader_has(reader, "speed")) {
        if (wh_reader_has(reader, "move")) {
            wh_reader_refuse(reader, "speed", NULL, "nothing beside `move`");
        }
        fly(reader, tool, robot, at);
    } else {
        read_moves(reader, tool, robot);
    }
    if (wh_reader_has(reader, "swap")) {
        read_times(reader, tool, robot, "swap", NAN, tool->swap_us);
        return;
    }
    for (size_t s = 0; s < tool->station_count; ++s) {
        const size_t of = wh_flow_of(tool, robot, (int32_t)s);
        const size_t away = tool->station_count > 1 ? (s + 1) % tool->station_count : 0;
        tool->swap_us[of] =
            tool->pick_us[of] + tool->move_us[of * tool->station_count + away] + tool->place_us[of];
    }
}

/* ------------------------------------------------------------------------------------------------ the whole */

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
    static const name_t one = {"robot"};
    size_t robots = 1, stations = 0;
    const name_t *robot_names = &one;
    if (!is_one) {
        (void)wh_reader_enter(reader, "robots");
        robot_names = read_keys(reader, "robots", &robots);
        wh_reader_leave(reader);
    }
    if (!wh_reader_enter(reader, "stations")) {
        wh_reader_refuse(reader, "stations", NULL, "a table of stations by name");
    }
    const name_t *station_names = read_keys(reader, "stations", &stations);
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
        read_station(reader, &tool->stations[s]);
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

const wh_flow_tool_t *wh_layout_read_tool(wh_reader_t *reader) {
    wh_flow_tool_t *tool = new_tool(reader->L);
    wh_reader_refuse_unknown(reader, wh_layout_timed_fields);
    const bool is_one = wh_reader_has(reader, "robot");
    if (is_one && wh_reader_has(reader, "robots")) {
        wh_reader_refuse(reader, "robot", NULL, "nothing: `robots` has them all");
    }
    open_named(reader, tool, is_one);
    read_stations(reader, tool);
    wh_vec3_t *at = lua_newuserdatauv(reader->L, tool->station_count * sizeof *at, 0);
    lua_insert(reader->L, -2); /* below the table being read */
    read_places(reader, tool, at, is_any_flying(reader, tool, is_one));
    (void)wh_reader_enter(reader, is_one ? "robot" : "robots");
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        if (!is_one) {
            (void)wh_reader_enter(reader, tool->robots[r].name);
        }
        read_robot(reader, tool, r, at);
        if (!is_one) {
            wh_reader_leave(reader);
        }
    }
    wh_reader_leave(reader);
    lua_remove(reader->L, -2);
    return tool;
}
