/* pairs and next in sorted order: the order of a hash table itself changes from run to run. */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "sandbox_internal.h"

#if LDBL_MANT_DIG < 64
#error "waferhand: keys are compared as long doubles, which must hold each whole number of Lua's"
#endif

/* A copy of a key. `text` points into the Lua string, which exists as long as its table keeps it. */
typedef struct {
    enum { RANK_NUMBER, RANK_STRING, RANK_BOOLEAN } rank;
    bool is_integer;
    union {
        long double number; /* also of a boolean: 0 or 1 */
        struct {
            const char *text;
            size_t length;
        } string;
    } as;
} order_key_t;

static void key_read(lua_State *L, int index, order_key_t *key) {
    memset(key, 0, sizeof *key);
    switch (lua_type(L, index)) {
    case LUA_TNUMBER:
        key->rank = RANK_NUMBER;
        key->is_integer = lua_isinteger(L, index);
        key->as.number =
            key->is_integer ? (long double)lua_tointeger(L, index) : (long double)lua_tonumber(L, index);
        return;
    case LUA_TSTRING:
        key->rank = RANK_STRING;
        key->as.string.text = lua_tolstring(L, index, &key->as.string.length);
        return;
    case LUA_TBOOLEAN:
        key->rank = RANK_BOOLEAN;
        key->as.number = lua_toboolean(L, index);
        return;
    default:
        luaL_error(L, "a table with a %s for a key has no order to be read in", luaL_typename(L, index));
    }
}

static void key_push(lua_State *L, const order_key_t *key) {
    if (key->rank == RANK_STRING) {
        lua_pushlstring(L, key->as.string.text, key->as.string.length);
    } else if (key->rank == RANK_BOOLEAN) {
        lua_pushboolean(L, key->as.number > 0);
    } else if (key->is_integer) {
        lua_pushinteger(L, (lua_Integer)key->as.number);
    } else {
        lua_pushnumber(L, (lua_Number)key->as.number);
    }
}

/* Returns below 0, 0 or above 0, for qsort. */
static int key_compare(const void *one, const void *other) {
    const order_key_t *const a = one;
    const order_key_t *const b = other;
    if (a->rank != b->rank) {
        return a->rank < b->rank ? -1 : 1;
    }
    if (a->rank != RANK_STRING) {
        return (a->as.number > b->as.number) - (a->as.number < b->as.number);
    }
    const size_t one_length = a->as.string.length;
    const size_t other_length = b->as.string.length;
    const int order =
        memcmp(a->as.string.text, b->as.string.text, one_length < other_length ? one_length : other_length);
    return order != 0 ? order : (one_length > other_length) - (one_length < other_length);
}

/* -------------------------------------------------------------------------------------------------- pairs */

/* A search for keys also visits empty slots; a table that was once large has many of them. */
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

/* Upvalues: the keys, and the number of visited ones. Arguments: the table and the last key; nil begins
 * again. */
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
    wh_params_fill(L, 1);
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
    wh_params_fill(L, 1);
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

const luaL_Reg wh_library_order[] = {{"pairs", order_pairs}, {"next", order_next}, {NULL, NULL}};
