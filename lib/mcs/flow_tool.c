#include "flow_tool.h"

#include <lauxlib.h>
#include <string.h>

#include "../layout/times.h"
#include "../text/array.h"

/* The most arms of a robot in a flow. */
#define MOST_ARMS 2

int32_t wh_flow_gripper_of(const wh_layout_t *layout, int32_t robot, int32_t arm) {
    int32_t found = -1;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const bool is_its =
            layout->grippers[g].station == WH_NONE && layout->machine.mounts[g].robot == robot;
        if (is_its && ++found == arm) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
}

static int32_t count_arms(const wh_layout_t *layout, int32_t robot) {
    int32_t arms = 0;
    while (arms < MOST_ARMS && wh_flow_gripper_of(layout, robot, arms) != WH_NONE) {
        ++arms;
    }
    return arms;
}

static void fill_station(const wh_layout_t *layout, size_t s, wh_flow_station_t *station) {
    const wh_layout_times_t *times = layout->stations[s].times;
    if (times) {
        *station = times->of;
        station->is_real = true;
    }
    station->name = wh_text_copy(layout->stations[s].name);
    station->slots = layout->places[s].slots;
    const bool has_sensor = wh_layout_scanner(layout, layout->places[s].chuck) != NULL;
    station->works = layout->stations[s].prealigner && has_sensor ? WH_FLOW_WORK_ALIGN
                     : layout->stations[s].flipper                ? WH_FLOW_WORK_FLIP
                                                                  : WH_FLOW_WORK_NONE;
}

static void fill_robot(const wh_layout_t *layout, int32_t r, wh_flow_tool_t *tool) {
    wh_flow_robot_t *robot = &tool->robots[r];
    robot->name = wh_text_copy(layout->robots[r].name);
    robot->arms = count_arms(layout, r);
    robot->at = WH_FLOW_NONE;
    robot->is_real = true;
    for (size_t s = 0; s < layout->station_count; ++s) {
        const size_t of = wh_flow_of(tool, r, (int32_t)s);
        const wh_layout_approach_t *by = layout->stations[s].by;
        tool->serves[of] = robot->arms > 0 && layout->stations[s].taught && (!by || by[r].serves);
        tool->doors[of].is_real = wh_layout_door_of(layout, s, (size_t)r) != WH_NONE;
        tool->sides[of] = wh_layout_side_of(layout, s, (size_t)r);
    }
}

static int close_tool(lua_State *L) {
    wh_flow_tool_close(lua_touserdata(L, 1));
    return 0;
}

wh_flow_tool_t *wh_flow_tool_of_layout(lua_State *L, const wh_layout_t *layout) {
    wh_flow_tool_t *tool = lua_newuserdatauv(L, sizeof *tool, 0);
    memset(tool, 0, sizeof *tool);
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, close_tool);
    lua_setfield(L, -2, "__gc");
    lua_setmetatable(L, -2);
    lua_rawsetp(L, LUA_REGISTRYINDEX, tool);
    wh_flow_tool_open(tool, layout->robot_count, layout->station_count);
    for (size_t s = 0; s < layout->station_count; ++s) {
        fill_station(layout, s, &tool->stations[s]);
    }
    wh_flow_tool_number(tool);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        fill_robot(layout, (int32_t)r, tool);
    }
    return tool;
}
