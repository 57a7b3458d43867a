/* --set NAME=VALUE: what a script finds in params. */
#include <ctype.h>
#include <string.h>

#include "sandbox_internal.h"

/* Handed to the protected part. */
typedef struct {
    const char *name;
    const char *value; /* null: there is no '=' */
    size_t name_length;
} assignment_t;

static bool looks_like_name(const char *text, size_t length) {
    if (length == 0 || isdigit((unsigned char)text[0])) {
        return false;
    }
    for (size_t i = 0; i < length; ++i) {
        if (!isalnum((unsigned char)text[i]) && text[i] != '_') {
            return false;
        }
    }
    return true;
}

/* The compiler knows the reserved words. */
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

static int assign(lua_State *L) {
    const assignment_t *const assignment = lua_touserdata(L, 1);
    const char *const name = lua_pushlstring(L, assignment->name, assignment->name_length);
    if (assignment->value == NULL) {
        return luaL_error(L, "'%s' is no NAME=VALUE", name);
    }
    if (!looks_like_name(name, assignment->name_length) || is_reserved(L, name)) {
        return luaL_error(L,
                          "'%s' is no name for a parameter: letters, digits and '_', not first a digit, no "
                          "reserved word of Lua",
                          name);
    }
    if (lua_getglobal(L, "params") != LUA_TTABLE) {
        return luaL_error(L, "params is no table any more");
    }
    lua_pushvalue(L, 2);
    push_value(L, assignment->value);
    lua_rawset(L, 3);
    return 0;
}

bool wh_sandbox_set_parameter(wh_sandbox_t *sandbox, const char *text, wh_sandbox_result_t *result) {
    const char *const equals = strchr(text, '=');
    assignment_t assignment = {text, NULL, strlen(text)};
    if (equals != NULL) {
        assignment.value = equals + 1;
        assignment.name_length = (size_t)(equals - text);
    }
    lua_pushcfunction(sandbox->main, assign);
    lua_pushlightuserdata(sandbox->main, &assignment);
    return wh_sandbox_call(sandbox->main, 1, 0, result);
}

wh_sandbox_t *wh_sandbox_new_with(const wh_sandbox_limits_t *limits, const char *const assignments[],
                                  size_t count, wh_sandbox_result_t *result) {
    wh_sandbox_t *sandbox = wh_sandbox_new(limits);
    if (!sandbox) {
        *result = (wh_sandbox_result_t){WH_SANDBOX_MEMORY, "no memory for Lua"};
    }
    for (size_t i = 0; sandbox && i < count; ++i) {
        if (!wh_sandbox_set_parameter(sandbox, assignments[i], result)) {
            wh_sandbox_free(sandbox);
            return NULL;
        }
    }
    return sandbox;
}
