/* pcall, xpcall and coroutines. They pass an exhausted limit on instead of catching it, and note which
 * coroutine runs. */
#include "sandbox_internal.h"

/* ------------------------------------------------------------------------------------------ pcall, xpcall */

/* In place of a count it means that xpcall's handler has run. Its result, or its error, is on top of the
 * stack. */
#define HANDLED (-1)

/* left_out is the number of values at the bottom of the stack that are not results. */
static int finish(lua_State *L, int status, lua_KContext left_out) {
    const bool failed = status != LUA_OK && status != LUA_YIELD;
    if (!failed && left_out != HANDLED) {
        return lua_gettop(L) - (int)left_out;
    }
    if (failed && wh_sandbox_is_fatal(L, status)) {
        return wh_sandbox_raise(L);
    }
    lua_pushboolean(L, false);
    lua_insert(L, -2);
    return 2;
}

static int protect_pcall(lua_State *L) {
    luaL_checkany(L, 1);
    lua_pushboolean(L, true);
    lua_insert(L, 1);
    const int status = lua_pcallk(L, lua_gettop(L) - 2, LUA_MULTRET, 0, 0, finish);
    return finish(L, status, 0);
}

/* Calls the handler, at index 2, after the stack has been unwound. Lua itself would call it at the place of
 * the error. If that is in the count hook, hooks are off and the handler could loop for ever. */
static int finish_xpcall(lua_State *L, int status, lua_KContext left_out) {
    if (status == LUA_OK || status == LUA_YIELD || wh_sandbox_is_fatal(L, status)) {
        return finish(L, status, left_out);
    }
    lua_pushvalue(L, 2);
    lua_insert(L, -2);
    return finish(L, lua_pcallk(L, 1, 1, 0, HANDLED, finish), HANDLED);
}

static int protect_xpcall(lua_State *L) {
    const int arguments = lua_gettop(L) - 2;
    luaL_checktype(L, 2, LUA_TFUNCTION);
    lua_pushboolean(L, true);
    lua_pushvalue(L, 1);
    lua_rotate(L, 3, 2); /* function, handler, true, function, arguments */
    const int status = lua_pcallk(L, arguments, LUA_MULTRET, 0, 2, finish_xpcall);
    return finish_xpcall(L, status, 2);
}

/* --------------------------------------------------------------------------------------------- Coroutines */

static int body_finish(lua_State *L, int status, lua_KContext context) {
    (void)context;
    if (status == LUA_OK || status == LUA_YIELD) {
        return lua_gettop(L);
    }
    (void)wh_sandbox_is_fatal(L, status);
    return lua_error(L);
}

/* The first function of each coroutine calls the script's function protected. Otherwise an error that the
 * count hook raised would leave the coroutine with its hooks off, and closing its variables could loop for
 * ever. lua_pcallk switches the hooks on again and closes the variables itself. */
static int body(lua_State *L) {
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    const int status = lua_pcallk(L, lua_gettop(L) - 1, LUA_MULTRET, 0, 0, body_finish);
    return body_finish(L, status, 0);
}

/* It charges a granule, because up to that many instructions of a coroutine are never counted. */
static int coroutine_create(lua_State *L) {
    luaL_checktype(L, 1, LUA_TFUNCTION);
    wh_sandbox_charge(L, WH_SANDBOX_GRANULE);
    lua_State *const co = lua_newthread(L);
    lua_pushvalue(L, 1);
    lua_pushcclosure(L, body, 1);
    lua_xmove(L, co, 1);
    return 1;
}

static lua_State *check_coroutine(lua_State *L) {
    lua_State *const co = lua_tothread(L, 1);
    luaL_argexpected(L, co != NULL, 1, "coroutine");
    return co;
}

/* lua_resume with the sandbox's rules. If a limit is exhausted inside, raises that error in `from`. */
static int resume_noted(lua_State *co, lua_State *from, int arguments, int *results) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(co);
    lua_State *const before = sandbox->running;
    sandbox->running = co;
    const int status = lua_resume(co, from, arguments, results);
    sandbox->running = before;
    if (status != LUA_OK && status != LUA_YIELD && wh_sandbox_is_fatal(co, status)) {
        wh_sandbox_raise(from);
    }
    return status;
}

/* Moves the arguments to the coroutine, resumes it, and moves the results or the error's value back. Returns
 * the number of results, or -1. */
static int resume(lua_State *L, lua_State *co, int arguments) {
    if (!lua_checkstack(co, arguments)) {
        lua_pushliteral(L, "too many arguments to resume");
        return -1;
    }
    lua_xmove(L, co, arguments);
    int results = 0;
    const int status = resume_noted(co, L, arguments, &results);
    if (status != LUA_OK && status != LUA_YIELD) {
        lua_xmove(co, L, 1);
        return -1;
    }
    if (!lua_checkstack(L, results + 1)) {
        lua_pop(co, results);
        lua_pushliteral(L, "too many results to resume");
        return -1;
    }
    lua_xmove(co, L, results);
    return results;
}

static int coroutine_resume(lua_State *L) {
    lua_State *const co = check_coroutine(L);
    const int results = resume(L, co, lua_gettop(L) - 1);
    lua_pushboolean(L, results >= 0);
    lua_insert(L, results >= 0 ? -results - 1 : -2);
    return results >= 0 ? results + 1 : 2;
}

static int call_wrapped(lua_State *L) {
    lua_State *const co = lua_tothread(L, lua_upvalueindex(1));
    const int results = resume(L, co, lua_gettop(L));
    return results >= 0 ? results : lua_error(L);
}

static int coroutine_wrap(lua_State *L) {
    coroutine_create(L);
    lua_pushcclosure(L, call_wrapped, 1);
    return 1;
}

static bool is_active(lua_State *L, lua_State *co) {
    lua_Debug frame;
    return co == L || (lua_status(co) == LUA_OK && lua_getstack(co, 0, &frame));
}

static int coroutine_close(lua_State *L) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    lua_State *const co = check_coroutine(L);
    if (is_active(L, co)) {
        return luaL_error(L, "cannot close a %s coroutine", co == L ? "running" : "normal");
    }
    lua_State *const before = sandbox->running;
    sandbox->running = co;
    const int status = lua_resetthread(co);
    sandbox->running = before;
    lua_pushboolean(L, status == LUA_OK);
    if (status == LUA_OK) {
        return 1;
    }
    lua_xmove(co, L, 1);
    return wh_sandbox_is_fatal(L, status) ? wh_sandbox_raise(L) : 2;
}

const luaL_Reg wh_library_protect[] = {{"pcall", protect_pcall}, {"xpcall", protect_xpcall}, {NULL, NULL}};
const luaL_Reg wh_library_coroutine[] = {{"create", coroutine_create},
                                         {"resume", coroutine_resume},
                                         {"wrap", coroutine_wrap},
                                         {"close", coroutine_close},
                                         {NULL, NULL}};
