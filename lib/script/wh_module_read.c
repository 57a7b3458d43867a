#include <string.h>

#include "wh_module_internal.h"

/* From the leaf to the root, each step putting one more part before the rest. */
static const char *push_path(lua_State *L, const wh_field_t *at) {
    lua_pushliteral(L, "");
    for (; at; at = at->of) {
        const char *rest = lua_tostring(L, -1);
        if (!at->name) {
            lua_pushfstring(L, "[%I]%s", (LUAI_UACINT)at->index, rest);
        } else {
            const char *dot = at->of && (at->of->of || at->of->name[0]) ? "." : "";
            lua_pushfstring(L, "%s%s%s", dot, at->name, rest);
        }
        lua_remove(L, -2);
    }
    return lua_tostring(L, -1);
}

int wh_lua_refuse(lua_State *L, const wh_field_t *at, const char *what, ...) {
    va_list arguments;
    va_start(arguments, what);
    const char *text = lua_pushvfstring(L, what, arguments);
    va_end(arguments);
    const char *path = push_path(L, at);
    if (path[0]) {
        text = lua_pushfstring(L, "%s: %s", path, text);
    }
    while (at->of) {
        at = at->of;
    }
    return luaL_argerror(L, (int)at->index, text);
}

static void refuse_type(lua_State *L, const wh_field_t *at, const char *expected) {
    wh_lua_refuse(L, at, "%s expected, got %s", expected, luaL_typename(L, -1));
}

static void check_finite(lua_State *L, const wh_field_t *at, const wh_vec3_t *v) {
    const wh_real_t entries[3] = {v->x, v->y, v->z};
    for (int i = 0; i < 3; ++i) {
        if (!wh_real_is_finite(entries[i])) {
            const wh_field_t entry = wh_lua_entry(at, i + 1);
            const wh_status_t status = WH_STATUS_NOT_FINITE;
            wh_lua_refuse(L, &entry, "%f (%s) [%d]", entries[i], wh_status_text(status), (int)status);
        }
    }
}

int wh_lua_refuse_pose(lua_State *L, const wh_field_t *at, const wh_pose_t *pose, wh_status_t status) {
    if (status == WH_STATUS_NOT_FINITE) {
        const wh_field_t r = wh_lua_field(at, "r");
        const wh_field_t R = wh_lua_field(at, "R");
        check_finite(L, &r, &pose->r);
        for (size_t i = 0; i < 3; ++i) {
            const wh_field_t row = wh_lua_entry(&R, (lua_Integer)i + 1);
            const wh_vec3_t numbers = wh_mat3_row(&pose->R, i);
            check_finite(L, &row, &numbers);
        }
    }
    return wh_lua_refuse(L, at, "%s [%d]", wh_status_text(status), (int)status);
}

/* What a table's own keys may be: one of the names, or 1 to count. */
typedef struct {
    const char *const *names; /* null: none */
    lua_Integer count;
} keys_t;

static bool is_expected(lua_State *L, int key, const keys_t *keys) {
    if (lua_isinteger(L, key)) {
        const lua_Integer index = lua_tointeger(L, key);
        return index >= 1 && index <= keys->count;
    }
    if (!keys->names || lua_type(L, key) != LUA_TSTRING) {
        return false;
    }
    const char *const *name = keys->names;
    while (*name && strcmp(*name, lua_tostring(L, key)) != 0) {
        ++name;
    }
    return *name != NULL;
}

/* An order among keys, so that of several wrong ones always the same is named, whatever lua_next's order. */
static bool precedes(lua_State *L, int key, int other) {
    const int type = lua_type(L, key);
    if (type != lua_type(L, other)) {
        return lua_isnil(L, other) || type < lua_type(L, other);
    }
    return (type == LUA_TNUMBER || type == LUA_TSTRING) && lua_compare(L, key, other, LUA_OPLT);
}

/* Pushes the first key that should not be there, or nil. */
static void push_stranger(lua_State *L, int index, const keys_t *keys) {
    lua_pushnil(L);
    const int stranger = lua_gettop(L);
    lua_pushnil(L);
    while (lua_next(L, index)) {
        lua_pop(L, 1);
        const int key = stranger + 1;
        if (!is_expected(L, key, keys) && precedes(L, key, stranger)) {
            lua_copy(L, key, stranger);
        }
    }
}

static wh_field_t key_field(lua_State *L, const wh_field_t *of) {
    if (lua_isinteger(L, -1)) {
        return wh_lua_entry(of, lua_tointeger(L, -1));
    }
    const char *type = lua_pushfstring(L, "(a %s as key)", luaL_typename(L, -1));
    return wh_lua_field(of, lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : type);
}

static const char *push_names(lua_State *L, const char *const *names) {
    lua_pushstring(L, *names);
    while (*++names) {
        lua_pushfstring(L, "%s, %s", lua_tostring(L, -1), *names);
        lua_remove(L, -2);
    }
    return lua_tostring(L, -1);
}

static void check_table(lua_State *L, int index, const wh_field_t *at) {
    if (!lua_istable(L, index)) {
        lua_pushvalue(L, index);
        refuse_type(L, at, "table");
    }
}

void wh_lua_check_record(lua_State *L, int index, const wh_field_t *at, const char *const *names) {
    const keys_t keys = {names, 0};
    check_table(L, index, at);
    push_stranger(L, index, &keys);
    if (!lua_isnil(L, -1)) {
        const wh_field_t stranger = key_field(L, at);
        wh_lua_refuse(L, &stranger, "no such field (expected %s)", push_names(L, names));
    }
    lua_pop(L, 1);
}

void wh_lua_check_list(lua_State *L, int index, const wh_field_t *at, lua_Integer count) {
    const keys_t keys = {NULL, count};
    check_table(L, index, at);
    push_stranger(L, index, &keys);
    if (!lua_isnil(L, -1)) {
        const wh_field_t stranger = key_field(L, at);
        wh_lua_refuse(L, &stranger, "no such entry (expected a list of %I)", (LUAI_UACINT)count);
    }
    lua_pop(L, 1);
}

wh_real_t wh_lua_take_number(lua_State *L, const wh_field_t *at) {
    if (lua_type(L, -1) != LUA_TNUMBER) {
        refuse_type(L, at, "number");
    }
    const wh_real_t number = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return number;
}

lua_Integer wh_lua_take_integer(lua_State *L, const wh_field_t *at, lua_Integer first, lua_Integer last,
                                const char *expected) {
    if (lua_type(L, -1) != LUA_TNUMBER) {
        refuse_type(L, at, "number");
    }
    int whole;
    const lua_Integer integer = lua_tointegerx(L, -1, &whole);
    if (!whole || integer < first || integer > last) {
        wh_lua_refuse(L, at, "%s (expected %s)", luaL_tolstring(L, -1, NULL), expected);
    }
    lua_pop(L, 1);
    return integer;
}

size_t wh_lua_take_index(lua_State *L, const wh_field_t *at, size_t count) {
    const char *expected = lua_pushfstring(L, "1 to %I", (LUAI_UACINT)count);
    lua_insert(L, -2);
    const lua_Integer index = wh_lua_take_integer(L, at, 1, (lua_Integer)count, expected);
    lua_pop(L, 1);
    return (size_t)index - 1;
}

wh_real_t wh_lua_get_number(lua_State *L, int index, const wh_field_t *of, const char *name,
                            wh_real_t otherwise) {
    const wh_field_t field = wh_lua_field(of, name);
    if (lua_getfield(L, index, name) == LUA_TNIL) {
        lua_pop(L, 1);
        return otherwise;
    }
    return wh_lua_take_number(L, &field);
}
