#include "check_values.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

/* The most characters of names that are told for a table. */
#define MOST_TOLD 500

/* The fields that objects of a kind may lack; `mark` is a name that all objects of the kind have. */
typedef struct {
    const char *mark;
    const char *names[14];
} optional_t;

static const optional_t optional[] = {
    {"format", {"nothing_moved", "failure", "errors", "trial", "log", "clearances", "clearance_curves"}},
    {"error", {"message"}},
    {"measured_utime",
     {"parts", "at", "value", "limit", "fault", "fault_kind", "from", "holder", "other", "height", "status",
      "message", "seat"}}};

/* ----------------------------------------------------------------------------------------- what there is */

static int compare_texts(const void *one, const void *other) {
    return strcmp(*(const char *const *)one, *(const char *const *)other);
}

/* Adds the keys of the table at `index` that are texts; returns how many there are then. */
static size_t add_names(lua_State *L, int index, const char *names[], size_t count, size_t most) {
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING && count < most) {
            names[count++] = lua_tostring(L, -2);
        }
    }
    return count;
}

/* Pushes up to MOST_TOLD characters of names, in their order. */
static const char *push_told(lua_State *L, const char *const names[], size_t count) {
    luaL_Buffer told;
    size_t size = 0;
    luaL_buffinit(L, &told);
    for (size_t i = 0; i < count && size < MOST_TOLD; ++i) {
        luaL_addstring(&told, i > 0 ? ", " : "");
        luaL_addstring(&told, names[i]);
        size += strlen(names[i]) + 2;
    }
    luaL_addstring(&told, size < MOST_TOLD ? "" : ", ...");
    luaL_pushresult(&told);
    return lua_tostring(L, -1);
}

/* The names stay alive in the tables whose keys they are. */
static const char *push_names(lua_State *L, int table, int more) {
    enum { MOST = 256 };
    const char *names[MOST];
    size_t count = add_names(L, table, names, 0, MOST);
    count = add_names(L, more, names, count, MOST);
    qsort(names, count, sizeof *names, compare_texts);
    return push_told(L, names, count);
}

/* ------------------------------------------------------------------------------------------------- strict */

/* Runs when a table's field is nil. Upvalue 1 holds the fields that may be nil; any other name is an
 * error. */
static int find_absent(lua_State *L) {
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL) {
        lua_pushvalue(L, lua_upvalueindex(1));
        const char *names = push_names(L, 1, lua_gettop(L));
        return luaL_error(L, "%s: there is no such field (expected %s)", luaL_tolstring(L, 2, NULL), names);
    }
    lua_pushnil(L);
    return 1;
}

/* The names of a list's items, if they have any. */
static const char *push_item_names(lua_State *L, lua_Integer count) {
    enum { MOST = 64 };
    const char *names[MOST];
    size_t found = 0;
    for (lua_Integer i = 1; i <= count && found < MOST; ++i) {
        if (lua_rawgeti(L, 1, i) == LUA_TTABLE) {
            lua_pushliteral(L, "name");
            if (lua_rawget(L, -2) == LUA_TSTRING) {
                names[found++] = lua_tostring(L, -1);
            }
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
    }
    return push_told(L, names, found);
}

/* Runs when a list has no such item: an error. */
static int find_item(lua_State *L) {
    const lua_Integer count = (lua_Integer)lua_rawlen(L, 1);
    const char *names = push_item_names(L, count);
    if (count == 0) {
        return luaL_error(L, "%s: there is no such item of the list (expected none: it is empty)",
                          luaL_tolstring(L, 2, NULL));
    }
    return luaL_error(L, "%s: there is no such item of the list (expected a number from 1 to %I%s%s)",
                      luaL_tolstring(L, 2, NULL), (LUAI_UACINT)count, names[0] ? ", of " : "", names);
}

/* Our lists are read without the metamethod, so a loop ends at the list's end. */
static int next_item(lua_State *L) {
    const lua_Integer i = luaL_checkinteger(L, 2) + 1;
    lua_pushinteger(L, i);
    if (luaL_getmetafield(L, 1, "__name") != LUA_TNIL) {
        lua_pop(L, 1);
        lua_rawgeti(L, 1, i);
    } else {
        lua_geti(L, 1, i);
    }
    return lua_isnil(L, -1) ? 1 : 2;
}

int wh_check_ipairs(lua_State *L) {
    luaL_checkany(L, 1);
    lua_pushcfunction(L, next_item);
    lua_pushvalue(L, 1);
    lua_pushinteger(L, 0);
    return 3;
}

static void set_lookup(lua_State *L) {
    lua_createtable(L, 0, 1);
    lua_insert(L, -2);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
}

int wh_check_make_list(lua_State *L) {
    lua_settop(L, 1);
    lua_pushcfunction(L, find_item);
    set_lookup(L);
    (void)lua_getmetatable(L, -1);
    lua_pushliteral(L, "list");
    lua_setfield(L, -2, "__name");
    lua_pop(L, 1);
    return 1;
}

void wh_check_make_strict(lua_State *L) {
    lua_pushcclosure(L, find_absent, 1);
    set_lookup(L);
}

void wh_check_set_name(lua_State *L, const char *name) {
    lua_pushboolean(L, true);
    lua_setfield(L, -2, name);
}

/* ------------------------------------------------------------------------------------------------- values */

static void push_list(lua_State *L, const json_t *list) {
    lua_pushcfunction(L, wh_check_make_list);
    lua_createtable(L, (int)json_array_size(list), 0);
    for (size_t i = 0; i < json_array_size(list); ++i) {
        wh_check_push(L, json_array_get(list, i));
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_call(L, 1, 1);
}

static void set_optional(lua_State *L, const json_t *object) {
    for (size_t i = 0; i < sizeof optional / sizeof optional[0]; ++i) {
        for (size_t n = 0; json_object_get(object, optional[i].mark) && optional[i].names[n]; ++n) {
            wh_check_set_name(L, optional[i].names[n]);
        }
    }
}

static void push_object(lua_State *L, json_t *object) {
    lua_newtable(L);
    lua_newtable(L);
    set_optional(L, object);
    for (void *member = json_object_iter(object); member; member = json_object_iter_next(object, member)) {
        const char *name = json_object_iter_key(member);
        if (json_is_null(json_object_iter_value(member))) {
            wh_check_set_name(L, name);
            continue;
        }
        wh_check_push(L, json_object_iter_value(member));
        lua_setfield(L, -3, name);
        lua_pushnil(L);
        lua_setfield(L, -2, name);
    }
    wh_check_make_strict(L);
}

void wh_check_push(lua_State *L, json_t *value) {
    luaL_checkstack(L, 8, "values within values");
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        push_object(L, value);
        break;
    case JSON_ARRAY:
        push_list(L, value);
        break;
    case JSON_STRING:
        lua_pushlstring(L, json_string_value(value), json_string_length(value));
        break;
    case JSON_INTEGER:
        lua_pushinteger(L, json_integer_value(value));
        break;
    case JSON_REAL:
        lua_pushnumber(L, json_real_value(value));
        break;
    case JSON_TRUE:
    case JSON_FALSE:
        lua_pushboolean(L, json_is_true(value));
        break;
    case JSON_NULL:
        lua_pushnil(L);
        break;
    }
}
