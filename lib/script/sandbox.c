/* Creating a sandbox and running things in it. */
#include <stdlib.h>
#include <string.h>

#include "sandbox_internal.h"

/* Registry key of the last error's value. The slot always exists (false: none), so that setting it needs no
 * memory. */
static const char error_key = 0;

static int open_all(lua_State *L) {
    wh_sandbox_budget_open(L);
    lua_pushboolean(L, false);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &error_key);
    return wh_sandbox_library_open(L);
}

static void set_limits(wh_sandbox_t *sandbox, const wh_sandbox_limits_t *limits) {
    static const wh_sandbox_limits_t defaults = {0};
    const wh_sandbox_limits_t *const wanted = limits != NULL ? limits : &defaults;
    sandbox->memory_cap = wanted->memory_bytes != 0 ? wanted->memory_bytes : WH_SANDBOX_MEMORY_BYTES;
    sandbox->trust = wanted->trust;
    sandbox->print_to = wanted->print_to != NULL ? wanted->print_to : stdout;
    sandbox->budget = wanted->instructions != 0 ? wanted->instructions : WH_SANDBOX_INSTRUCTIONS;
}

wh_sandbox_t *wh_sandbox_new(const wh_sandbox_limits_t *limits) {
    wh_sandbox_t *const sandbox = calloc(1, sizeof *sandbox);
    if (sandbox == NULL) {
        return NULL;
    }
    set_limits(sandbox, limits);
    sandbox->main = lua_newstate(wh_sandbox_allocate, sandbox);
    if (sandbox->main == NULL) {
        free(sandbox);
        return NULL;
    }
    lua_pushcfunction(sandbox->main, open_all);
    if (lua_pcall(sandbox->main, 0, 0, 0) != LUA_OK) {
        wh_sandbox_free(sandbox);
        return NULL;
    }
    sandbox->running = sandbox->main;
    wh_sandbox_renew(sandbox);
    wh_pow_set_strict(sandbox);
    return sandbox;
}

void wh_sandbox_free(wh_sandbox_t *sandbox) {
    if (sandbox == NULL) {
        return;
    }
    lua_close(sandbox->main);
    if (wh_pow_strict() == sandbox) {
        wh_pow_set_strict(NULL);
    }
    free(sandbox);
}

lua_State *wh_sandbox_state(wh_sandbox_t *sandbox) {
    return sandbox->main;
}

wh_sandbox_reason_t wh_sandbox_reason(const wh_sandbox_t *sandbox) {
    return sandbox->reason;
}

void wh_sandbox_push_error(lua_State *L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &error_key) == LUA_TBOOLEAN && !lua_toboolean(L, -1)) {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
}

/* ---- One job ---- */

static void keep_error(lua_State *L) {
    if (lua_isnil(L, -1)) {
        lua_pushboolean(L, false);
    } else {
        lua_pushvalue(L, -1);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &error_key);
}

static void enter(lua_State *L, wh_sandbox_job_t *job) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (sandbox->job == NULL) {
        sandbox->refused = false;
        sandbox->power_pending = false;
        sandbox->stop = 0;
    }
    job->outer = sandbox->job;
    job->outer_running = sandbox->running;
    job->outer_strict = wh_pow_set_strict(sandbox);
    sandbox->job = job;
    sandbox->running = L;
}

/* Memory and stop are over when the outermost job is; a spent budget stays spent until it is renewed. */
static void leave(wh_sandbox_t *sandbox, const wh_sandbox_job_t *job) {
    sandbox->job = job->outer;
    sandbox->running = job->outer_running;
    wh_pow_set_strict(job->outer_strict);
    if (sandbox->job == NULL && sandbox->fatal != WH_SANDBOX_OK) {
        lua_gc(sandbox->main, LUA_GCCOLLECT);
        sandbox->fatal = sandbox->fatal == WH_SANDBOX_BUDGET ? WH_SANDBOX_BUDGET : WH_SANDBOX_OK;
    }
}

static wh_sandbox_reason_t reason_of(const wh_sandbox_t *sandbox, const wh_sandbox_job_t *job) {
    if (sandbox->fatal != WH_SANDBOX_OK) {
        return sandbox->fatal;
    }
    return job->loaded ? WH_SANDBOX_ERROR : WH_SANDBOX_SYNTAX;
}

/* The error's value is on top; takes it off. */
static void fail(lua_State *L, wh_sandbox_job_t *job, int status, wh_sandbox_result_t *result) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    (void)wh_sandbox_is_fatal(L, status);
    keep_error(L);
    wh_sandbox_report(L, job, result->message);
    sandbox->reason = result->status = reason_of(sandbox, job);
}

/* base: where the results, or the error, begin. True when all went well. */
static bool conclude(lua_State *L, wh_sandbox_job_t *job, int base, int status, wh_sandbox_result_t *result) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (status == LUA_OK && (sandbox->fatal != WH_SANDBOX_OK || sandbox->power_pending)) {
        /* A C function swallowed it. */
        lua_settop(L, base - 1);
        lua_pushliteral(L, "an error was swallowed");
        status = LUA_ERRRUN;
        sandbox->power_pending = false;
    }
    if (status == LUA_OK) {
        sandbox->reason = result->status = WH_SANDBOX_OK;
        result->message[0] = '\0';
    } else {
        fail(L, job, status, result);
    }
    leave(sandbox, job);
    return status == LUA_OK;
}

static int load_and_run(lua_State *L) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    wh_sandbox_job_t *const job = lua_touserdata(L, 1);
    wh_sandbox_charge(L, job->size);
    const char *const name = lua_pushfstring(L, "@%s", job->path);
    ++sandbox->loading;
    const int status = luaL_loadbufferx(L, job->text, job->size, name, "t");
    --sandbox->loading;
    if (status != LUA_OK) {
        return lua_error(L);
    }
    job->loaded = true;
    lua_call(L, 0, job->results);
    return job->results;
}

/* How Lua abbreviates a path in its own messages (its luaO_chunkid): the last 56 bytes of a long one. */
static void abbreviate(wh_sandbox_job_t *job) {
    const size_t length = strlen(job->path);
    if (length < LUA_IDSIZE) {
        memcpy(job->short_source, job->path, length + 1);
    } else {
        const size_t kept = LUA_IDSIZE - sizeof "...";
        memcpy(job->short_source, "...", 3);
        memcpy(job->short_source + 3, job->path + length - kept, kept + 1);
    }
}

static bool run_text(lua_State *L, wh_sandbox_job_t *job, wh_sandbox_result_t *result) {
    wh_sandbox_result_t unused = {WH_SANDBOX_OK, ""};
    wh_sandbox_result_t *const told = result != NULL ? result : &unused;
    enter(L, job);
    abbreviate(job);
    job->text = wh_source_begin(job->text, &job->size);
    if (!lua_checkstack(L, 4)) {
        leave(wh_sandbox_of(L), job);
        told->status = WH_SANDBOX_ERROR;
        snprintf(told->message, sizeof told->message, "%.900s: stack overflow", job->path);
        return false;
    }
    lua_pushcfunction(L, wh_sandbox_handler);
    const int base = lua_gettop(L);
    lua_pushcfunction(L, load_and_run);
    lua_pushlightuserdata(L, job);
    const int status = lua_pcall(L, 1, job->results, base);
    lua_remove(L, base);
    return conclude(L, job, base, status, told);
}

bool wh_sandbox_evaluate_text(lua_State *L, const char *name, const char *text, size_t size,
                              wh_sandbox_result_t *result) {
    wh_sandbox_job_t job = {.path = name, .text = text, .size = size, .results = 1};
    return run_text(L, &job, result);
}

static bool run_file(lua_State *L, const char *path, int results, wh_sandbox_result_t *result) {
    char *text = NULL;
    size_t size = 0;
    const char *const why = wh_source_read(path, &text, &size);
    if (why != NULL) {
        wh_sandbox_of(L)->reason = WH_SANDBOX_UNREADABLE;
        if (result != NULL) {
            result->status = WH_SANDBOX_UNREADABLE;
            snprintf(result->message, sizeof result->message, "%.900s: %s", path, why);
        }
        return false;
    }
    wh_sandbox_job_t job = {.path = path, .text = text, .size = size, .results = results};
    const bool ok = run_text(L, &job, result);
    free(text);
    return ok;
}

bool wh_sandbox_run(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result) {
    return run_file(sandbox->main, path, 0, result);
}

bool wh_sandbox_evaluate(lua_State *L, const char *path, wh_sandbox_result_t *result) {
    return run_file(L, path, 1, result);
}

bool wh_sandbox_call(lua_State *L, int arguments, int results, wh_sandbox_result_t *result) {
    wh_sandbox_result_t unused;
    wh_sandbox_job_t job = {.loaded = true};
    const int base = lua_gettop(L) - arguments;
    enter(L, &job);
    lua_pushcfunction(L, wh_sandbox_handler);
    lua_insert(L, base);
    const int status = lua_pcall(L, arguments, results, base);
    lua_remove(L, base);
    return conclude(L, &job, base, status, result != NULL ? result : &unused);
}
