/* Commands and what is kept of them: their beginning and end, errors, expectations, cycles, complaints, and
 * why a pick was missed. */
#include <stdio.h>
#include <string.h>

#include "../sim/event_text.h"
#include "native.h"

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
    size_t length = 0;
    const char *text = luaL_checklstring(L, 1, &length);
    wh_mcs_charge_entry(L, length);
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
    size_t length = 0;
    const wh_status_t error = (wh_status_t)luaL_optinteger(L, 1, WH_OK);
    const char *message = error == WH_OK ? "" : luaL_checklstring(L, 2, &length);
    const wh_command_record_t *command = end_command(mcs, error, message);
    luaL_argcheck(L, command, 1, "no command is running");
    if (error != WH_OK) {
        wh_mcs_charge_entry(L, length); /* may raise: not before the command has ended */
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
    size_t length = 0;
    const char *text = luaL_checklstring(L, 2, &length);
    wh_mcs_charge_entry(L, length);
    wh_record_add_expectation(mcs->recorder.record, wh_sandbox_line(L, mcs->script), text, ok);
    return 0;
}

/* native.cycle(name): the next one begins. */
static int begin_cycle(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    size_t length = 0;
    const char *name = luaL_checklstring(L, 1, &length);
    if (mcs->recorder.running != WH_NONE) {
        wh_mcs_raise(L, mcs, WH_STATUS_BUSY, "a cycle within a command");
    }
    wh_mcs_charge_entry(L, length);
    wh_record_add_cycle(mcs->recorder.record, wh_sandbox_line(L, mcs->script), name, mcs->track.slice);
    return 0;
}

static wh_status_t status_named(const char *name) {
    static const wh_status_t all[] = {
#define WH_STATUS(number, name, text) WH_STATUS_##name,
#include "../math/status.def"
#undef WH_STATUS
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        if (strcmp(wh_status_name(all[i]), name) == 0) {
            return all[i];
        }
    }
    return WH_STATUS_BAD_ARGUMENT;
}

/* native.fail(NAME, detail): raises the numbered error of the catalogue. */
static int fail(lua_State *L) {
    wh_mcs_raise(L, wh_mcs_of(L), status_named(luaL_checkstring(L, 1)), luaL_optstring(L, 2, NULL));
}

/* ------------------------------------------------------------------------------------------- missed picks */

/* The gripper that missed it is the command's own: only why is said. */
static void describe_miss(const wh_mcs_t *mcs, const wh_event_t *miss, char *text, size_t size) {
    const wh_event_names_t names = {.first = 1, .tolerance = &mcs->layout->grasp.tolerance};
    char reason[WH_EVENT_TEXT_SIZE];
    int length = snprintf(text, size, "closest to %s", mcs->layout->wafers[miss->wafer].name);
    for (size_t i = 0; wh_event_reason(miss, &names, i, reason, sizeof reason) > 0; ++i) {
        length += snprintf(text + length, size - (size_t)length, "%s%s", i == 0 ? ": " : " and ", reason);
    }
}

/* native.explain(gripper): why the running command took nothing with it. */
static int explain(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_record_t *record = mcs->recorder.record;
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    char text[WH_EVENT_TEXT_SIZE] = "no wafer came near";
    wh_decisions_measured(mcs->decisions, "why a wafer was missed");
    for (size_t i = record->event_count; i > 0; --i) {
        const wh_event_record_t *kept = &record->events[i - 1];
        if (kept->command != mcs->recorder.running) {
            break;
        }
        if (kept->event.kind == WH_EVENT_NEAR_MISS && kept->event.gripper == gripper) {
            describe_miss(mcs, &kept->event, text, sizeof text);
            break;
        }
    }
    lua_pushstring(L, text);
    return 1;
}

/* --------------------------------------------------------------------------------------------- complaints */

/* native.mark(): how many events the record has. */
static int count_events(lua_State *L) {
    lua_pushinteger(L, (lua_Integer)wh_mcs_with_layout(L)->recorder.record->event_count);
    return 1;
}

static void push_complaint(lua_State *L, const wh_layout_t *layout, const wh_event_t *event) {
    lua_pushstring(L, wh_event_name(event->kind));
    if (event->wafer != WH_NONE) {
        lua_pushfstring(L, " \"%s\"", layout->wafers[event->wafer].name);
        lua_concat(L, 2);
    }
    if (event->kind == WH_EVENT_RELEASED_UNSUPPORTED) {
        char height[60];
        snprintf(height, sizeof height, ", %.3f mm high", event->height);
        lua_pushstring(L, height);
        lua_concat(L, 2);
    }
}

/* native.complaints(mark): what the cell complained of since then, as text, or nil. */
static int describe_complaints(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_record_t *record = mcs->recorder.record;
    luaL_Buffer text;
    bool any = false;
    const size_t mark = (size_t)luaL_checkinteger(L, 1);
    luaL_buffinit(L, &text);
    for (size_t i = mark; i < record->event_count; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (wh_record_is_complaint(event->kind)) {
            luaL_addstring(&text, any ? "; " : "");
            push_complaint(L, mcs->layout, event);
            luaL_addvalue(&text);
            any = true;
        }
    }
    luaL_pushresult(&text);
    return any ? 1 : 0;
}

const luaL_Reg wh_mcs_command_functions[] = {{"begin", begin_command},
                                             {"finish", finish_command},
                                             {"expect", add_expectation},
                                             {"cycle", begin_cycle},
                                             {"fail", fail},
                                             {"explain", explain},
                                             {"mark", count_events},
                                             {"complaints", describe_complaints},
                                             {NULL, NULL}};
