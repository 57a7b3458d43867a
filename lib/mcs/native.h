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

/* The lines from which the script's functions were called that L's stack is in, the innermost first. */
void wh_mcs_find_callers(lua_State *L, const wh_mcs_t *mcs, int callers[WH_MCS_CALLERS]);

/* Index (from 0) of a wafer, gripper or station given from 1 by lua/mcs. */
int32_t wh_mcs_index(lua_State *L, int argument, size_t count);

/* From now on this is called for each slice. */
void wh_mcs_listen(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user);

/* The same, before all others. */
void wh_mcs_listen_first(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user);

/* From now on motion control knows for STATUS which slice's state came last: of a link that is not the local
 * cell's. To be called before the first slice. */
void wh_mcs_watch_slices(wh_mcs_t *mcs);

/* Sets the run up in the cell of this layout, whose table is on top of the stack if the run is a trial, and
 * pushes the layout as Lua sees it. Raises if the cell cannot be. */
void wh_mcs_set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout);

/* The layout's faults, once it is read. */
void wh_mcs_start_faults(wh_mcs_t *mcs);

/* Plans the segment table at stack index 1 from where the track stands, which has then begun it. Raises if it
 * cannot be. */
void wh_mcs_plan_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned);

/* If a door is "open", "shut" or "moving", as its switches tell. */
const char *wh_mcs_door_word(const wh_mcs_t *mcs, size_t door);

/* What so many slices cost of the instruction budget: a slice takes as much time as some twenty instructions
 * of Lua. */
static inline uint64_t wh_mcs_steps(int64_t slices) {
    return 20 * (uint64_t)slices;
}

/* Hears of each slice for what `edge` and `pass` collect; `user` is the wh_mcs_t. */
void wh_mcs_hear_slice(void *user, const wh_command_t *command, const wh_state_t *state);

void wh_mcs_free_lanes(wh_mcs_t *mcs);

void wh_mcs_free_edge(wh_mcs_edge_t *edge);
void wh_mcs_free_turns(wh_mcs_turns_t *turns);

/* From the end of the next slice on these beams latch, and this gripper's way is remembered. The beams are
 * taken to stand as this base_from_station says. What was collected before is gone. */
void wh_mcs_arm(wh_mcs_t *mcs, wh_latch_order_t order, int32_t station, int32_t gripper,
                const wh_pose_t *believed);

/* The first `count` numbers of the list at this absolute stack index; raises if one is none. */
void wh_mcs_read_numbers(lua_State *L, int list, wh_real_t numbers[], size_t count);

/* The station's frame as motion control believes for a robot: as the layout has it, or moved by the table at
 * this stack index, if that is one: see native.shift in believed.c. */
wh_pose_t wh_mcs_believed_station(lua_State *L, int shift, const wh_mcs_t *mcs, size_t station, size_t robot);

/* How far beside that, in base, mm, one of several robots goes in a trial, for it was taught the station so;
 * else zero. */
wh_vec3_t wh_mcs_drawn_aside(const wh_mcs_t *mcs, size_t station, size_t robot);

/* Pushes what motion control knows of an edge sensor of the layout: { samples: in a turn, pixels: of the
 * line, pixel, middle and length, mm, run_up: how far the chuck turns from rest to its full speed,
 * believed: its errors as the layout says that they are known }. The true ones are for a calibration to
 * find. */
void wh_mcs_push_edge_sensor(lua_State *L, const wh_layout_t *layout, const wh_scanner_t *scanner);

/* Pushes { offset, zero, gain, latency }. */
void wh_mcs_push_sensor_error(lua_State *L, const wh_sensor_error_t *error);

/* Functions of the native table, by file. */
extern const luaL_Reg wh_mcs_align_functions[];
extern const luaL_Reg wh_mcs_arrival_functions[];
extern const luaL_Reg wh_mcs_believed_functions[];
extern const luaL_Reg wh_mcs_calibration_functions[];
extern const luaL_Reg wh_mcs_cell_functions[];
extern const luaL_Reg wh_mcs_centring_functions[];
extern const luaL_Reg wh_mcs_command_functions[];
extern const luaL_Reg wh_mcs_definition_functions[];
extern const luaL_Reg wh_mcs_describe_functions[];
extern const luaL_Reg wh_mcs_edge_functions[];
extern const luaL_Reg wh_mcs_fault_functions[];
extern const luaL_Reg wh_mcs_job_functions[];
extern const luaL_Reg wh_mcs_lane_functions[];
extern const luaL_Reg wh_mcs_plan_functions[];
extern const luaL_Reg wh_mcs_play_functions[];
extern const luaL_Reg wh_mcs_query_functions[];
extern const luaL_Reg wh_mcs_saved_functions[];
extern const luaL_Reg wh_mcs_scan_functions[];
extern const luaL_Reg wh_mcs_survey_functions[];
extern const luaL_Reg wh_mcs_teaching_functions[];

/* Pushes what looks at the stations of a layout for a survey, see lua/mcs/init.lua. */
void wh_mcs_push_survey(lua_State *L);

/* Pushes what makes definitions, see lua/mcs/definitions.lua. */
void wh_mcs_push_definitions(lua_State *L);

#endif
