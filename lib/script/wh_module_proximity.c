#include "wh_module_internal.h"

/* An argument that may be missing reads as nil. */
static void push_argument(lua_State *L, int number) {
    luaL_checkstack(L, LUA_MINSTACK, NULL);
    if (lua_isnone(L, number)) {
        lua_pushnil(L);
    } else {
        lua_pushvalue(L, number);
    }
}

static void read_poses(lua_State *L, wh_pose_t *base_from_wafer, wh_pose_t *base_from_gripper) {
    const wh_field_t wafer = wh_lua_argument("wafer", 1);
    const wh_field_t gripper = wh_lua_argument("gripper", 2);
    push_argument(L, 1);
    wh_lua_take_valid_pose(L, &wafer, base_from_wafer);
    push_argument(L, 2);
    wh_lua_take_valid_pose(L, &gripper, base_from_gripper);
}

int wh_lua_proximity(lua_State *L) {
    const wh_field_t at = wh_lua_argument("tolerance", 3);
    wh_pose_t wafer, gripper;
    read_poses(L, &wafer, &gripper);
    push_argument(L, 3);
    const wh_tolerance_t tolerance = wh_lua_take_tolerance(L, &at);
    wh_proximity_t result;
    const wh_status_t status = wh_proximity_measure(&wafer, &gripper, &tolerance, &result);
    if (status != WH_OK) {
        return luaL_error(L, "%s [%d]", wh_status_text(status), (int)status);
    }
    wh_lua_push_proximity(L, &result);
    return 1;
}

int wh_lua_rim_gap(lua_State *L) {
    const wh_field_t at = wh_lua_argument("radius", 3);
    wh_pose_t wafer, gripper;
    read_poses(L, &wafer, &gripper);
    push_argument(L, 3);
    const wh_real_t radius = wh_lua_take_number(L, &at);
    if (!wh_real_is_finite(radius) || radius < 0) {
        return wh_lua_refuse(L, &at, "%f (expected a finite number, 0 or more)", radius);
    }
    lua_pushnumber(L, wh_proximity_rim_gap(&wafer, &gripper, radius));
    return 1;
}

int wh_lua_tolerance(lua_State *L) {
    const wh_field_t at = wh_lua_argument("tolerance", 1);
    push_argument(L, 1);
    const wh_tolerance_t tolerance = wh_lua_take_tolerance(L, &at);
    wh_lua_push_tolerance(L, &tolerance);
    return 1;
}
