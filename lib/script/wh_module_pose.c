#include <string.h>

#include "wh_module_internal.h"

static void take_triple(lua_State *L, const wh_field_t *at, wh_real_t triple[3]) {
    const int list = lua_gettop(L);
    wh_lua_check_list(L, list, at, 3);
    for (int i = 0; i < 3; ++i) {
        const wh_field_t entry = wh_lua_entry(at, i + 1);
        lua_geti(L, list, i + 1);
        triple[i] = wh_lua_take_number(L, &entry);
    }
    lua_pop(L, 1);
}

static void take_matrix(lua_State *L, const wh_field_t *at, wh_mat3_t *matrix) {
    const int list = lua_gettop(L);
    wh_lua_check_list(L, list, at, 3);
    for (int i = 0; i < 3; ++i) {
        const wh_field_t row = wh_lua_entry(at, i + 1);
        lua_geti(L, list, i + 1);
        take_triple(L, &row, matrix->m[i]);
    }
    lua_pop(L, 1);
}

void wh_lua_take_pose(lua_State *L, const wh_field_t *at, wh_pose_t *pose) {
    static const char *const names[] = {"r", "R", NULL};
    const wh_field_t r = wh_lua_field(at, "r");
    const wh_field_t R = wh_lua_field(at, "R");
    const int table = lua_gettop(L);
    wh_real_t position[3];
    wh_lua_check_record(L, table, at, names);
    lua_getfield(L, table, "r");
    take_triple(L, &r, position);
    pose->r = wh_vec3(position[0], position[1], position[2]);
    if (lua_getfield(L, table, "R") == LUA_TNIL) {
        pose->R = wh_mat3_identity();
        lua_pop(L, 1);
    } else {
        take_matrix(L, &R, &pose->R);
    }
    lua_pop(L, 1);
}

void wh_lua_take_valid_pose(lua_State *L, const wh_field_t *at, wh_pose_t *pose) {
    wh_lua_take_pose(L, at, pose);
    const wh_status_t status = wh_pose_validate(pose);
    if (status != WH_OK) {
        wh_lua_refuse_pose(L, at, pose, status);
    }
}

static wh_tolerance_t find_preset(lua_State *L, const wh_field_t *at) {
    const char *name = lua_tostring(L, -1);
    wh_tolerance_t tolerance;
    for (size_t i = 0; i < WH_TOLERANCE_PRESETS; ++i) {
        if (strcmp(wh_tolerance_preset(i, &tolerance), name) == 0) {
            return tolerance;
        }
    }
    wh_lua_refuse(L, at, "\"%s\" (expected \"paper\", \"strict\" or a table)", name);
    return wh_tolerance_paper();
}

static wh_tolerance_t read_limits(lua_State *L, const wh_field_t *at) {
    static const char *const names[] = {"projz", "projxy", "planar", NULL};
    const int table = lua_gettop(L);
    const wh_tolerance_t paper = wh_tolerance_paper();
    wh_tolerance_t t;
    wh_lua_check_record(L, table, at, names);
    t.projz = wh_lua_get_number(L, table, at, "projz", paper.projz);
    t.projxy = wh_lua_get_number(L, table, at, "projxy", paper.projxy);
    t.planar = wh_lua_get_number(L, table, at, "planar", paper.planar);
    const wh_status_t status = wh_tolerance_validate(&t);
    if (status != WH_OK) {
        wh_lua_refuse(L, at,
                      "projz %f, projxy %f, planar %f (expected projz in (0, 1e6], projxy in [1e-6, 1e6], "
                      "planar in [0, 1)) [%d]",
                      t.projz, t.projxy, t.planar, (int)status);
    }
    return t;
}

wh_tolerance_t wh_lua_take_tolerance(lua_State *L, const wh_field_t *at) {
    wh_tolerance_t tolerance = wh_tolerance_paper();
    switch (lua_type(L, -1)) {
    case LUA_TNIL:
        break;
    case LUA_TSTRING:
        tolerance = find_preset(L, at);
        break;
    case LUA_TTABLE:
        tolerance = read_limits(L, at);
        break;
    default:
        wh_lua_refuse(L, at, "table or a preset's name expected, got %s", luaL_typename(L, -1));
    }
    lua_pop(L, 1);
    return tolerance;
}
