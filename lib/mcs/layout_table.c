/* The layout as a Lua table: handed to lua/mcs once, when the cell is set up. */
#include "../script/wh_module_internal.h"
#include "mcs_internal.h"

typedef struct {
    const char *name;
    double value;
} number_t;

static void set_numbers(lua_State *L, const number_t numbers[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        lua_pushnumber(L, numbers[i].value);
        lua_setfield(L, -2, numbers[i].name);
    }
}

static void set_boolean(lua_State *L, const char *name, bool value) {
    lua_pushboolean(L, value);
    lua_setfield(L, -2, name);
}

static void set_text(lua_State *L, const char *name, const char *value) {
    lua_pushstring(L, value);
    lua_setfield(L, -2, name);
}

/* Indices go to Lua from 1; WH_NONE is nil. */
static void set_index(lua_State *L, const char *name, int32_t index) {
    wh_lua_push_index(L, index);
    lua_setfield(L, -2, name);
}

static void push_station(lua_State *L, const wh_layout_t *layout, size_t index) {
    const wh_layout_station_t *station = &layout->stations[index];
    const wh_station_t *place = &layout->places[index];
    static const char *const modes[] = {"both", "get", "put", "none"};
    const number_t numbers[] = {{"pitch", place->pitch},
                                {"stroke", station->stroke},
                                {"offset", station->offset},
                                {"retract", station->retract},
                                {"pickup_speed", station->pickup_speed},
                                {"pickup_acceleration", station->pickup_acceleration},
                                {"release", station->release},
                                {"vacuum_delay", station->vacuum_delay},
                                {"timeout", station->timeout},
                                {"wait", station->wait},
                                {"map_speed", station->map_speed},
                                {"retries", station->retries}};
    lua_createtable(L, 0, 24);
    set_numbers(L, numbers, sizeof numbers / sizeof numbers[0]);
    set_text(L, "name", station->name);
    set_index(L, "index", (int32_t)index);
    lua_pushinteger(L, place->slots);
    lua_setfield(L, -2, "slots");
    set_index(L, "chuck", place->chuck);
    set_index(L, "effector", station->effector);
    set_boolean(L, "taught", station->taught);
    set_boolean(L, "check_map", station->check_map);
    set_text(L, "vacuum_check", modes[station->check]);
    set_text(L, "handover", station->handover == WH_HANDOVER_NEW_FIRST ? "new_first" : "same_slice");
}

static void push_gripper(lua_State *L, const wh_layout_t *layout, size_t g) {
    lua_createtable(L, 0, 3);
    set_text(L, "name", layout->grippers[g].name);
    set_boolean(L, "on_robot", layout->grippers[g].station == WH_NONE);
    set_index(L, "axis", layout->machine.mounts[g].axis);
}

void wh_mcs_push_layout(lua_State *L, const wh_layout_t *layout) {
    const wh_tolerance_t *limit = &layout->grasp.tolerance;
    const number_t tolerance[] = {
        {"projz", limit->projz}, {"projxy", limit->projxy}, {"planar", limit->planar}};
    const number_t slice = {"slice", (double)layout->slice_us / 1e6};
    lua_createtable(L, 0, 8);
    set_text(L, "path", layout->path);
    set_numbers(L, &slice, 1);
    set_boolean(L, "sampled", layout->grasp.check == WH_CHECK_SAMPLED);
    set_boolean(L, "homed", layout->homed);
    lua_createtable(L, 0, 3);
    set_numbers(L, tolerance, 3);
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
