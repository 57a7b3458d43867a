/* A script's own files: their text, and require for modules in the same folder. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "../text/output.h"
#include "sandbox_internal.h"
#include "wh_module_values.h"

/* The registry's tables of our chunks, and of the values that modules' files returned; while one runs,
 * `running`. */
#define OWN "waferhand.own"
#define LOADED "waferhand.loaded"
static char running;

/* --------------------------------------------------------------------------------------------------- text */

/* Skips like Lua's luaL_loadfile: the skipped beginning keeps its line end. */
static const char *skip_heading(const char *text, size_t *size) {
    static const char mark[] = "\xEF\xBB\xBF";
    const char *at = text;
    const char *const end = text + *size;
    if (*size >= strlen(mark) && memcmp(at, mark, strlen(mark)) == 0) {
        at += strlen(mark);
    }
    if (at < end && *at == '#') {
        const char *const line_end = memchr(at, '\n', (size_t)(end - at));
        at = line_end != NULL ? line_end : end;
    }
    *size = (size_t)(end - at);
    return at;
}

const char *wh_sandbox_read_text(lua_State *L, const char *path, size_t *size) {
    char *const text = lua_newuserdatauv(L, *size + 1, 0);
    FILE *const file = fopen(path, "rb");
    const size_t read = file != NULL ? fread(text, 1, *size, file) : 0;
    const int reason = errno;
    const bool failed = file == NULL || ferror(file) != 0;
    if (file != NULL) {
        (void)fclose(file);
    }
    if (failed) {
        luaL_error(L, "cannot be read: %s", strerror(reason));
    }
    *size = read;
    return skip_heading(text, size);
}

/* Sets a field of a table of the registry to the value on top of the stack, which it pops. */
static void set_kept(lua_State *L, const char *table, const char *field) {
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, table);
    lua_insert(L, -2);
    lua_setfield(L, -2, field);
    lua_pop(L, 1);
}

void wh_sandbox_own(lua_State *L, const char *chunk_name) {
    lua_pushboolean(L, true);
    set_kept(L, OWN, chunk_name);
}

bool wh_sandbox_owns(lua_State *L, const char *chunk_name) {
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, OWN);
    const bool is_own = lua_getfield(L, -1, chunk_name) != LUA_TNIL;
    lua_pop(L, 2);
    return is_own;
}

/* ------------------------------------------------------------------------------------------------ require */

/* The path of the file whose function called; empty if there is none. */
static const char *calling_file(lua_State *L) {
    lua_Debug frame;
    for (int level = 1; lua_getstack(L, level, &frame); ++level) {
        if (lua_getinfo(L, "S", &frame) && frame.source[0] == '@' && wh_sandbox_owns(L, frame.source)) {
            return lua_pushstring(L, frame.source + 1);
        }
    }
    return lua_pushliteral(L, "");
}

/* True for names with dots between them: no name may lead out of the folder. */
static bool is_module_name(const char *name) {
    static const char characters[] = "-0123456789_ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    size_t length = strspn(name, characters);
    while (length > 0 && name[length] == '.') {
        name += length + 1;
        length = strspn(name, characters);
    }
    return length > 0 && name[length] == '\0';
}

/* Pushes the path of a module in the folder of the file that requires it. */
static const char *push_module_path(lua_State *L, const char *name) {
    const char *const from = calling_file(L);
    const char *const slash = strrchr(from, '/');
    lua_pushlstring(L, from, slash != NULL ? (size_t)(slash - from) + 1 : 0);
    luaL_gsub(L, name, ".", "/");
    lua_pushliteral(L, ".lua");
    lua_concat(L, 3);
    return lua_tostring(L, -1);
}

/* Runs the module's file, or raises its error: a numbered error stays one. Leaves the returned value, true
 * if that is nil. */
static int run_module(lua_State *L, const char *path) {
    wh_sandbox_result_t result;
    lua_pushlightuserdata(L, &running);
    set_kept(L, LOADED, path);
    if (!wh_sandbox_evaluate(L, path, &result)) {
        lua_pushnil(L);
        set_kept(L, LOADED, path);
        wh_sandbox_push_error(L);
        if (!lua_istable(L, -1)) {
            lua_pushstring(L, result.message);
        }
        return lua_error(L);
    }
    if (lua_isnil(L, -1)) {
        lua_pushboolean(L, true);
    }
    lua_pushvalue(L, -1);
    set_kept(L, LOADED, path);
    return 1;
}

/* Leaves the module's value, from the file at `path` unless that has already run. */
static int load_once(lua_State *L, const char *path) {
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, LOADED);
    if (lua_getfield(L, -1, path) == LUA_TLIGHTUSERDATA) {
        return luaL_error(L, "require: %s requires itself (expected modules that do not)", path);
    }
    return lua_isnil(L, -1) ? run_module(L, path) : 1;
}

/* Pushes one of the libraries that are globals anyway. */
static bool push_library(lua_State *L, const char *name) {
    static const char *const names[] = {LUA_COLIBNAME,  LUA_MATHLIBNAME, LUA_STRLIBNAME,
                                        LUA_TABLIBNAME, LUA_UTF8LIBNAME, "wh"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (strcmp(names[i], name) == 0) {
            lua_pushglobaltable(L);
            lua_pushstring(L, name);
            return lua_rawget(L, -2) != LUA_TNIL;
        }
    }
    return false;
}

/* require "NAME": NAME.lua in the folder of the calling file, otherwise, with trust, as in Lua. */
static int require_module(lua_State *L) {
    const bool trust = wh_sandbox_of(L)->trust;
    size_t length = 0;
    const char *const name = luaL_checklstring(L, 1, &length);
    lua_settop(L, 1);
    wh_sandbox_charge(L, WH_SANDBOX_GRANULE);
    if (strlen(name) == length && is_module_name(name)) {
        const char *const path = push_module_path(L, name);
        wh_output_note_input(path);
        if (access(path, F_OK) == 0) {
            return load_once(L, path);
        }
    }
    if (trust) {
        lua_settop(L, 1);
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_insert(L, 1);
        lua_call(L, 1, LUA_MULTRET);
        return lua_gettop(L);
    }
    if (strlen(name) == length && push_library(L, name)) {
        return 1;
    }
    return luaL_error(L,
                      "require: \"%s\": not in the sandbox (expected NAME.lua beside this file, or in a "
                      "folder there as FOLDER.NAME; run --trust allows others)",
                      wh_lua_whole_text(L, 1));
}

const luaL_Reg wh_library_modules[] = {{"require", require_module}, {NULL, NULL}};
