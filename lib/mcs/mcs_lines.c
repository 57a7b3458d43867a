/* The MCS host for typed lines: names to complete, the time, and what the cell complained of. */
#include <stdio.h>

#include "mcs_internal.h"

/* native.utime(): simulated microseconds so far. */
static int read_utime(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    lua_pushinteger(L, mcs->track.slice * mcs->track.slice_us);
    return 1;
}

/* native.held(gripper): the name of the wafer that it holds, or nil. */
static int find_held(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const int32_t wafer = mcs->state.grippers[gripper].wafer;
    wh_decisions_ask(mcs->decisions, WH_TAPE_HELD, gripper, wafer);
    if (wafer == WH_NONE) {
        return 0;
    }
    lua_pushstring(L, mcs->layout->wafers[wafer].name);
    return 1;
}

/* native.wafer_names(): a list. */
static int list_wafers(lua_State *L) {
    const wh_layout_t *layout = wh_mcs_with_layout(L)->layout;
    wh_sandbox_charge(L, layout->wafer_count);
    lua_createtable(L, (int)layout->wafer_count, 0);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        lua_pushstring(L, layout->wafers[w].name);
        lua_rawseti(L, -2, (lua_Integer)w + 1);
    }
    return 1;
}

/* native.mark(): how many events the record has. */
static int count_events(lua_State *L) {
    lua_pushinteger(L, (lua_Integer)wh_mcs_with_layout(L)->record->event_count);
    return 1;
}

static void push_complaint(lua_State *L, const wh_layout_t *layout, const wh_event_t *event) {
    lua_pushstring(L, wh_event_name(event->kind));
    if (event->wafer != WH_NONE) {
        lua_pushfstring(L, " \"%s\"", layout->wafers[event->wafer].name);
        lua_concat(L, 2);
    }
    if (event->kind == WH_EVENT_RELEASED_UNSUPPORTED) {
        char height[60];
        snprintf(height, sizeof height, ", %.3f mm high", event->height);
        lua_pushstring(L, height);
        lua_concat(L, 2);
    }
}

/* native.complaints(mark): what the cell complained of since then, as text, or nil. */
static int describe_complaints(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    luaL_Buffer text;
    bool any = false;
    const size_t mark = (size_t)luaL_checkinteger(L, 1);
    luaL_buffinit(L, &text);
    for (size_t i = mark; i < mcs->record->event_count; ++i) {
        const wh_event_t *event = &mcs->record->events[i].event;
        if (wh_mcs_is_complaint(event)) {
            luaL_addstring(&text, any ? "; " : "");
            push_complaint(L, mcs->layout, event);
            luaL_addvalue(&text);
            any = true;
        }
    }
    luaL_pushresult(&text);
    return any ? 1 : 0;
}

const luaL_Reg wh_mcs_line_functions[] = {{"utime", read_utime},
                                          {"held", find_held},
                                          {"wafer_names", list_wafers},
                                          {"mark", count_events},
                                          {"complaints", describe_complaints},
                                          {NULL, NULL}};
