/* Within the MCS host. */
#ifndef WH_MCS_MCS_INTERNAL_H
#define WH_MCS_MCS_INTERNAL_H

#include <lauxlib.h>

#include "mcs.h"

/* The host behind a function of the native table. */
wh_mcs_t *wh_mcs_of(lua_State *L);

/* The same, with a layout; raises NO_LAYOUT when none was set up. */
wh_mcs_t *wh_mcs_with_layout(lua_State *L);

/* Raises a numbered error: a table { number, name, message, line } whose text is "script:line: COMMAND: text,
 * detail". */
int wh_mcs_raise(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *detail)
    __attribute__((noreturn));

/* The cell as it really is: the trial's, or the layout's. */
const wh_layout_t *wh_mcs_real(const wh_mcs_t *mcs);

/* Ends a rehearsal that is under way, if one is: everything is where it was. */
void wh_mcs_end_rehearsal(wh_mcs_t *mcs);

/* Simulated seconds so far. */
double wh_mcs_now(const wh_mcs_t *mcs);

/* Index (from 0) of a wafer, gripper or station given from 1 by lua/mcs. */
int32_t wh_mcs_index(lua_State *L, int argument, size_t count);

/* The layout's faults, once it is read. */
void wh_mcs_start_faults(wh_mcs_t *mcs);

/* The segment table at stack index 1: one of axes, line (with speed and acceleration), valves, dwell, sensor (with timeout).
 * Raises when it is none. */
wh_segment_t wh_mcs_read_segment(lua_State *L, const wh_mcs_t *mcs);

/* What the segment table at stack index 1, read as `segment`, asks of the machine. */
wh_task_t wh_mcs_task(lua_State *L, const wh_mcs_t *mcs, const wh_segment_t *segment);

/* Where a rehearsed segment ends: how near the axes came to their ends. */
void wh_mcs_look_at_reach(wh_mcs_t *mcs);

/* The layout as lua/mcs reads it: { path, slice, sampled, homed, tolerance, home: the robot's axes, grippers in order, stations by
 * name }. Lengths in mm, angles in rad, times in s. */
void wh_mcs_push_layout(lua_State *L, const wh_layout_t *layout);

/* Functions of the native table, by subject. */
extern const luaL_Reg wh_mcs_cell_functions[];
extern const luaL_Reg wh_mcs_collision_functions[];
extern const luaL_Reg wh_mcs_plan_functions[];
extern const luaL_Reg wh_mcs_play_functions[];
extern const luaL_Reg wh_mcs_query_functions[];
extern const luaL_Reg wh_mcs_record_functions[];
extern const luaL_Reg wh_mcs_line_functions[];
extern const luaL_Reg wh_mcs_scan_functions[];
extern const luaL_Reg wh_mcs_fault_functions[];
extern const luaL_Reg wh_mcs_figure_functions[];

#endif
