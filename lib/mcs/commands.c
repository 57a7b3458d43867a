/* Commands and their records: beginning and end, phases, errors, expectations, cycles and complaints. */
#include <stdio.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "../text/nearest.h"
#include "../text/utf8.h"
#include "native.h"

/* The cost of an entry of the record in the instruction budget. */
#define STEPS_PER_ENTRY 256
#define STEPS_PER_BYTE 4

/* The most names among which the nearest one is looked for. */
#define MOST_NAMES 1000

/* Pays for an argument that goes into the record. The record is outside of Lua's memory cap, so the budget
 * pays for an entry: about as much as a script would spend on making such a text. Raises if the budget is
 * spent. */
static const char *pay_for_text(lua_State *L, int argument) {
    size_t length = 0;
    (void)luaL_checklstring(L, argument, &length);
    wh_sandbox_charge(L, STEPS_PER_ENTRY + STEPS_PER_BYTE * (uint64_t)length);
    return wh_lua_whole_text(L, argument);
}

static void tell_command(const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    wh_mcs_tell(mcs, ended ? WH_MCS_COMMAND_ENDED : WH_MCS_COMMAND_BEGINS, command);
    if (mcs->wanted.listener.boundary) {
        mcs->wanted.listener.boundary(mcs->wanted.listener.user, mcs->layout);
    }
}

/* The script's line; if a task's body has ended in the call of a word, only the body's last line is known. */
static int find_line(lua_State *L, const wh_mcs_t *mcs) {
    const int line = wh_sandbox_line(L, mcs->script);
    return line > 0 ? line : (int)luaL_optinteger(L, 2, 0);
}

/* native.line_of(function): the last line of its code. */
static int find_last_line(lua_State *L) {
    lua_pushinteger(L, wh_sandbox_last_line(L, 1));
    return 1;
}

/* native.line_in(thread): the script's line in which a coroutine waits; 0: in none that is known. */
static int find_line_in(lua_State *L) {
    lua_State *thread = lua_tothread(L, 1);
    luaL_argcheck(L, thread, 1, "no thread");
    int line = 0;
    (void)wh_sandbox_lines(thread, wh_mcs_of(L)->script, &line, 1);
    lua_pushinteger(L, line);
    return 1;
}

/* native.begin(text, line): a command starts; the script's line is found on the stack, or else it is `line`.
 * An argument's metamethod can call this within another command. */
static int begin_command(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const char *text = pay_for_text(L, 1);
    if (mcs->recorder.running != WH_NONE) {
        lua_pushfstring(L, "%s is a command within another", text);
        wh_mcs_raise(L, mcs, WH_STATUS_BUSY, lua_tostring(L, -1));
    }
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track); /* of a command that was cut short */
    wh_mcs_find_callers(L, mcs);
    wh_origins_look(&mcs->heard.origins, &mcs->state); /* a free run may not hear of each slice */
    tell_command(mcs,
                 wh_recorder_begin(&mcs->recorder, find_line(L, mcs), text, wh_recorder_now(&mcs->recorder)),
                 false);
    return 0;
}

/* native.begin_word(word): the script uses this word. A word may be a command, or a question, which
 * has no record. */
static int begin_word(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    (void)snprintf(mcs->running.word, sizeof mcs->running.word, "%s", luaL_checkstring(L, 1));
    return 0;
}

static const wh_command_record_t *end_command(wh_mcs_t *mcs, wh_status_t error, const char *message) {
    return wh_recorder_end(&mcs->recorder, wh_recorder_now(&mcs->recorder), error, message,
                           mcs->state.wafers);
}

/* native.finish(number, message): the command ended, with an error number unless that is nil. */
static int finish_command(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_status_t error = (wh_status_t)luaL_optinteger(L, 1, WH_OK);
    const char *message = error == WH_OK ? "" : wh_lua_whole_text(L, 2);
    const wh_command_record_t *command = end_command(mcs, error, message);
    luaL_argcheck(L, command, 1, "no command is running");
    if (error != WH_OK) {
        (void)pay_for_text(L, 2); /* may raise: not before the command has ended */
    }
    tell_command(mcs, command, true);
    return 0;
}

static void end_early(wh_mcs_t *mcs, wh_status_t error, const char *message) {
    const wh_command_record_t *command = end_command(mcs, error, message);
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track);
    if (command) {
        tell_command(mcs, command, true);
    }
}

void wh_mcs_cut_short(wh_mcs_t *mcs, wh_status_t error, const char *message) {
    const bool runs = mcs->recorder.running != WH_NONE;
    end_early(mcs, error, message);
    if (runs) {
        wh_mcs_give_up(mcs, WH_NONE);
    }
}

void wh_mcs_stop_tasks(wh_mcs_t *mcs) {
    for (size_t i = 0; mcs->lanes && i < WH_MCS_LANES; ++i) {
        wh_lane_t *lane = &mcs->lanes->of[i];
        lane->is_busy = false;
        if ((int32_t)i != mcs->lanes->current && lane->running != WH_NONE) {
            mcs->recorder.running = lane->running;
            lane->running = WH_NONE;
            end_early(mcs, WH_STATUS_STOPPED, "the script had failed");
        }
    }
}

void wh_mcs_refuse(wh_mcs_t *mcs, const char *text, wh_status_t error, const char *message) {
    tell_command(mcs, wh_recorder_begin(&mcs->recorder, 0, text, wh_recorder_now(&mcs->recorder)), false);
    end_early(mcs, error, message);
}

/* ------------------------------------------------------------------------------------------------- phases */

void wh_mcs_give_up(wh_mcs_t *mcs, int32_t robot) {
    for (int32_t i = 0; i < WH_MCS_ROBOTS; ++i) {
        if (robot == WH_NONE || robot == i) {
            mcs->held[i].command[0] = '\0';
        }
    }
}

const wh_mcs_held_t *wh_mcs_find_held(const wh_mcs_t *mcs, int32_t robot) {
    for (int32_t i = 0; i < WH_MCS_ROBOTS; ++i) {
        if ((robot == WH_NONE || robot == i) && mcs->held[i].command[0] != '\0') {
            return &mcs->held[i];
        }
    }
    return NULL;
}

/* native.hold(robot, text, phase): this command of the robot is held after its end. */
static int hold_command(lua_State *L) {
    wh_mcs_held_t *held = &wh_mcs_of(L)->held[wh_mcs_index(L, 1, WH_MCS_ROBOTS)];
    wh_utf8_clip(held->command, sizeof held->command, wh_lua_whole_text(L, 2));
    (void)snprintf(held->phase, sizeof held->phase, "%s", luaL_checkstring(L, 3));
    return 0;
}

/* native.release(robot): it is no longer held. */
static int release_command(lua_State *L) {
    wh_mcs_give_up(wh_mcs_of(L), wh_mcs_index(L, 1, WH_MCS_ROBOTS));
    return 0;
}

/* native.is_held(robot): the phase in which a command of the robot's is held, or nil. */
static int find_phase(lua_State *L) {
    const wh_mcs_held_t *held = wh_mcs_find_held(wh_mcs_of(L), wh_mcs_index(L, 1, WH_MCS_ROBOTS));
    lua_pushstring(L, held ? held->phase : NULL);
    return 1;
}

/* native.expect(ok, text) */
static int expect_condition(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    const bool ok = lua_toboolean(L, 1) != 0;
    const char *text = pay_for_text(L, 2);
    wh_record_add_expectation(mcs->recorder.record, wh_sandbox_line(L, mcs->script), text, ok);
    if (!lua_isnoneornil(L, 3)) {
        wh_record_name_expectation(mcs->recorder.record, (size_t)luaL_checkinteger(L, 3));
    }
    wh_mcs_tell(mcs, WH_MCS_EXPECTED, NULL);
    return 0;
}

/* native.imply(ok, text): what a command implies. If it is met, only studies count it, and the script does
 * not pay for the text: its command paid for a longer one. */
static int add_implied(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    const bool ok = lua_toboolean(L, 1) != 0;
    const char *text = ok ? luaL_checkstring(L, 2) : pay_for_text(L, 2);
    wh_record_add_implied(mcs->recorder.record, wh_sandbox_line(L, mcs->script), text, ok);
    if (!ok) {
        wh_mcs_tell(mcs, WH_MCS_EXPECTED, NULL);
    }
    return 0;
}

/* native.cycle(name): the next cycle begins. */
static int begin_cycle(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (mcs->recorder.running != WH_NONE) {
        wh_mcs_raise(L, mcs, WH_STATUS_BUSY, "a cycle within a command");
    }
    const char *name = pay_for_text(L, 1);
    wh_record_add_cycle(mcs->recorder.record, wh_sandbox_line(L, mcs->script), name, mcs->track.slice);
    wh_mcs_tell(mcs, WH_MCS_CYCLE_BEGINS, NULL);
    return 0;
}

/* native.nearest(word, names): "; did you mean NAME?", or nil. A longer list is not looked at. */
static int find_nearest(lua_State *L) {
    const size_t length = strlen(luaL_checkstring(L, 1));
    luaL_checktype(L, 2, LUA_TTABLE);
    const size_t count = lua_rawlen(L, 2);
    if (count > MOST_NAMES || length > WH_NEAREST_BYTES) {
        return 0;
    }
    wh_sandbox_charge(L, count * (length + 1));
    const char **names = lua_newuserdatauv(L, (count + 1) * sizeof *names, 0);
    for (size_t i = 0; i < count; ++i) {
        lua_rawgeti(L, 2, (lua_Integer)i + 1);
        names[i] = luaL_checkstring(L, -1); /* which the list keeps */
        lua_pop(L, 1);
    }
    char meant[WH_NEAREST_TEXT];
    const char *nearest = wh_text_nearest(lua_tostring(L, 1), names, count);
    lua_pushstring(L, nearest ? wh_text_did_you_mean(meant, "; ", "", nearest) : NULL);
    return 1;
}

/* native.fail(number, detail): raises the numbered error. */
static int fail_command(lua_State *L) {
    wh_mcs_raise(L, wh_mcs_of(L), (wh_status_t)luaL_checkinteger(L, 1), wh_lua_whole_text(L, 2));
}

/* --------------------------------------------------------------------------------------------- complaints */

/* native.mark(): how many events the record has, and how many expectations. */
static int count_events(lua_State *L) {
    const wh_record_t *record = wh_mcs_with_layout(L)->recorder.record;
    lua_pushinteger(L, (lua_Integer)record->event_count);
    lua_pushinteger(L, (lua_Integer)record->expectation_count);
    return 2;
}

/* True if no other task's command caused it: of tasks side by side, each gets only its own events. */
static bool is_own_event(const wh_mcs_t *mcs, const wh_event_record_t *event) {
    const wh_record_t *record = mcs->recorder.record;
    return event->command == WH_NONE || record->commands[event->command].task == mcs->recorder.number;
}

/* Adds { kind = text } for each expectation from number `mark` on that was not met: those of PUTs whose wafer
 * ended elsewhere. */
static void add_unmet(lua_State *L, const wh_record_t *record, size_t mark) {
    for (size_t i = mark; i < record->expectation_count; ++i) {
        if (!record->expectations[i].ok) {
            lua_createtable(L, 0, 1);
            wh_lua_set_text(L, "kind", record->expectations[i].text);
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
}

/* native.complaints(mark, expectations): the cell's complaints since then in this task's commands, a list of
 * { kind, wafer, height }. Unused wafers and heights are left out. */
static int list_complaints(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_record_t *record = mcs->recorder.record;
    const size_t mark = (size_t)luaL_checkinteger(L, 1);
    lua_newtable(L);
    for (size_t i = mark; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (!wh_record_is_complaint(event->kind) || !is_own_event(mcs, &record->events[i])) {
            continue;
        }
        lua_createtable(L, 0, 3);
        wh_lua_set_text(L, "kind", wh_event_name(event->kind));
        if (event->wafer != WH_NONE) {
            wh_lua_set_text(L, "wafer", mcs->layout->wafers[event->wafer].name);
        }
        if (event->kind == WH_EVENT_RELEASED_UNSUPPORTED) {
            wh_lua_set_number(L, "height", event->height);
        }
        lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
    }
    add_unmet(L, record, (size_t)luaL_checkinteger(L, 2));
    return 1;
}

const luaL_Reg wh_mcs_command_functions[] = {{"begin", begin_command},        {"line_of", find_last_line},
                                             {"line_in", find_line_in},       {"finish", finish_command},
                                             {"begin_word", begin_word},      {"hold", hold_command},
                                             {"release", release_command},    {"is_held", find_phase},
                                             {"expect", expect_condition},    {"imply", add_implied},
                                             {"cycle", begin_cycle},          {"nearest", find_nearest},
                                             {"fail", fail_command},          {"mark", count_events},
                                             {"complaints", list_complaints}, {NULL, NULL}};
