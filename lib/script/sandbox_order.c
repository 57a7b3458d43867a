/* pairs and next in sorted order: the order of a hash table itself changes from run to run. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sandbox_internal.h"

/* A copy of a key. `text` points into the Lua string, which lives as long as its table keeps it. */
typedef struct {
    enum { RANK_NUMBER, RANK_STRING, RANK_BOOLEAN } rank;
    bool is_integer;
    lua_Integer integer; /* of a boolean, too: 0 or 1 */
    lua_Number number;
    const char *text;
    size_t length;
} order_key_t;

static void key_read(lua_State *L, int index, order_key_t *key) {
    memset(key, 0, sizeof *key);
    switch (lua_type(L, index)) {
    case LUA_TNUMBER:
        key->rank = RANK_NUMBER;
        key->is_integer = lua_isinteger(L, index);
        key->integer = lua_tointeger(L, index);
        key->number = lua_tonumber(L, index);
        return;
    case LUA_TSTRING:
        key->rank = RANK_STRING;
        key->text = lua_tolstring(L, index, &key->length);
        return;
    case LUA_TBOOLEAN:
        key->rank = RANK_BOOLEAN;
        key->is_integer = true;
        key->integer = lua_toboolean(L, index);
        return;
    default:
        luaL_error(L, "a table with a %s for a key has no order to be read in", luaL_typename(L, index));
    }
}

static void key_push(lua_State *L, const order_key_t *key) {
    if (key->rank == RANK_STRING) {
        lua_pushlstring(L, key->text, key->length);
    } else if (key->rank == RANK_BOOLEAN) {
        lua_pushboolean(L, key->integer != 0);
    } else if (key->is_integer) {
        lua_pushinteger(L, key->integer);
    } else {
        lua_pushnumber(L, key->number);
    }
}

/* True if an integer is below a number that is none. Above all integers, and below them, doubles are too far
 * apart to be converted. */
static bool is_integer_below(lua_Integer integer, lua_Number number) {
    const lua_Number beyond = 9223372036854775808.0;
    if (number >= beyond || number < -beyond) {
        return number > 0;
    }
    return integer <= (lua_Integer)floor(number);
}

static int number_compare(const order_key_t *a, const order_key_t *b) {
    if (a->is_integer && b->is_integer) {
        return (a->integer > b->integer) - (a->integer < b->integer);
    }
    if (a->is_integer) {
        return is_integer_below(a->integer, b->number) ? -1 : 1;
    }
    if (b->is_integer) {
        return is_integer_below(b->integer, a->number) ? 1 : -1;
    }
    return (a->number > b->number) - (a->number < b->number);
}

/* Below 0, 0 or above 0, as qsort asks for it. */
static int key_compare(const void *one, const void *other) {
    const order_key_t *const a = one;
    const order_key_t *const b = other;
    if (a->rank != b->rank) {
        return a->rank < b->rank ? -1 : 1;
    }
    if (a->rank != RANK_STRING) {
        return number_compare(a, b);
    }
    const int order = memcmp(a->text, b->text, a->length < b->length ? a->length : b->length);
    return order != 0 ? order : (a->length > b->length) - (a->length < b->length);
}

/* -------------------------------------------------------------------------------------------------- pairs */

/* A search for keys also passes over empty slots: a table that was once large has many of them. */
static void charge_scan(lua_State *L) {
    wh_sandbox_charge(L, 1 + (wh_sandbox_of(L)->largest_block >> 10));
}

static size_t count_keys(lua_State *L, int table) {
    size_t count = 0;
    charge_scan(L);
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        ++count;
    }
    return count;
}

/* Pushes a list of the table's keys in order. */
static void push_sorted_keys(lua_State *L, int table) {
    const size_t count = count_keys(L, table);
    uint64_t levels = 1;
    for (size_t rest = count; rest != 0; rest >>= 1) {
        ++levels;
    }
    wh_sandbox_charge(L, count * levels);
    order_key_t *const keys = lua_newuserdatauv(L, (count + 1) * sizeof *keys, 0);
    size_t i = 0;
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        key_read(L, -2, &keys[i++]);
    }
    qsort(keys, count, sizeof *keys, key_compare); /* no two keys are equal: any sort gives this order */
    lua_createtable(L, count < INT32_MAX ? (int)count : 0, 0);
    for (i = 0; i < count; ++i) {
        key_push(L, &keys[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_remove(L, -2);
}

/* Upvalues: the keys, and how many have been visited. Arguments: the table and the last key; nil begins
 * anew. */
static int pairs_step(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_Integer visited = lua_isnoneornil(L, 2) ? 0 : lua_tointeger(L, lua_upvalueindex(2));
    const lua_Integer first = visited;
    while (lua_rawgeti(L, lua_upvalueindex(1), ++visited) != LUA_TNIL) {
        lua_pushvalue(L, -1);
        if (lua_rawget(L, 1) != LUA_TNIL) {
            wh_sandbox_charge(L, (uint64_t)(visited - first));
            lua_pushinteger(L, visited);
            lua_replace(L, lua_upvalueindex(2));
            return 2;
        }
        lua_pop(L, 2);
    }
    wh_sandbox_charge(L, (uint64_t)(visited - first));
    return 1;
}

static int order_pairs(lua_State *L) {
    luaL_checkany(L, 1);
    if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
        lua_pushvalue(L, 1);
        lua_call(L, 1, 3);
        return 3;
    }
    luaL_checktype(L, 1, LUA_TTABLE);
    push_sorted_keys(L, 1);
    lua_pushinteger(L, 0);
    lua_pushcclosure(L, pairs_step, 2);
    lua_pushvalue(L, 1);
    lua_pushnil(L);
    return 3;
}

/* --------------------------------------------------------------------------------------------------- next */

static int order_next(lua_State *L) {
    order_key_t last, best, key;
    bool found = false;
    uint64_t seen = 0;
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 2);
    const bool from_start = lua_isnil(L, 2);
    if (!from_start) {
        key_read(L, 2, &last);
    }
    charge_scan(L);
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1), ++seen) {
        key_read(L, -2, &key);
        if ((from_start || key_compare(&last, &key) < 0) && (!found || key_compare(&key, &best) < 0)) {
            best = key;
            found = true;
        }
    }
    wh_sandbox_charge(L, seen);
    if (!found) {
        lua_pushnil(L);
        return 1;
    }
    key_push(L, &best);
    lua_pushvalue(L, -1);
    lua_rawget(L, 1);
    return 2;
}

void wh_library_open_order(lua_State *L) {
    static const luaL_Reg functions[] = {{"pairs", order_pairs}, {"next", order_next}, {NULL, NULL}};
    lua_pushglobaltable(L);
    wh_library_set(L, functions);
    lua_pop(L, 1);
}
