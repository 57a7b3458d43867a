/* The module and its plain functions. */
#include "wh_module.h"

#include "wh_module_values.h"

/* Leaves the third argument, or nil, on top. */
static void read_poses(lua_State *L, wh_pose_t *base_from_wafer, wh_pose_t *base_from_gripper) {
    const wh_field_t wafer = wh_lua_argument("wafer", 1);
    const wh_field_t gripper = wh_lua_argument("gripper", 2);
    luaL_checkstack(L, LUA_MINSTACK, NULL);
    wh_lua_take_at_most(L, 3);
    lua_pushvalue(L, 1);
    wh_lua_take_valid_pose(L, &wafer, base_from_wafer);
    lua_pushvalue(L, 2);
    wh_lua_take_valid_pose(L, &gripper, base_from_gripper);
}

static int proximity(lua_State *L) {
    const wh_field_t at = wh_lua_argument("tolerance", 3);
    wh_pose_t wafer, gripper;
    read_poses(L, &wafer, &gripper);
    const wh_tolerance_t tolerance = wh_lua_take_tolerance(L, &at);
    wh_proximity_t result;
    const wh_status_t status = wh_proximity_measure(&wafer, &gripper, &tolerance, &result);
    if (status != WH_OK) {
        return luaL_error(L, "%s [%d]", wh_status_text(status), (int)status);
    }
    wh_lua_push_proximity(L, &result);
    return 1;
}

static int rim_gap(lua_State *L) {
    const wh_field_t at = wh_lua_argument("radius", 3);
    wh_pose_t wafer, gripper;
    read_poses(L, &wafer, &gripper);
    const wh_real_t radius = wh_lua_take_number(L, &at);
    if (!wh_real_is_finite(radius) || radius < 0) {
        return wh_lua_refuse(L, &at, "%f (expected a finite number, 0 or more)", radius);
    }
    lua_pushnumber(L, wh_proximity_rim_gap(&wafer, &gripper, radius));
    return 1;
}

static int tolerance(lua_State *L) {
    const wh_field_t at = wh_lua_argument("tolerance", 1);
    wh_lua_take_at_most(L, 1);
    const wh_tolerance_t tolerance = wh_lua_take_tolerance(L, &at);
    wh_lua_push_tolerance(L, &tolerance);
    return 1;
}

static const struct {
    int number;
    const char *name, *text;
} catalogue[] = {
#define WH_STATUS(number, name, text) {(number), #name, text},
#include "../math/status.def"
#undef WH_STATUS
};

static void push_errors(lua_State *L) {
    lua_newtable(L);
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; ++i) {
        lua_createtable(L, 0, 2);
        wh_lua_set_integer(L, "number", catalogue[i].number);
        wh_lua_set_text(L, "text", catalogue[i].text);
        lua_setfield(L, -2, catalogue[i].name);
    }
}

int luaopen_wh(lua_State *L) {
    static const luaL_Reg functions[] = {{"proximity", proximity},
                                         {"rim_gap", rim_gap},
                                         {"tolerance", tolerance},
                                         {"cell", wh_lua_cell},
                                         {NULL, NULL}};
    wh_lua_open_cell(L);
    luaL_newlib(L, functions);
    wh_lua_set_text(L, "version", WH_VERSION);
    push_errors(L);
    lua_setfield(L, -2, "errors");
    return 1;
}
