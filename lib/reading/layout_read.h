/* A layout out of its Lua file, read strictly: each field is known, has its type, and is within its range. */
#ifndef WH_READING_LAYOUT_READ_H
#define WH_READING_LAYOUT_READ_H

#include <lua.h>

#include "../layout/layout.h"
#include "../script/reader.h"
#include "../script/sandbox.h"

/* Reads the table on top of L's stack, which the layout file returned; it stays there. Fills in the defaults
 * and checks all that can be checked without moving: fields, ranges, names, where wafers lie and grippers
 * ride, strokes against slices. Raises a Lua error that names file, field path, value and what was expected.
 * Lua owns the layout's memory; the registry keeps the reference. Cost: linear in wafers, plus a sort. */
wh_layout_t *wh_layout_read(lua_State *L, const char *path);

/* Runs the file in the sandbox and reads what it returns. Null, and the reason in `result`, if that fails.
 * The layout lives as long as the sandbox. */
const wh_layout_t *wh_layout_load(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result);

/* wh_layout_load of a cell whose robots are times alone, for those who hold a schedule against it. Others are
 * refused, as these are by wh_layout_load. */
const wh_layout_t *wh_layout_load_timed(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result);

/* Reads the fault that the reader is at: a table with its kind, gripper or wafer, time and size. Raises the
 * reader's errors. `wafers` are the layout's as they lie now, and `first` is the slice that `after = 0`
 * means. */
wh_fault_t wh_layout_read_fault(wh_reader_t *reader, const wh_layout_t *layout, const wh_wafer_t wafers[],
                                int64_t first);

/* Reads the collision world again, for a copy of a layout whose stations stand elsewhere. The layout's table
 * is on top of the stack. The copy must outlive the state. Raises what wh_layout_read does. */
void wh_layout_read_trial_world(lua_State *L, wh_layout_t *trial_cell);

/* Reads `study` from the table on top of the stack and replaces the layout's own. Errors name the script
 * `path`. */
void wh_layout_read_own_study(lua_State *L, const char *path, wh_layout_t *layout);

/* Zeroed memory for `count` items that lives as long as the Lua state. */
void *wh_layout_memory(lua_State *L, size_t count, size_t size);

#endif
