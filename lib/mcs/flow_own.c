/* The functions of a script are called by wh_flow_play in the middle of its work, so their errors are
 * caught, and raised again when the flow is over. */
#include "flow_own.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../text/array.h"
#include "flow_seen.h"

typedef struct {
    wh_flow_seen_t seen; /* the first member: its address is the userdata's */
    lua_State *L;        /* on which the flow goes on */
    bool has_failed;
} own_t;

/* User values behind those of `seen`: the functions, an error. */
enum { RULE = WH_FLOW_SEEN_VALUES + 1, ON_ERROR, FAILURE };

/* ------------------------------------------------------------------------------------------------ answers */

/* The text of entry `number` of the answer on top of the stack, "" if it is nil. It stays on the stack. */
static const char *push_entry(lua_State *L, int number) {
    const int type = lua_rawgeti(L, -number, number);
    return type == LUA_TSTRING ? lua_tostring(L, -1) : type == LUA_TNIL ? "" : NULL;
}

static char *refuse_answer(const own_t *own, int number, const char *why) {
    char text[300];
    (void)snprintf(text, sizeof text, "rule for %s: answer %d: %s",
                   own->seen.tool->robots[own->seen.robot].name, number, why);
    return wh_text_copy(text);
}

/* Sets the way of a transfer by two names at stack indices -3 and -2. False if it is none. */
static bool find_way(const own_t *own, const char *from, const char *to, wh_flow_line_t *line) {
    const bool brings = strcmp(from, "keep") == 0, keeps = strcmp(to, "keep") == 0;
    line->what = brings ? WH_FLOW_BRING : keeps ? WH_FLOW_KEEP : WH_FLOW_TRANSFER;
    line->from = brings ? WH_FLOW_NONE : wh_flow_seen_station(own->L, &own->seen, -3);
    line->to = keeps ? WH_FLOW_NONE : wh_flow_seen_station(own->L, &own->seen, -2);
    return (brings || line->from != WH_FLOW_NONE) && (keeps || line->to != WH_FLOW_NONE) &&
           !(brings && keeps);
}

static char *read_names(own_t *own, int number, wh_flow_line_t *line) {
    lua_State *L = own->L;
    const char *from = push_entry(L, 1), *to = push_entry(L, 2), *wafer = push_entry(L, 3);
    char text[200];
    if (!from || !to || !wafer || !*from || !*to) {
        return refuse_answer(own, number, "{ FROM, TO } or { FROM, TO, WAFER } by names is expected");
    }
    if (!find_way(own, from, to, line)) {
        (void)snprintf(text, sizeof text, "{ %.60s, %.60s }: no such stations, or twice \"keep\"", from, to);
        return refuse_answer(own, number, text);
    }
    line->wafer = *wafer ? wh_flow_seen_wafer(L, &own->seen, -1) : WH_FLOW_NONE;
    if (*wafer && line->wafer == WH_FLOW_NONE) {
        (void)snprintf(text, sizeof text, "there is no wafer %.60s", wafer);
        return refuse_answer(own, number, text);
    }
    return NULL;
}

/* A choice stands for its wafer, from where it lies to its best place. */
static char *read_choice(const own_t *own, int number, const wh_flow_choice_t *choice, wh_flow_line_t *line) {
    if (!choice) {
        return refuse_answer(own, number, "a choice of this question is expected");
    }
    line->wafer = choice->wafer;
    line->from = wh_flow_station_of(own->seen.state, choice->wafer);
    line->to = own->seen.tool->place_stations[choice->target.place];
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
        const wh_flow_choice_t *choice = NULL;
        lines[count] = WH_FLOW_NO_LINE;
        if (type == LUA_TNIL) {
            lua_settop(L, top);
            break;
        }
        *why = wh_flow_seen_choice(L, &own->seen, -1, &choice)
                   ? read_choice(own, count + 1, choice, &lines[count])
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
    own->seen.state = state;
    own->seen.robot = robot;
    wh_flow_seen_push_value(L, &own->seen, which);
    wh_flow_seen_push(L, &own->seen);
    if (arguments == 2) {
        lua_rotate(L, -3, -1);
    }
    if (lua_pcall(L, arguments, 1, 0) == LUA_OK) {
        return true;
    }
    own->has_failed = true;
    wh_flow_seen_keep_value(L, &own->seen, FAILURE);
    return false;
}

static int ask_rule(void *context, const wh_flow_state_t *state, int32_t robot, wh_flow_line_t lines[],
                    char **why) {
    own_t *own = context;
    const int top = lua_gettop(own->L);
    const int count = call_own(own, state, robot, RULE, 1) ? read_answers(own, lines, why) : -1;
    own->seen.state = own->seen.asked;
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
    lua_pushstring(L,
                   problem->station == WH_FLOW_NONE ? NULL : own->seen.tool->stations[problem->station].name);
    lua_setfield(L, -2, "station");
    lua_pushnumber(L, problem->us == WH_FLOW_FOR_EVER ? (lua_Number)INFINITY : (double)problem->us / 1e6);
    lua_setfield(L, -2, "seconds");
    lua_pushstring(L, problem->wafer == WH_FLOW_NONE ? NULL : own->seen.plan->wafers[problem->wafer].name);
    lua_setfield(L, -2, "wafer");
    lua_pushstring(L, problem->robot == WH_FLOW_NONE ? NULL : own->seen.tool->robots[problem->robot].name);
    lua_setfield(L, -2, "robot");
    if (!call_own(own, state, problem->robot, ON_ERROR, 2)) {
        why = wh_text_copy("on_error failed");
    } else if (lua_type(L, -1) == LUA_TSTRING) {
        why = wh_text_copy(lua_tostring(L, -1));
    }
    own->seen.state = own->seen.asked;
    lua_settop(L, top);
    return why;
}

/* -------------------------------------------------------------------------------------------------- whole */

/* Takes the function of this name, if it is one, out of the description at stack index 1. */
static bool take_function(lua_State *L, own_t *own, const char *name, int which) {
    lua_getfield(L, 1, name);
    const bool is_function = lua_isfunction(L, -1);
    wh_flow_seen_keep_value(L, &own->seen, which);
    return is_function;
}

void wh_flow_own_open(lua_State *L, const wh_flow_tool_t *tool, wh_flow_plan_t *plan) {
    own_t *own = lua_newuserdatauv(L, sizeof *own, FAILURE);
    *own = (own_t){.seen = {.tool = tool, .plan = plan, .robot = WH_FLOW_NONE}, .L = L};
    wh_flow_seen_open(L, lua_gettop(L));
    lua_pop(L, 1);
    plan->own_context = own;
    if (take_function(L, own, "rule", RULE)) {
        plan->own = ask_rule;
    }
    if (take_function(L, own, "on_error", ON_ERROR)) {
        plan->on_problem = tell_problem;
    }
}

void wh_flow_own_use(lua_State *L, const wh_flow_plan_t *plan) {
    own_t *own = plan->own_context;
    own->L = L;
}

bool wh_flow_own_push_on_error(lua_State *L, const wh_flow_plan_t *plan, const wh_flow_state_t *state,
                               int64_t (*now)(const void *), const void *clock) {
    own_t *own = plan->own_context;
    if (!plan->on_problem) {
        return false;
    }
    own->seen.asked = state;
    own->seen.state = state;
    own->seen.now = now;
    own->seen.clock = clock;
    own->seen.robot = WH_FLOW_NONE;
    wh_flow_seen_push_value(L, &own->seen, ON_ERROR);
    wh_flow_seen_push(L, &own->seen);
    return true;
}

void wh_flow_own_end_on_error(const wh_flow_plan_t *plan) {
    own_t *own = plan->own_context;
    own->seen.asked = own->seen.state = NULL;
    own->seen.now = NULL;
}

bool wh_flow_own_close(lua_State *L, wh_flow_plan_t *plan) {
    own_t *own = plan->own_context;
    plan->own = NULL;
    plan->on_problem = NULL;
    plan->own_context = NULL;
    own->seen.asked = own->seen.state = NULL;
    if (own->has_failed) {
        wh_flow_seen_push_value(L, &own->seen, FAILURE);
    }
    return own->has_failed;
}
