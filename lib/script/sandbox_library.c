/* Builds the functions of a script, which sandbox_library.h lists. */
#include "sandbox_library.h"

#include <string.h>

#include "../text/utf8.h"
#include "sandbox_internal.h"

/* --------------------------------------------------------------------------------------- global functions */

static void push_type_name(lua_State *L, int index) {
    const int type = luaL_getmetafield(L, index, "__name");
    if (type != LUA_TSTRING) {
        lua_pop(L, type == LUA_TNIL ? 0 : 1);
        lua_pushstring(L, luaL_typename(L, index));
    }
}

static void push_text(lua_State *L, int index) {
    const int type = lua_type(L, index);
    if (type == LUA_TNUMBER && lua_tonumber(L, index) != lua_tonumber(L, index)) {
        lua_pushliteral(L, "nan");
    } else if (type == LUA_TNUMBER || type == LUA_TNIL || type == LUA_TBOOLEAN || type == LUA_TSTRING) {
        luaL_tolstring(L, index, NULL);
    } else {
        push_type_name(L, index);
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

static void put_visible(FILE *to, const char *text, size_t size) {
    char piece[WH_UTF8_PIECE];
    size_t length = 0;
    for (size_t done = 0; done < size;) {
        done += wh_utf8_piece(text + done, size - done, piece, &length);
        fwrite(piece, 1, length, to);
    }
}

static int base_print(lua_State *L) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    FILE *const to = sandbox->print_to;
    const int count = lua_gettop(L);
    for (int i = 1; i <= count; ++i) {
        size_t length = 0;
        const char *const text = wh_library_tostring(L, i, &length);
        wh_sandbox_charge(L, 1 + (length >> 3));
        if (length >= WH_SANDBOX_PRINT_BYTES - sandbox->printed) {
            return luaL_error(L, "print: more than %d MiB in one run (expected less)",
                              (int)(WH_SANDBOX_PRINT_BYTES >> 20));
        }
        sandbox->printed += length + 1;
        if (i > 1) {
            fputc('\t', to);
        }
        put_visible(to, text, length);
        lua_pop(L, 1);
    }
    fputc('\n', to);
    fflush(to);
    return 0;
}

/* Lua looks up __gc once, when the metatable is set; it looks up __mode each time the collector runs. */
static int base_setmetatable(lua_State *L) {
    static const char *const refused[] = {"__gc", "__mode"};
    if (lua_type(L, 2) == LUA_TTABLE && !wh_sandbox_of(L)->trust) {
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
    if (lua_type(L, 1) == LUA_TTABLE) {
        wh_params_fill(L, 1);
    }
    return wh_library_call_stock(L);
}

static int base_rawget(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    wh_params_fill(L, 1);
    return wh_library_call_stock(L);
}

/* Hides the metatables of userdata, because they belong to the host. */
static int base_getmetatable(lua_State *L) {
    luaL_checkany(L, 1);
    if (lua_type(L, 1) == LUA_TTABLE) {
        return wh_library_call_stock(L);
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

/* ---------------------------------------------------------------------------------------------- all of it */

void wh_library_set(lua_State *L, const luaL_Reg *functions) {
    for (; functions->name != NULL; ++functions) {
        if (functions->func != NULL) {
            lua_getfield(L, -1, functions->name);
            lua_pushcclosure(L, functions->func, 1);
        } else {
            lua_pushnil(L);
        }
        lua_setfield(L, -2, functions->name);
    }
}

int wh_library_call_stock(lua_State *L) {
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
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
    return wh_library_call_stock(L);
}

void wh_library_charge_strings(lua_State *L, const char *const *names, int shift) {
    for (; *names != NULL; ++names) {
        lua_getfield(L, -1, *names);
        lua_pushinteger(L, shift);
        lua_pushcclosure(L, charge_and_call, 2);
        lua_setfield(L, -2, *names);
    }
}

static void open_untrusted(lua_State *L) {
    static const luaL_Reg libraries[] = {{LUA_GNAME, luaopen_base},       {LUA_COLIBNAME, luaopen_coroutine},
                                         {LUA_TABLIBNAME, luaopen_table}, {LUA_STRLIBNAME, luaopen_string},
                                         {LUA_MATHLIBNAME, luaopen_math}, {LUA_UTF8LIBNAME, luaopen_utf8}};
    for (size_t i = 0; i < sizeof libraries / sizeof *libraries; ++i) {
        luaL_requiref(L, libraries[i].name, libraries[i].func, 1);
        lua_pop(L, 1);
    }
}

/* The iterator that utf8.codes returns may skip any number of continuation bytes in one call, so it is
 * charged, too. */
static int charged_codes(lua_State *L) {
    const int results = wh_library_call_stock(L);
    lua_pushvalue(L, -results);
    lua_pushinteger(L, 10);
    lua_pushcclosure(L, charge_and_call, 2);
    lua_replace(L, -results - 1);
    return results;
}

static const luaL_Reg base[] = {{"print", base_print},
                                {"rawget", base_rawget},
                                {"setmetatable", base_setmetatable},
                                {"tostring", base_tostring},
                                {NULL, NULL}};
static const luaL_Reg untrusted_base[] = {{"getmetatable", base_getmetatable},
                                          {"load", base_load},
                                          {"collectgarbage", NULL},
                                          {"dofile", NULL},
                                          {"loadfile", NULL},
                                          {"warn", NULL},
                                          {NULL, NULL}};
static const luaL_Reg untrusted_string[] = {{"dump", NULL}, {NULL, NULL}};
static const luaL_Reg utf8[] = {{"codes", charged_codes}, {NULL, NULL}};

/* Changes to each table: functions that are set, and others that charge for the texts they read. */
static const struct {
    const char *table;
    const luaL_Reg *functions;
    const char *scanning[4];
    int shift;
    bool with_trust;
} changes[] = {{LUA_GNAME, base, {"tonumber"}, 4, true},
               {LUA_GNAME, untrusted_base, {NULL}, 0, false},
               {LUA_GNAME, wh_library_protect, {NULL}, 0, true},
               {LUA_COLIBNAME, wh_library_coroutine, {NULL}, 0, true},
               {LUA_GNAME, wh_library_order, {NULL}, 0, true},
               {LUA_MATHLIBNAME, wh_library_math, {NULL}, 0, true},
               {LUA_TABLIBNAME, wh_library_table, {NULL}, 0, true},
               {LUA_STRLIBNAME, wh_library_string, {"pack", "unpack", "packsize"}, 4, true},
               {LUA_STRLIBNAME, untrusted_string, {NULL}, 0, false},
               {LUA_UTF8LIBNAME, utf8, {"len", "codepoint", "offset"}, 3, true},
               {LUA_GNAME, wh_library_modules, {NULL}, 0, true}};

int wh_sandbox_library_open(lua_State *L) {
    const bool trust = wh_sandbox_of(L)->trust;
    if (trust) {
        luaL_openlibs(L);
    } else {
        open_untrusted(L);
    }
    wh_library_start_random(L);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; ++i) {
        if (changes[i].with_trust || !trust) {
            lua_getglobal(L, changes[i].table);
            wh_library_set(L, changes[i].functions);
            wh_library_charge_strings(L, changes[i].scanning, changes[i].shift);
            lua_pop(L, 1);
        }
    }
    wh_library_open_string(L);
    wh_library_open_absent(L);
    wh_library_open_params(L);
    wh_library_open_globals(L); /* last: after it, reading a missing global is an error */
    return 0;
}
