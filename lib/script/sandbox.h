/* Where Lua scripts run: a state with a memory cap, an instruction budget and no way out to the machine.
 *
 * A script in a sandbox ends: an endless loop, a runaway allocation or a thrown error comes back as a result
 * with the file and line, and the process lives on. The same script does the same on every machine: named
 * tables are read in sorted order, the math is the library's own, no address and no clock can be seen
 * (sandbox_library.h lists what a script finds).
 *
 * Rules for the host:
 * - Enter Lua by the functions below, never by lua_pcall or lua_resume of your own at the outermost level:
 * they keep track of which coroutine runs, which the limits need. Inside a C function called from Lua,
 * lua_call and lua_pcall are fine; resume coroutines by wh_sandbox_resume.
 * - A C function that loops for long charges the budget (wh_sandbox_charge) and holds no resource while it
 * does.
 * - Give metatables of your own a __metatable field, so that scripts cannot change them.
 * - Leave the process in the "C" locale (no setlocale): numbers and string order depend on it.
 * - One thread at a time per sandbox. Several sandboxes may live side by side.
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
/* A script or layout file may be this long. */
#define WH_SANDBOX_FILE_BYTES ((size_t)16 << 20)

/* A zero or null field means its default. */
typedef struct {
    size_t memory_bytes; /* cap on all that Lua holds, live data to 7/8 of it; default 256 MiB; below 128 KiB
                            nothing starts */
    uint64_t instructions; /* budget of the sandbox until it is renewed; default 1e9 */
    bool trust;     /* all of Lua's libraries, native modules too; the deterministic replacements stay */
    FILE *print_to; /* where print writes; borrowed; default stdout */
} wh_sandbox_limits_t;

/* Why the last chunk ended. */
typedef enum {
    WH_SANDBOX_OK,
    WH_SANDBOX_ERROR,      /* it threw an error */
    WH_SANDBOX_BUDGET,     /* the instruction budget was spent */
    WH_SANDBOX_MEMORY,     /* the memory cap was reached */
    WH_SANDBOX_STOPPED,    /* wh_sandbox_stop was called */
    WH_SANDBOX_SYNTAX,     /* the text is no Lua; nothing of it ran */
    WH_SANDBOX_UNREADABLE, /* no such file, no regular file, too large; nothing ran */
} wh_sandbox_reason_t;

typedef struct {
    wh_sandbox_reason_t status;
    /* Empty when ok; else "path:line: text", or "path: text" where no line is known, the path as it was
     * handed in. One that does not fit ends in "...". Never cut within a UTF-8 character. */
    char message[WH_SANDBOX_MESSAGE_BYTES];
} wh_sandbox_result_t;

typedef struct wh_sandbox wh_sandbox_t;

/* A new sandbox, or null when there is no memory for it (the cap counts). limits may be null: all defaults.
 * The caller frees it. Cost: about 40 KiB, 0.1 ms. */
wh_sandbox_t *wh_sandbox_new(const wh_sandbox_limits_t *limits);

/* Closes the state (finalizers of the host's userdata run) and frees it all. Null is allowed. */
void wh_sandbox_free(wh_sandbox_t *sandbox);

/* The state, to register functions in; owned by the sandbox. Calls that may raise need protection: register
 * from within a C function run by wh_sandbox_call. */
lua_State *wh_sandbox_state(wh_sandbox_t *sandbox);

/* The sandbox that a state or coroutine belongs to; not for a state that is none of ours. */
wh_sandbox_t *wh_sandbox_of(lua_State *L);

/* ---- Running ---- */

/* Reads the file, runs it and drops what it returns. Only regular files of text up to WH_SANDBOX_FILE_BYTES;
 * a first line that begins with '#' is skipped, a byte order mark too. True when it ended well; result may be
 * null. */
bool wh_sandbox_run(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result);

/* The same, but leaves the first returned value (or nil) on L's stack; on failure L's stack is as it was. L
 * is the sandbox's state or, in a C function called from Lua, the state it was given. A budget spent inside
 * ends the calling script too. */
bool wh_sandbox_evaluate(lua_State *L, const char *path, wh_sandbox_result_t *result);

/* The same for a text in memory (the library's own Lua sources, a line typed at a prompt); name stands in
 * messages where a path would. text needs no final zero and is not kept. */
bool wh_sandbox_evaluate_text(lua_State *L, const char *name, const char *text, size_t size,
                              wh_sandbox_result_t *result);

/* lua_pcall with the sandbox's rules: function and arguments are on L's stack; leaves results, or nothing on
 * failure. Messages have no path of their own. */
bool wh_sandbox_call(lua_State *L, int arguments, int results, wh_sandbox_result_t *result);

/* lua_resume with the sandbox's rules; same arguments and result. An exhausted limit inside is raised in
 * `from`. */
int wh_sandbox_resume(lua_State *co, lua_State *from, int arguments, int *results);

/* Pushes the value that the last failed chunk threw (a numbered error is a table), nil if there was none.
 * Needs one free stack slot. */
void wh_sandbox_push_error(lua_State *L);

/* The innermost line of the chunk named path on L's call stack; 0 if there is none among the first 1000 levels. */
int wh_sandbox_line(lua_State *L, const char *path);

/* Why the last chunk ended. */
wh_sandbox_reason_t wh_sandbox_reason(const wh_sandbox_t *sandbox);

/* ---- Limits ---- */

/* Takes steps off the budget for work done in C: a simulated slice, a scanned byte. Raises when it is spent,
 * so call it where an error may pass. No effect in a state that is none of ours. Cost: a few ns. */
void wh_sandbox_charge(lua_State *L, uint64_t steps);

/* A full budget again, for the next command of a prompt. Not while a chunk runs. */
void wh_sandbox_renew(wh_sandbox_t *sandbox);

/* Ends the running chunk at its next instruction. May be called from a signal handler of the thread that runs
 * it. */
void wh_sandbox_stop(wh_sandbox_t *sandbox);

/* Whether wh_sandbox_stop was called and the chunk has not ended yet: for C functions that are long at work
 * between two charges. */
bool wh_sandbox_stopping(const wh_sandbox_t *sandbox);

/* Steps taken off the budget so far: VM instructions (counted by the thousand), charges of C functions, and
 * one per 64 bytes of long strings and large blocks. */
uint64_t wh_sandbox_spent(const wh_sandbox_t *sandbox);

/* Bytes that Lua holds now, and the most that it ever held. */
size_t wh_sandbox_memory(const wh_sandbox_t *sandbox);
size_t wh_sandbox_memory_high_water(const wh_sandbox_t *sandbox);

/* ---- Parameters ---- */

/* Sets params.NAME from "NAME=VALUE" (--set). NAME is a Lua identifier and no reserved word. VALUE becomes a
 * number when all of it is a finite one as Lua writes them, else true or false, else a string. False, with a
 * message that names the fault, when it is refused; result may be null. */
bool wh_sandbox_set_parameter(wh_sandbox_t *sandbox, const char *assignment, wh_sandbox_result_t *result);

/* wh_sandbox_new, then wh_sandbox_set_parameter for each of the assignments. Null, and the reason in `result`, if out of memory
 * or if a parameter is refused. */
wh_sandbox_t *wh_sandbox_new_with(const wh_sandbox_limits_t *limits, const char *const assignments[],
                                  size_t count, wh_sandbox_result_t *result);

#endif
