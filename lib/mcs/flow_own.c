/* The functions of a script are called by wh_flow_play in the middle of its work, so their errors are
 * caught, and raised again when the flow is over. They see the tool by userdata that read the engine's
 * state: no table is built but the list of choices. */
#include "flow_own.h"

#include <lauxlib.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../flow/safe.h"
#include "../flow/transfer.h"
#include "../text/array.h"

/* The most transfers that one question offers. */
#define MOST_CHOICES 256

#define TYPE "waferhand.tool"

/* The parts of a tool as a script sees them. */
typedef enum { IT, CHOICES, ROBOTS, STATIONS, WAFERS, ROBOT, STATION, WAFER, CHOICE } kind_t;

/* A transfer that the robot could carry out, now or later. */
typedef struct {
    wh_flow_target_t target;
    int64_t begin_us, there_us;
    int32_t wafer;
} choice_t;

/* All parts share it; it is at the stack index `index` of L while the flow runs. */
typedef struct {
    lua_State *L;
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    const wh_flow_state_t *state; /* null but while a function is called */
    int32_t robot;                /* that is asked, or WH_FLOW_NONE */
    int index;
    bool has_failed;
    size_t count;
    choice_t choices[MOST_CHOICES];
} own_t;

typedef struct {
    own_t *own;
    kind_t kind;
    int32_t number;
} part_t;

/* User values of own_t: parts by kind and number, wafers' and stations' numbers by name, the functions, an
 * error. */
enum { PARTS = 1, WAFER_NUMBERS, STATION_NUMBERS, RULE, ON_ERROR, FAILURE };

/* Pushes the user value of own_t, which the part keeps alive. */
static void push_value(lua_State *L, const own_t *own, int which) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, own);
    (void)lua_getiuservalue(L, -1, which);
    lua_remove(L, -2);
}

/* Pushes a part; it is made once. */
static void push_part(lua_State *L, own_t *own, kind_t kind, int32_t number) {
    push_value(L, own, PARTS);
    const lua_Integer key = (lua_Integer)number * 16 + kind;
    if (lua_rawgeti(L, -1, key) == LUA_TNIL) {
        lua_pop(L, 1);
        part_t *part = lua_newuserdatauv(L, sizeof *part, 0);
        *part = (part_t){own, kind, number};
        luaL_setmetatable(L, TYPE);
        lua_pushvalue(L, -1);
        lua_rawseti(L, -3, key);
    }
    lua_remove(L, -2);
}

static void push_us(lua_State *L, int64_t us) {
    if (us == WH_FLOW_NEVER) {
        lua_pushnil(L);
    } else {
        lua_pushnumber(L, (double)us / 1e6);
    }
}

static void push_station(lua_State *L, const own_t *own, int32_t station) {
    if (station == WH_FLOW_NONE) {
        lua_pushnil(L);
    } else {
        lua_pushstring(L, own->tool->stations[station].name);
    }
}

/* ------------------------------------------------------------------------------------------------ choices */

static void add_wafer(own_t *own, int32_t wafer) {
    const wh_flow_state_t *state = own->state;
    if (!wh_flow_may_take(state, own->robot, wafer)) {
        return;
    }
    choice_t *choice = &own->choices[own->count];
    choice->wafer = wafer;
    choice->begin_us = wh_flow_begin_us(state, own->robot, wafer, &choice->there_us);
    const int32_t from = wh_flow_station_of(state, wafer);
    choice->target =
        wh_flow_target(state, own->robot, wafer, from,
                       wh_flow_loaded_us(state, own->robot, wafer, choice->begin_us), WH_FLOW_NONE);
    own->count += choice->target.place != WH_FLOW_NONE && own->count < MOST_CHOICES - 1;
}

static void find_choices(own_t *own) {
    own->count = 0;
    for (size_t step = 0; own->robot != WH_FLOW_NONE && step < own->plan->step_count; ++step) {
        for (int32_t wafer = wh_flow_next_in(own->state, step, WH_FLOW_NONE); wafer != WH_FLOW_NONE;
             wafer = wh_flow_next_in(own->state, step, wafer)) {
            add_wafer(own, wafer);
        }
    }
}

static void push_choices(lua_State *L, own_t *own) {
    find_choices(own);
    lua_createtable(L, (int)own->count, 0);
    for (size_t i = 0; i < own->count; ++i) {
        push_part(L, own, CHOICE, (int32_t)i);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* ------------------------------------------------------------------------------------------------- fields */

static bool is(const char *key, const char *name) {
    return strcmp(key, name) == 0;
}

/* Fields that a wafer has, and a choice has of its wafer. */
static bool push_of_wafer(lua_State *L, const own_t *own, int32_t wafer, const char *key) {
    const wh_flow_wafer_state_t *at = &own->state->wafers[wafer];
    const wh_flow_lot_t *lot = &own->plan->lots[own->plan->wafers[wafer].lot];
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

static void push_next(lua_State *L, const own_t *own, int32_t wafer) {
    lua_newtable(L);
    if (own->state->wafers[wafer].is_over) {
        return;
    }
    const wh_flow_step_t *next = wh_flow_step_of(own->plan, wafer, own->state->wafers[wafer].step + 1);
    for (size_t i = 0; i < next->station_count; ++i) {
        push_station(L, own, next->stations[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static bool push_wafer_field(lua_State *L, const own_t *own, int32_t wafer, const char *key) {
    const wh_flow_wafer_state_t *at = &own->state->wafers[wafer];
    if (is(key, "name")) {
        lua_pushstring(L, own->plan->wafers[wafer].name);
    } else if (is(key, "station")) {
        push_station(L, own, wh_flow_station_of(own->state, wafer));
    } else if (is(key, "robot")) {
        lua_pushstring(L, at->robot == WH_FLOW_NONE ? NULL : own->tool->robots[at->robot].name);
    } else if (is(key, "next")) {
        push_next(L, own, wafer);
    } else if (is(key, "over")) {
        lua_pushboolean(L, at->is_over);
    } else if (is(key, "moving")) {
        lua_pushboolean(L, at->is_moving);
    } else {
        return push_of_wafer(L, own, wafer, key);
    }
    return true;
}

static bool push_choice_field(lua_State *L, const own_t *own, int32_t number, const char *key) {
    const choice_t *choice = &own->choices[number];
    if ((size_t)number >= own->count) {
        lua_pushnil(L);
    } else if (is(key, "wafer")) {
        lua_pushstring(L, own->plan->wafers[choice->wafer].name);
    } else if (is(key, "from")) {
        push_station(L, own, wh_flow_station_of(own->state, choice->wafer));
    } else if (is(key, "to")) {
        push_station(L, own, own->tool->place_stations[choice->target.place]);
    } else if (is(key, "begins")) {
        push_us(L, choice->begin_us);
    } else if (is(key, "ready")) {
        lua_pushboolean(L, choice->begin_us == choice->there_us);
    } else if (is(key, "safe")) {
        const wh_flow_into_t into = {choice->wafer, choice->target.place};
        lua_pushboolean(L, wh_flow_is_safe(own->state, &into, 1));
    } else {
        return push_of_wafer(L, own, choice->wafer, key);
    }
    return true;
}

/* The names of the wafers in a station, or on a robot's arms. */
static void push_wafers(lua_State *L, const own_t *own, const int32_t wafers[], size_t count) {
    lua_Integer found = 0;
    lua_newtable(L);
    for (size_t i = 0; i < count; ++i) {
        if (wafers[i] != WH_FLOW_NONE) {
            lua_pushstring(L, own->plan->wafers[wafers[i]].name);
            lua_rawseti(L, -2, ++found);
        }
    }
}

static void push_inside(lua_State *L, const own_t *own, const wh_flow_station_t *of) {
    lua_Integer found = 0;
    lua_newtable(L);
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        if (own->state->places[p].wafer != WH_FLOW_NONE) {
            lua_pushstring(L, own->plan->wafers[own->state->places[p].wafer].name);
            lua_rawseti(L, -2, ++found);
        }
    }
}

static lua_Integer room_in(const own_t *own, const wh_flow_station_t *of) {
    lua_Integer room = 0;
    for (int32_t p = of->first_place; p < of->first_place + of->slots; ++p) {
        const wh_flow_place_t *place = &own->state->places[p];
        room += place->wafer == WH_FLOW_NONE && place->coming == WH_FLOW_NONE;
    }
    return room;
}

static bool push_station_field(lua_State *L, const own_t *own, int32_t number, const char *key) {
    const wh_flow_station_t *of = &own->tool->stations[number];
    const wh_flow_station_state_t *at = &own->state->stations[number];
    if (is(key, "name")) {
        lua_pushstring(L, of->name);
    } else if (is(key, "slots")) {
        lua_pushinteger(L, of->slots);
    } else if (is(key, "wafers")) {
        push_inside(L, own, of);
    } else if (is(key, "room")) {
        lua_pushinteger(L, room_in(own, of));
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

static bool push_robot_field(lua_State *L, const own_t *own, int32_t number, const char *key) {
    const wh_flow_robot_state_t *at = &own->state->robots[number];
    if (is(key, "name")) {
        lua_pushstring(L, own->tool->robots[number].name);
    } else if (is(key, "arms")) {
        lua_pushinteger(L, own->tool->robots[number].arms);
    } else if (is(key, "at")) {
        push_station(L, own, at->station);
    } else if (is(key, "idle")) {
        lua_pushboolean(L, at->action == WH_FLOW_IDLE);
    } else if (is(key, "holds")) {
        push_wafers(L, own, at->arms, 2);
    } else {
        return false;
    }
    return true;
}

static bool push_tool_field(lua_State *L, own_t *own, const char *key) {
    if (is(key, "now")) {
        push_us(L, own->state->now_us);
    } else if (is(key, "robot")) {
        lua_pushstring(L, own->robot == WH_FLOW_NONE ? NULL : own->tool->robots[own->robot].name);
    } else if (is(key, "choices")) {
        push_choices(L, own);
    } else if (is(key, "robots")) {
        push_part(L, own, ROBOTS, 0);
    } else if (is(key, "stations")) {
        push_part(L, own, STATIONS, 0);
    } else if (is(key, "wafers")) {
        push_part(L, own, WAFERS, 0);
    } else {
        return false;
    }
    return true;
}

/* The number of a name in one of the user values that hold them, or WH_FLOW_NONE. */
static int32_t number_of(lua_State *L, const own_t *own, int which, int name) {
    const int at = lua_absindex(L, name);
    push_value(L, own, which);
    lua_pushvalue(L, at);
    const int32_t number = lua_rawget(L, -2) == LUA_TNUMBER ? (int32_t)lua_tointeger(L, -1) : WH_FLOW_NONE;
    lua_pop(L, 2);
    return number;
}

static bool push_named(lua_State *L, own_t *own, kind_t kind) {
    const int32_t number = kind == ROBOTS     ? wh_flow_robot_named(own->tool, lua_tostring(L, 2))
                           : kind == STATIONS ? number_of(L, own, STATION_NUMBERS, 2)
                                              : number_of(L, own, WAFER_NUMBERS, 2);
    if (number == WH_FLOW_NONE) {
        return false;
    }
    push_part(L, own, kind == ROBOTS ? ROBOT : kind == STATIONS ? STATION : WAFER, number);
    return true;
}

static int read_field(lua_State *L) {
    const part_t *part = luaL_checkudata(L, 1, TYPE);
    static const char *const what[] = {"the tool",       "",        "robots by name", "stations by name",
                                       "wafers by name", "a robot", "a station",      "a wafer",
                                       "a choice"};
    const char *key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    own_t *own = part->own;
    bool is_known = false;
    if (!own->state) {
        return luaL_error(L, "the tool is seen only while a rule is asked");
    }
    switch (part->kind) {
    case ROBOT:
        is_known = push_robot_field(L, own, part->number, key);
        break;
    case STATION:
        is_known = push_station_field(L, own, part->number, key);
        break;
    case WAFER:
        is_known = push_wafer_field(L, own, part->number, key);
        break;
    case CHOICE:
        is_known = push_choice_field(L, own, part->number, key);
        break;
    case IT:
        is_known = push_tool_field(L, own, key);
        break;
    case ROBOTS:
    case STATIONS:
    case WAFERS:
    case CHOICES:
    default:
        is_known = lua_type(L, 2) == LUA_TSTRING && push_named(L, own, part->kind);
        break;
    }
    if (!is_known) {
        return luaL_error(L, "%s: there is no %s", what[part->kind], luaL_tolstring(L, 2, NULL));
    }
    return 1;
}

static int refuse_change(lua_State *L) {
    return luaL_error(L, "the tool of a flow can be read alone");
}

/* ------------------------------------------------------------------------------------------------ answers */

/* The text of entry `number` of the answer on top of the stack, "" if it is nil. It stays on the stack. */
static const char *push_entry(lua_State *L, int number) {
    const int type = lua_rawgeti(L, -number, number);
    return type == LUA_TSTRING ? lua_tostring(L, -1) : type == LUA_TNIL ? "" : NULL;
}

static char *refuse_answer(const own_t *own, int number, const char *why) {
    char text[300];
    (void)snprintf(text, sizeof text, "rule for %s: answer %d: %s", own->tool->robots[own->robot].name,
                   number, why);
    return wh_text_copy(text);
}

static char *read_names(own_t *own, int number, wh_flow_line_t *line) {
    lua_State *L = own->L;
    const char *from = push_entry(L, 1), *to = push_entry(L, 2), *wafer = push_entry(L, 3);
    char text[200];
    if (!from || !to || !wafer || !*from || !*to) {
        return refuse_answer(own, number, "{ FROM, TO } or { FROM, TO, WAFER } by names is expected");
    }
    const bool brings = is(from, "keep"), keeps = is(to, "keep");
    line->what = brings ? WH_FLOW_BRING : keeps ? WH_FLOW_KEEP : WH_FLOW_TRANSFER;
    line->from = brings ? WH_FLOW_NONE : number_of(L, own, STATION_NUMBERS, -3);
    line->to = keeps ? WH_FLOW_NONE : number_of(L, own, STATION_NUMBERS, -2);
    line->wafer = *wafer ? number_of(L, own, WAFER_NUMBERS, -1) : WH_FLOW_NONE;
    if ((brings && keeps) || (!brings && line->from == WH_FLOW_NONE) ||
        (!keeps && line->to == WH_FLOW_NONE)) {
        (void)snprintf(text, sizeof text, "{ %.60s, %.60s }: no such stations, or twice \"keep\"", from, to);
        return refuse_answer(own, number, text);
    }
    if (*wafer && line->wafer == WH_FLOW_NONE) {
        (void)snprintf(text, sizeof text, "there is no wafer %.60s", wafer);
        return refuse_answer(own, number, text);
    }
    return NULL;
}

/* A choice stands for its wafer, from where it lies to its best place. */
static char *read_choice(own_t *own, int number, const part_t *part, wh_flow_line_t *line) {
    if (part->kind != CHOICE || (size_t)part->number >= own->count) {
        return refuse_answer(own, number, "a choice of this question is expected");
    }
    const choice_t *choice = &own->choices[part->number];
    line->wafer = choice->wafer;
    line->from = wh_flow_station_of(own->state, choice->wafer);
    line->to = own->tool->place_stations[choice->target.place];
    return NULL;
}

/* Reads the answer on top of the stack. */
static int read_answers(own_t *own, wh_flow_line_t lines[], char **why) {
    lua_State *L = own->L;
    if (lua_isnil(L, -1)) {
        return 0;
    }
    if (!lua_istable(L, -1)) {
        *why = refuse_answer(own, 1, "a list of transfers is expected, or nothing");
        return -1;
    }
    int count = 0;
    while (count < WH_FLOW_ANSWERS && !*why) {
        const int top = lua_gettop(L), type = lua_rawgeti(L, -1, count + 1);
        const part_t *part = type == LUA_TUSERDATA ? luaL_testudata(L, -1, TYPE) : NULL;
        lines[count] =
            (wh_flow_line_t){WH_FLOW_TRANSFER, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_BOTH};
        if (type == LUA_TNIL) {
            lua_settop(L, top);
            break;
        }
        *why = part                 ? read_choice(own, count + 1, part, &lines[count])
               : type == LUA_TTABLE ? read_names(own, count + 1, &lines[count])
                                    : refuse_answer(own, count + 1, "a transfer is expected");
        ++count;
        lua_settop(L, top);
    }
    return *why ? -1 : count;
}

/* Calls the function that is a user value, with the tool and the argument on top of the stack, if
 * `arguments` is 2. False if it fails; its error is kept. The result is then on top of the stack. */
static bool call_own(own_t *own, const wh_flow_state_t *state, int32_t robot, int which, int arguments) {
    lua_State *L = own->L;
    own->state = state;
    own->robot = robot;
    push_value(L, own, which);
    push_part(L, own, IT, 0);
    if (arguments == 2) {
        lua_rotate(L, -3, -1);
    }
    if (lua_pcall(L, arguments, 1, 0) == LUA_OK) {
        return true;
    }
    own->has_failed = true;
    lua_setiuservalue(L, own->index, FAILURE);
    return false;
}

static int ask_rule(void *context, const wh_flow_state_t *state, int32_t robot, wh_flow_line_t lines[],
                    char **why) {
    own_t *own = context;
    const int top = lua_gettop(own->L);
    const int count = call_own(own, state, robot, RULE, 1) ? read_answers(own, lines, why) : -1;
    own->state = NULL;
    lua_settop(own->L, top);
    return count;
}

static char *tell_problem(void *context, const wh_flow_state_t *state, const wh_flow_problem_t *problem) {
    own_t *own = context;
    lua_State *L = own->L;
    const int top = lua_gettop(L);
    char *why = NULL;
    lua_createtable(L, 0, 4);
    lua_pushstring(L, problem->what == WH_FLOW_LATE ? "late" : "down");
    lua_setfield(L, -2, "kind");
    lua_pushstring(L, own->tool->stations[problem->station].name);
    lua_setfield(L, -2, "station");
    lua_pushnumber(L, (double)problem->us / 1e6);
    lua_setfield(L, -2, "seconds");
    lua_pushstring(L, problem->wafer == WH_FLOW_NONE ? NULL : own->plan->wafers[problem->wafer].name);
    lua_setfield(L, -2, "wafer");
    if (!call_own(own, state, problem->robot, ON_ERROR, 2)) {
        why = wh_text_copy("on_error failed");
    } else if (lua_type(L, -1) == LUA_TSTRING) {
        why = wh_text_copy(lua_tostring(L, -1));
    }
    own->state = NULL;
    lua_settop(L, top);
    return why;
}

/* -------------------------------------------------------------------------------------------------- whole */

/* Takes the function of this name, if it is one. */
static bool take_function(lua_State *L, int own, const char *name, int which) {
    lua_getfield(L, 1, name);
    const bool is_function = lua_isfunction(L, -1);
    lua_setiuservalue(L, own, which);
    return is_function;
}

static void number_names(lua_State *L, int at, const own_t *own) {
    lua_newtable(L);
    for (size_t i = 0; i < own->plan->wafer_count; ++i) {
        lua_pushinteger(L, (lua_Integer)i);
        lua_setfield(L, -2, own->plan->wafers[i].name);
    }
    lua_setiuservalue(L, at, WAFER_NUMBERS);
    lua_newtable(L);
    for (size_t i = 0; i < own->tool->station_count; ++i) {
        lua_pushinteger(L, (lua_Integer)i);
        lua_setfield(L, -2, own->tool->stations[i].name);
    }
    lua_setiuservalue(L, at, STATION_NUMBERS);
    lua_newtable(L);
    lua_setiuservalue(L, at, PARTS);
}

void wh_flow_own_open(lua_State *L, const wh_flow_tool_t *tool, wh_flow_plan_t *plan) {
    if (luaL_newmetatable(L, TYPE)) {
        lua_pushcfunction(L, read_field);
        lua_setfield(L, -2, "__index");
        lua_pushcfunction(L, refuse_change);
        lua_setfield(L, -2, "__newindex");
        lua_pushboolean(L, false);
        lua_setfield(L, -2, "__metatable");
    }
    lua_pop(L, 1);
    own_t *own = lua_newuserdatauv(L, sizeof *own, FAILURE);
    const int at = lua_gettop(L);
    *own = (own_t){.L = L, .tool = tool, .plan = plan, .robot = WH_FLOW_NONE, .index = at};
    lua_pushvalue(L, at);
    lua_rawsetp(L, LUA_REGISTRYINDEX, own); /* it outlives what a script keeps of it */
    number_names(L, at, own);
    plan->own_context = own;
    if (take_function(L, at, "rule", RULE)) {
        plan->own = ask_rule;
    }
    if (take_function(L, at, "on_error", ON_ERROR)) {
        plan->on_problem = tell_problem;
    }
}

void wh_flow_own_close(lua_State *L, int index, wh_flow_plan_t *plan) {
    const own_t *own = lua_touserdata(L, index);
    plan->own = NULL;
    plan->on_problem = NULL;
    plan->own_context = NULL;
    if (own->has_failed) {
        (void)lua_getiuservalue(L, index, FAILURE);
        (void)lua_error(L);
    }
}
