/* Commands and what is kept of them: their beginning and end, errors, expectations, cycles, complaints, and
 * why a pick was missed. */
#include "../script/wh_module_values.h"
#include "../sim/event_text.h"
#include "native.h"

/* What an entry of the record costs of the instruction budget. */
#define STEPS_PER_ENTRY 256
#define STEPS_PER_BYTE 4

/* An argument that goes into the record. The record is outside of Lua's memory cap, so an entry is paid for
 * from the budget: about as much as a script would spend on making as much text anew. Raises if the budget is
 * spent. */
static const char *pay_for_text(lua_State *L, int argument) {
    size_t length = 0;
    const char *text = luaL_checklstring(L, argument, &length);
    wh_sandbox_charge(L, STEPS_PER_ENTRY + STEPS_PER_BYTE * (uint64_t)length);
    return text;
}

static void tell(const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    if (mcs->partners.watch) {
        mcs->partners.watch(mcs->partners.user, mcs, command, ended);
    }
    if (mcs->listener.boundary) {
        mcs->listener.boundary(mcs->listener.user, mcs->layout);
    }
}

/* native.begin(text): a command starts; the script's line is found on the stack. A metamethod of an argument
 * can get here from within another command. */
static int begin_command(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const char *text = pay_for_text(L, 1);
    if (mcs->recorder.running != WH_NONE) {
        lua_pushfstring(L, "%s is a command within another", text);
        wh_mcs_raise(L, mcs, WH_STATUS_BUSY, lua_tostring(L, -1));
    }
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track); /* of a command that was cut short */
    tell(mcs,
         wh_recorder_begin(&mcs->recorder, wh_sandbox_line(L, mcs->script), text,
                           wh_recorder_now(&mcs->recorder)),
         false);
    return 0;
}

static const wh_command_record_t *end_command(wh_mcs_t *mcs, wh_status_t error, const char *message) {
    return wh_recorder_end(&mcs->recorder, wh_recorder_now(&mcs->recorder), error, message,
                           mcs->state.wafers);
}

/* native.finish(number, message): it ended, with an error number unless that is nil. */
static int finish_command(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_status_t error = (wh_status_t)luaL_optinteger(L, 1, WH_OK);
    const char *message = error == WH_OK ? "" : luaL_checkstring(L, 2);
    const wh_command_record_t *command = end_command(mcs, error, message);
    luaL_argcheck(L, command, 1, "no command is running");
    if (error != WH_OK) {
        (void)pay_for_text(L, 2); /* may raise: not before the command has ended */
    }
    tell(mcs, command, true);
    return 0;
}

void wh_mcs_cut_short(wh_mcs_t *mcs, wh_status_t error, const char *message) {
    const wh_command_record_t *command = end_command(mcs, error, message);
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track);
    if (command) {
        tell(mcs, command, true);
    }
}

/* native.expect(ok, text) */
static int add_expectation(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    const bool ok = lua_toboolean(L, 1) != 0;
    const char *text = pay_for_text(L, 2);
    wh_record_add_expectation(mcs->recorder.record, wh_sandbox_line(L, mcs->script), text, ok);
    if (mcs->partners.expected) {
        mcs->partners.expected(mcs->partners.user, mcs);
    }
    return 0;
}

/* native.cycle(name): the next one begins. */
static int begin_cycle(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const char *name = luaL_checkstring(L, 1);
    if (mcs->recorder.running != WH_NONE) {
        wh_mcs_raise(L, mcs, WH_STATUS_BUSY, "a cycle within a command");
    }
    (void)pay_for_text(L, 1);
    wh_record_add_cycle(mcs->recorder.record, wh_sandbox_line(L, mcs->script), name, mcs->track.slice);
    if (mcs->partners.cycle) {
        mcs->partners.cycle(mcs->partners.user, mcs);
    }
    return 0;
}

/* native.fail(number, detail): raises the numbered error. */
static int fail(lua_State *L) {
    wh_mcs_raise(L, wh_mcs_of(L), (wh_status_t)luaL_checkinteger(L, 1), luaL_optstring(L, 2, NULL));
}

/* ------------------------------------------------------------------------------ missed picks, complaints */

/* Pushes why it was missed: all conditions that failed. */
static void push_reasons(lua_State *L, const wh_mcs_t *mcs, const wh_event_t *miss) {
    const wh_event_names_t names = {.first = 1, .tolerance = &mcs->layout->grasp.tolerance};
    char reason[WH_EVENT_TEXT_SIZE];
    luaL_Buffer text;
    luaL_buffinit(L, &text);
    for (size_t i = 0; wh_event_reason(miss, &names, i, reason, sizeof reason) > 0; ++i) {
        luaL_addstring(&text, i > 0 ? " and " : "");
        luaL_addstring(&text, reason);
    }
    luaL_pushresult(&text);
}

/* native.closest(gripper): the name of the wafer that came closest to it in the running command, which took
 * nothing with it, and why it was not taken; nothing if no wafer came near. */
static int find_closest(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_record_t *record = mcs->recorder.record;
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    wh_decisions_measured(mcs->decisions, "why a wafer was missed");
    for (size_t i = record->event_count; i > 0; --i) {
        const wh_event_record_t *kept = &record->events[i - 1];
        if (kept->command != mcs->recorder.running) {
            break;
        }
        if (kept->event.kind == WH_EVENT_NEAR_MISS && kept->event.gripper == gripper) {
            lua_pushstring(L, mcs->layout->wafers[kept->event.wafer].name);
            push_reasons(L, mcs, &kept->event);
            return 2;
        }
    }
    return 0;
}

/* native.mark(): how many events the record has. */
static int count_events(lua_State *L) {
    lua_pushinteger(L, (lua_Integer)wh_mcs_with_layout(L)->recorder.record->event_count);
    return 1;
}

/* native.complaints(mark): what the cell complained of since then, a list of { kind, wafer, height }. A wafer
 * or a height that says nothing is left out. */
static int list_complaints(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_record_t *record = mcs->recorder.record;
    const size_t mark = (size_t)luaL_checkinteger(L, 1);
    lua_newtable(L);
    for (size_t i = mark; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (!wh_record_is_complaint(event->kind)) {
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
    return 1;
}

const luaL_Reg wh_mcs_command_functions[] = {{"begin", begin_command},
                                             {"finish", finish_command},
                                             {"expect", add_expectation},
                                             {"cycle", begin_cycle},
                                             {"fail", fail},
                                             {"closest", find_closest},
                                             {"mark", count_events},
                                             {"complaints", list_complaints},
                                             {NULL, NULL}};
