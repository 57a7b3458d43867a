/* Builds what a script finds; sandbox_library.h says what that is. */
#include "sandbox_library.h"

#include "sandbox_internal.h"

void wh_library_set(lua_State *L, const luaL_Reg *functions) {
    for (; functions->name != NULL; ++functions) {
        if (functions->func != NULL) {
            lua_pushcfunction(L, functions->func);
        } else {
            lua_pushnil(L);
        }
        lua_setfield(L, -2, functions->name);
    }
}

/* Upvalues: a C function of Lua's without upvalues of its own, and the shift. */
static int charge_and_call(lua_State *L) {
    uint64_t bytes = 0;
    for (int i = lua_gettop(L); i > 0; --i) {
        if (lua_type(L, i) == LUA_TSTRING) {
            bytes += lua_rawlen(L, i);
        }
    }
    wh_sandbox_charge(L, bytes >> lua_tointeger(L, lua_upvalueindex(2)));
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

void wh_library_charge_strings(lua_State *L, const char *const *names, int shift) {
    for (; *names != NULL; ++names) {
        lua_getfield(L, -1, *names);
        lua_pushinteger(L, shift);
        lua_pushcclosure(L, charge_and_call, 2);
        lua_setfield(L, -2, *names);
    }
}

static void require(lua_State *L, const char *name, lua_CFunction open) {
    luaL_requiref(L, name, open, 1);
    lua_pop(L, 1);
}

static void open_untrusted(lua_State *L) {
    require(L, LUA_GNAME, luaopen_base);
    require(L, LUA_COLIBNAME, luaopen_coroutine);
    require(L, LUA_TABLIBNAME, luaopen_table);
    require(L, LUA_STRLIBNAME, luaopen_string);
    require(L, LUA_MATHLIBNAME, luaopen_math);
    require(L, LUA_UTF8LIBNAME, luaopen_utf8);
}

/* utf8.codes returns an iterator that passes over any run of continuation bytes in one call. */
static int charged_codes(lua_State *L) {
    const int results = lua_tocfunction(L, lua_upvalueindex(1))(L);
    lua_pushvalue(L, -results);
    lua_pushinteger(L, 10);
    lua_pushcclosure(L, charge_and_call, 2);
    lua_replace(L, -results - 1);
    return results;
}

static void open_utf8(lua_State *L) {
    static const char *const scanning[] = {"len", "codepoint", "offset", NULL};
    lua_getglobal(L, LUA_UTF8LIBNAME);
    wh_library_charge_strings(L, scanning, 3);
    lua_getfield(L, -1, "codes");
    lua_pushcclosure(L, charged_codes, 1);
    lua_setfield(L, -2, "codes");
    lua_pop(L, 1);
}

int wh_sandbox_library_open(lua_State *L) {
    const bool trust = wh_sandbox_of(L)->trust;
    if (trust) {
        luaL_openlibs(L);
    } else {
        open_untrusted(L);
    }
    wh_library_open_base(L, trust);
    wh_library_open_protect(L);
    wh_library_open_order(L);
    wh_library_open_math(L);
    wh_library_open_table(L);
    wh_library_open_string(L, trust);
    wh_library_open_pattern(L);
    open_utf8(L);
    lua_newtable(L);
    lua_setglobal(L, "params");
    return 0;
}
