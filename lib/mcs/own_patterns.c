/* Patterns of one's own: the file that has them, and the places in it that errors name. */
#include <stdio.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "native.h"

/* native.patterns(path, is_of_script): runs the file; returns its value and its path. A path of the script
 * is relative to the script's folder. */
static int run_patterns(lua_State *L) {
    wh_sandbox_result_t result;
    const char *path = luaL_checkstring(L, 1);
    const bool is_of_script = lua_toboolean(L, 2) != 0;
    if (is_of_script) {
        path = wh_mcs_push_path(L, wh_mcs_of(L), path);
    }
    if (!wh_sandbox_evaluate(L, path, &result)) {
        lua_pushstring(L, result.message);
        return lua_error(L);
    }
    lua_pushstring(L, path);
    return 2;
}

/* Pushes the innermost place on the stack of `of` in a user's file, "FILE:LINE" or "", and the beginning
 * that a message of Lua has for it, in which a long path is cut. */
static void push_place(lua_State *L, lua_State *of) {
    char place[WH_SANDBOX_MODULE_BYTES];
    char beginning[LUA_IDSIZE + 20] = "";
    lua_Debug frame;
    wh_sandbox_module_place(of, "", place);
    for (int level = 0; place[0] && !beginning[0] && lua_getstack(of, level, &frame); ++level) {
        if (lua_getinfo(of, "Sl", &frame) && frame.currentline > 0 &&
            strncmp(frame.source + 1, WH_INNER_CHUNK, strlen(WH_INNER_CHUNK)) != 0) {
            (void)snprintf(beginning, sizeof beginning, "%s:%d: ", frame.short_src, frame.currentline);
        }
    }
    lua_pushstring(L, place);
    lua_pushstring(L, beginning);
}

/* native.place_in(thread): where a coroutine waits, "FILE:LINE". */
static int find_place(lua_State *L) {
    lua_State *thread = lua_tothread(L, 1);
    luaL_argcheck(L, thread, 1, "no thread");
    push_place(L, thread);
    lua_pop(L, 1);
    return 1;
}

/* An error's handler: makes { error, place, beginning } of it while its stack is still there. */
static int keep_place(lua_State *L) {
    lua_createtable(L, 3, 0);
    lua_insert(L, 1);
    lua_rawseti(L, 1, 1);
    push_place(L, L);
    lua_rawseti(L, 1, 3);
    lua_rawseti(L, 1, 2);
    return 1;
}

/* The stack has keep_place, true, and the results or the error. */
static int finish_call(lua_State *L, int status, lua_KContext context) {
    (void)context;
    if (status != LUA_OK && status != LUA_YIELD) {
        lua_pushboolean(L, false);
        lua_replace(L, 2);
    }
    return lua_gettop(L) - 1;
}

/* native.call_own(function, ...): true and its results; or false and { error, place, beginning }, see
 * push_place. */
static int call_own(lua_State *L) {
    luaL_checktype(L, 1, LUA_TFUNCTION);
    lua_pushboolean(L, true);
    lua_insert(L, 1);
    lua_pushcfunction(L, keep_place);
    lua_insert(L, 1);
    return finish_call(L, lua_pcallk(L, lua_gettop(L) - 3, LUA_MULTRET, 1, 0, finish_call), 0);
}

const luaL_Reg wh_mcs_own_functions[] = {
    {"patterns", run_patterns}, {"place_in", find_place}, {"call_own", call_own}, {NULL, NULL}};
