/* The layout as a Lua table: handed to lua/mcs once, when the cell is set up. */
#include "../script/wh_module_values.h"
#include "mcs_internal.h"

static void push_station(lua_State *L, const wh_layout_t *layout, size_t index) {
    const wh_layout_station_t *station = &layout->stations[index];
    const wh_station_t *place = &layout->places[index];
    static const char *const modes[] = {"both", "get", "put", "none"};
    lua_createtable(L, 0, 24);
    wh_lua_set_number(L, "pitch", place->pitch);
    wh_lua_set_number(L, "stroke", station->stroke);
    wh_lua_set_number(L, "offset", station->offset);
    wh_lua_set_number(L, "retract", station->retract);
    wh_lua_set_number(L, "pickup_speed", station->pickup_speed);
    wh_lua_set_number(L, "pickup_acceleration", station->pickup_acceleration);
    wh_lua_set_number(L, "release", station->release);
    wh_lua_set_number(L, "vacuum_delay", station->vacuum_delay);
    wh_lua_set_number(L, "timeout", station->timeout);
    wh_lua_set_number(L, "wait", station->wait);
    wh_lua_set_number(L, "map_speed", station->map_speed);
    wh_lua_set_number(L, "retries", station->retries);
    wh_lua_set_text(L, "name", station->name);
    wh_lua_set_index(L, "index", (int32_t)index);
    wh_lua_set_integer(L, "slots", place->slots);
    wh_lua_set_index(L, "chuck", place->chuck);
    wh_lua_set_index(L, "effector", station->effector);
    wh_lua_set_boolean(L, "taught", station->taught);
    wh_lua_set_boolean(L, "check_map", station->check_map);
    wh_lua_set_text(L, "vacuum_check", modes[station->check]);
    wh_lua_set_text(L, "handover", station->handover == WH_HANDOVER_NEW_FIRST ? "new_first" : "same_slice");
}

static void push_gripper(lua_State *L, const wh_layout_t *layout, size_t g) {
    lua_createtable(L, 0, 3);
    wh_lua_set_text(L, "name", layout->grippers[g].name);
    wh_lua_set_boolean(L, "on_robot", layout->grippers[g].station == WH_NONE);
    wh_lua_set_index(L, "axis", layout->machine.mounts[g].axis);
}

void wh_mcs_push_layout(lua_State *L, const wh_layout_t *layout) {
    lua_createtable(L, 0, 8);
    wh_lua_set_text(L, "path", layout->path);
    wh_lua_set_number(L, "slice", (double)layout->slice_us / 1e6);
    wh_lua_set_boolean(L, "sampled", layout->grasp.check == WH_CHECK_SAMPLED);
    wh_lua_set_boolean(L, "homed", layout->homed);
    wh_lua_push_tolerance(L, &layout->grasp.tolerance);
    lua_setfield(L, -2, "tolerance");
    lua_createtable(L, 0, (int)layout->station_count);
    for (size_t s = 0; s < layout->station_count; ++s) {
        push_station(L, layout, s);
        lua_setfield(L, -2, layout->stations[s].name);
    }
    lua_setfield(L, -2, "stations");
    lua_createtable(L, (int)layout->machine.gripper_count, 0);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        push_gripper(L, layout, g);
        lua_rawseti(L, -2, (lua_Integer)g + 1);
    }
    lua_setfield(L, -2, "grippers");
    lua_createtable(L, WH_ROBOT_AXES, 0);
    for (int axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        lua_pushnumber(L, layout->machine.robot.home[axis]);
        lua_rawseti(L, -2, axis + 1);
    }
    lua_setfield(L, -2, "home");
}
