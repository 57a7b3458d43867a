/* The tester's own dialect: where it is, and its table `known`, the names that a tester may type, and the one
 * that it may have meant. */
#include <string.h>

#include <lauxlib.h>

#include "../grasp/event.h"
#include "../script/embedded.h"
#include "../script/wh_module_values.h"
#include "../text/nearest.h"
#include "dialect_internal.h"
#include "state.h"

#define MOST_NAMES 160
#define TESTERS "dialects/control.lua"

bool wh_dialect_is_testers(const char *path) {
    const size_t length = strlen(path);
    const size_t name = strlen(TESTERS);
    return strcmp(path, WH_DIALECT_CONTROL) == 0 ||
           (length >= name && strcmp(path + length - name, TESTERS) == 0);
}

const wh_embedded_t *wh_dialect_find_embedded(const char *path) {
    for (size_t i = 0; strcmp(path, WH_DIALECT_CONTROL) == 0 && i < wh_embedded_count; ++i) {
        if (strcmp(wh_embedded[i].name, TESTERS) == 0) {
            return &wh_embedded[i];
        }
    }
    return NULL;
}

/* known.meant(word, names): "; did you mean NAME?", or "". */
static int find_meant(lua_State *L) {
    const char *names[MOST_NAMES];
    char text[WH_NEAREST_TEXT];
    const char *word = luaL_checkstring(L, 1);
    luaL_checktype(L, 2, LUA_TTABLE);
    size_t count = 0;
    while (count < MOST_NAMES && lua_rawgeti(L, 2, (lua_Integer)count + 1) == LUA_TSTRING) {
        names[count++] = lua_tostring(L, -1); /* it stays in the list */
        lua_pop(L, 1);
    }
    lua_pushstring(L, wh_text_did_you_mean(text, "; ", "", wh_text_nearest(word, names, count)));
    return 1;
}

static void add_name(lua_State *L, const char *name) {
    lua_pushstring(L, name);
    lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
}

/* The kinds of events: those of wafers by their own names. */
static void push_kinds(lua_State *L) {
    lua_newtable(L);
    for (int kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        add_name(L, wh_event_name((wh_event_kind_t)kind));
    }
    for (int kind = WH_HOST_WAFER + 1; kind < WH_HOST_EVENTS; ++kind) {
        add_name(L, wh_host_event_names[kind]);
    }
}

static void push_errors(lua_State *L) {
    lua_newtable(L);
    for (int number = WH_OK + 1; number < WH_HOST_NUMBERS; ++number) {
        const char *name = wh_status_name((wh_status_t)number);
        if (strcmp(name, "UNKNOWN") != 0) {
            add_name(L, name);
        }
    }
}

void wh_dialect_open_tester(lua_State *L) {
    lua_createtable(L, 0, 3);
    push_kinds(L);
    lua_setfield(L, -2, "kinds");
    push_errors(L);
    lua_setfield(L, -2, "errors");
    lua_pushcfunction(L, find_meant);
    lua_setfield(L, -2, "meant");
    lua_setglobal(L, "known");
}
