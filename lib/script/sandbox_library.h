/* The functions that a script in a sandbox has. This is a page to read; it declares nothing.
 *
 * Present: assert, error, getmetatable, ipairs, load, next, pairs, pcall, print, rawequal, rawget, rawlen,
 * rawset, require, select, setmetatable, tonumber, tostring, type, xpcall, _G, _VERSION, params, and the
 * tables coroutine, math, string, table and utf8. Absent: os, io, debug, package, dofile, loadfile,
 * collectgarbage, warn, string.dump, math.exp, math.log, math.pow and similar ones. --trust adds all of
 * Lua's libraries but changes nothing below that is marked (D).
 *
 * Differences from the Lua 5.4 manual:
 * - (D) pairs and next go through a table's keys in order: numbers by value, strings by bytes, false, true.
 *   Other keys (tables, functions) raise an error. pairs takes a snapshot of the keys, in O(n log n) time and
 *   48 n bytes: keys added during the loop are not visited, removed ones are skipped. next looks at all keys:
 *   O(n) each, so a loop over next is O(n^2); next(t) == nil is the test for emptiness. __pairs is honoured.
 * - (D) tostring, print and string.format("%s") show a table as "table", a function as "function" and so on,
 *   or by its __tostring or __name; never an address. %p is refused. A NaN is "nan" without a sign.
 * - (D) math.sin, cos, tan, asin, acos, atan are the library's own. Angles go up to 1e5; asin and acos take
 *   [-1, 1]; anything else is an error. deg and rad are there.
 * - (D) math.random starts from the same seed in each sandbox; math.randomseed needs its argument.
 * - (D) x ^ y needs a whole-number y, and is exact by repeated squaring; any other y is an error. math.sqrt
 *   is there.
 * - (D) table.sort is stable, and takes O(n log n) comparisons for any comparison function.
 * - (D) pcall, xpcall and coroutines pass an exhausted limit on. An error that ends a coroutine closes its
 *   to-be-closed variables at once; coroutine.wrap passes error values on as they are.
 * - (D) xpcall calls its handler after the stack has been unwound: debug.traceback sees the caller.
 * - (D) Reading a global that nobody defined is an error, unless a module does it that only --trust finds.
 *   rawget(_G, name) asks without an error. setmetatable(_G, ...) takes the place of this.
 * - (D) A file with a table literal in which a key appears twice is refused.
 * - (D) require takes names with dots between them, of files in and below the folder of the file that calls,
 *   before it looks where Lua looks. A module runs once.
 * - (D) params has nil for a parameter that was not set.
 * - (D) print shows a control character as \xNN, except line ends and tabs. In messages these are blanks.
 * - (D) Reading a function of math that is absent is an error, which says why; string.dump likewise without
 *   --trust. A module that only --trust finds gets nil, as rawget(math, name) does.
 * - load takes a string of Lua text, not a function or a binary chunk.
 * - setmetatable refuses a metatable with __gc or __mode: their effect depends on the garbage collector.
 *   getmetatable of a string gives false, of a userdata its __metatable field or false.
 * - table.insert, remove, sort, concat and unpack refuse a table with __len, and take nothing but tables.
 * - Functions in C charge the instruction budget for their work: patterns for each step of the matcher, the
 *   table functions for each element, others for the bytes that they read or make.
 *
 * Three things may still differ between machines: the sign of a NaN in `..`, the native byte order of
 * string.pack, and a __mode that is put into a metatable after it was set.
 *
 * A budget cannot bound the time of one instruction. The worst known are comparing two equal strings of
 * half the memory cap (10 ms), passing a million varargs on (1 ms), an __index chain of 2000 tables (20
 * us).
 */
#ifndef WH_SCRIPT_SANDBOX_LIBRARY_H
#define WH_SCRIPT_SANDBOX_LIBRARY_H
#endif
