#include "flow_seen.h"

#include <lauxlib.h>
#include <string.h>

#include "../flow/failed.h"
#include "../flow/safe.h"

#define TYPE "waferhand.tool"

/* The parts of a tool as a script sees them. */
typedef enum { TOOL, ROBOTS, STATIONS, WAFERS, ROBOT, STATION, WAFER, CHOICE } kind_t;

typedef struct {
    wh_flow_seen_t *seen;
    kind_t kind;
    int32_t number;
} part_t;

/* User values: parts by kind and number, wafers' and stations' numbers by name. */
enum { PARTS = 1, WAFER_NUMBERS, STATION_NUMBERS };

void wh_flow_seen_push_value(lua_State *L, const wh_flow_seen_t *seen, int which) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, seen);
    (void)lua_getiuservalue(L, -1, which);
    lua_remove(L, -2);
}

void wh_flow_seen_keep_value(lua_State *L, const wh_flow_seen_t *seen, int which) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, seen);
    lua_rotate(L, -2, 1);
    (void)lua_setiuservalue(L, -2, which);
    lua_pop(L, 1);
}

/* Pushes a part; it is made once. */
static void push_part(lua_State *L, wh_flow_seen_t *seen, kind_t kind, int32_t number) {
    wh_flow_seen_push_value(L, seen, PARTS);
    const lua_Integer key = (lua_Integer)number * 16 + kind;
    if (lua_rawgeti(L, -1, key) == LUA_TNIL) {
        lua_pop(L, 1);
        part_t *part = lua_newuserdatauv(L, sizeof *part, 0);
        *part = (part_t){seen, kind, number};
        luaL_setmetatable(L, TYPE);
        lua_pushvalue(L, -1);
        lua_rawseti(L, -3, key);
    }
    lua_remove(L, -2);
}

static void push_us(lua_State *L, int64_t us) {
    if (us >= WH_FLOW_FOR_EVER) {
        lua_pushnil(L);
    } else {
        lua_pushnumber(L, (double)us / 1e6);
    }
}

static void push_station_name(lua_State *L, const wh_flow_seen_t *seen, int32_t station) {
    if (station == WH_FLOW_NONE) {
        lua_pushnil(L);
    } else {
        lua_pushstring(L, seen->tool->stations[station].name);
    }
}

/* ------------------------------------------------------------------------------------------------ choices */

static void add_wafer(wh_flow_seen_t *seen, int32_t wafer) {
    const wh_flow_state_t *state = seen->state;
    if (!wh_flow_may_take(state, seen->robot, wafer)) {
        return;
    }
    wh_flow_choice_t *choice = &seen->choices[seen->count];
    choice->wafer = wafer;
    choice->begin_us = wh_flow_begin_us(state, seen->robot, wafer, &choice->there_us);
    const int32_t from = wh_flow_station_of(state, wafer);
    choice->target =
        wh_flow_target(state, seen->robot, wafer, from,
                       wh_flow_loaded_us(state, seen->robot, wafer, choice->begin_us), WH_FLOW_NONE);
    seen->count += choice->target.place != WH_FLOW_NONE && seen->count < WH_FLOW_SEEN_CHOICES - 1;
}

static void find_choices(wh_flow_seen_t *seen) {
    seen->count = 0;
    for (size_t step = 0; seen->robot != WH_FLOW_NONE && step < seen->plan->step_count; ++step) {
        for (int32_t wafer = wh_flow_next_in(seen->state, step, WH_FLOW_NONE); wafer != WH_FLOW_NONE;
             wafer = wh_flow_next_in(seen->state, step, wafer)) {
            add_wafer(seen, wafer);
        }
    }
}

static void push_choices(lua_State *L, wh_flow_seen_t *seen) {
    find_choices(seen);
    lua_createtable(L, (int)seen->count, 0);
    for (size_t i = 0; i < seen->count; ++i) {
        push_part(L, seen, CHOICE, (int32_t)i);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* ------------------------------------------------------------------------------------------------- fields */

static bool is(const char *key, const char *name) {
    return strcmp(key, name) == 0;
}

/* Fields that a wafer has, and a choice has of its wafer. */
static bool push_of_wafer(lua_State *L, const wh_flow_seen_t *seen, int32_t wafer, const char *key) {
    const wh_flow_wafer_state_t *at = &seen->state->wafers[wafer];
    const wh_flow_lot_t *lot = &seen->plan->lots[seen->plan->wafers[wafer].lot];
    if (is(key, "order")) {
        lua_pushinteger(L, wafer + 1);
    } else if (is(key, "step")) {
        lua_pushinteger(L, at->step);
    } else if (is(key, "done")) {
        push_us(L, at->done_us);
    } else if (is(key, "entered")) {
        push_us(L, at->entered_us);
    } else if (is(key, "priority")) {
        lua_pushinteger(L, lot->priority);
    } else if (is(key, "lot")) {
        lua_pushstring(L, lot->name);
    } else {
        return false;
    }
    return true;
}

static void push_next(lua_State *L, const wh_flow_seen_t *seen, int32_t wafer) {
    lua_newtable(L);
    if (seen->state->wafers[wafer].is_over) {
        return;
    }
    const int32_t step = wh_flow_next_step(seen->state, wafer);
    const wh_flow_step_t *next = step == WH_FLOW_NONE ? NULL : wh_flow_step_of(seen->plan, wafer, step);
    for (size_t i = 0; next && i < next->station_count; ++i) {
        push_station_name(L, seen, next->stations[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static bool push_wafer_field(lua_State *L, wh_flow_seen_t *seen, int32_t wafer, const char *key) {
    const wh_flow_wafer_state_t *at = &seen->state->wafers[wafer];
    if (is(key, "name")) {
        lua_pushstring(L, seen->plan->wafers[wafer].name);
    } else if (is(key, "station")) {
        push_station_name(L, seen, wh_flow_station_of(seen->state, wafer));
    } else if (is(key, "robot")) {
        lua_pushstring(L, at->robot == WH_FLOW_NONE ? NULL : seen->tool->robots[at->robot].name);
    } else if (is(key, "next")) {
        push_next(L, seen, wafer);
    } else if (is(key, "over")) {
        lua_pushboolean(L, at->is_over);
    } else if (is(key, "moving")) {
        lua_pushboolean(L, at->is_moving);
    } else {
        return push_of_wafer(L, seen, wafer, key);
    }
    return true;
}

static bool push_choice_field(lua_State *L, wh_flow_seen_t *seen, int32_t number, const char *key) {
    const wh_flow_choice_t *choice = &seen->choices[number];
    if ((size_t)number >= seen->count) {
        lua_pushnil(L);
    } else if (is(key, "wafer")) {
        lua_pushstring(L, seen->plan->wafers[choice->wafer].name);
    } else if (is(key, "from")) {
        push_station_name(L, seen, wh_flow_station_of(seen->state, choice->wafer));
    } else if (is(key, "to")) {
        push_station_name(L, seen, seen->tool->place_stations[choice->target.place]);
    } else if (is(key, "begins")) {
        push_us(L, choice->begin_us);
    } else if (is(key, "ready")) {
        lua_pushboolean(L, choice->begin_us == choice->there_us);
    } else if (is(key, "safe")) {
        const wh_flow_into_t into = {choice->wafer, choice->target.place};
        lua_pushboolean(L, wh_flow_is_safe(seen->state, &into, 1));
    } else {
        return push_of_wafer(L, seen, choice->wafer, key);
    }
    return true;
}

/* The names of the wafers in a station, or on a robot's arms. */
static void push_wafers(lua_State *L, const wh_flow_seen_t *seen, const int32_t wafers[], size_t count) {
    lua_Integer found = 0;
    lua_newtable(L);
    for (size_t i = 0; i < count; ++i) {
        if (wafers[i] != WH_FLOW_NONE) {
            lua_pushstring(L, seen->plan->wafers[wafers[i]].name);
            lua_rawseti(L, -2, ++found);
        }
    }
}

static void push_inside(lua_State *L, const wh_flow_seen_t *seen, const wh_flow_station_t *of) {
    lua_Integer found = 0;
    lua_newtable(L);
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        if (seen->state->places[p].wafer != WH_FLOW_NONE) {
            lua_pushstring(L, seen->plan->wafers[seen->state->places[p].wafer].name);
            lua_rawseti(L, -2, ++found);
        }
    }
}

static lua_Integer room_in(const wh_flow_seen_t *seen, const wh_flow_station_t *of) {
    lua_Integer room = 0;
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        const wh_flow_place_t *place = &seen->state->places[p];
        room += place->wafer == WH_FLOW_NONE && place->coming == WH_FLOW_NONE;
    }
    return room;
}

static bool push_station_field(lua_State *L, wh_flow_seen_t *seen, int32_t number, const char *key) {
    const wh_flow_station_t *of = &seen->tool->stations[number];
    const wh_flow_station_state_t *at = &seen->state->stations[number];
    if (is(key, "name")) {
        lua_pushstring(L, of->name);
    } else if (is(key, "slots")) {
        lua_pushinteger(L, of->slots);
    } else if (is(key, "wafers")) {
        push_inside(L, seen, of);
    } else if (is(key, "room")) {
        lua_pushinteger(L, room_in(seen, of));
    } else if (is(key, "state")) {
        lua_pushstring(L, !of->is_lock                     ? NULL
                          : at->pump_us != WH_FLOW_NEVER   ? "pumping"
                          : at->side == WH_FLOW_ATMOSPHERE ? "atmosphere"
                                                           : "vacuum");
    } else if (is(key, "down")) {
        lua_pushboolean(L, at->down_us != WH_FLOW_NEVER);
    } else {
        return false;
    }
    return true;
}

static bool push_robot_field(lua_State *L, wh_flow_seen_t *seen, int32_t number, const char *key) {
    const wh_flow_robot_state_t *at = &seen->state->robots[number];
    if (is(key, "name")) {
        lua_pushstring(L, seen->tool->robots[number].name);
    } else if (is(key, "arms")) {
        lua_pushinteger(L, seen->tool->robots[number].arms);
    } else if (is(key, "at")) {
        push_station_name(L, seen, at->station);
    } else if (is(key, "idle")) {
        lua_pushboolean(L, at->action == WH_FLOW_IDLE);
    } else if (is(key, "holds")) {
        push_wafers(L, seen, at->arms, 2);
    } else {
        return false;
    }
    return true;
}

static bool push_tool_field(lua_State *L, wh_flow_seen_t *seen, int32_t none, const char *key) {
    (void)none;
    if (is(key, "now")) {
        push_us(L, seen->now ? seen->now(seen->clock) : seen->state->now_us);
    } else if (is(key, "robot")) {
        lua_pushstring(L, seen->robot == WH_FLOW_NONE ? NULL : seen->tool->robots[seen->robot].name);
    } else if (is(key, "choices")) {
        push_choices(L, seen);
    } else if (is(key, "robots")) {
        push_part(L, seen, ROBOTS, 0);
    } else if (is(key, "stations")) {
        push_part(L, seen, STATIONS, 0);
    } else if (is(key, "wafers")) {
        push_part(L, seen, WAFERS, 0);
    } else {
        return false;
    }
    return true;
}

/* The number of a name in one of the user values that hold them, or WH_FLOW_NONE. */
static int32_t number_of(lua_State *L, const wh_flow_seen_t *seen, int which, int name) {
    const int at = lua_absindex(L, name);
    wh_flow_seen_push_value(L, seen, which);
    lua_pushvalue(L, at);
    const int32_t number = lua_rawget(L, -2) == LUA_TNUMBER ? (int32_t)lua_tointeger(L, -1) : WH_FLOW_NONE;
    lua_pop(L, 2);
    return number;
}

int32_t wh_flow_seen_wafer(lua_State *L, const wh_flow_seen_t *seen, int name) {
    return number_of(L, seen, WAFER_NUMBERS, name);
}

int32_t wh_flow_seen_station(lua_State *L, const wh_flow_seen_t *seen, int name) {
    return number_of(L, seen, STATION_NUMBERS, name);
}

/* The parts by name; the name is at stack index 2. */
static bool push_found(lua_State *L, wh_flow_seen_t *seen, kind_t kind, int32_t number) {
    if (number != WH_FLOW_NONE) {
        push_part(L, seen, kind, number);
    }
    return number != WH_FLOW_NONE;
}

static bool push_robot(lua_State *L, wh_flow_seen_t *seen, int32_t none, const char *name) {
    (void)none;
    return push_found(L, seen, ROBOT, wh_flow_robot_named(seen->tool, name));
}

static bool push_station(lua_State *L, wh_flow_seen_t *seen, int32_t none, const char *name) {
    (void)none;
    (void)name;
    return push_found(L, seen, STATION, wh_flow_seen_station(L, seen, 2));
}

static bool push_wafer(lua_State *L, wh_flow_seen_t *seen, int32_t none, const char *name) {
    (void)none;
    (void)name;
    return push_found(L, seen, WAFER, wh_flow_seen_wafer(L, seen, 2));
}

/* By kinds: what a script calls it, and what pushes the field or the part of a name. */
static const struct {
    const char *what;
    bool (*push)(lua_State *L, wh_flow_seen_t *seen, int32_t number, const char *key);
} kinds[] = {[TOOL] = {"the tool", push_tool_field},          [ROBOTS] = {"robots by name", push_robot},
             [STATIONS] = {"stations by name", push_station}, [WAFERS] = {"wafers by name", push_wafer},
             [ROBOT] = {"a robot", push_robot_field},         [STATION] = {"a station", push_station_field},
             [WAFER] = {"a wafer", push_wafer_field},         [CHOICE] = {"a choice", push_choice_field}};

static int read_field(lua_State *L) {
    const part_t *part = luaL_checkudata(L, 1, TYPE);
    const char *key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    if (!part->seen->state) {
        return luaL_error(L, "the tool is seen only while a rule is asked");
    }
    if (!kinds[part->kind].push(L, part->seen, part->number, key)) {
        return luaL_error(L, "%s: there is no %s", kinds[part->kind].what, luaL_tolstring(L, 2, NULL));
    }
    return 1;
}

static int refuse_change(lua_State *L) {
    return luaL_error(L, "the tool of a flow can be read alone");
}

/* -------------------------------------------------------------------------------------------------- whole */

static void number_names(lua_State *L, int at, const wh_flow_seen_t *seen) {
    lua_newtable(L);
    for (size_t i = 0; i < seen->plan->wafer_count; ++i) {
        lua_pushinteger(L, (lua_Integer)i);
        lua_setfield(L, -2, seen->plan->wafers[i].name);
    }
    lua_setiuservalue(L, at, WAFER_NUMBERS);
    lua_newtable(L);
    for (size_t i = 0; i < seen->tool->station_count; ++i) {
        lua_pushinteger(L, (lua_Integer)i);
        lua_setfield(L, -2, seen->tool->stations[i].name);
    }
    lua_setiuservalue(L, at, STATION_NUMBERS);
    lua_newtable(L);
    lua_setiuservalue(L, at, PARTS);
}

void wh_flow_seen_open(lua_State *L, int index) {
    const wh_flow_seen_t *seen = lua_touserdata(L, index);
    if (luaL_newmetatable(L, TYPE)) {
        lua_pushcfunction(L, read_field);
        lua_setfield(L, -2, "__index");
        lua_pushcfunction(L, refuse_change);
        lua_setfield(L, -2, "__newindex");
        lua_pushboolean(L, false);
        lua_setfield(L, -2, "__metatable");
    }
    lua_pop(L, 1);
    lua_pushvalue(L, index);
    lua_rawsetp(L, LUA_REGISTRYINDEX, seen);
    number_names(L, index, seen);
}

void wh_flow_seen_push(lua_State *L, wh_flow_seen_t *seen) {
    push_part(L, seen, TOOL, 0);
}

bool wh_flow_seen_choice(lua_State *L, const wh_flow_seen_t *seen, int index,
                         const wh_flow_choice_t **choice) {
    const part_t *part = luaL_testudata(L, index, TYPE);
    *choice = part && part->kind == CHOICE && (size_t)part->number < seen->count
                  ? &seen->choices[part->number]
                  : NULL;
    return part != NULL;
}
