/* Values from Lua, refused with the name of the field, and values to Lua. */
#include <string.h>

#include "wh_module_values.h"

void wh_lua_take_at_most(lua_State *L, int count) {
    for (int i = count + 1; i <= lua_gettop(L); ++i) {
        if (!lua_isnil(L, i)) {
            luaL_argerror(L, i, lua_pushfstring(L, "one too many (expected at most %d)", count));
        }
    }
    lua_settop(L, count);
}

const char *wh_lua_word(lua_State *L, int index) {
    size_t length = 0;
    const char *text = lua_type(L, index) == LUA_TSTRING ? lua_tolstring(L, index, &length) : "";
    return strlen(text) == length ? text : "";
}

const char *wh_lua_whole_text(lua_State *L, int index) {
    size_t length = 0;
    const char *text = lua_tolstring(L, index, &length);
    if (!text || strlen(text) == length) {
        return text;
    }
    const int place = lua_absindex(L, index);
    luaL_Buffer whole;
    luaL_buffinit(L, &whole);
    for (const char *end = text + length; text < end; ++text) {
        luaL_addlstring(&whole, *text ? text : "\\x00", *text ? 1 : 4);
    }
    luaL_pushresult(&whole);
    lua_replace(L, place);
    return lua_tostring(L, place);
}

/* -------------------------------------------------------------------------------------- fields and errors */

/* It goes from the leaf to the root: each step puts one more part before the rest. */
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

/* The keys that a table may have: one of the names, or 1 to count. */
typedef struct {
    const char *const *names; /* null: no names */
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
    while (*name && strcmp(*name, wh_lua_word(L, key)) != 0) {
        ++name;
    }
    return *name != NULL;
}

/* An order of keys: if several keys are wrong, one fixed key is named, whatever lua_next's order. */
static bool precedes(lua_State *L, int key, int other) {
    const int type = lua_type(L, key);
    if (type != lua_type(L, other)) {
        return lua_isnil(L, other) || type < lua_type(L, other);
    }
    return (type == LUA_TNUMBER || type == LUA_TSTRING) && lua_compare(L, key, other, LUA_OPLT);
}

/* Pushes the first key that is not allowed, or nil. */
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
    return wh_lua_field(of, lua_type(L, -2) == LUA_TSTRING ? wh_lua_whole_text(L, -2) : type);
}

static const char *push_names(lua_State *L, const char *const *names) {
    lua_pushstring(L, *names);
    while (*++names) {
        lua_pushfstring(L, "%s, %s", lua_tostring(L, -1), *names);
        lua_remove(L, -2);
    }
    return lua_tostring(L, -1);
}

static void check_keys(lua_State *L, int index, const wh_field_t *at, const keys_t *keys) {
    if (!lua_istable(L, index)) {
        lua_pushvalue(L, index);
        refuse_type(L, at, "table");
    }
    push_stranger(L, index, keys);
    if (!lua_isnil(L, -1)) {
        const wh_field_t stranger = key_field(L, at);
        if (keys->names) {
            wh_lua_refuse(L, &stranger, "no such field (expected %s)", push_names(L, keys->names));
        }
        wh_lua_refuse(L, &stranger, "no such entry (expected a list of %I)", (LUAI_UACINT)keys->count);
    }
    lua_pop(L, 1);
}

void wh_lua_check_record(lua_State *L, int index, const wh_field_t *at, const char *const *names) {
    check_keys(L, index, at, &(keys_t){names, 0});
}

void wh_lua_check_list(lua_State *L, int index, const wh_field_t *at, lua_Integer count) {
    check_keys(L, index, at, &(keys_t){NULL, count});
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

/* ----------------------------------------------------------------------------------- poses and tolerances */

static void take_triple(lua_State *L, const wh_field_t *at, wh_real_t triple[3]) {
    const int list = lua_gettop(L);
    wh_lua_check_list(L, list, at, 3);
    for (int i = 0; i < 3; ++i) {
        const wh_field_t entry = wh_lua_entry(at, i + 1);
        lua_geti(L, list, i + 1);
        triple[i] = wh_lua_take_number(L, &entry);
    }
    lua_pop(L, 1);
}

static void take_matrix(lua_State *L, const wh_field_t *at, wh_mat3_t *matrix) {
    const int list = lua_gettop(L);
    wh_lua_check_list(L, list, at, 3);
    for (int i = 0; i < 3; ++i) {
        const wh_field_t row = wh_lua_entry(at, i + 1);
        lua_geti(L, list, i + 1);
        take_triple(L, &row, matrix->m[i]);
    }
    lua_pop(L, 1);
}

void wh_lua_take_pose(lua_State *L, const wh_field_t *at, wh_pose_t *pose) {
    static const char *const names[] = {"r", "R", NULL};
    const wh_field_t r = wh_lua_field(at, "r");
    const wh_field_t R = wh_lua_field(at, "R");
    const int table = lua_gettop(L);
    wh_real_t position[3];
    wh_lua_check_record(L, table, at, names);
    lua_getfield(L, table, "r");
    take_triple(L, &r, position);
    pose->r = wh_vec3(position[0], position[1], position[2]);
    if (lua_getfield(L, table, "R") == LUA_TNIL) {
        pose->R = wh_mat3_identity();
        lua_pop(L, 1);
    } else {
        take_matrix(L, &R, &pose->R);
    }
    lua_pop(L, 1);
}

void wh_lua_take_valid_pose(lua_State *L, const wh_field_t *at, wh_pose_t *pose) {
    wh_lua_take_pose(L, at, pose);
    const wh_status_t status = wh_pose_validate(pose);
    if (status != WH_OK) {
        wh_lua_refuse_pose(L, at, pose, status);
    }
}

static wh_tolerance_t find_preset(lua_State *L, const wh_field_t *at) {
    const char *name = wh_lua_word(L, -1);
    wh_tolerance_t tolerance;
    for (size_t i = 0; i < WH_TOLERANCE_PRESETS; ++i) {
        if (strcmp(wh_tolerance_preset(i, &tolerance), name) == 0) {
            return tolerance;
        }
    }
    wh_lua_refuse(L, at, "\"%s\" (expected \"paper\", \"strict\" or a table)", wh_lua_whole_text(L, -1));
    return wh_tolerance_paper();
}

static wh_tolerance_t read_limits(lua_State *L, const wh_field_t *at) {
    static const char *const names[] = {"projz", "projxy", "planar", NULL};
    const int table = lua_gettop(L);
    const wh_tolerance_t paper = wh_tolerance_paper();
    wh_tolerance_t t;
    wh_lua_check_record(L, table, at, names);
    t.projz = wh_lua_get_number(L, table, at, "projz", paper.projz);
    t.projxy = wh_lua_get_number(L, table, at, "projxy", paper.projxy);
    t.planar = wh_lua_get_number(L, table, at, "planar", paper.planar);
    const wh_status_t status = wh_tolerance_validate(&t);
    if (status != WH_OK) {
        wh_lua_refuse(L, at,
                      "projz %f, projxy %f, planar %f (expected projz in (0, 1e6], projxy in [1e-6, 1e6], "
                      "planar in [0, 1)) [%d]",
                      t.projz, t.projxy, t.planar, (int)status);
    }
    return t;
}

wh_tolerance_t wh_lua_take_tolerance(lua_State *L, const wh_field_t *at) {
    wh_tolerance_t tolerance = wh_tolerance_paper();
    switch (lua_type(L, -1)) {
    case LUA_TNIL:
        break;
    case LUA_TSTRING:
        tolerance = find_preset(L, at);
        break;
    case LUA_TTABLE:
        tolerance = read_limits(L, at);
        break;
    default:
        wh_lua_refuse(L, at, "table or a preset's name expected, got %s", luaL_typename(L, -1));
    }
    lua_pop(L, 1);
    return tolerance;
}

/* ------------------------------------------------------------------------------------------------- to Lua */

void wh_lua_set_number(lua_State *L, const char *name, wh_real_t value) {
    lua_pushnumber(L, value);
    lua_setfield(L, -2, name);
}

void wh_lua_set_integer(lua_State *L, const char *name, int64_t value) {
    lua_pushinteger(L, value);
    lua_setfield(L, -2, name);
}

void wh_lua_set_boolean(lua_State *L, const char *name, bool value) {
    lua_pushboolean(L, value);
    lua_setfield(L, -2, name);
}

void wh_lua_set_text(lua_State *L, const char *name, const char *text) {
    lua_pushstring(L, text);
    lua_setfield(L, -2, name);
}

void wh_lua_push_index(lua_State *L, int32_t index) {
    if (index == WH_NONE) {
        lua_pushnil(L);
    } else {
        lua_pushinteger(L, (lua_Integer)index + 1);
    }
}

void wh_lua_set_index(lua_State *L, const char *name, int32_t index) {
    wh_lua_push_index(L, index);
    lua_setfield(L, -2, name);
}

void wh_lua_push_numbers(lua_State *L, const wh_real_t numbers[], size_t count) {
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; ++i) {
        lua_pushnumber(L, numbers[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

void wh_lua_set_triple(lua_State *L, const char *name, const wh_vec3_t *v) {
    const wh_real_t entries[3] = {v->x, v->y, v->z};
    wh_lua_push_numbers(L, entries, 3);
    lua_setfield(L, -2, name);
}

void wh_lua_push_pose(lua_State *L, const wh_pose_t *pose) {
    lua_createtable(L, 0, 2);
    wh_lua_set_triple(L, "r", &pose->r);
    lua_createtable(L, 3, 0);
    for (size_t i = 0; i < 3; ++i) {
        wh_lua_push_numbers(L, pose->R.m[i], 3);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "R");
}

void wh_lua_push_tolerance(lua_State *L, const wh_tolerance_t *tolerance) {
    lua_createtable(L, 0, 3);
    wh_lua_set_number(L, "projz", tolerance->projz);
    wh_lua_set_number(L, "projxy", tolerance->projxy);
    wh_lua_set_number(L, "planar", tolerance->planar);
}

static void set_failed(lua_State *L, unsigned failed) {
    static const struct {
        unsigned bit;
        const char *name;
    } limits[] = {{WH_FAILED_PROJZ, "projz"}, {WH_FAILED_PROJXY, "projxy"}, {WH_FAILED_PLANAR, "planar"}};
    lua_newtable(L);
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; ++i) {
        if (failed & limits[i].bit) {
            wh_lua_set_boolean(L, limits[i].name, true);
        }
    }
    lua_setfield(L, -2, "failed");
}

void wh_lua_push_proximity(lua_State *L, const wh_proximity_t *p) {
    const wh_tolerance_t margin = {p->margin_projz, p->margin_projxy, p->margin_planar};
    lua_createtable(L, 0, 14);
    wh_lua_set_triple(L, "dr", &p->dr);
    wh_lua_set_number(L, "n1_proj_n2", p->n1_proj_n2);
    wh_lua_set_number(L, "dr_proj_z", p->dr_proj_z);
    wh_lua_set_triple(L, "dr_proj_xy", &p->dr_proj_xy);
    wh_lua_set_number(L, "dr_proj_xy_norm", p->dr_proj_xy_norm);
    wh_lua_set_boolean(L, "ready", p->ready);
    set_failed(L, p->failed);
    wh_lua_push_tolerance(L, &margin);
    lua_setfield(L, -2, "margin");
}

void wh_lua_push_event(lua_State *L, const wh_event_t *event) {
    wh_lua_push_proximity(L, &event->measured);
    wh_lua_set_text(L, "kind", wh_event_name(event->kind));
    wh_lua_set_integer(L, "slice", (int64_t)event->slice);
    wh_lua_set_integer(L, "measured_slice", (int64_t)event->measured_slice);
    wh_lua_set_index(L, "wafer", event->wafer);
    wh_lua_set_index(L, "gripper", event->gripper);
    if (event->kind == WH_EVENT_HANDED_OVER) {
        wh_lua_set_index(L, "from", event->other);
    } else if (event->kind == WH_EVENT_CONTESTED) {
        wh_lua_set_index(L, "holder", event->other);
    }
}
