/* The MCS host's collision check: what a script can ask of it. */
#include <string.h>

#include "mcs_internal.h"

static void push_part(lua_State *L, const wh_mcs_t *mcs, int32_t part) {
    const char *name = wh_layout_part_name(mcs->layout, part);
    lua_pushstring(L, name ? name : "nothing");
}

static void set_parts(lua_State *L, const wh_mcs_t *mcs, const int32_t parts[2]) {
    lua_createtable(L, 2, 0);
    for (int i = 0; i < 2; ++i) {
        push_part(L, mcs, parts[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "parts");
}

static void set_place(lua_State *L, wh_vec3_t at) {
    const double values[] = {at.x, at.y, at.z};
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; ++i) {
        lua_pushnumber(L, values[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "at");
}

/* native.hits(): a list of { kind, parts, at, time } so far. */
static int list_hits(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    lua_newtable(L);
    wh_decisions_measured(mcs->decisions, "hits");
    for (size_t i = 0; i < mcs->record->event_count; ++i) {
        const wh_event_record_t *record = &mcs->record->events[i];
        const wh_event_kind_t kind = record->event.kind;
        if (kind == WH_EVENT_HIT || kind == WH_EVENT_UNDECIDED) {
            lua_createtable(L, 0, 4);
            lua_pushstring(L, wh_event_name(kind));
            lua_setfield(L, -2, "kind");
            set_parts(L, mcs, record->event.parts);
            set_place(L, record->event.at);
            lua_pushnumber(L, (double)record->utime / 1e6);
            lua_setfield(L, -2, "time");
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
    return 1;
}

static int find_kind(const char *name) {
    int kind = 0;
    while (kind < WH_CLEARANCES && strcmp(name, wh_clearance_name((wh_clearance_kind_t)kind)) != 0) {
        ++kind;
    }
    return kind;
}

/* native.clearance(kind): { gap, limit, time, parts, at } so far, of which only `limit` is there until something was near; nil
 * where nobody looks; false for a kind that there is not. */
static int find_clearance(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int kind = find_kind(luaL_checkstring(L, 1));
    wh_decisions_measured(mcs->decisions, "clearance");
    if (kind == WH_CLEARANCES) {
        lua_pushboolean(L, 0);
        return 1;
    }
    if (!mcs->collision.world) {
        return 0;
    }
    const wh_clearance_t *least = &wh_world_clearances(mcs->collision.world)[kind];
    lua_createtable(L, 0, 5);
    lua_pushnumber(L, mcs->layout->world.limits[kind]);
    lua_setfield(L, -2, "limit");
    if (least->parts[0] != WH_NONE) {
        lua_pushnumber(L, least->gap);
        lua_setfield(L, -2, "gap");
        lua_pushnumber(L, (double)((int64_t)least->slice * mcs->layout->slice_us) / 1e6);
        lua_setfield(L, -2, "time");
        set_parts(L, mcs, least->parts);
        set_place(L, least->at);
    }
    return 1;
}

const luaL_Reg wh_mcs_collision_functions[] = {
    {"hits", list_hits}, {"clearance", find_clearance}, {NULL, NULL}};
