#include "values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <lauxlib.h>

/* The characters of a name or a value without quotes. */
static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./-";

/* Behind a value that may be in quotes. */
static const char *end_of(const char *value) {
    if (*value != '"') {
        return value + strcspn(value, " ;");
    }
    for (++value; *value && *value != '"'; ++value) {
        value += *value == '\\' && value[1] != '\0' ? 1 : 0;
    }
    return value + (*value == '"' ? 1 : 0);
}

/* True if a text without quotes is a number and no row of digits, as the codes of a map are. */
static bool is_number(const char *text) {
    const size_t digits = strspn(text, "0123456789");
    const bool is_row = text[digits] == '\0' && digits > 1 && (text[0] == '0' || digits > 15);
    return !is_row;
}

/* Pushes a value: a text in quotes without the quotes, and `none` as nil. */
static void push_value(lua_State *L, const char *value, const char *end) {
    if (*value == '"') {
        luaL_Buffer buffer;
        luaL_buffinit(L, &buffer);
        for (++value; value + 1 < end; ++value) {
            value += *value == '\\' ? 1 : 0;
            luaL_addchar(&buffer, *value);
        }
        luaL_pushresult(&buffer);
        return;
    }
    lua_pushlstring(L, value, (size_t)(end - value));
    if (strcmp(lua_tostring(L, -1), "none") == 0) {
        lua_pop(L, 1);
        lua_pushnil(L);
    } else if (is_number(lua_tostring(L, -1)) && lua_stringtonumber(L, lua_tostring(L, -1)) != 0) {
        lua_remove(L, -2);
    }
}

/* Where the next name=value begins; null: none is left. `name_end` is at its equals sign. */
static const char *next_pair(const char *text, const char **name_end) {
    for (const char *at = text; *at; at = end_of(at), at += strspn(at, " ;")) {
        const char *end = *at == '"' ? end_of(at) : at; /* a name's owner may be in quotes: "EE 1".holds */
        end += strcspn(end, "= ;\"");
        if (*end == '=' && end > at) {
            *name_end = end;
            return at;
        }
        if (end == at) {
            return NULL;
        }
    }
    return NULL;
}

void wh_push_values(lua_State *L, const char *text) {
    const char *name_end = NULL;
    lua_newtable(L);
    for (const char *at = next_pair(text, &name_end); at; at = next_pair(text, &name_end)) {
        text = end_of(name_end + 1);
        lua_pushlstring(L, at, (size_t)(name_end - at));
        push_value(L, name_end + 1, text);
        lua_rawset(L, -3);
        text += strspn(text, " ;");
    }
}

const char *wh_value_begin(const char *text, const char *name) {
    const char *name_end = NULL;
    for (const char *at = next_pair(text, &name_end); at; at = next_pair(text, &name_end)) {
        if (strlen(name) == (size_t)(name_end - at) && strncmp(at, name, strlen(name)) == 0) {
            return name_end + 1;
        }
        text = end_of(name_end + 1);
        text += strspn(text, " ;");
    }
    return "";
}

void wh_value_copy(const char *text, const char *name, char *to, size_t size) {
    const char *value = wh_value_begin(text, name);
    (void)snprintf(to, size, "%.*s", (int)(end_of(value) - value), value);
}

/* In quotes, and with a backslash before quotes and backslashes. */
static bool spell_quoted(const char *name, char *to, size_t size) {
    size_t length = 1;
    if (2 * strlen(name) + 3 > size) {
        return false;
    }
    to[0] = '"';
    for (const char *c = name; *c; ++c) {
        if (*c == '"' || *c == '\\') {
            to[length++] = '\\';
        }
        to[length++] = *c;
    }
    to[length] = '"';
    to[length + 1] = '\0';
    return true;
}

bool wh_value_spell(const char *name, char *to, size_t size) {
    const bool is_plain = name[0] != '\0' && name[strspn(name, plain)] == '\0';
    if (is_plain && strcasecmp(name, "none") != 0) {
        return snprintf(to, size, "%s", name) < (int)size;
    }
    return spell_quoted(name, to, size);
}
