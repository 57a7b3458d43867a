/* How messages show a value, and the message that refuses one. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reader_internal.h"

/* The sign of a NaN depends on the machine, and says nothing. */
static void describe_number(double value, char *text, size_t size) {
    if (value != value) {
        snprintf(text, size, "nan");
    } else {
        snprintf(text, size, "%.14g", value);
    }
}

static bool is_short_list(lua_State *L) {
    const lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    bool numbers = count >= 1 && count <= 4;
    for (lua_Integer i = 1; numbers && i <= count; ++i) {
        numbers = lua_rawgeti(L, -1, i) == LUA_TNUMBER;
        lua_pop(L, 1);
    }
    return numbers;
}

/* { 0, 90, 0 }: a short list of numbers as it was written; of any other table only that it is one. */
static void describe_table(lua_State *L, char *text, size_t size) {
    if (!is_short_list(L)) {
        snprintf(text, size, "a table");
        return;
    }
    const char *before = "{ ";
    text[0] = '\0';
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, -1); ++i) {
        char number[40];
        lua_rawgeti(L, -1, i);
        describe_number(lua_tonumber(L, -1), number, sizeof number);
        lua_pop(L, 1);
        const size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s", before, number);
        before = ", ";
    }
    const size_t used = strlen(text);
    snprintf(text + used, size - used, " }");
}

void wh_reader_describe(lua_State *L, char *text, size_t size) {
    switch (lua_type(L, -1)) {
    case LUA_TNUMBER:
        describe_number(lua_tonumber(L, -1), text, size);
        break;
    case LUA_TTABLE:
        describe_table(L, text, size);
        break;
    case LUA_TSTRING:
        snprintf(text, size, "\"%.60s\"", lua_tostring(L, -1));
        break;
    case LUA_TBOOLEAN:
        snprintf(text, size, "%s", lua_toboolean(L, -1) ? "true" : "false");
        break;
    case LUA_TNIL:
        snprintf(text, size, "nothing");
        break;
    default:
        snprintf(text, size, "a %s", luaL_typename(L, -1));
        break;
    }
}

void wh_reader_fail(const wh_reader_t *reader, const char *field, const char *expected, ...) {
    char value[200];
    char wanted[512];
    va_list arguments;
    wh_reader_describe(reader->L, value, sizeof value);
    va_start(arguments, expected);
    vsnprintf(wanted, sizeof wanted, expected, arguments);
    va_end(arguments);
    const bool in_list = field && field[0] == '[';
    const char *dot = reader->depth > 0 && field && !in_list ? "." : "";
    lua_pushfstring(reader->L, "%s: %s%s%s: %s (expected %s)", reader->file, reader->path, dot,
                    field ? field : "", value, wanted);
    lua_error(reader->L);
    abort(); /* lua_error does not return, but its declaration does not say so */
}
