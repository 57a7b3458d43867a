/* Injected faults: a script's faults go to the simulator with the next slice's command. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../reading/layout_read.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "clocks.h"
#include "native.h"
#include "ports.h"

static int64_t next_slice(const wh_mcs_t *mcs) {
    return mcs->track.slice + 1;
}

void wh_mcs_start_faults(wh_mcs_t *mcs) {
    const wh_physics_t *physics = &mcs->layout->physics;
    mcs->armed.fault_count = physics->fault_count;
    memcpy(mcs->armed.faults, physics->faults, sizeof mcs->armed.faults);
}

/* Finds a slot that was never used, so that a number means one fault as long as possible; else the first
 * slot whose fault is over, also in the simulator. */
static size_t find_fault_slot(lua_State *L, wh_mcs_t *mcs) {
    size_t slot = mcs->armed.fault_count < WH_FAULTS ? mcs->armed.fault_count : 0;
    while (slot < mcs->armed.fault_count && mcs->armed.faults[slot].until > mcs->track.slice) {
        ++slot;
    }
    if (slot == WH_FAULTS) {
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT,
                     "16 faults are there already (expected at most 16: clear one)");
    }
    return slot;
}

/* Sends the fault of a slot with the next command, in place of a pending one for that slot. */
static void send_fault(lua_State *L, wh_mcs_t *mcs, size_t slot, const wh_fault_t *fault) {
    wh_command_t *command = &mcs->command;
    size_t place = 0;
    while (place < command->fault_count && command->faults[place].index != (int32_t)slot) {
        ++place;
    }
    if (place == WH_COMMAND_FAULTS) {
        wh_mcs_raise(
            L, mcs, WH_STATUS_BAD_ARGUMENT,
            "4 faults change with the next slice already (expected at most 4: wait before the next)");
    }
    command->faults[place].index = (int32_t)slot;
    command->faults[place].fault = *fault;
    command->fault_count += place == command->fault_count ? 1 : 0;
    mcs->armed.faults[slot] = *fault;
}

/* native.fault(description): the fault's number, from 1. */
static int add_fault(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_reader_t reader;
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    wh_reader_start(&reader, L, "fault");
    const wh_fault_t fault = wh_layout_read_fault(&reader, mcs->layout, mcs->state.wafers, next_slice(mcs));
    const size_t slot = find_fault_slot(L, mcs);
    send_fault(L, mcs, slot, &fault);
    mcs->armed.fault_count += slot == mcs->armed.fault_count ? 1 : 0;
    lua_pushinteger(L, (lua_Integer)slot + 1);
    return 1;
}

/* ------------------------------------------------------------------------------------------------- alarms */

static bool is_alarm(const wh_mcs_t *mcs, lua_Integer number) {
    return number > WH_FAULTS && number <= WH_FAULTS + WH_MCS_ALARMS &&
           mcs->armed.alarms[number - WH_FAULTS - 1] != WH_OK;
}

/* An alarm that a host has armed waits for one of this host's commands. */
static bool waits_for(const wh_mcs_t *mcs, size_t alarm, int32_t job) {
    return mcs->armed.alarms[alarm] != WH_OK &&
           (mcs->armed.alarm_jobs[alarm] == 0 || mcs->armed.alarm_jobs[alarm] == WH_MCS_NOBODYS_JOB ||
            mcs->armed.alarm_jobs[alarm] == job);
}

static int32_t current_job(const wh_mcs_t *mcs) {
    const int32_t job = mcs->lanes ? mcs->lanes->of[mcs->lanes->current].job : 0;
    return job != 0 ? job : mcs->wanted.asker.controller;
}

bool wh_mcs_take_alarm(wh_mcs_t *mcs, wh_status_t error, int32_t job) {
    for (size_t i = 0; error != WH_OK && i < WH_MCS_ALARMS; ++i) {
        if (mcs->armed.alarms[i] == error && waits_for(mcs, i, job)) {
            mcs->armed.alarms[i] = WH_OK;
            return true;
        }
    }
    return false;
}

/* native.arm_alarm(error): the fault's number. */
static int arm_alarm(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_status_t error = (wh_status_t)luaL_checkinteger(L, 1);
    size_t place = 0;
    while (place < WH_MCS_ALARMS && mcs->armed.alarms[place] != WH_OK) {
        ++place;
    }
    if (place == WH_MCS_ALARMS) {
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT,
                     "16 errors wait for a command already (expected at most 16: clear one)");
    }
    mcs->armed.alarms[place] = error;
    mcs->armed.alarm_jobs[place] = current_job(mcs);
    mcs->armed.alarm_tried[place] = false;
    lua_pushinteger(L, (lua_Integer)(WH_FAULTS + place + 1));
    return 1;
}

/* native.alarms(): the errors armed for the running task, a list of { number, error } in the order of
 * numbers; nil: none. */
static int list_alarms(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    lua_Integer count = 0;
    for (size_t i = 0; i < WH_MCS_ALARMS; ++i) {
        if (!waits_for(mcs, i, current_job(mcs))) {
            continue;
        }
        if (count == 0) {
            lua_newtable(L);
        }
        lua_createtable(L, 0, 2);
        wh_lua_set_integer(L, "number", (lua_Integer)(WH_FAULTS + i + 1));
        wh_lua_set_integer(L, "error", mcs->armed.alarms[i]);
        lua_rawseti(L, -2, ++count);
    }
    return count > 0 ? 1 : 0;
}

/* native.disarm(number): this error no longer waits. */
static int disarm_alarm(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    const lua_Integer number = luaL_checkinteger(L, 1);
    if (is_alarm(mcs, number)) {
        mcs->armed.alarms[number - WH_FAULTS - 1] = WH_OK;
    }
    return 0;
}

/* native.note_tried(number): something broke for this error, and its command ended otherwise. */
static int note_tried(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    const lua_Integer number = luaL_checkinteger(L, 1);
    if (is_alarm(mcs, number)) {
        mcs->armed.alarm_tried[number - WH_FAULTS - 1] = true;
    }
    return 0;
}

/* --------------------------------------------------------------------------------------------- at the end */

static void put_comma(FILE *out) {
    if (ftell(out) > 0) {
        fputs(", ", out);
    }
}

/* Tells a fault that has not come. One of a wafer waits while a gripper has it. */
static void put_unbegun(FILE *out, const wh_mcs_t *mcs, size_t slot) {
    const wh_fault_t *fault = &mcs->armed.faults[slot];
    const wh_physics_state_t *physics = mcs->state.physics;
    const bool is_later = fault->from > mcs->track.slice && fault->until > fault->from;
    if (is_later) {
        put_comma(out);
        fprintf(out, "%s (fault %zu, from %.10g s on)", wh_fault_name(fault->kind), slot + 1,
                (double)(fault->from * mcs->track.slice_us) / 1e6);
    } else if (wh_fault_is_of_wafer(fault->kind) && fault->from <= mcs->track.slice &&
               fault->until > mcs->track.slice && physics && slot < physics->faults.count &&
               physics->faults.slots[slot].phase == WH_FAULT_WAITING) {
        put_comma(out);
        fprintf(out, "%s (fault %zu: its wafer was held)", wh_fault_name(fault->kind), slot + 1);
    }
}

/* Tells the errors that still wait for a command. */
static void put_alarms(FILE *out, const wh_mcs_t *mcs) {
    for (size_t i = 0; i < WH_MCS_ALARMS; ++i) {
        if (mcs->armed.alarms[i] != WH_OK) {
            put_comma(out);
            fprintf(out, "error %d %s (fault %zu: %s)", (int)mcs->armed.alarms[i],
                    wh_status_name(mcs->armed.alarms[i]), WH_FAULTS + i + 1,
                    mcs->armed.alarm_tried[i]
                        ? "its cause led to no such error in a command that can answer with it"
                        : "no command that can answer with it");
        }
    }
}

/* Tells the carriers that were still to come. */
static void put_carriers(FILE *out, const wh_mcs_t *mcs) {
    const struct wh_ports *ports = mcs->clocks ? mcs->clocks->ports : NULL;
    for (size_t c = 0; ports && c < mcs->layout->carrier_count; ++c) {
        const wh_carrier_now_t *carrier = &ports->carriers[c];
        if (carrier->is_due) {
            put_comma(out);
            fprintf(out, "carrier %s (to %s at %.10g s)", mcs->layout->carriers[c].name,
                    mcs->layout->stations[ports->of[carrier->port].station].name,
                    (double)carrier->comes_us / 1e6);
        }
    }
}

char *wh_mcs_tell_never_came(const wh_mcs_t *mcs) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    for (size_t i = 0; i < mcs->armed.fault_count; ++i) {
        put_unbegun(out, mcs, i);
    }
    put_alarms(out, mcs);
    put_carriers(out, mcs);
    if (mcs->stop.at_slice != INT64_MAX) {
        put_comma(out);
        fprintf(out, "a STOP (stop_in, at %.10g s)",
                (double)(mcs->stop.at_slice * mcs->track.slice_us) / 1e6);
    }
    const bool is_any = ftell(out) > 0;
    (void)fclose(out);
    if (!is_any) {
        free(text);
    }
    return is_any ? text : NULL;
}

/* ----------------------------------------------------------------------------------------------- clearing */

/* native.clear_fault(number): the fault ends with the next slice; a waiting error is disarmed. */
static int clear_fault(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const lua_Integer number = luaL_checkinteger(L, 1);
    if (is_alarm(mcs, number)) {
        return disarm_alarm(L);
    }
    if (number < 1 || number > (lua_Integer)mcs->armed.fault_count ||
        mcs->armed.faults[number - 1].until <= mcs->track.slice) {
        lua_pushfstring(L, "number: %I (expected that of a fault that is not over)", (LUAI_UACINT)number);
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, lua_tostring(L, -1));
    }
    wh_fault_t fault = mcs->armed.faults[number - 1];
    if (fault.until > next_slice(mcs)) {
        fault.until = next_slice(mcs);
        send_fault(L, mcs, (size_t)number - 1, &fault);
    }
    return 0;
}

/* native.fault_kinds(): the names of those on purpose. */
static int list_kinds(lua_State *L) {
    lua_createtable(L, WH_FAULT_KINDS, 0);
    for (int kind = 0; kind < WH_FAULT_KINDS; ++kind) {
        if (kind != WH_FAULT_WAFER_PLACED) {
            lua_pushstring(L, wh_fault_name((wh_fault_kind_t)kind));
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
    return 1;
}

const luaL_Reg wh_mcs_fault_functions[] = {{"fault", add_fault},        {"clear_fault", clear_fault},
                                           {"fault_kinds", list_kinds}, {"arm_alarm", arm_alarm},
                                           {"alarms", list_alarms},     {"disarm", disarm_alarm},
                                           {"note_tried", note_tried},  {NULL, NULL}};
