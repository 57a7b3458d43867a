#include "wh_module_internal.h"

void wh_lua_set_number(lua_State *L, const char *name, wh_real_t value) {
    lua_pushnumber(L, value);
    lua_setfield(L, -2, name);
}

static void set_slice(lua_State *L, const char *name, uint64_t slice) {
    lua_pushinteger(L, (lua_Integer)slice);
    lua_setfield(L, -2, name);
}

void wh_lua_set_index(lua_State *L, const char *name, int32_t index) {
    wh_lua_push_index(L, index);
    lua_setfield(L, -2, name);
}

static void push_triple(lua_State *L, const wh_vec3_t *v) {
    const wh_real_t entries[3] = {v->x, v->y, v->z};
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; ++i) {
        lua_pushnumber(L, entries[i]);
        lua_rawseti(L, -2, i + 1);
    }
}

void wh_lua_set_triple(lua_State *L, const char *name, const wh_vec3_t *v) {
    push_triple(L, v);
    lua_setfield(L, -2, name);
}

void wh_lua_push_pose(lua_State *L, const wh_pose_t *pose) {
    lua_createtable(L, 0, 2);
    wh_lua_set_triple(L, "r", &pose->r);
    lua_createtable(L, 3, 0);
    for (size_t i = 0; i < 3; ++i) {
        const wh_vec3_t row = wh_mat3_row(&pose->R, i);
        push_triple(L, &row);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "R");
}

void wh_lua_push_tolerance(lua_State *L, const wh_tolerance_t *tolerance) {
    lua_createtable(L, 0, 3);
    wh_lua_set_number(L, "projz", tolerance->projz);
    wh_lua_set_number(L, "projxy", tolerance->projxy);
    wh_lua_set_number(L, "planar", tolerance->planar);
}

void wh_lua_push_index(lua_State *L, int32_t index) {
    if (index == WH_NONE) {
        lua_pushnil(L);
    } else {
        lua_pushinteger(L, (lua_Integer)index + 1);
    }
}

static void set_failed(lua_State *L, unsigned failed) {
    static const struct {
        unsigned bit;
        const char *name;
    } conditions[] = {{WH_FAILED_PROJZ, "projz"}, {WH_FAILED_PROJXY, "projxy"}, {WH_FAILED_PLANAR, "planar"}};
    lua_newtable(L);
    for (size_t i = 0; i < sizeof conditions / sizeof conditions[0]; ++i) {
        if (failed & conditions[i].bit) {
            lua_pushboolean(L, 1);
            lua_setfield(L, -2, conditions[i].name);
        }
    }
    lua_setfield(L, -2, "failed");
}

static void set_proximity(lua_State *L, const wh_proximity_t *p) {
    const wh_tolerance_t margin = {p->margin_projz, p->margin_projxy, p->margin_planar};
    wh_lua_set_triple(L, "dr", &p->dr);
    wh_lua_set_number(L, "n1_proj_n2", p->n1_proj_n2);
    wh_lua_set_number(L, "dr_proj_z", p->dr_proj_z);
    wh_lua_set_triple(L, "dr_proj_xy", &p->dr_proj_xy);
    wh_lua_set_number(L, "dr_proj_xy_norm", p->dr_proj_xy_norm);
    lua_pushboolean(L, p->ready);
    lua_setfield(L, -2, "ready");
    set_failed(L, p->failed);
    wh_lua_push_tolerance(L, &margin);
    lua_setfield(L, -2, "margin");
}

void wh_lua_push_proximity(lua_State *L, const wh_proximity_t *proximity) {
    lua_createtable(L, 0, 8);
    set_proximity(L, proximity);
}

void wh_lua_push_event(lua_State *L, const wh_event_t *event) {
    lua_createtable(L, 0, 14);
    lua_pushstring(L, wh_event_name(event->kind));
    lua_setfield(L, -2, "kind");
    set_slice(L, "slice", event->slice);
    set_slice(L, "measured_slice", event->measured_slice);
    wh_lua_set_index(L, "wafer", event->wafer);
    wh_lua_set_index(L, "gripper", event->gripper);
    if (event->kind == WH_EVENT_HANDED_OVER) {
        wh_lua_set_index(L, "from", event->other);
    } else if (event->kind == WH_EVENT_CONTESTED) {
        wh_lua_set_index(L, "holder", event->other);
    }
    set_proximity(L, &event->measured);
}
