/* A file whose columns have other names, or whose rows tell something else: a Lua file says how it is read.
 *
 *     return {
 *       separator = ";",
 *       columns = { begin_s = { "StartTime", scale = 1e-3 }, robot = "Module",
 *                   wafer = function(row) ... end },
 *       actions = { Pick = "pick" },
 *       skip = function(row) return row.State ~= "Completed" end,
 *       expand = function(row) return { { action = "pick", ... }, ... } end,
 *     }
 *
 * It runs in the sandbox. `row` is a table from the names of the file's first line to texts. A column is the
 * name of one of theirs, one with a scale, or a function that returns a text, a number or nil. With `expand`
 * each row becomes a list of rows that have our columns; `columns` is not needed then. Numbers are seconds.
 */
#ifndef WH_SCHEDULE_MAP_H
#define WH_SCHEDULE_MAP_H

#include "../script/sandbox.h"
#include "read.h"

/* Reads a whole file by a map, like wh_schedule_read. */
bool wh_schedule_read_mapped(wh_schedule_t *schedule, const char *path, const char *map,
                             const wh_sandbox_limits_t *limits, char message[1600]);

#endif
