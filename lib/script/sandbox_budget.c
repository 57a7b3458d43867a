/* The instruction budget: a count hook in every coroutine, charges from C functions, and the effects of an
 * exhausted limit.
 *
 * A script cannot catch an exhausted limit. From then on the hook fires at each instruction, and pcall,
 * xpcall and the coroutine functions (sandbox_protect.c) pass the error on.
 */
#include <inttypes.h>
#include <string.h>

#include <lauxlib.h>

#include "sandbox_internal.h"

/* Levels of the call stack that are searched for a line. A runaway recursion has a hundred thousand. */
#define SEARCHED_LEVELS 1000

/* Registry keys of the messages. They are made beforehand, because raising must not need memory. */
static const char message_keys[WH_SANDBOX_UNREADABLE + 1] = {0};

wh_sandbox_t *wh_sandbox_of(lua_State *L) {
    void *opaque = NULL;
    (void)lua_getallocf(L, &opaque);
    return opaque;
}

void wh_sandbox_fatal_text(const wh_sandbox_t *sandbox, char *text, size_t size) {
    const size_t cap = sandbox->memory_cap;
    const bool in_mib = cap >> 20 << 20 == cap;
    if (sandbox->fatal == WH_SANDBOX_BUDGET) {
        snprintf(text, size, "instruction budget of %" PRIu64 " spent", sandbox->budget);
    } else if (sandbox->fatal == WH_SANDBOX_MEMORY) {
        snprintf(text, size, "memory cap of %zu %s reached", in_mib ? cap >> 20 : cap >> 10,
                 in_mib ? "MiB" : "KiB");
    } else {
        snprintf(text, size, "stopped");
    }
}

/* The registry's chunks of files by name, see wh_sandbox_keep_chunk. */
#define CHUNKS "waferhand.chunks"

void wh_sandbox_keep_chunk(lua_State *L, const char *name) {
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, CHUNKS);
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, name);
    lua_pop(L, 1);
}

int wh_sandbox_last_line(lua_State *L, int index) {
    lua_Debug function;
    int last = 0;
    lua_pushvalue(L, index);
    if (!lua_getinfo(L, ">SL", &function) || !lua_istable(L, -1)) {
        lua_pop(L, 1);
        return 0;
    }
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        const int line = (int)lua_tointeger(L, -2);
        const bool is_end = line == function.lastlinedefined && line > function.linedefined;
        last = line > last && !is_end ? line : last;
    }
    lua_pop(L, 1);
    return last;
}

/* A chunk that ends with the call of a word as its result has left the stack. */
static int find_end(lua_State *L, const char *path) {
    int line = 0;
    (void)luaL_getsubtable(L, LUA_REGISTRYINDEX, CHUNKS);
    lua_pushfstring(L, "@%s", path);
    if (lua_rawget(L, -2) == LUA_TFUNCTION) {
        line = wh_sandbox_last_line(L, -1);
    }
    lua_pop(L, 2);
    return line;
}

int wh_sandbox_line(lua_State *L, const char *path) {
    int line = 0;
    (void)wh_sandbox_lines(L, path, &line, 1);
    if (line == 0) {
        const bool is_main = lua_pushthread(L) == 1;
        lua_pop(L, 1);
        return is_main ? find_end(L, path) : 0;
    }
    return line;
}

size_t wh_sandbox_lines(lua_State *L, const char *path, int lines[], size_t room) {
    lua_Debug frame;
    size_t count = 0;
    for (int level = 0; count < room && level < SEARCHED_LEVELS && lua_getstack(L, level, &frame); ++level) {
        if (lua_getinfo(L, "Sl", &frame) && frame.currentline > 0 && frame.source[0] == '@' &&
            strcmp(frame.source + 1, path) == 0) {
            lines[count++] = frame.currentline;
        }
    }
    return count;
}

/* The innermost place on L's stack that is in a user's file. Returns false if there is none. */
static bool find_frame(lua_State *L, lua_Debug *frame) {
    for (int level = 0; level < SEARCHED_LEVELS && lua_getstack(L, level, frame); ++level) {
        if (lua_getinfo(L, "Sl", frame) && frame->currentline > 0 && frame->source[0] == '@' &&
            !wh_sandbox_is_inner(frame->source + 1)) {
            return true;
        }
    }
    return false;
}

void wh_sandbox_module_place(lua_State *L, const char *path, char place[WH_SANDBOX_MODULE_BYTES]) {
    lua_Debug frame;
    place[0] = '\0';
    if (find_frame(L, &frame) && strcmp(frame.source + 1, path) != 0) {
        const char *file = frame.source + 1;
        const size_t length = strlen(file);
        const size_t most = WH_SANDBOX_MODULE_BYTES - 20;
        (void)snprintf(place, WH_SANDBOX_MODULE_BYTES, "%s%s:%d", length > most ? "..." : "",
                       length > most ? file + length - most + 3 : file, frame.currentline);
    }
}

/* The innermost file on L's stack. Returns false if there is none. */
static bool find_file(lua_State *L, char place[WH_SANDBOX_PLACE_BYTES]) {
    lua_Debug frame;
    const bool found = find_frame(L, &frame);
    if (found) {
        snprintf(place, WH_SANDBOX_PLACE_BYTES, "%.900s:%d", frame.source + 1, frame.currentline);
    }
    return found;
}

void wh_sandbox_find_place(const wh_sandbox_t *sandbox, lua_State *L, char place[WH_SANDBOX_PLACE_BYTES]) {
    const wh_sandbox_job_t *job = sandbox->job;
    place[0] = '\0';
    if (job != NULL && job->path != NULL && !job->loaded && !wh_sandbox_is_inner(job->path)) {
        snprintf(place, WH_SANDBOX_PLACE_BYTES, "%.900s", job->path);
        return;
    }
    bool found = find_file(L, place);
    for (; !found && job != NULL; job = job->outer) {
        found = find_file(job->state, place);
    }
}

/* Enters the exhausted state. The first call in a run decides the reason. L is the state in which it
 * happened. */
static void exhaust(lua_State *L, wh_sandbox_reason_t reason) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (sandbox->fatal != WH_SANDBOX_OK) {
        return;
    }
    sandbox->fatal = reason;
    if (reason == WH_SANDBOX_MEMORY && sandbox->refused) {
        memcpy(sandbox->fatal_place, sandbox->refused_place, sizeof sandbox->fatal_place);
    } else {
        wh_sandbox_find_place(sandbox, L, sandbox->fatal_place);
    }
    wh_sandbox_alarm(sandbox);
}

int wh_sandbox_raise(lua_State *L) {
    const wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &message_keys[sandbox->fatal]);
    return lua_error(L);
}

bool wh_sandbox_is_fatal(lua_State *L, int status) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    /* lauxlib's buffers report a refusal as an ordinary error with this text. */
    const bool buffer_refused = sandbox->refused && lua_type(L, -1) == LUA_TSTRING &&
                                strcmp(lua_tostring(L, -1), "not enough memory") == 0;
    if (status == LUA_ERRMEM || buffer_refused) {
        exhaust(L, WH_SANDBOX_MEMORY);
    }
    return sandbox->fatal != WH_SANDBOX_OK;
}

static void on_count(lua_State *L, lua_Debug *event);

/* Collects garbage if the memory is above the brim, and charges for the work. */
static void check_brim(lua_State *L, wh_sandbox_t *sandbox) {
    if (!sandbox->brimming) {
        return;
    }
    wh_sandbox_spend(sandbox, sandbox->memory >> 6);
    lua_gc(L, LUA_GCCOLLECT);
    sandbox->brimming = false;
    if (sandbox->memory > wh_sandbox_memory_brim(sandbox)) {
        /* the line to report is here, not that of an earlier refusal, which a collection repaired */
        sandbox->refused = false;
        exhaust(L, WH_SANDBOX_MEMORY);
    }
}

static void check_stop_and_budget(lua_State *L, const wh_sandbox_t *sandbox) {
    if (sandbox->stop) {
        exhaust(L, WH_SANDBOX_STOPPED);
    }
    if (sandbox->spent > sandbox->budget) {
        exhaust(L, WH_SANDBOX_BUDGET);
    }
}

/* The alarm set the count to 1. After it the hook returns to its usual rate, so that a false alarm costs
 * little. */
static void check_limits(lua_State *L, wh_sandbox_t *sandbox) {
    const int count = lua_gethookcount(L);
    if (count != WH_SANDBOX_GRANULE) {
        lua_sethook(L, on_count, LUA_MASKCOUNT, WH_SANDBOX_GRANULE);
    }
    wh_sandbox_spend(sandbox, (uint64_t)count);
    check_brim(L, sandbox);
    check_stop_and_budget(L, sandbox);
}

static void on_count(lua_State *L, lua_Debug *event) {
    (void)event;
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (sandbox->fatal == WH_SANDBOX_OK) {
        check_limits(L, sandbox);
    }
    if (sandbox->fatal != WH_SANDBOX_OK) {
        lua_sethook(L, on_count, LUA_MASKCOUNT, 1);
        wh_sandbox_raise(L);
    }
    if (sandbox->power_pending) {
        sandbox->power_pending = false;
        lua_pushfstring(L, "%s:%d: '^' needs a whole-number exponent; got %f", sandbox->power_source,
                        sandbox->power_line, sandbox->power_exponent);
        lua_error(L);
    }
}

void wh_sandbox_alarm(wh_sandbox_t *sandbox) {
    if (sandbox->running != NULL) {
        lua_sethook(sandbox->running, on_count, LUA_MASKCOUNT, 1);
    }
}

void wh_sandbox_spend(wh_sandbox_t *sandbox, uint64_t steps) {
    sandbox->spent = steps > UINT64_MAX - sandbox->spent ? UINT64_MAX : sandbox->spent + steps;
    if (sandbox->spent > sandbox->budget) {
        wh_sandbox_alarm(sandbox);
    }
}

void wh_sandbox_charge(lua_State *L, uint64_t steps) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    wh_sandbox_spend(sandbox, steps);
    check_stop_and_budget(L, sandbox);
    if (sandbox->fatal != WH_SANDBOX_OK) {
        wh_sandbox_raise(L);
    }
}

void wh_sandbox_renew(wh_sandbox_t *sandbox) {
    sandbox->spent = 0;
    sandbox->printed = 0;
    sandbox->fatal = WH_SANDBOX_OK;
    sandbox->stop = 0;
    lua_sethook(sandbox->main, on_count, LUA_MASKCOUNT, WH_SANDBOX_GRANULE);
}

void wh_sandbox_stop(wh_sandbox_t *sandbox) {
    sandbox->stop = 1;
    wh_sandbox_alarm(sandbox);
}

bool wh_sandbox_stopping(const wh_sandbox_t *sandbox) {
    return sandbox->stop != 0;
}

uint64_t wh_sandbox_spent(const wh_sandbox_t *sandbox) {
    return sandbox->spent;
}

void wh_sandbox_budget_open(lua_State *L) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    for (int reason = WH_SANDBOX_BUDGET; reason <= WH_SANDBOX_STOPPED; ++reason) {
        char text[100];
        sandbox->fatal = (wh_sandbox_reason_t)reason;
        wh_sandbox_fatal_text(sandbox, text, sizeof text);
        lua_pushstring(L, text);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &message_keys[reason]);
    }
    sandbox->fatal = WH_SANDBOX_OK;
    lua_sethook(L, on_count, LUA_MASKCOUNT, WH_SANDBOX_GRANULE);
}
