/* Reading an undefined global is an error that gives the nearest name. */
#include <stdlib.h>
#include <string.h>

#include "../text/nearest.h"
#include "sandbox_internal.h"

/* Comparing a name costs this number of instructions. */
#define STEPS_PER_NAME 100

#define BITS "it has not the same bits on every machine"

/* Names that people look for in Lua, and their replacements here. */
static const struct {
    const char *name, *instead;
} absent[] = {
    {"cell", "a script has it: waferhand run FILE"},
    {"collectgarbage", "memory is collected by itself"},
    {"debug", "an error names its line by itself"},
    {"dofile", "require \"NAME\" runs NAME.lua beside this file, once"},
    {"io", "print writes lines, run --json writes the result"},
    {"loadfile", "require \"NAME\" runs NAME.lua beside this file, once"},
    {"math.cosh", BITS},
    {"math.exp", BITS},
    {"math.frexp", "(\"%a\"):format(x) shows mantissa and exponent"},
    {"math.ldexp", "x * 2.0 ^ n is the same"},
    {"math.log", BITS},
    {"math.log10", BITS},
    {"math.pow", "x ^ n takes whole exponents"},
    {"math.sinh", BITS},
    {"math.tanh", BITS},
    {"os", "params.NAME has what --set NAME=VALUE hands over; there is no clock and no environment"},
    {"package", "require \"NAME\" runs NAME.lua beside this file, once"},
    {"string.dump", "load takes texts alone"},
    {"warn", "print writes lines"},
};

static const char *instead_of(const char *name) {
    for (size_t i = 0; i < sizeof absent / sizeof *absent; ++i) {
        if (strcmp(absent[i].name, name) == 0) {
            return absent[i].instead;
        }
    }
    return NULL;
}

/* True if the reading function belongs to a script, a layout or a module of theirs. With trust other
 * functions may read globals of other versions of Lua. */
static bool is_ours(lua_State *L) {
    lua_Debug frame;
    if (!lua_getstack(L, 1, &frame) || !lua_getinfo(L, "S", &frame) || frame.what[0] == 'C') {
        return false;
    }
    return !wh_sandbox_of(L)->trust || wh_sandbox_owns(L, frame.source);
}

static int compare(const void *one, const void *other) {
    return strcmp(*(const char *const *)one, *(const char *const *)other);
}

const char **wh_library_list_names(lua_State *L, const char *const words[], size_t *count) {
    size_t room = *count + 1;
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        ++room;
    }
    const char **names = lua_newuserdatauv(L, room * sizeof *names, 0);
    lua_insert(L, -2);
    for (size_t i = 0; i < *count; ++i) {
        names[i] = words[i];
    }
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING) {
            names[(*count)++] = lua_tostring(L, -2);
        }
    }
    lua_pop(L, 1);
    qsort(names, *count, sizeof *names, compare);
    return names;
}

/* __index of the globals: the table, the name. */
static int undefined(lua_State *L) {
    static const char *const words[] = {"false", "nil", "return", "true"};
    size_t count = sizeof words / sizeof *words;
    if (lua_type(L, 2) != LUA_TSTRING || !is_ours(L)) {
        lua_pushnil(L);
        return 1;
    }
    const char *const name = lua_tostring(L, 2);
    const char *const instead = wh_sandbox_of(L)->trust ? NULL : instead_of(name);
    if (instead != NULL) {
        return luaL_error(L, "%s: not in the sandbox (%s)", name, instead);
    }
    lua_pushglobaltable(L);
    const char **const names = wh_library_list_names(L, words, &count);
    wh_sandbox_charge(L, STEPS_PER_NAME * count);
    const char *const nearest = wh_text_nearest(name, names, count);
    if (nearest != NULL) {
        char meant[WH_NEAREST_TEXT];
        return luaL_error(L, "%s: nobody defined this global (%s)", name,
                          wh_text_did_you_mean(meant, "", "", nearest));
    }
    return luaL_error(L, "%s: nobody defined this global (rawget(_G, \"%s\") asks without an error)", name,
                      name);
}

/* __index of a library, whose name is the upvalue: the table, the name. */
static int absent_function(lua_State *L) {
    lua_settop(L, 2);
    if (lua_type(L, 2) == LUA_TSTRING && is_ours(L)) {
        const char *const name =
            lua_pushfstring(L, "%s.%s", lua_tostring(L, lua_upvalueindex(1)), lua_tostring(L, 2));
        const char *const instead = instead_of(name);
        if (instead != NULL) {
            return luaL_error(L, "%s: not in the sandbox (%s)", name, instead);
        }
    }
    lua_pushnil(L);
    return 1;
}

void wh_library_open_absent(lua_State *L) {
    static const char *const libraries[] = {LUA_MATHLIBNAME, LUA_STRLIBNAME};
    for (size_t i = 0; i < sizeof libraries / sizeof *libraries; ++i) {
        lua_getglobal(L, libraries[i]);
        lua_createtable(L, 0, 1);
        lua_pushstring(L, libraries[i]);
        lua_pushcclosure(L, absent_function, 1);
        lua_setfield(L, -2, "__index");
        lua_setmetatable(L, -2);
        lua_pop(L, 1);
    }
}

void wh_library_open_globals(lua_State *L) {
    lua_pushglobaltable(L);
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, undefined);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    lua_pop(L, 1);
}
