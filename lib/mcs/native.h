/* Within motion control: the table of functions that lua/mcs calls `native`. */
#ifndef WH_MCS_NATIVE_H
#define WH_MCS_NATIVE_H

#include <lauxlib.h>

#include "mcs.h"

/* The motion control behind a function of the native table. */
wh_mcs_t *wh_mcs_of(lua_State *L);

/* The same, with a layout; raises NO_LAYOUT if none was set up. */
wh_mcs_t *wh_mcs_with_layout(lua_State *L);

/* Raises a numbered error: a table { number, name, message, line } whose text is "script:line: COMMAND: text,
 * detail". */
int wh_mcs_raise(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *detail)
    __attribute__((noreturn));

/* Index (from 0) of a wafer, gripper or station given from 1 by lua/mcs. */
int32_t wh_mcs_index(lua_State *L, int argument, size_t count);

/* From now on this is called for each slice. */
void wh_mcs_listen(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user);

/* The record is outside of Lua's memory cap, so an entry with so much text is paid for from the budget: about as much as a
 * script would spend on making as much text anew. Raises if the budget is spent. */
void wh_mcs_charge_entry(lua_State *L, size_t text_bytes);

/* The layout's faults, once it is read. */
void wh_mcs_start_faults(wh_mcs_t *mcs);

/* The layout as lua/mcs reads it: { path, slice, sampled, homed, tolerance, home: the robot's axes, grippers in order, stations by
 * name }. Lengths in mm, angles in rad, times in s. */
void wh_mcs_push_layout(lua_State *L, const wh_layout_t *layout);

/* Functions of the native table, by file. */
extern const luaL_Reg wh_mcs_cell_functions[];
extern const luaL_Reg wh_mcs_command_functions[];
extern const luaL_Reg wh_mcs_fault_functions[];
extern const luaL_Reg wh_mcs_plan_functions[];
extern const luaL_Reg wh_mcs_play_functions[];
extern const luaL_Reg wh_mcs_query_functions[];
extern const luaL_Reg wh_mcs_scan_functions[];

#endif
