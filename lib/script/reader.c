#include "reader.h"

#include <stdio.h>
#include <string.h>

#include "../math/config.h"
#include "reader_internal.h"

void wh_reader_start(wh_reader_t *reader, lua_State *L, const char *file) {
    memset(reader, 0, sizeof *reader);
    reader->L = L;
    reader->file = file;
    luaL_checkstack(L, 16, "layout nested too deeply");
}

/* --------------------------------------------------------------------------------------------- nesting */

void wh_reader_enter_top(wh_reader_t *reader, const char *name) {
    const size_t length = strlen(reader->path);
    const char *dot = length > 0 && name[0] != '[' ? "." : "";
    if (!lua_istable(reader->L, -1)) {
        wh_reader_fail(reader, name, "a table");
    }
    if (reader->depth == WH_READER_DEPTH) {
        wh_reader_fail(reader, name, "less nesting");
    }
    snprintf(reader->path + length, sizeof reader->path - length, "%s%s", dot, name);
    reader->lengths[reader->depth++] = length;
}

bool wh_reader_enter(wh_reader_t *reader, const char *field) {
    lua_pushstring(reader->L, field);
    lua_rawget(reader->L, -2);
    if (lua_isnil(reader->L, -1)) {
        lua_pop(reader->L, 1);
        return false;
    }
    wh_reader_enter_top(reader, field);
    return true;
}

bool wh_reader_enter_item(wh_reader_t *reader, lua_Integer index) {
    char name[32];
    snprintf(name, sizeof name, "[%lld]", (long long)index);
    lua_rawgeti(reader->L, -1, index);
    if (lua_isnil(reader->L, -1)) {
        lua_pop(reader->L, 1);
        return false;
    }
    wh_reader_enter_top(reader, name);
    return true;
}

void wh_reader_leave(wh_reader_t *reader) {
    WH_ASSERT(reader->depth > 0);
    reader->path[reader->lengths[--reader->depth]] = '\0';
    lua_pop(reader->L, 1);
}

/* ---------------------------------------------------------------------------------------------- fields */

/* Pushes a field; false when it is absent, which is an error when it is required. */
static bool push_field(const wh_reader_t *reader, const char *field, bool required, const char *expected) {
    lua_pushstring(reader->L, field);
    lua_rawget(reader->L, -2);
    if (!lua_isnil(reader->L, -1)) {
        return true;
    }
    if (required) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    lua_pop(reader->L, 1);
    return false;
}

wh_real_t wh_reader_number(wh_reader_t *reader, const char *field, wh_real_t fallback, wh_real_t min,
                           wh_real_t max) {
    char expected[80];
    snprintf(expected, sizeof expected, "a number from %.12g to %.12g", (double)min, (double)max);
    if (!push_field(reader, field, !wh_real_is_finite(fallback), expected)) {
        return fallback;
    }
    const wh_real_t value = (wh_real_t)lua_tonumber(reader->L, -1);
    if (lua_type(reader->L, -1) != LUA_TNUMBER || !(value >= min && value <= max)) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    lua_pop(reader->L, 1);
    return value;
}

int32_t wh_reader_whole(wh_reader_t *reader, const char *field, int32_t fallback, int32_t min, int32_t max) {
    char expected[80];
    int is_whole = 0;
    snprintf(expected, sizeof expected, "a whole number from %d to %d", (int)min, (int)max);
    if (!push_field(reader, field, fallback < min, expected)) {
        return fallback;
    }
    const lua_Integer value = lua_tointegerx(reader->L, -1, &is_whole);
    if (lua_type(reader->L, -1) != LUA_TNUMBER || !is_whole || value < min || value > max) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    lua_pop(reader->L, 1);
    return (int32_t)value;
}

bool wh_reader_boolean(wh_reader_t *reader, const char *field, bool fallback) {
    if (!push_field(reader, field, false, "")) {
        return fallback;
    }
    if (!lua_isboolean(reader->L, -1)) {
        wh_reader_fail(reader, field, "true or false");
    }
    const bool value = lua_toboolean(reader->L, -1) != 0;
    lua_pop(reader->L, 1);
    return value;
}

static wh_real_t component(wh_reader_t *reader, const char *field, lua_Integer index) {
    char name[80];
    snprintf(name, sizeof name, "%s[%d]", field, (int)index);
    lua_rawgeti(reader->L, -1, index);
    const wh_real_t value = (wh_real_t)lua_tonumber(reader->L, -1);
    if (lua_type(reader->L, -1) != LUA_TNUMBER || !(wh_real_abs(value) <= WH_REAL(1e6))) {
        wh_reader_fail(reader, name, "a number from -1e6 to 1e6");
    }
    lua_pop(reader->L, 1);
    return value;
}

wh_vec3_t wh_reader_vector(wh_reader_t *reader, const char *field, const wh_vec3_t *fallback) {
    if (!push_field(reader, field, !fallback, "a list of three numbers")) {
        return *fallback;
    }
    if (!lua_istable(reader->L, -1) || !wh_reader_is_list_of_three(reader->L)) {
        wh_reader_fail(reader, field, "a list of three numbers");
    }
    wh_vec3_t vector;
    vector.x = component(reader, field, 1);
    vector.y = component(reader, field, 2);
    vector.z = component(reader, field, 3);
    lua_pop(reader->L, 1);
    return vector;
}

bool wh_reader_is_plain(const char *text, size_t length) {
    for (size_t i = 0; i < length; ++i) {
        if ((unsigned char)text[i] < 0x20 || text[i] == 0x7f) {
            return false;
        }
    }
    return length > 0;
}

void wh_reader_text(wh_reader_t *reader, const char *field, const char *fallback, char *text, size_t size) {
    char expected[80];
    snprintf(expected, sizeof expected, "text of 1 to %d bytes", (int)size - 1);
    if (!push_field(reader, field, !fallback, expected)) {
        snprintf(text, size, "%s", fallback);
        return;
    }
    size_t length = 0;
    const char *value = lua_type(reader->L, -1) == LUA_TSTRING ? lua_tolstring(reader->L, -1, &length) : NULL;
    if (!value || length >= size || !wh_reader_is_plain(value, length)) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    memcpy(text, value, length + 1);
    lua_pop(reader->L, 1);
}

int wh_reader_choice(wh_reader_t *reader, const char *field, int fallback, const char *const choices[]) {
    if (!push_field(reader, field, false, "")) {
        return fallback;
    }
    const char *value = lua_type(reader->L, -1) == LUA_TSTRING ? lua_tostring(reader->L, -1) : "";
    char expected[256] = "";
    for (int i = 0; choices[i]; ++i) {
        if (strcmp(value, choices[i]) == 0) {
            lua_pop(reader->L, 1);
            return i;
        }
        const size_t length = strlen(expected);
        snprintf(expected + length, sizeof expected - length, "%s\"%s\"", i > 0 ? " or " : "", choices[i]);
    }
    wh_reader_fail(reader, field, "%s", expected);
}
