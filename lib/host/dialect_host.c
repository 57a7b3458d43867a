/* The table `host` of a dialect's functions: names and units by the dialect's own tables, and refusals. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <lauxlib.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../record/record.h"
#include "../script/wh_module_values.h"
#include "dialect.h"
#include "values.h"

/* Above all numbers of errors. */
#define NUMBERS 128

/* Raises a refusal by one of our errors. */
static int refuse_by(lua_State *L, wh_status_t number, const char *detail) {
    lua_createtable(L, 0, 2);
    wh_lua_set_integer(L, "refused", number);
    wh_lua_set_text(L, "detail", detail);
    return lua_error(L);
}

/* host.refuse(name [, detail [, code]]): the request is refused by our error of this name; the host is told
 * the code of the dialect's table, or this one. */
static int refuse_request(lua_State *L) {
    const char *name = luaL_checkstring(L, 1);
    int number = 1;
    while (number < NUMBERS && strcmp(wh_status_name((wh_status_t)number), name) != 0) {
        ++number;
    }
    luaL_argcheck(L, number < NUMBERS, 1, "no name of our errors");
    size_t length = 0;
    const char *detail = luaL_optlstring(L, 2, "", &length);
    const char *code = luaL_optstring(L, 3, "");
    lua_createtable(L, 0, 3);
    wh_lua_set_integer(L, "refused", number);
    (void)lua_pushlstring(L, detail, length); /* which may have any bytes */
    lua_setfield(L, -2, "detail");
    wh_lua_set_text(L, "code", code);
    return lua_error(L);
}

/* Pushes the entry of the dialect's table of that name for the word at index 1; without such a table, the
 * word itself. */
static void push_ours(lua_State *L, const char *table, wh_status_t number) {
    const char *theirs = luaL_tolstring(L, 1, NULL);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    if (lua_isnil(L, -1) || lua_getfield(L, -1, table) == LUA_TNIL) {
        lua_pushstring(L, theirs);
    } else if (lua_getfield(L, -1, theirs) == LUA_TNIL) {
        (void)refuse_by(L, number, theirs);
    }
}

/* Pushes the name on top of the stack as it is typed at the prompt. */
static int push_spelt(lua_State *L, wh_status_t number) {
    char spelt[WH_DIALECT_LINE_BYTES];
    const char *name = lua_tostring(L, -1);
    if (!wh_value_spell(name, spelt, sizeof spelt)) {
        return refuse_by(L, number, name);
    }
    lua_pushstring(L, spelt);
    return 1;
}

/* host.station(theirs), host.arm(theirs), host.door(theirs): our name as it is typed. Refuses one that is not
 * in the table. */
static int our_station(lua_State *L) {
    push_ours(L, "stations", WH_STATUS_NO_SUCH_STATION);
    return push_spelt(L, WH_STATUS_NO_SUCH_STATION);
}

static int our_arm(lua_State *L) {
    push_ours(L, "arms", WH_STATUS_NO_SUCH_GRIPPER);
    return push_spelt(L, WH_STATUS_NO_SUCH_GRIPPER);
}

static int our_door(lua_State *L) {
    push_ours(L, "doors", WH_STATUS_BAD_ARGUMENT);
    return push_spelt(L, WH_STATUS_BAD_ARGUMENT);
}

/* host.typed(name): a name of a wafer or of what was saved, as it is typed. An empty one names nothing. */
static int name_as_typed(lua_State *L) {
    size_t length = 0;
    (void)luaL_tolstring(L, 1, &length);
    if (length == 0) {
        return refuse_by(L, WH_STATUS_BAD_ARGUMENT, "no name");
    }
    return push_spelt(L, WH_STATUS_BAD_ARGUMENT);
}

static const wh_dialect_t *find_self(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_self_key);
    const wh_dialect_t *dialect = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return dialect;
}

/* host.unit(otherwise): the address that this controller was given on its line; without one `otherwise`. */
static int own_unit(lua_State *L) {
    const char *unit = find_self(L)->place.unit;
    lua_settop(L, 1);
    if (unit) {
        lua_pushstring(L, unit);
    }
    return 1;
}

/* host.mechanism(otherwise): our name of the robot or station that this controller stands for, as it is
 * typed. One that stands for several has `otherwise`; without that it is refused. */
static int own_mechanism(lua_State *L) {
    const wh_dialect_t *dialect = find_self(L);
    const bool is_robot = dialect->mechanism == WH_MECHANISM_ROBOT;
    const wh_status_t refusal = is_robot ? WH_STATUS_NO_SUCH_ROBOT : WH_STATUS_NO_SUCH_STATION;
    if (!dialect->place.stands_for && !lua_isnoneornil(L, 1)) {
        lua_settop(L, 1);
        return 1;
    }
    if (!dialect->place.stands_for) {
        return refuse_by(L, refusal, "this controller stands for several (expected --mechanism)");
    }
    lua_pushstring(L, dialect->place.stands_for);
    return push_spelt(L, refusal);
}

/* The number at index 1, which may be a text: digits, a sign and a point, for hosts write no others. */
static double take_number(lua_State *L) {
    int is_number = 0;
    const double value = lua_tonumberx(L, 1, &is_number);
    const char *text = lua_type(L, 1) == LUA_TSTRING ? lua_tostring(L, 1) : "";
    if (!is_number || !isfinite(value) || text[strspn(text, " +-.0123456789")] != '\0') {
        (void)refuse_by(L, WH_STATUS_BAD_ARGUMENT, luaL_tolstring(L, 1, NULL));
    }
    return value;
}

/* The field of a table of the dialect's, or `otherwise`. */
static double number_of(lua_State *L, const char *table, const char *field, double otherwise) {
    double value = otherwise;
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    if (lua_istable(L, -1) && lua_getfield(L, -1, table) == LUA_TTABLE) {
        lua_getfield(L, -1, field);
        value = lua_isnumber(L, -1) ? lua_tonumber(L, -1) : otherwise;
    }
    lua_settop(L, 1);
    return value;
}

/* host.slot(theirs): the slot as we count it, from 1. */
static int our_slot(lua_State *L) {
    const double theirs = take_number(L);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    lua_getfield(L, -1, "first_slot");
    const double first = lua_isnumber(L, -1) ? lua_tonumber(L, -1) : 1;
    if (theirs != floor(theirs) || fabs(theirs) > 1e6) {
        return refuse_by(L, WH_STATUS_NO_SUCH_SLOT, luaL_tolstring(L, 1, NULL));
    }
    lua_pushinteger(L, (lua_Integer)(theirs - first) + 1);
    return 1;
}

/* The sign, 1 or -1, that the dialect's `signs` give the axis named at index 2; 1 if none is named. */
static double sign_at(lua_State *L) {
    static const char *const axes[] = {"theta", "r", "z", "yaw", "", NULL};
    const char *axis = axes[luaL_checkoption(L, 2, "", axes)];
    return number_of(L, "signs", axis, 1);
}

/* host.mm(theirs, axis), host.degrees(theirs, axis): ours; host.length(mm, axis), host.angle(degrees, axis):
 * theirs. With an axis its sign counts. */
static int our_mm(lua_State *L) {
    const double sign = sign_at(L);
    lua_pushnumber(L, sign * take_number(L) * number_of(L, "units", "length", 1) + 0.0);
    return 1;
}

static int our_degrees(lua_State *L) {
    const double sign = sign_at(L);
    lua_pushnumber(L, sign * take_number(L) * number_of(L, "units", "angle", 1) + 0.0);
    return 1;
}

static int their_length(lua_State *L) {
    const double sign = sign_at(L);
    lua_pushnumber(L, sign * take_number(L) / number_of(L, "units", "length", 1) + 0.0);
    return 1;
}

static int their_angle(lua_State *L) {
    const double sign = sign_at(L);
    lua_pushnumber(L, sign * take_number(L) / number_of(L, "units", "angle", 1) + 0.0);
    return 1;
}

/* host.code(number): theirs of one of our errors; nil of none. */
static int their_code(lua_State *L) {
    const lua_Integer number = luaL_checkinteger(L, 1);
    if (number == WH_OK) {
        lua_pushnil(L);
        return 1;
    }
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    if (lua_getfield(L, -1, "errors") != LUA_TTABLE ||
        lua_getfield(L, -1, wh_status_name((wh_status_t)number)) == LUA_TNIL) {
        lua_getfield(L, 2, "other_error");
    }
    return 1;
}

/* Pushes "alarm 9 (expected one of 0101, 0102, ...)"; the table of errors is at index 2. */
static int refuse_alarm(lua_State *L, const char *theirs) {
    luaL_Buffer text;
    lua_Integer count = 0;
    lua_newtable(L);
    for (int number = 1; number < NUMBERS; ++number) {
        if (lua_getfield(L, 2, wh_status_name((wh_status_t)number)) != LUA_TNIL) {
            (void)luaL_tolstring(L, -1, NULL);
            lua_rawseti(L, 3, ++count);
        }
        lua_settop(L, 3);
    }
    luaL_buffinit(L, &text);
    luaL_addstring(&text, "alarm ");
    luaL_addstring(&text, theirs);
    luaL_addstring(&text, " (expected one of ");
    for (lua_Integer i = 1; i <= count; ++i) {
        luaL_addstring(&text, i > 1 ? ", " : "");
        lua_rawgeti(L, 3, i);
        luaL_addvalue(&text);
    }
    luaL_addstring(&text, ")");
    luaL_pushresult(&text);
    return refuse_by(L, WH_STATUS_BAD_ARGUMENT, lua_tostring(L, -1));
}

/* host.alarm(theirs): the number of our error that has this code; the first one, if several have. Refuses a
 * code that is not in the table. */
static int find_alarm(lua_State *L) {
    char theirs[WH_DIALECT_NAME_BYTES];
    (void)snprintf(theirs, sizeof theirs, "%s", luaL_tolstring(L, 1, NULL));
    lua_settop(L, 0);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    if (lua_isnil(L, 1) || lua_getfield(L, 1, "errors") != LUA_TTABLE) {
        lua_settop(L, 1);
        lua_newtable(L);
    }
    for (int number = 1; number < NUMBERS; ++number) {
        const bool is_there = lua_getfield(L, 2, wh_status_name((wh_status_t)number)) != LUA_TNIL;
        if (is_there && strcmp(luaL_tolstring(L, -1, NULL), theirs) == 0) {
            lua_pushinteger(L, number);
            return 1;
        }
        lua_settop(L, 2);
    }
    return refuse_alarm(L, theirs);
}

/* host.name(table, ours): their name of one of our "stations", "arms" or "doors"; ours where
 * there is no such table; nil where it has none. */
static int their_name(lua_State *L) {
    const char *table = luaL_checkstring(L, 1);
    const char *ours = luaL_checkstring(L, 2);
    lua_settop(L, 2);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    if (lua_getfield(L, -1, table) != LUA_TTABLE) {
        lua_pushstring(L, ours);
        return 1;
    }
    lua_pushnil(L); /* the first of their names, if there are several */
    for (lua_pushnil(L); lua_next(L, 4) != 0; lua_pop(L, 1)) {
        const bool is_it = lua_type(L, -2) == LUA_TSTRING && lua_type(L, -1) == LUA_TSTRING &&
                           strcmp(lua_tostring(L, -1), ours) == 0;
        if (is_it && (lua_isnil(L, 5) || strcmp(lua_tostring(L, -2), lua_tostring(L, 5)) < 0)) {
            lua_pushvalue(L, -2);
            lua_replace(L, 5);
        }
    }
    return 1;
}

/* ------------------------------------------------------------------------------------ the layout's places */

static const wh_layout_t *find_layout(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_layout_key);
    const wh_layout_t *layout = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return layout;
}

static void push_point(lua_State *L, const wh_pose_t *pose) {
    lua_createtable(L, 0, 4);
    wh_lua_set_number(L, "x", pose->r.x);
    wh_lua_set_number(L, "y", pose->r.y);
    wh_lua_set_number(L, "z", pose->r.z);
    wh_lua_set_number(L, "yaw", wh_atan2(pose->R.m[1][0], pose->R.m[0][0]) * 180 / WH_PI);
}

/* The station with this name as it is typed; the count: there is none. */
static size_t find_spelt_station(const wh_layout_t *layout, const char *name) {
    char spelt[WH_DIALECT_LINE_BYTES];
    size_t s = 0;
    while (s < layout->station_count &&
           (!wh_value_spell(layout->stations[s].name, spelt, sizeof spelt) || strcmp(spelt, name) != 0)) {
        ++s;
    }
    return s;
}

/* host.pose(station, slot): x, y, z (mm) and yaw (degrees) of a slot, by our name as host.station gives it.
 * Refuses what is not there. Without a cell, as in `waferhand dialect`, all are 0. */
static int slot_pose(lua_State *L) {
    const wh_layout_t *layout = find_layout(L);
    const char *name = luaL_checkstring(L, 1);
    const lua_Integer slot = luaL_optinteger(L, 2, 1);
    wh_pose_t pose = {.R = wh_mat3_identity()};
    if (layout) {
        const size_t s = find_spelt_station(layout, name);
        if (s == layout->station_count) {
            return refuse_by(L, WH_STATUS_NO_SUCH_STATION, name);
        }
        if (slot < 1 || slot > layout->places[s].slots) {
            return refuse_by(L, WH_STATUS_NO_SUCH_SLOT, luaL_tolstring(L, 2, NULL));
        }
        pose = wh_station_slot(&layout->places[s], (int32_t)slot);
    }
    push_point(L, &pose);
    return 1;
}

/* host.forward(axes): where the first gripper is with these axes of the first robot, by name, degrees and mm;
 * others are at home. Without a cell all are 0. */
static int find_forward(lua_State *L) {
    const wh_layout_t *layout = find_layout(L);
    wh_real_t axes[WH_AXES];
    wh_pose_t poses[WH_GRIPPERS] = {{.R = wh_mat3_identity()}};
    luaL_checktype(L, 1, LUA_TTABLE);
    if (layout) {
        const wh_machine_t *machine = &layout->machine;
        wh_machine_home(machine, axes);
        for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
            size_t own;
            if (wh_machine_robot_of(machine, axis, &own) == 0 &&
                lua_getfield(L, 1, wh_axis_name(machine, axis)) == LUA_TNUMBER) {
                const double value = lua_tonumber(L, -1);
                axes[axis] = wh_axis_turns(machine, axis) ? value * WH_PI / 180 : value;
            }
            lua_settop(L, 1);
        }
        wh_machine_grippers(machine, axes, poses);
    }
    push_point(L, &poses[0]);
    return 1;
}

/* host.nearest(x, y, z): the slot nearest to a point, mm: { station = , slot = , distance = }; the first one
 * of several. Without a cell nil. */
static int find_nearest(lua_State *L) {
    const wh_layout_t *layout = find_layout(L);
    const wh_vec3_t point = {luaL_checknumber(L, 1), luaL_checknumber(L, 2), luaL_checknumber(L, 3)};
    char spelt[WH_DIALECT_LINE_BYTES] = "";
    double least = INFINITY;
    int32_t station = WH_NONE;
    int32_t nearest = 0;
    for (size_t s = 0; layout && s < layout->station_count; ++s) {
        for (int32_t slot = 1; slot <= layout->places[s].slots; ++slot) {
            const wh_pose_t pose = wh_station_slot(&layout->places[s], slot);
            const wh_vec3_t way = wh_vec3_subtract(&pose.r, &point);
            const double square = wh_vec3_dot(&way, &way);
            if (square < least) {
                least = square;
                station = (int32_t)s;
                nearest = slot;
            }
        }
    }
    if (station == WH_NONE || !wh_value_spell(layout->stations[station].name, spelt, sizeof spelt)) {
        lua_pushnil(L);
        return 1;
    }
    lua_createtable(L, 0, 3);
    wh_lua_set_text(L, "station", spelt);
    wh_lua_set_integer(L, "slot", nearest);
    wh_lua_set_number(L, "distance", sqrt(least));
    return 1;
}

void wh_dialect_show(wh_dialect_t *dialect, const wh_layout_t *layout) {
    lua_State *L = wh_sandbox_state(dialect->sandbox);
    union {
        const wh_layout_t *shown;
        void *kept;
    } held = {layout};
    lua_pushlightuserdata(L, held.kept);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &wh_dialect_layout_key);
}

/* ------------------------------------------------------------------------------------- the layout's names */

/* The layout's name of this number; null: no more. */
typedef const char *(*name_at_t)(const wh_layout_t *layout, size_t i);

static const char *station_at(const wh_layout_t *layout, size_t i) {
    return i < layout->station_count ? layout->stations[i].name : NULL;
}

static const char *gripper_at(const wh_layout_t *layout, size_t i) {
    return i < layout->machine.gripper_count ? layout->grippers[i].name : NULL;
}

static const char *door_at(const wh_layout_t *layout, size_t i) {
    return i < layout->machine.door_count ? layout->door_list[i].name : NULL;
}

/* A table of the dialect, and the things of the layout that it names. */
typedef struct {
    wh_dialect_t *dialect;
    const wh_layout_t *layout;
    const char *table;
    name_at_t name_at;
} naming_t;

static bool has_name(const naming_t *naming, const char *wanted) {
    const char *found = naming->name_at(naming->layout, 0);
    for (size_t i = 1; found && strcmp(found, wanted) != 0; ++i) {
        found = naming->name_at(naming->layout, i);
    }
    return found;
}

static bool refuse_name(const naming_t *naming, const char *theirs, const char *ours) {
    char text[WH_SANDBOX_MESSAGE_BYTES];
    size_t length = (size_t)snprintf(text, sizeof text,
                                     "%s.%.63s: \"%.63s\" (expected a name of the layout's: ", naming->table,
                                     theirs, ours);
    const char *name = naming->name_at(naming->layout, 0);
    for (size_t i = 1; name && length < sizeof text; name = naming->name_at(naming->layout, i++)) {
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%.63s", i > 1 ? ", " : "", name);
    }
    if (length < sizeof text) {
        (void)snprintf(text + length, sizeof text - length, ")");
    }
    wh_dialect_note(naming->dialect, text);
    return false;
}

static bool check_naming(lua_State *L, const naming_t *naming) {
    bool is_good = true;
    lua_settop(L, 0);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    lua_pushstring(L, naming->table);
    if (lua_rawget(L, 1) == LUA_TTABLE) {
        for (lua_pushnil(L); is_good && lua_next(L, 2) != 0; lua_settop(L, 3)) {
            const char *ours = lua_tostring(L, -1);
            is_good = has_name(naming, ours) || refuse_name(naming, lua_tostring(L, -2), ours);
        }
    }
    lua_settop(L, 0);
    return is_good;
}

bool wh_dialect_fits(wh_dialect_t *dialect, const wh_layout_t *layout) {
    lua_State *L = wh_sandbox_state(dialect->sandbox);
    return check_naming(L, &(naming_t){dialect, layout, "stations", station_at}) &&
           check_naming(L, &(naming_t){dialect, layout, "arms", gripper_at}) &&
           check_naming(L, &(naming_t){dialect, layout, "doors", door_at});
}

/* Runs protected. */
int wh_dialect_open_host(lua_State *L) {
    static const luaL_Reg functions[] = {{"refuse", refuse_request},
                                         {"station", our_station},
                                         {"arm", our_arm},
                                         {"door", our_door},
                                         {"typed", name_as_typed},
                                         {"unit", own_unit},
                                         {"mechanism", own_mechanism},
                                         {"slot", our_slot},
                                         {"mm", our_mm},
                                         {"degrees", our_degrees},
                                         {"length", their_length},
                                         {"angle", their_angle},
                                         {"nearest", find_nearest},
                                         {"forward", find_forward},
                                         {"pose", slot_pose},
                                         {"name", their_name},
                                         {"code", their_code},
                                         {"alarm", find_alarm},
                                         {NULL, NULL}};
    luaL_newlib(L, functions);
    lua_setglobal(L, "host");
    return 0;
}
