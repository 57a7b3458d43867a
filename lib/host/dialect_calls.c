/* Calls a dialect's functions that make requests and lines of frames: decode, unit_of and run. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "dialect_internal.h"
#include "values.h"

/* ---------------------------------------------------------------------------------------------- refusals */

/* A field of the error's table, as a text. */
static void take_error_text(lua_State *L, const char *field, char *text, size_t size) {
    lua_pushstring(L, field);
    lua_rawget(L, -2);
    (void)snprintf(text, size, "%s", lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "");
    lua_pop(L, 1);
}

/* Reads a text that a host has sent. Its control characters become \xNN: they cannot steer a terminal. */
static void take_visible(lua_State *L, const char *field, char *text, size_t size) {
    size_t length = 0;
    lua_pushstring(L, field);
    lua_rawget(L, -2);
    const char *said = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &length) : "";
    wh_utf8_visible_bytes(text, size, said, length);
    lua_pop(L, 1);
}

bool wh_dialect_refused(const wh_dialect_t *dialect, wh_failure_t *failure) {
    lua_State *L = wh_sandbox_state(dialect->sandbox);
    bool is_refusal = false;
    memset(failure, 0, sizeof *failure);
    wh_sandbox_push_error(L);
    if (lua_istable(L, -1)) {
        lua_pushliteral(L, "refused");
        is_refusal = lua_rawget(L, -2) == LUA_TNUMBER;
        failure->number = (wh_status_t)lua_tointeger(L, -1);
        lua_pop(L, 1);
        take_error_text(L, "code", failure->code, sizeof failure->code);
        take_visible(L, "detail", failure->detail, sizeof failure->detail);
    }
    lua_pop(L, 1);
    if (is_refusal && failure->code[0] == '\0') {
        (void)snprintf(failure->code, sizeof failure->code, "%s", wh_dialect_code(dialect, failure->number));
    }
    return is_refusal;
}

bool wh_dialect_call(wh_dialect_t *dialect, lua_CFunction function, wh_dialect_call_t *argument) {
    wh_sandbox_result_t result;
    wh_sandbox_renew(dialect->sandbox);
    if (wh_sandbox_protect(wh_sandbox_state(dialect->sandbox), function, argument, &result)) {
        return true;
    }
    wh_dialect_note(dialect, result.message);
    return false;
}

wh_decoded_t wh_dialect_outcome(wh_dialect_t *dialect, bool done, wh_failure_t *failure) {
    if (done) {
        return WH_DECODED_REQUEST;
    }
    return wh_dialect_refused(dialect, failure) ? WH_DECODED_REFUSED : WH_DECODED_MISTAKE;
}

/* ----------------------------------------------------------------------------------------------- decoding */

/* Raises what host.refuse does. */
__attribute__((noreturn)) static void refuse(lua_State *L, wh_status_t number, const char *detail) {
    lua_createtable(L, 0, 2);
    wh_lua_set_integer(L, "refused", number);
    wh_lua_set_text(L, "detail", detail);
    lua_error(L);
    abort();
}

/* Takes a field of the request that is on top of the stack: a text, or a whole number. A text that is too
 * long for a word or has a byte 0 came from the host, and is refused by this error. */
static bool take_word(lua_State *L, const char *field, wh_status_t refusal, char *word) {
    size_t size = 0;
    lua_getfield(L, -1, field);
    const bool is_word = lua_type(L, -1) == LUA_TSTRING || lua_isinteger(L, -1);
    const char *text = is_word ? lua_tolstring(L, -1, &size) : "";
    if (!is_word && !lua_isnil(L, -1)) {
        luaL_error(L, "decode returned a request's %s that is neither a text nor a whole number", field);
    }
    if (size >= WH_DIALECT_NAME_BYTES || strlen(text) != size) {
        char shown[WH_DIALECT_NAME_BYTES];
        wh_utf8_visible_bytes(shown, sizeof shown, text, size);
        refuse(L, refusal, shown);
    }
    (void)snprintf(word, WH_DIALECT_NAME_BYTES, "%s", text);
    lua_pop(L, 1);
    return is_word;
}

static const wh_dialect_command_t *find_command(const wh_dialect_t *dialect, const char *name) {
    for (size_t i = 0; i < dialect->command_count; ++i) {
        if (strcmp(dialect->commands[i].name, name) == 0) {
            return &dialect->commands[i];
        }
    }
    return NULL;
}

void wh_dialect_push_client(lua_State *L, const wh_client_t *client) {
    lua_createtable(L, 0, 2);
    wh_lua_set_text(L, "port", client->port);
    wh_lua_set_integer(L, "number", (lua_Integer)client->number);
}

/* Runs protected. */
static int decode_frame(lua_State *L) {
    char name[WH_DIALECT_NAME_BYTES];
    wh_dialect_call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "decode", NULL);
    lua_pushlstring(L, it->frame, it->size);
    wh_dialect_push_client(L, it->client);
    lua_pushlstring(L, it->end ? (const char *)it->end->bytes : "", it->end ? it->end->size : 0);
    lua_call(L, 3, 1);
    if (lua_isnil(L, -1)) {
        return 0;
    }
    if (!lua_istable(L, -1)) {
        return luaL_error(L, "%s: decode returned no request (expected a table, or nil)", it->dialect->path);
    }
    lua_pushvalue(L, -1);
    it->request->reference = luaL_ref(L, LUA_REGISTRYINDEX);
    (void)take_word(L, "sequence", WH_STATUS_BAD_ARGUMENT, it->request->sequence);
    if (!take_word(L, "command", WH_STATUS_NO_SUCH_COMMAND, name)) {
        return luaL_error(L, "%s: decode returned a request without a command", it->dialect->path);
    }
    it->request->command = find_command(it->dialect, name);
    if (!it->request->command) {
        refuse(L, WH_STATUS_NO_SUCH_COMMAND, name);
    }
    return 0;
}

wh_decoded_t wh_dialect_decode(wh_dialect_t *dialect, const wh_client_t *client, const wh_frame_t *frame,
                               wh_request_t *request, wh_failure_t *failure) {
    const bool has_end = frame->end < dialect->framing.end_count;
    wh_dialect_call_t it = {.dialect = dialect,
                            .client = client,
                            .frame = (const char *)frame->body,
                            .size = frame->body_size,
                            .end = has_end ? &dialect->framing.ends[frame->end] : NULL,
                            .request = request};
    *request = (wh_request_t){.reference = LUA_NOREF};
    memset(failure, 0, sizeof *failure);
    const bool done = wh_dialect_call(dialect, decode_frame, &it);
    const wh_decoded_t outcome = wh_dialect_outcome(dialect, done, failure);
    const bool is_none = outcome == WH_DECODED_REQUEST && !request->command;
    return is_none ? WH_DECODED_NOTHING : outcome;
}

void wh_dialect_forget(wh_dialect_t *dialect, wh_request_t *request) {
    if (request->reference != LUA_NOREF) {
        luaL_unref(wh_sandbox_state(dialect->sandbox), LUA_REGISTRYINDEX, request->reference);
    }
    *request = (wh_request_t){.reference = LUA_NOREF};
}

/* Runs protected: leaves the address in `unit`. */
static int find_unit(lua_State *L) {
    const wh_dialect_call_t *it = lua_touserdata(L, 1);
    size_t size = 0;
    wh_dialect_push(L, "unit_of", NULL);
    lua_pushlstring(L, it->frame, it->size);
    lua_call(L, 1, 1);
    const bool is_unit = lua_type(L, -1) == LUA_TSTRING || lua_isinteger(L, -1);
    const char *text = is_unit ? lua_tolstring(L, -1, &size) : "";
    if (!is_unit && !lua_isnil(L, -1)) {
        return luaL_error(L, "%s: unit_of returned %s (expected a text, a whole number, or nil)",
                          it->dialect->path, luaL_typename(L, -1));
    }
    /* A host's own text that is too long is no unit's. */
    const bool fits = size < WH_DIALECT_NAME_BYTES && strlen(text) == size;
    (void)snprintf(it->unit, WH_DIALECT_NAME_BYTES, "%s", fits ? text : "");
    return 0;
}

bool wh_dialect_unit_of(wh_dialect_t *dialect, const char *frame, size_t size,
                        char unit[WH_DIALECT_NAME_BYTES]) {
    wh_dialect_call_t it = {.dialect = dialect, .frame = frame, .size = size, .unit = unit};
    unit[0] = '\0';
    return wh_dialect_call(dialect, find_unit, &it);
}

/* -------------------------------------------------------------------------------------------------- lines */

static void take_typed_line(lua_State *L, const wh_dialect_call_t *it) {
    const wh_dialect_command_t *command = it->request->command;
    size_t size = 0;
    const char *text = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &size) : NULL;
    if (!text) {
        luaL_error(L, "%s: commands.%s.run returned no line", it->dialect->path, command->name);
        return;
    }
    if (size >= WH_DIALECT_LINE_BYTES || strlen(text) != size) {
        refuse(L, WH_STATUS_BAD_ARGUMENT, "a line that is too long, or has a byte 0");
    }
    const wh_word_t *word = command->kind == WH_WORD_LOCAL ? NULL : wh_word_of(text);
    bool is_one_of_them = command->kind == WH_WORD_LOCAL;
    for (size_t i = 0; i < command->does_count; ++i) {
        is_one_of_them = is_one_of_them || word == command->does[i];
    }
    if (!is_one_of_them) {
        luaL_error(L, "%s: commands.%s.run: \"%s\" (expected a line of what `does` names)", it->dialect->path,
                   command->name, text);
    }
    if (it->lines->count == WH_DIALECT_LINES) {
        luaL_error(L, "%s: commands.%s.run: \"%s\" (expected at most %d lines)", it->dialect->path,
                   command->name, text, WH_DIALECT_LINES);
    }
    memcpy(it->lines->lines[it->lines->count++], text, size + 1);
    lua_pop(L, 1);
}

/* True if the function on top of the stack has a second parameter. */
static bool takes_second(lua_State *L) {
    lua_Debug debug;
    lua_pushvalue(L, -1);
    return lua_getinfo(L, ">u", &debug) != 0 && (debug.nparams >= 2 || debug.isvararg != 0);
}

static void push_now(lua_State *L, const wh_dialect_call_t *it) {
    wh_result_t now = {.answer = "", .status = ""};
    if (it->ask) {
        it->ask(it->user, &now);
    }
    wh_dialect_push_now(L, it->dialect, &now);
}

/* Runs protected. */
static int run_command(lua_State *L) {
    wh_dialect_call_t *it = lua_touserdata(L, 1);
    const wh_dialect_command_t *command = it->request->command;
    wh_dialect_push(L, "commands", command->name);
    if (lua_getfield(L, -1, "run") == LUA_TNIL) {
        lua_pushstring(L, command->does[0]->name);
    } else {
        const bool takes_now = takes_second(L);
        lua_rawgeti(L, LUA_REGISTRYINDEX, it->request->reference);
        if (takes_now) {
            push_now(L, it);
        }
        lua_call(L, takes_now ? 2 : 1, 1);
    }
    if (!lua_istable(L, -1)) {
        take_typed_line(L, it);
        return 0;
    }
    for (lua_Integer i = 1; lua_geti(L, -1, i) != LUA_TNIL; ++i) {
        take_typed_line(L, it);
    }
    lua_pop(L, 1);
    if (it->lines->count == 0) {
        return luaL_error(L, "%s: commands.%s.run returned no line", it->dialect->path, command->name);
    }
    return 0;
}

wh_decoded_t wh_dialect_run(wh_dialect_t *dialect, const wh_request_t *request, wh_now_t *ask, void *user,
                            wh_lines_t *lines, wh_failure_t *failure) {
    wh_request_t asked = *request;
    wh_dialect_call_t it = {.dialect = dialect, .request = &asked, .ask = ask, .user = user, .lines = lines};
    lines->count = 0;
    memset(failure, 0, sizeof *failure);
    return wh_dialect_outcome(dialect, wh_dialect_call(dialect, run_command, &it), failure);
}
