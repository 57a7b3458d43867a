/* What the files of the sandbox share; nobody else includes it. */
#ifndef WH_SCRIPT_SANDBOX_INTERNAL_H
#define WH_SCRIPT_SANDBOX_INTERNAL_H

#include <signal.h>

#include <lauxlib.h>
#include <lualib.h>

#include "sandbox.h"

/* The count hook fires every so many instructions of a coroutine, and at each one once a limit is exhausted.
 */
#define WH_SANDBOX_GRANULE 1000

/* One entry into Lua: a file, a text or a call. Jobs nest (a script names a layout). */
typedef struct wh_sandbox_job {
    const char *path; /* null for a call */
    const char *text;
    size_t size;
    int results;
    bool loaded;                     /* past the syntax check */
    char short_source[LUA_IDSIZE];   /* how Lua abbreviates the path in its own messages */
    int line;                        /* of path, where the error came from; 0 unknown */
    bool line_is_final;              /* an exhausted limit has set it; what follows is unwinding */
    int refused_line;                /* where the allocator last said no */
    struct wh_sandbox_job *outer;    /* null for the outermost */
    lua_State *outer_running;        /* to go back to */
    struct wh_sandbox *outer_strict; /* likewise */
} wh_sandbox_job_t;

struct wh_sandbox {
    lua_State *main;
    lua_State *running; /* the coroutine whose instructions run now */
    wh_sandbox_job_t *job;
    FILE *print_to;
    bool trust;
    int loading; /* > 0 while a text is compiled */
    /* limits */
    uint64_t budget, spent;
    size_t memory_cap, memory, memory_high_water;
    size_t largest_block; /* the largest allocation of 64 KiB or more so far: what a scan of one table may
                             cost */
    bool refused;         /* the allocator has said no in this run */
    bool brimming;        /* the memory has gone above the brim since the hook last looked */
    volatile sig_atomic_t stop;
    wh_sandbox_reason_t fatal;  /* BUDGET, MEMORY or STOPPED once exhausted, else OK */
    wh_sandbox_reason_t reason; /* of the last job */
    /* a fractional exponent that pow was asked for and the hook has yet to report */
    bool power_pending;
    double power_exponent;
    int power_line;
    char power_source[LUA_IDSIZE];
};

/* ---- sandbox_memory.c ---- */
void *wh_sandbox_allocate(void *sandbox, void *block, size_t old_size, size_t new_size);
/* Above this much, seven eighths of the cap, the hook collects garbage; what then stays above has reached the
 * cap. The buffers of lauxlib bypass the collection that Lua makes before it reports a refusal: the rest is
 * room for them. */
size_t wh_sandbox_memory_brim(const wh_sandbox_t *sandbox);

/* ---- sandbox_budget.c ---- */
/* Anchors the messages in the registry and sets the hook. May raise. */
void wh_sandbox_budget_open(lua_State *L);
/* Adds to spent without raising; makes the hook fire at the next instruction when that is too much. */
void wh_sandbox_spend(wh_sandbox_t *sandbox, uint64_t steps);
/* Makes the hook fire at the running coroutine's next instruction. */
void wh_sandbox_alarm(wh_sandbox_t *sandbox);
/* Enters the exhausted state; the first call in a run wins. L is where it happened. */
void wh_sandbox_exhaust(lua_State *L, wh_sandbox_reason_t reason);
/* The error that ended a protected call is on L's top: was it an exhausted limit? */
bool wh_sandbox_is_fatal(lua_State *L, int status);
/* Raises the exhausted limit's error. */
int wh_sandbox_raise(lua_State *L);
/* "instruction budget of N spent" and the like. */
void wh_sandbox_fatal_text(const wh_sandbox_t *sandbox, char *text, size_t size);

/* ---- sandbox_message.c ---- */
/* Handler of protected calls: notes the line, keeps the value. */
int wh_sandbox_handler(lua_State *L);
/* Writes "path:line: text" for the error value on L's top and pops it. */
void wh_sandbox_report(lua_State *L, const wh_sandbox_job_t *job, char message[WH_SANDBOX_MESSAGE_BYTES]);

/* ---- sandbox_source.c ---- */
/* Reads all of a regular file. Returns null and sets *text (malloc'd; the caller frees it) and *size, or says
 * why not in constant or thread-local text. */
const char *wh_source_read(const char *path, char **text, size_t *size);
/* The part of a text that is Lua: without byte order mark and first '#' line (its line break stays). */
const char *wh_source_begin(const char *text, size_t *size);

/* ---- pow.c ---- */
/* The sandbox whose scripts run on this thread: `^` is strict in it. Returns the one before. */
wh_sandbox_t *wh_pow_set_strict(wh_sandbox_t *sandbox);
wh_sandbox_t *wh_pow_strict(void);

/* ---- sandbox_library.c and the subjects ---- */
/* Builds the environment; called protected, once. */
int wh_sandbox_library_open(lua_State *L);
/* Sets functions in the table on top; entries with a null function remove the name. */
void wh_library_set(lua_State *L, const luaL_Reg *functions);
/* Replaces functions of the table on top by closures that charge (bytes of string arguments >> shift) first.
 */
void wh_library_charge_strings(lua_State *L, const char *const *names, int shift);
/* luaL_tolstring without addresses: pushes the text and returns it. */
const char *wh_library_tostring(lua_State *L, int index, size_t *length);
/* Each works on the globals and library tables that luaL_requiref has opened. */
void wh_library_open_base(lua_State *L, bool trust);
void wh_library_open_protect(lua_State *L);
void wh_library_open_order(lua_State *L);
void wh_library_open_math(lua_State *L);
void wh_library_open_table(lua_State *L);
void wh_library_open_string(lua_State *L, bool trust);
void wh_library_open_pattern(lua_State *L);

#endif
