/* The place where Lua scripts run: a Lua state with a memory cap, an instruction budget and no access to
 * the machine.
 *
 * Every script ends. An endless loop, an allocation without bound or an error comes back as a result with
 * file and line, and the process continues. A script behaves equally on every machine: tables are read in
 * sorted order, the trigonometry is the library's own, and scripts see no address and no clock.
 * sandbox_library.h lists the functions that a script has. A key that appears twice in a table literal is
 * an error, and so is an undefined global.
 *
 * Rules for the host:
 * - Enter Lua by the functions below. At the outermost level never call lua_pcall or lua_resume yourself: the
 *   limits need to know which coroutine runs. Inside a C function that Lua called, lua_call and lua_pcall are
 *   fine; resume no coroutine.
 * - A C function that loops for long charges the budget (wh_sandbox_charge), and holds no resource while it
 *   does.
 * - Give your own metatables a __metatable field, so that scripts cannot change them.
 * - Leave the process in the "C" locale (no setlocale): numbers and the order of texts depend on it.
 * - Use a sandbox from one thread at a time. Several sandboxes may live side by side.
 */
#ifndef WH_SCRIPT_SANDBOX_H
#define WH_SCRIPT_SANDBOX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <lua.h>

#define WH_SANDBOX_MEMORY_BYTES ((size_t)256 << 20)
#define WH_SANDBOX_INSTRUCTIONS UINT64_C(1000000000)
#define WH_SANDBOX_MESSAGE_BYTES 1024
/* The longest script or layout file. */
#define WH_SANDBOX_FILE_BYTES ((size_t)16 << 20)

/* Zero or null means the default. */
typedef struct {
    /* cap on all memory of Lua; live data may use 7/8 of it; default 256 MiB; a sandbox needs at least 128
     * KiB */
    size_t memory_bytes;
    uint64_t instructions; /* number of instructions until the budget is renewed; default 1e9 */
    /* allows all of Lua's libraries and native modules; the deterministic functions remain */
    bool trust;
    FILE *print_to; /* the caller's stream to which print writes; default stdout */
} wh_sandbox_limits_t;

/* The reason why a chunk ended. */
typedef enum {
    WH_SANDBOX_OK,
    WH_SANDBOX_ERROR,      /* it threw an error */
    WH_SANDBOX_BUDGET,     /* the instruction budget was spent */
    WH_SANDBOX_MEMORY,     /* the memory cap was reached */
    WH_SANDBOX_STOPPED,    /* wh_sandbox_stop was called */
    WH_SANDBOX_SYNTAX,     /* the text is not Lua; nothing ran */
    WH_SANDBOX_UNREADABLE, /* no such file, not a regular file, or too large; nothing ran */
} wh_sandbox_reason_t;

typedef struct {
    wh_sandbox_reason_t status;
    /* Empty if ok; otherwise "path:line: text", or "path: text" if no line is known. The path is as the
     * caller gave it. A message that does not fit ends in "...". It is never cut within a UTF-8
     * character. */
    char message[WH_SANDBOX_MESSAGE_BYTES];
} wh_sandbox_result_t;

typedef struct wh_sandbox wh_sandbox_t;

/* A new sandbox, which the caller frees. Returns null if the cap is too low for it. limits may be null: all
 * defaults. Cost: about 40 KiB, 0.1 ms. */
wh_sandbox_t *wh_sandbox_new(const wh_sandbox_limits_t *limits);

/* Closes the state and frees it. Finalizers of the host's userdata run. Null is allowed. */
void wh_sandbox_free(wh_sandbox_t *sandbox);

/* The state, for registering functions; the sandbox owns it. Calls that may raise an error need protection:
 * register from within a C function that wh_sandbox_call runs. */
lua_State *wh_sandbox_state(wh_sandbox_t *sandbox);

/* The sandbox of a state or coroutine, which must be one of ours. */
wh_sandbox_t *wh_sandbox_of(lua_State *L);

/* ------------------------------------------------------------------------------------------------ Running */

/* Reads the file, runs it and leaves the first value that it returns (or nil) on L's stack. Returns true if
 * it ended well; otherwise L's stack is unchanged. The file must be a regular file of text of at most
 * WH_SANDBOX_FILE_BYTES. A byte order mark is skipped, and so is a first line that begins with '#'. L is
 * the sandbox's state or, in a C function that Lua called, its state. If a limit is exhausted inside, the
 * calling script ends too. `result` may be null. */
bool wh_sandbox_evaluate(lua_State *L, const char *path, wh_sandbox_result_t *result);

/* wh_sandbox_evaluate for a text in memory, such as the library's own Lua sources; all of it is Lua. Messages
 * show `name` in place of a path. The text needs no final zero and is not kept. */
bool wh_sandbox_evaluate_text(lua_State *L, const char *name, const char *text, size_t size,
                              wh_sandbox_result_t *result);

/* wh_sandbox_evaluate for what Lua's compiler has made of one of the library's own sources, without names and
 * lines; `name` is its own. Lua trusts such code, so it must not come from outside. */
bool wh_sandbox_evaluate_code(lua_State *L, const char *name, const void *code, size_t size,
                              wh_sandbox_result_t *result);

/* lua_pcall with the sandbox's rules. Function and arguments are on L's stack; it leaves the results, or
 * nothing on failure. Messages begin without a path. */
bool wh_sandbox_call(lua_State *L, int arguments, int results, wh_sandbox_result_t *result);

/* wh_sandbox_call of a C function, whose only argument is the light userdata `argument`. It leaves nothing
 * on the stack. */
bool wh_sandbox_protect(lua_State *L, lua_CFunction function, void *argument, wh_sandbox_result_t *result);

/* Pushes the error value of the last chunk that failed, or nil if there was none. A numbered error is a
 * table. It needs one free stack slot. */
void wh_sandbox_push_error(lua_State *L);

/* The innermost line of the chunk named `path` on L's call stack; if it has left that by a tail call, its
 * last one, but within a coroutine; 0 if it is not among the first 1000 levels. */
int wh_sandbox_line(lua_State *L, const char *path);

/* The last line of the code of the function at a stack index, where its result is most likely made; 0 of what
 * is no function of Lua. */
int wh_sandbox_last_line(lua_State *L, int index);

/* Up to `room` of its lines on the call stack, the innermost first: where it is, and the lines from which it
 * called its own functions. Returns how many there are. */
size_t wh_sandbox_lines(lua_State *L, const char *path, int lines[], size_t room);

/* Room for the place of wh_sandbox_module_place. */
#define WH_SANDBOX_MODULE_BYTES 240

/* The innermost place on L's call stack, FILE:LINE, if it is in another user's file than the chunk named
 * `path`, such as a module; else "". A longer path loses its beginning. */
void wh_sandbox_module_place(lua_State *L, const char *path, char place[WH_SANDBOX_MODULE_BYTES]);

/* Names of chunks that messages never show begin with this: the library's own Lua files. No file can be
 * below it, so no user's path has such a name. */
#define WH_INNER_CHUNK "/dev/null/"

/* A message without the place at its beginning if that is in a chunk whose name begins with WH_INNER_CHUNK,
 * or in code without names and lines; otherwise the whole message. */
const char *wh_sandbox_skip_inner(const char *text);

/* ------------------------------------------------------------------------------------------------- Limits */

/* Subtracts steps from the budget for work done in C, such as a simulated slice or a scanned byte. It
 * raises an error if the budget is spent, so call it only where an error is allowed. Cost: a few ns. */
void wh_sandbox_charge(lua_State *L, uint64_t steps);

/* Fills the budget again, for the next command of a prompt. Do not call it while a chunk runs. */
void wh_sandbox_renew(wh_sandbox_t *sandbox);

/* Ends the running chunk at its next instruction. A signal handler of the thread that runs it may call
 * this. */
void wh_sandbox_stop(wh_sandbox_t *sandbox);

/* True if wh_sandbox_stop was called and the chunk has not ended yet. It is for C functions that work for a
 * long time between two charges. */
bool wh_sandbox_stopping(const wh_sandbox_t *sandbox);

/* Steps subtracted from the budget so far: VM instructions (counted by the thousand), charges of C
 * functions, and one for each 64 bytes of long strings and large blocks. */
uint64_t wh_sandbox_spent(const wh_sandbox_t *sandbox);

/* The most bytes that Lua held at any time. */
size_t wh_sandbox_memory_high_water(const wh_sandbox_t *sandbox);

/* --------------------------------------------------------------------------------------------- Parameters */

/* Sets params.NAME from "NAME=VALUE" (--set). NAME is a Lua identifier and not a reserved word. VALUE
 * becomes a number if all of it is a finite number in Lua's notation, otherwise true or false, otherwise a
 * string. A NAME can be set only once. Returns false, with a message that names the fault, if it is
 * refused; result may be null. */
bool wh_sandbox_set_parameter(wh_sandbox_t *sandbox, const char *assignment, wh_sandbox_result_t *result);

/* Returns false if each parameter that was set has been read. Otherwise `message` is "--set NAME: nobody
 * read params.NAME", for the first by name, and lists the read ones. If a script goes through params with
 * pairs, all count as read. */
bool wh_sandbox_find_unread(wh_sandbox_t *sandbox, char message[WH_SANDBOX_MESSAGE_BYTES]);

/* True if the parameter set by this "NAME=VALUE" was not read. */
bool wh_sandbox_is_unread(wh_sandbox_t *sandbox, const char *assignment);

/* wh_sandbox_new, then wh_sandbox_set_parameter for each of the assignments. Returns null, and the reason
 * in `result`, if out of memory or if a parameter is refused. */
wh_sandbox_t *wh_sandbox_new_with(const wh_sandbox_limits_t *limits, const char *const assignments[],
                                  size_t count, wh_sandbox_result_t *result);

#endif
