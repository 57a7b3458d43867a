/* Builds what a script finds, which sandbox_library.h lists, and params for --set NAME=VALUE. */
#include "sandbox_library.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

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

/* Lua looks up __gc once, when the metatable is set; it looks up __mode each time the collector runs. */
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
    return wh_library_call_stock(L);
}

/* Hides the metatables of userdata: they are the host's. */
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

/* --------------------------------------------------------------------------------------------- parameters */

static bool looks_like_name(const char *text) {
    static const char characters[] = "0123456789_ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    return text[0] != '\0' && !isdigit((unsigned char)text[0]) && text[strspn(text, characters)] == '\0';
}

/* Asks the compiler, which knows the reserved words. */
static bool is_reserved(lua_State *L, const char *name) {
    const char *const text = lua_pushfstring(L, "local %s", name);
    const int status = luaL_loadbufferx(L, text, strlen(text), "=name", "t");
    lua_pop(L, 2);
    return status != LUA_OK;
}

static void push_value(lua_State *L, const char *text) {
    const size_t length = strlen(text);
    const bool spaced =
        length == 0 || isspace((unsigned char)text[0]) || isspace((unsigned char)text[length - 1]);
    if (!spaced && lua_stringtonumber(L, text) == length + 1) {
        const double value = lua_tonumber(L, -1);
        if (value - value == 0) {
            return;
        }
        lua_pop(L, 1);
    }
    if (strcmp(text, "true") == 0 || strcmp(text, "false") == 0) {
        lua_pushboolean(L, text[0] == 't');
    } else {
        lua_pushstring(L, text);
    }
}

/* Runs protected, with where the text of the assignment stands. */
static int assign(lua_State *L) {
    const char *const text = *(const char **)lua_touserdata(L, 1);
    const size_t length = strcspn(text, "=");
    const char *const name = lua_pushlstring(L, text, length);
    if (text[length] == '\0') {
        return luaL_error(L, "'%s' is no NAME=VALUE", name);
    }
    if (!looks_like_name(name) || is_reserved(L, name)) {
        return luaL_error(L,
                          "'%s' is no name for a parameter: letters, digits and '_', not first a digit, no "
                          "reserved word of Lua",
                          name);
    }
    if (lua_getglobal(L, "params") != LUA_TTABLE) {
        return luaL_error(L, "params is no table any more");
    }
    lua_pushvalue(L, 2);
    push_value(L, text + length + 1);
    lua_rawset(L, 3);
    return 0;
}

bool wh_sandbox_set_parameter(wh_sandbox_t *sandbox, const char *text, wh_sandbox_result_t *result) {
    return wh_sandbox_protect(sandbox->main, assign, &text, result);
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

static void open_base(lua_State *L, bool trust) {
    static const luaL_Reg functions[] = {{"print", base_print}, {"tostring", base_tostring}, {NULL, NULL}};
    static const char *const scanning[] = {"tonumber", NULL};
    static const luaL_Reg untrusted[] = {{"setmetatable", base_setmetatable},
                                         {"getmetatable", base_getmetatable},
                                         {"load", base_load},
                                         {"collectgarbage", NULL},
                                         {"dofile", NULL},
                                         {"loadfile", NULL},
                                         {"warn", NULL},
                                         {NULL, NULL}};
    lua_pushglobaltable(L);
    wh_library_set(L, functions);
    wh_library_charge_strings(L, scanning, 4);
    if (!trust) {
        wh_library_set(L, untrusted);
    }
    lua_pop(L, 1);
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
 * charged as well. */
static int charged_codes(lua_State *L) {
    const int results = wh_library_call_stock(L);
    lua_pushvalue(L, -results);
    lua_pushinteger(L, 10);
    lua_pushcclosure(L, charge_and_call, 2);
    lua_replace(L, -results - 1);
    return results;
}

static void open_utf8(lua_State *L) {
    static const char *const scanning[] = {"len", "codepoint", "offset", NULL};
    static const luaL_Reg wrapped[] = {{"codes", charged_codes}, {NULL, NULL}};
    lua_getglobal(L, LUA_UTF8LIBNAME);
    wh_library_charge_strings(L, scanning, 3);
    wh_library_set(L, wrapped);
    lua_pop(L, 1);
}

int wh_sandbox_library_open(lua_State *L) {
    const bool trust = wh_sandbox_of(L)->trust;
    if (trust) {
        luaL_openlibs(L);
    } else {
        open_untrusted(L);
    }
    open_base(L, trust);
    wh_library_open_protect(L);
    wh_library_open_order(L);
    wh_library_open_math(L);
    wh_library_open_table(L);
    wh_library_open_string(L, trust);
    open_utf8(L);
    lua_newtable(L);
    lua_setglobal(L, "params");
    return 0;
}
