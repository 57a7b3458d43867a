/* The Lua module `wh`: the proximity check and the grasp table, for scripts and for plain lua5.4.
 *
 *     local wh = require "wh"               -- wh.so on package.cpath; the program brings its own
 *
 * It is a thin binding: every value and every verdict is the library's. grasp/proximity.h and grasp/grasp.h
 * explain them. Lengths are in mm. Indices count from 1; "none" is nil.
 *
 * Tables
 *     pose        { r = {x, y, z}, R = {{..}, {..}, {..}} }: base_from_body. R is given row by row; its
 *                 columns are the body's axes; without R the body is not turned. r is required.
 *     tolerance   a preset's name, "paper" or "strict", or { projz =, projxy =, planar = }. A limit that is
 *                 left out is as in "paper"; nil is "paper".
 *     measurement dr, n1_proj_n2, dr_proj_z, dr_proj_xy, dr_proj_xy_norm: (1) to (5), dr and dr_proj_xy as
 *                 lists of three; ready; failed: { projz = true, projxy = true, planar = true }, only those
 *                 that failed; margin: { projz =, projxy =, planar = }, positive inside the limit.
 * Argument tables may have metatables (__index, __len). They are read before anything else happens, and
 * never kept or changed. Returned tables are new; the caller may change them.
 *
 * Functions
 *     wh.proximity(wafer, gripper [, tolerance])   the measurement of one pose against another
 *     wh.rim_gap(wafer, gripper, radius)           how far the wafer's rim is at most from the contact plane
 *     wh.tolerance([tolerance])                    its three limits as a table
 *     wh.cell { ... }                              a new cell:
 *         grippers     how many, 1 to 8
 *         wafers       a list of poses, one for each wafer, at most 1000000; may be empty
 *         tolerance    as above
 *         check        "sampled" (default) or "swept"
 *         seat         true: a picked wafer is drawn onto the pads; default false
 *         near_projz, near_projxy   neighbourhood for near misses, in (0, 1e6]; default 4.5 and 2 projxy
 *     wh.version       the library's version, such as "1.2.3"
 *     wh.errors        the catalogue math/status.def: NAME -> { number =, text = }
 *
 * Methods of a cell
 *     cell:step(inputs)      one slice. `inputs` is a list with { pose =, valve = } for each gripper, valve 0
 *                            (open: vacuum on) or 1 (closed). Returns the list of events, empty if nothing
 *                            happened. An event has
 *         kind               "picked", "released", "handed_over", "near_miss" or "contested"
 *         slice              the step that reports it, from 1
 *         measured_slice     the step in which its values were measured. For a near miss that is an earlier
 *                            one, of the closest approach; for a contest that of its beginning
 *         wafer, gripper     indices
 *         from               handed_over: the gripper that released it
 *         holder             contested: the gripper that held the wafer
 *         and the fields of a measurement, wafer against gripper
 *     cell:wafer(i)          pose of wafer i, and the index of the gripper that holds it or nil
 *     cell:held(gripper)     index of the wafer that a gripper holds, or nil
 *     cell:place(i, pose)    puts a free wafer at another place
 *     cell:hash()            16 hex digits over all that the next step depends on (wh_grasp_hash): equal
 *                            hashes mean equal runs from here on. Configuration and counters are left out.
 *     cell:counters()        { slices =, refused =, picked =, released =, handed_over =, near_misses =,
 *                            contested = }; refused counts the calls of step and place that raised an error
 *
 * Errors are strings raised with error(). They give the caller's place, the argument, the path of the field
 * within it, its value and the expected values. For a library status they have the text and, in brackets,
 * the number:
 *     t.lua:7: bad argument #1 to 'proximity' (wafer.R[2][3]: number expected, got nil)
 *     t.lua:8: bad argument #1 to 'cell' (tolerance.projyz: no such field (expected projz, projxy, planar))
 *     t.lua:9: bad argument #1 to 'step' (inputs[2].valve: 2 (expected 0, open, or 1, closed))
 *     t.lua:9: bad argument #1 to 'step' (inputs[1].pose: a matrix is no rotation (...) [3])
 * Unknown fields and surplus list entries are refused. Strings do not count as numbers; an integer may be
 * given as a float with a whole value. A call that raises an error leaves the cell unchanged, except its
 * counter. There is one exception: memory may run out while the events of a finished step are returned.
 *
 * Memory: a cell is one userdata, which Lua frees; 4 kB and 104 bytes for each wafer. Costs: as in
 * grasp/grasp.h, and about a microsecond for each pose in an argument or a result.
 */
#ifndef WH_SCRIPT_WH_MODULE_H
#define WH_SCRIPT_WH_MODULE_H

#include <lua.h>

/* Pushes the module's table: for `require`, or for luaL_requiref(L, "wh", luaopen_wh, 0) in a host. There
 * is no static data; any number of states may use it at the same time. */
int luaopen_wh(lua_State *L);

#endif
