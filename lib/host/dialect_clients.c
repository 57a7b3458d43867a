/* Calls a dialect's functions for clients and testers: connected, gone and tester. */
#include <string.h>

#include <lauxlib.h>

#include "dialect_internal.h"

/* Runs protected. */
static int call_connected(lua_State *L) {
    const wh_dialect_call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "connected", NULL);
    wh_dialect_push_client(L, it->client);
    lua_call(L, 1, 1);
    if (!lua_isnil(L, 2)) {
        wh_dialect_take_text(L, it, "connected");
    }
    return 0;
}

static void take_condition(lua_State *L, const wh_dialect_t *dialect, const char *function,
                           wh_lines_t *lines) {
    size_t size = 0;
    const char *text = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &size) : NULL;
    const wh_word_t *word = text ? wh_word_of(text) : NULL;
    if (!word || word->kind != WH_WORD_CONTROLLER || size >= WH_DIALECT_LINE_BYTES || strlen(text) != size ||
        lines->count == WH_DIALECT_LINES) {
        luaL_error(L, "%s: %s: \"%s\" (expected at most %d lines that begin with CONTROLLER)", dialect->path,
                   function, text ? text : luaL_typename(L, -1), WH_DIALECT_LINES);
        return;
    }
    memcpy(lines->lines[lines->count++], text, size + 1);
}

void wh_dialect_take_conditions(lua_State *L, const wh_dialect_t *dialect, const char *function,
                                wh_lines_t *lines) {
    lines->count = 0;
    if (lua_isnil(L, -1)) {
        return;
    }
    if (!lua_istable(L, -1)) {
        take_condition(L, dialect, function, lines);
        return;
    }
    for (lua_Integer i = 1; lua_geti(L, -1, i) != LUA_TNIL; ++i) {
        take_condition(L, dialect, function, lines);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

/* Runs protected. */
static int call_gone(lua_State *L) {
    const wh_dialect_call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "gone", NULL);
    wh_dialect_push_client(L, it->client);
    lua_call(L, 1, 1);
    wh_dialect_take_conditions(L, it->dialect, "gone", it->lines);
    return 0;
}

bool wh_dialect_welcome(wh_dialect_t *dialect, const wh_client_t *client) {
    wh_dialect_call_t it = {.dialect = dialect, .client = client};
    wh_dialect_drop_text(dialect);
    return !dialect->clients.greets || wh_dialect_call(dialect, call_connected, &it);
}

bool wh_dialect_part(wh_dialect_t *dialect, const wh_client_t *client, wh_lines_t *lines) {
    wh_dialect_call_t it = {.dialect = dialect, .client = client, .lines = lines};
    lines->count = 0;
    wh_dialect_drop_text(dialect);
    return !dialect->clients.heeds_going || wh_dialect_call(dialect, call_gone, &it);
}

/* Runs protected. */
static int call_tester(lua_State *L) {
    const wh_dialect_call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "tester", NULL);
    lua_pushstring(L, it->frame);
    lua_call(L, 1, 1);
    it->lines->count = 0;
    *it->stops = lua_isboolean(L, -1) && lua_toboolean(L, -1) != 0;
    if (!lua_isboolean(L, -1)) {
        wh_dialect_take_conditions(L, it->dialect, "tester", it->lines);
    }
    return 0;
}

wh_decoded_t wh_dialect_tell(wh_dialect_t *dialect, const char *text, bool *stops, wh_lines_t *lines,
                             wh_failure_t *failure) {
    wh_dialect_call_t it = {.dialect = dialect, .frame = text, .stops = stops, .lines = lines};
    *stops = false;
    lines->count = 0;
    memset(failure, 0, sizeof *failure);
    if (!dialect->clients.hears_testers) {
        return WH_DECODED_NOTHING;
    }
    return wh_dialect_outcome(dialect, wh_dialect_call(dialect, call_tester, &it), failure);
}
