#include "reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../math/config.h"
#include "../math/trig.h"
#include "../text/nearest.h"
#include "../text/utf8.h"
#include "wh_module_values.h"

/* ----------------------------------------------------------------------------------------------- messages */

/* The sign is left out, because that of a NaN differs between machines and has no meaning. */
static void describe_number(double value, char *text, size_t size) {
    if (value != value) {
        snprintf(text, size, "nan");
    } else {
        snprintf(text, size, "%.14g", value);
    }
}

/* A short list of numbers is shown as written, { 0, 90, 0 }; for any other table the text only says that it
 * is one. */
static void describe_table(lua_State *L, char *text, size_t size) {
    const lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    bool is_short_list = count >= 1 && count <= 4;
    text[0] = '\0';
    for (lua_Integer i = 1; is_short_list && i <= count; ++i) {
        char number[40];
        is_short_list = lua_rawgeti(L, -1, i) == LUA_TNUMBER;
        describe_number(lua_tonumber(L, -1), number, sizeof number);
        lua_pop(L, 1);
        const size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s%s", i > 1 ? ", " : "{ ", number, i == count ? " }" : "");
    }
    if (!is_short_list) {
        snprintf(text, size, "a table");
    }
}

static void describe(lua_State *L, char *text, size_t size) {
    switch (lua_type(L, -1)) {
    case LUA_TNUMBER:
        describe_number(lua_tonumber(L, -1), text, size);
        break;
    case LUA_TTABLE:
        describe_table(L, text, size);
        break;
    case LUA_TSTRING:
        snprintf(text, size, "\"%.60s\"", wh_lua_whole_text(L, -1));
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

/* The longest text that describes the expected values. */
#define WANTED_SIZE 640

__attribute__((noreturn)) static void fail(const wh_reader_t *reader, const char *field, const char *wanted) {
    char value[200];
    describe(reader->L, value, sizeof value);
    const bool in_list = field && field[0] == '[';
    const char *dot = reader->depth > 0 && field && !in_list ? "." : "";
    lua_pushfstring(reader->L, "%s: %s%s%s: %s (expected %s)", reader->file, reader->path, dot,
                    field ? field : "", value, wanted);
    lua_error(reader->L);
    abort(); /* lua_error does not return, but its declaration does not say so */
}

void wh_reader_fail(const wh_reader_t *reader, const char *field, const char *expected, ...) {
    va_list arguments;
    char wanted[WANTED_SIZE];
    va_start(arguments, expected);
    vsnprintf(wanted, sizeof wanted, expected, arguments);
    va_end(arguments);
    fail(reader, field, wanted);
}

void wh_reader_refuse(const wh_reader_t *reader, const char *field, const char *text, const char *expected,
                      ...) {
    va_list arguments;
    char wanted[WANTED_SIZE];
    va_start(arguments, expected);
    vsnprintf(wanted, sizeof wanted, expected, arguments);
    va_end(arguments);
    if (!text && field && lua_istable(reader->L, -1)) {
        (void)wh_reader_push(reader, field);
    } else {
        lua_pushstring(reader->L, text);
    }
    fail(reader, field, wanted);
}

/* --------------------------------------------------------------------------------------------------- keys */

static bool is_known(const char *name, size_t length, const wh_reader_field_t *known) {
    while (known->name && (strlen(known->name) != length || memcmp(known->name, name, length) != 0)) {
        ++known;
    }
    return known->name != NULL;
}

/* Names the key below the top of the stack, in brackets unless it is a text. */
static void name_key(lua_State *L, char *field, size_t size) {
    lua_pushvalue(L, -2);
    if (lua_type(L, -1) == LUA_TSTRING) {
        snprintf(field, size, "%.60s", wh_lua_whole_text(L, -1));
    } else {
        char key[60];
        describe(L, key, sizeof key);
        snprintf(field, size, "[%s]", key);
    }
    lua_pop(L, 1);
}

/* The most fields that a table has. */
#define MOST_FIELDS 64

/* Refuses the value on top of the stack: its field is not a known one. */
__attribute__((noreturn)) static void refuse_field(const wh_reader_t *reader, const char *field,
                                                   const char *name, const wh_reader_field_t *known) {
    const char *names[MOST_FIELDS];
    char list[WANTED_SIZE] = "";
    char meant[WH_NEAREST_TEXT] = "";
    size_t count = 0;
    for (; count < MOST_FIELDS && known[count].name; ++count) {
        const size_t used = strlen(list);
        names[count] = known[count].name;
        snprintf(list + used, sizeof list - used, "%s%s", count > 0 ? " " : "", names[count]);
    }
    const char *nearest = name ? wh_text_nearest(name, names, count) : NULL;
    wh_reader_fail(reader, field, "one of the fields %s%s", list,
                   wh_text_did_you_mean(meant, "; ", "", nearest));
}

void wh_reader_refuse_unknown(wh_reader_t *reader, const wh_reader_field_t *known) {
    lua_State *L = reader->L;
    const char *first = NULL;
    size_t first_length = 0;
    reader->known[reader->depth] = known;
    lua_pushnil(L);
    while (lua_next(L, -2) != 0) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            char field[80];
            name_key(L, field, sizeof field);
            refuse_field(reader, field, NULL, known);
        }
        size_t length = 0;
        const char *name = lua_tolstring(L, -2, &length);
        if (!is_known(name, length, known) && (!first || strcmp(name, first) < 0)) {
            first = name;
            first_length = length;
        }
        lua_pop(L, 1);
    }
    if (first) {
        char field[80];
        lua_pushlstring(L, first, first_length);
        lua_pushvalue(L, -1);
        (void)lua_rawget(L, -3);
        name_key(L, field, sizeof field);
        refuse_field(reader, field, first, known);
    }
}

/* True if the key below the top is one of 1 to count. */
static bool is_entry(lua_State *L, lua_Integer count) {
    const bool whole = lua_isinteger(L, -2) != 0;
    return whole && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= count;
}

/* Counts the entries. True if their keys are 1, 2, ... without a gap: whole ones, the highest of which is
 * their number. */
static bool is_list(lua_State *L, size_t *count) {
    lua_Integer highest = 0;
    bool are_whole = true;
    *count = 0;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const lua_Integer key = lua_isinteger(L, -2) ? lua_tointeger(L, -2) : 0;
        are_whole = are_whole && key >= 1;
        highest = key > highest ? key : highest;
        ++*count;
    }
    return are_whole && highest == (lua_Integer)*count;
}

/* Pushes a key that is not allowed in a list of this number of entries, and its value; false if there is
 * none. Counts the entries. */
static bool push_stray(lua_State *L, size_t *count) {
    if (is_list(L, count)) {
        return false;
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

static bool is_list_of_three(lua_State *L) {
    size_t count = 0;
    if (push_stray(L, &count)) {
        lua_pop(L, 2);
        return false;
    }
    return count == 3;
}

void wh_reader_start(wh_reader_t *reader, lua_State *L, const char *file) {
    memset(reader, 0, sizeof *reader);
    reader->L = L;
    reader->file = file;
    luaL_checkstack(L, 16, "layout nested too deeply");
}

/* ------------------------------------------------------------------------------------------------ nesting */

static void enter_top(wh_reader_t *reader, const char *name) {
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
    reader->known[reader->depth] = NULL;
}

int wh_reader_push(const wh_reader_t *reader, const char *field) {
    lua_pushstring(reader->L, field);
    return lua_rawget(reader->L, -2);
}

bool wh_reader_has(const wh_reader_t *reader, const char *field) {
    const bool there = wh_reader_push(reader, field) != LUA_TNIL;
    lua_pop(reader->L, 1);
    return there;
}

/* Enters the value on top of the stack, or pops it if it is nil. */
static bool enter_top_unless_nil(wh_reader_t *reader, const char *name) {
    if (lua_isnil(reader->L, -1)) {
        lua_pop(reader->L, 1);
        return false;
    }
    enter_top(reader, name);
    return true;
}

bool wh_reader_enter(wh_reader_t *reader, const char *field) {
    (void)wh_reader_push(reader, field);
    return enter_top_unless_nil(reader, field);
}

bool wh_reader_open(wh_reader_t *reader, const char *field, const wh_reader_field_t *known) {
    const bool there = wh_reader_enter(reader, field);
    if (there) {
        wh_reader_refuse_unknown(reader, known);
    }
    return there;
}

void wh_reader_open_section(wh_reader_t *reader, const char *field, const wh_reader_field_t *known) {
    if (wh_reader_push(reader, field) == LUA_TNIL) {
        lua_newtable(reader->L);
        lua_replace(reader->L, -2);
    }
    enter_top(reader, field);
    wh_reader_refuse_unknown(reader, known);
}

bool wh_reader_enter_item(wh_reader_t *reader, lua_Integer index) {
    char name[32];
    snprintf(name, sizeof name, "[%lld]", (long long)index);
    lua_rawgeti(reader->L, -1, index);
    return enter_top_unless_nil(reader, name);
}

void wh_reader_leave(wh_reader_t *reader) {
    WH_ASSERT(reader->depth > 0);
    reader->path[reader->lengths[--reader->depth]] = '\0';
    lua_pop(reader->L, 1);
}

/* ------------------------------------------------------------------------------------------------- fields */

/* Pushes a field. Returns false if it is absent; that is an error if it is required. */
static bool push_field(const wh_reader_t *reader, const char *field, bool required, const char *expected) {
    if (wh_reader_push(reader, field) != LUA_TNIL) {
        return true;
    }
    if (required) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    lua_pop(reader->L, 1);
    return false;
}

/* Pops the field, or refuses it. */
static void pop_field(const wh_reader_t *reader, const char *field, bool is_good, const char *expected) {
    if (!is_good) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    lua_pop(reader->L, 1);
}

static const wh_reader_field_t *find_row(const wh_reader_t *reader, const char *field) {
    const wh_reader_field_t *rows = reader->known[reader->depth];
    return rows ? wh_field_find(rows, field) : NULL;
}

/* In a cell nothing is longer in metres. */
#define MOST_METRES 2

/* Appends a question to the text of what was expected, if the number would be within its limits in another
 * unit. */
static void ask_unit(const wh_reader_t *reader, const char *field, double value, double min, double max,
                     char *expected, size_t size) {
    const wh_reader_field_t *row = find_row(reader, field);
    if (!row) {
        return;
    }
    const bool is_angle = strstr(row->text, "degrees") && !strstr(row->text, "degrees or mm");
    const bool is_length = strncmp(row->text, "mm", 2) == 0 && value < MOST_METRES;
    const double meant = value * (is_angle ? 180 / (double)WH_PI : 1000);
    const size_t used = strlen(expected);
    if ((is_angle || is_length) && meant >= min && meant <= max) {
        snprintf(expected + used, size - used, "; is that %s? Then it is %.6g",
                 is_angle ? "radians" : "metres", meant);
    }
}

wh_real_t wh_reader_number(wh_reader_t *reader, const char *field, wh_real_t fallback, wh_real_t min,
                           wh_real_t max) {
    char expected[160];
    snprintf(expected, sizeof expected, "a number from %.12g to %.12g", (double)min, (double)max);
    if (!push_field(reader, field, !wh_real_is_finite(fallback), expected)) {
        return fallback;
    }
    const wh_real_t value = (wh_real_t)lua_tonumber(reader->L, -1);
    const bool is_number = lua_type(reader->L, -1) == LUA_TNUMBER;
    if (is_number && value < min) {
        ask_unit(reader, field, value, min, max, expected, sizeof expected);
    }
    pop_field(reader, field, is_number && value >= min && value <= max, expected);
    return value;
}

int32_t wh_reader_whole(wh_reader_t *reader, const char *field, int32_t fallback, int32_t min, int32_t max) {
    char expected[80];
    int is_whole = 0;
    snprintf(expected, sizeof expected, min < max ? "a whole number from %d to %d" : "%d", (int)min,
             (int)max);
    if (!push_field(reader, field, fallback < min, expected)) {
        return fallback;
    }
    const lua_Integer value = lua_tointegerx(reader->L, -1, &is_whole);
    const bool is_number = lua_type(reader->L, -1) == LUA_TNUMBER;
    pop_field(reader, field, is_number && is_whole && value >= min && value <= max, expected);
    return (int32_t)value;
}

bool wh_reader_boolean(wh_reader_t *reader, const char *field, bool fallback) {
    if (!push_field(reader, field, false, "")) {
        return fallback;
    }
    const bool value = lua_toboolean(reader->L, -1) != 0;
    pop_field(reader, field, lua_isboolean(reader->L, -1), "true or false");
    return value;
}

static wh_real_t component(wh_reader_t *reader, const char *field, lua_Integer index) {
    char name[80];
    snprintf(name, sizeof name, "%s[%d]", field, (int)index);
    lua_rawgeti(reader->L, -1, index);
    const wh_real_t value = (wh_real_t)lua_tonumber(reader->L, -1);
    const bool is_good = lua_type(reader->L, -1) == LUA_TNUMBER && wh_real_abs(value) <= WH_REAL(1e6);
    pop_field(reader, name, is_good, "a number from -1e6 to 1e6");
    return value;
}

wh_vec3_t wh_reader_vector(wh_reader_t *reader, const char *field, const wh_vec3_t *fallback) {
    if (!push_field(reader, field, !fallback, "a list of three numbers")) {
        return *fallback;
    }
    if (!lua_istable(reader->L, -1) || !is_list_of_three(reader->L)) {
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
        if (wh_utf8_control_bytes(text + i) > 0) {
            return false;
        }
        const size_t character = wh_utf8_bytes(text + i);
        i += character > 0 ? character - 1 : 0;
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
    if (!value || length >= size || length == 0) {
        wh_reader_fail(reader, field, "%s", expected);
    }
    if (!wh_reader_is_plain(value, length)) {
        wh_reader_fail(reader, field, "text without control characters");
    }
    memcpy(text, value, length + 1);
    lua_pop(reader->L, 1);
}

int wh_reader_choice(wh_reader_t *reader, const char *field, int fallback, const char *const choices[]) {
    if (!push_field(reader, field, false, "")) {
        return fallback;
    }
    const char *value = wh_lua_word(reader->L, -1);
    char expected[WANTED_SIZE] = "";
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
