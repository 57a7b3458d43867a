#include "mcs.h"

#include <stdlib.h>
#include <string.h>

#include "../script/embedded.h"
#include "../script/wh_module.h"
#include "mcs_internal.h"

wh_mcs_t *wh_mcs_of(lua_State *L) {
    return lua_touserdata(L, lua_upvalueindex(1));
}

wh_mcs_t *wh_mcs_with_layout(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    if (!mcs->layout) {
        wh_mcs_raise(L, mcs, WH_STATUS_NO_LAYOUT, "begin the script with cell \"LAYOUT.lua\"");
    }
    return mcs;
}

int32_t wh_mcs_index(lua_State *L, int argument, size_t count) {
    const lua_Integer index = luaL_checkinteger(L, argument);
    luaL_argcheck(L, index >= 1 && index <= (lua_Integer)count, argument, "index out of range");
    return (int32_t)index - 1;
}

double wh_mcs_now(const wh_mcs_t *mcs) {
    return (double)(mcs->track.slice * mcs->track.slice_us) / 1e6;
}

/* ------------------------------------------------------------------------------------------ numbered errors
 */

static int numbered_error_text(lua_State *L) {
    lua_getfield(L, 1, "message");
    return 1;
}

static void push_numbered_error_metatable(lua_State *L) {
    if (luaL_newmetatable(L, "wh.numbered_error")) {
        lua_pushcfunction(L, numbered_error_text);
        lua_setfield(L, -2, "__tostring");
        lua_pushliteral(L, "numbered error");
        lua_setfield(L, -2, "__name");
        lua_pushboolean(L, 0);
        lua_setfield(L, -2, "__metatable");
    }
}

int wh_mcs_raise(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *detail) {
    /* Within a pattern L is the pattern's coroutine, on whose stack the script is not: the command knows. */
    const bool runs = mcs->running != WH_NONE;
    const int line = runs ? mcs->record->commands[mcs->running].line : wh_sandbox_line(L, mcs->script);
    const char *command = runs ? mcs->record->commands[mcs->running].text : "";
    lua_createtable(L, 0, 4);
    lua_pushinteger(L, status);
    lua_setfield(L, -2, "number");
    lua_pushstring(L, wh_status_name(status));
    lua_setfield(L, -2, "name");
    lua_pushinteger(L, line);
    lua_setfield(L, -2, "line");
    lua_pushfstring(L, "error %d %s: %s%s%s", (int)status, wh_status_name(status), wh_status_text(status),
                    detail ? "; " : "", detail ? detail : "");
    lua_pushfstring(L, "%s:%d: %s%s%s", mcs->script, line, command, command[0] ? ": " : "",
                    lua_tostring(L, -1));
    lua_setfield(L, -3, "message");
    lua_setfield(L, -2, "text");
    push_numbered_error_metatable(L);
    lua_setmetatable(L, -2);
    lua_error(L);
    abort(); /* lua_error does not return, but its declaration does not say so */
}

/* ------------------------------------------------------------------------------------------------- opening
 */

/* native.module(name): what an embedded file of lua/mcs returns. */
static int load_module(lua_State *L) {
    const char *name = luaL_checkstring(L, 1);
    wh_sandbox_result_t result;
    for (size_t i = 0; i < wh_embedded_count; ++i) {
        const wh_embedded_t *file = &wh_embedded[i];
        if (strcmp(file->name, name) == 0) {
            if (!wh_sandbox_evaluate_text(L, name, (const char *)file->text, file->size, &result)) {
                return luaL_error(L, "%s", result.message);
            }
            return 1;
        }
    }
    return luaL_error(L, "no embedded file %s", name);
}

/* native.connect(): the cell stands; from here on slices go over the caller's link, if it has one. */
static int connect(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (mcs->partners.connect) {
        mcs->link = mcs->partners.connect(mcs->partners.user, mcs);
        if (!mcs->link) {
            return luaL_error(L, "%s: no link to the simulator", mcs->layout->path);
        }
    }
    return 0;
}

static const luaL_Reg module_functions[] = {{"module", load_module}, {"connect", connect}, {NULL, NULL}};

/* Registry key of what lua/mcs/init.lua returned: it opens the lines. */
static char lines_key;

/* Runs protected: pushes the native table and hands it to lua/mcs/init.lua, which sets the globals. */
static int open_words(lua_State *L) {
    wh_mcs_t *mcs = lua_touserdata(L, 1);
    const luaL_Reg *const groups[] = {
        module_functions,       wh_mcs_cell_functions,   wh_mcs_plan_functions,     wh_mcs_play_functions,
        wh_mcs_query_functions, wh_mcs_record_functions, wh_mcs_line_functions,     wh_mcs_scan_functions,
        wh_mcs_fault_functions, wh_mcs_figure_functions, wh_mcs_collision_functions};
    luaopen_wh(L);
    lua_setglobal(L, "wh");
    lua_pushcfunction(L, load_module);
    lua_pushliteral(L, "mcs/init.lua");
    lua_call(L, 1, 1);
    lua_newtable(L);
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; ++i) {
        lua_pushlightuserdata(L, mcs);
        luaL_setfuncs(L, groups[i], 1);
    }
    lua_call(L, 1, 1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &lines_key);
    return 0;
}

void wh_mcs_push_lines(lua_State *L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &lines_key);
    lua_call(L, 0, 2);
}

bool wh_mcs_open(wh_mcs_t *mcs, wh_sandbox_t *sandbox, const char *script, wh_record_t *record,
                 wh_sandbox_result_t *result) {
    lua_State *L = wh_sandbox_state(sandbox);
    memset(mcs, 0, sizeof *mcs);
    mcs->script = script;
    mcs->sandbox = sandbox;
    mcs->record = record;
    mcs->running = WH_NONE;
    mcs->stop_slice = INT64_MAX;
    record->script = wh_record_text(script);
    lua_pushcfunction(L, open_words);
    lua_pushlightuserdata(L, mcs);
    return wh_sandbox_call(L, 1, 0, result);
}

/* ------------------------------------------------------------------------------------------------ finishing
 */

static void record_wafer(const wh_mcs_t *mcs, size_t w) {
    const wh_wafer_t *wafer = &mcs->state.wafers[w];
    wh_wafer_record_t *kept = &mcs->record->wafers[w];
    kept->base_from_wafer = wafer->base_from_wafer;
    kept->holder = wafer->holder;
    if (!wh_cell_locate(&mcs->simulator.cell, &wafer->base_from_wafer, &kept->place)) {
        kept->place.station = WH_NONE;
    }
}

bool wh_mcs_is_complaint(const wh_event_t *event) {
    static const uint32_t complaints =
        1U << WH_EVENT_RELEASED_UNSUPPORTED | 1U << WH_EVENT_SLOT_OCCUPIED | 1U << WH_EVENT_BAD_INPUT |
        1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED | 1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_SLIPPED;
    return (complaints >> (unsigned)event->kind & 1U) != 0;
}

void wh_mcs_finish(wh_mcs_t *mcs) {
    wh_record_t *record = mcs->record;
    record->ok = record->failure == NULL;
    for (size_t i = 0; i < record->expectation_count; ++i) {
        record->ok = record->ok && record->expectations[i].ok;
    }
    for (size_t i = 0; i < record->event_count; ++i) {
        record->ok = record->ok && !wh_mcs_is_complaint(&record->events[i].event);
    }
    record->layout = mcs->layout;
    if (!mcs->layout) {
        return;
    }
    record->slices = mcs->track.slice;
    wh_activity_end(&record->activity, record->slices);
    record->simulated_s = wh_mcs_now(mcs);
    record->hash = mcs->link->hash(mcs->link);
    record->missed = mcs->link->missed(mcs->link);
    record->checked = mcs->collision.world != NULL;
    if (record->checked) {
        memcpy(record->clearances, wh_world_clearances(mcs->collision.world), sizeof record->clearances);
        wh_record_keep_curves(record, wh_world_curves(mcs->collision.world));
    }
    record->wafers = calloc(mcs->layout->wafer_count + 1, sizeof *record->wafers);
    for (size_t w = 0; record->wafers && w < mcs->layout->wafer_count; ++w) {
        record_wafer(mcs, w);
    }
}

void wh_mcs_close(wh_mcs_t *mcs) {
    free(mcs->segments);
    mcs->segments = NULL;
    mcs->segment_count = 0;
}
