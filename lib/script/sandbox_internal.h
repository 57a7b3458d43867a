/* Shared by the files of the sandbox. Only they and the fuzzers include it. */
#ifndef WH_SCRIPT_SANDBOX_INTERNAL_H
#define WH_SCRIPT_SANDBOX_INTERNAL_H

#include <signal.h>

#include <lauxlib.h>
#include <lualib.h>

#include "sandbox.h"

/* The count hook fires after this many instructions of a coroutine, and at each one once a limit is
 * exhausted. */
#define WH_SANDBOX_GRANULE 1000

/* One entry into Lua: a file, a text or a call. Jobs nest: a script names a layout, which is then run,
 * too. */
typedef struct wh_sandbox_job {
    const char *path; /* null for a call */
    const char *text; /* null for a file */
    bool is_code;     /* the text is what Lua compiled */
    size_t size;
    int results;
    bool loaded;                     /* past the syntax check */
    char short_source[LUA_IDSIZE];   /* the path as Lua abbreviates it in its own messages */
    int line;                        /* the line of the error in `path`; 0: unknown */
    lua_State *state;                /* the state in which it was entered */
    struct wh_sandbox_job *outer;    /* null for the outermost */
    lua_State *outer_running;        /* restored at the end */
    struct wh_sandbox *outer_strict; /* restored at the end */
} wh_sandbox_job_t;

/* True if a chunk's name, or a text, begins with WH_INNER_CHUNK. */
bool wh_sandbox_is_inner(const char *name);

/* A file and its line, as messages have it. */
#define WH_SANDBOX_PLACE_BYTES (WH_SANDBOX_MESSAGE_BYTES - 100)

/* The most bytes that the prints of one run may write. */
#define WH_SANDBOX_PRINT_BYTES ((size_t)16 << 20)

/* Blocks of less than so many steps of 16 bytes are small. */
#define WH_SANDBOX_BLOCK_KINDS 33

typedef struct {
    char *region;
    size_t size, used;
    void *free[WH_SANDBOX_BLOCK_KINDS]; /* by steps: each begins with the address of the next one */
} wh_sandbox_blocks_t;

struct wh_sandbox {
    lua_State *main;
    wh_sandbox_blocks_t blocks;
    lua_State *running; /* the coroutine whose instructions run now */
    wh_sandbox_job_t *job;
    FILE *print_to;
    bool trust;
    int loading; /* > 0 while a text is compiled */
    /* limits */
    uint64_t budget, spent;
    size_t printed;
    size_t memory_cap, memory, memory_high_water;
    /* the largest allocation so far of 64 KiB or more: bounds the cost of one scan of a table */
    size_t largest_block;
    bool refused; /* the allocator has refused in this run, and the place of the last refusal */
    char refused_place[WH_SANDBOX_PLACE_BYTES];
    bool brimming; /* memory went above the brim since the hook's last check */
    volatile sig_atomic_t stop;
    wh_sandbox_reason_t fatal;                /* BUDGET, MEMORY or STOPPED once exhausted, else OK */
    char fatal_place[WH_SANDBOX_PLACE_BYTES]; /* its place; empty if in no file */
    /* A fractional exponent that pow was called with; the hook has not reported it yet. */
    bool power_pending;
    double power_exponent;
    int power_line;
    char power_source[LUA_IDSIZE];
};

/* --------------------------------------------------------------------------------------- sandbox_blocks.c */
void wh_sandbox_blocks_open(wh_sandbox_blocks_t *blocks);
/* All blocks must have been freed. */
void wh_sandbox_blocks_close(wh_sandbox_blocks_t *blocks);
/* Like realloc and free, with the size that the block has; `size` is above 0. */
void *wh_sandbox_block_resize(wh_sandbox_blocks_t *blocks, void *block, size_t held, size_t size);
void wh_sandbox_block_free(wh_sandbox_blocks_t *blocks, void *block, size_t held);

/* --------------------------------------------------------------------------------------- sandbox_memory.c */
void *wh_sandbox_allocate(void *sandbox, void *block, size_t old_size, size_t new_size);
/* The brim: seven eighths of the cap. Above it the hook collects garbage; memory that remains above it has
 * reached the cap. The rest is room for the buffers of lauxlib, because they bypass the collection that Lua
 * makes before it reports a refusal. */
size_t wh_sandbox_memory_brim(const wh_sandbox_t *sandbox);

/* --------------------------------------------------------------------------------------- sandbox_budget.c */
/* Keeps the messages in the registry and sets the hook. It may raise an error. */
void wh_sandbox_budget_open(lua_State *L);
/* Adds to `spent` without raising. If that is too much, makes the hook fire at the next instruction. */
void wh_sandbox_spend(wh_sandbox_t *sandbox, uint64_t steps);
/* Makes the hook fire at the running coroutine's next instruction. */
void wh_sandbox_alarm(wh_sandbox_t *sandbox);
/* True if the error on L's top, which ended a protected call, is an exhausted limit. */
bool wh_sandbox_is_fatal(lua_State *L, int status);
/* Raises the exhausted limit's error. */
int wh_sandbox_raise(lua_State *L);
/* "instruction budget of N spent" and similar texts. */
void wh_sandbox_fatal_text(const wh_sandbox_t *sandbox, char *text, size_t size);
/* The place of the file that L runs or that is being loaded: "layout.lua:12", or empty. It needs no
 * memory. */
void wh_sandbox_find_place(const wh_sandbox_t *sandbox, lua_State *L, char place[WH_SANDBOX_PLACE_BYTES]);

/* -------------------------------------------------------------------------------------------------- pow.c */
/* Sets the sandbox whose scripts run on this thread: `^` is strict in it. Returns the previous one. */
wh_sandbox_t *wh_pow_set_strict(wh_sandbox_t *sandbox);

/* --------------------------------------------------------------------- sandbox_library.c and the subjects */
/* Builds the environment. It is called once, protected. */
int wh_sandbox_library_open(lua_State *L);
/* Sets functions in the table on top: closures whose upvalue is the replaced function. A null function
 * removes the name. */
void wh_library_set(lua_State *L, const luaL_Reg *functions);
/* In such a closure: calls the replaced function with its arguments. */
int wh_library_call_stock(lua_State *L);
/* Makes these functions of the table on top charge (bytes of string arguments >> shift) before they run. */
void wh_library_charge_strings(lua_State *L, const char *const *names, int shift);
/* luaL_tolstring without addresses: pushes the text and returns it. */
const char *wh_library_tostring(lua_State *L, int index, size_t *length);
/* Replacements of globals, or of functions of the library of that name. */
extern const luaL_Reg wh_library_protect[], wh_library_order[], wh_library_modules[];
extern const luaL_Reg wh_library_coroutine[], wh_library_math[], wh_library_string[], wh_library_table[];
/* Gives the stock math.random its seed. */
void wh_library_start_random(lua_State *L);
/* Prepare the metatables of globals and of strings, and params. */
void wh_library_open_globals(lua_State *L);
/* Reading a missing function of one of Lua's libraries gives its replacement. */
void wh_library_open_absent(lua_State *L);
void wh_library_open_string(lua_State *L);
void wh_library_open_params(lua_State *L);
/* A sorted list of the texts that are keys of the table on top of the stack, and of `*count` words; it
 * counts them. The table then owns the list. Because it is sorted, the nearest one is equal on every
 * machine. */
const char **wh_library_list_names(lua_State *L, const char *const words[], size_t *count);
/* If the value at the index is `params`, it gets all its parameters as fields of its own; they then count
 * as read. It is for functions that see a table without its metatable. */
void wh_params_fill(lua_State *L, int index);

/* --------------------------------------------------------------------------------------------- literals.c */
/* Raises "SOURCE:LINE: KEY: ..." for the first key that appears twice in one table literal of a compiled
 * text; Lua keeps the last value without a message. It compares names, texts without escapes, whole numbers
 * and places in a list; other keys are known only at run time. Cost: linear. */
void wh_literals_refuse_twice(lua_State *L, const char *source, const char *text, size_t size);

/* -------------------------------------------------------------------------------------- sandbox_modules.c */
/* The text of a file of `size` bytes, and its size without a byte order mark and a first line of '#'.
 * Pushes the userdata that owns it. */
const char *wh_sandbox_read_text(lua_State *L, const char *path, size_t *size);
/* Keeps the function on top of the stack as the chunk of that name, for its lines. */
void wh_sandbox_keep_chunk(lua_State *L, const char *name);
/* Notes that a chunk is a script, a layout or a module of theirs, or tests it. */
void wh_sandbox_own(lua_State *L, const char *chunk_name);
bool wh_sandbox_owns(lua_State *L, const char *chunk_name);

#endif
