/* The MCS host's memory: commands, expectations, numbered errors, and why a pick was missed. */
#include <stdio.h>
#include <string.h>

#include "mcs_internal.h"

/* What an entry of the record costs of the instruction budget. */
#define STEPS_PER_ENTRY 256
#define STEPS_PER_BYTE 4

/* The record is outside of Lua's memory cap, so it is paid for from the budget: about as much as a script would
 * spend on making as much text anew. Raises when the budget is spent. */
static const char *charged_text(lua_State *L, int argument) {
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
        mcs->listener.boundary(mcs->listener.user, mcs);
    }
}

/* native.begin(text): a command starts; the script's line is found on the stack. A metamethod of an argument
 * can get here from within another command. */
static int begin_command(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const char *text = charged_text(L, 1);
    if (mcs->running != WH_NONE) {
        lua_pushfstring(L, "%s is a command within another", text);
        wh_mcs_raise(L, mcs, WH_STATUS_BUSY, lua_tostring(L, -1));
    }
    wh_mcs_end_rehearsal(mcs); /* of a command that was cut short */
    wh_record_add_command(mcs->record, wh_sandbox_line(L, mcs->script), text, wh_mcs_now(mcs));
    mcs->running = (int32_t)mcs->record->command_count - 1;
    tell(mcs, &mcs->record->commands[mcs->running], false);
    return 0;
}

/* native.finish(number, message): it ended, with an error number unless that is nil. */
static int finish_command(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    luaL_argcheck(L, mcs->running != WH_NONE, 1, "no command is running");
    wh_command_record_t *command = &mcs->record->commands[mcs->running];
    command->end_s = wh_mcs_now(mcs);
    if (lua_isnoneornil(L, 1)) {
        wh_mcs_count_puts(mcs);
    }
    mcs->running = WH_NONE; /* before anything that may raise */
    command->error = (wh_status_t)luaL_optinteger(L, 1, WH_OK);
    if (command->error != WH_OK) {
        command->message = wh_record_text(charged_text(L, 2));
    }
    tell(mcs, command, true);
    return 0;
}

/* native.expect(ok, text) */
static int add_expectation(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    const bool ok = lua_toboolean(L, 1) != 0;
    const char *text = charged_text(L, 2);
    wh_record_add_expectation(mcs->record, wh_sandbox_line(L, mcs->script), text, ok);
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

/* ------------------------------------------------------------------------------------------ missed picks */

static void append(char *text, size_t size, const char *part) {
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s", length > 0 ? " and " : "", part);
}

static void describe_miss(const wh_mcs_t *mcs, const wh_event_t *miss, char *text, size_t size) {
    const wh_tolerance_t *limit = &mcs->layout->grasp.tolerance;
    const wh_proximity_t *p = &miss->measured;
    char reasons[240] = "";
    char part[80];
    if (p->failed & WH_FAILED_PROJZ) {
        snprintf(part, sizeof part, "|dr_proj_z| %.4f is not below %g", wh_real_abs(p->dr_proj_z),
                 limit->projz);
        append(reasons, sizeof reasons, part);
    }
    if (p->failed & WH_FAILED_PROJXY) {
        snprintf(part, sizeof part, "|dr_proj_xy| %.4f is not below %g", p->dr_proj_xy_norm, limit->projxy);
        append(reasons, sizeof reasons, part);
    }
    if (p->failed & WH_FAILED_PLANAR) {
        snprintf(part, sizeof part, "n1_proj_n2 %.6f is not above %g", p->n1_proj_n2, limit->planar);
        append(reasons, sizeof reasons, part);
    }
    snprintf(text, size, "closest to %s: %s", mcs->layout->wafers[miss->wafer].name, reasons);
}

/* native.explain(gripper): why the running command took nothing with it. */
static int explain(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    char text[360] = "no wafer came near";
    wh_decisions_measured(mcs->decisions, "why a wafer was missed");
    for (size_t i = mcs->record->event_count; i > 0; --i) {
        const wh_event_record_t *record = &mcs->record->events[i - 1];
        if (record->command != mcs->running) {
            break;
        }
        if (record->event.kind == WH_EVENT_NEAR_MISS && record->event.gripper == gripper) {
            describe_miss(mcs, &record->event, text, sizeof text);
            break;
        }
    }
    lua_pushstring(L, text);
    return 1;
}

const luaL_Reg wh_mcs_record_functions[] = {{"begin", begin_command},    {"finish", finish_command},
                                            {"expect", add_expectation}, {"fail", fail},
                                            {"explain", explain},        {NULL, NULL}};
