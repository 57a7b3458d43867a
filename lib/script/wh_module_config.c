#include <string.h>

#include "wh_module_internal.h"

static wh_check_t read_check(lua_State *L, const wh_field_t *of) {
    const wh_field_t at = wh_lua_field(of, "check");
    const int type = lua_getfield(L, 1, "check");
    const char *name = type == LUA_TSTRING ? lua_tostring(L, -1) : "sampled";
    const bool swept = strcmp(name, "swept") == 0;
    if (type != LUA_TNIL && type != LUA_TSTRING) {
        wh_lua_refuse(L, &at, "string expected, got %s", luaL_typename(L, -1));
    }
    if (!swept && strcmp(name, "sampled") != 0) {
        wh_lua_refuse(L, &at, "\"%s\" (expected \"sampled\" or \"swept\")", name);
    }
    lua_pop(L, 1);
    return swept ? WH_CHECK_SWEPT : WH_CHECK_SAMPLED;
}

static bool read_seat(lua_State *L, const wh_field_t *of, bool otherwise) {
    const wh_field_t at = wh_lua_field(of, "seat");
    const int type = lua_getfield(L, 1, "seat");
    const bool seat = type == LUA_TNIL ? otherwise : lua_toboolean(L, -1);
    if (type != LUA_TNIL && type != LUA_TBOOLEAN) {
        wh_lua_refuse(L, &at, "boolean expected, got %s", luaL_typename(L, -1));
    }
    lua_pop(L, 1);
    return seat;
}

wh_grasp_config_t wh_lua_read_config(lua_State *L, const wh_field_t *of) {
    const wh_field_t tolerance = wh_lua_field(of, "tolerance");
    wh_grasp_config_t config = wh_grasp_config_default();
    lua_getfield(L, 1, "tolerance");
    config.tolerance = wh_lua_take_tolerance(L, &tolerance);
    config.check = read_check(L, of);
    config.seat = read_seat(L, of, config.seat);
    config.near_projz = wh_lua_get_number(L, 1, of, "near_projz", config.near_projz);
    config.near_projxy = wh_lua_get_number(L, 1, of, "near_projxy", 2 * config.tolerance.projxy);
    return config;
}
