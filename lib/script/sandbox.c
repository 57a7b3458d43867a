/* Creating a sandbox, running files, texts and functions in it, and the message when one fails. */
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/output.h"
#include "../text/utf8.h"
#include "sandbox_internal.h"

/* ----------------------------------------------------------------------------------------------- messages */

static int note_line(lua_State *L) {
    wh_sandbox_job_t *const job = wh_sandbox_of(L)->job;
    if (job->path != NULL) {
        job->line = wh_sandbox_line(L, job->path);
    }
    return 1;
}

/* The error's text for people. Lua code (__tostring) may have to make it. For a table without __tostring
 * the text is its field `message`: numbered errors are such tables. */
static const char *text_of(lua_State *L, size_t *length) {
    const int type = lua_type(L, 1);
    if (type == LUA_TSTRING || type == LUA_TNUMBER || luaL_getmetafield(L, 1, "__tostring") != LUA_TNIL) {
        return wh_library_tostring(L, 1, length);
    }
    if (type == LUA_TTABLE) {
        lua_pushliteral(L, "message");
        if (lua_rawget(L, 1) == LUA_TSTRING) {
            return lua_tolstring(L, -1, length);
        }
    }
    lua_pushfstring(L, "(error object is a %s value)", luaL_typename(L, 1));
    return lua_tolstring(L, -1, length);
}

/* Makes one line of the text, without characters that control a terminal. Line ends and tabs become
 * blanks. */
static int describe(lua_State *L) {
    size_t length = 0;
    const char *const all = text_of(L, &length);
    const char *const text = wh_sandbox_skip_inner(all);
    char whole[WH_SANDBOX_MESSAGE_BYTES + 1];
    length -= (size_t)(text - all);
    const size_t kept = length < sizeof whole ? length : sizeof whole - 1;
    for (size_t i = 0; i < kept; ++i) {
        whole[i] = isspace((unsigned char)text[i]) ? ' ' : text[i];
    }
    whole[kept] = '\0';
    wh_utf8_visible_bytes(lua_touserdata(L, 2), WH_SANDBOX_MESSAGE_BYTES, whole, kept);
    return 0;
}

static void make_text(lua_State *L, char described[WH_SANDBOX_MESSAGE_BYTES]) {
    const wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (sandbox->fatal == WH_SANDBOX_OK) {
        wh_utf8_clip(described, WH_SANDBOX_MESSAGE_BYTES, "(error object whose __tostring failed)");
        lua_pushcfunction(L, describe);
        lua_pushvalue(L, -2);
        lua_pushlightuserdata(L, described);
        if (lua_pcall(L, 2, 0, 0) != LUA_OK) {
            (void)wh_sandbox_is_fatal(L, LUA_ERRRUN);
            lua_pop(L, 1);
        }
    }
    if (sandbox->fatal != WH_SANDBOX_OK) {
        wh_sandbox_fatal_text(sandbox, described, WH_SANDBOX_MESSAGE_BYTES);
    }
}

bool wh_sandbox_is_inner(const char *name) {
    return strncmp(name, WH_INNER_CHUNK, sizeof WH_INNER_CHUNK - 1) == 0;
}

/* The place that Lua names in code without names and lines. */
#define NO_PLACE "?:-1: "

const char *wh_sandbox_skip_inner(const char *text) {
    if (strncmp(text, NO_PLACE, sizeof NO_PLACE - 1) == 0) {
        return text + sizeof NO_PLACE - 1;
    }
    const char *const colon = wh_sandbox_is_inner(text) ? strchr(text, ':') : NULL;
    if (colon == NULL) {
        return text;
    }
    const char *const after = colon + 1 + strspn(colon + 1, "0123456789");
    return strncmp(after, ": ", 2) == 0 ? after + 2 : text;
}

/* True if the text begins with Lua's own "short_source:line:". */
static bool has_position(const char *text, const char *short_source) {
    const size_t length = strlen(short_source);
    return strncmp(text, short_source, length) == 0 && text[length] == ':' &&
           isdigit((unsigned char)text[length + 1]);
}

static void report(lua_State *L, const wh_sandbox_job_t *job, char message[WH_SANDBOX_MESSAGE_BYTES]) {
    const wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    char described[WH_SANDBOX_MESSAGE_BYTES];
    char whole[WH_SANDBOX_MESSAGE_BYTES * 3];
    make_text(L, described);
    lua_pop(L, 1);
    if (sandbox->fatal != WH_SANDBOX_OK && sandbox->fatal_place[0] != '\0') {
        snprintf(whole, sizeof whole, "%s: %s", sandbox->fatal_place, described);
    } else if (job->path == NULL) {
        snprintf(whole, sizeof whole, "%s", described);
    } else if (has_position(described, job->short_source)) {
        snprintf(whole, sizeof whole, "%.1023s%s", job->path, described + strlen(job->short_source));
    } else if (job->line > 0) {
        snprintf(whole, sizeof whole, "%.1023s:%d: %s", job->path, job->line, described);
    } else {
        snprintf(whole, sizeof whole, "%.1023s: %s", job->path, described);
    }
    wh_utf8_visible(message, WH_SANDBOX_MESSAGE_BYTES, whole);
}

/* -------------------------------------------------------------------------------------------------- files */

/* The reason why a file is not read, or null. It checks the file before Lua opens it, because opening a
 * device may move it. */
static const char *file_fault(const char *path, size_t *size) {
    struct stat status;
    wh_output_note_input(path);
    if (stat(path, &status) != 0) {
        return strerror(errno);
    }
    *size = (size_t)status.st_size;
    if (S_ISDIR(status.st_mode)) {
        return "it is a directory";
    }
    if (!S_ISREG(status.st_mode)) {
        return "it is no regular file";
    }
    if (status.st_size > (off_t)WH_SANDBOX_FILE_BYTES) {
        return "it is larger than 16 MiB";
    }
    wh_output_keep(path);
    return access(path, R_OK) == 0 ? NULL : strerror(errno);
}

/* Users sometimes give a log in place of a script; a log begins with LCM's sync word or is compressed. */
static bool is_log(const char *path) {
    static const unsigned char begins[2][4] = {{0xED, 0xA1, 0xDA, 0x01}, {0x28, 0xB5, 0x2F, 0xFD}};
    unsigned char begin[4] = {0};
    FILE *file = fopen(path, "rb");
    const size_t size = file ? fread(begin, 1, sizeof begin, file) : 0;
    if (file) {
        (void)fclose(file);
    }
    return size == sizeof begin && (memcmp(begin, begins[0], 4) == 0 || memcmp(begin, begins[1], 4) == 0);
}

/* ---------------------------------------------------------------------------------------------- a sandbox */

/* Registry key of the last error's value. The slot always exists (false: no error), so setting it needs no
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
    wh_sandbox_t *const sandbox = wh_array_new(1, sizeof *sandbox);
    set_limits(sandbox, limits);
    wh_sandbox_blocks_open(&sandbox->blocks);
    sandbox->main = lua_newstate(wh_sandbox_allocate, sandbox);
    if (sandbox->main == NULL) {
        wh_sandbox_blocks_close(&sandbox->blocks);
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
    wh_sandbox_blocks_close(&sandbox->blocks);
    wh_sandbox_t *const strict = wh_pow_set_strict(NULL);
    wh_pow_set_strict(strict != sandbox ? strict : NULL);
    free(sandbox);
}

lua_State *wh_sandbox_state(wh_sandbox_t *sandbox) {
    return sandbox->main;
}

void wh_sandbox_push_error(lua_State *L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &error_key) == LUA_TBOOLEAN && !lua_toboolean(L, -1)) {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
}

/* ------------------------------------------------------------------------------------------------ One job */

static void keep_error(lua_State *L) {
    if (lua_isnil(L, -1)) {
        lua_pushboolean(L, false);
    } else {
        lua_pushvalue(L, -1);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &error_key);
}

/* The outermost job starts with empty state; inner ones share the limits that the outer one has
 * exhausted. */
static void enter(lua_State *L, wh_sandbox_job_t *job) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (sandbox->job == NULL) {
        sandbox->refused = false;
        sandbox->refused_place[0] = sandbox->fatal_place[0] = '\0';
        sandbox->power_pending = false;
        sandbox->stop = 0;
    }
    job->state = L;
    job->outer = sandbox->job;
    job->outer_running = sandbox->running;
    job->outer_strict = wh_pow_set_strict(sandbox);
    sandbox->job = job;
    sandbox->running = L;
}

/* The outermost job's end clears an exhausted memory cap and a stop. A spent budget stays spent until it is
 * renewed. */
static void leave(wh_sandbox_t *sandbox, const wh_sandbox_job_t *job) {
    sandbox->job = job->outer;
    sandbox->running = job->outer_running;
    wh_pow_set_strict(job->outer_strict);
    if (sandbox->job == NULL && sandbox->fatal != WH_SANDBOX_OK) {
        lua_gc(sandbox->main, LUA_GCCOLLECT);
        sandbox->fatal = sandbox->fatal == WH_SANDBOX_BUDGET ? WH_SANDBOX_BUDGET : WH_SANDBOX_OK;
    }
}

/* `base` is the index at which the results, or the error, begin. Returns true if all went well. */
static bool conclude(lua_State *L, wh_sandbox_job_t *job, int base, int status, wh_sandbox_result_t *result) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (status == LUA_OK && (sandbox->fatal != WH_SANDBOX_OK || sandbox->power_pending)) {
        /* A C function has swallowed the error. */
        lua_settop(L, base - 1);
        lua_pushliteral(L, "an error was swallowed");
        status = LUA_ERRRUN;
        sandbox->power_pending = false;
    }
    if (status == LUA_OK) {
        result->status = WH_SANDBOX_OK;
        result->message[0] = '\0';
    } else {
        (void)wh_sandbox_is_fatal(L, status);
        keep_error(L);
        report(L, job, result->message);
        result->status = job->loaded ? WH_SANDBOX_ERROR : WH_SANDBOX_SYNTAX;
        result->status = sandbox->fatal != WH_SANDBOX_OK ? sandbox->fatal : result->status;
    }
    leave(sandbox, job);
    return status == LUA_OK;
}

/* True if a script names the file that the job is about to read. */
static bool is_named_by_script(const wh_sandbox_job_t *job) {
    const wh_sandbox_job_t *outer = job->outer;
    while (outer != NULL && outer->path == NULL) {
        outer = outer->outer;
    }
    return outer != NULL;
}

/* Raises the reason why the text is not valid Lua. A script must not see the content of another file.
 * Everything that Lua quotes of it comes after "near", or the message has no "near". */
static int raise_syntax(lua_State *L, const wh_sandbox_job_t *job, int status) {
    const char *const text = lua_tostring(L, -1);
    if (status != LUA_ERRSYNTAX || job->text != NULL || !is_named_by_script(job)) {
        return lua_error(L);
    }
    const char *const near = strstr(text, " near ");
    const size_t source = strlen(job->short_source);
    if (!has_position(text, job->short_source)) {
        lua_pushstring(L, "no text");
    } else {
        const size_t position = source + 1 + strspn(text + source + 1, "0123456789");
        lua_pushlstring(L, text, near != NULL ? (size_t)(near - text) : position);
    }
    lua_pushfstring(L, "%s (expected Lua; a script is told no more of another file)", lua_tostring(L, -1));
    return lua_error(L);
}

/* Compiles and runs in one protected call, because compiling may run out of memory, too. During compilation
 * `^` with a fractional exponent is left for the run: constant folding must not raise the error. */
static int load_and_run(lua_State *L) {
    wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    wh_sandbox_job_t *const job = lua_touserdata(L, 1);
    wh_sandbox_charge(L, job->size);
    const bool is_file = job->text == NULL;
    const char *const name = lua_pushfstring(L, "@%s", job->path);
    const char *const text = is_file ? wh_sandbox_read_text(L, job->path, &job->size) : job->text;
    ++sandbox->loading;
    const int status = luaL_loadbufferx(L, text, job->size, name, job->is_code ? "b" : "t");
    --sandbox->loading;
    if (status != LUA_OK) {
        return raise_syntax(L, job, status);
    }
    job->loaded = true;
    if (is_file) {
        wh_sandbox_keep_chunk(L, name);
        wh_sandbox_own(L, name);
        wh_literals_refuse_twice(L, job->short_source, text, job->size);
    }
    lua_call(L, 0, job->results);
    return job->results;
}

/* Like Lua's luaO_chunkid: the last 56 bytes of a long path. */
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

/* lua_pcall as a job: function and arguments are on the stack. */
static bool run_job(lua_State *L, wh_sandbox_job_t *job, int arguments, wh_sandbox_result_t *result) {
    wh_sandbox_result_t unused;
    const int base = lua_gettop(L) - arguments;
    enter(L, job);
    lua_pushcfunction(L, note_line);
    lua_insert(L, base);
    const int status = lua_pcall(L, arguments, job->results, base);
    lua_remove(L, base);
    return conclude(L, job, base, status, result != NULL ? result : &unused);
}

static bool refuse_run(wh_sandbox_result_t *result, wh_sandbox_reason_t reason, const char *path,
                       const char *why) {
    if (result != NULL) {
        char text[WH_SANDBOX_MESSAGE_BYTES];
        result->status = reason;
        snprintf(text, sizeof text, "%.900s: %.100s", path, why);
        wh_utf8_visible(result->message, sizeof result->message, text);
    }
    return false;
}

static bool load_job(lua_State *L, wh_sandbox_job_t *job, wh_sandbox_result_t *result) {
    abbreviate(job);
    if (!lua_checkstack(L, 4)) {
        return refuse_run(result, WH_SANDBOX_ERROR, job->path, "stack overflow");
    }
    lua_pushcfunction(L, load_and_run);
    lua_pushlightuserdata(L, job);
    return run_job(L, job, 1, result);
}

bool wh_sandbox_evaluate_text(lua_State *L, const char *name, const char *text, size_t size,
                              wh_sandbox_result_t *result) {
    wh_sandbox_job_t job = {.path = name, .text = text, .size = size, .results = 1};
    return load_job(L, &job, result);
}

bool wh_sandbox_evaluate_code(lua_State *L, const char *name, const void *code, size_t size,
                              wh_sandbox_result_t *result) {
    wh_sandbox_job_t job = {.path = name, .text = code, .size = size, .is_code = true, .results = 1};
    return load_job(L, &job, result);
}

bool wh_sandbox_evaluate(lua_State *L, const char *path, wh_sandbox_result_t *result) {
    wh_sandbox_job_t job = {.path = path, .results = 1};
    const char *why = file_fault(path, &job.size);
    if (why == NULL && is_log(path)) {
        why = "it is a log or compressed, no Lua (waferhand replay reads logs)";
    }
    if (why != NULL) {
        char text[100];
        snprintf(text, sizeof text, "cannot be read: %.80s", why);
        return refuse_run(result, WH_SANDBOX_UNREADABLE, path, text);
    }
    return load_job(L, &job, result);
}

bool wh_sandbox_call(lua_State *L, int arguments, int results, wh_sandbox_result_t *result) {
    wh_sandbox_job_t job = {.loaded = true, .results = results};
    return run_job(L, &job, arguments, result);
}

bool wh_sandbox_protect(lua_State *L, lua_CFunction function, void *argument, wh_sandbox_result_t *result) {
    lua_pushcfunction(L, function);
    lua_pushlightuserdata(L, argument);
    return wh_sandbox_call(L, 1, 0, result);
}

wh_sandbox_t *wh_sandbox_new_with(const wh_sandbox_limits_t *limits, const char *const assignments[],
                                  size_t count, wh_sandbox_result_t *result) {
    wh_sandbox_t *sandbox = wh_sandbox_new(limits);
    if (!sandbox) {
        *result = (wh_sandbox_result_t){WH_SANDBOX_MEMORY, "no memory for Lua"};
    }
    for (size_t i = 0; sandbox && i < count; ++i) {
        if (!wh_sandbox_set_parameter(sandbox, assignments[i], result)) {
            wh_sandbox_free(sandbox);
            return NULL;
        }
    }
    return sandbox;
}
