/* Within motion control: the table of functions that lua/mcs calls `native`. */
#ifndef WH_MCS_NATIVE_H
#define WH_MCS_NATIVE_H

#include <lauxlib.h>

#include "mcs.h"

/* Returns the motion control behind a function of the native table. */
wh_mcs_t *wh_mcs_of(lua_State *L);

/* Like wh_mcs_of, but raises NO_LAYOUT if no layout was set up. */
wh_mcs_t *wh_mcs_with_layout(lua_State *L);

/* Raises a numbered error: a table { number, name, message, line } whose text is "script:line: COMMAND: text,
 * detail". */
int wh_mcs_raise(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *detail)
    __attribute__((noreturn));

/* Finds the calling lines of the script's functions on L's stack, the innermost first. */
void wh_mcs_find_callers(lua_State *L, wh_mcs_t *mcs);

/* Index (from 0) of a wafer, gripper or station given from 1 by lua/mcs. */
int32_t wh_mcs_index(lua_State *L, int argument, size_t count);

/* Tells the partners of it; `command` is null but for a command's begin and end. */
void wh_mcs_tell(const wh_mcs_t *mcs, wh_mcs_news_t news, const wh_command_record_t *command);

/* From now on `hear` is called for each slice. */
void wh_mcs_listen(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user);

/* Like wh_mcs_listen, but called before all others. */
void wh_mcs_listen_first(wh_mcs_t *mcs, wh_slice_listener_t *hear, void *user);

/* For each slice: which grippers' valves do not open with their command. `user` has one for each of them. */
void wh_mcs_hear_valves(void *user, const wh_command_t *command, const wh_state_t *state);

/* From now on motion control knows, for STATUS, which slice's state came last over a link that is not the
 * local cell's. Call it before the first slice. */
void wh_mcs_watch_slices(wh_mcs_t *mcs);

/* Sets the run up in the cell of this layout and pushes the layout as Lua sees it. In a trial the layout's
 * table must be on top of the stack. Raises if the cell cannot be set up. */
void wh_mcs_set_up(lua_State *L, wh_mcs_t *mcs, const wh_layout_t *layout);

/* Pushes the table of a layout that lua/mcs goes by. */
void wh_mcs_push_layout(lua_State *L, const wh_layout_t *layout);

/* Starts the layout's faults, after the layout is read. */
void wh_mcs_start_faults(wh_mcs_t *mcs);

/* Plans the segment table at stack index 1 from the track's place; the track has then begun it. Raises if
 * that fails. */
void wh_mcs_plan_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned);

/* The cost of these slices in the instruction budget: a slice takes as much time as about twenty
 * instructions of Lua. */
static inline uint64_t wh_mcs_steps(int64_t slices) {
    return 20 * (uint64_t)slices;
}

/* The codes of a station's slots (slot_codes.h), for the wafers as they lie. */
void wh_mcs_see_slots(const wh_mcs_t *mcs, const wh_station_t *place, const wh_mapping_t *mapping,
                      int codes[WH_LAYOUT_SLOTS]);

/* Takes each slice for the data that `edge` and `pass` collect; `user` is the wh_mcs_t. */
void wh_mcs_hear_slice(void *user, const wh_command_t *command, const wh_state_t *state);

void wh_mcs_free_lanes(wh_mcs_t *mcs);

void wh_mcs_free_edge(wh_mcs_edge_t *edge);
void wh_mcs_free_turns(wh_mcs_turns_t *turns);

/* From the end of the next slice on these beams latch, and this gripper's way is remembered. The beams are
 * assumed to stand where this base_from_station places them. Data collected before is deleted. */
void wh_mcs_arm(wh_mcs_t *mcs, wh_latch_order_t order, int32_t station, int32_t gripper,
                const wh_pose_t *believed);

/* Reads the first `count` numbers of the list at this absolute stack index; raises if one is not a
 * number. */
void wh_mcs_read_numbers(lua_State *L, int list, wh_real_t numbers[], size_t count);

/* The station's frame as motion control believes it for a robot: from the layout, or moved by the table at
 * this stack index, if there is one. See native.shift in believed.c. */
wh_pose_t wh_mcs_believed_station(lua_State *L, int shift, const wh_mcs_t *mcs, size_t station, size_t robot);

/* The offset from that frame, in base, mm, at which one of several robots was taught the station in a trial;
 * else zero. */
wh_vec3_t wh_mcs_drawn_aside(const wh_mcs_t *mcs, size_t station, size_t robot);

/* Pushes what motion control knows of an edge sensor of the layout: { samples: in a turn, pixels: of the
 * line, pixel, middle and length, mm, run_up: the angle in which the chuck comes from rest to its full
 * speed, believed: its errors as known from the layout }. A calibration must find the true ones. */
void wh_mcs_push_edge_sensor(lua_State *L, const wh_layout_t *layout, const wh_scanner_t *scanner);

/* Pushes { offset, zero, gain, latency }. */
void wh_mcs_push_sensor_error(lua_State *L, const wh_sensor_error_t *error);

/* Pushes the path of a file that the script names: relative to the script's own folder. */
const char *wh_mcs_push_path(lua_State *L, const wh_mcs_t *mcs, const char *name);

/* If the robot is one that moves and may no longer do so, its motion ends after this slice. */
void wh_mcs_end_refused_motion(wh_mcs_t *mcs, size_t robot);

/* Raises the condition by which this robot's motion has ended. */
void wh_mcs_raise_condition(lua_State *L, wh_mcs_t *mcs, size_t robot) __attribute__((noreturn));

/* Raises the condition of a robot with one of these axes if the segment moves them and it may not. */
void wh_mcs_check_segment(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment, uint32_t axes);

/* Functions of the native table, by file. */
extern const luaL_Reg wh_mcs_align_functions[];
extern const luaL_Reg wh_mcs_arrival_functions[];
extern const luaL_Reg wh_mcs_believed_functions[];
extern const luaL_Reg wh_mcs_flow_functions[];
extern const luaL_Reg wh_mcs_flow_played_functions[];
extern const luaL_Reg wh_mcs_flow_timed_functions[];
extern const luaL_Reg wh_mcs_flow_call_functions[];
extern const luaL_Reg wh_mcs_calibration_functions[];
extern const luaL_Reg wh_mcs_cell_functions[];
extern const luaL_Reg wh_mcs_centring_functions[];
extern const luaL_Reg wh_mcs_clock_functions[];
extern const luaL_Reg wh_mcs_clock_questions[];
extern const luaL_Reg wh_mcs_command_functions[];
extern const luaL_Reg wh_mcs_miss_functions[];
extern const luaL_Reg wh_mcs_controller_functions[];
extern const luaL_Reg wh_mcs_definition_functions[];
extern const luaL_Reg wh_mcs_describe_functions[];
extern const luaL_Reg wh_mcs_edge_functions[];
extern const luaL_Reg wh_mcs_fault_functions[];
extern const luaL_Reg wh_mcs_job_functions[];
extern const luaL_Reg wh_mcs_kind_functions[];
extern const luaL_Reg wh_mcs_lane_functions[];
extern const luaL_Reg wh_mcs_own_functions[];
extern const luaL_Reg wh_mcs_plan_functions[];
extern const luaL_Reg wh_mcs_play_functions[];
extern const luaL_Reg wh_mcs_port_functions[];
extern const luaL_Reg wh_mcs_query_functions[];
extern const luaL_Reg wh_mcs_saved_functions[];
extern const luaL_Reg wh_mcs_scan_functions[];
extern const luaL_Reg wh_mcs_teaching_functions[];

/* Pushes the function that checks a layout's stations for a survey, see lua/mcs/init.lua. */
void wh_mcs_push_survey(lua_State *L);

/* Pushes the function that makes definitions, see lua/mcs/definitions.lua. */
void wh_mcs_push_definitions(lua_State *L);

#endif
