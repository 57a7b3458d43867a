/* params, for --set NAME=VALUE: the values, and which of them were read. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "../text/nearest.h"
#include "sandbox_internal.h"

/* The most names that a message lists. */
#define NAMED 12

/* Registry keys: the values that were not read yet, the names that were read, and params itself, an empty
 * table. A value becomes a field of params when it is read. */
#define VALUES "waferhand.values"
#define ASKED "waferhand.asked"
#define PARAMS "waferhand.params"

static void push_kept(lua_State *L, const char *key) {
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, key);
}

/* ---------------------------------------------------------------------------------------------- assigning */

static bool looks_like_name(const char *text) {
    static const char characters[] = "0123456789_ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    return text[0] != '\0' && !isdigit((unsigned char)text[0]) && text[strspn(text, characters)] == '\0';
}

/* Tests it with the compiler, which knows the reserved words. */
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

/* Runs protected; the argument holds the place of the assignment's text. */
static int assign(lua_State *L) {
    const char *const text = *(const char **)lua_touserdata(L, 1);
    const size_t length = strcspn(text, "=");
    const char *const name = lua_pushlstring(L, text, length);
    if (text[length] == '\0') {
        return luaL_error(L, "--set %s: nothing to set it to (expected NAME=VALUE)", name);
    }
    if (!looks_like_name(name) || is_reserved(L, name)) {
        return luaL_error(L,
                          "--set %s: '%s' is no name for a parameter (expected letters, digits and '_', not "
                          "first a digit, no reserved word of Lua)",
                          text, name);
    }
    push_kept(L, VALUES);
    if (lua_getfield(L, 3, name) != LUA_TNIL) {
        return luaL_error(L, "--set %s: given twice (expected once; before: %s=%s)", text, name,
                          luaL_tolstring(L, -1, NULL));
    }
    lua_settop(L, 3);
    lua_pushvalue(L, 2);
    push_value(L, text + length + 1);
    lua_rawset(L, 3);
    return 0;
}

bool wh_sandbox_set_parameter(wh_sandbox_t *sandbox, const char *text, wh_sandbox_result_t *result) {
    return wh_sandbox_protect(sandbox->main, assign, &text, result);
}

/* ------------------------------------------------------------------------------------------------ reading */

/* Moves the value on top of the stack, whose name is below it, into params. It pops neither. */
static void hand_over(lua_State *L) {
    const int name = lua_absindex(L, -2);
    push_kept(L, PARAMS);
    lua_pushvalue(L, name);
    lua_pushvalue(L, name + 1);
    lua_rawset(L, -3);
    push_kept(L, VALUES);
    lua_pushvalue(L, name);
    lua_pushnil(L);
    lua_rawset(L, -3);
    lua_pop(L, 2);
}

/* __index of params: the table, the name. */
static int read_parameter(lua_State *L) {
    lua_settop(L, 2);
    if (lua_type(L, 2) != LUA_TSTRING) {
        lua_pushnil(L);
        return 1;
    }
    push_kept(L, ASKED);
    lua_pushvalue(L, 2);
    lua_pushboolean(L, true);
    lua_rawset(L, -3);
    push_kept(L, VALUES);
    lua_insert(L, 2);
    lua_settop(L, 3);
    lua_pushvalue(L, 3);
    if (lua_rawget(L, 2) != LUA_TNIL) {
        hand_over(L);
    }
    return 1;
}

void wh_params_fill(lua_State *L, int index) {
    index = lua_absindex(L, index);
    push_kept(L, PARAMS);
    const bool is_params = lua_rawequal(L, index, -1) != 0;
    lua_pop(L, 1);
    push_kept(L, VALUES);
    for (lua_pushnil(L); is_params && lua_next(L, -2); lua_pop(L, 1)) {
        hand_over(L); /* clears a field, which lua_next allows */
    }
    lua_settop(L, lua_gettop(L) - (is_params ? 1 : 2));
}

/* --------------------------------------------------------------------------------------- what nobody read */

static void write_message(char *message, const char *name, const char *const asked[], size_t count) {
    const char *const nearest = wh_text_nearest(name, asked, count);
    char meant[WH_NEAREST_TEXT];
    size_t length = (size_t)snprintf(
        message, WH_SANDBOX_MESSAGE_BYTES, "--set %.100s: nobody read params.%.100s (%s%sread: %s", name,
        name, wh_text_did_you_mean(meant, "", "", nearest), nearest ? " " : "", count == 0 ? "none" : "");
    for (size_t i = 0; i < count && length < WH_SANDBOX_MESSAGE_BYTES - 200; ++i) {
        length += (size_t)snprintf(message + length, WH_SANDBOX_MESSAGE_BYTES - length, "%s%.50s",
                                   i > 0 ? ", " : "", asked[i]);
    }
    (void)snprintf(message + length, WH_SANDBOX_MESSAGE_BYTES - length, "%s)", count == NAMED ? ", ..." : "");
}

/* Runs protected; the argument is the message. */
static int find_unread(lua_State *L) {
    size_t asked_count = 0;
    size_t unread_count = 0;
    push_kept(L, ASKED);
    const char **const asked = wh_library_list_names(L, NULL, &asked_count);
    push_kept(L, VALUES);
    const char **const unread = wh_library_list_names(L, NULL, &unread_count);
    if (unread_count > 0) {
        write_message(lua_touserdata(L, 1), unread[0], asked, asked_count < NAMED ? asked_count : NAMED);
    }
    return 0;
}

bool wh_sandbox_find_unread(wh_sandbox_t *sandbox, char message[WH_SANDBOX_MESSAGE_BYTES]) {
    message[0] = '\0';
    return wh_sandbox_protect(sandbox->main, find_unread, message, NULL) && message[0] != '\0';
}

typedef struct {
    const char *assignment;
    bool is_unread;
} question_t;

/* Runs protected; the argument is a question. */
static int look_for(lua_State *L) {
    question_t *question = lua_touserdata(L, 1);
    push_kept(L, VALUES);
    (void)lua_pushlstring(L, question->assignment, strcspn(question->assignment, "="));
    question->is_unread = lua_rawget(L, -2) != LUA_TNIL;
    return 0;
}

bool wh_sandbox_is_unread(wh_sandbox_t *sandbox, const char *assignment) {
    question_t question = {assignment, true};
    (void)wh_sandbox_protect(sandbox->main, look_for, &question, NULL);
    return question.is_unread;
}

void wh_library_open_params(lua_State *L) {
    push_kept(L, PARAMS);
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, read_parameter);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    lua_setglobal(L, "params");
}
