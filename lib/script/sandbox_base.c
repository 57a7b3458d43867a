/* The global functions: print, tostring, load, metatables. */
#include <math.h>
#include <string.h>

#include "sandbox_internal.h"

static void push_type_name(lua_State *L, int index) {
    const int type = luaL_getmetafield(L, index, "__name");
    if (type != LUA_TSTRING) {
        lua_pop(L, type == LUA_TNIL ? 0 : 1);
        lua_pushstring(L, luaL_typename(L, index));
    }
}

static void push_text(lua_State *L, int index) {
    switch (lua_type(L, index)) {
    case LUA_TNUMBER:
        if (lua_tonumber(L, index) != lua_tonumber(L, index)) {
            lua_pushliteral(L, "nan");
            return;
        }
        luaL_tolstring(L, index, NULL);
        return;
    case LUA_TNIL:
    case LUA_TBOOLEAN:
    case LUA_TSTRING:
        luaL_tolstring(L, index, NULL);
        return;
    default:
        push_type_name(L, index);
        return;
    }
}

const char *wh_library_tostring(lua_State *L, int index, size_t *length) {
    index = lua_absindex(L, index);
    if (!luaL_callmeta(L, index, "__tostring")) {
        push_text(L, index);
    } else if (!lua_isstring(L, -1)) {
        luaL_error(L, "'__tostring' must return a string");
    }
    return lua_tolstring(L, -1, length);
}

static int base_tostring(lua_State *L) {
    luaL_checkany(L, 1);
    wh_library_tostring(L, 1, NULL);
    return 1;
}

static int base_print(lua_State *L) {
    FILE *const to = wh_sandbox_of(L)->print_to;
    const int count = lua_gettop(L);
    for (int i = 1; i <= count; ++i) {
        size_t length = 0;
        const char *const text = wh_library_tostring(L, i, &length);
        wh_sandbox_charge(L, 1 + (length >> 3));
        if (i > 1) {
            fputc('\t', to);
        }
        fwrite(text, 1, length, to);
        lua_pop(L, 1);
    }
    fputc('\n', to);
    fflush(to);
    return 0;
}

/* The finalizer is looked up when the metatable is set, and only then; __mode each time the collector runs.
 */
static int base_setmetatable(lua_State *L) {
    static const char *const refused[] = {"__gc", "__mode"};
    if (lua_type(L, 2) == LUA_TTABLE) {
        for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
            lua_pushstring(L, refused[i]);
            if (lua_rawget(L, 2) != LUA_TNIL) {
                return luaL_error(
                    L, "a metatable with %s cannot be set: it would depend on the garbage collector",
                    refused[i]);
            }
            lua_pop(L, 1);
        }
    }
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/* The metatables of userdata are the host's. */
static int base_getmetatable(lua_State *L) {
    luaL_checkany(L, 1);
    if (lua_type(L, 1) == LUA_TTABLE) {
        return lua_tocfunction(L, lua_upvalueindex(1))(L);
    }
    if (luaL_getmetafield(L, 1, "__metatable") == LUA_TNIL) {
        if (lua_getmetatable(L, 1)) {
            lua_pushboolean(L, false);
        } else {
            lua_pushnil(L);
        }
    }
    return 1;
}

/* load(text [, name [, mode [, env]]]) */
static int base_load(lua_State *L) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    size_t size = 0;
    if (lua_type(L, 1) != LUA_TSTRING) {
        return luaL_error(L, "'load' takes a string; got a %s", luaL_typename(L, 1));
    }
    const char *const text = lua_tolstring(L, 1, &size);
    const char *const name = luaL_optstring(L, 2, text);
    const char *const mode = luaL_optstring(L, 3, "t");
    const bool has_environment = !lua_isnone(L, 4);
    wh_sandbox_charge(L, WH_SANDBOX_GRANULE + size);
    lua_settop(L, 4);
    ++sandbox->loading;
    const int status = luaL_loadbufferx(L, text, size, name, strchr(mode, 't') != NULL ? "t" : "");
    --sandbox->loading;
    if (status != LUA_OK) {
        if (wh_sandbox_is_fatal(L, status)) {
            return wh_sandbox_raise(L);
        }
        luaL_pushfail(L);
        lua_insert(L, -2);
        return 2;
    }
    if (has_environment) {
        lua_pushvalue(L, 4);
        if (lua_setupvalue(L, -2, 1) == NULL) {
            lua_pop(L, 1);
        }
    }
    return 1;
}

/* Replaces a C function of the globals by a closure over it. */
static void wrap(lua_State *L, const char *name, lua_CFunction wrapper) {
    lua_getfield(L, -1, name);
    lua_pushcclosure(L, wrapper, 1);
    lua_setfield(L, -2, name);
}

static void remove_untrusted(lua_State *L) {
    static const luaL_Reg absent[] = {
        {"collectgarbage", NULL}, {"dofile", NULL}, {"loadfile", NULL}, {"warn", NULL}, {NULL, NULL}};
    wh_library_set(L, absent);
    wrap(L, "setmetatable", base_setmetatable);
    wrap(L, "getmetatable", base_getmetatable);
    lua_pushcfunction(L, base_load);
    lua_setfield(L, -2, "load");
}

void wh_library_open_base(lua_State *L, bool trust) {
    static const luaL_Reg functions[] = {{"print", base_print}, {"tostring", base_tostring}, {NULL, NULL}};
    static const char *const scanning[] = {"tonumber", NULL};
    lua_pushglobaltable(L);
    wh_library_set(L, functions);
    wh_library_charge_strings(L, scanning, 4);
    if (!trust) {
        remove_untrusted(L);
    }
    lua_pop(L, 1);
}
