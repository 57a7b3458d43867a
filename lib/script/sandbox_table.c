/* table: Lua's own functions, charged for each element that they touch, and a sort that is equal in each
 * run. Lua's own sort takes pivots from the clock. */
#include <limits.h>

#include "sandbox_internal.h"

/* Refuses __len, because it could give any length, and another one at the next call. */
static lua_Integer check_length(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    if (luaL_getmetafield(L, 1, "__len") != LUA_TNIL) {
        luaL_argerror(L, 1, "a table without __len expected");
    }
    return (lua_Integer)lua_rawlen(L, 1);
}

static void charge_range(lua_State *L, lua_Integer first, lua_Integer last) {
    if (first <= last) {
        wh_sandbox_charge(L, (uint64_t)last - (uint64_t)first + 1);
    }
}

static int table_insert(lua_State *L) {
    const lua_Integer length = check_length(L);
    if (lua_gettop(L) == 3) {
        charge_range(L, luaL_checkinteger(L, 2), length);
    }
    return wh_library_call_stock(L);
}

static int table_remove(lua_State *L) {
    const lua_Integer length = check_length(L);
    charge_range(L, luaL_optinteger(L, 2, length), length);
    return wh_library_call_stock(L);
}

static int table_concat(lua_State *L) {
    const lua_Integer length = check_length(L);
    charge_range(L, luaL_optinteger(L, 3, 1), luaL_optinteger(L, 4, length));
    return wh_library_call_stock(L);
}

/* A range too large for the stack is not charged: Lua's own unpack refuses it at once. */
static int table_unpack(lua_State *L) {
    const lua_Integer length = check_length(L);
    const lua_Integer first = luaL_optinteger(L, 2, 1);
    const lua_Integer last = luaL_optinteger(L, 3, length);
    if (first <= last && (uint64_t)last - (uint64_t)first < INT_MAX) {
        charge_range(L, first, last);
    }
    return wh_library_call_stock(L);
}

static int table_move(lua_State *L) {
    charge_range(L, luaL_checkinteger(L, 2), luaL_checkinteger(L, 3));
    return wh_library_call_stock(L);
}

/* ----------------------------------------- sort: stable, bottom-up merging of runs between two work lists */

enum { ARG_TABLE = 1, ARG_LESS = 2, WORK_FROM = 3, WORK_TO = 4 };

/* True if the value at index a comes before the one at b. */
static bool is_before(lua_State *L, int a, int b) {
    if (lua_isnil(L, ARG_LESS)) {
        return lua_compare(L, a, b, LUA_OPLT);
    }
    lua_pushvalue(L, ARG_LESS);
    lua_pushvalue(L, a - 1);
    lua_pushvalue(L, b - 2);
    lua_call(L, 2, 1);
    const bool before = lua_toboolean(L, -1);
    lua_pop(L, 1);
    return before;
}

/* Merges [left, middle) and [middle, end) of one list into the other. If two values are equal the left one
 * goes first. */
static void merge(lua_State *L, int from, int to, lua_Integer left, lua_Integer middle, lua_Integer end) {
    lua_Integer right = middle;
    for (lua_Integer out = left; out < end; ++out) {
        bool take_right = left >= middle;
        if (left < middle && right < end) {
            lua_rawgeti(L, from, left);
            lua_rawgeti(L, from, right);
            take_right = is_before(L, -1, -2);
            lua_pop(L, 2);
        }
        lua_rawgeti(L, from, take_right ? right++ : left++);
        lua_rawseti(L, to, out);
    }
}

static lua_Integer at_most(lua_Integer value, lua_Integer limit) {
    return value < limit ? value : limit;
}

/* Returns the index of the work list that holds the result. */
static int merge_all(lua_State *L, lua_Integer count) {
    int from = WORK_FROM, to = WORK_TO;
    for (lua_Integer width = 1; width < count; width *= 2) {
        wh_sandbox_charge(L, (uint64_t)count);
        for (lua_Integer left = 1; left <= count; left += 2 * width) {
            const lua_Integer end = count + 1;
            merge(L, from, to, left, at_most(left + width, end), at_most(left + 2 * width, end));
        }
        const int swapped = from;
        from = to;
        to = swapped;
    }
    return from;
}

static int table_sort(lua_State *L) {
    const lua_Integer count = check_length(L);
    lua_settop(L, 2);
    if (!lua_isnil(L, ARG_LESS)) {
        luaL_checktype(L, ARG_LESS, LUA_TFUNCTION);
    }
    charge_range(L, 1, count);
    luaL_argcheck(L, count < INT_MAX, 1, "array too big");
    lua_createtable(L, (int)count, 0);
    lua_createtable(L, (int)count, 0);
    for (lua_Integer i = 1; i <= count; ++i) {
        lua_geti(L, ARG_TABLE, i);
        lua_rawseti(L, WORK_FROM, i);
    }
    const int sorted = merge_all(L, count);
    for (lua_Integer i = 1; i <= count; ++i) {
        lua_rawgeti(L, sorted, i);
        lua_seti(L, ARG_TABLE, i);
    }
    return 0;
}

const luaL_Reg wh_library_table[] = {{"insert", table_insert},
                                     {"remove", table_remove},
                                     {"concat", table_concat},
                                     {"unpack", table_unpack},
                                     {"move", table_move},
                                     {"sort", table_sort},
                                     {NULL, NULL}};
