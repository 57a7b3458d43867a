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
    station->is_load_port = station->has_carriers = station->is_real_port = layout->stations[s].port != NULL;
    const bool has_sensor = wh_layout_scanner(layout, layout->places[s].chuck) != NULL;
    station->works = layout->stations[s].prealigner && has_sensor ? WH_FLOW_WORK_ALIGN
                     : layout->stations[s].flipper                ? WH_FLOW_WORK_FLIP
                                                                  : WH_FLOW_WORK_NONE;
}

static void fill_robot(const wh_layout_t *layout, int32_t number, wh_flow_tool_t *tool, int32_t r) {
    wh_flow_robot_t *robot = &tool->robots[r];
    robot->name = wh_text_copy(layout->robots[number].name);
    robot->arms = count_arms(layout, number);
    robot->at = WH_FLOW_NONE;
    robot->is_real = true;
    robot->number = number;
    for (size_t s = 0; s < layout->station_count; ++s) {
        const size_t of = wh_flow_of(tool, r, (int32_t)s);
        const wh_layout_approach_t *by = layout->stations[s].by;
        const int32_t door = wh_layout_door_of(layout, s, (size_t)number);
        tool->serves[of] = robot->arms > 0 && layout->stations[s].taught && (!by || by[number].serves);
        tool->doors[of] = (wh_flow_door_t){.is_real = door != WH_NONE, .number = door};
        tool->sides[of] = wh_layout_side_of(layout, s, (size_t)number);
    }
}

/* A robot that is times alone: all is as the layout's own tool has it. */
static void fill_timed(const wh_flow_tool_t *from, int32_t number, wh_flow_tool_t *tool, int32_t r) {
    const size_t stations = from->station_count, is = wh_flow_of(from, number, 0),
                 of = wh_flow_of(tool, r, 0);
    tool->robots[r] = from->robots[number];
    tool->robots[r].name = wh_text_copy(from->robots[number].name);
    tool->robots[r].number = number;
    memcpy(&tool->serves[of], &from->serves[is], stations * sizeof *tool->serves);
    memcpy(&tool->doors[of], &from->doors[is], stations * sizeof *tool->doors);
    memcpy(&tool->sides[of], &from->sides[is], stations * sizeof *tool->sides);
    memcpy(&tool->pick_us[of], &from->pick_us[is], stations * sizeof *tool->pick_us);
    memcpy(&tool->place_us[of], &from->place_us[is], stations * sizeof *tool->place_us);
    memcpy(&tool->swap_us[of], &from->swap_us[is], stations * sizeof *tool->swap_us);
    memcpy(&tool->move_us[of * stations], &from->move_us[is * stations],
           stations * stations * sizeof *tool->move_us);
}

/* Both kinds in the order of their names, in which rules are asked. */
static void fill_robots(const wh_layout_t *layout, wh_flow_tool_t *tool) {
    const wh_flow_tool_t *timed = layout->timed;
    int32_t real = 0, other = 0;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const bool is_real = !timed || other == (int32_t)timed->robot_count ||
                             (real < (int32_t)layout->robot_count &&
                              strcmp(layout->robots[real].name, timed->robots[other].name) < 0);
        if (is_real) {
            fill_robot(layout, real++, tool, r);
        } else {
            fill_timed(timed, other++, tool, r);
        }
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
    wh_flow_tool_open(tool, layout->robot_count + (layout->timed ? layout->timed->robot_count : 0),
                      layout->station_count);
    if (layout->recipes) {
        tool->recipes = *layout->recipes;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        fill_station(layout, s, &tool->stations[s]);
    }
    wh_flow_tool_number(tool);
    fill_robots(layout, tool);
    return tool;
}
