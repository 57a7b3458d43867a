/* Robots that are times alone: picks, places and swaps by station, moves by pair or by speed. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "layout_internal.h"
#include "layout_tool.h"

/* The number of a station that the robot serves; a time for another one would never be used. */
static int32_t find_served(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t robot, const char *field,
                           const char *name) {
    const int32_t station = wh_timed_find_station(reader, tool, field, name);
    if (!tool->serves[wh_flow_of(tool, robot, station)]) {
        wh_reader_refuse(reader, field, name, "a station that %s serves", tool->robots[robot].name);
    }
    return station;
}

/* The times of the stations that the reader's table names. It must name all that the robot serves if there is
 * no usual time. */
static void read_own_times(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t robot, bool has_usual,
                           int64_t own_us[]) {
    for (size_t s = 0; s < tool->station_count; ++s) {
        const bool is_needed = !has_usual && tool->serves[wh_flow_of(tool, robot, (int32_t)s)];
        if (is_needed || wh_reader_has(reader, tool->stations[s].name)) {
            own_us[s] = wh_timed_read_us(reader, tool->stations[s].name, (double)NAN);
        }
    }
    size_t count = 0;
    const wh_timed_name_t *names = wh_timed_read_names(reader, "stations", &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(names[i].name, "default") != 0) {
            (void)find_served(reader, tool, robot, names[i].name, names[i].name);
        }
    }
}

/* A time for each station: a number, or a table with some of them and `default`. */
static void read_times(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const char *field,
                       double fallback, int64_t times_us[]) {
    int64_t *own_us = &times_us[wh_flow_of(tool, robot, 0)];
    const int type = wh_reader_push(reader, field);
    lua_pop(reader->L, 1);
    const bool is_table = type == LUA_TTABLE && wh_reader_enter(reader, field);
    const double usual =
        is_table ? wh_reader_number(reader, "default", isnan(fallback) ? 0 : fallback, 0, WH_TIMED_LONGEST_S)
                 : wh_reader_number(reader, field, fallback, 0, WH_TIMED_LONGEST_S);
    for (size_t s = 0; s < tool->station_count; ++s) {
        own_us[s] = wh_layout_us(usual);
    }
    if (is_table) {
        const bool has_usual = wh_reader_has(reader, "default") || !isnan(fallback);
        read_own_times(reader, tool, robot, has_usual, own_us);
        wh_reader_leave(reader);
    }
}

/* One end of a pair: a station that the robot serves, or in front of which it begins. */
static size_t find_end(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t robot, const char *pair,
                       const char *name) {
    const int32_t begins = tool->robots[robot].at;
    return (size_t)(strcmp(name, tool->stations[begins].name) == 0
                        ? begins
                        : find_served(reader, tool, robot, pair, name));
}

/* One pair of `move`, named "A>B"; and the way back, unless that is named as well. */
static void read_pair(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const char *pair) {
    char from[WH_NAME_SIZE], to[WH_NAME_SIZE], back[2 * WH_NAME_SIZE];
    if (sscanf(pair, "%63[^>]>%63[^\n]", from, to) != 2) {
        wh_reader_refuse(reader, NULL, pair, "a pair of stations, as in [\"A>B\"]");
    }
    const size_t a = find_end(reader, tool, robot, pair, from), b = find_end(reader, tool, robot, pair, to);
    if (a == b) {
        wh_reader_refuse(reader, NULL, pair, "two stations: within one a robot has no way");
    }
    const int64_t us = wh_timed_read_us(reader, pair, (double)NAN);
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

/* Returns the usual one, us. */
static int64_t read_moves(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot) {
    if (wh_reader_push(reader, "move") != LUA_TTABLE) {
        lua_pop(reader->L, 1);
        const int64_t us = wh_timed_read_us(reader, "move", (double)NAN);
        fill_moves(tool, robot, us);
        return us;
    }
    lua_pop(reader->L, 1);
    (void)wh_reader_enter(reader, "move");
    const int64_t usual_us = wh_timed_read_us(reader, "default", (double)NAN);
    fill_moves(tool, robot, usual_us);
    size_t count = 0;
    const wh_timed_name_t *pairs = wh_timed_read_names(reader, "pairs of stations", &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(pairs[i].name, "default") != 0) {
            read_pair(reader, tool, robot, pairs[i].name);
        }
    }
    wh_reader_leave(reader);
    return usual_us;
}

/* The straight way between the stations' places at the robot's speed. */
static void fly(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const wh_vec3_t at[]) {
    const double speed = wh_reader_apart(reader, "speed");
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
    tool->robots[robot].is_at_assumed = !wh_reader_has(reader, "at");
    wh_reader_text(reader, "at", tool->stations[first].name, name, sizeof name);
    tool->robots[robot].at = wh_timed_find_station(reader, tool, "at", name);
}

/* Without a `swap`: the station's pick and place, and the usual move, whatever moves to and from it take. A
 * robot with a speed has no usual one: with two arms it needs a `swap`. */
static void fill_swaps(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, int64_t usual_us) {
    if (usual_us == WH_FLOW_NONE && tool->robots[robot].arms > 1) {
        wh_reader_refuse(reader, "swap", NULL,
                         "s, or by station: with `speed` there is no move of one length");
    }
    for (size_t s = 0; s < tool->station_count; ++s) {
        const size_t of = wh_flow_of(tool, robot, (int32_t)s);
        tool->swap_us[of] = tool->pick_us[of] + (usual_us > 0 ? usual_us : 0) + tool->place_us[of];
    }
}

void wh_timed_read_robot(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const wh_vec3_t at[]) {
    wh_reader_refuse_unknown(reader, wh_layout_timed_robot_fields);
    tool->robots[robot].arms = (int32_t)wh_reader_apart(reader, "arms");
    read_stand(reader, tool, robot);
    read_times(reader, tool, robot, "pick", (double)NAN, tool->pick_us);
    read_times(reader, tool, robot, "place", (double)NAN, tool->place_us);
    int64_t usual_us = WH_FLOW_NONE;
    if (wh_reader_has(reader, "speed")) {
        if (wh_reader_has(reader, "move")) {
            wh_reader_refuse(reader, "speed", NULL, "nothing beside `move`");
        }
        fly(reader, tool, robot, at);
    } else {
        usual_us = read_moves(reader, tool, robot);
    }
    if (wh_reader_has(reader, "swap")) {
        read_times(reader, tool, robot, "swap", (double)NAN, tool->swap_us);
    } else {
        fill_swaps(reader, tool, robot, usual_us);
    }
}
