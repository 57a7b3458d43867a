/* Which keys a table may have: named fields, or a list's entries. */
#include <stdio.h>
#include <string.h>

#include "reader_internal.h"

static bool is_known(const char *name, size_t length, const char *known) {
    if (length == 0 || length != strlen(name) || strchr(name, ' ')) {
        return false;
    }
    for (const char *at = strstr(known, name); at; at = strstr(at + 1, name)) {
        const bool begins = at == known || at[-1] == ' ';
        if (begins && (at[length] == ' ' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

/* The key below the top, in brackets unless it is a name. */
static void name_key(lua_State *L, char *field, size_t size) {
    lua_pushvalue(L, -2);
    if (lua_type(L, -1) == LUA_TSTRING) {
        snprintf(field, size, "%.60s", lua_tostring(L, -1));
    } else {
        char key[60];
        wh_reader_describe(L, key, sizeof key);
        snprintf(field, size, "[%s]", key);
    }
    lua_pop(L, 1);
}

void wh_reader_refuse_unknown(wh_reader_t *reader, const char *known) {
    lua_State *L = reader->L;
    const char *first = NULL;
    lua_pushnil(L);
    while (lua_next(L, -2) != 0) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            char field[80];
            name_key(L, field, sizeof field);
            wh_reader_fail(reader, field, "one of the fields %s", known);
        }
        size_t length = 0;
        const char *name = lua_tolstring(L, -2, &length);
        if (!is_known(name, length, known) && (!first || strcmp(name, first) < 0)) {
            first = name;
        }
        lua_pop(L, 1);
    }
    if (first) {
        char field[80];
        snprintf(field, sizeof field, "%.60s", first);
        lua_pushstring(L, first);
        lua_rawget(L, -2);
        wh_reader_fail(reader, field, "one of the fields %s", known);
    }
}

/* Whether the key below the top is that of an entry of a list of `count`. */
static bool is_entry(lua_State *L, lua_Integer count) {
    const bool whole = lua_isinteger(L, -2) != 0;
    return whole && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= count;
}

/* Pushes the first key that no list of as many entries has, and its value; false when there is none. */
static bool push_stray(lua_State *L, size_t *count) {
    *count = 0;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        ++*count;
    }
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        if (!is_entry(L, (lua_Integer)*count)) {
            return true;
        }
    }
    return false;
}

size_t wh_reader_list(const wh_reader_t *reader) {
    size_t count = 0;
    if (push_stray(reader->L, &count)) {
        char field[80];
        name_key(reader->L, field, sizeof field);
        wh_reader_fail(reader, field, "a list: entries 1, 2, ... without names and gaps");
    }
    return count;
}

bool wh_reader_is_list_of_three(lua_State *L) {
    size_t count = 0;
    if (push_stray(L, &count)) {
        lua_pop(L, 2);
        return false;
    }
    return count == 3;
}
